#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a packed store of packages that is filmed alone gives the film of the whole light field, or is refused.

usage: store_alone_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFIMPORT LFEXAMPLE LFDENSIFY
"""
import hashlib
import json
import shutil
import sqlite3
import sys
import unittest

import numpy as np

import small_field
from program_test_case import ProgramTestCase
from small_field import HEIGHT, WIDTH, write_field, write_path

SIDE = 9
COMPRESSOR = RENDERER = PREPROCESSOR = IMPORT = EXAMPLE = DENSIFY = None
CUTS = {"default": [], "nearest": ["--estimator", "nearest"], "area": ["--lens-weights", "area"],
        "hat": ["--lens-weights", "hat"], "none": ["--lens-weights", "none"],
        "hybrid": ["--mode", "hybrid"], "rebin": ["--mode", "rebin"]}
RULES = {"most": ["--max-images", 5], "noise": ["--stop-when", "noise<=0.05"], "samples": ["--stop-when", "samples>=3"],
         "seed": ["--seed", 7, "--max-images", 5], "area order": ["--order", "area", "--max-images", 5],
         "groups": ["--order", "groups", "--max-images", 5]}


def smooth(index):
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    waves = 128 + 100 * np.sin(x / 9 + index / 5) * np.cos(y / 7)
    noise = np.random.default_rng(index).normal(0, 2, (HEIGHT, WIDTH, 3))
    return np.clip(waves[..., None] + [0, 8, -8] + noise, 0, 255).astype(np.uint8)


class StoreAloneTest(ProgramTestCase):
    """Has a film that needs a corner of a light field."""

    def setUp(self):
        super().setUp()
        small_field.SIDE = SIDE
        self.field = write_field(self.folder / "field", smooth)
        self.path = self.path_at("corner", -0.02)

    def path_at(self, name, x, aperture=0.037):
        folder = self.folder / name
        folder.mkdir()
        path = write_path(folder, frames=2, aperture=aperture, x=x)
        text = path.read_text().replace("view_deg: 50", "view_deg: 20")
        # A lens off the plane of the LF cameras, so that each element sees others through it.
        path.write_text(text.replace(f"position: [{x}, 0, 0]", f"position: [{x}, 0, 0.02]"))
        return path

    def packages(self, *options, path=None, name="packages", light_field=None):
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        self.succeeds(PREPROCESSOR, light_field or self.field, path or self.path, "-o", out, "--packages", 2, *options)
        return sorted(out.glob("*.lfp"))

    def compress(self, *inputs, name="part", profile="lossless", code=0):
        store = self.folder / f"{name}.lfs"
        report = json.loads(self.succeeds(COMPRESSOR, *inputs, "-o", store, "--profile", profile, "--overwrite",
                                          "--json", code=code))
        return store, report

    def film(self, *inputs, code=0):
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        self.succeeds(RENDERER, *inputs, "-o", out, "-q", "--no-contact-sheet", code=code)
        reports = [json.loads(report.read_text()) for report in sorted(out.glob("report*.json"))]
        digests = {frame.name: hashlib.sha256(frame.read_bytes()).hexdigest() for frame in sorted(out.glob("*.exr"))}
        self.assertEqual(len(digests), 2)
        return digests, [image for report in reports for image in report["skipped_lf_images"]]

    def refused(self, *inputs):
        out = self.folder / "refused"
        self.fails(3, ["packed store", "compress"], RENDERER, *inputs, "-o", out)
        self.assertFalse(list(out.glob("*.exr")))

    # Films

    def test_it_has_the_bits_of_the_whole(self):
        for name, options in CUTS.items():
            with self.subTest(name):
                limit = ["--max-rays", 200000] if "--mode" in options else []
                store, report = self.compress(*self.packages(*options))
                expected = self.film(self.field, self.path, *options, *limit)
                self.assertEqual(self.film(store, self.path, *options, *limit), expected)
                self.assertGreater(report["lf_images_left_out"], 30)
                self.assertEqual(report["lf_images"] + report["lf_images_left_out"], SIDE * SIDE)
                needed, _ = self.compress(*self.packages(*options), "--needed-pixels", name="needed")
                self.assertEqual(self.film(needed, self.path, *options, *limit), expected)

    def test_so_it_has_with_rules_that_depend_on_the_order(self):
        store, _ = self.compress(*self.packages())
        for name, rule in RULES.items():
            with self.subTest(name):
                self.assertEqual(self.film(store, self.path, *rule), self.film(self.field, self.path, *rule))

    def test_a_lossy_one_has_the_bits_of_the_whole_lossy_store(self):
        for name in ("default", "nearest", "hat"):
            with self.subTest(name):
                part, _ = self.compress(*self.packages(*CUTS[name]), profile="default")
                whole, _ = self.compress(self.field, name="whole", profile="default")
                self.assertEqual(self.film(part, self.path, *CUTS[name]), self.film(whole, self.path, *CUTS[name]))

    def test_pixels_that_show_points_are_known_though_their_images_are_left_out(self):
        """Three LF images tell whether pixels show points, and a store may hold none of them."""
        def checks(index):
            cells = np.add.outer(np.arange(HEIGHT) // 3, (np.arange(WIDTH) + index) // 3) % 2
            return np.repeat((cells * 180 + 30).astype(np.uint8)[..., None], 3, axis=2)
        self.field = write_field(self.folder / "checks", checks)
        store, _ = self.compress(*self.packages())
        with sqlite3.connect(store) as database:
            self.assertEqual(database.execute("select value from settings where key = 'footprint'").fetchone(),
                             ("points",))
        self.assertEqual(self.film(store, self.path), self.film(self.field, self.path))

    def test_packages_and_shards_made_of_it_have_the_same_bits(self):
        expected, _ = self.film(self.field, self.path)
        store, _ = self.compress(*self.packages())
        self.assertEqual(self.film(*self.packages(name="again", light_field=store))[0], expected)
        self.assertEqual(self.film(*self.packages(), "--lightfield", store)[0], expected)

    def test_images_that_cannot_be_read_are_skipped_as_they_are_in_the_whole(self):
        packages = self.packages()
        with sqlite3.connect(packages[0]) as package:
            names = [name for name, in package.execute("select name from lf_images where frames > 0 order by id")]
        (self.folder / "field" / names[1]).write_text("no picture")
        expected = self.film(self.field, self.path, code=6)
        store, report = self.compress(*packages, code=6)
        self.assertEqual(report["lf_images_skipped"], 1)
        frames, skipped = self.film(store, self.path, code=6)
        self.assertEqual(frames, expected[0])
        self.assertEqual([image["name"] for image in skipped], [image["name"] for image in expected[1]])

    # Refusals

    def test_another_film_is_right_or_refused(self):
        store, _ = self.compress(*self.packages())
        narrower = self.path_at("narrower", -0.02, aperture=0.02)
        self.assertEqual(self.film(store, narrower), self.film(self.field, narrower))
        beside = self.path_at("beside", 0.02)
        self.refused(store, beside)
        self.fails(3, ["packed store", "compress"], PREPROCESSOR, store, beside, "-o", self.folder / "none")
        self.refused(store, self.path_at("wider", -0.02, aperture=0.08))

    def test_the_calibration_is_found_or_asked_for(self):
        moved = self.folder / "elsewhere"
        (self.folder / "field").rename(moved)
        images = self.folder / "images"
        images.mkdir()
        for image in moved.glob("*.png"):
            image.rename(images / image.name)
        packages = self.packages("--images", images, light_field=moved)
        expected = self.film(moved, self.path, "--images", images)
        store, _ = self.compress(*packages)
        self.assertEqual(self.film(store, self.path), expected)
        gone = self.folder / "gone.json"
        (moved / "transforms.json").rename(gone)
        self.fails(3, ["package-0000.lfp", "calibration of all LF cameras", "--lightfield"],
                   COMPRESSOR, *packages, "-o", self.folder / "none.lfs")
        store, _ = self.compress(*packages, "--lightfield", gone, "--images", images)
        self.assertEqual(self.film(store, self.path), expected)
        text = json.loads(gone.read_text())
        text["frames"][0]["transform_matrix"][0][3] += 0.001
        gone.write_text(json.dumps(text))
        self.fails(3, ["was made from another light field"],
                   COMPRESSOR, *packages, "--lightfield", gone, "--images", images, "-o", self.folder / "none.lfs")

    # Other programs

    def test_images_that_are_left_out_are_not_missing(self):
        store, report = self.compress(*self.packages())
        for check in ("headers", "pixels"):
            told = json.loads(self.succeeds(IMPORT, store, "--check", check, "--json"))
            self.assertEqual((told["images"], told["missing"], told["broken"]), (SIDE * SIDE, 0, 0))
            self.assertEqual(told["not_stored"], report["lf_images_left_out"])
        self.assertIn(f"{report['lf_images_left_out']} not in the store", self.succeeds(IMPORT, store))
        whole, _ = self.compress(self.field, name="whole")
        self.assertNotIn("not_stored", json.loads(self.succeeds(IMPORT, whole, "--json")))
        self.succeeds(EXAMPLE, store, "-o", self.folder / "example.yaml")
        self.fails(3, ["densify the light field that it was made from"], DENSIFY, store, "-o",
                   self.folder / "dense.lfs", "--force")
        self.assertFalse(list(self.folder.glob("dense.lfs*")))

    def test_verify_checks_the_images_that_are_stored(self):
        packages = self.packages()
        store, report = self.compress(*packages)
        checked = json.loads(self.succeeds(COMPRESSOR, *packages, "-o", store, "--profile", "lossless", "--verify",
                                           "--json"))
        self.assertEqual((checked["verified"], checked["was_there"]), (report["lf_images"], True))
        self.fails(3, ["packed store was made with"], COMPRESSOR, self.field, "-o", store, "--profile", "lossless",
                   "--verify")

    def test_a_store_of_an_earlier_build_is_told(self):
        """Such a store holds the LF cameras of the LF images that packages read, and no others."""
        packages = self.packages()
        store, _ = self.compress(*packages)
        with sqlite3.connect(store) as database:
            database.execute("update settings set value = '90' where key = 'light_field.images'")
        result = self.call(IMPORT, store)
        self.assertEqual(result.returncode, 0)
        self.assertIn("kept 81 of 90 LF cameras", result.stderr)
        self.assertIn("other lens weights", result.stderr)


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, IMPORT, EXAMPLE, DENSIFY = sys.argv[1:7]
    unittest.main(argv=sys.argv[:1] + sys.argv[7:], verbosity=2)
