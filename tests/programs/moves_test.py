#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the moves of lfexample on captures from 3 x 3 LF cameras to a track held by hand: a camera moves or says why
not, within the recorded positions, level, and sees only what LF cameras have recorded.

usage: moves_test.py LFSYNTH LFEXAMPLE LFRENDERER
"""
import json
import re
import sys
import unittest

import numpy as np
import yaml
from PIL import Image

from program_test_case import ProgramTestCase

SYNTH = EXAMPLE = RENDERER = None
WIDTH, HEIGHT, DISTANCE = 72, 48, 0.75
MOVES = ("orbit", "dolly", "along")


def positions_of(field):
    """Returns the positions of the LF cameras."""
    frames = json.loads((field / "transforms.json").read_text())["frames"]
    return np.array([np.array(frame["transform_matrix"])[:3, 3] for frame in frames])


def keys_of(path):
    return np.array([key["value"] for key in yaml.safe_load(path.read_text())["keyframes"]["position"]])


class MovesTest(ProgramTestCase):
    def synth(self, *options):
        field = self.folder / "field"
        self.succeeds(SYNTH, "still-life", "-o", field, "--size", f"{WIDTH}x{HEIGHT}", "--samples", 2, "--format",
                      "png", "--distance", DISTANCE, "-q", "--overwrite", *options)
        return field

    def example(self, field, *options, code=0):
        path = self.folder / "path.yaml"
        path.unlink(missing_ok=True)
        result = self.call(EXAMPLE, field, "-o", path, *options)
        self.assertEqual(result.returncode, code, result.stderr)
        return path, result.stderr

    def film(self, field, path):
        """Returns the first frame and that of half time, without filling."""
        frames = yaml.safe_load(path.read_text())["frames"]
        report = json.loads(self.succeeds(RENDERER, field, path, "-o", self.folder / "film", "--frames",
                                          f"1,{frames // 2}", "--fill", "off", "--format", "png", "--overwrite",
                                          "--json", "-q"))
        for frame in report["frames"]:
            elements = np.prod(report["resolution"])
            self.assertLess(max(frame["elements_without_ray"]) / elements, 0.015, frame["frame"])
        return [np.asarray(Image.open(file).convert("RGB"), float)
                for file in sorted((self.folder / "film").glob("frame_*.png"))]

    def expect_movement(self, field, path, words):
        """The film must change where no warning says that the movement is hardly visible, and its lens must stay
        within the recorded positions."""
        first, later = self.film(field, path)
        if "hardly be visible" not in words:
            self.assertGreater(np.abs(first - later).mean(), 2, words)
        keys = keys_of(path)
        self.assertGreater(np.linalg.norm(np.ptp(keys, axis=0)), 0)
        return keys

    def test_a_camera_moves_within_the_grid(self):
        for side, spacing in ((3, 0.02), (5, 0.02), (9, 0.012), (17, 0.006)):
            field = self.synth("--count", side * side, "--spacing", spacing)
            recorded = positions_of(field)
            right = (recorded[side - 1] - recorded[0]) / np.linalg.norm(recorded[side - 1] - recorded[0])
            up = (recorded[-1] - recorded[side - 1]) / np.linalg.norm(recorded[-1] - recorded[side - 1])
            for move in MOVES:
                with self.subTest(side=side, move=move):
                    path, words = self.example(field, "--move", move, "--focus", DISTANCE)
                    self.assertRegex(words, r"degrees as seen from the subject|% of the focus distance: ")
                    keys = self.expect_movement(field, path, words)
                    radius = yaml.safe_load(path.read_text())["lens"]["aperture_diameter"] / 2
                    for axis in (right, up):
                        across = (keys - recorded[0]) @ axis
                        extent = (recorded[-1] - recorded[0]) @ axis
                        self.assertGreaterEqual(across.min(), radius - 1e-6)
                        self.assertLessEqual(across.max(), extent - radius + 1e-6)
                        if move == "orbit":  # all that the grid allows
                            self.assertGreaterEqual(np.ptp(across), extent - 2 * radius - 1e-6)

    def test_a_dense_grid_is_filmed_by_a_moving_camera(self):
        field = self.synth("--count", 81, "--spacing", 0.01)
        for move, expected in (("orbit", 0.03), ("dolly", 0.06), ("along", 0.03)):
            path, words = self.example(field, "--move", move, "--focus", DISTANCE)
            self.assertNotIn("warning", words)
            self.assertGreaterEqual(np.linalg.norm(np.ptp(keys_of(path), axis=0)), expected, words)

    def test_a_movement_that_nobody_would_see_is_refused(self):
        field = self.synth("--count", 9, "--spacing", 0.000005)
        for move in MOVES:
            self.fails(3, ["no room for a visible movement", "--move focus-pull"], EXAMPLE, field, "-o",
                       self.folder / "no.yaml", "--move", move, "--focus", DISTANCE)
            self.assertFalse((self.folder / "no.yaml").exists())

    def video(self):
        """Writes an arc of 30 degrees as a hand films it, 120 LF images: shaken, and around the subject."""
        field = self.synth("--capture", "band", "--count", 360, "--spacing", 0.00333, "--jitter", 0.4)
        calibration = json.loads((field / "transforms.json").read_text())
        calibration["frames"] = calibration["frames"][120:240]
        (field / "transforms.json").write_text(json.dumps(calibration))
        return field

    def test_a_video_held_by_hand_is_filmed_along_its_track(self):
        field = self.video()
        path, words = self.example(field, "--focus", DISTANCE)
        self.assertRegex(words, r"the camera moves \S+ in world units along the recorded track, smoothed, from "
                                r"images/01\d\d.png to images/0\d\d\d.png, 1[12](\.\d)? degrees as seen from the "
                                r"subject: a calm film goes no farther")
        self.assertIn("stand in a row, so that it blurs in one direction only", words)
        keys = self.expect_movement(field, path, words)
        recorded = positions_of(field)
        for key in keys:  # near the track, whose cameras stand within 0.4 spacings of an arc
            self.assertLess(np.linalg.norm(recorded - key, axis=1).min(), 0.004)
        steps = np.diff(keys, axis=0)
        lengths = np.linalg.norm(steps, axis=1)
        self.assertLess(lengths.max() / lengths.min(), 1.1)
        # No step turns away from its neighbours: the shaking is gone.
        cosines = (steps[1:] * steps[:-1]).sum(axis=1) / lengths[1:] / lengths[:-1]
        self.assertGreater(cosines.min(), 0.995)
        camera = yaml.safe_load(path.read_text())["camera"]
        up = np.array(camera["up"]) / np.linalg.norm(camera["up"])
        for key in keys:
            forward = camera["look_at"] - key
            right = np.cross(forward, up) / np.linalg.norm(np.cross(forward, up))
            self.assertLess(abs(np.degrees(np.arcsin(right[1]))), 0.5)  # the y axis of the world is vertical

    def test_the_subject_stays_sharp_and_in_the_middle_of_a_film_along_a_track(self):
        path, _ = self.example(self.video(), "--focus", DISTANCE)
        parsed = yaml.safe_load(path.read_text())
        self.assertEqual(parsed["lens"]["focus_point"], parsed["camera"]["look_at"])
        self.assertEqual(parsed["camera"]["follow"], "look_at")

    def test_names_that_are_no_sequence_are_no_track(self):
        field = self.video()
        calibration = json.loads((field / "transforms.json").read_text())
        for index, frame in enumerate(calibration["frames"]):
            name = f"images/{index * 53 % 120:04d}.png"
            (field / frame["file_path"]).rename(field / f"{name}.moved")
            frame["file_path"] = name
        for file in field.glob("images/*.moved"):
            file.rename(file.with_suffix(""))
        (field / "transforms.json").write_text(json.dumps(calibration))
        self.fails(3, ["there is no recorded track", "in the order of their names"], EXAMPLE, field, "-o",
                   self.folder / "no.yaml", "--move", "along", "--focus", DISTANCE)
        _, words = self.example(field, "--focus", DISTANCE)
        self.assertIn("the focus moves from", words)

    def test_positions_of_georeferenced_captures_are_exact(self):
        field = self.synth("--count", 9)
        calibration = json.loads((field / "transforms.json").read_text())
        for frame in calibration["frames"]:
            del frame["lf_translation"]
            for row, offset in zip(frame["transform_matrix"], (312450.7654321, 5634812.1234567, 412.5)):
                row[3] += offset
        (field / "transforms.json").write_text(json.dumps(calibration))
        path, _ = self.example(field, "--move", "static", "--focus", DISTANCE, "--camera", 4)
        camera = yaml.safe_load(path.read_text())["camera"]
        self.assertLess(np.abs(positions_of(field)[4] - camera["position"]).max(), 3e-9)
        distance = np.linalg.norm(np.subtract(camera["look_at"], camera["position"]))
        self.assertAlmostEqual(distance, DISTANCE, places=8)

    def test_no_number_is_minus_zero(self):
        field = self.synth("--count", 9, "--spacing", 0.02)
        for move in (*MOVES, "static", "focus-pull"):
            path, _ = self.example(field, "--move", move, "--focus", DISTANCE)
            self.assertIsNone(re.search(r"-0[,\]}]", path.read_text()), path.read_text())


if __name__ == "__main__":
    SYNTH, EXAMPLE, RENDERER = (sys.argv.pop(1) for _ in range(3))
    unittest.main()
