#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Times whole renders: the five camera movements of Table 5.1 of the thesis, thinned out.

usage: bench/workloads.py BUILD_DIR [--density 0.03] [--size 480x320] [--runs 3] [--most-seconds 15]
                          [--threads 1,2] [--only stack,short] [--field DIR] [--name NAME] [--write PAGE]
       bench/workloads.py --again JSON [--write PAGE]

Lengths, times, frames, apertures and focus distances are those of the thesis; only a share of its LF cameras exists
(--density). LF images have the size --size, frames half of it, so that an element gets as many rays as from four times
as many LF cameras. lfsynth photographs a planar grid of noisy raw Bayer mosaics. Each path sweeps over an area that
contains as many LF cameras as it needs in the thesis, times the density. The grid is a square, whereas the thesis had a
band, so long paths wind.

Each workload is rendered in three ways: as the thesis does (nearest, without lens weights), by plain
interpolation (bilinear, without lens weights), and by the defaults. Ways and numbers of threads take turns, so
that a busy machine disturbs all alike; each is repeated up to `runs` times, but not beyond --most-seconds.
Seconds and peak memory are those of the whole program, CPU seconds those of the last run, ns/ray is collection alone.

--field DIR  folder of the light field, which is kept; an existing one is used again
"""
import argparse
import json
import math
import pathlib
import statistics
import sys
import tempfile
import types

import record as results

PER_MM2 = 66    # LF cameras: 827 within a disk of 4 mm (stack)
DISTANCE_M = 1  # distance from the grid to the middle of the scene
FPS = 30

# Ways of rendering. Each states every choice; the defaults are measured beside them.
WAYS = {
    "nearest": ("--mode", "collect", "--estimator", "nearest", "--lens-weights", "none"),
    "bilinear": ("--mode", "collect", "--estimator", "bilinear", "--filter", "bilinear", "--lens-weights", "none"),
    "default": (),
}

# Table 5.1. focus: metres, from the first frame to the last; a changing aperture opens and closes every ten seconds.
WORKLOADS = {
    "stack": dict(frames=30, aperture_mm=(4, 4), focus_m=(0.2, 1), images=827),
    "short": dict(frames=60, aperture_mm=(4, 4), focus_m=(0.5, 0.1), images=5621),
    "sharp": dict(frames=30, aperture_mm=(2, 2), focus_m=(0.8, 0.8), images=1914),
    "long": dict(frames=480, aperture_mm=(2, 2), focus_m=(0.15, 1), images=27173),
    "bokeh": dict(frames=900, aperture_mm=(0.1, 2), focus_m=(0.15, 1), images=67502),
}


def straight_length_mm(workload):
    """Returns the length of a straight path whose lens sweeps over the workload's LF images."""
    narrow, wide = workload["aperture_mm"]
    area_mm2 = workload["images"] / PER_MM2
    return max(0, area_mm2 - math.pi / 4 * wide ** 2) / ((narrow + wide) / 2)


# Side of the square grid: bokeh winds over all of it, in lines as far apart as its lens is wide.
SIDE_MM = math.sqrt(straight_length_mm(WORKLOADS["bokeh"]) * WORKLOADS["bokeh"]["aperture_mm"][1])


def winding_path(workload):
    """Returns points (x, y) in mm: a straight line in the middle of the grid, or many lines from its upper left."""
    wide = workload["aperture_mm"][1]
    left = straight_length_mm(workload)
    reach = (SIDE_MM - wide) / 2
    if left <= 2 * reach:
        return [(-left / 2, 0), (left / 2, 0)]
    x, y, direction = -reach, -reach, 1
    points = [(x, y)]
    while left > 0:
        x += direction * min(left, 2 * reach)
        left -= 2 * reach
        points.append((x, y))
        if left <= 0 or y + wide > reach:
            return points
        y += wide
        left -= wide
        points.append((x, y))
        direction = -direction
    return points


def keys(times, values):
    return "[" + ", ".join(f"{{time: {t:.6f}, value: {v}, interpolation: linear}}"
                           for t, v in zip(times, values)) + "]"


def path_yaml(workload, size, focal_mm=36):
    """Returns the camera path. workload["frames_share"], if given, keeps only this share of the frames: the camera
    moves along the same way in the same time, with fewer frames per second."""
    seconds = (workload["frames"] - 1) / FPS
    frames = max(2, round(workload["frames"] * workload.get("frames_share", 1)))
    fps = (frames - 1) / seconds
    points = winding_path(workload)
    (x, y), (near, far), (narrow, wide) = points[0], workload["focus_m"], workload["aperture_mm"]
    moves = {}
    lengths = [0]
    for a, b in zip(points, points[1:]):
        lengths.append(lengths[-1] + math.dist(a, b))
    if lengths[-1] > 0:
        moves["position"] = keys([seconds * length / lengths[-1] for length in lengths],
                                 [f"[{a / 1000:.6f}, {b / 1000:.6f}, {-DISTANCE_M}]"
                                  for a, b in points])
    if near != far:
        moves["focus_distance"] = keys([0, seconds], [near, far])
    if narrow != wide:
        times = range(0, math.ceil(seconds) + 5, 5)
        moves["aperture_diameter_mm"] = keys(times, [(narrow, wide)[i % 2] for i in range(len(times))])
    movement = "keyframes:\n" + "".join(f"  {key}: {value}\n" for key, value in moves.items())
    return f"""format: lfpath 1
fps: {fps:.6f}
frames: {frames}
resolution: [{size[0]}, {size[1]}]
camera:
  sensor_width_mm: 36
  focal_length_mm: {focal_mm}
  position: [{x / 1000:.6f}, {y / 1000:.6f}, {-DISTANCE_M}]
  look_at: [{x / 1000:.6f}, {y / 1000:.6f}, 0]
  follow: direction
lens:
  aperture_diameter_mm: {narrow}
  focus_distance: {near}
{movement if moves else ''}"""


def photograph(build, field, density, size, *options):
    """Makes the light field, unless it exists."""
    if (field / "transforms.json").exists():
        return
    spacing_m = 0.001 / math.sqrt(density * PER_MM2)
    count = round(SIDE_MM ** 2 * PER_MM2 * density)
    results.call([build / "bin/lfsynth", "chart", "-o", field, "--count", count, "--size", size, "--spacing",
                  f"{spacing_m:.8f}", "--distance", DISTANCE_M, "--bayer", "--noise", "0.01", "--samples", "1", "-q",
                  *options])


def render(build, field, path, out, threads, *options):
    """Renders once. Returns seconds, use of resources, and the report."""
    used = results.timed([build / "bin/lfrenderer", field, path, "-o", out, "--threads", threads, "-q",
                          "--no-contact-sheet", *options])
    usage = types.SimpleNamespace(ru_utime=used["cpu_s"], ru_stime=0.0, ru_maxrss=used["peak_bytes"] // 1024)
    return used["seconds"], usage, json.loads((out / "report.json").read_text())


def measure(build, field, folder, name, size, runs, most_s, threads):
    """Returns the rows of one workload, one for each way and number of threads."""
    path = folder / f"{name}.yaml"
    path.write_text(path_yaml(WORKLOADS[name], size))
    rows = [{"workload": name, "way": way, "threads": n, "seconds": [], "peak_bytes": 0}
            for way in WAYS for n in threads]
    for _ in range(runs):
        for row in rows:
            done = row["seconds"]
            if done and sum(done) * (len(done) + 1) / len(done) > most_s:
                continue
            seconds, usage, report = render(build, field, path, folder / "out", row["threads"], *WAYS[row["way"]])
            row["seconds"].append(round(seconds, 3))
            row["peak_bytes"] = max(row["peak_bytes"], usage.ru_maxrss * 1024)
            row["cpu_s"] = round(usage.ru_utime + usage.ru_stime, 3)
            for key in ("lf_images_selected", "rays_accepted", "load_cpu_s", "collect_cpu_s"):
                row[key] = report[key]
            print(f"{name}, {row['way']}, {row['threads']} threads: {seconds:.2f} s", file=sys.stderr, flush=True)
    return rows


def table(record):
    lines = ["| workload | way | frames | LF images (aim) | Grays | threads | runs | seconds: min, median, max | "
             "CPU s: decoding, collecting, rest | ns/ray | peak MiB |", "|" + " --- |" * 11]
    for row in record["rows"]:
        workload, seconds = WORKLOADS[row["workload"]], row["seconds"]
        load, collect = row["load_cpu_s"], row["collect_cpu_s"]
        lines.append(
            f"| {row['workload']} | {row['way']} | {workload['frames']} | {row['lf_images_selected']} "
            f"({workload['images'] * record['density']:.0f}) | {row['rays_accepted'] / 1e9:.2f} | "
            f"{row['threads']} | {len(seconds)} | {min(seconds):.2f}, {statistics.median(seconds):.2f}, "
            f"{max(seconds):.2f} | {load:.2f}, {collect:.2f}, {row['cpu_s'] - load - collect:.2f} | "
            f"{collect / row['rays_accepted'] * 1e9:.2f} | {row['peak_bytes'] >> 20} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=0.03)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--most-seconds", type=float, default=15, metavar="S",
                        help="not a further run of a way beyond this")
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--only", default=",".join(WORKLOADS))
    parser.add_argument("--field", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        build = arguments.build.resolve()
        size = [int(length) // 2 for length in arguments.size.split("x")]
        record = results.context()
        record.update(density=arguments.density, size=arguments.size, runs=arguments.runs, rows=[])
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            field = arguments.field or folder / "field"
            photograph(build, field, arguments.density, arguments.size)
            for name in arguments.only.split(","):
                record["rows"] += measure(build, field, folder, name, size, arguments.runs,
                                          arguments.most_seconds, list(map(int, arguments.threads.split(","))))
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record) + f" LF images {record['size']}, frames half "
                      f"as large, {record['density']:g} of the thesis's LF cameras.", ""] +
                     table(record)) + "\n"
    results.publish(arguments, "workloads.py", record, text)


if __name__ == "__main__":
    main()
