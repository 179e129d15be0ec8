#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Times whole programs on the same light field: lfrenderer, and the same thing written with OpenCV
(bench/compare_opencv.cc), JPEG decoding included.

usage: bench/compare_opencv.py BUILD_DIR LIGHTFIELD [--threads 2] [--frames 1,10] [--rounds 3,2]
                               [--diameter W] [--name NAME] [--write PAGE]
       bench/compare_opencv.py --again JSON [--write PAGE]

LIGHTFIELD  8-bit sRGB images of parallel cameras in one plane; measured with the 27 x 27 views of
            960 x 640 of Linus Mossberg's light-field-renderer, folder light-fields/shop
--diameter  diameter of the lens, in world units (1.2: all 729 views are within it)
--frames    lengths of the focus pulls that are rendered; a pull of one frame is its beginning
--rounds    number of rounds for each of these lengths

lfrenderer renders in three ways: by plain interpolation, which is what OpenCV's program does; as the thesis does; and
by the defaults. OpenCV's program interpolates between four pixels; a second run interpolates between sixteen, because
the defaults sharpen. The programs take turns. Figures are medians over the rounds, and ratios are computed from these
medians. Rates are LF images per second of wall time. The time of lfrenderer includes everything: selection, developing
and the EXR files of all frames; OpenCV's program writes one picture. After the rounds, the first frames of lfrenderer
are compared with those of OpenCV's program.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import tempfile

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

import record as results
from workloads import WAYS

PATH = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [960, 640]
camera:
  field_of_view_deg: 61.92751
  focal_length_mm: 30
  position: [0, 0, 0]
  look_at: [0, 0, 8]
  up: [0, -1, 0]
  follow: direction
lens:
  aperture_diameter: {diameter}
  focus_distance: 6.3
keyframes:
  focus_distance: [{{time: 0, value: 6.3}}, {{time: {end}, value: 13}}]
"""
# OpenCV's programs, by their interpolation. Ratios and PSNR are to the first one.
OPENCV = {"OpenCV": "bilinear", "OpenCV, bicubic": "bicubic"}
LEAST_PSNR_DB = 45  # between the first frames of two programs with the same interpolation


def psnr_db(a, b):
    return 10 * math.log10(1 / float(np.mean((a - b) ** 2)))


class Comparison:
    """Times all programs on one light field."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.images = len(list(arguments.light_field.glob("**/*.jpg")))

    def command(self, program, path, frames):
        a = self.arguments
        if program in OPENCV:
            return [a.build / "bench/lf_compare_opencv", a.light_field, path, frames, a.threads, OPENCV[program],
                    self.folder / f"{OPENCV[program]}.f32"]
        return [a.build / "bin/lfrenderer", a.light_field, path, "-o", self.folder / program, "--threads", a.threads,
                "--progress", "none", "--no-contact-sheet", *WAYS[program]]

    def rows(self, frames, rounds):
        """Returns one row per program."""
        path = self.folder / f"path{frames}.yaml"
        path.write_text(PATH.format(frames=frames, diameter=self.arguments.diameter, end=(frames - 1) / 25 or 1))
        runs = {program: [] for program in (*OPENCV, *WAYS)}
        for _ in range(rounds):
            for program in runs:
                runs[program].append(results.timed(self.command(program, path, frames)))
        theirs = np.fromfile(self.folder / "bilinear.f32", np.float32).reshape(640, 960, 3)
        rows = []
        for program, used in runs.items():
            wall, cpu, peak = (statistics.median(run[key] for run in used)
                               for key in ("seconds", "cpu_s", "peak_bytes"))
            row = dict(program=program, frames=frames, rounds=rounds, wall_s=wall, cpu_s=cpu, peak_mib=peak / 2 ** 20,
                       images_per_s=self.images / wall, per_frame_s=wall / frames)
            if program in WAYS:
                ours = cv2.imread(str(self.folder / program / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[:, :, 2::-1]
                row["psnr_db"] = psnr_db(ours, theirs)
                if program == "bilinear" and row["psnr_db"] < LEAST_PSNR_DB:
                    raise SystemExit(f"the frames differ: {row['psnr_db']:.1f} dB")
            if rows:
                row["rate"], row["cpu_ratio"] = rows[0]["wall_s"] / wall, rows[0]["cpu_s"] / cpu
            rows.append(row)
        return rows


def table(record):
    lines = ["| frames | rounds | program | s | s/frame | LF images/s | "
             "rate to OpenCV's | CPU s | OpenCV's CPU to it | "
             "peak MiB | PSNR to OpenCV's |", "|" + " --- |" * 11]
    for row in record["rows"]:
        rate, cpu_ratio = (f"{row[key]:.2f} x" if key in row else "1" for key in ("rate", "cpu_ratio"))
        psnr = f"{row['psnr_db']:.1f} dB" if "psnr_db" in row else ""
        lines.append(f"| {row['frames']} | {row['rounds']} | {row['program']} | {row['wall_s']:.2f} | "
                     f"{row['per_frame_s']:.3f} | {row['images_per_s']:.0f} | {rate} | "
                     f"{row['cpu_s']:.2f} | {cpu_ratio} | {row['peak_mib']:.0f} | {psnr} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("light_field", type=pathlib.Path, nargs="?")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--frames", default="1,10")
    parser.add_argument("--rounds", default="3,2")
    parser.add_argument("--diameter", type=float, default=1.2)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.light_field:
        record = dict(results.context(), threads=arguments.threads, rows=[])
        with tempfile.TemporaryDirectory() as folder:
            comparison = Comparison(arguments, pathlib.Path(folder))
            record["images"] = comparison.images
            for frames, rounds in zip(map(int, arguments.frames.split(",")),
                                      map(int, arguments.rounds.split(",")), strict=True):
                record["rows"] += comparison.rows(frames, rounds)
    else:
        parser.error("BUILD_DIR LIGHTFIELD or --again is needed")
    text = "\n".join([f"{results.sentence(record)} {record['images']} LF images, {record['threads']} threads each, "
                      "frames of 960 x 640, medians over the rounds.", ""] + table(record)) + "\n"
    results.publish(arguments, "compare_opencv.py", record, text)


if __name__ == "__main__":
    main()
