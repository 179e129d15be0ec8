#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests packed stores by resolution: complete, without their last files, and copied in part; and --reduce.

usage: resolution_stores_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFIMPORT LFDENSIFY LFFOCUS
"""
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

from program_test_case import ProgramTestCase
from small_field import HEIGHT, WIDTH, write_field, write_path

COMPRESSOR = RENDERER = PREPROCESSOR = IMPORT = DENSIFY = FOCUS = None


def smooth(index):
    """Returns a picture whose details are wide enough to be seen at half the size."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    waves = 128 + 60 * np.sin(x / 9 + index / 5) * np.cos(y / 7)
    return np.clip(waves[..., None] + [0, 20, -20], 0, 255).astype(np.uint8)


class ResolutionStoresTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.store = self.folder / "a.lfs"
        self.path = write_path(self.folder, 2)
        self.field = write_field(self.folder / "png", smooth)

    def compress(self, *options, source=None, store=None, code=0):
        words = [source or self.field, "-o", store or self.store, "--by-resolution", *options, "--json"]
        return json.loads(self.succeeds(COMPRESSOR, *words, code=code))

    def part(self, number):
        return self.store.with_name(f"a-r{number}.lfs")

    def frames(self, name, *inputs, code=0):
        """Returns the files of a film's frames, as bytes."""
        out = self.folder / name
        self.succeeds(RENDERER, *inputs, "-o", out, "--format", "exr", "-q", code=code)
        return [file.read_bytes() for file in sorted(out.glob("frame_*.exr"))]

    def green(self, name):
        return cv2.imread(str(self.folder / name / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., 1]

    def warnings_of(self, *inputs, code=0):
        """Returns what a render writes to stderr."""
        shutil.rmtree(self.folder / "warned", ignore_errors=True)
        done = subprocess.run([RENDERER, *map(str, inputs), "-o", str(self.folder / "warned"), "--progress", "none"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def test_a_complete_store_has_the_bits_of_the_folder(self):
        report = self.compress("--profile", "lossless", "--verify")
        self.assertEqual(report["verified"], 25)
        self.assertEqual(sorted(file.name for file in self.folder.glob("a*.lfs")),
                         ["a-r0.lfs", "a-r1.lfs", "a-r2.lfs", "a-r3.lfs", "a.lfs"])
        self.assertEqual(report["store_bytes"], sum(file.stat().st_size for file in self.folder.glob("a*.lfs")))
        head = self.part(2).read_bytes()[:64].decode()
        self.assertRegex(head, r"^lfrendertools part 2 of the packed store [0-9a-f]{16} +\n$")
        self.assertEqual(self.frames("of_folder", self.field, self.path),
                         self.frames("of_store", self.store, self.path))
        self.succeeds(COMPRESSOR, self.field, "-o", self.store, "--profile", "lossless", "--by-resolution", "--resume",
                      "--verify")
        self.fails(3, ["a number of files for resolutions (--by-resolution) of 4"], COMPRESSOR, self.field, "-o",
                   self.store, "--profile", "lossless", "--verify", "--reencode")

    def test_without_its_last_files_it_is_coarser(self):
        self.compress()
        whole = self.frames("whole", self.store, self.path)
        for missing in (1, 2, 3):
            reduced = self.frames(f"reduced{missing}", self.store, self.path, "--reduce", 2 ** missing)
            self.part(4 - missing).unlink()
            text = self.warnings_of(self.store, self.path)
            self.assertIn(f"{missing} of the store's 4 files of LF images are missing: LF images are loaded at "
                          f"1/{2 ** missing} of their width and height", text)
            self.assertEqual(self.frames(f"coarse{missing}", self.store, self.path), reduced)
            self.assertNotEqual(reduced, whole)
            self.assertNotIn("files of LF images", self.warnings_of(self.store, self.path, "--reduce", 2 ** missing))
            report = json.loads(self.succeeds(IMPORT, self.store, "--check", "pixels", "--json"))
            self.assertEqual((report["missing"], report["broken"]), (0, 0))
        self.part(0).unlink()
        self.fails(3, ["a-r0.lfs: this part of the packed store cannot be read"], RENDERER, self.store, self.path, "-o",
                   self.folder / "none")

    def test_reduced_frames_are_near_the_whole_ones(self):
        self.compress()
        self.frames("whole", self.store, self.path)
        whole = self.green("whole")
        for source in (self.field, self.store):
            self.frames(f"half of {source.name}", source, self.path, "--reduce", 2)
            # Elements at the border see the border of the LF images, where a reduced image has less.
            inner = (self.green(f"half of {source.name}") - whole)[8:-8, 8:-8]
            self.assertLess(np.mean(inner ** 2) ** 0.5, 0.003)

    def test_an_incomplete_copy_has_fewer_images(self):
        self.compress()
        last = self.part(3).read_bytes()
        previous = 25
        for share in (0.99, 0.5, 0.1):
            self.part(3).write_bytes(last[:int(share * len(last))])
            text = self.warnings_of(self.store, self.path, code=6)
            count = int(re.search(r"has the bytes of (\d+) of 25 LF images", text)[1])
            self.assertLess(count, previous)
            self.assertAlmostEqual(count, 25 * share, delta=3)
            previous = count
            report = json.loads(self.succeeds(IMPORT, self.store, "--json", code=6))
            self.assertEqual(report["missing"], 25 - count)
        # The advice loads all LF images.
        advice = re.search(r"\((--reduce \d)\)", text)[1]
        self.assertNotIn("has the bytes", self.warnings_of(self.store, self.path, *shlex.split(advice)))
        self.part(3).write_bytes(last[:20])
        self.succeeds(RENDERER, self.store, self.path, "-o", self.folder / "none", code=3)
        # Damage in a file that has its size is found by checksums.
        self.part(3).write_bytes(last[:300] + b"xxxx" + last[304:])
        self.assertIn("a wrong checksum", self.warnings_of(self.store, self.path, code=6))

    def test_files_of_another_store_are_refused(self):
        self.compress()
        other = self.folder / "other/a.lfs"
        other.parent.mkdir()
        self.compress(store=other)
        shutil.copy(other.with_name("a-r1.lfs"), self.part(1))
        self.fails(3, ["a-r1.lfs: is not part 1 of the packed store", "copy all files of one store together"], RENDERER,
                   self.store, self.path, "-o", self.folder / "none")
        self.fails(3, ["a-r2.lfs: is a part of a packed store: give the store's file"], RENDERER, self.part(2),
                   self.path, "-o", self.folder / "none")

    def test_files_that_cannot_be_reduced_are_in_the_first_file(self):
        self.compress("--profile", "recorded", "--verify")
        self.assertEqual(sorted(file.name for file in self.folder.glob("a*.lfs")), ["a-r0.lfs", "a.lfs"])
        self.assertEqual(self.frames("of_folder", self.field, self.path),
                         self.frames("of_store", self.store, self.path))

    def test_a_store_of_packages_may_be_by_resolution(self):
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, self.path, "-o", packages)
        files = sorted(packages.glob("*.lfp"))
        self.succeeds(COMPRESSOR, *files, "-o", self.store, "--by-resolution", "--profile", "lossless", "--verify")
        self.assertEqual(self.frames("of_folder", *files), self.frames("of_store", *files, "--lightfield", self.store))
        for words, options in ((["--by-resolution and --needed-pixels"], ["--needed-pixels"]),
                               (["--by-resolution and --shard-size"], ["--shard-size", "1M"])):
            self.fails(2, words, COMPRESSOR, *files, "-o", self.folder / "b.lfs", "--by-resolution", *options)

    def test_encoded_images_are_copied_between_stores(self):
        one = self.folder / "one.lfs"
        self.succeeds(COMPRESSOR, self.field, "-o", one, "--reencode", "-q")
        frames = self.frames("of_one", one, self.path)
        report = json.loads(self.succeeds(COMPRESSOR, one, "-o", self.store, "--by-resolution", "--verify", "--json"))
        self.assertEqual((report["copied"], report["coded"], report["verified"]), (True, 25, 25))
        self.assertEqual(frames, self.frames("of_parts", self.store, self.path))
        self.compress(store=self.folder / "b.lfs")
        for number in range(4):
            self.assertEqual(self.part(number).stat().st_size, self.folder.joinpath(f"b-r{number}.lfs").stat().st_size)
        # Back again, and only what packages need.
        shards = self.folder / "shards.lfs"
        self.assertIn("copied    25 encoded images", self.succeeds(
            COMPRESSOR, self.store, "-o", shards, "--shard-size", "20k", "--verify"))
        self.assertEqual(frames, self.frames("of_shards", shards, self.path))
        packages, film = self.folder / "packages", self.folder / "film.lfs"
        path = write_path(self.folder, 2, aperture=0.012, x=-0.02)
        self.succeeds(PREPROCESSOR, self.field, path, "-o", packages)
        files = sorted(packages.glob("*.lfp"))
        report = json.loads(self.succeeds(COMPRESSOR, *files, "--lightfield", one, "-o", film, "--verify", "--json"))
        self.assertTrue(report["copied"])
        self.assertLess(report["lf_images"], 25)
        self.assertEqual(self.frames("film_of_one", *files, "--lightfield", one),
                         self.frames("film", *files, "--lightfield", film))
        self.assertEqual(self.frames("alone_of_one", one, path), self.frames("alone", film, path))
        # A store of packages is copied with the LF images that it has.
        self.succeeds(COMPRESSOR, film, "-o", self.folder / "again.lfs", "--by-resolution", "--verify")
        self.assertEqual(self.frames("again", self.folder / "again.lfs", path), self.frames("alone2", film, path))
        for words, options in ((["copied as they are", "--threshold"], ["--threshold", 5]),
                               (["--needed-pixels", "copied as they are"], ["--needed-pixels"])):
            self.fails(2, words, COMPRESSOR, *files, "--lightfield", one, "-o", self.folder / "none.lfs", *options)
        self.fails(2, ["cannot be compressed again into itself"], COMPRESSOR, one, "-o", one, "--overwrite")
        self.fails(3, ["made with the encoding"], COMPRESSOR, self.field, "-o", self.store, "--by-resolution",
                   "--verify", "--threshold", 5)
        # A damaged encoded image is left out, and named.
        part = bytearray(self.part(3).read_bytes())
        part[200] ^= 1
        self.part(3).write_bytes(part)
        report = json.loads(self.succeeds(COMPRESSOR, self.store, "-o", self.folder / "c.lfs", "--json", code=6))
        self.assertEqual(len(report["skipped"]), 1)
        self.assertIn("a wrong checksum", report["skipped"][0]["reason"])

    def test_what_needs_whole_images_is_refused(self):
        self.compress()
        self.part(3).unlink()
        self.fails(2, ["a package needs whole LF images", "at 1/2 of their width"], PREPROCESSOR, self.store, self.path,
                   "-o", self.folder / "packages")
        self.fails(2, ["a densified store needs whole LF images"], DENSIFY, self.store, "-o", self.folder / "dense.lfs",
                   "--force")
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, self.path, "-o", packages)
        self.fails(2, ["a package needs whole LF images"], RENDERER, *sorted(packages.glob("*.lfp")), "--lightfield",
                   self.store, "-o", self.folder / "none")
        # Looking at a coarser store works.
        self.succeeds(FOCUS, "views", self.store, "--grid", "5x5", "-o", self.folder / "views.npy")

    def test_killed_writers_resume(self):
        self.compress("--profile", "lossless", store=self.folder / "b.lfs")
        words = [COMPRESSOR, str(self.field), "-o", str(self.store), "--by-resolution", "--profile", "lossless",
                 "--threads", "1", "--progress", "none"]
        for delay_s in (0.02, 0.05, 0.1):
            process = subprocess.Popen([*words, "--resume"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(delay_s)
            process.send_signal(signal.SIGKILL)
            process.wait()
        self.succeeds(*words, "--resume", "--verify")
        for number in range(4):
            self.assertEqual(self.part(number).stat().st_size, self.folder.joinpath(f"b-r{number}.lfs").stat().st_size)
        self.assertEqual(list(self.folder.glob("*.unfinished*")), [])


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, IMPORT, DENSIFY, FOCUS = sys.argv[1:7]
    unittest.main(argv=sys.argv[:1], verbosity=2)
