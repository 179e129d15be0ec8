#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfrenderer when it is interrupted, killed and resumed: the bits do not change, and a damaged state never gives
a wrong picture.

usage: lfrenderer_resume_test.py LFRENDERER
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np
from PIL import Image

import small_field

RENDERER = None
FRAMES = 20


def digests(folder):
    """Returns the sha256 of the finished frames and plates of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for pattern in ("frame_*.exr", "frame_*.plate") for path in folder.glob(pattern)}


class ResumeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        # 169 LF images, of which a frame uses about 110: stop rules are tested after 64 and 128 of them.
        small_field.SIDE = 13
        cls.field = small_field.write_field(cls.folder / "field")
        cls.path = small_field.write_path(cls.folder, frames=FRAMES, aperture=0.12)
        cls.common = ["--format", "exr-float", "--keep-plates", "--no-contact-sheet"]
        one = cls()
        start = time.monotonic()
        cls.expected = one.finish("whole", "--threads", "1")
        cls.whole_s = time.monotonic() - start
        cls.expected_reference = one.reference("ref")
        cls.last_words = one.begin("it's begun")
        few = one.run_renderer("few", "--threads", "3", "--memory", "2M")
        cls.small_memory = ["--threads", "3", "--memory",
                            re.search(r"at least (\d+) MiB", few.stderr).group(1) + "M"]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def arguments(self, name, *options):
        return [RENDERER, str(self.field), str(self.path), "-o", str(self.folder / name),
                *self.common, *options]

    def run_renderer(self, name, *options, **keys):
        return subprocess.run(self.arguments(name, *options), capture_output=True, text=True,
                              timeout=400, **keys)

    def finish(self, name, *options):
        result = self.run_renderer(name, *options)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        return digests(self.folder / name)

    def finish_each(self, *calls):
        """Runs two renders at a time, because a small render mostly uses one thread."""
        with concurrent.futures.ThreadPoolExecutor(2) as threads:
            return list(threads.map(lambda call: self.finish(*call), calls))

    def fails(self, code, words, name, *options, **keys):
        result = self.run_renderer(name, *options, **keys)
        self.assertEqual(result.returncode, code, result.stderr)
        last = result.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("error: "), last)
        for word in words:
            self.assertIn(word, last)
        return last

    def partial(self, name):
        return self.folder / name / "partial"

    def wait_for_lock(self, name, process):
        """Waits until the process handles signals. (A killed process leaves its lock file behind.)"""
        lock = self.partial(name) / "lock"
        while process.poll() is None:
            try:
                if lock.read_text().split()[:1] == [str(process.pid)]:
                    return
            except FileNotFoundError:
                pass
            time.sleep(0.002)

    def begin(self, name, *options, frames="1-12"):
        """Begins a render that ends unfinished, with some plates and perhaps some frames. Uses the slow reference back
        end."""
        delay_s = 0.3
        while True:
            process = subprocess.Popen(
                self.arguments(name, "--back-end", "reference", "--frames", frames, *options),
                stderr=subprocess.PIPE, text=True)
            self.wait_for_lock(name, process)
            time.sleep(delay_s)
            process.send_signal(signal.SIGTERM)
            _, words = process.communicate(timeout=240)
            if list(self.partial(name).glob("*.plate")):
                self.assertEqual(process.returncode, 5, words)
                return words
            shutil.rmtree(self.folder / name, ignore_errors=True)
            # The render was interrupted before it began, or it is complete.
            delay_s *= 1.5 if process.returncode == 5 else 0.6

    def begun(self, name):
        """Copies an unfinished render that was made once for many tests."""
        shutil.copytree(self.folder / "it's begun", self.folder / name)

    def reference(self, name, *options, frames="1-12"):
        return self.finish(name, "--back-end", "reference", "--frames", frames, *options)

    def of_reference(self, frames):
        names = {f"frame_{n:04d}.{kind}" for n in frames for kind in ("exr", "plate")}
        return {name: self.expected_reference[name] for name in names}

    # Identical bits

    def test_killed_at_random_points_it_ends_with_the_same_bits(self):
        with concurrent.futures.ThreadPoolExecutor(2) as threads:
            resumed = list(threads.map(self.kill_and_resume, range(4), (
                ["--threads", "1", "--dump-every", "0"],
                ["--threads", "2", "--dump-every", "0.01s"],
                ["--dump-every", "0.02s", *self.small_memory],
                ["--threads", "2", "--dump-every", "0.05s", "--seed", "0"])))
        # On a busy machine most renders are killed before they have a state to resume from.
        self.assertGreater(sum(resumed), 0)

    def kill_and_resume(self, index, options):
        """Kills and resumes a render three times. Returns how often it resumed from a state."""
        rng = random.Random(index)
        name = f"killed{index}"
        resumed = 0
        for kill in range(3):
            process = subprocess.Popen(self.arguments(name, "--resume", *options),
                                       stderr=subprocess.PIPE, text=True)
            self.wait_for_lock(name, process)
            time.sleep(rng.uniform(0, 0.4 * self.whole_s))
            process.send_signal(signal.SIGKILL if kill % 2 == index % 2 else signal.SIGTERM)
            _, words = process.communicate(timeout=240)
            self.assertIn(process.returncode, (-signal.SIGKILL, 0, 5), words)
            resumed += "continuing" in words
            # Every file with a final name is complete and correct.
            for file, digest in digests(self.folder / name).items():
                self.assertEqual(digest, self.expected[file], (options, kill, file))
        self.assertEqual(self.finish(name, "--resume", *options), self.expected, options)
        self.assertFalse(self.partial(name).exists())
        report = json.loads((self.folder / name / "report.json").read_text())
        self.assertEqual([f["frame"] for f in report["frames"]], list(range(1, FRAMES + 1)))
        return resumed

    def test_plates_and_frames_do_not_depend_on_threads_and_memory(self):
        # The expected frames were rendered with one thread.
        for rays in self.finish_each(("two", "--threads", "2"), ("three", *self.small_memory)):
            self.assertEqual(rays, self.expected)

    def test_the_order_changes_nothing_but_the_text_of_plates(self):
        def rays(folder):
            rays = {}
            for path in folder.glob("frame_*.plate"):
                plate = path.read_bytes()
                rays[path.name] = plate[48 + int.from_bytes(plate[12:16], "little"):]
            return rays
        other = self.finish("seed", "--seed", "5", "--frames", f"1-{FRAMES}x3")
        for name, digest in other.items():
            self.assertEqual(digest == self.expected[name], name.endswith(".exr"), name)
        whole = rays(self.folder / "whole")
        for name, content in rays(self.folder / "seed").items():
            self.assertEqual(content, whole[name])

    def test_a_state_is_resumed_with_other_memory_threads_and_frames(self):
        self.begun("other")
        self.reference("other", "--resume", *self.small_memory, frames="3-11x4")
        state = [p.name for p in self.partial("other").glob("*.plate")]
        self.assertNotIn("frame_0007.plate", state)
        self.assertEqual(self.reference("other", "--resume", "--threads", "3"),
                         self.expected_reference)
        self.assertFalse(self.partial("other").exists())
        # A second call has nothing left to do.
        before = (self.folder / "other" / "frame_0001.exr").stat().st_mtime_ns
        self.assertEqual(self.reference("other", "--resume"), self.expected_reference)
        self.assertEqual((self.folder / "other" / "frame_0001.exr").stat().st_mtime_ns, before)

    def test_the_command_in_the_last_words_goes_on(self):
        last = self.last_words.strip().splitlines()[-1]
        self.assertRegex(last, r"interrupted after \d+ of 12 frames.*--resume$")
        command = last.split("continue with: ")[1]
        # Uses a copy, because other tests begin with this state.
        aside = self.folder / "aside"
        shutil.copytree(self.folder / "it's begun", aside)
        result = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=400)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(digests(self.folder / "it's begun"), self.expected_reference)
        shutil.rmtree(self.folder / "it's begun")
        aside.rename(self.folder / "it's begun")

    def test_pictures_stand_beside_unfinished_plates(self):
        self.assertTrue(list(self.partial("it's begun").glob("frame_*.exr")))

    # The finished frame equals the picture of the last checkpoint; other frames are not affected.
    def test_frames_are_finished_with_the_rays_they_have(self):
        self.begun("early")
        path = sorted(self.partial("early").glob("frame_*.exr"))[-1]
        seen, frame = cv2.imread(str(path), cv2.IMREAD_UNCHANGED), int(path.stem[6:])
        options = ["--back-end", "reference", "--frames", "1-12", "--finish", f"{frame},20"]
        self.fails(2, ["--finish", "--resume"], "early", *options, "--overwrite")
        self.fails(2, ["--finish", "--shard"], "early", *options, "--resume", "--shard", "1/2")
        self.fails(2, ["made with mode collect", "hybrid"], "early", *options, "--resume", "--mode", "hybrid")
        self.fails(2, ["--finish '21'", "from 1 to 20"], "early", "--resume", "--finish", "21")
        self.begun("early again")
        finished = self.finish("early again", *options, "--resume")
        early = {path.name, path.with_suffix(".plate").name}
        self.assertEqual({name for name, digest in finished.items()
                          if digest != self.expected_reference[name]}, early)
        self.assertEqual(set(finished), set(self.expected_reference))
        picture = cv2.imread(str(self.folder / "early again" / path.name), cv2.IMREAD_UNCHANGED)
        np.testing.assert_array_equal(picture, seen)
        report = json.loads((self.folder / "early again" / "report.json").read_text())
        places = {one["frame"]: one["finished_early_before_rank"] for one in report["frames"]
                  if "finished_early_before_rank" in one}
        self.assertEqual(list(places), [frame])
        self.assertTrue(0 < places[frame] < 169, places)

    def test_video_sheet_and_report_of_a_resumed_render_have_all_frames(self):
        self.begun("film")
        out = self.folder / "film"
        result = subprocess.run(
            [argument for argument in self.arguments(
                "film", "--back-end", "reference", "--frames", "1-12", "--resume", "--video",
                str(out / "film.mp4")) if argument != "--no-contact-sheet"],
            capture_output=True, text=True, timeout=400)
        self.assertEqual(result.returncode, 0, result.stderr)
        counted = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                  "stream=nb_read_frames", "-of", "csv=p=0", out / "film.mp4"],
                                 capture_output=True, text=True)
        self.assertEqual(counted.stdout.strip().strip(","), "12", counted.stderr)
        with Image.open(out / "contact_sheet.png") as sheet:
            self.assertGreater(sheet.size[0], 4 * 80)
        report = json.loads((out / "report.json").read_text())
        self.assertEqual([f["frame"] for f in report["frames"]], list(range(1, 13)))
        whole = json.loads((self.folder / "ref" / "report.json").read_text())
        for ours, theirs in zip(report["frames"], whole["frames"]):
            self.assertEqual({**ours, "develop_s": 0}, {**theirs, "develop_s": 0})

    def test_sigusr1_writes_the_state_and_goes_on(self):
        expected = self.of_reference(range(1, 7))
        process = subprocess.Popen(
            self.arguments("usr1", "--back-end", "reference", "--frames", "1-6", "--dump-every",
                           "0"), stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not list(self.partial("usr1").glob("*.plate")):
            if (self.partial("usr1") / "lock").exists():
                process.send_signal(signal.SIGUSR1)
            time.sleep(0.05)
        _, words = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 0, words)
        self.assertIn("the state is written", words)
        self.assertEqual(digests(self.folder / "usr1"), expected)

    def test_an_interrupt_that_comes_twice_at_once_is_one(self):
        """`timeout -s INT` sends the signal to both the program and its group."""
        process = subprocess.Popen(self.arguments("echo", "--back-end", "reference"),
                                   stderr=subprocess.PIPE, text=True)
        self.wait_for_lock("echo", process)
        for _ in range(3):
            process.send_signal(signal.SIGINT)
        _, words = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 5, words)
        self.assertEqual(self.reference("echo", "--resume"), self.expected_reference)

    def test_a_closed_terminal_is_an_interrupt_but_not_under_nohup(self):
        for name, prefix, code in (("hup", [], 5), ("nohup", ["nohup"], 0)):
            process = subprocess.Popen(
                [*prefix, *self.arguments(name, "--back-end", "reference", "--frames", "1-6")],
                stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
            self.wait_for_lock(name, process)
            process.send_signal(signal.SIGHUP)
            _, words = process.communicate(timeout=240)
            self.assertEqual(process.returncode, code, words)

    def test_a_log_that_nobody_reads_any_more_does_not_end_it(self):
        read, write = os.pipe()
        os.close(read)
        process = subprocess.run(self.arguments("pipe"), stderr=write)
        os.close(write)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(digests(self.folder / "pipe"), self.expected)

    def test_a_second_sigint_ends_at_once_and_harms_nothing(self):
        expected = self.of_reference(range(1, 7))
        process = subprocess.Popen(
            self.arguments("twice", "--back-end", "reference", "--frames", "1-6"),
            stderr=subprocess.PIPE, text=True)
        self.wait_for_lock("twice", process)
        time.sleep(0.02)  # long before the last frame
        process.send_signal(signal.SIGINT)
        time.sleep(0.6)
        process.send_signal(signal.SIGINT)
        _, words = process.communicate(timeout=240)
        self.assertIn(process.returncode, (-signal.SIGINT, 5), words)
        self.assertEqual(self.reference("twice", "--resume", frames="1-6"), expected)

    def test_a_frame_that_is_being_finished_is_interrupted(self):
        # Every element is smoothed over all others within 32, which takes seconds.
        path = self.folder / "large.yaml"
        text = small_field.PATH_YAML.format(frames=1, aperture=0.12, x=0)
        path.write_text(text.replace("[80, 60]", "[112, 84]"))
        out = self.folder / "finishing"
        call = [RENDERER, self.field, path, "-o", out, *self.common, "--smooth-below", "1000000"]
        process = subprocess.Popen([*call, "--dump-every", "0"], stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not (out / "frame_0001.plate").exists():
            time.sleep(0.005)  # all rays are collected; the picture is being developed
        process.send_signal(signal.SIGTERM)
        _, words = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 5, words)
        self.assertFalse((out / "frame_0001.exr").exists())
        self.assertTrue((out / "partial" / "frame_0001.plate").exists())
        # The frame has all its rays, so that it is not cut short.
        done = subprocess.run([*call, "--resume", "--finish", "1"], capture_output=True, text=True, timeout=240)
        self.assertEqual((done.returncode, "warning" in done.stderr), (0, False), done.stderr)
        for text in ((out / "report.json").read_bytes(), (out / "frame_0001.exr").read_bytes(),
                     (out / "frame_0001.plate").read_bytes()):
            self.assertNotIn(b"finished_early", text)

    # Limits and rules

    def test_max_images_does_not_depend_on_passes_and_frames(self):
        options = ["--max-images", "20"]
        expected, some = self.finish_each(
            ("max", *options), ("max_some", *options, *self.small_memory, "--frames", "2-20x2"))
        self.assertNotEqual(expected, self.expected)
        self.assertEqual(some, {name: expected[name] for name in some})
        report = json.loads((self.folder / "max" / "report.json").read_text())
        self.assertLessEqual(max(f["lf_images"] for f in report["frames"]), 20)

    def test_stop_rules_give_the_same_bits_in_any_run(self):
        rule = ["--stop-when", "samples>=12"]
        self.finish("alike", "--lens-weights", "none")
        expected = self.finish("stop", *rule)
        report = json.loads((self.folder / "stop" / "report.json").read_text())
        whole = json.loads((self.folder / "alike" / "report.json").read_text())
        stopped = 0
        for frame, all_of_it in zip(report["frames"], whole["frames"]):
            if frame["lf_images"] == all_of_it["lf_images"]:
                continue
            stopped += 1
            self.assertGreaterEqual(frame["samples"]["share"], 0.99)
            self.assertGreaterEqual(frame["samples"]["most_have"], 12)
            # The render stops at 64 or 128 of 169 LF images, all of which contribute with similar probability.
            share = frame["lf_images"] / all_of_it["lf_images"]
            self.assertLess(min(abs(share - 64 / 169), abs(share - 128 / 169)), 0.12)
        self.assertGreater(stopped, 5)
        some = self.finish("stop_some", *rule, *self.small_memory, "--frames", "2-20x2")
        self.assertEqual(some, {name: expected[name] for name in some})
        expected = self.reference("stop_ref", *rule, frames="1-6")
        self.begin("stop_begun", *rule, frames="1-6")
        self.assertEqual(self.reference("stop_begun", *rule, "--resume", frames="1-6"), expected)

    def test_stop_rules_of_frames_that_take_different_images(self):
        # A camera that passes by: each frame uses some 60 of 169 LF images, fewer at the ends.
        path = self.folder / "passing.yaml"
        text = small_field.PATH_YAML.format(frames=15, aperture=0.09, x=-0.04)
        path.write_text(text.replace("  up: [0, 1, 0]", "  up: [0, 1, 0]\n  speed: [0.14, 0, 0]"))
        rule = ["--stop-when", "samples>=5", "--estimator", "nearest"]

        def run(name, *options):
            result = subprocess.run([RENDERER, self.field, path, "-o", self.folder / name,
                                     *self.common, *rule, *options], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            return digests(self.folder / name)
        expected = run("passing")
        plates = [p.read_bytes() for p in (self.folder / "passing").glob("*.plate")]
        places = {int(re.search(rb"ranks_done: (\d+)", plate).group(1)) for plate in plates}
        self.assertEqual(places, {128, 169})
        self.assertEqual(run("passing_small", *self.small_memory), expected)
        for frame in (1, 8):
            alone = run(f"passing{frame}", "--frames", str(frame))
            self.assertEqual(alone, {name: expected[name] for name in alone})

    def test_require_ends_with_code_6_and_names_frames(self):
        # The rule counts samples, which lens weights do not allow, so that the render to be resumed has none.
        self.finish("require", "--frames", "1-2", "--lens-weights", "none")
        # Frames whose samples were not measured are rendered again.
        last = self.fails(6, ["samples>=1000", "3 of 3 frames", "frame 2 (0.0 %)"], "require",
                          "--resume", "--frames", "1-3", "--require", "samples>=1000")
        self.assertIn("99 %", last)
        self.assertTrue((self.folder / "require" / "frame_0003.exr").exists())
        self.finish("require", "--frames", "1-3", "--require", "samples>=1", "--resume")

    # Refusals

    def test_an_unfinished_render_is_not_lost_by_accident(self):
        self.begun("kept")
        self.fails(2, ["--resume", "--overwrite"], "kept", "--frames", "1")
        self.assertTrue(list(self.partial("kept").glob("*.plate")))
        kept = self.finish("kept", "--overwrite", "--frames", "1")
        for name in ("frame_0001.exr", "frame_0001.plate"):
            self.assertEqual(kept[name], self.expected[name])
        self.assertFalse(self.partial("kept").exists())

    def test_a_state_from_other_inputs_is_refused_and_the_difference_named(self):
        self.begun("inputs")
        options = ["--back-end", "reference", "--frames", "1-12", "--resume"]
        self.fails(2, ["seed 0, this call has 7", "--overwrite"], "inputs", *options, "--seed", "7")
        path, other = self.path.read_text(), self.path.with_name("other.yaml")
        other.write_text(path.replace("[{time: 0, value: 0.8}", "[{time: 0, value: 0.9}"))
        result = subprocess.run([RENDERER, self.field, other, "-o", self.folder / "inputs",
                                 *self.common, *options], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        # The message is about the first frame that is kept, which may be any.
        self.assertRegex(result.stderr, r"frame\.focus_distance_w 0\.8\d*, this call has 0\.9\d*")
        calibration = json.loads(self.field.read_text())
        calibration["frames"][7]["transform_matrix"][0][3] += 1e-9
        moved = self.field.with_name("moved.json")
        moved.write_text(json.dumps(calibration))
        result = subprocess.run([RENDERER, moved, self.path, "-o", self.folder / "inputs",
                                 *self.common, *options], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("light_field.calibration", result.stderr)
        # Finished frames are also protected: the report names all options, and a changed option is refused.
        choices = ["--frames", "1-2", "--resume", "--seed", "3", "--max-images", "9",
                   "--stop-when", "samples>=3", "--estimator", "bilinear"]
        self.finish("complete", *choices)
        inputs = json.loads((self.folder / "complete" / "report.json").read_text())["inputs"]
        for key, value in (("seed", "3"), ("max_images", "9"), ("stop_when", "samples>=3"),
                           ("estimator", "bilinear"), ("back_end", "fast"),
                           ("picture.format", "exr-float")):
            self.assertEqual(inputs[key], value)
        self.fails(2, ["report.json", "back_end fast, this call has reference"], "complete", *choices,
                   "--back-end", "reference")

    def test_frames_of_earlier_builds_are_not_mixed_with_frames_of_other_channel_names(self):
        """Earlier builds wrote count.R in place of count_red, and recorded no names of channels."""
        self.finish("earlier", "--frames", "1-2")
        report = self.folder / "earlier" / "report.json"
        facts = json.loads(report.read_text())
        self.assertEqual(facts["inputs"].pop("picture.channels"), "all, with count_red")
        report.write_text(json.dumps(facts))
        before = digests(self.folder / "earlier")
        for words in (["--frames", "1-3", "--resume"], ["--frames", "3"]):
            self.fails(2, ["no picture.channels, this call has picture.channels all, with count_red", "--overwrite"],
                       "earlier", *words)
        self.assertEqual(digests(self.folder / "earlier"), before)

    def test_a_damaged_state_is_a_clear_error(self):
        self.begun("damaged")
        plate = sorted(self.partial("damaged").glob("*.plate"))[0]
        whole = plate.read_bytes()
        options = ["--back-end", "reference", "--frames", "1-12", "--resume"]
        before = digests(self.folder / "damaged")
        plate.write_bytes(whole[:len(whole) // 2])
        self.fails(3, [plate.name, "truncated", "remove the file"], "damaged", *options)
        flipped = bytearray(whole)
        flipped[len(whole) * 2 // 3] ^= 16
        plate.write_bytes(flipped)
        self.fails(3, [plate.name, "checksum", "remove the file"], "damaged", *options)
        self.assertEqual(digests(self.folder / "damaged"), before)
        plate.unlink()  # as the message advises
        self.assertEqual(self.reference("damaged", "--resume"), self.expected_reference)

    def test_a_folder_is_rendered_into_by_one_program_at_a_time(self):
        process = subprocess.Popen(self.arguments("locked", "--back-end", "reference"),
                                   stderr=subprocess.DEVNULL)
        try:
            self.wait_for_lock("locked", process)
            process.send_signal(signal.SIGSTOP)  # it keeps the lock while the other process runs
            self.fails(4, ["locked", str(process.pid)], "locked", "--overwrite")
        finally:
            process.kill()
            process.wait()

    def test_a_full_disk_keeps_the_last_checkpoint(self):
        self.begun("full")
        state = {p.name: p.read_bytes() for p in self.partial("full").glob("*.plate")}

        def limit_files():  # further writes fail; the signal that comes with the failure does not end the process
            resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000))
        self.fails(4, ["cannot be written"], "full", "--back-end", "reference", "--frames", "1-12",
                   "--resume", "--dump-every", "0.01s", preexec_fn=limit_files)
        for name, content in state.items():
            if (self.partial("full") / name).exists():
                self.assertEqual((self.partial("full") / name).read_bytes(), content)
        self.assertFalse(list(self.partial("full").glob(".*.tmp.*")))
        self.assertEqual(self.reference("full", "--resume"), self.expected_reference)


if __name__ == "__main__":
    RENDERER = sys.argv.pop(1)
    unittest.main()
