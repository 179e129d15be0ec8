#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares two ways to make frames of a part of the bytes of a light field, and makes the table of doc/checkpoints.md:
whole LF images in spread order, or the wavelet coefficients of all LF images in rounds, the largest first.

usage: coefficient_rounds.py BIN SHARED [--only CAPTURE,...] [--write doc/checkpoints.md]
       coefficient_rounds.py --again JSON [--write doc/checkpoints.md]

BIN, SHARED  as for order_quality.py, whose captures and lenses these are, except that of `shop` only a part
             is taken

After a round, all LF images have the coefficients above a threshold. Stores of these thresholds have the bytes and the
pixels of that state: an encoding whose rounds refine each other has a little more bytes. Within a round, some LF images
in spread order have the smaller threshold already. The frame is then that of the last round, with the difference that
these LF images make between the two thresholds: all of it, as if it were the mean difference of all LF images, or its
share of all LF images. The better of both counts. The reference is the frame of all LF images with the smallest
threshold, the default; the first n LF images of the spread order are read from the same store. PSNR is that of
sRGB values, interpolated between the measured numbers of bytes, as a mean over lenses. Frames are rendered by the
defaults.
"""
import argparse
import pathlib
import sqlite3
import sys

import numpy as np

import densify_captures as captures
import order_quality
import quality
from quality import results

THRESHOLDS = (96, 48, 24, 12, 6, 3)
DEFAULT = order_quality.WEIGHTS["default"].split()
PARTS = (1 / 4, 1 / 2)  # of the LF images of a lens
NUMBERS = (4, 8, 16, 32, 64, 128, 192, 256)
SHARES = (0.05, 0.1, 0.2, 0.35, 0.5, 0.75)  # of the bytes: columns of the table


def shop(bench):
    """Returns the LF images of blender-shop around the smaller lens of order_quality.py, and its path."""
    calibration, paths = order_quality.shop(bench)
    field = quality.read_field(calibration)
    field["frames"] = captures.square(field["frames"], range(7, 20))
    return bench.written("middle", field), paths[:1]


CAPTURES = {"planar": order_quality.CAPTURES["planar"], "cards": order_quality.cards, "shop": shop}


def bytes_of(store):
    """Returns the bytes of the encoded images, without the tables of the store."""
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        return database.execute("select sum(length(code) - 8) from blobs").fetchone()[0]


def decibels(picture, whole):
    return float(-10 * np.log10(np.mean((quality.encoded(picture) - quality.encoded(whole)) ** 2)))


class Lens:
    """Frames of one lens, from stores of all thresholds."""

    def __init__(self, bench, stores, path):
        self.bench, self.stores, self.path = bench, stores, path
        self.whole, self.count = self.frame(THRESHOLDS[-1])

    def frame(self, threshold, most=None):
        """Returns the light of a frame, and its number of LF images."""
        options = ["--max-images", most] if most else []
        return order_quality.light(self.bench, self.stores[threshold], self.path, *DEFAULT, *options)

    def spread(self):
        """Returns [(share of the bytes, dB)] of the first LF images of the spread order."""
        return [(n / self.count, decibels(self.frame(THRESHOLDS[-1], n)[0], self.whole))
                for n in NUMBERS if n < self.count]

    def rounds(self):
        """Returns [(share of the bytes, dB)] of rounds, of which the last is not finished."""
        points, all_bytes = [], bytes_of(self.stores[THRESHOLDS[-1]])
        for coarse, fine in zip(THRESHOLDS, THRESHOLDS[1:]):
            begin, end = (bytes_of(self.stores[threshold]) / all_bytes for threshold in (coarse, fine))
            last = self.frame(coarse)[0]
            points.append((begin, decibels(last, self.whole)))
            for part in PARTS:
                most = max(1, round(part * self.count))
                gain = self.frame(fine, most)[0] - self.frame(coarse, most)[0]
                points.append((begin + part * (end - begin), max(decibels(last + gain, self.whole),
                                                                 decibels(last + part * gain, self.whole))))
        return points


def at(points, share):
    """Returns the dB at a share of the bytes, None if it is less than the least that was measured."""
    shares, values = zip(*sorted(points))
    return None if share < shares[0] else float(np.interp(np.log(share), np.log(shares), values))


def stores_of(bench, name, calibration):
    stores = {}
    for threshold in THRESHOLDS:
        stores[threshold] = bench.folder / f"{name}-{threshold}.lfs"
        results.call([bench.programs / "lfcompressor", calibration, "-o", stores[threshold], "--threshold", threshold,
                      "--reencode", "--progress", "none", "-q"])
    return stores


def measure(bench, names):
    rows = []
    for name in names:
        calibration, paths = CAPTURES[name](bench)
        stores = stores_of(bench, name, calibration)
        for path in paths:
            lens = Lens(bench, stores, path)
            rows.append({"capture": name, "lf_images": lens.count, "spread": lens.spread(), "rounds": lens.rounds()})
            print(rows[-1], file=sys.stderr, flush=True)
    return rows


def table(record):
    lines = ["| capture | LF images in the lens | " + " | ".join(f"{share:.0%}" for share in SHARES) + " |",
             "|" + " --- |" * (len(SHARES) + 2)]
    cell = lambda value: "-" if value is None else f"{value:.1f}"
    for row in record["rows"]:
        lines.append(f"| {row['capture']} | {row['lf_images']} | " + " | ".join(
            f"{cell(at(row['spread'], share))}, {cell(at(row['rounds'], share))}" for share in SHARES) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", default=",".join(CAPTURES), help="captures, with commas between")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.shared, lambda folder: {
        "rows": measure(order_quality.Bench(arguments.programs.resolve(), arguments.shared.resolve(), folder),
                        arguments.only.split(","))}, "BIN SHARED")
    text = "\n".join([results.sentence(record), "PSNR, dB, of frames of a share of the bytes: whole LF images in the "
                      "order `spread`, coefficients of all LF images in rounds.", ""] + table(record)) + "\n"
    results.publish(arguments, "quality/coefficient_rounds.py", record, text)


if __name__ == "__main__":
    main()
