#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what unfinished frames lose in the order `groups`, and makes a table of doc/checkpoints.md.

usage: group_order.py BIN SHARED [--only CAPTURE,...] [--seeds 3] [--write doc/checkpoints.md]
       group_order.py --again JSON [--write doc/checkpoints.md]

BIN and SHARED are those of order_quality.py, as are the captures, the lenses and the figure: the PSNR of frames of the
first n LF images (--max-images n) against frames of all, in sRGB with the peak 1, as the mean of its decibels over
seeds and lenses. Frames are rendered by the defaults. The frame of all LF images must have the same bits in all orders.
"""
import argparse
import pathlib
import sys

import numpy as np

import order_quality
from quality import results

NUMBERS = (16, 32, 64)
ORDERS = ("spread", "shuffle", "groups")
CAPTURES = ("planar", "band", "shop")
DEFAULT = order_quality.WEIGHTS["default"].split()


def measure(bench, names, seeds):
    rows = []
    for name in names:
        calibration, paths = order_quality.CAPTURES[name](bench)
        decibels, counts = {}, []
        for path in paths:
            whole, count = order_quality.frame(bench, calibration, path, *DEFAULT)
            counts.append(count)
            for order in ORDERS:
                same, _ = order_quality.frame(bench, calibration, path, *DEFAULT, "--order", order)
                if not np.array_equal(whole, same):
                    raise SystemExit(f"{name}: the frame of all LF images has other bits in the order {order}")
            for n in NUMBERS:
                if n > order_quality.MOST * count:
                    break
                for order in ORDERS:
                    for seed in range(seeds):
                        part, _ = order_quality.frame(bench, calibration, path, *DEFAULT, "--max-images", n,
                                                      "--order", order, "--seed", seed)
                        decibels.setdefault((n, order), []).append(-10 * np.log10(np.mean((part - whole) ** 2)))
        rows.append({"capture": name, "lf_images": counts} | {
            order: {str(n): float(np.mean(decibels[n, order])) for n in NUMBERS if (n, order) in decibels}
            for order in ORDERS})
        print(rows[-1], file=sys.stderr, flush=True)
    return rows


def table(record):
    lines = ["| capture | in the lens | order | " + " | ".join(f"*n* = {n}" for n in NUMBERS) + " |",
             "|" + " --- |" * (len(NUMBERS) + 3)]
    for row in record["rows"]:
        for order in ORDERS:
            cells = [f"{row[order][str(n)]:.1f}" if str(n) in row[order] else "" for n in NUMBERS]
            counts = ", ".join(map(str, row["lf_images"]))
            lines.append(f"| {row['capture']} | {counts} | `{order}` | " + " | ".join(cells) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", default=",".join(CAPTURES), help="captures, with commas between")
    parser.add_argument("--seeds", type=int, default=3)
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.shared, lambda folder: {
        "seeds": arguments.seeds,
        "rows": measure(order_quality.Bench(arguments.programs.resolve(), arguments.shared.resolve(), folder),
                        arguments.only.split(","), arguments.seeds)}, "BIN SHARED")
    text = "\n".join([results.sentence(record), "PSNR, dB, of frames of the first *n* LF images against frames of all; "
                      f"means of {record['seeds']} seeds each. Frames are rendered by `{' '.join(DEFAULT)}`.", ""]
                     + table(record)) + "\n"
    results.publish(arguments, "quality/group_order.py", record, text)


if __name__ == "__main__":
    main()
