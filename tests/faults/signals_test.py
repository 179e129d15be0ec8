#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests signals at any moment of a program, from its start on, and starts in a poor environment: the program ends
correctly, and the next call makes the right files and removes the files of the killed program.

usage: signals_test.py FOLDER_OF_PROGRAMS
"""
import os
import pathlib
import pwd
import resource
import signal
import subprocess
import sys
import time
import unittest

from writers_case import WritersCase

WritersCase.programs = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
MOMENTS = 4
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGKILL, signal.SIGINT)


class SignalsTest(WritersCase):
    def seconds(self, program):
        """Returns the seconds that the program's call takes when it runs alone."""
        out = self.folder / f"{program}-timed"
        out.mkdir()
        begin = time.monotonic()
        subprocess.run(self.command(program, "a", out), check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        return time.monotonic() - begin

    def hit(self, program, out, seconds, sent):
        """Runs the call, sends it a signal, and returns its output."""
        process = subprocess.Popen(self.command(program, "a", out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        time.sleep(seconds)
        process.send_signal(sent)
        said = process.communicate(timeout=240)[1]
        # A program cannot print anything before its libraries are loaded.
        self.assertIn(process.returncode, (0, 5, -sent), said)
        if process.returncode == -sent:
            self.assertTrue(sent == signal.SIGKILL or not said, said)
        if process.returncode == 5:
            self.assertTrue(said.strip().splitlines()[-1].startswith("error: "), said)
        return said

    def survives(self, program, again):
        """again(out) returns the command that completes the result."""
        expected, seconds = self.expect(program, "a"), self.seconds(program)
        for moment in range(MOMENTS):
            out = self.folder / f"{program}-{moment}"
            out.mkdir()
            sent = SIGNALS[moment % len(SIGNALS)]
            said = self.hit(program, out, seconds * (moment + 0.5) / MOMENTS, sent)
            command = again(out)
            result = subprocess.run(command, capture_output=True, text=True, timeout=240)
            self.assertEqual(result.returncode, 0, (sent, said, command, result.stderr))
            self.assertEqual(self.files(program, out), expected, (sent, said))
            self.assertEqual(self.leftovers(out), [], (sent, said))

    def same(self, program, *more):
        self.survives(program, lambda out: self.command(program, "a", out, *more))

    def test_lfrenderer(self):
        self.same("lfrenderer", "--resume")

    def test_lfpreprocessor(self):
        self.same("lfpreprocessor", "--overwrite")

    def test_lfcompressor(self):
        self.same("lfcompressor", "--resume")

    def test_lfdensify(self):
        self.same("lfdensify", "--resume")

    def test_lfmerge(self):
        self.same("lfmerge", "--resume")

    def test_lfquilt(self):
        self.same("lfquilt", "--resume")

    def test_lfsynth(self):
        self.same("lfsynth", "--overwrite")

    def test_lfimport(self):
        self.same("lfimport")

    def test_lfexample(self):
        self.same("lfexample")

    def test_lfsubmit(self):
        self.survives("lfsubmit", lambda out: [str(self.programs / "lfsubmit"), "--resume", str(out)]
                      if (out / "cluster" / "job.json").exists() else self.command("lfsubmit", "a", out))

    def test_a_signal_at_the_start_is_no_crash(self):
        program = self.programs / "lfexample"
        for sent in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
            for moment in range(4):
                process = subprocess.Popen([program, "--help"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                           text=True)
                time.sleep(0.02 * moment)
                process.send_signal(sent)
                said = process.communicate(timeout=60)[1]
                self.assertIn(process.returncode, (0, 5, -sent), said)
                self.assertIn(said, ("", "error: interrupted\n"))

    def test_closed_standard_files_get_nothing(self):
        expected = self.expect("lfrenderer", "a")
        for closed in ((0,), (1,), (2,), (0, 1, 2)):
            out = self.folder / "-".join(map(str, closed))

            def close(closed=closed):
                for file in closed:
                    os.close(file)
            result = subprocess.run(self.command("lfrenderer", "a", out), preexec_fn=close, timeout=240)
            self.assertEqual(result.returncode, 0)
            self.assertEqual(self.files("lfrenderer", out), expected)
        result = subprocess.run([*self.command("lfpreprocessor", "a", self.folder / "p")], stderr=subprocess.PIPE,
                                text=True, preexec_fn=lambda: os.close(1), timeout=240)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("standard output", result.stderr.splitlines()[-1])

    def test_no_threads_at_all(self):
        """A library may start a thread before main()."""
        # The leak check of a build with the address sanitizer needs a thread of its own.
        environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
        nobody = pwd.getpwnam("nobody").pw_uid if os.geteuid() == 0 else None

        def limit():
            resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
            if nobody is not None:
                os.setuid(nobody)
        program = self.programs / "lfrenderer"
        try:
            result = subprocess.run([program, "--version"], capture_output=True, text=True, preexec_fn=limit,
                                    env=environment, timeout=60)
        except PermissionError:
            self.skipTest("nobody may not run the programs here")
        self.assertIn(result.returncode, (0, 4), result.stderr)
        if result.returncode == 4:
            last = result.stderr.strip().splitlines()[-1]
            self.assertTrue(last.startswith("error: cannot start a thread"), result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
