#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests two programs that write into one folder at the same time: one wins, or they work one after the other, and their
files are never mixed.

usage: writers_test.py FOLDER_OF_PROGRAMS
"""
import pathlib
import subprocess
import sys
import time
import unittest

from writers_case import WritersCase

WritersCase.programs = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
ATTEMPTS = 2


class WritersTest(WritersCase):
    def race(self, program, *more, may_refuse=()):
        """Starts the ways "a" and "b" one shortly after the other; the files must be those of one of them.

        may_refuse  words that a program with exit code 2 may print, because the other program has ended before it began
        """
        expected = {way: self.expect(program, way) for way in "ab"}
        self.assertNotEqual(expected["a"], expected["b"])
        for attempt in range(ATTEMPTS):
            out = self.folder / f"{program}{attempt}"
            out.mkdir()
            processes = {}
            for way in "ab" if attempt % 2 else "ba":
                processes[way] = subprocess.Popen(self.command(program, way, out, *more), stdout=subprocess.DEVNULL,
                                                  stderr=subprocess.PIPE, text=True)
                time.sleep(0.03 * attempt)
            said = {way: process.communicate(timeout=240)[1] for way, process in processes.items()}
            codes = {way: process.returncode for way, process in processes.items()}
            winners = [way for way in "ab" if codes[way] == 0]
            self.assertTrue(winners, said)
            for way in set("ab") - set(winners):
                last = said[way].strip().splitlines()[-1]
                self.assertTrue(last.startswith("error: "), last)
                if codes[way] == 2 and may_refuse:
                    self.assertTrue(any(words in last for words in may_refuse), last)
                    continue
                self.assertEqual(codes[way], 4, said)
                self.assertIn(f"process {processes[winners[0]].pid}", last)
            self.assertIn(self.files(program, out), [expected[way] for way in winners], said)
            self.assertEqual(self.leftovers(out), [])
            locks = [path for path in out.rglob("*lock") if path != out / "cluster" / "lock" and
                     path.parent != out / "cluster" / "packages" and path != out / "cluster" / "finish.lock"]
            self.assertEqual(locks, [])

    def test_lfrenderer(self):
        self.race("lfrenderer", may_refuse=["exists already", "unfinished"])

    def test_lfpreprocessor(self):
        self.race("lfpreprocessor", may_refuse=["contains 2 packages"])
        self.race_again("lfpreprocessor")

    def race_again(self, program):
        self.doCleanups()
        self.setUp()
        self.race(program, "--overwrite")

    def test_lfmerge(self):
        self.race("lfmerge", "--overwrite")

    def test_lfquilt(self):
        self.race("lfquilt", "--overwrite")

    def test_lfcompressor(self):
        self.race("lfcompressor", "--overwrite")

    def test_lfdensify(self):
        self.race("lfdensify", "--overwrite")

    def test_lfsynth(self):
        self.race("lfsynth")

    def test_lfimport(self):
        self.race("lfimport")

    def test_lfexample(self):
        self.race("lfexample")

    def test_lfsubmit(self):
        self.race("lfsubmit", "--overwrite")

    def test_a_submission_beside_one_that_goes_on(self):
        out = self.folder / "film"
        out.mkdir()
        subprocess.run(self.command("lfsubmit", "a", out), check=True, stderr=subprocess.DEVNULL)
        next(out.glob("frame_*")).unlink()
        resume = subprocess.Popen([self.programs / "lfsubmit", "--resume", out], stderr=subprocess.PIPE, text=True)
        submit = subprocess.Popen(self.command("lfsubmit", "b", out, "--overwrite"), stderr=subprocess.PIPE, text=True)
        said = [process.communicate(timeout=240)[1] for process in (resume, submit)]
        self.assertIn(4 * (resume.returncode == 4) + 4 * (submit.returncode == 4), (0, 4), said)
        self.assertIn(0, (resume.returncode, submit.returncode), said)
        way = "b" if submit.returncode == 0 else "a"
        self.assertEqual(self.files("lfsubmit", out), self.expect("lfsubmit", way), said)
        self.assertEqual(self.leftovers(out), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
