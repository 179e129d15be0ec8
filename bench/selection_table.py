#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Times selection in the band of the thesis (lf_selection_bench): by the octree, and by testing every LF camera.

usage: bench/selection_table.py BUILD_DIR [--name NAME] [--write PAGE]
       bench/selection_table.py --again JSON [--write PAGE]

Figures are CPU times of one thread. LF cameras stand on half a circle, and the path goes along a tenth of it. A lens of
30 mm sees 1 % of the LF cameras, a lens of 150 mm 5 %.
"""
import argparse
import json
import pathlib

import record as results

# Name of the benchmark -> column.
KINDS = {"Select": "octree", "AskEveryCamera<false>": "in_full", "AskEveryCamera<true>": "quickly"}


def measure(build):
    report = json.loads(results.call([build / "lf/selection/lf_selection_bench", "--benchmark_filter=Select|Ask",
                                      "--benchmark_format=json"]))
    rows = {}
    for run in report["benchmarks"]:
        kind, cameras, frames, thousandths = run["name"].split("/")
        rows.setdefault((int(cameras), int(frames), int(thousandths)), {})[KINDS[kind]] = run["s/frame"]
        if kind == "Select":
            rows[int(cameras), int(frames), int(thousandths)]["share"] = run["share"]
    # All LF cameras are tested only for few frames, because each further frame takes the same time.
    asked = {key: row for key, row in rows.items() if "share" not in row}
    for (cameras, frames, aperture), row in asked.items():
        least = min(key for key in rows if (key[0], key[2]) == (cameras, aperture) and "share" in rows[key])
        rows[least] |= row
    return [{"cameras": key[0], "frames": key[1], **row} for key, row in rows.items() if "share" in row]


def milliseconds(row, key):
    return f"{1e3 * row[key]:.3g} ms" if key in row else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build,
                               lambda folder: {"rows": measure(arguments.build.resolve())})
    lines = ["| LF cameras | frames | share seen | a frame | every LF camera asked, in full | "
             "asked first whether it plainly misses |", "|" + " --- |" * 6]
    lines += [f"| {row['cameras']:,} | {row['frames']} | {100 * row['share']:.2g} % | {milliseconds(row, 'octree')} | "
              f"{milliseconds(row, 'in_full')} | {milliseconds(row, 'quickly')} |" for row in record["rows"]]
    text = "\n".join([results.sentence(record) + " One thread, CPU time.", ""] + lines) + "\n"
    results.publish(arguments, "selection_table.py", record, text)


if __name__ == "__main__":
    main()
