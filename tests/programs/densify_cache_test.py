#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the depths that lfdensify keeps for other calls: they are found again, never where something has changed, and
no bit depends on them.

usage: densify_cache_test.py LFDENSIFY LFSYNTH LFRENDERER
"""
import json
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import unittest

from program_test_case import ProgramTestCase

DENSIFY = SYNTH = RENDERER = None

PATH_YAML = """format: lfpath 1
fps: 25
frames: 2
resolution: [80, 60]
camera: {field_of_view_deg: 40, position: [0.002, -0.157, -0.7975], look_at: [0.02, -0.1, 0.2], speed: [0.1, 0, 0]}
lens: {aperture_diameter: 0.05, focus_distance: 0.8}
"""


def contents(store):
    """Returns the encoded LF images and planes of a store."""
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        return (database.execute("select id, code, mask from blobs order by id").fetchall(),
                database.execute("select id, kind, plane from planes order by id, kind").fetchall())


class DensifyCacheTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field, self.cache = self.folder / "field", self.folder / "field.depths"
        self.path = self.folder / "path.yaml"
        self.path.write_text(PATH_YAML)
        self.succeeds(SYNTH, "still-life", "-o", self.field, "--count", 16, "--size", "160x120", "--spacing", 0.02,
                      "--format", "png", "-q")

    def call_of(self, name, *options):
        return [DENSIFY, self.field, "-o", self.folder / f"{name}.lfs", "--json", "--overwrite", *options]

    def report(self, name, *options):
        return json.loads(self.succeeds(*self.call_of(name, *options)))

    def contents(self, name):
        return contents(self.folder / f"{name}.lfs")

    def planes(self):
        return sorted(self.cache.glob("plane-*.lfdepth"))

    def test_another_call_finds_the_depths(self):
        first = self.report("first", "--most", 60)
        self.assertEqual((first["cache"], first["cached_planes"]), (str(self.cache), 0))
        self.assertEqual(len(self.planes()), 16)
        times = [plane.stat().st_mtime_ns for plane in self.planes()]
        # Neither the path nor the number of virtual LF images changes a depth.
        for options in (["--most", 60], ["--most", 90], [self.path]):
            with self.subTest(options=options):
                again, alone = self.report("again", *options), self.report("alone", *options, "--cache", "none")
                self.assertGreater(again["cached_planes"], 8)
                self.assertEqual(again["swept_pixels"], 0)
                self.assertEqual((alone["cache"], alone["cached_planes"]), (None, 0))
                self.assertGreater(alone["swept_pixels"], 0)
                self.assertEqual(self.contents("again"), self.contents("alone"))
                self.assertEqual([again[key] for key in ("inverse_depths", "tests", "agreeing_share")],
                                 [alone[key] for key in ("inverse_depths", "tests", "agreeing_share")])
        self.assertEqual([plane.stat().st_mtime_ns for plane in self.planes()], times)
        # Other options of the search have entries of their own, and the old ones stay.
        self.assertEqual(self.report("half", "--divisor", 2)["cached_planes"], 0)
        self.assertEqual(self.report("again", "--most", 60)["cached_planes"], 16)

    def test_lfrenderer_finds_the_depths(self):
        self.report("first", "--most", 60)
        film = [RENDERER, self.field, self.path, "-o", self.folder / "film", "--no-contact-sheet", "--densify"]
        result = self.call(*film)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("field.depths: had ", result.stderr)
        alone = self.folder / "alone"
        self.succeeds(*film[:4], alone, *film[5:], "--cache", "none")
        self.assertEqual(contents(self.folder / "film" / "densified.lfs"), contents(alone / "densified.lfs"))

    def test_damaged_entries_are_made_again(self):
        self.report("first", "--most", 60)
        for number, entry in enumerate(sorted(self.cache.iterdir())):
            content = bytearray(entry.read_bytes())
            content[len(content) * number // 20] ^= 16
            entry.write_bytes(content if number % 2 else content[:len(content) * number // 20])
        result = self.call(*self.call_of("again", "--most", 60))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("is damaged; what it held is made again"), 19, result.stderr)
        self.assertEqual(json.loads(result.stdout)["cached_planes"], 0)
        self.assertEqual(self.contents("again"), self.contents("first"))
        self.assertEqual(self.report("again", "--most", 60)["cached_planes"], 16)

    def test_changed_files_and_poses_are_searched_again(self):
        options = ["--most", 60, "--depths", 0.2, 10, "--force"]
        images = sorted((self.field / "images").iterdir())
        self.report("first", *options)
        shutil.copyfile(images[2], images[0])
        changed = self.report("changed", *options)
        self.assertGreater(changed["cached_planes"], 0)
        self.assertLess(changed["cached_planes"], 16)
        self.report("alone", *options, "--cache", "none")
        self.assertEqual(self.contents("changed"), self.contents("alone"))
        self.assertEqual(len(self.planes()), 16)  # replaced, not piled up
        calibration = self.field / "transforms.json"
        text = json.loads(calibration.read_text())
        for frame in text["frames"]:
            frame["transform_matrix"][0][3] *= 1.001
            frame.pop("lf_translation")
        calibration.write_text(json.dumps(text))
        self.assertEqual(self.report("moved", *options)["cached_planes"], 0)

    def test_two_processes_may_use_a_folder(self):
        both = [subprocess.Popen([*map(str, self.call_of(name, "--most", 60))], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True) for name in ("a", "b")]
        for process in both:
            errors = process.communicate()[1]
            self.assertEqual(process.returncode, 0, errors)
            self.assertEqual(errors.count("warning"), 0, errors)
        self.report("alone", "--most", 60, "--cache", "none")
        self.assertEqual(self.contents("a"), self.contents("alone"))
        self.assertEqual(self.contents("b"), self.contents("alone"))
        self.assertEqual({path.suffix for path in self.cache.iterdir()}, {".lfdepth"})

    def test_nothing_is_kept_in_a_place_of_others(self):
        place = self.folder / "place"
        place.mkdir()
        self.field = self.field.rename(place / "field")
        if os.geteuid() == 0:
            os.chown(place, 65534, 65534)
        else:
            place.chmod(0o555)
            self.addCleanup(place.chmod, 0o755)
        self.assertEqual(self.report("a", "--most", 20)["cache"], None)
        self.assertEqual([path.name for path in place.iterdir()], ["field"])
        # A user may name a place; if it cannot be written, the store is made all the same.
        chosen = self.folder / "chosen"
        self.assertEqual(self.report("a", "--most", 20, "--cache", chosen)["cached_planes"], 0)
        self.assertEqual(self.report("a", "--most", 20, "--cache", chosen)["cached_planes"], 16)
        result = self.call(*self.call_of("b", "--most", 20, "--cache", self.path / "chosen"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("depths are not kept for other calls"), 1, result.stderr)
        self.assertEqual(self.contents("b"), self.contents("a"))
        self.fails(2, ["--cache", "is a file"], *self.call_of("c", "--cache", self.path))


if __name__ == "__main__":
    DENSIFY, SYNTH, RENDERER = map(pathlib.Path, sys.argv[1:4])
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
