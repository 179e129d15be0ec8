#!/usr/bin/python3
"""lfexample: the path it writes renders, and is focused on what there is to see.

usage: lfexample_test.py LFEXAMPLE LFRENDERER
"""
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
        return subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=120)

    def example(self, *options):
        path = self.folder / "path.yaml"
        result = self.run_tool(EXAMPLE, self.field, "-o", path, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path, result.stderr

    def test_every_move_renders(self):
        for move in ("static", "orbit", "dolly", "focus-pull"):
            path, _ = self.example("--move", move)
            result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / move, "--frames",
                                   "1,25,50")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((self.folder / move / "frame_0050.exr").exists())

    def test_focuses_on_the_wall(self):
        path, words = self.example("--move", "static")
        focus = float(re.search(r"focus_distance: (\S+)", path.read_text()).group(1))
        self.assertAlmostEqual(focus, DEPTH, delta=0.12 * DEPTH)
        self.assertIn("sharpest", words)

    def test_takes_the_focus_and_the_camera_it_is_given(self):
        path, _ = self.example("--move", "static", "--focus", "0.9", "--camera", "0")
        text = path.read_text()
        self.assertIn("focus_distance: 0.9 ", text)
        position = re.search(r"position: \[(.*)\]", text).group(1)
        x, y, _ = map(float, position.split(","))
        self.assertAlmostEqual(x, -2 * PITCH, places=6)

    def test_an_unknown_camera_is_an_error_that_names_the_range(self):
        result = self.run_tool(EXAMPLE, self.field, "-o", self.folder / "p.yaml", "--camera", "25")
        self.assertEqual(result.returncode, 3)
        self.assertIn("0 to 24", result.stderr.strip().splitlines()[-1])
        self.assertFalse((self.folder / "p.yaml").exists())


if __name__ == "__main__":
    EXAMPLE, RENDERER = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
