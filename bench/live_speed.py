#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures live pictures of lfvisualizer: how soon they come, how many LF images they are made of, and how fast.

usage: bench/live_speed.py BUILD_DIR [--data ../shared] [--only shop,beer,many] [--count 256] [--pictures 60]
                           [--cameras 100000] [--name NAME] [--write doc/visualizer.md]
       bench/live_speed.py --again JSON [--write doc/visualizer.md]

shop, beer  blender-shop and beer-colmap (photographs), with memory for --count LF images
many        as many LF cameras as --cameras says, with image files of 64 x 48 pixels, which are links to a thousand
            files of lfsynth, and the default memory

Pictures have 480 x 270 elements. First all LF images for which there is room are loaded, while quick pictures are asked
for. Then the focus is dragged twice, for --pictures pictures one after the other: first each has a budget of 40 ms,
then each is made of all LF images in memory. Times are those of a client on the same machine, answer included.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import tempfile
import time

import record as results
from live_pictures import LiveServer

WIDTH, BUDGET_MS = 480, 40
FILES_OF_MANY = 1000
# Case -> its title, the focus distance, and the diameter of the lens in world units.
CASES = {"shop": ("blender-shop", 8.12, 0.8), "beer": ("beer-colmap", 4.1, 5), "many": ("still-life", 0.8, 0.55)}


def many_cameras(build, folder, count):
    """Makes a light field of many small image files. Returns its folder."""
    small, field = folder / "small", folder / "many"
    options = ["--size", "64x48", "--samples", "1", "--format", "png", "--spacing", "0.002", "-q"]
    results.call([build / "bin/lfsynth", "still-life", "-o", small, "--count", FILES_OF_MANY, *options])
    results.call([build / "bin/lfsynth", "still-life", "-o", field, "--count", count, *options, "--calibration-only"])
    (field / "images").mkdir()
    files = sorted((small / "images").iterdir())
    for i, frame in enumerate(json.loads((field / "transforms.json").read_text())["frames"]):
        os.link(files[i % len(files)], field / frame["file_path"])
    return field


def path_of(build, field, folder, focus, aperture):
    """Returns the text of a path: the frame of lfexample, with another size, focus and aperture."""
    path = folder / "example.yaml"
    results.call([build / "bin/lfexample", field, "-o", path, "--move", "static", "--focus", focus, "-q"])
    text = path.read_text()
    path.unlink()
    text = re.sub(r"resolution: \[.*?\]", "resolution: [480, 270]", text)
    text = re.sub(r"aperture_diameter: \S+", f"aperture_diameter: {aperture}", text)
    return re.sub(r"focus_distance: \S+", f"focus_distance: {focus}", text)


def drag(server, text, focus, count, budget_ms):
    """Drags the focus. Returns the times of the pictures in ms, and the numbers of their LF images."""
    times, images = [], []
    for i in range(count):
        dragged = text.replace(f"focus_distance: {focus}", f"focus_distance: {focus * (1 + 0.3 * i / count)}")
        begin = time.monotonic()
        facts, _ = server.ask(dragged, WIDTH, budget_ms)
        times.append(1000 * (time.monotonic() - begin))
        images.append(facts["images"])
    return {"median_ms": statistics.median(times), "most_ms": sorted(times)[int(0.95 * len(times))],
            "least_images": min(images), "most_images": max(images), "per_second": 1000 * count / sum(times)}


def image_bytes(command, text):
    with LiveServer(*command) as server:
        while not (facts := server.ask(text, WIDTH, 1)[0])["image_bytes"]:
            time.sleep(0.05)
    return facts["image_bytes"]


def measure(build, field, case, options, folder):
    title, focus, aperture = CASES[case]
    text = path_of(build, field, folder, focus, aperture)
    path = folder / f"{case}.yaml"
    path.write_text(text)
    command = [build / "bin/lfvisualizer", field, path, "-q"]
    if case != "many":
        command += ["--live-memory", options.count * image_bytes(command, text)]
    with LiveServer(*command) as server:
        row = {"case": case, "title": title, "start_s": server.seconds()}
        while not server.ask(text, WIDTH, BUDGET_MS)[0]["images"]:
            pass
        row["first_s"] = server.seconds()
        facts = server.load_all(text, WIDTH)
        row |= {"loaded_s": server.seconds(), "facts": facts,
                "quick": drag(server, text, focus, options.pictures, BUDGET_MS),
                "still": drag(server, text, focus, max(5, options.pictures // 6) if case == "many" else
                              options.pictures, None), "peak_mib": server.peak_mib()}
    return row


def table(record):
    lines = ["| capture | LF images in memory | first picture | all in memory | LF images within 40 ms | "
             "pictures per second | 95 % take at most | picture of all LF images | 95 % take at most | "
             "largest memory |", "|" + " --- |" * 10]
    for row in record["rows"]:
        facts, quick, still = row["facts"], row["quick"], row["still"]
        count = f"{facts['resident']:,} of {facts['needed']:,}".replace(",", " ")
        lines.append(f"| {row['title']} | {count} | {row['first_s']:.2f} s | {row['loaded_s']:.1f} s | "
                     f"{quick['least_images']} to {quick['most_images']} | {quick['per_second']:.1f} | "
                     f"{quick['most_ms']:.0f} ms | {still['median_ms']:.0f} ms | {still['most_ms']:.0f} ms | "
                     f"{row['peak_mib']:.0f} MiB |")
    return results.sentence(record) + "\n\n" + "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    parser.add_argument("--only", default=",".join(CASES))
    parser.add_argument("--count", type=int, default=256)
    parser.add_argument("--pictures", type=int, default=60)
    parser.add_argument("--cameras", type=int, default=100_000)
    results.add_options(parser)
    options = parser.parse_args()
    if options.again:
        record = json.loads(options.again.read_text())
    elif options.build:
        build, data = options.build.resolve(), options.data.resolve() / "data"
        record = results.context() | {"rows": []}
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            for case in options.only.split(","):
                field = {"shop": data / "blender-shop/images", "beer": data / "beer-colmap"}.get(case)
                record["rows"].append(measure(build, field or many_cameras(build, folder, options.cameras), case,
                                              options, folder))
    else:
        parser.error("BUILD_DIR or --again is needed")
    results.publish(options, "live_speed.py", record, table(record))


if __name__ == "__main__":
    main()
