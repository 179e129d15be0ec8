#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests packed stores that keep image files as they are: smaller than encoded images, and exact.

usage: kept_files_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFDENSIFY LFSYNTH
"""
import json
import sqlite3
import sys
import unittest

import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase
from small_field import HEIGHT, WIDTH, write_field, write_path

COMPRESSOR = RENDERER = PREPROCESSOR = DENSIFY = SYNTH = None


def rough(index):
    """Returns a picture with detail, which JPEG files hold in fewer bytes than lossless ones."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    waves = 128 + 60 * np.sin(x / 3 + index / 5) * np.cos(y / 2)
    noise = np.random.default_rng(index).normal(0, 12, (HEIGHT, WIDTH, 3))
    return np.clip(waves[..., None] + [0, 20, -20] + noise, 0, 255).astype(np.uint8)


def as_jpegs(field):
    """Makes JPEG files of the PNG files of a light field, and returns it."""
    text = json.loads(field.read_text())
    for frame in text["frames"]:
        png = field.parent / frame["file_path"]
        Image.open(png).convert("RGB").save(png.with_suffix(".jpg"), quality=85)
        png.unlink()
        frame["file_path"] = str(png.with_suffix(".jpg").relative_to(field.parent))
    field.write_text(json.dumps(text))
    return field


class KeptFilesTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.store = self.folder / "a.lfs"
        self.path = write_path(self.folder, 2)
        self.pngs = write_field(self.folder / "png", rough)
        self.jpegs = as_jpegs(write_field(self.folder / "jpeg", rough))

    def report(self, *arguments, code=0):
        return json.loads(self.succeeds(COMPRESSOR, *arguments, "--json", code=code))

    def frames(self, name, light_field, *options):
        """Returns the pictures of a film, as bytes."""
        self.succeeds(RENDERER, light_field, *options, "-o", self.folder / name, "--format", "exr", "-q")
        return [file.read_bytes() for file in sorted((self.folder / name).glob("frame_*.exr"))]

    def kinds(self, store):
        with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
            return [kind for kind, in database.execute("select kind from codes order by id")]

    def assertSamePictures(self, a, b):
        """Compares pixels, because the metadata of frames name their light field."""
        for x, y in zip(a, b, strict=True):
            self.assertEqual(x, y)

    def test_files_that_are_smaller_are_kept(self):
        report = self.report(self.jpegs, "-o", self.store, "--profile", "lossless", "--verify")
        self.assertEqual((report["coded"], report["files_kept"], report["verified"]), (25, 25, 25))
        self.assertEqual((report["code_bytes"], report["psnr_db"]), (report["source_bytes"], "exact"))
        self.assertEqual(self.kinds(self.store), ["file"] * 25)
        self.assertIn("or the image file if it is smaller", report["codec"])
        with sqlite3.connect(f"file:{self.store}?immutable=1", uri=True) as database:
            code = database.execute("select code from blobs join lf_images using (id) where name = 'image_07.jpg'")
            self.assertEqual(code.fetchone()[0][:-8], (self.folder / "jpeg/image_07.jpg").read_bytes())
        self.assertIn("kept      25 of 25 LF images as their files", self.succeeds(
            COMPRESSOR, self.jpegs, "-o", self.store, "--profile", "lossless", "--overwrite"))
        report = self.report(self.jpegs, "-o", self.store, "--profile", "lossless", "--reencode", "--overwrite",
                             "--verify")
        self.assertEqual((report["files_kept"], report["psnr_db"]), (0, "exact"))
        self.assertGreater(report["code_bytes"], report["source_bytes"])
        self.fails(3, ["made with the encoding"], COMPRESSOR, self.jpegs, "-o", self.store, "--profile", "lossless",
                   "--verify")

    def test_the_smaller_one_is_chosen_for_each_image(self):
        # An empty picture takes few bytes as a PNG; noise takes fewer by the lossy codec.
        Image.fromarray(np.full((HEIGHT, WIDTH, 3), 90, np.uint8)).save(self.folder / "png/image_03.png")
        report = self.report(self.pngs, "-o", self.store, "--verify")
        kinds = self.kinds(self.store)
        sizes = {"file": 0, "uint8": 0}
        for kind in kinds:
            sizes[kind] += 1
        self.assertEqual(report["files_kept"], sizes["file"])
        self.assertGreater(sizes["uint8"], 20)
        self.assertLess(report["code_bytes"], report["source_bytes"])

    def test_the_profile_recorded_gives_the_bits_of_the_folder(self):
        for field, name in ((self.pngs, "png"), (self.jpegs, "jpeg")):
            report = self.report(field, "-o", self.store, "--profile", "recorded", "--overwrite", "--verify",
                                 "--shard-size", "20k")
            self.assertEqual((report["files_kept"], report["psnr_db"]), (25, "exact"))
            self.assertTrue(report["codec"].startswith("lossless"))
            self.assertSamePictures(self.frames(f"{name}_folder", field, self.path),
                                    self.frames(f"{name}_store", self.store, self.path))
        for words, options in ((["--reencode", "--profile recorded"], ["--reencode"]),
                               (["recorded, which drops no details"], ["--threshold", 2])):
            self.fails(2, words, COMPRESSOR, self.pngs, "-o", self.folder / "b.lfs", "--profile", "recorded", *options)

    def test_packages_keep_files_of_the_images_that_they_need(self):
        packages = self.folder / "packages"
        path = write_path(self.folder, 2, aperture=0.012, x=-0.02)
        path.write_text(path.read_text().replace("view_deg: 50", "view_deg: 15"))  # a part of each LF image
        self.succeeds(PREPROCESSOR, self.jpegs, path, "-o", packages)
        files = sorted(packages.glob("*.lfp"))
        for name, options, kept in (("whole", [], True), ("part", ["--needed-pixels"], False)):
            store = self.folder / f"{name}.lfs"
            report = self.report(*files, "-o", store, "--profile", "recorded", *options)
            self.assertLess(report["lf_images"], 25)
            self.assertEqual(report["files_kept"], report["lf_images"] if kept else 0)
            self.assertSamePictures(self.frames(f"{name}_folder", files[0]),
                                    self.frames(f"{name}_store", files[0], "--lightfield", store))

    def test_a_file_that_has_changed_is_found(self):
        self.report(self.jpegs, "-o", self.store, "--profile", "recorded")
        other = self.folder / "jpeg/image_11.jpg"
        Image.fromarray(rough(77)).save(other, quality=85)
        self.fails(3, ["1 of 25 LF images are wrong", "image_11.jpg"], COMPRESSOR, self.jpegs, "-o", self.store,
                   "--profile", "recorded", "--verify")
        # A broken file is left out, as from every store.
        other.write_bytes(other.read_bytes()[:300])
        report = self.report(self.jpegs, "-o", self.folder / "b.lfs", "--profile", "recorded", code=6)
        self.assertEqual([skipped["name"] for skipped in report["skipped"]], ["image_11.jpg"])

    def test_densified_stores_keep_files(self):
        folder = self.folder / "synth"
        self.succeeds(SYNTH, "still-life", "-o", folder, "--count", 25, "--size", "96x64", "--spacing", 0.02,
                      "--distance", 0.8, "--format", "png", "-q")
        field = as_jpegs(folder / "transforms.json")
        self.report(field, "-o", self.store, "--profile", "recorded")
        for source, name in ((field, "of_files"), (self.store, "of_a_store")):
            dense = self.folder / f"{name}.lfs"
            self.succeeds(DENSIFY, source, "-o", dense, "--force", "--most", 20, "--cache", "none", "-q")
            kinds = self.kinds(dense)
            self.assertEqual(kinds.count("file"), 25)
            self.assertEqual(kinds.count("uint8"), len(kinds) - 25)
            self.assertGreater(len(kinds), 25)


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, DENSIFY, SYNTH = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1], verbosity=2)
