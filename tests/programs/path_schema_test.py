#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the schema of camera paths and the programs agree: a path that a program accepts is valid, and paths with
planted faults are refused by both.

usage: path_schema_test.py LFCAMMVMINFO LFPATH SOURCE
"""
import copy
import pathlib
import re
import sys
import unittest

import yaml
from PIL import Image

import schema_files
from program_test_case import ProgramTestCase

INFO = PATH = SOURCE = None
GOOD = """format: lfpath 1
fps: 25
frames: 3
unit_m: 1
resolution: [80, 60]
shutter: {angle_deg: 180, samples: 2}
camera:
  position: [0, 0, -1]
  look_at: [0, 0, 0]
  up: [0, -1, 0]
  follow: look_at
  speed: [0.1, 0, 0]
  focal_length_mm: 35
  sensor_width_mm: 36
  shift_mm: {horizontal: 1}
lens:
  aperture_diameter: 0.05
  aperture_diameter_speed_mm: 1
  focus_distance: 0.8
  focus_tilt_deg: {vertical: 3}
  blades: 5
  blade_roundness: 0.5
  ratio: 1.5
  hood_distance: 0.1
  hood_diameter_mm: 100
  breathing: true
accelerations:
  - {quantity: position, from: 0, to: 0.04, value: [0.1, 0, 0]}
keyframes:
  focus_distance_mm: [{time: 0, value: 800}, {time: 1, value: 900, interpolation: linear}]
"""
HEIGHTS = {"surface": "map.png", "kind": "height", "origin": [0, 0, 0], "cell": 0.5}
# Keys and their new values, which the schema and the programs refuse. None removes the key.
FAULTS = [
    ("format", "lfpath 2"), ("fps", 0), ("fps", "fast"), ("fps", "24000/"), ("fps", None), ("frames", 1.5),
    ("frames", 0),
    ("frames", 1000001), ("frames", None), ("resolution", [80]), ("resolution", [80, 0]), ("resolution", [80, 65537]),
    ("resolution", "80x60"), ("unit_m", 0), ("views", 0), ("views", 1.5), ("views", [2]),
    ("colour", 1), ("camera", None), ("camera", []), ("lens", None),
    ("shutter/angle_deg", 361), ("shutter/samples", 0), ("shutter/samples", 65), ("shutter/samples", None),
    ("shutter/curve", 1),
    ("camera/position", None), ("camera/position", [0, 0]), ("camera/position", [0, 0, "a"]),
    ("camera/position", [0, 0, 2e9]), ("camera/position_mm", [0, 0, 0]), ("camera/positon", [0, 0, 0]),
    ("camera/look_at", None), ("camera/orientation", {"yaw": 3}), ("camera/look_at", {"yaw": 3}),
    ("camera/follow", "both"), ("camera/up", [1, 2]), ("camera/speed", 3), ("camera/look_at_speed", {}),
    ("camera/roll_speed_deg", [1]), ("camera/orientation_speed", {"yaw": 1}), ("camera/focal_length_mm", 0),
    ("camera/focal_length_mm", None), ("camera/field_of_view_deg", 60), ("camera/sensor_width", 1),
    ("camera/sensor_width_mm", -1), ("camera/shift_mm", 1), ("camera/shift_mm", {"up": 1}),
    ("camera/focal_length_speed_mm", "1"),
    ("lens/aperture_diameter", -1), ("lens/aperture_diameter", None), ("lens/f_number", 2),
    ("lens/focus_distance", 0), ("lens/focus_distance_mm", 800), ("lens/focus_point", [0, 0, 0]),
    ("lens/focus_tilt_deg", {"vertical": 90}), ("lens/focus_tilt_deg", 5), ("lens/blades", 2), ("lens/blades", 65),
    ("lens/blades", 5.5), ("lens/blade_roundness", 1.1), ("lens/ratio", 11), ("lens/hood_distance", None),
    ("lens/hood_diameter_mm", None), ("lens/hood_diameter_mm", 0), ("lens/breathing", 1), ("lens/breathing", "yes"),
    ("lens/transmission", ["a"]), ("lens/blade_rotation_per_stop_deg", "a"), ("lens/blades", 41),
    ("accelerations", {}), ("accelerations/0/quantity", "speed"), ("accelerations/0/quantity", "quaternion"),
    ("accelerations/0/from", -1), ("accelerations/0/to", None), ("accelerations/0/value", 1),
    ("accelerations/0/jerk", 1),
    ("keyframes/focus_distance_mm", []), ("keyframes/focus_distance_mm", 1), ("keyframes/focus", []),
    ("keyframes/focus_distance_mm/0/time", -1), ("keyframes/focus_distance_mm/0/time", None),
    ("keyframes/focus_distance_mm/0/value", [1]), ("keyframes/focus_distance_mm/0/value", -1),
    ("keyframes/focus_distance_mm/1/interpolation", "cubic"), ("keyframes/focus_distance_mm/1/ease", 1),
    ("keyframes/focus_distance", [{"time": 0, "value": 1}]),
    ("focus", {"surface": "map.png"}), ("focus", HEIGHTS | {"kind": "map"}), ("focus", HEIGHTS | {"cell": 0}),
    ("focus", {"surface": "map.png", "kind": "height"}), ("focus", HEIGHTS | {"kind": "depth"}),
    ("focus", {"surface": "map.png", "kind": "depth", "scale": 0}), ("focus", HEIGHTS | {"blur": 101}),
    ("focus", HEIGHTS | {"size": 1})]


class CoreLoader(yaml.SafeLoader):
    """Reads YAML 1.2, as editors and the programs do: 4e-1 is a number, yes is a word."""


CoreLoader.yaml_implicit_resolvers = {}
for tag, pattern, first in (("bool", r"true|false", "tf"), ("null", r"~|null|", ["~", "n", ""]),
                            ("int", r"[-+]?[0-9]+", "-+0123456789"),
                            ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+.0123456789")):
    CoreLoader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), list(first))
CoreLoader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(loader.construct_scalar(node)))
CoreLoader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(loader.construct_scalar(node)))


def parsed(text):
    return yaml.load(text, CoreLoader)


def written(path):
    return yaml.safe_dump(path, sort_keys=False, default_flow_style=None, width=1000)


def changed(path, place, value):
    """Returns a path with another value at a place such as lens/blades; None: without it."""
    path = copy.deepcopy(path)
    *parents, key = place.split("/")
    part = path
    for parent in parents:
        part = part[int(parent) if isinstance(part, list) else parent]
    if value is None:
        del part[key]
    else:
        part[int(key) if isinstance(part, list) else key] = value
    return path


def example_paths():
    """Yields (name, text, folder that it may name pictures in) of the paths in pages, tests, examples and corpora."""
    for file in sorted(SOURCE.glob("examples/*.yaml")) + sorted(SOURCE.glob("fuzz/corpus/path_yaml/*.yaml")):
        yield file.name, file.read_bytes().decode(errors="replace"), file.parent
    for page in sorted(SOURCE.glob("doc/**/*.md")):
        for number, block in enumerate(re.findall(r"```yaml\n(.*?)```", page.read_text(), re.S)):
            yield f"{page.name} {number}", block, page.parent
    for script in sorted(SOURCE.glob("tests/**/*.py")) + sorted(SOURCE.glob("python/tests/*.py")):
        for number, block in enumerate(re.findall(r'"""(format: lfpath 1\n.*?)"""', script.read_text(), re.S)):
            yield f"{script.name} {number}", block, script.parent


class PathSchemaTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.schemas = schema_files.SchemaFiles(SOURCE / "schemas")
        self.file = self.folder / "path.yaml"
        Image.new("L", (8, 8), 255).save(self.folder / "map.png")

    def accepts(self, text):
        """Returns true if lfcammvminfo accepts a path; otherwise its exit code must be that of a wrong input."""
        self.file.write_text(text)
        result = self.call(INFO, self.file)
        self.assertIn(result.returncode, (0, 3), result.stderr)
        return result.returncode == 0

    def test_paths_that_are_accepted_are_valid(self):
        accepted, refused = [], []
        for name, text, folder in example_paths():
            self.file.write_bytes(text.encode(errors="replace"))
            result = self.call(INFO, self.file)
            (refused if result.returncode else accepted).append(name)
            if result.returncode == 0:
                self.assertEqual(self.schemas.faults("path", parsed(text)), [], name)
        self.assertGreater(len(accepted), 15, refused)
        # Every example that is one, and every good path of the corpus, was among them.
        for name in ("demo.yaml", "orbit.yaml", "eases.yaml", "good.yaml", "orientation.yaml", "shutter.yaml",
                     "transmission.yaml", "path.md 0"):
            self.assertIn(name, accepted)

    def test_what_the_programs_write_is_valid(self):
        self.file.write_text(GOOD)
        for number, words in enumerate(([], ["--resolution", "40x30"], ["--stereo-mm", 60], ["--frames", 7])):
            text = GOOD if "--stereo-mm" not in words else re.sub("shutter.*\n", "", GOOD)
            self.file.write_text(text)
            out = self.folder / f"out_{number}.yaml"
            self.succeeds(PATH, self.file, "-o", out, *words)
            self.assertEqual(self.schemas.faults("path", parsed(out.read_text())), [], words)

    def test_examples_name_the_schema_for_editors(self):
        for file in SOURCE.glob("examples/*.yaml"):
            named = re.match(r"# yaml-language-server: \$schema=(\S+)\n", file.read_text())[1]
            self.assertEqual((file.parent / named).resolve(), (SOURCE / "schemas/path.schema.json").resolve())

    def test_planted_faults_are_refused_by_both(self):
        good = parsed(GOOD)
        self.assertTrue(self.accepts(written(good)))
        self.assertEqual(self.schemas.faults("path", good), [])
        heights = good | {"focus": HEIGHTS}
        self.assertEqual(self.schemas.faults("path", heights), [])
        for place, value in FAULTS:
            with self.subTest(place=place, value=value):
                path = changed(good, place, value)
                self.assertTrue(self.schemas.faults("path", path), "the schema accepts it")
                self.assertFalse(self.accepts(written(path)), "the program accepts it")

    def test_what_moves_needs_no_start(self):
        """Quantities may be stated by keyframes alone."""
        path = parsed(GOOD)
        for section, key, value in (("camera", "position", [0, 0, -1]), ("camera", "look_at", [0, 0, 0]),
                                    ("lens", "aperture_diameter", 0.05)):
            del path[section][key]
            path["keyframes"][key] = [{"time": 0, "value": value}]
        del path["camera"]["speed"], path["accelerations"], path["lens"]["aperture_diameter_speed_mm"]
        self.assertTrue(self.accepts(written(path)))
        self.assertEqual(self.schemas.faults("path", path), [])
        del path["keyframes"]["look_at"]
        self.assertFalse(self.accepts(written(path)))
        self.assertTrue(self.schemas.faults("path", path))

    def test_every_key_that_the_program_knows_is_in_the_schema(self):
        """The program lists the keys that it knows when it meets an unknown one."""
        schema = self.schemas.published["path.schema.json"]["properties"]
        for place, keys in (("", schema), ("camera/", schema["camera"]["properties"]),
                            ("lens/", schema["lens"]["properties"]), ("shutter/", schema["shutter"]["properties"]),
                            ("keyframes/", schema["keyframes"]["properties"])):
            self.file.write_text(written(changed(parsed(GOOD), f"{place}zzz", 1)))
            last = self.call(INFO, self.file).stderr.strip().splitlines()[-1]
            known = re.sub(r" \(also wrong.*", "", last.split("known are: ")[1])
            self.assertEqual(set(known.split(", ")), set(keys), place)
        quantities = schema["accelerations"]["items"]["properties"]["quantity"]["enum"]
        self.file.write_text(written(changed(parsed(GOOD), "accelerations/0/quantity", "zzz")))
        last = self.call(INFO, self.file).stderr.strip().splitlines()[-1]
        self.assertEqual(set(re.sub(r" \(also wrong.*", "", last.split("known are: ")[1]).split(", ")),
                         set(quantities))


if __name__ == "__main__":
    INFO, PATH, SOURCE = sys.argv[1:4]
    SOURCE = pathlib.Path(SOURCE)
    del sys.argv[1:4]
    unittest.main()
