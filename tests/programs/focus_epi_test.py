#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lffocus epi from a user's view: the slope of a light tells its depth, pixels are those of the LF images, and
wrong calls are refused.

usage: focus_epi_test.py LFFOCUS LFSYNTH
"""
import json
import sys
import unittest

import numpy as np
from PIL import Image

import small_field
from exr_file import attributes_of, channels_of
from program_test_case import ProgramTestCase

FOCUS = SYNTH = None
# The scene `lights` has seven rows of eleven lights: depths, and pixels from one to the next in the middle LF image.
DEPTHS, STEP_PX = (3.0, 2.0, 1.4, 1.0, 0.75, 0.6, 0.5), 40


class EpipolarPictureTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = self.folder / "field"

    def epi(self, out, *options, field=None, code=0):
        """Returns the report of a picture, and its channel G."""
        picture = self.folder / out
        report = self.succeeds(FOCUS, "epi", field or self.field, "-o", picture, "--json", *options, code=code)
        return json.loads(report), channels_of(picture)["G"] if out.endswith(".exr") else None

    def lights(self, *options):
        self.succeeds(SYNTH, "lights", "-o", self.field, "--count", 49, "--spacing", 0.01, *options)
        calibration = json.loads((self.field / "transforms.json").read_text())
        return {key: calibration[key] for key in ("fl_x", "cx", "cy", "w", "h")}

    def centre_near(self, line, at):
        """Returns the centroid of the light near a position."""
        begin = int(at) - 8
        self.assertTrue(0 <= begin and begin + 17 <= len(line))
        weights = line[begin:begin + 17] ** 2
        return float((weights * (np.arange(begin, begin + 17) + 0.5)).sum() / weights.sum())

    def check_slopes(self, kind, tolerance_px, *options, focus=None):
        """Compares the slope of each light with its depth."""
        lens = self.lights(*options)
        slopes = 0
        for row, depth in enumerate(DEPTHS):
            # Lights of a depth are in one row of pixels; in a column, each light has another depth.
            across = lens["cy"] + STEP_PX * (row - 3) if kind == "--row" else lens["cx"]
            words = [] if focus is None else ["--focus-distance", focus]
            report, picture = self.epi(f"{row}.exr", kind, int(across), "--lines", "recorded", "--overwrite", *words)
            lines = picture if kind == "--row" else picture.T
            self.assertEqual(len(lines), 7)
            positions = np.array([line["position_w"] for line in report["positions"]])
            rate = -lens["fl_x"] * (1 / depth - (0 if focus is None else 1 / focus))
            # The places of the lights in the LF image in the middle, whose position is 0.
            middle = [lens["cx"] + STEP_PX * column for column in range(-5, 6)] if kind == "--row" else \
                [lens["cy"] + STEP_PX * (row - 3)]
            for at in middle:
                found = [self.centre_near(line, at + rate * s) for line, s in zip(lines, positions)
                         if 8 < at + rate * s < len(lines[0]) - 9]
                if len(found) == len(positions):
                    slope_px = np.polyfit(positions, found, 1)[0] * 0.01  # from one LF camera to the next
                    self.assertLess(abs(slope_px - rate * 0.01), tolerance_px, (row, at))
                    slopes += 1
        return slopes

    # Depth

    def test_the_slope_of_a_light_tells_its_depth(self):
        self.assertGreater(self.check_slopes("--row", 0.02), 70)

    def test_so_it_does_in_a_column(self):
        self.assertEqual(self.check_slopes("--column", 0.02), 7)

    def test_so_it_does_if_cameras_are_distorted_turned_and_uneven(self):
        lens = self.lights("--distortion", "-0.1,0.02,0.001,-0.001", "--jitter", 0.2, "--seed", 3)
        frames = json.loads((self.field / "transforms.json").read_text())["frames"]
        centres = {frame["file_path"]: np.array(frame["transform_matrix"])[:3, 3] for frame in frames}
        words = ["--through", sorted(centres)[24], "--tolerance", 0.005, "--lines", "recorded", "--overwrite"]
        first, _ = self.epi("first.exr", "--row", 0, *words)
        view_from_world = np.array(first["view_from_world"])
        self.assertGreater(np.abs(view_from_world - np.eye(3)).max(), 0.005)
        for row, depth in enumerate(DEPTHS):
            for column in (-2, 1, 3):
                light = np.array([STEP_PX * column * depth / 480, STEP_PX * (row - 3) * depth / 480, depth - 1])
                x, y, z = view_from_world @ (light - centres[first["through"]])
                across = int(lens["fl_x"] * y / z + lens["cy"])
                report, picture = self.epi("a.exr", "--row", across, *words)
                positions = np.array([line["position_w"] for line in report["positions"]])
                self.assertEqual(len(positions), 7)
                places = lens["fl_x"] * (x - positions) / z + lens["cx"]
                found = [self.centre_near(line, at) for line, at in zip(picture, places)]
                slope_px = np.polyfit(positions, found, 1)[0] * 0.01
                self.assertLess(abs(slope_px + lens["fl_x"] * 0.01 / z), 0.1, (row, column))

    def test_lights_at_the_focus_distance_do_not_move(self):
        self.assertGreater(self.check_slopes("--row", 0.02, focus=1.0), 70)

    # Pixels

    def write_grid(self):
        """Writes 5 x 5 parallel LF cameras of noise, 0.01 apart."""
        calibration = small_field.write_field(self.field)
        content = json.loads(calibration.read_text())
        for index, frame in enumerate(content["frames"]):
            frame["transform_matrix"][0][3] = 0.01 * (index % 5 - 2)
        calibration.write_text(json.dumps(content))

    def stored(self, index):
        return np.asarray(Image.open(self.field / f"image_{index:02}.png"))

    def test_pixels_are_those_of_the_lf_images(self):
        self.write_grid()
        self.epi("row.png", "--row", 17, "--through", "image_11.png")
        expected = np.stack([self.stored(index)[17] for index in range(10, 15)])
        np.testing.assert_array_equal(np.asarray(Image.open(self.folder / "row.png")), expected)
        # In OpenGL's world, y is up: the last row of the capture is the upper one.
        self.epi("column.png", "--column", 20, "--through", "image_11.png", "--thickness", 3)
        expected = np.stack([self.stored(index)[:, 20] for index in (21, 16, 11, 6, 1)], axis=1)
        np.testing.assert_array_equal(np.asarray(Image.open(self.folder / "column.png")), expected.repeat(3, axis=1))

    def test_uneven_rows_get_even_lines(self):
        small_field.write_field(self.field)  # columns are up to 6 % beside their even places
        report, _ = self.epi("even.exr", "--row", 17, "--through", "image_12.png")
        self.assertEqual(report["lines"], "nearest")
        np.testing.assert_allclose(np.diff([line["position_w"] for line in report["positions"]]), 0.0403 / 4, rtol=0.02)
        self.assertEqual(self.epi("all.exr", "--row", 17, "--lines", "recorded")[0]["lines"], "recorded")
        report, picture = self.epi("more.exr", "--row", 17, "--lines", "linear", "--count", 13)
        self.assertEqual((len(report["positions"]), picture.shape), (13, (13, 64)))

    def test_files_state_what_slopes_mean(self):
        self.write_grid()
        report, _ = self.epi("row.exr", "--row", 17, "--focus-distance", "500mm")
        stated = attributes_of(self.folder / "row.exr")
        self.assertEqual((stated["lf:row"], stated["lf:fx_px"], stated["lf:focus_distance_w"]), (17, 70, 0.5))
        self.assertAlmostEqual(stated["lf:line_distance_w"], 0.01, 12)
        self.assertEqual((report["through"], stated["lf:through"]), ("image_12.png", "image_12.png"))

    # Errors

    def test_missing_lf_images_are_told(self):
        self.write_grid()
        (self.field / "image_13.png").unlink()
        self.fails(6, ["1 of 5 LF images were left out"], FOCUS, "epi", self.field, "--row", 17, "-o",
                   self.folder / "a.png")
        picture = np.asarray(Image.open(self.folder / "a.png"))
        self.assertEqual((picture[3].max(), picture[4].max() > 0), (0, True))
        self.epi("b.exr", "--row", 17, "--allow-missing", "1")
        self.fails(3, ["image_13.png"], FOCUS, "epi", self.field, "--row", 17, "--strict", "-o", self.folder / "c.png")
        self.assertFalse((self.folder / "c.png").exists())

    def test_wrong_calls_are_refused(self):
        self.write_grid()
        image = self.field / "image_00.png"
        (self.folder / "old.png").write_text("mine")
        for words, code, options in (
                (["--row", "--column"], 2, ["-o", "a.png"]),
                (["excludes"], 2, ["--row", 1, "--column", 1, "-o", "a.png"]),
                (["row 48", "0 to 47"], 2, ["--row", 48, "-o", "a.png"]),
                (["column 64", "0 to 63"], 2, ["--column", 64, "-o", "a.png"]),
                (["i_9.png", "no LF image", "image_"], 2, ["--row", 1, "--through", "i_9.png", "-o", "a.png"]),
                ([".png or .exr"], 2, ["--row", 1, "-o", "a.jpg"]),
                (["old.png: exists", "--overwrite"], 2, ["--row", 1, "-o", self.folder / "old.png"]),
                (["would be replaced"], 2, ["--row", 1, "-o", image, "--overwrite"]),
                (["--count", "--lines recorded"], 2, ["--row", 1, "--lines", "recorded", "--count", 9, "-o", "a.png"]),
                (["--focus-distance 0"], 2, ["--row", 1, "--focus-distance", 0, "-o", "a.png"]),
                (["stands in no row", "larger tolerance"], 3, ["--row", 1, "--tolerance", "1e-9", "-o", "a.png",
                                                               "--through", "image_12.png", "--images", "other"])):
            if "--images" in options:
                lonely = json.loads((self.field / "transforms.json").read_text())
                for index, frame in enumerate(lonely["frames"]):
                    frame["transform_matrix"][1][3] += 1e-4 * index
                (self.field / "transforms.json").write_text(json.dumps(lonely))
                options = options[:-2]
            with self.subTest(options=options):
                self.fails(code, words, FOCUS, "epi", self.field, *options)
        self.assertEqual((self.folder / "old.png").read_text(), "mine")


if __name__ == "__main__":
    FOCUS, SYNTH = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
