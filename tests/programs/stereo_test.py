#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes stereo films and quilts of a small scene: paths of views by lfpath, frames by lfrenderer, pictures and videos
by lfquilt. Tiles must be the frames bit for bit, and a light must be where NumPy projects it in every view.

usage: stereo_test.py LFPATH LFSYNTH LFRENDERER LFQUILT LFCAMMVMINFO
"""
import json
import os
import re
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

import exr_file
from program_test_case import ProgramTestCase

PATH = SYNTH = RENDERER = QUILT = INFO = None
WIDTH, HEIGHT, FOCAL = 240, 160, 240  # pixels
# The scene `lights` seen from the middle of the capture, 1 in front of the origin: seven rows of lights, 20 pixels
# apart in both directions, at these depths from the top.
DEPTHS = (3, 2, 1.4, 1, 0.75, 0.6, 0.5)
CONVERGENCE, SEPARATION = 1.0, 0.03
SHIFT_MM = 1.2  # of the path: 8 pixels of a plate of 36 mm

PATH_YAML = f"""format: lfpath 1
fps: 24
frames: 2
resolution: [{WIDTH}, {HEIGHT}]
camera:
  sensor_width_mm: 36
  focal_length_mm: 36
  position: [0, 0, -1]
  speed: [0.12, 0, 0]
  look_at: [0, 0, 1]
  follow: direction
  shift_mm: {{horizontal: {SHIFT_MM}, vertical: 0}}
lens: {{aperture_diameter: 0.015, focus_distance: 0.75}}
"""


def light(row, column):
    """Returns the place of a light of the scene."""
    depth = DEPTHS[row]
    return np.array([20 * column / FOCAL * depth, 20 * (row - 3) / FOCAL * depth, depth - 1])


def projected(point, frame, offset):
    """Returns the position of a point in the view that is moved to the right, by the definition of parallel cameras
    whose plates are shifted."""
    x, y, z = point - [0.12 * frame / 24 + offset, 0, -1]
    cx = WIDTH / 2 - SHIFT_MM / 36 * WIDTH + FOCAL * offset / CONVERGENCE
    return np.array([FOCAL * x / z + cx, FOCAL * y / z + HEIGHT / 2])


def centroid(picture, around, half=6):
    """Returns the centre of light near a position: (x, y), pixel centres at half integers."""
    left, top = (int(round(value)) - half for value in around)
    window = picture[top:top + 2 * half, left:left + 2 * half].astype(float).sum(axis=2)
    ys, xs = np.mgrid[top:top + 2 * half, left:left + 2 * half] + 0.5
    assert window.sum() > 0
    return np.array([(window * xs).sum(), (window * ys).sum()]) / window.sum()


class StereoTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.world = cls("runTest")  # calls programs for the whole class
        cls.world.setUp()
        cls.addClassCleanup(cls.world.doCleanups)
        cls.field, cls.path = cls.world.folder / "field", cls.world.folder / "path.yaml"
        cls.path.write_text(PATH_YAML)
        cls.world.succeeds(SYNTH, "lights", "-o", cls.field, "--size", f"{WIDTH}x{HEIGHT}", "--count", 169,
                           "--spacing", 0.005, "--samples", 1, "-q")
        angle = np.degrees(2 * np.arctan(SEPARATION / 2 / CONVERGENCE))
        cls.quilt = cls.film("quilt", "exr", "--quilt", "3x2", "--view-angle", angle)
        cls.stereo = cls.film("stereo", "png", "--stereo-mm", 1000 * SEPARATION)

    def runTest(self):
        """Is never called; a test case needs a method."""

    @classmethod
    def film(cls, name, form, *views):
        """Returns the folder with the frames of a path of views."""
        folder = cls.world.folder
        cls.world.succeeds(PATH, cls.path, "-o", folder / f"{name}.yaml", "--convergence", CONVERGENCE, *views, "-q")
        cls.world.succeeds(RENDERER, cls.field, folder / f"{name}.yaml", "-o", folder / name, "--format", form,
                           "--colour-space", "acescg" if form == "exr" else "rec709", "--no-contact-sheet",
                           "--video", folder / f"{name}.mp4", "-q")
        return folder / name

    def facts(self, path, *options):
        return json.loads(self.succeeds(INFO, path, "--json", *options))["cameras"]

    def join(self, *words, code=0):
        return self.succeeds(QUILT, *words, "-q", code=code)

    @staticmethod
    def png(path):
        picture = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        assert picture is not None, path
        return picture

    def test_lights_are_where_numpy_projects_them(self):
        """Lights in focus (0.75), and lights at the distance of convergence, whose blur is 1 pixel."""
        errors = []
        offsets = {"stereo": np.array([-0.5, 0.5]) * SEPARATION, "quilt": np.linspace(-0.5, 0.5, 6) * SEPARATION}
        for name, folder in ("stereo", self.stereo), ("quilt", self.quilt):
            count = len(offsets[name])
            for moment in 0, 1:
                for view, offset in enumerate(offsets[name]):
                    frame = folder / f"frame_{moment * count + view + 1:04d}"
                    if name == "stereo":
                        picture = self.png(frame.with_suffix(".png"))
                        picture = np.where(picture > 40, picture, 0)
                    else:
                        channels = exr_file.channels_of(frame.with_suffix(".exr"))
                        picture = np.stack([channels[c] for c in "RGB"], axis=2)
                    for row, column in (4, 0), (4, 2), (3, -2), (3, 1):
                        expected = projected(light(row, column), moment, offset)
                        errors.append(np.abs(centroid(picture, expected) - expected).max())
        self.assertEqual(len(errors), 2 * 8 * 4)
        self.assertLess(max(errors), 0.3)
        self.assertLess(np.mean(errors), 0.15)
        # The test would notice a missing shift of the plate: it is 3.6 pixels.
        self.assertAlmostEqual(FOCAL * SEPARATION / 2 / CONVERGENCE, 3.6)

    def test_a_quilt_has_the_bits_of_the_frames(self):
        for extension in "exr", "png":
            folder, grid = (self.quilt, (3, 2)) if extension == "exr" else (self.stereo, (1, 2))
            count = grid[0] * grid[1]
            said = json.loads(self.join(folder, "-o", self.folder / f"film.{extension}", "--views",
                                        f"{grid[0]}x{grid[1]}", "--json"))
            self.assertEqual((said["moments"], said["views"]), (2, count))
            self.assertEqual(said["resolution"], [grid[0] * WIDTH, grid[1] * HEIGHT])
            for moment, file in enumerate(said["files"]):
                name = f"film_{moment + 1:04d}_qs{grid[0]}x{grid[1]}a1.50.{extension}"
                self.assertEqual(file, str(self.folder / name))
                self.compare_tiles(self.folder / name, folder, moment, grid)

    def compare_tiles(self, file, folder, moment, grid):
        """Compares the tiles of a quilt with the frames: the first is at the lower left."""
        for view in range(grid[0] * grid[1]):
            frame = folder / f"frame_{moment * grid[0] * grid[1] + view + 1:04d}{file.suffix}"
            left, top = view % grid[0] * WIDTH, (grid[1] - 1 - view // grid[0]) * HEIGHT
            window = (slice(top, top + HEIGHT), slice(left, left + WIDTH))
            if file.suffix == ".png":
                self.assertTrue(np.array_equal(self.png(file)[window], self.png(frame)))
                continue
            quilt, single = exr_file.channels_of(file), exr_file.channels_of(frame)
            self.assertEqual(set(quilt), set("RGB"))
            for name in "RGB":
                self.assertEqual(quilt[name].dtype, single[name].dtype)
                self.assertEqual(quilt[name][window].tobytes(), single[name].tobytes())

    def test_quilts_state_the_colours_and_the_rate_of_the_frames(self):
        self.join(self.quilt, "-o", self.folder / "q.exr", "--views", "3x2")
        frame, _ = exr_file.read_header((self.quilt / "frame_0001.exr").read_bytes())
        quilt, _ = exr_file.read_header((self.folder / "q_0002_qs3x2a1.50.exr").read_bytes())
        for name in "chromaticities", "framesPerSecond":
            self.assertEqual(quilt[name], frame[name])
        self.assertEqual(quilt["framesPerSecond"][1], (24, 1))
        self.assertEqual(quilt["imageCounter"][1], 2)
        self.join(self.stereo, "-o", self.folder / "s.png", "--layout", "side-by-side")
        for name in self.stereo / "frame_0001.png", self.folder / "s_0001.png":
            self.assertIn(b"sRGB", name.read_bytes())

    def test_layouts_of_two_views(self):
        for layout in "side-by-side", "over-under", "anaglyph":
            self.join(self.stereo, "-o", self.folder / f"{layout}.png", "--layout", layout)
        self.join(self.stereo, "-o", self.folder / "both.png", "--layout", "left-right")
        for moment in 1, 2:
            left, right = (self.png(self.stereo / f"frame_{2 * moment - 1 + eye:04d}.png") for eye in (0, 1))
            files = {layout: self.png(self.folder / f"{layout}_{moment:04d}.png")
                     for layout in ("side-by-side", "over-under", "anaglyph", "both_left", "both_right")}
            self.assertTrue(np.array_equal(files["side-by-side"], np.hstack([left, right])))
            self.assertTrue(np.array_equal(files["over-under"], np.vstack([left, right])))
            # OpenCV's order is blue, green, red.
            self.assertTrue(np.array_equal(files["anaglyph"], np.dstack([right[..., :2], left[..., 2]])))
            self.assertTrue(np.array_equal(files["both_left"], left))
            self.assertTrue(np.array_equal(files["both_right"], right))
            self.assertFalse(np.array_equal(left, right))

    def frames_of(self, video):
        reader = cv2.VideoCapture(str(video))
        self.assertTrue(reader.isOpened(), video)
        pictures = []
        while True:
            is_read, picture = reader.read()
            if not is_read:
                return reader.get(cv2.CAP_PROP_FPS), pictures
            pictures.append(picture.astype(int))

    def test_videos_show_the_pictures_of_the_renderer(self):
        """The frames of left-right films are those of the video of the renderer, which shows all views in turn."""
        for name, folder in ("stereo", self.stereo), ("quilt", self.quilt):
            count = 2 if name == "stereo" else 6
            _, all_views = self.frames_of(self.world.folder / f"{name}.mp4")
            out = self.folder / f"{name}.mp4"
            self.join(folder, "-o", out, "--views", f"{count // 2}x2")
            rate, pictures = self.frames_of(self.folder / f"{name}_qs{count // 2}x2a1.50.mp4")
            self.assertEqual((rate, len(pictures)), (24, 2))
            for moment, picture in enumerate(pictures):
                self.assertEqual(picture.shape, (2 * HEIGHT, count // 2 * WIDTH, 3))
                for view in range(count):
                    left, top = view % (count // 2) * WIDTH, (1 - view // (count // 2)) * HEIGHT
                    tile = picture[top:top + HEIGHT, left:left + WIDTH]
                    self.assertLess(np.abs(tile - all_views[moment * count + view]).mean(), 1.5)
        self.join(self.stereo, "-o", self.folder / "both.mp4", "--layout", "left-right", "--fps", 12)
        for eye, side in enumerate(("left", "right")):
            rate, pictures = self.frames_of(self.folder / f"both_{side}.mp4")
            self.assertEqual((rate, len(pictures)), (12, 2))
            for moment, picture in enumerate(pictures):
                frame = self.png(self.stereo / f"frame_{2 * moment + eye + 1:04d}.png").astype(int)
                self.assertLess(np.abs(picture - frame).mean(), 1.5)

    def test_every_format_that_holds_a_shift_holds_the_views(self):
        words = ("--stereo", SEPARATION, "--convergence", CONVERGENCE)
        facts = self.facts(self.stereo.with_suffix(".yaml"))
        self.assertEqual(len(facts), 4)
        for out, form in ("s.json", "nerfstudio"), ("n.json", "instant-ngp"):
            self.succeeds(PATH, self.path, "-o", self.folder / out, "--format", form, *words, "-q")
            for old, new in zip(facts, self.facts(self.folder / out)):
                for name in set(old):
                    self.assertLessEqual(np.abs(np.subtract(old[name], new[name])).max(), 1e-9, name)
        self.succeeds(PATH, self.path, "-o", self.folder / "s.usda", *words, "-q")
        text = (self.folder / "s.usda").read_text()
        offsets = eval("{" + re.search(r"horizontalApertureOffset.timeSamples = {(.*?)}", text, re.S)[1] + "}")
        for number, fact in enumerate(facts, 1):
            self.assertAlmostEqual(offsets[number], fact["shift_mm"][0] / 100, delta=1e-9)  # tenths of a world unit
        self.fails(2, ["2 views", "s.chan", "yaml, nerfstudio"], PATH, self.path, "-o", self.folder / "s.chan", *words)
        self.fails(2, ["4 views", "s.chan"], PATH, self.path, "-o", self.folder / "s.chan", "--quilt", "2x2")

    def test_resampled_views_keep_their_distance_and_their_order(self):
        """Each view is interpolated with the same view of the next moment, in every form of the path."""
        words = "--stereo", SEPARATION, "--convergence", CONVERGENCE
        for out, form in ("s.yaml", "yaml"), ("s.json", "nerfstudio"), ("n.json", "instant-ngp"):
            self.succeeds(PATH, self.path, "-o", self.folder / out, "--format", form, *words, "-q")
            for change, moments in (("--frames", 8), 4), (("--frames", 2), 1), (("--fps", 72), 4):
                with self.subTest(out=out, change=change):
                    slow = self.folder / f"slow_{out}"
                    self.succeeds(PATH, self.folder / out, "-o", slow, *change, "--scale", 2, "--overwrite", "-q")
                    cameras = np.array([fact["position_w"] for fact in self.facts(slow)]).reshape(moments, 2, 3)
                    self.assertLess(np.abs(cameras[:, 1] - cameras[:, 0] - [2 * SEPARATION, 0, 0]).max(), 1e-9)
                    middle = 0.12 / 24 * 2 * np.arange(moments) / max(moments - 1, 1)
                    self.assertLess(np.abs(cameras.mean(axis=1)[:, 0] - middle).max(), 1e-9)
        self.fails(2, ["--frames 7", "multiple of 2"], PATH, self.folder / "s.yaml", "-o", self.folder / "odd.yaml",
                   "--frames", 7)
        self.fails(3, ["2 views of each moment already"], PATH, self.folder / "s.json", "-o", self.folder / "odd.yaml",
                   "--quilt", "2x2")
        self.assertFalse((self.folder / "odd.yaml").exists())

    def test_a_plain_path_that_is_resampled_loses_nothing(self):
        path = self.folder / "shaped.yaml"
        path.write_text(PATH_YAML.replace("focus_distance: 0.75", "focus_distance: 0.75, ratio: 1.3, "
                                          "blade_roundness: 0.3, blades: 5, hood_distance: 0.11, hood_diameter: 0.07"))
        result = self.call(PATH, path, "-o", self.folder / "long.yaml", "--frames", 29)
        self.assertEqual((result.returncode, "no place" in result.stderr), (0, False), result.stderr)

    def test_views_of_a_path_of_another_program(self):
        self.succeeds(PATH, self.path, "-o", self.folder / "p.json", "-q")
        for views in ("--stereo", 0.02), ("--quilt", "5x1"):
            cameras = [json.loads(self.succeeds(PATH, path, *views, "--json"))["cameras"]
                       for path in (self.path, self.folder / "p.json")]
            self.assertEqual(len(cameras[0]), 2 * (2 if views[0] == "--stereo" else 5))
            for old, new in zip(*cameras):
                self.assertLessEqual(np.abs(np.subtract(old["shift_mm"], new["shift_mm"])).max(), 1e-9)
                self.assertLessEqual(np.abs(np.subtract(old["position_w"], new["position_w"])).max(), 1e-9)

    def test_units_and_resampled_frames(self):
        """The separation in mm is that of the path's unit, and views are made of the frames of OUT."""
        cameras = json.loads(self.succeeds(PATH, self.path, "--unit-m", 0.1, "--stereo-mm", 65, "--frames", 3,
                                           "--json"))["cameras"]
        self.assertEqual(len(cameras), 6)
        for left, right in zip(cameras[::2], cameras[1::2]):
            moved = np.subtract(right["position_w"], left["position_w"])
            self.assertLessEqual(np.abs(moved - [0.65, 0, 0]).max(), 1e-12)

    def test_the_convergence_may_be_in_millimetres(self):
        in_units, in_mm = (self.succeeds(PATH, self.path, "--unit-m", 0.1, "--stereo", 0.3, "--convergence", length,
                                         "--json") for length in ("4", "400mm"))
        self.assertEqual(in_units, in_mm)
        self.fails(2, ["--convergence 4cm", "400mm"], PATH, self.path, "--stereo", 0.3, "--convergence", "4cm")

    def test_views_of_a_device_have_its_aspect_and_the_field_of_view_of_the_path(self):
        focal_mm, sensor_mm = 36, 36  # of PATH_YAML: they decide the field of view across
        for device, grid, size, aspect in (
                ("portrait", 8 * 6, [420, 560], 3 / 4), ("go", 11 * 6, [384, 682], 9 / 16),
                ("16-landscape", 7 * 7, [1524, 857], 16 / 9), ("16-portrait", 11 * 6, [563, 1000], 9 / 16),
                ("32-landscape", 7 * 7, [2080, 1170], 16 / 9), ("32-portrait", 11 * 6, [768, 1364], 9 / 16),
                ("65", 8 * 9, [1618, 910], 16 / 9)):
            made = json.loads(self.succeeds(PATH, self.path, "--device", device, "--frames", 1, "--json"))
            self.assertEqual((made["frames"], made["resolution"]), (grid, size), device)
            camera = made["cameras"][0]
            self.assertAlmostEqual(camera["focal_length_mm"], focal_mm, 6)
            upright = np.degrees(2 * np.arctan(sensor_mm / 2 / focal_mm / aspect))
            self.assertLess(abs(camera["field_of_view_deg"][1] - upright), 0.2, device)
        small = json.loads(self.succeeds(PATH, self.path, "--device", "go", "--resolution", "36x64", "--view-angle", 20,
                                         "--json"))
        self.assertEqual((small["frames"], small["resolution"]), (2 * 66, [36, 64]))
        for words in (("--device", "go", "--quilt", "3x2"), ("--device", "go", "--stereo", 1), ("--device", "phone"),
                      ("--device", "portrait", "--resolution", "600x560")):
            self.assertEqual(self.call(PATH, self.path, *words).returncode, 2, words)

    def test_views_are_squeezed_into_tiles(self):
        """A tile shows the whole view: OpenCV's means of areas are the judge."""
        said = json.loads(self.join(self.quilt, "-o", self.folder / "s.exr", "--views", "3x2", "--tile", "150x160",
                                    "--json"))
        self.assertEqual(said["resolution"], [450, 320])
        # The name keeps the aspect of the display.
        file = self.folder / "s_0002_qs3x2a1.50.exr"
        self.assertIn(str(file), said["files"])
        quilt = exr_file.channels_of(file)
        for view in range(6):
            frame = exr_file.channels_of(self.quilt / f"frame_{6 + view + 1:04d}.exr")
            left, top = view % 3 * 150, (1 - view // 3) * 160
            for name in "RGB":
                expected = cv2.resize(frame[name].astype(np.float32), (150, 160), interpolation=cv2.INTER_AREA)
                tile = quilt[name][top:top + 160, left:left + 150].astype(np.float32)
                self.assertLess(np.abs(tile - expected).max(), 0.002)
            self.assertGreater(expected.max(), 0.05)
        # The file that exists was made with other tiles.
        self.fails(2, ["was made with layout quilt 3x2 of 150x160", "quilt 3x2"], QUILT, self.quilt, "-o",
                   self.folder / "s.exr", "--views", "3x2", "--resume")
        self.join(self.quilt, "-o", self.folder / "s.exr", "--views", "3x2", "--tile", "150x160", "--resume")

    def test_the_quilt_of_a_device(self):
        path, frames = self.folder / "go.yaml", self.folder / "go"
        self.succeeds(PATH, self.path, "-o", path, "--device", "go", "--frames", 1, "--view-angle", 3, "--convergence",
                      CONVERGENCE, "-q")
        self.succeeds(RENDERER, self.field, path, "-o", frames, "--format", "png", "--no-contact-sheet", "-q")
        said = json.loads(self.join(frames, "-o", self.folder / "film.png", "--device", "go", "--json"))
        self.assertEqual(said["resolution"], [4092, 4092])
        self.assertEqual(said["files"], [str(self.folder / "film_qs11x6a0.56.png")])
        whole = self.png(self.folder / "film_qs11x6a0.56.png")
        first = self.png(frames / "frame_0001.png")
        # A light in the first view is in the lower left tile, squeezed.
        ys, xs = np.nonzero(first.sum(axis=2) > 300)
        tile = whole[-682:, :372]
        tile_ys, tile_xs = np.nonzero(tile.sum(axis=2) > 300)
        self.assertGreater(len(xs), 20)
        self.assertAlmostEqual(tile_xs.mean() / 372, xs.mean() / 384, 2)
        self.assertAlmostEqual(tile_ys.mean(), ys.mean(), delta=1.5)
        self.fails(2, ["0.563", "1.778", "lfpath --device"], QUILT, *sorted(frames.glob("*.png"))[:49], "-o",
                   self.folder / "other.png", "--device", "16-landscape")
        self.fails(2, ["--tile can only be used with --layout quilt"], QUILT, self.stereo, "-o", self.folder / "x.png",
                   "--layout", "side-by-side", "--tile", "10x10")
        self.fails(2, ["240 x 160", "a tile of the quilt 300 x 160", "--tile"], QUILT, self.quilt, "-o",
                   self.folder / "x.exr", "--views", "3x2", "--tile", "300x160")

    def test_wrong_calls_of_lfpath(self):
        self.fails(2, ["--stereo SEPARATION", "from 1e-09 to 1e+09", "found '0'"], PATH, self.path, "--stereo", 0)
        self.fails(2, ["--quilt CxR", "found '8'"], PATH, self.path, "--quilt", 8)
        self.fails(2, ["--convergence", "--quilt"], PATH, self.path, "--convergence", 2)
        self.fails(2, ["1x1", "at least 2"], PATH, self.path, "--quilt", "1x1")
        for words in (("--stereo", 1, "--stereo-mm", 1), ("--stereo", 1, "--quilt", "2x1"), ("--stereo", 0),
                      ("--stereo", "nan"), ("--quilt", "0x3"), ("--view-angle", 30),
                      ("--quilt", "2x1", "--view-angle", 180), ("--stereo", 1, "--convergence", -1)):
            self.assertEqual(self.call(PATH, self.path, *words).returncode, 2, words)
        tilted = self.folder / "tilted.yaml"
        tilted.write_text(PATH_YAML.replace("focus_distance: 0.75", "focus_distance: 0.1, "
                                            "focus_tilt_deg: {horizontal: 60, vertical: 0}"))
        self.fails(3, ["frame 1, view 1", "tilted focus plane"], PATH, tilted, "--stereo", 0.3)

    def test_wrong_calls_of_lfquilt(self):
        out = self.folder / "film.png"
        self.fails(2, ["--views"], QUILT, self.stereo, "-o", out)
        self.fails(2, ["--views 2x1", "two views"], QUILT, self.stereo, "-o", out, "--views", "2x1", "--layout",
                   "anaglyph")
        self.fails(3, ["frame 5 is missing", "view 5 of 6"], QUILT, self.stereo, "-o", out, "--views", "3x2")
        self.fails(2, ["number of frames is 1", "multiple of 2"], QUILT, self.stereo / "frame_0001.png", "-o", out,
                   "--layout", "side-by-side")
        self.fails(2, ["one format"], QUILT, self.stereo / "frame_0001.png", self.quilt / "frame_0001.exr", "-o", out,
                   "--layout", "side-by-side")
        self.fails(2, [".png"], QUILT, self.stereo, "-o", self.folder / "film.exr", "--layout", "side-by-side")
        self.fails(2, ["--fps"], QUILT, self.stereo, "-o", out, "--layout", "side-by-side", "--fps", 25)
        small = self.folder / "small.png"
        cv2.imwrite(str(small), np.zeros((HEIGHT, 2, 3), np.uint8))
        self.fails(3, ["small.png", "2 x 160"], QUILT, self.stereo / "frame_0001.png", small, "-o", out, "--layout",
                   "side-by-side")
        # Numbers of views that divide the number of frames, but are not those of the path.
        out = self.folder / "film.exr"
        self.fails(3, ["frame_0004.exr", "4 views of moment 1", "the next frame stands one step to the right"], QUILT,
                   self.quilt, "-o", out, "--views", "2x2")
        self.fails(3, ["frame_0007.exr", "not the right neighbour", "frame_0006.exr", "6 and 7 of the 12"], QUILT,
                   self.quilt, "-o", out, "--views", "4x3")
        self.fails(3, ["frame_0002.exr", "2 views of moment 1"], QUILT, self.quilt, "-o", out, "--layout",
                   "side-by-side")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["small.png"])
        # The eyes may change places, for crossed eyes.
        frames = [self.stereo / f"frame_{i:04d}.png" for i in (2, 1, 4, 3)]
        self.join(*frames, "-o", self.folder / "crossed.png", "--layout", "side-by-side")

    def test_files_are_kept_or_replaced_on_demand_only(self):
        call = [self.stereo, "-o", self.folder / "film.png", "--layout", "over-under"]
        self.join(*call)
        self.fails(2, ["film_0001.png: exists", "--overwrite"], QUILT, *call)
        whole = (self.folder / "film_0001.png").read_bytes()
        (self.folder / "film_0002.png").unlink()
        self.assertIn("1 of 2 files existed", self.call(QUILT, *call, "--resume").stderr)
        self.assertEqual((self.folder / "film_0001.png").read_bytes(), whole)
        self.assertTrue((self.folder / "film_0002.png").exists())
        self.fails(2, ["film_0001.png: exists already", "over-under", "side-by-side", "--overwrite"], QUILT,
                   *call[:-1], "side-by-side", "--resume")
        (self.folder / "film_0001.png").write_bytes(b"other")
        self.fails(2, ["film_0001.png: exists already", "does not tell"], QUILT, *call, "--resume")
        self.assertEqual((self.folder / "film_0001.png").read_bytes(), b"other")
        self.join(*call, "--overwrite")
        self.assertEqual((self.folder / "film_0001.png").read_bytes(), whole)
        self.assertEqual(len(list(self.folder.iterdir())), 2)


if __name__ == "__main__":
    PATH, SYNTH, RENDERER, QUILT, INFO = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1], verbosity=2)
