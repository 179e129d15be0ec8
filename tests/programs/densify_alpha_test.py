#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests densified light fields of cut-out objects: frames over any background and with alpha are nearer to the truth
than those of the recorded LF images, above all at outlines, and nothing appears where nothing is.

usage: densify_alpha_test.py LFDENSIFY LFSYNTH LFRENDERER LFCOMPRESSOR
"""
import json
import os
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from drawn_cards import psnr_db
from program_test_case import ProgramTestCase, wait_until

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402

DENSIFY = SYNTH = RENDERER = COMPRESSOR = None

# The camera stands in the middle of the 4 x 4 LF cameras of lfsynth, and its focus plane is in front of most objects.
PATH_YAML = """format: lfpath 1
fps: 25
frames: 1
resolution: [120, 90]
camera:
  field_of_view_deg: {angle}
  focal_length_mm: 50
  position: {position}
  look_at: {target}
  up: {up}
lens:
  aperture_diameter: 0.05
  focus_distance: 0.45
"""
ANGLES_DEG = {"still-life": 45, "chart": 40}
GREEN = "0,1,0"


def contents(store):
    """Returns the encoded LF images and planes of a store."""
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        return (database.execute("select id, code, mask from blobs order by id").fetchall(),
                database.execute("select id, kind, plane from planes order by id, kind").fetchall())


def setting(store, name):
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        return database.execute("select value from settings where key = ?", (name,)).fetchone()[0]


def light_and_alpha(file):
    picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
    return picture[..., :3], picture[..., 3:]


def run(*words):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if result.returncode != 0:
        raise AssertionError(result.stderr)


class Scene:
    """A cut-out scene with the truth of a frame, and its densified store."""

    def __init__(self, folder, name, alpha, size="120x90", most=60):
        self.field, self.path, self.store = folder / "field", folder / "path.yaml", folder / "dense.lfs"
        synth = [SYNTH, name, "-o", self.field, "--count", 16, "--size", size, "--spacing", 0.02, "--alpha", alpha,
                 "--format", "png", "-q", "--overwrite"]
        run(*synth, "--calibration-only")
        self.write_path(name)
        run(*synth, "--truth", self.path, "--truth-samples", 200)
        run(DENSIFY, self.field, "-o", self.store, "--most", most)
        self.light, self.alpha = light_and_alpha(next((self.field / "truth").glob("*.exr")))

    def write_path(self, name):
        frames = json.loads((self.field / "transforms.json").read_text())["frames"]
        poses = np.array([frame["transform_matrix"] for frame in frames])
        position, axes = poses[:, :3, 3].mean(0), poses[0][:3, :3]
        words = {key: "[" + ", ".join(repr(float(x)) for x in vector) + "]"
                 for key, vector in (("position", position), ("target", position - axes[:, 2]), ("up", axes[:, 1]))}
        self.path.write_text(PATH_YAML.format(angle=ANGLES_DEG[name], **words))

    def near_outlines(self):
        partly = (self.alpha > 0.002) & (self.alpha < 0.998)
        return cv2.dilate(partly.astype(np.uint8), np.ones((5, 5))) > 0


class DensifyAlphaTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.scenes = {}
        for name, alpha in (("chart", "straight"), ("chart", "premultiplied"), ("still-life", "straight")):
            folder = pathlib.Path(cls.shared.name) / f"{name}-{alpha}"
            folder.mkdir()
            cls.scenes[name, alpha] = Scene(folder, name, alpha)

    @classmethod
    def tearDownClass(cls):
        cls.shared.cleanup()

    def render(self, field, path, *options):
        frames = self.folder / "frames"
        shutil.rmtree(frames, ignore_errors=True)
        self.succeeds(RENDERER, field, path, "-o", frames, "--format", "exr-float", "--no-contact-sheet", "-q",
                      *options)
        return frames / "frame_0001.exr"

    def frames_over(self, scene, background, guard=("--no-guard",)):
        """Returns the frames of the recorded LF images and of the densified store."""
        options = ("--background", background)
        recorded = self.render(scene.field, scene.path, *options)
        kept = self.folder / "recorded.exr"
        shutil.copy(recorded, kept)
        return kept, self.render(scene.store, scene.path, *guard, *options)

    def gains_db(self, scene, background, colour, guard):
        """Returns by how much a frame comes nearer to the truth, whole and near outlines."""
        truth = scene.light + (1 - scene.alpha) * np.array(colour, np.float32)
        near = scene.near_outlines()
        pictures = [light_and_alpha(file)[0] for file in self.frames_over(scene, background, guard)]
        recorded, dense = [[psnr_db(np.clip(picture[where], 0, 1), truth[where]) for picture in pictures]
                           for where in (near >= 0, near)]
        return recorded[1] - recorded[0], dense[1] - dense[0]

    def test_frames_over_any_background_come_nearer_to_the_true_lens_picture(self):
        for (name, alpha), least in ((("chart", "straight"), 6), (("chart", "premultiplied"), 6),
                                     (("still-life", "straight"), 0.5)):
            for background, colour, guard in ((GREEN, (0, 1, 0), ("--no-guard",)), (GREEN, (0, 1, 0), ()),
                                              ("black", (0, 0, 0), ()), ("white", (1, 1, 1), ("--no-guard",))):
                with self.subTest(scene=name, alpha=alpha, background=background, guard=guard):
                    whole, outlines = self.gains_db(self.scenes[name, alpha], background, colour, guard)
                    self.assertGreater(whole, least)
                    self.assertGreater(outlines, least)

    def test_alpha_is_that_of_the_true_lens_picture_and_nothing_appears_where_nothing_is(self):
        for (name, alpha), least in ((("chart", "straight"), 8), (("still-life", "straight"), 5)):
            with self.subTest(scene=name):
                scene = self.scenes[name, alpha]
                (_, recorded), (light, opacity) = map(light_and_alpha, self.frames_over(scene, "none", guard=()))
                self.assertGreater(psnr_db(opacity, scene.alpha) - psnr_db(recorded, scene.alpha), least)
                empty = cv2.dilate((scene.alpha > 0).astype(np.uint8), np.ones((9, 9))) == 0
                self.assertGreater(np.count_nonzero(empty), 100)
                self.assertLess(opacity[empty].max(), 0.02)
                self.assertLess(light[empty].max(), 0.02)
                inside = cv2.erode((scene.alpha == 1).astype(np.uint8), np.ones((5, 5))) == 1
                self.assertGreater(np.count_nonzero(inside), 1000)
                self.assertGreater(opacity[inside].min(), 0.97)

    def test_straight_and_premultiplied_lf_images_give_nearly_the_same_frames(self):
        pictures = [light_and_alpha(self.frames_over(self.scenes["chart", alpha], "none")[1])
                    for alpha in ("straight", "premultiplied")]
        for straight, premultiplied in zip(*pictures):
            self.assertGreater(psnr_db(straight, premultiplied), 45)

    # The store

    def small(self, alpha="straight"):
        folder = self.folder / f"small-{alpha}"
        folder.mkdir()
        return Scene(folder, "still-life", alpha, size="80x60", most=30)

    def densify(self, scene, *options):
        store = self.folder / "again.lfs"
        self.succeeds(DENSIFY, scene.field, "-o", store, "--most", 30, "--overwrite", *options)
        return store

    def test_the_store_has_alpha_whatever_the_background_is(self):
        for alpha in "straight", "premultiplied":
            scene = self.small(alpha)
            self.assertEqual(setting(scene.store, "alpha"), alpha)
            for background, stored in (GREEN, "0 1 0"), ("none", "none"):
                with self.subTest(alpha=alpha, background=background):
                    store = self.densify(scene, "--background", background)
                    self.assertEqual(contents(store), contents(scene.store))
                    self.assertEqual(setting(store, "background"), stored)
                    self.assertEqual(self.render(store, scene.path, "--no-guard").read_bytes(),
                                     self.render(scene.store, scene.path, "--no-guard", "--background",
                                                 background).read_bytes())
            self.assertTrue(all(mask for _, _, mask in contents(scene.store)[0]))

    def test_a_packed_store_is_densified_to_the_bits_of_its_image_files(self):
        scene = self.small()
        packed = self.folder / "packed.lfs"
        self.succeeds(COMPRESSOR, scene.field, "-o", packed, "--profile", "lossless")
        store = self.folder / "of_store.lfs"
        self.succeeds(DENSIFY, packed, "-o", store, "--most", 30)
        self.assertEqual(contents(store), contents(scene.store))

    def test_lfrenderer_densifies_and_renders_in_one_call(self):
        scene = self.small()
        film = self.folder / "film"
        options = ("--no-guard", "--background", "none", "--no-contact-sheet", "-q")
        self.succeeds(RENDERER, scene.field, scene.path, "-o", film, "--densify", *options)
        other = self.folder / "other"
        self.succeeds(RENDERER, film / "densified.lfs", scene.path, "-o", other, *options)
        self.assertEqual((film / "frame_0001.exr").read_bytes(), (other / "frame_0001.exr").read_bytes())
        # The store is used again for frames over another background.
        before = (film / "densified.lfs").stat()
        options = ("--no-guard", "--background", GREEN, "--no-contact-sheet", "-q")
        self.succeeds(RENDERER, scene.field, scene.path, "-o", film, "--densify", *options)
        self.assertEqual((film / "densified.lfs").stat(), before)
        self.succeeds(RENDERER, film / "densified.lfs", scene.path, "-o", other, *options)
        self.assertEqual((film / "frame_0001.exr").read_bytes(), (other / "frame_0001.exr").read_bytes())

    # Equal bits

    def test_any_number_of_threads_gives_the_same_bits(self):
        scene = self.small()
        for threads in 1, 2, 3:
            self.assertEqual(contents(self.densify(scene, "--threads", threads)), contents(scene.store))

    def test_a_store_that_was_killed_and_interrupted_ends_with_the_same_bits(self):
        scene = self.small()
        again, unfinished = self.folder / "again.lfs", self.folder / "again.lfs.unfinished"
        call = [str(word) for word in (DENSIFY, scene.field, "-o", again, "--most", 30, "--threads", 1, "--resume")]
        for stop in signal.SIGKILL, signal.SIGINT:
            process = subprocess.Popen(call, stderr=subprocess.DEVNULL)
            size = unfinished.stat().st_size if unfinished.exists() else 0
            wait_until(lambda: unfinished.exists() and unfinished.stat().st_size > size, process)
            process.send_signal(stop)
            self.assertIn(process.wait(), (5, -stop, 0))
        if not again.exists():
            self.succeeds(*call)
        self.assertEqual(contents(again), contents(scene.store))


if __name__ == "__main__":
    DENSIFY, SYNTH, RENDERER, COMPRESSOR = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1] + sys.argv[5:])
