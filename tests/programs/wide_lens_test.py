#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests a lens that is wider than the capture: the part beyond the capture is empty and reported.

usage: wide_lens_test.py LFRENDERER LFPREPROCESSOR
"""
import json
import os
import re
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from drawn_cards import PITCH, SIDE, lens_picture, psnr_db, write_field, write_path
from program_test_case import ProgramTestCase

RENDERER = PREPROCESSOR = None
# Half the width of the capture, plus half a camera distance.
COVERED = SIDE / 2 * PITCH
LEAST_PSNR_DB = 40


def lamp(x, y, depth):
    """Returns a small light far behind the focus, without a background."""
    del depth
    return np.ones(x.shape + (3,)), (np.hypot(x, y) < 0.02).astype(float)


def png16(file, light, opacity):
    del opacity
    cv2.imwrite(str(file.with_suffix(".png")), (light[..., ::-1] * 65535).round().astype(np.uint16))


def covered_lens(diameter):
    """Returns points of the part of a lens that the capture covers; the centre of the lens is beside the centre of the
    capture."""
    grid = np.linspace(-COVERED, COVERED, 16)
    grid = (grid[1:] + grid[:-1]) / 2
    return [(x - 0.001, y - 0.002) for x in grid for y in grid
            if np.hypot(x - 0.001, y - 0.002) <= diameter / 2]


class WideLensTest(ProgramTestCase):
    def frame(self, field, diameter, *options):
        out = self.folder / "frames"
        result = self.call(RENDERER, field, write_path(self.folder, diameter), "-o", out,
                           "--overwrite", "--format", "exr-float", "--no-contact-sheet", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        picture = cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)
        report = json.loads((out / "report.json").read_text())["frames"][0]
        return picture[..., ::-1], result.stderr, report

    def test_the_picture_is_that_of_the_covered_lens(self):
        field = write_field(self.folder / "field", png16, lf_transfer="linear")
        for diameter in (4 * COVERED, 2.4 * COVERED):
            frame, messages, report = self.frame(field, diameter)
            truth, _ = lens_picture(covered_lens(diameter))
            self.assertGreater(psnr_db(frame, truth), LEAST_PSNR_DB)
            self.assertIn("beyond the LF cameras", messages)
            self.assertAlmostEqual(report["fitting_aperture_w"], 2 * (COVERED - 0.002), delta=1e-6)
            self.assertIn("An aperture of at most 0.074 ", messages)

    def test_a_hybrid_tells_what_it_completes(self):
        field = write_field(self.folder / "field", png16, lf_transfer="linear")
        _, messages, report = self.frame(field, 2.4 * COVERED, "--mode", "hybrid")
        # More than in the middle of the picture is missing at its borders, which not all LF cameras see.
        self.assertGreater(report["interpolated_share"], report["uncovered_share"])
        self.assertLess(report["interpolated_share"], 2 * report["uncovered_share"])
        self.assertIn(f"in {100 * report['interpolated_share']:.0f} % of the picture", messages)
        self.assertIn("keep the shape of the capture", messages)
        self.assertNotIn("cut off", messages)

    def test_a_lens_within_the_capture_is_not_told_of(self):
        field = write_field(self.folder / "field", png16, lf_transfer="linear")
        _, messages, report = self.frame(field, 1.8 * COVERED)
        self.assertNotIn("beyond the LF cameras", messages)
        self.assertLess(report["uncovered_share"], 0.01)

    def test_the_advised_aperture_is_not_warned_of(self):
        field = write_field(self.folder / "field", png16, lf_transfer="linear")
        _, messages, _ = self.frame(field, 4 * COVERED)
        advised = float(re.search(r"An aperture of at most (\S+) world units", messages).group(1))
        _, messages, _ = self.frame(field, advised)
        self.assertNotIn("beyond the LF cameras", messages)

    def test_bokeh_are_even_to_their_rim(self):
        scene = {"scene": lamp, "depths": (3,)}
        field = write_field(self.folder / "field", png16, scene, lf_transfer="linear", lf_pixels="points")
        frame, _, _ = self.frame(field, 4 * COVERED)
        rows, columns = np.nonzero(frame[..., 1] > 0.5 * np.median(frame[frame > 0]))
        spot = frame[rows.min():rows.max() + 1, columns.min():columns.max() + 1, 1]
        self.assertGreater(min(spot.shape), 4)
        inner = spot[2:-2, 2:-2]
        self.assertLess(spot.max(), 1.15 * np.median(inner))

    def test_the_forecast_names_an_aperture_that_fits(self):
        field = write_field(self.folder / "field", png16, lf_transfer="linear")
        result = self.call(PREPROCESSOR, field, write_path(self.folder, 4 * COVERED), "--plan")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("beyond the LF cameras", result.stdout + result.stderr)
        self.assertIn("an aperture of at most 74", result.stdout + result.stderr)


if __name__ == "__main__":
    RENDERER, PREPROCESSOR = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
