# SPDX-License-Identifier: Apache-2.0
"""Writes the light field of a transforms.json in other formats: with numpy from their documentation, independently of
the library.

Every writer gets the calibration (a parsed transforms.json whose images are in `source`) and a folder to fill.
"""
import json
import pathlib
import shutil
import struct

import numpy as np

import write_exports

COLMAP_MODELS = {"PINHOLE": 1, "OPENCV": 4, "OPENCV_FISHEYE": 5, "FULL_OPENCV": 6, "FOV": 7}


def poses(field):
    """Returns [(file name, rotation, translation)] of cam_from_world, x right, y down, z forward."""
    result = []
    for frame in field["frames"]:
        pose = np.array(frame["transform_matrix"])
        rotation = (pose[:3, :3] * [1, -1, -1]).T  # OpenGL axes, camera to world
        result.append((frame["file_path"], rotation, -rotation @ pose[:3, 3]))
    return result


def quaternion(rotation):
    """Returns (w, x, y, z)."""
    # All four candidates are multiples of the quaternion; the longest has the smallest rounding error.
    r = rotation
    candidates = [np.array([1 + r[0, 0] + r[1, 1] + r[2, 2], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0],
                            r[1, 0] - r[0, 1]]),
                  np.array([r[2, 1] - r[1, 2], 1 + r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0],
                            r[0, 2] + r[2, 0]]),
                  np.array([r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], 1 - r[0, 0] + r[1, 1] - r[2, 2],
                            r[1, 2] + r[2, 1]]),
                  np.array([r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1],
                            1 - r[0, 0] - r[1, 1] + r[2, 2]])]
    best = max(candidates, key=np.linalg.norm)
    return best / np.linalg.norm(best)


def copy_images(field, source, folder, rename=None):
    for index, frame in enumerate(field["frames"]):
        name = pathlib.Path(frame["file_path"]).name
        target = folder / (rename(index, name) if rename else name)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / frame["file_path"], target)


def colmap_camera(field):
    """Returns (model name, parameters) in COLMAP's order."""
    model = field["camera_model"]
    keys = {"PINHOLE": [], "OPENCV": ["k1", "k2", "p1", "p2"],
            "FULL_OPENCV": ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"],
            "OPENCV_FISHEYE": ["k1", "k2", "k3", "k4"], "FOV": ["lf_fov_omega"]}[model]
    return model, [field[k] for k in ("fl_x", "fl_y", "cx", "cy")] + [field[k] for k in keys]


def colmap_text(field, source, folder):
    copy_images(field, source, folder / "images")
    model = folder / "sparse" / "0"
    model.mkdir(parents=True)
    name, parameters = colmap_camera(field)
    numbers = " ".join(repr(float(p)) for p in parameters)
    (model / "cameras.txt").write_text(
        "# Camera list with one line of data per camera:\n"
        f"7 {name} {field['w']} {field['h']} {numbers}\n")
    lines = ["# Image list with two lines of data per image:"]
    for index, (file_path, rotation, translation) in enumerate(poses(field)):
        values = " ".join(repr(float(v)) for v in [*quaternion(rotation), *translation])
        lines += [f"{index + 3} {values} 7 {pathlib.Path(file_path).name}",
                  "12.5 13.25 -1 40.125 7.5 5"]
    (model / "images.txt").write_text("\n".join(lines) + "\n")
    (model / "points3D.txt").write_text("# none\n")
    return folder


def colmap_binary(field, source, folder):
    copy_images(field, source, folder / "images")
    model = folder / "sparse" / "0"
    model.mkdir(parents=True)
    name, parameters = colmap_camera(field)
    (model / "cameras.bin").write_bytes(
        struct.pack("<QIiQQ", 1, 7, COLMAP_MODELS[name], field["w"], field["h"]) +
        struct.pack(f"<{len(parameters)}d", *parameters))
    images = struct.pack("<Q", len(field["frames"]))
    for index, (file_path, rotation, translation) in enumerate(poses(field)):
        images += struct.pack("<I7dI", index + 3, *quaternion(rotation), *translation, 7)
        images += pathlib.Path(file_path).name.encode() + b"\0"
        images += struct.pack("<Q", 2)
        images += struct.pack("<ddqddq", 12.5, 13.25, -1, 40.125, 7.5, 5)
    (model / "images.bin").write_bytes(images)
    (model / "points3D.bin").write_bytes(struct.pack("<Q", 0))
    return folder


def nerfstudio(field, source, folder):
    """Writes a transforms.json without lf_ keys, with intrinsics in each frame, as for several cameras."""
    copy_images(field, source, folder / "images")
    intrinsics = {k: v for k, v in field.items() if not k.startswith("lf_") and k != "frames"}
    model = intrinsics.pop("camera_model")
    frames = [{"file_path": "images/" + pathlib.Path(f["file_path"]).name, **intrinsics,
               "transform_matrix": f["transform_matrix"]} for f in field["frames"]]
    (folder / "transforms.json").write_text(
        json.dumps({"camera_model": model, "frames": frames, "applied_scale": 1.0}))
    return folder


def blender(field, source, folder):
    """Writes the form of NeRF's synthetic scenes: a field of view, no size, names without extension."""
    copy_images(field, source, folder / "train")
    frames = [{"file_path": "./train/" + pathlib.Path(f["file_path"]).stem, "rotation": 0.01,
               "transform_matrix": f["transform_matrix"]} for f in field["frames"]]
    angle = 2 * np.arctan(0.5 * field["w"] / field["fl_x"])
    (folder / "transforms_train.json").write_text(
        json.dumps({"camera_angle_x": angle, "frames": frames}))
    return folder / "transforms_train.json"


def middlebury(field, source, folder):
    copy_images(field, source, folder)
    k = np.array([[field["fl_x"], 0, field["cx"] - 0.5], [0, field["fl_y"], field["cy"] - 0.5],
                  [0, 0, 1]])
    lines = [str(len(field["frames"]))]
    for file_path, rotation, translation in poses(field):
        numbers = [*k.ravel(), *rotation.ravel(), *translation]
        lines.append(" ".join([pathlib.Path(file_path).name, *(repr(float(v)) for v in numbers)]))
    (folder / "synth_par.txt").write_text("\n".join(lines) + "\n")
    return folder


def llff(field, source, folder):
    copy_images(field, source, folder / "images")
    rows = []
    for frame in field["frames"]:
        pose = np.array(frame["transform_matrix"])
        right, up, backwards, centre = pose[:3].T
        matrix = np.stack([-up, right, backwards, centre,
                           [field["h"], field["w"], field["fl_x"]]], axis=1)
        rows.append([*matrix.ravel(), 0.5, 20])
    np.save(folder / "poses_bounds.npy", np.array(rows))
    return folder


def aos(field, source, folder):
    copy_images(field, source, folder / "images")
    images = [{"imagefile": pathlib.Path(file_path).name,
               "M3x4": [[repr(float(v)) for v in (*row, t)]
                        for row, t in zip(rotation, translation)]}
              for file_path, rotation, translation in poses(field)]
    (folder / "poses.json").write_text(json.dumps({"images": images}))
    return folder


def grid(field):
    """Returns (row, column, x, y) of each camera of a grid of parallel cameras, R = I."""
    cameras = poses(field)
    xs = sorted({round(-t[0], 9) for _, _, t in cameras})
    ys = sorted({round(-t[1], 9) for _, _, t in cameras})
    return [(ys.index(round(-t[1], 9)), xs.index(round(-t[0], 9)), -t[0], -t[1])
            for _, _, t in cameras]


def stanford(field, source, folder):
    """Writes images whose names contain positions in millimetres, and the lens."""
    places = grid(field)

    def name(index, _):
        row, column, x, y = places[index]
        focal_mm = 36 * field["fl_x"] / field["w"]
        return (f"out_{row:02}_{column:02}_{1000 * y:.12f}_{1000 * x:.12f}_"
                f"{focal_mm:.12f}_36.png")
    copy_images(field, source, folder, name)
    return folder


def stanford_without_positions(field, source, folder):
    places = grid(field)
    copy_images(field, source, folder,
                lambda index, _: f"out_{places[index][0]:02}_{places[index][1]:02}.png")
    return folder


def hci(field, source, folder):
    """Writes the form of the 4D Light Field Benchmark: a grid row by row from the upper left, with the plane without
    disparity at infinity."""
    places = grid(field)
    rows, columns = (max(place[axis] for place in places) + 1 for axis in (0, 1))
    copy_images(field, source, folder, lambda index, _:
                f"input_Cam{places[index][0] * columns + places[index][1]:03}.png")
    xs = sorted({round(frame["transform_matrix"][0][3], 9) for frame in field["frames"]})
    (folder / "parameters.cfg").write_text(f"""[intrinsics]
focal_length_mm = {field["fl_x"] * 35 / max(field["w"], field["h"])!r}
image_resolution_x_px = {field["w"]}
image_resolution_y_px = {field["h"]}
sensor_size_mm = 35

[extrinsics]
num_cams_x = {columns}
num_cams_y = {rows}
baseline_mm = {1000 * (xs[1] - xs[0])!r}
focus_distance_m = 0
""")
    return folder


def exported(write):
    """Returns a writer of an export of another program, by a function of write_exports.py, for square pixels and a
    principal point in the middle."""
    def writer(field, source, folder):
        views = [write_exports.View(pathlib.Path(file_path).stem, rotation, -rotation.T @ translation,
                                    (field["w"], field["h"])) for file_path, rotation, translation in poses(field)]
        write(folder, views, focal_px=field["fl_x"])
        copy_images(field, source, folder / "images")
        return folder
    writer.__name__ = write.__name__
    return writer
