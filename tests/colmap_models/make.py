#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the COLMAP models in this folder, with COLMAP itself, so that the tests need no COLMAP.

usage: make.py        needs COLMAP 3.8 (Debian 12: apt-get install --no-install-recommends colmap)

ten_cameras: one camera of each model that COLMAP 3.8 and we have in common, two images each, all of which see the same
twelve points. This program projects the points by the formulas of the models, and fails unless COLMAP finds that the
reprojection error is 0. COLMAP writes the binary files and exports the text files from them.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

WIDTH, HEIGHT = 640, 480
CAMERAS = [
    ("SIMPLE_PINHOLE", [500.25, 321.5, 238.75]),
    ("PINHOLE", [501.125, 507.0625, 318.5, 242.125]),
    ("SIMPLE_RADIAL", [498.3, 320.1, 239.9, 0.0327]),
    ("RADIAL", [503.7, 319.2, 240.3, -0.0411, 0.0123]),
    ("OPENCV", [505.1, 506.2, 322.3, 237.4, -0.0521, 0.0111, 0.0031, -0.0017]),
    ("FULL_OPENCV", [507.1, 506.9, 317.3, 241.4, 0.0521, -0.0111, 0.0021, -0.0027, 0.0033, 0.0044,
                     -0.0055, 0.0013]),
    ("OPENCV_FISHEYE", [311.3, 312.4, 321.7, 239.3, 0.0213, -0.0042, 0.0017, -0.0003]),
    ("FOV", [401.9, 402.8, 319.6, 240.7, 0.8125]),
    ("SIMPLE_RADIAL_FISHEYE", [307.7, 320.9, 238.1, 0.0191]),
    ("RADIAL_FISHEYE", [309.3, 318.8, 241.9, -0.0143, 0.0037]),
]


def split(model, p):
    """Returns fx, fy, cx, cy and the remaining parameters."""
    if model.startswith("SIMPLE_") or model.startswith("RADIAL"):
        p = [p[0]] + p
    return p[:4], p[4:]


def project(model, parameters, x, y):
    """Returns the pixels of the direction (x, y, 1), by the formulas of COLMAP's camera models."""
    (fx, fy, cx, cy), k = split(model, parameters)
    r = np.hypot(x, y)
    if model == "FOV":
        scale = np.arctan(2 * r * np.tan(k[0] / 2)) / k[0] / r
        x, y = x * scale, y * scale
    elif model.endswith("FISHEYE"):
        theta = np.arctan(r)
        powers = [theta ** (2 * i + 2) for i in range(len(k))]
        scale = theta * (1 + np.dot(k, powers)) / r
        x, y = x * scale, y * scale
    elif k:
        k1, k2, p1, p2, k3, k4, k5, k6 = k + [0] * (8 - len(k))
        s = r * r
        radial = (1 + k1 * s + k2 * s**2 + k3 * s**3) / (1 + k4 * s + k5 * s**2 + k6 * s**3)
        x, y = (x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x),
                y * radial + 2 * p2 * x * y + p1 * (s + 2 * y * y))
    return fx * x + cx, fy * y + cy


def rotation(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def write_text(folder):
    random = np.random.default_rng(1)
    points = random.uniform([-1, -0.7, 3], [1, 0.7, 6], (12, 3))
    cameras, images, tracks = [], [], [[] for _ in points]
    for index, (model, parameters) in enumerate(CAMERAS):
        camera_id = 100 - 3 * index
        cameras.append(f"{camera_id} {model} {WIDTH} {HEIGHT} " +
                       " ".join(repr(p) for p in parameters))
        for side in (0, 1):
            image_id = 7 * index + 3 * side + 2
            q = np.array([1, *random.normal(0, 0.03, 3)])
            q /= np.linalg.norm(q)
            t = np.array([0.2 * side - 0.1, 0, 0]) + random.normal(0, 0.02, 3)
            name = f"{('left', 'right')[side]}/{model.lower()}.png"
            images.append(" ".join([str(image_id), *map(repr, map(float, [*q, *t])),
                                    str(camera_id), name]))
            observed = []
            for number, point in enumerate(points):
                x, y, z = rotation(*q) @ point + t
                u, v = project(model, parameters, x / z, y / z)
                observed += [repr(float(u)), repr(float(v)), str(number + 5)]
                tracks[number] += [str(image_id), str(number)]
            images.append(" ".join(observed))
    lines = [" ".join([str(number + 5), *map(repr, map(float, point)), "200 100 50 0", *track])
             for number, (point, track) in enumerate(zip(points, tracks))]
    for name, content in (("cameras", cameras), ("images", images), ("points3D", lines)):
        (folder / f"{name}.txt").write_text("\n".join(content) + "\n")


def colmap(*arguments):
    command = ["colmap", *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    target = pathlib.Path(__file__).parent / "ten_cameras"
    target.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        ours, adjusted = pathlib.Path(temporary) / "ours", pathlib.Path(temporary) / "adjusted"
        for folder in (ours, adjusted):
            folder.mkdir()
        write_text(ours)
        report = colmap("bundle_adjuster", "--input_path", ours, "--output_path", adjusted)
        error_px = float(re.search(r"Initial cost : ([0-9.e+-]+)", report).group(1))
        print(f"reprojection error by COLMAP: {error_px} px")
        if not error_px < 1e-6:
            sys.exit("our projection is not COLMAP's")
        colmap("model_converter", "--input_path", ours, "--output_path", target,
               "--output_type", "BIN")
        shutil.rmtree(ours)
    colmap("model_converter", "--input_path", target, "--output_path", target,
           "--output_type", "TXT")


if __name__ == "__main__":
    main()
