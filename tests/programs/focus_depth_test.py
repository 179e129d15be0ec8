#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lffocus depth and lffocus sharp: depths of known scenes, sharp pictures against true ones, all file formats.

usage: focus_depth_test.py LFFOCUS LFSYNTH LFDENSIFY
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from exr_file import attributes_of, channels_of
from program_test_case import ProgramTestCase

FOCUS = SYNTH = DENSIFY = None
GROUNDTRUTH = pathlib.Path(os.environ.get("LF_TEST_DATA", "../shared")) / "groundtruth"
NEAR, FAR = 0.5, 2
PATH = """format: lfpath 1
fps: 25
frames: 1
resolution: [240, 160]
camera: {{field_of_view_deg: 50, position: [0.0012, 0.0007, -1], look_at: [0, 0, 0]}}
lens: {{aperture_diameter: {diameter}, focus_distance: 1}}
"""
GROUNDTRUTH_PATH = """format: lfpath 1
fps: 25
frames: 1
resolution: [280, 210]
camera: {{field_of_view_deg: {fov_x_deg}, position: {position}, look_at: {target}, up: {up}}}
lens: {{aperture_diameter: 0.008, focus_distance: 0.5}}
"""


def rgb(channels):
    return np.clip(np.stack([channels[c] for c in "RGB"], -1).astype(float), 0, 1)


def psnr_db(a, b):
    return -10 * np.log10(np.mean((a - b) ** 2))


def read_pfm(file):
    with open(file, "rb") as opened:
        kind, size, scale = (opened.readline().decode().strip() for _ in range(3))
        width, height = map(int, size.split())
        values = np.frombuffer(opened.read(), "<f4" if float(scale) < 0 else ">f4")
        return kind, values.reshape(height, width)[::-1]


def read_ply(file):
    data = file.read_bytes()
    header, points = data.split(b"end_header\n", 1)
    count = int(header.split(b"element vertex ")[1].split()[0])
    record = np.dtype([("xyz", "<f4", 3), ("rgb", "u1", 3), ("confidence", "<f4")])
    assert len(points) == count * record.itemsize
    return np.frombuffer(points, record)


def widened(mask, by):
    """Returns the elements that are at most `by` elements away, across or down, from one of the mask."""
    padded = np.pad(mask, by)
    height, width = mask.shape
    return np.any([padded[j:j + height, i:i + width] for j in range(2 * by + 1) for i in range(2 * by + 1)], axis=0)


class FocusDepthTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.shared = pathlib.Path(temporary.name)
        cls.path, pinhole = cls.shared / "path.yaml", cls.shared / "pinhole.yaml"
        cls.path.write_text(PATH.format(diameter=0.04))
        pinhole.write_text(PATH.format(diameter=0))
        cls.field = cls.shared / "chart"
        subprocess.run([SYNTH, "chart", "-o", cls.field, "--count", "169", "--size", "240x160", "--spacing", "0.004",
                        "--format", "png", "--truth", pinhole, "-q"], check=True)
        cls.truth = channels_of(cls.field / "truth/frame_0001.exr")

    def depth(self, *files, code=0, field=None, options=()):
        outputs = [word for file in files for word in ("-o", self.folder / file)]
        return self.succeeds(FOCUS, "depth", field or self.field, self.path, *outputs, "--near", NEAR, "--far", FAR,
                             *options, code=code)

    def sharp(self, file):
        self.succeeds(FOCUS, "sharp", self.field, self.path, "-o", self.folder / file, "--near", NEAR, "--far", FAR)

    def planes_off(self, depths, planes):
        """Returns by how many of the tested distances the depths are wrong; beyond any for surfaces that do not
        exist."""
        step = (1 / NEAR - 1 / FAR) / (planes - 1)
        return np.abs(1 / depths - 1 / self.truth["Z"]) / step

    def test_depths_are_true_where_they_are_known(self):
        report = json.loads(self.depth("depth.exr", options=["--json"]))
        channels = channels_of(self.folder / "depth.exr")
        depths, truth = channels["Z"], self.truth["Z"]
        is_known, is_surface = np.isfinite(depths), np.isfinite(truth)
        self.assertAlmostEqual(report["known_share"], is_known.mean(), 6)
        self.assertGreater(is_known[is_surface].mean(), 0.6)
        off = self.planes_off(depths, report["planes"])
        self.assertLess(np.median(off[is_known]), 0.25)
        self.assertLess((off[is_known] > 2).mean(), 0.02)
        self.assertFalse(is_known[~widened(is_surface, 3)].any(), "the flat background has a depth")
        self.assertTrue((channels["confidence"][is_known] >= 0.499).all())
        self.assertIn("worldToCamera", attributes_of(self.folder / "depth.exr"))

    def test_clean_depths_are_more_and_true(self):
        self.depth("depth.exr")
        report = json.loads(self.depth("clean.exr", options=["--clean", "--json"]))
        found, clean = (channels_of(self.folder / f"{name}.exr") for name in ("depth", "clean"))
        is_known, is_surface = np.isfinite(clean["Z"]), np.isfinite(self.truth["Z"])
        was_known = np.isfinite(found["Z"])
        self.assertTrue(is_known[was_known].all())
        self.assertGreater(is_known[is_surface].mean(), was_known[is_surface].mean() + 0.03)
        off = self.planes_off(clean["Z"], report["planes"])
        self.assertLess(np.median(off[is_known]), 0.25)
        self.assertLess((off[is_known] > 2).mean(), 0.02)
        self.assertFalse(is_known[~widened(is_surface, 3)].any(), "the flat background has a depth")
        self.assertTrue((clean["confidence"][is_known] >= 0.499).all())

    def test_threads_and_memory_change_no_bit(self):
        self.depth("one.exr", options=["--threads", 1, "--clean"])
        self.depth("three.exr", options=["--threads", 3, "--memory", "8M", "--clean"])
        self.assertEqual((self.folder / "one.exr").read_bytes(), (self.folder / "three.exr").read_bytes())

    def test_all_files_tell_the_same(self):
        self.depth("depth.exr", "depth.pfm", "points.ply", "depth.png")
        channels = channels_of(self.folder / "depth.exr")
        kind, depths = read_pfm(self.folder / "depth.pfm")
        self.assertEqual(kind, "Pf")
        self.assertEqual(depths.tobytes(), channels["Z"].tobytes())
        is_known = np.isfinite(depths)
        points = read_ply(self.folder / "points.ply")
        self.assertEqual(len(points), is_known.sum())
        # The camera looks almost along z, from z = -1.
        focal = 120 / np.tan(np.radians(25))
        y, x = np.nonzero(is_known)
        self.assertLess(np.abs(points["xyz"][:, 2] + 1 - depths[is_known]).max(), 0.01)
        self.assertLess(np.abs(points["xyz"][:, 0] - (x + 0.5 - 120) / focal * depths[is_known]).max(), 0.01)
        linear = rgb(channels)[is_known]
        display = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055) * 255
        self.assertLess(np.abs(points["rgb"] - display).max(), 1.1)

    def test_filled_depths_keep_the_known_ones(self):
        self.depth("depth.pfm")
        self.depth("filled.pfm", options=["--fill"])
        depths, filled = (read_pfm(self.folder / f"{name}.pfm")[1] for name in ("depth", "filled"))
        self.assertTrue(np.isfinite(filled).all() and (filled > 0).all())
        self.assertTrue(np.array_equal(filled[np.isfinite(depths)], depths[np.isfinite(depths)]))

    def test_the_sharp_picture_is_that_of_depth(self):
        self.sharp("sharp.exr")
        self.depth("depth.exr")
        sharp, depth = (channels_of(self.folder / f"{name}.exr") for name in ("sharp", "depth"))
        self.assertEqual(sharp["G"].tobytes(), depth["G"].tobytes())
        self.sharp("sharp.png")
        self.assertTrue((self.folder / "sharp.png").read_bytes().startswith(b"\x89PNG"))

    def test_the_sharp_picture_is_that_of_a_pinhole(self):
        if not GROUNDTRUTH.is_dir():
            self.skipTest(f"{GROUNDTRUTH} is missing")
        cases = json.loads((GROUNDTRUTH / "cases.json").read_text())
        cases = cases["cases"] if isinstance(cases, dict) else cases
        case = next(one for one in cases if one["name"] == "planar_pinhole_between")
        pose = np.array(case["transform_matrix"])
        path = self.folder / "path.yaml"
        path.write_text(GROUNDTRUTH_PATH.format(fov_x_deg=case["fov_x_deg"], position=pose[:3, 3].tolist(),
                                                target=(pose[:3, 3] - pose[:3, 2]).tolist(),
                                                up=pose[:3, 1].tolist()))
        self.succeeds(FOCUS, "sharp", GROUNDTRUTH / "data/planar", path, "-o", self.folder / "sharp.exr")
        with open(GROUNDTRUTH / case["linear"], "rb") as opened:
            _, size, _ = (opened.readline() for _ in range(3))
            width, height = map(int, size.split())
            truth = np.frombuffer(opened.read(), "<f4").reshape(height, width, 3)[::-1]
        found = rgb(channels_of(self.folder / "sharp.exr"))
        self.assertGreater(psnr_db(found, np.clip(truth, 0, 1)), 35)

    def test_the_depths_of_a_densified_store_are_more_and_true_where_lf_cameras_are_far_apart(self):
        field, store, path = (self.folder / name for name in ("sparse", "dense.lfs", "path.yaml"))
        path.write_text(PATH.format(diameter=0.06))
        self.succeeds(SYNTH, "chart", "-o", field, "--count", 25, "--size", "240x160", "--spacing", 0.03, "-q")
        self.succeeds(DENSIFY, field, path, "-o", store, "--most", 20, "--depths", NEAR, FAR, "-q")
        step = 0.5 / (120 / np.tan(np.radians(25)) * 0.03)  # half an element at the rim of the lens
        is_surface, right = np.isfinite(self.truth["Z"]), {}
        for name, options in (("sweep", ["--near", NEAR, "--far", FAR]), ("store", ["--from", "store"])):
            result = self.call(FOCUS, "depth", store, path, "-o", self.folder / f"{name}.exr", "--json", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(json.loads(result.stdout)["from"], name)
            self.assertEqual("has the depths of 12 LF images" in result.stderr, name == "store", result.stderr)
            depths = channels_of(self.folder / f"{name}.exr")["Z"]
            off = np.abs(1 / depths - 1 / self.truth["Z"]) / step
            right[name] = (off[is_surface] <= 2).mean()
        self.assertGreater(right["store"], 0.95)
        self.assertGreater(right["store"], right["sweep"] + 0.1)
        self.depth_bits_of_threads(store, path)

    def depth_bits_of_threads(self, store, path):
        """Checks that depths of a store and their picture have the same bits for any number of threads."""
        for threads in (1, 3):
            self.succeeds(FOCUS, "depth", store, path, "-o", self.folder / f"{threads}.exr", "--from", "store",
                          "--threads", threads)
        self.assertEqual((self.folder / "1.exr").read_bytes(), (self.folder / "3.exr").read_bytes())

    def test_depths_are_only_taken_from_densified_stores(self):
        for words, options in ((["--from store", "densified store"], []), (["leave out", "--near"], ["--near", 0.5])):
            self.fails(2, words, FOCUS, "depth", self.field, self.path, "-o", self.folder / "d.exr", "--from", "store",
                       *options)

    # Errors

    def test_wrong_calls_are_refused(self):
        for words, arguments in ((["depth.tif", ".exr, .pfm, .ply or .png"], ["-o", "depth.tif"]),
                                 (["--window 4", "odd"], ["-o", "d.exr", "--window", 4]),
                                 (["the nearest below the farthest"], ["-o", "d.exr", "--near", 2, "--far", 1]),
                                 (["--frame 2", "1 frame"], ["-o", "d.exr", "--frame", 2])):
            with self.subTest(words):
                self.fails(2, words, FOCUS, "depth", self.field, self.path, *arguments)
        self.fails(2, ["sharp.tif", ".exr or .png"], FOCUS, "sharp", self.field, self.path, "-o", "sharp.tif")

    def test_a_file_that_exists_is_kept(self):
        self.depth("depth.pfm")
        before = (self.folder / "depth.pfm").read_bytes()
        arguments = [self.field, self.path, "-o", self.folder / "depth.pfm", "--near", NEAR, "--far", 1.5]
        self.fails(2, ["depth.pfm: exists already", "--overwrite"], FOCUS, "depth", *arguments)
        self.assertEqual((self.folder / "depth.pfm").read_bytes(), before)
        self.succeeds(FOCUS, "depth", *arguments, "--overwrite")
        self.assertNotEqual((self.folder / "depth.pfm").read_bytes(), before)

    def test_inputs_are_never_replaced(self):
        image = self.field / json.loads((self.field / "transforms.json").read_text())["frames"][0]["file_path"]
        before = image.read_bytes()
        for command in ("depth", "sharp"):
            self.fails(2, [image.name, "input"], FOCUS, command, self.field, self.path, "-o", image, "--near", NEAR,
                       "--far", FAR, "--overwrite")
        self.assertEqual(image.read_bytes(), before)

    def test_the_picture_in_the_lens_is_an_input(self):
        picture = self.folder / "heart.png"
        picture.write_bytes((self.field / "images/0000.png").read_bytes())
        path = self.folder / "path.yaml"
        path.write_text(self.path.read_text().replace("focus_distance", "transmission: heart.png, focus_distance"))
        for output in (picture, path):
            before = output.read_bytes()
            renamed = output if output == picture else self.folder / "linked.png"
            if renamed != output:
                renamed.symlink_to(output)
            for words in (["depth", "-o", renamed], ["sharp", "-o", renamed]):
                self.fails(2, ["input"], FOCUS, words[0], self.field, path, *words[1:], "--near", NEAR, "--far", FAR,
                           "--overwrite")
            self.assertEqual(output.read_bytes(), before)

    def test_a_map_without_any_depth_is_an_error(self):
        beyond = ["--near", 100, "--far", 200]
        self.fails(6, ["no element has a depth", f"0 of {240 * 160}", "--confidence"], FOCUS, "depth", self.field,
                   self.path, "-o", self.folder / "a.pfm", *beyond)
        self.assertFalse(np.isfinite(read_pfm(self.folder / "a.pfm")[1]).any())
        self.fails(6, ["no element has a depth"], FOCUS, "sharp", self.field, self.path, "-o", self.folder / "a.png",
                   *beyond)
        self.assertTrue((self.folder / "a.png").exists())

    def test_a_pinhole_has_the_depths_of_a_wider_lens(self):
        path = self.folder / "path.yaml"
        path.write_text(PATH.format(diameter=0))
        result = self.call(FOCUS, "depth", self.field, path, "-o", self.folder / "a.pfm", "--near", NEAR, "--far", FAR)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("the lens has a diameter of 0 world units and 0 LF cameras: for the depths it is widened",
                      result.stderr)
        self.assertNotIn("warning", result.stderr)
        self.assertTrue(np.isfinite(read_pfm(self.folder / "a.pfm")[1]).any())

    def test_lf_cameras_that_are_far_apart_are_warned_of_before_the_work(self):
        # Each sixth LF camera, across and down: nine of them.
        field = self.folder / "field"
        field.mkdir()
        (field / "images").symlink_to(self.field / "images")
        calibration = json.loads((self.field / "transforms.json").read_text())
        frames = calibration["frames"]
        calibration["frames"] = [frames[13 * y + x] for y in (0, 6, 12) for x in (0, 6, 12)]
        (field / "transforms.json").write_text(json.dumps(calibration))
        path = self.folder / "path.yaml"
        path.write_text(PATH.format(diameter=0).replace("240, 160", "960, 640"))
        result = self.call(FOCUS, "depth", field, path, "-o", self.folder / "a.pfm", "--near", 0.1, "--far", FAR,
                           "--planes", 60, "--threads", 1, "--progress", "plain")
        self.assertIn(result.returncode, (0, 6), result.stderr)
        apart, coarse = result.stderr.find("far apart"), result.stderr.find("60 distances are tested")
        self.assertTrue(0 < apart < coarse < result.stderr.find("LF images compared"), result.stderr)
        self.assertIn("are needed, 1024 are possible", result.stderr)

    def test_a_broken_lf_image_is_left_out_and_told(self):
        field = self.folder / "field"
        field.mkdir()
        (field / "images").symlink_to(self.field / "images")
        calibration = json.loads((self.field / "transforms.json").read_text())
        middle = calibration["frames"][len(calibration["frames"]) // 2]
        broken = self.folder / "broken.png"
        broken.write_bytes((self.field / middle["file_path"]).read_bytes()[:2000])
        middle["file_path"] = str(broken)
        (field / "transforms.json").write_text(json.dumps(calibration))
        arguments = [field, self.path, "--near", NEAR, "--far", FAR]
        self.fails(6, ["1 of", "left out", "broken.png"], FOCUS, "depth", *arguments, "-o", self.folder / "a.pfm")
        self.assertTrue(np.isfinite(read_pfm(self.folder / "a.pfm")[1]).any())
        self.succeeds(FOCUS, "depth", *arguments, "-o", self.folder / "b.pfm", "--allow-missing", 1)
        self.fails(3, ["broken.png"], FOCUS, "depth", *arguments, "-o", self.folder / "c.pfm", "--strict")
        self.assertFalse((self.folder / "c.pfm").exists())

    def test_too_little_memory_is_refused(self):
        self.fails(4, ["--memory 1 KiB", "16 rows", "at least"], FOCUS, "depth", self.field, self.path, "-o",
                   self.folder / "a.pfm", "--near", NEAR, "--far", FAR, "--memory", "1K")

    def test_lf_images_that_hide_the_depths_are_named(self):
        field = self.folder / "field"
        field.mkdir()
        content = (self.field / "transforms.json").read_text()
        (field / "transforms.json").write_text(content)
        (field / "images").mkdir()
        self.fails(3, ["depths of the scene", ".png", "--near and --far"], FOCUS, "depth", field, self.path, "-o",
                   self.folder / "a.pfm")

    def test_a_missing_folder_is_named(self):
        self.fails(4, [f"{self.folder}/none/a.pfm", "the folder", "does not exist"], FOCUS, "depth", self.field,
                   self.path, "-o", self.folder / "none/a.pfm", "--near", NEAR, "--far", FAR, "--planes", 2)

    def test_interrupted_it_writes_nothing(self):
        output = self.folder / "depth.exr"
        process = subprocess.Popen([FOCUS, "depth", self.field, self.path, "-o", output, "--near", str(NEAR), "--far",
                                    str(FAR), "--planes", "1000", "--progress", "json"], stderr=subprocess.PIPE)
        process.stderr.readline()  # the work has begun
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.assertEqual(process.returncode, 5)
        self.assertEqual(list(self.folder.glob("depth*")), [])


if __name__ == "__main__":
    FOCUS, SYNTH, DENSIFY = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
