#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures programs that load reduced LF images, from packed stores and from the image files that these were made of.

usage: bench/reduced_programs.py BUILD_DIR [--data ../shared] [--only CASE;...] [--runs 5] [--stores DIR] [--write PAGE]
       bench/reduced_programs.py --again JSON [--write PAGE]

`lffocus depth` makes the depth map of a frame, and `lfvisualizer` the live picture of the same frame: until the first
one that shows LF images, and until all LF images that there is memory for are loaded. Each is done with the files, with
a store of the profile `recorded`, and with one of the profile `default` and --reencode, one after the other in each
run. The table shows the figures with the files, and those with a store as a share of them: medians of the runs, and
of the ratios of each run. Bytes are those that a program reads by system calls, from files that are in memory.

--stores  keep the packed stores here, and use those that are there
"""
import argparse
import json
import pathlib
import statistics
import tempfile

import record as results
from live_pictures import LiveServer
from live_speed import path_of
from reduced_loads import light_field_of

# Case -> the capture, width of the frame in elements, focus distance and diameter of the lens in world units.
CASES = {"blender-shop, 240": ("blender-shop", 240, 8.12, 0.3), "stanford-cards, 384": ("stanford-cards", 384, 100, 8)}
SOURCES = ("files", "recorded", "default")
BUDGET_MS = 40
# Columns of the table: (program and figure in a run, its heading, unit of the files, divisor).
FIGURES = (("depth", "cpu_s", "depth: CPU", "s", 1), ("depth", "read_bytes", "bytes", "MB", 1e6),
           ("depth", "seconds", "wall", "s", 1), ("first", "seconds", "first live picture: wall", "s", 1),
           ("all", "cpu_s", "all LF images: CPU", "s", 1), ("all", "read_bytes", "bytes", "MB", 1e6),
           ("all", "seconds", "wall", "s", 1))


def sources_of(name, arguments, folder):
    """Returns {kind: light field} of a capture."""
    field = light_field_of(name, arguments, folder)
    sources = {"files": field}
    for profile, options in (("recorded", ()), ("default", ("--reencode",))):
        sources[profile] = (arguments.stores or folder) / f"{name}-{profile}.lfs"
        if not sources[profile].exists():
            results.call([arguments.build / "bin/lfcompressor", field, "-o", sources[profile], "--profile", profile,
                          *options, "--progress", "none", "-q"])
    return sources


def path_with_width(build, field, folder, width, focus, aperture):
    """Returns a path whose frame has the aspect of its LF images, and its text."""
    text = path_of(build, field, folder, focus, aperture)
    text = text.replace("resolution: [480, 270]", f"resolution: [{width}, {2 * width // 3}]")
    path = folder / f"path-{width}.yaml"
    path.write_text(text)
    return path, text


def depth_of(build, field, path, folder):
    used = results.timed([build / "bin/lffocus", "depth", field, path, "-o", folder / "depth.exr", "--overwrite", "-q",
                          "--progress", "none"])
    return {key: used[key] for key in ("cpu_s", "seconds", "read_bytes")}


def live_of(build, field, path, text, width):
    """Returns what the first live picture takes, and all LF images, from the start of the program on."""
    with LiveServer(build / "bin/lfvisualizer", field, path, "-q") as server:
        while not server.ask(text, width, BUDGET_MS)[0]["images"]:
            pass
        first = {"seconds": server.seconds()}
        facts = server.load_all(text, width)
        return first, {"seconds": server.seconds(), "cpu_s": server.cpu_s(), "read_bytes": server.read_bytes()}, facts


def measure(case, sources, arguments, folder):
    """Returns the rows of a case, one for each source, with the figures of all runs."""
    _, width, focus, aperture = CASES[case]
    path, text = path_with_width(arguments.build, sources["files"], folder, width, focus, aperture)
    rows = {kind: {"case": case, "source": kind, "runs": []} for kind in SOURCES}
    for _ in range(arguments.runs):
        for kind, field in sources.items():
            first, whole, facts = live_of(arguments.build, field, path, text, width)
            rows[kind]["runs"].append({"depth": depth_of(arguments.build, field, path, folder), "first": first,
                                       "all": whole})
            rows[kind] |= {"divisor": facts["divisor"], "resident": facts["resident"]}
    return list(rows.values())


def rows_of(arguments, folder):
    rows, sources = [], {}
    for case in arguments.only.split(";"):
        name = CASES[case][0]
        if name not in sources:
            sources[name] = sources_of(name, arguments, folder)
        rows += measure(case, sources[name], arguments, folder)
    return rows


def table(record):
    lines = ["| frame, elements wide | LF images | source | " + " | ".join(figure[2] for figure in FIGURES) + " |",
             "|" + " --- |" * (3 + len(FIGURES))]
    for row in record["rows"]:
        if row["source"] == "files":
            files = row["runs"]
            cells = [f"{statistics.median(run[part][key] for run in files) / by:.{1 if by > 1 else 2}f} {unit}"
                     for part, key, _, unit, by in FIGURES]
        else:
            shares = [[run[part][key] / old[part][key] for run, old in zip(row["runs"], files)]
                      for part, key, *_ in FIGURES]
            cells = [f"{statistics.median(share):.0%}" for share in shares]
        lines.append(f"| {row['case']} | {row['resident']}, 1/{row['divisor']} | {row['source']} | "
                     + " | ".join(cells) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    parser.add_argument("--only", default=";".join(CASES), help="cases, with semicolons between")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--stores", type=pathlib.Path, metavar="DIR")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        arguments.build, arguments.data = arguments.build.resolve(), arguments.data.resolve()
        record = results.context()
        with tempfile.TemporaryDirectory() as temporary:
            record["rows"] = rows_of(arguments, pathlib.Path(temporary))
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "reduced_programs.py", record, text)


if __name__ == "__main__":
    main()
