#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Times lfpreprocessor on a million LF cameras: the band of the thesis, and films along a tenth of it.

usage: bench/million_cameras.py BUILD_DIR [--counts 10000,100000,1000000] [--frames 30,900]
                                [--runs 3] [--name NAME] [--write PAGE]
       bench/million_cameras.py --again JSON [--write PAGE]

LF cameras stand on half a circle of 1 m, within 1 cm of height (thesis 5.1), and look at its middle; there
are no images. A lens of 30 mm sees 1 % of the LF cameras, a lens of 150 mm 5 %. The largest light field is filmed with
each number of frames in --frames, smaller light fields only with the first one. Packages have at most 64 frames. They
are made without lens weights and, for the first number of frames, also by the defaults. Figures are medians over the
runs.
"""
import argparse
import json
import math
import pathlib
import statistics
import sys
import tempfile

import numpy as np

import record as results

RADIUS_M, HEIGHT_M = 1, 0.01
FRAMES_PER_PACKAGE = 64
WEIGHTS = {"none": ("--estimator", "bilinear", "--lens-weights", "none"), "default": ()}


def band(count, path):
    """Writes a transforms.json, whose matrices are camera-to-world with OpenGL axes."""
    random = np.random.default_rng(1)
    angle = math.pi * random.random(count)
    lift = HEIGHT_M * (random.random(count) - 0.5)
    centre = np.column_stack([RADIUS_M * np.cos(angle), lift, RADIUS_M * np.sin(angle)])
    back = centre / np.linalg.norm(centre, axis=1, keepdims=True)
    right = np.column_stack([back[:, 2], np.zeros(count), -back[:, 0]])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    poses = np.stack([right, np.cross(back, right), back, centre], axis=2)
    with path.open("w") as out:
        out.write('{"fl_x": 2100, "fl_y": 2100, "cx": 1024, "cy": 1024, "w": 2048, "h": 2048,\n'
                  '"frames": [\n')
        for i in range(count):
            rows = poses[i].tolist()
            out.write(f'{{"file_path": "images/{i:07}.png", "transform_matrix": '
                      f'{rows + [[0, 0, 0, 1]]}}}{"," if i + 1 < count else ""}\n')
        out.write("]}\n")


def path_yaml(frames, aperture_mm):
    keys = []
    for i in range(33):
        angle = math.pi * (0.45 + 0.1 * i / 32)
        keys.append(f"{{time: {i / 32 * (frames - 1) / 30:.6f}, value: "
                    f"[{RADIUS_M * math.cos(angle):.9f}, 0, {RADIUS_M * math.sin(angle):.9f}]}}")
    return f"""format: lfpath 1
fps: 30
frames: {frames}
resolution: [1920, 1080]
camera: {{sensor_width_mm: 36, focal_length_mm: 37.5, position: [0, 0, {RADIUS_M}],
  look_at: [0, 0, 0], up: [0, 1, 0]}}
lens: {{aperture_diameter_mm: {aperture_mm}, focus_distance: {RADIUS_M}}}
keyframes: {{position: [{", ".join(keys)}]}}
"""


def measure(build, folder, count, frames, aperture_mm, weights, runs, most_s):
    path = folder / "path.yaml"
    path.write_text(path_yaml(frames, aperture_mm))
    out = folder / "packages"
    spent, used = [], []
    while not used or len(used) < runs and used[0]["seconds"] < most_s:
        used.append(results.timed([build / "bin/lfpreprocessor", folder / f"{count}.json", path, "-o", out,
                                   "--overwrite", "--frames-per-package", FRAMES_PER_PACKAGE, *WEIGHTS[weights],
                                   "--allow-missing", "100%", "--json", "-q"]))
        report = json.loads(used[-1].pop("stdout"))
        spent.append(report["spent_s"])
    seen = sum(frame["lf_images"] for frame in report["frames"])
    row = {"cameras": count, "frames": frames, "aperture_mm": aperture_mm, "weights": weights, "runs": len(used),
           "share": seen / count / frames, "packages": len(report["packages"]),
           "package_bytes": sum(file.stat().st_size for file in out.glob("*.lfp")),
           "peak_kib": statistics.median(run["peak_bytes"] for run in used) / 1024,
           "total_s": statistics.median(run["seconds"] for run in used)}
    for key in spent[0]:
        row[f"{key}_s"] = statistics.median(run[key] for run in spent)
    print(row, file=sys.stderr, flush=True)
    return row


def table(record):
    lines = ["| LF cameras | frames | lens weights | share seen | calibration | octree | selection | a frame | density "
             "| writing | in all | packages | peak MiB |", "|" + " --- |" * 13]
    for row in record["rows"]:
        frame_ms = row["selection_s"] / row["frames"] * 1e3
        lines.append(
            f"| {row['cameras']:,} | {row['frames']} | {row['weights']} | {100 * row['share']:.2g} % | "
            f"{row['reading_s']:.2f} s | {row['index_s']:.2f} s | {row['selection_s']:.2f} s | "
            f"{frame_ms:.2f} ms | {row['density_s']:.2f} s | {row['writing_s']:.2f} s | {row['total_s']:.2f} s | "
            f"{row['packages']}, {row['package_bytes'] / 2**20:.0f} MiB | "
            f"{row['peak_kib'] / 1024:.0f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--counts", default="10000,100000,1000000")
    parser.add_argument("--frames", default="30,900")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--most-seconds", type=float, default=10, metavar="S",
                        help="of a row that is measured again")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        build = arguments.build.resolve()
        counts = list(map(int, arguments.counts.split(",")))
        frames = list(map(int, arguments.frames.split(",")))
        record = results.context()
        record.update(runs=arguments.runs)
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            for count in counts:
                band(count, folder / f"{count}.json")
            films = [(count, frames[0], 30) for count in counts]
            films += [(counts[-1], n, 30) for n in frames[1:]] + [(counts[-1], frames[0], 150)]
            record["rows"] = [measure(build, folder, *film, weights, arguments.runs, arguments.most_seconds)
                              for film in films for weights in WEIGHTS
                              if weights == "none" or film[1] == frames[0]]
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record) + f" All threads; medians of up to {record['runs']}.", ""] +
                     table(record)) + "\n"
    results.publish(arguments, "million_cameras.py", record, text)


if __name__ == "__main__":
    main()
