#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the peak memory of lfrenderer, to compare it with its limit --memory.

usage: bench/memory_bound.py BUILD_DIR LIGHTFIELD [--bounds 1G,4G] [--frames 1,60] [--images 24]
                             [--name NAME] [--write PAGE]
       bench/memory_bound.py --again JSON [--write PAGE]

LIGHTFIELD  the light field of bench/compare_opencv.py; frames of its focus pull have 1920 x 1080 elements
--images    LF images of each frame: they are loaded a few at a time, however many there are

Frames are rendered by plain interpolation without lens weights, and by the defaults.
"""
import argparse
import json
import pathlib
import tempfile

import record as results
from compare_opencv import PATH
from workloads import WAYS


def measure(arguments, folder):
    rows = []
    for frames in map(int, arguments.frames.split(",")):
        path = folder / f"path{frames}.yaml"
        path.write_text(PATH.format(frames=frames, diameter=1.2, end=(frames - 1) / 25 or 1)
                        .replace("[960, 640]", "[1920, 1080]"))
        for way in ("bilinear", "default"):
            for bound in arguments.bounds.split(","):
                out = folder / f"{frames}-{way}-{bound}"
                used = results.timed([arguments.build / "bin/lfrenderer", arguments.light_field, path, "-o", out,
                                      "--memory", bound, "--max-images", arguments.images, "--threads", 2, "-q",
                                      "--no-contact-sheet", *WAYS[way]])
                used.pop("stdout")
                report = json.loads((out / "report.json").read_text())
                rows.append({"frames": frames, "way": way, "bound": bound, "passes": report["passes"], **used})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("light_field", type=pathlib.Path, nargs="?")
    parser.add_argument("--bounds", default="1G,4G")
    parser.add_argument("--frames", default="1,60")
    parser.add_argument("--images", type=int, default=24)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.light_field:
        record = results.context() | {"images": arguments.images}
        with tempfile.TemporaryDirectory() as temporary:
            record["rows"] = measure(arguments, pathlib.Path(temporary))
    else:
        parser.error("BUILD_DIR LIGHTFIELD or --again is needed")
    lines = ["| frames | way | `--memory` | peak MiB | passes | s |", "|" + " --- |" * 6]
    lines += [f"| {row['frames']} | {row['way']} | {row['bound']} | "
              f"{row['peak_bytes'] / 2 ** 20:,.0f} | {row['passes']} | "
              f"{row['seconds']:.1f} |" for row in record["rows"]]
    text = "\n".join([results.sentence(record) + f" {record['images']} LF images a frame, two threads.",
                      ""] + lines) + "\n"
    results.publish(arguments, "memory_bound.py", record, text)


if __name__ == "__main__":
    main()
