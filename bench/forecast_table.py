#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tabulates what lfpreprocessor forecasts for a light field of a million LF images, cut into more and more packages.

usage: bench/forecast_table.py BUILD_DIR [--count 1000000] [--packages 1,8,64,300] [--name NAME]
                               [--write doc/cluster.md]
       bench/forecast_table.py --again JSON [--write doc/cluster.md]

The light field has 1000 x 1000 LF cameras, 123 µm apart. Its LF images are raw mosaics of 1280 x 1024 pixels; one file
stands for all of them, because a forecast loads only a few. The film is `bokeh` of bench/workloads.py, in frames of
1920 x 1080. Forecasts are made for rendering as in the thesis (nearest, without lens weights) and, for the largest
number of packages, by the defaults.
"""
import argparse
import json
import pathlib
import re
import shutil

import record as results
from workloads import DISTANCE_M, WORKLOADS, path_yaml

SPACING_M, WIDTH, HEIGHT = 0.000123, 1280, 1024
WAYS = {"nearest": ("--estimator", "nearest", "--lens-weights", "none"), "default": ()}
GB = 1e9


def photograph(programs, folder, count):
    """Writes a calibration of all LF cameras that gives each of them the same image."""
    field, one = folder / "field", folder / "one"
    for out, options in ((field, ("--count", count, "--calibration-only")), (one, ("--count", 1, "--noise", "0.01"))):
        results.call([programs / "lfsynth", "chart", "-o", out, "--size", f"{WIDTH}x{HEIGHT}", "--spacing", SPACING_M,
                      "--distance", DISTANCE_M, "--samples", 1, "--bayer", "-q", *options])
    shutil.copy(one / "images/0000.png", field / "one.png")
    calibration = field / "transforms.json"
    calibration.write_text(re.sub(r"images/\d+\.png", "one.png", calibration.read_text()))
    return field


def measure(arguments, folder):
    programs = arguments.build.resolve() / "bin"
    field, path = photograph(programs, folder, arguments.count), folder / "bokeh.yaml"
    path.write_text(path_yaml(WORKLOADS["bokeh"], (1920, 1080)))
    rows = []
    counts = list(map(int, arguments.packages.split(",")))
    for way, options in WAYS.items():
        # Computing the lens weights of 900 frames takes minutes, so the default has only the last row.
        for count in counts if way != "default" else counts[-1:]:
            used = results.timed([programs / "lfpreprocessor", field, path, "--plan", "--packages", count, "--memory",
                                  "8G", "--json", "-q", *options])
            packages = json.loads(used["stdout"])["packages"]
            rows.append({"way": way, "packages": len(packages), "seconds": used["seconds"],
                         "lf_images": sum(p["lf_images"] for p in packages),
                         "bytes": sum(p["bytes_to_read"] for p in packages),
                         "most_bytes": max(p["bytes_to_read"] for p in packages),
                         "cpu_s": sum(p["cpu_s"] for p in packages), "most_cpu_s": max(p["cpu_s"] for p in packages),
                         "memory_bytes": max(p["memory_bytes"] for p in packages),
                         "passes": [min(p["passes"] for p in packages), max(p["passes"] for p in packages)]})
    return rows


def duration(seconds):
    """Returns 1 h 47 min, 16 min, 2 min 47 s, 45 s."""
    minutes = seconds / 60
    if minutes >= 60:
        return f"{int(minutes // 60)} h {round(minutes % 60)} min"
    if minutes >= 10:
        return f"{minutes:.0f} min"
    return f"{int(minutes)} min {round(seconds % 60)} s" if minutes >= 1 else f"{seconds:.0f} s"


def table(record):
    lines = ["| way | packages | LF images read, all together | GB read | by the largest | CPU time | of the longest | "
             "memory of the largest | passes | found in |", "|" + " --- |" * 10]
    for row in record["rows"]:
        passes = " to ".join(map(str, dict.fromkeys(row["passes"])))
        lines.append(f"| {row['way']} | {row['packages']} | {row['lf_images']:,} | {row['bytes'] / GB:.0f} | "
                     f"{row['most_bytes'] / GB:.3g} | {duration(row['cpu_s'])} | {duration(row['most_cpu_s'])} | "
                     f"{row['memory_bytes'] / GB:.1f} GB | {passes} | {row['seconds']:.0f} s |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--packages", default="1,8,64,300")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build, lambda folder: {"rows": measure(arguments, folder)})
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "forecast_table.py", record, text)


if __name__ == "__main__":
    main()
