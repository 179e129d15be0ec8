#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how much sooner a film is done when its packages are rendered at the same time (thesis, Table 5.2).

usage: bench/simultaneous_packages.py BUILD_DIR [--movement long] [--density 0.03] [--size 480x320]
                                      [--frames-share 1] [--packages 1,2,4] [--runs 3] [--field DIR]
                                      [--name NAME] [--write PAGE]
       bench/simultaneous_packages.py --again JSON [--write PAGE]

The thesis rendered its packages on four machines with four cores each, and was ready in a half to a third of the time.
Here `lfsubmit --jobs N --threads 1` renders N packages at the same time on one machine, so that N cores stand for
N machines; beyond the machine's cores nothing can be gained. The gain of more machines can be seen from the package
that takes longest when each package is rendered alone: on as many machines as packages, the film is ready when this
package is.

Films are rendered in turns, so that a busy machine disturbs all alike; their frames must have the same bits. Seconds
are from the call of lfsubmit to its end, CPU seconds are those of all its processes. lfpreprocessor's time does not
count.

--frames-share S  render only this share of the movement's frames, over the same path
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import tempfile
import time

import record as results
from packages import digest
from workloads import WORKLOADS, path_yaml, photograph

WAYS = {
    "collect, thesis's estimator": ("--mode", "collect", "--estimator", "nearest", "--lens-weights", "none"),
    "collect (the default)": ("--mode", "collect", "--estimator", "bilinear", "--filter", "mosaic",
                              "--lens-weights", "auto"),
}


def timed(*words):
    """Returns wall seconds, and the CPU seconds of the process and all processes that it waited for."""
    start = time.monotonic()
    process = subprocess.Popen(list(map(str, words)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    messages = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{words[0]} failed: {messages}")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime


def cut(build, field, path, folder, count):
    packages = folder / f"packages-{count}"
    if not packages.exists():
        timed(build / "bin/lfpreprocessor", field, path, "-o", packages, "-q", "--packages", count, "--balance", "rays")
    return sorted(packages.glob("*.lfp"))


def submit(build, packages, folder, options):
    """Renders all packages at once. Returns wall seconds, CPU seconds, and digests of the frames."""
    film = folder / "film"
    shutil.rmtree(film, ignore_errors=True)
    wall, cpu = timed(build / "bin/lfsubmit", *packages, "-o", film, "--jobs", len(packages), "--threads", 1,
                      "--no-contact-sheet", "-q", "--", *options)
    return wall, cpu, digest(film)


def longest_alone(build, packages, folder, options):
    seconds = []
    for package in packages:
        shutil.rmtree(folder / "alone", ignore_errors=True)
        seconds.append(timed(build / "bin/lfrenderer", package, "-o", folder / "alone", "--threads", 1, "-q",
                             "--no-contact-sheet", *options)[0])
    return max(seconds)


def measure(build, field, path, folder, counts, runs):
    rows = []
    for way, options in WAYS.items():
        found = {count: {"way": way, "packages": count, "seconds": [], "cpu_s": [], "longest_alone_s": []}
                 for count in counts}
        frames = set()
        for _ in range(runs):
            for count, row in found.items():
                packages = cut(build, field, path, folder, count)
                wall, cpu, frames_of = submit(build, packages, folder, options)
                frames.add(frames_of)
                row["seconds"].append(round(wall, 3))
                row["cpu_s"].append(round(cpu, 3))
                row["longest_alone_s"].append(round(longest_alone(build, packages, folder, options), 3))
        if len(frames) != 1:
            raise SystemExit(f"{way}: the films differ")
        rows += found.values()
    return rows


def table(record):
    lines = ["| way | packages at the same time | seconds | sooner by | CPU s of all | "
             "longest package alone, s | so many "
             "machines: sooner by |", "|" + " --- |" * 7]
    base = {}
    for row in record["rows"]:
        seconds, cpu, longest = (statistics.median(row[key]) for key in ("seconds", "cpu_s", "longest_alone_s"))
        first, first_longest = base.setdefault(row["way"], (seconds, longest))
        lines.append(f"| {row['way']} | {row['packages']} | {seconds:.2f} | {first / seconds:.2f} | {cpu:.2f} | "
                     f"{longest:.2f} | {first_longest / longest:.2f} |")
    lines += ["", "Options of each way:", ""]
    lines += [f"- {way}: `{' '.join(options)}`" for way, options in WAYS.items()]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--movement", default="long", choices=WORKLOADS)
    parser.add_argument("--density", type=float, default=0.03)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--frames-share", type=float, default=1)
    parser.add_argument("--packages", default="1,2,4")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--field", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        build = arguments.build.resolve()
        size = [int(length) // 2 for length in arguments.size.split("x")]
        record = results.context()
        record.update(movement=arguments.movement, density=arguments.density, size=arguments.size, runs=arguments.runs,
                      frames_share=arguments.frames_share)
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            field = arguments.field or folder / "field"
            photograph(build, field, arguments.density, arguments.size)
            path = folder / "path.yaml"
            path.write_text(path_yaml(dict(WORKLOADS[arguments.movement], frames_share=arguments.frames_share), size))
            counts = list(map(int, arguments.packages.split(",")))
            record["rows"] = measure(build, field, path, folder, counts, arguments.runs)
    else:
        parser.error("BUILD_DIR or --again is needed")
    share = record["frames_share"]
    text = "\n".join([results.sentence(record) + f" The movement `{record['movement']}`, "
                      + (f"{share:g} of its frames, " if share != 1 else "")
                      + f"LF images {record['size']}, frames half as large, {record['density']:g} of the thesis's LF "
                      f"cameras, one thread for each package, medians of {record['runs']} runs.", ""]
                     + table(record)) + "\n"
    results.publish(arguments, "simultaneous_packages.py", record, text)


if __name__ == "__main__":
    main()
