#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that packages, stores of needed pixels and renders agree about what frames need.

usage: needed_pixels_test.py LFCOMPRESSOR LFRENDERER LFPREPROCESSOR LFSUBMIT
"""
import hashlib
import json
import sys
import unittest

from program_test_case import ProgramTestCase
from small_field import write_field

COMPRESSOR = RENDERER = PREPROCESSOR = SUBMIT = None

# The camera moves across the capture, and its aperture opens from a pinhole and closes again.
PATH_YAML = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [40, 30]
camera:
  field_of_view_deg: 45
  focal_length_mm: 35
  position: [-0.02, 0, 0]
  look_at: [-0.02, 0, -1]
  up: [0, 1, 0]
lens:
  aperture_diameter: 0.0
  focus_distance: 0.8
keyframes:
  position: [{{time: 0, value: [-0.02, -0.01, 0]}}, {{time: {end}, value: [0.02, 0.01, 0.005]}}]
  look_at: [{{time: 0, value: [-0.02, -0.01, -1]}}, {{time: {end}, value: [0.02, 0.01, -1]}}]
  aperture_diameter: [{{time: 0, value: {narrow}}}, {{time: {middle}, value: 0.03}},
                      {{time: {end}, value: {narrow}}}]
  focus_distance: [{{time: 0, value: 0.6}}, {{time: {end}, value: 2}}]
"""


class NeededPixelsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.field = write_field(self.folder / "field")

    def path(self, frames=24, narrow=0.002):
        path = self.folder / f"path{frames}_{narrow}.yaml"
        end = (frames - 1) / 25
        path.write_text(PATH_YAML.format(frames=frames, end=end, middle=end / 2, narrow=narrow))
        return path

    def packages(self, path, *options, count=4, name="packages"):
        self.succeeds(PREPROCESSOR, self.field, path, "-o", self.folder / name, "--packages", count,
                      *options)
        packages = sorted((self.folder / name).glob("*.lfp"))
        self.assertEqual(len(packages), count)
        return packages

    def frames(self, name, *arguments):
        out = self.folder / name
        self.succeeds(RENDERER, *arguments, "-o", out, "-q", "--no-contact-sheet")
        for report in out.glob("report*.json"):
            self.assertEqual(json.loads(report.read_text())["skipped_lf_images"], [])
        digests = {frame.name: hashlib.sha256(frame.read_bytes()).hexdigest()
                   for frame in sorted(out.glob("frame_*.exr"))}
        self.assertTrue(digests)
        return digests

    def store(self, packages, name="film"):
        store = self.folder / f"{name}.lfs"
        self.succeeds(COMPRESSOR, *packages, "--needed-pixels", "--profile", "lossless", "-o", store)
        return store

    def test_a_store_of_needed_pixels_holds_what_a_moving_film_reads(self):
        path = self.path(frames=200)
        # A narrow view sees only a part of each LF image.
        path.write_text(path.read_text().replace("deg: 45", "deg: 15"))
        packages = self.packages(path, count=8)
        store = self.store(packages)
        whole = self.folder / "whole.lfs"
        self.succeeds(COMPRESSOR, *packages, "--profile", "lossless", "-o", whole)
        self.assertLess(store.stat().st_size, whole.stat().st_size)
        for options in ([], ["--estimator", "nearest"]):
            name = "-".join(options)
            expected = self.frames(f"files{name}", self.field, path, *options)
            self.assertEqual(len(expected), 200)
            self.assertEqual(expected, self.frames(f"codes{name}", *packages, "--lightfield", store,
                                                   *options))

    def test_every_mode_has_its_packages_and_stores(self):
        path = self.path(frames=12)
        for mode, weights, way in (("collect", "none", "auto"), ("collect", "hat", "auto"), ("rebin", "auto", "auto"),
                                   ("rebin", "auto", "cells"), ("hybrid", "none", "auto"), ("hybrid", "auto", "auto"),
                                   ("hybrid", "auto", "cells")):
            with self.subTest(mode=mode, weights=weights, way=way):
                options = render = ["--mode", mode, "--lens-weights", weights, "--interpolation", way]
                name = f"{mode}-{weights}-{way}"
                expected = self.frames(f"whole-{name}", self.field, path, *render)
                packages = self.packages(path, *options, name=f"packages-{name}")
                self.assertEqual(self.frames(f"packages-of-{name}", *packages, *render), expected)
                store = self.store(packages, name)
                self.assertEqual(self.frames(f"store-of-{name}", *packages, "--lightfield", store,
                                             *render), expected)

    def test_the_advised_render_has_the_interpolation_of_the_packages(self):
        path = self.path(frames=6)
        for mode, way in (("rebin", "cells"), ("rebin", "pixels"), ("hybrid", "cells")):
            packages = self.packages(path, "--mode", mode, "--interpolation", way, name=f"{mode}-{way}")
            told = self.call(COMPRESSOR, *packages, "--needed-pixels", "-o", self.folder / f"{mode}-{way}.lfs")
            words = told.stdout + told.stderr
            self.assertIn(f"--mode {mode}", words)
            self.assertEqual("--interpolation cells" in words, way == "cells", words)

    def test_whole_images_serve_every_mode_and_estimator(self):
        path = self.path(frames=8)
        packages = self.packages(path, count=3)
        for i, options in enumerate((["--mode", "rebin"], ["--mode", "hybrid"],
                                     ["--mode", "hybrid", "--lens-weights", "none"],
                                     ["--estimator", "nearest", "--lens-weights", "none"],
                                     ["--mode", "rebin", "--estimator", "nearest"])):
            with self.subTest(options=options):
                expected = self.frames(f"whole{i}", self.field, path, *options)
                self.assertEqual(self.frames(f"packages{i}", *packages, *options), expected)
                out = self.folder / f"job{i}"
                self.succeeds(SUBMIT, *packages, "-o", out, "--no-contact-sheet", "-q", "--",
                              *options)
                self.assertEqual({frame.name: hashlib.sha256(frame.read_bytes()).hexdigest()
                                  for frame in out.glob("frame_*.exr")}, expected)

    def test_some_frames_have_the_bits_of_the_whole_film(self):
        path = self.path(frames=9)
        for mode in ("rebin", "hybrid"):
            expected = self.frames(f"all-{mode}", self.field, path, "--mode", mode)
            some = self.frames(f"some-{mode}", self.field, path, "--mode", mode, "--frames", "2,5-6")
            self.assertEqual(some, {name: expected[name] for name in some})
            self.assertEqual(len(some), 3)

    def test_pixels_that_a_store_lacks_are_told_before_anything_is_rendered(self):
        path = self.path(frames=6)
        path.write_text(path.read_text().replace("deg: 45", "deg: 15"))
        packages = self.packages(path, "--lens-weights", "none")
        store = self.store(packages)
        self.fails(2, ["--mode hybrid", "lacks the LF cameras beside the lens", "make the package again"],
                   RENDERER, *packages, "--lightfield", store, "--lens-weights", "none", "--mode",
                   "hybrid", "-o", self.folder / "none")
        packages = self.packages(path, name="with-neighbours")
        store = self.store(packages, "neighbours")
        self.fails(3, ["lacks pixels that frame", "this packed store", "--mode",
                       "packages of these frames"],
                   RENDERER, *packages, "--lightfield", store, "--mode", "rebin", "--interpolation",
                   "cells", "-o", self.folder / "none")
        self.assertFalse(list((self.folder / "none").glob("frame_*")))
        # lfpreprocessor writes no package if the packed store lacks pixels that the package needs.
        wide = self.folder / "wide.yaml"
        wide.write_text(path.read_text().replace("deg: 15", "deg: 45"))
        self.fails(3, ["lacks pixels that frame", "this packed store"],
                   PREPROCESSOR, store, wide, "-o", self.folder / "made")
        self.assertFalse(list((self.folder / "made").glob("*.lfp")))

    def test_a_lens_without_rays_is_planned_for_the_mode_that_fills_it(self):
        # The lens is in the plane of the LF cameras, between four of them.
        path = self.path(frames=4, narrow=0.001)
        path.write_text(path.read_text().replace("value: 0.03", "value: 0.001")
                        .replace("value: [-0.02, -0.01, 0]", "value: [0.005, 0.005, 0]")
                        .replace("value: [0.02, 0.01, 0.005]", "value: [0.006, 0.005, 0]"))
        out = self.folder / "small"
        self.fails(3, ["no LF image contributes"], PREPROCESSOR, self.field, path, "-o", out,
                   "--lens-weights", "none")
        for mode in ("hybrid", "rebin"):
            report = json.loads(self.succeeds(PREPROCESSOR, self.field, path, "--plan", "--json",
                                              "--mode", mode, "--lens-weights",
                                              "none"))
            self.assertGreater(report["packages"][0]["lf_images"], 0)

    def test_packages_are_read_and_checked_once(self):
        packages = self.packages(self.path(frames=4), count=2)
        result = self.call(RENDERER, *packages, "-v", "-o", self.folder / "once")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count(": read and checked"), 2)


class OrderTest(ProgramTestCase):
    def test_orders_are_the_same_of_packages_and_light_fields(self):
        field = write_field(self.folder / "field")
        path = self.folder / "path.yaml"
        path.write_text(PATH_YAML.format(frames=6, end=0.2, middle=0.1, narrow=0.002))
        digests = {}
        for order in ("shuffle", "round-robin", "area", "groups"):
            packages = self.folder / order
            limit = ["--max-images", "3"]
            self.succeeds(PREPROCESSOR, field, path, "-o", packages, "--packages", "2", "--order",
                          order, *limit)
            for name, arguments in (("whole", [field, path, "--order", order, *limit]),
                                    ("packed", sorted(packages.glob("*.lfp")))):
                out = self.folder / f"{order}-{name}"
                self.succeeds(RENDERER, *arguments, "-o", out, "-q", "--no-contact-sheet")
                digests[order, name] = {frame.name: hashlib.sha256(frame.read_bytes()).hexdigest()
                                        for frame in sorted(out.glob("frame_*.exr"))}
                # Lens weights reach beyond small lenses. LF images that have only such a weight are also counted.
                for report in out.glob("report*.json"):
                    for frame in json.loads(report.read_text())["frames"]:
                        # In the order groups, one of the three is beside the last lens and sends it no ray.
                        least = 2 if order == "groups" else 3
                        self.assertGreaterEqual(frame["lf_images"], least, (order, name))
            self.assertEqual(digests[order, "whole"], digests[order, "packed"])
        self.assertNotEqual(digests["shuffle", "whole"], digests["area", "whole"])
        packages = sorted((self.folder / "area").glob("*.lfp"))
        self.fails(2, ["--order", "lfpreprocessor --order"], RENDERER, *packages, "--order", "area",
                   "-o", self.folder / "none")


if __name__ == "__main__":
    COMPRESSOR, RENDERER, PREPROCESSOR, SUBMIT = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1], verbosity=2)
