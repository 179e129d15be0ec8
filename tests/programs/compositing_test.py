#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what compositing programs read of frames: attributes of EXR files, --colour-space, --frame-alpha, --z,
--channels and --exr-compression. Places, colours and depths are compared with formulas of the OpenEXR documentation and
of the standards, in NumPy.

usage: compositing_test.py LFSYNTH LFRENDERER LFMERGE LFPREPROCESSOR
"""
import hashlib
import signal
import subprocess
import sys
import unittest

import numpy as np
from PIL import Image

from exr_file import attributes_of, channels_of, read_header
from program_test_case import ProgramTestCase, wait_until

SYNTH = RENDERER = MERGE = PREPROCESSOR = None
WIDTH, HEIGHT = 300, 200
LIGHT = np.array([80 / 480, 0, 0])  # a light of the scene `lights`: in its middle row, second to the right
PATH = f"""format: lfpath 1
fps: 29.97
frames: 3
resolution: [{WIDTH}, {HEIGHT}]
camera:
  field_of_view_deg: 40
  focal_length_mm: 35
  shift_mm: {{horizontal: 3, vertical: -2}}
  position: [0.02, -0.03, -1.05]
  look_at: [0.1, 0.05, 0]
  up: [0.1, -1, 0.05]
lens:
  aperture_diameter: 0.05
  focus_distance: 1.05
  focus_tilt_deg: {{horizontal: 20, vertical: -10}}
"""
PRIMARIES = {  # x and y of red, green, blue and white: ITU-R BT.709 and BT.2020, SMPTE ST 2065-1 and ACES S-2014-004
    "rec709": [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290],
    "rec2020": [0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290],
    "acescg": [0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767],
}
ALL = ["--colour-space", "acescg", "--frame-alpha", "--z"]


def xyz(chromaticity):
    x, y = chromaticity
    return np.array([x / y, 1, (1 - x - y) / y])


def xyz_from_rgb(name):
    *colours, white = np.reshape(PRIMARIES[name], (4, 2))
    columns = np.stack([xyz(colour) for colour in colours], axis=1)
    return columns * np.linalg.solve(columns, xyz(white))


def from_rec709(name):
    """Returns the matrix from linear Rec. 709, with Bradford adaptation (Lindbloom's formula)."""
    bradford = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
    before, after = (bradford @ xyz(PRIMARIES[space][6:]) for space in ("rec709", name))
    adapted = np.linalg.inv(bradford) @ np.diag(after / before) @ bradford
    return np.linalg.inv(xyz_from_rgb(name)) @ adapted @ xyz_from_rgb("rec709")


def digests(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.glob("frame_*.*"))}


class CompositingTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = ProgramTestCase()
        cls.shared.setUp()
        cls.addClassCleanup(cls.shared.doCleanups)
        cls.field = cls.shared.folder / "field"
        cls.shared.succeeds(SYNTH, "lights", "-o", cls.field, "--count", 49, "--spacing", "0.008", "--format", "exr",
                            "--size", "300x200")
        cls.path = cls.shared.folder / "path.yaml"
        cls.path.write_text(PATH)

    def render(self, name, *options):
        self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / name, "--format", "exr-float", *options)
        return self.folder / name

    def test_the_attributes_describe_camera_and_lens(self):
        header, _ = read_header((self.render("out") / "frame_0002.exr").read_bytes())
        types = {name: kind for name, (kind, _) in header.items()}
        value = {name: value for name, (_, value) in header.items()}
        for names, kind in (("worldToCamera worldToNDC", "m44f"), ("framesPerSecond", "rational"),
                            ("chromaticities", "chromaticities"), ("imageCounter", "int"),
                            ("focus aperture nominalFocalLength effectiveFocalLength pinholeFocalLength "
                             "pixelAspectRatio screenWindowWidth", "float"),
                            ("sensorOverallDimensions screenWindowCenter", "v2f")):
            for name in names.split():
                self.assertEqual(types[name], kind, name)
        self.assertEqual(value["framesPerSecond"], (30000, 1001))
        np.testing.assert_allclose(value["chromaticities"], PRIMARIES["rec709"], rtol=1e-6)
        self.assertEqual(value["imageCounter"], 2)
        window = 2 * np.tan(np.radians(20))  # of a field of view of 40 degrees
        for name, expected in (("focus", 1.05), ("nominalFocalLength", 35), ("pinholeFocalLength", 35),
                               ("aperture", 0.035 / 0.05), ("pixelAspectRatio", 1), ("screenWindowWidth", window),
                               ("sensorOverallDimensions", (35 * window, 35 * window * HEIGHT / WIDTH))):
            np.testing.assert_allclose(value[name], expected, rtol=1e-6, err_msg=name)
        self.assertIn("lf:focus_plane", value)

    def test_a_point_of_the_world_is_seen_where_the_matrices_say(self):
        out = self.render("out", "--frames", 1)
        attributes = attributes_of(out / "frame_0001.exr")
        x, y, _, w = np.append(LIGHT, 1) @ attributes["worldToNDC"]
        predicted = np.array([x / w * WIDTH, y / w * HEIGHT])
        grey = channels_of(out / "frame_0001.exr")["G"]
        column, row = (predicted - 0.5).round().astype(int)
        left, top = column - 7, row - 7
        window = grey[top:top + 15, left:left + 15].astype(float)
        self.assertGreater(window.max(), 0.5)
        places = np.mgrid[top:top + 15, left:left + 15] + 0.5
        seen = [(place * window).sum() / window.sum() for place in places[::-1]]
        print(f"the light is {np.hypot(*(seen - predicted)):.3f} px from the place that worldToNDC gives")
        self.assertLess(np.hypot(*(seen - predicted)), 0.1)
        # worldToCamera and the screen window, whose axes are left and up, give the same place.
        right, up, forward, _ = np.append(LIGHT, 1) @ attributes["worldToCamera"]
        window = attributes["screenWindowWidth"] * np.array([1, HEIGHT / WIDTH])
        place = 0.5 - (np.array([-right, up]) / forward - attributes["screenWindowCenter"]) / window
        np.testing.assert_allclose(place, [x / w, y / w], atol=1e-5)
        lens = np.array(attributes["sensorOverallDimensions"]) / attributes["pinholeFocalLength"]
        np.testing.assert_allclose(lens, window, rtol=1e-6)

    def test_colours_are_converted_exactly(self):
        rgb, sheets = {}, {}
        for name in PRIMARIES:
            out = self.render(name, "--frames", 1, "--colour-space", name)
            path = out / "frame_0001.exr"
            np.testing.assert_allclose(attributes_of(path)["chromaticities"], PRIMARIES[name], rtol=1e-6)
            rgb[name] = np.dstack([channels_of(path)[channel] for channel in "RGB"]).astype(float)
            sheets[name] = np.asarray(Image.open(out / "contact_sheet.png")).astype(int)
        for name in ("rec2020", "acescg"):
            expected = rgb["rec709"] @ from_rec709(name).T
            np.testing.assert_allclose(rgb[name], expected, atol=2e-6 * expected.max())
            self.assertGreater(abs(rgb[name] - rgb["rec709"]).max(), 0.05)
            self.assertLessEqual(abs(sheets[name] - sheets["rec709"]).max(), 1)
        self.assertEqual(digests(self.folder / "rec709"), digests(self.render("plain", "--frames", 1)))

    def test_alpha_is_1_where_light_was_recorded(self):
        beside = self.folder / "beside.yaml"  # a camera that sees beyond the capture
        beside.write_text(PATH.replace("[0.1, 0.05, 0]", "[0.5, 0.05, 0]"))
        for name, fill, least in (("filled", 2, 50), ("bare", "off", 50)):
            out = self.folder / name
            self.succeeds(RENDERER, self.field, beside, "-o", out, "--frame-alpha", "--frames", 1, "--fill", fill)
            channels = channels_of(out / "frame_0001.exr")
            alpha = channels["A"]
            self.assertEqual(set(np.unique(alpha)), {0, 1})
            for count in (alpha == 0).sum(), (alpha == 1).sum():
                self.assertGreater(count, least)
            for colour in "RGB":
                self.assertEqual(np.count_nonzero(channels[colour][alpha == 0]), 0)
            png = self.folder / f"{name} png"
            self.succeeds(RENDERER, self.field, beside, "-o", png, "--frame-alpha", "--frames", 1, "--fill", fill,
                          "--format", "png")
            np.testing.assert_array_equal(np.asarray(Image.open(png / "frame_0001.png"))[..., 3], 255 * alpha)

    def test_the_depth_of_focus_follows_the_tilted_plane(self):
        out = self.render("out", "--frames", 1, "--z")
        path = out / "frame_0001.exr"
        attributes = attributes_of(path)
        depth = channels_of(path)["Z"]
        self.assertEqual(depth.dtype, np.float32)
        *normal, offset = map(float, attributes["lf:focus_plane"].split())
        world_from_row = np.linalg.inv(attributes["worldToNDC"].astype(float))
        for row, column in ((0, 0), (100, 150), (199, 7), (3, 299)):
            place = np.array([(column + 0.5) / WIDTH, (row + 0.5) / HEIGHT])
            w = depth[row, column]  # the last coordinate of worldToNDC is the depth
            focus = attributes["focus"]
            point = np.array([*(place * w), w - focus, w]) @ world_from_row
            self.assertAlmostEqual(point[3], 1, 4)
            self.assertAlmostEqual(np.dot(normal, point[:3]), offset, 3)
        self.assertGreater(depth.max() - depth.min(), 0.05)

    def test_frames_have_the_same_bits_however_they_are_made(self):
        plain = digests(self.render("plain", *ALL))
        self.assertEqual(len(plain), 3)
        for number in (1, 2):
            self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / "cut", "--shard", f"{number}/2")
        self.succeeds(MERGE, self.folder / "cut" / "partial" / "shards", "-o", self.folder / "cut", "--format",
                      "exr-float", *ALL)
        self.assertEqual(digests(self.folder / "cut"), plain)
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, self.path, "-o", packages, "--packages", 2)
        self.succeeds(RENDERER, *sorted(packages.glob("*.lfp")), "-o", self.folder / "packaged", "--format",
                      "exr-float", *ALL)
        self.assertEqual(digests(self.folder / "packaged"), plain)

    def test_an_interrupted_render_resumes_and_its_frames_keep_their_options(self):
        plain = digests(self.render("plain", *ALL))
        out = self.folder / "out"
        words = [RENDERER, self.field, self.path, "-o", out, "--format", "exr-float", "--threads", 1, "--dump-every",
                 "0.001s", *ALL]
        process = subprocess.Popen([*map(str, words)], stderr=subprocess.DEVNULL)
        wait_until(lambda: any(out.glob("partial/frame_*.plate")), process)
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertTrue((out / "partial").exists())
        self.assertFalse((out / "frame_0003.exr").exists())
        self.succeeds(*words, "--resume")
        self.assertEqual(digests(out), plain)
        start = [RENDERER, self.field, self.path, "-o", out, "--format", "exr-float", "--resume"]
        self.fails(2, ["picture.colour_space", "acescg", "rec2020"], *start, "--frame-alpha", "--z", "--colour-space",
                   "rec2020")
        self.fails(2, ["picture.z"], *start, "--frame-alpha", "--colour-space", "acescg")
        self.assertEqual(digests(out), plain)

    def test_frames_of_fewer_channels_hold_the_same_light(self):
        whole = channels_of(self.render("whole", "--frames", 1, "--frame-alpha", "--z") / "frame_0001.exr")
        for name, options, names in (("rgb", [], "RGB"), ("rgba", [], "RGBA"), ("rgb", ["--z"], "RGBZ"),
                                     ("rgba", ["--frame-alpha", "--z"], "RGBAZ")):
            for compression, number in (("zip", 3), ("zips", 2)):
                out = self.folder / "few"
                self.render("few", "--frames", 1, "--overwrite", "--channels", name, "--exr-compression", compression,
                            *options)
                few = channels_of(out / "frame_0001.exr")
                self.assertEqual(set(few), set(names))
                for channel in names:
                    np.testing.assert_array_equal(few[channel], whole[channel])
                self.assertEqual(attributes_of(out / "frame_0001.exr")["compression"], number)
        # A film keeps its channels: frames of others are not added to it.
        for options in (["--channels", "all"], ["--channels", "rgba", "--exr-compression", "zip"]):
            self.fails(2, ["picture."], RENDERER, self.field, self.path, "-o", self.folder / "few", "--format",
                       "exr-float", "--frames", 2, "--frame-alpha", "--z", *options)

    def test_options_that_a_file_cannot_follow_are_refused(self):
        self.fails(2, ["--channels rgb", "--frame-alpha", "--channels rgba"], RENDERER, self.field, self.path, "-o",
                   self.folder / "out", "--channels", "rgb", "--frame-alpha")
        for options in (["--z"], ["--colour-space", "acescg"], ["--channels", "rgb"], ["--exr-compression", "zips"]):
            self.fails(2, ["--format png16", options[0], "leave one of them out"], RENDERER, self.field, self.path,
                       "-o", self.folder / "out", "--format", "png16", *options)
        for options in (["--z"], ["--frame-alpha"], ["--colour-space", "acescg"], ["--channels", "rgba"],
                        ["--exr-compression", "zips"]):
            self.fails(2, ["--shard", options[0], "lfmerge"], RENDERER, self.field, self.path, "-o",
                       self.folder / "out", "--shard", "1/2", *options)
        self.fails(2, ["--colour-space", "rec709"], RENDERER, self.field, self.path, "-o", self.folder / "out",
                   "--colour-space", "srgb")

    def test_openimageio_lists_the_attributes(self):
        out = self.render("out", "--frames", 1, "--colour-space", "acescg")
        text = self.succeeds("oiiotool", "--info", "-v", out / "frame_0001.exr").lower()
        for words in ("worldtocamera: 0.992", "worldtondc: 1.391", "framespersecond: 30000/1001",
                      "chromaticities: 0.713, 0.293, 0.165", "focus: 1.05", "fnumber: 0.7", "pixelaspectratio: 1",
                      "pinholefocallength: 35", "sensoroveralldimensions: 25.4"):
            self.assertIn(words, text)


if __name__ == "__main__":
    SYNTH, RENDERER, MERGE, PREPROCESSOR = sys.argv[1:5]
    del sys.argv[1:5]
    unittest.main()
