#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests packed stores of groups from a user's view: sizes, films, kills, faults, copies, and the choice of a profile.

usage: group_stores_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFIMPORT LFSYNTH LFDENSIFY
"""
import hashlib
import json
import re
import signal
import sqlite3
import subprocess
import sys
import time
import unittest

import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase, wait_until

COMPRESSOR = RENDERER = PREPROCESSOR = IMPORT = SYNTH = DENSIFY = None

COUNT = 81
PATH = """format: lfpath 1
fps: 25
frames: 2
resolution: [120, 80]
camera:
  field_of_view_deg: 44
  focal_length_mm: 45
  position: [0, -0.12495, -0.799]
  look_at: [0, -0.0898, -0.0967]
  up: [0, -0.99875, 0.04994]
lens:
  aperture_diameter: 0.02
  focus_distance: 0.7
"""


class GroupStoresTest(ProgramTestCase):

    def setUp(self):
        super().setUp()
        self.store = self.folder / "a.lfs"
        self.path = self.folder / "path.yaml"
        self.path.write_text(PATH)

    def capture(self, *options, count=COUNT):
        """Photographs the still life, usually with 81 LF cameras."""
        field = self.folder / "field"
        self.succeeds(SYNTH, "still-life", "-o", field, "--count", count, "--size", "120x80", "--format", "png",
                      *options)
        return field

    def compress(self, *arguments, code=0):
        return json.loads(self.succeeds(COMPRESSOR, *arguments, "--json", code=code))

    def frames(self, name, *arguments, code=0):
        """Renders, and returns the hashes of the frames."""
        out = self.folder / name
        self.succeeds(RENDERER, *arguments, "-o", out, "--no-contact-sheet", code=code)
        return [hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(out.glob("frame_*.exr"))]

    def codes(self, store=None):
        with sqlite3.connect(store or self.store) as database:
            return (database.execute("select id, code, mask from blobs order by id").fetchall(),
                    database.execute("select id, reference_ids from predicted order by id").fetchall())

    def test_half_the_bytes_and_the_bits_of_the_files(self):
        field = self.capture()
        single = self.compress(field, "-o", self.folder / "single.lfs", "--reencode")
        group = self.compress(field, "-o", self.store, "--profile", "group", "--verify")
        self.assertLess(group["code_bytes"], 0.65 * single["code_bytes"])
        self.assertGreater(group["psnr_db"], single["psnr_db"] - 0.5)
        self.assertGreater(group["predicted"], 0.7 * COUNT)
        self.assertEqual(group["verified"], COUNT)
        self.assertIn("in groups", group["codec"])
        report = json.loads(self.succeeds(IMPORT, self.store, "--json"))
        self.assertEqual(report["predicted"], group["predicted"])
        exact = self.compress(field, "-o", self.folder / "exact.lfs", "--profile", "group-lossless", "--verify")
        self.assertEqual(exact["psnr_db"], "exact")
        self.assertGreater(exact["predicted"], 0.7 * COUNT)
        expected = self.frames("expected", field, self.path)
        self.assertEqual(len(expected), 2)
        self.assertEqual(self.frames("exact", self.folder / "exact.lfs", self.path), expected)
        self.assertEqual(self.frames("one", self.folder / "exact.lfs", self.path, "--threads", 1), expected)
        self.assertEqual(self.frames("groups", self.folder / "exact.lfs", self.path, "--order", "groups"),
                         expected)

    def test_a_kill_at_any_moment_costs_whole_groups_alone(self):
        field = self.capture()
        self.compress(field, "-o", self.store, "--profile", "group")
        whole = self.codes()
        self.store.unlink()
        words = [COMPRESSOR, field, "-o", self.store, "--profile", "group", "--threads", "2", "--resume"]
        kills = 0
        for delay in (0.25, 0.4, 0.6, 0.9):
            process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(delay)
            process.kill()
            kills += process.wait(timeout=240) == -signal.SIGKILL
        self.assertGreater(kills, 0)
        self.compress(field, "-o", self.store, "--profile", "group", "--resume", "--verify")
        self.assertEqual(self.codes(), whole)

    def test_an_interruption_states_what_is_stored(self):
        field = self.capture()
        words = [COMPRESSOR, field, "-o", self.store, "--profile", "group", "--threads", "1"]
        process = subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        while not self.store.with_name("a.lfs.unfinished").exists() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 5, errors)
        done = int(re.search(rf"interrupted after (\d+) of {COUNT} LF images", errors)[1])
        self.fails(2, ["codec"], *words, "--resume", "--entropy", "packed")
        report = self.compress(*words[1:], "--resume", "--verify")
        self.assertEqual((report["resumed"], report["verified"]), (done, COUNT))

    def test_a_broken_file_and_a_damaged_store_cost_few_images(self):
        field = self.capture()
        broken = sorted((field / "images").iterdir())[40]
        whole = broken.read_bytes()
        broken.write_bytes(whole[:50])
        report = self.compress(field, "-o", self.store, "--profile", "group", "--verify", code=6)
        self.assertEqual([image["name"] for image in report["skipped"]], [f"images/{broken.name}"])
        broken.write_bytes(whole)
        self.compress(field, "-o", self.store, "--profile", "group", "--overwrite")
        with sqlite3.connect(self.store) as database:
            # A reference image of many, but not of all.
            key = database.execute("select id from lf_images where id not in (select id from predicted)"
                                   " order by id").fetchone()[0]
            code, = database.execute("select code from blobs where id = ?", (key,)).fetchone()
            damaged = code[:200] + bytes([code[200] ^ 255]) + code[201:]
            database.execute("update blobs set code = ? where id = ?", (damaged, key))
        self.fails(6, ["were left out", "damaged", "a.lfs"], RENDERER, self.store, self.path, "-o",
                   self.folder / "out")
        skipped = json.loads((self.folder / "out/report.json").read_text())["skipped_lf_images"]
        self.assertGreater(len(skipped), 1)
        self.assertLess(len(skipped), COUNT // 2)

    def test_an_lf_image_that_is_mended_stands_beside_one_that_is_not_predicted(self):
        field = self.capture(count=16)  # one group
        images = sorted((field / "images").iterdir())
        broken = images[2].read_bytes()
        words = [field, "-o", self.store, "--profile", "group"]
        for noisy in images[10:13]:
            with self.subTest(noisy=noisy.name):
                kept = noisy.read_bytes()
                noise = np.random.default_rng(1).integers(0, 256, (80, 120, 3), np.uint8)
                Image.fromarray(noise).save(noisy)
                images[2].write_bytes(broken[:60])
                self.fails(3, [images[2].name], COMPRESSOR, *words, "--strict", "--overwrite")
                images[2].write_bytes(broken)
                report = self.compress(*words, "--resume", "--verify")
                self.assertEqual((report["resumed"], report["verified"]), (15, 16))
                noisy.write_bytes(kept)

    def test_a_store_is_densified_and_its_recorded_images_stay_predicted(self):
        field = self.capture("--overwrite", "--spacing", 0.02, count=16)
        self.compress(field, "-o", self.store, "--profile", "group")
        codes, predicted = self.codes()
        self.assertGreater(len(predicted), 8)
        words = [DENSIFY, self.store, "--most", 60, "--cache", "none", "--threads", 1]
        dense, again = self.folder / "dense.lfs", self.folder / "again.lfs"
        self.succeeds(*words, "-o", dense)
        self.assertEqual(self.codes(dense)[1], predicted)
        self.assertEqual(self.codes(dense)[0][:16], codes)
        self.assertGreater(len(self.codes(dense)[0]), 30)
        # Killed at several moments and resumed, it has the same bits.
        unfinished = again.with_name("again.lfs.unfinished")
        ends = []
        for stop in signal.SIGKILL, signal.SIGINT, signal.SIGKILL:
            process = subprocess.Popen([*map(str, words), "-o", str(again), "--resume"], stderr=subprocess.DEVNULL,
                                       stdout=subprocess.DEVNULL)
            size = unfinished.stat().st_size if unfinished.exists() else 0
            wait_until(lambda size=size: unfinished.exists() and unfinished.stat().st_size > size + 20000, process)
            process.send_signal(stop)
            ends.append(process.wait(timeout=240))
            self.assertIn(ends[-1], (5, -stop, 0))
        self.assertNotEqual(ends[0], 0)
        if not again.exists():
            self.succeeds(*words, "-o", again, "--resume")
        self.assertEqual(self.codes(again), self.codes(dense))
        # A film from a store without loss has the bits of one that is densified from the files.
        exact, of_files = self.folder / "exact.lfs", self.folder / "of_files.lfs"
        self.compress(field, "-o", exact, "--profile", "group-lossless")
        self.succeeds(DENSIFY, exact, "-o", dense, "--most", 60, "--cache", "none", "--overwrite")
        self.succeeds(DENSIFY, field, "-o", of_files, "--most", 60, "--cache", "none")
        self.assertGreater(len(self.codes(dense)[1]), 8)
        self.assertEqual(self.frames("dense film", dense, self.path), self.frames("film", of_files, self.path))

    def test_packages_and_copies(self):
        field = self.capture()
        self.compress(field, "-o", self.store, "--profile", "group-lossless")
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, field, self.path, "-o", packages, "--packages", 2)
        files = sorted(packages.glob("*.lfp"))
        expected = self.frames("expected", field, self.path)
        for name, words in (("made", [*files, "--profile", "group-lossless"]),
                            ("needed", [*files, "--profile", "group-lossless", "--needed-pixels"]),
                            ("copied", [*files, "--lightfield", self.store])):
            store = self.folder / f"{name}.lfs"
            self.compress(*words, "-o", store, "--verify")
            self.assertEqual(self.frames(f"film of {name}", store, self.path), expected)
            self.assertGreater(len(self.codes(store)[1]), 0)
        self.compress(self.store, "-o", self.folder / "shards.lfs", "--shard-size", "100K", "--verify")
        self.assertEqual(self.frames("film of shards", self.folder / "shards.lfs", self.path), expected)
        self.fails(2, ["predicted from others", "--by-resolution"], COMPRESSOR, self.store, "-o",
                   self.folder / "r.lfs", "--by-resolution")
        self.fails(2, ["--by-resolution", "--profile group"], COMPRESSOR, field, "-o", self.folder / "r.lfs",
                   "--by-resolution", "--profile", "group")

    def test_auto_takes_what_is_smallest(self):
        field = self.capture()
        report = self.compress(field, "-o", self.store, "--profile", "auto", "--verify")
        self.assertIn("in groups", report["codec"])
        self.assertLess(report["sample"]["bytes_in_groups"], report["sample"]["bytes_alone"])
        self.assertIn("chosen", self.succeeds(COMPRESSOR, field, "-o", self.store, "--profile", "auto",
                                              "--overwrite"))
        # Mosaics are predicted also.
        mosaic = self.folder / "mosaic"
        self.succeeds(SYNTH, "still-life", "-o", mosaic, "--count", COUNT, "--size", "120x80", "--bayer")
        single = self.compress(mosaic, "-o", self.folder / "single.lfs", "--reencode")
        report = self.compress(mosaic, "-o", self.folder / "m.lfs", "--profile", "auto")
        self.assertIn("in groups", report["codec"])
        self.assertLess(report["code_bytes"], 0.8 * single["code_bytes"])


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, IMPORT, SYNTH, DENSIFY = sys.argv[1:7]
    unittest.main(argv=sys.argv[:1] + sys.argv[7:])
