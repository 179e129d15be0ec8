#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the folders that people have: whatever their images and calibrations are called and wherever they lie, all
images are found, and the commands that are printed lead to a first picture.

usage: found_captures_test.py LFIMPORT LFEXAMPLE LFRENDERER LFSYNTH LFCOMPRESSOR DATA [CONTACT_SHEET.png]
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image

import found_captures
import write_formats
from first_picture_case import write_sheet
from printed_commands import Ended
from program_test_case import ProgramTestCase

PROGRAMS = IMPORT = EXAMPLE = RENDERER = SYNTH = DATA = None
PICTURES = []
COUNT = 25
# Folders in which images have another order or size than in the light field itself.
NOT_THE_SAME_PICTURE = (found_captures.splits, found_captures.llff_smaller)


def centres(folder):
    """Returns the positions of the cameras of a transforms.json, sorted."""
    frames = json.loads((folder / "transforms.json").read_text())["frames"]
    return np.array(sorted(tuple(np.round(np.array(f["transform_matrix"])[:3, 3], 7)) for f in frames))


class FoundCapturesTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)
        cls.native = pathlib.Path(cls.shared.name) / "native"
        subprocess.run([SYNTH, "still-life", "-o", cls.native, "--count", str(COUNT), "--size", "96x64", "--format",
                        "png", "-q"], check=True)
        cls.field = json.loads((cls.native / "transforms.json").read_text())

    def line(self, line, code=0):
        """Runs a line of a shell in the folder of the test."""
        environment = dict(os.environ, PATH=f"{PROGRAMS}:{os.environ['PATH']}")
        done = subprocess.run(["bash", "-c", line], cwd=self.folder, env=environment, capture_output=True, timeout=300)
        ended = Ended(done.returncode, done.stdout.decode(), done.stderr.decode())
        self.assertEqual(ended.code, code, f"{line}\n{ended.text}")
        return ended

    def first_picture(self, name, capture):
        """Films a light field with no option. Returns the first frame."""
        self.line(f"lfexample '{capture}' -o path.yaml --move static")
        return self.picture_of(name, capture)

    def picture_of(self, name, capture):
        """Films a light field along the path of the last first_picture(). Returns the first frame."""
        self.line(f"lfrenderer '{capture}' path.yaml -o frames --frames 1 --format png --no-contact-sheet --overwrite")
        picture = Image.open(self.folder / "frames" / "frame_0001.png").convert("RGB")
        self.assertGreater(np.asarray(picture, float).std(), 5, name)
        PICTURES.append((name, picture))
        return np.asarray(picture, float)

    def report(self, capture, *options):
        return json.loads(self.succeeds(IMPORT, capture, "--json", *options))

    def expect_whole(self, report, count=COUNT):
        self.assertEqual((report["images"], report["missing"], report["broken"]), (count, 0, 0))

    def kinds(self, report):
        return [warning["kind"] for warning in report["warnings"]]

    def test_folders_open_as_they_are(self):
        expected = self.first_picture("native", self.native)
        for write in found_captures.OPEN_AS_THEY_ARE:
            with self.subTest(write.__name__):
                folder = self.folder / write.__name__
                capture = write(self.field, self.native, folder) or folder
                report = self.report(capture, "-o", self.folder / "out")
                self.expect_whole(report)
                np.testing.assert_allclose(centres(self.folder / "out"), centres(self.native), atol=2e-7)
                picture = self.first_picture(write.__name__, capture)
                if write not in NOT_THE_SAME_PICTURE:
                    self.assertLess(np.abs(picture - expected).mean(), 0.5)

    def test_grids_print_the_call_that_opens_them(self):
        for write in found_captures.PRINT_A_CALL:
            with self.subTest(write.__name__):
                write(self.field, self.native, self.folder / write.__name__)
                call, = self.line(f"lfimport {write.__name__}", code=3).commands("lfimport")
                self.line(call)
                self.expect_whole(self.report(self.folder / write.__name__))
                self.first_picture(write.__name__, write.__name__)
                # The file that was written locks nothing: neither the report nor another folder needs the same -o.
                self.line(f"{call.split(' -o ')[0].replace('--pitch 1', '--pitch 2')} -o elsewhere")
                self.assertAlmostEqual(self.report(self.folder / "elsewhere")["spacing_w"]["median"], 2)
                self.line(f"lfimport {write.__name__} --pitch 2 --focal-px 90 --plane-distance 150")

    def test_images_in_the_order_of_a_grid_open_with_its_size(self):
        side = 5
        names = {
            "sorted": lambda row, column, place: f"frame {place}.png",  # 10 follows 9
            "serpentine": lambda row, column, place:
                f"frame {row * side + (column if row % 2 == 0 else side - 1 - column)}.png",
        }
        for folder, name in names.items():
            with self.subTest(folder):
                found_captures.grid_names(self.field, self.native, self.folder / folder, name)
                options = "--grid 5x5" + (" --serpentine" if folder == "serpentine" else "")
                ended = self.line(f"lfimport {folder}", code=3)
                self.assertIn("give its columns and rows (lfimport --grid)", ended.text)
                call, = self.line(f"lfimport {folder} {options}", code=3).commands("lfimport")
                self.assertIn(options, call)
                self.line(call)
                self.expect_whole(self.report(self.folder / folder))
                self.first_picture(folder, folder)
                self.line(call.replace("--pitch 1", "--pitch 2"))  # the file that was written locks nothing
                self.assertAlmostEqual(self.report(self.folder / folder)["spacing_w"]["median"], 2)
        positions = [centres(self.folder / folder) for folder in names]
        by_row = np.reshape(positions, (2, side, side, 3))
        np.testing.assert_allclose(by_row[0, 0], by_row[1, 0])
        self.line("lfimport sorted --grid 5x4 --pitch 1 --focal-px 96", code=3)
        self.line("lfimport sorted --serpentine", code=2)

    def test_a_burst_is_no_grid(self):
        found_captures.images_into(self.native, self.folder / "burst", lambda index, name: f"IMG_4831_{index}.png")
        ended = self.line("lfimport burst", code=3)
        self.assertIn("holds 25 images, such as IMG_4831_0.png, but no file with the poses", ended.text)
        self.assertEqual(ended.commands("lfimport"), [])
        self.line("lfimport burst --pitch 1 --focal-px 96")  # it is a row after all

    def test_a_calibration_without_missing_images(self):
        shutil.copytree(self.native, self.folder / "capture")
        for index in (0, 3, 7, 19, 24):
            (self.folder / "capture" / self.field["frames"][index]["file_path"]).unlink()
        (self.folder / "capture" / self.field["frames"][5]["file_path"]).write_text("no image")
        call, = self.line("lfimport capture", code=6).commands("lfimport")
        self.line(call)
        self.expect_whole(self.report(self.folder / "complete"), COUNT - 6)
        self.first_picture("six missing", "complete")
        report = self.report(self.folder / "capture", "--exclude", "missing,*1*")
        self.assertEqual(report["left_out"], 6 + 12 - 1)
        for file in (self.folder / "capture" / "images").iterdir():
            file.unlink()
        self.fails(3, ["--exclude missing", "all 25 images are missing or broken"], IMPORT, self.folder / "capture",
                   "--exclude", "missing")

    def test_a_survey_to_and_fro_is_not_upside_down(self):
        """Each line of the flight turns the drone, and with it the images, by 180 degrees."""
        images = self.folder / "survey"
        images.mkdir()
        frames = []
        for index, frame in enumerate(self.field["frames"]):
            matrix = np.array(frame["transform_matrix"])
            image = Image.open(self.native / frame["file_path"])
            if index // 5 % 2:
                matrix[:3, :2] *= -1
                image = image.transpose(Image.Transpose.ROTATE_180)
            image.save(images / f"DJI_{index:04d}.png")
            frames.append({"file_path": f"DJI_{index:04d}.png", "transform_matrix": matrix.tolist()})
        found_captures.transforms(self.field, images, frames=frames)
        self.assertNotIn("upside-down", self.kinds(self.report(images)))
        self.first_picture("survey", "survey")

    def test_masks_are_used_or_named(self):
        mask = Image.new("L", (96, 64), 255)
        mask.paste(0, (0, 0, 30, 64))
        for form in ("{name}.png", "{stem}.png", "{name}"):
            with self.subTest(form):
                folder = self.folder / f"colmap {form}"
                write_formats.colmap_text(self.field, self.native, folder)
                (folder / "masks").mkdir()
                for image in (folder / "images").iterdir():
                    mask.save(folder / "masks" / form.format(name=image.name, stem=image.stem))
                report = self.report(folder)
                self.assertEqual((report["masks"], self.kinds(report).count("unused-masks")), (COUNT, 0))
        for place in ("masks", "images_mask", "images/dynamic_mask_"):
            with self.subTest(place):
                folder = self.folder / f"native {place.replace('/', ' ')}"
                shutil.copytree(self.native, folder)
                for image in sorted((folder / "images").iterdir()):
                    target = folder / (place + image.name if place.endswith("_") else f"{place}/{image.stem}.png")
                    target.parent.mkdir(exist_ok=True)
                    mask.save(target)
                report = self.report(folder)
                self.assertEqual((report["masks"], self.kinds(report).count("unused-masks")), (0, 1))
                ended = self.line(f"lfimport '{folder}'")
                for call in ended.commands("lfimport"):
                    self.line(call)
                    self.assertEqual(self.report(self.folder / "masked")["masks"], COUNT)
                    self.line("rm -r masked")
                self.assertEqual(len(ended.commands("lfimport")), int(place != "images/dynamic_mask_"), ended.text)

    def test_colour_profiles_are_converted(self):
        expected = self.first_picture("native", self.native)
        for suffix, limit in ((".png", 0.7), (".tif", 0.7), (".jpg", 3)):  # JPEG loses that much itself
            with self.subTest(suffix):
                folder = self.folder / f"phone{suffix}"
                found_captures.display_p3(self.field, self.native, folder, suffix)
                profile = self.report(folder)["colour_profile"]
                self.assertEqual(profile, {"name": "Display P3", "images": 15, "examined": 15, "converted": True})
                picture = self.picture_of("Display P3 " + suffix, folder)
                self.assertLess(np.abs(picture - expected).mean(), limit)
                self.line(f"lfcompressor '{folder}' -o phone.lfs -q && lfimport phone.lfs")
                self.line("rm phone.lfs")
                # A calibration that says what the numbers mean is right, whatever the files state.
                calibration = json.loads((folder / "transforms.json").read_text())
                (folder / "transforms.json").write_text(json.dumps({**calibration, "lf_transfer": "linear"}))
                self.assertFalse(self.report(folder)["colour_profile"]["converted"])

    def test_another_calibration_is_mentioned(self):
        write_formats.colmap_text(self.field, self.native, self.folder / "capture")
        found_captures.transforms(self.field, self.folder / "capture", lambda index, name: f"old/frame{index}.png")
        ended = self.line("lfimport capture --allow-missing 100%", code=3)
        self.assertIn("capture/sparse/0 may belong to the images instead", ended.text)
        self.expect_whole(self.report(self.folder / "capture/sparse/0"))

    def test_captures_that_failed(self):
        cases = pathlib.Path(DATA) / "cases"
        if not cases.exists():
            self.skipTest(f"{cases} is not there")
        for number in ("02", "03", "05", "06", "07", "10", "11", "12", "13", "17", "18"):
            case, = cases.glob(f"{number}-*")
            with self.subTest(case.name):
                shutil.copytree(case, self.folder / number, copy_function=shutil.copyfile)
                self.line(f"chmod -R u+w {number}")
                if number == "13":  # photographs without poses
                    self.assertIn("reconstruct the poses first", self.line(f"lfimport {number}", code=3).text)
                    continue
                ended = self.line(f"lfimport {number}", code=3 if number in ("02", "17") else 0)
                for call in ended.commands("lfimport"):
                    self.line(call)
                report = self.report(self.folder / number)
                self.expect_whole(report, sum(1 for file in case.rglob("*") if file.suffix.lower() in (".png", ".jpg")))
                self.assertNotIn("upside-down", self.kinds(report))
                self.first_picture(case.name, number)


if __name__ == "__main__":
    IMPORT, EXAMPLE, RENDERER, SYNTH = sys.argv[1:5]
    DATA = sys.argv[6]
    PROGRAMS = pathlib.Path(IMPORT).resolve().parent
    result = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False).result
    if len(sys.argv) > 7:
        write_sheet(sys.argv[7], PICTURES, 5)
    sys.exit(not result.wasSuccessful())
