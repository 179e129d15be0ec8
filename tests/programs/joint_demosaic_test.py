#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfcompressor --demosaic joint from a user's view: frames of its stores against those of RGB light fields,
resumed stores, broken LF images, and what is refused.

usage: joint_demosaic_test.py LFCOMPRESSOR LFRENDERER LFSYNTH LFPREPROCESSOR
"""
import json
import signal
import subprocess
import sys
import unittest

import cv2
import numpy as np

from exr_file import channels_of
from program_test_case import ProgramTestCase, wait_until

COMPRESSOR = RENDERER = SYNTH = PREPROCESSOR = None

PATH = """format: lfpath 1
fps: 25
frames: 1
resolution: [128, 84]
camera:
  field_of_view_deg: 38
  focal_length_mm: 50
  position: {position}
  look_at: {look_at}
  up: {up}
lens:
  aperture_diameter: 0.012
  focus_distance: 0.8
"""


class JointDemosaicTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "path.yaml"  # from the middle of the LF cameras

    def synth(self, name, *options):
        self.succeeds(SYNTH, "still-life", "-o", self.folder / name, "--count", 25, "--size", "160x106", "--spacing",
                      0.003, "--jitter", 0.4, "-q", *options)
        poses = np.array([frame["transform_matrix"] for frame in
                          json.loads((self.folder / name / "transforms.json").read_text())["frames"]]).mean(0)
        position = poses[:3, 3]
        self.path.write_text(PATH.format(position=list(map(float, position)), up=list(map(float, poses[:3, 1])),
                                         look_at=list(map(float, position - poses[:3, 2]))))
        return self.folder / name

    def compress(self, source, store, *options, code=0):
        return json.loads(self.succeeds(COMPRESSOR, source, "-o", self.folder / store, "--demosaic", "joint",
                                        "--profile", "lossless", "--json", *options, code=code))

    def frame(self, field):
        out = self.folder / f"frames-{field.name}"
        self.succeeds(RENDERER, field, self.path, "-o", out, "--format", "exr-float", "-q", "--no-contact-sheet")
        channels = channels_of(out / "frame_0001.exr")
        return np.stack([channels[name] for name in "RGB"], -1).astype(float)

    def db(self, one, other):
        return -10 * np.log10(np.mean((np.clip(one, 0, 1) - np.clip(other, 0, 1)) ** 2))

    def test_frames_are_nearer_to_those_of_rgb(self):
        mosaics = self.synth("mosaics", "--bayer")
        facts = self.compress(mosaics, "rgb.lfs", "--verify")
        rgb = self.frame(self.synth("truth"))
        single, joint = self.db(self.frame(mosaics), rgb), self.db(self.frame(self.folder / "rgb.lfs"), rgb)
        self.assertGreater(joint, single + 4, (single, joint))
        self.assertEqual(facts["verified"], 25)
        test = facts["demosaic"]
        self.assertGreater(test["kept_db"], test["single_db"] + 3)
        self.assertGreater(test["joint_share"], 0.5)
        # A packed store of mosaics is decoded, and gives the same pixels.
        self.succeeds(COMPRESSOR, mosaics, "-o", self.folder / "mosaics.lfs", "--profile", "lossless", "-q")
        self.compress(self.folder / "mosaics.lfs", "again.lfs")
        np.testing.assert_array_equal(self.frame(self.folder / "again.lfs"), self.frame(self.folder / "rgb.lfs"))

    def test_the_same_store_whatever_the_threads_and_interruptions(self):
        mosaics = self.synth("mosaics", "--bayer")
        self.compress(mosaics, "one.lfs", "--threads", 1)
        self.compress(mosaics, "four.lfs", "--threads", 4)
        one = self.frame(self.folder / "one.lfs")
        np.testing.assert_array_equal(self.frame(self.folder / "four.lfs"), one)
        killed = self.folder / "killed.lfs"
        call = [COMPRESSOR, mosaics, "-o", killed, "--demosaic", "joint", "--profile", "lossless", "--threads", "1",
                "--progress", "plain"]
        process = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_until((self.folder / "killed.lfs.unfinished").exists, process)
        process.send_signal(signal.SIGINT)
        process.wait()
        if process.returncode != 0:  # a fast machine has finished
            self.assertEqual(process.returncode, 5)
            # Mosaics cannot be added to a store of RGB.
            self.fails(2, ["codec"], COMPRESSOR, mosaics, "-o", killed, "--resume", "--profile", "lossless")
        self.compress(mosaics, "killed.lfs", "--resume")
        np.testing.assert_array_equal(self.frame(killed), one)

    def test_a_broken_lf_image_is_left_out_and_named(self):
        mosaics = self.synth("mosaics", "--bayer")
        broken = sorted((mosaics / "images").iterdir())[7]
        broken.write_bytes(b"broken")
        facts = self.compress(mosaics, "rgb.lfs", code=6)
        self.assertEqual(facts["coded"], 24)
        self.assertEqual([skipped["name"] for skipped in facts["skipped"]], [f"images/{broken.name}"])

    def test_exposures_that_differ_give_the_same_light(self):
        mosaics = self.synth("mosaics", "--bayer")
        self.compress(mosaics, "even.lfs")
        calibration = json.loads((mosaics / "transforms.json").read_text())
        black = calibration["lf_black_level"]
        for index, frame in enumerate(calibration["frames"]):
            if index % 2 == 0:
                continue
            path = str(mosaics / frame["file_path"])
            stored = cv2.imread(path, cv2.IMREAD_UNCHANGED).astype(float)
            cv2.imwrite(path, np.clip((stored - black) / 2 + black + 0.5, 0, 65535).astype(np.uint16))
            frame["lf_gain"] = 2
        (mosaics / "transforms.json").write_text(json.dumps(calibration))
        self.compress(mosaics, "uneven.lfs")
        self.assertGreater(self.db(self.frame(self.folder / "uneven.lfs"), self.frame(self.folder / "even.lfs")), 50)

    def test_usage(self):
        rgb = self.synth("rgb", "--format", "png")
        self.fails(2, ["has RGB or grey LF images", "needs mosaics"], COMPRESSOR, rgb, "-o", self.folder / "a.lfs",
                   "--demosaic", "joint")
        mosaics = self.synth("mosaics", "--bayer")
        for profile in ("auto", "recorded"):
            self.fails(2, [profile, "leave one of them out"], COMPRESSOR, mosaics, "-o", self.folder / "a.lfs",
                       "--demosaic", "joint", "--profile", profile)
        self.succeeds(PREPROCESSOR, mosaics, self.path, "-o", self.folder / "packages", "--packages", 1, "-q")
        self.fails(2, ["packages of that store"], COMPRESSOR, *(self.folder / "packages").glob("*.lfp"), "-o",
                   self.folder / "a.lfs", "--demosaic", "joint")
        self.assertFalse((self.folder / "a.lfs").exists())


if __name__ == "__main__":
    COMPRESSOR, RENDERER, SYNTH, PREPROCESSOR = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1], verbosity=2)
