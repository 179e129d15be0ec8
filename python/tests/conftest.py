# SPDX-License-Identifier: Apache-2.0
"""Shared by the tests of the Python package: the programs, and a small synthetic light field.

LF_BIN names the folder of the programs.
"""
import os
import pathlib
import subprocess

import pytest

import lfrendertools as lf

PATH = """format: lfpath 1
fps: 25
frames: 3
resolution: [120, 80]
camera:
  field_of_view_deg: 40
  position: [0.002, -0.157, -0.7975]
  look_at: [0.02, -0.1, 0.2]
lens:
  aperture_diameter: 0.05
  blades: 5
keyframes:
  focus_distance: [{time: 0, value: 0.8}, {time: 0.08, value: 1.4}]
"""


@pytest.fixture(scope="session")
def programs():
    return pathlib.Path(os.environ["LF_BIN"])


@pytest.fixture(scope="session")
def run(programs):
    def run_program(name, *words):
        return subprocess.run([programs / name, *map(str, words), "-q"], check=True, capture_output=True, text=True)
    return run_program


@pytest.fixture(scope="session")
def capture(run, tmp_path_factory):
    """A folder with 7 x 7 LF images of 160 x 120 pixels."""
    folder = tmp_path_factory.mktemp("capture") / "field"
    run("lfsynth", "still-life", "-o", folder, "--count", 49, "--size", "160x120", "--spacing", "0.01", "--samples", 1,
        "--format", "png")
    return folder


@pytest.fixture(scope="session")
def path_file(tmp_path_factory):
    file = tmp_path_factory.mktemp("path") / "path.yaml"
    file.write_text(PATH)
    return file


@pytest.fixture()
def field(capture):
    return lf.open(capture)


@pytest.fixture()
def path(path_file, field):
    return lf.Path.load(path_file, field.unit_m)
