#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how fast LF images are encoded and decoded: 2048 x 2048 RGGB mosaics of 8 bits, one thread.

usage: bench/codec_speed.py BUILD_DIR [--data ../shared] [--runs 5] [--name NAME] [--write doc/codec.md]
       bench/codec_speed.py --again JSON [--write doc/codec.md]

The mosaics are made of pictures of `blender-shop` (the densest light field) side by side, of pictures of `beer-colmap`
(photographs) side by side, and of the picture of waves and noise that lf_pixels_codec_bench draws. Each is encoded by
the profiles thesis, default and lossless. Figures are medians of 10^6 bytes of pixels per second of CPU time.
"""
import argparse
import json
import os
import pathlib
import tempfile

import cv2
import numpy as np

import record as results

PROFILES = ("thesis, 1 level, threshold 8", "default", "lossless")


def mosaic_of(files):
    """Returns a mosaic of 2048 x 2048 pixels, made from as many pictures as needed."""
    pictures = [cv2.imread(str(file)) for file in files]
    height, width = pictures[0].shape[:2]
    across, down = -(-2048 // width), -(-2048 // height)
    rows = [np.hstack([pictures[(y * across + x) * len(pictures) // (across * down)] for x in range(across)])
            for y in range(down)]
    picture = np.vstack(rows)[:2048, :2048]
    mosaic = np.empty((2048, 2048), np.uint8)
    for y, x, channel in ((0, 0, 2), (0, 1, 1), (1, 0, 1), (1, 1, 0)):
        mosaic[y::2, x::2] = picture[y::2, x::2, channel]
    return mosaic


def measure(build, data, runs):
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        for name in ("blender-shop", "beer-colmap", "drawn"):
            environment = dict(os.environ)
            environment.pop("LF_BENCH_IMAGE", None)
            if name != "drawn":
                image = pathlib.Path(temporary) / "mosaic.raw"
                mosaic_of(sorted((data / "data" / name / "images").glob("*.jpg"))).tofile(image)
                environment["LF_BENCH_IMAGE"] = str(image)
            report = json.loads(results.call(
                [build / "lf/pixels/codec/lf_pixels_codec_bench", "--benchmark_filter=Mosaic",
                 f"--benchmark_repetitions={runs}", "--benchmark_format=json",
                 "--benchmark_min_time=0.3"], env=environment))
            found = {b["run_name"]: b for b in report["benchmarks"] if b.get("aggregate_name") == "median"}
            for number, profile in enumerate(PROFILES):
                coded, decoded = (found[f"{what}Mosaic/profile:{number}"] for what in ("Encode", "Decode"))
                rows.append({"content": name, "profile": profile, "ratio": decoded["ratio"],
                             "coded_bytes_per_s": coded["bytes_per_second"],
                             "decoded_bytes_per_s": decoded["bytes_per_second"]})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    parser.add_argument("--runs", type=int, default=5)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        record = results.context()
        record["rows"] = measure(arguments.build.resolve(), arguments.data, arguments.runs)
    else:
        parser.error("BUILD_DIR or --again is needed")
    lines = ["| content | profile | ratio | coded, MB/s | decoded, MB/s |", "|" + " --- |" * 5]
    lines += [f"| {row['content']} | {row['profile']} | {row['ratio']:.2f} | {row['coded_bytes_per_s'] / 1e6:.0f} | "
              f"{row['decoded_bytes_per_s'] / 1e6:.0f} |" for row in record["rows"]]
    results.publish(arguments, "codec_speed.py", record, results.sentence(record) + "\n\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
