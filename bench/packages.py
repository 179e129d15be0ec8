#!/usr/bin/python3
"""What packages and rectangles are worth, on movements of Table 5.1 (workloads.py).

usage: bench/packages.py BUILD_DIR [--density 0.03] [--size 480x320] [--runs 5] [--field DIR]
                         [--packages 4] [--name NAME] [--write PAGE]
       bench/packages.py --again JSON [--write PAGE]

The movement `long` is cut into packages by rays and by frames, and each package is rendered by itself,
with all threads: the longest decides when a film on so many machines is ready. `short` is rendered with
rectangles and without, by a lens that sees as much as the LF cameras and by one of twice their focal length,
without lens weights. Without them every LF image
that may give rays to some frame is tried whole in all frames, as in the thesis. The frames of all runs are compared: they must have the same bits.
"""
import argparse
import hashlib
import itertools
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

import record as results
from workloads import WORKLOADS, path_yaml, photograph


def call(*words):
    subprocess.run(list(map(str, words)), check=True, stdout=subprocess.DEVNULL)


def digest(folder):
    """of all frames: their pixels' files, whoever wrote them when"""
    whole = hashlib.sha256()
    for frame in sorted(folder.glob("frame_*")):
        whole.update(hashlib.sha256(frame.read_bytes()).digest())
    return whole.hexdigest()


def render(build, inputs, out, *options):
    for report in out.glob("report*.json"):  # of the run before, which is told otherwise
        report.unlink()
    start = time.monotonic()
    call(build / "bin/lfrenderer", *inputs, "-o", out, "-q", "--no-contact-sheet", *options)
    return time.monotonic() - start


def measure_packages(build, field, folder, size, count, balance, runs):
    """estimated rays, frames and the median seconds of each package"""
    path = folder / "long.yaml"
    path.write_text(path_yaml(WORKLOADS["long"], size))
    packages = folder / f"packages-{balance}"
    call(build / "bin/lfpreprocessor", field, path, "-o", packages, "-q", "--packages", count,
         "--balance", balance)
    plan = json.loads(subprocess.run(
        [build / "bin/lfpreprocessor", field, path, "--plan", "-q", "--json", "--packages",
         str(count), "--balance", balance], check=True, capture_output=True).stdout)
    files = sorted(packages.glob("*.lfp"))
    seconds = [[] for _ in files]
    for run in range(runs):
        for i, file in enumerate(files):
            seconds[i].append(render(build, [file], folder / f"parts-{balance}"))
    whole = folder / "whole"
    if not whole.exists():
        render(build, [field, path], whole)
    if digest(whole) != digest(folder / f"parts-{balance}"):
        raise SystemExit("packages give other frames than the whole film")
    return {"balance": balance,
            "frames": [len(package["frames"]) for package in plan["packages"]],
            "rays": [package["rays"] for package in plan["packages"]],
            "forecast_cpu_s": [package["cpu_s"] for package in plan["packages"]],
            "seconds": [round(statistics.median(times), 3) for times in seconds]}


def measure_rectangles(build, field, folder, size, runs):
    path = folder / "short.yaml"
    rows = []
    for estimator, focal_mm in itertools.product(("nearest", "bilinear"), (36, 72)):
        path.write_text(path_yaml(WORKLOADS["short"], size, focal_mm))
        seconds, frames, collect = {"on": [], "off": []}, {}, {}
        for _ in range(runs):
            for choice in seconds:
                out = folder / f"short-{choice}"
                seconds[choice].append(render(build, [field, path], out, "--rectangles", choice,
                                              "--estimator", estimator, "--lens-weights", "none"))
                frames[choice] = digest(out)
                report = json.loads((out / "report.json").read_text())
                collect[choice] = {key: report[key] for key in
                                   ("lf_images_selected", "load_cpu_s", "collect_cpu_s",
                                    "rays_tested")}
        if frames["on"] != frames["off"]:
            raise SystemExit("frames differ without rectangles")
        rows.append({"estimator": estimator, "focal_mm": focal_mm, **{
            choice: {"seconds": round(statistics.median(seconds[choice]), 3), **collect[choice]}
            for choice in seconds}})
    return rows


def table(record):
    lines = ["| `long`, balanced by | frames | estimated rays, M | largest / mean | seconds alone | longest / "
             "mean | shortest / longest |", "|" + " --- |" * 7]
    for row in record["packages"]:
        mean = lambda values: sum(values) / len(values)
        lines.append(
            f"| {row['balance']} | {', '.join(map(str, row['frames']))} | "
            f"{', '.join(f'{rays / 1e6:.0f}' for rays in row['rays'])} | "
            f"{max(row['rays']) / mean(row['rays']):.3f} | "
            f"{', '.join(f'{s:.2f}' for s in row['seconds'])} | "
            f"{max(row['seconds']) / mean(row['seconds']):.2f} | "
            f"{min(row['seconds']) / max(row['seconds']):.2f} |")
    lines += ["", "| `short`, estimator | focal length | rectangles | LF images | Mpx tried | seconds | CPU s: decoding, "
              "collecting |", "|" + " --- |" * 7]
    for row in record["rectangles"]:
        for choice in ("on", "off"):
            part = row[choice]
            lines.append(
                f"| {row['estimator']} | {row['focal_mm']} mm | {choice} | {part['lf_images_selected']} | "
                f"{part['rays_tested'] / 1e6:.0f} | {part['seconds']:.2f} | "
                f"{part['load_cpu_s']:.2f}, {part['collect_cpu_s']:.2f} |")
        lines.append(f"| {row['estimator']} | {row['focal_mm']} mm | off / on | | | "
                     f"{row['off']['seconds'] / row['on']['seconds']:.2f} | |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=0.03)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--runs", type=int, default=5)
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
                measure_packages(build, field, folder, size, arguments.packages, balance,
                                 arguments.runs) for balance in ("rays", "frames")]
            record["rectangles"] = measure_rectangles(build, field, folder, size, arguments.runs)
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record) + f" LF images {record['size']}, frames half as large, "
                      f"{record['density']:g} of the thesis's LF cameras, medians of {record['runs']} runs.",
                      ""] + table(record)) + "\n"
    results.publish(arguments, "packages.py", record, text)


if __name__ == "__main__":
    main()
