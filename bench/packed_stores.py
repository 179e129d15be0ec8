#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what rendering from a packed store costs, compared with rendering from pixels in memory.

usage: bench/packed_stores.py BUILD_DIR [--count 64] [--size 1024x1024] [--runs 3] [--name NAME] [--write PAGE]
       bench/packed_stores.py --again JSON [--write PAGE]

The movement `stack` of Table 5.1 (30 frames) is rendered from noisy RGGB mosaics of lfsynth, with 16 bits (as lfsynth
writes them) and with 8 bits. They are stored as uncompressed TIFF files in memory (/dev/shm), which are almost as fast
as decoded pixels; as packed stores of the profiles lossless and default; and as PNG files. Each is rendered as in the
thesis (nearest, without lens weights) and by the defaults. Renders take turns. Figures are medians of the seconds, and
of the CPU seconds of loading.
"""
import argparse
import json
import pathlib
import shutil
import statistics
import tempfile

import cv2

import record as results
from workloads import WAYS, WORKLOADS, path_yaml

RENDERED = ("nearest", "default")


def rewritten(field, folder, shift, extension, options):
    """Returns the light field with other image files."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    calibration = json.loads((field / "transforms.json").read_text())
    for i, frame in enumerate(calibration["frames"]):
        picture = cv2.imread(str(field / frame["file_path"]), cv2.IMREAD_UNCHANGED)
        frame["file_path"] = f"{i}.{extension}"
        cv2.imwrite(str(folder / frame["file_path"]), (picture >> 8).astype("uint8") if shift else picture, options)
    for key in ("lf_black_level", "lf_white_level"):
        if shift and key in calibration:
            calibration[key] = calibration[key] // 256
    (folder / "transforms.json").write_text(json.dumps(calibration))
    return folder


def stores_of(programs, folder, memory, field, bits):
    """Returns {kind: light field} for one number of bits."""
    png = rewritten(field, folder / "png", bits == 8, "png", [cv2.IMWRITE_PNG_COMPRESSION, 6])
    kinds = {"in memory": rewritten(field, memory / "tiff", bits == 8, "tiff", [cv2.IMWRITE_TIFF_COMPRESSION, 1])}
    for profile in ("lossless", "default"):
        store = folder / f"{profile}.lfs"
        results.call([programs / "lfcompressor", png, "-o", store, "--profile", profile, "--reencode", "--overwrite",
                      "-q", "--progress", "none"])
        kinds[f"store, {profile}"] = store
    kinds["PNG files"] = png
    return kinds


def measure(programs, folder, kinds, path, way, runs):
    """Returns {kind: measurements of each run}."""
    taken = {kind: [] for kind in kinds}
    for _ in range(runs):
        for kind, light_field in kinds.items():
            out = folder / "out"
            shutil.rmtree(out, ignore_errors=True)
            results.call([programs / "lfrenderer", light_field, path, "-o", out, "-q",
                          "--no-contact-sheet", *WAYS[way]])
            report = json.loads((out / "report.json").read_text())
            taken[kind].append({key: report[key] for key in ("seconds", "load_cpu_s", "collect_cpu_s")})
    return taken


def rows_of(arguments, folder, memory):
    programs = arguments.build.resolve() / "bin"
    field, path = folder / "field", folder / "stack.yaml"
    # The lens of 4 mm sees nearly all LF cameras.
    results.call([programs / "lfsynth", "chart", "-o", field, "--count", arguments.count, "--size", arguments.size,
                  "--spacing", f"{0.0035 / arguments.count ** 0.5:.6f}", "--distance", 1, "--bayer", "--noise", "0.01",
                  "--samples", 1, "-q"])
    path.write_text(path_yaml(WORKLOADS["stack"], [int(length) // 2 for length in arguments.size.split("x")]))
    rows = []
    for bits in (8, 16):
        kinds = stores_of(programs, folder, memory, field, bits)
        for way in RENDERED:
            taken = measure(programs, folder, kinds, path, way, arguments.runs)
            for kind, light_field in kinds.items():
                files = light_field.glob("*") if light_field.is_dir() else [light_field]
                rows.append({"bits": bits, "way": way, "kind": kind, "runs": taken[kind],
                             "bytes": sum(file.stat().st_size for file in files)})
    return rows


def table(record):
    lines = ["| bits | way | LF images | MB | seconds | / in memory | CPU s loading | of all CPU s |",
             "|" + " --- |" * 8]
    for row in record["rows"]:
        base = next(other for other in record["rows"] if other["kind"] == "in memory" and
                    (other["bits"], other["way"]) == (row["bits"], row["way"]))
        median = lambda values: statistics.median(list(values))
        ratio = median(a["seconds"] / b["seconds"] for a, b in zip(row["runs"], base["runs"]))
        share = median(run["load_cpu_s"] / (run["load_cpu_s"] + run["collect_cpu_s"]) for run in row["runs"])
        lines.append(f"| {row['bits']} | {row['way']} | {row['kind']} | {row['bytes'] / 1e6:.1f} | "
                     f"{median(run['seconds'] for run in row['runs']):.2f} | {ratio:.2f} | "
                     f"{median(run['load_cpu_s'] for run in row['runs']):.2f} | {share:.0%} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--count", type=int, default=64, help="LF images")
    parser.add_argument("--size", default="1024x1024")
    parser.add_argument("--runs", type=int, default=3)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        record = results.context()
        with tempfile.TemporaryDirectory() as temporary, tempfile.TemporaryDirectory(dir="/dev/shm") as memory:
            record["rows"] = rows_of(arguments, pathlib.Path(temporary), pathlib.Path(memory))
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "packed_stores.py", record, text)


if __name__ == "__main__":
    main()
