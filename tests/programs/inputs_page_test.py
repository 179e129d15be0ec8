#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the table "Every program and data set" of doc/inputs.md: its order, that each reader of the library has a row,
and that the call of each row opens what the program of the row writes.

usage: inputs_page_test.py LFSYNTH LFIMPORT LFCOMPRESSOR REPOSITORY
"""
import dataclasses
import json
import pathlib
import re
import shlex
import shutil
import sys
import unittest

import h5py
import numpy as np
from PIL import Image

import write_exports
import write_formats
import write_scans
from program_test_case import ProgramTestCase

SYNTH = IMPORT = COMPRESSOR = REPOSITORY = None
COLUMNS = ROWS = 5
# Readers whose page has another name: lf/import/*/read_NAME.cc.
PAGES = {"reality_csv": "realitycapture", "reality_xmp": "realitycapture", "splits": "transforms_json"}


def rows():
    """Returns [(program, page, call)] of the table."""
    text = (REPOSITORY / "doc" / "inputs.md").read_text()
    section = text[text.index("## Every program and data set"):]
    found = re.findall(r"^\| \[([^\]]+)\]\(formats/(\w+)\.md[^)]*\) \| .* \| `([^`]+)` \|$", section, re.M)
    table = section[section.index("| --- |"):section.index("\n\n", section.index("| --- |"))]
    assert len(found) == table.count("\n"), "each row has a link to a page and one call"
    return found


class InputsPageTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field_folder = self.folder / "synth"
        made = self.call(SYNTH, "lights", "-o", self.field_folder, "--count", COLUMNS * ROWS, "--format", "png",
                         "--size", "60x60")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.field = json.loads((self.field_folder / "transforms.json").read_text())
        files = [self.field_folder / frame["file_path"] for frame in self.field["frames"]]
        pictures = [np.asarray(Image.open(file).convert("RGB")) for file in files]
        self.views = np.stack(pictures).reshape(ROWS, COLUMNS, *pictures[0].shape)

    # Each method or function writes the files of a program into an empty folder, and returns what is opened instead of
    # the name in the table.

    def of_formats(write):
        return lambda self, folder: write(self.field, self.field_folder, folder)

    def of_exports(write, opened=".", images=None):
        def made(self, folder):
            views = [dataclasses.replace(view, name=str(n)) for n, view in enumerate(write_exports.random_views())]
            write(folder, views)
            if images is not None:
                write_exports.write_images(folder / images, views)
            return folder / opened
        return made

    def nerf(self, folder):
        write_formats.blender(self.field, self.field_folder, folder)
        content = json.loads((folder / "transforms_train.json").read_text())
        for part in ("val", "test"):
            (folder / f"transforms_{part}.json").write_text(json.dumps(content))
        return folder

    def picture(name, arrange):
        def made(self, folder):
            Image.fromarray(np.ascontiguousarray(arrange(self.views))).save(folder / name)
            return folder / name
        return made

    def lenslets(views):
        views = np.tile(views, (3, 3, 1, 1, 1))[:14, :14]
        return views.transpose(2, 0, 3, 1, 4).reshape(14 * views.shape[2], 14 * views.shape[3], 3)

    def mosaic(views):
        return np.concatenate([np.concatenate(list(row), 1) for row in views])

    def quilt(views):
        return np.concatenate([np.concatenate([views[0, column % COLUMNS] for column in range(8)], 1)] * 6)

    def archive(self, folder):
        with h5py.File(folder / "lf.h5", "w") as file:
            file["LF"] = self.views
            file.attrs.update({"dH": 0.1, "focalLength": 60.0, "shift": 1.0})
        return folder / "lf.h5"

    def filmed(self, folder):
        """Each camera has a folder of two frames."""
        write_formats.llff(self.field, self.field_folder, folder)
        images = sorted((folder / "images").iterdir())
        for n, image in enumerate(images):
            frames = folder / f"cam{n:02}"
            frames.mkdir()
            for frame in range(2):
                shutil.copy(image, frames / f"{frame:04}{image.suffix}")
        shutil.rmtree(folder / "images")
        return folder

    def array(self, folder):
        np.save(folder / "views.npy", self.views)
        return folder / "views.npy"

    def named(pattern):
        def made(self, folder):
            for index in range(ROWS * COLUMNS):
                row, column = divmod(index, COLUMNS)
                name = pattern.format(index=index, row=row, column=column)
                Image.fromarray(self.views[row, column]).save(folder / f"{name}.png")
            return folder
        return made

    def store(self, folder):
        made = self.call(COMPRESSOR, self.field_folder, "-o", folder / "a.lfs")
        self.assertEqual(made.returncode, 0, made.stderr)
        return folder / "a.lfs"

    MAKERS = {
        "3D Gaussian splatting": of_exports(write_exports.write_splat_cameras, "cameras.json", "images"),
        "4D Light Field Benchmark (HCI, Konstanz)": of_formats(write_formats.hci),
        "Airborne Optical Sectioning": of_formats(write_formats.aos),
        "Bundler; programs that export its form": of_exports(write_exports.write_bundler),
        "COLMAP": of_formats(write_formats.colmap_text),
        "Google's Spaces and Immersive Light Field Video": of_exports(write_scans.write_google_models),
        "HCI Light Field Archive (2013)": archive,
        "kapture": of_exports(write_scans.write_kapture),
        "Light field displays": picture("scene_qs8x6a0.75.png", quilt),
        "LLFF, NeRF's forward-facing scenes": of_formats(write_formats.llff),
        "Lytro cameras": picture("IMG_0001_eslf.png", lenslets),
        "Meshroom": of_exports(write_exports.write_meshroom),
        "Metashape, PhotoScan": of_exports(write_scans.write_metashape, "cameras.xml"),
        "Middlebury multi-view stereo": of_formats(write_formats.middlebury),
        "mosaics: all views in one picture": picture("scene_5x5.png", mosaic),
        "MVSNet and its successors": of_exports(write_exports.write_mvsnet),
        "NeRF's scenes of Blender": nerf,
        "nerfies, HyperNeRF": of_exports(write_exports.write_nerfies),
        "Neural 3D Video, other videos of several cameras": filmed,
        "nerfstudio, instant-ngp": of_formats(write_formats.nerfstudio),
        "NSVF": of_exports(write_exports.write_nsvf),
        "NumPy": array,
        "OpenMVG": of_exports(write_exports.write_openmvg),
        "OpenSfM; OpenDroneMap, WebODM": of_exports(write_exports.write_opensfm),
        "photographs of a grid of cameras": named("photo {index:02}"),
        "photographs named by row and column": named("out_{row:02}_{column:02}"),
        "Polycam": of_exports(write_scans.write_polycam),
        "RealityCapture, RealityScan: CSV": of_exports(write_scans.write_reality_csv, "scan.csv"),
        "RealityCapture, RealityScan: XMP": of_exports(write_scans.write_reality_xmp),
        "Record3D": of_exports(write_scans.write_record3d),
        "SLAM programs (ORB-SLAM and others), TUM's benchmark": of_exports(write_exports.write_tum),
        "Stanford Light Field Archive, gantries": named("out_{row:02}_{column:02}_{row}0_{column}0"),
        "VisualSFM": of_exports(write_exports.write_nvm, "model.nvm"),
        "this project: packed stores": store,
    }

    def test_rows_are_in_the_order_of_the_alphabet(self):
        programs = [program for program, _, _ in rows()]
        self.assertEqual(programs[:-1], sorted(programs[:-1], key=str.casefold))
        self.assertEqual(programs, list(dict.fromkeys(programs)))
        self.assertEqual(set(programs), set(self.MAKERS))

    def test_each_reader_has_a_row(self):
        pages = {page for _, page, _ in rows()}
        readers = [file.stem[len("read_"):] for file in (REPOSITORY / "lf" / "import").glob("*/read_*.cc")
                   if not file.stem.endswith(("_test", "_fuzz"))]
        self.assertGreater(len(readers), 20)
        for reader in readers:
            with self.subTest(reader):
                self.assertIn(PAGES.get(reader, reader), pages)

    def test_the_call_of_each_row_opens_what_the_program_writes(self):
        for number, (program, _, call) in enumerate(rows()):
            with self.subTest(program):
                folder = self.folder / f"row {number}"
                folder.mkdir()
                opened = self.MAKERS[program](self, folder)
                words = shlex.split(call)
                self.assertEqual(words[0], "lfimport")
                if "-o" in words:
                    words[words.index("-o") + 1] = folder / "native"
                if "--images" in words:
                    images = next((path for path in (folder / "images", folder / "photos") if path.is_dir()), folder)
                    words[words.index("--images") + 1] = images
                done = self.call(IMPORT, opened, *words[2:])
                self.assertEqual(done.returncode, 0, done.stderr)
                if "-o" in words:
                    done = self.call(IMPORT, folder / "native")
                    self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    SYNTH, IMPORT, COMPRESSOR, REPOSITORY = sys.argv[1:4] + [pathlib.Path(sys.argv[4])]
    unittest.main(argv=sys.argv[:1] + sys.argv[5:])
