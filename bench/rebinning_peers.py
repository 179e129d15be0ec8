#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares rebinning with its peers (lf_rebinning_peers_bench): frames from splats and from a k-d tree, cells in hash
maps.

usage: bench/rebinning_peers.py BUILD_DIR [--runs 3] [--name NAME] [--write doc/rebinning.md]
       bench/rebinning_peers.py --again JSON [--write doc/rebinning.md]

Frames have 1920 x 1080 elements and 16 lens points; the kernel finds about 16 rays. Figures are medians of the CPU time
of one thread. Only the first 36 rows of the frame from the k-d tree are measured.
"""
import argparse
import json
import pathlib
import re

import record as results

HEIGHT = 1080


def constant(name):
    """Returns a number that is a constant in the benchmark's source."""
    source = (results.HERE / "rebinning_bench.cc").read_text()
    return int(re.search(rf"\b{name} = (\d+)", source)[1])


def measure(build, runs):
    """Returns {benchmark: {cells: CPU seconds}}."""
    report = json.loads(results.call([build / "bench/lf_rebinning_peers_bench", "--benchmark_format=json",
                                      f"--benchmark_repetitions={runs}", "--benchmark_report_aggregates_only=true"]))
    found = {}
    for run in report["benchmarks"]:
        if run["aggregate_name"] == "median":
            name, cells = run["run_name"].split("/")[:2]
            found.setdefault(name, {})[cells] = run["cpu_time"] * {"ms": 1e-3, "us": 1e-6, "ns": 1e-9}[run["time_unit"]]
    # Extrapolates from the strip of rows to the whole frame.
    found["FrameByQueries"] = {cells: s * HEIGHT / constant("kStrip") for cells, s in found["FrameByQueries"].items()}
    return found


def table(record):
    rows = record["rows"]
    sizes = list(rows["FrameBySplats"])
    lines = ["| | " + " | ".join(f"{int(cells) / 1e6:g} M cells" for cells in sizes) + " |",
             "|" + " --- |" * (1 + len(sizes))]

    def add(words, cell):
        lines.append(f"| {words} | " + " | ".join(cell(cells) for cells in sizes) + " |")

    def rate(name):
        return lambda cells: f"{int(cells) / rows[name][cells] / 1e6:.1f} M/s"

    add("frame by a k-d tree (nanoflann): of all elements, from 36 rows",
        lambda c: f"{rows['FrameByQueries'][c]:.1f} s")
    add("frame by splats", lambda c: f"{rows['FrameBySplats'][c]:.2f} s: "
        f"**{rows['FrameByQueries'][c] / rows['FrameBySplats'][c]:.0f} x** faster")
    add("building the tree", lambda c: f"{rows['BuildTree'][c]:.2f} s")
    add("cells into sparsehash's map (`sparse_hash_map`)", rate("InsertSparseHash"))
    add("into its `dense_hash_map`", rate("InsertDenseHash"))
    add("into ours, which has its memory from the beginning", lambda c: rate("InsertOurs")(c) +
        f": **{rows['InsertSparseHash'][c] / rows['InsertOurs'][c]:.1f} x** sparsehash")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--runs", type=int, default=3)
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build,
                               lambda folder: {"rows": measure(arguments.build.resolve(), arguments.runs)})
    text = "\n".join([results.sentence(record) + " One thread.", ""] + table(record)) + "\n"
    results.publish(arguments, "rebinning_peers.py", record, text)


if __name__ == "__main__":
    main()
