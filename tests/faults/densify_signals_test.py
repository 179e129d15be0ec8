#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that lfdensify heeds SIGTERM in each of its steps: it ends soon, says in which step and how to continue, and
--resume ends with the bits of a run that nobody interrupted. The processor time after the signal is measured, because
other tests run on the machine at the same time.

usage: densify_signals_test.py LFDENSIFY LFSYNTH
"""
import json
import signal
import sqlite3
import subprocess
import sys
import unittest

from processor_clock import Clock
from program_test_case import ProgramTestCase

DENSIFY = SYNTH = None
# The steps in their order. Progress is printed once a second, so that a short step may not be seen.
STEPS = ["checked LF images", "searched LF images", "compared pairs", "tests", "recorded LF images", "depths",
         "compared depths", "compared depths again", "stored depths", "virtual LF images"]
LONG = {"depths", "virtual LF images"}
MOST_CPU_S = 2


def contents(store):
    """Returns the encoded LF images and planes of a store."""
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        return (database.execute("select id, code, mask from blobs order by id").fetchall(),
                database.execute("select id, kind, plane from planes order by id, kind").fetchall())


class DensifySignalsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field = self.folder / "field"
        self.succeeds(SYNTH, "still-life", "-o", self.field, "--count", 36, "--size", "720x540", "--spacing", 0.02,
                      "--samples", 1, "--format", "png", "-q")

    def command(self, store):
        return [str(word) for word in (DENSIFY, self.field, "-o", store, "--divisor", 3, "--spacing", 2, "--most", 150,
                                       "--threads", 1, "--progress", "json", "--resume")]

    def seen(self, process, others):
        """Reads progress until a step that is not among the others; returns it, or None if the program ends before."""
        for line in process.stderr:
            if not line.startswith("{"):
                continue
            progress = json.loads(line)
            (step, (done, total)), = progress["counts"].items()
            self.assertIn(step, STEPS)
            self.assertLessEqual(done, total)
            self.assertLessEqual(progress["done"], progress["total"])
            if step not in others:
                return step
        return None

    def test_each_step_ends_soon_and_is_continued(self):
        store, steps = self.folder / "again.lfs", []
        while not store.exists():
            process = subprocess.Popen(self.command(store), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                       text=True)
            step = self.seen(process, steps)
            if step is None:
                process.communicate()
                self.assertEqual(process.returncode, 0)
                break
            clock = Clock(process.pid)
            before_s = clock.look()
            process.send_signal(signal.SIGTERM)
            while process.poll() is None and clock.look() - before_s <= MOST_CPU_S:
                pass
            cpu_s = sum(clock.known.values()) - before_s
            if process.poll() is None:
                process.kill()
            last = process.communicate()[1].strip().splitlines()[-1]
            print(step, f"{cpu_s:.2f} s", last, flush=True)
            self.assertLessEqual(cpu_s, MOST_CPU_S, step)
            self.assertEqual(process.returncode, 5, last)
            self.assertRegex(last, r"error: interrupted after \d+ of \d+ \(.*\): --resume continues")
            steps.append(step)
        self.assertGreaterEqual(set(steps), LONG)
        whole = self.folder / "whole.lfs"
        self.succeeds(*self.command(whole), "--cache", "none")
        self.assertEqual(contents(store), contents(whole))


if __name__ == "__main__":
    DENSIFY, SYNTH = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
