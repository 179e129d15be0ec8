#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfsubmit on one machine: processes of packages die, fail, are interrupted, cancelled and resumed; the frames
are always those of one lfrenderer.

usage: lfsubmit_test.py LFRENDERER LFPREPROCESSOR LFSUBMIT
"""
import json
import os
import shutil
import signal
import subprocess
import sys
import unittest

import cluster_test_case
from cluster_test_case import ClusterTestCase, digests


class LocalJobTest(ClusterTestCase):
    def test_the_frames_are_those_of_one_render(self):
        self.submit("--jobs", 2, "--video", self.folder / "film.mp4")
        self.assertEqual(digests(self.film), self.expected)
        self.assertGreater((self.folder / "film.mp4").stat().st_size, 1000)
        self.assertTrue((self.film / "contact_sheet.png").exists())
        self.assertFalse((self.film / "partial").exists())
        report = json.loads((self.film / "cluster" / "report.json").read_text())
        self.assertEqual([frame["frame"] for frame in report["frames"]], list(range(1, 10)))
        status = self.status()
        self.assertEqual(status["state"], "done")
        self.assertEqual(status["frames_done"], 9)
        for package in status["packages"]:
            self.assertEqual((package["state"], package["frames_done"], package["share"],
                              package["restarts"]), ("done", 3, 1, 0))
        table = self.succeeds(cluster_test_case.SUBMIT, "--status", self.film)
        for words in ("3 of 3 packages done; 9 of 9 frames, 100 %", "package-0002", "finish"):
            self.assertIn(words, table)

    def test_arguments_of_lfrenderer_follow_two_dashes(self):
        self.submit("--frames", "2-7x2", "--", "--format", "png16", "--lens-weights", "none")
        self.assertEqual(sorted(digests(self.film)),
                         ["frame_0002.png", "frame_0004.png", "frame_0006.png"])
        self.assertEqual(self.status()["frames"], 3)

    def test_what_dies_or_is_interrupted_is_begun_again(self):
        renderer = self.unlucky_renderer("""
            [[ $package == package-0000 && $start == 1 ]] && kill -9 $$
            [[ $package == package-0000 && $start == 2 ]] && exit 5
            [[ $package == package-0002 && $start == 1 ]] && kill -SEGV $$""")
        self.submit("--jobs", 2, "--lfrenderer", renderer)
        self.assertEqual(digests(self.film), self.expected)
        packages = self.status()["packages"]
        self.assertEqual([package["restarts"] for package in packages], [2, 0, 1])
        self.assertEqual([package["crashes"] for package in packages], [1, 0, 1])

    def test_what_fails_is_named_and_costs_no_other(self):
        renderer = self.unlucky_renderer("""
            [[ $package == package-0001 ]] && { echo "error: the disk is on fire" >&2; exit 3; }""")
        self.submit("--lfrenderer", renderer, code=3,
                    words=["package-0001", "frames 4-6", "failed", "the disk is on fire",
                           "--resume"])
        self.assertEqual(len(digests(self.film)), 6)
        self.assertFalse((self.film / "contact_sheet.png").exists())
        status = self.status()
        self.assertEqual(status["state"], "failed")
        self.assertEqual([package["state"] for package in status["packages"]],
                         ["done", "failed", "done"])
        self.assertEqual(status["packages"][1]["exit_code"], 3)
        self.assertIn("disk is on fire", status["packages"][1]["message"])
        self.unlucky_renderer("")  # repaired
        before = (self.film / "frame_0001.exr").stat().st_mtime_ns
        self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film)
        self.assertEqual(digests(self.film), self.expected)
        self.assertEqual((self.film / "frame_0001.exr").stat().st_mtime_ns, before)
        self.assertEqual(self.status()["state"], "done")

    def break_images(self, *indices):
        """Breaks these images until the test ends."""
        for index in indices:
            image = self.field.parent / f"image_{index:02d}.png"
            whole = image.read_bytes()
            image.write_bytes(whole[:900])
            self.addCleanup(image.write_bytes, whole)

    def test_images_that_are_left_out_end_it_with_6_and_cost_no_retry(self):
        self.break_images(5, 10)
        last = self.submit("--jobs", 2, code=6,
                           words=["error: 2 LF images were left out", "2 of 16 in package-0000",
                                  "2 of 16 in package-0002", "--allow-missing 2", "--resume"])
        self.assertEqual(len(digests(self.film)), 9)
        self.assertTrue((self.film / "contact_sheet.png").exists())
        report = json.loads((self.film / "cluster" / "report.json").read_text())
        self.assertEqual(report["lf_images_skipped"], 2)
        status = self.status()
        self.assertEqual((status["state"], status["finishing"]["exit_code"]), ("done", 6))
        for package in status["packages"]:
            self.assertEqual((package["state"], package["exit_code"], package["restarts"]),
                             ("done", 6, 0))
            self.assertIn("2 of 16 LF images were left out", package["message"])
        # The exit code stays until somebody accepts the loss; the packages are not rendered again.
        submit = cluster_test_case.SUBMIT
        self.fails(6, [last.split(";")[0].removeprefix("error: ")], submit, "--resume", self.film)
        self.fails(6, ["2 LF images"], submit, "--resume", self.film, "--", "--allow-missing", 1)
        self.succeeds(submit, "--resume", self.film, "--", "--allow-missing", 2)
        status = self.status()
        self.assertEqual(status["finishing"]["exit_code"], 0)
        self.assertEqual([package["restarts"] for package in status["packages"]], [0, 0, 0])
        self.succeeds(submit, "--resume", self.film)

    def test_images_that_are_left_out_may_be_accepted_beforehand(self):
        self.break_images(5, 10)
        result = self.call(cluster_test_case.SUBMIT, *self.package_files, "-o", self.film, "--",
                           "--allow-missing", "13%")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: 2 LF images were left out", result.stderr)
        self.assertEqual([package["exit_code"] for package in self.status()["packages"]], [0, 0, 0])
        self.submit("--overwrite", "--json", "--", "--allow-missing", "12%", code=6)
        self.submit("--overwrite", "--", "--allow-missing", "2 %", code=2,
                    words=["--allow-missing 2 %"])

    def test_the_end_of_the_finishing_task_is_that_of_the_film(self):
        for code, phase in ((4, "failed"), (3, "failed"), (1, "failed"), (6, "done"),
                            (5, "interrupted")):
            renderer = self.unlucky_renderer(
                f"[[ $package == finish ]] && {{ echo 'error: so it ends' >&2; exit {code}; }}")
            self.submit("--overwrite", "--lfrenderer", renderer, code=code, words=["so it ends"])
            finishing = self.status()["finishing"]
            self.assertEqual((finishing["exit_code"], finishing["state"]), (code, phase))
            self.assertEqual(digests(self.film), self.expected)

    def test_what_always_dies_has_failed(self):
        renderer = self.unlucky_renderer("[[ $package == package-0001 ]] && kill -9 $$")
        self.submit("--lfrenderer", renderer, "--crashes", 2, code=4,
                    words=["package-0001", "crashed 3 times", "signal 9"])
        self.assertEqual((self.folder / "starts" / "package-0001").read_text().count("\n"), 3)

    def test_below_what_was_asked_for_is_told_and_complete(self):
        last = self.submit("--video", self.folder / "film.mp4", "--", "--require", "samples>=9999",
                           code=6, words=["9999"])
        self.assertTrue(last.startswith("error: "))
        self.assertEqual(len(digests(self.film)), 9)
        self.assertTrue((self.folder / "film.mp4").exists())
        self.assertEqual(self.status()["state"], "done")

    # On resume, a job can get more memory or run one process at a time.
    def test_what_a_job_gets_may_change_when_it_goes_on(self):
        renderer = self.unlucky_renderer("""
            [[ "$*" == *"--memory 1073741824"* ]] || { echo "error: too little" >&2; exit 4; }""")
        self.submit("--memory", "512M", "--lfrenderer", renderer, code=4, words=["too little"])
        self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film, "--memory", "1G")
        self.assertEqual(digests(self.film), self.expected)
        self.fails(2, ["--time-limit", "slurm"], cluster_test_case.SUBMIT, "--resume", self.film,
                   "--time-limit", "1h")

    def test_a_job_may_become_strict_and_lose_its_contact_sheet_when_it_goes_on(self):
        submit = cluster_test_case.SUBMIT
        renderer = self.unlucky_renderer("[[ $package == package-0001 ]] && exit 3")
        self.submit("--lfrenderer", renderer, code=3)
        self.unlucky_renderer("")
        self.succeeds(submit, "--resume", self.film, "--no-contact-sheet")
        self.assertEqual(digests(self.film), self.expected)
        self.assertFalse((self.film / "contact_sheet.png").exists())
        self.break_images(5, 10)
        (self.film / "frame_0001.exr").unlink()
        self.succeeds(submit, "--resume", self.film, code=6)
        # When a film is done, --strict judges its LF images again.
        self.fails(3, ["--strict"], submit, "--resume", self.film, "--strict")

    def test_packages_and_light_field_may_move(self):
        renderer = self.unlucky_renderer("[[ $package == package-0001 ]] && exit 3")
        shutil.copytree(self.field.parent, self.folder / "field")
        shutil.copytree(self.package_files[0].parent, self.folder / "a")
        files = sorted((self.folder / "a").glob("*.lfp"))
        submit = cluster_test_case.SUBMIT
        self.fails(3, ["package-0001"], submit, *files, "-o", self.film, "--lfrenderer", renderer)
        (self.folder / "a").rename(self.folder / "b")
        self.unlucky_renderer("")
        self.fails(3, ["package-0001", "no such file"], submit, "--resume", self.film)
        self.fails(2, ["not a package of this job"], submit, "--resume", self.film, "other.lfp")
        self.fails(2, ["after --", "--nonsense"], submit, "--resume", self.film, *files, "--",
                   "--nonsense")
        self.succeeds(submit, "--resume", self.film, *(self.folder / "b").glob("*.lfp"), "--",
                      "--lightfield", self.folder / "field")
        self.assertEqual(digests(self.film), self.expected)

    def test_frames_that_are_gone_are_rendered_again(self):
        self.submit()
        (self.film / "frame_0005.exr").unlink()
        # This is how the batch script of Slurm finishes a film.
        self.fails(5, ["package-0001 (frames 5: done, but their files are missing)"],
                   cluster_test_case.SUBMIT, "--run-finish", self.film)
        self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film)
        self.assertEqual(digests(self.film), self.expected)
        self.assertEqual([package["restarts"] for package in self.status()["packages"]], [0, 1, 0])

    def test_a_film_that_was_moved_goes_on_in_its_new_place(self):
        self.submit()
        moved = self.folder / "moved"
        self.film.rename(moved)
        (moved / "frame_0005.exr").unlink()
        self.succeeds(cluster_test_case.SUBMIT, "--resume", moved)
        self.assertEqual(digests(moved), self.expected)
        self.assertFalse(self.film.exists())

    def test_a_folder_of_a_job_that_lost_files_is_repaired(self):
        self.submit("--frames", "1-4")
        submit = cluster_test_case.SUBMIT
        self.succeeds(submit, "--resume", self.film)  # the job is done already
        shutil.rmtree(self.film / "cluster" / "packages")
        self.assertNotEqual(self.status()["state"], "done")
        self.succeeds(submit, "--resume", self.film, "--video", self.folder / "film.mp4")
        self.assertEqual(self.status()["state"], "done")
        self.assertTrue((self.folder / "film.mp4").exists())
        self.fails(2, ["new jobs"], submit, "--resume", self.film, "-o", self.folder)
        self.submit("--", "--help", code=2, words=["--help", "render nothing"])
        (self.film / "cluster" / "job.json").write_text("")
        self.submit(code=3, words=["job.json", "remove the file to submit a new job"])

    def test_a_folder_has_one_job(self):
        self.submit()
        self.submit(code=2, words=["contains a job already", "--resume", "--overwrite"])
        before = (self.film / "frame_0001.exr").stat().st_mtime_ns
        self.submit("--overwrite")
        self.assertNotEqual((self.film / "frame_0001.exr").stat().st_mtime_ns, before)
        self.assertEqual(digests(self.film), self.expected)

    def test_what_cannot_be_is_said_before_the_work(self):
        for options, code, words in (
                (["--", "--format", "jpeg"], 2, ["after --", "jpeg"]),
                (["--", "--no-such-option"], 2, ["after --", "no-such-option"]),
                (["--", "--shard", "1/2"], 2, ["--shard", "lfsubmit itself decides"]),
                (["--", "--frames=1"], 2, ["--frames=1", "lfsubmit itself decides"]),
                (["--", "--mode", "rebin", "--stop-when", "samples>=2"], 2, ["--mode rebin"]),
                (["--time-limit", "1h"], 2, ["--engine slurm"]),
                (["--frames", "12"], 2, ["12"]),
                (["--video", self.folder / "no" / "film.mp4"], 4, ["does not exist"]),
                (["--lfrenderer", self.folder / "no"], 2, ["--lfrenderer"])):
            self.submit(*options, code=code, words=words)
            self.assertFalse((self.film / "cluster").exists(), options)
        submit = cluster_test_case.SUBMIT
        for words, arguments in ((["no job", "cluster/job.json"], ["--status", self.folder]),
                                 (["no job"], ["--resume", self.folder / "no"]),
                                 (["no job"], ["--cancel", self.folder]),
                                 (["no job"], ["--finish", self.folder, "1"])):
            self.fails(3, words, submit, *arguments)
        self.fails(2, ["PACKAGES"], submit)
        self.fails(2, ["-o DIR is missing"], submit, *self.package_files)
        self.fails(2, ["only one of"], submit, "--status", self.film, "--cancel", self.film)
        self.fails(2, ["need only DIR"], submit, *self.package_files, "--status", self.film)
        self.fails(2, ["is not a package", "lfpreprocessor"], submit, self.field, self.path, "-o",
                   self.film)

    def test_the_number_of_a_package_is_read_whole(self):
        """A farm whose index variable is empty must not render package 0 in every task."""
        self.submit("--frames", "1")
        (self.film / "frame_0001.exr").unlink()
        for word in ("abc", "", "0x0", "0.9", " 0", "0 ", "00", "+0", "0,1", "3", "99999999999999999999"):
            words = [f"--run-package {word}", "number of a package, 0 to 0", "" if word else "SLURM_ARRAY_TASK_ID"]
            self.fails(2, words, cluster_test_case.SUBMIT, "--run-package", word, self.film)
        self.assertFalse((self.film / "frame_0001.exr").exists())
        self.succeeds(cluster_test_case.SUBMIT, "--run-package", 0, self.film)
        self.assertTrue((self.film / "frame_0001.exr").exists())

    def test_a_program_that_is_no_lfrenderer_is_an_output_that_failed(self):
        self.fails(4, ["not all packages are done", "/bin/false ended with exit code 1 and without a message"],
                   cluster_test_case.SUBMIT, *self.package_files[:1], "-o", self.film, "--lfrenderer", "/bin/false")
        self.fails(4, ["/bin/false ended with exit code 1"], cluster_test_case.SUBMIT, "--run-package", 0, self.film,
                   "--lfrenderer", "/bin/false")

    def test_the_folder_of_a_job_names_no_program(self):
        """It may come out of an archive of somebody else."""
        self.submit("--frames", "1")
        touched, evil = self.folder / "touched", self.folder / "evil"
        evil.write_text(f"#!/bin/sh\ntouch {touched}\n")
        evil.chmod(0o755)
        file = self.film / "cluster" / "job.json"
        good = json.loads(file.read_text())
        self.assertNotIn("lfrenderer", file.read_text())
        submit = cluster_test_case.SUBMIT
        for change, code, words in (
                ({"lfrenderer": str(evil), "lfsubmit": str(evil)}, 0, []),
                ({"arguments": ["-o", str(self.folder / "elsewhere")]}, 3, ["job.json", "-o"]),
                ({"arguments": ["--video=/elsewhere.mp4"]}, 3, ["job.json", "--video"]),
                ({"engine": "slurm", "sbatch_options": [f"--export=BASH_ENV={evil}"]}, 2, ["--export", "--sbatch="]),
                ({"engine": "slurm", "sbatch_options": [f"--mem=1G --wrap={evil}"]}, 2, ["--wrap", "--sbatch="])):
            with self.subTest(change=change):
                (self.film / "frame_0001.exr").unlink(missing_ok=True)
                file.write_text(json.dumps(good | change))
                if code == 0:
                    self.succeeds(submit, "--run-package", 0, self.film)
                    (self.film / "frame_0001.exr").unlink()
                    self.succeeds(submit, "--resume", self.film)
                    self.assertTrue((self.film / "frame_0001.exr").exists())
                else:
                    self.fails(code, words, submit, "--resume", self.film)
                self.assertFalse(touched.exists())
        self.assertFalse((self.folder / "elsewhere").exists())
        # A program of the call is run.
        file.write_text(json.dumps(good))
        self.call(submit, "--resume", self.film, "--lfrenderer", evil)
        self.assertTrue(touched.exists())

    def test_damaged_states_are_named(self):
        self.submit()
        state = self.film / "cluster" / "packages" / "package-0001.json"
        state.write_text(state.read_text()[:20])
        self.assertIn("package-0001.json", self.status()["packages"][1]["message"])
        job = self.film / "cluster" / "job.json"
        job.write_text("[]")
        self.fails(3, ["job.json", "remove the file"], cluster_test_case.SUBMIT, "--status", self.film)


class LongLocalJobTest(ClusterTestCase):
    """Tests renders of some seconds that are interrupted."""
    packages = 2
    frames = 6
    side, pitch = 12, 0.004
    resolution = [320, 240]
    OPTIONS = ("--jobs", 2, "--threads", 1, "--", "--dump-every", "0.001s")

    def start_held(self):
        return self.start("--lfrenderer", self.held_renderer(), *self.OPTIONS)

    def resume(self, *options, code=0):
        return self.succeeds(cluster_test_case.SUBMIT, "--resume", self.film, *options, code=code)

    def test_a_signal_writes_the_state_of_all_packages(self):
        for sign in (signal.SIGINT, signal.SIGTERM):
            process = self.start_held()
            self.wait_for(lambda: self.is_held(0) and self.is_held(1))
            process.send_signal(sign)
            words = process.communicate()[1].strip().splitlines()[-1]
            self.assertEqual(process.returncode, 5, words)
            self.assertIn("--resume", words)
            status = self.status()
            self.assertEqual(status["state"], "interrupted")
            self.assertEqual({package["state"] for package in status["packages"]}, {"interrupted"})
            self.resume()
            self.assertEqual(digests(self.film), self.expected)
            logs = [(self.film / "cluster" / "packages" / f"package-000{k}.log").read_text()
                    for k in (0, 1)]
            for log in logs:  # nothing that was in a checkpoint is rendered again
                self.assertRegex(log, r"continuing: \d frames are finished, \d begun")
            subprocess.run(["rm", "-r", self.film, self.folder / "starts"], check=True)

    def test_a_killed_lfsubmit_takes_its_renderers_along(self):
        process = self.start_held()
        self.wait_for(lambda: self.is_held(0) and self.is_held(1))
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        # The renderers get SIGTERM and write their checkpoints.
        self.wait_for(lambda: self.status()["state"] == "interrupted")
        self.assertIn("process has died", self.status()["packages"][0]["message"])
        self.resume()
        self.assertEqual(digests(self.film), self.expected)
        self.assertEqual([package["crashes"] for package in self.status()["packages"]], [0, 0])

    # The job's renderers are still writing checkpoints and hold their locks.
    def test_a_killed_lfsubmit_is_gone_on_with_at_once(self):
        process = self.start_held()
        self.wait_for(lambda: self.is_held(0) and self.is_held(1))
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        self.resume()
        self.assertEqual(digests(self.film), self.expected)

    def test_a_report_is_whole_or_missing(self):
        renderer = self.unlucky_renderer("""
            [[ $start == 1 && $package == finish ]] && { echo '{"half": '; exec sleep 100; }""")
        process = self.start("--lfrenderer", renderer, *self.OPTIONS)
        cluster = self.film / "cluster"
        self.wait_for(lambda: any(path.stat().st_size for path in cluster.glob(".report.*.tmp.json")))
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        self.assertFalse((cluster / "report.json").exists())
        self.resume()
        self.assertEqual(len(json.loads((cluster / "report.json").read_text())["frames"]), self.frames)
        self.assertFalse(list(cluster.glob(".*")))

    def test_a_job_is_cancelled_from_elsewhere(self):
        renderer = self.unlucky_renderer("""
            trap 'exit 5' TERM
            [[ $start == 1 && $package != finish ]] && while :; do sleep 0.05; done""")
        process = self.start("--lfrenderer", renderer, *self.OPTIONS)
        self.wait_for(lambda: (self.film / "cluster" / "packages" / "package-0000.json").exists())
        self.assertEqual(self.status()["state"], "running")
        beside = ["cluster/lock", f"another program (process {process.pid})", "--cancel"]
        self.fails(4, beside, cluster_test_case.SUBMIT, "--resume", self.film)
        job = (self.film / "cluster" / "job.json").read_bytes()
        for options in ([], ["--overwrite"]):
            self.submit(*options, "--threads", 2, code=4, words=beside)
        self.assertEqual((self.film / "cluster" / "job.json").read_bytes(), job)
        self.succeeds(cluster_test_case.SUBMIT, "--cancel", self.film)
        words = process.communicate()[1].strip().splitlines()[-1]
        self.assertEqual(process.returncode, 5, words)
        self.assertIn("cancelled", words)
        self.assertTrue(self.status()["cancelled"])
        self.resume()
        self.assertFalse(self.status()["cancelled"])
        self.assertEqual(digests(self.film), self.expected)

    def test_frames_are_finished_early(self):
        submit = cluster_test_case.SUBMIT
        process = self.start_held()
        self.wait_for(lambda: self.is_held(0) and self.is_held(1))
        process.send_signal(signal.SIGINT)
        process.communicate()
        begun = [int(path.stem[6:]) for path in
                 (self.film / "partial" / "package-0000").glob("frame_*.plate")]
        self.assertTrue(begun)
        self.fails(2, ["--finish", "7"], submit, "--finish", self.film, "1,7")
        frame = max(begun)
        self.succeeds(submit, "--finish", self.film, frame)
        self.resume()
        expected, name = self.expected, f"frame_{frame:04d}.exr"
        got = digests(self.film)
        self.assertEqual(set(got), set(expected))
        self.assertEqual([other for other in got if got[other] != expected[other]], [name])
        report = json.loads((self.film / "cluster" / "report.json").read_text())
        early = {frame["frame"]: frame["finished_early_before_rank"] for frame in report["frames"]
                 if "finished_early_before_rank" in frame}
        self.assertEqual(list(early), [frame])
        self.assertTrue(0 < early[frame] < self.side ** 2, early)
        images = {frame["frame"]: frame["lf_images"] for frame in report["frames"]}
        self.assertLess(images[frame], min(images[other] for other in images if other != frame))


if __name__ == "__main__":
    cluster_test_case.take_programs()
    unittest.main(argv=sys.argv[:1], verbosity=2)
