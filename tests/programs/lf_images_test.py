#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the kinds of files of LF images: the same light in any of them gives the same bits.

usage: lf_images_test.py LFRENDERER LFIMPORT
"""
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np
from PIL import Image, ImageOps

from dng_file import dng
from small_field import HEIGHT, WIDTH, write_field, write_path

RENDERER = IMPORT = None


def noise(index, shape=(HEIGHT, WIDTH, 3), limit=256, kind=np.uint8):
    return np.random.default_rng(index).integers(0, limit, shape, dtype=kind)


class LfImagesTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.path = write_path(self.folder, frames=1)

    def field(self, name, write, mask=None, **keys):
        """Writes a light field whose images are written by write(index, folder) -> file name."""
        calibration = write_field(self.folder / name, **keys)
        content = json.loads(calibration.read_text())
        for index, frame in enumerate(content["frames"]):
            frame["file_path"] = write(index, calibration.parent)
            if mask:
                frame["lf_mask"] = mask(index, calibration.parent)
        calibration.write_text(json.dumps(content))
        return calibration

    def run_renderer(self, field):
        out = self.folder / "out" / field.parent.name
        result = subprocess.run([RENDERER, field, self.path, "-o", out, "--format", "exr-float"],
                                capture_output=True, text=True, timeout=400)
        return result, out

    def digest(self, field):
        """Returns the digest of the frame, whose rays come from all LF images."""
        result, out = self.run_renderer(field)
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads((out / "report.json").read_text())
        self.assertEqual(report["skipped_lf_images"], [])
        return hashlib.sha256((out / "frame_0001.exr").read_bytes()).hexdigest()

    # Mosaics

    @staticmethod
    def mosaic(index, limit=16384):
        return noise(index, (HEIGHT, WIDTH), limit, np.uint16)

    def mosaic_as_png(self, index, folder):
        cv2.imwrite(str(folder / f"{index}m.png"), self.mosaic(index))
        return f"{index}m.png"

    def test_raw_files_give_the_bits_of_the_same_mosaic_as_png(self):
        for pattern in ("RGGB", "BGGR", "GRBG", "GBRG"):
            def write(index, folder):
                content = dng(self.mosaic(index), pattern, 512, 16383, orientation=1 + index % 8)
                (folder / f"{index}.dng").write_bytes(content)
                return f"{index}.dng"
            raw = self.digest(self.field(f"raw_{pattern}", write))
            keys = {"lf_bayer": pattern, "lf_black_level": 512, "lf_white_level": 16383}
            png = self.digest(self.field(f"png_{pattern}", self.mosaic_as_png, **keys))
            self.assertEqual(raw, png, pattern)

    def test_the_white_balance_of_raw_files_is_applied(self):
        def write(index, folder):
            (folder / f"{index}.dng").write_bytes(dng(self.mosaic(index), neutral=(0.5, 1, 0.8)))
            return f"{index}.dng"
        stated = {"lf_bayer": "RGGB", "lf_white_balance": [2, 1, 1.25],
                  "lf_camera_to_srgb": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "lf_white_level": 65535,
                  "lf_black_level": 0}
        told = self.frame(self.field("told", write))
        balanced = self.frame(self.field("stated", self.mosaic_as_png, **stated))
        # The files state that camera colours are XYZ. Balanced to D65 white, the matrix of the sRGB standard converts
        # these colours to linear sRGB.
        white = np.array([0.9505, 1, 1.089])
        matrix = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415],
                           [0.0557, -0.2040, 1.0570]]) * white
        np.testing.assert_allclose(told, balanced @ matrix.T, atol=2e-3)

    def frame(self, field):
        result, out = self.run_renderer(field)
        self.assertEqual(result.returncode, 0, result.stderr)
        bgr = cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)
        return bgr[:, :, 2::-1].astype(float)

    def test_a_raw_file_of_another_pattern_is_skipped_and_named(self):
        def write(index, folder):
            pattern = "GRBG" if index == 7 else "RGGB"
            (folder / f"{index}.dng").write_bytes(dng(self.mosaic(index), pattern))
            return f"{index}.dng"
        result, out = self.run_renderer(self.field("mixed", write))
        self.assertEqual(result.returncode, 6, result.stderr)
        skipped = json.loads((out / "report.json").read_text())["skipped_lf_images"]
        self.assertEqual(len(skipped), 1)
        self.assertIn("has the Bayer pattern GRBG, but the light field has RGGB", str(skipped))

    def test_a_pattern_that_the_files_do_not_tell_is_stated_on_import(self):
        def write(index, folder):
            (folder / f"{index}.dng").write_bytes(dng(self.mosaic(index), "RGBG", 512, 16383))
            return f"{index}.dng"
        field = self.field("untold", write)
        result, _ = self.run_renderer(field)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("lfimport --bayer", result.stderr)
        native = self.folder / "native"
        result = subprocess.run([IMPORT, field, "-o", native, "--bayer", "BGGR"],
                                capture_output=True, text=True, timeout=400)
        self.assertEqual(result.returncode, 0, result.stderr)
        keys = {"lf_bayer": "BGGR", "lf_black_level": 512, "lf_white_level": 16383}
        self.assertEqual(self.digest(native / "transforms.json"),
                         self.digest(self.field("stated", self.mosaic_as_png, **keys)))

    def test_mosaics_of_8_bits_are_those_of_16_with_the_same_light(self):
        def write(factor, kind):
            def write_one(index, folder):
                name = f"{index}_{factor}.png"
                values = noise(index, (HEIGHT, WIDTH)).astype(kind) * kind(factor)
                cv2.imwrite(str(folder / name), values)
                return name
            return write_one
        keys = {"lf_bayer": "GBRG"}
        self.assertEqual(self.digest(self.field("bits8", write(1, np.uint8), **keys)),
                         self.digest(self.field("bits16", write(257, np.uint16), **keys)))

    def test_mosaics_of_10_to_14_bits_in_words_of_16(self):
        for bits in (10, 12, 14):
            def write_png(index, folder):
                cv2.imwrite(str(folder / f"{index}.tif"), self.mosaic(index, 2**bits))
                return f"{index}.tif"

            def write_dng(index, folder):
                content = dng(self.mosaic(index, 2**bits), "RGGB", 16, 2**bits - 1)
                (folder / f"{index}.dng").write_bytes(content)
                return f"{index}.dng"
            keys = {"lf_bayer": "RGGB", "lf_black_level": 16, "lf_white_level": 2**bits - 1}
            self.assertEqual(self.digest(self.field(f"words{bits}", write_png, **keys)),
                             self.digest(self.field(f"dng{bits}", write_dng)), bits)

    # Masks

    @staticmethod
    def colours(index, folder):
        Image.fromarray(noise(index)).save(folder / f"{index}.png")
        return f"{index}.png"

    @staticmethod
    def opaque(index):
        return np.random.default_rng(100 + index).random((HEIGHT, WIDTH)) < 0.7

    def mask_as_png(self, index, folder):
        Image.fromarray(self.opaque(index).astype(np.uint8) * 255).save(folder / f"{index}m.png")
        return f"{index}m.png"

    def test_masks_of_all_kinds_take_the_same_rays_away(self):
        expected = self.digest(self.field("mask8", self.colours, self.mask_as_png))
        self.assertNotEqual(expected, self.digest(self.field("plain", self.colours)))

        def one_bit(index, folder):
            Image.fromarray(self.opaque(index)).save(folder / f"{index}b.png")
            return f"{index}b.png"

        def coloured_tiff(index, folder):
            white = np.repeat(self.opaque(index)[:, :, None], 3, axis=2).astype(np.uint8) * 255
            Image.fromarray(white).save(folder / f"{index}c.tif")
            return f"{index}c.tif"

        def words(index, folder):
            cv2.imwrite(str(folder / f"{index}w.png"), self.opaque(index).astype(np.uint16))
            return f"{index}w.png"

        def floats(index, folder):
            cv2.imwrite(str(folder / f"{index}f.tif"), self.opaque(index).astype(np.float32))
            return f"{index}f.tif"
        for mask in (one_bit, coloured_tiff, words, floats):
            self.assertEqual(self.digest(self.field(mask.__name__, self.colours, mask)), expected,
                             mask.__name__)

    def test_alpha_of_all_kinds_takes_rays_and_leaves_colours_alone(self):
        expected = self.digest(self.field("mask8", self.colours, self.mask_as_png))
        wide = {"lf_transfer": "linear"}

        def alpha(index):
            # Half-transparent pixels keep their full colours.
            return np.where(self.opaque(index), 128, 127).astype(np.uint8)

        def png(index, folder):
            Image.fromarray(np.dstack([noise(index), alpha(index)])).save(folder / f"{index}a.png")
            return f"{index}a.png"

        def tiff(index, folder):
            Image.fromarray(np.dstack([noise(index), alpha(index)])).save(folder / f"{index}a.tif")
            return f"{index}a.tif"
        for write in (png, tiff):
            self.assertEqual(self.digest(self.field(write.__name__, write)), expected,
                             write.__name__)

        def plain16(index, folder):
            cv2.imwrite(str(folder / f"{index}p.png"), noise(index).astype(np.uint16) * 257)
            return f"{index}p.png"

        def alpha16(index, folder):
            rgba = np.dstack([noise(index), alpha(index)]).astype(np.uint16) * 257
            cv2.imwrite(str(folder / f"{index}q.png"), rgba)
            return f"{index}q.png"

        def alpha_float(index, folder):
            rgba = np.dstack([noise(index), alpha(index)]).astype(np.float32) / np.float32(255)
            cv2.imwrite(str(folder / f"{index}e.exr"), rgba)
            return f"{index}e.exr"
        plain = self.digest(self.field("plain16", plain16, self.mask_as_png, **wide))
        self.assertEqual(self.digest(self.field("alpha16", alpha16, **wide)), plain)
        floats = self.field("alpha_float", alpha_float, lf_max_radiance=1)
        self.assertEqual(self.digest(floats), plain)

    def test_transparent_palettes_and_greys(self):
        def grey(index):
            return noise(index, (HEIGHT, WIDTH), 4) * np.uint8(80)

        def plain(index, folder):
            Image.fromarray(grey(index)).save(folder / f"{index}g.png")
            return f"{index}g.png"

        def palette(index, folder):
            indices = np.where(self.opaque(index), grey(index) // 80, 4).astype(np.uint8)
            image = Image.fromarray(indices, "P")
            image.putpalette([v for i in range(5) for v in [80 * (i % 4)] * 3])
            image.save(folder / f"{index}p.png", transparency=4)
            return f"{index}p.png"

        def grey_alpha(index, folder):
            image = np.dstack([grey(index), self.opaque(index).astype(np.uint8) * 255])
            Image.fromarray(image, "LA").save(folder / f"{index}l.png")
            return f"{index}l.png"
        expected = self.digest(self.field("grey", plain, self.mask_as_png))
        self.assertEqual(self.digest(self.field("palette", palette, lf_alpha="mask")), expected)
        self.assertNotEqual(self.digest(self.field("palette_light", palette, lf_alpha="straight")), expected)
        self.assertEqual(self.digest(self.field("grey_alpha", grey_alpha)), expected)

    # Orientation

    @staticmethod
    def tagged_jpeg(index, folder, orientation, size):
        exif = Image.Exif()
        exif[274] = orientation
        name = folder / f"{index}.jpg"
        Image.fromarray(noise(index, (*size, 3))).save(name, exif=exif, quality=90)
        return name

    def test_orientation_counts_only_where_the_calibration_is_of_the_turned_picture(self):
        for orientation in range(1, 9):
            stored = (WIDTH, HEIGHT) if orientation >= 5 else (HEIGHT, WIDTH)

            def jpeg(index, folder):
                return self.tagged_jpeg(index, folder, orientation, stored).name

            def as_calibrated(index, folder):
                with Image.open(self.tagged_jpeg(index, folder, orientation, stored)) as image:
                    turned = ImageOps.exif_transpose(image) if orientation >= 5 else image
                    self.assertEqual(turned.size, (WIDTH, HEIGHT))
                    Image.fromarray(np.asarray(turned)).save(folder / f"{index}u.png")
                return f"{index}u.png"
            self.assertEqual(self.digest(self.field(f"tagged{orientation}", jpeg)),
                             self.digest(self.field(f"plain{orientation}", as_calibrated)),
                             orientation)

    def test_pictures_of_another_size_are_scaled_or_say_what_to_do(self):
        def smaller(index, folder, numerator, denominator):
            size = (HEIGHT * numerator // denominator, WIDTH * numerator // denominator, 3)
            Image.fromarray(noise(index, size)).save(folder / f"{index}s.png")
            return f"{index}s.png"
        # A whole factor scales the intrinsics, with a message; no other factor is a reduction of the same pixels.
        result, _ = self.run_renderer(self.field("half", lambda k, folder: smaller(k, folder, 1, 2)))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("intrinsics are scaled", result.stderr)
        result, _ = self.run_renderer(self.field("more", lambda k, folder: smaller(k, folder, 3, 4)))
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("resized by 0.75", result.stderr)


if __name__ == "__main__":
    RENDERER, IMPORT = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
