#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfsubmit --engine slurm on a cluster of four nodes on this machine (private_slurm.py): nodes and processes die,
and the frames are those of one lfrenderer.

usage: slurm_test.py LFRENDERER LFPREPROCESSOR LFSUBMIT       (exit code 77: no Slurm is installed)
"""
import json
import os
import pathlib
import signal
import sys
import tempfile
import unittest

import cluster_test_case
from cluster_test_case import ClusterTestCase, digests
from private_slurm import PrivateSlurm, missing


class SlurmTest(ClusterTestCase):
    packages = 8
    frames = 16
    side, pitch = 12, 0.004
    resolution = [640, 480]
    OPTIONS = ("--engine", "slurm", "--memory", "1G")
    ARGUMENTS = ("--", "--dump-every", "0.05s")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.slurm = PrivateSlurm(pathlib.Path(temporary.name) / "slurm")
        cls.addClassCleanup(cls.slurm.stop)
        os.environ["SLURM_CONF"] = str(cls.slurm.configuration)

    def tearDown(self):
        for job in self.slurm.call("squeue", "-h", "-o", "%F").split():
            self.slurm.call("scancel", job)
        self.wait_for(lambda: self.slurm.call("squeue", "-h") == "")

    def package(self, number):
        return self.status()["packages"][number]

    def begun(self, number):
        """Waits until a package has a checkpoint and its renderer is held, and returns the state of the package."""
        self.wait_for(lambda: self.is_held(number))
        name = f"package-{number:04d}.json"
        return json.loads((self.film / "cluster" / "packages" / name).read_text())

    # A node is cut off, a renderer and an lfsubmit are killed, and a renderer is asked to end. One call waits for the
    # film, whose frames are those of one lfrenderer.
    def test_the_film_survives_a_node_and_processes(self):
        process = self.start(*self.OPTIONS, "--wait", "--video", self.folder / "film.mp4",
                             "--lfrenderer", self.held_renderer(range(4)), *self.ARGUMENTS)
        first = self.begun(0)
        node = int(first["node"].removeprefix("n"))
        self.slurm.kill_node(node)
        self.addCleanup(self.slurm.start_node, node)
        os.kill(self.begun(1)["process"], signal.SIGKILL)
        os.kill(self.begun(2)["process"], signal.SIGTERM)
        runner = pathlib.Path("/proc", str(self.begun(3)["process"]), "status").read_text()
        os.kill(int(runner.split("PPid:")[1].split()[0]), signal.SIGKILL)
        status = self.status()
        self.assertEqual(status["state"], "running")
        self.assertEqual(status["packages"][7]["queue"], "PENDING")
        error = process.communicate(timeout=240)[1]
        self.assertEqual(process.returncode, 0, error)
        self.assertEqual(digests(self.film), self.expected)
        status = self.status()
        self.assertEqual(status["state"], "done")
        self.assertEqual([package["state"] for package in status["packages"]], ["done"] * 8)
        restarts = [package["restarts"] for package in status["packages"]]
        self.assertEqual([count > 0 for count in restarts], [True] * 4 + [False] * 4, restarts)
        crashes = [package["crashes"] for package in status["packages"]]
        self.assertEqual(crashes, [1, 1, 0, 1, 0, 0, 0, 0])
        for number in range(4):
            log = self.film / "cluster" / "packages" / f"package-{number:04d}.log"
            self.assertRegex(log.read_text(), r"continuing: \d frames are finished, \d begun")
        self.assertNotEqual(status["packages"][0]["node"], first["node"])
        self.assertGreater((self.folder / "film.mp4").stat().st_size, 1000)
        self.assertTrue((self.film / "contact_sheet.png").exists())

    # The signal is the one of a time limit: the batch script passes it on, and its task is requeued.
    def test_what_is_told_to_end_is_requeued(self):
        process = self.start(*self.OPTIONS, "--wait", "--lfrenderer", self.held_renderer([0]),
                             *self.ARGUMENTS)
        self.wait_for(lambda: self.is_held(0))
        array = json.loads((self.film / "cluster" / "job.json").read_text())["slurm_arrays"][0]
        self.slurm.call("scancel", "--batch", "--signal=TERM", f"{array}_0")
        self.wait_for(lambda: self.package(0)["restarts"] > 0 or
                      self.package(0).get("queue") == "PENDING")
        error = process.communicate(timeout=240)[1]
        self.assertEqual(process.returncode, 0, error)
        self.assertEqual(digests(self.film), self.expected)
        # Two restarts if lfrenderer got the signal before its lfsubmit.
        self.assertIn(self.package(0)["restarts"], (1, 2))
        self.assertEqual(self.package(0)["crashes"], 0)

    def test_a_job_is_cancelled_and_gone_on_with(self):
        self.submit(*self.OPTIONS, "--lfrenderer", self.held_renderer([0]), *self.ARGUMENTS,
                    words=["submitted 8 packages", "--status"])
        self.wait_for(lambda: self.is_held(0))
        table = self.succeeds(cluster_test_case.SUBMIT, "--status", self.film)
        self.assertIn("waiting for", table)
        self.succeeds(cluster_test_case.SUBMIT, "--cancel", self.film)
        self.assertEqual(self.slurm.call("squeue", "-h"), "")
        status = self.status()
        self.assertEqual((status["state"], status["cancelled"]), ("interrupted", True))
        self.assertLess(status["frames_done"], self.frames)
        self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film, "--wait")
        self.assertEqual(digests(self.film), self.expected)

    # A user's scancel also ends tasks, but must not be mistaken for a time limit.
    def test_what_is_removed_from_the_queue_stays_away(self):
        process = self.start(*self.OPTIONS, "--wait", "--lfrenderer", self.held_renderer([0]),
                             *self.ARGUMENTS)
        self.wait_for(lambda: self.is_held(0))
        array = json.loads((self.film / "cluster" / "job.json").read_text())["slurm_arrays"][0]
        self.slurm.call("scancel", array)
        error = process.communicate(timeout=240)[1]
        self.assertEqual(process.returncode, 5, error)
        last = error.strip().splitlines()[-1]
        for word in ("not all packages are done", "package-0007", "--resume"):
            self.assertIn(word, last)
        self.assertEqual(self.slurm.call("squeue", "-h"), "")
        self.assertEqual(self.status()["state"], "interrupted")
        self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film, "--wait")
        self.assertEqual(digests(self.film), self.expected)

    def test_the_finishing_task_fails_where_a_package_has(self):
        renderer = self.unlucky_renderer("""
            [[ $package == package-0005 ]] && { echo "error: broken" >&2; exit 3; }""")
        self.submit(*self.OPTIONS, "--wait", "--lfrenderer", renderer, code=3,
                    words=["package-0005", "frames 11-12", "broken"])
        self.assertEqual(len(digests(self.film)), self.frames - 2)
        self.assertEqual(self.status()["finishing"]["state"], "failed")

    def test_what_slurm_refuses_is_told(self):
        self.submit(*self.OPTIONS, "--sbatch=--partition=no-such", code=4,
                    words=["sbatch failed", "partition"])
        self.assertFalse((self.film / "cluster" / "job.json").exists())
        self.assertEqual(self.slurm.call("squeue", "-h"), "")


if __name__ == "__main__":
    cluster_test_case.take_programs()
    if missing():
        print(f"SKIPPED: missing: {', '.join(missing())}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
