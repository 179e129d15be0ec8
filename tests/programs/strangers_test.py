#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests light fields as users bring them: faults are reported with helpful messages, or do not matter.

usage: strangers_test.py LFIMPORT LFEXAMPLE LFRENDERER
"""
import json
import pathlib
import sys
import unittest

from PIL import Image

from program_test_case import ProgramTestCase
from small_field import SIDE, write_field, write_path

IMPORT = EXAMPLE = RENDERER = None


class StrangersTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.calibration = write_field(self.folder / "my field")
        self.field = self.calibration.parent
        self.path = write_path(self.folder, frames=1, aperture=0.03)

    def edit(self, change):
        calibration = json.loads(self.calibration.read_text())
        change(calibration)
        self.calibration.write_text(json.dumps(calibration))

    def name_frames(self, name):
        def change(calibration):
            for frame in calibration["frames"]:
                frame["file_path"] = name(frame["file_path"])
        self.edit(change)

    def renders(self):
        out = self.folder / "frames"
        self.succeeds(RENDERER, self.field, self.path, "-o", out, "--overwrite")
        return (out / "frame_0001.exr").read_bytes()

    def everywhere_fails(self, *words):
        self.fails(3, words, IMPORT, self.field)
        self.fails(3, words, EXAMPLE, self.field, "-o", self.folder / "p.yaml")
        self.fails(3, words, RENDERER, self.field, self.path, "-o", self.folder / "frames")

    # Oddities that do not matter

    def test_names_may_be_of_another_system(self):
        expected = self.renders()
        images = self.field / "images"
        images.mkdir()
        for image in self.field.glob("*.png"):
            image.rename(images / image.name)
        for name in (lambda n: "images\\" + n, lambda n: "C:\\Users\\me\\images\\" + n,
                     lambda n: "./images/" + n[:-4], lambda n: "images/" + n.upper()):
            with self.subTest(name("a.png")):
                before = self.calibration.read_text()
                self.name_frames(name)
                self.assertEqual(self.renders(), expected)
                self.calibration.write_text(before)
        (self.folder / "elsewhere").mkdir()
        images.rename(self.folder / "elsewhere" / "images")
        images.symlink_to(self.folder / "elsewhere" / "images")
        self.name_frames(lambda n: "images/" + n)
        self.assertEqual(self.renders(), expected)

    def test_names_may_hold_blanks_and_umlauts(self):
        expected = self.renders()
        for image in list(self.field.glob("*.png")):
            image.rename(self.field / f"Bild ä {image.name}")
        self.name_frames(lambda n: "Bild ä " + n)
        self.assertEqual(self.renders(), expected)

    def test_sizes_may_be_missing_and_a_byte_order_mark_there(self):
        expected = self.renders()
        self.edit(lambda calibration: [calibration.pop(key) for key in ("w", "h", "cx", "cy")])
        self.calibration.write_bytes(b"\xef\xbb\xbf" + self.calibration.read_bytes())
        self.assertEqual(self.renders(), expected)

    # Faults that are reported

    def test_photographs_alone_are_told_what_they_lack(self):
        self.calibration.unlink()
        self.everywhere_fails(f"holds {SIDE * SIDE} images, such as image_00.png, but no file",
                              "COLMAP", "sparse/0")
        for image in self.field.glob("*.png"):
            image.unlink()
        result = self.call(IMPORT, self.field)
        self.assertNotIn("images, such as", result.stderr)

    def test_what_is_no_json_is_told_why(self):
        text = self.calibration.read_text()
        for wrong, words in ((text.replace("}]", "},]"), "a comma too many"),
                             ("", "the file is empty")):
            with self.subTest(words):
                self.calibration.write_text(wrong)
                self.everywhere_fails("transforms.json: is not JSON", words)
        self.calibration.write_bytes(text.encode("utf-16"))
        self.everywhere_fails("UTF-8")

    def test_numbers_that_are_missing_or_wild_are_named(self):
        text = self.calibration.read_text()
        for key in ("fl_x", "fl_y"):
            self.edit(lambda calibration, key=key: calibration.pop(key))
        self.everywhere_fails("the focal length is missing", "camera_angle_x")
        self.calibration.write_text(text)
        self.edit(lambda c: c["frames"][3]["transform_matrix"][0].__setitem__(3, 1e300))
        self.everywhere_fails("frames[3] (image_03.png)", "holds 1e+300, expected")
        self.calibration.write_text(text.replace("[1, 0, 0, ", "[NaN, 0, 0, ", 1))
        self.everywhere_fails("frames[0] (image_00.png)", '"transform_matrix" is [["NaN",0,0,', "finite")

    def test_a_missing_image_is_told_what_is_nearby(self):
        (self.field / "image_07.png").rename(self.field / "image_7 (1).png")
        report = json.loads(self.succeeds(IMPORT, self.field, "--json", code=6))
        self.assertIn("image_07.png: no such file; similar there: image_7 (1).png",
                      report["warnings"][0]["message"])
        self.fails(6, ["image_07.png", "similar there: image_7 (1).png"], RENDERER, self.field,
                   self.path, "-o", self.folder / "frames")
        (self.field / "image_7 (1).png").unlink()
        self.fails(6, ["its folder holds 25 files, such as image_00.png"], RENDERER, self.field,
                   self.path, "-o", self.folder / "frames", "--overwrite")

    def test_a_missing_folder_is_named(self):
        for image in self.field.glob("*.png"):
            image.unlink()
        (self.field / "pictures").mkdir()
        self.name_frames(lambda n: "images/" + n)
        self.fails(3, [f"there is no folder {self.field}/images: {self.field} holds pictures/"],
                   RENDERER, self.field, self.path, "-o", self.folder / "frames")
        (self.field / "images").symlink_to("/nowhere/images")
        self.fails(3, ["is a link to /nowhere/images, which is not there"], EXAMPLE, self.field, "-o",
                   self.folder / "p.yaml")

    def test_broken_images_are_named_and_counted(self):
        (self.field / "image_07.png").write_bytes(b"")
        image = self.field / "image_08.png"
        image.write_bytes(image.read_bytes()[:600])
        Image.open(self.field / "image_05.png").resize((32, 24)).save(self.field / "image_05.png")
        self.fails(6, ["2 of"], RENDERER, self.field, self.path, "-o", self.folder / "frames")
        report = json.loads(self.succeeds(IMPORT, self.field, "--check", "pixels", "--json", code=6))
        self.assertEqual(report["broken"], 3)

    def test_images_listed_twice_give_no_path(self):
        self.edit(lambda calibration: calibration["frames"].extend(calibration["frames"]))
        self.fails(3, ["have only", "listed twice"], EXAMPLE, self.field, "-o",
                   self.folder / "p.yaml")
        self.assertFalse((self.folder / "p.yaml").exists())
        report = json.loads(self.succeeds(IMPORT, self.field, "--json"))
        self.assertEqual([w["kind"] for w in report["warnings"]], ["repeated-positions"])


if __name__ == "__main__":
    IMPORT, EXAMPLE, RENDERER = map(pathlib.Path, sys.argv[1:4])
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
