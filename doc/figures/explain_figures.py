#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of doc/how-it-works.md.

usage: doc/figures/explain_figures.py FOLDER

FOLDER  receives how_lens.svg, how_capture.svg, how_focus.svg, how_weights.svg and how_rebinning.svg. Every ray is
        computed.
"""
import pathlib
import sys

INK, GREY, AMBER, BLUE, RED, GREEN = "#22303c", "#8b98a5", "#d97800", "#1f6fb2", "#c0392b", "#2e8b57"
PAPER = "#fffdf8"


class Figure:
    """A drawing with a light background, which is readable on pages of any colour."""

    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.parts = width, height, title, []

    def line(self, x1, y1, x2, y2, colour=INK, width=1.5, dashes="", opacity=1.0):
        dash = f' stroke-dasharray="{dashes}"' if dashes else ""
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
                          f'stroke-width="{width}" opacity="{opacity}"{dash}/>')

    def dot(self, x, y, colour, radius=5.0):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}"/>')

    def text(self, x, y, words, colour=INK, anchor="middle", size=17):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" '
                          f'font-size="{size}">{words}</text>')

    def box(self, x, y, width, height, colour, opacity=1.0, stroke="none"):
        self.parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" fill="{colour}" '
                          f'opacity="{opacity}" stroke="{stroke}"/>')

    def lens(self, x, y, half):
        self.parts.append(f'<path d="M{x} {y - half} Q{x + 14} {y} {x} {y + half} Q{x - 14} {y} {x} {y - half}" '
                          f'fill="#bfe0f5" stroke="{BLUE}" stroke-width="1.5" opacity="0.8"/>')

    def camera(self, x, y, colour=INK):
        """Draws a small camera that looks to the left."""
        self.box(x, y - 6, 15, 12, colour)
        outline = f"{x},{y - 3} {x - 7},{y - 6} {x - 7},{y + 6} {x},{y + 3}"
        self.parts.append(f'<polygon points="{outline}" fill="{colour}"/>')

    def save(self, file: pathlib.Path):
        file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
                        f'width="{self.width}" height="{self.height}" font-family="sans-serif" role="img">\n'
                        f'<title>{self.title}</title>\n'
                        f'<rect width="{self.width}" height="{self.height}" rx="10" fill="{PAPER}"/>\n'
                        + "\n".join(self.parts) + "\n</svg>\n")


def at(x1, y1, x2, y2, x):
    """Returns the height at x of the line through two points."""
    return y1 + (y2 - y1) * (x - x1) / (x2 - x1)


def lens_figure():
    """A lens collects all rays of a point: sharp if it is in the focus plane, a disk otherwise."""
    figure = Figure(720, 300, "A lens joins all rays of a point in the focus plane, and spreads those of other points")
    lens_x, sensor_x, middle, half = 470, 640, 150, 80
    focus = lens_x - 300
    f = 1 / (1 / 300 + 1 / (sensor_x - lens_x))
    figure.line(focus, 30, focus, 262, GREEN, 1.5, "6 5")
    figure.text(focus, 282, "focus plane", GREEN)
    for x, y, colour in ((focus, 105, GREEN), (335, 190, RED)):
        distance = lens_x - x
        image = 1 / (1 / f - 1 / distance)
        image_y = middle - (y - middle) * image / distance
        for k in range(-3, 4):
            on_lens = middle + k * half / 3.4
            figure.line(x, y, lens_x, on_lens, colour, 1.2, opacity=0.75)
            figure.line(lens_x, on_lens, sensor_x, at(lens_x, on_lens, lens_x + image, image_y, sensor_x), colour, 1.2,
                        opacity=0.75)
        figure.dot(x, y, colour)
    figure.lens(lens_x, middle, half)
    figure.line(sensor_x, 35, sensor_x, 255, INK, 4)
    figure.text(sensor_x, 282, "sensor")
    figure.text(lens_x, 282, "lens")
    figure.text(sensor_x + 10, 190, "sharp", GREEN, "start", 16)
    figure.text(sensor_x + 10, 120, "a disk", RED, "start", 16)
    return figure


def capture_figure():
    """LF cameras stand where the lens will be; each records the rays through its own small hole."""
    figure = Figure(720, 300, "Cameras side by side record the rays that a large lens at their place would collect")
    lens_x, middle, half = 500, 150, 92
    cameras = [middle + k * 2 * half / 8 for k in range(-4, 5)]
    for x, y, colour in ((170, 90, GREEN), (90, 205, RED)):
        for camera_y in cameras:
            figure.line(x, y, lens_x - 8, camera_y, colour, 1.2, opacity=0.7)
        figure.dot(x, y, colour)
    for camera_y in cameras:
        figure.camera(lens_x, camera_y)
    figure.parts.append(f'<ellipse cx="{lens_x - 3}" cy="{middle}" rx="16" ry="{half + 14}" fill="none" '
                        f'stroke="{BLUE}" stroke-width="2" stroke-dasharray="7 5"/>')
    figure.text(lens_x + 40, 60, "the lens of the film", BLUE, "start")
    figure.text(lens_x + 40, 78, "(not there yet)", BLUE, "start")
    figure.text(lens_x + 40, 150, "LF cameras: one", INK, "start")
    figure.text(lens_x + 40, 168, "photograph each", INK, "start")
    figure.text(60, 285, "every line is a recorded ray: a pixel of a photograph", INK, "start")
    return figure


def focus_figure():
    """The focus plane decides where a recorded ray lands: where the ray crosses it."""
    figure = Figure(720, 320, "The same recorded rays, with the focus plane at two distances")
    for left, plane_x, name in ((0, 40, "focus on the far point"), (360, 160, "focus on the near point")):
        lens_x, middle = left + 320, 150
        points = ((left + 40, 110, BLUE), (left + 160, 170, AMBER))
        plane = left + plane_x
        figure.line(plane, 35, plane, 255, GREEN, 2, "6 5")
        figure.text(left + 185, 300, name, GREEN)
        for x, y, colour in points:
            crossings = set()
            for k in range(-3, 4):
                camera_y = middle + 22 * k
                # The ray of the point, drawn beyond it as far as the focus plane.
                end_y = at(x, y, lens_x, camera_y, plane)
                figure.line(min(x, plane), end_y if plane < x else y, lens_x, camera_y, colour, 1.1, opacity=0.7)
                crossings.add(end_y)
            for crossing in crossings:
                figure.dot(plane, crossing, colour, 3.5)
            figure.dot(x, y, colour, 6)
        for k in range(-3, 4):
            figure.camera(lens_x, middle + 22 * k)
    figure.line(360, 20, 360, 300, GREY, 1)
    return figure


def weights_figure():
    """LF cameras that stand unevenly stand for unequal parts of the lens."""
    figure = Figure(720, 250, "Each LF camera stands for the part of the lens that is nearest to it")
    places = [60, 105, 128, 150, 262, 300, 420, 452, 560, 660]
    left, right = 40, 680
    borders = [left] + [(a + b) / 2 for a, b in zip(places, places[1:])] + [right]
    figure.text(360, 32, "the lens, from one edge to the other", BLUE)
    for i, place in enumerate(places):
        width = borders[i + 1] - borders[i]
        figure.box(borders[i], 50, width, 34, (BLUE, AMBER)[i % 2], 0.25)
        figure.dot(place, 67, INK, 5)
        figure.box(place - 9, 205 - 0.9 * width, 18, 0.9 * width, (BLUE, AMBER)[i % 2], 0.85)
    figure.line(left, 205, right, 205, GREY)
    figure.text(360, 232, "weight of each photograph: the width of its part")
    return figure


def rebinning_figure():
    """Rays as points of a map: position on the lens across, position on the focus plane down."""
    figure = Figure(720, 310, "Recorded rays as points of a map, between which other rays are interpolated")
    figure.line(60, 260, 330, 260, INK)
    figure.line(60, 260, 60, 30, INK)
    figure.text(195, 290, "where the ray passes the lens")
    figure.parts.append(f'<text x="0" y="0" fill="{INK}" text-anchor="middle" font-size="14" '
                        'transform="translate(38 145) rotate(-90)">where it meets the focus plane</text>')
    for column in range(7):
        for row in range(8):
            x = 85 + 36 * column + 5 * ((3 * column + 5 * row) % 4 - 1.5)
            y = 50 + 27 * row + 3 * ((5 * column + 3 * row) % 5 - 2)
            figure.dot(x, y, BLUE, 3.5)
    figure.parts.append(f'<circle cx="212" cy="140" r="32" fill="{AMBER}" opacity="0.25"/>')
    figure.dot(212, 140, AMBER, 6)
    for y, colour, first, second in ((70, BLUE, "recorded rays: pixels of photographs,", "sorted by four such numbers"),
                                     (135, AMBER, "a ray of the film that was not recorded:",
                                      "a mean of the rays around it")):
        figure.dot(385, y - 5, colour, 6)
        figure.text(402, y, first, INK, "start", 14)
        figure.text(402, y + 20, second, INK, "start", 14)
    figure.text(385, 205, "(drawn with two numbers instead of four:", GREY, "start", 14)
    figure.text(385, 223, "across and down for lens and focus plane)", GREY, "start", 14)
    return figure


def main() -> int:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1])
    for name, draw in (("lens", lens_figure), ("capture", capture_figure), ("focus", focus_figure),
                       ("weights", weights_figure), ("rebinning", rebinning_figure)):
        draw().save(folder / f"how_{name}.svg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
