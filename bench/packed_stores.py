#!/usr/bin/python3
"""What rendering from a packed store costs beside rendering from pixels in memory.

usage: bench/packed_stores.py BUILD_DIR [--count 64] [--size 1024x1024] [--runs 5] [--write PAGE]

The movement `stack` of Table 5.1 (30 frames), from noisy RGGB mosaics of lfsynth, as they are (16 bits) and with 8
bits: as uncompressed TIFF files in memory (/dev/shm), which are as good as decoded, as packed stores without loss and
with the default's, and as PNG files. Renders take turns; medians of their seconds and of the CPU seconds that went into
loading.
"""
import argparse
import json
import pathlib
import shutil
import statistics
import subprocess
import tempfile

import cv2

import record as results
from workloads import WORKLOADS, path_yaml


def rewritten(field, folder, shift, extension, options):
    """the light field with other image files"""
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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=64, help="LF images")
    parser.add_argument("--size", default="1024x1024")
    parser.add_argument("--runs", type=int, default=5)
    results.add_options(parser)
    arguments = parser.parse_args()
    programs = arguments.build.resolve() / "bin"
    size = [int(length) // 2 for length in arguments.size.split("x")]
    lines = ["| bits | LF images | MB | seconds | / in memory | CPU s loading | of all CPU s |", "|" + " --- |" * 7]
    with tempfile.TemporaryDirectory() as temporary, tempfile.TemporaryDirectory(dir="/dev/shm") as memory:
        folder, memory = pathlib.Path(temporary), pathlib.Path(memory)
        field = folder / "field"
        # The lens of 4 mm sees nearly all of them.
        subprocess.run([programs / "lfsynth", "chart", "-o", field, "--count", str(arguments.count), "--size",
                        arguments.size, "--spacing", f"{0.0035 / arguments.count ** 0.5:.6f}", "--distance", "1",
                        "--bayer", "--noise", "0.01", "--samples", "1", "-q"], check=True)
        path = folder / "stack.yaml"
        path.write_text(path_yaml(WORKLOADS["stack"], size))
        for bits in (8, 16):
            png = rewritten(field, folder / "png", bits == 8, "png", [cv2.IMWRITE_PNG_COMPRESSION, 6])
            kinds = {"in memory": rewritten(field, memory / "tiff", bits == 8, "tiff", [cv2.IMWRITE_TIFF_COMPRESSION, 1])}
            for profile in ("lossless", "default"):
                store = folder / f"{profile}.lfs"
                subprocess.run([programs / "lfcompressor", png, "-o", store, "--profile", profile, "--overwrite", "-q",
                                "--progress", "none"], check=True, stdout=subprocess.DEVNULL)
                kinds[f"store, {profile}"] = store
            kinds["PNG files"] = png
            seconds, loading, shares = ({kind: [] for kind in kinds} for _ in range(3))
            for _ in range(arguments.runs):
                for kind, light_field in kinds.items():
                    out = folder / "out"
                    shutil.rmtree(out, ignore_errors=True)
                    subprocess.run([programs / "lfrenderer", light_field, path, "-o", out, "-q", "--no-contact-sheet"],
                                   check=True)
                    report = json.loads((out / "report.json").read_text())
                    seconds[kind].append(report["seconds"])
                    loading[kind].append(report["load_cpu_s"])
                    shares[kind].append(report["load_cpu_s"] / (report["load_cpu_s"] + report["collect_cpu_s"]))
            for kind, light_field in kinds.items():
                files = light_field.glob("*") if light_field.is_dir() else [light_field]
                ratio = statistics.median(a / b for a, b in zip(seconds[kind], seconds["in memory"]))
                lines.append(f"| {bits} | {kind} | {sum(f.stat().st_size for f in files) / 1e6:.1f} | "
                             f"{statistics.median(seconds[kind]):.2f} | {ratio:.2f} | "
                             f"{statistics.median(loading[kind]):.2f} | {statistics.median(shares[kind]):.0%} |")
    record = results.context()
    results.publish(arguments, "packed_stores.py", record, results.sentence(record) + "\n\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
