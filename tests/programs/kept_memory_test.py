#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the memory of lfrenderer --mode rebin and hybrid: it never exceeds --memory and is not much less where kept
pixels fill it, messages name a memory that suffices at once, and so do forecasts.

usage: kept_memory_test.py LFRENDERER LFPREPROCESSOR
"""
import json
import re
import sys
import unittest

import numpy as np

import small_field
from bounded_runs import Run
from PIL import Image
from program_test_case import ProgramTestCase

RENDERER = PREPROCESSOR = None
SIZE, SIDE = (480, 320), 9  # 12.4 million pixels: 124 MB if all are kept
MIB = 1 << 20


class KeptMemoryTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        (small_field.WIDTH, small_field.HEIGHT), small_field.SIDE = SIZE, SIDE
        rng = np.random.default_rng(1)
        picture = rng.integers(0, 256, (SIZE[1], SIZE[0], 3), dtype=np.uint8)
        self.field = small_field.write_field(self.folder / "field", lambda index: np.roll(picture, index, 1),
                                             fl_x=500, fl_y=500)

    def path(self, size=(80, 60), **keys):
        path = small_field.write_path(self.folder, **keys)
        path.write_text(path.read_text().replace("[80, 60]", str(list(size))))

    def run_renderer(self, *options, out="out"):
        return Run("render", [RENDERER, self.field, self.folder / "path.yaml", "-o", self.folder / out, "--overwrite",
                              "--no-contact-sheet", "--threads", 2, *options], self.folder, {})

    def least_mib(self, *options):
        """Returns the memory that the message for one that is too small names."""
        refused = self.run_renderer(*options, "--memory", "1M")
        self.assertEqual(refused.code, 4, refused.errors)
        found = re.search(r"give --memory (\d+)M", refused.errors)
        self.assertTrue(found, refused.errors)
        self.assertNotIn("--max-rays", refused.errors)
        return int(found[1])

    def render_with_least(self, *options):
        """Renders with the memory that a message names. Returns its part that was used."""
        least = self.least_mib(*options)
        rendered = self.run_renderer(*options, "--memory", f"{least}M")
        self.assertEqual(rendered.code, 0, rendered.errors)
        self.assertLessEqual(rendered.peak_mib, least, options)
        refused = self.run_renderer(*options, "--memory", f"{least - 1}M")
        self.assertEqual(refused.code, 4, refused.errors)
        return rendered.peak_mib / least

    def test_the_memory_that_is_named_suffices_at_once(self):
        for size in ((80, 60), (1600, 1200)):
            self.path(size, frames=2, aperture=0.02)
            for options in (["--mode", "rebin"], ["--mode", "hybrid"],
                            ["--mode", "hybrid", "--lens-weights", "none"]):
                with self.subTest(size=size, options=options):
                    self.render_with_least(*options)

    def test_kept_pixels_fill_their_memory_and_no_more(self):
        self.path(frames=1, aperture=0.2)
        for options, least_part in ((["--kept", "all", "--max-rays", "12500000"], 0.65),
                                    (["--kept", "edges", "--xi", "1", "--max-rays", "6M"], 0.5),
                                    (["--kept", "edges", "--xi", "0.7", "--max-rays", "12M"], 0.5)):
            with self.subTest(options=options):
                self.assertGreater(self.render_with_least("--mode", "rebin", *options), least_part)

    def test_masks_are_within_the_memory(self):
        rng = np.random.default_rng(2)
        calibration = json.loads(self.field.read_text())
        (self.field.parent / "masks").mkdir()
        for index, frame in enumerate(calibration["frames"]):
            mask = np.where(rng.random((SIZE[1], SIZE[0])) < 0.5, 255, 0).astype(np.uint8)
            name = f"masks/{index}.png"
            Image.fromarray(mask).save(self.field.parent / name)
            frame["mask_path"] = name
        self.field.write_text(json.dumps(calibration))
        self.path(frames=1, aperture=0.2)
        self.render_with_least("--mode", "rebin", "--kept", "edges", "--xi", "1", "--max-rays", "5M")

    def test_the_forecast_suffices(self):
        for size in ((80, 60), (1280, 960)):
            self.path(size, frames=2, aperture=0.02)
            for mode in ("rebin", "hybrid"):
                with self.subTest(size=size, mode=mode):
                    plan = self.succeeds(PREPROCESSOR, self.field, self.folder / "path.yaml", "--plan", "--packages",
                                         "1", "--json", "-q", "--mode", mode, "--threads", "2")
                    forecast = json.loads(plan)["packages"][0]["memory_bytes"]
                    rendered = self.run_renderer("--mode", mode, "--memory", f"{forecast // MIB}M")
                    self.assertEqual(rendered.code, 0, rendered.errors)
                    self.assertLessEqual(rendered.peak_mib, forecast / MIB)

    # The number of kept pixels follows from --memory, and is none of the options that were given.
    def test_resuming_with_another_memory_names_the_number_of_rays(self):
        self.path(frames=2, aperture=0.02)
        options = ["--mode", "rebin", "--frames", "1"]
        call = [RENDERER, self.field, self.folder / "path.yaml", "-o", self.folder / "out", "--no-contact-sheet"]
        self.succeeds(*call, *options, "--memory", "300M")
        frame = (self.folder / "out/frame_0001.exr").read_bytes()
        refused = self.call(*call, *options, "--memory", "400M", "--resume")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        count = re.search(r"give --max-rays (\d+)", refused.stderr)[1]
        self.succeeds(*call, *options, "--memory", "400M", "--resume", "--max-rays", count)
        self.assertEqual((self.folder / "out/frame_0001.exr").read_bytes(), frame)


if __name__ == "__main__":
    RENDERER, PREPROCESSOR = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
