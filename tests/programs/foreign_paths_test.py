#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads camera paths in the formats of other programs. The files are written here, with NumPy and from the formats'
documentation alone (doc/formats/foreign_paths.md); the cameras must be those they were written of. Writes such paths
with lfpath, and reads them here; rendered again, they must give the same frames.

usage: foreign_paths_test.py LFCAMMVMINFO LFPATH LFSYNTH LFRENDERER
"""
import json
import os
import re
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from program_test_case import ProgramTestCase

INFO = PATH = SYNTH = RENDERER = None
OPENGL = np.diag([1.0, -1.0, -1.0])  # turns the camera axes right, down, forward to right, up, backward
CYCLE = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])  # instant-ngp's coordinates are y, z, x


def rotation(generator):
    """Returns a random rotation."""
    q, r = np.linalg.qr(generator.normal(size=(3, 3)))
    q = q @ np.diag(np.sign(np.diag(r)))
    return q if np.linalg.det(q) > 0 else q @ np.diag([1, 1, -1.0])


def quaternion(matrix):
    """Returns x, y, z, w of a rotation: the eigenvector of the matrix of Bar-Itzhack."""
    m = matrix
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
                  [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
                  [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)]]) / 3
    return np.linalg.eigh(k)[1][:, -1]


def matrix_of(q):
    """Returns the rotation of a quaternion x, y, z, w."""
    (x, y, z), w = q[:3] / np.linalg.norm(q), q[3] / np.linalg.norm(q)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


# A film in which everything moves; the sensor of a breathing lens stands farther away than its focal length.
LIVELY = """format: lfpath 1
fps: 12.5
frames: 4
resolution: [60, 40]
camera: {sensor_width_mm: 36, focal_length_mm: 40, focal_length_speed_mm: 20, position: [-0.002, -0.127, -0.8],
         speed: [0.01, 0.005, -0.002], look_at: [0, -0.1, 0], up: [0.1, -1, 0]}
lens: {aperture_diameter: 0.02, aperture_diameter_speed: -0.01, focus_distance: 0.6, focus_distance_speed: 0.5,
       blades: 5, blade_rotation_deg: 12, blade_roundness: 0.2, ratio: 1.2, breathing: true,
       focus_tilt_deg: {horizontal: 4, vertical: -7}}
"""


class Camera:
    """A random camera: `axes` has the columns right, down, forward in the world."""

    def __init__(self, generator):
        self.axes = rotation(generator)
        self.centre = generator.uniform(-3, 3, 3)
        self.vertical_deg = generator.uniform(20, 90)
        self.focus, self.diameter = generator.uniform(1, 5), generator.uniform(0, 0.2)


def pose_of(fact):
    """Returns axes and centre that lfcammvminfo tells."""
    forward, up = np.array(fact["forward"]), np.array(fact["up"])
    return np.column_stack([np.cross(forward, up), -up, forward]), np.array(fact["position_w"])


class ForeignPathsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        generator = np.random.default_rng(5)
        self.generator = generator
        self.cameras = [Camera(generator) for _ in range(6)]

    def facts(self, path, *options):
        return json.loads(self.succeeds(INFO, path, "--json", *options))

    def agrees(self, facts, axes, centre, vertical_deg, tolerance=1e-9):
        found_axes, found_centre = pose_of(facts)
        self.assertLessEqual(np.abs(found_axes - axes).max(), tolerance)
        self.assertLessEqual(np.abs(found_centre - centre).max(), tolerance)
        self.assertLessEqual(abs(facts["field_of_view_deg"][1] - vertical_deg), tolerance)

    def write(self, name, value):
        (self.folder / name).write_text(json.dumps(value))
        return self.folder / name

    def nerfstudio(self, scale=1, turn=np.eye(3), shift=np.zeros(3), **keys):
        """Returns a file whose cameras are in the trained space scale (turn x + shift)."""
        frames = []
        for camera in self.cameras:
            matrix = np.eye(4)
            matrix[:3, :3] = turn @ camera.axes @ OPENGL
            matrix[:3, 3] = scale * (turn @ camera.centre + shift)
            frames.append({"camera_to_world": matrix.ravel().tolist(), "fov": camera.vertical_deg, "aspect": 1.5})
        return self.write("camera_path.json", {
            "camera_type": "perspective", "render_width": 300, "render_height": 200, "fps": 12,
            "seconds": len(frames) / 12, "keyframes": [], "camera_path": frames, **keys})

    def test_nerfstudio_in_the_world(self):
        path = self.facts(self.nerfstudio())
        self.assertEqual((path["fps"], path["frames"], path["resolution"]), (12, 6, [300, 200]))
        for camera, facts in zip(self.cameras, path["cameras"]):
            self.agrees(facts, camera.axes, camera.centre, camera.vertical_deg)

    def test_nerfstudio_in_the_trained_space(self):
        scale, turn, shift = 0.37, rotation(self.generator), np.array([1, -2, 0.5])
        path = self.nerfstudio(scale, turn, shift)
        transform = np.column_stack([turn, shift]).tolist()
        self.write("dataparser_transforms.json", {"transform": transform, "scale": scale})
        for camera, facts in zip(self.cameras, self.facts(path)["cameras"]):
            self.agrees(facts, camera.axes, camera.centre, camera.vertical_deg)

    def ngp_key(self, camera, scale=0.33, offset=0.5, timestamp=None):
        key = {"R": quaternion(CYCLE @ camera.axes).tolist(),
               "T": (CYCLE @ (scale * camera.centre + offset)).tolist(), "slice": -0.5,
               "scale": scale * camera.focus + 0.5, "fov": camera.vertical_deg,
               "aperture_size": scale * camera.diameter / 2}
        return key if timestamp is None else {**key, "timestamp": timestamp}

    def test_nerfstudio_with_matrices_in_rows(self):
        """Scripts write a matrix as NumPy's tolist() does, with or without its last row."""
        path = json.loads(self.nerfstudio().read_text())
        for rows in 4, 3:
            for frame, camera in zip(path["camera_path"], self.cameras):
                frame["camera_to_world"] = np.reshape(frame["camera_to_world"], (-1, 4))[:rows].tolist()
            for camera, facts in zip(self.cameras, self.facts(self.write("rows.json", path))["cameras"]):
                self.agrees(facts, camera.axes, camera.centre, camera.vertical_deg)

    def test_poses_that_nerfstudio_exports(self):
        """ns-export cameras writes the poses of the trained space, and no intrinsics."""
        scale, turn, shift = 0.37, rotation(self.generator), np.array([1, -2, 0.5])
        poses = [{"file_path": f"images/{i}.png",
                  "transform": np.column_stack([turn @ camera.axes @ OPENGL,
                                                scale * (turn @ camera.centre + shift)]).tolist()}
                 for i, camera in enumerate(self.cameras)]
        file = self.write("transforms_train.json", poses)
        transform = np.column_stack([turn, shift]).tolist()
        self.write("dataparser_transforms.json", {"transform": transform, "scale": scale})
        words = ["--resolution", "300x200", "--focal-length-mm", 27, "--fps", 12, "--json"]
        vertical = np.degrees(2 * np.arctan(36 / 27 / 2 * 200 / 300))
        for camera, facts in zip(self.cameras, json.loads(self.succeeds(PATH, file, *words))["cameras"]):
            self.agrees(facts, camera.axes, camera.centre, vertical)
        self.assertIn("no field of view (that of a lens of 50 mm", self.call(INFO, file).stderr)
        self.fails(3, ["ns-export cameras", "no intrinsics", "transforms.json"], RENDERER, file, file, "-o",
                   self.folder / "frames")

    def test_radians_are_never_taken_for_degrees(self):
        path = json.loads(self.nerfstudio().read_text())
        for frame in path["camera_path"]:
            frame["fov"] = np.radians(frame["fov"])
        chan = self.folder / "radians.chan"
        chan.write_text("1 0 0 0 0 0 0 0.87\n")
        key = {"R": [0, 0, 0, 1], "T": [0, 0, 0], "slice": 1, "scale": 1, "fov": 0.87, "aperture_size": 0}
        for file in self.write("radians.json", path), chan, self.write("base_cam.json", {"path": [key]}):
            for program in INFO, PATH:
                self.fails(3, ["so that the unit is uncertain", "lfpath --fov-unit radians"], program, file)
            self.succeeds(PATH, file, "--fov-unit", "degrees", "-q")
        told = json.loads(self.succeeds(PATH, self.folder / "radians.json", "--fov-unit", "radians", "--json"))
        for camera, facts in zip(self.cameras, told["cameras"]):
            self.agrees(facts, camera.axes, camera.centre, camera.vertical_deg)
        self.fails(3, ["in radians"], PATH, self.nerfstudio(), "--fov-unit", "radians")

    def test_a_long_lens_of_our_own_is_not_asked_for_its_unit(self):
        """A path that we wrote states the field of view twice."""
        text = LIVELY.replace("focal_length_mm: 40, ", "focal_length_mm: 900, ")
        (self.folder / "tele.yaml").write_text(text.replace("breathing: true", "breathing: false"))
        for form in "nerfstudio", "instant-ngp":
            file = self.folder / f"{form}.json"
            self.succeeds(PATH, self.folder / "tele.yaml", "-o", file, "--format", form)
            self.assertLess(self.facts(file)["cameras"][0]["field_of_view_deg"][1], 3)

    def test_files_of_other_programs_are_named(self):
        for name, text, words in (
                ("scene.fbx", "Kaydara FBX Binary  ", "FBX scene"), ("scene.abc", "Ogawa", "Alembic scene"),
                ("scene.usda", "#usda 1.0\n(\n)\n", "USD scene"), ("scene.usdz", "PK", "USD scene"),
                ("scene.gltf", '{"asset": {"version": "2.0"}}', "glTF scene"), ("scene.blend", "BLENDER", "Blender"),
                ("comp.nk", "set cut_paste_input [stack 0]\n", "script of Nuke"),
                ("export.py", "import hou\n", "script of Python"),
                ("take.csv", "Frame,Location X\n1,0\n", "such as Unreal"), ("walk.bvh", "HIERARCHY\n", "skeleton"),
                ("points.ply", "ply\nformat ascii 1.0\n", "PLY file"), ("film.mp4", "\0\0\0\x18ftypmp42", "a video")):
            (self.folder / name).write_text(text)
            self.fails(3, [words, "is not read as a camera path: "], INFO, self.folder / name)

    def test_a_file_of_a_colmap_model_stands_for_the_model(self):
        folder = self.calibration("colmap")
        model = folder / "sparse" / "0" if (folder / "sparse").is_dir() else folder
        self.assertEqual(self.facts(model / "images.txt"), self.facts(folder))
        (model / "cameras.txt").unlink()
        self.fails(3, ["one file of a COLMAP model", "give this folder"], INFO, model / "images.txt")

    def test_instant_ngp_with_its_lens(self):
        """With order 0 and a loop, six frames are the six keyframes."""
        path = self.write("base_cam.json", {"path": [self.ngp_key(c) for c in self.cameras], "spline_order": 0,
                                            "loop": True, "duration_seconds": 6 / 30})
        found = self.facts(path)
        self.assertEqual((found["fps"], found["frames"], found["resolution"]), (30, 6, [1920, 1080]))
        for camera, facts in zip(self.cameras, found["cameras"]):
            self.agrees(facts, camera.axes, camera.centre, camera.vertical_deg)
            self.assertAlmostEqual(facts["focus_distance_w"], camera.focus, delta=1e-9)
            self.assertAlmostEqual(facts["aperture_diameter_mm"] / 1000, camera.diameter, delta=1e-9)

    def test_instant_ngp_curves(self):
        def basis(order, u):
            if order == 0:
                return 1.0 * ((u >= 0) & (u < 1))
            return (u * basis(order - 1, u) + (order + 1 - u) * basis(order - 1, u - 1)) / order

        ends = np.cumsum(self.generator.uniform(0.2, 1, 6))
        keys = [self.ngp_key(c, timestamp=end) for c, end in zip(self.cameras, ends)]
        for order in 1, 2, 3:
            path = self.write("base_cam.json", {"path": keys, "spline_order": order, "loop": False,
                                                "duration_seconds": 2})
            found = self.facts(path)["cameras"]
            self.assertEqual(len(found), 60)
            for i, facts in enumerate(found):
                place = np.interp(i / 60 * ends[4], [0, *ends[:5]], range(6))
                sum_q, sum_t, sum_fov = np.zeros(4), np.zeros(3), 0
                for k in range(-2, 9):
                    weight = basis(order, place - k + (order + 1) // 2)
                    key = keys[min(max(k, 0), 5)]
                    q = np.array(key["R"])
                    sum_q = sum_q + weight * (q if q @ sum_q >= 0 else -q)
                    sum_t, sum_fov = sum_t + weight * np.array(key["T"]), sum_fov + weight * key["fov"]
                centre = (CYCLE.T @ sum_t - 0.5) / 0.33
                self.agrees(facts, CYCLE.T @ matrix_of(sum_q), centre, sum_fov, 1e-8)

    def test_instant_ngp_in_the_space_of_a_transforms_json(self):
        path = self.write("base_cam.json", {"path": [self.ngp_key(self.cameras[0], 0.8, 0.1)]})
        self.write("transforms.json", {"scale": 0.8, "offset": [0.1, 0.1, 0.1], "frames": []})
        camera = self.cameras[0]
        self.agrees(self.facts(path)["cameras"][0], camera.axes, camera.centre, camera.vertical_deg)

    def lively(self, shift_mm="{horizontal: 0, vertical: 0}"):
        """Returns the file of the lively path and what lfcammvminfo tells about it."""
        path = self.folder / "lively.yaml"
        path.write_text(LIVELY.replace("up: ", f"shift_mm: {shift_mm}, up: "))
        return path, self.facts(path)

    def convert(self, path, name, *options):
        self.succeeds(PATH, path, "-o", self.folder / name, *options)
        return self.folder / name

    def test_what_is_written_for_nerfstudio_is_as_its_documentation_says(self):
        path, facts = self.lively()
        scale, turn, shift = 0.37, rotation(self.generator), np.array([1, -2, 0.5])
        trained = self.write("t.json", {"transform": np.column_stack([turn, shift]).tolist(), "scale": scale})
        world = json.loads(self.convert(path, "w.json").read_text())
        moved = json.loads(self.convert(path, "m.json", "--out-dataparser-transforms", trained).read_text())
        self.assertEqual((world["fps"], world["render_width"], world["render_height"]), (12.5, 60, 40))
        self.assertEqual(len(world["camera_path"]), 4)
        for fact, frame, other in zip(facts["cameras"], world["camera_path"], moved["camera_path"]):
            axes, centre = pose_of(fact)
            matrix, trained_matrix = (np.reshape(f["camera_to_world"], (4, 4)) for f in (frame, other))
            self.assertLessEqual(np.abs(matrix[:3, :3] @ OPENGL - axes).max(), 1e-9)
            self.assertLessEqual(np.abs(matrix[:3, 3] - centre).max(), 1e-9)
            self.assertLessEqual(np.abs(trained_matrix[:3, :3] @ OPENGL - turn @ axes).max(), 1e-9)
            self.assertLessEqual(np.abs(trained_matrix[:3, 3] - scale * (turn @ centre + shift)).max(), 1e-9)
            self.assertAlmostEqual(frame["fov"], fact["field_of_view_deg"][1], delta=1e-9)

    def test_what_is_written_for_instant_ngp_is_as_its_source_says(self):
        path, facts = self.lively()
        keys = json.loads(self.convert(path, "b.json", "--format", "instant-ngp").read_text())
        # instant-ngp films n frames at i / n, where the last but one timestamp ends the film.
        ends = [key["timestamp"] for key in keys["path"]]
        self.assertEqual((keys["spline_order"], len(ends)), (1, 5))
        for i, fact in enumerate(facts["cameras"]):
            self.assertAlmostEqual(i / 4 * ends[3], ends[i - 1] if i else 0, delta=1e-12)
            key, (axes, centre) = keys["path"][i], pose_of(fact)
            self.assertLessEqual(np.abs(CYCLE.T @ matrix_of(np.array(key["R"])) - axes).max(), 1e-9)
            self.assertLessEqual(np.abs((CYCLE.T @ key["T"] - 0.5) / 0.33 - centre).max(), 1e-9)
            self.assertAlmostEqual((key["slice"] + key["scale"]) / 0.33, fact["focus_distance_w"], delta=1e-9)
            self.assertAlmostEqual(key["aperture_size"] / 0.33 * 2000, fact["aperture_diameter_mm"], delta=1e-9)
            self.assertAlmostEqual(key["fov"], fact["field_of_view_deg"][1], delta=1e-9)

    def test_frames_keep_their_numbers(self):
        """A shot has the frames 1001 to 1048 in every program."""
        file = self.folder / "shot.chan"
        file.write_text("".join(f"{frame} {frame / 100} 2 3 0 0 0 40\n" for frame in range(1001, 1049)))
        for form, name in (("chan", "out.chan"), ("yaml", "out.yaml"), ("nerfstudio", "a.json"),
                           ("instant-ngp", "b.json")):
            self.succeeds(PATH, file, "-o", self.folder / name, "--format", form)
            told = self.facts(self.folder / name)
            self.assertEqual([camera["frame"] for camera in told["cameras"]], list(range(1001, 1049)), form)
            self.assertEqual(told["cameras"][0]["time_s"], 0)
        numbers = np.loadtxt(self.folder / "out.chan")[:, 0]
        self.assertEqual(numbers.tolist(), list(range(1001, 1049)))
        self.succeeds(PATH, file, "-o", self.folder / "out.usda")
        usda = (self.folder / "out.usda").read_text()
        self.assertIn("startTimeCode = 1001\n    endTimeCode = 1048\n", usda)
        samples = re.search(r"xformOp:transform.timeSamples = {\n(.*?)\n    }", usda, re.S)[1]
        self.assertEqual([int(line.split(":")[0]) for line in samples.splitlines()], list(range(1001, 1049)))
        # Other numbers are given by an option.
        self.succeeds(PATH, file, "-o", self.folder / "one.chan", "--first-frame", 1)
        self.assertEqual(np.loadtxt(self.folder / "one.chan")[:, 0].tolist(), list(range(1, 49)))
        file.write_text("-1 0 0 0 0 0 0 40\n0 0 0 0 0 0 0 40\n")
        told = self.call(INFO, file, "--json")
        self.assertIn("frames are numbered from 1; set --first-frame", told.stderr)
        self.assertEqual([camera["frame"] for camera in json.loads(told.stdout)["cameras"]], [1, 2])

    def test_chan_in_any_order_of_rotations(self):
        def about(axis, degrees):
            c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
            turn = np.eye(3)
            i, j = (axis + 1) % 3, (axis + 2) % 3
            turn[[i, j], [i, j]], turn[i, j], turn[j, i] = c, -s, s
            return turn

        path, facts = self.lively()
        for order in "xyz", "xzy", "yxz", "yzx", "zxy", "zyx":
            words = () if order == "zxy" else ("--rotation-order", order)  # zxy is the default
            angles = self.generator.uniform(-200, 200, (3, 3))
            places = self.generator.uniform(-3, 3, (3, 3))
            file = self.folder / "in.chan"
            file.write_text("".join(f"{frame}\t" + "\t".join(map(str, [*places[i], *angles[i], 30 + i])) + "\n"
                                    for i, frame in enumerate((1001, 1002, 1003))))
            read = json.loads(self.succeeds(PATH, file, "--json", "--resolution", "90x60", *words))
            for place, turns, fov, fact in zip(places, angles, (30, 31, 32), read["cameras"]):
                axes = np.eye(3)
                for letter in order:
                    axes = about("xyz".index(letter), turns["xyz".index(letter)]) @ axes
                self.agrees(fact, axes @ OPENGL, place, fov)
            self.convert(path, f"{order}.chan", *words)
            for line, fact in zip(np.loadtxt(self.folder / f"{order}.chan"), facts["cameras"]):
                axes = np.eye(3)
                for letter in order:
                    axes = about("xyz".index(letter), line[4 + "xyz".index(letter)]) @ axes
                self.agrees(fact, axes @ OPENGL, line[1:4], line[7], 1e-5)

    def calibration(self, form):
        """Returns a transforms.json, a COLMAP model or a cameras.json of the cameras, 300 x 200 pixels each."""
        focal = [100 / np.tan(np.radians(camera.vertical_deg / 2)) for camera in self.cameras]
        if form == "transforms.json":
            frames = []
            for number, (camera, f) in enumerate(zip(self.cameras, focal)):
                matrix = np.eye(4)
                matrix[:3, :3], matrix[:3, 3] = camera.axes @ OPENGL, camera.centre
                frames.append({"file_path": f"{number}.png", "transform_matrix": matrix.tolist(), "fl_x": f})
            return self.write(form, {"w": 300, "h": 200, "cx": 170, "cy": 90, "frames": frames})
        if form == "cameras.json":
            return self.write(form, [{"id": 0, "img_name": "a", "width": 300, "height": 200, "fx": f, "fy": f,
                                      "position": camera.centre.tolist(), "rotation": camera.axes.tolist()}
                                     for camera, f in zip(self.cameras, focal)])
        model = self.folder / "colmap" / "sparse" / "0"
        model.mkdir(parents=True)
        (model / "cameras.txt").write_text("".join(f"{i} PINHOLE 300 200 {f} {f} 150 100\n"
                                                   for i, f in enumerate(focal, 1)))
        lines = []
        for i, camera in enumerate(self.cameras, 1):
            x, y, z, w = quaternion(camera.axes.T)
            t = " ".join(map(str, -camera.axes.T @ camera.centre))
            lines.append(f"{i} {w} {x} {y} {z} {t} {i} image{i}.png\n\n")
        (model / "images.txt").write_text("".join(lines))
        return self.folder / "colmap"

    def test_cameras_of_calibrations_are_frames(self):
        for form in "transforms.json", "cameras.json", "colmap":
            path = self.facts(self.calibration(form))
            self.assertEqual((path["frames"], path["resolution"]), (6, [300, 200]))
            for camera, facts in zip(self.cameras, path["cameras"]):
                focal, centre = 100 / np.tan(np.radians(camera.vertical_deg / 2)), 90 if form[0] == "t" else 100
                vertical = np.degrees(np.arctan(centre / focal) + np.arctan((200 - centre) / focal))
                self.agrees(facts, camera.axes, camera.centre, vertical)

    def test_off_centre_frames_show_their_part_of_the_picture(self):
        """The left half of a frame is the frame of half the width that has the same intrinsics."""
        path, _ = self.lively("{horizontal: 0.5, vertical: -0.3}")
        whole = json.loads(self.convert(path, "whole.json", "--frames", 1).read_text())
        half = json.loads(json.dumps(whole))
        half["render_width"] = 30
        field = self.folder / "field"
        self.succeeds(SYNTH, "still-life", "-o", field, "--count", 25, "--size", "60x40", "--format", "png")
        pictures = []
        for name, value in ("whole", whole), ("half", half):
            film = self.folder / f"film of {name}"
            # Lens weights depend on the whole plate.
            self.succeeds(RENDERER, field, self.write(f"{name}.json", value), "-o", film, "--format", "exr-float",
                          "--lens-weights", "none")
            pictures.append(cv2.imread(str(film / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., :3])
        self.assertEqual(pictures[1].shape, (40, 30, 3))
        self.assertGreater(pictures[1].max(), 0.1)
        self.assertLessEqual(np.abs(pictures[0][:, :30] - pictures[1]).max(), 1e-6)

    def samples(self, text, name):
        """Returns the values of an attribute of a .usda file in each frame; it has one value if they are equal."""
        if constant := re.search(rf" {name} = (\S+)", text):
            return [float(constant[1])] * len(self.cameras)
        samples = re.search(rf" {name}.timeSamples = {{(.*?)}}", text, re.S)[1]
        return [float(value.split(":")[1]) for value in samples.split(",") if value.strip()]

    def test_usda_holds_an_off_centre_principal_point(self):
        text = self.convert(self.calibration("transforms.json"), "frames.usda", "--focus-distance", 2).read_text()
        focal = [float(value) for value in re.search(r"focalLength.timeSamples = {(.*?)}", text, re.S)[1].replace(
            ",", " ").replace(":", " ").split()[1::2]]
        for axis, size, offset in ("horizontal", 300, 150 - 170), ("vertical", 200, 90 - 100):
            apertures, offsets = (self.samples(text, axis + name) for name in ("Aperture", "ApertureOffset"))
            for camera, f, aperture, moved in zip(self.cameras, focal, apertures, offsets):
                focal_px = 100 / np.tan(np.radians(camera.vertical_deg / 2))
                self.assertAlmostEqual(aperture / f, size / focal_px, delta=1e-9)
                self.assertAlmostEqual(moved / f, offset / focal_px, delta=1e-9)

    def test_usda_states_the_camera_in_its_units(self):
        path, facts = self.lively()
        text = self.convert(path, "camera.usda", "--unit-m", 0.5).read_text()
        self.assertTrue(text.startswith("#usda 1.0"))
        for words in "timeCodesPerSecond = 12.5", "endTimeCode = 4", "metersPerUnit = 0.5":
            self.assertIn(words, text)
        facts = self.facts(path, "--unit-m", 0.5)

        def samples(name):
            match = re.search(rf" {name}(?:\.timeSamples = {{(.*?)}}| = (.*?)\n)", text, re.S)
            if match[2]:
                return [eval(match[2])] * 4
            return list(eval("{" + match[1] + "}").values())

        names = ("focalLength", "horizontalAperture", "verticalAperture", "focusDistance", "fStop", "xformOp:transform",
                 "horizontalApertureOffset")
        for fact, focal, width, height, focus, stop, matrix, offset in zip(facts["cameras"], *map(samples, names)):
            matrix, (axes, centre) = np.array(matrix), pose_of(fact)
            self.assertLessEqual(np.abs(matrix[:3, :3].T @ OPENGL - axes).max(), 1e-9)  # rows are the axes
            self.assertLessEqual(np.abs(matrix[3] - [*centre, 1]).max(), 1e-9)
            self.assertLessEqual(np.abs(matrix[:3, 3]).max(), 0)
            self.assertAlmostEqual(focal / 10 * 0.5 * 1000, fact["focal_length_mm"], delta=1e-9)
            view = np.degrees(2 * np.arctan(np.divide([width, height], 2 * focal)))
            self.assertLessEqual(np.abs(view - fact["field_of_view_deg"]).max(), 1e-9)
            self.assertAlmostEqual(focus, fact["focus_distance_w"], delta=1e-9)
            self.assertAlmostEqual(stop, fact["f_number"], delta=1e-9)
            self.assertAlmostEqual(offset / width, fact["shift_mm"][0] / 36, delta=1e-9)

    def test_json_renders_to_the_same_bits(self):
        path, _ = self.lively("{horizontal: 0.5, vertical: -0.3}")
        field = self.folder / "field"
        self.succeeds(SYNTH, "still-life", "-o", field, "--count", 9, "--size", "60x40", "--format", "png",
                      "--jitter", 0.4)
        films = {}
        for name, options in (("lively.yaml", None), ("n.json", []), ("b.json", ["--format", "instant-ngp"])):
            written = path if options is None else self.convert(path, name, *options)
            film = self.folder / f"film of {name}"
            self.succeeds(RENDERER, field, written, "-o", film, "--no-contact-sheet")
            films[name] = [(film / f"frame_{i:04d}.exr").read_bytes() for i in (1, 2, 3, 4)]
        self.assertEqual(len(set(films["lively.yaml"])), 4)
        self.assertEqual(films["n.json"], films["lively.yaml"])
        self.assertEqual(films["b.json"], films["lively.yaml"])

    def test_our_own_format_holds_every_camera(self):
        path, facts = self.lively("{horizontal: 0.5, vertical: -0.3}")
        again = self.facts(self.convert(self.convert(path, "n.json"), "again.yaml"))
        self.assertEqual((again["fps"], again["frames"], again["resolution"]), (12.5, 4, [60, 40]))
        for old, new in zip(facts["cameras"], again["cameras"]):
            # A breathing lens is written with the sensor width of its view, which has other millimetres.
            for name in set(old) - {"shift_mm"}:
                self.assertLessEqual(np.abs(np.subtract(old[name], new[name])).max(), 1e-9, name)

    def test_paths_are_moved_scaled_and_resampled(self):
        path, facts = self.lively()
        turn, shift = rotation(self.generator), np.array([3, 1, -2])
        matrix = np.eye(4)
        matrix[:3] = np.column_stack([2 * turn, shift])
        moved = self.convert(path, "moved.json", "--transform", " ".join(map(str, matrix.ravel())), "--scale", 0.25)
        for old, new in zip(facts["cameras"], self.facts(moved)["cameras"]):
            (axes, centre), (new_axes, new_centre) = pose_of(old), pose_of(new)
            self.assertLessEqual(np.abs(turn @ axes - new_axes).max(), 1e-9)
            self.assertLessEqual(np.abs(0.25 * (2 * turn @ centre + shift) - new_centre).max(), 1e-9)
            self.assertAlmostEqual(new["focus_distance_w"], old["focus_distance_w"] / 2, delta=1e-9)
        fine = self.facts(self.convert(path, "fine.yaml", "--fps", 25))
        self.assertEqual((fine["fps"], fine["frames"]), (25, 7))
        slow = self.facts(self.convert(path, "slow.yaml", "--frames", 7))
        self.assertEqual((slow["fps"], slow["frames"]), (12.5, 7))
        for new in fine, slow:
            for old, frame in zip(facts["cameras"], new["cameras"][::2]):
                self.assertLessEqual(np.abs(np.subtract(old["position_w"], frame["position_w"])).max(), 1e-9)

    def test_options_state_what_a_path_lacks(self):
        path = self.nerfstudio(lf_space="world")
        full = self.convert(path, "full.yaml", "--f-number", 2, "--focus-distance", 3, "--sensor-width-mm", 24,
                            "--resolution", "150x100")
        self.assertEqual(self.call(INFO, full).stderr, "")
        facts = self.facts(full)
        self.assertEqual(facts["resolution"], [150, 100])
        for camera, fact in zip(self.cameras, facts["cameras"]):
            self.agrees(fact, camera.axes, camera.centre, camera.vertical_deg)
            self.assertAlmostEqual(fact["f_number"], 2, delta=1e-9)
            self.assertAlmostEqual(fact["focus_distance_w"], 3, delta=1e-9)
            focal_mm = 12 / np.tan(np.radians(fact["field_of_view_deg"][0] / 2))
            self.assertAlmostEqual(fact["focal_length_mm"], focal_mm, delta=1e-9)

    def test_without_an_output_the_cameras_are_told(self):
        path, facts = self.lively()
        self.assertEqual(self.succeeds(PATH, path), self.succeeds(INFO, path))
        self.assertEqual(json.loads(self.succeeds(PATH, path, "--json")), facts)

    def test_files_are_replaced_on_demand_only(self):
        path, _ = self.lively()
        self.fails(2, ["lively.yaml: exists", "--overwrite"], PATH, path, "-o", path)
        self.fails(2, ["out.xyz", "--format"], PATH, path, "-o", self.folder / "out.xyz")
        self.succeeds(PATH, path, "-o", path, "--overwrite", "--frames", 2)
        self.assertEqual(self.facts(path)["frames"], 2)

    def test_other_views_and_files_are_refused(self):
        self.fails(3, ["camera_type", "fisheye", "Perspective"], INFO, self.nerfstudio(camera_type="fisheye"))
        self.fails(3, ["other.json", "found 'cameras'", "camera_path (nerfstudio)"], INFO,
                   self.write("other.json", {"cameras": []}))
        self.fails(3, ["holds no camera path", "COLMAP"], INFO, self.folder)

    def test_what_is_missing_is_told(self):
        result = self.call(INFO, self.nerfstudio())
        for words in "no aperture (a pinhole", "no focus distance (1 world unit", "36 mm", "dataparser_transforms":
            self.assertIn(words, result.stderr)


if __name__ == "__main__":
    INFO, PATH, SYNTH, RENDERER = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1], verbosity=2)
