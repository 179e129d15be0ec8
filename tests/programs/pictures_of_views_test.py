#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests pictures that hold the views of a grid of cameras, from a user's view: a mosaic, a picture of lenslets and a
quilt give the same bits of frames as a folder of the same views, by every way from a picture to a film.

usage: pictures_of_views_test.py LFIMPORT LFRENDERER LFCOMPRESSOR LFPREPROCESSOR LFMERGE
"""
import json
import subprocess
import sys
import unittest

import cv2
import numpy as np

from exr_file import channels_of
from program_test_case import ProgramTestCase

IMPORT = RENDERER = COMPRESSOR = PREPROCESSOR = MERGE = None
COLUMNS, ROWS = 4, 3
GEOMETRY = ("--pitch", 0.02, "--focal-px", 60)
PATH = """format: lfpath 1
frames: 2
fps: 24
resolution: [48, 36]
camera: {field_of_view_deg: 40, position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}
lens: {aperture_diameter: 0.05}
keyframes:
  focus_distance: [{time: 0, value: 0.5}, {time: 0.1, value: 2}]
"""


class PicturesOfViewsTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        noise = np.random.default_rng(3).integers(0, 65536, (ROWS, COLUMNS, 6, 8, 3), np.uint16)
        # Smooth views, whose errors would still show in each bit.
        cls.views = np.stack([[cv2.resize(noise[row, column], (64, 48)) for column in range(COLUMNS)]
                              for row in range(ROWS)])

    def setUp(self):
        super().setUp()
        (self.folder / "path.yaml").write_text(PATH)
        (self.folder / "views").mkdir()
        for row in range(ROWS):
            for column in range(COLUMNS):
                self.write(f"views/view_r{row}_c{column}.png", self.views[row, column])

    def run_tool(self, program, *arguments, code=0):
        done = self.call(program, *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def write(self, name, picture):
        self.assertTrue(cv2.imwrite(str(self.folder / name), picture))

    def lenslets(self):
        return self.views.transpose(2, 0, 3, 1, 4).reshape(48 * ROWS, 64 * COLUMNS, 3)

    def mosaic(self, views=None):
        views = self.views if views is None else views
        return np.concatenate([np.concatenate(list(row), 1) for row in views])

    def native(self, name, *options):
        """Imports a light field into a folder, and returns it."""
        out = self.folder / f"of {name}"
        self.run_tool(IMPORT, self.folder / name, "-o", out, *GEOMETRY, *options)
        return out

    def frames(self, light_field, *options):
        out = self.folder / f"frames {light_field.name}"
        self.run_tool(RENDERER, light_field, self.folder / "path.yaml", "-o", out, "--format", "exr-float",
                      "--no-contact-sheet", *options)
        return self.read(out)

    def read(self, folder):
        return [channels_of(folder / f"frame_000{number}.exr") for number in (1, 2)]

    def assert_same(self, frames, expected):
        for frame, other in zip(frames, expected):
            self.assertEqual(frame.keys(), other.keys())
            for channel, values in frame.items():
                np.testing.assert_array_equal(values, other[channel])

    def test_each_picture_gives_the_frames_of_a_folder(self):
        expected = self.frames(self.native("views"))
        self.write("mosaic.png", self.mosaic())
        self.write("mosaic.ppm", self.mosaic())  # is read in parts
        self.write("lenslets.png", self.lenslets())
        self.write("a_eslf.png", self.lenslets())
        for name, *options in (("mosaic.png", ), ("mosaic.ppm", ), ("lenslets.png", "--layout", "lenslets"),
                               ("a_eslf.png", )):
            with self.subTest(name):
                native = self.native(name, "--grid", f"{COLUMNS}x{ROWS}", *options)
                content = json.loads((native / "transforms.json").read_text())
                self.assertEqual(len(content["frames"]), COLUMNS * ROWS)
                self.assertTrue(content["frames"][5]["file_path"].startswith(f"../{name}#"))
                self.assert_same(self.frames(native), expected)
                report = json.loads(self.run_tool(IMPORT, native, "--check", "pixels", "--json").stdout)
                self.assertEqual((report["missing"], report["broken"]), (0, 0))

    def test_a_quilt_is_a_row_of_cameras(self):
        (self.folder / "row").mkdir()
        views = self.views.reshape(1, COLUMNS * ROWS, 48, 64, 3)
        for column, view in enumerate(views[0]):
            self.write(f"row/a_0_{column}.png", view)
        # From the lower left view on, row by row upwards.
        self.write(f"q_qs{COLUMNS}x{ROWS}a1.33.png", self.mosaic(self.views[::-1]))
        expected = self.frames(self.native("row"))
        self.assert_same(self.frames(self.native(f"q_qs{COLUMNS}x{ROWS}a1.33.png")), expected)

    def test_arrays_give_the_frames_of_a_folder(self):
        expected = self.frames(self.native("views"))
        rgb = self.views[..., ::-1]
        np.save(self.folder / "little.npy", np.ascontiguousarray(rgb))
        np.save(self.folder / "big.npy", np.ascontiguousarray(rgb).astype(">u2"))
        for name in ("little.npy", "big.npy"):
            with self.subTest(name):
                native = self.native(name)
                content = json.loads((native / "transforms.json").read_text())
                self.assertEqual(content["frames"][5]["file_path"], f"../{name}#view+1+1")
                self.assert_same(self.frames(native), expected)
                store = self.folder / f"{name}.lfs"
                self.run_tool(COMPRESSOR, native, "-o", store, "--profile", "lossless")
                self.assert_same(self.frames(store), expected)

    def test_arrays_of_floats_hold_light(self):
        for kind in (np.float32, np.float64):
            light = np.full((ROWS, COLUMNS, 48, 64, 3), 3.5, kind)
            np.save(self.folder / f"{kind.__name__}.npy", light)
            middle = self.frames(self.native(f"{kind.__name__}.npy"))[0]["G"][18, 24]
            self.assertAlmostEqual(float(middle), 3.5, delta=0.01)
        np.save(self.folder / "grey.npy", np.ascontiguousarray(light[..., 0].astype(np.uint8)))
        report = json.loads(self.run_tool(IMPORT, self.folder / "grey.npy", *GEOMETRY, "--json").stdout)
        self.assertEqual((report["images"], report["broken"]), (12, 0))

    def test_other_arrays_are_refused(self):
        for name, array, said in (("fortran", np.asfortranarray(self.views), "Fortran order"),
                                  ("signed", self.views.astype(np.int16), "'<i2'"),
                                  ("channels", np.concatenate([self.views] * 2, -1), "up to 4 channels")):
            with self.subTest(name):
                np.save(self.folder / f"{name}.npy", array)
                self.fails(3, [said], IMPORT, self.folder / f"{name}.npy", *GEOMETRY)
        np.save(self.folder / "views.npy", self.views)
        self.fails(2, ["--grid", "leave the option out"], IMPORT, self.folder / "views.npy", "--grid", "4x3", *GEOMETRY)
        (self.folder / "views.npy").write_bytes((self.folder / "views.npy").read_bytes()[:-1])
        self.fails(3, ["copy or save it again"], IMPORT, self.folder / "views.npy", *GEOMETRY)
        (self.folder / "a.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
        self.fails(3, ["an HDF5 file", "numpy.save()"], IMPORT, self.folder / "a.h5")

    def test_every_way_to_a_film_takes_views(self):
        self.write("mosaic.png", self.mosaic())
        native = self.native("mosaic.png", "--grid", f"{COLUMNS}x{ROWS}")
        expected = self.frames(native)
        # A packed store.
        store = self.folder / "store.lfs"
        self.run_tool(COMPRESSOR, native, "-o", store, "--profile", "lossless")
        self.assert_same(self.frames(store), expected)
        # Packages, with their LF images where they are, and in a store.
        packages = self.folder / "packages"
        self.run_tool(PREPROCESSOR, native, self.folder / "path.yaml", "-o", packages, "--packages", 2)
        for name, *options in (("packages", ), ("stored", "--lightfield", self.folder / "film.lfs")):
            if options:
                self.run_tool(COMPRESSOR, *sorted(packages.glob("*.lfp")), "-o", options[1], "--profile", "lossless")
            out = self.folder / f"frames {name}"
            self.run_tool(RENDERER, *sorted(packages.glob("*.lfp")), "-o", out, "--format", "exr-float",
                          "--no-contact-sheet", *options)
            self.assert_same(self.read(out), expected)
        # Shards, which read LF images in other orders.
        for part in (1, 2):
            self.run_tool(RENDERER, native, self.folder / "path.yaml", "-o", self.folder / "shards", "--shard",
                          f"{part}/2", "--format", "exr-float", "--no-contact-sheet")
        self.run_tool(MERGE, self.folder / "shards/partial/shards", "-o", self.folder / "merged", "--format",
                      "exr-float", "--no-contact-sheet")
        self.assert_same(self.read(self.folder / "merged"), expected)

    def test_the_memory_of_the_picture_is_planned(self):
        # 12 views of 64 x 48 in a picture of 96 MiB of zeros: the views at its upper left corner.
        large = np.zeros((4096, 4096, 3), np.uint16)
        picture = self.mosaic()
        large[:picture.shape[0], :picture.shape[1]] = picture
        self.write("mosaic.png", picture)
        native = self.native("mosaic.png", "--grid", f"{COLUMNS}x{ROWS}")
        expected = self.frames(native)
        self.write("mosaic.png", large)  # the rectangles stay where they are
        refused = self.run_tool(RENDERER, native, self.folder / "path.yaml", "-o", self.folder / "small",
                                "--memory", "100M", code=4)
        self.assertIn("is too small", refused.stderr)
        self.assert_same(self.frames(native, "--memory", "400M", "--threads", 2), expected)

    def test_a_picture_prints_the_call_that_opens_it(self):
        self.write("a_qs4x3.png", self.mosaic())
        self.write("plain.png", self.mosaic())
        refused = self.run_tool(IMPORT, self.folder / "plain.png", code=3)
        self.assertIn("(lfimport --grid)", refused.stderr)
        refused = self.run_tool(IMPORT, self.folder / "plain.png", "--grid", "5x3", *GEOMETRY, code=3)
        self.assertIn("cannot be divided into 5 x 3 views", refused.stderr)
        for name, *options in (("a_qs4x3.png", ), ("plain.png", "--grid", "4x3")):
            for program, *rest in ((IMPORT, *options), (RENDERER, self.folder / "path.yaml", "-o", self.folder / "f")):
                if program == RENDERER and options:
                    continue
                last = self.run_tool(program, self.folder / name, *rest, code=3).stderr.strip().splitlines()[-1]
                call = last[last.index(": lfimport") + 2:] if program == RENDERER else last[last.rindex(": ") + 2:]
                shell = call.replace(str(IMPORT), "lfimport", 1).replace("lfimport", str(IMPORT), 1)
                self.assertEqual(subprocess.run(shell, shell=True, capture_output=True).returncode, 0, call)
                self.frames((self.folder / name).with_suffix(""))


if __name__ == "__main__":
    IMPORT, RENDERER, COMPRESSOR, PREPROCESSOR, MERGE = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1] + sys.argv[6:])
