#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfsubmit with false programs sbatch, squeue and scancel in PATH, whose answers Slurm would never give. lfsubmit
must believe none of them and report this in one line.

usage: hostile_slurm_test.py LFPREPROCESSOR LFSUBMIT
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from bounded_runs import BoundedRuns
from small_field import write_field, write_path

PREPROCESSOR = SUBMIT = None
MEMORY_MIB = 544  # an answer of a program may take 256 MiB, and is copied once
GOOD = {"sbatch": "echo 17", "squeue": "true", "scancel": "true"}
# Answers of sbatch that cannot be the number of a job.
BAD_NUMBERS = {
    "nothing": "true",
    "an option": "echo --help",
    "a command": "echo '; touch owned'",
    "a number of a million digits": "head -c 1000000 /dev/zero | tr '\\0' 7",
    "a number below 0": "echo -17",
    "zeros": "head -c 1000 /dev/zero",
    "an end without a word": "exit 1",
    "an end with a forged last line": "printf 'no\\nerror: nothing\\n[done]\\n' >&2; exit 1",
    "an end with control characters": "printf '\\033[2J\\033]0;owned\\007\\r' >&2; exit 1",
    "an end by a signal": "kill -9 $$",
    "no end": "exec yes",
    "complaints without an end": "exec yes >&2",
    "a long complaint": "head -c 10000000 /dev/zero | tr '\\0' x >&2; exit 3",
}
# Answers of squeue about jobs.
BAD_QUEUES = {
    "no end": "exec yes '17|0|RUNNING|node|None'",
    "numbers out of range": "echo '17|99999999999999999999|RUNNING|node|None'",
    "numbers below 0": "echo '17|-1|RUNNING|node|None'",
    "other jobs": "echo '18|0|RUNNING|node|None'; echo '--help|0|RUNNING|node|None'",
    "forged lines": "printf '17|0|RUNNING|a\\033[2Jerror: b\\r|c\\n'",
    "no fields": "printf 'x\\n\\n|||||||\\n'",
    "zeros": "head -c 1000000 /dev/zero",
    "an end without a word": "exit 9",
    "an end by a signal": "kill -9 $$",
    "a long complaint": "head -c 10000000 /dev/zero | tr '\\0' x >&2; exit 3",
}


class HostileSlurmTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        subprocess.run([PREPROCESSOR, write_field(cls.folder / "field"), write_path(cls.folder, frames=2), "-o",
                        cls.folder / "packages", "--packages", "2"], check=True, capture_output=True)
        cls.packages = sorted((cls.folder / "packages").glob("*.lfp"))
        cls.runs = BoundedRuns(cls.folder, MEMORY_MIB)

    @classmethod
    def tearDownClass(cls):
        print(cls.runs.table(), file=sys.stderr)

    def tearDown(self):
        faults, self.runs.faults[:] = list(self.runs.faults), []
        self.assertEqual([], faults, "\n".join(faults))
        self.assertFalse(list(self.folder.rglob("owned")))

    def environment(self, **scripts):
        """Returns an environment with a Slurm made of these scripts."""
        programs = pathlib.Path(tempfile.mkdtemp(prefix="slurm ", dir=self.folder))
        for name, script in {**GOOD, **scripts}.items():
            (programs / name).write_text(f"#!/bin/sh\n{script}\n")
            (programs / name).chmod(0o755)
        return {"PATH": f"{programs}:{os.environ['PATH']}"}

    def submitted(self, name):
        return [SUBMIT, *self.packages, "-o", self.folder / name, "--engine", "slurm"]

    def expect_plain_words(self, runs):
        for run in runs:
            lines = run.errors.splitlines()
            self.assertFalse([line for line in lines[:-1] if line.startswith("error: ")], run.errors[:500])
            self.assertNotRegex(run.errors, "[\x00-\x08\x0b-\x1f]")
            self.assertLess(len(run.errors), 10_000)

    def test_a_good_one_is_believed(self):
        self.runs.all("good", [("good", self.submitted("good"), self.environment())], accepts=(0,))
        job = json.loads((self.folder / "good" / "cluster" / "job.json").read_text())
        self.assertEqual(job["slurm_arrays"], ["17"])

    def test_only_numbers_of_jobs_are_taken_from_sbatch(self):
        self.expect_plain_words(self.runs.all("sbatch", [
            (name, self.submitted(f"sbatch {name}"), self.environment(sbatch=script))
            for name, script in BAD_NUMBERS.items()], accepts=(4,)))
        for name in BAD_NUMBERS:
            job = self.folder / f"sbatch {name}" / "cluster" / "job.json"
            if job.exists():
                self.assertEqual(json.loads(job.read_text())["slurm_arrays"], [], name)

    def test_queues_are_not_believed(self):
        submitted = []
        for name in BAD_QUEUES:
            subprocess.run(list(map(str, self.submitted(f"squeue {name}"))), check=True, capture_output=True,
                           env={**os.environ, **self.environment()})
            submitted.append((name, self.folder / f"squeue {name}"))
        self.expect_plain_words(self.runs.all("squeue, --status", [
            (name, [SUBMIT, "--status", folder], self.environment(squeue=BAD_QUEUES[name]))
            for name, folder in submitted], accepts=(0, 4)))


if __name__ == "__main__":
    PREPROCESSOR, SUBMIT = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
