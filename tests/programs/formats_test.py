#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads and renders one light field in every format; all results must agree.

usage: formats_test.py LFSYNTH LFEXAMPLE LFIMPORT LFRENDERER
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

import write_exports
import write_formats
import write_pictures
import write_scans

SYNTH = EXAMPLE = IMPORT = RENDERER = None


def run(*arguments):
    result = subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=300)
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: exit {result.returncode}\n{result.stderr}")


def picture(frames):
    """Returns linear RGB of the first frame, [height][width][3]."""
    bgr = cv2.imread(str(frames / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., :3]
    return bgr[..., ::-1].astype(np.float64)


def target_position(frame):
    """Returns (x, y) of the brightest spot in elements: the centroid of what is brighter than half of its maximum."""
    grey = frame.sum(axis=2)
    y, x = np.unravel_index(grey.argmax(), grey.shape)
    window = grey[max(0, y - 4):y + 5, max(0, x - 4):x + 5]
    weight = np.clip(window - 0.5 * window.max(), 0, None)
    rows, columns = np.indices(weight.shape)
    return (max(0, x - 4) + (columns * weight).sum() / weight.sum() + 0.5,
            max(0, y - 4) + (rows * weight).sum() / weight.sum() + 0.5)


def shift_between(a, b):
    """Returns the shift (x, y) of b relative to a in elements, by least squares over the picture."""
    grey, difference = (a + b).sum(axis=2) / 2, (b - a).sum(axis=2)
    inner = (slice(6, -6), slice(6, -6))
    rows, columns = (g[inner].ravel() for g in np.gradient(grey))
    difference = difference[inner].ravel()
    normal = [[columns @ columns, columns @ rows], [columns @ rows, rows @ rows]]
    return -np.linalg.solve(normal, [columns @ difference, rows @ difference])


class FormatsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        # Rotated and jittered cameras, so that no camera lies on the rim of the lens.
        cls.jittered = cls.synth("jittered", "still-life", "--jitter", 0.4, "--size", "120x80")
        cls.square = cls.synth("square", "still-life", "--jitter", 0.4, "--size", "80x80")
        cls.brown = cls.synth("brown", "still-life", "--jitter", 0.4, "--size", "120x80",
                              "--distortion=-0.2,0.06,0.003,-0.002")
        cls.rational = cls.synth("rational", "still-life", "--jitter", 0.4, "--size", "120x80",
                                 "--distortion=0.3,-0.1,0.001,-0.002,0.02,0.6,-0.05,0.01")
        cls.fisheye = cls.synth("fisheye", "still-life", "--jitter", 0.4, "--size", "120x80",
                                "--fisheye=-0.02,0.004,-0.002,0.0003")
        cls.fov = cls.synth("fov", "still-life", "--jitter", 0.4, "--size", "120x80",
                            "--fov", 0.93)
        cls.parallel = cls.synth("parallel", "lights", "--size", "120x80")
        cls.centre_at_origin(cls.parallel)
        cls.rendered = {}

    @classmethod
    def synth(cls, name, scene, *options):
        folder = cls.folder / name
        run(SYNTH, scene, "-o", folder, "--count", 25, "--format", "png", *options)
        return folder

    @staticmethod
    def centre_at_origin(folder):
        """Moves the world so that the grid is centred at the origin, in the plane z = 0."""
        field = json.loads((folder / "transforms.json").read_text())
        matrices = [np.array(f["transform_matrix"]) for f in field["frames"]]
        centre = np.mean([m[:3, 3] for m in matrices], axis=0)
        for frame, matrix in zip(field["frames"], matrices):
            matrix[:3, 3] -= centre
            frame["transform_matrix"] = matrix.tolist()
            frame.pop("lf_translation", None)
        (folder / "transforms.json").write_text(json.dumps(field))

    def native_frame(self, native):
        """Returns the path and the picture of the native form."""
        if native not in self.rendered:
            path = native.with_name(native.name + ".yaml")
            focus = [] if native == self.parallel else ["--focus", 0.69]
            run(EXAMPLE, native, "-o", path, "--move", "static", *focus)
            out = native.with_name(native.name + "-frames")
            run(RENDERER, native, path, "-o", out, "--frames", 1, "--format", "exr-float",
                "--estimator", "bilinear")
            self.rendered[native] = path, picture(out)
        return self.rendered[native]

    def check(self, writer, native, import_options=(), reads_itself=True):
        field = json.loads((native / "transforms.json").read_text())
        folder = self.folder / f"{native.name}-{writer.__name__}"
        folder.mkdir()
        light_field = writer(field, native, folder)
        imported = folder / "imported"
        run(IMPORT, light_field, "-o", imported, *import_options)
        self.compare_calibrations(field, json.loads((imported / "transforms.json").read_text()),
                                  writer.__name__)
        path, expected = self.native_frame(native)
        sources = [imported] + ([light_field] if reads_itself else [])
        for number, source in enumerate(sources):
            out = folder / f"frames{number}"
            run(RENDERER, source, path, "-o", out, "--frames", 1, "--format", "exr-float",
                "--estimator", "bilinear")
            frame = picture(out)
            rms = np.sqrt(np.mean((frame - expected) ** 2))
            self.assertGreater(expected.std(), 0.01)
            self.assertLessEqual(rms, 1e-4, source)
            shift = np.subtract(target_position(frame), target_position(expected))
            self.assertLessEqual(np.abs(shift).max(), 0.05, source)

    def compare_calibrations(self, native, imported, name):
        expected, found = write_formats.poses(native), write_formats.poses(imported)
        self.assertEqual(len(found), len(expected))
        # Both have the same number of frames in the same order; names may differ.
        if name.startswith("stanford"):
            found.sort(key=lambda pose: pose[0])
        for (_, rotation, translation), (file_path, rotation2, translation2) in zip(expected, found):
            self.assertLessEqual(np.abs(rotation - rotation2).max(), 1e-9, file_path)
            self.assertLessEqual(np.abs(rotation.T @ translation - rotation2.T @ translation2).max(),
                                 1e-9, file_path)
        keys = ["fl_x", "fl_y", "cx", "cy", "w", "h", "k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2",
                "lf_fov_omega"]
        for key in keys:
            self.assertAlmostEqual(native.get(key, 0), imported.get(key, 0), delta=1e-9, msg=key)
        self.assertEqual(native["camera_model"], imported["camera_model"])

    def test_the_native_form_lands_where_the_true_picture_does(self):
        # In a regular grid, the mean position of the cameras within the lens is the centre of the lens.
        chart = ("chart", "--count", 49, "--size", "120x80", "--format", "png")
        run(SYNTH, *chart, "-o", self.folder / "chart")
        path = self.folder / "chart.yaml"
        run(EXAMPLE, self.folder / "chart", "-o", path, "--move", "static", "--focus", 1.2)
        lines = ["frames: 1" if line.startswith("frames:") else line
                 for line in path.read_text().splitlines()]
        path.write_text("\n".join(lines) + "\n")
        run(SYNTH, *chart, "-o", self.folder / "truth", "--calibration-only", "--truth", path,
            "--truth-samples", 200)
        out = self.folder / "chart-frames"
        run(RENDERER, self.folder / "chart", path, "-o", out, "--format", "exr-float",
            "--estimator", "bilinear")
        frame, truth = picture(out), picture(self.folder / "truth" / "truth")
        self.assertEqual(truth.shape, frame.shape)
        self.assertLessEqual(np.abs(shift_between(truth, frame)).max(), 0.05)
        # The measure detects a shift of one element.
        self.assertGreater(shift_between(truth, np.roll(truth, 1, axis=1))[0], 0.8)

    def test_colmap_binary(self):
        for native in (self.jittered, self.brown, self.rational, self.fisheye, self.fov):
            with self.subTest(native.name):
                self.check(write_formats.colmap_binary, native)

    def test_colmap_text(self):
        for native in (self.jittered, self.brown, self.fov):
            with self.subTest(native.name):
                self.check(write_formats.colmap_text, native)

    def test_nerfstudio(self):
        for native in (self.jittered, self.brown, self.fisheye):
            with self.subTest(native.name):
                self.check(write_formats.nerfstudio, native)

    def test_blender(self):
        self.check(write_formats.blender, self.jittered)

    def test_middlebury(self):
        self.check(write_formats.middlebury, self.jittered)

    def test_llff(self):
        self.check(write_formats.llff, self.jittered)

    def test_aos(self):
        field = json.loads((self.square / "transforms.json").read_text())
        fov = 2 * np.degrees(np.arctan(0.5 * field["w"] / field["fl_x"]))
        self.check(write_formats.aos, self.square, ["--fov-deg", repr(float(fov))],
                   reads_itself=False)

    def test_hci(self):
        self.check(write_formats.hci, self.parallel)

    def test_stanford(self):
        self.check(write_formats.stanford, self.parallel)

    def test_stanford_without_positions(self):
        field = json.loads((self.parallel / "transforms.json").read_text())
        xs = sorted({round(f["transform_matrix"][0][3], 9) for f in field["frames"]})
        self.check(write_formats.stanford_without_positions, self.parallel,
                   ["--pitch", repr(float(xs[1] - xs[0])), "--focal-px", repr(field["fl_x"])],
                   reads_itself=False)

    def test_exports_of_other_programs(self):
        for write in (write_exports.write_opensfm, write_exports.write_bundler, write_exports.write_splat_cameras,
                      write_scans.write_metashape, write_scans.write_reality_csv, write_scans.write_reality_xmp):
            with self.subTest(write.__name__):
                self.check(write_formats.exported(write), self.jittered)

    def pictures_of_parallel(self):
        field = json.loads((self.parallel / "transforms.json").read_text())
        files = [self.parallel / frame["file_path"] for frame in field["frames"]]
        return [write_pictures.decoded_by_pillow(file) for file in files]

    def image_files(self, name, write, pictures):
        """Writes the light field `parallel` with pictures in a format, and returns its frame."""
        folder = self.folder / f"of {name}"
        folder.mkdir()
        field = json.loads((self.parallel / "transforms.json").read_text())
        for index, (frame, picture) in enumerate(zip(field["frames"], pictures)):
            frame["file_path"] = f"{index:02}-{name}"
            write(picture, folder / frame["file_path"])
        (folder / "transforms.json").write_text(json.dumps(field))
        return self.frame_of(folder)

    def frame_of(self, folder):
        path, _ = self.native_frame(self.parallel)
        out = folder / "frames"
        run(RENDERER, folder, path, "-o", out, "--frames", 1, "--format", "exr-float", "--estimator", "bilinear")
        return picture(out)

    def test_every_format_of_image_files(self):
        colour = self.pictures_of_parallel()
        grey = [picture[..., 1] for picture in colour]
        for pictures, formats in ((colour, write_pictures.FORMATS), (grey, write_pictures.GREY_FORMATS)):
            kind = "grey" if formats is write_pictures.GREY_FORMATS else "colour"
            expected = self.image_files(f"{kind}.png", write_pictures.by_pillow(), pictures)
            self.assertGreater(expected.std(), 0.01)
            for name, (write, most) in formats.items():
                with self.subTest(name):
                    frame = self.image_files(name, write, pictures)
                    difference = np.abs(frame - expected)
                    self.assertLessEqual(difference.max(), most)
                    self.assertLessEqual(difference.mean(), most / 5)

    def test_lossy_image_files_have_the_pixels_that_other_programs_decode(self):
        original = self.pictures_of_parallel()
        unharmed = self.image_files("unharmed.png", write_pictures.by_pillow(), original)
        for name, (write, decode) in write_pictures.LOSSY.items():
            with self.subTest(name):
                frame = self.image_files(name, write, original)
                folder = self.folder / f"of {name}"
                decoded = [decode(file) for file in sorted(folder.glob(f"*{name}"))]
                expected = self.image_files(f"decoded {name}.png", write_pictures.by_pillow(), decoded)
                np.testing.assert_array_equal(frame, expected)
                self.assertGreater(np.abs(frame - unharmed).max(), 0)
                self.assertLessEqual(np.abs(frame - unharmed).mean(), 0.02)

    def test_colour_profiles_of_image_files(self):
        pictures = self.pictures_of_parallel()
        profile = write_pictures.exchanged_profile()
        plain = self.image_files("without profile.png", write_pictures.by_pillow(), pictures)
        expected = self.image_files("with profile.png", write_pictures.by_pillow(icc_profile=profile), pictures)
        self.assertGreater(np.abs(expected - plain).max(), 0.01)
        for name, write in (("profile.webp", write_pictures.by_pillow(lossless=True, exact=True, icc_profile=profile)),
                            ("profile.jxl", write_pictures.by_program("cjxl", "-d", "0", "IN", "OUT", profile=profile)),
                            ("profile.tif", write_pictures.by_pillow(icc_profile=profile))):
            with self.subTest(name):
                np.testing.assert_array_equal(self.image_files(name, write, pictures), expected)

    def test_every_lens_gives_the_picture_of_the_pinhole(self):
        """Renders light fields whose LF cameras have other lenses. The tolerance is larger, because the pixels of
        these cameras are at other positions."""
        path, expected = self.native_frame(self.jittered)
        for native in (self.brown, self.rational, self.fisheye, self.fov):
            out = self.folder / f"{native.name}-as-pinhole"
            run(RENDERER, native, path, "-o", out, "--frames", 1, "--format", "exr-float",
                "--estimator", "bilinear")
            frame = picture(out)
            inner = (slice(12, -12), slice(18, -18))
            error = np.sqrt(np.mean((frame[inner] - expected[inner]) ** 2))
            with self.subTest(native.name):
                self.assertLessEqual(error, 0.03)
                shift = np.subtract(target_position(frame), target_position(expected))
                self.assertLessEqual(np.abs(shift).max(), 0.25)


if __name__ == "__main__":
    SYNTH, EXAMPLE, IMPORT, RENDERER = map(pathlib.Path, sys.argv[1:5])
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
