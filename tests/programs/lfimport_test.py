#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfimport: its light field gives the same film, and its report names the faults of a capture.

usage: lfimport_test.py LFIMPORT LFSYNTH LFEXAMPLE LFRENDERER TEST_DATA
"""
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image

from small_field import HEIGHT, PITCH, SIDE, WIDTH, write_field, write_path

IMPORT = SYNTH = EXAMPLE = RENDERER = TEST_DATA = None


def poses(calibration):
    frames = json.loads(pathlib.Path(calibration).read_text())["frames"]
    return {frame["file_path"].rsplit("/", 1)[-1]: np.array(frame["transform_matrix"])
            for frame in frames}


class ImportTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def run_tool(self, *arguments, code=0):
        result = subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=400)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def report(self, *arguments, code=0):
        return json.loads(self.run_tool(IMPORT, *arguments, "--json", code=code).stdout)

    def fails(self, code, words, *arguments):
        result = self.run_tool(IMPORT, *arguments, code=code)
        last = result.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("error: "), last)
        for word in words:
            self.assertIn(word, last)
        return result.stdout

    def frames(self, field, path, name):
        out = self.folder / name
        self.run_tool(RENDERER, field, path, "-o", out, "--format", "exr-float")
        digests = [hashlib.sha256(frame.read_bytes()).hexdigest()
                   for frame in sorted(out.glob("frame_*.exr"))]
        self.assertTrue(digests)
        return digests

    # Written light fields

    def test_a_written_light_field_films_the_same_bits(self):
        field = self.folder / "field"
        self.run_tool(SYNTH, "lights", "-o", field, "--count", 25, "--size", "60x40", "--bayer")
        path = self.folder / "path.yaml"
        self.run_tool(EXAMPLE, field, "-o", path, "--move", "orbit", "--focus", 1)
        path.write_text("\n".join("frames: 2" if line.startswith("frames:") else line
                                  for line in path.read_text().splitlines()) + "\n")
        report = self.report(field, "-o", self.folder / "deep" / "native")
        self.assertEqual((report["missing"], report["broken"]), (0, 0))
        native = self.folder / "deep" / "native"
        self.assertEqual(report["written"], str(native / "transforms.json"))
        self.assertEqual([file.name for file in native.iterdir()], ["transforms.json"])
        names = [frame["file_path"]
                 for frame in json.loads((native / "transforms.json").read_text())["frames"]]
        self.assertTrue(all(name.startswith("../../field/images/") for name in names), names[0])
        self.assertEqual(self.frames(field, path, "a"), self.frames(native, path, "b"))

    def test_scale_and_transform_move_the_world(self):
        field = write_field(self.folder / "field")
        before = poses(field)
        matrix = np.array([[0, -2, 0, 1], [2, 0, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1.]])
        (self.folder / "m.json").write_text(json.dumps(matrix.tolist()))
        np.savetxt(self.folder / "m.txt", matrix)
        words = ",".join(f"{x:g}" for x in matrix.ravel())
        for name in (self.folder / "m.json", self.folder / "m.txt", words):
            self.run_tool(IMPORT, field, "-o", self.folder / "out", "--transform", name, "--scale",
                          "0.5", "--unit-m", "0.25")
            written = json.loads((self.folder / "out" / "transforms.json").read_text())
            self.assertEqual(written["lf_unit_m"], 0.25)
            after = poses(self.folder / "out" / "transforms.json")
            self.assertEqual(len(after), SIDE * SIDE)
            for image, pose in after.items():
                expected = 0.5 * (matrix @ before[image][:, 3])[:3]
                np.testing.assert_allclose(pose[:3, 3], expected, atol=1e-14)
                np.testing.assert_allclose(pose[:3, :3], matrix[:3, :3] / 2 @ before[image][:3, :3],
                                           atol=1e-15)
        self.fails(3, ["right angles or equal lengths"], field, "--transform",
                   "1,0,0,0,0,2,0,0,0,0,1,0,0,0,0,1")
        self.fails(3, ["flatten or mirror"], field, "--transform", "1,0,0,0,0,1,0,0,0,0,-1,0,0,0,0,1")
        self.fails(3, ["none.txt"], field, "--transform", self.folder / "none.txt")

    def test_images_are_left_out_by_name_and_pattern(self):
        field = write_field(self.folder / "field")
        (self.folder / "bad.txt").write_text("image_24.png\nimage_23.png\n")
        report = self.report(field, "-o", self.folder / "out", "--exclude", "image_0*,image_11.png",
                             "--exclude", f"@{self.folder / 'bad.txt'}")
        self.assertEqual((report["images"], report["left_out"]), (12, 13))
        self.assertEqual(sorted(poses(self.folder / "out" / "transforms.json")),
                         [f"image_{i:02d}.png" for i in range(10, 23) if i != 11])
        self.fails(3, ["\"image_30*\" matches none of the 25 image names"], field, "--exclude", "image_30*")
        self.fails(3, ["match all 25 images"], field, "--exclude", "*")

    def test_a_calibration_of_the_user_is_never_replaced_unasked(self):
        field = write_field(self.folder / "field")
        text = field.read_text()
        self.fails(2, ["is the calibration that is read", "--force"], field, "-o", field.parent)
        self.assertEqual(field.read_text(), text)
        other = write_field(self.folder / "other")
        self.fails(2, ["not written by lfimport", "--force"], field, "-o", other.parent)
        self.assertEqual(other.read_text(), text)
        out = self.folder / "out"
        self.run_tool(IMPORT, field, "-o", out)
        self.run_tool(IMPORT, field, "-o", out, "--scale", 2)
        self.fails(2, ["is the calibration that is read"], out, "-o", out)
        (out / "transforms.json").write_text((out / "transforms.json").read_text() + "\n")
        self.fails(2, ["was changed since"], field, "-o", out)
        self.run_tool(IMPORT, field, "-o", out, "--force")
        self.run_tool(IMPORT, field, "-o", field.parent, "--force", "--scale", 2)
        self.assertAlmostEqual(poses(field)["image_00.png"][0, 3], -4 * PITCH)

    # Reports

    def test_the_report_tells_what_the_light_field_is(self):
        field = write_field(self.folder / "field", lf_depth_range=[0.5, 1.5])
        report = self.report(field)
        self.assertEqual(report["images"], SIDE * SIDE)
        self.assertIsNone(report["written"])
        camera, = report["cameras"]
        self.assertEqual(camera["model"], "pinhole")
        self.assertEqual(camera["size_px"], [WIDTH, HEIGHT])
        self.assertEqual((camera["images"], camera["distinct"]), (25, 1))
        self.assertAlmostEqual(camera["horizontal_fov_deg"]["median"],
                               np.degrees(2 * np.arctan(WIDTH / 2 / 70)))
        positions = np.array([pose[:3, 3] for pose in poses(field).values()])
        np.testing.assert_allclose(report["positions_w"]["min"], positions.min(axis=0), atol=1e-15)
        np.testing.assert_allclose(report["positions_w"]["max"], positions.max(axis=0), atol=1e-15)
        distances = np.linalg.norm(positions[:, None] - positions[None], axis=2)
        nearest = np.sort(np.where(distances == 0, 9, distances).min(axis=1))
        for key, expected in zip(("min", "median", "max"), nearest[[0, 12, 24]]):
            self.assertAlmostEqual(report["spacing_w"][key], expected)
        self.assertIsNone(report["axes_meet_at_w"])
        self.assertEqual(report["depth_range_w"], [0.5, 1.5])
        density = report["density"]
        self.assertEqual(density["distance_from"], "depth range")
        self.assertAlmostEqual(density["distance_w"], 0.75)
        self.assertAlmostEqual(density["disparity_px"], 70 * nearest[12] / 0.75)
        self.assertAlmostEqual(density["ghost_near_px"], density["disparity_px"] / 3)
        self.assertEqual(report["warnings"], [])
        text = self.run_tool(IMPORT, field).stdout
        self.assertRegex(text, r"(?m)^images +25, 0 missing, 0 broken$")
        self.assertRegex(text, r"(?m)^depth range +0.5 to 1.5$")
        self.assertNotIn("warning", text)

    def test_pixels_show_areas_or_points(self):
        def squares(index):
            lights = np.random.default_rng(index).integers(0, 2, (HEIGHT, WIDTH, 1), dtype=np.uint8) * 200 + 20
            return lights.repeat(29, axis=0).repeat(29, axis=1).repeat(3, axis=2)[:4 * HEIGHT, :4 * WIDTH]

        def areas(index):
            return squares(index).reshape(HEIGHT, 4, WIDTH, 4, 3).mean(axis=(1, 3)).astype(np.uint8)

        def written(name, *options):
            out = self.folder / f"{name} written"
            report = self.report(self.folder / name, "-o", out, *options)
            return report["pixels"], json.loads((out / "transforms.json").read_text()).get("lf_pixels")

        write_field(self.folder / "points", lambda index: squares(index)[::4, ::4])
        self.assertEqual(written("points"), ({"show": "points", "from": "images"}, "points"))
        self.assertEqual(written("points", "--check", "none"), (None, None))
        write_field(self.folder / "areas", areas)
        self.assertEqual(written("areas"), ({"show": "areas", "from": "images"}, None))
        write_field(self.folder / "stated", areas, lf_pixels="points")
        self.assertEqual(written("stated"), ({"show": "points", "from": "lf_pixels"}, "points"))
        self.assertRegex(self.run_tool(IMPORT, self.folder / "points").stdout, "(?m)^pixels +show the light of points")

    def test_missing_and_broken_images_are_counted_and_named(self):
        field = write_field(self.folder / "field")
        for index in range(6):
            (field.parent / f"image_{index:02d}.png").unlink()
        (field.parent / "image_10.png").write_text("no picture")
        Image.new("RGB", (WIDTH + 1, HEIGHT)).save(field.parent / "image_11.png")
        cut = field.parent / "image_12.png"
        cut.write_bytes(cut.read_bytes()[:2000])
        out = self.folder / "out"
        report = self.report(field, "-o", out, code=6)
        self.assertEqual((report["missing"], report["broken"]), (6, 2))
        missing, broken = report["warnings"]
        self.assertEqual((missing["kind"], missing["images"]), ("missing-images", 6))
        self.assertEqual(missing["names"], [f"image_{i:02d}.png" for i in range(5)])
        self.assertEqual((broken["kind"], broken["names"]),
                         ("broken-images", ["image_10.png", "image_11.png"]))
        self.assertEqual(len(poses(out / "transforms.json")), 25)
        self.assertEqual(self.report(field, "--check", "pixels", code=6)["broken"], 3)
        unchecked = self.report(field, "--check", "none")
        self.assertIsNone(unchecked["missing"])
        self.assertEqual(unchecked["warnings"], [])
        strict = self.folder / "strict"
        self.fails(3, ["6 of 25 images are missing, 2 broken", "nothing was written"], field, "-o",
                   strict, "--strict")
        self.assertFalse(strict.exists())
        for index in range(25):
            (field.parent / f"image_{index:02d}.png").unlink(missing_ok=True)
        self.fails(3, ["25 of 25 images are missing"], field, "-o", strict)
        self.assertFalse(strict.exists())

    def change(self, change):
        """Returns the kinds of warnings about a light field whose cameras look at one point, after change(frames)."""
        field = write_field(self.folder / "field")
        text = json.loads(field.read_text())
        for frame in text["frames"]:
            centre = np.array(frame["transform_matrix"])[:3, 3]
            back = centre - np.array([0, 0, -2])
            back /= np.linalg.norm(back)
            right = np.cross([0, 1, 0], back)
            right /= np.linalg.norm(right)
            pose = np.eye(4)
            pose[:3] = np.column_stack([right, np.cross(back, right), back, centre])
            frame["transform_matrix"] = pose
        change(text["frames"])
        for frame in text["frames"]:
            frame["transform_matrix"] = np.asarray(frame["transform_matrix"]).tolist()
        field.write_text(json.dumps(text))
        report = self.report(field)
        self.kinds = [warning["kind"] for warning in report["warnings"]]
        shown = self.run_tool(IMPORT, field).stdout
        for warning in report["warnings"]:
            self.assertIn(f"warning: {warning['kind']}: {warning['message']}", shown)
        return report["warnings"]

    def test_every_warning_has_its_cause(self):
        def turn(axes, *indices):
            def change(frames):
                for index in indices or range(len(frames)):
                    frames[index]["transform_matrix"][:3, :3] *= axes
            return change

        self.assertEqual(self.change(lambda frames: None), [])
        warnings = self.change(turn([-1, -1, 1], 3, 8))
        self.assertEqual(self.kinds, ["upside-down"])
        self.assertEqual(warnings[0]["names"], ["image_03.png", "image_08.png"])
        warnings = self.change(turn([-1, 1, -1], 7))
        self.assertEqual(self.kinds, ["facing-away"])
        self.assertEqual(warnings[0]["names"], ["image_07.png"])
        warnings = self.change(turn([1, -1, -1]))  # as if the file had OpenCV's axes
        self.assertEqual(self.kinds, ["diverging-axes"])
        self.assertIn("negate the 2nd and 3rd column", warnings[0]["message"])

        def repeat(frames):
            frames[4]["transform_matrix"] = frames[5]["transform_matrix"]
        warnings = self.change(repeat)
        self.assertEqual(self.kinds, ["repeated-positions"])
        self.assertEqual(warnings[0]["names"], ["image_04.png", "image_05.png"])
        field = self.folder / "field" / "transforms.json"
        sparse, = self.report(field, "--exclude", "image_04.png", "--distance", 0.3)["warnings"]
        self.assertEqual(sparse["kind"], "sparse")
        self.assertIn("pixels", sparse["message"])

    # Folders with missing information

    def write_grid(self):
        folder = self.folder / "a grid"
        folder.mkdir()
        for row in range(3):
            for column in range(4):
                pixels = np.random.default_rng(row * 4 + column).integers(0, 256, (24, 32, 3))
                Image.fromarray(pixels.astype(np.uint8)).save(folder / f"out_{row:02d}_{column:02d}.png")
        return folder

    def test_row_and_column_need_a_pitch(self):
        grid = self.write_grid()
        path = write_path(self.folder)
        for program, *rest in ((RENDERER, path, "-o", self.folder / "f"),
                               (EXAMPLE, "-o", self.folder / "p.yaml"), (IMPORT,)):
            last = self.run_tool(program, grid, *rest, code=3).stderr.strip().splitlines()[-1]
            command = f"lfimport '{grid}' -o '{grid}' --pitch 1 --focal-px 32 --plane-distance 100"
            if program == IMPORT:  # repeats the call
                command = f"lfimport '{grid}' --pitch 1 --focal-px 32 --plane-distance 100 -o '{grid}'"
            self.assertTrue(last.endswith(command), last)
        # The suggested command works.
        shell = command.replace("lfimport", str(IMPORT), 1)
        self.assertEqual(subprocess.run(shell, shell=True, capture_output=True).returncode, 0)
        self.run_tool(EXAMPLE, grid, "-o", self.folder / "p.yaml", "--focus", 10)
        after = poses(grid / "transforms.json")
        # In OpenGL y points up in the camera; in the world x still points right and y down.
        np.testing.assert_allclose(after["out_02_03.png"][:3, 3], [1.5, 1, 0], atol=0)
        # Again with another pitch: the file that lfimport wrote does not interfere.
        again = self.run_tool(IMPORT, grid, "-o", grid, "--pitch", 2, "--focal-px", 32)
        self.assertIn("is read instead", again.stderr)
        np.testing.assert_allclose(poses(grid / "transforms.json")["out_02_03.png"][:3, 3], [3, 2, 0])
        # Neither the report nor another folder needs -o of before; only the options of the names are given again.
        self.assertAlmostEqual(self.report(grid, "--pitch", 3, "--focal-px", 32)["spacing_w"]["median"], 3)
        self.run_tool(IMPORT, grid, "-o", self.folder / "other", "--pitch", 4, "--focal-px", 32, "--plane-distance", 90)
        self.assertAlmostEqual(self.report(self.folder / "other")["spacing_w"]["median"], 4)
        # Without these options, lfimport reads the file, as other programs do.
        self.assertAlmostEqual(self.report(grid)["spacing_w"]["median"], 2)
        self.run_tool(IMPORT, grid, "-o", self.folder / "copy")
        np.testing.assert_allclose(
            poses(self.folder / "copy" / "transforms.json")["out_02_03.png"][:3, 3], [3, 2, 0])
        (grid / "transforms.json").write_text((grid / "transforms.json").read_text() + "\n")
        self.fails(2, ["is the calibration that is read", "--force"], grid, "-o", grid)

    def test_poses_without_a_field_of_view_need_it(self):
        folder = self.folder / "aos"
        (folder / "images").mkdir(parents=True)
        Image.new("RGB", (40, 40)).save(folder / "images" / "a.png")
        matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
        (folder / "poses.json").write_text(json.dumps(
            {"images": [{"imagefile": "a.png", "M3x4": matrix}]}))
        self.fails(3, ["--fov-deg"], folder)
        camera, = self.report(folder, "--fov-deg", 50)["cameras"]
        self.assertAlmostEqual(camera["horizontal_fov_deg"]["median"], 50)
        (folder / "images").rename(self.folder / "elsewhere")
        report = self.report(folder, "--fov-deg", 50, "--images", self.folder / "elsewhere")
        self.assertEqual((report["images"], report["missing"]), (1, 0))

    def test_pitch_plane_and_signs_of_a_rectified_slab(self):
        grid = self.write_grid()
        self.run_tool(IMPORT, grid, "-o", self.folder / "out", "--pitch", "0.5,2", "--focal-px", 40,
                      "--plane-distance", 8, "--flip-y", "--distance", 8)
        frames = json.loads((self.folder / "out" / "transforms.json").read_text())["frames"]
        last = frames[-1]
        top = json.loads((self.folder / "out" / "transforms.json").read_text())
        self.assertEqual(last["file_path"], "../a grid/out_02_03.png")
        np.testing.assert_allclose(np.array(last["transform_matrix"])[:3, 3], [0.75, -2, 0])
        self.assertAlmostEqual(last["cx"], 16 + 40 * 0.75 / 8)
        self.assertAlmostEqual(last["cy"], 12 - 40 * 2 / 8)
        self.assertAlmostEqual(top["cx"], 16 - 40 * 0.75 / 8)
        report = self.report(self.folder / "out")
        np.testing.assert_allclose(report["axes_meet_at_w"], [0, 0, 8], atol=1e-9)
        for pitch in ("x", "1,", "1,2,3", "1 2", "0", "-1", "1,inf"):
            result = self.run_tool(IMPORT, grid, f"--pitch={pitch}", "--focal-px", 40, code=2)
            self.assertIn("pitch", result.stderr.strip().splitlines()[-1])
        field = write_field(self.folder / "field")
        self.fails(2, ["--pitch is only for folders"], field, "--pitch", 1)

    def test_the_cards_are_sharp_where_they_stand(self):
        cards = pathlib.Path(TEST_DATA) / "data" / "stanford-cards-9x9"
        if not cards.exists():
            self.skipTest(f"no test data at {cards} (set LF_TEST_DATA to the folder that holds it)")
        field = self.folder / "cards"
        report = self.report(cards, "-o", field, "--pitch", 1, "--focal-px", 768,
                             "--plane-distance", 100)
        self.assertEqual((report["images"], report["missing"], report["broken"]), (81, 0, 0))
        np.testing.assert_allclose(report["axes_meet_at_w"], [0, 0, 100], atol=1e-6)
        # If the images are shifted by s pixels per row and column and then added, the plane 1/Z = 1/Z0 + s/F is in
        # focus.
        shift = -1.5  # focuses on the standing cards; whole pixels, because rows and columns are even
        path = self.folder / "path.yaml"
        path.write_text(f"""format: lfpath 1
fps: 25
frames: 1
resolution: [768, 768]
camera:
  field_of_view_deg: {np.degrees(2 * np.arctan(0.5))}
  focal_length_mm: 50
  position: [0, 0, 0]
  look_at: [0, 0, 1]
  up: [0, -1, 0]
lens:
  aperture_diameter: 30
  focus_distance: {1 / (1 / 100 + shift / 768)}
""")
        self.run_tool(RENDERER, field, path, "-o", self.folder / "out", "--format", "png",
                      "--estimator", "nearest", "--lens-weights", "none")
        frame = np.asarray(Image.open(self.folder / "out" / "frame_0001.png")).astype(float) / 255
        # The expected picture, computed with numpy in linear light.
        total = np.zeros((768, 768, 3))
        count = np.zeros((768, 768, 1))
        for file in sorted((cards / "images").glob("*.jpg")):
            row, column = int(file.stem[4:6]) - 8, int(file.stem[7:9]) - 8
            srgb = np.asarray(Image.open(file)).astype(float) / 255
            light = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
            dy, dx = int(shift * row), int(shift * column)  # out(x) = image(x - s c), for row or column c
            source = light[max(0, -dy):768 - max(0, dy), max(0, -dx):768 - max(0, dx)]
            rows, columns = slice(max(0, dy), 768 + min(0, dy)), slice(max(0, dx), 768 + min(0, dx))
            total[rows, columns] += source
            count[rows, columns] += 1
        mean = total / np.maximum(count, 1)
        expected = np.where(mean <= 0.0031308, mean * 12.92, 1.055 * mean ** (1 / 2.4) - 0.055)
        inner = np.s_[40:-40, 40:-40]
        error = np.abs(frame - expected)[inner].mean()
        self.assertLess(error, 0.004)
        # The picture differs if the signs are wrong.
        self.assertGreater(np.abs(frame[::-1] - expected)[inner].mean(), 10 * error)

    def test_a_full_disk_is_an_error(self):
        field = write_field(self.folder / "field")
        with open("/dev/full", "w") as full:
            result = subprocess.run([IMPORT, field], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, 4)

    def test_help_has_examples(self):
        self.assertIn("lfimport capture/ -o native", self.run_tool(IMPORT, "--help").stdout)


if __name__ == "__main__":
    IMPORT, SYNTH, EXAMPLE, RENDERER, TEST_DATA = sys.argv[1:6]
    TEST_DATA = os.environ.get("LF_TEST_DATA", TEST_DATA)
    unittest.main(argv=sys.argv[:1])
