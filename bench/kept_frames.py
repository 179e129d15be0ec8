#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the CPU time of one more frame of 1920 x 1080 elements in a film: collected, from kept pixels, and from
cells.

usage: bench/kept_frames.py BUILD_DIR [--frames 6] [--runs 3] [--field DIR] [--name NAME] [--write PAGE]
       bench/kept_frames.py --again JSON [--write PAGE]

Films of one frame and of --frames equal frames are rendered in turns by one thread of lfrenderer, from 225 LF images of
640 x 424 pixels by lfsynth, beside it, with a lens of 3 camera distances. A frame costs the difference of their CPU
times, divided by the number of frames that one film has more. This contains the plate, its development and the EXR
file. The median of the runs is shown.

--field DIR  folder of the light field, which is kept; an existing one is used again
"""
import argparse
import json
import pathlib
import statistics
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent / "quality"))
import lens_weights
import record as results

SIZE, ELEMENTS, SPACING_M = "640x424", (2400, 1350), 0.003  # synthetic_path() takes 0.8 of the field of view
DEFAULTS = "--estimator bilinear --lens-weights auto"
WAYS = {
    "collected": f"--mode collect {DEFAULTS}",
    "all pixels that frames ask for": f"--mode rebin {DEFAULTS} --max-rays 8M",
    "a million pixels": f"--mode rebin {DEFAULTS} --max-rays 1M",
    "a million cells": f"--mode rebin {DEFAULTS} --interpolation cells --max-rays 1M",
}


def path_text(calibration, frames):
    size, lens_weights.SYNTHETIC_SIZE = lens_weights.SYNTHETIC_SIZE, ELEMENTS
    text = lens_weights.synthetic_path(calibration, 3 * SPACING_M, 0.8, 0.8)
    lens_weights.SYNTHETIC_SIZE = size
    return text.replace("frames: 1\n", f"frames: {frames}\n")


def measure(build, field, folder, frames, runs):
    """Returns the rows of the table."""
    if not (field / "transforms.json").exists():
        results.call([build / "bin/lfsynth", "still-life", "-o", field, "--count", 225, "--jitter", 0.4, "--spacing",
                      SPACING_M, "--size", SIZE, "-q"])
    rows = [{"way": way, "kept": 0, "of": 0, "cpu_s": {"1": [], str(frames): []}} for way in WAYS]
    for _ in range(runs):
        for row in rows:
            for count, seconds in row["cpu_s"].items():
                path = folder / f"{count}.yaml"
                path.write_text(path_text(field / "transforms.json", int(count)))
                used = results.timed([build / "bin/lfrenderer", field, path, "-o", folder / "out", "--threads", 1, "-q",
                                      "--overwrite", "--no-contact-sheet", "--format", "exr",
                                      *WAYS[row["way"]].split()])
                seconds.append(round(used["cpu_s"], 3))
            report = json.loads((folder / "out" / "report.json").read_text())
            row["lf_images"] = report["frames"][0]["lf_images"]
            if report.get("rebinning"):
                rebinning = report["rebinning"]
                row["kept"] = rebinning.get("pixels", rebinning["cells"])
                row["of"] = rebinning["lf_pixels_looked_at"]
    return rows


def table(record):
    lines = ["| frame | kept, of LF pixels that frames ask for | LF images | CPU s |", "| --- " * 4 + "|"]
    for row in record["rows"]:
        one, more = (statistics.median(seconds) for seconds in row["cpu_s"].values())
        kept = f"{row['kept'] / 1e6:.2f} M of {row['of'] / 1e6:.2f} M" if row["of"] else "-"
        lines.append(f"| {row['way']} | {kept} | {row['lf_images']} | {(more - one) / (record['frames'] - 1):.2f} |")
    return lines + ["", "Options of each frame:", ""] + [f"- {way}: `{options}`" for way, options in WAYS.items()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--frames", type=int, default=6)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--field", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build, lambda folder: {
        "frames": arguments.frames, "runs": arguments.runs,
        "rows": measure(arguments.build.resolve(), arguments.field or folder / "field", folder, arguments.frames,
                        arguments.runs)})
    text = "\n".join([f"{results.sentence(record)} One thread, medians of {record['runs']} runs.", "",
                      *table(record)]) + "\n"
    results.publish(arguments, "kept_frames.py", record, text)


if __name__ == "__main__":
    main()
