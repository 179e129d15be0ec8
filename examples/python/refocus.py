#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders one view of a light field at several focus distances, side by side.

usage: refocus.py LIGHTFIELD PICTURE.png [NEAR FAR]
"""
import sys

import numpy as np
from PIL import Image

import lfrendertools as lf

if len(sys.argv) < 3:
    sys.exit(__doc__)
field = lf.open(sys.argv[1])
subject = field.camera()
near, far = 0.75 * subject.focus_distance, 1.5 * subject.focus_distance
if len(sys.argv) > 3:
    near, far = map(float, sys.argv[3:5])
# The blur of a point changes in equal steps if 1 / distance does.
distances = 1 / np.linspace(1 / near, 1 / far, 5)
path = lf.Path([subject.replace(focus_distance=distance) for distance in distances])
pictures = [frame.display() for _, frame in lf.film(field, path)]
Image.fromarray(np.concatenate(pictures, axis=1)).save(sys.argv[2])
print(f"focus at {', '.join(f'{distance:.3g}' for distance in distances)}: {sys.argv[2]}")
