#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares every camera model with OpenCV if it has the model, and otherwise with its formula in numpy.

usage: camera_models_test.py PROJECT_POINTS
"""
import subprocess
import sys
import unittest

import cv2
import numpy as np

PROJECT_POINTS = None
F, C = (1117.2, 1120.9), (640.3, 359.6)
K = np.array([[F[0], 0, C[0]], [0, F[1], C[1]], [0, 0, 1]])
COUNT = 10_000


def directions(widest_rad):
    """Returns COUNT directions spread evenly over the disk whose half angle is `widest_rad`."""
    index = np.arange(COUNT)
    theta = widest_rad * np.sqrt((index + 0.5) / COUNT)
    phi = index * np.pi * (3 - np.sqrt(5))
    depth = 1 + index % 7  # lengths must have no influence
    return depth[:, None] * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi),
                                      np.cos(theta)], axis=1)


def project(model, parameters, points):
    parameters = [*parameters, *[0.0] * (12 - len(parameters))]
    header = " ".join(map(repr, [*F, *C])) + f" {model} " + " ".join(map(repr, parameters))
    text = header + "\n" + "\n".join(" ".join(repr(float(v)) for v in p) for p in points)
    result = subprocess.run([PROJECT_POINTS], input=text, capture_output=True, text=True)
    if result.returncode != 0:
        raise AssertionError(result.stderr)
    return np.array([[float(v) for v in line.split()] for line in result.stdout.splitlines()])


def by_opencv(parameters, points):
    """Returns the pixels that OpenCV computes. parameters: k1 k2 p1 p2 k3 k4 k5 k6"""
    zero = np.zeros(3)
    return cv2.projectPoints(points, zero, zero, K, np.array(parameters))[0][:, 0]


def by_opencv_fisheye(parameters, points):
    zero = np.zeros(3)
    return cv2.fisheye.projectPoints(points[:, None], zero, zero, K, np.array(parameters))[0][:, 0]


def by_numpy_fisheye(parameters, points):
    """Returns the pixels of OpenCV's fisheye model. OpenCV's own function stops at 90 degrees."""
    across = np.hypot(points[:, 0], points[:, 1])
    theta = np.arctan2(across, points[:, 2])
    rd = theta + sum(k * theta ** (2 * i + 3) for i, k in enumerate(parameters))
    return points[:, :2] / across[:, None] * rd[:, None] * F + C


def by_numpy_fov(parameters, points):
    u = points[:, :2] / points[:, 2:]
    r = np.hypot(*u.T)
    rd = np.arctan(2 * r * np.tan(parameters[0] / 2)) / parameters[0]
    return u * (rd / r)[:, None] * F + C


def by_numpy_division(parameters, points):
    """Returns the pixels of the division model, where rd is the smaller root of k r rd^2 - rd + r = 0."""
    u = points[:, :2] / points[:, 2:]
    r = np.hypot(*u.T)
    k, = parameters
    rd = (1 - np.sqrt(1 - 4 * k * r * r)) / (2 * k * r)
    return u * (rd / r)[:, None] * F + C


def by_numpy_eucm(parameters, points):
    alpha, beta = parameters
    rho = np.sqrt(beta * (points[:, 0] ** 2 + points[:, 1] ** 2) + points[:, 2] ** 2)
    return points[:, :2] / (alpha * rho + (1 - alpha) * points[:, 2])[:, None] * F + C


def by_numpy_brown(parameters, points):
    k1, k2, p1, p2, k3, k4 = parameters
    x, y = (points[:, :2] / points[:, 2:]).T
    r = np.hypot(x, y)
    radial = 1 + k1 * r ** 2 + k2 * r ** 4 + k3 * r ** 6 + k4 * r ** 8
    return np.stack([x * radial + 2 * p1 * x * y + p2 * (r ** 2 + 2 * x ** 2),
                     y * radial + p1 * (r ** 2 + 2 * y ** 2) + 2 * p2 * x * y], 1) * F + C


def by_numpy_thin_prism(parameters, points):
    k1, k2, p1, p2, k3, k4, sx1, sy1 = parameters
    across = np.hypot(points[:, 0], points[:, 1])
    theta = np.arctan2(across, points[:, 2])
    u, v = (points[:, :2] / across[:, None] * theta[:, None]).T
    s = theta ** 2
    radial = k1 * s + k2 * s ** 2 + k3 * s ** 3 + k4 * s ** 4
    x = u + u * radial + 2 * p1 * u * v + p2 * (s + 2 * u * u) + sx1 * s
    y = v + v * radial + 2 * p2 * u * v + p1 * (s + 2 * v * v) + sy1 * s
    return np.stack([x, y], 1) * F + C


def by_numpy_rad_tan_thin_prism(parameters, points):
    """Returns the pixels of Project Aria's Fisheye624, with the angle in place of the slope as in COLMAP."""
    radial, (p0, p1), prism = parameters[:6], parameters[6:8], parameters[8:]
    across = np.hypot(points[:, 0], points[:, 1])
    theta = np.arctan2(across, points[:, 2])
    bent = theta + sum(k * theta ** (2 * i + 3) for i, k in enumerate(radial))
    a = points[:, :2] / across[:, None] * bent[:, None]
    q = (a ** 2).sum(1)
    along = a @ [p0, p1]
    powers = np.stack([q, q ** 2])
    x = a[:, 0] * (1 + 2 * along) + p0 * q + prism[:2] @ powers
    y = a[:, 1] * (1 + 2 * along) + p1 * q + prism[2:] @ powers
    return np.stack([x, y], 1) * F + C


# COLMAP's name: model, parameters, tested half angle, reference implementation
MODELS = {
    "PINHOLE": ("none", [], 1.3, lambda p, x: x[:, :2] / x[:, 2:] * F + C),
    "SIMPLE_RADIAL": ("radial-tangential", [0.035], 0.9, lambda p, x: by_opencv([*p, 0, 0, 0], x)),
    "RADIAL": ("radial-tangential", [-0.25, 0.07], 0.7, lambda p, x: by_opencv([*p, 0, 0], x)),
    "OPENCV": ("radial-tangential", [-0.28, 0.09, 0.002, -0.003], 0.7, by_opencv),
    "FULL_OPENCV": ("radial-tangential", [0.3, -0.1, 5e-4, -2e-4, 0.02, 0.6, -0.05, 0.01], 0.8,
                    by_opencv),
    "BROWN": ("brown", [-0.09, -0.076, 1e-3, -2e-3, 0.116, -0.076], 0.75, by_numpy_brown),
    "OPENCV_FISHEYE": ("fisheye", [-0.02, 0.004, -0.002, 3e-4], 1.5, by_opencv_fisheye),
    "OPENCV_FISHEYE, behind itself": ("fisheye", [-0.02, 0.004, -0.002, 3e-4], 1.7,
                                      by_numpy_fisheye),
    "SIMPLE_RADIAL_FISHEYE": ("fisheye", [0.03], 1.5, lambda p, x: by_opencv_fisheye([*p, 0, 0, 0], x)),
    "RADIAL_FISHEYE": ("fisheye", [0.03, -0.01], 1.5, lambda p, x: by_opencv_fisheye([*p, 0, 0], x)),
    "FISHEYE": ("fisheye", [], 1.7, by_numpy_fisheye),
    "DIVISION, barrel": ("division", [-0.3], 1.3, by_numpy_division),
    "DIVISION, pincushion": ("division", [0.2], 0.8, by_numpy_division),
    "EUCM": ("unified", [0.6, 1.1], 1.3, by_numpy_eucm),
    "EUCM, almost a pinhole": ("unified", [0.05, 2], 1.2, by_numpy_eucm),
    "THIN_PRISM_FISHEYE": ("thin-prism", [-0.02, 0.004, 1e-3, -2e-3, -0.002, 3e-4, 2e-3, -1e-3], 1.2,
                           by_numpy_thin_prism),
    "RAD_TAN_THIN_PRISM_FISHEYE, COLMAP's test": (
        "radial-tangential-thin-prism",
        [-0.0232, 0.0924, -0.0591, 0.003, 0.0048, -0.0009, 0.0002, 0.0005, -0.0009, -0.0001, 0.00007,
         -0.00017], 1.2, by_numpy_rad_tan_thin_prism),
    "RAD_TAN_THIN_PRISM_FISHEYE, strong terms": (
        "radial-tangential-thin-prism",
        [-0.02, 0.006, -0.002, 5e-4, -1e-4, 2e-5, 0.01, -0.02, 0.008, -0.004, -0.006, 0.003], 1.2,
        by_numpy_rad_tan_thin_prism),
    "RAD_TAN_THIN_PRISM_FISHEYE, behind itself": (
        "radial-tangential-thin-prism",
        [-0.02, 0.004, -0.002, 3e-4, 0, 0, 1e-4, -2e-4, 1e-4, -1e-4, 2e-4, 1e-4], 1.7,
        by_numpy_rad_tan_thin_prism),
    "FOV": ("fov", [0.93], 1.5, by_numpy_fov),
}


class CameraModelsTest(unittest.TestCase):
    def test_pixels_are_those_of_an_independent_formula(self):
        for name, (model, parameters, widest_rad, judge) in MODELS.items():
            with self.subTest(name):
                points = directions(widest_rad)
                found = project(model, parameters, points)
                self.assertEqual(found.shape, (COUNT, 5))
                error = np.abs(found[:, :2] - judge(parameters, points)).max()
                self.assertLessEqual(error, 1e-6)

    def test_unprojecting_gives_the_direction_back(self):
        for name, (model, parameters, widest_rad, _) in MODELS.items():
            with self.subTest(name):
                points = directions(widest_rad)
                found = project(model, parameters, points)
                back = found[:, 2:] / np.linalg.norm(found[:, 2:], axis=1)[:, None]
                forth = points / np.linalg.norm(points, axis=1)[:, None]
                # The error of the direction as an angle, times the focal length.
                self.assertLessEqual(np.abs(back - forth).max() * max(F), 1e-6)


if __name__ == "__main__":
    PROJECT_POINTS = sys.argv[1]
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
