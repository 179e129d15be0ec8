#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures LF images that are loaded from packed stores at a reduced size: bytes, CPU time and error.

usage: bench/reduced_loads.py BUILD_DIR [--data ../shared] [--images 40] [--name NAME] [--write PAGE]
       bench/reduced_loads.py --again JSON [--write PAGE]

Each capture is packed by `lfcompressor`, and its LF images are loaded whole and at 1/2, 1/4 and 1/8 of their width by
the Python package, in one thread. Bytes are those of the front of the encoded image that is read, as a share of the
whole; the CPU time includes the conversion to linear light, and is a share of that of whole LF images. Both are sums
over the images, and the time is the least of five. The error is the PSNR of display values, against means of squares
of display values of the whole LF images; borders of four pixels are left out. `mosaic` is an RGGB mosaic
of `still-life`, which is loaded as RGB.
"""
import argparse
import math
import pathlib
import sqlite3
import sys
import time

import numpy as np

import record as results

REDUCTIONS = (2, 4, 8)
BORDER = 4
RUNS = 5
CAPTURES = {"blender-shop": "data/blender-shop", "stanford-cards": "data/stanford-cards-9x9",
            "beer-colmap": "data/beer-colmap", "templeRing": "data/middlebury-templeRing/templeRing",
            "still-life": ("--size", "960x640", "--format", "png"), "mosaic": ("--size", "960x640", "--bayer")}
PROFILES = ("default", "lossless")


def display(light):
    """Returns sRGB values, 0 to 1, of linear light."""
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def means_of(values, side):
    height, width = values.shape[0] // side, values.shape[1] // side
    return values[:height * side, :width * side].reshape(height, side, width, side, 3).mean((1, 3))


def light_field_of(name, arguments, folder):
    if name == "stanford-cards":  # its names state no focal length
        results.call([arguments.build.resolve() / "bin/lfimport", arguments.data / CAPTURES[name], "-o", folder / name,
                      "--pitch", 1, "--focal-px", 768, "--plane-distance", 100, "-q"])
        return folder / name
    if not isinstance(CAPTURES[name], tuple):
        return arguments.data / CAPTURES[name]
    results.call([arguments.build.resolve() / "bin/lfsynth", "still-life", "-o", folder / name, "--count", 16,
                  *CAPTURES[name], "-q"])
    return folder / name


def fronts_of(store):
    """Returns {id: lengths of the fronts of the encoded image, and of the whole}."""
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        rows = database.execute("select id, fronts, length(code) - 8 from fronts join blobs using (id)").fetchall()
    return {i: [*np.frombuffer(fronts[:-8], "<u8")[::2].tolist(), whole] for i, fronts, whole in rows}


def least_cpu_s(function):
    """Returns the least CPU time of some calls, because other work on the machine only adds to it."""
    taken = []
    for _ in range(RUNS):
        begin = time.process_time()
        function()
        taken.append(time.process_time() - begin)
    return min(taken)


def row_of(lf, store, arguments, is_mosaic):
    field = lf.open(store)
    indices = np.linspace(0, len(field) - 1, min(arguments.images, len(field))).astype(int)
    fronts = fronts_of(store)
    wholes = [field.image(int(i)) for i in indices]
    whole_s = least_cpu_s(lambda: [field.image(int(i)) for i in indices])
    row = {"images": len(indices), "mpx": sum(whole.shape[0] * whole.shape[1] for whole in wholes) / 1e6}
    for reduction in REDUCTIONS:
        load = lambda: [field._core.thumbnail(int(i), wholes[0].shape[1] // reduction) for i in indices]
        reduced, cpu_s = load(), least_cpu_s(load)
        left_out = int(math.log2(reduction)) - (1 if is_mosaic else 0)
        front_bytes = sum(fronts[int(i)][-1 - left_out] for i in indices)
        inner = (slice(BORDER, -BORDER),) * 2
        error = np.mean([np.mean((display(small) - means_of(display(whole), reduction))[inner] ** 2)
                         for small, whole in zip(reduced, wholes)])
        row[str(reduction)] = {"bytes": front_bytes / sum(fronts[int(i)][-1] for i in indices),
                               "cpu": cpu_s / whole_s, "psnr": 10 * math.log10(1 / error)}
    return row


def rows_of(arguments, folder):
    sys.path.insert(0, str(arguments.build.resolve() / "python"))
    import lfrendertools as lf  # the package of the build
    rows = []
    for name in CAPTURES:
        field = light_field_of(name, arguments, folder)
        for profile in PROFILES:
            store = folder / f"{name}-{profile}.lfs"
            results.call([arguments.build.resolve() / "bin/lfcompressor", field, "-o", store, "--profile", profile,
                          "--reencode", "--progress", "none", "-q"])
            rows.append({"capture": name, "profile": profile} | row_of(lf, store, arguments, name == "mosaic"))
    return rows


def table(record):
    lines = ["| capture | profile | " + " | ".join(f"bytes, 1/{r} | CPU, 1/{r} | dB, 1/{r}" for r in REDUCTIONS) + " |",
             "|" + " --- |" * (2 + 3 * len(REDUCTIONS))]
    for row in record["rows"]:
        cells = [f"{row[str(r)]['bytes']:.0%} | {row[str(r)]['cpu']:.0%} | {row[str(r)]['psnr']:.1f}"
                 for r in REDUCTIONS]
        lines.append(f"| {row['capture']} | {row['profile']} | {' | '.join(cells)} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    parser.add_argument("--images", type=int, default=40, help="LF images of each capture")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build, lambda folder: {"rows": rows_of(arguments, folder)})
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "reduced_loads.py", record, text)


if __name__ == "__main__":
    main()
