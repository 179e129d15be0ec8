#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every program in a folder whose name is not text (not UTF-8), since file names may have any bytes. The JSON
that a program prints is text nevertheless. A file that is read again either keeps the bytes of the names, or is refused
before the work begins.

usage: no_text_names_test.py FOLDER_OF_THE_PROGRAMS
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

from common_options import OFFERED
from program_test_case import ProgramTestCase
from tiny_calls import TinyCalls

BIN = None
NO_TEXT = os.fsdecode(b"a\xff\xfeb")


class NoTextNamesTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.place = self.folder / NO_TEXT
        self.place.mkdir()
        self.calls = TinyCalls(BIN, self.place / "base", self.place / "out")
        self.calls.prepare()

    def run_in_bytes(self, words, code=0):
        """Calls a program, and returns what it printed, which may be no text."""
        done = subprocess.run([os.fsencode(word) for word in words], capture_output=True, timeout=400, cwd=self.place)
        self.assertEqual(done.returncode, code, (words, done.stderr[-2000:]))
        return done

    def empty_out(self):
        for path in self.place.iterdir():
            if path != self.calls.base:
                shutil.rmtree(path) if path.is_dir() else path.unlink()

    def printed_json(self, words):
        done = self.run_in_bytes([*words, "--json"])
        return json.loads(done.stdout.decode("utf-8"))

    def test_json_is_text(self):
        """Each program that prints JSON; a new one cannot be left out."""
        left = {name for name, options in OFFERED.items() if "--json" in options}
        calls = {call.name: call.command for call in self.calls.writers() + self.calls.submitters()[:1]}
        calls["lfcammvminfo"] = [BIN / "lfcammvminfo", str(self.calls.path)]
        calls["lffocus sharp"] = self.calls.words("lffocus", "sharp", self.calls.field, self.calls.path, "--planes", 3,
                                                  "--near", 2, "--far", 4, "--confidence", 0, "-o",
                                                  self.calls.out.with_suffix(".exr"))
        for name, words in calls.items():
            name = name.split(",")[0]
            if name not in OFFERED or "--json" not in OFFERED[name]:
                continue
            with self.subTest(program=name):
                self.empty_out()
                self.printed_json(words)
                left.discard(name)
        self.assertEqual(left, set())

    def test_json_names_files_that_are_no_text(self):
        """Names that are told to people have U+FFFD in place of the bytes."""
        path = self.place / f"{NO_TEXT}.exr"
        words = self.calls.words("lffocus", "through", self.calls.field, self.calls.path, "-o", path)
        report = self.printed_json(words)
        self.assertTrue(path.exists())
        self.assertIn("a\ufffd\ufffdb.exr", json.dumps(report, ensure_ascii=False))

    def test_a_job_is_resumed(self):
        film = self.place / f"{NO_TEXT} film"
        packages = sorted(self.calls.packages.glob("*.lfp"))
        video = [] if shutil.which("ffmpeg") is None else ["--video", self.place / f"{NO_TEXT}.mp4"]
        self.run_in_bytes([BIN / "lfsubmit", *packages, "-o", film, "--progress", "none", *video])
        frames = {frame.name: frame.read_bytes() for frame in film.glob("frame_*")}
        self.assertEqual(len(frames), 2)
        job = json.loads((film / "cluster/job.json").read_bytes().decode("utf-8"))
        self.assertEqual(bytes.fromhex(job["packages"][0]["file"]["bytes"]), os.fsencode(packages[0]))
        for path in [*film.glob("frame_*"), *self.place.glob("*.mp4")]:
            path.unlink()
        self.run_in_bytes([BIN / "lfsubmit", "--resume", film, "--progress", "none"])
        self.assertEqual({frame.name: frame.read_bytes() for frame in film.glob("frame_*")}, frames)
        self.assertEqual(len(list(self.place.glob("*.mp4"))), len(video) // 2)
        for task in "--run-package", "--run-finish":
            self.run_in_bytes([BIN / "lfsubmit", task, *(["0"] if task == "--run-package" else []), film])
        json.loads(self.run_in_bytes([BIN / "lfsubmit", "--status", film, "--json"]).stdout.decode("utf-8"))

    def test_scripts_keep_the_bytes_and_templates_are_refused_before_the_work(self):
        packages = sorted(self.calls.packages.glob("*.lfp"))
        film = self.place / "film"
        done = self.run_in_bytes([BIN / "lfsubmit", *packages, "-o", film, "--engine", "openjd"], code=2)
        self.assertIn(b"is not UTF-8", done.stderr.splitlines()[-1])
        self.assertFalse(film.exists())
        self.run_in_bytes([BIN / "lfsubmit", *packages, "-o", film, "--engine", "array"])
        for number in range(len(packages)):
            self.run_in_bytes(["bash", film / "cluster/array/packages.sh", str(number)])
        self.run_in_bytes(["bash", film / "cluster/array/finish.sh"])
        self.assertEqual(len(list(film.glob("frame_*"))), 2)
        # A template of a folder that is text does not name the packages.
        self.run_in_bytes([BIN / "lfsubmit", *packages, "-o", self.folder / "film", "--engine", "openjd"])
        (self.folder / "film/cluster/openjd/template.yaml").read_text("utf-8")

    def test_images_of_such_names_are_refused_before_the_work(self):
        """A transforms.json is text, and cannot name them."""
        images = self.place / "images"
        images.mkdir()
        for number, image in enumerate(sorted(self.calls.field.rglob("*.png"))):
            shutil.copy(image, images / os.fsdecode(b"\xff_00_0%d_0.0_%d.0_10_10.png" % (number, number)))
        done = self.run_in_bytes([BIN / "lfimport", images, "-o", self.place / "imported"], code=2)
        self.assertIn(b"is not UTF-8", done.stderr.splitlines()[-1])
        self.assertFalse((self.place / "imported").exists())


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv[1])
    unittest.main(argv=sys.argv[:1], verbosity=2)
