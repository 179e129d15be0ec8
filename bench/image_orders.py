#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how evenly the orders of LF images fill the frames of a film, as lfpreprocessor plans it.

usage: bench/image_orders.py BUILD_DIR [--density 1] [--size 480x320] [--name NAME] [--write PAGE]
       bench/image_orders.py --again JSON [--write PAGE]

The film is the movement `bokeh` of Table 5.1, whose lens opens and closes, through a grid as dense as the thesis's band
(calibration only). Packages are made without lens weights and by the default. The table shows how many rays each frame
has after a tenth of the LF images (the pixels of the rectangles in its package), and how these numbers spread over the
frames.
"""
import argparse
import itertools
import pathlib
import sqlite3
import statistics

import record as results
from workloads import WORKLOADS, path_yaml, photograph


def filled_after_a_tenth(packages):
    """Returns the number of rays that each frame has after a tenth of the LF images. Frames without rays are left out.

    packages  packages with one frame each, so that the needs of a package are those of its frame
    """
    frames = []
    for package in packages:
        with sqlite3.connect(f"file:{package}?immutable=1", uri=True) as database:
            frames.append(dict(database.execute("select rank, rays from lf_images where frames > 0")))
    places = sorted(set().union(*frames))
    first = set(places[:len(places) // 10])
    return [sum(rays for place, rays in frame.items() if place in first) for frame in frames if frame]


WEIGHTS = {"none": ("--estimator", "bilinear", "--lens-weights", "none"), "default": ()}


def measure(build, folder, density, size):
    field, path = folder / "field", folder / "bokeh.yaml"
    photograph(build, field, density, size, "--calibration-only")
    path.write_text(path_yaml(WORKLOADS["bokeh"], [int(length) // 2 for length in size.split("x")]))
    rows = []
    for weights, order in itertools.product(WEIGHTS, ("spread", "shuffle", "round-robin", "area")):
        out = folder / f"{order}-{weights}"
        results.call([build / "bin/lfpreprocessor", field, path, "-o", out, "-q", "--order", order,
                      "--frames-per-package", 1, "--allow-missing", "100%", *WEIGHTS[weights]])
        rays = filled_after_a_tenth(sorted(out.glob("*.lfp")))
        rows.append({"order": order, "weights": weights, "frames": len(rays), "empty": rays.count(0),
                     "least": min(rays), "median": statistics.median(rays), "most": max(rays),
                     "deviation": statistics.pstdev(rays) / statistics.mean(rays)})
    return rows


def table(record):
    lines = ["| order | lens weights | frames without a ray | rays of a frame: least, median, most, M | "
             "standard deviation / mean |", "|" + " --- |" * 5]
    for row in record["rows"]:
        lines.append(f"| {row['order']} | {row['weights']} | {row['empty']} of {row['frames']} | "
                     f"{row['least'] / 1e6:.2f}, {row['median'] / 1e6:.2f}, {row['most'] / 1e6:.2f} | "
                     f"{row['deviation']:.2f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=1)
    parser.add_argument("--size", default="480x320")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build, lambda folder: {
        "density": arguments.density, "size": arguments.size,
        "rows": measure(arguments.build.resolve(), folder, arguments.density, arguments.size)})
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "image_orders.py", record, text)


if __name__ == "__main__":
    main()
