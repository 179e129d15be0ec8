# SPDX-License-Identifier: Apache-2.0
"""Makes the first picture of a capture with lfimport, lfexample and lfrenderer, and a sheet of such pictures."""
import re

import cv2
import numpy as np
from PIL import Image, ImageDraw

from program_test_case import ProgramTestCase


def grey(image):
    return np.asarray(image.convert("L"), np.float32)


def detail(pixels):
    """Returns the standard deviation of the Laplacian, relative to the mean brightness."""
    return cv2.Laplacian(pixels, cv2.CV_32F)[2:-2, 2:-2].std() / max(1, pixels.mean())


def expose(file, gain, falloff=0, out=None):
    """Rewrites an image as a camera with another exposure would record it, through a lens that loses `falloff` of the
    light towards the corners. White stays below the largest value that the file can hold."""
    image = Image.open(file).convert("RGB")
    x, y = np.meshgrid(*((np.arange(n) + 0.5 - n / 2 for n in image.size)))
    corner = 4 * (x * x + y * y) / (image.width ** 2 + image.height ** 2)
    light_of = ((np.arange(256) / 255) ** 2.2).astype(np.float32)
    gains = (gain / 1.25 * (1 - falloff * corner)).astype(np.float32)
    light = np.clip(light_of[np.asarray(image)] * gains[..., None], 0, 1)
    stored = (255 * cv2.pow(light, 1 / 2.2)).round().astype(np.uint8)
    Image.fromarray(stored).save(out or file, quality=92, compress_level=1)  # compress_level is for PNG files


class FirstPictureCase(ProgramTestCase):
    PROGRAMS = ()  # lfimport, lfexample, lfrenderer
    PICTURES = []  # (name, PIL image)

    def first_picture(self, name, capture, codes=(0, 0), options=(), words=(), is_sure=True):
        """Runs the three programs. Returns the picture, the focus distance, and the name of the LF image at which the
        path starts.

        codes    exit codes of lfimport and lfrenderer
        options  of lfimport; with -o, its output is rendered
        words    must be in the output
        is_sure  False: lfexample must report that it is not sure of the focus
        """
        importer, example, renderer = self.PROGRAMS
        report = self.succeeds(importer, capture, *options, code=codes[0])
        if "-o" in options:
            capture = options[options.index("-o") + 1]
        path = self.folder / "path.yaml"
        written = self.call(example, capture, "-o", path, "--move", "static")
        self.assertEqual(written.returncode, 0, written.stderr)
        self.assertEqual("not sure" not in written.stderr, is_sure, written.stderr)
        rendered = self.call(renderer, capture, path, "-o", self.folder / "frames", "--format", "png",
                             "--no-contact-sheet", "--overwrite")
        self.assertEqual(rendered.returncode, codes[1], rendered.stderr)
        for word in words:
            self.assertIn(word, report + written.stderr + rendered.stderr)
        picture = Image.open(self.folder / "frames" / "frame_0001.png").convert("RGB")
        self.PICTURES.append((name, picture))
        text = path.read_text()
        focus = float(re.search(r"focus_distance: (\S+)", text).group(1))
        return picture, focus, re.search(r"starts at LF camera \d+ \((.*)\)\.", text).group(1)


def write_sheet(path, pictures, columns=4):
    """Writes all pictures with their names below."""
    width, height = 240, 200
    sheet = Image.new("RGB", (columns * width, -(-len(pictures) // columns) * height), "white")
    for number, (name, picture) in enumerate(pictures):
        x, y = number % columns * width, number // columns * height
        picture = picture.copy()
        picture.thumbnail((width - 8, height - 24))
        if picture.width < width - 8 and picture.height < height - 24:
            picture = picture.resize((width - 8, height - 24))
        sheet.paste(picture, (x + 4, y + 4))
        ImageDraw.Draw(sheet).text((x + 6, y + height - 16), name, fill="black")
    sheet.save(path)
