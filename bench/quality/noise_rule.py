#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that frames stopped by --stop-when "noise<=X" have the requested noise, and that this noise equals their
difference from frames of all LF images.

usage: bench/quality/noise_rule.py BUILD_DIR [--data ../shared] [--size 480x320] [--noise 0.012,0.009,...]
                           [--only WAY,...] [--name NAME] [--write PAGE]
       bench/quality/noise_rule.py --again JSON [--write PAGE]

The light field is blender-shop with 729 LF images; most of its LF cameras are in the lens, which is 0.9 m wide. Three
frames are focused on the foreground, the counter and the shelf behind it, and rendered in the ways of WAYS.

Each frame is rendered with all LF images, and with a rule for every X. The kept plates contain the second moments of
the measured elements (progress.noise), from which the standard error s of each element is computed here again. LF
images are taken in random order, and N of them contribute to an element in the end. After n of them, its difference
from its final value is expected to have the standard deviation s * sqrt(1 - n / N). The script compares the measured
and the expected root mean square of the difference over the measured elements and channels, and the 90th percentile of
its absolute value; the expected percentile assumes that differences are normally distributed.
"""
import argparse
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
import record as results

FOCUS = {"foreground": 6.3, "counter": 8.12, "shelf": 13}  # metres, see the data's README
WAYS = {
    "nearest": ["--mode", "collect", "--estimator", "nearest", "--lens-weights", "none"],
    "default": ["--mode", "collect", "--estimator", "bilinear", "--filter", "auto",
                "--lens-weights", "auto"],
    "hybrid": ["--mode", "hybrid", "--estimator", "bilinear", "--filter", "auto",
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


def render(build, field, path, out, *options):
    subprocess.run([build / "bin/lfrenderer", field, path, "-o", out, "-q", "--format", "exr-float",
                    "--no-contact-sheet", "--keep-plates", *options], check=True)
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
        pedestal, scale = map(float, entries["sheet.develop"].split()[:2])
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


def measure(build, data, size, noises, ways):
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        path, field = write_path(folder, size), data / "data/blender-shop/images"
        for way in ways:
            options = WAYS[way]
            whole = folder / f"whole {way}"
            ends = render(build, field, path, whole, *options, "--require", "noise<=1000")
            for noise in noises:
                out = folder / f"{noise} {way}"
                frames = render(build, field, path, out, *options, "--stop-when", f"noise<={noise}")
                for number, (frame, end) in enumerate(zip(frames, ends), 1):
                    name = f"frame_{number:04d}.plate"
                    rows.append({"way": way, "focus": list(FOCUS)[number - 1], "asked": noise, **frame,
                                 "ranks_in_all": end["ranks"], "lf_images_in_all": end["lf_images"],
                                 "reached_by_all": end["reached"],
                                 **compare(Measured(out / name), Measured(whole / name))})
                    print(rows[-1], flush=True)
    return rows


def table(rows):
    lines = ["| way | focused on | X | noise reached | reached / X | ranks | LF images | difference to all "
             "LF images: RMS, as expected | 90 % are below, as expected |", "|" + " --- |" * 9]
    for row in rows:
        early = row["ranks"] < row["ranks_in_all"]
        differences = (f"{row['rms']:.5f}, {row['rms_expected']:.5f} | {row['most']:.5f}, "
                       f"{row['most_expected']:.5f}" if early else "is that of all | ")
        lines.append(f"| {row['way']} | {row['focus']} | {row['asked']} | {row['reached']:.5f} | "
                     f"{row['reached'] / row['asked']:.3f} | {row['ranks']} of {row['ranks_in_all']} | "
                     f"{row['lf_images']} of {row['lf_images_in_all']} | {differences} |")
    ended = [row for row in rows if row["ranks"] < row["ranks_in_all"]]
    ratios = [row["reached"] / row["asked"] for row in ended]
    rms = [row["rms"] / row["rms_expected"] for row in ended]
    most = [row["most"] / row["most_expected"] for row in ended]
    lines += ["", f"{len(ended)} of {len(rows)} frames ended early, after {min(row['ranks'] for row in ended)} "
              f"to {max(row['ranks'] for row in ended)} ranks: with {min(ratios):.3f} to {max(ratios):.3f} of "
              f"the noise asked for. Their differences to frames of all LF images are {min(rms):.2f} to "
              f"{max(rms):.2f} of the RMS expected, and {min(most):.2f} to {max(most):.2f} of the 90th "
              "percentile expected. All elements of a frame take the same LF images, in one order for "
              "all rows, so that their differences are no independent samples."]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parents[2] / "../shared")
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--noise", default="0.024,0.018,0.014,0.011,0.009")
    parser.add_argument("--only", default=",".join(WAYS), help="ways, with commas between")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    else:
        record = results.context()
        size = [int(length) for length in arguments.size.split("x")]
        record["size"] = size
        record["ways"] = {way: WAYS[way] for way in arguments.only.split(",")}
        record["rows"] = measure(arguments.build.resolve(), arguments.data.resolve(), size,
                                 [float(noise) for noise in arguments.noise.split(",")],
                                 record["ways"])
    ways = [f"{way} is `{' '.join(options)}`" for way, options in record["ways"].items()]
    text = "\n".join([results.sentence(record), f"Frames of {record['size'][0]} x {record['size'][1]}; "
                      + "; ".join(ways) + ".", ""] + table(record["rows"])) + "\n"
    results.publish(arguments, "quality/noise_rule.py", record, text)


if __name__ == "__main__":
    main()
