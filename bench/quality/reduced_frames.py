#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what frames lose whose elements are two or more LF pixels wide if their LF images are loaded reduced.

usage: reduced_frames.py BUILD_DIR SHARED [--only CAPTURE,...] [--write doc/codec.md]
       reduced_frames.py --again JSON [--write doc/codec.md]

SHARED   folder with groundtruth/ (as for quality.py) and data/blender-shop

A frame is rendered of whole LF images, and of a light field of LF images that are reduced to 1/2, 1/4 and 1/8: as
means of squares of light, as means of squares of stored values, as a lossless packed store loads them, and, if they are
JPEG files, as these are loaded. Figures are the PSNR of sRGB values against the picture of a true lens, if there is
one, and against the frame of whole LF images. Frames are rendered by the defaults. The reduced LF images are written as
PNG files of 16 bits.
"""
import argparse
import json
import pathlib
import shutil
import sys

import cv2
import numpy as np

import densify_captures as captures
import lens_weights
import order_quality
import quality
from quality import results

WIDTHS = (2, 3, 4, 8)  # of an element, in LF pixels
REDUCTIONS = (2, 4, 8)
DEFAULT = order_quality.WEIGHTS["default"].split()


def means_of(light, side):
    """Returns the means of squares of side x side pixels; those that fill no square are left out."""
    height, width = light.shape[0] // side, light.shape[1] // side
    return light[:height * side, :width * side].reshape(height, side, width, side, 3).mean((1, 3))


def decibels(picture, truth):
    return float(-10 * np.log10(np.mean((quality.encoded(picture) - quality.encoded(truth)) ** 2)))


class Frame:
    """A camera and its lens: path(width) writes a path, truth(width) returns the true picture or None."""

    def __init__(self, name, path, truth=lambda width: None):
        self.name, self.path, self.truth = name, path, truth


def ground_truth(name, *cases):
    def make(bench):
        folder = bench.shared / "groundtruth"

        def frame(case_name):
            case = captures.case_of(folder, case_name)
            whole = lens_weights.linear_pfm(folder / case["linear"])

            def sizes(width):  # elements of a frame in the middle of the true picture
                return [size // width - (size // width * width - size) % 2 for size in (case["w"], case["h"])]

            def path(width):
                elements = sizes(width)
                fov_deg = float(2 * np.degrees(np.arctan(elements[0] * width / 2 / case["fl_x"])))
                file = bench.folder / f"{case_name}_{width}.yaml"
                file.write_text(quality.path_yaml(case | {"w": elements[0], "h": elements[1], "fov_x_deg": fov_deg}))
                return file

            def truth(width):
                columns, rows = (count * width for count in sizes(width))
                x, y = (case["w"] - columns) // 2, (case["h"] - rows) // 2
                return means_of(whole[y:y + rows, x:x + columns], width)
            return Frame(case_name.partition("_")[2], path, truth)
        return folder / f"data/{name}/transforms.json", [frame(case) for case in cases]
    return make


def shop(bench):
    calibration, _ = order_quality.shop(bench)
    field = quality.read_field(calibration)
    field["frames"] = captures.square(field["frames"], range(7, 20))  # those around the lenses
    calibration = bench.written("middle", field)

    def frame(diameter, focus):
        def path(width):
            elements = [field[side] // width for side in "wh"]
            return captures.middle_path(field, bench.folder / f"shop_{focus}_{width}.yaml", elements,
                                        field["fl_x"] / width, diameter, focus)
        return Frame(f"focus {focus}", path)
    return calibration, [frame(0.24, 6.3), frame(0.3, 8.12), frame(0.3, 3)]


CAPTURES = {"planar": ground_truth("planar", "planar_d4_f50", "planar_d8_f20"), "shop": shop}


def opened(bench, light_field):
    """Returns the light field in Python."""
    sys.path.insert(0, str(bench.build / "python"))
    import lfrendertools as lf  # the package of the build
    return lf.open(light_field)


def reduced_field(folder, field, side, light_of):
    """Writes the light field whose LF images are reduced.

    light_of  returns the reduced light of the LF image with a number and a file
    """
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    reduced = dict(field, frames=[], lf_transfer="sRGB")
    for key in ("camera_angle_x", "camera_angle_y"):
        reduced.pop(key, None)

    def shrink(facts):
        facts.update({key: facts[key] / side for key in ("fl_x", "fl_y", "cx", "cy") if key in facts})
        facts.update({key: facts[key] // side for key in "wh" if key in facts})
    shrink(reduced)
    for number, frame in enumerate(field["frames"]):
        frame = dict(frame)
        light = light_of(number, frame["file_path"])
        shrink(frame)
        frame["file_path"] = f"{number:04}.png"
        cv2.imwrite(str(folder / frame["file_path"]),
                    np.rint(65535 * quality.encoded(light))[..., ::-1].astype(np.uint16),
                    [cv2.IMWRITE_PNG_COMPRESSION, 1])
        reduced["frames"].append(frame)
    (folder / "transforms.json").write_text(json.dumps(reduced))
    return folder / "transforms.json"


def lights_of(bench, calibration, field):
    """Returns {way to reduce: function of the number, the file and the side of a square}."""
    store = bench.folder / "lossless.lfs"
    results.call([bench.programs / "lfcompressor", calibration, "-o", store, "--profile", "lossless", "--reencode",
                  "--overwrite", "--progress", "none", "-q"])
    packed, files = opened(bench, store), opened(bench, calibration)
    width, values = field["w"], lambda file: cv2.imread(file)[..., ::-1] / 255
    ways = {"means": lambda number, file, side: means_of(quality.linear(values(file)), side),
            "values": lambda number, file, side: quality.linear(means_of(values(file), side)),
            "store": lambda number, file, side: packed._core.thumbnail(number, width // side)}
    if field["frames"][0]["file_path"].endswith(".jpg"):
        ways["JPEG"] = lambda number, file, side: files._core.thumbnail(number, width // side)
    return ways


def measure(bench, names):
    rows = []
    for name in names:
        calibration, frames = CAPTURES[name](bench)
        field = quality.read_field(calibration)
        whole = {}
        for frame in frames:
            for width in WIDTHS:
                whole[frame.name, width] = (order_quality.light(bench, calibration, frame.path(width), *DEFAULT)[0],
                                            frame.truth(width))
        found = {}
        for way, light_of in lights_of(bench, calibration, field).items():
            for side in REDUCTIONS:
                reduced = reduced_field(bench.folder / "reduced", field, side,
                                        lambda number, file: light_of(number, file, side))
                for frame in frames:
                    for width in (width for width in WIDTHS if width >= side):
                        picture = order_quality.light(bench, reduced, frame.path(width), *DEFAULT)[0]
                        of_whole, truth = whole[frame.name, width]
                        found.setdefault((frame.name, width, side), {})[way] = [
                            None if truth is None else decibels(picture, truth), decibels(picture, of_whole)]
        for (frame, width, side), ways in sorted(found.items()):
            picture, truth = whole[frame, width]
            rows.append({"capture": name, "frame": frame, "width": width, "reduction": side,
                         "whole": None if truth is None else decibels(picture, truth), "ways": ways})
            print(rows[-1], file=sys.stderr, flush=True)
    return rows


def table(record):
    lines = ["| capture | frame | elements, LF pixels | reduced | whole | means of light | means of values | "
             "store | JPEG |", "|" + " --- |" * 9]
    for row in record["rows"]:
        of_way = lambda way: ", ".join("-" if value is None else f"{value:.1f}" for value in row["ways"].get(way, ()))
        whole = "-" if row["whole"] is None else f"{row['whole']:.1f}"
        lines.append(f"| {row['capture']} | {row['frame']} | {row['width']} | 1/{row['reduction']} | {whole} | "
                     + " | ".join(of_way(way) for way in ("means", "values", "store", "JPEG")) + " |")
    return lines


class Bench(order_quality.Bench):
    def __init__(self, build, shared, folder):
        super().__init__(build / "bin", shared, folder)
        self.build = build


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?", metavar="BUILD_DIR")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", default=",".join(CAPTURES), help="captures, with commas between")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.shared, lambda folder: {
        "rows": measure(Bench(arguments.build.resolve(), arguments.shared.resolve(), folder),
                        arguments.only.split(","))}, "BUILD_DIR SHARED")
    text = "\n".join([results.sentence(record), "PSNR, dB, against the true picture, and against the frame of whole LF "
                      "images.", ""] + table(record)) + "\n"
    results.publish(arguments, "quality/reduced_frames.py", record, text)


if __name__ == "__main__":
    main()
