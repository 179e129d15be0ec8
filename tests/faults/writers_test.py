#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests two programs that write into one folder at the same time: one wins, or they work one after the other, and their
files are never mixed.

usage: writers_test.py FOLDER_OF_PROGRAMS
"""
import pathlib
import re
import subprocess
import sys
import time
import unittest

from writers_case import KINDS, VARIANTS, WritersCase

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

    def race_again(self, program):
        self.doCleanups()
        self.setUp()
        self.race(program, "--overwrite")

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


# Words that the second call may say if the first ended before it began. Calls that are not named here get --overwrite.
MAY_REFUSE = {"lfrenderer": ["exists already", "unfinished"], "lfpreprocessor": ["contains 2 packages"],
              "lfsynth": ["exists already"], "lfvisualizer": ["exists already"], "lffocus views": ["exists already"],
              "lfimport": []}


def test_of(call):
    def test(self):
        if call not in self.calls():
            self.skipTest(f"{call} is not built")
        more = [] if call in MAY_REFUSE else ["--overwrite"]
        self.race(call, *more, may_refuse=MAY_REFUSE.get(call, ()))
        if call in ("lfpreprocessor", "lfsynth", "lffocus views"):
            self.race_again(call)
    return test


for name in [*KINDS, *(f"{name}, {variant}" for name, variants in VARIANTS.items() for variant in variants)]:
    setattr(WritersTest, "test_" + re.sub(r"\W+", "_", name), test_of(name))

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
