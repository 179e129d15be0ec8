#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests stores of packages whose LF images have the quality that their film needs.

usage: quality_by_use_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFIMPORT LFSYNTH
"""
import json
import re
import shutil
import sqlite3
import subprocess
import sys
import time
import unittest

import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase
from small_field import HEIGHT, WIDTH, write_field, write_path

COMPRESSOR = RENDERER = PREPROCESSOR = IMPORT = SYNTH = None

BY_USE = "--quality-by-use"
WARNING = "the quality of this film may be lower"


def smooth(index):
    """Returns a picture that wavelets compress well."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    waves = 128 + 100 * np.sin(x / 9 + index / 5) * np.cos(y / 7)
    noise = np.random.default_rng(index).normal(0, 4, (HEIGHT, WIDTH, 3))
    return np.clip(waves[..., None] + [0, 8, -8] + noise, 0, 255).astype(np.uint8)


class QualityByUseTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field = write_field(self.folder / "field", smooth)
        self.store = self.folder / "a.lfs"
        # The lens moves from the middle of the capture to its right.
        self.path = write_path(self.folder, 4, aperture=0.03)
        self.path.write_text(re.sub(r"keyframes:", "keyframes:\n  position: [{time: 0, value: [0, 0, 0]}, "
                                    "{time: 1, value: [0.1, 0, 0]}]", self.path.read_text()))

    def packages(self, *options, field=None, path=None, name="packages"):
        self.succeeds(PREPROCESSOR, field or self.field, path or self.path, "-o", self.folder / name, *options)
        return sorted((self.folder / name).glob("*.lfp"))

    def report(self, *arguments, code=0):
        return json.loads(self.succeeds(COMPRESSOR, *arguments, "-o", self.store, "--json", code=code))

    def bytes_of_images(self):
        with sqlite3.connect(f"file:{self.store}?immutable=1", uri=True) as database:
            return dict(database.execute("select name, bytes from codes join lf_images using (id)"))

    def blobs(self, store=None):
        with sqlite3.connect(f"file:{store or self.store}?immutable=1", uri=True) as database:
            return database.execute("select id, code from blobs order by id").fetchall()

    def frames(self, *arguments):
        """Renders frames, and returns their display values."""
        out = self.folder / "frames"
        self.succeeds(RENDERER, *arguments, "-o", out, "--format", "png", "--overwrite", "-q")
        return np.stack([np.asarray(Image.open(file)).astype(float)
                         for file in sorted(out.glob("frame_*.png"))])

    def warning(self, *arguments, code=0):
        """Renders, and returns the lines that warn of another film."""
        shutil.rmtree(self.folder / "warned", ignore_errors=True)
        result = self.call(RENDERER, *arguments, "-o", self.folder / "warned", "--format", "png")
        self.assertEqual(result.returncode, code, result.stderr)
        return [line for line in result.stderr.splitlines() if WARNING in line]

    # Quality

    def test_images_that_count_more_have_more_bytes(self):
        packages = self.packages("--packages", 2)
        self.report(*packages, "--threshold", 4)
        uniform = self.bytes_of_images()
        report = self.report(*packages, "--threshold", 4, BY_USE, "--overwrite", "--verify")
        by_use = self.bytes_of_images()
        self.assertEqual(report["verified"], len(by_use))
        self.assertEqual(uniform.keys(), by_use.keys())
        self.assertIn("threshold 4 by use ", report["codec"])
        change = {name: by_use[name] / uniform[name] for name in uniform}
        self.assertGreater(change["image_12.png"], 1)  # in the middle of the lens
        self.assertLess(min(change.values()), 0.9)
        self.assertLess(sum(by_use.values()), sum(uniform.values()))
        self.assertLess(report["frames"]["worst_psnr_db"], report["frames"]["psnr_db"])
        self.assertGreater(report["frames"]["psnr_db"], report["psnr_db"])
        text = self.succeeds(COMPRESSOR, *packages, "-o", self.folder / "b.lfs", BY_USE)
        self.assertRegex(text, r"frames +\d+\.\d dB predicted; worst \d+\.\d dB \(frame \d\)")

    def test_the_quality_of_frames_is_found_and_predicted(self):
        packages = self.packages()
        exact = self.frames(*packages)
        before = 0
        for target in 40, 46:
            report = self.report(*packages, BY_USE, "--target-psnr", target, "--reencode", "--overwrite")
            predicted = report["frames"]["psnr_db"]
            self.assertAlmostEqual(predicted, target, delta=0.7)
            error = np.mean((self.frames(*packages, "--lightfield", self.store) - exact) ** 2)
            # Elements of these frames are smaller than LF pixels, whose interpolation makes errors smaller.
            self.assertAlmostEqual(10 * np.log10(255 ** 2 / error), predicted, delta=4)
            self.assertGreater(report["code_bytes"], before)
            before = report["code_bytes"]

    def test_every_kind_of_picture(self):
        for options in ["--format", "png16"], ["--bayer"], ["--format", "exr"]:
            folder = self.folder / options[-1].strip("-")
            self.succeeds(SYNTH, "still-life", "-o", folder, "--count", 25, "--size", "96x64", *options)
            path = self.folder / "still.yaml"
            path.write_text("{format: lfpath 1, fps: 25, frames: 2, resolution: [48, 32], camera: {focal_length_mm: 40,"
                            "position: [0, -0.125, -0.8], look_at: [0, -0.085, 0]}, lens: {aperture_diameter_mm: 9,"
                            "focus_distance: 0.8}}")
            packages = self.packages(field=folder, path=path, name=f"packages{options[-1]}")
            for more in [], ["--needed-pixels"], ["--target-psnr", 45], ["--shard-size", "20K"]:
                report = self.report(*packages, BY_USE, "--overwrite", "--verify", *more)
                self.assertEqual(report["verified"], report["lf_images"])
                self.assertGreater(report["frames"]["psnr_db"], 30)
                self.assertEqual(self.warning(*packages, "--lightfield", self.store), [])

    def test_files_that_are_kept_are_exact(self):
        for png in (self.folder / "field").glob("*.png"):
            Image.open(png).save(png.with_suffix(".jpg"), quality=50)
        self.field.write_text(self.field.read_text().replace(".png", ".jpg"))
        packages = self.packages()
        report = self.report(*packages, BY_USE, "--threshold", 0.2, "--verify")
        self.assertEqual(report["files_kept"], report["coded"])
        self.assertEqual(report["frames"]["psnr_db"], "exact")

    # Restarts

    def test_a_store_is_resumed_and_verified_with_the_same_options_only(self):
        packages = self.packages("--packages", 2)
        self.report(*packages, BY_USE)
        whole = self.blobs()
        image = self.folder / "field" / max(self.bytes_of_images())
        pixels = image.read_bytes()
        image.write_text("no picture")
        self.fails(3, [image.name], COMPRESSOR, *packages, "-o", self.store, BY_USE, "--strict", "--overwrite",
                   "--threads", 1)
        image.write_bytes(pixels)
        self.store.unlink()
        self.fails(2, ["codec", "--overwrite"], COMPRESSOR, *packages, "-o", self.store, "--resume")
        self.fails(2, ["was begun with", "--overwrite"], COMPRESSOR, packages[0], "-o", self.store, "--resume", BY_USE)
        report = self.report(*packages, "--resume", BY_USE, "--verify")
        self.assertGreater(report["resumed"], 0)
        self.assertNotIn("frames", report)
        self.assertEqual(self.blobs(), whole)
        self.fails(3, ["by use", "but the options ask for"], COMPRESSOR, *packages, "-o", self.store, "--verify")
        self.assertTrue(self.report(*packages, BY_USE, "--verify")["was_there"])

    def test_a_killed_call_is_resumed(self):
        packages = self.packages()
        self.report(*packages, BY_USE)
        whole = self.blobs()
        process = subprocess.Popen([COMPRESSOR, *packages, "-o", self.store, BY_USE, "--overwrite", "--threads", "1"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(0.05)
        process.kill()
        process.wait()
        if (self.folder / "a.lfs.unfinished").exists():
            self.report(*packages, BY_USE, "--resume")
        self.assertEqual(self.blobs(), whole)

    # Films

    def test_another_film_warns_and_the_same_film_does_not(self):
        packages = self.packages("--packages", 2)
        self.report(*packages, BY_USE)
        self.assertEqual(self.warning(*packages, "--lightfield", self.store), [])
        self.assertEqual(self.warning(packages[1], "--lightfield", self.store), [])
        self.assertEqual(self.warning(self.store, self.path), [])
        self.assertEqual(self.warning(self.store, self.path, "--frames", 2), [])
        half = self.folder / "half.yaml"
        half.write_text(self.path.read_text().replace("[80, 60]", "[40, 30]"))
        self.assertEqual(self.warning(self.store, half), [])
        other = self.folder / "other.yaml"
        other.write_text(self.path.read_text().replace("aperture_diameter: 0.03", "aperture_diameter: 0.02"))
        line, = self.warning(self.store, other)
        for word in "a.lfs", "package-0000.lfp", "lfcompressor --quality-by-use":
            self.assertIn(word, line)
        line, = self.warning(*self.packages("--packages", 2, path=other, name="others"), "--lightfield",
                             self.store)
        line, = self.warning(self.store, self.path, "--lens-weights", "none")
        self.assertIn("this film with lens weights", line)
        self.succeeds(COMPRESSOR, *packages, "-o", self.store, "--overwrite")
        self.assertEqual(self.warning(self.store, other), [])

    def test_several_films_and_films_without_lens_weights(self):
        other = self.folder / "other.yaml"
        other.write_text(self.path.read_text().replace("aperture_diameter: 0.03", "aperture_diameter: 0.025"))
        both = self.packages() + self.packages(path=other, name="others")
        self.report(*both, BY_USE)
        for path in self.path, other:
            self.assertEqual(self.warning(self.store, path), [])
        equal = self.packages("--lens-weights", "none", name="equal")
        self.report(*equal, BY_USE, "--overwrite")
        self.assertEqual(self.warning(*equal, "--lightfield", self.store, "--lens-weights", "none"), [])
        line, = self.warning(self.store, self.path, code=3)  # lens weights need LF images beside the lens
        self.assertIn("--lens-weights none", line)

    def test_import_tells_the_film(self):
        self.report(*self.packages(), BY_USE)
        self.assertRegex(self.succeeds(IMPORT, self.store),
                         r"encoded for +the film of .*package-0000.lfp: 4 frames, lens weights auto")
        facts = json.loads(self.succeeds(IMPORT, self.store, "--json"))["encoded_for"]
        self.assertEqual((facts["frames"], facts["lens_weights"]), (4, "auto"))

    def test_a_damaged_setting_is_an_error(self):
        self.report(*self.packages(), BY_USE)
        with sqlite3.connect(self.store) as database:
            database.execute("update settings set value = 'many' where key = 'film.frames'")
        self.fails(3, ["a.lfs", "film.frames"], RENDERER, self.store, self.path, "-o", self.folder / "out")

    def test_usage(self):
        packages = self.packages()
        self.fails(2, ["--quality-by-use", "packages"], COMPRESSOR, self.field, "-o", self.store, BY_USE)
        for profile in "lossless", "recorded", "thesis":
            self.fails(2, ["--quality-by-use", f"--profile {profile}"], COMPRESSOR, *packages, "-o", self.store, BY_USE,
                       "--profile", profile)
        rebinned = self.packages("--mode", "hybrid", name="hybrid")
        self.fails(2, ["--quality-by-use", "--mode hybrid"], COMPRESSOR, *rebinned, "-o", self.store, BY_USE)
        self.assertFalse(self.store.exists())


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, IMPORT, SYNTH = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1])
