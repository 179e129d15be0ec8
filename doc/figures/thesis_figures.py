#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of doc/thesis.md: what the figures of chapter 5 of the thesis show, from scenes
of lfsynth (which lies beside LFRENDERER).

usage: thesis_figures.py LFRENDERER FOLDER [--only NAME]

FOLDER  receives thesis_bokeh.jpg     a pentagon focused near the lens (Figure 5.2); the same by the
                                      thesis's estimator; the truth
                 thesis_stack.jpg     six frames of a focal stack (Figure 5.3)
                 thesis_tilt.jpg      a focus plane tilted about the vertical axis; a part of it
                                      magnified, and the same from twice as many LF images (Figure 5.4)
                 thesis_rebinned.jpg  collected and rebinned, the whole and a part (Figure 5.7)
                 thesis_short.jpg     a camera that moves by 2 cm while the focus comes nearer
                                      (Figure 5.9)
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from lens_pictures import picture, side_by_side

SIZE, SPACING, COUNT, TRUTH_SAMPLES = (360, 240), 0.003, 289, 600
DEFAULT = "--mode collect --estimator bilinear --filter prefiltered --lens-weights auto"
THESIS = "--mode collect --estimator nearest --lens-weights none"


class Capture:
    """A grid of LF cameras in front of a scene, SPACING apart, or more closely on the same square."""

    def __init__(self, renderer, folder, scene, denser=1):
        self.renderer, self.folder, self.scene = renderer, folder, scene
        self.lfsynth = pathlib.Path(renderer).with_name("lfsynth")
        self.run(self.lfsynth, scene, "-o", folder, "--count", COUNT * denser, "--size", "x".join(map(str, SIZE)),
                 "--spacing", SPACING / denser ** 0.5)
        field = json.loads((folder / "transforms.json").read_text())
        poses = np.array([f["transform_matrix"] for f in field["frames"]])
        self.right, self.up, back = poses[len(poses) // 2, :3, :3].T
        self.forward = -back
        self.middle = poses[:, :3, 3].mean(axis=0)
        self.fov_deg = float(0.8 * 2 * np.degrees(np.arctan(0.5 * SIZE[0] / field["fl_x"])))

    def run(self, program, *arguments):
        subprocess.run([program, *map(str, arguments), "-q"], check=True)

    def path(self, name, frames, lens, moves=""):
        """Returns a path of one second with `frames` frames, from the middle of the grid unless it moves."""
        numbers = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
        path = self.folder / (name + ".yaml")
        path.write_text(f"""format: lfpath 1
fps: {max(1, frames - 1)}
frames: {frames}
resolution: [{SIZE[0]}, {SIZE[1]}]
camera:
  field_of_view_deg: {self.fov_deg!r}
  focal_length_mm: 50
  position: {numbers(self.middle)}
  look_at: {numbers(self.middle + self.forward)}
  up: {numbers(self.up)}
  follow: direction
lens:
{lens}
{moves}""")
        return path

    def frames(self, path, options=DEFAULT):
        with tempfile.TemporaryDirectory() as out:
            self.run(self.renderer, self.folder, path, "-o", out, "--no-contact-sheet", *options.split())
            return [picture(frame) for frame in sorted(pathlib.Path(out).glob("frame_*.exr"))]

    def truth(self, path):
        with tempfile.TemporaryDirectory() as out:
            self.run(self.lfsynth, self.scene, "-o", out, "--calibration-only", "--truth", path, "--truth-samples",
                     TRUTH_SAMPLES)
            return picture(next(pathlib.Path(out).rglob("frame_0001.exr")))


def magnified(shown, x, y, times=3):
    """Returns a part of the picture around (x, y), in shares of its size, at the size of the whole."""
    height, width = shown.shape[0] // times, shown.shape[1] // times
    left = int(np.clip(x * shown.shape[1] - width / 2, 0, shown.shape[1] - width))
    top = int(np.clip(y * shown.shape[0] - height / 2, 0, shown.shape[0] - height))
    return shown[top:top + height, left:left + width].repeat(times, axis=0).repeat(times, axis=1)


def stacked(rows):
    """Returns rows of pictures, each row side by side, below each other as one picture."""
    gap = lambda shape: np.full(shape, 255, np.uint8)
    lines = [np.hstack([p for shown in row for p in (shown, gap((shown.shape[0], 6, 3)))][:-1]) for row in rows]
    return np.vstack([p for line in lines for p in (line, gap((6, line.shape[1], 3)))][:-1])


def bokeh(capture, folder):
    scene = capture("lights")
    path = scene.path("bokeh", 1, "  aperture_diameter: 0.045\n  blades: 5\n  focus_distance: 0.6")
    side_by_side(folder / "thesis_bokeh.jpg",
                 [scene.frames(path)[0], scene.frames(path, THESIS)[0], scene.truth(path)])


def stack(capture, folder):
    scene = capture("still-life")
    path = scene.path("stack", 6, "  aperture_diameter: 0.04\n  focus_distance: 1.4",
                      "keyframes:\n  focus_distance: [{time: 0, value: 1.4}, {time: 1, value: 0.6}]\n")
    shown = scene.frames(path)
    side_by_side(folder / "thesis_stack.jpg", [stacked([shown[:3], shown[3:]])])


def tilt(capture, folder):
    scene, denser = capture("lights"), capture("lights", 2)
    lens = "  aperture_diameter: 0.03\n  focus_distance: 0.8\n  focus_tilt_deg: {horizontal: 50, vertical: 0}"
    whole = scene.frames(scene.path("tilt", 1, lens))[0]
    # The parts are rendered without lens weights, so that the density of LF cameras is visible.
    parts = [magnified(c.frames(c.path("tilt", 1, lens), THESIS)[0], 0.15, 0.15) for c in (scene, denser)]
    side_by_side(folder / "thesis_tilt.jpg", [whole, *parts])


def rebinned(capture, folder):
    scene = capture("still-life")
    path = scene.path("rebinned", 1, "  aperture_diameter: 0.02\n  focus_distance: 0.8")
    collected = scene.frames(path)[0]
    # This frame uses only rays at edges, and few of them per element. It shows the noise and the artefacts that the
    # thesis describes.
    sparse = scene.frames(path, "--mode rebin --kept edges --lens-points 21 --lens-sets 4")[0]
    side_by_side(folder / "thesis_rebinned.jpg",
                 [stacked([[collected, sparse], [magnified(collected, 0.4, 0.5), magnified(sparse, 0.4, 0.5)]])])


def short(capture, folder):
    scene = capture("still-life")
    numbers = lambda v: "[" + ", ".join(repr(float(x)) for x in v) + "]"
    ends = [scene.middle + side * 0.01 * scene.right for side in (-1, 1)]
    path = scene.path("short", 4, "  aperture_diameter: 0.02\n  focus_distance: 1.2",
                      "keyframes:\n  focus_distance: [{time: 0, value: 1.2}, {time: 1, value: 0.6}]\n  position: "
                      f"[{{time: 0, value: {numbers(ends[0])}}}, {{time: 1, value: {numbers(ends[1])}}}]\n")
    shown = scene.frames(path)
    side_by_side(folder / "thesis_short.jpg", [stacked([shown[:2], shown[2:]])])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=lambda word: pathlib.Path(word).resolve())
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        captures = {}

        def capture(scene, denser=1):
            key = scene, denser
            if key not in captures:
                captures[key] = Capture(arguments.renderer, pathlib.Path(temporary) / f"{scene}-{denser}",
                                        scene, denser)
            return captures[key]

        for figure in (bokeh, stack, tilt, rebinned, short):
            if arguments.only in figure.__name__:
                figure(capture, arguments.folder)


if __name__ == "__main__":
    main()
