#!/usr/bin/python3
"""The first picture of captures as people have them: lfimport, lfexample and lfrenderer without a
further option give one in which the subject is sharp.

usage: first_pictures_test.py LFIMPORT LFEXAMPLE LFRENDERER [CONTACT_SHEET.png]
"""
import json
import os
import pathlib
import re
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # before the import
import cv2
import numpy as np
from PIL import Image, ImageDraw

from drawn_cards import FOCUS, srgb_of, write_field
from program_test_case import ProgramTestCase

IMPORTER = EXAMPLE = RENDERER = SHEET = None
FAR = 2.5
MIDDLE = "084"  # the LF camera in the middle
PICTURES = []   # (name, PIL image)


def card_and_wall(x, y, depth):
    """A textured card in the middle, at FOCUS, before a dimmer wall."""
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
    """Writes transforms.json again as edit(text) leaves it."""
    calibration = field / "transforms.json"
    text = json.loads(calibration.read_text())
    edit(text)
    calibration.write_text(json.dumps(text))


def each_picture(field, edit):
    for file in sorted(field.glob("*.png")):
        edit(Image.open(file)).save(file)


class FirstPicturesTest(ProgramTestCase):
    def capture(self, write=png, scene=None):
        return write_field(self.folder / "capture", write, scene or CARD_AND_WALL)

    def first_picture(self, name, capture, codes=(0, 0), lf_image=None, words=()):
        """The three programs; the picture's middle must be that of the LF image that it starts at.

        codes  exit codes of lfimport and lfrenderer
        """
        report = self.succeeds(IMPORTER, capture, code=codes[0])
        path = self.folder / "path.yaml"
        example = self.call(EXAMPLE, capture, "-o", path, "--move", "static")
        self.assertEqual(example.returncode, 0, example.stderr)
        self.assertNotIn("not sure", example.stderr)
        focus = float(re.search(r"focus_distance: (\S+)", path.read_text()).group(1))
        self.assertAlmostEqual(focus, FOCUS, delta=0.02 * FOCUS)
        rendered = self.call(RENDERER, capture, path, "-o", self.folder / "frames", "--format", "png",
                             "--no-contact-sheet")
        self.assertEqual(rendered.returncode, codes[1], rendered.stderr)
        for word in words:
            self.assertIn(word, report + example.stderr + rendered.stderr)
        picture = Image.open(self.folder / "frames" / "frame_0001.png").convert("RGB")
        PICTURES.append((name, picture))
        start = re.search(r"starts at LF camera \d+ \((.*)\)\.", path.read_text()).group(1)
        self.expect_sharp(picture, lf_image or Image.open(capture / start))

    def expect_sharp(self, picture, lf_image):
        """The middle of the card, in both as large as in the picture."""
        def middle(image):
            image = np.asarray(image.convert("L"), np.float32)
            y, x = image.shape[0] // 2, image.shape[1] // 2
            half = min(image.shape) // 4
            return image[y - half:y + half, x - half:x + half]
        ours, theirs = middle(picture), middle(lf_image)
        found = cv2.matchTemplate(theirs, ours[4:-4, 4:-4], cv2.TM_CCOEFF_NORMED)
        self.assertGreater(found.max(), 0.97)
        def detail(pixels):
            return cv2.Laplacian(pixels, cv2.CV_32F)[2:-2, 2:-2].std()
        self.assertGreater(detail(ours), 0.6 * detail(theirs))

    def test_a_plain_capture(self):
        self.first_picture("plain", self.capture())

    def test_an_object_alone(self):
        capture = self.capture(rgba, CARD)
        self.first_picture("alpha", capture, words=["straight light over black"])

    def test_images_that_were_made_smaller(self):
        capture = self.capture()
        lf_image = Image.open(capture / f"{MIDDLE}.png").reduce(2)
        each_picture(capture, lambda image: image.reduce(2))
        self.first_picture("half size", capture, lf_image=lf_image, words=["0.5 times"])

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
        self.first_picture("stale paths", capture, lf_image=lf_image, words=["found by their names"])

    def test_a_watermark_in_every_image(self):
        capture = self.capture()
        mark = np.random.default_rng(1).integers(0, 256, (12, 30, 3), dtype=np.uint8)
        def stamp(image):
            image.paste(Image.fromarray(mark), (60, 55))
            return image
        each_picture(capture, stamp)
        self.first_picture("watermark", capture)

    def test_a_principal_point_beside_the_middle(self):
        capture = self.capture()
        each_picture(capture, lambda image: image.crop((0, 0, 84, 66)))
        change(capture, lambda text: text.update(w=84, h=66))
        lf_image = Image.open(capture / f"{MIDDLE}.png").crop((12, 6, 84, 66))
        self.first_picture("off-centre", capture, lf_image=lf_image)

    def test_images_of_another_size_among_them(self):
        capture = self.capture()
        for name in ("000", "001", "002"):
            Image.open(capture / f"{name}.png").resize((50, 41)).save(capture / f"{name}.png")
        def without_size(text):
            for key in ("w", "h", "cx", "cy"):
                text.pop(key)
        change(capture, without_size)
        self.first_picture("mixed sizes", capture, codes=(6, 0))  # a lens that needs none of them

    def test_a_missing_image_in_the_middle(self):
        capture = self.capture()
        (capture / f"{MIDDLE}.png").unlink()
        self.first_picture("missing middle", capture, codes=(6, 6))


def write_sheet(path):
    """All pictures, each with its name below."""
    width, height = 240, 200
    sheet = Image.new("RGB", (4 * width, -(-len(PICTURES) // 4) * height), "white")
    for number, (name, picture) in enumerate(PICTURES):
        x, y = number % 4 * width, number // 4 * height
        sheet.paste(picture.resize((width - 8, height - 24)), (x + 4, y + 4))
        ImageDraw.Draw(sheet).text((x + 6, y + height - 16), name, fill="black")
    sheet.save(path)


if __name__ == "__main__":
    IMPORTER, EXAMPLE, RENDERER = sys.argv[1:4]
    SHEET = pathlib.Path(sys.argv[4]) if len(sys.argv) > 4 else None
    result = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False).result
    if SHEET:
        write_sheet(SHEET)
    sys.exit(not result.wasSuccessful())
