#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the first picture of captures as people have them: lfimport, lfexample and lfrenderer without further options
make one whose subject is sharp.

usage: first_pictures_test.py LFIMPORT LFEXAMPLE LFRENDERER [CONTACT_SHEET.png]
"""
import json
import os
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np
from PIL import Image

from drawn_cards import FOCUS, SIDE, srgb_of, write_field
from first_picture_case import FirstPictureCase, detail, expose, grey, write_sheet

FAR = 2.5
MIDDLE = "084"  # the LF camera in the middle


def card_and_wall(x, y, depth):
    """A textured card in the middle, at FOCUS, in front of a dimmer wall."""
    scale = 0.9 / depth
    wave = np.sin(70 * scale * x + 9 * np.sin(8 * scale * y)) * np.cos(62 * scale * y - 7 * scale * x)
    light = np.stack([0.45 + 0.3 * wave, 0.4 + 0.3 * wave ** 2, 0.35 - 0.2 * wave], -1)
    if depth == FOCUS:
        return light, ((np.abs(x) < 0.3) & (np.abs(y) < 0.22)).astype(float)
    return 0.4 * light, np.ones(x.shape)


CARD = {"scene": card_and_wall, "depths": (FOCUS,)}
CARD_AND_WALL = {"scene": card_and_wall, "depths": (FOCUS, FAR)}


def png(file, light, opacity):
    del opacity
    Image.fromarray((srgb_of(light) * 255).round().astype(np.uint8)).save(file.with_suffix(".png"))


def rgba(file, light, opacity):
    colour = srgb_of(light / np.maximum(opacity, 1e-9)) * (opacity > 0)
    Image.fromarray((np.concatenate([colour, opacity], -1) * 255).round().astype(np.uint8)).save(
        file.with_suffix(".png"))


def change(field, edit):
    """Replaces transforms.json by edit(its content)."""
    calibration = field / "transforms.json"
    text = json.loads(calibration.read_text())
    edit(text)
    calibration.write_text(json.dumps(text))


def each_picture(field, edit):
    for file in sorted(field.glob("*.png")):
        edit(Image.open(file)).save(file)


class FirstPicturesTest(FirstPictureCase):
    def capture(self, write=png, scene=None):
        return write_field(self.folder / "capture", write, scene or CARD_AND_WALL)

    def shows_the_card(self, name, capture, lf_image=None, **call):
        """The middle of the picture must show the same as the middle of the LF image at which the path starts."""
        picture, focus, start = self.first_picture(name, capture, **call)
        self.assertAlmostEqual(focus, FOCUS, delta=0.02 * FOCUS)
        self.expect_sharp(picture, lf_image or Image.open(capture / start))

    def expect_sharp(self, picture, lf_image):
        """Compares the middle of the card in both images, at the size of the picture."""
        def middle(image):
            image = grey(image)
            y, x = image.shape[0] // 2, image.shape[1] // 2
            half = min(image.shape) // 4
            return image[y - half:y + half, x - half:x + half]
        ours, theirs = middle(picture), middle(lf_image)
        found = cv2.matchTemplate(theirs, ours[4:-4, 4:-4], cv2.TM_CCOEFF_NORMED)
        self.assertGreater(found.max(), 0.97)
        self.assertGreater(detail(ours), 0.6 * detail(theirs))

    def test_a_plain_capture(self):
        self.shows_the_card("plain", self.capture())

    def test_an_object_alone(self):
        capture = self.capture(rgba, CARD)
        self.shows_the_card("alpha", capture, words=["straight light over black"])

    def test_images_that_were_made_smaller(self):
        capture = self.capture()
        lf_image = Image.open(capture / f"{MIDDLE}.png").reduce(2)
        each_picture(capture, lambda image: image.reduce(2))
        self.shows_the_card("half size", capture, lf_image=lf_image, words=["0.5 times"])

    def test_stale_absolute_paths_and_other_suffixes(self):
        capture = self.capture()
        lf_image = Image.open(capture / f"{MIDDLE}.png").copy()
        (capture / "images").mkdir()
        for file in capture.glob("*.png"):
            file.rename(capture / "images" / (file.stem + ".PNG"))

        def stale(text):
            for frame in text["frames"]:
                frame["file_path"] = f"/home/someone/{frame['file_path']}".replace(".png", ".jpeg")
        change(capture, stale)
        self.shows_the_card("stale paths", capture, lf_image=lf_image, words=["found by their names"])

    def test_a_watermark_in_every_image(self):
        capture = self.capture()
        mark = np.random.default_rng(1).integers(0, 256, (12, 30, 3), dtype=np.uint8)

        def stamp(image):
            image.paste(Image.fromarray(mark), (60, 55))
            return image
        each_picture(capture, stamp)
        self.shows_the_card("watermark", capture)

    def test_a_principal_point_beside_the_middle(self):
        capture = self.capture()
        each_picture(capture, lambda image: image.crop((0, 0, 84, 66)))
        change(capture, lambda text: text.update(w=84, h=66))
        self.shows_the_card("off-centre", capture)  # all of the LF image, not only the part around its axis

    def test_images_of_another_size_among_them(self):
        capture = self.capture()
        for name in ("000", "001", "002"):
            Image.open(capture / f"{name}.png").resize((50, 41)).save(capture / f"{name}.png")

        def without_size(text):
            for key in ("w", "h", "cx", "cy"):
                text.pop(key)
        change(capture, without_size)
        self.shows_the_card("mixed sizes", capture, codes=(6, 0))  # the lens needs none of the images of another size

    def test_images_exposed_unevenly(self):
        capture = self.capture()
        exposures = np.random.default_rng(3).uniform(0.8, 1.2, SIDE * SIDE)
        for file, exposure in zip(sorted(capture.glob("*.png")), exposures):
            expose(file, exposure)
        self.shows_the_card("uneven", capture)

    def test_images_with_dark_corners(self):
        capture = self.capture()
        for file in capture.glob("*.png"):
            expose(file, 1, falloff=0.4)
        self.shows_the_card("falloff", capture)

    def test_a_missing_image_in_the_middle(self):
        capture = self.capture()
        (capture / f"{MIDDLE}.png").unlink()
        self.shows_the_card("missing middle", capture, codes=(6, 6))


if __name__ == "__main__":
    FirstPictureCase.PROGRAMS = sys.argv[1:4]
    result = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False).result
    if len(sys.argv) > 4:
        write_sheet(sys.argv[4], FirstPictureCase.PICTURES)
    sys.exit(not result.wasSuccessful())
