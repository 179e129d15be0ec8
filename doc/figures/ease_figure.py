#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws how a focus pull of two keys moves, for doc/formats/path.md: the focus distances that lfcammvminfo states,
their speed and their acceleration.

usage: doc/figures/ease_figure.py PROGRAMS FOLDER

PROGRAMS  folder of lfcammvminfo
FOLDER    receives eases.svg
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from explain_figures import AMBER, BLUE, GREY, INK, RED, Figure

FPS, SECONDS, BEGIN, END = 100, 3, 0.75, 2.25  # the pull lasts from BEGIN to END
NEAR, FAR = 1, 2
PATH = f"""format: lfpath 1
fps: {FPS}
frames: {FPS * SECONDS + 1}
resolution: [16, 9]
camera: {{focal_length_mm: 50, position: [0, 0, 0], look_at: [0, 0, 1]}}
lens: {{aperture_diameter_mm: 4START}}
MOVES
"""
HALF = 4 * (FAR - NEAR) / (END - BEGIN)**2
MIDDLE = (BEGIN + END) / 2
PULLS = {
    "smooth or linear": (RED, "", f"keyframes: {{focus_distance: [{{time: {BEGIN}, value: {NEAR}}}, "
                                  f"{{time: {END}, value: {FAR}}}]}}"),
    "accelerations": (AMBER, f", focus_distance: {NEAR}",
                      f"accelerations:\n"
                      f"  - {{quantity: focus_distance, from: {BEGIN}, to: {MIDDLE}, value: {HALF}}}\n"
                      f"  - {{quantity: focus_distance, from: {MIDDLE}, to: {END}, value: {-HALF}}}"),
    "ease": (BLUE, "", f"keyframes: {{focus_distance: [{{time: {BEGIN}, value: {NEAR}}}, "
                       f"{{time: {END}, value: {FAR}, interpolation: ease}}]}}"),
}
WIDTH, PANEL, GAP, LEFT, TOP = 720, 130, 44, 90, 60


def distances(program: pathlib.Path, start: str, moves: str) -> np.ndarray:
    """Returns the focus distance of each frame."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "pull.yaml"
        path.write_text(PATH.replace("START", start).replace("MOVES", moves))
        lines = subprocess.run([program, path, "--csv"], check=True, capture_output=True, text=True).stdout.splitlines()
    column = lines[0].split(",").index("focus_distance_w")
    return np.array([float(line.split(",")[column]) for line in lines[1:]])


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    program, folder = pathlib.Path(sys.argv[1]) / "lfcammvminfo", pathlib.Path(sys.argv[2])
    time = np.arange(FPS * SECONDS + 1) / FPS
    figure = Figure(WIDTH, TOP + 3 * (PANEL + GAP), "Distance, speed and acceleration of a focus pull of two keys")
    panels = (("distance", NEAR, FAR), ("speed", 0, 2 * (FAR - NEAR) / (END - BEGIN)),
              ("acceleration", -6 * (FAR - NEAR) / (END - BEGIN)**2, 6 * (FAR - NEAR) / (END - BEGIN)**2))
    for row, (name, low, high) in enumerate(panels):
        y0 = TOP + row * (PANEL + GAP)
        zero = y0 + PANEL * (high - max(low, 0)) / (high - low)
        figure.line(LEFT, zero, WIDTH - 20, zero, GREY, 1)
        for key in (BEGIN, END):
            x = LEFT + key / SECONDS * (WIDTH - 20 - LEFT)
            figure.line(x, y0, x, y0 + PANEL, GREY, 1, "3 5")
        figure.text(14, y0 + 18, name, INK, "start")
        for colour, start, moves in PULLS.values():
            values = distances(program, start, moves)
            for _ in range(row):
                values = np.gradient(values, 1 / FPS)
            x = LEFT + time / SECONDS * (WIDTH - 20 - LEFT)
            # The acceleration of a straight line is an impulse at both keys, which leaves the panel.
            beyond = 0.1 * (high - low)
            y = y0 + PANEL * (high - np.clip(values, low - beyond, high + beyond)) / (high - low)
            points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
            figure.parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
    for i, (name, (colour, _, _)) in enumerate(PULLS.items()):
        x = LEFT + 210 * i
        figure.line(x, 26, x + 28, 26, colour, 3)
        figure.text(x + 36, 32, name, INK, "start")
    figure.save(folder / "eases.svg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
