#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders light fields whose true thin-lens pictures are known with collected rays, with kept pixels, with cells, and
with collected and kept rays, and prints the table of doc/rebinning.md.

usage: rebinning_quality.py LFRENDERER GROUNDTRUTH [--name NAME] [--write doc/rebinning.md] [--only SUBSTRING]
                            [--check]
       rebinning_quality.py --again JSON [--write doc/rebinning.md]

GROUNDTRUTH  as for quality.py
--check      exit 1 if a hybrid frame is more than 0.05 dB below the collected frame; if, for a lens that leaves
             elements without rays, it is not 3 dB above the collected frame; or if the frame of the pinhole between the
             LF cameras is below 30 dB
"""
import argparse
import json
import pathlib
import sys
import tempfile

import lens_weights
import quality
from quality import results

# "with lens weights" is the default; "rebinned" and "hybrid" are the default with another mode, which keeps pixels.
COLUMNS = {
    "collected, nearest": "--mode collect --estimator nearest --lens-weights none",
    "collected": "--mode collect --estimator bilinear --filter prefiltered --lens-weights none",
    "with lens weights": "",
    "rebinned": "--mode rebin",
    "rebinned, cells": "--mode rebin --interpolation cells",
    "hybrid, no weights": "--mode hybrid --estimator bilinear --filter prefiltered --lens-weights none",
    "hybrid": "--mode hybrid",
}


def ground_truth_cases(truth_folder, folder):
    """Yields (name, calibration, path, true picture)."""
    for case in json.loads((truth_folder / "cases.json").read_text())["cases"]:
        if not case["aperture_diameter_m"]:
            *_, forward = quality.camera_axes(case)
            case.update(aperture_diameter_m=0.0, blades=0, blade_rotation_deg=0.0,
                        focus_distance_m=lens_weights.PINHOLE_FOCUS_M,
                        focus_plane={"normal": list(forward)})
        path = folder / (case["name"] + ".yaml")
        path.write_text(quality.path_yaml(case))
        truth = lens_weights.linear_pfm(truth_folder / case["linear"])
        calibration = truth_folder / case["light_field"]
        yield case["name"], calibration, path, truth
        field = quality.read_field(calibration)
        thinned = quality.write_field(folder / (calibration.parent.name + "_4th"), field, field["frames"][::4])
        yield case["name"] + ", every 4th LF image", thinned, path, truth


def synthetic_cases(renderer, folder):
    scenes = lens_weights.SyntheticScenes(renderer, folder)
    spacing = lens_weights.SYNTHETIC_SPACING
    for scene in lens_weights.SYNTHETIC_SCENES:
        for distances, behind, words in (
                (0, 0, "pinhole"), (0.25, 0, "1/4 of the spacing"),
                (0.25, 0.03, "1/4 of the spacing, behind the capture"),
                (0.9, 0.03, "0.9 of the spacing, behind the capture"), (3, 0, "3 spacings"),
                (8, 0, "8 spacings")):
            path, truth = scenes.truth(scene, distances * spacing, behind=behind)
            yield f"{scene}, lens {words}", scenes.calibration(scene), path, truth
        # Keeps only the middle rows, so that the lens is twice as high as the capture.
        calibration = scenes.calibration(scene)
        field = quality.read_field(calibration)
        up = lens_weights.np.array(field["frames"][0]["transform_matrix"])[:3, 1]
        places = [lens_weights.np.array(f["transform_matrix"])[:3, 3] @ up for f in field["frames"]]
        middle = sum(places) / len(places)
        kept = [f for f, p in zip(field["frames"], places) if abs(p - middle) < 2 * spacing]
        band = quality.write_field(folder / (scene + "_band"), field, kept)
        path, truth = scenes.truth(scene, 8 * spacing)
        yield f"{scene}, lens twice as high as the band", band, path, truth


def faults_of(name, found):
    plain = [found[c][0] for c in ("collected, nearest", "collected")]
    for column in ("hybrid, no weights", "hybrid"):
        hybrid = found[column][0]
        reference = found["collected"][0]
        if reference is not None and hybrid < reference - 0.05:
            yield f"{name}: {column} {hybrid:.2f} dB, collected {reference:.2f} dB"
        if " of the spacing" in name and max(p or 0 for p in plain) + 3 > hybrid:
            yield f"{name}: {column} {hybrid:.2f} dB is not 3 dB above what was collected"
    for column in ("rebinned", "rebinned, cells"):
        if "pinhole_between" in name and "4th" not in name and found[column][0] < 30:
            yield f"{name}: {column} {found[column][0]:.2f} dB, expected 30"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("groundtruth", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default="")
    parser.add_argument("--check", action="store_true")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.groundtruth:
        parser.error("LFRENDERER GROUNDTRUTH or --again is needed")
    if not (arguments.groundtruth / "cases.json").exists():
        print(f"skipped: no ground truth at {arguments.groundtruth} (set LF_TEST_DATA)")
        return 77
    table = lens_weights.Table("case", *COLUMNS)
    record = results.context() | {"options": COLUMNS}
    faults = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        cases = [*ground_truth_cases(arguments.groundtruth, folder),
                 *synthetic_cases(arguments.renderer, folder)]
        for name, calibration, path, truth in cases:
            if arguments.only not in name:
                continue
            found = {column: lens_weights.decibels(arguments.renderer, truth, calibration, path,
                                                   options)
                     for column, options in COLUMNS.items()}
            table.add(name, *(lens_weights.text(found[column]) for column in COLUMNS))
            faults += faults_of(name, found)
    table.publish(arguments, "rebinning_quality.py", record)
    for fault in faults:
        print("fault:", fault)
    return 1 if arguments.check and faults else 0


if __name__ == "__main__":
    sys.exit(main())
