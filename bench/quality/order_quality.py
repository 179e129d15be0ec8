#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how near frames of the first LF images are to frames of all, by the order in which LF images are taken, and
makes the table of doc/checkpoints.md.

usage: order_quality.py BIN SHARED [--only CAPTURE,...] [--seeds 6] [--write doc/checkpoints.md]
       order_quality.py --again JSON [--write doc/checkpoints.md]

BIN      folder of lfrenderer, lfimport and lfsynth
SHARED   folder with groundtruth/ (as for quality.py) and data/: blender-shop and stanford-cards-9x9

Each capture is filmed by lenses that see some of its LF cameras or all. A frame is rendered of all LF images and, for
each number n in NUMBERS below 0.8 of those in the lens, with --max-images n, in each order with each of the seeds.
The figure is the PSNR of the second frame against the first, in sRGB with the peak 1, as the mean of its decibels over
seeds and lenses. The spread order was chosen on `shop` and a part of it alone.
"""
import argparse
import json
import pathlib
import shutil
import sys

import numpy as np

import densify_captures as captures
import lens_weights
import quality
from quality import results

NUMBERS = (12, 16, 24, 32, 48, 64, 96, 128, 256)
SHOWN = (12, 16, 32, 64, 128, 256)  # columns of the table
MOST = 0.8
ORDERS = ("spread", "shuffle")
COLLECT = "--mode collect --estimator bilinear --filter auto --lens-weights"
WEIGHTS = {"default": f"{COLLECT} auto", "none": f"{COLLECT} none"}


class Bench:
    def __init__(self, programs, shared, folder):
        self.programs, self.shared, self.folder = programs, shared, folder

    def synth(self, scene, *options):
        out = self.folder / f"synth_{scene}_{len(options)}"
        results.call([self.programs / "lfsynth", scene, "-q", "-o", out, "--format", "png", *options])
        return quality.read_field(out / "transforms.json")

    def written(self, name, field):
        return quality.write_field(self.folder / name, field, field["frames"])

    def path(self, field, name, size, elements, diameter, focus):
        return captures.middle_path(field, self.folder / f"{name}_{diameter}_{focus}.yaml", size, elements, diameter,
                                    focus)


# Each returns (calibration, paths).
def shop(bench):
    out = bench.folder / "shop"
    results.call([bench.programs / "lfimport", bench.shared / "data/blender-shop/images", "-o", out, "-q"])
    field = quality.read_field(out / "transforms.json")
    return out / "transforms.json", [bench.path(field, "shop", (240, 160), 200, diameter, focus)
                                     for diameter, focus in ((0.24, 6.3), (0.7, 8.12))]


def truth(name, *cases):
    def make(bench):
        folder = bench.shared / "groundtruth"
        return folder / f"data/{name}/transforms.json", [
            path for _, path, _ in captures.ground_truth_frames(folder, cases, bench.folder)]
    return make


def cards(bench):
    field = captures.cards_field(bench.shared / "data/stanford-cards-9x9/images")
    return bench.written("cards", field), [bench.path(field, "cards", (256, 256), 333, diameter, focus)
                                           for diameter, focus in ((16, 148), (14, 286))]


def at_random(bench):
    spacing = 0.003
    field = bench.synth("still-life", "--count", 441, "--size", "240x160", "--spacing", spacing, "--jitter", 0.5)
    field["frames"] = captures.at_random(field["frames"], 260, 1)
    return bench.written("random", field), [
        bench.path(field, "random", (240, 160), field["fl_x"], diameter, focus)
        for diameter, focus in ((16 * spacing, 0.45), (10 * spacing, 1.6))]


def dome(bench):
    field = bench.synth("chart", "--capture", "hemisphere", "--count", 2000, "--size", "160x120")
    return bench.written("dome", field), [
        captures.camera_path(field, bench.folder / f"dome_{number}.yaml", number, 0.5, 0.85)
        for number in (500, 900)]


CAPTURES = {"shop": shop, "planar": truth("planar", "planar_d8_f20", "planar_d4_f50"),
            "band": truth("band", "band_d4_f40"), "cards": cards, "random": at_random, "dome": dome}


def light(bench, calibration, path, *options):
    """Returns the light of the first frame, and its number of LF images."""
    out = bench.folder / "frames"
    results.call([bench.programs / "lfrenderer", calibration, path, "-o", out, "--frames", 1, "--format", "exr-float",
                  "-q", "--no-contact-sheet", "--overwrite", *options])
    report = json.loads((out / "report.json").read_text())
    picture = lens_weights.linear_exr(next(out.glob("frame_*.exr")))
    shutil.rmtree(out)
    return picture, report["frames"][0]["lf_images"]


def frame(bench, calibration, path, *options):
    """Returns the first frame, in sRGB, and its number of LF images."""
    picture, count = light(bench, calibration, path, *options)
    return quality.encoded(picture), count


def measure(bench, names, seeds):
    rows = []
    for name in names:
        calibration, paths = CAPTURES[name](bench)
        for weights, words in WEIGHTS.items():
            decibels, counts = {}, []
            for path in paths:
                whole, count = frame(bench, calibration, path, *words.split())
                counts.append(count)
                for n in NUMBERS:
                    if n > MOST * count:
                        break
                    for order in ORDERS:
                        for seed in range(seeds):
                            part, _ = frame(bench, calibration, path, *words.split(), "--max-images", n, "--order",
                                            order, "--seed", seed)
                            error = np.mean((part - whole) ** 2)
                            decibels.setdefault((n, order), []).append(-10 * np.log10(error))
            for n in NUMBERS:
                if (n, "spread") in decibels:
                    row = {"capture": name, "weights": weights, "lf_images": counts, "n": n}
                    rows.append(row | {order: float(np.mean(decibels[n, order])) for order in ORDERS}
                                | {f"worst_{order}": float(np.min(decibels[n, order])) for order in ORDERS})
                    print(rows[-1], file=sys.stderr, flush=True)
    return rows


def table(record):
    lines = ["| capture | in the lens | lens weights | " + " | ".join(f"*n* = {n}" for n in SHOWN)
             + " | least gain, dB |", "|" + " --- |" * (len(SHOWN) + 4)]
    groups = {}
    for row in record["rows"]:
        groups.setdefault((row["capture"], row["weights"]), {})[row["n"]] = row
    for (capture, weights), rows in groups.items():
        cell = lambda n: f"**{rows[n]['spread']:.1f}**, {rows[n]['shuffle']:.1f}" if n in rows else ""
        gain = {n: row["spread"] - row["shuffle"] for n, row in rows.items()}
        least = min(gain, key=gain.get)
        counts = ", ".join(map(str, next(iter(rows.values()))["lf_images"]))
        lines.append(f"| {capture} | {counts} | {weights} | " + " | ".join(map(cell, SHOWN))
                     + f" | {gain[least]:+.1f} (*n* = {least}) |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", default=",".join(CAPTURES), help="captures, with commas between")
    parser.add_argument("--seeds", type=int, default=6)
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.shared, lambda folder: {
        "seeds": arguments.seeds,
        "rows": measure(Bench(arguments.programs.resolve(), arguments.shared.resolve(), folder),
                        arguments.only.split(","), arguments.seeds)}, "BIN SHARED")
    text = "\n".join([results.sentence(record), f"PSNR, dB, of frames of the first *n* LF images against frames of "
                      f"all: **spread**, shuffle; means of {record['seeds']} seeds each. Default is `--mode collect "
                      "--estimator bilinear --filter auto --lens-weights auto`; none has `--lens-weights none` in its "
                      "place.", ""] + table(record)) + "\n"
    results.publish(arguments, "quality/order_quality.py", record, text)


if __name__ == "__main__":
    main()
