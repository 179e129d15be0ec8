# SPDX-License-Identifier: Apache-2.0
"""Writes a small light field of files, for tests of whole programs."""
import json
import pathlib

import numpy as np
from PIL import Image

WIDTH, HEIGHT, SIDE, PITCH = 64, 48, 5, 0.01
WALL_DEPTH = 0.25

PATH_YAML = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [80, 60]
camera:
  field_of_view_deg: 50
  focal_length_mm: 35
  position: [{x}, 0, 0]
  look_at: [{x}, 0, -1]
  up: [0, 1, 0]
lens:
  aperture_diameter: {aperture}
  focus_distance: 0.8
keyframes:
  focus_distance: [{{time: 0, value: 0.8}}, {{time: 1, value: 2}}]
"""


def wall(index):
    """Returns a finely textured wall at WALL_DEPTH, as LF camera `index` sees it."""
    x0 = (index % SIDE - (SIDE - 1) / 2) * PITCH + 0.0003 * (index % 3)
    y0 = -(index // SIDE - (SIDE - 1) / 2) * PITCH
    x = x0 + (np.arange(WIDTH) + 0.5 - WIDTH / 2) / 70 * WALL_DEPTH
    y = y0 + (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / 70 * WALL_DEPTH
    cells = np.floor(x / 0.02)[None, :] * 374761 + np.floor(y / 0.02)[:, None] * 668265
    grey = (np.sin(cells) * 43758.5453) % 1
    return np.repeat((grey * 200 + 20).astype(np.uint8)[..., None], 3, axis=2)


def write_path(folder: pathlib.Path, frames=3, aperture=0.045, x=0) -> pathlib.Path:
    path = folder / "path.yaml"
    path.write_text(PATH_YAML.format(frames=frames, aperture=aperture, x=x))
    return path


def write_field(folder: pathlib.Path, picture=None, **keys) -> pathlib.Path:
    """Writes a light field of SIDE x SIDE parallel cameras, PITCH apart, looking along -z of an OpenGL world.

    picture(index) -> uint8 or uint16 array, default noise; keys are added to transforms.json
    """
    folder.mkdir(parents=True, exist_ok=True)
    if picture is None:
        def picture(index):
            return np.random.default_rng(index).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    frames = []
    for index in range(SIDE * SIDE):
        name = f"image_{index:02d}.png"
        Image.fromarray(picture(index)).save(folder / name)
        x = (index % SIDE - (SIDE - 1) / 2) * PITCH + 0.0003 * (index % 3)
        y = (index // SIDE - (SIDE - 1) / 2) * PITCH
        frames.append({"file_path": name, "transform_matrix": [
            [1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]]})
    field = {"fl_x": 70, "fl_y": 70, "cx": WIDTH / 2, "cy": HEIGHT / 2, "w": WIDTH, "h": HEIGHT,
             "frames": frames, **keys}
    calibration = folder / "transforms.json"
    calibration.write_text(json.dumps(field))
    return calibration
