#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lenses that are shifted, squeezed or rounded: frames are those of true lenses, whatever makes them.

usage: lens_shapes_test.py LFSYNTH LFRENDERER LFPREPROCESSOR LFMERGE
"""
import os
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from still_life_case import StillLifeCase

SYNTH = RENDERER = PREPROCESSOR = MERGE = None
PATH = """format: lfpath 1
fps: 25
frames: 1
resolution: [160, 106]
camera:
  focal_length_mm: 50
  position: [0, -0.125, -0.799]
  look_at: [0, -0.085, 0]
  {camera}
lens:
  aperture_diameter: 0.04
  focus_distance: 0.62
  {lens}
"""
# Each lens, and a similar one that must give another picture.
LENSES = {
    "shift": (("shift_mm: {horizontal: 2, vertical: -1.5}", ""), ("shift_mm: {horizontal: 2, vertical: -1}", "")),
    "upright": (("", "ratio: 2"), ("", "ratio: 1.6")),
    "lying": (("", "ratio: 0.5"), ("", "ratio: 0.65")),
    "rounded": (("", "blades: 3\n  blade_roundness: 0.4"), ("", "blades: 3")),
    "cat's eye": (("", "hood_distance: 0.05\n  hood_diameter: 0.042"), ("", "")),
    "transmission": (("", "transmission: crescent.png"), ("", "transmission: mirrored.png")),
    "turned": (("", "transmission: crescent.png\n  blade_rotation_deg: 90\n  ratio: 1.5"),
               ("", "transmission: crescent.png\n  ratio: 1.5")),
    "all": (("shift_mm: {vertical: 1}", "blades: 5\n  blade_roundness: 0.3\n  ratio: 1.8\n  blade_rotation_deg: 20"),
            ("shift_mm: {vertical: 1}", "blades: 5\n  blade_roundness: 0.3\n  ratio: 1.8\n  blade_rotation_deg: 56")),
}


def picture(file):
    return np.clip(cv2.imread(str(file), cv2.IMREAD_UNCHANGED)[..., :3], 0, 1)


def psnr_db(a, b):
    return -10 * np.log10(np.mean((a.astype(float) - b) ** 2))


class LensShapesTest(StillLifeCase):
    def setUp(self):
        super().setUp()
        crescent = np.zeros((120, 120), np.uint8)
        cv2.circle(crescent, (60, 60), 58, 255, -1, cv2.LINE_AA)
        cv2.circle(crescent, (85, 45), 45, 60, -1, cv2.LINE_AA)
        cv2.imwrite(str(self.folder / "crescent.png"), crescent)
        cv2.imwrite(str(self.folder / "mirrored.png"), crescent[:, ::-1])

    def path(self, name, lens):
        file = self.folder / f"{name}.yaml"
        file.write_text(PATH.format(camera=lens[0], lens=lens[1]))
        return file

    def frame(self, path, *options, source=None):
        out = self.folder / f"frames-{path.stem}-{len(list(self.folder.iterdir()))}"
        self.succeeds(RENDERER, *(source or [self.field, path]), "-o", out, "--format", "exr-float",
                      "--no-contact-sheet", "-q", *options)
        return out / "frame_0001.exr"

    def truth(self, path):
        out = self.folder / f"truth-{path.stem}"
        self.succeeds(SYNTH, "still-life", "-o", out, "--calibration-only", "--truth", path, "--truth-samples", 400,
                      "-q", "--overwrite")
        return picture(out / "truth/frame_0001.exr")

    def test_frames_are_those_of_true_lenses(self):
        for name, (right, wrong) in LENSES.items():
            with self.subTest(name):
                path = self.path(name, right)
                truth = self.truth(path)
                of_default = psnr_db(picture(self.frame(path)), truth)
                self.assertGreater(of_default, 40)
                self.assertLess(psnr_db(picture(self.frame(self.path("wrong", wrong))), truth), of_default - 3)
                # The capture fills these lenses: a hybrid is no worse than its collection.
                hybrid = psnr_db(picture(self.frame(path, "--mode", "hybrid")), truth)
                self.assertGreater(hybrid, max(40, of_default - 0.1))
                if "transmission" in right[1]:
                    continue
                plain = self.frame(path, "--lens-weights", "none")
                self.assertGreater(psnr_db(picture(plain), truth), 36)
                if "hood" not in right[1]:
                    hybrid = self.frame(path, "--mode", "hybrid")
                    self.assertGreater(psnr_db(picture(hybrid), truth), 36)

    def test_a_transmission_needs_lens_weights(self):
        path = self.path("crescent", LENSES["transmission"][0])
        for options in (["--lens-weights", "none"], ["--stop-when", "samples>=4"], ["--smooth-below", 2]):
            self.fails(2, ["transmission", "--lens-weights none"], RENDERER, self.field, path, "-o",
                       self.folder / "frames", *options)
        for mode in ("rebin", "hybrid"):
            self.fails(2, ["transmission", "use --interpolation pixels or --mode collect"], RENDERER, self.field,
                       path, "-o", self.folder / "frames", "--mode", mode, "--interpolation", "cells")

    def test_a_wrong_transmission_is_an_error(self):
        for name, text, words in (("missing", "nothing.png", ["nothing.png"]),
                                  ("text", "00ff/00", ["two hexadecimal digits"]),
                                  ("list", "[1, 2]", ["name of a picture file"]),
                                  ("dark", "00", ["wholly dark"])):
            with self.subTest(name):
                path = self.path(name, ("", f"transmission: {text}"))
                self.fails(3, ["lens.transmission", f"{name}.yaml:", *words], RENDERER, self.field, path, "-o",
                           self.folder / "frames")

    def test_cells_refuse_a_hood(self):
        path = self.path("hood", LENSES["cat's eye"][0])
        for mode in ("rebin", "hybrid"):
            for program, output in ((RENDERER, "frames"), (PREPROCESSOR, "packages")):
                self.fails(2, ["hood", "use --interpolation pixels or --mode collect"], program, self.field, path,
                           "-o", self.folder / output, "--mode", mode, "--interpolation", "cells")

    def test_packages_and_plates_keep_the_lens(self):
        for name in ("all", "cat's eye", "turned"):
            with self.subTest(name):
                self.check_packages_and_plates(self.path(name.replace("'", ""), LENSES[name][0]))

    def check_packages_and_plates(self, path):
        folder = self.folder / path.stem
        expected = self.frame(path).read_bytes()
        self.assertEqual(self.frame(path, "--threads", 3).read_bytes(), expected)
        self.succeeds(PREPROCESSOR, self.field, path, "-o", folder / "packages", "-q")
        package = folder / "packages/package-0000.lfp"
        self.assertEqual(self.frame(path, source=[package]).read_bytes(), expected)
        for shard in (1, 2):
            self.succeeds(RENDERER, self.field, path, "-o", folder / "shards", "--shard", f"{shard}/2", "-q")
        self.succeeds(MERGE, folder / "shards/partial/shards", "-o", folder / "merged", "--format",
                      "exr-float", "-q")
        merged = folder / "merged/frame_0001.exr"
        self.assertEqual(picture(merged).tobytes(), picture(self.frame(path)).tobytes())


if __name__ == "__main__":
    SYNTH, RENDERER, PREPROCESSOR, MERGE = sys.argv[1:5]
    StillLifeCase.SYNTH = SYNTH
    unittest.main(argv=sys.argv[:1])
