#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what `lfcompressor --quality-by-use` saves, and how well it predicts the errors of frames, and makes the
table of doc/codec.md.

usage: quality_by_use.py BIN SHARED [--only CAPTURE,...] [--films FILM,...] [--write doc/codec.md]
       quality_by_use.py --again JSON [--write doc/codec.md]

BIN      folder of lfrenderer, lfpreprocessor, lfcompressor, lfimport and lfsynth
SHARED   folder with groundtruth/ (as for quality.py) and data/blender-shop

Each capture is filmed by moving lenses, whose diameters and ways are given in distances between its LF cameras. The
packages of a film are compressed at several thresholds, uniformly and by use, without keeping image files. The frames
that lfrenderer makes of these stores are compared with those that it makes of the image files, in sRGB with the peak
1: PSNR of the mean squared error of all frames, and of the worst frame. Bytes at equal PSNR, and PSNR at equal bytes,
are interpolated between thresholds, and are means over the range that both ways have. `planar` and `still-life` were
used to choose the constant of the prediction; `shop` reports.
"""
import argparse
import json
import pathlib
import shutil
import sys

import numpy as np

import densify_captures as captures
import lens_weights
import quality
from quality import results

THRESHOLDS = (2, 5, 12)
DEFAULT = "--mode collect --estimator bilinear --filter auto --lens-weights auto".split()
FRAMES = 8
# Name: diameters at the begin and the end, and places of the camera to the right and above.
FILMS = {
    "slide of 5": ((5, 5), [(-2.5 + 5 * k / (FRAMES - 1), 0) for k in range(FRAMES)]),
    "slow move of 9": ((9, 9), [(-1 + 2 * k / (FRAMES - 1), 0) for k in range(FRAMES)]),
    "closing from 9 to 3": ((9, 3), [(0, 0)] * FRAMES),
    "circle of 5": ((5, 5), [(2 * np.cos(2 * np.pi * k / FRAMES), 2 * np.sin(2 * np.pi * k / FRAMES))
                             for k in range(FRAMES)]),
}


def pitch_of(field):
    """Returns the median distance of LF cameras from their nearest neighbours."""
    places = np.array([frame["transform_matrix"] for frame in field["frames"]])[:, :3, 3]
    distances = np.linalg.norm(places[:, None] - places[None], axis=2)
    np.fill_diagonal(distances, np.inf)
    return float(np.median(distances.min(axis=1)))


def write_film(path, field, film, size, elements, focus):
    """Writes the path of a film whose middle is that of the LF cameras."""
    diameters, places = FILMS[film]
    pitch = pitch_of(field)
    captures.middle_path(field, path, size, elements, pitch * diameters[0], focus)
    pose = np.array(field["frames"][len(field["frames"]) // 2]["transform_matrix"])
    middle = np.mean([frame["transform_matrix"] for frame in field["frames"]], axis=0)[:3, 3]
    keys = [{"time": k / 25, "value": (middle + pitch * (x * pose[:3, 0] + y * pose[:3, 1])).tolist(),
             "interpolation": "linear"} for k, (x, y) in enumerate(places)]
    opening = [{"time": 0, "value": pitch * diameters[0]},
               {"time": (FRAMES - 1) / 25, "value": pitch * diameters[1], "interpolation": "linear"}]
    text = path.read_text().replace("frames: 1\n", f"frames: {FRAMES}\n").replace(
        "lens:\n", "  follow: direction\nlens:\n")
    path.write_text(f"{text}keyframes: {json.dumps({'position': keys, 'aperture_diameter': opening})}\n")
    return path


# Each returns (calibration, field, size of frames, focal length in elements, focus distance).
def still_life(bench):
    out = bench.folder / "still-life"
    results.call([bench.programs / "lfsynth", "still-life", "-q", "-o", out, "--format", "png", "--count", 196,
                  "--size", "480x320", "--spacing", 0.004])
    field = quality.read_field(out / "transforms.json")
    return out / "transforms.json", field, (480, 320), field["fl_x"], 0.8


def planar(bench):
    calibration = bench.shared / "groundtruth/data/planar/transforms.json"
    field = quality.read_field(calibration)
    return calibration, field, (320, 240), field["fl_x"], 0.2


def shop(bench):
    out = bench.folder / "shop"
    results.call([bench.programs / "lfimport", bench.shared / "data/blender-shop/images", "-o", out, "-q"])
    return out / "transforms.json", quality.read_field(out / "transforms.json"), (480, 320), 400, 6.3


CAPTURES = {"still-life": still_life, "planar": planar, "shop": shop}


class Bench:
    def __init__(self, programs, shared, folder):
        self.programs, self.shared, self.folder = programs, shared, folder

    def frames(self, packages, *options):
        """Returns the frames of the packages, in sRGB."""
        out = self.folder / "frames"
        results.call([self.programs / "lfrenderer", *packages, "-o", out, "--format", "exr-float", "-q",
                      "--no-contact-sheet", "--overwrite", *DEFAULT, *options])
        pictures = [quality.encoded(lens_weights.linear_exr(file)) for file in sorted(out.glob("frame_*.exr"))]
        shutil.rmtree(out)
        return pictures

    def packages(self, calibration, path):
        out = self.folder / "packages"
        shutil.rmtree(out, ignore_errors=True)
        results.call([self.programs / "lfpreprocessor", calibration, path, "-o", out, "-q"])
        return sorted(out.glob("*.lfp"))

    def store(self, packages, threshold, *options):
        """Returns the store and the report of lfcompressor."""
        store = self.folder / "film.lfs"
        report = results.call([self.programs / "lfcompressor", *packages, "-o", store, "--reencode", "--threshold",
                               threshold, "--overwrite", "--json", "-q", *options])
        return store, json.loads(report)


def decibels(error):
    return float(-10 * np.log10(error))


def measure(bench, names, films):
    rows = []
    for name in names:
        calibration, field, *lens = CAPTURES[name](bench)
        for film in films:
            packages = bench.packages(calibration, write_film(bench.folder / "film.yaml", field, film, *lens))
            exact = bench.frames(packages)
            for way, options in ("uniform", ()), ("by use", ("--quality-by-use",)):
                for threshold in THRESHOLDS:
                    store, report = bench.store(packages, threshold, *options)
                    errors = [float(np.mean((a - b) ** 2)) for a, b in
                              zip(exact, bench.frames(packages, "--lightfield", store))]
                    row = {"capture": name, "film": film, "way": way, "threshold": threshold,
                           "lf_images": report["lf_images"], "bytes": report["code_bytes"],
                           "images_db": report["psnr_db"], "mean_db": decibels(np.mean(errors)),
                           "worst_db": decibels(max(errors)), "frames_db": [decibels(e) for e in errors]}
                    if "frames" in report:
                        row |= {"predicted_db": report["frames"]["psnr_db"],
                                "predicted_worst_db": report["frames"]["worst_psnr_db"]}
                    rows.append(row)
                    print(name, film, way, threshold, file=sys.stderr, flush=True)
    return rows


def gains(rows, key):
    """Returns by how many decibels of `key` the second way is better at equal bytes, and the ratio of its bytes at
    equal decibels."""
    curves = {}
    for row in rows:
        curves.setdefault(row["way"], []).append((np.log(row["bytes"]), row[key]))
    uniform, by_use = (np.array(sorted(curves[way])).T for way in ("uniform", "by use"))

    def difference(of, to):
        """Returns the mean of to's values minus those of `of`, over the arguments that both have."""
        at = np.linspace(max(of[0][0], to[0][0]), min(of[0][-1], to[0][-1]), 50)
        return float(np.mean(np.interp(at, *to) - np.interp(at, *of)))
    return difference(uniform, by_use), float(np.exp(difference(uniform[::-1], by_use[::-1])))


def table(record):
    lines = ["| capture | film | LF images | bytes at equal mean dB | at equal worst dB | mean dB at equal bytes "
             "| worst dB at equal bytes | predicted − measured, dB |", "|" + " --- |" * 8]
    groups = {}
    for row in record["rows"]:
        groups.setdefault((row["capture"], row["film"]), []).append(row)
    for (capture, film), rows in groups.items():
        (mean_db, mean_bytes), (worst_db, worst_bytes) = gains(rows, "mean_db"), gains(rows, "worst_db")
        off = [row["predicted_db"] - row["mean_db"] for row in rows if "predicted_db" in row]
        lines.append(f"| {capture} | {film} | {rows[0]['lf_images']} | {100 * mean_bytes - 100:+.0f} % | "
                     f"{100 * worst_bytes - 100:+.0f} % | {mean_db:+.2f} | {worst_db:+.2f} | {min(off):+.1f} to "
                     f"{max(off):+.1f} |".replace("-", "−").replace("still−life", "still-life"))
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", default=",".join(CAPTURES), help="captures, with commas between")
    parser.add_argument("--films", default=",".join(FILMS), help="films, with commas between")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.shared, lambda folder: {
        "rows": measure(Bench(arguments.programs.resolve(), arguments.shared.resolve(), folder),
                        arguments.only.split(","), arguments.films.split(","))}, "BIN SHARED")
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "quality/quality_by_use.py", record, text)


if __name__ == "__main__":
    main()
