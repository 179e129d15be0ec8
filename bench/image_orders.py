#!/usr/bin/python3
"""How evenly the orders of LF images fill the frames of a film, as lfpreprocessor plans it.

usage: bench/image_orders.py BUILD_DIR [--density 1] [--size 480x320] [--write PAGE]

The movement `bokeh` of Table 5.1, whose lens opens and closes, through a grid as dense as the thesis's band
(calibration only). After a tenth of the LF images: the rays of each frame, as pixels of rectangles that its
package tells, and their spread over the frames.
"""
import argparse
import pathlib
import sqlite3
import statistics
import subprocess
import tempfile

import record as results
from workloads import WORKLOADS, path_yaml, photograph


def filled_after_a_tenth(packages):
    """rays of each frame that has any

    packages  of one frame each: what they need of LF images is what that frame needs
    """
    frames = []
    for package in packages:
        with sqlite3.connect(f"file:{package}?immutable=1", uri=True) as database:
            frames.append(dict(database.execute("select place, rays from lf_images where frames > 0")))
    places = sorted(set().union(*frames))
    first = set(places[:len(places) // 10])
    return [sum(rays for place, rays in frame.items() if place in first) for frame in frames if frame]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--density", type=float, default=1)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--write", type=pathlib.Path, metavar="PAGE")
    parser.set_defaults(name=None)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    size = [int(length) // 2 for length in arguments.size.split("x")]
    lines = ["| order | frames without a ray | rays of a frame: least, median, most, M | standard deviation / mean |",
             "|" + " --- |" * 4]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        field = folder / "field"
        photograph(build, field, arguments.density, arguments.size, "--calibration-only")
        path = folder / "bokeh.yaml"
        path.write_text(path_yaml(WORKLOADS["bokeh"], size))
        for order in ("shuffle", "round-robin", "area"):
            out = folder / order
            subprocess.run([build / "bin/lfpreprocessor", field, path, "-o", out, "-q", "--order", order,
                            "--frames-per-package", "1", "--lens-weights", "none"], check=True,
                           stdout=subprocess.DEVNULL)
            rays = filled_after_a_tenth(sorted(out.glob("*.lfp")))
            lines.append(
                f"| {order} | {rays.count(0)} of {len(rays)} | {min(rays) / 1e6:.2f}, "
                f"{statistics.median(rays) / 1e6:.2f}, {max(rays) / 1e6:.2f} | "
                f"{statistics.pstdev(rays) / statistics.mean(rays):.2f} |")
    record = results.context()
    text = "\n".join([results.sentence(record), ""] + lines) + "\n"
    results.publish(arguments, "image_orders.py", record, text)


if __name__ == "__main__":
    main()
