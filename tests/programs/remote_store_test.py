#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that programs read packed stores on web servers, with the results of local ones, and say what is wrong with a
server.

usage: remote_store_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

from program_test_case import ProgramTestCase, wait_until
from range_server import RangeServer, make_certificate
from small_field import write_field, write_path, wall

PROGRAMS = None


def program(name):
    return PROGRAMS / name


class RemoteStoreTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.served = self.folder / "served"
        self.served.mkdir()
        self.cache = self.folder / "cache"
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(self.cache), "TMPDIR": str(self.folder)}
        self.path = write_path(self.folder)
        self.store = self.served / "field.lfs"
        self.field = write_field(self.folder / "field", wall)
        self.make_store()

    def make_store(self):
        self.succeeds(program("lfcompressor"), self.field, "-o", self.store, "-q")

    def call(self, name, *arguments):
        return subprocess.run([name, *map(str, arguments)], capture_output=True, text=True, timeout=400,
                              env=self.environment, cwd=self.folder)

    def serve(self, fault=None, **options):
        server = RangeServer(self.served, fault, **options)
        self.addCleanup(server.stop)
        return server

    def frames(self, source, name, *options):
        """Films a light field. Returns the bytes of the frames."""
        out = self.folder / name
        self.succeeds(program("lfrenderer"), source, self.path, "-o", out, "-q", *options)
        return [file.read_bytes() for file in sorted(out.glob("*.exr"))]

    def copies(self):
        return sorted(self.cache.glob("lfrendertools/stores/*/*.lfs"))


class FilmTest(RemoteStoreTest):
    def test_the_frames_are_those_of_the_local_store(self):
        server = self.serve()
        local = self.frames(self.store, "local")
        self.assertEqual(len(local), 3)
        self.assertEqual(self.frames(server.url("field.lfs"), "remote"), local)
        report = json.loads((self.folder / "remote/report.json").read_text())
        self.assertNotIn(str(self.cache), json.dumps(report))
        copied = server.sent_bytes()
        # Later calls copy nothing, from a signed URL either, and work without the server.
        self.assertEqual(self.frames(server.url("field.lfs?token=x"), "again"), local)
        self.assertLessEqual(server.sent_bytes(), copied + 1)
        server.stop()
        result = self.call(program("lfrenderer"), server.url("field.lfs"), self.path, "-o", self.folder / "alone", "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("its copy in ", result.stderr)
        self.assertEqual([f.read_bytes() for f in sorted((self.folder / "alone").glob("*.exr"))], local)

    def test_store_cache_names_the_folder_of_copies(self):
        server = self.serve()
        self.frames(server.url("field.lfs"), "remote", "--store-cache", "copies")
        self.assertEqual(len(list((self.folder / "copies").glob("field-*/field.lfs"))), 1)
        self.assertFalse(self.cache.exists())

    def test_a_cache_that_cannot_be_written_is_done_without(self):
        server = self.serve()
        self.cache.write_text("")
        result = self.call(program("lfimport"), server.url("field.lfs"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("warning"), 1, result.stderr)
        self.assertIn("temporary folder", result.stderr)
        self.assertEqual(list(self.folder.glob("lfrendertools-*")), [])

    def test_packages_name_the_url(self):
        server = self.serve()
        url = server.url("field.lfs")
        local = self.frames(self.store, "local")
        self.succeeds(program("lfpreprocessor"), url, self.path, "-o", self.folder / "packages", "--packages", 2, "-q")
        packages = sorted((self.folder / "packages").glob("*.lfp"))
        # As on another machine, which has no copy yet.
        for copy in self.copies():
            for file in copy.parent.iterdir():
                file.unlink()
            copy.parent.rmdir()
        before = len(server.requests)
        self.succeeds(program("lfrenderer"), *packages, "-o", self.folder / "packaged", "-q")
        self.assertEqual([f.read_bytes() for f in sorted((self.folder / "packaged").glob("*.exr"))], local)
        self.assertEqual(len(server.requests), before + 2)
        self.succeeds(program("lfsubmit"), *packages, "-o", self.folder / "job", "--jobs", 1, "-q")
        self.assertEqual([f.read_bytes() for f in sorted((self.folder / "job").glob("*.exr"))], local)

    def test_other_programs_open_urls(self):
        server = self.serve()
        url = server.url("field.lfs")
        self.assertIn(url, self.succeeds(program("lfimport"), url))
        self.succeeds(program("lfexample"), url, "-o", self.folder / "example.yaml")
        self.succeeds(program("lffocus"), "stack", url, self.path, "-o", self.folder / "stack", "--planes", 2, "-q")
        self.assertIn("collected", self.succeeds(program("lfvisualizer"), url, self.path, "--text"))


class ByResolutionTest(RemoteStoreTest):
    """Has a store by resolution, in four files besides its tables."""

    def make_store(self):
        self.succeeds(program("lfcompressor"), self.field, "-o", self.store, "--by-resolution", "-q")
        self.parts = sorted(self.served.glob("field-r*.lfs"))
        self.assertGreater(len(self.parts), 1)
        self.local = self.frames(self.store, "local")

    def film(self, url, name, *options):
        return self.call(program("lfrenderer"), url, self.path, "-o", self.folder / name, "-q", *options)

    def films_the_same(self, url, name, *options):
        result = self.film(url, name, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([f.read_bytes() for f in sorted((self.folder / name).glob("*.exr"))], self.local)

    def whole_bytes(self):
        return sum(file.stat().st_size for file in self.served.iterdir())

    def test_each_range_is_read_once(self):
        server = self.serve()
        url = server.url("field.lfs")
        self.films_the_same(url, "first")
        first = server.sent_bytes()
        self.assertLessEqual(first, self.whole_bytes() + 1)
        self.films_the_same(url + "?token=x", "second")
        self.assertEqual(server.sent_bytes(), first + 1)
        server.stop()
        self.films_the_same(url, "third")

    def test_the_tables_alone_are_read_by_reports(self):
        server = self.serve()
        self.succeeds(program("lfcammvminfo"), self.path)
        self.succeeds(program("lfimport"), server.url("field.lfs"), "--check", "none")
        heads = 64 * len(self.parts)
        self.assertLessEqual(server.sent_bytes("-r"), heads)

    def test_a_film_that_a_server_interrupts_is_resumed(self):
        dead = []

        def dies(handler, path, begin, _):
            if "-r" in path and begin > 0 and len(server.requests) > 20:
                dead.append(path)
            if dead:
                handler.close_connection = True
            return bool(dead)

        server = self.serve(dies)
        url = server.url("field.lfs")
        result = self.film(url, "film")
        self.assertEqual(result.returncode, 4, result.stderr)
        last = result.stderr.strip().splitlines()[-1]
        for words in ("127.0.0.1", "6 attempts", "--resume continues"):
            self.assertIn(words, last)
        server.stop()
        again = self.serve(port=server.port)
        self.films_the_same(url, "film", "--resume")
        self.assertLess(again.sent_bytes("-r"), self.whole_bytes())

    def test_a_film_that_is_killed_begins_with_what_was_read(self):
        server = self.serve(lambda *_: time.sleep(0.02))
        url = server.url("field.lfs")
        process = subprocess.Popen([program("lfrenderer"), url, self.path, "-o", self.folder / "film", "-q"],
                                   env=self.environment)
        wait_until(lambda: len(server.requests) > 30, process)
        process.kill()
        process.wait()
        server.fault = None
        before = server.sent_bytes("-r")
        self.films_the_same(url, "film", "--overwrite")
        self.assertLess(server.sent_bytes("-r") - before, self.whole_bytes() - self.store.stat().st_size)

    def test_programs_share_a_copy(self):
        server = self.serve()
        url = server.url("field.lfs")
        processes = [subprocess.Popen([program("lfrenderer"), url, self.path, "-o", self.folder / f"film{i}", "-q"],
                                      env=self.environment) for i in range(3)]
        for i, process in enumerate(processes):
            self.assertEqual(process.wait(), 0)
            self.assertEqual([f.read_bytes() for f in sorted((self.folder / f"film{i}").glob("*.exr"))], self.local)
        # The tables were copied by one of them.
        self.assertLess(server.sent_bytes("field.lfs"), 2 * self.store.stat().st_size)
        sent = server.sent_bytes()
        self.films_the_same(url, "later")
        self.assertEqual(server.sent_bytes(), sent + 1)

    def test_a_damaged_copy_is_mended(self):
        server = self.serve()
        url = server.url("field.lfs")
        self.films_the_same(url, "first")
        part = next(copy for copy in self.copies() if copy.name == self.parts[-1].name)
        damaged = bytearray(part.read_bytes())
        damaged[len(damaged) // 2] ^= 1
        part.write_bytes(damaged)
        before = server.sent_bytes("-r")
        self.films_the_same(url, "second")
        self.assertGreater(server.sent_bytes("-r"), before)
        self.assertEqual(part.read_bytes(), self.parts[-1].read_bytes())

    def test_a_part_that_is_not_on_the_server_makes_it_coarser(self):
        self.parts[-1].unlink()
        expected = self.frames(self.store, "coarse")
        self.local = expected
        self.films_the_same(self.serve().url("field.lfs"), "remote")
        self.parts[0].unlink()
        self.fails(3, ["field-r0.lfs", "not on the server"], program("lfimport"), self.serve().url("field.lfs"),
                   "--store-cache", self.folder / "other")

    def test_images_that_the_server_lacks_or_damages_are_left_out(self):
        content = self.parts[0].read_bytes()
        self.parts[0].write_bytes(content[:len(content) // 2])
        result = self.film(self.serve().url("field.lfs"), "cut")
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertIn("field-r0.lfs", result.stderr)
        damaged = bytearray(content)
        damaged[len(damaged) // 2] ^= 1
        self.parts[0].write_bytes(damaged)
        result = self.film(self.serve().url("field.lfs"), "damaged", "--store-cache", self.folder / "other")
        self.assertIn("damaged on the server", result.stderr)
        report = json.loads((self.folder / "damaged/report.json").read_text())
        self.assertIn(result.returncode, (0, 6), report)

    def test_a_copy_is_a_local_store(self):
        server = self.serve()
        self.films_the_same(server.url("field.lfs"), "remote")
        copy = next(copy for copy in self.copies() if copy.name == "field.lfs")
        moved = self.folder / "moved"
        copy.parent.rename(moved)
        (moved / "field.lfs.url").unlink()
        server.stop()
        self.films_the_same(moved / "field.lfs", "alone")


class FaultTest(RemoteStoreTest):
    def refuses(self, code, words, url, *options):
        begin = time.monotonic()
        self.fails(code, words, program("lfimport"), url, *options)
        return time.monotonic() - begin

    def test_urls_of_other_kinds_are_refused(self):
        self.refuses(2, ["https:// or http://"], "ftp://host/field.lfs")
        self.refuses(2, ["packed store"], "https://host/transforms.json")
        self.refuses(2, [".netrc"], "https://me:secret@host/field.lfs")

    def test_a_missing_file_is_named(self):
        server = self.serve()
        self.refuses(3, ["/other.lfs: ", "status 404"], server.url("other.lfs?token=secret"))

    def test_a_server_without_ranges_is_named(self):
        def whole(handler, *_):
            handler.send_response(200)
            handler.send_header("Content-Length", str(1 << 40))
            handler.end_headers()
            try:
                while True:
                    handler.wfile.write(bytes(1 << 20))
            except OSError:
                return True

        self.refuses(3, ["must send ranges"], self.serve(whole).url("field.lfs"))

    def test_a_large_ordinary_store_is_not_copied(self):
        with open(self.store, "r+b") as file:
            file.truncate(1 << 40)
        server = self.serve()
        self.refuses(3, ["1.1 TB", "--by-resolution"], server.url("field.lfs"))
        self.assertEqual(server.sent_bytes(), 1)

    def test_redirections_lead_to_web_servers_alone(self):
        def to_file(handler, *_):
            handler.status(302, Location="file:///etc/hostname")
            return True

        self.refuses(4, ["check the URL"], self.serve(to_file).url("field.lfs"))

    def test_a_certificate_that_nobody_knows_is_refused(self):
        server = self.serve(certificate=make_certificate(self.folder))
        self.refuses(4, ["certificate", "authority that this machine knows"], server.url("field.lfs"))
        self.assertEqual(server.requests, [])

    def test_an_interrupt_ends_a_server_that_stalls(self):
        def stall(*_):
            time.sleep(60)
            return True

        server = self.serve(stall)
        process = subprocess.Popen([program("lfimport"), server.url("field.lfs")], env=self.environment,
                                   stderr=subprocess.PIPE, text=True)
        wait_until(lambda: server._open, process)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 5, errors)
        self.assertLess(time.monotonic() - begin, 10)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
