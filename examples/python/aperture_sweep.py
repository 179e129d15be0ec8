#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Films a synthetic scene through wider and wider lenses, and compares the frames with what real lenses would record.

usage: aperture_sweep.py FOLDER PICTURE.png [CAMERAS]

FOLDER   folder for the light field and the frames of the real lenses; those that are there already are used again
CAMERAS  approximate number of LF cameras (289)

The picture shows the rendered frames above, the true ones in the middle, and their differences, eight times as bright,
below.
"""
import pathlib
import sys

import numpy as np
from PIL import Image

import lfrendertools as lf

if len(sys.argv) < 3:
    sys.exit(__doc__)
folder, picture = pathlib.Path(sys.argv[1]), sys.argv[2]
count = int(sys.argv[3]) if len(sys.argv) > 3 else 289
widest_mm = 40
# The lens is in the middle of the LF cameras, and focused on the glass ball.
lens = lf.Camera((0, -0.125, -0.799), look_at=(0, -0.085, 0), resolution=(240, 160), focal_length_mm=50,
                 aperture_diameter_mm=widest_mm, focus_distance=0.75)
path = lf.Path([lens.replace(aperture_diameter_mm=diameter) for diameter in np.linspace(widest_mm / 4, widest_mm, 4)])
if not (folder / "truth/frame_0004.exr").exists():
    lf.synth("still-life", folder, count=count, spacing=0.05 / (count ** 0.5 - 1), truth=path, truth_samples=256,
             overwrite=True, progress=True)
columns = []
for number, frame in lf.film(lf.open(folder), path):
    truth = lf.read_image(folder / f"truth/frame_{number:04}.exr")[..., :3]
    # Light above display white is cut off, as a display does, so that lamps do not decide the result.
    rendered, true = np.clip(frame.rgb, 0, 1), np.clip(truth, 0, 1)
    psnr = -10 * np.log10(np.mean((rendered - true) ** 2))
    print(f"{frame.camera.aperture_diameter * 1000:4.0f} mm: {frame.image_count:4} LF images, {psnr:.1f} dB")
    difference = np.clip(8 * np.abs(frame.display().astype(int) - lf.display_values(truth)), 0, 255).astype(np.uint8)
    columns.append(np.concatenate([frame.display(), lf.display_values(truth), difference]))
Image.fromarray(np.concatenate(columns, axis=1)).save(picture)
