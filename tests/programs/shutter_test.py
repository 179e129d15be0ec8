#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests frames that are exposed while the camera moves: they are the mean of true lenses, whatever makes them.

usage: shutter_test.py LFSYNTH LFRENDERER LFPREPROCESSOR LFMERGE LFPATH LFCAMMVMINFO
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

from exr_file import read_header
from program_test_case import wait_until
from still_life_case import StillLifeCase

SYNTH = RENDERER = PREPROCESSOR = MERGE = PATH = INFO = None
FPS, ANGLE_DEG, SAMPLES = 8, 240, 6
PATH_YAML = """format: lfpath 1
fps: {fps}
frames: {frames}
resolution: [160, 106]
{shutter}
camera:
  focal_length_mm: 50
  position: [{x}, -0.125, -0.799]
  speed: [0.16, 0, 0]
  orientation: {{pitch: -3}}
  roll_deg: {roll}
  roll_speed_deg: 12
lens:
  aperture_diameter: {aperture}
  aperture_diameter_speed: 0.05
  focus_distance: {focus}
  focus_distance_speed: 0.4
"""
SHUTTER = f"shutter: {{angle_deg: {ANGLE_DEG}, samples: {SAMPLES}}}"


def picture(file):
    return np.clip(cv2.imread(str(file), cv2.IMREAD_UNCHANGED)[..., :3], 0, 1)


def psnr_db(a, b):
    return -10 * np.log10(max(np.mean((a.astype(float) - b) ** 2), 1e-20))


class ShutterTest(StillLifeCase):
    def path(self, name, shutter=SHUTTER, time_s=0.0, fps=FPS, frames=2, wide=0.03):
        """Writes a path that begins at another time of the same movement."""
        file = self.folder / f"{name}.yaml"
        file.write_text(PATH_YAML.format(fps=fps, frames=frames, shutter=shutter, x=-0.01 + 0.16 * time_s,
                                         roll=12 * time_s, aperture=wide + 0.05 * time_s, focus=0.6 + 0.4 * time_s))
        return file

    def render(self, path, *options, source=None, code=0):
        out = self.folder / f"frames-{path.stem}-{len(list(self.folder.iterdir()))}"
        self.succeeds(RENDERER, *(source or [self.field, path]), "-o", out, "--format", "exr-float",
                      "--no-contact-sheet", "-q", *options, code=code)
        return out

    def frames(self, *arguments, **options):
        """Returns the bytes of both frames of a render."""
        out = self.render(*arguments, **options)
        return [(out / f"frame_{number:04d}.exr").read_bytes() for number in (1, 2)]

    def truth(self, frame, wide=0.03):
        """Returns the mean of the pictures that true lenses take at the instants of a frame."""
        open_s = ANGLE_DEG / 360 / FPS
        first_s = (frame - 1) / FPS + open_s * (0.5 / SAMPLES - 0.5)
        path = self.path(f"truth-{frame}", "", first_s, SAMPLES / open_s, SAMPLES, wide)
        out = self.folder / f"truth-{frame}"
        self.succeeds(SYNTH, "still-life", "-o", out, "--calibration-only", "--truth", path, "--truth-samples", 256,
                      "-q", "--overwrite")
        pictures = [cv2.imread(str(out / f"truth/frame_{k + 1:04d}.exr"), cv2.IMREAD_UNCHANGED)[..., :3]
                    for k in range(SAMPLES)]
        return np.clip(np.mean(pictures, axis=0), 0, 1)

    def test_a_frame_is_the_mean_of_true_lenses(self):
        truth = self.truth(1)
        blurred = picture(self.render(self.path("blurred")) / "frame_0001.exr")
        self.assertGreater(psnr_db(blurred, truth), 40)
        sharp = picture(self.render(self.path("sharp", "")) / "frame_0001.exr")
        self.assertLess(psnr_db(sharp, truth), psnr_db(blurred, truth) - 8)
        half = picture(self.render(self.path("half", SHUTTER.replace("240", "120"))) / "frame_0001.exr")
        self.assertLess(psnr_db(half, truth), psnr_db(blurred, truth) - 3)
        for options in (["--lens-weights", "none"], ["--filter", "bicubic"], ["--estimator", "nearest"]):
            with self.subTest(options=options):
                other = picture(self.render(self.path("blurred"), *options) / "frame_0001.exr")
                self.assertGreater(psnr_db(other, truth), 33)

    def test_the_ground_truth_is_the_mean_of_its_instants(self):
        out = self.folder / "truth"
        self.succeeds(SYNTH, "still-life", "-o", out, "--calibration-only", "--truth", self.path("path"),
                      "--truth-samples", 256, "-q")
        self.assertEqual(len(list(out.glob("truth/*.exr"))), 2)
        self.assertGreater(psnr_db(picture(out / "truth/frame_0002.exr"), self.truth(2)), 90)

    def test_a_camera_at_rest_takes_the_picture_without_a_shutter(self):
        path = self.path("moving")
        rest = "\n".join(line for line in path.read_text().splitlines() if "speed" not in line)
        pictures = []
        for name, text in (("rest", rest), ("sharp", rest.replace(SHUTTER, ""))):
            (self.folder / f"{name}.yaml").write_text(text)
            pictures.append(picture(self.render(self.folder / f"{name}.yaml") / "frame_0002.exr").tobytes())
        self.assertEqual(*pictures)

    def test_every_way_to_render_gives_the_same_bits(self):
        path = self.path("path")
        for options in ([], ["--lens-weights", "none", "--estimator", "nearest"]):
            with self.subTest(options=options):
                expected = self.frames(path, *options)
                for threads in (1, 2, 3):
                    self.assertEqual(self.frames(path, "--threads", threads, *options), expected)
                self.assertEqual(self.frames(path, "--memory", "96M", "--threads", 2, *options), expected)
                self.assertEqual(self.killed(path, *options), expected)
                self.check_packages(path, options, expected)
                self.check_shards(path, options, expected)

    def killed(self, path, *options):
        out = self.folder / f"killed-{len(options)}"
        words = [RENDERER, self.field, path, "-o", out, "--format", "exr-float", "--no-contact-sheet", "-q",
                 "--dump-every", "0.001s", "--memory", "96M", *options]
        resume = []
        for _ in range(3):
            with subprocess.Popen([*map(str, words), *resume], stderr=subprocess.DEVNULL) as process:
                wait_until(lambda: list(out.glob("partial/*.plate")), process)
                process.send_signal(signal.SIGKILL)
            resume = ["--resume"]
        self.succeeds(*words, "--resume", "--threads", 3)
        return [(out / f"frame_{number:04d}.exr").read_bytes() for number in (1, 2)]

    def check_packages(self, path, options, expected):
        folder = self.folder / f"packages-{len(options)}"
        self.succeeds(PREPROCESSOR, self.field, path, "-o", folder, "--packages", 2, "-q", *options)
        again = self.folder / f"again-{len(options)}"
        self.succeeds(PREPROCESSOR, self.field, path, "-o", again, "--packages", 2, "--threads", 1, "-q", *options)
        packages = sorted(folder.glob("*.lfp"))
        self.assertEqual(len(packages), 2)
        for package in packages:
            self.assertEqual(package.read_bytes(), (again / package.name).read_bytes())
        self.assertEqual(self.frames(path, *options, source=packages), expected)

    def check_shards(self, path, options, expected):
        out = self.folder / f"shards-{len(options)}"
        for shard in (1, 2, 3):
            self.succeeds(RENDERER, self.field, path, "-o", out, "--shard", f"{shard}/3", "-q", *options)
        self.succeeds(MERGE, out / "partial/shards", "-o", out / "merged", "--format", "exr-float",
                      "--no-contact-sheet", "-q")
        merged = [(out / f"merged/frame_{number:04d}.exr").read_bytes() for number in (1, 2)]
        self.assertEqual(merged, expected)

    def test_another_shutter_is_another_film(self):
        path, other = self.path("path"), self.path("other", SHUTTER.replace("240", "239"))
        out = self.folder / "out"
        with subprocess.Popen([*map(str, [RENDERER, self.field, path, "-o", out, "-q", "--dump-every", "0.001s"])],
                              stderr=subprocess.DEVNULL) as process:
            wait_until(lambda: list(out.glob("partial/*.plate")), process)
            process.send_signal(signal.SIGTERM)
        self.assertEqual(process.returncode, 5)
        self.fails(2, ["frame.shutter 240 degrees", "this call has 239 degrees"], RENDERER, self.field, other,
                   "-o", out, "--resume")
        self.fails(2, ["no frame.shutter"], RENDERER, self.field, self.path("sharp", ""), "-o", out, "--resume")
        for shard, film in enumerate((path, other), 1):
            self.succeeds(RENDERER, self.field, film, "-o", self.folder / f"shard-{shard}", "--shard", f"{shard}/2",
                          "-q")
        self.fails(3, ["frame.shutter 239 degrees"], MERGE, self.folder / "shard-1/partial/shards",
                   self.folder / "shard-2/partial/shards", "-o", self.folder / "merged")
        for number, film in enumerate((path, other)):
            self.succeeds(PREPROCESSOR, self.field, film, "-o", self.folder / f"film-{number}", "--packages", 2, "-q")
        self.fails(3, ["another camera path"], RENDERER, self.folder / "film-0/package-0000.lfp",
                   self.folder / "film-1/package-0001.lfp", "-o", self.folder / "mixed")

    def test_cells_and_guarded_frames_refuse_a_shutter(self):
        path = self.path("path")
        for mode in ("rebin", "hybrid"):
            for program, output in ((RENDERER, "frames"), (PREPROCESSOR, "packages")):
                self.fails(2, [f"--mode {mode}", "shutter", "use --interpolation pixels or --mode collect"], program,
                           self.field, path, "-o", self.folder / output, "--mode", mode, "--interpolation", "cells")
        self.fails(2, ["densified", "shutter", "--no-guard"], RENDERER, self.field, path, "-o", self.folder / "frames",
                   "--densify")

    def test_files_and_programs_state_the_shutter(self):
        path = self.path("path")
        with_shutter, without = (read_header((self.render(film) / "frame_0001.exr").read_bytes())[0]
                                 for film in (path, self.path("sharp", "")))
        self.assertEqual(with_shutter["lf:shutter_angle_deg"], ("double", ANGLE_DEG))
        self.assertEqual(with_shutter["lf:shutter_samples"], ("int", SAMPLES))
        kind, open_s = with_shutter["expTime"]
        self.assertEqual(kind, "float")
        self.assertAlmostEqual(open_s, ANGLE_DEG / 360 / FPS, 6)
        self.assertEqual(set(with_shutter) - set(without), {"lf:shutter_angle_deg", "lf:shutter_samples", "expTime"})
        self.assertIn("angle_deg 240 samples 6", self.succeeds(INFO, path))
        cameras = json.loads(self.succeeds(INFO, path, "--json"))["cameras"]
        self.assertEqual(cameras[0]["shutter"], [ANGLE_DEG, SAMPLES])
        self.assertNotIn("shutter", self.succeeds(INFO, self.folder / "sharp.yaml", "--json"))

    def test_only_yaml_keeps_the_shutter(self):
        path = self.path("path", frames=5)
        yaml, moved = self.folder / "out.yaml", self.folder / "moved.yaml"
        told = self.call(PATH, path, "-o", yaml)
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn("interpolated between the cameras of the frames", told.stderr)
        self.assertIn(SHUTTER, yaml.read_text())
        self.succeeds(PATH, path, "-o", moved, "--scale", 2, "-q")
        self.assertIn(SHUTTER, moved.read_text())
        # In the middle of the film the cameras move as in the path itself.
        ours, written = (picture(self.render(file, "--frames", "3") / "frame_0003.exr") for file in (path, yaml))
        self.assertGreater(psnr_db(ours, written), 60)
        for name in ("out.json", "out.chan", "out.usda"):
            told = self.call(PATH, path, "-o", self.folder / name)
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertIn("no place for", told.stderr)
            self.assertIn("the shutter", told.stderr)
        self.assertNotIn("shutter", self.succeeds(INFO, self.folder / "out.json", "--json"))


if __name__ == "__main__":
    SYNTH, RENDERER, PREPROCESSOR, MERGE, PATH, INFO = sys.argv[1:7]
    StillLifeCase.SYNTH = SYNTH
    unittest.main(argv=sys.argv[:1])
