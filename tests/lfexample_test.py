#!/usr/bin/python3
"""lfexample: the path it writes renders, and is focused on what there is to see.

usage: lfexample_test.py LFEXAMPLE LFRENDERER
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from small_field import HEIGHT, PITCH, SIDE, WIDTH, write_field

EXAMPLE = RENDERER = None
DEPTH = 0.25


def wall(index):
    """A finely textured wall at DEPTH, as LF camera `index` sees it."""
    x0 = (index % SIDE - (SIDE - 1) / 2) * PITCH + 0.0003 * (index % 3)
    y0 = -(index // SIDE - (SIDE - 1) / 2) * PITCH
    x = x0 + (np.arange(WIDTH) + 0.5 - WIDTH / 2) / 70 * DEPTH
    y = y0 + (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / 70 * DEPTH
    cells = np.floor(x / 0.02)[None, :] * 374761 + np.floor(y / 0.02)[:, None] * 668265
    grey = (np.sin(cells) * 43758.5453) % 1
    return np.repeat((grey * 200 + 20).astype(np.uint8)[..., None], 3, axis=2)


class ExampleTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.field = write_field(self.folder / "field", wall)

    def run_tool(self, *arguments):
        return subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=400)

    def example(self, *options):
        path = self.folder / "path.yaml"
        result = self.run_tool(EXAMPLE, self.field, "-o", path, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path, result.stderr

    def test_every_move_renders(self):
        for move in ("static", "orbit", "dolly", "focus-pull"):
            path, _ = self.example("--move", move)
            last = 1 if move == "static" else 50
            result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / move, "--frames",
                                   f"1,{last}")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((self.folder / move / f"frame_{last:04d}.exr").exists())
            self.assertIn(f"\nframes: {last}\n", path.read_text())

    def test_focuses_on_the_wall(self):
        path, words = self.example("--move", "static")
        focus = float(re.search(r"focus_distance: (\S+)", path.read_text()).group(1))
        self.assertAlmostEqual(focus, DEPTH, delta=0.04 * DEPTH)
        self.assertIn("places of the image", words)
        self.assertNotIn("not sure", words)

    def test_takes_the_focus_and_the_camera_it_is_given(self):
        path, _ = self.example("--move", "static", "--focus", "0.9", "--camera", "0")
        text = path.read_text()
        self.assertIn("focus_distance: 0.9 ", text)
        position = re.search(r"position: \[(.*)\]", text).group(1)
        x, y, _ = map(float, position.split(","))
        self.assertAlmostEqual(x, -2 * PITCH, places=6)

    def position(self, *options):
        path, _ = self.example("--move", "static", "--focus", "0.9", *options)
        return re.search(r"position: \[(.*)\]", path.read_text()).group(1)

    def test_a_camera_may_be_named(self):
        for name in ("image_07.png", "image_07", "7"):
            self.assertEqual(self.position("--camera", name), self.position("--camera", "7"))
        result = self.run_tool(EXAMPLE, self.field, "-o", self.folder / "p.yaml", "--camera", "image_7")
        self.assertEqual(result.returncode, 2)
        self.assertIn("image_00.png", result.stderr.strip().splitlines()[-1])

    def test_never_starts_at_an_image_that_cannot_be_read(self):
        middle = self.field.parent / "image_12.png"
        self.assertEqual(self.position(), self.position("--camera", "12"))
        middle.write_bytes(middle.read_bytes()[:500])
        broken = self.position()
        middle.unlink()
        self.assertEqual(self.position(), broken)
        self.assertNotEqual(self.position(), self.position("--camera", "12"))

    def test_says_where_it_is_not_sure_and_keeps_the_picture_sharp(self):
        self.field = write_field(self.folder / "noise")  # every image is another
        path, words = self.example("--move", "static")
        self.assertIn("warning: not sure what to focus on", words)
        self.assertIn("--focus", words)
        aperture = float(re.search(r"aperture_diameter: (\S+)", path.read_text()).group(1))
        self.assertLess(aperture, 0.1 * PITCH)

    def colmap(self, depths):
        """Noise, which no two images share, with a model whose points lie at these depths."""
        folder = self.folder / "colmap"
        write_field(folder / "images")
        (folder / "images" / "transforms.json").unlink()
        model = folder / "sparse" / "0"
        model.mkdir(parents=True)
        (model / "cameras.txt").write_text(
            f"1 PINHOLE {WIDTH} {HEIGHT} 70 70 {WIDTH / 2} {HEIGHT / 2}\n")
        (model / "images.txt").write_text("".join(
            f"{i + 1} 1 0 0 0 {(2 - i % SIDE) * PITCH} {(2 - i // SIDE) * PITCH} 0 1 "
            f"image_{i:02d}.png\n\n" for i in range(SIDE * SIDE)))
        random = np.random.default_rng(1)
        places = random.uniform(-0.4, 0.4, (len(depths), 2))
        (model / "points3D.txt").write_text("".join(
            f"{i} {x * depth} {y * depth} {depth} 9 9 9 0.5 {i % 12 + 1} 0 13 0\n"
            for i, ((x, y), depth) in enumerate(zip(places, depths))))
        self.field = folder

    def test_points_tell_the_focus_if_the_images_do_not(self):
        random = np.random.default_rng(2)
        self.colmap(np.concatenate([random.uniform(0.79, 0.81, 200), random.uniform(0.5, 5, 60)]))
        path, words = self.example("--move", "static")
        focus = float(re.search(r"focus_distance: (\S+)", path.read_text()).group(1))
        self.assertAlmostEqual(focus, 0.8, delta=0.02 * 0.8)
        self.assertRegex(words, r"focused at 0\.\d+ by the points of the reconstruction, since the LF "
                                "images around agree")
        self.assertNotIn("not sure", words)
        result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / "frames")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_points_anywhere_tell_no_focus(self):
        self.colmap(1 / np.random.default_rng(2).uniform(0.2, 2, 300))
        _, words = self.example("--move", "static")
        self.assertIn("warning: not sure what to focus on", words)
        self.assertRegex(words, r"and \d+ of the \d+ points of the reconstruction that it shows lie at")

    def test_the_frame_shows_nothing_that_its_lf_image_does_not(self):
        calibration = json.loads(self.field.read_text())
        calibration["cx"] = WIDTH / 4  # a quarter of the image is left of the axis
        self.field.write_text(json.dumps(calibration))
        path, _ = self.example("--move", "static", "--focus", "0.9")
        width, height = map(int, re.search(r"resolution: \[(\d+), (\d+)\]", path.read_text()).groups())
        self.assertEqual((width, height), (WIDTH // 2, HEIGHT // 2))
        result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / "frames", "--fill", "off")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("warning", result.stderr)

    def test_the_horizon_is_level(self):
        calibration = json.loads(self.field.read_text())
        angle = np.radians(6)  # camera 12 leans to the side
        turned = [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
        for row, values in zip(calibration["frames"][12]["transform_matrix"], turned):
            row[:3] = values
        self.field.write_text(json.dumps(calibration))
        path, _ = self.example("--move", "static", "--focus", "0.9")
        up = [float(v) for v in re.search(r"up: \[(.*)\]", path.read_text()).group(1).split(",")]
        self.assertLess(abs(up[0]), 0.01)

    def test_an_unknown_camera_is_an_error_that_names_the_range(self):
        result = self.run_tool(EXAMPLE, self.field, "-o", self.folder / "p.yaml", "--camera", "25")
        self.assertEqual(result.returncode, 3)
        self.assertIn("0 to 24", result.stderr.strip().splitlines()[-1])
        self.assertFalse((self.folder / "p.yaml").exists())


if __name__ == "__main__":
    EXAMPLE, RENDERER = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
