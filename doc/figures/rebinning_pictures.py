#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of doc/rebinning.md from scenes of lfsynth (which lies beside LFRENDERER).

usage: rebinning_pictures.py LFRENDERER FOLDER

FOLDER  receives rebinning_small_lens.jpg   a lens narrower than the spacing: collected; hybrid; the
                                            truth
                 rebinning_few_images.jpg   every 4th LF image, focus near the lens: collected;
                                            rebinned; the truth
                 rebinning_kept.jpg         rebinned from all rays; from rays at edges, with xi by default; with xi =
                                            0.2
                 rebinning_kernel.jpg       a large sigma_uv; a large sigma_st; a small sigma_st with few lens points
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from lens_pictures import picture, side_by_side

SCENE, COUNT, SIZE, SPACING, TRUTH_SAMPLES = "still-life", 289, (360, 240), 0.003, 400


class Capture:
    def __init__(self, renderer, folder):
        self.renderer, self.folder = renderer, folder
        self.lfsynth = pathlib.Path(renderer).with_name("lfsynth")
        self.run(self.lfsynth, SCENE, "-o", folder, "--count", COUNT, "--size",
                 "x".join(map(str, SIZE)), "--spacing", SPACING, "--jitter", 0.3)
        self.field = json.loads((folder / "transforms.json").read_text())
        self.thinned = folder / "thinned.json"
        self.thinned.write_text(json.dumps(dict(self.field, frames=self.field["frames"][::4])))

    def run(self, program, *arguments):
        subprocess.run([program, *map(str, arguments), "-q"], check=True)

    def path(self, distances, focus, behind=0):
        """Returns a path whose lens is `distances` spacings wide, half a spacing beside the middle of the capture and
        `behind` it."""
        poses = np.array([f["transform_matrix"] for f in self.field["frames"]])
        right, up, back = poses[len(poses) // 2, :3, :3].T
        position = poses[:, :3, 3].mean(axis=0) + 0.5 * SPACING * right + behind * back
        fov = 2 * np.degrees(np.arctan(0.5 * SIZE[0] / self.field["fl_x"]))
        numbers = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
        path = self.folder / f"{distances}-{focus}-{behind}.yaml"
        path.write_text(f"""format: lfpath 1
fps: 25
frames: 1
resolution: [{SIZE[0]}, {SIZE[1]}]
camera:
  field_of_view_deg: {float(0.8 * fov)!r}
  focal_length_mm: 50
  position: {numbers(position)}
  look_at: {numbers(position - back)}
  up: {numbers(up)}
lens:
  aperture_diameter: {distances * SPACING!r}
  focus_distance: {focus}
""")
        return path

    def truth(self, path):
        out = self.folder / ("truth-" + path.stem)
        self.run(self.lfsynth, SCENE, "-o", out, "--calibration-only", "--truth", path,
                 "--truth-samples", TRUTH_SAMPLES)
        return next(out.rglob("frame_0001.exr"))

    def frame(self, calibration, path, *options):
        out = self.folder / "frames"
        self.run(self.renderer, calibration, path, "-o", out, "--no-contact-sheet", "--overwrite",
                 *options)
        return out / "frame_0001.exr"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    renderer, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    none = ("--lens-weights", "none")
    with tempfile.TemporaryDirectory() as temporary:
        capture = Capture(renderer, pathlib.Path(temporary) / "field")
        whole = pathlib.Path(temporary) / "field" / "transforms.json"
        small = capture.path(0.4, 0.9, behind=0.07)
        collected = picture(capture.frame(whole, small, *none))
        hybrid = capture.frame(whole, small, *none, "--mode", "hybrid")
        side_by_side(folder / "rebinning_small_lens.jpg",
                     [collected, picture(hybrid), picture(capture.truth(small))])
        cells = ("--mode", "rebin", "--interpolation", "cells")
        near = capture.path(12, 0.45)
        side_by_side(folder / "rebinning_few_images.jpg",
                     [picture(capture.frame(capture.thinned, near, *none)),
                      picture(capture.frame(capture.thinned, near, *cells)),
                      picture(capture.truth(near))])
        wide = capture.path(5, 0.8)
        rebin = lambda *options: picture(capture.frame(whole, wide, *cells, *options))
        edges = ("--kept", "edges")
        side_by_side(folder / "rebinning_kept.jpg",
                     [rebin(), rebin(*edges), rebin(*edges, "--xi", "0.2")])
        side_by_side(folder / "rebinning_kernel.jpg",
                     [rebin("--sigma-uv", "1.2"), rebin("--sigma-st", "2"),
                      rebin("--sigma-st", "0.1", "--lens-points", "8")])


if __name__ == "__main__":
    main()
