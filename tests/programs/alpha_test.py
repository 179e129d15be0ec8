#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests images with alpha: masks, and an object on any background, compared with exact lens pictures.

usage: alpha_test.py LFRENDERER LFIMPORT LFCOMPRESSOR LFPREPROCESSOR
"""
import functools
import json
import os
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np
from PIL import Image

from drawn_cards import lens_picture, psnr_db, srgb_of, write_field, write_path
from program_test_case import ProgramTestCase

RENDERER = IMPORTER = COMPRESSOR = PREPROCESSOR = None
APERTURE = 0.05
LEAST_PSNR_DB = 38


@functools.cache
def true_picture():
    grid = np.linspace(-1, 1, 19)
    return lens_picture([(APERTURE / 2 * x, APERTURE / 2 * y) for x in grid for y in grid
                         if np.hypot(x, y) <= 1])


class AlphaTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        write_path(self.folder, APERTURE)

    def field(self, write):
        return write_field(self.folder / f"field_{write.__name__}", write)

    @staticmethod
    def straight(file, light, opacity):
        colour = srgb_of(light / np.maximum(opacity, 1e-9))
        rgba = np.concatenate([colour * (opacity > 0), opacity], -1)
        Image.fromarray((rgba * 255).round().astype(np.uint8)).save(file.with_suffix(".png"))

    @staticmethod
    def premultiplied(file, light, opacity):
        bgra = np.concatenate([light[..., ::-1], opacity], -1).astype(np.float32)
        cv2.imwrite(str(file.with_suffix(".exr")), bgra)

    def frame(self, field, *options):
        out = self.folder / f"frames {len(list(self.folder.iterdir()))}"
        result = self.call(RENDERER, field, self.folder / "path.yaml", "-o", out, "--format", "exr-float",
                           "--no-contact-sheet", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        picture = cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)
        return picture[..., ::-1], result.stderr

    def expect_true(self, field, background, words=()):
        light, opacity = true_picture()
        frame, messages = self.frame(field, *(["--background", ",".join(map(str, background))]
                                              if background != (0, 0, 0) else []))
        self.assertGreater(psnr_db(frame, light + (1 - opacity) * background), LEAST_PSNR_DB)
        for word in words:
            self.assertIn(word, messages)

    def test_an_object_is_filmed_over_any_background(self):
        field = self.field(self.straight)
        self.expect_true(field, (0, 0, 0), ["straight light over black", "--image-alpha"])
        self.expect_true(field, (1, 1, 1), ["straight light over white"])
        self.expect_true(field, (0.2, 0.5, 0.9))

    def test_renderers_write_premultiplied_light(self):
        field = self.field(self.premultiplied)
        self.expect_true(field, (0, 0, 0), ["premultiplied light over black"])
        self.expect_true(field, (0.2, 0.5, 0.9))

    def test_no_light_beside_the_object(self):
        frame, _ = self.frame(self.field(self.straight))
        _, opacity = true_picture()
        near = cv2.dilate((opacity[..., 0] > 0).astype(np.uint8), np.ones((9, 9)))  # prefilters reach as far
        self.assertEqual(np.count_nonzero(frame[near == 0]), 0)

    def test_masks_take_rays_away(self):
        field = self.field(self.straight)
        light, opacity = true_picture()
        # A mask says nothing about the part of the lens that sees past the object, so the edge is hard.
        edge = (opacity[..., 0] > 0.5) & (opacity[..., 0] < 0.9)

        def brighter(*options):
            return np.mean(self.frame(field, *options)[0][edge] - light[edge])
        self.assertGreater(brighter("--image-alpha", "mask", "--fill", "off"), 2 * abs(brighter()))

    def test_packed_stores_keep_alpha_and_take_another_background(self):
        field = self.field(self.straight)
        store = self.folder / "a.lfs"
        self.succeeds(COMPRESSOR, field, "-o", store, "--profile", "lossless")
        for options in ([], ["--background", "white"], ["--mode", "rebin"], ["--mode", "hybrid"]):
            np.testing.assert_array_equal(self.frame(store, *options)[0], self.frame(field, *options)[0])
        self.fails(2, ["--image-alpha mask", "stored as opacity", "compress"], RENDERER, store,
                   self.folder / "path.yaml", "-o", self.folder / "refused", "--image-alpha", "mask")

    def test_packages_keep_the_background_that_they_were_made_with(self):
        field = self.field(self.straight)
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, field, self.folder / "path.yaml", "-o", packages, "--background", "white")
        package, = packages.glob("*.lfp")
        out = self.folder / "film"
        self.succeeds(RENDERER, package, "-o", out, "--format", "exr-float", "--no-contact-sheet")
        np.testing.assert_array_equal(
            cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., ::-1],
            self.frame(field, "--background", "white")[0])
        for option in (["--background", "black"], ["--image-alpha", "mask"]):
            for moved in ([], ["--lightfield", field]):
                self.fails(2, ["cannot be used with packages"], RENDERER, package, "-o",
                           self.folder / "refused", *option, *moved)
            self.fails(2, ["cannot be used with packages"], COMPRESSOR, package, "-o",
                       self.folder / "refused.lfs", *option)
        self.fails(2, ["--image-scale cannot be used with packages"], COMPRESSOR, package, "-o",
                   self.folder / "refused.lfs", "--image-scale", "0.5")

    def test_lfimport_writes_down_what_it_found(self):
        field = self.field(self.straight)
        report = self.succeeds(IMPORTER, field, "-o", self.folder / "native")
        self.assertIn("straight light over black", report)
        written = json.loads((self.folder / "native" / "transforms.json").read_text())
        self.assertEqual(written["lf_alpha"], "straight")
        self.assertEqual(written["lf_background"], [0, 0, 0])
        np.testing.assert_array_equal(self.frame(self.folder / "native")[0], self.frame(field)[0])
        self.assertEqual(json.loads(self.succeeds(IMPORTER, field, "--json"))["alpha"],
                         {"meaning": "straight", "background": [0, 0, 0]})

    def test_what_cannot_be_is_said(self):
        def opaque(file, light, opacity):
            Image.fromarray((light * 255).astype(np.uint8)).save(file.with_suffix(".png"))
        field = self.field(opaque)
        for words, options in [
                (["--background", "has no effect on"], ["--background", "white"]),
                (["--background", "expected black"], ["--background", "1,2"]),
                (["--background"], ["--background", ""]),
                (["--background", "expected black"], ["--background", "blue"]),
                (["brighter than lf_max_radiance, 1"],
                 ["--background", "2,0,0", "--image-alpha", "straight"])]:
            self.fails(2, words, RENDERER, field, self.folder / "path.yaml", "-o", self.folder / "out",
                       *options)


if __name__ == "__main__":
    RENDERER, IMPORTER, COMPRESSOR, PREPROCESSOR = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1], verbosity=2)
