#!/usr/bin/python3
"""Renders ground truth cases from thinned captures, without and with lens weights, and prints the
table of doc/lens-integral.md.

usage: lens_weights.py LFRENDERER GROUNDTRUTH [--write doc/lens-integral.md] [--only SUBSTRING]

GROUNDTRUTH  as for quality.py
"""
import argparse
import json
import pathlib
import random
import sys
import tempfile

import numpy as np

import quality

PINHOLE_FOCUS_M = 0.5  # the truth of a pinhole has no focus plane
SEED = 5


def thinned(case, frames):
    """(name, frames of it) of every capture; LF images are dropped at random, but always the same."""
    position, right, _, _ = quality.camera_axes(case)
    side = [(np.array(f["transform_matrix"])[:3, 3] - position) @ right for f in frames]

    def kept(share):
        dice = random.Random(SEED)
        return [f for f, s in zip(frames, side) if dice.random() < share(s)]
    yield "full", frames
    yield "half of one lens half dropped", kept(lambda s: 0.5 if s > 0 else 1)
    yield "three quarters dropped", kept(lambda s: 0.25)
    yield "90 % dropped", kept(lambda s: 0.1)


def decibels(renderer, truth, case, calibration, folder, weights):
    """PSNR of the frame, none without a ray; LF images that took part"""
    path = folder / "path.yaml"
    path.write_text(quality.path_yaml(case))
    try:
        frame, images = quality.render(renderer, calibration, path, folder / weights, "bilinear",
                                       weights)
    except quality.RenderFailed as failure:
        if "no LF image contributes" not in str(failure):
            raise
        return None, 0
    return quality.psnr(truth, case, frame), images


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer")
    parser.add_argument("groundtruth", type=pathlib.Path)
    parser.add_argument("--write", type=pathlib.Path)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    truth = arguments.groundtruth
    text = lambda db: "no ray" if db is None else f"{db:.2f}"
    rows = ["| case | capture | LF images | none | area | hat |", "| --- | --- | --- | --- | --- | --- |"]
    for case in json.loads((truth / "cases.json").read_text())["cases"]:
        if arguments.only not in case["name"]:
            continue
        is_pinhole = not case["aperture_diameter_m"]
        if is_pinhole:
            *_, forward = quality.camera_axes(case)
            case.update(aperture_diameter_m=0.0, blades=0, blade_rotation_deg=0.0,
                        focus_distance_m=PINHOLE_FOCUS_M, focus_plane={"normal": list(forward)})
        calibration = truth / case["light_field"]
        field = json.loads(calibration.read_text())
        for frame in field["frames"]:
            frame["file_path"] = str((calibration.parent / frame["file_path"]).resolve())
        for name, frames in thinned(case, field["frames"]):
            with tempfile.TemporaryDirectory() as temporary:
                folder = pathlib.Path(temporary)
                (folder / "transforms.json").write_text(json.dumps(dict(field, frames=frames)))
                found = {weights: decibels(arguments.renderer, truth, case,
                                           folder / "transforms.json", folder, weights)
                         for weights in (["hat"] if is_pinhole else ["none", "area", "hat"])}
                none, area, hat = (found.get(w, (None, 0)) for w in ("none", "area", "hat"))
                rows.append(f"| {case['name']} | {name} | {none[1]} ({(hat if is_pinhole else area)[1]}"
                            f" weighed) | {text(none[0])} | {'-' if is_pinhole else text(area[0])} | "
                            f"{text(hat[0])} |")
                print(rows[-1], flush=True)
    if arguments.write:
        quality.write_table(arguments.write, "lens_weights.py", rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
