#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every setting of a film means the same through each door: the command line of lfrenderer, packages and a
job of lfsubmit, Python, and the commands that the page of lfvisualizer shows.

A plate records the settings that its rays depend on. The test states all settings of the table in a few films, renders
each film through each door, and compares the records. tools.SettingOptions and api.Face compare the doors of C++.

usage: doors_test.py FOLDER_OF_THE_PROGRAMS [pageless] [EXTENSION_OF_PYTHON]
"""
import base64
import json
import pathlib
import shlex
import struct
import subprocess
import sys
import unittest

import small_field
from program_test_case import ProgramTestCase

BIN = PACKAGE = None
PAGELESS = False

# Films that together state each setting of the table. A value is that of the Python argument; the words of the command
# line follow from it. "hybrid" has plates, which record rays, and rebinned rays.
FILMS = {
    "collect": {"filter": "bicubic", "lf_pixels": "points", "lens_weights": "hat", "fill": 7, "max_images": 9,
                "max_angle_deg": 60, "order": "round-robin", "seed": 5, "stop_when": "noise<=0.25",
                "back_end": "reference"},
    "counted": {"estimator": "nearest", "smooth_below": 3},
    "hybrid": {"mode": "hybrid", "interpolation": "cells", "kept": "edges", "max_rays": 5000,
               "average_others": False, "preview": "on",
               "alpha": 3.5, "beta": 0.01, "xi": 0.5, "edge_sigma": 1.5, "probability_sigma": 0.5, "colour_sigma": 0.25,
               "sigma_st": 0.7, "sigma_uv": 0.8, "lens_points": 9, "lens_sets": 2, "r_st": 0.004, "r_uv": 0.003,
               "slab_position": (0, 0, 0), "slab_forward": (0, 0.125, -1), "slab_distance": 0.75,
               "back_end": "reference", "nearest": 5, "coverage_cells": 8},
    "slabs": {"mode": "hybrid", "max_rays": 5000, "reparameterise": False},
    "pixels": {"mode": "hybrid", "max_rays": 5000, "kept": "edges", "interpolation": "pixels"},
}
# A guard is recorded only for densified light fields. Python has no `require`, which only decides an exit code.
NOT_RECORDED = {"guard": False}
IN_PACKAGES = ("max_images", "max_angle_deg", "order", "seed")
OF_PREPROCESSOR = (*IN_PACKAGES, "mode", "interpolation", "lens_weights", "estimator")

OF_PYTHON = """
import json, sys
import lfrendertools as lf
field, path, plate, settings = sys.argv[1:]
with lf.Renderer(lf.open(field), lf.Path.load(path), "1", **json.loads(settings)) as renderer:
    while renderer.step():
        pass
    renderer.plate().save(plate)
"""


def environment():
    return {"PYTHONPATH": str(PACKAGE), "PATH": "/usr/bin:/bin"}


def words_of(settings):
    """Returns the options of lfrenderer that state the settings."""
    words = []
    for key, value in settings.items():
        option = "--" + key.replace("_deg", "").replace("_", "-")
        values = value if isinstance(value, tuple) else [{True: "on", False: "off"}.get(value, value)
                                                         if isinstance(value, bool) else value]
        words += ["--no-guard"] if key == "guard" else [option, *map(str, values)]
    return words


def record_of(plate):
    """Returns the entries of a plate (doc/formats/plate.md) without its progress and what follows from the rays."""
    head = plate.read_bytes()
    text = head[40:40 + struct.unpack_from("<I", head, 12)[0]].decode()
    entries = dict(line.split(": ", 1) for line in text.splitlines())
    return {key: value for key, value in entries.items() if not key.startswith(("progress.", "plate."))}


class DoorsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = small_field.write_field(self.folder / "field", small_field.wall)
        self.path = small_field.write_path(self.folder, frames=1)

    def of_command_line(self, settings, out):
        self.succeeds(BIN / "lfrenderer", self.field, self.path, "-o", out, "--keep-plates", *words_of(settings))
        return record_of(out / "frame_0001.plate")

    def of_job(self, settings, out):
        packages = self.folder / f"packages of {out.name}"
        chosen = {key: value for key, value in settings.items() if key in OF_PREPROCESSOR}
        later = {key: value for key, value in settings.items() if key not in IN_PACKAGES}
        self.succeeds(BIN / "lfpreprocessor", self.field, self.path, "-o", packages, *words_of(chosen))
        self.succeeds(BIN / "lfsubmit", *packages.glob("*.lfp"), "-o", out, "--", "--keep-plates", *words_of(later))
        return record_of(out / "frame_0001.plate")

    def of_python(self, settings, plate):
        subprocess.run([sys.executable, "-c", OF_PYTHON, self.field, self.path, plate, json.dumps(settings)],
                       check=True, env=environment())
        return record_of(plate)

    def test_films_have_the_settings_of_the_command_line(self):
        for name, settings in FILMS.items():
            with self.subTest(film=name):
                expected = self.of_command_line(settings, self.folder / name)
                for key, value in settings.items():
                    text = " ".join(map(str, value)) if isinstance(value, tuple) else str(value)
                    text = {True: "on", False: "off"}[value] if isinstance(value, bool) else text
                    if key not in ("fill", "smooth_below"):  # of the picture, which plates state as plate.fill
                        self.assertEqual(expected[key], text, key)
                self.assertEqual(self.of_job(settings, self.folder / f"{name} of a job"), expected)
                if PACKAGE:
                    self.assertEqual(self.of_python(settings, self.folder / f"{name}.plate"), expected)

    def test_the_films_state_all_settings(self):
        if not PACKAGE:
            self.skipTest("the table of settings is read from the Python package, which is not built")
        keys = json.loads(subprocess.run(
            [sys.executable, "-c", "import json; from lfrendertools import _core; "
             "print(json.dumps([row[0] for row in _core.settings()]))"],
            check=True, capture_output=True, env=environment()).stdout)
        self.assertEqual(sorted({key for film in FILMS.values() for key in film} | set(NOT_RECORDED)), sorted(keys))

    def test_reports_state_the_settings_of_pictures(self):
        def inputs(*options):
            self.succeeds(BIN / "lfrenderer", self.field, self.path, "-o", self.folder / "out", "--overwrite", *options)
            return json.loads((self.folder / "out" / "report.json").read_text())["inputs"]
        usual, told = inputs(), inputs("--fill", "7", "--lens-weights", "none", "--smooth-below", "3")
        self.assertEqual([(one["fill"], one["smooth_below"]) for one in (usual, told)], [("2", "0"), ("7", "3")])

    def test_the_commands_of_the_page_make_its_film(self):
        if PAGELESS:
            self.skipTest("lfvisualizer is built without its page")
        settings = {"estimator": "nearest", "lens_weights": "none", "max_images": 9, "max_angle_deg": 60, "seed": 5}
        expected = self.of_command_line(settings, self.folder / "expected")
        self.succeeds(BIN / "lfvisualizer", self.field, self.path, "--export", self.folder / "page",
                      *words_of(settings))
        scene = json.loads(base64.b64decode((self.folder / "page" / "scene.json.js").read_text().split('"')[3]))
        for name, command in scene["commands"].items():
            calls = [shlex.split(line) for line in command.splitlines()]
            for program, *words in calls:
                words = [str(file) for word in words
                         for file in (sorted(self.folder.glob(word)) if "*" in word else [word])]
                words += ["--keep-plates"] if program == "lfrenderer" else []
                told = subprocess.run([BIN / program, *words], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(told.returncode, 0, f"{name}: {command}\n{told.stderr}")
            if name != "forecast":
                film = record_of(self.folder / "frames" / "frame_0001.plate")
                if name == "densify":  # the film of another light field, with a guard
                    self.assertEqual({key: film[key] for key in settings}, {key: expected[key] for key in settings})
                    self.assertEqual(film["guard"], "on")
                else:
                    self.assertEqual(film, expected, name)
                (self.folder / "frames").rename(self.folder / f"frames of {name}")


if __name__ == "__main__":
    rest = sys.argv[2:]
    BIN, PAGELESS = pathlib.Path(sys.argv[1]).resolve(), "pageless" in rest
    PACKAGE = next((pathlib.Path(word).resolve().parent.parent for word in rest if word not in ("", "pageless")), None)
    unittest.main(argv=sys.argv[:1])
