#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how much the remedies of thesis 5.3 reduce noise in rebinned frames.

usage: bench/quality/noise_remedies.py BUILD_DIR GROUNDTRUTH [--electrons 1000] [--read-noise 5] [--seed 1]
                               [--only SUBSTRING] [--remedies SUBSTRING] [--name NAME] [--write PAGE]
       bench/quality/noise_remedies.py --again JSON [--write PAGE]

GROUNDTRUTH  as for bench/quality/quality.py: LF images without noise, and true thin-lens pictures
--electrons  electrons that a pixel of the sensor collects at white; their noise is photon noise
--read-noise standard deviation, in electrons, of the noise that reading adds to every pixel

Noise with a fixed seed is added to the linear light of the LF images. The LF images are then stored as before, in 8
bits by the sRGB curve. Each way of rendering is called twice: with the noisy LF images and with the clean ones. The
noise of a frame is the root mean square of the difference of both results, in grey steps (1/255 of display values),
over the whole frame and over its darkest quarter. The PSNR compares the noisy frame with the truth, once in linear
light and once in display values, in which errors in shadows count as much as errors in light areas.

"recorded" renders average stored values as they are: the light field claims that they are linear light (--transfer of
the thesis: no inverse response curve), and the curve is applied to the finished frame.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import lens_weights
from lens_weights import cv2, np
from quality import results
from rebinning_quality import ground_truth_cases

FULL = "--mode rebin --interpolation cells --estimator bilinear --filter prefiltered --lens-weights auto"
EDGES = FULL + " --kept edges"
WIDE = EDGES + " --r-st {pitch} --r-uv {pixel}"
# name: options of lfrenderer. Placeholders of cell widths: {pitch} is the distance between neighbouring LF cameras,
# {pixel} the width of an LF pixel in the focus plane.
REMEDIES = {
    "rebinned, no remedy": EDGES + " --colour-sigma 0 --average-others off",
    "colours smoothed by 1 pixel": EDGES + " --colour-sigma 1 --average-others off",
    "colours smoothed by 2 pixels": EDGES + " --colour-sigma 2 --average-others off",
    "edges smoothed by 2 pixels": EDGES + " --edge-sigma 2",
    "others averaged": EDGES + " --average-others on",
    "four times as many rays": EDGES + " --xi 0.2",
    "wide cells": WIDE + " --average-others off",
    "wide cells, others averaged": WIDE + " --average-others on",
    "all rays": FULL + " --kept all",
    "collected, nearest (the thesis's way)": "--mode collect --estimator nearest --lens-weights none",
    "collected (the default)": "--mode collect --estimator bilinear --filter auto --lens-weights auto",
}
CASES = ("planar_d8_f20", "planar_pinhole_between")


def linear_of(stored):
    return np.where(stored <= 0.04045, stored / 12.92, ((np.maximum(stored, 0) + 0.055) / 1.055) ** 2.4)


def stored_of(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def noisy(stored, electrons, read_noise, dice):
    """Returns 8-bit values as a sensor with noise would have stored them."""
    light = electrons * linear_of(stored / 255)
    light = dice.poisson(light) + dice.normal(0, read_noise, light.shape)
    return np.rint(255 * stored_of(light / electrons)).astype(np.uint8)


class Captures:
    """The light fields of the cases: clean or noisy LF images, as linear light by their curve or as recorded."""

    def __init__(self, folder, arguments):
        self.folder, self.arguments = folder, arguments
        self.seen = {}

    def images(self, calibration, is_noisy):
        """Returns the folder of the LF images, and the calibration in that folder."""
        key = calibration.parent.name + ("-noisy" if is_noisy else "-clean")
        if key not in self.seen:
            field = json.loads(calibration.read_text())
            folder = self.folder / key
            folder.mkdir()
            dice = np.random.default_rng(self.arguments.seed)
            for frame in field["frames"]:
                name = pathlib.Path(frame["file_path"]).name
                image = cv2.imread(str(calibration.parent / frame["file_path"]), cv2.IMREAD_COLOR)
                if is_noisy:
                    image = noisy(image, self.arguments.electrons, self.arguments.read_noise, dice)
                cv2.imwrite(str(folder / name), image, [cv2.IMWRITE_PNG_COMPRESSION, 1])
                frame["file_path"] = name
            self.seen[key] = folder, field
        return self.seen[key]

    def calibration(self, calibration, is_noisy, is_recorded):
        folder, field = self.images(calibration, is_noisy)
        path = folder / ("recorded" if is_recorded else "curve") / "transforms.json"
        path.parent.mkdir(exist_ok=True)
        frames = [dict(f, file_path="../" + f["file_path"]) for f in field["frames"]]
        path.write_text(json.dumps(dict(field, frames=frames, lf_transfer="linear" if is_recorded else "sRGB")))
        return path


def frame_of(renderer, calibration, path, options):
    with tempfile.TemporaryDirectory() as out:
        call = subprocess.run([renderer, calibration, path, "-o", out, "--format", "exr-float", "-q",
                               "--no-contact-sheet", *options.split()], stderr=subprocess.PIPE, text=True)
        if "no LF image contributes" in call.stderr or "has no area" in call.stderr:
            return None  # no recorded ray passes through a pinhole
        if call.returncode != 0:
            raise SystemExit(call.stderr)
        return lens_weights.linear_exr(pathlib.Path(out) / "frame_0001.exr")


def widths(calibration, case_path):
    """Returns the width of an LF pixel in the focus plane, and the distance between neighbouring LF cameras, in world
    units."""
    field = json.loads(calibration.read_text())
    places = np.array([f["transform_matrix"] for f in field["frames"]])[:, :3, 3]
    nearest = [np.sort(np.linalg.norm(places - p, axis=1))[1] for p in places]
    focus = float(next(line.split(":")[1] for line in case_path.read_text().splitlines()
                       if "focus_distance" in line))
    return {"pitch": f"{statistics.median(nearest):.6f}", "pixel": f"{focus / field['fl_x']:.6f}"}


def measure(renderer, captures, calibration, path, truth, name, options):
    options = options.format(**widths(calibration, path))
    row = {"remedy": name, "options": options}
    for values in ("linear", "recorded"):
        frames = []
        for is_noisy in (True, False):
            frame = frame_of(renderer, captures.calibration(calibration, is_noisy, values == "recorded"), path,
                             options)
            if frame is None:
                return None
            frames.append(frame if values == "linear" else linear_of(np.clip(frame, 0, 1)))
        shown, clean, expected = (stored_of(picture) for picture in (*frames, truth))
        dark = truth.mean(axis=2) <= np.quantile(truth.mean(axis=2), 0.25)
        rms = lambda difference: float(255 * np.sqrt(np.mean(difference ** 2)))
        row[values] = {"psnr_linear": float(lens_weights.psnr(truth, frames[0])),
                       "psnr_display": float(lens_weights.psnr(expected, shown)),
                       "noise": rms(shown - clean), "noise_dark": rms((shown - clean)[dark])}
    return row


def table(record):
    lines = ["| remedy | linear light: noise, in the dark | PSNR, linear | "
             "PSNR, display | recorded values: noise, in the "
             "dark | PSNR, linear | PSNR, display |", "|" + " --- |" * 7]
    for case in record["cases"]:
        lines.append(f"| **{case['case']}** | | | | | | |")
        for row in case["rows"]:
            cells = [f"{row[v]['noise']:.2f}, {row[v]['noise_dark']:.2f} | {row[v]['psnr_linear']:.2f} | "
                     f"{row[v]['psnr_display']:.2f}" for v in ("linear", "recorded")]
            lines.append(f"| {row['remedy']} | {' | '.join(cells)} |")
    lines += ["", "Options of each row:", ""]
    options = {}
    for row in (row for case in record["cases"][:1] for row in case["rows"]):
        options[row["remedy"]] = REMEDIES.get(row["remedy"], row["options"])
    lines += [f"- {name}: `{words}`" for name, words in options.items()]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("groundtruth", type=pathlib.Path, nargs="?")
    parser.add_argument("--electrons", type=float, default=1000)
    parser.add_argument("--read-noise", type=float, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="cases whose names have it")
    parser.add_argument("--remedies", default="", help="remedies whose names have it")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.groundtruth:
        renderer = arguments.build.resolve() / "bin/lfrenderer"
        record = results.context()
        record.update(electrons=arguments.electrons, read_noise=arguments.read_noise, seed=arguments.seed, cases=[])
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            captures = Captures(folder, arguments)
            for name, calibration, path, truth in ground_truth_cases(arguments.groundtruth, folder):
                if name not in CASES or arguments.only not in name:
                    continue
                rows = []
                for remedy, options in REMEDIES.items():
                    if arguments.remedies in remedy:
                        rows.append(measure(renderer, captures, calibration, path, truth, remedy, options))
                        print(name, json.dumps(rows[-1]), file=sys.stderr, flush=True)
                record["cases"].append({"case": name, "rows": [row for row in rows if row]})
    else:
        parser.error("BUILD_DIR and GROUNDTRUTH, or --again is needed")
    text = "\n".join([results.sentence(record) + " LF images with the noise of "
                                                 f"{record['electrons']:g} electrons at white "
                      f"and {record['read_noise']:g} of reading, seed {record['seed']}.", ""] + table(record)) + "\n"
    results.publish(arguments, "quality/noise_remedies.py", record, text)


if __name__ == "__main__":
    main()
