#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the add-on of Blender: what it captures is filmed like Cycles' own depth of field, cameras of every kind are
where transforms.json says, and a killed capture continues to the same files.

usage: blender_test.py LFRENDERER LFCAMMVMINFO LFPATH [TEST...]
Exit 77 if there is no blender: the test then counts as skipped, not as passed.
"""
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

from blender_run import BLENDER, ROOT, addon, command, scene_of
from program_test_case import ProgramTestCase, wait_until

sys.path.insert(0, str(ROOT / "blender" / "lfrendertools_blender"))
import rig

RENDERER = CAMMVMINFO = LFPATH = None
# Least quality of frames 1 and 5 of the scene "shop". With a lens that is turned by half a blade they have 42.2, 37.3.
TRUE_DB = {1: 43, 5: 47}
SAMPLES_OF_TRUTH = 2048

# Cameras that calibrations easily get wrong: arguments of blender_scene.dots, and options of the capture.
USUAL_CAMERA = dict(percentage=100, fit="AUTO", shift=(0, 0), parent_scale=None, aspect=(1, 1))
UPRIGHT, LYING = (90, 150), (150, 90)
ODD_CAMERAS = {
    "portrait": (dict(size=UPRIGHT), ""),
    "vertical fit": (dict(size=LYING, fit="VERTICAL"), ""),
    "vertical fit of a portrait": (dict(size=UPRIGHT, fit="VERTICAL"), ""),
    "horizontal fit of a portrait": (dict(size=UPRIGHT, fit="HORIZONTAL"), ""),
    "half the resolution": (dict(size=(301, 181), percentage=50), ""),
    "scaled parent": (dict(size=LYING, parent_scale=(2, 3, 0.5)), ""),
    "shifted lens": (dict(size=LYING, shift=(0.15, -0.2)), ""),
    "oblong pixels": (dict(size=LYING, aspect=(1, 1.5)), ""),
    "everything": (dict(size=(180, 300), percentage=50, fit="VERTICAL", shift=(-0.1, 0.1), parent_scale=(2, 2, 2)),
                   "--overscan 0.3 --shift"),
    "arc": (dict(size=LYING), "--rig arc --angle 20 20"),
    "dome": (dict(size=UPRIGHT, shift=(0.1, 0.1)), "--rig dome --angle 20 10"),
}
ALLOWED_PX = 0.05


def picture(file):
    return cv2.imread(str(file), cv2.IMREAD_UNCHANGED)[..., :3].astype(float)


def psnr(a, b):
    return -10 * math.log10(np.mean((a - b) ** 2))


def projected(field, frame, point):
    """Returns where a point of the world is in an LF image, by doc/formats/transforms_json.md."""
    k = {**field, **frame}
    x, y, z, _ = np.linalg.inv(np.array(frame["transform_matrix"])) @ [*point, 1]
    return np.array([k["cx"] - k["fl_x"] * x / z, k["cy"] + k["fl_y"] * y / z])


def centroid(image, place):
    """Returns the centroid of the light near a place."""
    left, top = (max(int(x) - 12, 0) for x in place)
    part = image[top:int(place[1]) + 12, left:int(place[0]) + 12].sum(axis=2)
    y, x = np.mgrid[:part.shape[0], :part.shape[1]] + 0.5
    return np.array([(part * x).sum(), (part * y).sum()]) / part.sum() + [left, top]


class FilmTest(ProgramTestCase):
    def test_a_film_of_the_capture_is_like_the_depth_of_field_of_cycles(self):
        """One Blender unit is 10 cm here: Cycles' aperture does not know about it."""
        scene, field = self.folder / "shop.blend", self.folder / "field"
        scene_of("shop", file=str(scene), unit=0.1)
        addon(scene, "capture", field, "--count", 15, 15, "--spacing", 0.02, 0.02, "--overscan", 0.2)
        addon(scene, "export-path", self.folder / "path.yaml")
        self.succeeds(RENDERER, field, self.folder / "path.yaml", "-o", self.folder / "film", "--format", "exr-float",
                      "--frames", "1,5")
        for frame, least_db in TRUE_DB.items():
            truth = self.folder / f"truth_{frame}.exr"
            scene_of("truth", file=str(scene), frame=frame, output=str(truth), samples=SAMPLES_OF_TRUTH)
            film = picture(self.folder / "film" / f"frame_{frame:04d}.exr")
            self.assertGreater(psnr(film, picture(truth)), least_db, frame)


class OddCamerasTest(ProgramTestCase):
    def test_dots_are_where_transforms_json_says(self):
        places = [(0.2, 0.2), (0.8, 0.25), (0.5, 0.5), (0.25, 0.75), (0.8, 0.8)]
        for name, (arguments, options) in ODD_CAMERAS.items():
            scene, field = self.folder / f"{name}.blend", self.folder / name
            scene_of("dots", file=str(scene), places=places, **{**USUAL_CAMERA, **arguments})
            addon(scene, "capture", field, "--count", 2, 2, "--spacing", 0.1, 0.1, *options.split())
            dots = json.loads(pathlib.Path(f"{scene}.json").read_text())
            calibration = json.loads((field / "transforms.json").read_text())
            for frame in calibration["frames"]:
                image = picture(field / frame["file_path"])
                self.assertEqual(image.shape[:2], (calibration["h"], calibration["w"]))
                for dot in dots:
                    place = projected(calibration, frame, dot)
                    with self.subTest(camera=name, image=frame["file_path"], place=place):
                        error = np.abs(centroid(image, place) - place).max()
                        self.assertLess(error, ALLOWED_PX)


class ResumeTest(ProgramTestCase):
    def files(self, field):
        return {path.relative_to(field): path.read_bytes() for path in field.rglob("*") if path.is_file()}

    def test_a_killed_capture_continues_to_the_same_files(self):
        scene = self.folder / "shop.blend"
        scene_of("shop", file=str(scene), unit=1)
        options = ["--count", 7, 5, "--float"]
        addon(scene, "capture", self.folder / "whole", *options)
        killed = self.folder / "killed"
        images = lambda: list(killed.glob("images/[!.]*.exr"))
        for count, number, code in ((3, signal.SIGINT, 5), (9, signal.SIGKILL, -signal.SIGKILL)):
            process = subprocess.Popen(command(scene, "capture", killed, *options), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            wait_until(lambda: len(images()) >= count, process)
            process.send_signal(number)
            self.assertEqual(process.wait(), code)
            self.assertIn(len(images()), range(count, 35))

        # The part that is there makes a film of the whole lens, and the film says that it is a part.
        addon(scene, "export-path", self.folder / "path.yaml", "--frames", 1, 1)
        self.succeeds(RENDERER, killed, self.folder / "path.yaml", "-o", self.folder / "film", code=6)

        # A file that was cut off by other means is rendered again.
        images()[0].write_bytes(images()[0].read_bytes()[:-100])
        addon(scene, "capture", killed, *options)
        self.assertEqual(self.files(killed), self.files(self.folder / "whole"))
        self.assertIn("0 LF images rendered", addon(scene, "capture", killed, *options))

        addon(scene, "capture", self.folder / "shop.blend" / "inside_a_file", *options, code=4)
        addon(scene, "capture", killed, "--spacing", 0, 1, code=2)
        # Another rig is not mixed with this one.
        self.assertIn("describes another capture (blender, frames)",
                      addon(scene, "capture", killed, "--count", 7, 6, "--float", code=3))


class PathTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "traveller.blend"
        scene_of("traveller", file=str(self.scene))

    def exported(self, scene, name):
        """Exports a path. Returns how lfcammvminfo reads it."""
        addon(scene, "export-path", self.folder / name)
        return json.loads(self.succeeds(CAMMVMINFO, self.folder / name, "--json"))

    def cameras(self, scene):
        """Returns what Blender says about the scene's camera in each frame."""
        file = self.folder / "cameras.json"
        scene_of("cameras", file=str(scene), output=str(file))
        return json.loads(file.read_text())

    def test_the_path_has_the_cameras_of_the_scene(self):
        path = self.exported(self.scene, "path.yaml")
        self.assertAlmostEqual(path["fps"], 24 / 1.001, places=6)
        self.assertEqual(path["resolution"], [90, 150])
        cameras = self.cameras(self.scene)
        self.assertEqual(len(path["cameras"]), len(cameras))
        for ours, blenders in zip(path["cameras"], cameras):
            np.testing.assert_allclose(ours["position_w"], blenders["position"], rtol=0, atol=1e-8)
            np.testing.assert_allclose(ours["up"], blenders["axes"][1], rtol=0, atol=3e-7)
            np.testing.assert_allclose(ours["forward"], np.negative(blenders["axes"][2]), rtol=0, atol=3e-7)
            self.assertAlmostEqual(ours["focal_length_mm"] / blenders["lens"], 1, delta=1e-8)
            right, up = np.divide(ours["shift_mm"], ours["focal_length_mm"])
            np.testing.assert_allclose([right, up], blenders["middle"], rtol=0, atol=1e-6)
            view = math.atan(blenders["half_view"] + right) + math.atan(blenders["half_view"] - right)
            self.assertAlmostEqual(ours["field_of_view_deg"][0], math.degrees(view), delta=1e-5)
            self.assertEqual(ours["blades"], blenders["blades"])
            self.assertAlmostEqual(ours["focus_distance_w"] / blenders["focus"], 1, delta=1e-8)
            if blenders["use_dof"]:
                self.assertEqual(ours["ratio"], blenders["ratio"])
                longer = 1 / min(1, blenders["ratio"])  # side of the opening, in diameters of Blender's
                self.assertAlmostEqual(ours["f_number"] * longer / blenders["fstop"], 1, delta=1e-8)
                self.assertAlmostEqual(ours["blade_rotation_deg"], 90 + math.degrees(blenders["rotation"]), delta=1e-6)
            else:
                self.assertEqual(ours["aperture_diameter_mm"], 0)

    def test_a_path_without_depth_of_field_says_so(self):
        """Depth of field is off in the cameras of Blender, unless somebody switches it on."""
        scene = self.folder / "plain.blend"
        scene_of("plain", file=str(scene), size=(150, 90), frames=3)
        self.assertIn("warning: depth of field is off, so that the path films a pinhole",
                      addon(scene, "export-path", self.folder / "pinhole.yaml"))
        said = addon(scene, "capture", self.folder / "field", "--plan", "--depth-range", 2, 5)
        self.assertIn("Camera's lens: none: Depth of Field is off", said)
        # The f-stop that it names is that of a lens which the rig fills.
        said = addon(scene, "export-path", self.folder / "again.yaml")
        stop = float(re.search(r"F-Stop of at least ([\d.]+)", said)[1])
        scene_of("changed", file=str(scene), dof__use_dof=True, dof__aperture_fstop=stop)
        self.assertNotIn("warning", addon(scene, "export-path", self.folder / "lens.yaml"))
        said = addon(scene, "capture", self.folder / "field", "--plan", "--depth-range", 2, 5)
        self.assertRegex(said, r"Camera's lens: [\d.]+ \S+\n")
        self.assertGreater(self.exported(scene, "lens.yaml")["cameras"][0]["aperture_diameter_mm"], 100)

    def test_an_imported_path_is_exported_again(self):
        path = self.exported(self.scene, "path.yaml")
        addon(self.scene, "import-path", self.folder / "path.yaml", "-o", self.folder / "imported.blend",
              "--lfcammvminfo", CAMMVMINFO)
        again = self.exported(self.folder / "imported.blend", "again.yaml")
        self.assertAlmostEqual(path.pop("fps"), again.pop("fps"), places=5)
        for ours, theirs in zip(path.pop("cameras"), again.pop("cameras"), strict=True):
            self.assertEqual(ours.pop("blades"), theirs.pop("blades"))
            self.assertAlmostEqual(ours.pop("time_s"), theirs.pop("time_s"), places=5)
            # Imported cameras have another sensor, and a focal length and a shift that make up for it.
            scale = ours.pop("focal_length_mm") / theirs.pop("focal_length_mm")
            self.assertAlmostEqual(ours.pop("f_number") or 0, (theirs.pop("f_number") or 0) * scale, places=5)
            np.testing.assert_allclose(np.multiply(theirs.pop("shift_mm"), scale), ours.pop("shift_mm"), atol=1e-5)
            del ours["depth_of_field_w"], theirs["depth_of_field_w"]  # infinite without an aperture
            for name in ours:
                np.testing.assert_allclose(theirs[name], ours[name], rtol=2e-6, atol=2e-6, err_msg=name)
        self.assertEqual(path, again)

    def test_refuses_what_a_path_cannot_tell(self):
        for values, words in (({"dof__aperture_ratio": 20}, "ratio of the camera 'camera' is 20"),
                              ({"dof__aperture_ratio": 2}, "the anamorphic ratio of the camera changes"),
                              ({"type": "ORTHO"}, "type ORTHO")):
            scene = self.folder / "refused.blend"
            shutil.copy(self.scene, scene)
            scene_of("changed", file=str(scene), **values)
            words_of_blender = addon(scene, "export-path", self.folder / "refused.yaml", code=3)
            self.assertIn(words, words_of_blender.strip().splitlines()[-1])
            self.assertFalse((self.folder / "refused.yaml").exists())


class NumberedFilmTest(ProgramTestCase):
    def test_frames_keep_the_numbers_of_the_scene(self):
        """A film of the frames 1001 to 1048 of a scene goes into the sequencer, and its path into another scene."""
        first, last = 1001, 1048
        scene, field, path = self.folder / "shot.blend", self.folder / "field", self.folder / "path.yaml"
        scene_of("numbered", file=str(scene), first=first, last=last)
        addon(scene, "export-path", path)
        self.assertIn(f"\nfirst_frame: {first}\n", path.read_text())
        addon(scene, "capture", field, "--count", 5, 5, "--spacing", 0.05, 0.05, "--overscan", 0.2)
        film = self.folder / "film"
        self.succeeds(RENDERER, field, path, "-o", film, "--no-contact-sheet")
        frames = sorted(film.glob("frame_*.exr"))
        self.assertEqual([frame.name for frame in frames], [f"frame_{n}.exr" for n in range(first, last + 1)])
        self.succeeds(RENDERER, field, path, "-o", self.folder / "few", "--frames", "1001,1010", "--no-contact-sheet")
        for name in ("frame_1001.exr", "frame_1010.exr"):
            self.assertEqual((self.folder / "few" / name).read_bytes(), (film / name).read_bytes())

        shown = (first, 1010, last)
        scene_of("strip", files=list(map(str, frames)), first=first, frames=shown, folder=str(self.folder))
        pictures = {n: picture(film / f"frame_{n}.exr") for n in shown}
        for number in shown:
            seen = picture(self.folder / f"{number}.exr")
            np.testing.assert_allclose(seen, pictures[number], rtol=2e-3, atol=2e-3)
        self.assertGreater(np.abs(pictures[first] - pictures[last]).max(), 0.05)

        # Frames before 0 have no number in a path.
        addon(scene, "export-path", self.folder / "zero.yaml", "--frames", 0, 1)
        self.assertIn("\nfirst_frame: 0\n", (self.folder / "zero.yaml").read_text())
        self.assertIn("warning: frame -2 of the scene is frame 1 of the path",
                      addon(scene, "export-path", self.folder / "below.yaml", "--frames", -2, 1))
        self.assertNotIn("first_frame", (self.folder / "below.yaml").read_text())

        # Back: the range of another scene becomes that of the path, and the path stays the same.
        other = self.folder / "other.blend"
        scene_of("plain", file=str(other), size=(64, 48), frames=3)
        addon(other, "import-path", path, "-o", self.folder / "back.blend", "--lfcammvminfo", CAMMVMINFO)
        addon(self.folder / "back.blend", "export-path", self.folder / "again.yaml")
        for key in ("first_frame", "frames", "fps", "resolution"):
            line = re.search(rf"^{key}: .*$", path.read_text(), re.M)[0]
            self.assertIn(f"\n{line}\n", (self.folder / "again.yaml").read_text())


MOVING = """format: lfpath 1
fps: 25
frames: 6
resolution: [150, 90]
camera: {focal_length_mm: 30, focal_length_speed_mm: 60, position: [0.5, -1.2, -3], speed: [4, 1, 2],
         look_at: [0.2, 0.3, 0.5], up: [0.3, -1, 0.2], roll_deg: 150, roll_speed_deg: 400}
lens: {aperture_diameter: 0, focus_distance: 2}
"""


class ChanTest(ProgramTestCase):
    """Blender comes with an add-on for .chan files: it must read and write the cameras that lfpath writes and reads."""

    def told(self, path, *options):
        return json.loads(self.succeeds(LFPATH, path, "--json", "-q", *options))["cameras"]

    def test_blender_reads_and_writes_the_cameras_of_a_chan(self):
        (self.folder / "path.yaml").write_text(MOVING)
        path = self.told(self.folder / "path.yaml")
        for order in "zxy", "xyz":
            chan, scene, file = self.folder / f"{order}.chan", self.folder / f"{order}.blend", self.folder / "c.json"
            self.succeeds(LFPATH, self.folder / "path.yaml", "-o", chan, "--rotation-order", order, "-q")
            scene_of("chan", file=str(scene), path=str(chan), order=order.upper(), size=(150, 90), frames=6)
            scene_of("cameras", file=str(scene), output=str(file))
            again = self.told(f"{chan}.again", "--rotation-order", order, "--resolution", "150x90", "--fps", 25)
            blenders = json.loads(file.read_text())
            self.assertEqual((len(blenders), len(again)), (6, 6))
            for ours, blender, read in zip(path, blenders, again):
                right = np.cross(ours["forward"], ours["up"])
                axes = [right, ours["up"], np.negative(ours["forward"])]
                np.testing.assert_allclose(blender["axes"], axes, rtol=0, atol=1e-5)
                np.testing.assert_allclose(blender["position"], ours["position_w"], rtol=0, atol=1e-5)
                half_view = math.tan(math.radians(ours["field_of_view_deg"][0] / 2))
                self.assertAlmostEqual(blender["half_view"], half_view, delta=1e-5)
                for name in "position_w", "forward", "up":
                    np.testing.assert_allclose(read[name], ours[name], rtol=0, atol=1e-5)
                self.assertAlmostEqual(read["field_of_view_deg"][1], ours["field_of_view_deg"][1], delta=1e-4)


class RigTest(unittest.TestCase):
    def test_coarse_grids_come_first(self):
        order = rig.coarse_first(rig.Rig(columns=15, rows=7))
        self.assertEqual(sorted(order), list(range(15 * 7)))
        coarse = {(row, column) for row in range(0, 7, 2) for column in range(0, 15, 2)}
        self.assertEqual({(i // 15, i % 15) for i in order[:len(coarse)]}, coarse)

    def test_cameras_of_a_dome_face_the_pivot_at_its_distance(self):
        for shape, axes in (("DOME", 3), ("ARC", 1)):
            one = rig.Rig(shape, columns=5, rows=3, spacing=(0.1, 0.1), angle=(0.6, 0.4), pivot=2)
            for pose in rig.poses(one):
                faced = pose[:3, 3] - 2 * pose[:3, 2]
                np.testing.assert_allclose(faced[[0, 2, 1][:axes]], [0, -2, 0][:axes], atol=1e-12)
                np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-12)
                self.assertAlmostEqual(np.linalg.det(pose[:3, :3]), 1)
            self.assertGreater(rig.poses(one)[2 * 5][2, 2], 0.9)


if __name__ == "__main__":
    RENDERER, CAMMVMINFO, LFPATH = sys.argv[1:4]
    if BLENDER is None:
        print("skipped: there is no blender here (scripts/install_packages.sh blender)")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
