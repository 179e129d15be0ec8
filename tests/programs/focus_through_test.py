#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lffocus through: statistics over the lens, with NumPy as the judge, and charts behind leaves.

usage: focus_through_test.py LFFOCUS LFRENDERER LFSYNTH
"""
import json
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from exr_file import attributes_of, channels_of
from program_test_case import ProgramTestCase

FOCUS = RENDERER = SYNTH = None
PATH = """format: lfpath 1
fps: 25
frames: 1
resolution: [{size}]
camera: {{field_of_view_deg: 53.13, position: [0, 0, -1], look_at: [0, 0, 0]}}
lens: {{aperture_diameter: 0.2, focus_distance: 1{more}}}
"""
STATISTICS = {"min": lambda v: v[0], "max": lambda v: v[-1], "mean": lambda v: v.mean(0),
              "median": lambda v: np.median(v, 0),
              "trimmed": lambda v: v[int(0.2 * len(v)):len(v) - int(0.2 * len(v))].mean(0)}


def rgb(channels):
    return np.stack([channels[c] for c in "RGB"], -1).astype(float)


class FocusThroughTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.shared = pathlib.Path(temporary.name)
        cls.path, cls.field = cls.shared / "path.yaml", cls.shared / "foliage"
        cls.path.write_text(PATH.format(size="120, 80", more=""))
        subprocess.run([SYNTH, "foliage", "-o", cls.field, "--size", "120x80", "--count", "49", "--spacing", "0.032",
                        "--samples", "1", "--format", "png16", "-q"], check=True)

    def through(self, name, *options, field=None, path=None, code=0):
        out = self.folder / name
        said = self.succeeds(FOCUS, "through", field or self.field, path or self.path, "-o", out, "--format",
                             "exr-float", *options, code=code)
        return said if code else channels_of(out)

    def field_of(self, name, choose):
        """Makes a light field of the LF images that `choose` returns of the list of all."""
        folder = self.folder / name
        folder.mkdir()
        (folder / "images").symlink_to(self.field / "images")
        calibration = json.loads((self.field / "transforms.json").read_text())
        calibration["frames"] = choose(calibration["frames"])
        (folder / "transforms.json").write_text(json.dumps(calibration))
        return folder

    def test_statistics_are_those_of_numpy(self):
        count = len(json.loads((self.field / "transforms.json").read_text())["frames"])
        for more in ("", ", focus_tilt_deg: {horizontal: 20, vertical: 10}, blades: 5"):
            path = self.folder / "path.yaml"
            path.write_text(PATH.format(size="120, 80", more=more))
            pictures = []
            for i in range(count):
                # A light field of one LF image, at the middle of 49, has the rays of this image alone.
                one = self.field_of(f"{bool(more)}{i}", lambda frames, i=i: [frames[i]])
                result = self.call(FOCUS, "through", one, path, "-o", self.folder / "one.exr", "--format", "exr-float",
                                   "--filter", "nearest", "--statistic", "mean", "--overwrite")
                if result.returncode == 3:
                    self.assertIn("no LF camera", result.stderr)
                    continue
                channels = channels_of(self.folder / "one.exr")
                pictures.append(np.where(channels["count_red"][..., None] > 0, rgb(channels), np.nan))
            values = np.array(pictures)
            seen = np.isfinite(values[..., 0]).sum(0)
            self.assertGreater(seen.max(), 20)
            for name, statistic in STATISTICS.items():
                trim = ["--trim", 0.2] if name == "trimmed" else []
                found = self.through(f"{bool(more)}{name}.exr", "--filter", "nearest", "--statistic", name, *trim,
                                     path=path)
                np.testing.assert_array_equal(found["count_green"], seen)
                for y, x in np.argwhere(seen > 0):
                    rays = np.sort(values[np.isfinite(values[:, y, x, 0]), y, x], 0)
                    expected, got = statistic(rays), rgb(found)[y, x]
                    if name in ("min", "max") or (name == "median" and len(rays) % 2):
                        np.testing.assert_array_equal(got, expected)
                    np.testing.assert_allclose(got, expected, rtol=2e-6, atol=1e-7)

    def test_the_mean_is_the_frame_of_the_renderer(self):
        for name in ("auto", "nearest", "bicubic"):
            with self.subTest(name):
                mean = self.through(f"{name}.exr", "--statistic", "mean", "--filter", name)
                self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / name, "--lens-weights", "none",
                              "--filter", name, "--format", "exr-float")
                frame = channels_of(self.folder / name / "frame_0001.exr")
                for channel in ("R", "G", "B", "count_red", "coverage"):
                    np.testing.assert_array_equal(mean[channel], frame[channel])

    def test_statistics_are_in_order(self):
        options = ["--filter", "bilinear"]
        low, median, high, mean = (rgb(self.through(f"{s}.exr", "--statistic", s, *options))
                                   for s in ("min", "median", "max", "mean"))
        trimmed = rgb(self.through("t.exr", "--statistic", "trimmed", "--trim", 0.3, *options))
        untrimmed = rgb(self.through("u.exr", "--statistic", "trimmed", "--trim", 0, *options))
        for middle in (median, trimmed, mean):
            self.assertTrue((low <= middle).all() and (middle <= high).all())
        np.testing.assert_array_equal(untrimmed, mean)
        self.assertTrue((low < high).any() and (trimmed != mean).any())

    def test_order_threads_and_memory_change_no_bit(self):
        shuffled = self.field_of("shuffled", lambda frames: random.Random(3).sample(frames, len(frames)))
        path = self.folder / "large.yaml"
        path.write_text(PATH.format(size="1200, 800", more=""))
        for order in ("channels", "luminance"):
            options = ["--statistic", "trimmed", "--order", order, "--lf-pixels", "areas"]
            one = self.through(f"{order}1.exr", "--threads", 1, *options, path=path)
            said = json.loads(self.succeeds(FOCUS, "through", shuffled, path, "-o", self.folder / f"{order}3.exr",
                                            "--format", "exr-float", "--threads", 3, "--memory", "256M", "--json",
                                            *options))
            three = channels_of(self.folder / f"{order}3.exr")
            for channel in one:
                np.testing.assert_array_equal(one[channel], three[channel])
            self.assertGreater(said["parts"], 1)
        self.fails(4, ["--memory 1 MiB is too small", "at least"], FOCUS, "through", self.field, path, "-o",
                   self.folder / "small.exr", "--memory", "1M")

    def test_an_order_by_luminance_keeps_the_colours_of_rays(self):
        def chart_error(colours):  # leaves are green, charts and background are grey
            return np.ptp(colours, axis=-1)
        low = rgb(self.through("l.exr", "--statistic", "min", "--order", "luminance", "--filter", "nearest"))
        self.assertLess(np.median(chart_error(low)), 1e-4)

    def test_charts_behind_leaves_become_readable(self):
        field, path, free = self.folder / "field", self.folder / "path.yaml", self.folder / "free.yaml"
        path.write_text(PATH.format(size="240, 160", more=""))
        # A pinhole between leaves and charts sees the plane of the charts in the same elements, without leaves.
        free.write_text("format: lfpath 1\nfps: 25\nframes: 1\nresolution: [240, 160]\n"
                        f"camera: {{field_of_view_deg: {np.degrees(2 * np.arctan(0.5 / 0.3))}, "
                        "position: [0, 0, -0.3], look_at: [0, 0, 0]}\n"
                        "lens: {aperture_diameter: 0, focus_distance: 0.3}\n")
        self.succeeds(SYNTH, "foliage", "-o", field, "--size", "240x160", "--count", 81, "--spacing", 0.025,
                      "--samples", 1, "--format", "png16", "--truth", free, "-q")
        truth = rgb(channels_of(field / "truth/frame_0001.exr"))[..., 1]
        y, x = np.mgrid[:160, :240] + 0.5
        charts = (abs(y - 80) < 42) & (abs(abs(x - 120) - 48) < 42)
        self.assertLess(truth[charts].max(), 0.15)  # leaves have at least 0.55
        # The star has 36 periods around element (168, 80): a sine of 36 periods explains the whole variance in its
        # outer rings if there are no leaves.
        x, y = x - 168, y - 80
        ring = (np.hypot(x, y) > 30) & (np.hypot(x, y) < 38)
        angle = 36 * np.arctan2(y, x)[ring]
        waves = np.stack([np.cos(angle), np.sin(angle), np.ones_like(angle)], -1)
        explained, correlation, error = {}, {}, {}
        for name in STATISTICS:
            trim = ["--trim", 0.4] if name == "trimmed" else []
            values = rgb(self.through(f"{name}.exr", "--statistic", name, *trim, field=field, path=path))[..., 1]
            rest = values[ring] - waves @ np.linalg.lstsq(waves, values[ring], rcond=None)[0]
            explained[name] = 1 - rest.var() / values[ring].var()
            correlation[name] = np.corrcoef(values[charts], truth[charts])[0, 1]
            error[name] = np.sqrt(((values - truth)[charts] ** 2).mean())
        said = f"{explained} {correlation} {error}"
        self.assertLess(explained["mean"], 0.4, said)
        self.assertLess(correlation["mean"], 0.6, said)
        for name in ("median", "trimmed", "min"):
            self.assertGreater(explained[name], 0.95, said)
            self.assertGreater(correlation[name], 0.8, said)
            self.assertLess(error[name], error["mean"] / 5, said)

    def test_the_file_states_its_statistic(self):
        self.through("a.exr", "--statistic", "trimmed")
        attributes = attributes_of(self.folder / "a.exr")
        self.assertEqual(attributes["lf:statistic"], "trimmed")
        self.assertIn("worldToCamera", attributes)
        self.succeeds(FOCUS, "through", self.field, self.path, "-o", self.folder / "a.png", "-o", self.folder / "b.exr")
        self.assertTrue((self.folder / "a.png").read_bytes().startswith(b"\x89PNG"))

    def test_kinds_of_lf_images(self):
        for name, options in (("raw", ["--bayer"]), ("clear", ["--alpha", "straight", "--format", "png"]),
                              ("wide", ["--distortion", "0.1,-0.1", "--format", "png"])):
            with self.subTest(name):
                field = self.folder / name
                self.succeeds(SYNTH, "foliage", "-o", field, "--size", "60x40", "--count", 9, "--spacing", 0.05,
                              "--samples", 1, *options, "-q")
                more = ["--background", "none"] if name == "clear" else []
                mean, median, low = (self.through(f"{name}_{s}.exr", "--statistic", s, *more, field=field)
                                     for s in ("mean", "median", "min"))
                self.assertEqual("A" in mean, name == "clear")
                self.assertFalse(np.array_equal(mean["G"], median["G"]))
                self.assertLess(rgb(low).mean(), rgb(mean).mean())
                if name == "clear":
                    self.assertTrue((median["A"] <= 1).all() and (median["A"] == 1).any())

    def test_wrong_calls_are_refused(self):
        for words, arguments in ((["a.tif", "seen.exr or seen.png"], ["-o", "a.tif"]),
                                 (["--trim cannot be used with --statistic median"], ["-o", "a.exr", "--trim", 0.1]),
                                 (["--trim 0.5"], ["-o", "a.exr", "--statistic", "trimmed", "--trim", 0.5]),
                                 (["--format png", ".png"], ["-o", "a.exr", "--format", "png"]),
                                 (["--filter"], ["-o", "a.exr", "--filter", "mosaic"]),
                                 (["--frame 2", "1 frame"], ["-o", "a.exr", "--frame", 2])):
            with self.subTest(words):
                self.fails(2, words, FOCUS, "through", self.field, self.path, *arguments)

    def test_lenses_without_an_order_are_refused(self):
        (self.folder / "heart.png").write_bytes(next((self.field / "images").iterdir()).read_bytes())
        for more, words in ((", transmission: heart.png", ["transmission"]), ("", ["shutter"])):
            path = self.folder / "path.yaml"
            text = PATH.format(size="120, 80", more=more)
            path.write_text(text if more else text + "shutter: {angle_deg: 180, samples: 4}\n")
            self.fails(2, words, FOCUS, "through", self.field, path, "-o", self.folder / "a.exr")

    def test_a_broken_lf_image_is_left_out_and_told(self):
        def breaks(frames):
            frames[24]["file_path"] = str(self.folder / "broken.png")
            return frames
        (self.folder / "broken.png").write_bytes(next((self.field / "images").iterdir()).read_bytes()[:2000])
        field = self.field_of("broken", breaks)
        arguments = [FOCUS, "through", field, self.path, "-o"]
        self.fails(6, ["1 of", "left out", "broken.png"], *arguments, self.folder / "a.exr")
        self.succeeds(*arguments, self.folder / "b.exr", "--allow-missing", 1)
        without = self.field_of("without", lambda frames: frames[:24] + frames[25:])
        self.succeeds(FOCUS, "through", without, self.path, "-o", self.folder / "d.exr")
        for channel, values in channels_of(self.folder / "d.exr").items():
            np.testing.assert_array_equal(channels_of(self.folder / "b.exr")[channel], values)
        # A frame that is made in parts leaves the LF image out of each of them, and counts it once.
        large = self.folder / "large.yaml"
        large.write_text(PATH.format(size="600, 400", more=""))
        said = []
        for name, memory in (("parts", "80M"), ("whole", "1G")):
            command = [FOCUS, "through", field, large, "-o", self.folder / f"{name}.exr", "--memory", memory,
                       "--threads", 1]
            said.append(json.loads(self.succeeds(*command, "--allow-missing", 1, "--json")))
            self.fails(6, ["1 of", "left out", "broken.png"], *command, "--overwrite")
        self.assertGreater(said[0]["parts"], said[1]["parts"])
        self.assertEqual((self.folder / "parts.exr").read_bytes(), (self.folder / "whole.exr").read_bytes())
        self.fails(3, ["broken.png"], *arguments, self.folder / "c.exr", "--strict")
        self.assertFalse((self.folder / "c.exr").exists())

    def test_inputs_and_files_that_exist_are_kept(self):
        image = next((self.field / "images").iterdir())
        before = image.read_bytes()
        self.fails(2, [image.name, "input"], FOCUS, "through", self.field, self.path, "-o", image, "--overwrite")
        self.assertEqual(image.read_bytes(), before)
        (self.folder / "a.png").write_text("mine")
        self.fails(2, ["exists already"], FOCUS, "through", self.field, self.path, "-o", self.folder / "a.png")
        self.assertEqual((self.folder / "a.png").read_text(), "mine")

    def test_interrupted_it_writes_nothing(self):
        path = self.folder / "large.yaml"
        path.write_text(PATH.format(size="2400, 1600", more=""))
        process = subprocess.Popen([FOCUS, "through", self.field, path, "-o", self.folder / "a.exr", "--progress",
                                    "json", "--memory", "1G"], stderr=subprocess.PIPE)
        process.stderr.readline()  # the work has begun
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.assertEqual(process.returncode, 5)
        self.assertEqual(list(self.folder.glob("a*")), [])


if __name__ == "__main__":
    FOCUS, RENDERER, SYNTH = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
