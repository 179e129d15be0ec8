#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests frames with a focal surface: they are those of true lenses, whatever makes them, and other ways refuse it.

usage: focal_surface_test.py LFSYNTH LFRENDERER LFPREPROCESSOR LFMERGE LFPATH LFFOCUS
"""
import os
import signal
import subprocess
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from still_life_case import StillLifeCase

SYNTH = RENDERER = PREPROCESSOR = MERGE = PATHS = FOCUS = None
WIDTH, HEIGHT, FOCAL_PX, PLACE, TARGET = 160, 106, 160 * 50 / 36, (0, -0.125, -0.799), (0, -0.085, 0)
PATH = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [160, 106]
{more}
camera: {{focal_length_mm: 50, position: [0, -0.125, -0.799], look_at: [0, -0.085, 0]}}
lens: {{aperture_diameter: {aperture}, focus_distance: 0.62, focus_tilt_deg: {{horizontal: {tilt}, vertical: 0}}}}
{focus}
"""


def picture(file):
    return np.clip(cv2.imread(str(file), cv2.IMREAD_UNCHANGED)[..., :3], 0, 1)


def psnr_db(a, b):
    return -10 * np.log10(max(1e-12, np.mean((a.astype(float) - b) ** 2)))


def write_pfm(file, depths):
    height, width = depths.shape
    file.write_bytes(f"Pf\n{width} {height}\n-1\n".encode() + depths[::-1].astype("<f4").tobytes())


def wavy_depths(phase=0):
    """Returns depths that rise and fall, with a step in the middle."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    return 1 / (1.55 + 0.25 * np.sin(x / 25 + phase) * np.cos(y / 31) + np.where(x > 90, 0.2, 0))


class FocalSurfaceTest(StillLifeCase):
    def path(self, name, focus="", aperture=0.04, tilt=0, more="", frames=1):
        file = self.folder / f"{name}.yaml"
        file.write_text(PATH.format(focus=focus, aperture=aperture, tilt=tilt, more=more, frames=frames))
        return file

    def depths(self, name="z.pfm", depths=None):
        write_pfm(self.folder / name, wavy_depths() if depths is None else depths)
        return f"focus: {{surface: {name}, kind: depth}}"

    def frames(self, source, *options):
        out = self.folder / f"frames-{len(list(self.folder.iterdir()))}"
        self.succeeds(RENDERER, *source, "-o", out, "--format", "exr-float", "--no-contact-sheet", "-q", *options)
        return out

    def frame(self, path, *options):
        return self.frames([self.field, path], *options) / "frame_0001.exr"

    def truth(self, path):
        out = self.folder / f"truth-{path.stem}"
        self.succeeds(SYNTH, "still-life", "-o", out, "--calibration-only", "--truth", path, "--truth-samples", 400,
                      "-q", "--overwrite")
        return picture(out / "truth/frame_0001.exr")

    def test_frames_are_those_of_true_lenses_that_focus_each_element_on_its_depth(self):
        path = self.path("wavy", self.depths())
        truth = self.truth(path)
        right = psnr_db(picture(self.frame(path)), truth)
        self.assertGreater(right, 40)
        self.assertLess(psnr_db(picture(self.frame(self.path("flat"))), truth), right - 6)
        for options, least in ((["--lens-weights", "none"], 36), (["--estimator", "nearest"], 28),
                               (["--filter", "bicubic"], 38), (["--filter", "bilinear"], 36)):
            with self.subTest(options):
                self.assertGreater(psnr_db(picture(self.frame(path, *options)), truth), least)

    def test_a_plane_as_depths_is_the_focus_plane(self):
        x = np.arange(WIDTH) + 0.5
        inverse = (1 - np.tan(np.radians(20)) * (x - WIDTH / 2) / FOCAL_PX) / 0.62
        tilted = self.depths("tilted.pfm", np.tile(1 / inverse, (HEIGHT, 1)))
        flat = self.depths("plane.pfm", np.full((HEIGHT, WIDTH), 0.62))
        for name, focus, tilt in (("tilted", tilted, 20), ("plane", flat, 0)):
            by_plane = picture(self.frame(self.path(name, tilt=tilt)))
            by_depths = picture(self.frame(self.path(f"{name}-depths", focus)))
            self.assertGreater(psnr_db(by_depths, by_plane), 60)

    def test_seams_between_pieces_are_no_larger_than_the_picture_itself_allows(self):
        # A smooth surface of many pieces: no jump from one element to the next may exceed that of the true lens
        # by more than the error of the whole frame.
        y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
        focus = self.depths("smooth.pfm", 1 / (1.5 + 0.3 * np.sin(x / 30) * np.cos(y / 25)))
        path = self.path("smooth", focus)
        frame, truth = picture(self.frame(path)), self.truth(path)
        jump = np.abs(np.diff(frame, axis=1) - np.diff(truth, axis=1)).max(axis=(0, 2))
        self.assertLess(np.percentile(jump, 90), 0.25)
        self.assertGreater(psnr_db(frame, truth), 38)

    def test_any_cut_of_the_work_gives_the_same_bits(self):
        focus = [self.depths(f"z_{n:04}.pfm", wavy_depths(n)) for n in (1, 2)] and \
            "focus: {surface: z_%04d.pfm, kind: depth}"
        path = self.path("film", focus, frames=2)
        whole = self.frames([self.field, path])
        frames = [(whole / f"frame_{n:04}.exr").read_bytes() for n in (1, 2)]
        self.assertNotEqual(frames[0], frames[1])
        single = self.frames([self.field, path], "--threads", 1)
        self.assertEqual((single / "frame_0002.exr").read_bytes(), frames[1])
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, path, "-o", packages, "--packages", 2, "-q")
        for n in (1, 2):
            of_package = self.frames([sorted(packages.glob("*.lfp"))[n - 1]])
            self.assertEqual((of_package / f"frame_{n:04}.exr").read_bytes(), frames[n - 1])
        shards = [self.frames([self.field, path], "--shard", f"{k}/2") for k in (1, 2)]
        merged = self.folder / "merged"
        self.succeeds(MERGE, *shards, "-o", merged, "--format", "exr-float", "-q")
        self.assertEqual(picture(merged / "frame_0002.exr").tobytes(), picture(whole / "frame_0002.exr").tobytes())
        self.fails(2, ["--z", "focal surface"], MERGE, *shards, "-o", self.folder / "with-z", "--z", "-q")
        # A resumed render must have the same surface.
        write_pfm(self.folder / "z_0002.pfm", wavy_depths(5))
        result = self.call(RENDERER, self.field, path, "-o", whole, "--format", "exr-float", "--no-contact-sheet",
                           "--resume", "-q")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("focal_surface", result.stderr)

    def test_z_is_the_depth_of_the_surface(self):
        path = self.path("z", self.depths())
        frame = self.frame(path, "--z")
        again = self.path("again", f"focus: {{surface: {frame}, kind: depth}}")
        self.assertGreater(psnr_db(picture(self.frame(again)), picture(frame)), 45)

    def test_a_height_map_is_sharp_where_the_table_is(self):
        # The table of the scene is the plane y = 0 of the world, whose y axis points down.
        focus = ("focus: {surface: table.pfm, kind: height, origin: [-5, 0, 5], cell: 1, right: [1, 0, 0], "
                 "down: [0, 0, -1], up: [0, -1, 0]}")
        write_pfm(self.folder / "table.pfm", np.zeros((11, 11)))
        path = self.path("table", focus)
        truth = self.truth(path)
        self.assertGreater(psnr_db(picture(self.frame(path)), truth), 38)
        with_shutter = self.path("open", focus, more="shutter: {angle_deg: 180, samples: 3}")
        self.assertGreater(psnr_db(picture(self.frame(with_shutter)), truth), 38)

    def test_what_knows_planes_only_refuses_a_surface(self):
        path = self.path("refused", self.depths())
        for mode in ("rebin", "hybrid"):
            self.fails(2, ["focal surface", "--interpolation pixels", "--mode collect"], RENDERER, self.field, path,
                       "-o", self.folder / "f", "--mode", mode, "--interpolation", "cells")
        self.fails(3, ["focus.surface", "lfrenderer"], FOCUS, "stack", self.field, path, "-o", self.folder / "f.exr",
                   "--planes", 3)

    def test_depths_of_a_frame_do_not_depend_on_its_surface(self):
        for command in ("depth", "sharp"):
            files = []
            for path in (self.path("with", self.depths()), self.path("without")):
                files.append(self.folder / f"{command}-{path.stem}.exr")
                self.succeeds(FOCUS, command, self.field, path, "-o", files[-1], "--near", 0.4, "--far", 1.5,
                              "--planes", 8, "-q")
            self.assertEqual(files[0].read_bytes(), files[1].read_bytes())

    def test_frames_that_a_stop_rule_finishes_early_are_left_alone(self):
        # The frames have different numbers of pieces, and the first one is finished first.
        self.depths("z_1.pfm", np.full((HEIGHT, WIDTH), 0.7))
        self.depths("z_2.pfm", wavy_depths(1))
        path = self.path("rules", "focus: {surface: z_%d.pfm, kind: depth, blur: 0.05}", frames=2)
        for rule in ("samples>=1", "noise<=0.05"):
            options = ["--stop-when", rule, "--lens-weights", "none"]
            out = [self.frames([self.field, path], *options, *more) for more in ([], ["--threads", 1])]
            for n in (1, 2):
                self.assertEqual(*((folder / f"frame_000{n}.exr").read_bytes() for folder in out))

    def test_only_the_surfaces_of_the_frames_that_are_rendered_are_made(self):
        self.depths("z_2.pfm", wavy_depths(2))
        path = self.path("part", "focus: {surface: z_%d.pfm, kind: depth}", frames=3)
        out = self.frames([self.field, path], "--frames", 2)
        self.fails(3, ["z_1.pfm"], RENDERER, self.field, path, "-o", self.folder / "all")
        for n in (1, 3):
            self.depths(f"z_{n}.pfm", wavy_depths(n))
        # A resumed render has the surfaces of frames that other calls have finished.
        self.succeeds(RENDERER, self.field, path, "-o", out, "--format", "exr-float", "--no-contact-sheet", "--resume",
                      "-q")
        whole = self.frames([self.field, path], "--threads", 3)
        for n in (1, 2, 3):
            self.assertEqual((out / f"frame_000{n}.exr").read_bytes(), (whole / f"frame_000{n}.exr").read_bytes())

    def test_a_signal_ends_the_making_of_surfaces(self):
        write_pfm(self.folder / "hills.pfm", 0.02 * np.random.default_rng(1).random((200, 200)))
        path = self.path("long", "focus: {surface: hills.pfm, kind: height, origin: [-1, 0, 1], cell: 0.01, "
                         "right: [1, 0, 0], down: [0, 0, -1], up: [0, -1, 0]}", frames=5000)
        for program, out in ((RENDERER, "film"), (PREPROCESSOR, "packages"), (FOCUS, "through")):
            command = ["through"] if program == FOCUS else []
            words = [program, *command, self.field, path, "-o", self.folder / out, "-v"]
            with subprocess.Popen(list(map(str, words)), stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    if "focal surface of frame" in line:
                        break
                process.send_signal(signal.SIGTERM)
                said = process.stderr.read()
            self.assertEqual(process.returncode, 5, said)
            self.assertLess(said.count("focal surface of frame"), 4000)
            self.assertEqual(list((self.folder / out).glob("*")), [])

    def test_both_eyes_of_a_stereo_pair_are_sharp_on_a_height_map(self):
        write_pfm(self.folder / "table.pfm", np.zeros((11, 11)))
        path = self.path("pair", "focus: {surface: table.pfm, kind: height, origin: [-5, 0, 5], cell: 1, "
                         "right: [1, 0, 0], down: [0, 0, -1], up: [0, -1, 0]}")
        stereo = self.folder / "stereo.yaml"
        self.succeeds(PATHS, path, "-o", stereo, "--stereo-mm", 10, "-q")
        eyes = self.frames([self.field, stereo])
        self.succeeds(SYNTH, "still-life", "-o", self.folder / "truth", "--calibration-only", "--truth", stereo,
                      "--truth-samples", 400, "-q")
        for n in (1, 2):
            truth = picture(self.folder / f"truth/truth/frame_000{n}.exr")
            self.assertGreater(psnr_db(picture(eyes / f"frame_000{n}.exr"), truth), 36)

    def test_lfpath_keeps_the_surface_in_yaml_only(self):
        path = self.path("kept", self.depths())
        (self.folder / "below").mkdir()
        to = self.folder / "below" / "kept.yaml"
        self.succeeds(PATHS, path, "-o", to, "-q")
        self.assertIn("../z.pfm", to.read_text())
        self.assertGreater(psnr_db(picture(self.frame(to)), picture(self.frame(path))), 80)
        result = self.call(PATHS, path, "-o", self.folder / "kept.json")
        self.assertIn("focal surface", result.stderr)
        self.fails(3, ["depth picture", "height map"], PATHS, path, "-o", self.folder / "s.yaml", "--stereo-mm", 60)

    def test_outputs_do_not_replace_the_surface(self):
        path = self.path("own", self.depths("frame_0001.exr"))
        result = self.call(RENDERER, self.field, path, "-o", self.folder, "--overwrite", "-q")
        self.assertNotEqual(result.returncode, 0)
        self.assertTrue((self.folder / "frame_0001.exr").read_bytes().startswith(b"Pf"))


if __name__ == "__main__":
    SYNTH, RENDERER, PREPROCESSOR, MERGE, PATHS, FOCUS = sys.argv[1:7]
    StillLifeCase.SYNTH = SYNTH
    unittest.main(argv=sys.argv[:1] + sys.argv[7:])
