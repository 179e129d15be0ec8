#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfrenderer --stop-when "noise<=X" and --require: frames end early with the same bits in any run, in every mode
and with every lens weights; a frame that cannot be measured never counts as good.

usage: noise_rule_test.py LFRENDERER LFPREPROCESSOR LFSUBMIT
"""
import concurrent.futures
import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

import small_field
from program_test_case import ProgramTestCase

RENDERER = PREPROCESSOR = SUBMIT = None
FRAMES = 4

# Every mode, estimator, filter and lens weights, and the options for all of them.
WAYS = {
    "nearest": ["--estimator", "nearest", "--lens-weights", "none", "--keep-plates"],
    "bilinear": ["--lens-weights", "none", "--keep-plates"],
    "auto": ["--keep-plates"],
    "hat": ["--estimator", "nearest", "--lens-weights", "hat", "--keep-plates"],
    "hybrid": ["--mode", "hybrid", "--keep-plates"],
    "hybrid, previews": ["--mode", "hybrid", "--lens-weights", "none", "--kept", "edges", "--preview",
                         "on"],
    "rebin": ["--mode", "rebin"],
}
NOISE = {"nearest": 0.075, "hat": 0.075}
DEFAULT_NOISE = 0.065


def digests(folder):
    """Returns the sha256 of the finished frames and plates of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for pattern in ("frame_*.exr", "frame_*.plate") for path in folder.glob(pattern)}


def report(folder, name="report.json"):
    return json.loads((folder / name).read_text())


def noises(folder):
    return [frame["noise"] for frame in report(folder)["frames"]]


class NoiseRuleTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 13  # 169 LF images
        self.field = small_field.write_field(self.folder / "field")
        self.path = small_field.write_path(self.folder, frames=FRAMES)
        # The lens opens, so that frames use different numbers of LF images.
        text = self.path.read_text()
        self.path.write_text(text + "  aperture_diameter: [{time: 0, value: 0.1}, {time: 0.12, value: "
                             "0.13}]\n")

    def arguments(self, out, *options):
        return [str(word) for word in (
            RENDERER, self.field, self.path, "-o", self.folder / out, "--format", "exr-float",
            "--no-contact-sheet", *options)]

    def render(self, out, *options, code=0):
        self.succeeds(*self.arguments(out, *options), code=code)
        return digests(self.folder / out)

    def rule(self, way):
        return ["--stop-when", f"noise<={NOISE.get(way, DEFAULT_NOISE)}", *WAYS[way]]

    def pixels(self, out, frame):
        return cv2.imread(str(self.folder / out / f"frame_{frame:04d}.exr"), cv2.IMREAD_UNCHANGED)

    # Identical bits

    def test_frames_end_early_with_the_same_bits_in_any_run(self):
        with concurrent.futures.ThreadPoolExecutor(2) as threads:
            list(threads.map(self.check_way, WAYS))

    def check_way(self, way):
        rule, tag = self.rule(way), way.replace(", ", "-")
        expected = self.render(tag, *rule, "--threads", "1")
        asked, ends = float(rule[1].split("=")[1]), set()
        for noise in noises(self.folder / tag):
            self.assertEqual(noise["asked"], asked)
            self.assertLessEqual(noise["reached"], asked, (way, noise))
            self.assertGreater(noise["reached"], 0.85 * asked, (way, noise))
            self.assertLess(noise["ranks"], 169, (way, noise))
            self.assertLessEqual(noise["lf_images"], noise["ranks"])
            ends.add(noise["ranks"])
        if way != "hat":  # hat weights use no more LF images in a wider lens
            self.assertGreater(len(ends), 1, way)
        self.assertEqual(report(self.folder / tag)["inputs"]["stop_when"], f"noise<={asked}")
        self.assertEqual(self.render(tag + "-2", *rule, "--threads", "2"), expected, way)
        self.kill_and_resume(tag, rule, expected)
        one = self.render(tag + "-one", *rule, "--frames", "3", "--threads", "3")
        if "--mode" not in rule:  # rebinned rays are kept for all frames of a pass
            self.assertEqual(one, {name: expected[name] for name in one}, way)

    def kill_and_resume(self, tag, rule, expected):
        kills = 0
        for attempt in range(8):
            process = subprocess.Popen(
                self.arguments(tag + "-cut", *rule, "--resume", "--dump-every", "0.001s", "--threads",
                               "1"), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            # Waits until the checkpoint of the next batch is written.
            partial, end = self.folder / (tag + "-cut") / "partial", time.monotonic() + 20
            before = self.checkpoints(partial)
            while process.poll() is None and time.monotonic() < end:
                if self.checkpoints(partial) != before:
                    break
                time.sleep(0.001)
            if process.poll() is None:
                process.send_signal(signal.SIGTERM if attempt % 4 == 3 else signal.SIGKILL)
                kills += 1
            process.communicate()
            if process.returncode == 0:
                break
            self.assertIn(process.returncode, (-signal.SIGKILL, -signal.SIGTERM, 5))
        self.assertGreater(kills, 1)
        self.assertEqual(self.render(tag + "-cut", *rule, "--resume", "--threads", "2"), expected, rule)
        self.assertFalse((self.folder / (tag + "-cut") / "partial").exists())

    def checkpoints(self, partial):
        times = []
        for path in sorted(partial.glob("*")):
            try:
                times.append((path.name, path.stat().st_mtime_ns))
            except FileNotFoundError:
                pass
        return times

    def test_passes_and_packages_do_not_matter(self):
        rule = self.rule("auto")
        expected = self.render("whole", *rule)
        few = self.call(*self.arguments("few", *rule, "--memory", "2M"))
        least = re.search(r"at least (\d+) MiB", few.stderr).group(1) + "M"
        self.assertEqual(self.render("passes", *rule, "--memory", least), expected)
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, self.path, "-o", packages, "--packages", 2)
        options = ["--format", "exr-float", *rule]
        self.succeeds(RENDERER, *sorted(packages.glob("*.lfp")), "-o", self.folder / "a", *options)
        self.assertEqual(digests(self.folder / "a"), expected)
        self.succeeds(SUBMIT, *sorted(packages.glob("*.lfp")), "-o", self.folder / "b", "--lfrenderer",
                      RENDERER, "--", *options)
        self.assertEqual(digests(self.folder / "b"), expected)

    # A frame that stops early equals a frame that is rendered with only the LF images that it used.
    def test_a_stopped_frame_is_that_of_fewer_lf_images(self):
        for way in ("nearest", "auto"):
            self.render(way, *self.rule(way))
            noise = noises(self.folder / way)[2]
            options = [*WAYS[way], "--frames", "3", "--require", "noise<=0.5"]
            images = noise["lf_images"]
            while True:  # LF images beside the lens have no weight, but --max-images counts them
                self.render("max", *options, "--max-images", images, "--overwrite")
                taken = noises(self.folder / "max")[0]
                if taken["lf_images"] >= noise["lf_images"]:
                    break
                images += noise["lf_images"] - taken["lf_images"]
            self.assertEqual(taken["reached"], noise["reached"])
            np.testing.assert_array_equal(self.pixels("max", 3), self.pixels(way, 3))
            self.assertTrue((self.pixels(way, 3) > 0).any())

    # Frames that do not reach the noise equal the frames of a render without a rule, although other frames stop.
    def test_frames_that_do_not_stop_are_as_without_a_rule(self):
        text = self.path.read_text().replace("value: 0.1}", "value: 0.03}")
        self.path.write_text(text.replace("aperture_diameter: 0.045", "aperture_diameter: 0.03"))
        for mode in ("collect", "hybrid", "rebin"):
            options = ["--mode", mode, "--lens-weights", "none"]
            plain = self.render(mode, *options)
            ruled = self.render(mode + "-ruled", *options, "--stop-when", "noise<=0.045")
            early = [noise["ranks"] < 169 for noise in noises(self.folder / (mode + "-ruled"))]
            self.assertIn(True, early, mode)
            self.assertIn(False, early, mode)
            for (name, digest), stopped in zip(sorted(ruled.items()), early):
                self.assertEqual(digest != plain[name], stopped, (mode, name))

    # Rebinned rays of a state are useless for a frame if they contain more LF images than the frame's plate.
    def test_a_plate_that_is_gone_does_not_mix_lf_images(self):
        for way in ("hybrid, previews", "rebin"):
            tag = way.replace(", ", "-")
            rule = [*self.rule(way), "--threads", "1"]
            expected = self.render(tag, *rule)
            partial = self.folder / (tag + "-cut") / "partial"
            process = subprocess.Popen(
                self.arguments(tag + "-cut", *rule, "--dump-every", "0.001s"),
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while process.poll() is None and not [*partial.glob("rays_*"), *partial.glob("kept_*")]:
                time.sleep(0.001)
            process.kill()
            process.wait()
            plates = sorted(partial.glob("*.plate"))
            self.assertTrue(plates, way)
            plates[-1].unlink()
            self.assertEqual(self.render(tag + "-cut", *rule, "--resume"), expected, way)

    # --require

    def test_require_ends_with_code_6(self):
        for way in ("auto", "hybrid", "rebin"):
            self.render(way, *WAYS[way], "--require", "noise<=0.5")
            frame = noises(self.folder / way)[1]
            self.assertEqual((frame["asked"], frame["ranks"]), (0.5, 169))
            self.fails(6, ["noise<=1e-05", "4 of 4 frames", f"frame 2 ({frame['reached']:.3g})"],
                       *self.arguments(way + "-6", *WAYS[way], "--require", "noise<=0.00001"))
            self.assertEqual(len(list((self.folder / (way + "-6")).glob("*.exr"))), 4)
        # Frames that --stop-when stops are below the quality that --require demands.
        self.fails(6, ["noise<=0.01"], *self.arguments(
            "both", *WAYS["auto"], "--stop-when", "noise<=0.045", "--require", "noise<=0.01"))

    def test_frames_whose_noise_nobody_measured_are_rendered_again(self):
        expected = self.render("out", "--frames", "1-2")
        partial = self.folder / "out2" / "partial"
        process = subprocess.Popen(self.arguments("out2", "--dump-every", "0.001s", "--threads", "1"),
                                   stderr=subprocess.DEVNULL)
        while process.poll() is None and not list(partial.glob("*.plate")):
            time.sleep(0.001)
        process.kill()
        process.wait()
        for out in ("out", "out2"):
            words = self.call(*self.arguments(out, "--frames", "1-2", "--resume", "--require",
                                              "noise<=0.5"))
            self.assertEqual(words.returncode, 0, words.stderr)
            self.assertEqual(len(noises(self.folder / out)), 2)
            self.assertEqual({name: digests(self.folder / out)[name] for name in expected}, expected)

    # A lens between LF cameras has no rays, so that the noise of its frames cannot be measured.
    def test_what_cannot_be_measured_never_stops(self):
        small_field.write_path(self.folder, frames=2, aperture=0.002, x=0.005)
        for mode in ("rebin", "hybrid"):
            options = ["--mode", mode, "--lens-weights", "none"]
            plain = self.render(mode, *options)
            ruled = self.render(mode + "-ruled", *options, "--stop-when", "noise<=1000")
            self.assertEqual(ruled, plain)
            for noise in noises(self.folder / (mode + "-ruled")):
                self.assertNotIn("reached", noise)
                self.assertEqual((noise["ranks"], noise["lf_images"]), (169, 0))
            self.fails(6, ["not measurable"], *self.arguments(mode + "-6", *options, "--require",
                                                              "noise<=1000"))

    def test_mosaics_broken_images_and_limits(self):
        bayer = {"lf_bayer": "RGGB", "lf_transfer": "linear", "lf_black_level": 0}

        def picture(index):
            shape = (small_field.HEIGHT, small_field.WIDTH)
            return np.random.default_rng(index).integers(0, 256, shape, dtype=np.uint8)
        self.field = small_field.write_field(self.folder / "mosaics", picture, **bayer)
        (self.folder / "mosaics" / "image_84.png").write_bytes(b"broken")
        for options in (["--stop-when", "noise<=0.08", "--allow-missing", "1"],
                        ["--stop-when", "noise<=0.14", "--allow-missing", "1", "--estimator",
                         "nearest"]):
            name = f"mosaic{len(options)}"
            expected = self.render(name, *options, "--threads", "1", "--keep-plates")
            self.assertEqual(self.render(name + "-2", *options, "--threads", "3", "--keep-plates"),
                             expected)
            self.assertTrue(any(noise["ranks"] < 169 for noise in noises(self.folder / name)))
            inputs = report(self.folder / name)["inputs"]
            self.assertEqual((inputs["lens_weights"], inputs.get("filter")),
                             ("auto", None if "nearest" in options else "mosaic"))
        self.render("limit", "--allow-missing", "1", "--stop-when", "noise<=0.001", "--max-images", "20")
        for noise in noises(self.folder / "limit"):
            self.assertLessEqual(noise["lf_images"], 20)
            self.assertGreater(noise["reached"], 0.001)

    def test_what_cannot_be_is_refused(self):
        for text in ("noise>=1", "noise<=0", "noise<=x", "noise"):
            self.fails(2, ["--stop-when", "noise<=0.002"],
                       *self.arguments("no", "--stop-when", text))
        self.fails(2, ["samples>=8 or noise<=0.002"], *self.arguments("no", "--require", "good"))
        for option in ("--stop-when", "--require"):
            self.fails(2, ["--shard", option],
                       *self.arguments("no", "--shard", "1/2", option, "noise<=0.1"))
        few = self.call(*self.arguments("no", "--mode", "rebin", "--stop-when", "noise<=0.1",
                                        "--memory", "1M", "--max-rays", "1000"))
        least = int(re.search(r"give --memory (\d+)M", few.stderr).group(1))
        too_small = ("--mode", "rebin", "--stop-when", "noise<=0.1", "--memory", f"{least - 1}M", "--max-rays", "1000")
        self.fails(4, ["--mode rebin", f"give --memory {least}M", "--frames"], *self.arguments("no", *too_small))
        self.render("one", *too_small, "--frames", "1")
        self.render("inputs", "--stop-when", "noise<=0.045", "--frames", "1")
        self.fails(2, ["stop_when noise<=0.045, this call has noise<=0.05"], *self.arguments(
            "inputs", "--stop-when", "noise<=0.05", "--frames", "1-2", "--resume"))


if __name__ == "__main__":
    RENDERER, PREPROCESSOR, SUBMIT = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
