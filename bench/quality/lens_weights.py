#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders light fields whose true thin-lens pictures are known, by every estimator and with every
kind of lens weights, and prints the tables of doc/lens-integral.md.

usage: lens_weights.py LFRENDERER GROUNDTRUTH [--name NAME] [--write doc/lens-integral.md] [--only SUBSTRING]
                       [--tables captures,lenses,magnifications]
       lens_weights.py --again JSON [--write doc/lens-integral.md]

GROUNDTRUTH     as for quality.py
captures        thinned captures of the ground truth cases; LF images are dropped at random, but
                always the same
lenses          lenses as small as pinholes, in two scenes of lfsynth (beside LFRENDERER)
magnifications  the same scenes with frames finer and coarser than their LF images

Each table has its own record. If several tables are made, their records are called NAME-captures and so on.
"""
import argparse
import copy
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

import quality
from quality import results

PINHOLE_FOCUS_M = 0.5  # the ground truth of a pinhole has no focus plane
SEED = 5
SYNTHETIC_SCENES = ("still-life", "chart")
SYNTHETIC_SIZE = (320, 212)
SYNTHETIC_SPACING = 0.003
TRUTH_SAMPLES = 256
COLLECT = "--mode collect --estimator"
# auto is the default and needs no options.
PREFILTERED = f"{COLLECT} bilinear --filter prefiltered --lens-weights"
WEIGHTS = {w: f"{PREFILTERED} {w}" for w in ("none", "area", "hat")} | {"auto": ""}


def linear_exr(path):
    return cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., 2::-1].astype(np.float64)


def linear_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().strip() for _ in range(3))
        width, height = map(int, size.split())
        values = np.frombuffer(file.read(), "<f4" if float(scale) < 0 else ">f4")
    assert kind == b"PF"
    return values.reshape(height, width, 3)[::-1].astype(np.float64)


def psnr(truth, picture):
    """Returns the PSNR in linear light, up to display white, in dB."""
    error = np.clip(truth, 0, 1) - np.clip(picture, 0, 1)
    return -10 * np.log10(np.mean(error ** 2))


def first_frame(renderer, calibration, path, options):
    """Returns (picture, number of contributing LF images); None if the frame has no ray."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        result = subprocess.run(
            [renderer, calibration, path, "-o", folder / "frames", "--format", "exr-float", "-q", "--no-contact-sheet",
             *options.split()], stderr=subprocess.PIPE, text=True)
        if "no LF image contributes" in result.stderr or "has no area" in result.stderr:
            return None, 0
        if result.returncode != 0:
            sys.exit(result.stderr)
        report = json.loads((folder / "frames" / "report.json").read_text())
        return linear_exr(folder / "frames" / "frame_0001.exr"), report["frames"][0]["lf_images"]


def decibels(renderer, truth, calibration, path, options):
    """Returns (PSNR, number of contributing LF images); None if the frame has no ray."""
    picture, images = first_frame(renderer, calibration, path, options)
    return None if picture is None else psnr(truth, picture), images


def text(found):
    return "-" if found[0] is None else f"{found[0]:.2f}"


class Table:
    """Rows of cells, in the order in which they are computed."""

    def __init__(self, *columns):
        self.columns, self.rows = columns, []

    def add(self, *cells):
        self.rows.append([str(cell) for cell in cells])
        print(*cells, sep=" | ", file=sys.stderr, flush=True)

    def publish(self, arguments, words, record):
        """Prints the table and writes it (bench/record.py). words: the words of its marker after scripts/"""
        line = lambda cells: "| " + " | ".join(cells) + " |"
        record |= {"columns": list(self.columns), "rows": self.rows}
        text = [results.sentence(record), "", line(self.columns), "| --- " * len(self.columns) + "|",
                *map(line, self.rows)]
        results.publish(arguments, f"quality/{words}", record, "\n".join(text) + "\n")


def publish_again(arguments):
    """Publishes the table of an earlier run from its record."""
    record = json.loads(arguments.again.read_text())
    table = Table(*record["columns"])
    table.rows = record["rows"]
    table.publish(arguments, record["table"].removeprefix("bench/quality/"), record)


def captures(case, frames):
    """Yields (name, frames of the calibration that are kept)."""
    position, right, up, _ = quality.camera_axes(case)
    places = [np.array(f["transform_matrix"])[:3, 3] - position for f in frames]

    def kept(share):
        dice = random.Random(SEED)
        return [f for f, p in zip(frames, places) if dice.random() < share(p @ right)]

    # The frames are in the order of their names: row by row for a grid, and along a single row.
    yield "full", frames
    yield "every 2nd", frames[::2]
    yield "every 4th", frames[::4]
    yield "half of one lens half dropped", kept(lambda side: 0.5 if side > 0 else 1)
    yield "90 % dropped", kept(lambda side: 0.1)


def table_of_captures(renderer, truth_folder, only):
    table = Table("case", "capture", "LF images", *WEIGHTS)
    for case in json.loads((truth_folder / "cases.json").read_text())["cases"]:
        if only not in case["name"]:
            continue
        if not case["aperture_diameter_m"]:
            *_, forward = quality.camera_axes(case)
            case.update(aperture_diameter_m=0.0, blades=0, blade_rotation_deg=0.0,
                        focus_distance_m=PINHOLE_FOCUS_M, focus_plane={"normal": list(forward)})
        truth = linear_pfm(truth_folder / case["linear"])
        calibration = truth_folder / case["light_field"]
        field = quality.read_field(calibration)
        for name, frames in captures(case, field["frames"]):
            with tempfile.TemporaryDirectory() as temporary:
                folder = pathlib.Path(temporary)
                kept = quality.write_field(folder, field, frames)
                (folder / "path.yaml").write_text(quality.path_yaml(case))
                found = {w: decibels(renderer, truth, kept, folder / "path.yaml", options)
                         for w, options in WEIGHTS.items()}
            table.add(case["name"], name, f"{found['none'][1]} ({found['auto'][1]} weighed)",
                      *(text(found[w]) for w in WEIGHTS))
    return table


def synthetic_path(calibration, diameter, scale, focus, behind=0):
    """Returns a path whose camera is in the middle of the capture, or `behind` it, and looks in the mean direction."""
    field = json.loads(calibration.read_text())
    poses = np.array([f["transform_matrix"] for f in field["frames"]])
    position = poses[:, :3, 3].mean(axis=0)
    forward, up = -poses[:, :3, 2].mean(axis=0), poses[:, :3, 1].mean(axis=0)
    position = position - behind * forward
    numbers = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
    width, height = (round(scale * size) for size in SYNTHETIC_SIZE)
    fov = 2 * np.degrees(np.arctan(0.5 * SYNTHETIC_SIZE[0] / field["fl_x"]))
    return f"""format: lfpath 1
fps: 25
frames: 1
resolution: [{width}, {height}]
camera:
  field_of_view_deg: {float(0.8 * fov)!r}
  focal_length_mm: 50
  position: {numbers(position)}
  look_at: {numbers(position + forward)}
  up: {numbers(up)}
lens:
  aperture_diameter: {diameter!r}
  focus_distance: {focus!r}
"""


class SyntheticScenes:
    """Light fields of lfsynth; each is made once."""

    def __init__(self, renderer, folder):
        self.lfsynth = pathlib.Path(renderer).with_name("lfsynth")
        self.folder = folder

    def run(self, *arguments):
        results.call([self.lfsynth, *arguments, "-q"])

    def photograph(self, scene, folder, *options):
        self.run(scene, "-o", folder, "--count", 225, "--jitter", 0.4, "--spacing", SYNTHETIC_SPACING, "--size",
                 "x".join(map(str, SYNTHETIC_SIZE)), *options)

    def calibration(self, scene):
        folder = self.folder / scene
        if not (folder / "transforms.json").exists():
            self.photograph(scene, folder)
        return folder / "transforms.json"

    def truth(self, scene, diameter, scale=1, focus=0.8, behind=0):
        """Returns (path, true picture)."""
        name = f"{scene}_{diameter}_{scale}_{behind}"
        path = self.folder / (name + ".yaml")
        path.write_text(synthetic_path(self.calibration(scene), diameter, scale, focus,
                                       behind))
        out = self.folder / ("truth_" + name)
        if not out.exists():
            self.run(scene, "-o", out, "--calibration-only", "--truth", path, "--truth-samples",
                     TRUTH_SAMPLES)
        return path, linear_exr(next(out.rglob("frame_0001.exr")))


def table_of_lenses(renderer, scenes, only):
    table = Table("scene", "diameter, in camera distances", "LF images", *WEIGHTS)
    for scene in SYNTHETIC_SCENES:
        if only not in scene:
            continue
        for distances in (0, 0.25, 0.5, 1, 1.5, 2, 3, 8):
            path, truth = scenes.truth(scene, distances * SYNTHETIC_SPACING)
            found = {w: decibels(renderer, truth, scenes.calibration(scene), path, options)
                     for w, options in WEIGHTS.items()}
            table.add(scene, distances or "pinhole",
                      f"{found['none'][1]} ({found['auto'][1]} weighed)",
                      *(text(found[w]) for w in WEIGHTS))
    return table


def table_of_magnifications(renderer, scenes, only):
    estimators = {"nearest": "nearest", "bilinear": "bilinear --filter bilinear",
                  "bicubic": "bilinear --filter bicubic", "prefiltered": "bilinear --filter prefiltered"}
    columns = {f"{e}, {w}": f"{COLLECT} {words} --lens-weights {w}" for e, words in estimators.items()
               for w in ("none", "area")} | {"auto": ""}
    table = Table("scene", "elements per LF pixel", *columns)
    for scene in SYNTHETIC_SCENES:
        if only not in scene:
            continue
        for scale in (0.4, 0.8, 1.2, 1.6):  # the field of view of a frame is 0.8 times an LF image's
            path, truth = scenes.truth(scene, 8 * SYNTHETIC_SPACING, scale)
            table.add(scene, f"{scale / 0.8:g}",
                      *(text(decibels(renderer, truth, scenes.calibration(scene), path, options))
                        for options in columns.values()))
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("groundtruth", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default="", help="cases or scenes whose names have it")
    parser.add_argument("--tables", default="captures,lenses,magnifications")
    parser.add_argument("--scenes", type=pathlib.Path,
                        help="keep the scenes of lfsynth here, and use what is there")
    results.add_options(parser)
    a = parser.parse_args()
    if a.again:
        publish_again(a)
        return 0
    if not a.groundtruth:
        parser.error("LFRENDERER GROUNDTRUTH or --again is needed")
    with tempfile.TemporaryDirectory() as temporary:
        scenes = SyntheticScenes(a.renderer, a.scenes or pathlib.Path(temporary))
        tables = {"captures": lambda: table_of_captures(a.renderer, a.groundtruth, a.only),
                  "lenses": lambda: table_of_lenses(a.renderer, scenes, a.only),
                  "magnifications": lambda: table_of_magnifications(a.renderer, scenes, a.only)}
        names = a.tables.split(",")
        for name in names:
            record = results.context()
            arguments = copy.copy(a)
            if a.name and len(names) > 1:
                arguments.name = f"{a.name}-{name}"
            tables[name]().publish(arguments, "lens_weights.py " + name, record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
