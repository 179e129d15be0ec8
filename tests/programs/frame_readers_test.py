#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the programs which people open EXR frames with show their picture: Blender (image, sequencer and
compositor), ffmpeg, OpenCV, OpenImageIO and OpenEXR's own. The table of doc/formats/frame.md tells what each shows.

Frames of earlier builds, whose counts have other names, are read by our programs.

usage: frame_readers_test.py LFSYNTH LFRENDERER LFCOMPARE LFQUILT [TEST...]
The test of Blender is skipped if there is no blender.
"""
import json
import os
import shutil
import subprocess
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

import blender_run
from exr_file import channels_of
from program_test_case import ProgramTestCase

SYNTH = RENDERER = COMPARE = QUILT = None
WIDTH, HEIGHT = 64, 48
PATH = f"""format: lfpath 1
fps: 25
frames: 1
resolution: [{WIDTH}, {HEIGHT}]
camera: {{field_of_view_deg: 40, position: [0, 0, -1.05], look_at: [0, 0, 0], up: [0, -1, 0]}}
lens: {{aperture_diameter: 0.05, focus_distance: 1.05}}
"""
# Options of frames, whose channels differ.
KINDS = {
    "default": [],
    "float": ["--format", "exr-float"],
    "everything": ["--frame-alpha", "--z", "--colour-space", "acescg"],
    "rgba": ["--channels", "rgba", "--exr-compression", "zips"],
    "rgb": ["--channels", "rgb", "--exr-compression", "zips", "--format", "exr-float"],
}
FACTS = {"count_red", "count_green", "count_blue", "coverage", "effective"}


class ReadersTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        shared = ProgramTestCase()
        shared.setUp()
        cls.addClassCleanup(shared.doCleanups)
        (shared.folder / "path.yaml").write_text(PATH)
        shared.succeeds(SYNTH, "still-life", "-o", shared.folder / "field", "--count", 25, "--size", "96x72",
                        "--samples", 1, "--format", "exr")
        cls.frames, cls.light = {}, {}
        for name, options in KINDS.items():
            shared.succeeds(RENDERER, shared.folder / "field", shared.folder / "path.yaml", "-o", shared.folder / name,
                            "--no-contact-sheet", "-q", *options)
            cls.frames[name] = shared.folder / name / "frame_0001.exr"
            channels = channels_of(cls.frames[name])
            cls.light[name] = np.dstack([channels[channel] for channel in "RGB"]).astype(np.float32)

    def assert_shows(self, name, seen, tolerance=0.0, least=-np.inf):
        """Compares what was seen with the light of a frame, where this is not below `least`."""
        expected = self.light[name]
        self.assertGreater(expected.max() - expected.min(), 0.2)
        self.assertEqual(seen.shape[:2], (HEIGHT, WIDTH))
        seen, expected = seen[..., :3][expected >= least], expected[expected >= least]
        self.assertGreater(expected.size, 0.99 * 3 * WIDTH * HEIGHT)
        np.testing.assert_allclose(seen, expected, rtol=tolerance, atol=tolerance, err_msg=name)

    def test_opencv(self):
        for name, frame in self.frames.items():
            seen = cv2.imread(str(frame), cv2.IMREAD_UNCHANGED)
            self.assert_shows(name, seen[..., 2::-1])
            has_alpha = name in ("everything", "rgba")
            self.assertEqual(seen.shape[2], 4 if has_alpha else 3)
            if has_alpha:
                np.testing.assert_array_equal(seen[..., 3], channels_of(frame)["A"])

    def test_ffmpeg(self):
        for name, frame in self.frames.items():
            # Its own format of such files, which needs no conversion.
            pixels, planes = ("gbrapf32le", 4) if "A" in channels_of(frame) else ("gbrpf32le", 3)
            words = ["ffmpeg", "-v", "error", "-i", frame, "-f", "rawvideo", "-pix_fmt", pixels, "-"]
            seen = subprocess.run(words, capture_output=True, check=True).stdout
            green, blue, red = np.frombuffer(seen, "<f4").reshape(planes, HEIGHT, WIDTH)[:3]
            self.assert_shows(name, np.dstack([red, green, blue]))

    def test_openimageio(self):
        for name, frame in self.frames.items():
            listed = self.succeeds("oiiotool", "--info", "-v", frame).split("channel list: ")[1].splitlines()[0]
            self.assertEqual({words.split(" ")[0] for words in listed.split(", ")}, set(channels_of(frame)))
            self.succeeds("oiiotool", frame, "--ch", "R,G,B", "-d", "float", "-o", self.folder / "seen.exr")
            seen = channels_of(self.folder / "seen.exr")
            self.assert_shows(name, np.dstack([seen[channel] for channel in "RGB"]))

    def test_the_programs_of_openexr(self):
        for name, frame in self.frames.items():
            said = self.succeeds("exrheader", frame)
            for channel in channels_of(frame):
                self.assertIn(f"    {channel}, ", said)
            self.assertIn("zip, individual scanlines" if name in ("rgba", "rgb") else "zip, multi-scanline", said)
        self.assertEqual(set(channels_of(self.frames["default"])), {*"RGB", *FACTS})
        self.assertEqual(set(channels_of(self.frames["everything"])), {*"RGBAZ", *FACTS})

    def test_our_programs_read_frames_of_earlier_builds(self):
        for name in ("default", "everything"):
            new, old = self.frames[name], self.folder / f"{name}.exr"
            names = [*channels_of(new)]
            former = {"count_red": "count.R", "count_green": "count.G", "count_blue": "count.B"}
            self.succeeds("oiiotool", new, "--ch", ",".join(names), "--chnames",
                          ",".join(former.get(channel, channel) for channel in names), "-o", old)
            self.assertEqual(set(channels_of(old)), {former.get(channel, channel) for channel in names})
            told = json.loads(self.succeeds(COMPARE, new, old, "--json"))
            self.assertEqual((told["all"]["psnr_db"], told["all"]["flip"]), (None, 0))
            self.fails(3, ["count_red"], QUILT, new, old, "-o", self.folder / "mixed.exr", "--layout", "side-by-side")
            self.succeeds(QUILT, old, old, "-o", self.folder / f"{name}_pair.exr", "--layout", "side-by-side")
            pair = channels_of(self.folder / f"{name}_pair.exr")
            self.assert_shows(name, np.dstack([pair[channel][:, :WIDTH] for channel in "RGB"]))

    @unittest.skipIf(blender_run.BLENDER is None, "there is no blender here (scripts/install_packages.sh blender)")
    def test_blender_shows_the_picture_in_three_ways(self):
        names = sorted(self.frames)
        blender_run.scene_of("shown", files=[str(self.frames[name]) for name in names], folder=str(self.folder))
        for number, name in enumerate(names):
            for way in ("image", "sequencer", "compositor"):
                file = self.folder / f"{number}_{way}.exr"
                seen = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
                # The sequencer computes sRGB values, which have no negative light.
                with self.subTest(frame=name, way=way):
                    self.assert_shows(name, seen[..., 2::-1], 2e-3, 0 if way == "sequencer" else -np.inf)


if __name__ == "__main__":
    SYNTH, RENDERER, COMPARE, QUILT = sys.argv[1:5]
    if not shutil.which("exrheader"):
        sys.exit("exrheader is missing: scripts/install_packages.sh test")
    unittest.main(argv=sys.argv[:1] + sys.argv[5:])
