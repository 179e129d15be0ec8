#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfcammvminfo from a user's view, on the examples and on the path of doc/formats/path.md.

usage: lfcammvminfo_test.py LFCAMMVMINFO REPOSITORY
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, REPOSITORY = None, None


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=60, **options)


class CameraMovementTest(unittest.TestCase):
    def setUp(self):
        self.path = REPOSITORY / "examples" / "focus-pull.yaml"

    def fails(self, code, words, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        last = result.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("error: "), last)
        for word in words:
            self.assertIn(word, last)

    def json_of(self, *arguments):
        result = run(*arguments, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_every_example_is_a_path(self):
        examples = sorted((REPOSITORY / "examples").glob("*.yaml"))
        self.assertGreaterEqual(len(examples), 3)
        for example in examples:
            with self.subTest(example.name):
                path = self.json_of(example)
                self.assertEqual(len(path["cameras"]), path["frames"])

    def test_the_path_in_the_manual_is_a_path(self):
        manual = (REPOSITORY / "doc" / "formats" / "path.md").read_text()
        text = re.search(r"```yaml\n(format: .*?)```", manual, re.S).group(1)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "path.yaml"
            path.write_text(text)
            self.assertEqual(self.json_of(path)["frames"], 60)

    def test_the_views_of_a_moment_have_its_time(self):
        text = re.sub(r"(?m)^frames:.*$", "frames: 6\nviews: 2", self.path.read_text())
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "path.yaml"
            path.write_text(text)
            told = self.json_of(path)
        self.assertEqual([round(camera["time_s"] * told["fps"]) for camera in told["cameras"]], [0, 0, 1, 1, 2, 2])

    def test_the_manual_has_every_key(self):
        manual = (REPOSITORY / "doc" / "formats" / "path.md").read_text()
        for section in "camera", "lens":
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "path.yaml"
                path.write_text(self.path.read_text().replace(f"{section}:", f"{section}:\n  x: 0"))
                known = run(path).stderr.split("known are: ")[1].split(" (")[0].strip().split(", ")
            self.assertGreater(len(known), 15)
            for key in known:
                if "speed" not in key:
                    self.assertRegex(manual, rf"`{key.removesuffix('_mm')}`")

    def test_tells_the_focus_pull(self):
        path = self.json_of(self.path)
        first, last = path["cameras"][0], path["cameras"][-1]
        self.assertEqual(first["frame"], 1)
        self.assertEqual(first["time_s"], 0)
        self.assertAlmostEqual(last["time_s"], 3)
        self.assertAlmostEqual(first["focus_distance_w"], 0.3)
        self.assertAlmostEqual(last["focus_distance_w"], 0.5)
        self.assertAlmostEqual(first["f_number"], 50 / 8)
        near, far = last["depth_of_field_w"]
        self.assertTrue(near < 0.5 < far)

    def test_a_pinhole_is_infinite_in_csv_and_null_in_json(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "path.yaml"
            path.write_text(re.sub(r"aperture_diameter_mm: .*", "aperture_diameter_mm: 0",
                                   self.path.read_text(), count=1).split("keyframes:")[0])
            self.assertIsNone(self.json_of(path)["cameras"][0]["f_number"])
            row = next(csv.DictReader(run(path, "--csv").stdout.splitlines()))
            self.assertEqual(row["f_number"], "inf")

    def test_table_and_csv_have_a_line_per_frame(self):
        table = run(self.path).stdout.splitlines()
        header = next(i for i, line in enumerate(table) if line.startswith("  frame"))
        self.assertEqual(len(table[header + 2:]), 76)
        rows = list(csv.DictReader(run(self.path, "--csv").stdout.splitlines()))
        self.assertEqual([row["frame"] for row in rows], [str(i) for i in range(1, 77)])
        self.assertEqual(float(rows[0]["position_w.z"]), -0.4)

    def test_one_frame_is_a_block(self):
        block = run(self.path, "--frame", 76).stdout
        self.assertRegex(block, r"(?m)^focus_distance_w +0\.5$")
        self.assertEqual(len(self.json_of(self.path, "--frame", 3)["cameras"]), 1)

    def test_millimetres_follow_the_unit(self):
        camera = self.json_of(self.path, "--unit-m", "0.01")["cameras"][0]
        self.assertAlmostEqual(camera["aperture_diameter_mm"], 8)
        self.assertAlmostEqual(camera["focus_distance_w"], 0.3)  # now 3 mm; the f-number does not change
        self.assertAlmostEqual(camera["f_number"], 50 / 8)

    def test_errors_say_what_to_do(self):
        self.fails(3, ["nowhere.yaml"], "nowhere.yaml")
        self.fails(2, ["--frame 77", "1 to 76"], self.path, "--frame", 77)
        self.fails(2, ["--csv"], self.path, "--csv", "--json")
        self.fails(2, ["PATH"])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "path.yaml"
            path.write_text(self.path.read_text().replace("focal_length_mm", "focal_lenght_mm"))
            self.fails(3, [f"{path}:12:3: ", "did you mean 'focal_length_mm'?"], path)

    def test_a_full_disk_is_an_error(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([PROGRAM, self.path], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, 4)

    def test_help_has_examples(self):
        result = run("--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("lfcammvminfo path.yaml --frame 12", result.stdout)


if __name__ == "__main__":
    PROGRAM, REPOSITORY = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
