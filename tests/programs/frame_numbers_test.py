#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests films whose frames are numbered from 1001: names, options, messages and metadata have these numbers, and
everything else is the film that is numbered from 1.

usage: frame_numbers_test.py LFRENDERER LFPREPROCESSOR LFMERGE LFSUBMIT LFPATH LFCAMMVMINFO LFFOCUS LFQUILT LFSYNTH
"""
import json
import os
import signal
import subprocess
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

import small_field
from exr_file import read_header
from program_test_case import ProgramTestCase, wait_until

RENDERER = PREPROCESSOR = MERGE = SUBMIT = PATH = INFO = FOCUS = QUILT = SYNTH = None
FRAMES = 6
FIRST = 1001


def pixels(file):
    return cv2.imread(str(file), cv2.IMREAD_UNCHANGED).tobytes()


class FrameNumbersTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field = small_field.write_field(self.folder / "field")
        self.one = small_field.write_path(self.folder, FRAMES)
        self.plate = self.folder / "plate.yaml"
        self.plate.write_text(self.one.read_text().replace("fps: 25", f"fps: 25\nfirst_frame: {FIRST}"))

    def render(self, path, out, *options, code=0):
        self.succeeds(RENDERER, *path if isinstance(path, list) else (self.field, path), "-o", self.folder / out,
                      "--no-contact-sheet", "-q", *options, code=code)
        return self.folder / out

    def is_the_film(self, out, numbers=range(FIRST, FIRST + FRAMES), options=()):
        """Checks that a folder has these frames of the film, and no others."""
        names = [f"frame_{number:04d}.exr" for number in numbers]
        self.assertEqual(sorted(file.name for file in out.glob("frame_*")), names)
        reference = self.folder / "-".join(["reference", *map(str, options)])
        if not reference.exists():
            self.render(self.one, reference, *options)
        for number, name in zip(numbers, names):
            same = pixels(reference / f"frame_{number - FIRST + 1:04d}.exr")
            self.assertEqual(pixels(out / name), same, name)
            self.assertEqual(read_header((out / name).read_bytes())[0]["imageCounter"], ("int", number))

    def test_names_options_and_reports_have_the_numbers_of_the_path(self):
        self.is_the_film(self.render(self.plate, "all"))
        some = self.render(self.plate, "some", "--frames", "1002-1004x2")
        self.is_the_film(some, (1002, 1004))
        report = json.loads((some / "report.json").read_text())
        self.assertEqual([frame["frame"] for frame in report["frames"]], [1002, 1004])
        self.fails(2, ["--frames '1-3': expected frames from 1001 to 1006"], RENDERER, self.field, self.plate,
                   "-o", self.folder / "none", "--frames", "1-3")
        self.is_the_film(self.render(self.plate, "end", "--frames", "1005-1010", "--clamp-frames"), (1005, 1006))

    def test_a_film_of_one_number_is_not_taken_for_that_of_another(self):
        out = self.render(self.one, "out")
        self.fails(2, ["frame_0001.exr"], RENDERER, self.field, self.plate, "-o", out)
        self.fails(2, ["belongs to frame 1, but the camera path has the frames 1001 to 1006"], RENDERER, self.field,
                   self.plate, "-o", out, "--resume")

    def test_packages_shards_and_jobs(self):
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, self.plate, "-o", packages, "--packages", 2, "-q")
        self.is_the_film(self.render(sorted(packages.glob("*.lfp")), "of-packages"))
        # A film with other numbers is another film, although its cameras are equal.
        self.succeeds(PREPROCESSOR, self.field, self.one, "-o", self.folder / "one", "--packages", 2, "-q")
        mixed = [sorted(packages.glob("*.lfp"))[0], sorted((self.folder / "one").glob("*.lfp"))[1]]
        self.fails(3, ["was made for another camera path"], RENDERER, *mixed, "-o", self.folder / "mixed")
        part = self.folder / "part"
        self.succeeds(PREPROCESSOR, self.field, self.plate, "-o", part, "--frames", "1003-1004", "-q")
        self.assertEqual([file.name for file in part.glob("*.lfp")], ["package-0000-of-frames-1003-1004.lfp"])
        self.is_the_film(self.render(sorted(part.glob("*.lfp")), "of-part"), (1003, 1004))
        for shard in (1, 2):
            self.render(self.plate, "shards", "--shard", f"{shard}/2")
        self.succeeds(MERGE, self.folder / "shards/partial/shards", "-o", self.folder / "merged",
                      "--no-contact-sheet", "-q")
        self.is_the_film(self.folder / "merged")
        job = self.folder / "job"
        self.succeeds(SUBMIT, *sorted(packages.glob("*.lfp")), "-o", job, "-q")
        self.is_the_film(job)
        state = json.loads((job / "cluster/job.json").read_text())
        self.assertEqual([package["frames"] for package in state["packages"]], ["1001-1003", "1004-1006"])

    def test_rebinned_rays(self):
        for mode in ("rebin", "hybrid"):
            options = ("--mode", mode, "--max-rays", 100000)
            self.is_the_film(self.render(self.plate, mode, *options), options=options)
            packages = self.folder / f"packages-{mode}"
            self.succeeds(PREPROCESSOR, self.field, self.plate, "-o", packages, "--packages", 2, "-q",
                          "--mode", mode)
            self.is_the_film(self.render(sorted(packages.glob("*.lfp")), f"packed-{mode}", *options),
                             options=options)

    def test_a_killed_film_continues(self):
        out = self.folder / "killed"
        words = [RENDERER, self.field, self.plate, "-o", out, "-q", "--no-contact-sheet", "--dump-every", "0.001s"]
        with subprocess.Popen(list(map(str, words)), stderr=subprocess.DEVNULL) as process:
            wait_until(lambda: list(out.glob("partial/frame_10*.plate")), process)
            process.send_signal(signal.SIGKILL)
        self.succeeds(*words, "--resume", "--finish", "1001-1002")
        self.assertEqual(len(list(out.glob("frame_10*.exr"))), FRAMES)

    def test_paths_keep_and_change_the_number(self):
        cameras = json.loads(self.succeeds(INFO, self.plate, "--json"))
        self.assertEqual(cameras["first_frame"], FIRST)
        self.assertEqual([camera["frame"] for camera in cameras["cameras"]], list(range(FIRST, FIRST + FRAMES)))
        self.assertEqual([camera["time_s"] for camera in cameras["cameras"]], [i / 25 for i in range(FRAMES)])
        self.assertIn("1003", self.succeeds(INFO, self.plate, "--frame", 1003))
        self.fails(2, ["--frame 3: ", "expected 1001 to 1006"], INFO, self.plate, "--frame", 3)
        for options, first, count in (([], 1001, FRAMES), (["--first-frame", 0], 0, FRAMES), (["--fps", 50], 1001, 11),
                                      (["--stereo-mm", 10, "--first-frame", 86], 86, 2 * FRAMES)):
            with self.subTest(options=options):
                moved = self.folder / "moved.yaml"
                self.succeeds(PATH, self.plate, "-o", moved, "--overwrite", "-q", *options)
                read = json.loads(self.succeeds(INFO, moved, "--json"))
                self.assertEqual((read["first_frame"], read["frames"]), (first, count))
        self.fails(2, ["above 99999999"], PATH, self.plate, "-o", self.folder / "far.yaml",
                   "--first-frame", 99999999)

    def test_depth_pictures_belong_to_numbers(self):
        for number in range(FIRST, FIRST + 2):
            (self.folder / f"depth_{number}.pfm").write_bytes(b"Pf\n80 60\n-1\n" + np.full(4800, 0.8, "<f4").tobytes())
        surface = self.folder / "surface.yaml"
        surface.write_text(self.plate.read_text() + "focus: {surface: depth_%04d.pfm, kind: depth}\n")
        self.render(surface, "focused", "--frames", "1001-1002")
        self.fails(3, ["--first-frame 1: the focal surface depth_%04d.pfm has a file for the number of each frame"],
                   PATH, surface, "-o", self.folder / "one.yaml", "--first-frame", 1)

    def test_one_frame_of_a_path_is_the_first_unless_it_is_named(self):
        seen = self.folder / "seen.exr"
        for options, number in (([], 1001), (["--frame", 1003], 1003)):
            report = json.loads(self.succeeds(FOCUS, "through", self.field, self.plate, "-o", seen, "--json",
                                              "--overwrite", *options))
            self.assertEqual(report["frame"], number)
        self.fails(2, ["--frame 1: ", "give a number from 1001 to 1006"], FOCUS, "through", self.field, self.plate,
                   "-o", seen, "--overwrite", "--frame", 1)

    def test_pictures_of_views_have_the_numbers_of_moments(self):
        stereo = self.folder / "stereo.yaml"
        self.succeeds(PATH, self.plate, "-o", stereo, "--stereo-mm", 10, "-q")
        for kind in ("exr", "png"):
            frames = self.render(stereo, f"eyes-{kind}", "--format", kind, "--frames", "1003-1006")
            self.succeeds(QUILT, frames, "-o", self.folder / f"pair.{kind}", "--layout", "side-by-side", "-q")
            self.assertEqual(sorted(file.name for file in self.folder.glob(f"pair_*.{kind}")),
                             [f"pair_1002.{kind}", f"pair_1003.{kind}"])

    def test_ground_truth_has_the_numbers(self):
        self.succeeds(SYNTH, "chart", "-o", self.folder / "chart", "--calibration-only", "--truth", self.plate,
                      "--truth-samples", 1, "-q")
        self.assertEqual(sorted(file.name for file in (self.folder / "chart/truth").iterdir()),
                         [f"frame_{number}.exr" for number in range(FIRST, FIRST + FRAMES)])


if __name__ == "__main__":
    RENDERER, PREPROCESSOR, MERGE, SUBMIT, PATH, INFO, FOCUS, QUILT, SYNTH = sys.argv[1:10]
    unittest.main(argv=sys.argv[:1])
