#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests frames with alpha: a turntable of lfsynth on an empty background, compared with exact lens pictures.

usage: opacity_test.py LFSYNTH LFRENDERER LFIMPORT LFCOMPRESSOR LFPREPROCESSOR LFMERGE LFSUBMIT
"""
import json
import os
import pathlib
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

from drawn_cards import psnr_db
from program_test_case import ProgramTestCase

SYNTH = RENDERER = IMPORTER = COMPRESSOR = PREPROCESSOR = MERGER = SUBMITTER = None
FRAMES = 2
LEAST_PSNR_DB = 38
NOTHING = ["--background", "none"]

# The frames show the charts in the middle of an arc of LF cameras, from the left and from the right.
PATH_YAML = """format: lfpath 1
fps: 25
frames: 2
resolution: [60, 40]
camera:
  field_of_view_deg: 46
  focal_length_mm: 36
  position: [-0.02, 0.0005, -0.9998]
  look_at: [0, 0, 0]
  up: [0, -1, 0]
lens:
  aperture_diameter: 0.012
  focus_distance: 1
keyframes:
  position:
    - {time: 0, value: [-0.02, 0.0005, -0.9998]}
    - {time: 0.04, value: [0.02, 0.0005, -0.9998]}
"""


def rgb_and_alpha(file):
    picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
    return picture[..., 2::-1], picture[..., 3:]


def linear_of(display):
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)


class OpacityTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        root = pathlib.Path(cls.shared.name)
        cls.field, cls.path, cls.whole = root / "field", root / "path.yaml", root / "whole"
        cls.path.write_text(PATH_YAML)
        for program in ([SYNTH, "chart", "-o", cls.field, "--capture", "band", "--count", "60",
                         "--spacing", "0.004", "--size", "360x240", "--format", "png",
                         "--alpha", "straight", "--truth", cls.path],
                        [RENDERER, cls.field, cls.path, "-o", cls.whole, "--format", "exr-float",
                         "--no-contact-sheet", "--keep-plates", *NOTHING]):
            result = subprocess.run(list(map(str, program)), capture_output=True, text=True)
            if result.returncode != 0:
                raise AssertionError(result.stderr)

    @classmethod
    def tearDownClass(cls):
        cls.shared.cleanup()

    def render(self, name, *options, field=None):
        self.succeeds(RENDERER, field or self.field, self.path, "-o", self.folder / name, "--format",
                      "exr-float", "--no-contact-sheet", *options)
        return self.folder / name

    def expect_same_bits(self, folder, other=None):
        for frame in range(1, FRAMES + 1):
            for one, expected in zip(rgb_and_alpha(folder / f"frame_{frame:04d}.exr"),
                                     rgb_and_alpha((other or self.whole) / f"frame_{frame:04d}.exr")):
                np.testing.assert_array_equal(one, expected)

    def test_a_turntable_over_black_over_white_and_with_alpha_is_the_true_lens_picture(self):
        white = self.render("white", "--background", "white")
        black = self.render("black", "--background", "black")
        for frame in range(1, FRAMES + 1):
            name = f"frame_{frame:04d}.exr"
            light, alpha = rgb_and_alpha(self.whole / name)
            true_light, true_alpha = rgb_and_alpha(self.field / "truth" / name)
            over_white, over_black = (cv2.imread(str(of / name), cv2.IMREAD_UNCHANGED)[..., ::-1]
                                      for of in (white, black))
            np.testing.assert_array_equal(light, over_black)
            self.assertGreater(psnr_db(over_black, true_light), LEAST_PSNR_DB)
            self.assertGreater(psnr_db(over_white, true_light + 1 - true_alpha), LEAST_PSNR_DB)
            self.assertGreater(psnr_db(alpha, true_alpha), LEAST_PSNR_DB)
            # Composing the frame over a background gives the picture that is rendered over it, except that alpha is
            # clipped where filters overshoot.
            np.testing.assert_allclose(light + (1 - alpha), over_white, atol=0.02)
            near = cv2.dilate((true_alpha > 0).astype(np.uint8), np.ones((7, 7)))  # prefilters reach as far
            self.assertGreater(np.count_nonzero(near == 0), 50)
            self.assertEqual(np.count_nonzero(light[near == 0]), 0)
            self.assertEqual(np.count_nonzero(alpha[near == 0]), 0)
            inside = cv2.erode((true_alpha == 1).astype(np.uint8), np.ones((7, 7))) == 1
            self.assertGreater(np.count_nonzero(inside), 500)
            np.testing.assert_allclose(alpha[inside], 1, atol=1e-3)

    def test_every_cut_of_the_work_gives_the_same_bits(self):
        self.expect_same_bits(self.render("alone", "--threads", "1", *NOTHING))
        store = self.folder / "a.lfs"
        self.succeeds(COMPRESSOR, self.field, "-o", store, "--profile", "lossless")
        self.expect_same_bits(self.render("packed", *NOTHING, field=store))
        self.succeeds(MERGER, self.whole, "-o", self.folder / "kept", "--format", "exr-float")
        self.expect_same_bits(self.folder / "kept")
        for k in (1, 2, 3):
            self.render("shards", "--shard", f"{k}/3", *NOTHING)
        self.succeeds(MERGER, self.folder / "shards" / "partial" / "shards", "-o",
                      self.folder / "merged", "--format", "exr-float")
        self.expect_same_bits(self.folder / "merged")

    def test_packages_and_jobs_give_the_same_bits(self):
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, self.path, "-o", packages, "--packages", "2", *NOTHING)
        files = sorted(packages.glob("*.lfp"))
        self.assertEqual(len(files), 2)
        self.succeeds(RENDERER, *files, "-o", self.folder / "film", "--format", "exr-float")
        self.expect_same_bits(self.folder / "film")
        self.succeeds(SUBMITTER, *files, "-o", self.folder / "job", "--lfrenderer", RENDERER, "--",
                      "--format", "exr-float")
        self.expect_same_bits(self.folder / "job")
        self.fails(2, ["--mode hybrid", "with an alpha channel", "--background black"], RENDERER, *files, "-o",
                   self.folder / "refused", "--mode", "hybrid", "--interpolation", "cells")

    def test_killed_and_resumed_it_has_the_same_bits(self):
        slow = ["--estimator", "nearest", "--back-end", "reference", *NOTHING]
        out = self.folder / "killed"
        arguments = [RENDERER, self.field, self.path, "-o", out, "--format", "exr-float",
                     "--no-contact-sheet", "--dump-every", "0.02s", *slow]
        process = subprocess.Popen(list(map(str, arguments)), stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not list(out.glob("partial/frame_*.plate")):
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        _, words = process.communicate(timeout=60)
        self.assertEqual(process.returncode, -signal.SIGKILL, words)
        self.fails(2, ["--resume", "over none", "over 0 0 0"], RENDERER, self.field, self.path, "-o",
                   out, "--format", "exr-float", *slow[:-1], "black", "--resume")
        self.succeeds(*arguments, "--resume")
        self.expect_same_bits(out, self.render("in one go", *slow))

    def test_png_has_straight_colours_as_it_must(self):
        out = self.folder / "png"
        self.succeeds(RENDERER, self.field, self.path, "-o", out, "--format", "png", "--video",
                      self.folder / "film.mp4", *NOTHING)
        self.assertGreater((self.folder / "film.mp4").stat().st_size, 1000)
        for frame in range(1, FRAMES + 1):
            picture = Image.open(out / f"frame_{frame:04d}.png")
            self.assertEqual(picture.mode, "RGBA")
            rgba = np.asarray(picture) / 255
            light, alpha = rgb_and_alpha(self.whole / f"frame_{frame:04d}.exr")
            self.assertLess(np.abs(rgba[..., 3:] - alpha).max(), 0.51 / 255)
            for behind in ([0, 0, 0], [0.02, 0.5, 0.05], [1, 1, 1]):
                composed = linear_of(rgba[..., :3]) * rgba[..., 3:] + (1 - rgba[..., 3:]) * behind
                expected = light + (1 - alpha) * behind
                self.assertLess(np.abs(composed - expected.clip(0, 1)).max(), 2 / 255)
        sheet = np.asarray(Image.open(out / "contact_sheet.png"))
        self.assertEqual(sheet.shape[2], 3)
        over_black = self.folder / "black"
        self.succeeds(RENDERER, self.field, self.path, "-o", over_black, "--format", "png")
        expected = np.asarray(Image.open(over_black / "contact_sheet.png"))
        # In dark areas, one step of an 8-bit alpha equals several display values.
        difference = np.abs(sheet.astype(int) - expected)
        self.assertLessEqual(difference.max(), 8)
        self.assertLess(difference.mean(), 0.5)

    def test_rules_and_counts_are_those_of_frames_over_black(self):
        reports = []
        for name, background in (("none", "none"), ("black", "black")):
            self.render(name, "--background", background, "--stop-when", "noise<=0.02")
            report = json.loads((self.folder / name / "report.json").read_text())
            reports.append([{key: frame[key] for key in
                             ("lf_images", "rays_tested", "rays_accepted", "noise")}
                            for frame in report["frames"]])
        self.assertEqual(*reports)

    def test_a_calibration_may_say_that_nothing_is_behind(self):
        native = self.folder / "native"
        report = self.succeeds(IMPORTER, self.field, "-o", native, *NOTHING)
        self.assertIn("straight light over nothing", report)
        written = json.loads((native / "transforms.json").read_text())
        self.assertEqual((written["lf_alpha"], written["lf_background"]), ("straight", "none"))
        self.expect_same_bits(self.render("of native", field=native))
        black = self.render("black", "--background", "black", field=native)
        self.assertEqual(len(cv2.imread(str(black / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[0, 0]), 3)
        self.assertEqual(json.loads(self.succeeds(IMPORTER, native, "--json"))["alpha"],
                         {"meaning": "straight", "background": "none"})

    def test_premultiplied_half_floats_have_the_alpha_of_straight_integers(self):
        field = self.folder / "exr"
        self.succeeds(SYNTH, "chart", "-o", field, "--capture", "band", "--count", "60", "--spacing",
                      "0.004", "--size", "360x240", "--alpha", "premultiplied")
        self.assertEqual(json.loads((field / "transforms.json").read_text())["lf_alpha"],
                         "premultiplied")
        light, alpha = rgb_and_alpha(self.render("of exr", *NOTHING, field=field) / "frame_0001.exr")
        straight_light, straight_alpha = rgb_and_alpha(self.whole / "frame_0001.exr")
        np.testing.assert_allclose(alpha, straight_alpha, atol=1 / 255)
        np.testing.assert_allclose(light, straight_light, atol=2 / 255)

    def test_what_cannot_have_opacity_is_refused_with_a_way_out(self):
        refused = self.folder / "refused"
        for mode in ("rebin", "hybrid"):
            words = [f"--mode {mode}", "with an alpha channel", "--interpolation pixels", "--mode collect",
                     "--background black"]
            cells = ["--mode", mode, "--interpolation", "cells"]
            self.fails(2, words, RENDERER, self.field, self.path, "-o", refused, *cells, *NOTHING)
            self.fails(2, words, PREPROCESSOR, self.field, self.path, "-o", refused, *cells, *NOTHING)
        mosaics = self.folder / "mosaics"
        self.succeeds(SYNTH, "chart", "-o", mosaics, "--bayer", "--calibration-only")
        self.fails(2, ["--background none", "mosaics", "no alpha"], RENDERER, mosaics, self.path, "-o",
                   refused, *NOTHING)
        self.fails(2, ["--bayer and --alpha"], SYNTH, "chart", "-o", refused, "--bayer", "--alpha",
                   "straight")
        self.fails(2, ["lights", "has no surfaces"], SYNTH, "lights", "-o", refused, "--alpha", "straight")
        self.assertFalse(refused.exists())
        calibration = self.folder / "wrong" / "transforms.json"
        shutil.copytree(self.field, calibration.parent)
        for value in ("white", 3):
            calibration.write_text(json.dumps({**json.loads(
                (self.field / "transforms.json").read_text()), "lf_background": value}))
            self.fails(3, ["lf_background", "three radiances", "none"], RENDERER, calibration, self.path,
                       "-o", refused)


if __name__ == "__main__":
    (SYNTH, RENDERER, IMPORTER, COMPRESSOR, PREPROCESSOR, MERGER, SUBMITTER) = sys.argv[1:8]
    unittest.main(argv=sys.argv[:1], verbosity=2)
