#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs lf_collection_peers_bench and prints the table of our kernels against their peers.

usage: bench/kernel_table.py BUILD_DIR [--rounds 5] [--cases REGEX] [--name NAME] [--write PAGE]
       bench/kernel_table.py --again JSON [--write PAGE]

Rounds are interleaved: a ratio compares two times of the same round. The table shows the median of a ratio over the
rounds and, in brackets, the smallest and the largest. Times are CPU times of one thread.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import record as results

PEERS = {"thesis": "thesis's loop", "thesis_native": "the same, -march=native", "opencv": "OpenCV",
         "opencv_cubic": "OpenCV, bicubic", "reference": "reference"}


ALL = ".*"


def run(build, rounds, cases):
    """Returns {case: {contender: [ns per ray of round 0, 1, ...]}}, {case: difference of our frame from the
    reference's}, and the options of the compiler."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        subprocess.run([build / "bench/lf_collection_peers_bench", f"--rounds={rounds}",
                        f"--benchmark_filter=^({cases})/", f"--benchmark_out={out.name}",
                        "--benchmark_out_format=json"], check=True, stdout=sys.stderr)
        report = json.load(open(out.name))
    result, agreement = {}, {}
    for row in report["benchmarks"]:
        case, contender, _ = row["name"].split("/", 2)
        result.setdefault(case, {}).setdefault(contender, []).append(1e9 / row["rays/s"])
        if contender == "reference":
            agreement[case] = {"psnr_db": row["dB"], "rays_in_other_elements": row["moved"]}
    return result, agreement, report["context"]["compiler"]


def spread(values, digits):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f}-{max(values):.{digits}f})"


def ratios(contenders, peer, ours="ours"):
    return [a / b for a, b in zip(contenders[peer], contenders[ours])]


def weighed(contenders):
    """Returns the cost of weights that change every few elements."""
    if "ours_weighed" not in contenders:
        return ""
    return f"{statistics.median(ratios(contenders, 'ours_weighed')) - 1:+.0%}"


def rows(head, lines):
    return ["| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head)] + lines]


def table(cases):
    return rows(["case", "ns/ray", "weighed"] + [f"x {text}" for text in PEERS.values()],
                [[case, spread(contenders["ours"], 2), weighed(contenders)] +
                 [spread(ratios(contenders, peer), 1) if peer in contenders else "" for peer in PEERS]
                 for case, contenders in cases.items()])


def target_table(cases):
    """Returns ns/ray and the speed relative to the thesis's loop, by instruction set."""
    targets = []
    for contenders in cases.values():
        targets += [name for name in contenders if name.startswith("ours@") and name not in targets]
    lines = []
    for case, contenders in cases.items():
        if all(name in contenders for name in targets):
            lines.append([case] + [f"{statistics.median(contenders[name]):.2f} "
                                   f"({statistics.median(ratios(contenders, 'thesis', name)):.1f} x)"
                                   for name in targets])
    return [""] + rows(["case"] + [name[5:] for name in targets], lines) if targets else []


def goals(record):
    """Returns the project's goals with the measured values, as lines of pass or fail."""
    cases, lines = record["ns_per_ray"], []

    def goal(text, value, holds):
        lines.append(f"- {'reached' if holds else 'MISSED'}: {text}: {value}")

    def at_least(case, peer, limit, ours="ours", what=""):
        if ours not in cases.get(case, {}) or peer not in cases[case]:
            return
        value = statistics.median(ratios(cases[case], peer, ours))
        goal(f"{case}{what} >= {limit} x {PEERS[peer]}", f"{value:.1f}", value >= limit)

    def at_most_ns(case, limit, ours="ours", what=""):
        if ours in cases.get(case, {}):
            value = statistics.median(cases[case][ours])
            goal(f"{case}{what} <= {limit} ns", f"{value:.2f}", value <= limit)

    def close(names, limit, base):
        names = [name for name in names if name in cases]
        if base not in cases or not names:
            return
        for name in names:
            share = statistics.median(a / b for a, b in zip(cases[name]["ours"], cases[base]["ours"]))
            goal(f"{name} within {limit:.0%} of {base}", f"{share - 1:+.0%}", share <= 1 + limit)

    at_least("disk", "thesis", 22)
    at_least("disk", "opencv", 6)
    at_least("disk", "thesis", 18, "ours@AVX2", " by AVX2")
    at_least("separable", "thesis", 50)
    close(["tilt", "pentagon", "distortion_phone", "distortion_barrel", "distortion_fisheye"], 0.15, "disk")
    close(["prefiltered_phone"], 0.15, "prefiltered")
    close(["prefiltered_barrel", "prefiltered_fisheye"], 0.3, "prefiltered")
    plates = [name for name in ("plate_720p", "plate_1080p", "plate_4k", "plate_8k") if name in cases]
    if len(plates) == 4:
        times = [statistics.median(cases[name]["ours"]) for name in plates]
        goal("720p to 8K within 15%", " ".join(f"{t:.2f}" for t in times), max(times) <= 1.15 * min(times))
    at_least("bilinear", "thesis", 15)
    at_least("bilinear", "opencv", 5)
    at_least("prefiltered", "opencv", 5)
    at_least("prefiltered", "opencv_cubic", 12)
    at_most_ns("prefiltered", 1.6, "ours_weighed", ", weighed")
    at_most_ns("prefiltered_0.5", 2.5)
    at_most_ns("mosaic", 5)
    if "bilinear" in record.get("agreement", {}):
        same = record["agreement"]["bilinear"]
        goal("bilinear >= 75 dB from the reference", f"{same['psnr_db']:.1f}", same["psnr_db"] >= 75)
        share = same["rays_in_other_elements"]
        goal("bilinear accepts the rays of the reference", f"{share:.1e} others", share == 0)
    for case in ("bilinear", "bicubic", "mosaic", "prefiltered"):
        if "ours_weighed" in cases.get(case, {}):
            share = statistics.median(ratios(cases[case], "ours_weighed"))
            goal(f"{case}, weighed within 30% of unweighed", f"{share - 1:+.0%}", share <= 1.3)
    for case in ("disk", "bilinear"):
        if case in cases:
            value = statistics.median(ratios(cases[case], "opencv", "thesis"))
            goal(f"the thesis's loop >= 0.25 x OpenCV, {case}", f"{value:.2f}", value >= 0.25)
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--cases", default=ALL, help="a table of its own (default: %(default)s)")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        record = results.context()
        record["rounds"] = arguments.rounds
        cases, agreement, compiler = run(arguments.build.resolve(), arguments.rounds, arguments.cases)
        record.update(compiler=f"g++ {compiler}, -O3", ns_per_ray=cases,
                      agreement=agreement)
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join(
        [results.sentence(record) + f" {record['compiler']}; one thread, CPU time, median "
         f"(least-largest) of {record['rounds']} interleaved rounds.", ""] +
        table(record["ns_per_ray"]) + target_table(record["ns_per_ray"]) + [""] + goals(record)) + "\n"
    script = "kernel_table.py"
    if arguments.cases != ALL:
        script += f" --cases '{arguments.cases}'"
    results.publish(arguments, script, record, text)


if __name__ == "__main__":
    main()
