#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how much time packages and rectangles save, on movements of Table 5.1 (workloads.py).

usage: bench/packages.py BUILD_DIR [--density 0.03] [--size 480x320] [--runs 3] [--field DIR]
                         [--packages 4] [--name NAME] [--write PAGE]
       bench/packages.py --again JSON [--write PAGE]

The movement `long` is cut into packages of equal rays or of equal frames, and each package is rendered by itself, with
all threads: the slowest package decides when a film is ready that is rendered on as many machines. It is rendered as in
the thesis (nearest, without lens weights) and by the defaults. `short` is rendered with and without rectangles, by a
render camera that sees as much as the LF cameras, and by one with twice their focal length: by nearest and bilinear
without lens weights, and by the defaults (only with the longer lens). Without rectangles, every LF image that may have
rays for some frame is tested whole in all frames, as in the thesis; such a render is not repeated. The frames of all
runs must have the same bits.
"""
import argparse
import hashlib
import json
import pathlib
import statistics
import tempfile

import record as results
from workloads import WAYS, WORKLOADS, path_yaml, photograph

# Options of lfpreprocessor with which it forecasts the measured render.
PREPROCESSING = {"nearest": ("--estimator", "nearest", "--lens-weights", "none"), "default": ()}
# Options and focal lengths of the renders of `short`.
RECTANGLES = (("nearest", 36), ("nearest", 72), ("bilinear", 72), ("default", 72))


def digest(folder):
    """Returns a digest of the bytes of all frames."""
    whole = hashlib.sha256()
    for frame in sorted(folder.glob("frame_*")):
        whole.update(hashlib.sha256(frame.read_bytes()).digest())
    return whole.hexdigest()


def render(build, inputs, out, *options):
    """Returns the seconds of one render."""
    for report in out.glob("report*.json"):  # a report of an earlier render, which only --resume would use
        report.unlink()
    used = results.timed([build / "bin/lfrenderer", *inputs, "-o", out, "-q", "--no-contact-sheet", *options])
    return used["seconds"]


def measure_packages(build, field, folder, size, count, balance, way, runs):
    """Returns the estimated rays, the frames and the median seconds of each package."""
    path = folder / "long.yaml"
    path.write_text(path_yaml(WORKLOADS["long"], size))
    packages, parts, whole = (folder / f"{what}-{balance}-{way}" for what in ("packages", "parts", "whole"))
    plan = json.loads(results.call([build / "bin/lfpreprocessor", field, path, "-o", packages, "-q", "--json",
                                    "--packages", count, "--balance", balance, *PREPROCESSING[way]]))
    files = sorted(packages.glob("*.lfp"))
    seconds = [[] for _ in files]
    for _ in range(runs):
        for times, file in zip(seconds, files):
            times.append(render(build, [file], parts, *WAYS[way]))
    if balance == "rays":  # packages by frames are compared with the same whole film
        render(build, [field, path], whole, *WAYS[way])
    if digest(folder / f"whole-rays-{way}") != digest(parts):
        raise SystemExit(f"packages give other frames than the whole film ({balance}, {way})")
    return {"balance": balance, "way": way,
            "frames": [len(package["frames"]) for package in plan["packages"]],
            "rays": [package["rays"] for package in plan["packages"]],
            "forecast_cpu_s": [package["cpu_s"] for package in plan["packages"]],
            "seconds": [round(statistics.median(times), 3) for times in seconds]}


def measure_rectangles(build, field, folder, size, runs):
    path = folder / "short.yaml"
    rows = []
    for way, focal_mm in RECTANGLES:
        path.write_text(path_yaml(WORKLOADS["short"], size, focal_mm))
        seconds, frames, collect = {"on": [], "off": []}, {}, {}
        for run in range(runs):
            for choice in ("on", "off") if run == 0 else ("on",):
                out = folder / f"short-{choice}"
                seconds[choice].append(render(build, [field, path], out, "--rectangles", choice, *WAYS[way]))
                frames[choice] = digest(out)
                report = json.loads((out / "report.json").read_text())
                collect[choice] = {key: report[key] for key in
                                   ("lf_images_selected", "load_cpu_s", "collect_cpu_s", "rays_tested")}
        if frames["on"] != frames["off"]:
            raise SystemExit(f"frames differ without rectangles ({way}, {focal_mm} mm)")
        rows.append({"way": way, "focal_mm": focal_mm, **{
            choice: {"seconds": round(statistics.median(seconds[choice]), 3), **collect[choice]}
            for choice in seconds}})
    return rows


def table(record):
    lines = ["| `long`, way | balanced by | frames | estimated rays, M | largest / mean | seconds alone | longest / "
             "mean | shortest / longest |", "|" + " --- |" * 8]
    for row in record["packages"]:
        mean = lambda values: sum(values) / len(values)
        lines.append(
            f"| {row['way']} | {row['balance']} | {', '.join(map(str, row['frames']))} | "
            f"{', '.join(f'{rays / 1e6:.0f}' for rays in row['rays'])} | "
            f"{max(row['rays']) / mean(row['rays']):.3f} | "
            f"{', '.join(f'{s:.2f}' for s in row['seconds'])} | "
            f"{max(row['seconds']) / mean(row['seconds']):.2f} | "
            f"{min(row['seconds']) / max(row['seconds']):.2f} |")
    lines += ["", "| `short`, way | focal length | rectangles | LF images | Mpx tried | seconds | CPU s: decoding, "
              "collecting |", "|" + " --- |" * 7]
    for row in record["rectangles"]:
        for choice in ("on", "off"):
            part = row[choice]
            lines.append(
                f"| {row['way']} | {row['focal_mm']} mm | {choice} | {part['lf_images_selected']} | "
                f"{part['rays_tested'] / 1e6:.0f} | {part['seconds']:.2f} | "
                f"{part['load_cpu_s']:.2f}, {part['collect_cpu_s']:.2f} |")
        lines.append(f"| {row['way']} | {row['focal_mm']} mm | off / on | | | "
                     f"{row['off']['seconds'] / row['on']['seconds']:.2f} | |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=0.03)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--packages", type=int, default=4)
    parser.add_argument("--field", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        build = arguments.build.resolve()
        size = [int(length) // 2 for length in arguments.size.split("x")]
        record = results.context()
        record.update(density=arguments.density, size=arguments.size, runs=arguments.runs)
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            field = arguments.field or folder / "field"
            photograph(build, field, arguments.density, arguments.size)
            record["packages"] = [
                measure_packages(build, field, folder, size, arguments.packages, balance, way, arguments.runs)
                for way in PREPROCESSING for balance in ("rays", "frames")]
            record["rectangles"] = measure_rectangles(build, field, folder, size, arguments.runs)
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record) + f" LF images {record['size']}, frames half as large, "
                      f"{record['density']:g} of the thesis's LF cameras, medians of {record['runs']} runs.",
                      ""] + table(record)) + "\n"
    results.publish(arguments, "packages.py", record, text)


if __name__ == "__main__":
    main()
