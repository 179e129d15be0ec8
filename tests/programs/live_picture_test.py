#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a still live picture of all LF images is close to the frame that lfrenderer makes of the full-size ones.

usage: live_picture_test.py LFVISUALIZER LFRENDERER TEST_DATA    exit 77 (skipped) without TEST_DATA/data/blender-shop
"""
import os
import pathlib
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from live_pictures import LiveServer
from program_test_case import ProgramTestCase

VISUALIZER = RENDERER = SHOP = None
LEAST_PSNR_DB = 38  # of linear light; it was 55.9
PATH = """format: lfpath 1
fps: 24
frames: 1
resolution: [480, 320]
camera:
  focal_length_mm: 30
  position: [0, 0, 0]
  orientation: {yaw: 0}
lens:
  aperture_diameter: 0.8
  focus_distance: 8.12
"""


class LivePictureTest(ProgramTestCase):
    def test_a_still_picture_is_close_to_the_frame(self):
        path = self.folder / "path.yaml"
        path.write_text(PATH)
        with LiveServer(VISUALIZER, SHOP, path, "--live-memory", "2G") as server:
            server.load_all(PATH, 480)
            facts, live = server.ask(PATH, 480)
        self.assertEqual(facts["images"], facts["needed"])
        self.assertGreater(facts["images"], 500)
        self.assertGreater(facts["divisor"], 1)
        out = self.folder / "frames"
        self.succeeds(RENDERER, SHOP, path, "-o", out, "--format", "exr", "--no-contact-sheet")
        frame = cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., 2::-1]
        error = np.clip(live, 0, 1) - np.clip(frame, 0, 1)
        self.assertGreater(-10 * np.log10(np.mean(error**2)), LEAST_PSNR_DB)


if __name__ == "__main__":
    VISUALIZER, RENDERER, data = sys.argv[1:4]
    SHOP = pathlib.Path(data) / "data/blender-shop/images"
    if not SHOP.is_dir():
        print("blender-shop is absent: nothing is tested")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
