#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the ground truth cases, compares them with true thin-lens pictures and prints the tables
of doc/quality.md.

usage: quality.py LFRENDERER GROUNDTRUTH [--areas] [--joint] [--name NAME] [--write doc/quality.md] [--check]
                  [--keep DIR]
       quality.py --again JSON [--write doc/quality.md]

GROUNDTRUTH  folder with cases.json, README.md, gt/ and data/
--check      exit 1 if a case falls more than 0.3 dB below a column of GROUNDTRUTH/README.md: scatter for the estimator
             nearest, gather for bilinear, the better of both for the others
--areas      the other table: pixels that show areas. LF images and true pictures are reduced to half their size, by
             means of 2 x 2 pixels in linear light
--joint      adds a column of mosaics that lfcompressor, beside LFRENDERER, has demosaicked together with their
             neighbours
--keep DIR   leave paths, frames and difference pictures there
Exit 77 if GROUNDTRUTH is absent: the test then counts as skipped, not as passed.
"""
import argparse
import json
import math
import os
import pathlib
import re
import sys
import tempfile

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np
from PIL import Image

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
import mosaic_sensor
import record as results

ALLOWED_LOSS_DB = 0.3
THESIS = "--mode collect --estimator nearest --lens-weights none"
BILINEAR = "--mode collect --estimator bilinear --filter bilinear --lens-weights none"
BICUBIC = "--mode collect --estimator bilinear --filter bicubic --lens-weights auto"
# Columns of the table of pixels that show areas; lens weights are auto in all of them.
OF_AREAS = {"nearest": "--estimator nearest", "bilinear": "--filter bilinear", "bicubic": "--filter bicubic",
            "default": ""}
MOSAICS_OF_AREAS = {"Bayer, nearest": "--mode collect --estimator nearest --lens-weights auto", "Bayer, default": ""}
# Methods for mosaics are chosen on these cases; the others are for reporting (doc/quality.md).
CHOOSING = {"planar_d4_f50", "planar_d8_f20_penta", "band_d4_f40", "planar_d8_f45_vtilt", "planar_d8_f20_half"}


def camera_axes(case):
    """Returns position, right, up, forward in the world, from the OpenGL camera-to-world matrix."""
    m = np.array(case["transform_matrix"])
    return m[:3, 3], m[:3, 0], m[:3, 1], -m[:3, 2]


def tilt_deg(case):
    """Returns focus_tilt_deg (horizontal, vertical) of the case's focus plane: depth g + x tan(horizontal) + u
    tan(vertical) at x right, u up."""
    _, right, up, forward = camera_axes(case)
    n = np.array(case["focus_plane"]["normal"])
    return (math.degrees(math.atan(-(n @ right) / (n @ forward))),
            math.degrees(math.atan(-(n @ up) / (n @ forward))))


def path_yaml(case):
    position, _, up, forward = camera_axes(case)
    horizontal, vertical = tilt_deg(case)
    numbers = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
    return f"""format: lfpath 1
fps: 25
frames: 1
resolution: [{case['w']}, {case['h']}]
camera:
  field_of_view_deg: {case['fov_x_deg']!r}
  focal_length_mm: 50
  position: {numbers(position)}
  look_at: {numbers(position + forward)}
  up: {numbers(up)}
lens:
  aperture_diameter: {case['aperture_diameter_m']!r}
  focus_distance: {case['focus_distance_m']!r}
  blades: {case['blades']}
  blade_rotation_deg: {case['blade_rotation_deg']!r}
  focus_tilt_deg: {{horizontal: {horizontal!r}, vertical: {vertical!r}}}
"""


def read_field(calibration):
    """Returns a transforms.json whose frames name their files by absolute paths: parts of it may lie in any folder."""
    field = json.loads(calibration.read_text())
    for frame in field["frames"]:
        frame["file_path"] = str((calibration.parent / frame["file_path"]).resolve())
    return field


def write_field(folder, field, frames):
    """Writes a light field that has these frames alone. Returns its calibration."""
    folder.mkdir(exist_ok=True)
    (folder / "transforms.json").write_text(json.dumps(dict(field, frames=frames)))
    return folder / "transforms.json"


def purpose(case_name):
    """Returns what the row of a case is for."""
    return mosaic_sensor.CHOOSING if case_name in CHOOSING else mosaic_sensor.REPORTING


def mosaic(calibration, folder):
    """Writes the light field as an RGGB mosaic sensor would have recorded it, with the bits of its LF images."""
    folder.mkdir(parents=True)
    field = json.loads(calibration.read_text())
    field.update(lf_bayer="RGGB", lf_transfer=field.get("lf_transfer", "sRGB"))
    for frame in field["frames"]:
        rgb = cv2.imread(str(calibration.parent / frame["file_path"]), cv2.IMREAD_UNCHANGED)[..., 2::-1]
        name = pathlib.Path(frame["file_path"]).name
        cv2.imwrite(str(folder / name), mosaic_sensor.rggb(rgb))
        frame["file_path"] = name
    (folder / "transforms.json").write_text(json.dumps(field))
    return folder / "transforms.json"


def render(renderer, calibration, path, folder, options):
    results.call([renderer, calibration, path, "-o", folder, "--format", "exr-float", "-q", "--no-contact-sheet",
                  *options.split()])
    report = json.loads((folder / "report.json").read_text())
    return folder / "frame_0001.exr", report["frames"][0]["lf_images"]


def reference_columns(truth_folder):
    """Returns case -> (scatter, gather) in dB, from the table in the README."""
    columns = {}
    for line in (truth_folder / "README.md").read_text().splitlines():
        match = re.match(r"\| (\w+)[^|]*\| *\d+ *\| *([\d.]+) *\| *([\d.]+) *\|", line)
        if match:
            columns[match.group(1)] = (float(match.group(2)), float(match.group(3)))
    return columns


def halved(pixels):
    """Returns the means of 2 x 2 pixels."""
    return (pixels[0::2, 0::2] + pixels[1::2, 0::2] + pixels[0::2, 1::2] + pixels[1::2, 1::2]) / 4


def linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def encoded(light):
    """Returns sRGB of linear light, from 0 to 1."""
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def at_half_size(field):
    """Returns a calibration of LF images of half the size."""
    halve = lambda owner: owner | {key: owner[key] // 2 if key in "wh" else owner[key] / 2
                                   for key in {"w", "h", "fl_x", "fl_y", "cx", "cy"} & owner.keys()}
    return halve(field) | {"frames": [halve(frame) for frame in field["frames"]]}


def of_areas(calibration, folder):
    """Writes the light field at half its size, with pixels that show the means of areas."""
    folder.mkdir(parents=True)
    field = at_half_size(json.loads(calibration.read_text()))
    field["lf_transfer"] = "linear"
    light_of = linear(np.arange(256) / 255)
    for frame in field["frames"]:
        stored = cv2.imread(str(calibration.parent / frame["file_path"]))
        name = pathlib.Path(frame["file_path"]).stem + ".png"
        light = halved(light_of[stored])
        cv2.imwrite(str(folder / name), np.round(65535 * light).astype(np.uint16))
        frame["file_path"] = name
    (folder / "transforms.json").write_text(json.dumps(field))
    return folder / "transforms.json"


def read_pfm(path):
    """Returns the pixels [height][width][3] of a PFM file, from the top."""
    _, size, _, values = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(values, "<f4").reshape(height, width, 3)[::-1]


def psnr(truth_folder, case, frame):
    """Returns the PSNR of a frame in linear light, in dB, and writes a picture of its difference beside it."""
    truth = read_pfm(truth_folder / case["linear"]).astype(float)
    picture = cv2.imread(str(frame), cv2.IMREAD_UNCHANGED)[..., 2::-1].astype(float)
    difference = np.clip(128 + 4 * 255 * (encoded(picture) - encoded(truth)), 0, 255).astype(np.uint8)
    Image.fromarray(difference).save(frame.with_name("difference.png"))
    return -10 * math.log10(np.mean((truth - np.clip(picture, 0, 1)) ** 2))


def true_picture_of_areas(truth, case):
    """Returns the true picture of a case at half its size. That of half resolution is made of the one of full
    resolution, whose first and last row are left out, because their number would be odd."""
    if not case["name"].endswith("_half"):
        return halved(read_pfm(truth / case["linear"]))
    return halved(halved(read_pfm(truth / case["linear"].replace("_half", ""))[1:-1]))


def measure_areas(renderer, truth, folder, is_joint):
    """Returns one row per case: {column: dB}, and the number of contributing LF images."""
    fields, mosaics, rows = {}, {}, []
    for case in json.loads((truth / "cases.json").read_text())["cases"]:
        if not case["aperture_diameter_m"]:
            continue
        calibration = truth / case["light_field"]
        if calibration not in fields:
            name = calibration.parent.name
            fields[calibration] = of_areas(calibration, folder / f"areas_{name}")
            mosaics[calibration] = mosaic(fields[calibration], folder / f"bayer_areas_{name}")
        picture = true_picture_of_areas(truth, case)
        work = folder / case["name"]
        work.mkdir(parents=True, exist_ok=True)
        path = work / "path.yaml"
        path.write_text(path_yaml(case | {"h": picture.shape[0], "w": picture.shape[1]}))
        row = {"case": case["name"]}
        for of_column, columns in ((fields, OF_AREAS), (mosaics, MOSAICS_OF_AREAS)):
            for column, options in columns.items():
                frame, images = render(renderer, of_column[calibration], path, work / column, options)
                if of_column is fields:
                    row["lf_images"] = images
                rendered = cv2.imread(str(frame), cv2.IMREAD_UNCHANGED)[..., 2::-1]
                row[column] = -10 * math.log10(np.mean((rendered - picture) ** 2))
        if is_joint:
            frame, _ = render(renderer, joint_store(renderer, mosaics[calibration]), path, work / "joint", "")
            rendered = cv2.imread(str(frame), cv2.IMREAD_UNCHANGED)[..., 2::-1]
            row[JOINT] = -10 * math.log10(np.mean((rendered - picture) ** 2))
        rows.append(row)
        print(row, file=sys.stderr, flush=True)
    return rows


def joint_store(renderer, mosaics):
    """Returns the packed store of mosaics that are demosaicked together with their neighbours; it is made once."""
    store = mosaics.with_name("joint.lfs")
    if not store.exists():
        results.call([renderer.with_name("lfcompressor"), mosaics, "-o", store, "--demosaic", "joint", "--profile",
                      "lossless", "-q"])
    return store


def table_of_areas(rows):
    columns = [column for column in (*OF_AREAS, *MOSAICS_OF_AREAS, JOINT) if column in rows[0]]
    lines = ["| case | for | LF images | " + " | ".join(columns) + " |", "| --- " * (len(columns) + 3) + "|"]
    return lines + [f"| {row['case']} | {purpose(row['case'])} | {row['lf_images']} | " +
                    " | ".join(f"{row[column]:.2f}" for column in columns) + " |" for row in rows]


JOINT = "Bayer, joint"
COLUMNS = ("nearest", "scatter", "bilinear", "gather", "bicubic", "default", "bayer_nearest", "bayer_default")


def measure(renderer, truth, folder, is_joint):
    """Returns one row per case: {column: dB}, and the number of contributing LF images."""
    references, bayer, rows = reference_columns(truth), {}, []
    for case in json.loads((truth / "cases.json").read_text())["cases"]:
        if not case["aperture_diameter_m"]:
            continue  # no recorded ray passes through a pinhole
        name, calibration = case["name"], truth / case["light_field"]
        work = folder / name
        work.mkdir(parents=True, exist_ok=True)
        path = work / "path.yaml"
        path.write_text(path_yaml(case))
        if calibration not in bayer:
            bayer[calibration] = mosaic(calibration, folder / ("bayer_" + calibration.parent.name))
        row = {"case": name, "scatter": references[name][0], "gather": references[name][1]}
        for column, light_field, options in (
                ("nearest", calibration, THESIS), ("bilinear", calibration, BILINEAR),
                ("bicubic", calibration, BICUBIC), ("default", calibration, ""),
                ("bayer_nearest", bayer[calibration], THESIS), ("bayer_default", bayer[calibration], "")):
            frame, images = render(renderer, light_field, path, work / column, options)
            row[column] = psnr(truth, case, frame)
            row.setdefault("lf_images", images)
        if is_joint:
            frame, _ = render(renderer, joint_store(renderer, bayer[calibration]), path, work / "joint", "")
            row[JOINT] = psnr(truth, case, frame)
        rows.append(row)
        print(row, file=sys.stderr, flush=True)
    return rows


def table(rows):
    names = ["case", "for", "LF images", "nearest", "reference", "bilinear", "reference", "bicubic", "default",
             "Bayer, nearest", "Bayer, default"]
    columns = list(COLUMNS)
    if JOINT in rows[0]:
        names.append(JOINT)
        columns.append(JOINT)
    lines = ["| " + " | ".join(names) + " |", "| --- " * len(names) + "|"]
    return lines + [f"| {row['case']} | {purpose(row['case'])} | {row['lf_images']} | " +
                    " | ".join(f"{row[column]:.2f}" for column in columns) +
                    " |" for row in rows]


def faults_of(rows):
    """Yields the cases that are too far below the reference."""
    for row in rows:
        for column, least in (("nearest", row["scatter"]), ("bilinear", row["gather"]),
                              ("bicubic", max(row["scatter"], row["gather"])),
                              ("default", max(row["scatter"], row["gather"]))):
            if row[column] < least - ALLOWED_LOSS_DB:
                yield f"{row['case']}, {column}: {row[column]:.2f} dB, below {least:.2f} - {ALLOWED_LOSS_DB}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("groundtruth", type=pathlib.Path, nargs="?")
    parser.add_argument("--areas", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--joint", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.groundtruth:
        if not (arguments.groundtruth / "cases.json").exists():
            print(f"skipped: no ground truth at {arguments.groundtruth} (set LF_TEST_DATA)")
            return 77
        record = results.context()
        with tempfile.TemporaryDirectory() as temporary:
            folder = arguments.keep or pathlib.Path(temporary)
            record["rows"] = (measure_areas if arguments.areas else measure)(
                arguments.renderer, arguments.groundtruth, folder, arguments.joint)
    else:
        parser.error("LFRENDERER GROUNDTRUTH or --again is needed")
    rows = record["rows"]
    if arguments.areas:
        results.publish(arguments, "quality/quality.py areas", record,
                        "\n".join([results.sentence(record), ""] + table_of_areas(rows)) + "\n")
        return 0
    results.publish(arguments, "quality/quality.py", record,
                    "\n".join([results.sentence(record), ""] + table(rows)) + "\n")
    faults = list(faults_of(rows))
    print("\n".join(faults) or f"{len(rows)} cases, none more than {ALLOWED_LOSS_DB} dB below")
    return 1 if arguments.check and (faults or not rows) else 0


if __name__ == "__main__":
    sys.exit(main())
