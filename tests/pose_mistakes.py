# SPDX-License-Identifier: Apache-2.0
"""Usual mistakes in a transforms.json: matrices the wrong way round, axes of another convention, names shifted, images
mirrored, focal lengths in other units. Each returns a light field that is wrong in one way."""
import copy
import json
import os
import pathlib

import numpy as np
from PIL import Image

OPENGL = np.diag([1.0, -1, -1, 1])  # converts camera axes between OpenGL and OpenCV


def _each_pose(change):
    def mistake(field):
        for frame in field["frames"]:
            frame.pop("lf_translation", None)  # more digits of the recorded position
            frame["transform_matrix"] = change(np.array(frame["transform_matrix"], float)).tolist()
    return mistake


def _rotation_transposed(pose):
    pose = pose.copy()
    pose[:3, :3] = pose[:3, :3].T
    return pose


def _colmap_rotation_transposed(pose):
    """The quaternion of COLMAP was conjugated, the translation was kept."""
    camera = np.linalg.inv(pose @ OPENGL)
    camera[:3, :3] = camera[:3, :3].T
    return np.linalg.inv(camera) @ OPENGL


def _position_for_translation(pose):
    """COLMAP's translation was taken as the position of the camera."""
    camera = np.linalg.inv(pose @ OPENGL)
    wrong = pose.copy()
    wrong[:3, 3] = camera[:3, 3]
    return wrong


def _of_positions(matrix):
    def change(pose):
        pose = pose.copy()
        pose[:3, 3] = matrix @ pose[:3, 3]
        return pose
    return change


def _names_shifted(step):
    def mistake(field):
        frames = sorted(field["frames"], key=lambda frame: frame["file_path"])
        names = [frame["file_path"] for frame in frames]
        for i, frame in enumerate(frames):
            frame["file_path"] = names[(i + step) % len(names)]
    return mistake


def _names_reversed(field):
    frames = sorted(field["frames"], key=lambda frame: frame["file_path"])
    names = [frame["file_path"] for frame in frames]
    for frame, name in zip(frames, reversed(names)):
        frame["file_path"] = name


def _of_intrinsics(change):
    """change(holder): changes the intrinsics in the field or in a frame, which hold those of all or of one image."""
    def mistake(field):
        for holder in [field, *field["frames"]]:
            if "fl_x" in holder:
                size = {key: holder.get(key, field.get(key)) for key in ("w", "h")}
                change(holder, size["w"], size["h"])
    return mistake


def _scale(x, y=None, centre=False):
    def change(holder, w, h):
        fx = x(w, h)
        fy = fx if y is None else y(w, h)
        holder["fl_x"] *= fx
        holder["fl_y"] = holder.get("fl_y", holder["fl_x"] / fx) * fy
        if centre:
            holder["cx"] *= fx
            holder["cy"] *= fy
    return change


def _swap_principal_point(holder, w, h):
    holder["cx"], holder["cy"] = holder.get("cy", h / 2), holder.get("cx", w / 2)


class Pixels:
    """A mistake that changes the pixels of the images."""
    def __init__(self, operation):
        self.operation = operation


# Each mistake by name: a function that changes the parsed transforms.json, or Pixels.
MISTAKES = {
    "none": lambda field: None,
    "opencv-axes": _each_pose(lambda pose: pose @ OPENGL),
    "world-to-camera": _each_pose(np.linalg.inv),
    "world-to-camera-opencv": _each_pose(lambda pose: np.linalg.inv(pose @ OPENGL)),
    "rotation-transposed": _each_pose(_rotation_transposed),
    "colmap-rotation-transposed": _each_pose(_colmap_rotation_transposed),
    "position-for-translation": _each_pose(_position_for_translation),
    "camera-y-z-exchanged": _each_pose(lambda pose: pose @ np.array(
        [[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])),
    "position-y-z-exchanged": _each_pose(_of_positions(np.array([[1.0, 0, 0], [0, 0, 1], [0, 1, 0]]))),
    "position-x-negated": _each_pose(_of_positions(np.diag([-1.0, 1, 1]))),
    "position-y-negated": _each_pose(_of_positions(np.diag([1.0, -1, 1]))),
    "rows-columns-exchanged": _each_pose(_of_positions(np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, 1]]))),
    "names-one-ahead": _names_shifted(1),
    "names-one-behind": _names_shifted(-1),
    "names-reversed": _names_reversed,
    "mirrored": Pixels(Image.Transpose.FLIP_LEFT_RIGHT),
    "upside-down": Pixels(Image.Transpose.FLIP_TOP_BOTTOM),
    "turned-by-180": Pixels(Image.Transpose.ROTATE_180),
    "focal-in-mm": _of_intrinsics(_scale(lambda w, h: 36 / w)),
    "focal-of-width": _of_intrinsics(_scale(lambda w, h: 1 / w)),
    "all-normalised": _of_intrinsics(_scale(lambda w, h: 1 / w, lambda w, h: 1 / h, centre=True)),
    "focal-half": _of_intrinsics(_scale(lambda w, h: 0.5)),
    "focal-twice": _of_intrinsics(_scale(lambda w, h: 2)),
    "principal-point-swapped": _of_intrinsics(_swap_principal_point),
}


def write_mistake(name, source, folder):
    """Writes into `folder` the light field of the folder `source`, which has a transforms.json, with a mistake. Images
    are linked, or written anew if the mistake changes them. Returns the folder."""
    source, folder = pathlib.Path(source).resolve(), pathlib.Path(folder)
    folder.mkdir(parents=True)
    field = copy.deepcopy(json.loads((source / "transforms.json").read_text()))
    field.pop("lf_generator", None)
    mistake = MISTAKES[name]
    for i, frame in enumerate(field["frames"]):
        file = source / frame["file_path"]
        new = pathlib.Path("images") / file.name
        (folder / new.parent).mkdir(exist_ok=True)
        if isinstance(mistake, Pixels):
            image = Image.open(file).transpose(mistake.operation)
            image.save(folder / new, **({"quality": 95} if file.suffix.lower() in (".jpg", ".jpeg") else {}))
        else:
            os.symlink(file, folder / new)
        frame["file_path"] = str(new)
    if not isinstance(mistake, Pixels):
        mistake(field)
    (folder / "transforms.json").write_text(json.dumps(field))
    return folder
