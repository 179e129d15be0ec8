#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders drawn light fields with lenses that reach beyond the LF cameras, and prints the table of doc/rebinning.md.

usage: beyond_capture.py LFRENDERER [--scenes DIR] [--name NAME] [--write doc/rebinning.md]
       beyond_capture.py --again JSON [--write doc/rebinning.md]
"""
import argparse
import pathlib
import sys
import tempfile

import lens_weights
import quality
from quality import results

SCENES = ("still-life", "chart", "lights")
COLUMNS = {
    "collected, no weights": "--mode collect --estimator bilinear --filter prefiltered --lens-weights none",
    "collected": "",
    "rebinned, cells": "--mode rebin --interpolation cells",
    "hybrid": "--mode hybrid",
}
# Half the height and width of the part of the capture that is kept, and the lens's diameter, in distances between LF
# cameras.
FAR = 100
LENSES = {
    "1.2 times as high as its band": ((-2, 2), (-FAR, FAR), 4.8),
    "1.5 times as high": ((-2, 2), (-FAR, FAR), 6),
    "twice as high": ((-2, 2), (-FAR, FAR), 8),
    "three times as high": ((-2, 2), (-FAR, FAR), 12),
    "beyond one side": ((-FAR, FAR), (-FAR, 1), 8),
    "beyond all sides": ((-2, 2), (-2, 2), 7),
    "of two rows": ((-1, 1), (-FAR, FAR), 8),
}


def part_of(field, rows, columns):
    """Returns the frames of a calibration that stand within these limits from its middle, in distances."""
    np, spacing = lens_weights.np, lens_weights.SYNTHETIC_SPACING
    poses = np.array([f["transform_matrix"] for f in field["frames"]])
    places = poses[:, :3, 3] - poses[:, :3, 3].mean(axis=0)
    up, right = places @ poses[0, :3, 1] / spacing, places @ poses[0, :3, 0] / spacing
    kept = (up > rows[0]) & (up < rows[1]) & (right > columns[0]) & (right < columns[1])
    return [f for f, is_kept in zip(field["frames"], kept) if is_kept]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("--scenes", type=pathlib.Path, help="keep the scenes of lfsynth here, and use what is there")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.renderer:
        parser.error("LFRENDERER or --again is needed")
    table = lens_weights.Table("scene, lens", *COLUMNS)
    record = results.context() | {"options": COLUMNS}
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.scenes or pathlib.Path(temporary)
        scenes = lens_weights.SyntheticScenes(arguments.renderer, folder)
        for scene in SCENES:
            field = quality.read_field(scenes.calibration(scene))
            for i, (lens, (rows, columns, distances)) in enumerate(LENSES.items()):
                part = quality.write_field(folder / f"{scene}_part_{i}", field, part_of(field, rows, columns))
                path, truth = scenes.truth(scene, distances * lens_weights.SYNTHETIC_SPACING)
                found = [lens_weights.decibels(arguments.renderer, truth, part, path, options)
                         for options in COLUMNS.values()]
                table.add(f"{scene}, {lens}", *map(lens_weights.text, found))
    table.publish(arguments, "beyond_capture.py", record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
