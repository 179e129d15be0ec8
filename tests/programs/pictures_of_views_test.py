#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests pictures that hold the views of a grid of cameras, from a user's view: a mosaic, a picture of lenslets and a
quilt give the same bits of frames as a folder of the same views, by every way from a picture to a film.

usage: pictures_of_views_test.py LFIMPORT LFRENDERER LFCOMPRESSOR LFPREPROCESSOR LFMERGE
"""
import json
import pathlib
import shlex
import shutil
import subprocess
import sys
import unittest

import cv2
import h5py
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

    def assert_array_gives(self, name, expected):
        """Checks the frames of an array, and those of a packed store that is made from it."""
        native = self.native(name)
        content = json.loads((native / "transforms.json").read_text())
        self.assertEqual(content["frames"][5]["file_path"], f"../{name}#view+1+1")
        self.assert_same(self.frames(native), expected)
        store = self.folder / f"{name}.lfs"
        self.run_tool(COMPRESSOR, native, "-o", store, "--profile", "lossless")
        self.assert_same(self.frames(store), expected)

    def test_arrays_give_the_frames_of_a_folder(self):
        expected = self.frames(self.native("views"))
        rgb = self.views[..., ::-1]
        np.save(self.folder / "little.npy", np.ascontiguousarray(rgb))
        np.save(self.folder / "big.npy", np.ascontiguousarray(rgb).astype(">u2"))
        for name in ("little.npy", "big.npy"):
            with self.subTest(name):
                self.assert_array_gives(name, expected)

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

    def h5(self, name, array=None, *, dataset="LF", attributes=None, **how):
        """Writes an HDF5 file of the views, and returns its path."""
        with h5py.File(self.folder / name, "w") as file:
            array = self.views[..., ::-1] if array is None else array
            file.create_dataset(dataset, data=array, **how)
            file.attrs.update(attributes or {})
        return self.folder / name

    def test_hdf5_files_give_the_frames_of_a_folder(self):
        expected = self.frames(self.native("views"))
        rows = (1, 1, 10, 64, 3)
        for name, how in (("whole.h5", {}), ("big.h5", {"dtype": ">u2"}), ("views.hdf5", {"dataset": "views"}),
                          ("each.h5", {"chunks": rows, "compression": "gzip"}),
                          ("across.h5", {"chunks": (ROWS, 2, 7, 9, 3), "compression": "gzip", "shuffle": True})):
            with self.subTest(name):
                self.h5(name, **how)
                self.assert_array_gives(name, expected)

    def test_attributes_of_hdf5_files_state_the_geometry(self):
        archive = {"dH": np.float32([0.5]), "dV": 0.25, "focalLength": 60.0, "shift": [3.0], "hRes": COLUMNS,
                   "vRes": np.int32(ROWS), "xRes": 64, "yRes": 48, "channels": 3, "camDistance": 10}
        (self.folder / "archive").mkdir()
        self.h5("archive/lf.h5", attributes=archive)
        self.h5("archive/labels.h5", dataset="GT_LABELS")
        out = self.folder / "native"
        self.run_tool(IMPORT, self.folder / "archive", "-o", out)
        content = json.loads((out / "transforms.json").read_text())
        for index, frame in enumerate(content["frames"]):
            row, column = divmod(index, COLUMNS)
            across, down = column - (COLUMNS - 1) / 2, row - (ROWS - 1) / 2
            pose = np.array(frame["transform_matrix"])
            np.testing.assert_allclose(np.abs(pose[:3, 3]), np.abs([0.5 * across, 0.25 * down, 0]), atol=1e-12)
            # The disparity of a point at depth Z between neighbouring columns is dH focalLength / Z - shift.
            lens = {**content, **frame}
            self.assertAlmostEqual(lens["fl_x"], 60)
            self.assertAlmostEqual(lens["cx"], 32 + 3 * across)
            self.assertAlmostEqual(lens["cy"], 24 + 1.5 * down)
        # Every program opens it, and options replace attributes.
        film = self.frames(self.folder / "archive")
        self.assert_same(self.frames(out), film)
        self.h5("bare.h5")
        self.h5("other.h5", attributes={**archive, "dH": 7, "focalLength": 80, "shift": 9})
        for name in ("bare", "other"):
            out = self.folder / f"of {name}"
            self.run_tool(IMPORT, self.folder / f"{name}.h5", "-o", out, "--pitch", "0.5,0.25", "--focal-px", 60,
                          "--plane-distance", 10)
            self.assert_same(self.frames(out), film)

    def test_hdf5_files_without_geometry_print_the_call_that_opens_them(self):
        for name, attributes, said in (("none.h5", {}, "no distance from one camera to the next and no focal length"),
                                       ("metres.h5", {"dH": 0.04, "focalLength": 0.035, "shift": 1},
                                        "focalLength is 0.035, which cannot be pixels")):
            self.h5(name, attributes=attributes)
            for program, *rest in ((IMPORT, ), (RENDERER, self.folder / "path.yaml", "-o", self.folder / "f")):
                done = self.run_tool(program, self.folder / name, *rest, code=3)
                self.assertIn(said, done.stderr)
                last = done.stderr.strip().splitlines()[-1]
                call = last[last.rindex(": ") + 2:]
                self.assertIn("--plane-distance 4" if attributes else "--plane-distance 100", call)
                shell = call.replace(str(IMPORT), "lfimport", 1).replace("lfimport", str(IMPORT), 1)
                self.assertEqual(subprocess.run(shell, shell=True, capture_output=True).returncode, 0, call)

    def test_other_hdf5_files_are_refused(self):
        for name, said, how in (("signed", "with a sign of 16 bits", {"dtype": "i2"}),
                                ("flat", "shape", {"array": self.views[0, 0]}),
                                ("name", "no dataset LF, but GT_DEPTH", {"dataset": "GT_DEPTH"}),
                                ("text", "dH is not one number", {"attributes": {"dH": "wide"}}),
                                ("sizes", "hRes is 17", {"attributes": {"hRes": 17}}),
                                ("pitch", "dH is -1", {"attributes": {"dH": -1}})):
            with self.subTest(name):
                self.fails(3, [f"{name}.h5", said], IMPORT, self.h5(f"{name}.h5", **how), "--focal-px", 60)
        whole = self.h5("whole.h5").read_bytes()
        for cut in (9, 100, len(whole) // 2, len(whole) - 1):
            (self.folder / "cut.h5").write_bytes(whole[:cut])
            self.fails(3, ["cut.h5: truncated or damaged"], IMPORT, self.folder / "cut.h5", *GEOMETRY)
        with h5py.File(self.folder / "large.h5", "w") as file:  # no byte of it is stored
            file.create_dataset("LF", (9, 9, 1 << 30, 1 << 30, 3), "u1", chunks=(1, 1, 64, 64, 3))
        self.fails(3, ["large.h5"], IMPORT, self.folder / "large.h5", *GEOMETRY)
        self.fails(2, ["--grid", "leave the option out"], IMPORT, self.folder / "whole.h5", "--grid", "4x3", *GEOMETRY)
        (self.folder / "two").mkdir()
        self.h5("two/a.h5")
        self.h5("two/b.h5")
        self.fails(3, ["two/a.h5", "is an HDF5 file", "give its path"], IMPORT, self.folder / "two")

    def test_features_in_an_hdf5_file_hide_nothing(self):
        self.h5("views/features.h5", dataset="view_r0_c0.png")
        self.run_tool(IMPORT, self.folder / "views", "-o", self.folder / "native", *GEOMETRY)
        (self.folder / "photographs").mkdir()
        for number in range(3):
            self.write(f"photographs/DSC{number}.png", self.views[0, number])
        self.h5("photographs/features.h5", dataset="DSC0.png")
        self.fails(3, ["reconstruct the poses first"], IMPORT, self.folder / "photographs")

    def test_archives_of_arrays_print_the_call_that_makes_a_file_of_one(self):
        expected = self.frames(self.native("views"))
        rgb = np.ascontiguousarray(self.views[..., ::-1])
        np.savez(self.folder / "a.npz", depth=np.zeros((3, 4)), LF=rgb)
        matlab = self.folder / "b.mat"
        with h5py.File(matlab, "w", userblock_size=512) as file:
            file["LF"] = rgb.T
        bytes_ = bytearray(matlab.read_bytes())
        bytes_[:19] = b"MATLAB 7.3 MAT-file"
        matlab.write_bytes(bytes_)
        files = ["a.npz", "b.mat"]
        try:
            from scipy.io import savemat
            savemat(self.folder / "c.mat", {"LF": rgb, "names": np.array(["a", "b"], object)})
            files.append("c.mat")
        except ImportError:
            pass
        for name in files:
            with self.subTest(name):
                said = self.run_tool(IMPORT, self.folder / name, code=3).stderr.strip().splitlines()[-1]
                call = said[said.rindex(": python3 ") + 2:].replace("python3", "/usr/bin/python3", 1)
                subprocess.run(call, shell=True, check=True)
                self.assert_same(self.frames(self.native(f"{name[0]}.npy")), expected)

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
        self.write("plain.png", self.views[0, 0])
        refused = self.run_tool(IMPORT, self.folder / "plain.png", code=3)
        self.assertIn("(lfimport --grid)", refused.stderr)
        self.write("plain.png", self.mosaic())
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

    def scene(self, columns, rows, width, height):
        """Views of a textured card before a wall: (rows, columns, height, width, 3)."""
        noise = np.random.default_rng(5).integers(0, 200, (height + 40, width + 40, 3)).astype(np.uint8)
        wall = cv2.GaussianBlur(noise, (0, 0), 1.5)
        card = 80 + cv2.GaussianBlur(noise[::-1], (0, 0), 1) // 2
        views = np.zeros((rows, columns, height, width, 3), np.uint8)
        for row, column in np.ndindex(rows, columns):
            views[row, column] = wall[20 + row:20 + row + height, 20 + column:20 + column + width]
            y, x = height // 4 + 2 * row, width // 4 + 2 * column
            views[row, column, y:y + height // 3, x:x + width // 3] = card[:height // 3, :width // 3]
        return views

    def test_a_picture_of_unknown_views_prints_the_call_that_opens_it(self):
        for name, columns, rows, layout in (
                ("scene_5x4.png", 5, 4, "mosaic"), ("scene.png", 5, 4, "mosaic"), ("plain_5x4.png", 5, 4, "lenslets"),
                ("IMG_0001_eslf.png", 5, 5, "lenslets"), ("IMG_0002_eslf.png", 7, 7, "lenslets"),
                ("lenslets.png", 9, 9, "lenslets"), ("scene_qs5x5a1.33.png", 5, 5, "mosaic")):
            views = self.scene(columns, rows, 98 if "2_eslf" in name else 80, 70 if "2_eslf" in name else 60)
            picture = (self.mosaic(views) if layout == "mosaic" else views.transpose(2, 0, 3, 1, 4).reshape(
                rows * views.shape[2], columns * views.shape[3], 3))
            folder = self.folder / f"of {name}"
            folder.mkdir()
            self.assertTrue(cv2.imwrite(str(folder / name), picture))
            (folder / "README").write_text("views")
            for given in (folder / name, folder):
                for program, *rest in ((IMPORT, ), (RENDERER, self.folder / "path.yaml", "-o", self.folder / "f")):
                    with self.subTest(name, given=given, program=program):
                        done = self.run_tool(program, given, *rest, code=3)
                        last = done.stderr.strip().splitlines()[-1]
                        call = last[last.rindex(": ") + 2:]
                        self.assertIn(f"--grid {columns}x{rows} --layout {layout} ", call)
                        shell = call.replace(str(IMPORT), "lfimport", 1).replace("lfimport", str(IMPORT), 1)
                        done = subprocess.run(shell, shell=True, capture_output=True, text=True)
                        self.assertEqual(done.returncode, 0, (call, done.stderr))
                        words = shlex.split(call)
                        native = pathlib.Path(words[words.index("-o") + 1])
                        content = json.loads((native / "transforms.json").read_text())
                        self.assertEqual(len(content["frames"]), columns * rows)
                        shutil.rmtree(folder / pathlib.Path(name).stem, ignore_errors=True)
                        (folder / "transforms.json").unlink(missing_ok=True)

    def test_a_picture_of_one_view_asks_for_its_columns_and_rows(self):
        (self.folder / "one").mkdir()
        self.write("one/photo.png", self.scene(1, 1, 400, 300)[0, 0])
        for given in ("one", "one/photo.png"):
            last = self.run_tool(IMPORT, self.folder / given, code=3).stderr.strip().splitlines()[-1]
            self.assertIn("photo.png: is one image file: if it is a picture of many views, give their columns "
                          "and rows (lfimport --grid)", last)


if __name__ == "__main__":
    IMPORT, RENDERER, COMPRESSOR, PREPROCESSOR, MERGE = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1] + sys.argv[6:])
