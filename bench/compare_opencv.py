#!/usr/bin/python3
"""Times whole programs on the same light field: lfrenderer, and the same thing written with OpenCV
(bench/compare_opencv.cc), JPEG decoding included.

usage: bench/compare_opencv.py BUILD_DIR LIGHTFIELD [--threads 2] [--frames 1,30] [--rounds 5,3]
                               [--diameter W] [--name NAME]

LIGHTFIELD  8-bit sRGB images of parallel cameras in one plane; measured with the 27 x 27 views of
            960 x 640 of Linus Mossberg's light-field-renderer, folder light-fields/shop
--diameter  of the lens, in world units (1.2: all 729 views are within)
--frames    lengths of the focus pulls that are rendered; a pull of one frame is its beginning
--rounds    of each of them
--name      write bench/results/NAME.md and NAME.json

The programs take turns; figures are medians over the rounds, ratios those of the medians. Rates are
LF images a second of the clock. lfrenderer is all of it: selection, developing and the EXR files of
all frames; OpenCV's program writes one picture. Before anything is timed their first frames are compared.
"""
import argparse
import math
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

import record as results

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
LEAST_PSNR_DB = 45  # between the first frames of two programs that interpolate alike


def timed(command):
    """seconds of the clock, CPU seconds, peak MiB"""
    start = time.monotonic()
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen([str(word) for word in command], stdout=log, stderr=log)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            log.seek(0)
            raise SystemExit(f"{command[0]} failed:\n{log.read().decode()}")
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def psnr_db(a, b):
    return 10 * math.log10(1 / float(np.mean((a - b) ** 2)))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("light_field", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--frames", default="1,30")
    parser.add_argument("--rounds", default="5,3")
    parser.add_argument("--diameter", type=float, default=1.2)
    parser.add_argument("--name")
    arguments = parser.parse_args()
    images = len(list(arguments.light_field.glob("**/*.jpg")))
    record = dict(results.context(), threads=arguments.threads, images=images, rows=[])
    programs = ["OpenCV", "bilinear", "nearest"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)

        def call(program, path, frames):
            if program == "OpenCV":
                return [arguments.build / "bench/lf_compare_opencv", arguments.light_field, path,
                        frames, arguments.threads, folder / "opencv.f32"]
            return [arguments.build / "bin/lfrenderer", arguments.light_field, path, "-o",
                    folder / program, "--estimator", program, "--threads", arguments.threads,
                    "--progress", "none", "--no-contact-sheet"]

        for frames, rounds in zip(map(int, arguments.frames.split(",")),
                                  map(int, arguments.rounds.split(",")), strict=True):
            path = folder / f"path{frames}.yaml"
            path.write_text(PATH.format(frames=frames, diameter=arguments.diameter,
                                        end=(frames - 1) / 25 or 1))
            times = {program: [] for program in programs}
            for _ in range(rounds):
                for program in programs:
                    times[program].append(timed(call(program, path, frames)))
            theirs = np.fromfile(folder / "opencv.f32", np.float32).reshape(640, 960, 3)
            medians = {}
            for program in programs:
                wall, cpu, peak = (statistics.median(column) for column in zip(*times[program]))
                medians[program] = (wall, cpu)
                row = dict(program=program, frames=frames, rounds=rounds, wall_s=wall, cpu_s=cpu, peak_mib=peak,
                           images_per_s=images / wall, per_frame_s=wall / frames)
                if program != "OpenCV":
                    ours = cv2.imread(str(folder / program / "frame_0001.exr"),
                                      cv2.IMREAD_UNCHANGED)[:, :, 2::-1]
                    row["psnr_db"] = psnr_db(ours, theirs)
                    row["rate"] = medians["OpenCV"][0] / wall
                    row["cpu_ratio"] = medians["OpenCV"][1] / cpu
                    if program == "bilinear" and row["psnr_db"] < LEAST_PSNR_DB:
                        raise SystemExit(f"the frames differ: {row['psnr_db']:.1f} dB")
                record["rows"].append(row)

    text = (f"# Whole programs: ours against OpenCV\n\n{images} LF images, {arguments.threads} "
            f"threads each, frames of 960 x 640, medians over the rounds. "
            f"{results.sentence(record)}\n\n"
            "| frames | rounds | program | s | s/frame | LF images/s | rate to OpenCV's | CPU s | OpenCV's CPU to it | peak MiB | "
            "PSNR to OpenCV's |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n")
    for row in record["rows"]:
        rate, cpu_ratio = (f"{row[key]:.2f} x" if key in row else "1"
                           for key in ("rate", "cpu_ratio"))
        psnr = f"{row['psnr_db']:.1f} dB" if "psnr_db" in row else ""
        text += (f"| {row['frames']} | {row['rounds']} | {row['program']} | {row['wall_s']:.2f} | "
                 f"{row['per_frame_s']:.3f} | {row['images_per_s']:.0f} | {rate} | "
                 f"{row['cpu_s']:.2f} | {cpu_ratio} | {row['peak_mib']:.0f} | {psnr} |\n")
    print(text)
    if arguments.name:
        results.save(arguments.name, record, text)


if __name__ == "__main__":
    main()
