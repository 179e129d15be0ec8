#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests packed stores from a user's view: made by lfcompressor, killed, resumed, verified, damaged.

usage: lfcompressor_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR
"""
import json
import os
import random
import re
import signal
import sqlite3
import subprocess
import sys
import time
import unittest

import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase
from small_field import HEIGHT, SIDE, WIDTH, write_field, write_path

COMPRESSOR = RENDERER = PREPROCESSOR = None


def smooth(index):
    """Returns a picture that wavelets compress well."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    waves = 128 + 100 * np.sin(x / 9 + index / 5) * np.cos(y / 7)
    noise = np.random.default_rng(index).normal(0, 2, (HEIGHT, WIDTH, 3))
    return np.clip(waves[..., None] + [0, 8, -8] + noise, 0, 255).astype(np.uint8)


class StoreTest(ProgramTestCase):
    """Provides a folder and calls of programs."""

    def setUp(self):
        super().setUp()
        self.store = self.folder / "a.lfs"

    def compress(self, *arguments):
        return self.succeeds(COMPRESSOR, *arguments)

    def report(self, *arguments, code=0):
        return json.loads(self.succeeds(COMPRESSOR, *arguments, "--json", code=code))

    def names(self):
        return sorted(path.name for path in self.folder.iterdir() if path.name.startswith("a"))

    def many(self, picture=smooth):
        """Returns 3000 LF images that share 25 files."""
        folder = self.folder / "field"
        field = write_field(folder, picture)
        text = json.loads(field.read_text())
        frames = []
        for i in range(3000):
            frame = dict(text["frames"][i % 25])
            os.link(folder / frame["file_path"], folder / f"link_{i}.png")
            frame["file_path"] = f"link_{i}.png"
            frames.append(frame)
        field.write_text(json.dumps(text | {"frames": frames}))
        return field


class CompressorTest(StoreTest):
    # Reports and quality

    def test_profiles_and_what_the_report_tells(self):
        field = write_field(self.folder / "field", smooth)
        pixels = SIDE * SIDE * WIDTH * HEIGHT * 3
        reports = {}
        for profile in "default", "thesis", "lossless":
            report = reports[profile] = self.report(field, "-o", self.folder / f"{profile}.lfs",
                                                    "--profile", profile, "--verify")
            self.assertEqual((report["lf_images"], report["coded"], report["verified"]), (25, 25, 25))
            self.assertEqual(report["pixel_bytes"], pixels)
            self.assertAlmostEqual(report["ratio"], pixels / report["code_bytes"])
            self.assertEqual(report["skipped"], [])
            self.assertGreater(report["store_bytes"], report["code_bytes"])
        self.assertEqual(reports["lossless"]["psnr_db"], "exact")
        self.assertGreater(reports["default"]["ratio"], reports["lossless"]["ratio"])
        self.assertGreater(reports["default"]["psnr_db"], 40)
        self.assertGreaterEqual(reports["default"]["psnr_db"], reports["default"]["worst_psnr_db"])
        text = self.compress(field, "-o", self.store)
        for word in "25 LF images", "pixels", "files", "quality", "MB/s", "next: lfrenderer":
            self.assertIn(word, text)

    def test_the_quality_that_is_asked_for(self):
        field = write_field(self.folder / "field", smooth)
        coarser = None
        for target in 48, 42, 38:
            report = self.report(field, "-o", self.store, "--target-psnr", target, "--overwrite")
            self.assertGreater(report["psnr_db"], target - 0.2)
            self.assertLess(report["psnr_db"], target + 1.5)
            if coarser:
                self.assertGreater(report["ratio"], coarser)
            coarser = report["ratio"]
        self.fails(2, ["--target-psnr 80", "these options give at most"], COMPRESSOR, field, "-o",
                   self.store, "--target-psnr", 80, "--profile", "thesis", "--overwrite")

    def test_the_same_store_whatever_the_threads(self):
        field = write_field(self.folder / "field", smooth)
        codes = []
        for threads in 1, 3:
            self.compress(field, "-o", self.store, "--threads", threads, "--overwrite")
            with sqlite3.connect(self.store) as database:
                codes.append(database.execute("select id, code from blobs order by id").fetchall())
        self.assertEqual(codes[0], codes[1])

    def test_levels_of_a_sensor_scale_the_threshold(self):
        """Values of 12 bits in 16-bit files must be encoded with the same quality as values of 16 bits."""
        def picture(scale):
            return lambda index: (smooth(index).astype(np.uint16)[..., 1] * scale)
        psnr = []
        for scale, white in (16, 4080), (256, 65280):
            field = write_field(self.folder / f"field{scale}", picture(scale), lf_bayer="RGGB",
                                lf_transfer="linear", lf_black_level=0, lf_white_level=white)
            psnr.append(self.report(field, "-o", self.store, "--overwrite")["psnr_db"])
            with sqlite3.connect(self.store) as database:
                self.assertEqual(database.execute("select distinct kind from codes").fetchall(),
                                 [("display16",)])
        self.assertAlmostEqual(psnr[0], psnr[1], delta=0.3)
        self.assertGreater(psnr[0], 40)
        # If levels of the calibration are corrected later, the encoded curve keeps its own levels.
        path = write_path(self.folder)
        frames = []
        for white in 65280, 32640:
            with sqlite3.connect(self.store) as database:
                database.execute("update settings set value = ? where key = 'white_level'", (str(white),))
            out = self.folder / f"out{white}"
            result = self.call(RENDERER, self.store, path, "-o", out, "--format", "png", "-q")
            self.assertEqual(result.returncode, 0, result.stderr)
            frames.append(np.asarray(Image.open(out / "frame_0001.png")).astype(float).mean())
        self.assertGreater(frames[1], frames[0] * 1.1)

    def test_packages_take_what_they_need(self):
        field = write_field(self.folder / "field", smooth)
        path = write_path(self.folder, 2, aperture=0.012, x=-0.02)
        path.write_text(path.read_text().replace("view_deg: 50", "view_deg: 15"))
        packages = self.folder / "packages"
        self.call(PREPROCESSOR, field, path, "-o", packages)
        files = sorted(packages.glob("*.lfp"))
        whole = self.report(*files, "-o", self.folder / "whole.lfs", "--profile", "lossless")
        part = self.report(*files, "-o", self.folder / "part.lfs", "--profile", "lossless",
                           "--needed-pixels", "--verify")
        self.assertLess(whole["lf_images"], 25)
        self.assertEqual(part["lf_images"], whole["lf_images"])
        self.assertLess(part["pixel_bytes"], whole["pixel_bytes"])
        for light_field in [], ["--lightfield", self.folder / "part.lfs"]:
            out = self.folder / f"out{len(light_field)}"
            result = self.call(RENDERER, *files, *light_field, "-o", out)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "out0/frame_0001.exr").read_bytes(),
                         (self.folder / "out2/frame_0001.exr").read_bytes())

    def test_contexts_keep_the_same_pixels_in_fewer_bytes(self):
        field, path = write_field(self.folder / "field", smooth), write_path(self.folder)
        for profile in ("default", "lossless"):
            frames, sizes = [], []
            for entropy in ("packed", "contexts"):
                store, out = self.folder / f"{profile}-{entropy}.lfs", self.folder / f"{profile}-{entropy}"
                report = self.report(field, "-o", store, "--profile", profile, "--reencode", "--entropy", entropy,
                                     "--verify")
                self.assertEqual("contexts" in report["codec"], entropy == "contexts")
                sizes.append(report["code_bytes"])
                self.succeeds(RENDERER, store, path, "-o", out, "--format", "png")
                frames.append([np.asarray(Image.open(frame)).tolist() for frame in sorted(out.glob("*.png"))])
            self.assertTrue(frames[0])
            self.assertEqual(*frames)
            self.assertLess(sizes[1], sizes[0])
        self.fails(3, ["coded by contexts"], COMPRESSOR, field, "-o", self.folder / "default-contexts.lfs", "--verify",
                   "--reencode")
        self.fails(2, ["--entropy contexts", "--profile thesis"], COMPRESSOR, field, "-o", self.store, "--profile",
                   "thesis", "--entropy", "contexts")

    # Failures

    def test_usage(self):
        field = write_field(self.folder / "field", smooth)
        for words, options in ((["--quantizer", "thesis"], ["--quantizer", "512"]),
                               (["lossless, which drops no details"], ["--profile", "lossless", "--threshold", "2"]),
                               (["--quantizer 9x"], ["--profile", "thesis", "--quantizer", "9x"]),
                               (["--needed-pixels", "packages"], ["--needed-pixels"]),
                               (["--levels"], ["--levels", "6"])):
            self.fails(2, words, COMPRESSOR, field, "-o", self.store, *options)
        self.fails(2, ["ends in .lfs"], COMPRESSOR, field, "-o", self.folder / "store.db")
        self.assertEqual(self.names(), [])
        self.compress(field, "-o", self.store)
        self.fails(2, ["exists already", "--overwrite"], COMPRESSOR, field, "-o", self.store)
        self.fails(2, ["copied as they are", "--profile"], COMPRESSOR, self.store, "-o", self.folder / "b.lfs",
                   "--profile", "lossless")
        self.assertTrue(self.report(field, "-o", self.store, "--resume")["was_there"])
        self.fails(3, ["made with the encoding"], COMPRESSOR, field, "-o", self.store, "--verify",
                   "--threshold", 5)

    def test_an_image_that_is_broken_is_skipped_and_named(self):
        field = write_field(self.folder / "field", smooth)
        (self.folder / "field/image_07.png").write_text("no picture")
        self.fails(3, ["image_07.png"], COMPRESSOR, field, "-o", self.store, "--strict")
        report = self.report(field, "-o", self.store, "--overwrite", "--verify", code=6)
        self.assertEqual([skipped["name"] for skipped in report["skipped"]], ["image_07.png"])
        self.assertEqual((report["coded"], report["verified"]), (24, 24))
        for image in (self.folder / "field").glob("*.png"):
            image.write_text("no picture")
        self.fails(3, ["none of the 25 LF images"], COMPRESSOR, field, "-o", self.folder / "b.lfs")

    def test_one_damaged_code_is_one_skipped_image(self):
        field, path = write_field(self.folder / "field", smooth), write_path(self.folder)
        self.compress(field, "-o", self.store)
        with sqlite3.connect(self.store) as database:
            code = bytearray(database.execute("select code from blobs where id = 12").fetchone()[0])
            code[len(code) // 2] ^= 16
            database.execute("update blobs set code = ? where id = 12", (bytes(code),))
        self.fails(6, ["1 of 25 LF images were left out", "image_12.png"], RENDERER, self.store, path,
                   "-o", self.folder / "out")
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertEqual([skipped["name"] for skipped in report["skipped_lf_images"]], ["image_12.png"])
        self.fails(3, ["a.lfs", "image_12.png"], RENDERER, self.store, path, "-o",
                   self.folder / "strict", "--strict")
        self.fails(3, ["a.lfs: 1 of 25 LF images are wrong", "image_12.png"], COMPRESSOR, field, "-o",
                   self.store, "--verify")

    def test_a_full_disk_keeps_what_is_done(self):
        field = write_field(self.folder / "field", smooth)
        limited = f"ulimit -f 64; exec '{COMPRESSOR}' '{field}' -o '{self.store}' --profile lossless"
        result = subprocess.run(["bash", "-c", "trap '' XFSZ; " + limited], capture_output=True, text=True)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("a.lfs", result.stderr.splitlines()[-1])
        self.assertFalse(self.store.exists())
        report = self.report(field, "-o", self.store, "--profile", "lossless", "--resume", "--verify")
        self.assertEqual(report["verified"], 25)

    def wait_for_work(self, process):
        """Waits until the store is being written, or was written."""
        while not (self.folder / "a.lfs.unfinished").exists() and process.poll() is None:
            time.sleep(0.005)

    def test_an_interruption_is_taken_up_again(self):
        field = self.many()
        process = subprocess.Popen([COMPRESSOR, field, "-o", self.store, "--threads", "1"],
                                   stderr=subprocess.PIPE, text=True, stdout=subprocess.PIPE)
        self.wait_for_work(process)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 5, errors)
        done = int(re.search(r"interrupted after (\d+) of 3000 LF images", errors)[1])
        self.fails(2, ["unfinished", "--resume"], COMPRESSOR, field, "-o", self.store)
        self.fails(2, ["codec"], COMPRESSOR, field, "-o", self.store, "--resume", "--threshold", 9)
        report = self.report(field, "-o", self.store, "--resume", "--verify")
        self.assertEqual((report["resumed"], report["verified"]), (done, 3000))

    def written_count(self):
        """Returns the number of LF images in the unfinished store; 0 before it has tables, or while it is locked."""
        unfinished = self.folder / "a.lfs.unfinished"
        if not unfinished.exists():
            return 0
        with sqlite3.connect(unfinished) as database:
            try:
                return database.execute("select count(*) from blobs").fetchone()[0]
            except sqlite3.OperationalError:
                return 0

    def test_kills_cost_nothing_that_was_written(self):
        field = self.many()
        chance = random.Random(1)
        kills, before = 0, 0
        for number in range(20):
            process = subprocess.Popen([COMPRESSOR, field, "-o", self.store, "--resume",
                                        "--threads", "1", "--progress", "none"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.wait_for_work(process)
            # Short, so that a fast machine does not write everything before it was killed a few times. Nothing is
            # written in so short a time, so some kills wait until an LF image is written.
            time.sleep(chance.uniform(0, 0.1))
            while number % 7 == 3 and self.written_count() <= before and process.poll() is None:
                time.sleep(0.05)
            process.kill()
            if process.wait() == 0 or self.store.exists():  # a fast machine has written everything
                break
            kills += 1
            done = self.written_count()
            self.assertGreaterEqual(done, before)
            before = done
        self.assertGreaterEqual(kills, 5)
        self.assertGreater(before, 0)
        report = self.report(field, "-o", self.store, *([] if self.store.exists() else ["--resume"]),
                             "--verify")
        self.assertEqual(report["verified"], 3000)
        with sqlite3.connect(self.store) as database:
            self.assertEqual(database.execute("pragma integrity_check").fetchall(), [("ok",)])
        self.assertEqual([name for name in self.names() if not name.endswith(".lock")], ["a.lfs"])


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
