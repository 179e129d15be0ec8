# SPDX-License-Identifier: Apache-2.0
"""Tests exposure brackets: three clipped 8-bit photographs of every pose become linear light.

Usage: brackets_test.py IMPORTER RENDERER SYNTH EXAMPLE PREPROCESSOR COMPRESSOR
"""
import json
import os
import pathlib
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase

IMPORTER = RENDERER = SYNTH = EXAMPLE = PREPROCESSOR = COMPRESSOR = None
STOPS = (2, 0, -2)
POSES = 25
READ_NOISE, SHOT_NOISE = 0.002, 0.0004  # noise of stored pictures: standard deviation; variance at radiance 1
MOST_ERROR = {"highlights": (12, 8), "shadows": (6, 2)}  # largest errors in %: root mean square, mean
MOST = 3.8  # radiance; the dark exposure clips from 4 on
EXIF_IFD, TIME, F_NUMBER, ISO = 0x8769, 0x829A, 0x829D, 0x8827


def stored_of(light):
    s = np.clip(light, 0, 1)
    s = np.where(s <= 0.0031308, 12.92 * s, 1.055 * s ** (1 / 2.4) - 0.055)
    return (255 * s).round().astype(np.uint8)


def exif_of(stops, leave_out=None):
    exif = Image.Exif()
    tags = {TIME: 0.01 * 2.0 ** stops, F_NUMBER: 4.0, ISO: 100}
    tags.pop(leave_out, None)
    exif[EXIF_IFD] = tags
    return exif


class Capture:
    """The light of a synthetic scene with highlights, as float images and as brackets."""

    def __init__(self, test):
        self.test, self.folder = test, test.folder
        self.true = self.folder / "true"
        test.succeeds(SYNTH, "still-life", "-o", self.true, "--count", POSES, "--size", "144x96",
                      "--spacing", 0.01, "--samples", 4)
        self.text = json.loads((self.true / "transforms.json").read_text())
        self.text["lf_max_radiance"] = 4
        self.lights = {}
        for frame in self.text["frames"]:
            bgr = cv2.imread(str(self.true / frame["file_path"]), cv2.IMREAD_UNCHANGED)[..., :3]
            bgr = np.minimum(bgr, MOST)
            cv2.imwrite(str(self.true / frame["file_path"]), bgr.astype(np.float32))
            self.lights[frame["file_path"]] = bgr[..., ::-1]
        (self.true / "transforms.json").write_text(json.dumps(self.text))

    def write(self, name, stops_list, leave_out=None, **keys):
        """Writes a folder of noisy 8-bit pictures of all poses at these exposures."""
        field = self.folder / name
        field.mkdir()
        text = {k: v for k, v in self.text.items() if not k.startswith("lf_")} | keys
        text["frames"] = []
        random = np.random.default_rng(7)
        for frame in self.text["frames"]:
            for stops in stops_list:
                light = self.lights[frame["file_path"]] * 2.0 ** stops
                noise = random.standard_normal(light.shape)
                noisy = light + noise * np.sqrt(READ_NOISE ** 2 + SHOT_NOISE * light)
                file = f"{pathlib.Path(frame['file_path']).stem}_{stops:+d}.png"
                Image.fromarray(stored_of(noisy)).save(
                    field / file, exif=exif_of(stops, leave_out if len(text["frames"]) == 4 else None))
                text["frames"].append({"file_path": file,
                                       "transform_matrix": frame["transform_matrix"]})
        (field / "transforms.json").write_text(json.dumps(text))
        return field


def relative_error(frame, true, where):
    """Returns the root mean square and the mean of the difference between a frame and the true frame, over the elements
    `where`, in % of their true mean."""
    difference, light = (frame - true)[where], true[where].mean()
    return 100 * np.sqrt((difference ** 2).mean()) / light, 100 * difference.mean() / light


def far_from_lights(true):
    """Selects elements that are more than three elements away from highlights, around which cubic filters overshoot."""
    return cv2.dilate(true.max(-1), np.ones((7, 7)))[..., None] < 0.2


class BracketsTest(ProgramTestCase):
    def frame(self, *inputs, options=()):
        out = self.folder / f"frames {len(list(self.folder.iterdir()))}"
        self.succeeds(RENDERER, *inputs, "-o", out, "--format", "exr-float", "--no-contact-sheet",
                      *options)
        return cv2.imread(str(out / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., 2::-1]

    def merged(self, field, *options):
        out = self.folder / f"{field.name} merged"
        self.succeeds(IMPORTER, field, "-o", out, "--gain-from-exif", "--mask-clipped", *options)
        return out

    def test_brackets_give_the_light_of_floats(self):
        capture = Capture(self)
        path = self.folder / "path.yaml"
        self.succeeds(EXAMPLE, capture.true, "-o", path, "--move", "static", "--focus", 2.34)
        brackets = self.merged(capture.write("brackets", STOPS))
        middle = capture.write("middle", [0])
        text = json.loads((brackets / "transforms.json").read_text())
        self.assertEqual(text["lf_clipped"], "mask")
        self.assertEqual(text["lf_max_radiance"], 4)
        np.testing.assert_allclose([f.get("lf_gain", 1) for f in text["frames"][:3]], [0.25, 1, 4],
                                   rtol=1e-6)
        bicubic = ["--filter", "bicubic"]  # the default for brackets, but not for the true LF images
        for options in (bicubic, ["--estimator", "nearest"], [*bicubic, "--lens-weights", "none"],
                        ["--mode", "rebin"], [*bicubic, "--mode", "hybrid"]):
            true, merged, one = (self.frame(field, path, options=options)
                                 for field in (capture.true, brackets, middle))
            regions = {"highlights": true > 1.2,
                       "shadows": (true > 0.002) & (true < 0.03) & far_from_lights(true)}
            for region, where in regions.items():
                self.assertGreater(where.sum(), 100, region)
                of_merged, of_one = (relative_error(frame, true, where) for frame in (merged, one))
                print(f"{' '.join(options) or 'default'}: {region} ({where.sum()} values) of brackets "
                      f"{of_merged[0]:.2f} % (mean {of_merged[1]:+.2f} %), of the middle exposure "
                      f"{of_one[0]:.2f} % (mean {of_one[1]:+.2f} %)", file=sys.stderr)
                self.assertLess(of_merged[0], MOST_ERROR[region][0], (options, region))
                self.assertLess(of_merged[0], of_one[0], (options, region))
                self.assertLess(abs(of_merged[1]), MOST_ERROR[region][1], (options, region))

    def test_all_ways_of_rendering_have_the_same_bits(self):
        capture = Capture(self)
        path = self.folder / "path.yaml"
        self.succeeds(EXAMPLE, capture.true, "-o", path, "--move", "static")
        brackets = self.merged(capture.write("brackets", STOPS))
        self.succeeds(COMPRESSOR, brackets, "-o", self.folder / "store.lfs", "--profile", "lossless")
        for mode in ("collect", "hybrid", "rebin"):
            options = ["--mode", mode]
            plain = self.frame(brackets, path, options=options)
            np.testing.assert_array_equal(self.frame(self.folder / "store.lfs", path, options=options),
                                          plain, mode)
            out = self.folder / f"packages {mode}"
            self.succeeds(PREPROCESSOR, brackets, path, "-o", out, "--packages", 1, "--mode", mode)
            np.testing.assert_array_equal(self.frame(out / "package-0000.lfp", options=options), plain,
                                          mode)

    def test_a_state_of_other_masks_is_not_resumed(self):
        capture = Capture(self)
        path = self.folder / "path.yaml"
        self.succeeds(EXAMPLE, capture.true, "-o", path, "--move", "static")
        brackets = self.merged(capture.write("brackets", STOPS))
        render = (RENDERER, brackets, path, "-o", self.folder / "frames", "--no-contact-sheet", "--filter",
                  "bicubic")
        self.succeeds(*render, "--shard", "1/2")
        text = (brackets / "transforms.json").read_text()
        (brackets / "transforms.json").write_text(text.replace('"lf_clipped": "mask"',
                                                               '"lf_clipped": "keep"'))
        self.fails(2, ["light_field.encoding"], *render, "--shard", "1/2", "--resume")
        (brackets / "transforms.json").write_text(text.replace('"lf_clipped": "mask"',
                                                               '"lf_clipped": "black"'))
        self.fails(3, ["lf_clipped", "black", '"mask" or "keep"'], RENDERER, brackets, path, "-o",
                   self.folder / "others")

    def test_lfexample_takes_the_distance_between_poses(self):
        capture = Capture(self)
        brackets = self.merged(capture.write("brackets", STOPS))
        self.succeeds(EXAMPLE, brackets, "-o", self.folder / "path.yaml")

    def kinds(self, report):
        return [warning["kind"] for warning in report["warnings"]]

    def test_the_report_tells_brackets_and_what_to_do(self):
        capture = Capture(self)
        field = capture.write("brackets", STOPS)
        report = json.loads(self.succeeds(IMPORTER, field, "--json", "--distance", 1000))
        self.assertEqual(self.kinds(report), ["brackets"])
        self.assertIn("--gain-from-exif --mask-clipped", report["warnings"][0]["message"])
        self.assertEqual(report["brackets"], {"poses": POSES, "images": 3 * POSES, "exposures": [3, 3],
                                              "stops": [-2, 0, 2], "from": "files"})
        self.assertAlmostEqual(report["spacing_w"]["median"], 0.01, places=6)
        self.assertIn("25 poses x 3 exposures, -2, 0 and +2 stops by what the files state",
                      self.succeeds(IMPORTER, field))
        report = json.loads(self.succeeds(IMPORTER, field, "--json", "--gain-from-exif",
                                          "--distance", 1000))
        self.assertEqual(self.kinds(report), ["brackets"])
        self.assertTrue(report["warnings"][0]["message"].endswith(
            f"lfimport {field} --json --gain-from-exif --distance 1000 --mask-clipped -o merged"))
        self.assertEqual(report["exif_gains"], {"images": 3 * POSES, "gain_min": 0.25, "gain_max": 4,
                                                "has_f_numbers": True})
        report = json.loads(self.succeeds(IMPORTER, self.merged(field), "--json", "--distance", 1000))
        self.assertEqual(self.kinds(report), [])
        self.assertEqual(report["brackets"]["from"], "lf_gain")

    def test_matching_finds_gains_that_no_file_states(self):
        capture = Capture(self)
        field = capture.write("brackets", STOPS)
        for image in field.glob("*.png"):
            Image.fromarray(np.array(Image.open(image))).save(image)
        report = json.loads(self.succeeds(IMPORTER, field, "-o", self.folder / "matched", "--json",
                                          "--match-exposure", "--mask-clipped", "--distance", 1000))
        frames = json.loads((self.folder / "matched" / "transforms.json").read_text())["frames"]
        gains = np.array([frame["lf_gain"] for frame in frames]).reshape(POSES, 3, -1).mean(-1)
        self.assertLess(np.abs(gains / [0.25, 1, 4] - 1).max(), 0.05)
        self.assertEqual(self.kinds(report), [])
        self.assertEqual(report["brackets"]["from"], "lf_gain")

    def test_what_cannot_be_done_is_refused(self):
        capture = Capture(self)
        field = capture.write("brackets", STOPS, leave_out=ISO)
        out = ["-o", self.folder / "out"]
        self.fails(3, ["0001_+0.png", "states no ISO sensitivity", "1 of 75", "Exif"], IMPORTER, field, *out,
                   "--gain-from-exif")
        result = self.call(IMPORTER, field, *out, "--gain-from-exif", "--match-exposure")
        self.assertEqual(result.returncode, 2)
        self.assertFalse((self.folder / "out").exists())
        report = json.loads(self.succeeds(IMPORTER, capture.true, "--json", "--mask-clipped",
                                          "--distance", 1000))
        self.assertEqual(self.kinds(report), ["no-brackets"])
        self.succeeds(COMPRESSOR, capture.write("middle", [0]), "-o", self.folder / "store.lfs")
        for option in ("--gain-from-exif", "--mask-clipped"):
            self.fails(2, [option, "packed store", "compress"], IMPORTER, self.folder / "store.lfs", option)

    def test_light_that_all_exposures_clip_is_no_hole(self):
        capture = Capture(self)
        path = self.folder / "path.yaml"
        self.succeeds(EXAMPLE, capture.true, "-o", path, "--move", "static")
        both = self.merged(capture.write("both", [4, 3]))
        true, merged, darker = (self.frame(field, path)
                                for field in (capture.true, both, capture.write("darker", [3])))
        # White of the darker image, which has the reference exposure, is radiance 1/8; more light is not recorded.
        lit = true > 0.5
        self.assertGreater(lit.sum(), 100)
        self.assertLess(relative_error(merged, darker, lit)[0], 8)


if __name__ == "__main__":
    IMPORTER, RENDERER, SYNTH, EXAMPLE, PREPROCESSOR, COMPRESSOR = sys.argv[1:7]
    unittest.main(argv=sys.argv[:1], verbosity=2)
