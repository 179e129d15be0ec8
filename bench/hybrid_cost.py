#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what rebinned rays cost: workloads of bench/workloads.py collected alone, and as hybrids with kept pixels
and with cells.

usage: bench/hybrid_cost.py BUILD_DIR [--density 0.05] [--size 480x320] [--runs 5]
                            [--only stack,short,sharp,long,bokeh] [--frames-share 1] [--field DIR]
                            [--name NAME] [--write PAGE]
       bench/hybrid_cost.py --again JSON [--write PAGE]

All five movements of Table 5.1 are rendered in turns, by one thread, so that a busy machine disturbs
all alike. CPU seconds are those of the whole program. Each hybrid is compared with a collection by the same estimator
and lens weights: those of the thesis (nearest, none), as in Table 5.2, and the defaults. ns per LF pixel is the time of
rebinning for each LF pixel that it examined: for its probability, the choice, and the cell or the pixel if it is kept.

--frames-share S  render only this share of the frames of each movement, over the same path

--field DIR  folder of the light field, which is kept; an existing one is used again

A table of some movements has a marker and a record of its own: hybrid_cost.py stack,sharp
"""
import argparse
import json
import pathlib
import statistics
import tempfile

import record as results
import workloads

DEFAULT = ("--estimator", "bilinear", "--filter", "mosaic", "--lens-weights", "auto")
THESIS = ("--estimator", "nearest", "--lens-weights", "none")
UNWEIGHTED = ("--estimator", "bilinear", "--filter", "mosaic", "--lens-weights", "none")
CELLS = ("--interpolation", "cells")
# mode: the mode that it is compared with, and the options of lfrenderer. Pictures of an unfinished render are previews
# by cells alone.
MODES = {
    "collect, thesis's estimator": (None, ("--mode", "collect", *THESIS)),
    "hybrid, thesis's estimator": ("collect, thesis's estimator", ("--mode", "hybrid", *THESIS)),
    "hybrid, thesis's estimator, cells": ("collect, thesis's estimator", ("--mode", "hybrid", *CELLS, *THESIS)),
    "collect (the default)": (None, ("--mode", "collect", *DEFAULT)),
    "hybrid": ("collect (the default)", ("--mode", "hybrid", *DEFAULT)),
    "hybrid, cells": ("collect (the default)", ("--mode", "hybrid", *CELLS, *DEFAULT)),
    "hybrid, cells, previews on": ("collect (the default)", ("--mode", "hybrid", "--preview", "on", *DEFAULT)),
    "hybrid, a small lens": (None, ("--mode", "hybrid", *UNWEIGHTED)),
    "hybrid, a small lens, cells": (None, ("--mode", "hybrid", *CELLS, *UNWEIGHTED)),
}
# Table 5.2: minutes of "Ray Collect" and of "Ray Collect & Rebinning".
THESIS_MINUTES = {"stack": (22 + 33 / 60, 23 + 38 / 60), "short": (36.5, 41 + 17 / 60),
                  "sharp": (5 + 25 / 60, 6 + 53 / 60), "long": (244.7, 271 + 35 / 60),
                  "bokeh": (310 + 21 / 60, 438.3)}


def measure(build, field, folder, name, size, runs, frames_share):
    rows = []
    for mode, (_, options) in MODES.items():
        rows.append({"workload": name, "mode": mode, "cpu_s": [], "seconds": [], "options": options})
    for row in rows:
        workload = dict(workloads.WORKLOADS[name], frames_share=frames_share)
        if "small" in row["mode"]:
            workload["aperture_mm"] = (0.5, 0.5)
        row["path"] = folder / f"{name}{'-small' if 'small' in row['mode'] else ''}.yaml"
        row["path"].write_text(workloads.path_yaml(workload, size))
    for _ in range(runs):
        for row in rows:
            seconds, usage, report = workloads.render(build, field, row["path"], folder / name, 1,
                                                      *row["options"])
            row["seconds"].append(round(seconds, 3))
            row["cpu_s"].append(round(usage.ru_utime + usage.ru_stime, 3))
            row["report"] = {key: report.get(key) for key in
                             ("lf_images_selected", "rays_accepted", "collect_cpu_s", "rebinning")}
            row["interpolated"] = max(f.get("interpolated_share", 0) for f in report["frames"])
    for row in rows:
        row["path"], row["options"] = row["path"].name, " ".join(row["options"])
    return rows


def table(record):
    lines = ["| workload | mode | LF images | CPU s | to its collection (thesis) | LF pixels looked at | "
             "ns each | kept pixels or cells | interpolated |", "| --- " * 9 + "|"]
    cpu_s = {(row["workload"], row["mode"]): statistics.median(row["cpu_s"]) for row in record["rows"]}
    for row in record["rows"]:
        name, mode = row["workload"], row["mode"]
        cpu, base = cpu_s[name, mode], MODES[mode][0]
        rebinning = row["report"]["rebinning"] or {"lf_pixels_looked_at": 0, "cpu_s": 0, "cells": 0}
        looked_at = rebinning["lf_pixels_looked_at"]
        ratio = f"{cpu / cpu_s[name, base]:.2f}" if base else ""
        if base and "thesis" in mode:
            collected, both = THESIS_MINUTES[name]
            ratio += f" ({both / collected:.2f})"
        lines.append(
            f"| {name} | {mode} | {row['report']['lf_images_selected']} | {cpu:.2f} | "
            f"{ratio} | {looked_at / 1e6:.1f} M | "
            + (f"{1e9 * rebinning['cpu_s'] / looked_at:.1f}" if looked_at else "-")
            + f" | {rebinning.get('pixels', rebinning['cells']) / 1e6:.2f} M | {100 * row['interpolated']:.0f} % |")
    lines += ["", "Options of each mode:", ""]
    lines += [f"- {mode}: `{' '.join(options)}`" for mode, (_, options) in MODES.items()]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=0.05)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default=",".join(workloads.WORKLOADS))
    parser.add_argument("--frames-share", type=float, default=1)
    parser.add_argument("--field", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        build = arguments.build.resolve()
        size = [int(length) // 2 for length in arguments.size.split("x")]
        record = results.context()
        record.update(density=arguments.density, size=arguments.size, runs=arguments.runs,
                      frames_share=arguments.frames_share, rows=[])
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            field = arguments.field or folder / "field"
            workloads.photograph(build, field, arguments.density, arguments.size)
            for name in arguments.only.split(","):
                record["rows"] += measure(build, field, folder, name, size, arguments.runs,
                                          arguments.frames_share)
    else:
        parser.error("BUILD_DIR or --again is needed")
    share = record.get("frames_share", 1)
    text = "\n".join([results.sentence(record) + f" LF images {record['size']}, frames half as large, "
                      f"{record['density']:g} of the thesis's LF cameras, "
                      + (f"{share:g} of its frames, " if share != 1 else "")
                      + f"medians of {record['runs']} runs, one thread.", ""] + table(record)) + "\n"
    names = list(dict.fromkeys(row["workload"] for row in record["rows"]))
    words = "" if names == list(workloads.WORKLOADS) else " " + ",".join(names)
    results.publish(arguments, "hybrid_cost.py" + words, record, text)


if __name__ == "__main__":
    main()
