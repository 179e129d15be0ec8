#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the noise of frames that --stop-when "noise<=X" ends with their difference from frames of all LF images.

usage: bench/quality/noise_rule.py BUILD_DIR [--data ../shared] [--size 480x320] [--noise 0.024,0.016,...] [--seeds 3]
                           [--only WAY,...] [--captures NAME,...] [--name NAME] [--write PAGE]
       bench/quality/noise_rule.py --again JSON [--write PAGE]

Three captures are filmed by lenses that see most of their LF cameras: blender-shop (729 LF images; focused on the
foreground, the counter and the shelf behind it), the ground truth `planar` (361), and 260 LF cameras of a synthetic
scene at random positions. Each frame is rendered in the ways of WAYS with all LF images, and with a rule for every X,
in the orders of ORDERS with each of the seeds.

The kept plates contain the second moments of the measured elements (progress.noise), from which the standard error s of
each element is computed here again. N LF images contribute to an element in the end. After n of them, if they were
drawn at random, its difference from its final value would have the standard deviation s * sqrt(1 - n / N). The script
compares the measured and this expected root mean square of the difference over the measured elements and channels, and
the 90th percentile of its absolute value; the expected percentile assumes that differences are normally distributed.
"""
import argparse
import itertools
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

import numpy as np
import zstandard

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
import densify_captures as captures
import order_quality
import record as results

FOCUS = {"foreground": 6.3, "counter": 8.12, "shelf": 13}  # metres, see the data's README
ORDERS = ("spread", "shuffle")
WAYS = {
    "nearest": ["--mode", "collect", "--estimator", "nearest", "--lens-weights", "none"],
    "default": ["--mode", "collect", "--estimator", "bilinear", "--filter", "auto",
                "--lens-weights", "auto"],
}
PATH = """format: lfpath 1
fps: 1
frames: {frames}
resolution: [{width}, {height}]
camera: {{field_of_view_deg: 61.92751, focal_length_mm: 30, position: [0, 0, 0], look_at: [0, 0, 9], up: [0, -1, 0]}}
lens: {{aperture_diameter: 0.9, focus_distance: 8}}
keyframes:
  focus_distance: [{keys}]
"""


def write_path(folder, size):
    keys = ", ".join(f"{{time: {i}, value: {focus}, interpolation: step}}"
                     for i, focus in enumerate(FOCUS.values()))
    path = folder / "path.yaml"
    path.write_text(PATH.format(frames=len(FOCUS), width=size[0], height=size[1], keys=keys))
    return path


def shop(bench, size):
    return bench.shared / "data/blender-shop/images", write_path(bench.folder, size)


def planar(bench, size):
    calibration = bench.shared / "groundtruth/data/planar/transforms.json"
    return calibration, joined(bench, size, order_quality.quality.read_field(calibration), "planar", 0.0085,
                               (0.2, 0.5))


def at_random(bench, size):
    calibration, _ = order_quality.at_random(bench)
    return calibration, joined(bench, size, order_quality.quality.read_field(calibration), "random", 0.05,
                               (0.45, 1.6))


def joined(bench, size, field, name, diameter, focuses):
    """Writes the path of a frame for each focus distance."""
    width, height = (length // 2 for length in size)
    path = captures.middle_path(field, bench.folder / f"{name}.yaml", (width, height),
                                field["fl_x"] * width / field["w"], diameter, focuses[0])
    keys = ", ".join(f"{{time: {i / 25}, value: {focus}, interpolation: step}}" for i, focus in enumerate(focuses))
    lines = path.read_text().replace("frames: 1\n", f"frames: {len(focuses)}\n").splitlines()
    lines = [line for line in lines if not line.startswith("  focus_distance:")]
    path.write_text("\n".join([*lines, "keyframes:", f"  focus_distance: [{keys}]", ""]))
    return path


CAPTURES = {"shop": shop, "planar": planar, "random": at_random}


def render(build, field, path, out, *options):
    subprocess.run([str(word) for word in (
        build / "bin/lfrenderer", field, path, "-o", out, "-q", "--format", "exr-float", "--no-contact-sheet",
        "--keep-plates", *options)], check=True)
    return [frame["noise"] for frame in json.loads((out / "report.json").read_text())["frames"]]


def read_plate(path):
    """Returns entries and words [height][width][3] (doc/formats/plate.md)."""
    data = path.read_bytes()
    text_bytes, width, height = struct.unpack_from("<3I", data, 12)
    entries = dict(line.split(": ", 1)
                   for line in data[40:40 + text_bytes].decode().splitlines())
    at, rows, words = 48 + text_bytes, struct.unpack_from("<I", data, 28)[0], []
    for first in range(0, height, rows):
        stored, _, _ = struct.unpack_from("<IIQ", data, at)
        size = min(rows, height - first) * width * 3
        planes = np.frombuffer(zstandard.ZstdDecompressor().decompress(
            data[at + 16:at + 16 + stored], 8 * size), np.uint8)
        words.append(np.ascontiguousarray(planes.reshape(8, size).T).view("<u8").ravel())
        at += 16 + stored
    return entries, np.concatenate(words).reshape(height, width, 3)


class Measured:
    """The measured elements of a frame: radiance, its standard error, number of LF images; [rows][columns][channel]."""

    def __init__(self, path):
        entries, words = read_plate(path)
        columns, rows, *numbers = (int(word, 16) for word in entries["progress.noise"].split())
        height, width = words.shape[:2]
        y = [(2 * i + 1) * height // (2 * rows) for i in range(rows)]
        x = [(2 * i + 1) * width // (2 * columns) for i in range(columns)]
        words = words[np.ix_(y, x)]
        self.count = (words >> np.uint64(40)).astype(float)
        self.sum = (words & np.uint64((1 << 40) - 1)).astype(float)
        pedestal, scale = map(float, entries["plate.develop"].split()[:2])
        squares, cross, counts, self.images = np.moveaxis(
            np.array(numbers, dtype=float).reshape(rows, columns, 3, 4), 3, 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = self.sum / self.count
            variance = self.images / (self.images - 1) * np.maximum(
                0, squares - 2 * mean * cross + mean ** 2 * counts) / self.count ** 2
            self.radiance = (mean - pedestal) / scale
            self.error = np.sqrt(variance) / scale


def percentile_of_normals(deviations, share):
    """Returns the x that a share `share` of normal numbers with these standard deviations does not exceed in absolute
    value."""
    low, high = 0.0, 10 * deviations.max()
    erf = np.vectorize(math.erf)
    for _ in range(40):
        middle = (low + high) / 2
        below = erf(middle / (np.maximum(deviations, 1e-12) * math.sqrt(2))).mean()
        low, high = (middle, high) if below < share else (low, middle)
    return (low + high) / 2


def compare(stopped, whole):
    """Returns root mean square and 90th percentile of the difference: measured and expected."""
    known = (stopped.images >= 2) & (whole.images >= 2)
    n, most = stopped.images[known], whole.images[known]
    expected = stopped.error[known] * np.sqrt(np.maximum(0, 1 - n / most))
    difference = np.abs(stopped.radiance[known] - whole.radiance[known])
    return {"elements": int(known.any(axis=2).sum()),
            "rms": float(np.sqrt(np.mean(difference ** 2))),
            "rms_expected": float(np.sqrt(np.mean(expected ** 2))),
            "most": float(np.quantile(difference, 0.9)),
            "most_expected": percentile_of_normals(expected, 0.9)}


def measure(build, data, size, arguments, ways):
    rows = []
    noises, seeds = map(float, arguments.noise.split(",")), range(arguments.seeds)
    cases = list(itertools.product(ORDERS, noises, seeds))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        bench = order_quality.Bench(build / "bin", data, folder)
        for capture in arguments.captures.split(","):
            field, path = CAPTURES[capture](bench, size)
            for way, options in ways.items():
                whole, out = folder / f"whole {capture} {way}", folder / "stopped"
                ends = render(build, field, path, whole, *options, "--require", "noise<=1000")
                for order, noise, seed in cases:
                    frames = render(build, field, path, out, *options, "--order", order, "--seed", seed, "--stop-when",
                                    f"noise<={noise}", "--overwrite")
                    for number, (frame, end) in enumerate(zip(frames, ends), 1):
                        name = f"frame_{number:04d}.plate"
                        rows.append({"capture": capture, "way": way, "order": order, "seed": seed, "frame": number,
                                     "asked": noise, **frame, "lf_images_in_all": end["lf_images"],
                                     **compare(Measured(out / name), Measured(whole / name))})
                        print(rows[-1], flush=True)
    return rows


def is_early(row):
    return row["lf_images"] < row["lf_images_in_all"]


def ratio(rows, what):
    """Returns the root mean square of measured differences divided by that of the expected ones, and their range."""
    one = lambda chosen: math.sqrt(sum(row[what] ** 2 for row in chosen)
                                   / sum(row[f"{what}_expected"] ** 2 for row in chosen))
    each = [one([row]) for row in rows]
    return f"**{one(rows):.2f}** ({min(each):.2f} to {max(each):.2f})"


def table(rows):
    lines = ["| capture | way | order | X | frames ended early | LF images | noise reached / X | difference to all LF "
             "images / as expected: RMS | 90 % are below |", "|" + " --- |" * 9]
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in ("capture", "way", "order", "asked")), []).append(row)
    for (capture, way, order, asked), group in groups.items():
        early = [row for row in group if is_early(row)]
        if not early:
            continue
        reached, images = ([row[key] for row in early] for key in ("reached", "lf_images"))
        lines.append(f"| {capture} | {way} | {order} | {asked} | {len(early)} of {len(group)} | {min(images)} to "
                     f"{max(images)} of {early[0]['lf_images_in_all']} | {min(reached) / asked:.2f} to "
                     f"{max(reached) / asked:.2f} | {ratio(early, 'rms')} | {ratio(early, 'most')} |")
    lines.append("")
    for order in ORDERS:
        early = [row for row in rows if is_early(row) and row["order"] == order]
        lines.append(f"- {order}: differences of all {len(early)} frames together, divided by those expected of random "
                     f"LF images: RMS {ratio(early, 'rms')}, 90th percentile {ratio(early, 'most')}.")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parents[2] / "../shared")
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--noise", default="0.024,0.016,0.011")
    parser.add_argument("--only", default=",".join(WAYS), help="ways, with commas between")
    parser.add_argument("--captures", default=",".join(CAPTURES), help="with commas between")
    parser.add_argument("--seeds", type=int, default=3)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    else:
        record = results.context()
        size = [int(length) for length in arguments.size.split("x")]
        record["size"] = size
        record["ways"] = {way: WAYS[way] for way in arguments.only.split(",")}
        record["rows"] = measure(arguments.build.resolve(), arguments.data.resolve(), size, arguments,
                                 record["ways"])
    ways = [f"{way} is `{' '.join(options)}`" for way, options in record["ways"].items()]
    text = "\n".join([results.sentence(record), f"Frames of {record['size'][0]} x {record['size'][1]}, half as wide of "
                      "`planar` and `random`; " + "; ".join(ways) + ".", ""] + table(record["rows"])) + "\n"
    results.publish(arguments, "quality/noise_rule.py", record, text)


if __name__ == "__main__":
    main()
