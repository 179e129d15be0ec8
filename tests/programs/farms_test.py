#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what render farms need: their lines of progress, frame lists that are too long, job bundles of Open Job
Description, and scripts for the arrays of batch systems.

usage: farms_test.py LFRENDERER LFPREPROCESSOR LFSUBMIT
"""
import json
import os
import signal
import subprocess
import sys
import unittest

import cluster_test_case
import openjd
from cluster_test_case import ClusterTestCase, digests

NUMBERS = {  # the variable of each batch system, and the number of its first task
    "SLURM_ARRAY_TASK_ID": 0, "PBS_ARRAY_INDEX": 0, "PBS_ARRAYID": 0, "SGE_TASK_ID": 1, "LSB_JOBINDEX": 1,
    "JOB_COMPLETION_INDEX": 0, "AWS_BATCH_JOB_ARRAY_INDEX": 0,
}
LAST_FRAMES = ("frame_0008.exr", "frame_0009.exr")  # of the nine frames of the path
OFTEN = ["--threads", 1, "--", "--dump-every", "0.001s"]  # packages get a checkpoint with their first LF images


class ProgressTest(ClusterTestCase):
    def render(self, *options, code=0):
        result = self.call(cluster_test_case.RENDERER, self.field, self.path, "-o", self.film, *options)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.splitlines()

    def test_farms_get_their_lines(self):
        for style, line in (("openjd", "openjd_progress: 100.0"), ("deadline", "Progress: 100%"),
                            ("alfred", "ALF_PROGRESS 100%")):
            self.assertIn(line, self.render("--progress", style, "--overwrite", "--frames", 1))

    def test_a_failure_is_told_to_the_farm(self):
        lines = self.render("--progress", "openjd", "--frames", "1-99", code=2)
        fault, = [line for line in lines if line.startswith("openjd_fail: ")]
        self.assertIn("--frames", fault)
        self.assertTrue(lines[-1].startswith("error: "))
        self.assertFalse([line for line in self.render("--progress", "alfred", "--frames", "1-99", code=2)
                          if line.startswith("ALF_PROGRESS")])

    def test_steps_may_follow_a_colon(self):
        self.render("--frames", "1-9:4")
        self.assertEqual(sorted(digests(self.film)), ["frame_0001.exr", "frame_0005.exr", "frame_0009.exr"])

    def test_frames_beyond_the_end_can_be_left_out(self):
        self.assertIn("1 to 9", self.render("--frames", "8-12", code=2)[-1])
        self.render("--frames", "8-12", "--clamp-frames")
        self.assertEqual(sorted(digests(self.film)), ["frame_0008.exr", "frame_0009.exr"])

    def test_nothing_is_rendered_if_no_frame_is_left(self):
        for inputs in ([self.field, self.path], self.package_files):
            result = self.call(cluster_test_case.RENDERER, *inputs, "-o", self.film, "--frames", "10-20",
                               "--clamp-frames", "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("nothing is rendered", result.stderr)
            self.assertEqual(json.loads(result.stdout)["frames"], [])
            self.assertFalse(self.film.exists())


class ClampedTest(ClusterTestCase):
    """--clamp-frames of the other programs that choose frames of a path."""

    def preprocess(self, *words, code=0):
        result = self.call(cluster_test_case.PREPROCESSOR, self.field, self.path, *words)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def test_packages_of_a_chunk_that_is_too_long(self):
        out = self.folder / "packages"
        self.assertIn("1 to 9", self.preprocess("-o", out, "--frames", "8-12", code=2).stderr)
        self.preprocess("-o", out, "--frames", "8-12", "--clamp-frames")
        package, = out.glob("*.lfp")
        self.assertIn("-of-frames-8-9", package.name)
        self.succeeds(cluster_test_case.RENDERER, package, "-o", self.film, "-q")
        self.assertEqual(digests(self.film), {name: self.expected[name] for name in LAST_FRAMES})

    def test_nothing_is_selected_if_no_frame_is_left(self):
        out = self.folder / "packages"
        for words in (["-o", out], ["-o", out, "--overwrite"], ["--plan"]):
            result = self.preprocess(*words, "--frames", "10-20", "--clamp-frames", "--json")
            self.assertIn("beyond the end of the path: nothing is selected", result.stderr)
            self.assertEqual(json.loads(result.stdout)["packages"], [])
            self.assertEqual(json.loads(result.stdout)["lf_images"], 16)
            result = self.preprocess(*words, "--frames", "10-20", "--clamp-frames")
            self.assertEqual(result.stdout, "")
        self.assertFalse(out.exists())

    def test_a_job_of_a_chunk_that_is_too_long(self):
        self.submit("--frames", "8-12", code=2, words=["1 to 9"])
        self.submit("--frames", "8-12", "--clamp-frames")
        self.assertEqual(digests(self.film), {name: self.expected[name] for name in LAST_FRAMES})

    def test_nothing_is_submitted_if_no_frame_is_left(self):
        self.assertIn("nothing is submitted", self.submit("--frames", "10-20", "--clamp-frames"))
        said = self.succeeds(cluster_test_case.SUBMIT, *self.package_files, "-o", self.film, "--frames", "10-20",
                             "--clamp-frames", "--json")
        self.assertEqual(json.loads(said)["packages"], [])
        self.assertFalse(self.film.exists())

    def test_frames_are_clamped_for_new_jobs_by_lfsubmit_alone(self):
        self.submit("--frames", "8-12", "--", "--clamp-frames", code=2, words=["--clamp-frames"])
        self.fails(2, ["--clamp-frames", "new jobs"], cluster_test_case.SUBMIT, "--resume", self.film, "--clamp-frames")


class FarmTestCase(ClusterTestCase):
    def bundle(self, *options):
        bundle = self.folder / "bundle"
        self.submit("--engine", "openjd", "--write", bundle, *options, words=["template.yaml"])
        return openjd.read_template(bundle / "template.yaml")

    def run_all(self, steps):
        for step in steps:
            for task in step:
                task.start()
            for task in step:
                self.assertEqual(task.end(), 0, (task.failure, task.statuses))

    def scripts(self, *options):
        scripts = self.folder / "scripts"
        self.submit("--engine", "array", "--write", scripts, *options, words=["packages.sh", "3 tasks"])
        return scripts

    def run_task(self, scripts, *arguments, code=0, **variables):
        environment = {name: value for name, value in os.environ.items()
                       if name not in NUMBERS and name != "_CONDOR_JOB_AD"}
        done = subprocess.run([scripts / "packages.sh", *arguments], env={**environment, **variables},
                              capture_output=True, text=True, timeout=400)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr


class OpenJdTest(FarmTestCase):
    def test_a_template_renders_the_film(self):
        steps = openjd.tasks_of(self.bundle("--threads", 1))
        self.assertEqual([len(step) for step in steps], [3, 1])
        self.run_all(steps)
        self.assertEqual(digests(self.film), self.expected)
        self.assertTrue((self.film / "contact_sheet.png").exists())
        for task in sum(steps, []):
            self.assertEqual(task.progress[-1], 100)
            self.assertIsNone(task.failure)
        self.assertEqual(self.status()["state"], "done")

    def test_a_resumed_job_has_only_the_packages_that_are_not_done(self):
        packages, _ = openjd.tasks_of(self.bundle())
        self.run_all([packages[:2]])
        self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film)
        packages, film = openjd.tasks_of(
            openjd.read_template(self.film / "cluster" / "openjd" / "template.yaml"))
        self.assertEqual([task.values["Task.Param.Package"] for task in packages], ["2"])
        self.run_all([packages, film])
        self.assertEqual(digests(self.film), self.expected)

    def test_a_film_with_a_fault_that_may_be_is_no_failure(self):
        packages, film = openjd.tasks_of(self.bundle("--", "--require", "noise<=0.0000001"))
        self.run_all([packages, film])
        self.assertIn("with faults", film[0].statuses[-1])

    def test_a_failure_fails_its_task(self):
        renderer = self.unlucky_renderer("[[ $package == package-0001 ]] && { echo error: no luck >&2; exit 3; }")
        packages, film = openjd.tasks_of(self.bundle("--lfrenderer", renderer))
        for task in packages:
            task.start()
        self.assertEqual([task.end() for task in packages], [0, 3, 0])
        self.assertIn("no luck", packages[1].failure)
        film[0].start()
        self.assertEqual(film[0].end(), 3)

    def test_the_interpreter_refuses_what_the_specification_does(self):
        path = self.folder / "bundle" / "template.yaml"
        self.bundle()
        text = path.read_text()
        for good, bad in (("notifyPeriodInSeconds: 120", "notifyPeriodInSeconds: 601"), ('"0-2"', '"0-2,2"'),
                          ("dependsOn: Packages", "dependsOn: Nothing"), ("NOTIFY_THEN_TERMINATE", "ASK"),
                          ("dataFlow: NONE", "dataflow: NONE"), ("jobtemplate-2023-09", "jobtemplate-2022-09")):
            self.assertIn(good, text)
            path.write_text(text.replace(good, bad, 1))
            with self.assertRaises(openjd.TemplateFault, msg=bad):
                openjd.read_template(path)

    def test_options_of_other_engines_are_refused(self):
        for options, words in ((["--engine", "openjd", "--jobs", 2], ["--jobs", "leave them out"]),
                               (["--engine", "array", "--wait"], ["--wait"]),
                               (["--engine", "array", "--sbatch=--x"], ["--sbatch", "slurm"]),
                               (["--write", "x"], ["--write", "--engine openjd"])):
            self.submit(*options, code=2, words=words)
        self.film = self.folder / "{{x}}"
        self.submit("--engine", "openjd", code=2, words=["{{", "another name"])


class ArrayTest(FarmTestCase):
    def test_every_batch_system_renders_each_package_once(self):
        scripts = self.scripts()
        started = 0
        for variable, first in NUMBERS.items():
            for number in range(3):
                self.run_task(scripts, **{variable: str(first + number)})
            self.succeeds(scripts / "finish.sh")
            self.assertEqual(digests(self.film), self.expected, variable)
            started += 1
            states = [json.loads(path.read_text()) for path in
                      sorted((self.film / "cluster" / "packages").glob("*.json"))]
            self.assertEqual([state["starts"] for state in states], [started] * 3, variable)
            for path in self.film.glob("frame_*"):
                path.unlink()

    def test_htcondor_gives_an_argument_or_a_description_of_the_job(self):
        scripts = self.scripts()
        self.run_task(scripts, "0")
        description = self.folder / ".job.ad"
        for number in (1, 2):
            description.write_text(f"ClusterId = 17\nProcId = {number}\nMyType = \"Job\"\n")
            self.run_task(scripts, _CONDOR_JOB_AD=str(description))
        self.assertEqual(digests(self.film), self.expected)

    def test_a_script_without_a_number_renders_nothing(self):
        for variables in ({}, {"SGE_TASK_ID": "undefined"}, {"LSB_JOBINDEX": "0"}):
            self.assertIn("no number of a package", self.run_task(self.scripts("--overwrite"), code=2, **variables))
        self.assertIn("0 to 2", self.run_task(self.folder / "scripts", "3", code=2))
        self.assertFalse(digests(self.film))


class InterruptedTest(FarmTestCase):
    """Tests packages of some seconds that are interrupted."""
    frames = 6
    side, pitch = 12, 0.004
    resolution = [320, 240]

    def test_a_task_that_is_cancelled_resumes_from_its_checkpoint(self):
        packages, film = openjd.tasks_of(self.bundle("--lfrenderer", self.held_renderer([1]), *OFTEN))
        held = packages[1]
        held.start()
        self.wait_for(lambda: self.is_held(1))
        held.cancel()
        self.assertEqual(held.end(), 5)
        self.assertIn("interrupted", held.failure)
        self.assertEqual(self.status()["packages"][1]["state"], "interrupted")
        self.run_all([packages, film])  # a farm starts the task again
        self.assertEqual(digests(self.film), self.expected)
        log = (self.film / "cluster" / "packages" / "package-0001.log").read_text()
        self.assertRegex(log, r"continuing: \d frames are finished, \d begun")

    def test_signals_of_batch_systems_write_the_state(self):
        for sign in (signal.SIGTERM, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU):
            scripts = self.scripts("--overwrite", "--lfrenderer", self.held_renderer([2]), *OFTEN)
            process = subprocess.Popen([scripts / "packages.sh", "2"], stderr=subprocess.PIPE, text=True,
                                       start_new_session=True)
            self.wait_for(lambda: self.is_held(2))
            os.killpg(process.pid, sign)  # Grid Engine sends signals to all processes of a task
            process.communicate()
            self.assertEqual(process.returncode, 5, sign)
            state = json.loads((self.film / "cluster" / "packages" / "package-0002.json").read_text())
            self.assertEqual((state["phase"], state["crashes"]), ("interrupted", 0))
            for number in range(3):
                self.run_task(scripts, str(number))
            self.assertEqual(digests(self.film), self.expected)
            subprocess.run(["rm", "-r", self.folder / "starts"], check=True)


if __name__ == "__main__":
    cluster_test_case.take_programs()
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
