#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that lfimport matches photographs that were exposed unevenly through a lens with dark corners: the frames are
then those of an even capture.

usage: uneven_exposure_test.py LFIMPORT LFRENDERER LFSYNTH LFEXAMPLE LFPREPROCESSOR LFCOMPRESSOR DATA
"""
import json
import os
import pathlib
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from program_test_case import ProgramTestCase

IMPORTER = RENDERER = SYNTH = EXAMPLE = PREPROCESSOR = COMPRESSOR = DATA = None
FALLOFF = (-0.3, 0.05, -0.15)  # 60 % of the light remain in the corners
DARKER = 0.75  # factor of all exposures, so that gains of +20 % clip only highlights


def light_of(stored):
    s = stored / 255
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


def stored_of(light):
    s = np.clip(light, 0, 1)
    s = np.where(s <= 0.0031308, 12.92 * s, 1.055 * s ** (1 / 2.4) - 0.055)
    return (255 * s).round().astype(np.uint8)


def falloff(width, height):
    x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
    q = 4 * (x * x + y * y) / (width ** 2 + height ** 2)
    return 1 + q * (FALLOFF[0] + q * (FALLOFF[1] + q * FALLOFF[2]))


def write_uneven(field, out):
    """Copies a light field with unevenly exposed images. Returns their exposures, R G B."""
    out.mkdir()
    text = json.loads((field / "transforms.json").read_text())
    exposures = np.random.default_rng(5).uniform(0.8, 1.2, (len(text["frames"]), 3))
    for frame, exposure in zip(text["frames"], exposures):
        bgr = cv2.imread(str(field / frame["file_path"]), cv2.IMREAD_COLOR)
        light = light_of(bgr) * DARKER * exposure[::-1] * falloff(*bgr.shape[1::-1])[..., None]
        frame["file_path"] = pathlib.Path(frame["file_path"]).stem + ".png"
        cv2.imwrite(str(out / frame["file_path"]), stored_of(light))
    (out / "transforms.json").write_text(json.dumps(text))
    return exposures


def seam_percent(frame, true):
    """Returns the mean step from pixel to pixel of the ratio of a frame and the true frame."""
    lit = (true > 0.03).all(-1) & (true < 0.95).all(-1)
    ratio = np.log(np.maximum(frame, 1e-4) / np.maximum(true, 1e-4))
    steps = np.abs(np.diff(ratio, axis=1))[lit[:, 1:] & lit[:, :-1]]
    return 100 * steps.mean()


def error_percent(frame, true):
    """Returns the mean difference of a frame and the true frame, up to one scale per channel."""
    lit = (true > 0.03).all(-1) & (true < 0.95).all(-1)
    ratio = np.log(np.maximum(frame, 1e-4) / np.maximum(true, 1e-4))[lit]
    return 100 * np.abs(ratio - np.median(ratio, 0)).mean()


class UnevenExposureTest(ProgramTestCase):
    def frame(self, field, *options, film=None):
        out = self.folder / f"frames {len(list(self.folder.iterdir()))}"
        self.succeeds(RENDERER, *([film] if film else [field, self.folder / "path.yaml"]), "-o", out,
                      "--format", "exr-float", "--no-contact-sheet", *options)
        return cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., ::-1]

    def synthetic_field(self):
        field = self.folder / "even"
        self.succeeds(SYNTH, "chart", "-o", field, "--count", 25, "--size", "192x128", "--format", "png",
                      "--samples", 4)
        return field

    def matched(self, field):
        """Returns the folder that lfimport wrote, its report, and the true exposures."""
        uneven = self.folder / "uneven"
        exposures = write_uneven(field, uneven)
        report = json.loads(self.succeeds(IMPORTER, uneven, "-o", self.folder / "matched", "--json",
                                          "--match-exposure", "--vignetting"))
        return self.folder / "matched", report, exposures

    def gain_percent(self, matched, exposures):
        """Returns the largest error of a gain in %, up to one scale per channel."""
        frames = json.loads((matched / "transforms.json").read_text())["frames"]
        left = np.array([np.ones(3) * frame["lf_gain"] for frame in frames]) * exposures
        left /= np.exp(np.log(left).mean(0))
        return 100 * np.abs(left - 1).max()

    def expect_even(self, field, gain_percent, frame_percent, corner):
        """Returns the matched folder, its frame and the exposures."""
        matched, report, exposures = self.matched(field)
        exposure = report["exposure"]
        self.assertGreater(exposure["step_before"], 0.05)
        self.assertLess(exposure["step_after"], exposure["step_before"] / 4)
        self.assertEqual(exposure["matched"], len(exposures))
        self.assertAlmostEqual(exposure["falloff"]["corner_min"], 0.6, delta=corner)
        gains = self.gain_percent(matched, exposures)
        # Few LF images share a pixel of this frame, so that every seam is visible.
        self.succeeds(EXAMPLE, field, "-o", self.folder / "path.yaml", "--move", "static")
        true, before, after = (self.frame(of) for of in (field, self.folder / "uneven", matched))
        seams = [seam_percent(frame, true) for frame in (before, after)]
        errors = [error_percent(frame, true) for frame in (before, after)]
        print(f"{field.name}: seams {seams[0]:.3f} % -> {seams[1]:.3f} %, frames differ by "
              f"{errors[0]:.2f} % -> {errors[1]:.2f} %, residual {100 * exposure['step_before']:.2f} % -> "
              f"{100 * exposure['step_after']:.2f} %, corner {exposure['falloff']['corner_min']:.4f}, "
              f"gains to {gains:.2f} %", file=sys.stderr)
        self.assertLess(gains, gain_percent)
        self.assertLess(errors[1], frame_percent)
        self.assertLess(errors[1], errors[0] / 8)
        self.assertLess(seams[1], min(0.3, seams[0] / 2))
        return matched, after, exposures

    def test_a_synthetic_field_becomes_even(self):
        self.expect_even(self.synthetic_field(), 0.3, 0.5, 0.008)

    def test_photographs_of_a_shop_become_even(self):
        images = pathlib.Path(DATA) / "data" / "blender-shop" / "images"
        if not images.is_dir():
            self.skipTest(f"no photographs at {images} (set LF_TEST_DATA to the folder that holds data)")
        names = sorted(images.glob("Original Camera_*.jpg"))
        field = self.folder / "shop"
        field.mkdir()
        frames = []
        for name in names:
            _, row, column, y, x, _, _ = name.stem.split("_")
            if not (11 <= int(row) <= 15 and 11 <= int(column) <= 15):
                continue
            small = cv2.resize(cv2.imread(str(name)), (240, 160), interpolation=cv2.INTER_AREA)
            cv2.imwrite(str(field / f"{row}_{column}.png"), small)
            frames.append({"file_path": f"{row}_{column}.png", "transform_matrix": [
                [1, 0, 0, float(x) / 1000], [0, 1, 0, -float(y) / 1000], [0, 0, 1, 0], [0, 0, 0, 1]]})
        (field / "transforms.json").write_text(json.dumps(
            {"fl_x": 200, "w": 240, "h": 160, "frames": frames}))
        matched, after, exposures = self.expect_even(field, 0.7, 0.9, 0.03)
        # Most of the remaining error belongs to the shop itself: matching changes even the evenly exposed photographs
        # of the shop. Relative to these matched photographs, gains are correct to 0.5 %, and frames to 0.6 %.
        even = self.folder / "even shop matched"
        self.succeeds(IMPORTER, field, "-o", even, "--match-exposure", "--vignetting")
        frames = json.loads((even / "transforms.json").read_text())["frames"]
        gains = self.gain_percent(matched, exposures / [np.ones(3) * frame["lf_gain"] for frame in frames])
        error = error_percent(after, self.frame(even))
        print(f"shop, relative to its even photographs matched: gains to {gains:.2f} %, frames differ by "
              f"{error:.2f} %", file=sys.stderr)
        self.assertLess(gains, 0.5)
        self.assertLess(error, 0.6)

    def test_every_way_of_rendering_takes_gain_and_falloff(self):
        matched, _, _ = self.matched(self.synthetic_field())
        self.succeeds(EXAMPLE, matched, "-o", self.folder / "path.yaml", "--move", "static")
        path = self.folder / "path.yaml"
        true = self.frame(matched)
        self.succeeds(PREPROCESSOR, matched, path, "-o", self.folder / "packages", "--packages", 1)
        np.testing.assert_array_equal(self.frame(None, film=self.folder / "packages" / "package-0000.lfp"), true)
        self.succeeds(COMPRESSOR, matched, "-o", self.folder / "store.lfs", "--profile", "lossless")
        np.testing.assert_array_equal(self.frame(self.folder / "store.lfs"), true)
        for options in (["--estimator", "bilinear"], ["--mode", "rebin"], ["--mode", "hybrid"]):
            pair = [self.frame(field, *options)
                    for field in (self.folder / "even", matched)]
            self.assertLess(error_percent(pair[1], pair[0]), 0.5, options)

    def test_a_state_of_another_falloff_is_not_resumed(self):
        matched, _, _ = self.matched(self.synthetic_field())
        self.succeeds(EXAMPLE, matched, "-o", self.folder / "path.yaml", "--move", "static")
        out = self.folder / "frames"
        render = (RENDERER, matched, self.folder / "path.yaml", "-o", out, "--no-contact-sheet")
        self.succeeds(*render, "--shard", "1/2")
        text = json.loads((matched / "transforms.json").read_text())
        text["lf_vignetting"][0] -= 0.01
        (matched / "transforms.json").write_text(json.dumps(text))
        self.fails(2, ["light_field.calibration"], *render, "--shard", "1/2", "--resume")

    def test_without_output_it_only_reports(self):
        uneven = self.folder / "uneven"
        write_uneven(self.synthetic_field(), uneven)
        before = (uneven / "transforms.json").read_text()
        text = self.succeeds(IMPORTER, uneven, "--match-exposure")
        for line in ("exposure       25 of 25 images matched", "seams          "):
            self.assertIn(line, text)
        self.assertNotIn("falloff  ", text)
        self.assertEqual((uneven / "transforms.json").read_text(), before)

    def test_nothing_is_matched_where_nothing_overlaps(self):
        field = self.synthetic_field()
        text = json.loads((field / "transforms.json").read_text())
        text["frames"] = text["frames"][::12]
        for turn, frame in enumerate(text["frames"]):  # back to back
            c, s = np.cos(2 * np.pi * turn / 3), np.sin(2 * np.pi * turn / 3)
            frame["transform_matrix"] = (np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]])
                                         @ frame["transform_matrix"]).tolist()
        (field / "transforms.json").write_text(json.dumps(text))
        self.fails(3, ["--match-exposure", "0 of 3 LF images"], IMPORTER, field, "-o", self.folder / "out",
                   "--match-exposure")
        self.assertFalse((self.folder / "out").exists())

    def test_vignetting_alone_is_refused(self):
        result = self.call(IMPORTER, self.synthetic_field(), "--vignetting")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--match-exposure", result.stderr)


if __name__ == "__main__":
    IMPORTER, RENDERER, SYNTH, EXAMPLE, PREPROCESSOR, COMPRESSOR, DATA = sys.argv[1:8]
    DATA = os.environ.get("LF_TEST_DATA", DATA)
    unittest.main(argv=sys.argv[:1], verbosity=2)
