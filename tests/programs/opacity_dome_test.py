#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests frames with alpha of a dome: an object of lfsynth on an empty background, compared with exact lens pictures.

usage: opacity_dome_test.py LFSYNTH LFRENDERER
"""
import os
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from drawn_cards import psnr_db
from program_test_case import ProgramTestCase

SYNTH = RENDERER = None
LEAST_PSNR_DB = {"light": 34, "alpha": 38, "over white": 34}

# Views from between LF cameras of the dome, obliquely and from above.
PATH_YAML = """format: lfpath 1
fps: 25
frames: 2
resolution: [60, 40]
camera:
  field_of_view_deg: 46
  focal_length_mm: 36
  position: [0.3, -0.7, -0.648]
  look_at: [0, 0, 0]
  up: [0, -1, 0]
  follow: look_at
lens:
  aperture_diameter: 0.2
  focus_distance: 1
keyframes:
  position:
    - {time: 0, value: [0.3, -0.7, -0.648]}
    - {time: 0.04, value: [-0.2, -0.95, -0.24]}
"""


def rgb_and_alpha(file):
    picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
    return picture[..., 2::-1], picture[..., 3:]


class OpacityDomeTest(ProgramTestCase):
    def test_frames_are_the_true_lens_pictures_with_alpha_and_over_white(self):
        path, field = self.folder / "path.yaml", self.folder / "field"
        path.write_text(PATH_YAML)
        self.succeeds(SYNTH, "chart", "-o", field, "--capture", "hemisphere", "--count", 1500, "--size",
                      "120x80", "--format", "png", "--alpha", "straight", "--truth", path)
        for name, *options in (("none", "none"), ("white", "white"),
                               ("none linear", "none", "--filter", "bilinear"),
                               ("white linear", "white", "--filter", "bilinear")):
            self.succeeds(RENDERER, field, path, "-o", self.folder / name, "--format", "exr-float",
                          "--no-contact-sheet", "--background", *options)
        for frame in (1, 2):
            name = f"frame_{frame:04d}.exr"
            light, alpha = rgb_and_alpha(self.folder / "none" / name)
            true_light, true_alpha = rgb_and_alpha(field / "truth" / name)
            white = cv2.imread(str(self.folder / "white" / name), cv2.IMREAD_UNCHANGED)[..., ::-1]
            found = {"light": psnr_db(light, true_light), "alpha": psnr_db(alpha, true_alpha),
                     "over white": psnr_db(white, true_light + 1 - true_alpha)}
            print(f"frame {frame}: "
                  f"{', '.join(f'{what} {value:.1f} dB' for what, value in found.items())}", file=sys.stderr)
            for what, least in LEAST_PSNR_DB.items():
                self.assertGreater(found[what], least, what)
            # Filters overshoot at edges, and values below black or above full alpha are clipped.
            self.assertLess(np.abs(light + (1 - alpha) - white).max(), 0.02)
            linear, its_alpha = rgb_and_alpha(self.folder / "none linear" / name)
            white = cv2.imread(str(self.folder / "white linear" / name), cv2.IMREAD_UNCHANGED)[..., ::-1]
            np.testing.assert_allclose(linear + (1 - its_alpha), white, atol=1e-4)
            near = cv2.dilate((true_alpha > 0).astype(np.uint8), np.ones((7, 7)))  # prefilters reach as far
            self.assertGreater(np.count_nonzero(near == 0), 50)
            self.assertEqual(np.count_nonzero(alpha[near == 0]), 0)
            inside = cv2.erode((true_alpha == 1).astype(np.uint8), np.ones((7, 7))) == 1
            self.assertGreater(np.count_nonzero(inside), 100)
            np.testing.assert_allclose(alpha[inside], 1, atol=1e-4)


if __name__ == "__main__":
    SYNTH, RENDERER = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
