#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfexample: its path renders, and is focused on what can be seen.

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

import small_field
from small_field import HEIGHT, PITCH, SIDE, WALL_DEPTH, WIDTH, wall, write_field

EXAMPLE = RENDERER = None
DEPTH = WALL_DEPTH


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
        result = self.run_tool(EXAMPLE, self.field, "-o", path, "--overwrite", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path, result.stderr

    def test_every_move_renders(self):
        for move, fewest in (("static", 1), ("along", 50), ("orbit", 50), ("dolly", 50), ("focus-pull", 50)):
            path, _ = self.example("--move", move)
            last = int(re.search(r"\nframes: (\d+)\n", path.read_text()).group(1))
            self.assertTrue(fewest <= last <= (1 if move == "static" else 101), last)
            result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / move, "--frames",
                                   f"1,{last}")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((self.folder / move / f"frame_{last:04d}.exr").exists())

    def film(self, path, name, frames):
        """Films without filling, and returns what the renderer says."""
        result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / name, "--frames", frames,
                               "--fill", "off")
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stderr

    def test_an_orbit_shows_only_what_was_recorded(self):
        # The camera turns to the subject while it moves, beyond the views of the parallel LF cameras.
        self.addCleanup(setattr, small_field, "SIDE", SIDE)
        small_field.SIDE = 15
        self.field = write_field(self.folder / "large", wall)
        path, words = self.example("--move", "orbit", "--focus", DEPTH)
        self.assertRegex(words, r"the orbit is 0\.0\d+ wide and 0\.0\d+ high in world units, \d+(\.\d+)? degrees as "
                                r"seen from the subject[:,]")
        self.assertNotIn("warning", words)
        self.assertNotIn("without rays", self.film(path, "orbit", "1-50x7"))

    def test_an_orbit_around_which_no_camera_stands_is_warned_of(self):
        # LF cameras on a circle around the subject, which look at it: beside the circle there is none.
        calibration = json.loads(self.field.read_text())
        for index, frame in enumerate(calibration["frames"]):
            angle = 2 * np.pi * index / len(calibration["frames"])
            back = np.array([np.sin(angle), 0, np.cos(angle)])
            matrix = np.eye(4)
            matrix[:3, :3] = np.column_stack([np.cross([0, 1, 0], back), [0, 1, 0], back])
            matrix[:3, 3] = back * 0.5
            frame["transform_matrix"] = matrix.tolist()
        self.field.write_text(json.dumps(calibration))
        path, words = self.example("--move", "orbit", "--focus", 0.5)
        self.assertRegex(words, r"the orbit is \S+ wide and \S+ high in world units, \S+ degrees as seen from the "
                                r"subject[,:]")
        position = [list(map(float, match.split(","))) for match in
                    re.findall(r"time: [^}]*value: \[(.*)\]", path.read_text())]
        # The orbit stays within a spacing of the circle; the positions alone would allow one through the subject.
        self.assertLess(np.abs(np.linalg.norm(position, axis=1) - 0.5).max(), 0.125)

    def test_moves_that_a_sparse_capture_cannot_show_are_warned_of(self):
        random = np.random.default_rng(2)
        self.colmap(np.concatenate([random.uniform(0.079, 0.081, 200), random.uniform(0.012, 0.03, 120)]))
        for move, expected in (("focus-pull", "the focus pull will hardly be visible"),
                               ("dolly", "the LF cameras are far apart"), ("static", None)):
            _, words = self.example("--move", move)
            self.assertIn("which holds one LF camera, because", words)
            self.assertEqual("warning" in words, expected is not None, words)
            self.assertIn(expected or "", words)

    def test_a_pull_that_nobody_sees_advises_a_move_that_works(self):
        calibration = json.loads(self.field.read_text())
        calibration["frames"] = calibration["frames"][10:15]  # a row of five
        self.field.write_text(json.dumps(calibration))
        _, words = self.example("--move", "focus-pull", "--focus", DEPTH)
        move, = re.findall(r"--move (\S+) moves the camera instead", words)
        self.example("--move", move, "--focus", DEPTH)

    def test_focuses_on_the_wall(self):
        path, words = self.example("--move", "static")
        focus = float(re.search(r"focus_distance: (\S+)", path.read_text()).group(1))
        self.assertAlmostEqual(focus, DEPTH, delta=0.04 * DEPTH)
        self.assertIn("places of the image", words)
        self.assertNotIn("not sure", words)

    def test_the_focus_pull_stays_near_what_is_there(self):
        # The wall has one depth, so that the pull passes it by a tenth. A given focus says nothing of the depths.
        for options, near, far in (((), 0.9, 1.1), (("--focus", DEPTH), 0.7, 1.6)):
            path, _ = self.example("--move", "focus-pull", *options)
            keys = path.read_text().partition("keyframes:")[2]
            distances = [float(value) for value in re.findall(r"value: ([0-9.]+)\}", keys)]
            self.assertEqual(len(distances), 3, keys)
            # Half a pixel of the largest disparity is 9 % of the depth.
            self.assertAlmostEqual(distances[0] / distances[1], near, delta=0.02)
            self.assertAlmostEqual(distances[2] / distances[1], far, delta=0.02)

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
        self.field = write_field(self.folder / "noise")  # every image is different
        path, words = self.example("--move", "static")
        self.assertIn("warning: the program is not sure what to focus on", words)
        self.assertIn("--focus", words)
        self.assertLess(self.aperture(path), 0.1 * PITCH)

    def test_a_doubt_names_aperture_distances_and_a_command_that_settles_it(self):
        self.field = write_field(self.folder / "no two alike")
        path, words = self.example("--move", "static", "--camera", "7")
        warning = next(line for line in words.splitlines() if "not sure" in line)
        self.assertRegex(warning, r"the aperture \S+, which holds one LF camera, so that the first frame "
                                  r"is sharp at any distance")
        distances = re.search(r"The best focus distances? found: ([^ ]+(, [^ ]+)*)\. ", warning).group(1)
        self.assertIn(len(distances.split(", ")), (1, 2, 3))
        command = warning[warning.index("lfexample "):]
        self.assertIn(f"--focus {distances.split(', ')[0]}", command)
        self.assertIn("--camera 7", command)
        result = subprocess.run(command.replace("lfexample", EXAMPLE, 1), shell=True, capture_output=True,
                                text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("not sure", result.stderr)
        self.assertGreater(self.aperture(path), 2 * PITCH)

    @staticmethod
    def aperture(path):
        return float(re.search(r"aperture_diameter: (\S+)", path.read_text()).group(1))

    def colmap(self, depths, picture=None):
        """Writes pictures, or noise that no two images share, with a model whose points have these depths."""
        folder = self.folder / "colmap"
        write_field(folder / "images", picture)
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
        self.assertRegex(words, r"focused at 0\.\d+ by the points of the reconstruction, because the LF image has no "
                                "texture")
        self.assertNotIn("not sure", words)
        result = self.run_tool(RENDERER, self.field, path, "-o", self.folder / "frames")
        self.assertEqual(result.returncode, 0, result.stderr)

    def focus(self):
        path, words = self.example("--move", "static")
        return float(re.search(r"focus_distance: (\S+)", path.read_text()).group(1)), words

    def test_points_that_agree_with_the_images_change_nothing(self):
        random = np.random.default_rng(2)
        self.colmap(np.concatenate([random.uniform(0.24, 0.26, 20), random.uniform(0.6, 3, 300)]), wall)
        focus, words = self.focus()
        self.assertAlmostEqual(focus, DEPTH, delta=0.04 * DEPTH)
        self.assertIn("places of the image", words)

    def test_points_that_contradict_the_images_are_preferred_if_they_are_sure(self):
        random = np.random.default_rng(2)
        self.colmap(np.concatenate([random.uniform(0.14, 0.16, 20), random.uniform(0.79, 0.81, 200),
                                    random.uniform(0.5, 3, 60)]), wall)
        focus, words = self.focus()
        self.assertAlmostEqual(focus, 0.8, delta=0.02 * 0.8)
        self.assertRegex(words, r"because the LF images agree on the distance 0\.2\d+, "
                                r"but almost none of the \d+ reconstructed points")

    def test_points_that_contradict_the_images_and_each_other_are_a_doubt(self):
        random = np.random.default_rng(2)
        self.colmap(np.concatenate([random.uniform(0.14, 0.16, 20), 1 / random.uniform(0.2, 2, 300)]), wall)
        path, words = self.example("--move", "static")
        self.assertRegex(words, r"not sure what to focus on \(the LF images agree on the distance 0\.2\d+, "
                                r"but almost none")
        self.assertLess(self.aperture(path), 0.1 * PITCH)

    def test_images_that_agree_beyond_all_depths_are_a_doubt(self):
        self.colmap(1 / np.random.default_rng(2).uniform(0.2, 2, 300), wall)
        _, words = self.example("--move", "static")
        self.assertRegex(words, r"not sure what to focus on \(the LF images agree on the distance 0\.2\d+, which is "
                                r"outside the depths of the scene, 0\.\d+ to \d")

    def test_points_anywhere_tell_no_focus(self):
        self.colmap(1 / np.random.default_rng(2).uniform(0.2, 2, 300))
        _, words = self.example("--move", "static")
        self.assertIn("warning: the program is not sure what to focus on", words)
        self.assertRegex(words, r"and \d+ of the \d+ reconstructed points that the LF image shows lie at")

    def test_the_frame_shows_nothing_that_its_lf_image_does_not(self):
        calibration = json.loads(self.field.read_text())
        calibration["cx"] = WIDTH / 4  # a quarter of the image is left of the optical axis
        self.field.write_text(json.dumps(calibration))
        path, _ = self.example("--move", "static", "--focus", "0.9")
        width, height = map(int, re.search(r"resolution: \[(\d+), (\d+)\]", path.read_text()).groups())
        self.assertEqual((width, height), (WIDTH, HEIGHT))
        # The middle of the image is a quarter of the sensor's 36 mm to the right of the optical axis.
        self.assertIn("shift_mm: {horizontal: 9, vertical: 0}", path.read_text())
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
