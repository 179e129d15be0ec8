#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the forecasts of lfpreprocessor with what renders take: CPU time and memory of three films, in every mode.

usage: bench/forecasts.py BUILD_DIR DATA [--runs 3] [--frames 12] [--scale 1] [--only marbles,shop,phone]
                          [--modes collect,rebin,hybrid] [--name NAME] [--write PAGE]
       bench/forecasts.py --again JSON [--write PAGE]

DATA has blender-shop and beer-colmap. The films:

marbles  a synthetic scene, dense EXR images; a wide lens slides and pulls the focus from near to far
shop     729 JPEG images on a grid, rendered; a focus pull with a lens that holds about fifty of them
phone    71 JPEG images of a hand-held phone with distortion, far apart; a small lens between LF cameras

Forecast and render take turns, `runs` times, so that a busy machine disturbs both alike; the table has the medians. CPU
seconds are those of the whole program, in user and system; memory is the largest resident memory. --scale S makes
frames S times as wide and high.
"""
import argparse
import json
import pathlib
import re
import statistics
import tempfile

import record as results

MARBLES = """format: lfpath 1
fps: 24
frames: {frames}
resolution: [{width}, {height}]
camera:
  sensor_width_mm: 36
  focal_length_mm: 40.5
  position: [-0.004, -0.125, -0.8]
  look_at: [0, -0.085, 0]
lens: {{aperture_diameter_mm: 38, focus_distance: 0.55, blades: 5}}
keyframes:
  position: [{{time: 0, value: [-0.004, -0.125, -0.8]}}, {{time: {end}, value: [0.004, -0.125, -0.8]}}]
  focus_distance: [{{time: 0, value: 0.55}}, {{time: {end}, value: 1.1}}]
"""
# Light field in DATA, and the size of frames.
CAPTURES = {"shop": ("blender-shop", (480, 320)), "phone": ("beer-colmap", (333, 593))}
FILMS = ("marbles", *CAPTURES)
MODES = ("collect", "rebin", "hybrid")
STAGES = ("begin", "load", "collect", "rebin", "complete", "finish")


def film_of(name, arguments, folder):
    """Returns the light field and the path of a film."""
    programs, path = arguments.build.resolve() / "bin", folder / f"{name}.yaml"

    def scaled(size):
        return [max(2, round(length * arguments.scale)) for length in size]

    if name == "marbles":
        field = folder / "marbles"
        width, height = scaled((480, 320))
        results.call([programs / "lfsynth", "still-life", "-o", field, "--count", 400, "--size", f"{width}x{height}",
                      "-q"])
        path.write_text(MARBLES.format(frames=arguments.frames, width=width, height=height,
                                       end=(arguments.frames - 1) / 24))
        return field, path
    capture, size = CAPTURES[name]
    field = arguments.data / capture
    results.call([programs / "lfexample", field, "-o", path, "-q"])
    text = re.sub(r"^frames: \d+", f"frames: {arguments.frames}", path.read_text(), flags=re.M)
    path.write_text(re.sub(r"^resolution: \[.*?\]", f"resolution: {scaled(size)}", text, flags=re.M))
    return field, path


def measure(name, mode, field, path, arguments, folder):
    programs = arguments.build.resolve() / "bin"
    options = ["--mode", mode, "--lens-weights", "none" if mode == "rebin" else "auto"]
    row = {"film": name, "mode": mode, "forecast_cpu_s": [], "cpu_s": [], "forecast_bytes": [], "bytes": [],
           "plan_cpu_s": [], "stages": []}
    for _ in range(arguments.runs):
        used = results.timed([programs / "lfpreprocessor", field, path, "--plan", "--packages", 1, "--json", "-q",
                              *options])
        package = json.loads(used["stdout"])["packages"][0]
        row["plan_cpu_s"].append(used["cpu_s"])
        row["forecast_cpu_s"].append(package["cpu_s"])
        row["forecast_bytes"].append(package["memory_bytes"])
        row["stages"].append(package.get("cpu_s_of"))
        used = results.timed([programs / "lfrenderer", field, path, "-o", folder / "out", "--overwrite", "-q",
                              "--no-contact-sheet", "--estimator", "auto", *options])
        row["cpu_s"].append(used["cpu_s"])
        row["bytes"].append(used["peak_bytes"])
    row["lf_images"] = package["lf_images"]
    return row


def table(record):
    lines = ["| film | mode | LF images | CPU s forecast | CPU s | ratio | memory forecast | memory | ratio | "
             "CPU s of the forecast | stages of the forecast |", "|" + " --- |" * 11]
    for row in record["rows"]:
        median = {key: statistics.median(row[key]) for key in
                  ("forecast_cpu_s", "cpu_s", "forecast_bytes", "bytes", "plan_cpu_s")}
        # The ratio is taken within runs that follow each other at once.
        cpu = statistics.median(a / b for a, b in zip(row["forecast_cpu_s"], row["cpu_s"]))
        memory = statistics.median(a / b for a, b in zip(row["forecast_bytes"], row["bytes"]))
        stages = ", ".join(f"{stage} {row['stages'][-1][stage]:.1f}" for stage in STAGES
                           if row["stages"][-1] and row["stages"][-1][stage] >= 0.05)
        lines.append(f"| {row['film']} | {row['mode']} | {row['lf_images']} | {median['forecast_cpu_s']:.1f} | "
                     f"{median['cpu_s']:.1f} | {cpu:.2f} | {median['forecast_bytes'] / 1e6:.0f} MB | "
                     f"{median['bytes'] / 1e6:.0f} MB | {memory:.2f} | {median['plan_cpu_s']:.1f} | {stages} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("data", type=pathlib.Path, nargs="?")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--scale", type=float, default=1)
    parser.add_argument("--only", default=",".join(FILMS))
    parser.add_argument("--modes", default=",".join(MODES))
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build and arguments.data:
        record = results.context()
        record.update(runs=arguments.runs, frames=arguments.frames, scale=arguments.scale, rows=[])
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            for name in arguments.only.split(","):
                field, path = film_of(name, arguments, folder)
                for mode in arguments.modes.split(","):
                    record["rows"].append(measure(name, mode, field, path, arguments, folder))
                    print(table({"rows": record["rows"][-1:]})[-1], flush=True)
    else:
        parser.error("BUILD_DIR and DATA, or --again are needed")
    text = "\n".join([results.sentence(record) + f" {record['frames']} frames, medians of {record['runs']} runs.", ""]
                     + table(record)) + "\n"
    results.publish(arguments, "forecasts.py", record, text)


if __name__ == "__main__":
    main()
