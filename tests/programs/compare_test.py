#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares pictures by lfcompare, and checks every number with NumPy and SciPy, by the formulas of the papers.

usage: compare_test.py LFCOMPARE LFSYNTH LFRENDERER
"""
import json
import math
import os
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

import exr_file
from program_test_case import ProgramTestCase

COMPARE = SYNTH = RENDERER = None
# The outermost elements of its frames are not covered by all LF images.
PATH = """format: lfpath 1
fps: 24
frames: 3
resolution: [48, 32]
camera: {field_of_view_deg: 60, position: [0, 0, -1], look_at: [0, 0, 0]}
lens: {aperture_diameter: 0.01, focus_distance: 0.8}
"""
PIXELS_PER_DEGREE = 3840 * math.pi / 180
XYZ_FROM_RGB = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                         [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                         [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = XYZ_FROM_RGB.sum(axis=1)


def linear(display):
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)


def display(light):
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def filtered(channel, kernel):
    """Returns the correlation with a whole two-dimensional kernel; borders repeat the nearest pixel."""
    return cv2.filter2D(channel, cv2.CV_64F, kernel, borderType=cv2.BORDER_REPLICATE)


def psnr(a, b):
    return -10 * math.log10(np.mean((a - b) ** 2))


def ssim(a, b):
    """Returns the mean of the structural similarity of two grey pictures (Wang et al. 2004)."""
    i = np.arange(-5, 6)
    window = np.exp(-(i[:, None] ** 2 + i ** 2) / (2 * 1.5 ** 2))
    window /= window.sum()
    mean_a, mean_b = filtered(a, window), filtered(b, window)
    variances = filtered(a * a, window) - mean_a ** 2 + filtered(b * b, window) - mean_b ** 2
    covariance = filtered(a * b, window) - mean_a * mean_b
    return np.mean((2 * mean_a * mean_b + 1e-4) * (2 * covariance + 9e-4) /
                   ((mean_a ** 2 + mean_b ** 2 + 1e-4) * (variances + 9e-4)))


def hunt_lab(rgb):
    v = rgb @ XYZ_FROM_RGB.T / WHITE
    delta = 6 / 29
    v = np.where(v > delta ** 3, np.cbrt(v), v / (3 * delta ** 2) + 4 / 29)
    lightness = 116 * v[..., 1] - 16
    return np.stack([lightness, 0.01 * lightness * 500 * (v[..., 0] - v[..., 1]),
                     0.01 * lightness * 200 * (v[..., 1] - v[..., 2])], axis=-1)


def distance(a, b):
    d = hunt_lab(a) - hunt_lab(b)
    return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])


def as_seen(rgb):
    """Returns linear light as the contrast sensitivity of the eye leaves it, edges, and points."""
    v = rgb @ XYZ_FROM_RGB.T / WHITE
    opponent = [116 * v[..., 1] - 16, 500 * (v[..., 0] - v[..., 1]), 200 * (v[..., 1] - v[..., 2])]
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi ** 2)) * PIXELS_PER_DEGREE)
    i = np.arange(-radius, radius + 1) / PIXELS_PER_DEGREE
    squares = i[:, None] ** 2 + i ** 2
    seen = []
    for channel, (a1, b1, a2, b2) in zip(opponent, ((1, 0.0047, 0, 1e-5), (1, 0.0053, 0, 1e-5),
                                                    (34.1, 0.04, 13.5, 0.025))):
        kernel = sum(a * math.sqrt(math.pi / b) * np.exp(-math.pi ** 2 * squares / b) for a, b in ((a1, b1), (a2, b2)))
        seen.append(filtered(channel, kernel / kernel.sum()))
    y = (seen[0] + 16) / 116
    xyz = np.stack([y + seen[1] / 500, y, y - seen[2] / 200], axis=-1) * WHITE
    light = np.clip(xyz @ np.linalg.inv(XYZ_FROM_RGB).T, 0, 1)
    sigma = 0.5 * 0.082 * PIXELS_PER_DEGREE
    radius = math.ceil(3 * sigma)
    x, down = np.meshgrid(np.arange(-radius, radius + 1), np.arange(-radius, radius + 1))
    gaussian = np.exp(-(x ** 2 + down ** 2) / (2 * sigma ** 2))
    features = []
    for kernel in (-x * gaussian, (x ** 2 / sigma ** 2 - 1) * gaussian):
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())
        features.append(np.hypot(filtered(v[..., 1], kernel), filtered(v[..., 1], kernel.T)))
    return light, *features


def flip(a, b):
    """Returns FLIP of every pixel (Andersson et al. 2020) of linear light in [0, 1]."""
    (light_a, edges_a, points_a), (light_b, edges_b, points_b) = as_seen(a), as_seen(b)
    largest = distance(np.array([0.0, 1, 0]), np.array([0.0, 0, 1])) ** 0.7
    colour = distance(light_a, light_b) ** 0.7
    bend = 0.4 * largest
    colour = np.where(colour < bend, 0.95 / bend * colour, 0.95 + (colour - bend) / (largest - bend) * 0.05)
    feature = np.maximum(np.abs(edges_a - edges_b), np.abs(points_a - points_b))
    return colour ** (1 - np.sqrt(feature / math.sqrt(2)))


class CompareTest(ProgramTestCase):
    def picture(self, name, seed, size=(90, 120)):
        """Writes a smooth random picture with an edge, and returns its values from 0 to 1."""
        random = np.random.default_rng(seed)
        values = cv2.GaussianBlur(random.random((*size, 3)), (0, 0), 2)
        values = (values - values.min()) / (values.max() - values.min())
        values[:, size[1] // 2 + seed:] *= 0.4
        stored = np.rint(255 * values).astype(np.uint8)
        self.assertTrue(cv2.imwrite(str(self.folder / name), stored[..., ::-1]))
        return stored / 255

    def report(self, *words, code=0):
        return json.loads(self.succeeds(COMPARE, *words, "--json", code=code))

    def test_every_number_is_that_of_numpy(self):
        a, b = self.picture("a.png", 1), self.picture("b.png", 4)
        found = self.report(self.folder / "a.png", self.folder / "b.png")["all"]
        self.assertEqual(found["pixels"], 90 * 120)
        self.assertAlmostEqual(found["psnr_db"], psnr(a, b), places=4)
        self.assertAlmostEqual(found["linear_psnr_db"], psnr(linear(a), linear(b)), places=4)
        weights = [0.2126, 0.7152, 0.0722]
        self.assertAlmostEqual(found["ssim"], ssim(a @ weights, b @ weights), places=5)
        self.assertAlmostEqual(found["flip"], flip(linear(a), linear(b)).mean(), places=5)

    def test_the_picture_of_differences_shows_flip(self):
        a, b = self.picture("a.png", 1), self.picture("b.png", 4)
        self.succeeds(COMPARE, self.folder / "a.png", self.folder / "b.png", "-o", self.folder / "d.png")
        shown = cv2.imread(str(self.folder / "d.png")).sum(axis=2).astype(float)
        errors = flip(linear(a), linear(b))
        self.assertGreater(np.corrcoef(shown.ravel(), errors.ravel())[0, 1], 0.97)
        self.succeeds(COMPARE, self.folder / "a.png", self.folder / "b.png", "-o", self.folder / "d.png", "--show",
                      "difference", "--gain", 2, "--overwrite")
        shown = cv2.imread(str(self.folder / "d.png"))[..., ::-1]
        expected = np.clip(127.5 + 255 * (b - a), 0, 255)
        self.assertLessEqual(np.abs(shown - expected).max(), 0.51)
        pair = [COMPARE, self.folder / "a.png", self.folder / "b.png", "-o"]
        self.fails(2, ["d.png", "exists"], *pair, self.folder / "d.png")
        self.fails(2, ["a.png"], *pair, self.folder / "a.png", "--overwrite")
        self.fails(2, ["d.exr", ".png"], *pair, self.folder / "d.exr")

    def test_frames_of_both_formats_and_primaries_agree(self):
        field, path = self.folder / "field", self.folder / "path.yaml"
        self.succeeds(SYNTH, "still-life", "-o", field, "--count", 25, "--size", "96x64", "-q")
        path.write_text(PATH)
        for name, words in {"exr": [], "aces": ["--colour-space", "acescg"], "png": ["--format", "png"]}.items():
            self.succeeds(RENDERER, field, path, "-o", self.folder / name, "-q", *words)
        found = self.report(self.folder / "exr", self.folder / "aces")
        self.assertEqual([one["name"] for one in found["pictures"]], [f"frame_{i:04}" for i in (1, 2, 3)])
        self.assertGreater(found["all"]["psnr_db"], 60)
        self.assertGreater(self.report(self.folder / "exr", self.folder / "png")["all"]["psnr_db"], 55)
        equal = self.report(self.folder / "exr", self.folder / "exr", "--min-psnr", 100, "--max-flip", 0)
        self.assertEqual((equal["all"]["psnr_db"], equal["all"]["flip"]), (None, 0))
        table = self.succeeds(COMPARE, self.folder / "exr", self.folder / "png", "-o", self.folder / "differences")
        self.assertEqual(len(list((self.folder / "differences").iterdir())), 3)
        self.assertEqual([line.split()[0] for line in table.splitlines()],
                         ["picture", "frame_0001", "frame_0002", "frame_0003", "all"])
        self.fails(2, ["is a file"], COMPARE, self.folder / "exr", self.folder / "png", "-o", path)

        coverage = exr_file.channels_of(self.folder / "exr/frame_0001.exr")["coverage"]
        self.assertTrue(0 < (coverage >= 0.99).sum() < coverage.size)
        found = self.report(self.folder / "exr/frame_0001.exr", self.folder / "png/frame_0001.png", "--coverage", 0.99)
        self.assertEqual(found["all"]["pixels"], (coverage >= np.float32(0.99)).sum())

        # A picture that one folder lacks.
        (self.folder / "png/frame_0002.png").unlink()
        self.fails(3, ["frame_0002", "--common"], COMPARE, self.folder / "exr", self.folder / "png")
        self.fails(3, ["frame_0002", "--common"], COMPARE, self.folder / "png", self.folder / "exr")
        self.assertEqual(len(self.report(self.folder / "exr", self.folder / "png", "--common")["pictures"]), 2)
        self.fails(3, ["path.yaml", "is a file"], COMPARE, self.folder / "exr", path)
        self.fails(3, ["none", "does not exist"], COMPARE, self.folder / "exr", self.folder / "none")
        self.fails(3, ["no pictures with equal names"], COMPARE, self.folder / "exr", field)

    def test_limits_end_with_code_6(self):
        a, b = self.folder / "a.png", self.folder / "b.png"
        self.picture("a.png", 1), self.picture("b.png", 4)
        for words in (["--min-psnr", 60], ["--min-ssim", 0.999], ["--max-flip", 0.001]):
            self.fails(6, ["1 of 1 pictures", words[0], "b.png"], COMPARE, a, b, *words)
            self.succeeds(COMPARE, a, a, *words)
        self.assertEqual(self.report(a, b, "--min-psnr", 60, code=6)["worst"]["psnr"], "b")

    def test_what_does_not_count(self):
        values = np.full((20, 30, 3), 0.5, np.float32)
        cv2.imwrite(str(self.folder / "a.exr"), values)
        values[0, :] = 0.9
        values[10, 10, 1] = np.nan
        cv2.imwrite(str(self.folder / "b.exr"), values)
        found = self.report(self.folder / "a.exr", self.folder / "b.exr", "--border", 1)["all"]
        self.assertEqual((found["undefined"], found["pixels"], found["linear_psnr_db"]), (1, 18 * 28 - 1, None))
        self.assertIn("1 pixels are left out", self.succeeds(COMPARE, self.folder / "a.exr", self.folder / "b.exr"))
        self.fails(3, ["b.exr", "no pixel can be compared"], COMPARE, self.folder / "a.exr", self.folder / "b.exr",
                   "--border", 10)
        cv2.imwrite(str(self.folder / "c.exr"), values[:10])
        self.fails(3, ["c.exr", "30 x 10 pixels, expected 30 x 20"], COMPARE, self.folder / "a.exr",
                   self.folder / "c.exr")


if __name__ == "__main__":
    COMPARE, SYNTH, RENDERER = sys.argv[1:4]
    del sys.argv[1:4]
    unittest.main()
