#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a frame step by step, prints how its error falls, and stops when its noise is small enough.

usage: progressive.py LIGHTFIELD PICTURE.png [NOISE]

NOISE  the frame is finished when its noise is at most this, in linear light where white is 1 (0.005)
"""
import sys

import numpy as np

import lfrendertools as lf

if len(sys.argv) < 3:
    sys.exit(__doc__)
field = lf.open(sys.argv[1])
noise = sys.argv[3] if len(sys.argv) > 3 else "0.005"
camera = field.camera()
final = lf.render(field, camera)
with lf.Renderer(field, camera, stop_when=f"noise<={noise}") as renderer:
    is_going_on = True
    while is_going_on:
        is_going_on = renderer.step()
        frame = renderer.preview()
        error = float(np.sqrt(np.mean((frame.rgb - final.rgb) ** 2)))
        print(f"{renderer.progress[0]:4} LF images read, {frame.image_count:4} in the frame, error {error:.5f}")
    renderer.preview().save(sys.argv[2])
