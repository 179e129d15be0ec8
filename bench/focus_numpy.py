#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Times focus stacks against a program of NumPy that shifts and sums LF images, as toolboxes for light fields do.

usage: bench/focus_numpy.py BUILD_DIR CARDS [--planes 16] [--runs 5] [--name NAME] [--write PAGE]
       bench/focus_numpy.py --again JSON [--write PAGE]

CARDS  the folder stanford-cards-9x9: 9 x 9 JPEG pictures of 768 x 768 pixels, rectified to one plane

Both read the 81 files, refocus them at the same planes, and write a PNG picture for each. Pictures that differ by more
than interpolation does (30 dB in the worst plane) are an error: then the programs would not do the same work. NumPy
shifts every LF image by a fraction of a pixel (bilinear interpolation) and sums. lffocus has a square lens of all 81 LF
cameras, once with its defaults and once with bilinear interpolation and equal weights, as NumPy does. Figures are
medians of the runs, which alternate.
"""
import argparse
import json
import pathlib
import statistics
import sys
import tempfile

import record as results

# The names count rows and columns from 0 to 16 in steps of 2, and a pitch is the distance of 1: the LF cameras are 16
# world units apart at the most. The square lens is a little larger, so that those at its corners are in it.
PITCH, FOCAL_PX, SIDE, SIZE = 1, 768, 9, 768
NEAR, FAR = 250, 1600
APERTURE = 1.001 * PITCH * 2 * (SIDE - 1) * 2 ** 0.5
PATH = f"""format: lfpath 1
fps: 25
frames: 1
resolution: [{SIZE}, {SIZE}]
camera: {{field_of_view_deg: 53.13, position: [0, 0, 0], look_at: [0, 0, 1]}}
lens: {{aperture_diameter: {APERTURE:.6f}, blades: 4, blade_rotation_deg: 45, focus_distance: 600}}
"""
PEER = """
import pathlib, re, sys
import cv2
import numpy as np
folder, out, planes, near, far, focal = sys.argv[1], pathlib.Path(sys.argv[2]), *map(float, sys.argv[3:])
views = {}
for file in sorted(pathlib.Path(folder).glob("*.jpg")):
    row, column = map(int, re.findall(r"_(\\d+)_(\\d+)", file.name)[0])
    stored = cv2.imread(str(file)).astype(np.float32) / 255
    views[row, column] = np.where(stored <= 0.04045, stored / 12.92, ((stored + 0.055) / 1.055) ** 2.4)
middle = (max(row for row, _ in views) + 1) // 2
height, width = views[0, 0].shape[:2]
for plane in range(int(planes)):
    inverse = 1 / near + (1 / far - 1 / near) * plane / (planes - 1)
    total = np.zeros((height, width, 3), np.float32)
    count = np.zeros((height, width, 1), np.float32)
    for (row, column), view in views.items():
        down, right = (focal * inverse * (middle - k) for k in (row, column))
        top, left = int(np.floor(down)), int(np.floor(right))
        v, u = down - top, right - left
        y0, y1 = max(0, -top), min(height, height - top - 1)
        x0, x1 = max(0, -left), min(width, width - left - 1)
        a = view[y0 + top:y1 + top + 1, x0 + left:x1 + left + 1]
        rows = (1 - v) * a[:-1] + v * a[1:]
        total[y0:y1, x0:x1] += (1 - u) * rows[:, :-1] + u * rows[:, 1:]
        count[y0:y1, x0:x1] += 1
    light = np.clip(total / np.maximum(count, 1), 0, 1)
    shown = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    cv2.imwrite(str(out / f"plane_{plane}.png"), np.rint(255 * shown).astype(np.uint8))
"""
WAYS = {
    "`lffocus stack` (the default)": [],
    "`lffocus stack --filter bilinear --lens-weights none`": ["--filter", "bilinear", "--lens-weights", "none"],
}
SINGLE = "`lfrenderer`, one frame (the default)"


def worst_psnr(ours, theirs, planes):
    """Returns the least PSNR in dB, over all planes, of the pictures of lffocus in `ours` against those of NumPy."""
    import cv2
    import numpy as np
    worst = float("inf")
    for plane in range(planes):
        first = cv2.imread(str(ours / f"frame_{plane + 1:04}.png"))
        second = cv2.imread(str(theirs / f"plane_{plane}.png"))
        square = np.mean((first.astype(float) - second) ** 2)
        worst = min(worst, 10 * np.log10(255 ** 2 / square))
    if worst < 30:
        raise SystemExit(f"{ours}: {worst:.1f} dB from the pictures of NumPy, expected at least 30")
    return worst


def measure(arguments):
    binaries = arguments.build / "bin"
    used = {}
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "path.yaml").write_text(PATH)
        (folder / "peer.py").write_text(PEER)
        results.call([binaries / "lfimport", arguments.cards, "-o", folder / "cards", "--pitch", PITCH, "--focal-px",
                      FOCAL_PX, "-q"])
        ours = [binaries / "lffocus", "stack", folder / "cards", folder / "path.yaml", "--near", NEAR, "--far", FAR,
                "--planes", arguments.planes, "--format", "png", "--no-contact-sheet", "-q", "--overwrite"]
        calls = {name: [*ours, "-o", folder / f"stack{number}", *options]
                 for number, (name, options) in enumerate(WAYS.items())}
        calls[SINGLE] = [binaries / "lfrenderer", folder / "cards", folder / "path.yaml", "-o", folder / "frame",
                         "--format", "png", "--no-contact-sheet", "-q", "--overwrite"]
        calls["NumPy, shifts and sums"] = [sys.executable, folder / "peer.py", arguments.cards / "images", folder,
                                           arguments.planes, NEAR, FAR, FOCAL_PX * PITCH]
        for _ in range(arguments.runs):
            for name, call in calls.items():
                one = results.timed(call)
                used.setdefault(name, []).append({"seconds": one["seconds"], "cpu_s": one["cpu_s"]})
        psnr = {name: worst_psnr(folder / f"stack{number}", folder, arguments.planes)
                for number, name in enumerate(WAYS)}
    return [{"name": name, **{key: statistics.median(run[key] for run in runs) for key in ("seconds", "cpu_s")},
             "psnr_db": psnr.get(name)} for name, runs in used.items()]


def table_of(record):
    planes, rows = record["planes"], record["rows"]
    peer = rows[-1]
    text = f"{planes} planes of 768 x 768 elements from 81 JPEG files.\n\n"
    text += "| program | s | CPU s | CPU s of a plane | NumPy's CPU / this | dB from NumPy, worst plane |\n"
    text += "| --- | --- | --- | --- | --- | --- |\n"
    for row in rows:
        count = 1 if row["name"] == SINGLE else planes
        text += f"| {row['name']} | {row['seconds']:.2f} | {row['cpu_s']:.2f} | {row['cpu_s'] / count:.3f} | "
        text += ("" if row["name"] == SINGLE else f"{peer['cpu_s'] / row['cpu_s']:.1f}") + " | "
        text += ("" if row["psnr_db"] is None else f"{row['psnr_db']:.1f}") + " |\n"
    return text + "\n" + results.sentence(record) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("cards", type=pathlib.Path, nargs="?")
    parser.add_argument("--planes", type=int, default=16)
    parser.add_argument("--runs", type=int, default=5)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    else:
        record = results.context()
        record |= {"planes": arguments.planes, "rows": measure(arguments)}
    results.publish(arguments, "focus_numpy.py", record, table_of(record))


if __name__ == "__main__":
    main()
