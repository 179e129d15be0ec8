#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes doc/images/densify_around.jpg: captures around an object, seen by a true lens and rendered from them.

usage: doc/figures/densified_pictures.py BIN [-o doc/images/densify_around.jpg] [--only NAME]

BIN          folder of lfsynth, lfdensify and lfrenderer
--only NAME  only rows whose name contains NAME
"""
import argparse
import pathlib
import sys
import tempfile

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "bench/quality"), str(ROOT / "bench"), str(ROOT / "tests/helpers")]
import drawn_captures as drawn
import exr_file
import lens_weights
import quality
from quality import results

COLUMNS = ("true lens", "recorded alone", "densified", "trust")
DIAMETER = 0.04
CHECKS_PX = 20
TILE = (300, 225)
HEAD, SIDE = 24, 120
ROWS = {
    "dome\n8 degrees": ("still-life", lambda: drawn.dome(8), False),
    "dome\n15 degrees": ("still-life", lambda: drawn.dome(15), False),
    "track\n8 degrees": ("chart", lambda: drawn.track(8), False),
    "track\n15 degrees": ("still-life", lambda: drawn.track(15), False),
    "turntable\n10 degrees\ncut out": ("chart", lambda: drawn.turntable(36), True),
    "video\n0.3 degrees": ("still-life", drawn.video, False),
}


def over_checks(picture):
    """Returns a premultiplied picture over a checkerboard."""
    rows, columns = np.mgrid[:picture.shape[0], :picture.shape[1]] // CHECKS_PX
    ground = np.where((rows + columns) % 2, 0.5, 0.2)[..., None]
    return picture[..., :3] + (1 - picture[..., 3:4]) * ground


def row_of(programs, scene, directions, is_cut_out, folder):
    """Returns the pictures of a row, of 8 bits."""
    calibration = drawn.photographs(programs, scene, directions, folder / "capture", is_cut_out)
    middle = len(directions) // 2
    between = np.mean([directions[middle], directions[middle + 1]], axis=0)
    path = drawn.film(folder / "path.yaml", between, between, 1, DIAMETER)
    true = drawn.true_pictures(programs, scene, path, folder / "true", 144, "straight" if is_cut_out else "none")[0]
    store = folder / "film.lfs"
    results.call([programs / "lfdensify", calibration, path, "-o", store, "-q", "--cache", "none", "--most", 600])
    files = [true]
    for name, source in (("recorded", calibration), ("densified", store)):
        drawn.frames_of(programs / "lfrenderer", source, path, folder / name, ())
        files.append(folder / name / "frame_0001.exr")
    light = [over_checks(drawn.linear(file)) if is_cut_out else lens_weights.linear_exr(file) for file in files]
    pictures = [255 * quality.encoded(np.clip(picture, 0, 1)) for picture in light]
    return [*pictures, np.repeat(255 * exr_file.channels_of(files[-1])["trust"][..., None], 3, axis=2)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, metavar="BIN")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "doc/images/densify_around.jpg")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    rows = {name: row for name, row in ROWS.items() if options.only in name}
    sheet = np.full((HEAD + len(rows) * TILE[1], SIDE + len(COLUMNS) * TILE[0], 3), 255, np.uint8)

    def write(text, x, y):
        cv2.putText(sheet, text, (x, y), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA)

    for number, title in enumerate(COLUMNS):
        write(title, SIDE + number * TILE[0] + 4, 16)
    for number, (name, (scene, directions, is_cut_out)) in enumerate(rows.items()):
        top = HEAD + number * TILE[1]
        for line, text in enumerate(name.split("\n")):
            write(text, 4, top + 20 + 20 * line)
        with tempfile.TemporaryDirectory() as temporary:
            pictures = row_of(options.programs.resolve(), scene, directions(), is_cut_out, pathlib.Path(temporary))
        for column, picture in enumerate(pictures):
            tile = cv2.resize(picture[..., ::-1], (TILE[0] - 4, TILE[1] - 4), interpolation=cv2.INTER_AREA)
            left = SIDE + column * TILE[0]
            sheet[top:top + TILE[1] - 4, left:left + TILE[0] - 4] = np.clip(tile + 0.5, 0, 255)
        cv2.imwrite(str(options.output), sheet, [cv2.IMWRITE_JPEG_QUALITY, 84])
    return 0


if __name__ == "__main__":
    sys.exit(main())
