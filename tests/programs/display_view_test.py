#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests --view: PNG frames by a view of the user's OpenColorIO configuration. The configurations are made here, and the
frames compared with formulas in NumPy.

usage: display_view_test.py LFSYNTH LFRENDERER LFMERGE
"""
import os
import sys
import unittest

import numpy as np
from PIL import Image

import compositing_test as compositing
from exr_file import channels_of
from program_test_case import ProgramTestCase

SYNTH = RENDERER = MERGE = None
CONFIG = """ocio_profile_version: 2
search_path: ""
strictparsing: true
roles:
  {roles}
  default: {linear}
  scene_linear: {linear}
file_rules:
  - !<Rule> {{name: Default, colorspace: default}}
displays:
  sRGB:
    - !<View> {{name: Video, colorspace: sRGB - Texture}}
    - !<View> {{name: Dark, colorspace: Half of sRGB}}
  Projector:
    - !<View> {{name: Video, colorspace: Gamma}}
colorspaces:
  - !<ColorSpace> {{name: {linear}}}
  - !<ColorSpace>
    name: sRGB - Texture
    from_scene_reference: !<GroupTransform>
      children: [{matrix}, {srgb}]
  - !<ColorSpace>
    name: Half of sRGB
    from_scene_reference: !<GroupTransform>
      children: [{matrix}, !<MatrixTransform> {{matrix: {half}}}, {srgb}]
  - !<ColorSpace>
    name: Gamma
    from_scene_reference: !<GroupTransform>
      children: [{matrix}, !<ExponentTransform> {{value: [2.4, 2.4, 2.4, 1], direction: inverse}}]
"""
SRGB = ("!<ExponentWithLinearTransform> {gamma: [2.4, 2.4, 2.4, 1], offset: [0.055, 0.055, 0.055, 0], "
        "direction: inverse}")


def rows(matrix):
    full = np.eye(4)
    full[:3, :3] = matrix
    return "[" + ", ".join(f"{value:.17g}" for value in full.ravel()) + "]"


def srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.abs(linear) ** (1 / 2.4) - 0.055)


class DisplayViewTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.config = self.folder / "config.ocio"
        self.environment("OCIO", None)
        refused = self.call(RENDERER, "a", "b", "-o", self.folder / "x", "--format", "png", "--view", "Video")
        if "built without OpenColorIO" in refused.stderr:
            self.skipTest("built without OpenColorIO")
        self.field, self.path = self.folder / "field", self.folder / "path.yaml"
        self.succeeds(SYNTH, "lights", "-o", self.field, "--count", 25, "--size", "120x80")
        self.path.write_text(compositing.PATH.replace("300, 200", "120, 80"))
        self.write_config()

    def environment(self, name, value):
        before = os.environ.pop(name, None)
        self.addCleanup(lambda: os.environ.pop(name, None) if before is None else os.environ.update({name: before}))
        if value is not None:
            os.environ[name] = str(value)

    def write_config(self, roles="aces_interchange: ACES2065-1", linear="ACES2065-1", to_rec709=None):
        """Writes a configuration whose reference space is ACES2065-1, unless a matrix to Rec. 709 is given."""
        if to_rec709 is None:
            to_rec709 = np.linalg.inv(compositing.from_rec709("aces"))
        self.config.write_text(CONFIG.format(
            roles=roles, linear=linear, srgb=SRGB, half=rows(0.5 * np.eye(3)),
            matrix=f"!<MatrixTransform> {{matrix: {rows(to_rec709)}}}"))
        self.environment("OCIO", self.config)

    def render(self, name, *options, code=0):
        out = self.folder / name
        self.succeeds(RENDERER, self.field, self.path, "-o", out, "--frames", 1, *options, code=code)
        return out

    def picture(self, name, *options):
        png = self.render(name, "--format", "png", *options) / "frame_0001.png"
        return np.asarray(Image.open(png)).astype(int), b"sRGB" in png.read_bytes()[:200]

    def test_the_view_of_an_srgb_display_is_that_without_a_view(self):
        plain, states_srgb = self.picture("plain")
        self.assertTrue(states_srgb)
        self.assertGreater(plain.max(), 100)
        seen, states_srgb = self.picture("seen", "--view", "Video")
        self.assertTrue(states_srgb)
        self.assertLessEqual(abs(seen - plain).max(), 1)

    def test_views_and_displays_are_those_of_the_configuration(self):
        linear = channels_of(self.render("exr", "--format", "exr-float") / "frame_0001.exr")
        linear = np.dstack([linear[colour] for colour in "RGB"])
        dark, _ = self.picture("dark", "--view", "Dark", "--display", "sRGB")
        self.assertLessEqual(abs(dark - (255 * np.clip(srgb(linear / 2), 0, 1)).round()).max(), 1)
        gamma, states_srgb = self.picture("gamma", "--view", "Video", "--display", "Projector")
        self.assertLessEqual(abs(gamma - (255 * np.clip(linear, 0, 1) ** (1 / 2.4)).round()).max(), 1)
        self.assertFalse(states_srgb)

    def test_a_configuration_may_name_linear_light(self):
        plain, _ = self.picture("plain")
        self.write_config(roles="color_timing: lin_srgb", linear="lin_srgb", to_rec709=np.eye(3))
        seen, _ = self.picture("seen", "--view", "Video")
        self.assertLessEqual(abs(seen - plain).max(), 1)

    def test_merged_shards_have_the_same_bits(self):
        whole = self.render("whole", "--format", "png16", "--view", "Dark")
        for number in (1, 2):
            self.render("cut", "--shard", f"{number}/2")
        cut = self.folder / "cut"
        self.succeeds(MERGE, cut / "partial" / "shards", "-o", cut, "--format", "png16", "--view", "Dark")
        self.assertEqual((cut / "frame_0001.png").read_bytes(), (whole / "frame_0001.png").read_bytes())

    def test_a_finished_frame_is_not_kept_for_another_view(self):
        self.render("out", "--format", "png", "--view", "Dark")
        again = [RENDERER, self.field, self.path, "-o", self.folder / "out", "--frames", 1, "--format", "png",
                 "--resume"]
        self.succeeds(*again, "--view", "Dark")
        self.fails(2, ["picture.view", "Dark", "Video"], *again, "--view", "Video")
        self.config.write_text(self.config.read_text().replace("0.055", "0.05"))
        self.fails(2, ["picture.view", "Dark"], *again, "--view", "Dark")

    def test_what_a_view_lacks_is_named(self):
        exr = [RENDERER, self.field, self.path, "-o", self.folder / "out"]
        start = [*exr, "--format", "png"]
        self.fails(2, ["--view Film", "Video, Dark"], *start, "--view", "Film")
        self.fails(2, ["--display TV", "sRGB, Projector"], *start, "--view", "Video", "--display", "TV")
        self.fails(2, ["--view Video", "--format exr", "--format png"], *exr, "--view", "Video")
        self.fails(2, ["--view"], *start, "--display", "sRGB")
        self.write_config(roles="color_timing: Log", linear="Log")
        self.fails(2, ["what linear light is", "aces_interchange"], *start, "--view", "Video")
        self.config.write_text("ocio_profile_version: 2\nroles: [")
        self.fails(3, ["config.ocio", "OpenColorIO"], *start, "--view", "Video")
        self.config.unlink()
        self.fails(3, ["config.ocio", "OpenColorIO"], *start, "--view", "Video")
        self.environment("OCIO", None)
        self.fails(2, ["environment variable OCIO is not set"], *start, "--view", "Video")
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    SYNTH, RENDERER, MERGE = sys.argv[1:4]
    compositing.PRIMARIES["aces"] = [0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767]
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
