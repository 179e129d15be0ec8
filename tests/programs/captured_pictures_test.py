#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the first picture of real and rendered captures, both unchanged and as people change them: images with uneven
exposure or dark corners, downscaled, renamed or moved. The subject must be sharp in all pictures.

usage: captured_pictures_test.py LFIMPORT LFEXAMPLE LFRENDERER DATA [CONTACT_SHEET.png]
"""
import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import cv2
import numpy as np
from PIL import Image

from first_picture_case import FirstPictureCase, detail, expose, grey, write_sheet

DATA = None
TILES = 12  # number of tiles of a picture along each axis
NEARLY = 0.7  # as `nearly` of all_pictures()
SUFFIXES = (".jpg", ".jpeg", ".png", ".PNG")
SHOP = range(9, 18)  # the rows, and the columns, in the middle of 27


def shrunk(file, out, divisor):
    Image.open(file).convert("RGB").reduce(divisor).save(out, quality=95)


def write_transforms(folder, frames, **keys):
    (folder / "transforms.json").write_text(json.dumps({**keys, "frames": frames}))


def pose(x, y):
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]]


def shop(folder):
    """Writes the 81 images in the middle, at a third of their size."""
    frames = []
    for file in sorted((DATA / "blender-shop" / "images").glob("Original Camera_*.jpg")):
        _, row, column, y, x, _, _ = file.stem.split("_")
        if int(row) in SHOP and int(column) in SHOP:
            shrunk(file, folder / "images" / f"{row}_{column}.jpg", 3)
            frames.append({"file_path": f"images/{row}_{column}.jpg",
                           "transform_matrix": pose(float(x) / 1000, -float(y) / 1000)})
    write_transforms(folder, frames, fl_x=800 / 3, w=320, h=214)


def cards(folder):
    """Writes images at a third of their size; the rays through the cameras' principal points meet at distance 100."""
    frames = []
    for file in sorted((DATA / "stanford-cards-9x9" / "images").glob("out_*.jpg")):
        shrunk(file, folder / "images" / file.name, 3)
        y, x = (int(n) - 8 for n in file.stem.split("_")[1:])
        frames.append({"file_path": f"images/{file.name}", "fl_x": 256, "w": 256, "h": 256,
                       "cx": 128 + 256 * x / 100, "cy": 128 + 256 * y / 100,
                       "transform_matrix": pose(x, -y)})
    write_transforms(folder, frames)


def temple(folder):
    """Copies the images, and their calibration templeR_par.txt into the folder above them."""
    source = DATA / "middlebury-templeRing" / "templeRing"
    for file in source.glob("*.png"):
        shutil.copyfile(file, folder / "images" / file.name)
    shutil.copyfile(source / "templeR_par.txt", folder / "templeR_par.txt")


def beer(folder):
    """Copies the images of a video that was taken with a phone, and their COLMAP model."""
    source = DATA / "beer-colmap"
    for file in (source / "images").glob("*.jpg"):
        shutil.copyfile(file, folder / "images" / file.name)
    shutil.copytree(source / "sparse", folder / "sparse", copy_function=shutil.copyfile)


def images_of(capture):
    return [file for file in sorted((capture / "images").iterdir()) if file.suffix in SUFFIXES]


def as_it_is(capture):
    del capture


def uneven(capture):
    gains = np.random.default_rng(3).uniform(0.8, 1.2, 1000)
    for file, gain in zip(images_of(capture), gains):
        expose(file, gain)


def dark_corners(capture):
    for file in images_of(capture):
        expose(file, 1, falloff=0.4)


def uneven_and_dark_corners(capture):
    gains = np.random.default_rng(3).uniform(0.8, 1.2, 1000)
    for file, gain in zip(images_of(capture), gains):
        expose(file, gain, falloff=0.4)


def smaller(capture):
    """Writes half-size images to the folder images_2 and removes the folder images."""
    (capture / "images_2").mkdir()
    for file in images_of(capture):
        shrunk(file, capture / "images_2" / file.name, 2)
        file.unlink()
    (capture / "images").rmdir()


def renamed(capture):
    for file in images_of(capture):
        if file.suffix == ".jpg":
            file.rename(file.with_suffix(".jpeg"))
        else:
            file.rename(file.with_suffix(".PNG"))


def of_another_machine(capture):
    """Gives every image an absolute path of another machine."""
    text = json.loads((capture / "transforms.json").read_text())
    for frame in text["frames"]:
        frame["file_path"] = f"/home/someone/captures/{frame['file_path']}"
    (capture / "transforms.json").write_text(json.dumps(text))


def sharp_share(picture, lf_image):
    """Returns the share of textured tiles that are as sharp as in the LF image at which the path starts."""
    ours = grey(picture)
    lf_image = grey(lf_image)
    scale = min(1, ours.shape[1] / lf_image.shape[1], ours.shape[0] / lf_image.shape[0])
    scale = max(scale, 0.5 if ours.shape[0] <= lf_image.shape[0] // 2 else 1)
    if scale < 1:
        lf_image = cv2.resize(lf_image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    top, left = ((there - here) // 2 for there, here in zip(lf_image.shape, ours.shape))
    theirs = lf_image[max(0, top):, max(0, left):][:ours.shape[0], :ours.shape[1]]
    ours = ours[:theirs.shape[0], :theirs.shape[1]]
    sharp = textured = 0
    height, width = ours.shape[0] // TILES, ours.shape[1] // TILES
    for y in range(TILES):
        for x in range(TILES):
            tile = np.s_[y * height:(y + 1) * height, x * width:(x + 1) * width]
            if theirs[tile].mean() > 16 and detail(theirs[tile]) > 0.06:
                textured += 1
                sharp += detail(ours[tile]) > 0.6 * detail(theirs[tile])
    return sharp / max(1, textured)


class CapturedPicturesTest(FirstPictureCase):
    def setUp(self):
        super().setUp()
        self.written = {}  # the folder that each function has written a capture to, unchanged

    def make(self, write, change=as_it_is):
        capture = pathlib.Path(tempfile.mkdtemp(prefix=f"{write.__name__} {change.__name__} ", dir=self.folder))
        if write not in self.written:
            self.written[write] = self.folder / f"{write.__name__} as written"
            (self.written[write] / "images").mkdir(parents=True)
            write(self.written[write])
        shutil.copytree(self.written[write], capture, dirs_exist_ok=True)
        change(capture)
        return capture

    def one_picture(self, write, change=as_it_is, name=None, **call):
        capture = self.make(write, change)
        name = f"{write.__name__}: {name or change.__name__.replace('_', ' ')}"
        picture, focus, start = self.first_picture(name, capture, **call)
        start = next(capture.glob(f"images*/{pathlib.Path(start).name}"))
        share = sharp_share(picture, Image.open(start))
        print(f"{name}: focus {focus:.4g}, {100 * share:.0f} % sharp", file=sys.stderr)
        return focus, share

    def all_pictures(self, write, changes, focus, sharp, is_sure=True, is_matched=True, nearly=NEARLY):
        """Every changed capture must be focused at the distance of the unchanged one, and be nearly as sharp.

        focus         distances between which the subject lies
        sharp         least share of the capture's textured tiles that are sharp
        is_sure       False: the images are too far apart to find a focus from pixels
        is_matched    False: the light moves over the subject, so that --match-exposure refuses
        nearly        least share of sharp tiles of a changed capture, relative to the unchanged one
        """
        folder = DATA / {"shop": "blender-shop", "cards": "stanford-cards-9x9", "beer": "beer-colmap",
                         "temple": "middlebury-templeRing"}[write.__name__]
        if not folder.is_dir():
            self.skipTest(f"no captures at {folder} (set LF_TEST_DATA to the folder that holds data)")
        plain, share = self.one_picture(write, is_sure=is_sure)
        self.assertGreater(plain, focus[0])
        self.assertLess(plain, focus[1])
        self.assertGreater(share, sharp)
        for change in changes:
            with self.subTest(change.__name__):
                its, sharp_of_it = self.one_picture(write, change, is_sure=is_sure)
                # At half the size, objects slightly out of focus look sharp.
                self.assertAlmostEqual(its, plain, delta=(0.06 if change is smaller else 0.03) * plain)
                self.assertGreater(sharp_of_it, nearly * share)
        with self.subTest("matched"):
            if not is_matched:
                self.refuses_to_match(write)
                return
            its, sharp_of_it = self.one_picture(
                write, uneven_and_dark_corners, name="matched", is_sure=is_sure,
                options=["--match-exposure", "--vignetting", "-o", self.folder / "matched"])
            self.assertAlmostEqual(its, plain, delta=0.03 * plain)
            self.assertGreater(sharp_of_it, nearly * share)

    def refuses_to_match(self, write):
        for change in (as_it_is, uneven_and_dark_corners):
            capture = self.make(write, change)
            for options in ((), ("--vignetting",)):
                done = self.call(self.PROGRAMS[0], capture, "--match-exposure", *options, "-o",
                                 self.folder / "never written")
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertIn("varies by", done.stderr)
                self.assertIn("turntable", done.stderr)
                self.assertFalse((self.folder / "never written").exists())

    def test_shop(self):
        self.all_pictures(shop, (uneven, dark_corners, smaller, renamed, of_another_machine), (6, 14), 0.2)

    def test_cards(self):
        # The subject is a ball of glass, before the cards that fill the picture.
        self.all_pictures(cards, (uneven, dark_corners, smaller, renamed, of_another_machine), (80, 100),
                          0.1)

    def test_temple(self):
        self.all_pictures(temple, (uneven, dark_corners, renamed), (0.5, 0.6), 0.8, is_matched=False)

    def test_beer(self):
        # The camera is rolled. Tiles of its levelled frame show other places than those of the LF image, and only four
        # or five of them have texture.
        self.all_pictures(beer, (uneven, dark_corners, smaller, renamed), (4, 5.5), 0.8, nearly=0.5)


if __name__ == "__main__":
    FirstPictureCase.PROGRAMS = sys.argv[1:4]
    DATA = pathlib.Path(os.environ.get("LF_TEST_DATA", sys.argv[4])) / "data"
    result = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False).result
    if len(sys.argv) > 5:
        write_sheet(sys.argv[5], FirstPictureCase.PICTURES, columns=7)
    sys.exit(not result.wasSuccessful())
