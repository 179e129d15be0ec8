#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders light fields whose true thin-lens pictures are known from pixels that are kept at edges only, and prints a
table of doc/rebinning.md.

usage: kept_edges.py LFRENDERER GROUNDTRUTH [--name NAME] [--write doc/rebinning.md] [--only SUBSTRING]
       kept_edges.py --again JSON [--write doc/rebinning.md]

GROUNDTRUTH  as for quality.py: of its cases, those that chose no default
Further cases are small bright lights on black, drawn by lfsynth, recorded as RGB and as mosaics. Each figure is a pair,
the PSNR in linear light and the PSNR in display values. The number of kept pixels is that of --kept edges.
"""
import argparse
import json
import pathlib
import sys
import tempfile

import lens_weights
import mosaic_sensor
import mosaics
import quality
import rebinning_quality
from quality import results

EDGES = "--mode rebin --kept edges"
COLUMNS = {
    "all pixels": "--mode rebin",
    "pixels at edges": EDGES,
    "`--xi 0.2`": f"{EDGES} --xi 0.2",
    "`--edge-sigma 0.7`": f"{EDGES} --edge-sigma 0.7",
    "cells at edges": f"{EDGES} --interpolation cells",
}
LIGHTS = (0.25, 3, 8)  # lens diameters, in camera distances


def cases(renderer, truth_folder, folder):
    """Yields (name, calibration, path, true picture)."""
    for case in rebinning_quality.ground_truth_cases(truth_folder, folder):
        if "every" not in case[0] and quality.purpose(case[0]) == mosaic_sensor.REPORTING:
            yield case
    scenes = mosaics.Scenes(renderer, folder)
    for spacings in LIGHTS:
        path, truth = scenes.truth("lights", spacings * lens_weights.SYNTHETIC_SPACING)
        for kind, calibration in (("RGB", scenes.calibration("lights")), ("mosaics", scenes.mosaics("lights", 0))):
            yield f"lights, {kind}, lens {spacings:g} spacings", calibration, path, truth


def render(renderer, calibration, path, options):
    """Returns (picture, share of the pixels that are kept)."""
    with tempfile.TemporaryDirectory() as temporary:
        frame, _ = quality.render(renderer, calibration, path, pathlib.Path(temporary) / "frames", options)
        report = json.loads((frame.parent / "report.json").read_text())["rebinning"]
        return lens_weights.linear_exr(frame), report.get("pixels", report["cells"]) / report["lf_pixels_looked_at"]


def pair(truth, picture):
    return f"{lens_weights.psnr(truth, picture):.2f}, " \
           f"{lens_weights.psnr(quality.encoded(truth), quality.encoded(picture)):.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("groundtruth", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default="")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.groundtruth:
        parser.error("LFRENDERER GROUNDTRUTH or --again is needed")
    table = lens_weights.Table("case", "kept", *COLUMNS)
    record = results.context() | {"options": COLUMNS}
    with tempfile.TemporaryDirectory() as temporary:
        for name, calibration, path, truth in cases(arguments.renderer, arguments.groundtruth, pathlib.Path(temporary)):
            if arguments.only not in name:
                continue
            found = {column: render(arguments.renderer, calibration, path, options)
                     for column, options in COLUMNS.items()}
            table.add(name, f"{100 * found['pixels at edges'][1]:.0f} %",
                      *(pair(truth, found[column][0]) for column in COLUMNS))
    table.publish(arguments, "kept_edges.py", record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
