#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lffocus views from a user's view: views at LF cameras are their LF images, bit for bit; others show points
where a pinhole sees them; outputs can be read again.

usage: focus_views_test.py LFFOCUS LFSYNTH LFIMPORT
"""
import json
import re
import signal
import subprocess
import sys
import unittest

import numpy as np
from PIL import Image

import small_field
from exr_file import channels_of
from program_test_case import ProgramTestCase, wait_until

FOCUS = SYNTH = IMPORT = None
# The scene `lights` has seven rows of eleven lights: depths, and pixels from one to the next in the middle LF image.
DEPTHS, STEP_PX = (3.0, 2.0, 1.4, 1.0, 0.75, 0.6, 0.5), 40


class ViewsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = self.folder / "field"

    def views(self, out, grid, *options, code=0):
        """Returns the report."""
        return json.loads(self.succeeds(FOCUS, "views", self.field, "--grid", grid, "-o", self.folder / out, "--json",
                                        *options, code=code) or "null")

    def write_grid(self):
        """Writes 5 x 5 parallel LF cameras of noise, 0.01 apart."""
        calibration = small_field.write_field(self.field, lf_depth_range=[0.2, 0.6])
        content = json.loads(calibration.read_text())
        for index, frame in enumerate(content["frames"]):
            frame["transform_matrix"][0][3] = 0.01 * (index % 5 - 2)
        calibration.write_text(json.dumps(content))

    def stored(self, row, column):
        """Returns the LF image at a place of the grid. In OpenGL's world, y is up, so that rows begin with the last."""
        return np.asarray(Image.open(self.field / f"image_{5 * (4 - row) + column:02}.png"))

    # Views at LF cameras

    def test_views_at_lf_cameras_are_their_lf_images(self):
        self.write_grid()
        report = self.views("views", "5x5")
        self.assertEqual((report["views_of_lf_images"], report["views_not_resampled"]), (25, 25))
        self.views("views.npy", "3x5")
        array = np.load(self.folder / "views.npy")
        self.assertEqual((array.shape, array.dtype), ((5, 3, 48, 64, 3), np.uint8))
        for row in range(5):
            for column in range(5):
                name = f"out_{row:02}_{column:02}_{10 * (row - 2):.6f}_{10 * (column - 2):.6f}.png"
                np.testing.assert_array_equal(np.asarray(Image.open(self.folder / "views" / name)),
                                              self.stored(row, column))
                if column % 2 == 0:
                    np.testing.assert_array_equal(array[row, column // 2], self.stored(row, column))

    def test_values_have_16_bits_or_are_linear(self):
        self.write_grid()
        for values, kind, most in (("srgb8", np.uint8, 255), ("srgb16", np.uint16, 65535)):
            self.views(f"{values}.npy", "5x1", "--values", values)
            array = np.load(self.folder / f"{values}.npy")
            self.assertEqual(array.dtype, kind)
            expected = np.stack([self.stored(2, column) for column in range(5)]) / 255
            np.testing.assert_allclose(array[0] / most, expected, atol=2e-3 if most > 255 else 0)
        self.views("linear.npy", "5x1", "--values", "linear")
        linear = np.load(self.folder / "linear.npy")
        self.assertEqual(linear.dtype, np.float32)
        self.views("linear", "5x1", "--values", "linear")
        found = channels_of(self.folder / "linear" / "out_00_01_0.000000_-10.000000.exr")
        np.testing.assert_array_equal(found["G"], linear[0, 1, ..., 1])
        stored = self.stored(2, 1)[..., 1] / 255
        light = np.where(stored > 0.04045, ((stored + 0.055) / 1.055)**2.4, stored / 12.92)
        np.testing.assert_allclose(found["G"], light, atol=1e-5)

    def test_the_folder_is_a_light_field(self):
        self.write_grid()
        self.views("views", "5x5")
        old, new = (json.loads((folder / "transforms.json").read_text())
                    for folder in (self.field, self.folder / "views"))
        self.assertEqual(new["lf_depth_range"], [0.2, 0.6])
        self.assertAlmostEqual(new["fl_x"], old["fl_x"])
        for number, frame in enumerate(new["frames"]):
            row, column = divmod(number, 5)
            np.testing.assert_allclose(frame["transform_matrix"],
                                       old["frames"][5 * (4 - row) + column]["transform_matrix"], atol=1e-12)
        self.succeeds(IMPORT, self.folder / "views", "--check", "pixels")
        # The names alone state the positions.
        (self.folder / "views/transforms.json").unlink()
        told = self.call(IMPORT, self.folder / "views", "--focal-px", 70)
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertRegex(told.stdout, "positions +from -0.02, -0.02, 0 to 0.02, 0.02, 0")

    # Other views

    def lights(self, *options):
        self.succeeds(SYNTH, "lights", "-o", self.field, "--count", 49, "--spacing", 0.01, *options)
        calibration = json.loads((self.field / "transforms.json").read_text())
        return calibration["fl_x"], calibration["cx"], calibration["cy"]

    def check_lights(self, picture, centre, lens, depths, tolerance_px):
        """Compares the centroid of each light with its projection into a view at (x, y)."""
        f, cx, cy = lens
        for row, depth in enumerate(DEPTHS):
            if depth not in depths:
                continue
            for column in range(-4, 5):
                light = STEP_PX / 480 * depth * np.array([column, row - 3])
                x, y = f * (light - centre) / depth + (cx, cy)
                part = picture[int(y) - 6:int(y) + 7, int(x) - 6:int(x) + 7] ** 2
                places = np.arange(-6, 7) + 0.5
                found = (part.sum(0) @ places / part.sum() + int(x), part.sum(1) @ places / part.sum() + int(y))
                self.assertLess(np.hypot(found[0] - x, found[1] - y), tolerance_px, (depth, column))

    def test_views_at_lf_cameras_have_no_distortion(self):
        lens = self.lights("--distortion", "-0.1,0.02,0.001,-0.001")
        report = self.views("views.npy", "7x7", "--values", "linear")
        self.assertEqual((report["views_of_lf_images"], report["views_not_resampled"]), (49, 0))
        views = np.load(self.folder / "views.npy")
        for row, column in ((0, 0), (3, 3), (2, 6)):
            centre = 0.01 * (np.array([column, row]) - 3)
            self.check_lights(views[row, column, ..., 1], centre, lens, DEPTHS, 0.05)

    def test_views_between_lf_cameras_are_sharp_at_the_focus_distance(self):
        lens = self.lights()
        report = self.views("views.npy", "4x6", "--values", "linear", "--focus-distance", "750mm")
        self.assertEqual((report["views_of_lf_images"], report["focus_distance_w"]), (8, 0.75))
        views = np.load(self.folder / "views.npy")
        centre = np.array([0.06 / 3 * 1 - 0.03, 0.06 / 5 * 2 - 0.03])
        self.check_lights(views[2, 1, ..., 1], centre, lens, (0.75,), 0.05)

    def test_the_focus_is_in_the_middle_of_the_depths(self):
        self.write_grid()
        self.assertAlmostEqual(self.views("views.npy", "2x3")["focus_distance_w"] or 0, 0)
        report = self.views("more.npy", "4x4")
        self.assertAlmostEqual(report["focus_distance_w"], 2 / (1 / 0.2 + 1 / 0.6))
        self.assertEqual((report["views_of_lf_images"], report["views_rendered"]), (4, 12))

    def test_overwriting_removes_views_of_a_larger_grid(self):
        self.write_grid()
        self.views("views", "5x5")
        folder = self.folder / "views"
        mine = folder / "out_09_09_mine.png"
        mine.write_text("mine")
        self.views("views", "3x3", "--overwrite")
        left = sorted(path.name for path in folder.iterdir())
        self.assertEqual(len(left), 9 + 2, left)
        self.assertEqual(mine.read_text(), "mine")
        # A list that somebody changed is no longer ours.
        listing = folder / "transforms.json"
        listing.write_text(listing.read_text().replace("PINHOLE", "OPENCV"))
        self.views("views", "2x2", "--overwrite")
        self.assertEqual(len(list(folder.glob("out_*_*_*.*_*.*.png"))), 9 + 3)  # one has the name of an old one

    def test_overwriting_removes_views_of_an_interrupted_call(self):
        self.write_grid()
        folder = self.folder / "views"
        begun = subprocess.Popen([FOCUS, "views", self.field, "--grid", "60x60", "-o", folder, "--threads", "1"],
                                 stderr=subprocess.PIPE, text=True)
        wait_until(lambda: len(list(folder.glob("out_*.png"))) > 20, begun)
        begun.kill()  # nothing can be tidied up
        begun.communicate()
        self.assertFalse((folder / "transforms.json").exists())
        self.fails(2, ["exists already", "--overwrite"], FOCUS, "views", self.field, "--grid", "60x60", "-o", folder)
        self.views("views", "3x3", "--overwrite")
        left = sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))
        self.assertEqual(len(left), 9 + 1, left)
        # While the views are replaced, the list of the old ones does not name the new ones.
        begun = subprocess.Popen([FOCUS, "views", self.field, "--grid", "50x50", "-o", folder, "--overwrite",
                                  "--threads", "1"], stderr=subprocess.PIPE, text=True)
        wait_until(lambda: len(list(folder.glob("out_*.png"))) > 30, begun)
        begun.send_signal(signal.SIGTERM)
        self.assertIn("--overwrite", begun.communicate()[1].splitlines()[-1])
        self.assertEqual(begun.returncode, 5)
        self.assertFalse((folder / "transforms.json").exists())

    # Errors

    def test_missing_lf_images_are_told(self):
        self.write_grid()
        (self.field / "image_13.png").unlink()
        self.fails(6, ["1 of 25 LF images were left out"], FOCUS, "views", self.field, "--grid", "5x5", "-o",
                   self.folder / "a.npy")
        array = np.load(self.folder / "a.npy")
        self.assertEqual((array[2, 3].max(), array[2, 2].max() > 0), (0, True))
        self.views("b.npy", "4x4", "--allow-missing", "1", "--values", "linear")
        self.fails(3, ["image_13.png"], FOCUS, "views", self.field, "--grid", "5x5", "--strict", "-o",
                   self.folder / "c.npy")
        self.assertFalse((self.folder / "c.npy").exists())

    def test_wrong_calls_are_refused(self):
        self.write_grid()
        (self.folder / "old.npy").write_text("mine")
        (self.folder / "old.txt").write_text("mine")
        (self.folder / "folder.npy").mkdir()
        for words, code, options in (
                (["--grid"], 2, ["-o", "a.npy"]),
                (["--grid"], 2, ["--grid", "0x3", "-o", "a.npy"]),
                (["--grid COLUMNSxROWS", "'5'"], 2, ["--grid", "5", "-o", "a.npy"]),
                (["--grid COLUMNSxROWS", "numbers from 1 to 4096", "'3*3'"], 2, ["--grid", "3*3", "-o", "a.npy"]),
                (["vx.png", "no .png file", "views.npy"], 2, ["--grid", "3x3", "-o", "vx.png"]),
                (["no HDF5", "lf.views(field, (2, 3), file="], 2, ["--grid", "3x2", "-o", "a.h5"]),
                (["old.npy: exists", "--overwrite"], 2, ["--grid", "3x3", "-o", self.folder / "old.npy"]),
                (["old.txt: is a file"], 2, ["--grid", "3x3", "-o", self.folder / "old.txt"]),
                (["folder.npy: is a folder"], 2, ["--grid", "3x3", "-o", self.folder / "folder.npy"]),
                (["transforms.json", "would be replaced"], 2, ["--grid", "3x3", "-o", self.field, "--overwrite"]),
                (["--focus-distance x"], 2, ["--grid", "4x4", "--focus-distance", "x", "-o", "a.npy"])):
            with self.subTest(options=options):
                self.fails(code, words, FOCUS, "views", self.field, *options)
        self.assertEqual((self.folder / "old.npy").read_text(), "mine")
        self.views("old.npy", "5x5", "--overwrite")
        small_field.write_field(self.field)  # noise: no depth can be found
        self.fails(3, ["depths of the scene", "focus distance"], FOCUS, "views", self.field, "--grid", "4x4", "-o",
                   self.folder / "noise.npy")

    def test_an_interruption_leaves_no_array(self):
        self.write_grid()
        begun = subprocess.Popen([FOCUS, "views", self.field, "--grid", "60x60", "-o", self.folder / "a.npy",
                                  "--threads", "1"], stderr=subprocess.PIPE, text=True)
        wait_until(lambda: any(self.folder.glob(".a.*")), begun)
        begun.send_signal(signal.SIGTERM)
        words = begun.communicate()[1]
        self.assertEqual(begun.returncode, 5, words)
        self.assertTrue(re.search("interrupted after .* of 3600 views", words.splitlines()[-1]), words)
        self.assertFalse(list(self.folder.glob("*a.*")))


if __name__ == "__main__":
    FOCUS, SYNTH, IMPORT = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1], verbosity=2)
