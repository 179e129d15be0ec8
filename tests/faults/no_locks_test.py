#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs programs on a disk without locks, where flock() and the locks of fcntl() fail: two programs never mix their
files, killed ones keep nobody out, and the frames have the same bits as on other disks.

usage: no_locks_test.py SHIM LFRENDERER LFPREPROCESSOR LFSUBMIT LFCOMPRESSOR
"""
import errno
import hashlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time
import unittest

import small_field
from program_test_case import ProgramTestCase, wait_until

SHIM = RENDERER = PREPROCESSOR = SUBMIT = COMPRESSOR = None
NO_LOCKS = "has no locks"


def digests(folder):
    """Returns the sha256 of the frames of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.glob("frame_*"))}


def without_locks(reason=errno.ENOSYS):
    return dict(os.environ, LD_PRELOAD=SHIM, NO_LOCKS=str(reason))


class NoLocksTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 3
        self.field = small_field.write_field(self.folder / "field")
        self.path = small_field.write_path(self.folder)
        self.out = self.folder / "out"
        self.claims = self.out / "partial" / "lock.claims"
        self.environment = without_locks()

    def call(self, program, *arguments):
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=400,
                              env=self.environment)

    def render(self, *options, out=None):
        result = self.call(RENDERER, self.field, self.path, "-o", out or self.out, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stderr

    def expected(self):
        """Returns the digests of the frames of a render on a disk that has locks."""
        subprocess.run([RENDERER, self.field, self.path, "-o", self.folder / "whole"], check=True,
                       stderr=subprocess.DEVNULL)
        return digests(self.folder / "whole")

    def start(self, program, *arguments, environment=None):
        process = subprocess.Popen([program, *map(str, arguments)], stderr=subprocess.PIPE, text=True,
                                   env=environment or self.environment)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def stopped_render(self, *options, environment=None):
        """Starts a render, and stops it as soon as it has begun a frame."""
        process = self.start(RENDERER, self.field, self.path, "-o", self.out, "--dump-every", "0.001s", *options,
                             environment=environment)
        wait_until(lambda: any((self.out / "partial").glob("frame_*.plate")), process)
        process.send_signal(signal.SIGSTOP)
        self.assertIsNone(process.poll(), "ended before it could be stopped")
        return process

    def test_all_errors_that_mean_so(self):
        expected = self.expected()
        self.assertEqual(len(expected), 3)
        for reason in (errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP):
            with self.subTest(errno.errorcode[reason]):
                self.environment = without_locks(reason)
                out = self.folder / errno.errorcode[reason]
                said = self.render(out=out)
                self.assertEqual(said.count(NO_LOCKS), 1, said)
                self.assertEqual(digests(out), expected)
                self.assertFalse((out / "partial").exists())

    def test_a_second_render_is_refused_and_a_killed_one_is_resumed(self):
        expected = self.expected()
        first = self.stopped_render()
        self.assertEqual(len(list(self.claims.iterdir())), 1)
        for options in ([], ["--resume"], ["--overwrite"]):
            self.fails(4, ["partial/lock: is locked", f"process {first.pid} on {socket.gethostname()}",
                           "wait for it to end"], RENDERER, self.field, self.path, "-o", self.out, *options)
        first.kill()
        first.wait()
        self.assertEqual(len(list(self.claims.iterdir())), 1)
        self.fails(2, ["--resume", "--overwrite"], RENDERER, self.field, self.path, "-o", self.out)
        self.render("--resume")
        self.assertEqual(digests(self.out), expected)
        self.assertFalse((self.out / "partial").exists())

    def test_two_that_resume_at_once_never_mix(self):
        expected = self.expected()
        for _ in range(3):
            first = self.stopped_render("--overwrite")
            first.kill()
            first.wait()
            two = [self.start(RENDERER, self.field, self.path, "-o", self.out, "--resume") for _ in range(2)]
            codes = sorted(process.wait() for process in two)
            self.assertIn(codes, ([0, 0], [0, 4]))  # the second may begin after the first has ended
            self.assertEqual(digests(self.out), expected)
            self.assertFalse((self.out / "partial").exists())

    def test_a_program_with_locks_and_one_without_keep_each_other_out(self):
        expected = self.expected()
        words = ["partial/lock: is locked", "wait for it to end"]
        for owner, other in ((self.environment, dict(os.environ)), (dict(os.environ), self.environment)):
            process = self.stopped_render("--overwrite", environment=owner)
            self.environment = other
            self.fails(4, [*words, f"process {process.pid}"], RENDERER, self.field, self.path, "-o", self.out,
                       "--resume")
            process.kill()
            process.wait()
            self.render("--resume")
            self.assertEqual(digests(self.out), expected)

    def test_a_program_of_another_machine_is_named_with_its_age(self):
        first = self.stopped_render()
        first.kill()
        first.wait()
        (claim,) = self.claims.iterdir()
        claim.write_text("4711 5 another node07\n")
        age = time.time() - 30
        os.utime(claim, (age, age))
        self.fails(4, ["process 4711 on node07", "last seen 3", "is 90 s old", str(claim)], RENDERER, self.field,
                   self.path, "-o", self.out, "--resume")
        claim.unlink()  # as the message says
        self.render("--resume")

    def test_a_program_with_locks_of_another_machine_is_named(self):
        first = self.stopped_render(environment=dict(os.environ))
        first.kill()
        first.wait()
        lock = self.out / "partial" / "lock"
        lock.write_text("4711 5 another node07\n")
        self.fails(4, [str(lock), "process 4711 on node07", "remove this file"], RENDERER, self.field, self.path,
                   "-o", self.out, "--resume")
        lock.unlink()
        self.render("--resume")

    def test_a_render_whose_claim_is_gone_ends_at_once(self):
        # A render of some ten seconds, which cannot be over before it looks.
        text = small_field.write_path(self.folder, 60).read_text()
        self.path.write_text(text.replace("resolution: [80, 60]", "resolution: [800, 600]"))
        first = self.stopped_render("--back-end", "reference")
        for claim in self.claims.iterdir():
            claim.unlink()
        # The program looks after 10 s, for which it stands still here.
        time.sleep(11)
        first.send_signal(signal.SIGCONT)
        said = first.stderr.read()
        self.assertEqual(first.wait(), 4, said)
        self.assertIn("lock.claims/", said)
        self.assertIn("This program ends", said.splitlines()[-1])

    def test_lfsubmit_renders_and_continues(self):
        expected = self.expected()
        self.succeeds(PREPROCESSOR, self.field, self.path, "-o", self.folder / "packages", "--packages", 2)
        packages = sorted((self.folder / "packages").glob("*.lfp"))
        self.assertEqual(len(packages), 2)
        renderer = self.folder / "lfrenderer"
        renderer.write_text(f'#!/bin/bash\nuntil [ -e {self.folder}/go ]; do sleep 0.1; done\nexec {RENDERER} "$@"\n')
        renderer.chmod(0o755)
        command = [*packages, "-o", self.out, "--lfrenderer", renderer]
        first = self.start(SUBMIT, *command)
        state = self.out / "cluster" / "packages" / "package-0000.json"
        wait_until(state.exists, first)
        self.fails(4, ["cluster/lock: is locked", f"process {first.pid} on", "--cancel"], SUBMIT, *command)
        self.assertEqual(json.loads(self.succeeds(SUBMIT, "--status", self.out, "--json"))["state"], "running")
        first.kill()
        first.wait()
        (self.folder / "go").touch()
        self.succeeds(SUBMIT, "--resume", self.out, "--lfrenderer", renderer)
        self.assertEqual(digests(self.out), expected)
        self.assertFalse(list(self.out.rglob("*.claims")))
        # Emptying the folder of the job leaves the claim of the program that does so.
        again = self.start(SUBMIT, *command, "--overwrite", "--jobs", "1")
        (self.folder / "go").unlink()
        claims = self.out / "cluster" / "lock.claims"
        wait_until(lambda: json.loads(state.read_text())["starts"] == 1 if state.exists() else False, again)
        self.assertEqual(len(list(claims.iterdir())), 1)
        again.terminate()
        self.assertEqual(again.wait(), 5)
        (self.folder / "go").touch()
        self.succeeds(SUBMIT, "--resume", self.out, "--lfrenderer", renderer)
        self.assertEqual(digests(self.out), expected)
        self.assertEqual(json.loads(self.succeeds(SUBMIT, "--status", self.out, "--json"))["state"], "done")

    def frames_of(self, store):
        self.succeeds(RENDERER, store, self.path, "-o", self.folder / "frames", "--overwrite")
        return digests(self.folder / "frames")

    def test_lfcompressor_writes_and_continues(self):
        store = self.folder / "store.lfs"
        unlike = self.folder / "unlike.lfs"
        self.succeeds(COMPRESSOR, self.field, "-o", store)
        subprocess.run([COMPRESSOR, self.field, "-o", unlike], check=True, capture_output=True)
        self.assertEqual(self.frames_of(store), self.frames_of(unlike))
        claim = pathlib.Path(f"{store}.lock.claims", "1")
        claim.parent.mkdir()
        # This process lives as long as the test does.
        fields = pathlib.Path("/proc/self/stat").read_text().rpartition(")")[2].split()
        boot = pathlib.Path("/proc/sys/kernel/random/boot_id").read_text().strip()
        system = f"{boot}/{os.stat('/proc/self/ns/pid').st_ino}"
        claim.write_text(f"{os.getpid()} {fields[19]} {system} here\n")
        again = [COMPRESSOR, self.field, "-o", store, "--overwrite"]
        self.fails(4, ["store.lfs.lock: is locked", f"process {os.getpid()} on here"], *again)
        claim.write_text(f"{os.getpid()} {int(fields[19]) - 1} {system} here\n")  # a number that was given anew
        self.succeeds(*again)
        self.assertFalse(claim.parent.exists())
        self.assertEqual(self.frames_of(store), self.frames_of(unlike))


if __name__ == "__main__":
    SHIM, RENDERER, PREPROCESSOR, SUBMIT, COMPRESSOR = sys.argv[1:6]
    SHIM = str(pathlib.Path(SHIM).resolve())
    del sys.argv[1:6]
    unittest.main()
