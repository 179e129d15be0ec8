#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that light keeps its range and its absence through light fields that the programs write and read again: gains
above 1, lenses with dark corners, masks, alpha and missing LF images give the films of the light field that was read.

usage: kept_light_test.py LFDENSIFY LFFOCUS LFSYNTH LFRENDERER LFCOMPRESSOR LFVISUALIZER
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from exr_file import channels_of
from live_pictures import LiveServer
from program_test_case import ProgramTestCase

DENSIFY = FOCUS = SYNTH = RENDERER = COMPRESSOR = VISUALIZER = None

PATH_YAML = """format: lfpath 1
fps: 25
frames: 1
resolution: [120, 90]
camera:
  field_of_view_deg: 45
  focal_length_mm: 50
  position: {position}
  look_at: {target}
  up: {up}
lens:
  aperture_diameter: 0.05
  focus_distance: 0.8
"""
FALLOFF = (-0.35, 0.0, -0.1)  # 55 % of the light remain in the corners
SIDE = 4
FILTERS = ("nearest", "bilinear", "bicubic", "prefiltered")


def light_of(stored):
    s = stored / 65535
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


def stored_of(light):
    s = np.clip(light, 0, 1)
    s = np.where(s <= 0.0031308, 12.92 * s, 1.055 * s ** (1 / 2.4) - 0.055)
    return np.rint(65535 * s).astype(np.uint16)


def falloff(height, width):
    x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
    q = 4 * (x * x + y * y) / (width ** 2 + height ** 2)
    return (1 + q * (FALLOFF[0] + q * (FALLOFF[1] + q * FALLOFF[2])))[..., None]


class KeptLightTest(ProgramTestCase):
    """Has a still life with lights that are clipped at white, photographed by 4 x 4 cameras."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.plain = pathlib.Path(temporary.name) / "plain"
        subprocess.run([SYNTH, "still-life", "-o", cls.plain, "--count", str(SIDE * SIDE), "--size", "160x120",
                        "--spacing", "0.02", "--format", "png", "-q"], check=True)
        text = json.loads((cls.plain / "transforms.json").read_text())
        poses = np.array([frame["transform_matrix"] for frame in text["frames"]])
        position, axes = poses[:, :3, 3].mean(0), poses[0][:3, :3]
        words = {name: "[" + ", ".join(repr(float(x)) for x in vector) + "]"
                 for name, vector in (("position", position), ("target", position - axes[:, 2]), ("up", axes[:, 1]))}
        cls.path = cls.plain.parent / "path.yaml"
        cls.path.write_text(PATH_YAML.format(**words))

    def field(self, name, change=None, *, top=None, frame=None):
        """Writes a light field of the plain one's LF images.

        change(index, bgr) -> picture, both of 16 bits; top: keys of the whole, which has no lf_max_radiance by default;
        frame(index) -> keys of a frame
        """
        folder = self.folder / name
        folder.mkdir()
        text = json.loads((self.plain / "transforms.json").read_text())
        del text["lf_max_radiance"]
        for index, of_frame in enumerate(text["frames"]):
            picture = cv2.imread(str(self.plain / of_frame["file_path"])).astype(np.uint16) * 257
            of_frame["file_path"] = f"{index:02}.png"
            cv2.imwrite(str(folder / of_frame["file_path"]), change(index, picture) if change else picture)
            of_frame.update(frame(index) if frame else {})
        text.update(top or {})
        (folder / "transforms.json").write_text(json.dumps(text))
        return folder

    def film(self, field, *options, code=0):
        """Returns the channels of the frame."""
        out = self.folder / "frames"
        shutil.rmtree(out, ignore_errors=True)
        self.succeeds(RENDERER, field, self.path, "-o", out, "--format", "exr-float", "--no-contact-sheet", "-q",
                      *options, code=code)
        return channels_of(out / "frame_0001.exr")

    def views(self, field, name, *options, code=0):
        """Returns the folder of the views at all LF cameras, and what was said."""
        out = self.folder / name
        result = self.call(FOCUS, "views", field, "--grid", f"{SIDE}x{SIDE}", "-o", out, *options)
        self.assertEqual(result.returncode, code, result.stderr)
        return out, result.stderr

    def expect_same(self, film, expected, factor=1.0, least_db=45.0, percent=0.5):
        """Compares two frames where rays were collected in both, which must be in the same places."""
        np.testing.assert_array_equal(film["coverage"] > 0, expected["coverage"] > 0)
        shown = expected["coverage"] > 0
        a, b = (np.stack([frame[c] for c in "RGB"], -1)[shown].astype(float) for frame in (film, expected))
        b *= factor
        db = -10 * np.log10(max(np.mean((a - b) ** 2), 1e-12) / b.max() ** 2)
        print(f"{self.id().rsplit('.')[-1]}: {db:.1f} dB, mean {a.mean() / b.mean():.5f} of what is right",
              file=sys.stderr)
        self.assertGreater(db, least_db)
        self.assertAlmostEqual(a.mean() / b.mean(), 1, delta=percent / 100)

    # The brightest light

    def bright_field(self, name, gain=3, change=None, **top):
        return self.field(name, change, top=top, frame=lambda index: {"lf_gain": gain})

    def test_no_filter_clips_light_of_gain_3(self):
        once, thrice = self.field("once"), self.bright_field("thrice")
        for name in FILTERS:
            with self.subTest(filter=name):
                film = self.film(thrice, "--filter", name)
                self.expect_same(film, self.film(once, "--filter", name), 3, 70, 0.01)
                self.assertGreater(max(film[c].max() for c in "RGB"), 2.5)

    def test_all_filters_clip_light_at_the_same_limit(self):
        """Compares with LF images in which the light was clipped when they were recorded."""
        thrice = self.bright_field("thrice", lf_max_radiance=1.5)
        clipped = self.bright_field("clipped", 3, lambda index, bgr: stored_of(np.minimum(light_of(bgr), 0.5)),
                                    lf_max_radiance=1.5)
        for name in FILTERS:
            with self.subTest(filter=name):
                self.expect_same(self.film(thrice, "--filter", name), self.film(clipped, "--filter", name), 1, 70,
                                 0.01)

    def test_stores_and_live_pictures_keep_light_of_gain_3(self):
        once, thrice = self.field("once"), self.bright_field("thrice")
        store = self.folder / "thrice.lfs"
        self.succeeds(COMPRESSOR, thrice, "-o", store, "--profile", "lossless", "-q")
        direct, stored = self.film(thrice), self.film(store)
        for channel in "RGB":
            np.testing.assert_array_equal(stored[channel], direct[channel])
        lives = []
        for field in (once, thrice):
            with LiveServer(VISUALIZER, field, self.path) as server:
                server.load_all(self.path.read_text(), 120)
                lives.append(server.ask(self.path.read_text(), 120)[1])
        self.assertGreater(lives[1].max(), 2.5)
        self.assertAlmostEqual(lives[1].mean() / lives[0].mean(), 3, delta=0.003)

    def test_light_that_needs_coarse_steps_is_clipped_with_a_warning(self):
        field = self.bright_field("40", 40)
        words = (RENDERER, field, self.path, "-o", self.folder / "frames", "--no-contact-sheet", "--overwrite")
        (advice,) = re.findall(r'add ("lf_max_radiance": 40)', self.call(*words).stderr)
        calibration = field / "transforms.json"
        calibration.write_text(calibration.read_text().replace("{", "{" + advice + ", ", 1))
        self.assertNotIn("lf_max_radiance", self.call(*words).stderr)
        self.expect_same(self.film(field), self.film(self.field("once")), 40, 40, 0.1)

    # Virtual LF images

    def dense(self, field):
        store = self.folder / f"{field.name}.lfs"
        self.succeeds(DENSIFY, field, "-o", store, "--most", 40, "-q")
        return store

    def test_densified_light_of_gain_3_is_3_times_as_bright(self):
        # Both have the same room for the overshoot of interpolation.
        once, thrice = (self.dense(self.field(str(gain), top=top, frame=lambda index: {"lf_gain": gain}))
                        for gain, top in ((1, {"lf_max_radiance": 3}), (3, {})))
        # Depths are found on a tone curve, which compresses brighter light more.
        for guard in ((), ("--no-guard",)):
            self.expect_same(self.film(thrice, *guard), self.film(once, *guard), 3, 40, 0.1)

    def expect_densified_as_even(self, change, frame, **keys):
        """Expects 1.5 times the light of an even light field, which is stored with half of the range unused, because
        interpolation overshoots beside lights."""
        room = {"lf_max_radiance": 3}
        even = self.field("even", lambda index, bgr: stored_of(light_of(bgr) / 2), top=room,
                          frame=lambda index: {"lf_gain": 2})
        uneven = self.field("uneven", change, top={**room, **keys}, frame=frame)
        expected, found = (self.film(self.dense(field), "--no-guard") for field in (even, uneven))
        self.expect_same(found, expected, 1.5, 40, 0.1)

    def test_densified_light_of_a_lens_with_dark_corners_is_that_of_an_even_one(self):
        self.expect_densified_as_even(lambda index, bgr: stored_of(light_of(bgr) * falloff(*bgr.shape[:2])),
                                      lambda index: {"lf_gain": 1.5}, lf_vignetting=FALLOFF)

    def test_densified_light_of_uneven_exposures_is_that_of_even_ones(self):
        exposures = np.random.default_rng(1).uniform(0.3, 0.8, (SIDE * SIDE, 3))
        self.expect_densified_as_even(lambda index, bgr: stored_of(light_of(bgr) * exposures[index][::-1]),
                                      lambda index: {"lf_gain": list(1.5 / exposures[index])})

    def test_densified_light_of_float_files_behind_one_of_integers_is_not_clipped(self):
        room = {"lf_max_radiance": 8}
        even = self.field("even", lambda index, bgr: stored_of(light_of(bgr) / 2), top=room,
                          frame=lambda index: {"lf_gain": 2})
        mixed = self.field("mixed", top=room, frame=lambda index: {"lf_gain": 4})
        text = json.loads((mixed / "transforms.json").read_text())
        for frame in text["frames"][1:]:
            light = 4 * light_of(cv2.imread(str(mixed / frame["file_path"]), cv2.IMREAD_UNCHANGED))
            frame["file_path"] = frame["file_path"].replace(".png", ".exr")
            cv2.imwrite(str(mixed / frame["file_path"]), light.astype(np.float32))
            del frame["lf_gain"]
        (mixed / "transforms.json").write_text(json.dumps(text))
        expected, found = (self.film(self.dense(field), "--no-guard") for field in (even, mixed))
        self.expect_same(found, expected, 4, 40, 0.1)

    def test_masked_light_stays_unrecorded_in_virtual_lf_images(self):
        masked = self.masked_field()
        store = self.dense(masked)
        self.expect_same(self.film(store, "--no-guard"), self.film(self.dense(self.field("whole")), "--no-guard"),
                         1, 30, 1)

    # Views

    def masked_field(self):
        """Returns the light field with a mask of its own for each LF image, which hides a sixth of it."""
        (self.folder / "masks").mkdir()
        for index in range(SIDE * SIDE):
            mask = np.full((120, 160), 255, np.uint8)
            row, column = divmod(index, 3)
            mask[20 * (row % 3):20 * (row % 3) + 60, 40 * column:40 * column + 53] = 0
            cv2.imwrite(str(self.folder / f"masks/{index}.png"), mask)
        return self.field("masked", frame=lambda index: {"lf_mask": f"../masks/{index}.png"})

    def uneven_field(self):
        """Returns a light field with gains up to 3 and dark corners, of light up to 3 / 0.55."""
        gains = np.random.default_rng(2).uniform(1, 3, (SIDE * SIDE, 3))
        return self.field("bright", top={"lf_vignetting": FALLOFF}, frame=lambda index: {"lf_gain": list(gains[index])})

    def test_views_keep_light_that_is_brighter_than_white(self):
        field = self.uneven_field()
        expected = self.film(field)
        for values, percent in (("linear", 0.01), ("srgb16", 0.05), ("srgb8", 0.5)):
            with self.subTest(values=values):
                views, said = self.views(field, values, "--values", values)
                self.expect_same(self.film(views), expected, 1, 45, percent)
                self.assertEqual("lf_gain" in said, values != "linear", said)

    def test_views_of_gain_3_are_3_times_as_bright(self):
        thrice = self.bright_field("thrice")
        for values in ("linear", "srgb16"):
            films = [self.film(self.views(field, f"{values} {field.name}", "--values", values)[0])
                     for field in (self.plain, thrice)]
            self.expect_same(films[1], films[0], 3, 60, 0.1)

    def test_views_are_clipped_only_if_asked(self):
        field = self.uneven_field()
        clipped, said = self.views(field, "clipped", "--clip", "--values", "srgb16")
        self.assertIn("brighter than display white", said)
        self.assertNotIn("lf_gain", (clipped / "transforms.json").read_text())
        kept, said = self.views(field, "kept", "--values", "srgb16")
        self.assertNotIn("clipped", said)
        frame = json.loads((kept / "transforms.json").read_text())["frames"][5]
        light = light_of(cv2.imread(str(kept / frame["file_path"]), cv2.IMREAD_UNCHANGED)) * frame["lf_gain"]
        shown = light_of(cv2.imread(str(clipped / frame["file_path"]), cv2.IMREAD_UNCHANGED))
        np.testing.assert_allclose(shown, np.minimum(light, 1), atol=3e-4)
        _, said = self.views(field, "bright.npy")
        self.assertIn("brighter than display white", said)
        _, said = self.views(self.plain, "plain")
        self.assertNotIn("lf_gain", (self.folder / "plain/transforms.json").read_text())
        self.assertNotIn("warning", said)

    def test_views_keep_the_light_of_cameras_with_other_colours(self):
        """White balance makes light brighter than white; the matrix makes colours darker than black."""
        field = self.field("raw", lambda index, bgr: (4000 + light_of(bgr) * 56000).astype(np.uint16), top={
            "lf_transfer": "linear", "lf_black_level": 4000, "lf_white_level": 60000, "lf_white_balance": [1.9, 1, 1.6],
            "lf_camera_to_srgb": [[1.6, -0.5, -0.1], [-0.2, 1.5, -0.3], [0.05, -0.65, 1.6]]})
        expected = self.film(field)
        self.assertLess(min(expected[c].min() for c in "RGB"), -0.01)
        self.assertGreater(max(expected[c].max() for c in "RGB"), 1.5)
        self.expect_same(self.film(self.views(field, "linear", "--values", "linear")[0]), expected, 1, 60, 0.05)

    def test_views_stay_unrecorded_where_masks_are(self):
        field = self.masked_field()
        expected = self.film(field)
        for values in ("srgb8", "linear"):
            with self.subTest(values=values):
                views, _ = self.views(field, values, "--values", values)
                self.expect_same(self.film(views), expected)
        views, _ = self.views(field, "linear.npy", "--values", "linear")
        masked = np.isnan(np.load(views))
        self.assertAlmostEqual(masked.mean(), 1 / 6, delta=0.02)
        _, said = self.views(field, "srgb8.npy")
        self.assertIn("17 % of the pixels are black", said)

    def test_views_stay_unrecorded_where_alpha_masks(self):
        def cut_out(index, bgr):
            alpha = np.full(bgr.shape[:2], 65535, np.uint16)
            alpha[30:80, 4 * index:4 * index + 60] = 0
            return np.dstack([bgr, alpha])
        field = self.field("cut", cut_out, top={"lf_alpha": "mask"})
        self.expect_same(self.film(self.views(field, "views")[0]), self.film(field))

    def test_views_of_missing_lf_images_are_unrecorded(self):
        field = self.field("missing")
        for index in (5, 6, 9):
            (field / f"{index:02}.png").unlink()
        expected = self.film(field, "--allow-missing", 3)
        for values in ("srgb8", "linear"):
            views, _ = self.views(field, values, "--values", values, "--allow-missing", 3)
            self.expect_same(self.film(views), expected)

    def test_rendered_views_are_unrecorded_where_no_lf_image_shows_anything(self):
        mask = np.full((120, 160), 255, np.uint8)
        mask[:, :40] = 0
        cv2.imwrite(str(self.folder / "mask.png"), mask)
        field = self.field("cut", frame=lambda index: {"lf_mask": "../mask.png"})
        out = self.folder / "between.npy"
        self.succeeds(FOCUS, "views", field, "--grid", "3x3", "-o", out, "--values", "linear", "--focus-distance", 0.8)
        columns = np.flatnonzero(np.isfinite(np.load(out)[1, 1]).all((0, 2)))
        # The LF images around the view are shifted by 2.4 pixels at this distance.
        focal_px = json.loads((self.plain / "transforms.json").read_text())["fl_x"]
        self.assertAlmostEqual(columns[0] + 0.5, 40.5 - focal_px * 0.01 / 0.8, delta=1)
        self.assertEqual(columns[-1], 159)

    def test_opacity_over_nothing_is_refused(self):
        def shade(index, bgr):
            return np.dstack([bgr, np.full(bgr.shape[:2], 20000 + index, np.uint16)])
        field = self.field("shaded", shade, top={"lf_alpha": "straight", "lf_background": "none"})
        self.fails(2, ["background", "opacity"], FOCUS, "views", field, "--grid", "4x4", "-o", self.folder / "views")
        views, _ = self.views(field, "views", "--background", "0.2,0.4,0.6")
        self.expect_same(self.film(views), self.film(field, "--background", "0.2,0.4,0.6"))


if __name__ == "__main__":
    DENSIFY, FOCUS, SYNTH, RENDERER, COMPRESSOR, VISUALIZER = sys.argv[1:7]
    unittest.main(argv=sys.argv[:1], verbosity=2)
