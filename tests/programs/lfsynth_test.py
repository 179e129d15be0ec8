#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfsynth: it writes a light field that the other programs can read.

usage: lfsynth_test.py LFSYNTH LFEXAMPLE LFRENDERER
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
from PIL import Image

SYNTH = EXAMPLE = RENDERER = None


class SynthTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def run_tool(self, *arguments, code=0):
        result = subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=400)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        return result.stderr

    def synth(self, scene, name, *options, **keys):
        self.run_tool(SYNTH, scene, "-o", self.folder / name, *options, **keys)
        return self.folder / name

    def test_every_scene_capture_and_format_can_be_filmed(self):
        cases = [("still-life", "planar", ["--bayer", "--noise", "0.01"]),
                 ("lights", "band", ["--format", "png", "--jitter", "0.2"]),
                 ("chart", "hemisphere", ["--format", "png16"]),
                 ("chart", "planar", [])]
        for scene, capture, options in cases:
            with self.subTest(f"{scene} {capture} {options}"):
                field = self.synth(scene, f"{scene}-{capture}", "--capture", capture, "--count", 25,
                                   "--size", "60x40", *options)
                calibration = json.loads((field / "transforms.json").read_text())
                for frame in calibration["frames"]:
                    self.assertTrue((field / frame["file_path"]).exists())
                path = self.folder / "path.yaml"
                self.run_tool(EXAMPLE, field, "-o", path, "--move", "static", "--focus", "0.8")
                out = self.folder / f"{scene}-{capture}-frames"
                self.run_tool(RENDERER, field, path, "-o", out, "--frames", 1, "--format", "png")
                self.assertGreater(np.asarray(Image.open(out / "frame_0001.png")).max(), 20)

    def test_nan_is_no_number(self):
        for option in ("--distortion=nan", "--fov=NaN", "--spacing=nan", "--distortion=0.1,nan"):
            self.assertIn("expected", self.run_tool(SYNTH, "chart", "-o", self.folder / "nan",
                                                    option, code=2))

    def test_truth_is_written_beside_the_light_field(self):
        field = self.synth("lights", "lights", "--count", 9, "--size", "48x32")
        path = self.folder / "path.yaml"
        self.run_tool(EXAMPLE, field, "-o", path, "--move", "static", "--focus", "1")
        path.write_text("\n".join("frames: 2" if line.startswith("frames:") else line
                                  for line in path.read_text().splitlines()) + "\n")
        self.synth("lights", "lights", "--calibration-only", "--truth", path, "--truth-samples", 4,
                   "--overwrite")
        names = sorted(file.name for file in (field / "truth").iterdir())
        self.assertEqual(names, ["frame_0001.exr", "frame_0002.exr"])

    def test_an_older_field_is_replaced_whole(self):
        first = ("--size", "24x16", "--samples", 1)
        options = (*first, "--overwrite")
        field = self.synth("chart", "field", "--count", 9, *first)
        (field / "images/0009.exr").write_bytes(b"of somebody else")
        self.synth("lights", "field", "--count", 4, "--calibration-only", *options)
        self.assertEqual(len(list((field / "images").iterdir())), 10)
        self.synth("chart", "field", "--count", 9, *options)
        self.synth("lights", "field", "--count", 4, *options)
        self.assertEqual(sorted(file.name for file in (field / "images").iterdir()),
                         ["0000.exr", "0001.exr", "0002.exr", "0003.exr", "0009.exr"])

    def test_a_light_field_of_another_form_is_not_hidden(self):
        folder = self.folder / "other"
        folder.mkdir()
        (folder / "scene_par.txt").write_text("1\na.png 1 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0 0 1 0 0 0\n")
        options = ("-o", folder, "--count", 1, "--size", "24x16", "--samples", 1)
        said = self.run_tool(SYNTH, "chart", *options, code=2)
        self.assertIn("holds a light field that lfsynth did not write", said)
        self.assertEqual([file.name for file in folder.iterdir()], ["scene_par.txt"])
        self.run_tool(SYNTH, "chart", *options, "--overwrite")
        self.assertTrue((folder / "transforms.json").exists())

    def test_a_calibration_alone_may_have_very_many_cameras(self):
        field = self.synth("chart", "wide", "--calibration-only", "--count", 10000)
        self.assertEqual(len(json.loads((field / "transforms.json").read_text())["frames"]), 10000)
        self.assertEqual([file.name for file in field.iterdir()], ["transforms.json"])

    def test_seeds_choose_the_jitter(self):
        def poses(name, *options):
            field = self.synth("chart", name, "--calibration-only", "--overwrite", "--count", 9, *options)
            return (field / "transforms.json").read_text()
        self.assertEqual(poses("a", "--jitter", 0.5), poses("b", "--jitter", 0.5))
        self.assertNotEqual(poses("a", "--jitter", 0.5), poses("c", "--jitter", 0.5, "--seed", 1))

    def test_calls_that_contradict_themselves_are_refused_before_anything_is_written(self):
        for words, *options in (
                ("cannot be combined", "--bayer", "--format", "png"),
                ("add --bayer", "--noise", 0.1),
                ("--count and --distance", "--capture", "hemisphere", "--spacing", 0.1),
                ("spacing -1", "--spacing", -1),
                ("longer than its circle", "--capture", "band", "--count", 90000),
                ("--size", "--size", "0x10"),
                ("planar", "--capture", "sphere")):
            with self.subTest(options):
                words_said = self.run_tool(SYNTH, "chart", "-o", self.folder / "no", *options,
                                           code=2).strip().splitlines()[-1]
                self.assertTrue(words_said.startswith("error: "), words_said)
                self.assertIn(words, words_said)
                self.assertFalse((self.folder / "no").exists())
        missing = self.run_tool(SYNTH, "chart", "-o", self.folder / "no", "--truth",
                                self.folder / "none.yaml", code=3)
        self.assertIn("none.yaml", missing)
        self.assertFalse((self.folder / "no").exists())

    def test_interrupted_it_leaves_no_calibration_and_says_so(self):
        field = self.folder / "field"
        process = subprocess.Popen([SYNTH, "still-life", "-o", field], stderr=subprocess.PIPE,
                                   text=True)
        while not (field / "images" / "0000.exr").exists():
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        words = process.communicate(timeout=240)[1].strip().splitlines()[-1]
        self.assertEqual(process.returncode, 5)
        self.assertRegex(words, r"^error: .*stopped after \d+ of 289 images")
        self.assertFalse((field / "transforms.json").exists())


if __name__ == "__main__":
    SYNTH, EXAMPLE, RENDERER = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
