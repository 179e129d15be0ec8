#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfrenderer from a user's view: input and output files, exit codes, last lines.

usage: lfrenderer_test.py LFRENDERER
"""
import hashlib
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image

from program_test_case import wait_until
from small_field import HEIGHT, WIDTH, write_field, write_path

RENDERER = None


class RendererTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def run_renderer(self, *arguments):
        return subprocess.run([RENDERER, *map(str, arguments)], capture_output=True, text=True,
                              timeout=400)

    def render(self, field, path, name, *options, code=0):
        """Returns the frames' digests and the report of a run that must end with this exit code."""
        out = self.folder / name
        result = self.run_renderer(field, path, "-o", out, "--format", "exr-float", *options)
        self.assertEqual(result.returncode, code, result.stderr)
        digests = [hashlib.sha256(frame.read_bytes()).hexdigest()
                   for frame in sorted(out.glob("frame_*.exr"))]
        return digests, json.loads((out / "report.json").read_text())

    def fails(self, code, words, *arguments):
        result = self.run_renderer(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        last = result.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("error: "), last)
        for word in words:
            self.assertIn(word, last)

    # Results

    def test_writes_frames_a_contact_sheet_and_a_report(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        digests, report = self.render(field, path, "out")
        self.assertEqual(len(digests), 3)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()),
                         ["contact_sheet.png", "frame_0001.exr", "frame_0002.exr",
                          "frame_0003.exr", "report.json"])
        self.assertEqual([frame["frame"] for frame in report["frames"]], [1, 2, 3])
        for frame in report["frames"]:
            self.assertGreater(frame["rays_accepted"], 10000)
            self.assertGreater(frame["rays_tested"], 10000)
        self.assertEqual(report["skipped_lf_images"], [])

    def test_writes_png_and_a_video(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        out = self.folder / "out"
        result = self.run_renderer(field, path, "-o", out, "--format", "png16", "--frames", "1-3x2",
                                   "--video", out / "film.mp4")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((out / "film.mp4").stat().st_size > 500)
        with Image.open(out / "frame_0003.png") as frame:
            self.assertEqual(frame.size, (80, 60))
        self.assertFalse((out / "frame_0002.png").exists())

    def least_memory(self, field, path):
        """Returns options for the least memory that the renderer says it needs: a few plates at a time."""
        few = self.run_renderer(field, path, "-o", self.folder / "few", "--threads", "2", "--memory", "2M")
        return ["--threads", "2", "--memory",
                re.search(r"at least (\d+) MiB", few.stderr).group(1) + "M"]

    def test_the_same_bits_for_any_threads_memory_and_order(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder, frames=12)
        expected, report = self.render(field, path, "out", "--threads", "1")
        self.assertEqual(report["passes"], 1)
        for index, options in enumerate([["--threads", "2"], ["--threads", "3"], ["--seed", "5"]]):
            digests, _ = self.render(field, path, f"out{index}", *options)
            self.assertEqual(digests, expected, options)
        digests, report = self.render(field, path, "small", *self.least_memory(field, path))
        self.assertGreater(report["passes"], 1)
        self.assertEqual(digests, expected)

    def test_weighed_frames_have_the_same_bits_for_any_threads_memory_and_order(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder, frames=12)
        plain, _ = self.render(field, path, "plain", "--lens-weights", "none")
        for weights in ("area", "hat", "auto"):
            chosen = ["--lens-weights", weights]
            expected, report = self.render(field, path, weights, "--threads", "1", *chosen)
            self.assertNotEqual(expected, plain)
            self.assertGreater(report["frames"][0]["effective_lf_images"], 1)
            for index, options in enumerate([["--threads", "3"], ["--seed", "5"],
                                             self.least_memory(field, path)]):
                digests, _ = self.render(field, path, f"{weights}{index}", *chosen, *options)
                self.assertEqual(digests, expected, options)

    def test_mosaics_become_rgb_unless_they_are_sorted_by_pixels(self):
        flat = lambda index: np.full((HEIGHT, WIDTH), 120, np.uint8)
        field = write_field(self.folder / "mosaics", flat, lf_bayer="RGGB", lf_transfer="sRGB")
        path = write_path(self.folder)
        for options in ([], ["--estimator", "nearest"]):
            out = self.folder / ("out" + str(len(options)))
            result = self.run_renderer(field, path, "-o", out, "--format", "png", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            with Image.open(out / "frame_0001.png") as frame:
                middle = np.asarray(frame)[20:-20, 20:-20]
            self.assertTrue((np.abs(middle.astype(int) - 120) <= 1).all())
        inputs = json.loads((self.folder / "out0" / "report.json").read_text())["inputs"]
        self.assertEqual((inputs["estimator"], inputs["filter"]), ("bilinear", "mosaic"))

    def test_frames_of_mosaics_have_the_same_bits_for_any_threads_memory_and_order(self):
        picture = lambda index: np.random.default_rng(index).integers(0, 256, (HEIGHT, WIDTH), np.uint8)
        field = write_field(self.folder / "mosaics", picture, lf_bayer="GBRG", lf_transfer="sRGB")
        path = write_path(self.folder, frames=12)
        expected, _ = self.render(field, path, "out", "--threads", "1")
        for index, options in enumerate([["--threads", "3"], ["--seed", "5"],
                                         self.least_memory(field, path)]):
            digests, _ = self.render(field, path, f"out{index}", *options)
            self.assertEqual(digests, expected, options)
        bilinear, _ = self.render(field, path, "bilinear", "--filter", "bilinear")
        self.assertNotEqual(bilinear, expected)

    def test_rays_of_mosaics_are_counted(self):
        flat = lambda index: np.full((HEIGHT, WIDTH), 120, np.uint8)
        field = write_field(self.folder / "mosaics", flat, lf_bayer="RGGB", lf_transfer="sRGB")
        path, rule = write_path(self.folder), ["--require", "samples>=1"]
        _, report = self.render(field, path, "counted", *rule)
        self.assertEqual(report["inputs"]["filter"], "mosaic")
        counted = report["frames"]
        _, report = self.render(field, path, "bilinear", "--filter", "bilinear", *rule)
        for key in ("rays_accepted", "rays_per_element_median", "samples"):
            self.assertEqual([frame[key] for frame in counted], [frame[key] for frame in report["frames"]])

    def test_auto_weights_say_what_they_are_and_warn(self):
        field = write_field(self.folder / "field")
        wide = self.run_renderer(field, write_path(self.folder), "-o", self.folder / "wide")
        self.assertIn("the area of the lens", wide.stderr)
        self.assertNotIn("two camera distances", wide.stderr)
        pinhole = self.run_renderer(field, write_path(self.folder, aperture=0), "-o",
                                    self.folder / "pinhole")
        self.assertIn("hat (interpolation between LF images), because the lenses are small", pinhole.stderr)
        self.assertNotIn("fewer than", pinhole.stderr)
        few = self.run_renderer(field, write_path(self.folder, aperture=0.016), "-o",
                                self.folder / "few")
        self.assertIn("fewer than 4 LF images", few.stderr)
        huge = self.run_renderer(field, write_path(self.folder, aperture=0.3), "-o",
                                 self.folder / "huge")
        self.assertIn("beyond the LF cameras", huge.stderr)
        counted = self.run_renderer(field, write_path(self.folder), "-o", self.folder / "counted",
                                    "--stop-when", "samples>=2")
        self.assertIn("auto means none", counted.stderr)

    def test_pinholes_have_hats_but_no_area(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder, aperture=0)
        self.fails(2, ["area", "pinhole", "hat"], field, path, "-o", self.folder / "area",
                   "--lens-weights", "area")
        digests, _ = self.render(field, path, "hat", "--lens-weights", "hat")
        self.assertEqual(len(digests), 3)
        self.fails(2, ["sums of weights"], field, path, "-o", self.folder / "counted",
                   "--lens-weights", "hat", "--stop-when", "samples>=4")

    def test_the_reference_collects_the_same_rays(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        _, fast = self.render(field, path, "fast")
        _, reference = self.render(field, path, "reference", "--back-end", "reference")
        for a, b in zip(fast["frames"], reference["frames"]):
            self.assertEqual(a["rays_accepted"], b["rays_accepted"])

    def test_black_stays_black_with_noise(self):
        # A raw sensor behind a lens cap: black level 1000, noise of both signs.
        def picture(index):
            noise = np.random.default_rng(index).normal(0, 60, (HEIGHT, WIDTH))
            return (1000 + np.round(noise)).astype(np.uint16)
        field = write_field(self.folder / "field", picture, lf_bayer="RGGB", lf_black_level=1000,
                            lf_white_level=16383)
        out = self.folder / "out"
        result = self.run_renderer(field, write_path(self.folder), "-o", out, "--format", "exr-float")
        self.assertEqual(result.returncode, 0, result.stderr)
        os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
        import cv2  # imported late, because it reads an environment variable when it is loaded
        frame = cv2.imread(str(out / "frame_0002.exr"), cv2.IMREAD_UNCHANGED)[..., :3]
        # Clipping at black would give a mean of 60 * 0.4 / 15383 = 1.6e-3.
        self.assertLess(abs(float(frame.mean())), 1e-4)
        self.assertLess(float(frame.min()), 0)

    # Faults that lfrenderer survives

    def test_a_broken_image_gives_the_bits_of_its_absence(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        description = json.loads(field.read_text())
        without = dict(description, frames=[f for i, f in enumerate(description["frames"]) if i != 12])
        absent = field.with_name("without.json")
        absent.write_text(json.dumps(without))
        # Without lens weights, because weights are planned as if the broken image could be read.
        alike = ["--lens-weights", "none"]
        expected, _ = self.render(absent, path, "absent", *alike)
        broken = self.folder / "field" / "image_12.png"
        broken.write_bytes(broken.read_bytes()[:900])
        out = self.folder / "broken"
        digests, report = self.render(field, path, "broken", *alike, code=6)
        self.assertEqual([s["name"] for s in report["skipped_lf_images"]], ["image_12.png"])
        self.assertEqual(digests, expected)
        self.fails(3, ["image_12.png"], field, path, "-o", out, "--strict")

    def test_all_images_broken_is_an_error(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        for image in field.parent.glob("*.png"):
            image.write_bytes(b"")
        # Also tested with a render slow enough to write a checkpoint, which is then useless.
        for index, options in enumerate([[], ["--dump-every", "0.001s", "--memory", "300M"]]):
            out = self.folder / f"out{index}"
            self.fails(3, ["every LF image", "image_"], field, path, "-o", out, *options)
            self.assertFalse(out.exists() and any(out.iterdir()), list(out.glob("*")))

    def test_a_broken_image_is_skipped_whatever_the_passes(self):
        field = write_field(self.folder / "field")
        (field.parent / "image_12.png").write_bytes(b"")
        path = write_path(self.folder, frames=12)
        for index, memory in enumerate([["--memory", "1G"], self.least_memory(field, path)]):
            _, report = self.render(field, path, f"out{index}", *memory, code=6)
            self.assertEqual(len(report["skipped_lf_images"]), 1)

    def test_an_interrupt_ends_it_with_code_5(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder, frames=2000)
        process = subprocess.Popen([RENDERER, field, path, "-o", self.folder / "out", "--back-end",
                                    "reference"], stderr=subprocess.PIPE, text=True)
        # The folder is created after the signal handlers are installed.
        wait_until((self.folder / "out").exists, process)
        process.send_signal(signal.SIGINT)
        _, words = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 5, words)
        self.assertIn("interrupted", words.strip().splitlines()[-1])

    # Refusals

    def test_usage_errors_name_the_option(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        out = self.folder / "out"
        self.fails(2, [], field, path)
        self.fails(2, [], field, "-o", out)
        self.fails(2, ["--mode"], field, path, "-o", out, "--mode", "magic")
        self.fails(2, ["--filter"], field, path, "-o", out, "--filter", "cubic")
        self.fails(2, ["--frames"], field, path, "-o", out, "--frames", "2-9")
        self.fails(2, ["--memory"], field, path, "-o", out, "--memory", "lots")

    def test_input_errors_name_the_file(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        out = self.folder / "out"
        self.fails(3, ["nothing.json"], self.folder / "nothing.json", path, "-o", out)
        self.fails(3, ["none.yaml"], field, self.folder / "none.yaml", "-o", out)
        path.write_text(path.read_text().replace("aperture_diameter", "apperture_diameter"))
        self.fails(3, ["path.yaml:12", "aperture_diameter"], field, path, "-o", out)
        self.fails(3, ["no LF image"], field, write_path(self.folder, aperture=0, x=0.004),
                   "-o", out, "--lens-weights", "none")

    def test_output_errors_name_the_place(self):
        field, path = write_field(self.folder / "field"), write_path(self.folder)
        (self.folder / "file").write_text("")
        self.fails(4, [str(self.folder / "file")], field, path, "-o", self.folder / "file" / "out")
        self.fails(4, ["--video", "nowhere"], field, path, "-o", self.folder / "out", "--video",
                   self.folder / "nowhere" / "film.mp4")
        self.assertFalse((self.folder / "out" / "frame_0001.exr").exists())
        with open("/dev/full", "w") as full:
            result = subprocess.run([RENDERER, field, path, "-o", self.folder / "out", "--json"],
                                    stdout=full, stderr=subprocess.DEVNULL)
        self.assertEqual(result.returncode, 4)
        self.fails(4, ["--memory", "at least"], field, path, "-o", self.folder / "out", "--memory",
                   "2M")


if __name__ == "__main__":
    RENDERER = sys.argv.pop(1)
    unittest.main()
