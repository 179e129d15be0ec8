#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders one view through lenses with different numbers of blades, focused in front of the scene.

usage: bokeh_shapes.py LIGHTFIELD PICTURE.png [FOCUS_DISTANCE]      in world units
"""
import sys

import numpy as np
from PIL import Image

import lfrendertools as lf

if len(sys.argv) < 3:
    sys.exit(__doc__)
field = lf.open(sys.argv[1])
camera = field.camera()
focus = float(sys.argv[3]) if len(sys.argv) > 3 else 0.8 * camera.focus_distance
rows = []
for blades in (0, 3, 5, 6):
    rows.append(lf.render(field, camera.replace(blades=blades, focus_distance=focus)).display())
Image.fromarray(np.concatenate([np.concatenate(rows[:2], axis=1), np.concatenate(rows[2:], axis=1)])).save(sys.argv[2])
