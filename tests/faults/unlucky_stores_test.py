#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests accidents around packed stores, which must be reported before they cost work: occupied names, captures that
changed, signals, partial copies, edited calibrations.

usage: unlucky_stores_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR
"""
import contextlib
import json
import os
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
import unittest

import numpy as np

import lfcompressor_test
from lfcompressor_test import StoreTest, smooth
from small_field import HEIGHT, WIDTH, write_field, write_path


def noisy(index):
    return np.random.default_rng(index).integers(0, 256, (HEIGHT, WIDTH, 3)).astype(np.uint8)


class UnluckyStoresTest(StoreTest):
    def setUp(self):
        super().setUp()
        self.compressor, self.renderer, self.preprocessor = lfcompressor_test.PROGRAMS
        self.field = write_field(self.folder / "field", smooth)

    def has_written(self):
        """Returns True if the unfinished store has LF images. Reads it without locks, which would disturb its
        writer."""
        unfinished = self.folder / "a.lfs.unfinished"
        if not unfinished.exists():
            return False
        with contextlib.closing(sqlite3.connect(f"file:{unfinished}?immutable=1", uri=True)) as database:
            try:
                return database.execute("select count(*) from codes").fetchone()[0] > 0
            except sqlite3.Error:
                return False

    def interrupt(self, *arguments, how=signal.SIGINT):
        """Interrupts a call as soon as it has written something. Returns its exit status and its output."""
        process = subprocess.Popen([self.compressor, *map(str, arguments), "--threads", "1"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while not self.has_written() and process.poll() is None:
            time.sleep(0.005)
        process.send_signal(how)
        _, errors = process.communicate(timeout=240)
        return process.returncode, errors

    # Occupied names

    def test_nothing_but_a_store_is_replaced(self):
        self.store.write_text("precious")
        for more in ([], ["--overwrite"], ["--resume"], ["--verify"]):
            self.fails(2, ["a.lfs", "is not a packed store"], self.compressor, self.field, "-o", self.store, *more)
        self.assertEqual(self.store.read_text(), "precious")
        (self.folder / "folder.lfs").mkdir()
        self.fails(2, ["folder.lfs", "is not a packed store"], self.compressor, self.field, "-o",
                   self.folder / "folder.lfs", "--overwrite")
        shard = self.folder / "b-0001.lfs"
        shard.write_text("precious")
        self.fails(2, ["b-0001.lfs", "would replace this file"], self.compressor, self.field, "-o",
                   self.folder / "b.lfs", "--shard-size", "8k")
        self.assertEqual(shard.read_text(), "precious")
        self.assertEqual(list(self.folder.glob("*.unfinished*")), [])

    def test_a_lock_is_no_link(self):
        note = self.folder / "note"
        note.write_text("precious")
        (self.folder / "a.lfs.lock").symlink_to(note)
        self.fails(4, ["a.lfs.lock"], self.compressor, self.field, "-o", self.store)
        self.assertEqual(note.read_text(), "precious")

    def test_two_at_once(self):
        process = subprocess.Popen([self.compressor, self.field, "-o", self.store, "--threads", "1",
                                    "--target-psnr", "45"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "a.lfs.lock").exists() and process.poll() is None:
            time.sleep(0.002)
        other = self.call(self.compressor, self.field, "-o", self.store)
        if process.poll() is None:
            self.assertEqual(other.returncode, 4, other.stderr)
            self.assertIn("locked", other.stderr)
        self.assertEqual(process.wait(60), 0)
        self.assertEqual(self.report(self.field, "-o", self.store, "--target-psnr", "45", "--verify")["verified"], 25)

    # Captures that changed

    def test_it_does_not_go_on_with_another_capture(self):
        field = self.many()
        self.assertEqual(self.interrupt(field, "-o", self.store, how=signal.SIGTERM)[0], 5)
        shutil.rmtree(self.folder / "field")
        other = self.many(noisy)
        self.fails(3, ["link_", "restore the file", "--overwrite"], self.compressor, other, "-o", self.store,
                   "--resume")

    def test_complete_is_what_was_asked_for(self):
        self.compress(self.field, "-o", self.store, "--shard-size", "20k")
        again = self.report(self.field, "-o", self.store, "--shard-size", "20k", "--resume")
        self.assertTrue(again["was_there"])
        self.assertNotIn("ratio", again)
        self.fails(3, ["a.lfs: this packed store was made with a --shard-size, in bytes, of"], self.compressor,
                   self.field, "-o", self.store, "--resume")
        (self.folder / "a-0002.lfs").unlink()
        for more in (["--resume"], ["--verify"]):
            self.fails(3, ["a-0002.lfs: no such file"], self.compressor, self.field, "-o", self.store,
                       "--shard-size", "20k", *more)
        self.fails(3, ["a-0002.lfs: no such file"], self.renderer, self.store, write_path(self.folder), "-o",
                   self.folder / "out")

    def test_verify_compares_the_calibration(self):
        self.compress(self.field, "-o", self.store)
        text = json.loads(self.field.read_text())
        self.field.write_text(json.dumps(text | {"lf_white_level": 200}))
        self.fails(3, ["white level", "but now it is 200"], self.compressor, self.field, "-o", self.store, "--verify")
        self.field.write_text(json.dumps(text))
        self.compress(self.field, "-o", self.store, "--verify")
        for command in ("update intrinsics set fx = fx + 1", "update lf_images set name = 'b' where id = 3",
                        "update lf_images set gain = 3 where id = 3"):
            damaged = self.folder / "b.lfs"
            shutil.copy(self.store, damaged)
            with sqlite3.connect(damaged) as database:
                database.execute(command)
            self.fails(3, ["b.lfs", "damaged"], self.renderer, damaged, write_path(self.folder), "-o",
                       self.folder / "out")

    # Signals

    def test_an_overwrite_goes_on_too(self):
        field = self.many()
        self.compress(field, "-o", self.store, "--threshold", "20")
        before = self.store.stat().st_size
        status, errors = self.interrupt(field, "-o", self.store, "--overwrite", how=signal.SIGHUP)
        self.assertEqual(status, 5, errors)
        self.assertEqual(self.store.stat().st_size, before)
        self.assertEqual(self.report(field, "-o", self.store, "--threshold", "20", "--verify")["verified"], 3000)
        report = self.report(field, "-o", self.store, "--resume", "--verify")
        self.assertGreater(report["resumed"], 0)
        self.assertEqual(report["verified"], 3000)
        self.assertGreater(self.store.stat().st_size, before)

    # Names and lists

    def test_names_in_any_bytes(self):
        store = os.fsencode(self.folder) + b"/n\xff.lfs"
        result = subprocess.run([self.compressor, self.field, b"-o", store, "--json"], capture_output=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["coded"], 25)

    def test_skipped_images_are_warned_of(self):
        (self.folder / "field/image_03.png").write_text("no picture")
        result = self.call(self.compressor, self.field, "-o", self.store, "--allow-missing", 1)
        self.assertEqual(result.returncode, 0)
        self.assertIn("24 LF images of 25", result.stdout)
        self.assertIn("1 of 25 LF images are not in the store", result.stderr)
        self.assertIn("image_03.png", result.stderr)
        for image in (self.folder / "field").glob("*.png"):
            image.write_text("no picture")
        self.fails(3, ["none of the 25"], self.compressor, self.field, "-o", self.folder / "b.lfs")
        self.assertEqual(list(self.folder.glob("b*")), [])


if __name__ == "__main__":
    lfcompressor_test.PROGRAMS = [pathlib.Path(word) for word in sys.argv[1:4]]
    lfcompressor_test.COMPRESSOR = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
