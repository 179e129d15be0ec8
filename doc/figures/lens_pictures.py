#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of doc/lens-integral.md and doc/quality.md from scenes of lfsynth (which lies
beside LFRENDERER).

usage: lens_pictures.py LFRENDERER FOLDER

FOLDER  receives lens_cells.png     LF cameras of an uneven capture, each with its part of the lens
                 lens_weights.jpg   lights: the truth; the capture without and with lens weights
                 mosaic_ghosts.jpg  lights: the truth; mosaics by the estimator nearest; by default
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile

import cv2
import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "bench/quality"))
from lens_weights import linear_exr

COUNT, SIZE, FOCUS, SEED = 441, (360, 240), 0.6, 5
TRUTH_SAMPLES = 1000
GAP = 6  # width of the gap between pictures, px


class Capture:
    """A light field of lfsynth, and a lens with the width of its capture."""

    def __init__(self, renderer, folder, *options):
        self.renderer, self.folder = renderer, folder
        self.lfsynth = pathlib.Path(renderer).with_name("lfsynth")
        size = "x".join(map(str, SIZE))
        self.run(self.lfsynth, "lights", "-o", folder, "--count", COUNT, "--size", size, *options)
        self.field = json.loads((folder / "transforms.json").read_text())
        poses = np.array([f["transform_matrix"] for f in self.field["frames"]])
        right, up, back = poses[0, :3, :3].T
        middle = poses[:, :3, 3].mean(axis=0)
        offsets = poses[:, :3, 3] - middle
        self.places = np.stack([offsets @ right, offsets @ up], axis=1)  # positions of the LF cameras in the lens plane
        self.radius = 0.98 * self.places[:, 0].max()
        fov = 2 * np.degrees(np.arctan(0.5 * SIZE[0] / self.field["fl_x"]))
        numbers = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
        self.path = folder / "path.yaml"
        self.path.write_text(f"""format: lfpath 1
fps: 25
frames: 1
resolution: [{SIZE[0]}, {SIZE[1]}]
camera:
  field_of_view_deg: {float(0.8 * fov)!r}
  focal_length_mm: 50
  position: {numbers(middle)}
  look_at: {numbers(middle - back)}
  up: {numbers(up)}
lens:
  aperture_diameter: {float(2 * self.radius)!r}
  focus_distance: {FOCUS}
""")

    def run(self, program, *arguments):
        subprocess.run([program, *map(str, arguments), "-q"], check=True)

    def thin_out(self):
        """Drops two thirds of the right half of the LF cameras. Returns the positions of the others."""
        dice = random.Random(SEED)
        kept = [x <= 0 or dice.random() < 1 / 3 for x, _ in self.places]
        frames = [f for f, k in zip(self.field["frames"], kept) if k]
        (self.folder / "transforms.json").write_text(json.dumps(dict(self.field, frames=frames)))
        return self.places[kept]

    def truth(self):
        out = self.folder / "truth"
        self.run(self.lfsynth, "lights", "-o", out, "--calibration-only", "--truth", self.path,
                 "--truth-samples", TRUTH_SAMPLES)
        return next(out.rglob("frame_0001.exr"))

    def frame(self, *options):
        out = self.folder / "frames"
        self.run(self.renderer, self.folder / "transforms.json", self.path, "-o", out,
                 "--no-contact-sheet", *options)
        return out / "frame_0001.exr"


def picture(frame):
    u = np.clip(linear_exr(frame), 0, 1)
    srgb = np.where(u <= 0.0031308, 12.92 * u, 1.055 * u ** (1 / 2.4) - 0.055)
    return np.round(255 * srgb).astype(np.uint8)


def side_by_side(file, pictures):
    gap = np.full((pictures[0].shape[0], GAP, 3), 255, np.uint8)
    joined = [p for picture in pictures for p in (picture, gap)][:-1]
    cv2.imwrite(str(file), np.hstack(joined)[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 92])


def clip(polygon, normal, offset):
    """Returns the part of the polygon with normal . p <= offset."""
    kept = []
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
        past_a, past_b = a @ normal - offset, b @ normal - offset
        if past_a <= 0:
            kept.append(a)
        if past_a * past_b < 0:
            kept.append(a + past_a / (past_a - past_b) * (b - a))
    return np.array(kept)


def draw_cells(file, places, radius):
    size, scale = 480, 16  # OpenCV's coordinates are in sixteenths of a pixel
    to_px = lambda p: np.round((p * [1, -1] / radius * 0.44 + 0.5) * size * scale).astype(np.int32)
    angles = np.linspace(0, 2 * np.pi, 256, endpoint=False)
    disk = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    cells = []
    for p in places:
        cell = disk
        for q in places[np.argsort(((places - p) ** 2).sum(axis=1))[1:40]]:
            cell = clip(cell, q - p, (q - p) @ (p + q) / 2)
            if len(cell) < 3:
                break
        cells.append(cell)
    area = lambda c: 0 if len(c) < 3 else 0.5 * abs(np.sum(
        c[:, 0] * np.roll(c[:, 1], -1) - c[:, 1] * np.roll(c[:, 0], -1)))
    most = max(map(area, cells))
    panels = []
    for by_area in (False, True):
        image = np.full((size, size, 3), 255, np.uint8)
        for cell in cells if by_area else []:
            if area(cell) > 0:
                share = (area(cell) / most) ** 0.5
                colour = tuple(int(v) for v in (1 - share) * np.array([252, 244, 232])
                               + share * np.array([214, 128, 40]))
                cv2.fillPoly(image, [to_px(cell)], colour, cv2.LINE_AA, 4)
                cv2.polylines(image, [to_px(cell)], True, (160, 120, 80), 1, cv2.LINE_AA, 4)
        cv2.polylines(image, [to_px(disk)], True, (60, 60, 60), 2, cv2.LINE_AA, 4)
        for p, cell in zip(places, cells):
            counts = area(cell) > 0 if by_area else np.hypot(*p) <= radius
            dot = tuple(int(v) for v in to_px(p))
            cv2.circle(image, dot, 48, (30, 30, 30) if counts else (200, 200, 200), -1, cv2.LINE_AA, 4)
        panels.append(image)
    cv2.imwrite(str(file), np.hstack(panels))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    renderer, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        capture = Capture(renderer, pathlib.Path(temporary) / "rgb", "--spacing", 0.0025)
        truth = picture(capture.truth())
        places = capture.thin_out()
        draw_cells(folder / "lens_cells.png", places[::4], capture.radius)
        side_by_side(folder / "lens_weights.jpg",
                     [truth, picture(capture.frame("--lens-weights", "none")),
                      picture(capture.frame("--overwrite"))])
        mosaics = Capture(renderer, pathlib.Path(temporary) / "mosaics", "--spacing", 0.0025, "--bayer")
        nearest = ("--estimator", "nearest", "--lens-weights", "none")
        side_by_side(folder / "mosaic_ghosts.jpg", [truth, picture(mosaics.frame(*nearest)),
                                                    picture(mosaics.frame("--overwrite"))])


if __name__ == "__main__":
    main()
