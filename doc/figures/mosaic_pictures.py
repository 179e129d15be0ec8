#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the picture of doc/mosaics.md: parts of frames from LF images with all colours, and from their mosaics.

usage: mosaic_pictures.py LFRENDERER DATA FOLDER [--scenes DIR] [--fields DIR]

DATA    as for bench/quality/photographs.py, which makes the light fields of photographs
FOLDER  receives mosaics.jpg: a row for each scene; with all colours, and of mosaics by the estimator nearest, by
        default, and demosaicked together with their neighbours
--scenes, --fields  as for bench/quality/mosaics.py and photographs.py
"""
import argparse
import pathlib
import sys
import tempfile

import cv2
import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "bench/quality"))
import lens_weights
import mosaics
import photographs
import quality

# (left, top) of the part of each frame that is shown
PARTS = {("still-life", 3, "1"): (120, 80), ("chart", 8, "1"): (80, 60), ("shop", 3, "counter"): (150, 120),
         ("cards", 3, "standing cards"): (100, 100)}
SIZE = (96, 64)
SCALE = 3
GAP = 6  # width of the gap between pictures, px


def shown(frame, corner):
    (x, y), (width, height) = corner, SIZE
    part = np.round(255 * quality.encoded(frame[y:y + height, x:x + width, ::-1])).astype(np.uint8)
    return cv2.resize(part, None, fx=SCALE, fy=SCALE, interpolation=cv2.INTER_NEAREST)


def beside(pictures, axis):
    gap = list(pictures[0].shape)
    gap[axis] = GAP
    parts = [part for picture in pictures for part in (np.full(gap, 255, np.uint8), picture)]
    return np.concatenate(parts[1:], axis)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--scenes", type=pathlib.Path)
    parser.add_argument("--fields", type=pathlib.Path)
    a = parser.parse_args()
    renderer = a.renderer.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        scenes = mosaics.Scenes(renderer, a.scenes or pathlib.Path(temporary))
        fields = a.fields or pathlib.Path(temporary)
        cases = [case for scene in ("still-life", "chart") for case in mosaics.cases_of(scenes, scene)]
        cases += [case for name in ("shop", "cards") for case in photographs.cases_of(name, renderer, a.data, fields)]
        rows = []
        for case in cases:
            name, noise, *lens = case.cells
            if noise != "none" or (name, *lens) not in PARTS:
                continue
            frame = lambda field, options: lens_weights.first_frame(renderer, field, case.path, options)[0]
            rows.append(beside([shown(picture, PARTS[name, *lens]) for picture in (
                frame(case.rgb, ""), frame(case.mosaics, mosaics.WAYS["nearest"]), frame(case.mosaics, ""),
                frame(quality.joint_store(renderer, case.mosaics), ""))], 1))
        assert len(rows) == len(PARTS)
        cv2.imwrite(str(a.folder / "mosaics.jpg"), beside(rows, 0), [cv2.IMWRITE_JPEG_QUALITY, 88])
    return 0


if __name__ == "__main__":
    sys.exit(main())
