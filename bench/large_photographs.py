#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Times lfrenderer on a few photographs of 24 megapixels, beside the time that OpenCV takes to read them.

usage: bench/large_photographs.py BUILD_DIR LIGHTFIELD [--count 7] [--size 6000x4000] [--frames 1,10] [--runs 3]
                                  [--name NAME] [--write PAGE]
       bench/large_photographs.py --again JSON [--write PAGE]

LIGHTFIELD  the light field of bench/compare_opencv.py
--count     number of rows and of columns of LF images that are taken, evenly spread

The photographs are the LF images, enlarged by bicubic interpolation, with noise of 3 levels as sensors add it, and
compressed with quality 92. They are filmed with 1920 x 1280 elements, each about three LF pixels wide, by all LF
cameras. The peer is OpenCV's imread() of all photographs by one thread. Figures are medians of the runs.
"""
import argparse
import json
import pathlib
import statistics
import time

import cv2
import numpy as np

import record as results
from compare_opencv import PATH
from workloads import WAYS

NOISE = 3  # standard deviation, of 255
QUALITY = 92


def enlarge(light_field, count, size, folder):
    """Writes count x count of the LF images, enlarged. Returns their files."""
    names = sorted(path.name for path in (light_field / "images").glob("*.jpg"))
    side = round(len(names) ** 0.5)
    picked = np.linspace(0, side - 1, count).round().astype(int)
    random = np.random.default_rng(1)
    width, height = size
    beyond = 100
    noise = cv2.GaussianBlur(random.normal(0, 1, (height + beyond, width + beyond)).astype(np.float32), (0, 0), 0.7)
    noise *= NOISE / noise.std()
    folder.mkdir()
    files = []
    for row in picked:
        for column in picked:
            name = names[row * side + column]
            picture = cv2.resize(cv2.imread(str(light_field / "images" / name)).astype(np.float32), (width, height),
                                 interpolation=cv2.INTER_CUBIC)
            x, y = random.integers(0, beyond, 2)
            picture += noise[y:y + height, x:x + width, None]
            files.append(folder / name)
            cv2.imwrite(str(files[-1]), picture.clip(0, 255).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    return files


def imread_cpu_s(files):
    start = time.process_time()
    for file in files:
        cv2.imread(str(file))
    return time.process_time() - start


def measure(arguments, folder):
    size = tuple(map(int, arguments.size.split("x")))
    files = enlarge(arguments.light_field, arguments.count, size, folder / "images")
    cv2.setNumThreads(1)
    record = {"images": len(files), "image_bytes": sum(file.stat().st_size for file in files) / len(files),
              "imread_cpu_s": statistics.median(imread_cpu_s(files) for _ in range(arguments.runs)), "rows": []}
    for frames in map(int, arguments.frames.split(",")):
        path = folder / f"path{frames}.yaml"
        path.write_text(PATH.format(frames=frames, diameter=1.2, end=(frames - 1) / 25 or 1)
                        .replace("[960, 640]", "[1920, 1280]"))
        rows = [{"frames": frames, "way": way, "runs": []} for way in WAYS]
        for _ in range(arguments.runs):
            for row in rows:
                out = folder / "out"
                used = results.timed([arguments.build / "bin/lfrenderer", folder, path, "-o", out, "--overwrite",
                                      "--threads", 2, "-q", "--no-contact-sheet", *WAYS[row["way"]]])
                used.pop("stdout")
                report = json.loads((out / "report.json").read_text())
                row["runs"].append(used | {"load_cpu_s": report["load_cpu_s"]})
        for row in rows:
            runs = row.pop("runs")
            row.update({key: statistics.median(run[key] for run in runs) for key in runs[0]})
        record["rows"] += rows
    return record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("light_field", type=pathlib.Path, nargs="?")
    parser.add_argument("--count", type=int, default=7)
    parser.add_argument("--size", default="6000x4000")
    parser.add_argument("--frames", default="1,10")
    parser.add_argument("--runs", type=int, default=3)
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.light_field, lambda folder: {
        "size": arguments.size, "runs": arguments.runs, **measure(arguments, folder)}, "BUILD_DIR LIGHTFIELD")
    lines = ["| frames | way | s | CPU s | CPU s of loading | imread() alone, CPU s | peak MiB |", "|" + " --- |" * 7]
    lines += [f"| {row['frames']} | {row['way']} | {row['seconds']:.1f} | {row['cpu_s']:.1f} | "
              f"{row['load_cpu_s']:.1f} | {record['imread_cpu_s']:.1f} | {row['peak_bytes'] / 2 ** 20:,.0f} |"
              for row in record["rows"]]
    text = "\n".join([results.sentence(record) + f" {record['images']} JPEGs of {record['size']}, "
                      f"{record['image_bytes'] / 1e6:.1f} MB each; two threads, medians of {record['runs']} runs.",
                      ""] + lines) + "\n"
    results.publish(arguments, "large_photographs.py", record, text)


if __name__ == "__main__":
    main()
