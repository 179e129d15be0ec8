# SPDX-License-Identifier: Apache-2.0
"""The examples make the pictures that they promise."""
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "examples/python"


@pytest.mark.parametrize("script, words, parts", [
    ("refocus.py", ["0.6", "2"], (5, 1)), ("bokeh_shapes.py", [], (2, 2)),
    ("progressive.py", [], (1, 1))])
def test_example(script, words, parts, capture, tmp_path):
    picture = tmp_path / "picture.png"
    end = subprocess.run([sys.executable, FOLDER / script, capture, picture, *words], capture_output=True, text=True)
    assert end.returncode == 0, end.stderr
    image = Image.open(picture)
    assert image.size[0] % parts[0] == image.size[1] % parts[1] == 0 and min(image.size) > 80
    assert np.asarray(image).std() > 10


@pytest.mark.parametrize("script, count, size", [("aperture_sweep.py", 49, (960, 480)),
                                                 ("million_cameras.py", 3000, (900, 900))])
def test_example_with_its_own_scene(script, count, size, tmp_path):
    picture = tmp_path / "picture.png"
    for _ in range(2):
        end = subprocess.run([sys.executable, FOLDER / script, tmp_path / "field", picture, str(count)],
                             capture_output=True, text=True)
        assert end.returncode == 0, end.stderr
    image = Image.open(picture)
    assert image.size == size and np.asarray(image).std() > 10
    if script == "aperture_sweep.py":
        psnr = [float(line.split(",")[1].split()[0]) for line in end.stdout.splitlines()]
        assert len(psnr) == 4 and min(psnr) > 28, psnr


@pytest.mark.parametrize("script", sorted(FOLDER.glob("*.py")), ids=lambda script: script.name)
def test_examples_tell_how_they_are_called(script):
    end = subprocess.run([sys.executable, script], capture_output=True, text=True)
    assert end.returncode == 1 and f"usage: {script.name}" in end.stderr and "Traceback" not in end.stderr
