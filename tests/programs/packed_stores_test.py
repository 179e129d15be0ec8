#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a packed store is a light field: every program accepts it and renders the same bits.

usage: packed_stores_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFIMPORT LFEXAMPLE
"""
import hashlib
import json
import sqlite3
import sys
import unittest

import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase
from small_field import HEIGHT, WIDTH, write_field, write_path

COMPRESSOR = RENDERER = PREPROCESSOR = IMPORT = EXAMPLE = None


class PackedStoreTest(ProgramTestCase):
    def frames(self, name, *arguments):
        out = self.folder / name
        self.succeeds(RENDERER, *arguments, "-o", out, "-q")
        digests = {frame.name: hashlib.sha256(frame.read_bytes()).hexdigest()
                   for frame in sorted(out.glob("frame_*.exr"))}
        self.assertTrue(digests)
        return digests

    def film(self, **keys):
        return write_field(self.folder / "field", **keys), write_path(self.folder, frames=4)

    def masked_film(self):
        """Returns a film with one LF image that has a mask file, and one with a gain."""
        field, path = self.film()
        text = json.loads(field.read_text())
        mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
        mask[:, :WIDTH // 2] = 0
        Image.fromarray(mask).save(self.folder / "field" / "mask.png")
        text["frames"][3]["lf_mask"] = "mask.png"
        text["frames"][4]["lf_gain"] = 1.25
        field.write_text(json.dumps(text))
        return field, path

    def pack(self, field, name="store", shard_bytes=0, packages=(), code=0):
        store = self.folder / name / "a store.lfs"
        store.parent.mkdir()
        shards = ["--shard-size", shard_bytes] if shard_bytes else []
        of_packages = [*packages, "--needed-pixels"] if packages else [field]
        self.succeeds(COMPRESSOR, *of_packages, "-o", store, "--profile", "lossless", *shards,
                      code=code)
        return store

    def packages(self, light_field, path, name="packages"):
        out = self.folder / name
        report = json.loads(self.succeeds(PREPROCESSOR, light_field, path, "-o", out, "--json",
                                          "--packages", "2"))
        self.assertEqual(len(report["packages"]), 2)
        return sorted(out.glob("*.lfp"))

    def test_a_store_renders_to_the_bits_of_the_folder(self):
        field, path = self.masked_film()
        expected = self.frames("files", field, path)
        for shard_bytes in (0, 50000):
            with self.subTest(shard_bytes=shard_bytes):
                store = self.pack(field, f"store{shard_bytes}", shard_bytes)
                self.assertEqual(len(list(store.parent.iterdir())) > 1, shard_bytes > 0)
                self.assertEqual(self.frames(f"codes{shard_bytes}", store, path), expected)
                self.assertEqual(self.frames(f"in{shard_bytes}", store.parent, path), expected)

    def test_packages_of_the_folder_take_their_images_from_a_store(self):
        field, path = self.masked_film()
        expected = self.frames("files", field, path)
        packages = self.packages(field, path)
        for name, of_packages in (("whole", ()), ("parts", packages)):
            with self.subTest(name=name):
                store = self.pack(field, name, packages=of_packages)
                self.assertEqual(
                    self.frames(f"codes-{name}", *packages, "--lightfield", store), expected)

    def test_a_package_whose_images_are_not_in_the_store_is_told(self):
        field, _ = self.film()
        left = self.packages(field, write_path(self.folder, 2, aperture=0.012, x=-0.02), "left")
        right = self.packages(field, write_path(self.folder, 2, aperture=0.012, x=0.02), "right")
        store = self.pack(field, packages=left)
        self.frames("codes", *left, "--lightfield", store)
        self.fails(3, ["package-0000.lfp", "lacks the image or some of its pixels", "the first: ",
                       "make the store again"],
                   RENDERER, *right, "--lightfield", store, "-o", self.folder / "none")

    def test_packages_are_made_of_a_store(self):
        field, path = self.masked_film()
        expected = self.frames("files", field, path)
        store = self.pack(field)
        packages = self.packages(store, path)
        self.assertEqual(self.frames("codes", *packages), expected)
        with sqlite3.connect(packages[0]) as package, sqlite3.connect(store) as codes:
            for name, size in package.execute(
                    "select name, file_bytes from lf_images where frames > 0"):
                self.assertEqual(codes.execute(
                    "select bytes from codes join lf_images using (id) where name = ?",
                    (name,)).fetchone(), (size,))
        moved = self.folder / "moved.lfs"
        store.rename(moved)
        self.fails(3, ["package-0000.lfp: its light field is not at", "a store.lfs: no such file",
                       "--lightfield"], RENDERER, packages[0], "-o",
                   self.folder / "gone")
        self.assertEqual(self.frames("again", *packages, "--lightfield", moved), expected)

    def test_another_light_field_is_an_input_error(self):
        field, path = self.film()
        packages = self.packages(field, path)
        other = write_field(self.folder / "other", fl_x=71)
        self.fails(3, ["was made from another light field"], RENDERER, *packages, "--lightfield",
                   self.pack(other), "-o", self.folder / "none")

    def test_images_that_could_not_be_read_are_skipped(self):
        field, path = self.film()
        (self.folder / "field" / "image_12.png").write_text("no picture")
        store = self.pack(field, code=6)
        out = self.folder / "out"
        self.succeeds(RENDERER, store, path, "-o", out, "-q", code=6)
        report = json.loads((out / "report.json").read_text())
        self.assertEqual([skipped["name"] for skipped in report["skipped_lf_images"]], ["image_12.png"])
        accept = ["--allow-missing", 1]
        self.assertEqual(self.frames("files", field, path, *accept),
                         self.frames("codes", store, path, *accept))

    def test_what_is_no_store_is_told(self):
        field, path = self.film()
        store = self.pack(field)
        self.fails(3, ["two.lfs", "no such file"], RENDERER, store.parent / "two.lfs", path, "-o",
                   self.folder / "a")
        (store.parent / "two.lfs").write_bytes(store.read_bytes())
        self.fails(3, ["such as a store.lfs and two.lfs"], RENDERER, store.parent, path, "-o",
                   self.folder / "a")
        (store.parent / "two.lfs").write_text("x" * 5000)
        self.fails(3, ["two.lfs: is no packed store"], RENDERER, store.parent / "two.lfs", path,
                   "-o", self.folder / "a")
        self.fails(2, ["--focal-px"], RENDERER, store, path, "--focal-px", "7", "-o",
                   self.folder / "a")

    def test_lfexample_and_lfimport_take_a_store(self):
        field, _ = self.film()
        store = self.pack(field)
        path = self.folder / "example.yaml"
        self.succeeds(EXAMPLE, store, "-o", path)
        of_files = self.folder / "files.yaml"
        self.succeeds(EXAMPLE, field, "-o", of_files)
        keys = "camera", "lens"
        for line, expected in zip(path.read_text().splitlines(), of_files.read_text().splitlines()):
            if line.startswith(keys):
                self.assertEqual(line, expected)
        for check in "headers", "pixels":
            report = json.loads(self.succeeds(IMPORT, store, "--json", "--check", check))
            self.assertEqual(report["images"]["count"] if isinstance(report["images"], dict)
                             else report["images"], 25)
            self.assertTrue(report["first_image"].endswith("a store.lfs/image_00.png"))
        self.fails(2, ["a packed store cannot be converted"], IMPORT, store, "-o",
                   self.folder / "native")
        self.fails(2, ["--bayer", "packed store"], IMPORT, store, "--bayer", "RGGB")
        self.damage(store, 3)
        self.succeeds(IMPORT, store)
        self.fails(6, ["0 of 25 images are missing, 1 broken"], IMPORT, store, "--check", "pixels")

    def damage(self, store, image):
        with sqlite3.connect(store) as database:
            code, = database.execute("select code from blobs where id = ?", (image,)).fetchone()
            code = bytearray(code)
            code[len(code) // 2] ^= 1
            database.execute("update blobs set code = ? where id = ?", (bytes(code), image))


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, IMPORT, EXAMPLE = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1])
