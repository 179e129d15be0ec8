#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws Figure 5.5 of the thesis: which share of the pixels that are tried are rays that a plate accepts.

usage: bench/ray_usage.py BUILD_DIR [--density 1] [--size 480x320] [--name NAME] [--write PAGE]
       bench/ray_usage.py --again JSON [--write PAGE]

The film is the movement `short` of Table 5.1, through a grid of LF cameras as dense as the thesis's. Only its
calibration exists, because the spans of the ray model need no pixels. LF images are ordered by their usage, accepted /
tried, over all frames. With --write the figures go into PAGE, and the picture into doc/images/ray_usage.svg.
"""
import argparse
import csv
import json
import pathlib
import tempfile

import record as results
from workloads import WORKLOADS, path_yaml, photograph

PICTURE = results.HERE.parent / "doc/images/ray_usage.svg"
WIDTH, HEIGHT, MARGIN = 420, 260, 48


def usage(build, density, size):
    """Returns [(whole, rectangles, accepted)] of every LF image inside the widened frustum."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        photograph(build, folder / "field", density, size, "--calibration-only")
        path = folder / "short.yaml"
        path.write_text(path_yaml(WORKLOADS["short"], [int(n) // 2 for n in size.split("x")]))
        text = results.call([build / "bench/lf_ray_usage", folder / "field", path])
    return [tuple(map(int, row)) for row in list(csv.reader(text.splitlines()))[1:]]


def panel(left, title, shares):
    """Returns one curve: LF images by falling usage."""
    across = lambda i: left + MARGIN + i / max(1, len(shares) - 1) * (WIDTH - 2 * MARGIN)
    down = lambda share: MARGIN + (1 - share) * (HEIGHT - 2 * MARGIN)
    step = max(1, len(shares) // 400)
    points = " ".join(f"{across(i):.1f},{down(shares[i]):.1f}" for i in range(0, len(shares), step))
    corner = f"{across(0):.1f},{down(0):.1f}"
    end = f"{across(len(shares) - 1):.1f},{down(0):.1f}"
    lines = [f'<text x="{left + WIDTH / 2}" y="24" text-anchor="middle" font-weight="bold">{title}</text>',
             f'<polygon points="{corner} {points} {end}" fill="#7aa6c2" stroke="#30566e"/>']
    for share in (0, 0.25, 0.5, 0.75, 1):
        y = down(share)
        lines.append(f'<line x1="{across(0)}" x2="{across(len(shares) - 1)}" y1="{y}" y2="{y}" '
                     'stroke="#888" stroke-width="0.4"/>')
        lines.append(f'<text x="{across(0) - 6}" y="{y + 4}" text-anchor="end">{share:g}</text>')
    lines.append(f'<text x="{across(0)}" y="{HEIGHT - MARGIN + 18}">1</text>')
    lines.append(f'<text x="{left + WIDTH - MARGIN}" y="{HEIGHT - MARGIN + 18}" text-anchor="end">'
                 f'{len(shares)}</text>')
    lines.append(f'<text x="{left + WIDTH / 2}" y="{HEIGHT - 10}" text-anchor="middle">LF images, ordered '
                 'by their usage</text>')
    return lines


def draw(images):
    by_rect = sorted((a / r for _, r, a in images if r > 0), reverse=True)
    by_whole = sorted((a / w for w, _, a in images), reverse=True)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * WIDTH}" height="{HEIGHT}" '
             'font-family="sans-serif" font-size="12">',
             f'<rect width="{2 * WIDTH}" height="{HEIGHT}" fill="white"/>']
    lines += panel(0, "tried by rectangles: accepted / tried", by_rect)
    lines += panel(WIDTH, "tried as whole LF images: accepted / tried", by_whole)
    PICTURE.write_text("\n".join(lines + ["</svg>"]) + "\n")


def row_of(images, tried):
    """Counts the tried pixels of the LF images: whole images (0) or rectangles (1)."""
    return {"images": len(images), "empty": sum(image[2] == 0 for image in images),
            "tried": sum(image[tried] for image in images), "accepted": sum(image[2] for image in images)}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--density", type=float, default=1)
    parser.add_argument("--size", default="480x320")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        record = results.context() | {"density": arguments.density, "size": arguments.size}
        images = usage(arguments.build.resolve(), arguments.density, arguments.size)
        if arguments.write:  # the picture belongs to the page
            draw(images)
        record["frustum"] = row_of(images, 0)
        record["rectangles"] = row_of([image for image in images if image[1] > 0], 1)
    else:
        parser.error("BUILD_DIR or --again is needed")
    lines = ["| | LF images | of them without a ray | pixels tried | accepted |", "| --- | --- | --- | --- | --- |"]
    for what, row in (("widened frustum, whole LF images", record["frustum"]), ("rectangles", record["rectangles"])):
        lines.append(f"| {what} | {row['images']} | {row['empty']} | {row['tried'] / 1e9:.2f} G | "
                     f"{100 * row['accepted'] / row['tried']:.1f} % |")
    text = "\n".join([f"{results.sentence(record)} LF images {record['size']}.", ""] + lines) + "\n"
    results.publish(arguments, "ray_usage.py", record, text)


if __name__ == "__main__":
    main()
