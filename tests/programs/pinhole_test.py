#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the warning of films whose aperture is 0 in all frames, as in paths from Blender: the command that it prints
makes a path with a lens of the capture, and films of a pinhole that is meant have no warning.

usage: pinhole_test.py LFRENDERER LFPREPROCESSOR LFPATH LFEXAMPLE
"""
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import unittest

from program_test_case import ProgramTestCase
from small_field import wall, write_field, write_path

RENDERER = PREPROCESSOR = LFPATH = EXAMPLE = None
WORDS = "warning: the aperture is 0 in "


class PinholeTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field = write_field(self.folder / "a field", wall)
        self.path = write_path(self.folder, aperture=0)

    def said(self, program, *words, code=0):
        """Runs a program in the folder. Returns its lines on stderr that warn of a pinhole."""
        done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        return [line for line in done.stderr.splitlines() if line.startswith(WORDS)]

    def film(self, name, *options, field="a field", path="path.yaml"):
        """Returns the warnings of a render, the bits of its frames, and its report."""
        warnings = self.said(RENDERER, field, path, "-o", name, "--no-contact-sheet", *options)
        frames = sorted((self.folder / name).glob("frame_*.exr"))
        bits = [hashlib.sha256(frame.read_bytes()).hexdigest() for frame in frames]
        return warnings, bits, json.loads((self.folder / name / "report.json").read_text())

    def test_the_printed_command_makes_a_path_with_a_lens(self):
        warnings, _, report = self.film("pinhole")
        self.assertEqual(len(warnings), 1)
        self.assertTrue(warnings[0].startswith(WORDS + "all 3 frames: a pinhole"), warnings[0])
        command = warnings[0].rsplit(": ", 1)[1]
        self.assertTrue(command.startswith("lfpath path.yaml -o lens.yaml --lightfield 'a field' --f-number "), command)
        programs = f"{pathlib.Path(LFPATH).parent}:{os.environ['PATH']}"
        subprocess.run(command, shell=True, check=True, cwd=self.folder, env={**os.environ, "PATH": programs},
                       capture_output=True)
        none, _, lens = self.film("lens", path="lens.yaml")
        self.assertEqual(none, [])
        self.assertGreater(lens["frames"][0]["lf_images"], 2 * report["frames"][0]["lf_images"])
        # The next warning does not advise to replace this path.
        self.assertIn(" -o lens-2.yaml ", self.film("again", "--frames", 1)[0][0])

    def test_a_film_that_begins_at_1001_warns(self):
        self.path.write_text(self.path.read_text().replace("frames: 3\n", "frames: 3\nfirst_frame: 1001\n"))
        for options in ([], ["--frames", 1002]):
            warnings = self.film(f"later{len(options)}", *options)[0]
            self.assertEqual(len(warnings), 1)
            self.assertIn("lfpath path.yaml", warnings[0])

    def test_packages_warn_when_they_are_made(self):
        self.assertEqual(len(self.said(PREPROCESSOR, "a field", "path.yaml", "-o", "packages")), 1)
        self.assertEqual(self.said(PREPROCESSOR, "a field", "path.yaml", "-o", "more", "--lens-weights", "hat"), [])

    def test_a_pinhole_that_is_meant_has_no_warning(self):
        _, plain, _ = self.film("plain")
        warnings, bits, _ = self.film("hat", "--lens-weights", "hat")
        self.assertEqual((warnings, bits), ([], plain))
        for number, options in enumerate((["--mode", "hybrid"], ["--mode", "rebin"],
                                          ["--lens-weights", "none", "--fill", "off"])):
            self.assertEqual(self.film(f"meant{number}", *options)[0], [], options)

    def test_a_lens_in_some_frame_is_enough(self):
        text = self.path.read_text().replace("keyframes:", "keyframes:\n  aperture_diameter: "
                                             "[{time: 0, value: 0}, {time: 0.04, value: 0.03}]")
        self.path.write_text(text)
        self.assertEqual(self.film("opens")[0], [])
        self.assertEqual(self.film("first", "--frames", 1)[0], [])
        self.assertEqual(self.film("second", "--frames", 2)[0], [])

    def test_lf_cameras_far_apart_need_virtual_lf_images(self):
        calibration = json.loads(self.field.read_text())
        for frame in calibration["frames"]:
            for row in range(2):
                frame["transform_matrix"][row][3] *= 40
        self.field.write_text(json.dumps(calibration))
        warnings = self.film("far", "--fill", 32, "--frames", 1)[0]
        self.assertIn("such a film needs virtual LF images (--densify)", warnings[0])
        self.assertIn(" lfpath path.yaml -o lens.yaml ", warnings[0])

    def test_lenses_of_examples_and_of_captures_without_a_lens(self):
        self.said(EXAMPLE, "a field", "-o", "example.yaml")
        self.assertEqual(self.film("example", path="example.yaml")[0], [])
        calibration = json.loads(self.field.read_text())
        calibration["frames"] = calibration["frames"][12:13]
        self.field.write_text(json.dumps(calibration))
        warnings = self.film("single", "--fill", 32)[0]
        self.assertEqual(len(warnings), 1)
        self.assertNotIn("lfpath", warnings[0])


if __name__ == "__main__":
    RENDERER, PREPROCESSOR, LFPATH, EXAMPLE = sys.argv[1:5]
    del sys.argv[1:5]
    unittest.main()
