#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that virtual LF images fill the lenses of films in captures around an object and in rows, and that lfexample
chooses such lenses.

usage: densified_films_test.py LFDENSIFY LFSYNTH LFRENDERER LFEXAMPLE
"""
import json
import os
import re
import shlex
import sqlite3
import shutil
import sys
import tempfile
import unittest

import numpy as np

from program_test_case import ProgramTestCase

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402

DENSIFY = SYNTH = RENDERER = EXAMPLE = None
SIZE = (120, 90)


def psnr(a, b):
    return -10 * np.log10(np.mean((np.clip(a, 0, 1) - np.clip(b, 0, 1)) ** 2))


def colours(file):
    return cv2.imread(str(file), cv2.IMREAD_UNCHANGED)[..., :3]


class DensifiedFilmsTest(ProgramTestCase):
    dome_folder = None

    def setUp(self):
        super().setUp()
        self.field = self.folder / "field"

    def dome(self):
        """Has photographs all around a still life, about 13 degrees apart."""
        if not self.dome_folder:
            folder = tempfile.TemporaryDirectory()
            self.addClassCleanup(folder.cleanup)
            self.succeeds(SYNTH, "still-life", "-o", f"{folder.name}/field", "--capture", "hemisphere", "--count", 120,
                          "--size", "{}x{}".format(*SIZE), "--format", "png", "-q")
            type(self).dome_folder = folder.name
        shutil.copytree(f"{self.dome_folder}/field", self.field)

    def poses(self):
        return [np.array(frame["transform_matrix"])
                for frame in json.loads((self.field / "transforms.json").read_text())["frames"]]

    def keep(self, numbers):
        """Keeps some LF cameras of the light field."""
        file = self.field / "transforms.json"
        calibration = json.loads(file.read_text())
        calibration["frames"] = [calibration["frames"][number] for number in numbers]
        file.write_text(json.dumps(calibration))

    def write_path(self, name, poses, aperture, focus):
        """Writes a path through poses in the axes of OpenGL, one frame each."""
        frames = [pose.tolist() for pose in poses]
        text = json.loads((self.field / "transforms.json").read_text())
        fov_deg = float(np.degrees(2 * np.arctan(text["w"] / 2 / text["fl_x"])))
        keys = ",\n    ".join("{{time: {}, value: {}}}".format(i, [row[3] for row in frame[:3]])
                              for i, frame in enumerate(frames))
        first = poses[0]
        look = (first[:3, 3] - focus * first[:3, 2]).tolist()
        path = self.folder / name
        path.write_text(f"""format: lfpath 1
fps: 1
frames: {len(frames)}
resolution: [{SIZE[0]}, {SIZE[1]}]
camera:
  field_of_view_deg: {fov_deg}
  focal_length_mm: 40
  position: {first[:3, 3].tolist()}
  look_at: {look}
  up: {first[:3, 1].tolist()}
  follow: look_at
lens:
  aperture_diameter: {aperture}
  focus_distance: {focus}
keyframes:
  position: [{keys}]
""")
        return path

    def frame(self, light_field, path, *options, number=1):
        out = self.folder / "frames"
        self.succeeds(RENDERER, light_field, path, "-o", out, "-q", "--overwrite", "--no-contact-sheet", *options)
        return colours(out / f"frame_{number:04}.exr")

    def truth(self, path, *options):
        out = self.folder / "truth"
        self.succeeds(SYNTH, "still-life", "-o", out, "--calibration-only", "--truth", path, "-q", "--overwrite",
                      *options)
        return colours(out / "truth" / "frame_0001.exr")

    def densify(self, path, *options):
        store = self.folder / "dense.lfs"
        words = [DENSIFY, self.field, path, "-o", store, "-q", "--overwrite", "--json", *options]
        return store, json.loads(self.succeeds(*words))

    def test_around_an_object_the_lens_is_filled(self):
        self.dome()
        self.fails(3, ["surround the scene", "camera path"], DENSIFY, self.field, "-o", self.folder / "dense.lfs", "-q")
        path = self.write_path("path.yaml", [self.poses()[52]], 0.05, 0.85)
        store, report = self.densify(path, "--most", 60)
        self.assertGreater(report["virtual"], 10)
        self.assertGreater(np.median([test["virtual_psnr_db"] - test["mean_psnr_db"] for test in report["tests"]]), 1.5)
        truth = self.truth(path, "--capture", "hemisphere", "--count", 120)
        recorded = psnr(self.frame(self.field, path), truth)
        densified = psnr(self.frame(store, path), truth)
        self.assertGreater(densified, recorded + 2)

    def test_virtual_lf_cameras_stand_in_the_lenses_alone(self):
        self.dome()
        poses = self.poses()
        path = self.write_path("path.yaml", [poses[52], poses[53]], 0.05, 0.85)
        store, _ = self.densify(path, "--most", 60)
        with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
            places = np.array(database.execute(
                "select x, y, z from lf_images join virtual_images using (id)").fetchall())
        self.assertGreater(len(places), 20)
        centres = [poses[52][:3, 3], poses[53][:3, 3]]
        for place in places:
            self.assertLess(min(np.linalg.norm(place - centre) for centre in centres), 0.06)

    def test_a_row_is_widened_by_half_of_its_spacing(self):
        self.succeeds(SYNTH, "still-life", "-o", self.field, "--count", 81, "--size", "{}x{}".format(*SIZE),
                      "--spacing", 0.04, "--format", "png", "-q")
        self.keep(range(36, 45))
        self.fails(3, ["on one line", "camera path"], DENSIFY, self.field, "-o", self.folder / "dense.lfs", "-q")
        pose = self.poses()[4]
        path = self.write_path("path.yaml", [pose], 0.04, 0.5)
        store, report = self.densify(path, "--most", 80)
        self.assertIsNone(report["filled_diameter_w"])
        wide = self.write_path("wide.yaml", [pose], 0.1, 0.5)
        self.assertAlmostEqual(self.densify(wide, "--most", 80)[1]["filled_diameter_w"], 0.04, delta=0.012)
        self.assertGreater(sum(not test["beyond"] for test in report["tests"]), 2)
        self.assertGreater(sum(test["beyond"] for test in report["tests"]), 1)
        truth = self.truth(path)
        self.assertGreater(psnr(self.frame(store, path), truth), psnr(self.frame(self.field, path), truth) + 2)

    def test_an_example_for_virtual_lf_images_films_them(self):
        self.dome()
        path = self.folder / "path.yaml"
        words = [EXAMPLE, self.field, "-o", path, "--move", "static", "--camera", 52, "--focus", 0.85]
        self.succeeds(*words)
        narrow = float(re.search(r"aperture_diameter: (\S+)", path.read_text()).group(1))
        printed = self.call(*words, "--densify").stderr
        wide = float(re.search(r"aperture_diameter: (\S+)", path.read_text()).group(1))
        self.assertIn("virtual LF images help", printed)
        self.assertGreater(wide, 20 * narrow)
        command = shlex.split(re.search(r"next: (.*)", printed).group(1))
        self.assertIn("--densify", command)
        command[0] = RENDERER
        command[command.index("-o") + 1] = self.folder / "film"
        self.succeeds(*command, "-q")
        self.assertTrue((self.folder / "film/densified.lfs").exists())
        self.assertTrue((self.folder / "film/frame_0001.exr").exists())

    def test_an_example_says_that_virtual_lf_images_do_not_help(self):
        """LF cameras that all see different noise."""
        self.dome()
        random = np.random.default_rng(1)
        for file in (self.field / "images").iterdir():
            cv2.imwrite(str(file), random.integers(0, 255, (SIZE[1], SIZE[0], 3)))
        path = self.folder / "path.yaml"
        done = self.call(EXAMPLE, self.field, "-o", path, "--move", "static", "--camera", 52, "--focus", 0.85,
                         "--densify")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("virtual LF images help", done.stderr)
        self.assertRegex(done.stderr, "do not help|not sure")
        self.assertNotIn("--densify --", done.stderr.split("next:")[1])


if __name__ == "__main__":
    DENSIFY, SYNTH, RENDERER, EXAMPLE = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1])
