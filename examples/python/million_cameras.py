#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shows which of a million LF cameras one frame needs, without a single LF image.

usage: million_cameras.py FOLDER PICTURE.png [CAMERAS]

FOLDER   folder for the calibration, which is used again if it is there already
CAMERAS  number of LF cameras, on a dome over the scene (1000000)

The picture shows the dome from above, north on top: grey all LF cameras, yellow those whose LF images the frame reads,
blue the other ones that lens weights are computed from. The frame's lens is drawn as a white circle, enlarged in the
corner.
"""
import pathlib
import sys
import time

import numpy as np
import numpy.typing as npt
from PIL import Image

import lfrendertools as lf

if len(sys.argv) < 3:
    sys.exit(__doc__)
folder, picture = pathlib.Path(sys.argv[1]), sys.argv[2]
count = int(sys.argv[3]) if len(sys.argv) > 3 else 1_000_000
if not (folder / "transforms.json").exists():
    lf.synth("still-life", folder, capture="hemisphere", count=count, calibration_only=True)
begin = time.perf_counter()
field = lf.open(folder)
opened = time.perf_counter()
radius = float(np.linalg.norm(field.centres - field.centres.mean(axis=0) * [1, 0, 1], axis=1).mean())
camera = lf.Camera((0.3 * radius, -0.75 * radius, -0.6 * radius), look_at=(0, 0, 0), resolution=(1920, 1080),
                   focal_length_mm=50, aperture_diameter=0.08 * radius, focus_distance=radius)
selection = lf.select(field, camera)
print(f"{len(field)} LF cameras, opened in {opened - begin:.1f} s; {len(selection.ids)} selected, and "
      f"{len(selection.neighbours)} neighbours, in {time.perf_counter() - opened:.1f} s")

GREY, YELLOW, BLUE, WHITE = (110, 110, 110), (255, 200, 40), (60, 130, 255), (255, 255, 255)
Floats = npt.NDArray[np.float64]


def draw(centre: Floats, width: float, side: int) -> npt.NDArray[np.uint8]:
    """Returns a map of the dome around `centre`, which is `width` wide."""
    pixels = np.zeros((side, side, 3), np.uint8)
    turn = np.linspace(0, 2 * np.pi, 8 * side)
    rim = camera.position + camera.aperture_diameter / 2 * (
        np.outer(np.cos(turn), camera.cam_from_world[0, :3]) + np.outer(np.sin(turn), camera.cam_from_world[1, :3]))
    dot = max(1, int(0.6 * side * field.spacing / width))
    for points, colour, size in ((field.centres, GREY, dot), (field.centres[selection.neighbours], BLUE, dot),
                                 (field.centres[selection.ids], YELLOW, dot), (rim, WHITE, 1)):
        at = ((points[:, [0, 2]] - centre) * [1, -1] / width + 0.5) * side
        for dx in range(size):
            for dy in range(size):
                x, y = (at + [dx, dy]).astype(int).T
                seen = (x >= 0) & (y >= 0) & (x < side) & (y < side)
                pixels[y[seen], x[seen]] = colour
    return pixels


overview = draw(field.centres[:, [0, 2]].mean(axis=0), 2.2 * radius, 900)
overview[:360, :360] = draw(camera.position[[0, 2]], 1.5 * camera.aperture_diameter, 360)
overview[360:362, :362] = overview[:362, 360:362] = WHITE
Image.fromarray(overview).save(picture)
