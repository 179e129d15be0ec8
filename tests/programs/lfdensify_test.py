#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests densified light fields from a user's view: nearer to the truth than the recorded ones, the same bits however
they were made, refused where they cannot be right.

usage: lfdensify_test.py LFDENSIFY LFSYNTH LFRENDERER LFCOMPRESSOR
"""
import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import unittest

import numpy as np

from program_test_case import ProgramTestCase, wait_until

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402

DENSIFY = SYNTH = RENDERER = COMPRESSOR = None

PATH_YAML = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [160, 120]
camera:
  field_of_view_deg: 45
  focal_length_mm: 50
  position: {position}
  look_at: {target}
  up: {up}
lens:
  aperture_diameter: {aperture}
  focus_distance: 0.8
"""


def psnr(a, b):
    return -10 * np.log10(np.mean((np.clip(a, 0, 1) - np.clip(b, 0, 1)) ** 2))


def contents(store):
    """Returns the encoded LF images and planes of a store."""
    with sqlite3.connect(f"file:{store}?immutable=1", uri=True) as database:
        return (database.execute("select id, code, mask from blobs order by id").fetchall(),
                database.execute("select id, kind, plane from planes order by id, kind").fetchall())


class DensifyTest(ProgramTestCase):
    """Has a still life, photographed by 4 x 4 cameras."""

    def setUp(self):
        super().setUp()
        self.field = self.folder / "field"
        self.store = self.folder / "dense.lfs"

    def synth(self, *options):
        self.succeeds(SYNTH, "still-life", "-o", self.field, "--count", 16, "--size", "160x120", "--spacing", 0.02,
                      "-q", "--overwrite", *options)

    def cameras(self):
        text = json.loads((self.field / "transforms.json").read_text())
        return text, np.array([frame["transform_matrix"] for frame in text["frames"]])

    def write_path(self, aperture=0.05, frames=1, camera=None):
        """Writes a path whose camera stands in the middle of the LF cameras, or at one of them."""
        _, poses = self.cameras()
        position, axes = poses[:, :3, 3].mean(0) if camera is None else poses[camera][:3, 3], poses[0][:3, :3]
        words = {name: "[" + ", ".join(repr(float(x)) for x in vector) + "]"
                 for name, vector in (("position", position), ("target", position - axes[:, 2]),
                                      ("up", axes[:, 1]))}
        path = self.folder / "path.yaml"
        path.write_text(PATH_YAML.format(frames=frames, aperture=aperture, **words))
        return path

    def densify(self, *options, code=0, store=None, most=60):
        return self.succeeds(DENSIFY, self.field, "-o", store or self.store, "--most", most, "--cache", "none",
                             *options, code=code)

    def render(self, field, path, *options):
        frames = self.folder / "frames"
        shutil.rmtree(frames, ignore_errors=True)
        self.succeeds(RENDERER, field, path, "-o", frames, "--format", "exr-float", "--no-contact-sheet", "-q",
                      *options)
        return cv2.imread(str(frames / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., :3]

    # Truth

    def gain_db(self, *options):
        """Returns by how much a densified light field comes nearer to the picture of a true lens."""
        self.synth("--calibration-only", *options)
        path = self.write_path()
        self.synth("--truth", path, "--truth-samples", 150, *options)
        truth = cv2.imread(str(next((self.field / "truth").glob("*.exr"))), cv2.IMREAD_UNCHANGED)[..., :3]
        self.densify(most=250)
        guard = ("--no-guard",) if "--bayer" in options else ()
        return psnr(truth, self.render(self.store, path, *guard)) - psnr(truth, self.render(self.field, path))

    def test_blur_comes_much_nearer_to_the_picture_of_a_true_lens(self):
        self.assertGreater(self.gain_db(), 8)

    def test_so_does_that_of_cameras_with_distorted_lenses(self):
        self.assertGreater(self.gain_db("--distortion", "0.12,-0.25,0.001,-0.002"), 8)

    def test_so_does_that_of_mosaics(self):
        self.assertGreater(self.gain_db("--bayer"), 6)

    def test_noise_does_not_hide_the_depths(self):
        self.synth("--format", "png")
        dice = np.random.default_rng(1)
        for file in (self.field / "images").glob("*.png"):
            picture = cv2.imread(str(file))
            noisy = np.clip(picture + dice.normal(0, 8, picture.shape), 0, 255)
            cv2.imwrite(str(file), np.rint(noisy).astype(np.uint8))
        self.densify(most=20)

    def test_virtual_lf_images_are_marked_and_recorded_ones_stay_as_they_are(self):
        self.synth()
        report = json.loads(self.densify("--json"))
        self.assertEqual(report["recorded"], 16)
        self.assertGreater(report["virtual"], 20)
        self.assertLessEqual(report["virtual"], 60)
        with sqlite3.connect(f"file:{self.store}?immutable=1", uri=True) as database:
            marked = [row[0] for row in database.execute("select id from virtual_images order by id")]
            planes = database.execute("select distinct kind from planes order by kind").fetchall()
            trusted = [row[0] for row in database.execute("select id from planes where kind = 'trust' order by id")]
        self.assertEqual(marked, list(range(16, 16 + report["virtual"])))
        self.assertEqual(planes, [("disparity",), ("trust",)])
        self.assertEqual(trusted, marked)
        loss = self.folder / "whole.lfs"
        self.succeeds(COMPRESSOR, self.field, "-o", loss, "--profile", "lossless")
        recorded = {row[0]: row[1:] for row in contents(self.store)[0]}
        with sqlite3.connect(f"file:{loss}?immutable=1", uri=True) as database:
            for id, code, mask in database.execute("select id, code, mask from blobs"):
                self.assertEqual(recorded[id], (code, mask))

    def test_a_film_gets_only_the_virtual_lf_images_that_it_looks_at(self):
        self.synth()
        path = self.write_path(aperture=0.04)
        whole = json.loads(self.densify("--json", "--spacing", 6))
        film = json.loads(self.succeeds(DENSIFY, self.field, path, "-o", self.folder / "film.lfs", "--json",
                                        "--spacing", 6))
        self.assertLess(film["virtual"], whole["virtual"])
        self.render(self.folder / "film.lfs", path)

    # Equal bits

    def test_any_number_of_threads_gives_the_same_bits(self):
        self.synth("--format", "png")
        stores = []
        for threads in 1, 2, 3:
            store = self.folder / f"{threads}.lfs"
            self.densify("--threads", threads, store=store)
            stores.append(contents(store))
        self.assertEqual(stores[0], stores[1])
        self.assertEqual(stores[0], stores[2])

    def test_a_store_that_was_interrupted_and_killed_ends_with_the_same_bits(self):
        self.synth()
        self.densify()
        unfinished = self.folder / "again.lfs.unfinished"
        again = self.folder / "again.lfs"
        for stop in signal.SIGINT, signal.SIGKILL, signal.SIGTERM:
            process = subprocess.Popen([DENSIFY, self.field, "-o", again, "--most", "60", "--threads", "1",
                                        "--cache", "none", "--resume"], stderr=subprocess.DEVNULL)
            size = unfinished.stat().st_size if unfinished.exists() else 0
            wait_until(lambda: unfinished.exists() and unfinished.stat().st_size > size + 20000, process)
            process.send_signal(stop)
            self.assertIn(process.wait(), (5, -stop, 0))
        if not again.exists():
            self.densify("--resume", store=again)
        self.assertEqual(contents(self.store), contents(again))

    # Packed stores

    def pack(self, profile):
        store = self.folder / f"{profile}.lfs"
        self.succeeds(COMPRESSOR, self.field, "-o", store, "--profile", profile)
        return store

    def test_a_packed_store_is_densified_to_the_bits_of_its_image_files(self):
        for options in (), ("--bayer",):
            with self.subTest(options=options):
                shutil.rmtree(self.field, ignore_errors=True)
                self.synth(*options)
                self.densify("--overwrite")
                dense = self.folder / "of_store.lfs"
                self.succeeds(DENSIFY, self.pack("lossless"), "-o", dense, "--most", 60, "--overwrite")
                self.assertEqual(contents(dense), contents(self.store))
                (self.folder / "lossless.lfs").unlink()

    def test_the_encoded_images_of_a_lossy_store_are_copied(self):
        for options in (), ("--bayer",):  # linear values of 16 bits are encoded along a curve
            with self.subTest(options=options):
                shutil.rmtree(self.field, ignore_errors=True)
                self.synth(*options)
                lossy, dense = self.pack("default"), self.folder / "of_store.lfs"
                depths = ("--depths", 0.35, 6)  # the same virtual LF cameras for both
                self.succeeds(DENSIFY, lossy, "-o", dense, "--most", 60, "--overwrite", *depths)
                virtual = {row[0]: row[1:] for row in contents(dense)[0]}
                with sqlite3.connect(f"file:{lossy}?immutable=1", uri=True) as database:
                    for id, code, mask in database.execute("select id, code, mask from blobs"):
                        self.assertEqual(virtual[id], (code, mask))
                path = self.write_path()
                self.densify("--overwrite", *depths)
                guard = ("--no-guard",) if options else ()
                self.assertGreater(psnr(self.render(dense, path, *guard), self.render(self.store, path, *guard)), 38)
                lossy.unlink()

    def test_a_store_is_not_written_over_itself(self):
        self.synth()
        store = self.pack("lossless")
        before = store.read_bytes()
        self.fails(2, ["is the packed store that is densified"], DENSIFY, store, "-o", store, "--overwrite")
        self.assertEqual(store.read_bytes(), before)

    def test_a_broken_lf_image_is_left_out_and_named(self):
        self.synth()
        broken = next(self.field.rglob("*.exr"))
        broken.write_bytes(broken.read_bytes()[:100])
        report = json.loads(self.densify("--json", code=6))
        self.assertEqual(report["recorded"], 15)
        self.assertEqual([image["lf_image"].rpartition("/")[2] for image in report["skipped"]], [broken.name])
        path = self.write_path()
        self.render(self.store, path)
        self.densify("--overwrite", "--allow-missing", 1)
        self.fails(3, [broken.name], DENSIFY, self.field, "-o", self.store, "--overwrite", "--strict")

    # lfrenderer --densify

    def small_path(self, resolution="[80, 60]"):
        path = self.write_path(aperture=0.04, frames=2)
        path.write_text(path.read_text().replace("[160, 120]", resolution))
        return path

    def call_of_film(self, path, *options, field=None, out=None):
        return [RENDERER, field or self.field, path, "-o", out or self.folder / "film", "--no-contact-sheet", *options]

    @staticmethod
    def frames_of(out):
        return [frame.read_bytes() for frame in sorted(out.glob("frame_*.exr"))]

    def test_lfrenderer_makes_the_store_that_lfdensify_makes_and_keeps_it(self):
        self.synth()
        path, film, other = self.small_path(), self.folder / "film", self.folder / "other"
        self.succeeds(*self.call_of_film(path, "--densify"))
        self.succeeds(DENSIFY, self.field, path, "-o", self.store)
        self.assertEqual(contents(film / "densified.lfs"), contents(self.store))
        self.succeeds(*self.call_of_film(path, field=self.store, out=other))
        self.assertEqual(len(self.frames_of(film)), 2)
        self.assertEqual(self.frames_of(film), self.frames_of(other))
        before = (film / "densified.lfs").stat()
        self.succeeds(*self.call_of_film(path, "--densify", "--filter", "bicubic"))
        self.assertNotEqual(self.frames_of(film), self.frames_of(other))
        self.assertEqual((film / "densified.lfs").stat(), before)
        path.write_text(path.read_text().replace("[80, 60]", "[60, 45]"))
        self.fails(3, ["densified.lfs", "--overwrite"], *self.call_of_film(path, "--densify"))
        self.succeeds(*self.call_of_film(path, "--densify", "--overwrite"))
        self.assertNotEqual(contents(film / "densified.lfs"), contents(self.store))

    def test_lfrenderer_resumes_a_store_that_was_interrupted(self):
        self.synth()
        path, film = self.small_path(), self.folder / "film"
        unfinished = film / "densified.lfs.unfinished"
        call = [str(word) for word in self.call_of_film(path, "--densify", "--threads", 1)]
        process = subprocess.Popen(call, stderr=subprocess.PIPE, text=True)
        wait_until(unfinished.exists, process)
        process.send_signal(signal.SIGINT)
        last = process.communicate()[1].splitlines()[-1]
        self.assertEqual(process.returncode, 5)
        self.assertTrue(last.endswith("--densify --threads 1 --resume"), last)
        self.assertEqual(self.frames_of(film), [])
        self.fails(2, ["densified.lfs", "--resume"], *call)
        self.succeeds(*call, "--resume")
        self.succeeds(DENSIFY, self.field, path, "-o", self.store)
        self.assertEqual(contents(film / "densified.lfs"), contents(self.store))
        self.assertEqual(len(self.frames_of(film)), 2)

    def test_lfrenderer_renders_a_dense_light_field_as_it_is(self):
        self.synth()
        path, film, other = self.small_path("[16, 12]"), self.folder / "film", self.folder / "other"
        result = self.call(*self.call_of_film(path, "--densify"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("makes no virtual LF images", result.stderr)
        self.succeeds(*self.call_of_film(path, out=other))
        self.assertEqual(self.frames_of(film), self.frames_of(other))
        self.assertFalse((film / "densified.lfs").exists())

    def test_lfrenderer_names_broken_lf_images_that_it_left_out(self):
        self.synth()
        broken = next(self.field.rglob("*.exr"))
        broken.write_bytes(broken.read_bytes()[:100])
        call = self.call_of_film(self.small_path(), "--densify")
        self.fails(6, [broken.name, "render again with --overwrite"], *call)
        self.assertEqual(len(self.frames_of(self.folder / "film")), 2)
        self.succeeds(*call, "--allow-missing", 1)
        self.fails(3, [broken.name], *call, "--overwrite", "--strict")

    def test_lfrenderer_refuses_what_it_cannot_densify_or_render_before_any_work(self):
        self.synth()
        path = self.small_path()
        for words, options in ((["--shard", "lfdensify"], ["--shard", "1/2"]),
                               (["--mode rebin", "--no-guard"], ["--mode", "rebin", "--interpolation", "cells"]),
                               (["samples>=N", "--no-guard"], ["--no-guard", "--stop-when", "samples>=1"])):
            self.fails(2, words, *self.call_of_film(path, "--densify", *options))
        self.fails(2, ["--densify", "lfdensify"], RENDERER, "a.lfp", "-o", self.folder / "film", "--densify")
        self.assertFalse((self.folder / "film").exists())
        self.densify()
        self.fails(2, ["virtual LF images already"], *self.call_of_film(path, "--densify", field=self.store))

    # Refusals

    def rewrite(self, change):
        text, _ = self.cameras()
        change(text["frames"])
        (self.field / "transforms.json").write_text(json.dumps(text))

    def test_wrong_poses_are_refused(self):
        self.synth()

        def exchange(frames):
            names = [frame["file_path"] for frame in frames]
            for frame, name in zip(frames, np.random.default_rng(1).permutation(names)):
                frame["file_path"] = str(name)
        self.rewrite(exchange)
        self.fails(3, ["left out"], DENSIFY, self.field, "-o", self.store, "--depths", 0.35, 20)
        self.assertFalse(self.store.exists())

    def fold(self):
        """Makes half of the cameras see another side of the world."""
        self.synth("--format", "png")
        frames = self.cameras()[0]["frames"]
        # They see it turned upside down: what the opposite camera sees, turned.
        places = [(row, column) for row in range(4) for column in range(row % 2, 4, 2)]
        pictures = {place: cv2.imread(str(self.field / frames[15 - 4 * place[0] - place[1]]["file_path"]))
                    for place in places}
        for (row, column), picture in pictures.items():
            cv2.imwrite(str(self.field / frames[4 * row + column]["file_path"]), picture[::-1, ::-1])

    def test_two_sides_that_were_put_at_the_same_places_are_told_apart(self):
        self.fold()
        self.fails(3, ["contradict each other", "group 1 has 8", "group 2 has 8", "--exclude"],
                   DENSIFY, self.field, "-o", self.store, "--depths", 0.35, 20)
        self.assertFalse(self.store.exists())

    def test_a_film_of_one_side_leaves_out_the_other(self):
        self.fold()
        frames = self.cameras()[0]["frames"]
        for camera, is_even in ((5, True), (6, False)):
            path = self.write_path(aperture=0.03, camera=camera)
            result = self.call(DENSIFY, self.field, path, "-o", self.store, "--depths", 0.35, 20, "--json",
                               "--overwrite", "--most", 30, "--cache", "none")
            self.assertEqual(result.returncode, 0, result.stderr)
            report = json.loads(result.stdout)
            left_out = [frame["file_path"] for i, frame in enumerate(frames) if (i + i // 4) % 2 == is_even]
            self.assertEqual(report["left_out"], left_out)
            self.assertEqual(report["recorded"], 8)
            self.assertGreater(report["kept_share"], 2 / 3)
            self.assertIn("8 LF images are left out", result.stderr)
            self.assertIn(f"lfimport {self.field} -o group_", result.stderr)
        self.fails(3, ["contradict each other", "group 1 has 8", "group 2 has 8"],
                   DENSIFY, self.field, self.write_path(), "-o", self.store, "--depths", 0.35, 20, "--overwrite")

    def test_cameras_on_a_line_are_refused(self):
        self.synth()
        self.rewrite(lambda frames: frames.__delitem__(slice(4, None)))
        self.fails(3, ["one line"], DENSIFY, self.field, "-o", self.store)

    def test_lf_images_too_far_apart_are_refused(self):
        self.synth()
        self.fails(3, ["--force"], DENSIFY, self.field, "-o", self.store, "--depths", 0.03, 20)

    def test_a_dense_light_field_is_refused(self):
        self.synth()
        self.fails(3, ["render the light field as it is"], DENSIFY, self.field, "-o", self.store, "--spacing", 16)

    def test_a_densified_light_field_is_refused(self):
        self.synth()
        self.densify()
        self.fails(2, ["virtual LF images already"], DENSIFY, self.store, "-o", self.folder / "b.lfs")

    def test_an_existing_store_is_only_replaced_if_the_user_says_so(self):
        self.synth()
        self.densify()
        before = contents(self.store)
        self.fails(2, ["exists already", "--overwrite"], DENSIFY, self.field, "-o", self.store)
        self.assertEqual(contents(self.store), before)
        self.densify("--overwrite")
        self.assertEqual(contents(self.store), before)

    def test_wrong_options_are_usage_errors(self):
        self.synth()
        for words, options in ((["--depths", "nearest"], ["--depths", 3, 1]), ([".lfs"], ["-o", "dense.txt"]),
                               (["--divisor"], ["--divisor", 0])):
            output = [] if "-o" in options else ["-o", self.store]
            self.fails(2, words, DENSIFY, self.field, *output, *options)


if __name__ == "__main__":
    DENSIFY, SYNTH, RENDERER, COMPRESSOR = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1])
