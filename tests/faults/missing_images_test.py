#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests missing and broken LF images: they are left out and counted on the last line, with exit code 6, and accepted
with --allow-missing, for every program, mode and cut.

usage: missing_images_test.py LFRENDERER LFPREPROCESSOR LFCOMPRESSOR LFMERGE LFIMPORT
"""
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

import small_field
from program_test_case import ProgramTestCase

RENDERER = PREPROCESSOR = COMPRESSOR = MERGE = IMPORT = None
BROKEN = (7, 12, 18)  # indices of broken LF images, among 25


class MissingImagesTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = small_field.write_field(self.folder / "field")
        self.path = small_field.write_path(self.folder)
        self.whole = {index: self.image(index).read_bytes() for index in BROKEN}
        self.image(7).unlink()
        self.image(12).write_bytes(self.whole[12][:900])
        self.image(18).write_bytes(b"")

    def image(self, index):
        return self.folder / "field" / f"image_{index:02d}.png"

    def mend(self, *indices):
        for index in indices or BROKEN:
            self.image(index).write_bytes(self.whole[index])

    def last_line(self, code, *command):
        result = self.call(*command)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.strip().splitlines()[-1]

    def render(self, out, *options):
        return [RENDERER, self.field, self.path, "-o", self.folder / out, *options]

    def report(self, out, name="report.json"):
        return json.loads((self.folder / out / name).read_text())

    def check_accepted(self, command, text, least):
        """A limit of `least` LF images or more accepts the missing ones, a smaller limit does not; everything is
        written each time."""
        for limit, code in ((least - 1, 6), (least, 0), (f"{100 * (least - 1) // 25}%", 6),
                            ("100%", 0)):
            with self.subTest(limit=limit):
                result = self.call(*command(f"limit-{limit}"), "--allow-missing", limit)
                self.assertEqual(result.returncode, code, result.stderr)
                told = [line for line in result.stderr.splitlines() if text in line]
                self.assertEqual(len(told), 1, result.stderr)
                start = "error: " if code else "warning: "
                self.assertTrue(told[0].startswith(start), told[0])
                if code:
                    self.assertEqual(told[0], result.stderr.strip().splitlines()[-1])
                    self.assertIn(f"--allow-missing {least}", told[0])

    # lfrenderer

    def test_every_mode_counts_them_on_the_last_line_and_writes_everything(self):
        for options in ([], ["--estimator", "nearest"], ["--lens-weights", "none"],
                        ["--lens-weights", "hat"], ["--mode", "rebin"], ["--mode", "hybrid"],
                        ["--back-end", "reference"], ["--stop-when", "samples>=1"]):
            with self.subTest(options=options):
                out = "-".join(["out", *options]).replace(">", "")
                last = self.last_line(6, *self.render(out, *options, "--json", "--video",
                                                      self.folder / "film.mp4"))
                told = re.match(r"error: 3 of (\d+) LF images were left out", last)
                self.assertTrue(told, last)
                for word in ("image_", "--allow-missing 3", "without --resume"):
                    self.assertIn(word, last)
                self.assertEqual(len(list((self.folder / out).glob("frame_*.exr"))), 3)
                self.assertTrue((self.folder / out / "contact_sheet.png").exists())
                self.assertGreater((self.folder / "film.mp4").stat().st_size, 1000)
                (self.folder / "film.mp4").unlink()
                report = self.report(out)
                self.assertEqual((report["lf_images_skipped"], report["lf_images_selected"]),
                                 (3, int(told[1])))
                self.assertEqual(sorted(image["name"] for image in report["skipped_lf_images"]),
                                 [f"image_{index:02d}.png" for index in BROKEN])

    def test_so_many_are_accepted_and_no_more(self):
        self.check_accepted(self.render, "3 of 25 LF images were left out", 3)
        # 12 % of 25 are 3; a slightly smaller percentage allows fewer.
        self.succeeds(*self.render("a", "--allow-missing", "12%"))
        self.succeeds(*self.render("b", "--allow-missing", "11.999999%"), code=6)
        self.fails(3, ["image_"], *self.render("c", "--allow-missing", "3", "--strict"))

    def test_other_limits_are_no_usage(self):
        for limit in ("-1", "x", "1.5", "101%", "-1%", "%", "2 %", "0.1234567%", "nan%", "1e1"):
            self.fails(2, ["--allow-missing", "expected a number of LF images"],
                       *self.render("out", f"--allow-missing={limit}"))
        self.assertFalse((self.folder / "out").exists())

    def test_frames_below_what_is_required_are_told_beside_them(self):
        last = self.last_line(6, *self.render("out", "--require", "samples>=1000"))
        self.assertRegex(last, r"3 of \d+ LF images were left out")
        self.assertIn("--require samples>=1000", last)

    def test_resume_keeps_what_was_rendered_without_them_and_says_so(self):
        self.last_line(6, *self.render("out"))
        before = {path.name: path.read_bytes() for path in (self.folder / "out").glob("frame_*")}
        self.mend()
        last = self.last_line(6, *self.render("out", "--resume"))
        self.assertIn("3 of 25 LF images were left out", last)
        self.assertEqual({path.name: path.read_bytes()
                          for path in (self.folder / "out").glob("frame_*")}, before)
        # Without --resume, all frames are rendered again with all LF images.
        self.succeeds(*self.render("out"))
        self.assertEqual(self.report("out")["lf_images_skipped"], 0)
        self.assertNotEqual((self.folder / "out/frame_0001.exr").read_bytes(),
                            before["frame_0001.exr"])

    def test_resume_forgets_them_where_nothing_of_the_render_is_kept(self):
        self.last_line(6, *self.render("out"))
        self.mend()
        for frame in (self.folder / "out").glob("frame_*"):
            frame.unlink()
        self.succeeds(*self.render("out", "--resume"))
        self.assertEqual(self.report("out")["lf_images_skipped"], 0)

    def test_those_of_an_interrupted_run_count_too(self):
        small_field.write_path(self.folder, frames=400)
        process = subprocess.Popen(list(map(str, self.render("out", "--threads", 1, "--dump-every",
                                                             "0.02s"))),
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        partial = self.folder / "out" / "partial"
        end = time.monotonic() + 60
        while time.monotonic() < end and process.poll() is None:
            if len(list(partial.glob("frame_*.json"))) > 2:
                break
            time.sleep(0.005)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(), 5)
        self.mend()
        last = self.last_line(6, *self.render("out", "--resume"))
        self.assertIn("3 of 25 LF images were left out", last)
        self.assertEqual(self.report("out")["lf_images_skipped"], 3)

    # Packages and shards

    def packages(self, *options, code=6):
        out = self.folder / "packages"
        report = json.loads(self.succeeds(PREPROCESSOR, self.field, self.path, "-o", out, "--json",
                                          "--packages", 3, *options, code=code))
        return report, sorted(out.glob("*.lfp"))

    def test_packages_are_written_without_files_that_are_missing(self):
        report, files = self.packages()
        self.assertEqual(len(files), 3)
        # The file of image_12 is broken, but it is not empty, so lfpreprocessor does not count it.
        self.assertEqual((report["lf_images_missing"], report["lf_images_needed"]), (2, 25))
        self.assertEqual([package["lf_images_missing"] for package in report["packages"]], [2] * 3)
        self.check_accepted(
            lambda out: [PREPROCESSOR, self.field, self.path, "-o", self.folder / out],
            "2 of 25 LF images that packages need do not exist", 2)
        self.fails(3, ["--strict", "image_"], PREPROCESSOR, self.field, self.path, "-o",
                   self.folder / "strict", "--strict")
        self.mend()
        self.packages("--overwrite", code=0)

    def test_packages_tell_which_lack_how_many(self):
        _, files = self.packages()
        command = [RENDERER, *files, "-o", self.folder / "out"]
        last = self.last_line(6, *command)
        for words in ("3 LF images were left out", "3 of 25 in package-0000",
                      "3 of 25 in package-0002"):
            self.assertIn(words, last)
        report = json.loads(self.succeeds(*command, "--resume", "--json", "--allow-missing", 3))
        self.assertEqual([package["lf_images_skipped"] for package in report["packages"]], [3] * 3)
        self.succeeds(*command, "--resume", "--allow-missing", 2, code=6)
        self.succeeds(*command, "--resume", "--allow-missing", "12%")
        self.succeeds(*command, "--resume", "--allow-missing", "8%", code=6)

    def test_a_percentage_is_of_each_package_and_a_number_of_all(self):
        """Packages 0 and 2 lack one LF image each."""
        self.mend()
        _, files = self.packages(code=0)
        for file, index in zip(files[::2], BROKEN[:2]):
            self.image(index).unlink()
            self.succeeds(RENDERER, file, "-o", self.folder / "out", code=6)
            self.mend(index)
        self.succeeds(RENDERER, files[1], "-o", self.folder / "out")
        command = [RENDERER, *files, "-o", self.folder / "out", "--resume", "--allow-missing"]
        last = self.last_line(6, *command, 1)
        for words in ("2 LF images were left out", "1 of 25 in package-0000",
                      "1 of 25 in package-0002", "--allow-missing 2"):
            self.assertIn(words, last)
        self.assertNotIn("package-0001", last)
        for limit, code in ((2, 0), ("4%", 0), ("3.9%", 6)):
            self.succeeds(*command, limit, code=code)

    def test_shards_hand_them_on_to_lfmerge(self):
        self.last_line(6, *self.render("whole", "--keep-plates"))
        skipped = 0
        for number in (1, 2):
            last = self.call(*self.render("out", "--shard", f"{number}/2"))
            report = self.report("out", f"report-shard_{number}_of_2.json")
            self.assertEqual(last.returncode, 6 if report["lf_images_skipped"] else 0)
            skipped += report["lf_images_skipped"]
        self.assertEqual(skipped, 3)
        merge = [MERGE, self.folder / "out/partial/shards", "-o", self.folder / "out"]
        last = self.last_line(6, *merge)
        self.assertIn("3 of 25 LF images were left out", last)
        self.assertIn("merge with --overwrite", last)
        report = self.report("out")
        self.assertEqual((report["lf_images_skipped"], report["lf_images_selected"]), (3, 25))
        self.assertEqual(sorted(image["name"] for image in report["skipped_lf_images"]),
                         [f"image_{index:02d}.png" for index in BROKEN])
        for frame in (self.folder / "whole").glob("frame_*.exr"):
            self.assertEqual(frame.read_bytes(), (self.folder / "out" / frame.name).read_bytes())
        for limit, code in ((3, 0), (2, 6), ("12%", 0), ("11%", 6)):
            self.succeeds(*merge, "--resume", "--allow-missing", limit, code=code)
        # The plates that a whole render kept also count the missing LF images.
        kept = sorted((self.folder / "whole").glob("*.plate"))
        self.assertIn("3 of 25", self.last_line(6, MERGE, *kept, "-o", self.folder / "again"))

    def test_plates_have_the_same_bytes_for_any_memory(self):
        """The bytes include the plates' count of missing LF images."""
        small_field.write_path(self.folder, frames=12)
        few = self.call(*self.render("few", "--threads", 2, "--memory", "2M"))
        least = re.search(r"at least (\d+) MiB", few.stderr).group(1)
        self.last_line(6, *self.render("much", "--keep-plates", "--threads", 2))
        self.last_line(6, *self.render("little", "--keep-plates", "--threads", 2, "--memory",
                                       f"{least}M"))
        self.assertGreater(self.report("little")["passes"], 1)
        for plate in (self.folder / "much").glob("*.plate"):
            self.assertEqual(plate.read_bytes(),
                             (self.folder / "little" / plate.name).read_bytes())

    # Stores and imports

    def test_a_store_without_all_codes_is_told_by_whoever_makes_or_checks_it(self):
        text = "3 of 25 LF images are not in the store"
        self.check_accepted(lambda out: [COMPRESSOR, self.field, "-o",
                                         self.folder / f"{out.replace('%', 'p')}.lfs"], text, 3)
        store = self.folder / "limit-3.lfs"
        for option in ("--resume", "--verify"):
            report = json.loads(self.succeeds(COMPRESSOR, self.field, "-o", store, option, "--json",
                                              code=6))
            self.assertEqual((report["was_there"], report["lf_images_skipped"]), (True, 3))
            self.succeeds(COMPRESSOR, self.field, "-o", store, option, "--allow-missing", 3)
        self.assertIn("3 of 25", self.last_line(6, RENDERER, store, self.path, "-o",
                                                self.folder / "out"))
        self.fails(3, ["image_"], COMPRESSOR, self.field, "-o", self.folder / "s.lfs", "--strict")
        self.mend()
        self.assertIn(text, self.last_line(6, COMPRESSOR, self.field, "-o", store, "--resume"))
        self.succeeds(COMPRESSOR, self.field, "-o", store, "--overwrite")
        self.succeeds(RENDERER, store, self.path, "-o", self.folder / "out")

    def test_an_unfinished_store_tries_them_again(self):
        """A strict call leaves an unfinished store; an image that is mended afterwards is encoded."""
        store = self.folder / "a.lfs"
        self.fails(3, ["image_"], COMPRESSOR, self.field, "-o", store, "--strict", "--threads", 1)
        self.mend(7, 12)
        self.assertIn("1 of 25", self.last_line(6, COMPRESSOR, self.field, "-o", store, "--resume"))

    def test_an_import_tells_them_as_before(self):
        self.check_accepted(lambda out: [IMPORT, self.field, "--check", "pixels"],
                            "of 25 images are missing", 3)


if __name__ == "__main__":
    RENDERER, PREPROCESSOR, COMPRESSOR, MERGE, IMPORT = map(os.path.abspath, sys.argv[1:6])
    unittest.main(argv=[sys.argv[0], *sys.argv[6:]], verbosity=2)
