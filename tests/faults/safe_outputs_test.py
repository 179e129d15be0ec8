#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that wrong output names destroy nothing, that file names cannot forge messages, and that truncated pictures are
not kept.

usage: safe_outputs_test.py FOLDER_OF_PROGRAMS
"""
import hashlib
import pathlib
import shutil
import subprocess
import sys
import unittest

from program_test_case import ProgramTestCase

PROGRAMS = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class SafeOutputsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field, self.path = self.folder / "field", self.folder / "path.yaml"
        self.succeeds(PROGRAMS / "lfsynth", "chart", "-o", self.field, "--count", "9", "--size", "48x32",
                      "--samples", "1", "--format", "png", "-q")
        self.succeeds(PROGRAMS / "lfexample", self.field, "-o", self.path, "--move", "static", "--focus", "3", "-q")
        self.calibration = self.field / "transforms.json"

    def keeps(self, path, code, words, program, *arguments):
        before = digest(path)
        self.fails(code, words, PROGRAMS / program, *arguments)
        self.assertEqual(digest(path), before)

    def test_a_light_field_is_not_replaced(self):
        again = ["chart", "-o", self.field, "--count", "9", "--size", "48x32", "--samples", "1", "-q"]
        self.keeps(self.calibration, 2, ["transforms.json", "exists already", "--overwrite"], "lfsynth", *again)
        self.succeeds(PROGRAMS / "lfsynth", *again, "--overwrite")
        self.calibration.write_text(self.calibration.read_text().replace('"frames"', ' "frames"', 1))
        self.keeps(self.calibration, 2, ["transforms.json", "--overwrite"], "lfsynth", *again)
        self.keeps(self.calibration, 2, ["--overwrite"], "lfsynth", *again, "--calibration-only")
        self.succeeds(PROGRAMS / "lfsynth", *again, "--overwrite")

    def test_a_path_replaces_paths_alone(self):
        self.keeps(self.calibration, 2, ["is not a camera path"], "lfexample", self.field, "-o", self.calibration)
        picture = next(self.field.rglob("*.png"))
        self.keeps(picture, 2, ["is not a camera path"], "lfexample", self.field, "-o", picture)
        again = [self.field, "-o", self.path, "--move", "static", "--focus"]
        self.succeeds(PROGRAMS / "lfexample", *again, "3", "--overwrite", "-q")
        self.succeeds(PROGRAMS / "lfexample", *again, "4", "-q")  # over what lfexample wrote
        written = self.path.read_text()
        for edited in (written + "# edited\n", written.replace("fps: 25", "fps: 24"), "# mine\n" + written):
            self.assertNotEqual(edited, written)
            self.path.write_text(edited)
            self.keeps(self.path, 2, ["path.yaml", "exists already", "--overwrite"], "lfexample", *again, "4")
        self.succeeds(PROGRAMS / "lfexample", *again, "4", "--overwrite", "-q")
        self.assertNotIn("# edited", self.path.read_text())

    def test_a_video_replaces_videos_alone(self):
        for file in (self.path, self.calibration, next(self.field.rglob("*.png"))):
            there = self.folder / f"{file.stem}.mp4"
            shutil.copy(file, there)
            self.keeps(there, 4, ["--video", there.name, "is not an mp4 video"], "lfrenderer", self.field, self.path,
                       "-o", self.folder / "film", "--video", there)
            self.assertFalse(list(self.folder.glob("film/frame_*")))

    def field_named_as_frames(self):
        """Writes a light field whose LF images lie beside it and are named frame_0001.png and so on."""
        text = self.calibration.read_text()
        images = sorted(self.field.rglob("*.png"))
        for number, image in enumerate(images, 1):
            name = f"frame_{number:04d}.png"
            text = text.replace(str(image.relative_to(self.field)), name)
            image.rename(self.field / name)
        self.calibration.write_text(text)
        return self.field / "frame_0001.png"

    def test_frames_do_not_replace_lf_images(self):
        picture = self.field_named_as_frames()
        link = self.folder / "link"
        link.symlink_to(self.field)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        (elsewhere / "frame_0001.png").symlink_to(picture)
        words = ["frame_0001.png", "an LF image", "-o"]
        render = [self.field, self.path, "--format", "png", "-o"]
        before = sorted(self.field.rglob("*"))
        for output in (self.field, link, elsewhere):
            for more in ([], ["--overwrite"], ["--resume"]):
                self.keeps(picture, 2, words, "lfrenderer", *render, output, *more)
        packages = self.folder / "packages"
        self.succeeds(PROGRAMS / "lfpreprocessor", self.field, self.path, "-o", packages, "-q")
        self.keeps(picture, 2, words, "lfrenderer", *packages.glob("*.lfp"), "--format", "png", "-o", self.field)
        self.keeps(picture, 2, words, "lfsubmit", *packages.glob("*.lfp"), "-o", self.field, "--", "--format", "png")
        self.assertEqual(sorted(self.field.rglob("*")), before)
        # Frames in another format have other names.
        self.succeeds(PROGRAMS / "lfrenderer", self.field, self.path, "-o", self.field, "--frames", "1", "-q")
        self.succeeds(PROGRAMS / "lfrenderer", *render, self.folder / "film", "-q")

    def test_frames_in_another_format_stay_and_are_warned_of(self):
        out, cut = self.folder / "film", self.folder / "cut"
        render = [PROGRAMS / "lfrenderer", self.field, self.path]
        self.succeeds(*render, "-o", out, "-q")
        self.succeeds(*render, "-o", cut, "--shard", "1/1", "-q")
        before = (out / "frame_0001.exr").read_bytes()
        png = ["-o", out, "--format", "png", "--overwrite", "-q"]
        for call in ([*render, *png],
                     [PROGRAMS / "lfmerge", cut / "partial" / "shards", *png],
                     [PROGRAMS / "lffocus", "through", self.field, self.path, *png]):
            with self.subTest(call[0].name):
                (out / "frame_0001.png").unlink(missing_ok=True)
                result = self.call(*call)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertRegex(result.stderr, "warning: .*film: .*frame_0001.exr.* another format")
                self.assertEqual((out / "frame_0001.exr").read_bytes(), before)
                self.assertTrue((out / "frame_0001.png").exists())
        result = self.call(*render, "-o", out, "--overwrite")
        self.assertRegex(result.stderr, "warning: .*film: .*frame_0001.png.* another format")
        (out / "frame_0001.png").unlink()
        self.assertNotIn("another format", self.call(*render, "-o", out, "--overwrite").stderr)

    def test_merged_frames_do_not_replace_lf_images(self):
        picture = self.field_named_as_frames()
        self.succeeds(PROGRAMS / "lfrenderer", self.field, self.path, "-o", self.folder / "cut", "--shard", "1/1", "-q")
        plates = self.folder / "cut" / "partial" / "shards"
        for more in ("--overwrite", "--resume"):
            self.keeps(picture, 2, ["frame_0001.png"], "lfmerge", plates, "-o", self.field, "--format", "png", more)
        self.assertFalse((self.field / "partial").exists())

    def test_what_is_read_is_not_replaced(self):
        path = self.folder / "film" / "report.json"
        path.parent.mkdir()
        self.path.rename(path)
        self.keeps(path, 2, ["report.json", "an input file"], "lfrenderer", self.field, path, "-o", path.parent)
        # An LF image has the name of the contact sheet.
        picture = next(self.field.rglob("*.png"))
        sheet = picture.with_name("contact_sheet.png")
        self.calibration.write_text(self.calibration.read_text().replace(picture.name, sheet.name))
        picture.rename(sheet)
        self.keeps(sheet, 2, ["contact_sheet.png", "an LF image"], "lfrenderer", self.field, path, "-o", sheet.parent)

    def test_a_store_does_not_replace_what_it_is_made_from(self):
        store, link = self.folder / "a.lfs", self.folder / "b.lfs"
        self.succeeds(PROGRAMS / "lfcompressor", self.field, "-o", store, "-q")
        link.symlink_to(store)
        for output in (store, link):
            self.keeps(store, 2, ["cannot be compressed again"], "lfcompressor", store, "-o", output, "--overwrite")
        picture = next(self.field.rglob("*.png"))
        for output in (picture, self.calibration, self.path):
            self.keeps(output, 2, [], "lfcompressor", self.field, "-o", output, "--overwrite")
        named = self.field / "image.lfs"
        picture.rename(named)
        self.keeps(named, 2, ["is not a packed store"], "lfcompressor", self.field, "-o", named, "--overwrite")

    def test_help_that_cannot_be_written_is_an_error(self):
        for program in ("lfrenderer", "lfimport"):
            for word in ("--help", "--version"):
                with open("/dev/full", "w", encoding="utf-8") as full:
                    result = subprocess.run([PROGRAMS / program, word], stdout=full, stderr=subprocess.PIPE,
                                            text=True, timeout=60)
                self.assertEqual(result.returncode, 4)
                self.assertTrue(result.stderr.splitlines()[-1].startswith("error: "), result.stderr)

    def test_a_name_cannot_forge_the_last_line(self):
        name = self.folder / "a\nwritten: all is well\x1b[2K"
        for program, more in (("lfrenderer", [self.path, "-o", self.folder / "film"]),
                              ("lfimport", []), ("lfpreprocessor", [self.path, "-o", self.folder / "packages"])):
            result = self.call(PROGRAMS / program, name, *more)
            self.assertEqual(result.returncode, 3, result.stderr)
            lines = result.stderr.splitlines()
            self.assertTrue(lines[-1].startswith("error: "), result.stderr)
            self.assertNotIn("\x1b", result.stderr)
            self.assertFalse([line for line in lines if line.startswith("written")], result.stderr)
        result = self.call(PROGRAMS / "lfrenderer", "--no-such\noption")
        self.assertEqual(result.returncode, 2)
        self.assertTrue(result.stderr.splitlines()[-1].startswith("error: "), result.stderr)

    def test_a_frame_that_was_cut_is_rendered_again(self):
        film = self.folder / "film"
        self.succeeds(PROGRAMS / "lfexample", self.field, "-o", self.path, "--move", "dolly", "--focus", "3",
                      "--overwrite", "-q")
        for form in ("exr", "png16"):
            shutil.rmtree(film, ignore_errors=True)
            call = [PROGRAMS / "lfrenderer", self.field, self.path, "-o", film, "--no-contact-sheet", "--format", form,
                    "--frames", "1-3"]
            self.succeeds(*call, "-q")
            frames = sorted(film.glob("frame_*"))
            self.assertEqual(len(frames), 3)
            whole = [digest(frame) for frame in frames]
            frames[1].write_bytes(frames[1].read_bytes()[:-200])
            result = self.call(*call, "--resume")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("the frame is rendered again", result.stderr)
            self.assertIn(frames[1].name, result.stderr)
            self.assertEqual([digest(frame) for frame in frames], whole)
            kept = frames[0].stat().st_mtime_ns
            self.succeeds(*call, "--resume", "-q")
            self.assertEqual(frames[0].stat().st_mtime_ns, kept)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
