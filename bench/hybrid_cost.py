#!/usr/bin/python3
"""What rebinned rays cost: workloads of bench/workloads.py collected alone, and as hybrids.

usage: bench/hybrid_cost.py BUILD_DIR [--density 0.05] [--size 480x320] [--runs 5]
                            [--only stack,short,sharp] [--field DIR] [--name NAME] [--write PAGE]
       bench/hybrid_cost.py --again JSON [--write PAGE]

All are rendered in turns, by one thread, so that a busy machine disturbs all alike. CPU seconds are
those of the whole program. ns per LF pixel are of the LF pixels that rebinning looked at: their
probabilities, the choice, and the cells of those that are kept.

--field DIR  keep the light field there, or take the one that is there
"""
import argparse
import json
import pathlib
import statistics
import tempfile

import record as results
import workloads

MODES = {
    "collect": (),
    "hybrid": ("--mode", "hybrid"),
    "hybrid, previews on": ("--mode", "hybrid", "--preview", "on"),
    "hybrid, a small lens": ("--mode", "hybrid", "--lens-weights", "none"),
}


def measure(build, field, folder, name, size, runs):
    rows = []
    for mode, options in MODES.items():
        rows.append({"workload": name, "mode": mode, "cpu_s": [], "seconds": [], "options": options})
    for row in rows:
        workload = dict(workloads.WORKLOADS[name])
        if "small" in row["mode"]:
            workload["aperture_mm"] = (0.5, 0.5)
        row["path"] = folder / f"{len(row['mode'])}-{name}.yaml"
        row["path"].write_text(workloads.path_yaml(workload, size))
    for _ in range(runs):
        for row in rows:
            seconds, usage, report = workloads.render(build, field, row["path"], folder / "out", 1,
                                                      *row["options"])
            row["seconds"].append(round(seconds, 3))
            row["cpu_s"].append(round(usage.ru_utime + usage.ru_stime, 3))
            row["report"] = {key: report.get(key) for key in
                             ("lf_images_selected", "rays_accepted", "collect_cpu_s", "rebinning")}
            row["interpolated"] = [f.get("interpolated_share", 0) for f in report["frames"]]
    for row in rows:
        row["path"], row["options"] = row["path"].name, " ".join(row["options"])
    return rows


def table(record):
    lines = ["| workload | mode | LF images | CPU s | as collected | LF pixels looked at | ns each | "
             "cells | interpolated |", "| --- " * 9 + "|"]
    base = {}
    for row in record["rows"]:
        cpu = statistics.median(row["cpu_s"])
        base.setdefault(row["workload"], cpu)
        rebinning = row["report"]["rebinning"] or {"lf_pixels_looked_at": 0, "cpu_s": 0, "cells": 0}
        looked_at = rebinning["lf_pixels_looked_at"]
        ratio = "" if "small" in row["mode"] else f"{cpu / base[row['workload']]:.2f}"
        lines.append(
            f"| {row['workload']} | {row['mode']} | {row['report']['lf_images_selected']} | {cpu:.2f} | "
            f"{ratio} | {looked_at / 1e6:.1f} M | "
            + (f"{1e9 * rebinning['cpu_s'] / looked_at:.1f}" if looked_at else "-")
            + f" | {rebinning['cells'] / 1e6:.2f} M | {100 * max(row['interpolated']):.0f} % |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=0.05)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default="stack,short,sharp")
    parser.add_argument("--field", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        build = arguments.build.resolve()
        size = [int(length) // 2 for length in arguments.size.split("x")]
        record = results.context()
        record.update(density=arguments.density, size=arguments.size, runs=arguments.runs, rows=[])
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            field = arguments.field or folder / "field"
            workloads.photograph(build, field, arguments.density, arguments.size)
            for name in arguments.only.split(","):
                record["rows"] += measure(build, field, folder, name, size, arguments.runs)
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record) + f" LF images {record['size']}, frames half as large, "
                      f"{record['density']:g} of the thesis's LF cameras, medians of {record['runs']} "
                      "runs, one thread.", ""] + table(record)) + "\n"
    results.publish(arguments, "hybrid_cost.py", record, text)


if __name__ == "__main__":
    main()
