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


def _camera_y_negated(pose):
    """Only the y axis of the camera was negated, which makes the matrix left-handed."""
    return pose @ np.diag([1.0, -1, 1, 1])


def _noisy_rotations(field):
    """Directions come from a compass: they are off by about five degrees."""
    generator = np.random.default_rng(5)
    for frame in field["frames"]:
        matrix = np.array(frame["transform_matrix"], float)
        turn, _ = np.linalg.qr(np.eye(3) + np.cross(np.eye(3), 0.09 * generator.standard_normal(3)))
        matrix[:3, :3] = matrix[:3, :3] @ (turn * np.sign(np.diag(turn)))
        frame["transform_matrix"] = matrix.tolist()


def _noisy_positions(field):
    """Positions are off by about the distance of neighbours, as those of GPS."""
    generator = np.random.default_rng(6)
    places = np.array([frame["transform_matrix"] for frame in field["frames"]])[:, :3, 3]
    apart = np.linalg.norm(places[:, None] - places[None], axis=-1) + 1e9 * np.eye(len(places))
    for frame in field["frames"]:
        matrix = np.array(frame["transform_matrix"], float)
        matrix[:3, 3] += 0.7 * np.median(apart.min(1)) * generator.standard_normal(3)
        frame["transform_matrix"] = matrix.tolist()


def _sorted_frames(field):
    return sorted(field["frames"], key=lambda frame: frame["file_path"])


def _every_second_pose(field):
    """The images are the first half of those whose every second pose was exported."""
    frames = _sorted_frames(field)
    half = len(frames) // 2
    poses = [frame["transform_matrix"] for frame in frames]
    for i, frame in enumerate(frames[:half]):
        frame["transform_matrix"] = poses[2 * i]
    field["frames"] = frames[:half]


def _two_exchanged(field):
    frames = _sorted_frames(field)
    a, b = frames[len(frames) // 4], frames[3 * len(frames) // 4]
    a["file_path"], b["file_path"] = b["file_path"], a["file_path"]


def _names_shuffled(field):
    names = [frame["file_path"] for frame in field["frames"]]
    order = np.random.default_rng(7).permutation(len(names))
    for frame, at in zip(field["frames"], order.tolist()):
        frame["file_path"] = names[at]


def _dropped_image(field):
    """An image in the middle is missing, and those behind it have moved up."""
    frames = _sorted_frames(field)
    names = [frame["file_path"] for frame in frames]
    middle = len(frames) // 2
    for frame, name in zip(frames[middle:], names[middle + 1:]):
        frame["file_path"] = name
    field["frames"] = frames[:-1]


def _both(first, second):
    def mistake(field):
        first(field)
        second(field)
    return mistake


def _sizes_exchanged(field):
    """Width and height follow the turned images; poses and the rest do not."""
    field["w"], field["h"] = field["h"], field["w"]
    field["cx"], field["cy"] = field["w"] / 2, field["h"] / 2


def _halved(image):
    return image.resize((image.width // 2, image.height // 2))


def _of_half_size(field):
    """Images were reduced to half; only the width and the height followed."""
    field["w"], field["h"] = field["w"] // 2, field["h"] // 2


def _turned_world(field):
    matrix, _ = np.linalg.qr(np.random.default_rng(8).standard_normal((3, 3)))
    turn = np.eye(4)
    turn[:3, :3] = matrix * np.linalg.det(matrix)
    turn[:3, 3] = 3, -2, 5
    _each_pose(lambda pose: turn @ pose)(field)


class Pixels:
    """A mistake that changes the pixels of the images, and perhaps the field."""
    def __init__(self, operation, change=None):
        self.operation = operation
        self.change = change or (lambda field: None)

    def applied_to(self, image):
        return self.operation(image) if callable(self.operation) else image.transpose(self.operation)


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


# Mistakes, and harmless changes, with which no threshold was chosen.
MORE_MISTAKES = {
    "camera-y-negated": _each_pose(_camera_y_negated),
    "noisy-rotations": _noisy_rotations,
    "noisy-positions": _noisy_positions,
    "every-second-pose": _every_second_pose,
    "two-exchanged": _two_exchanged,
    "names-shuffled": _names_shuffled,
    "names-five-ahead": _names_shifted(5),
    "dropped-image": _dropped_image,
    "turned-clockwise": Pixels(Image.Transpose.ROTATE_270, _sizes_exchanged),
    "turned-anticlockwise": Pixels(Image.Transpose.ROTATE_90, _sizes_exchanged),
    "reduced-images": Pixels(_halved),
    "reduced-images-and-sizes": Pixels(_halved, _of_half_size),
    "inverse-and-names-ahead": _both(_each_pose(np.linalg.inv), _names_shifted(1)),
    "mirrored-opencv-axes": Pixels(Image.Transpose.FLIP_LEFT_RIGHT, _each_pose(lambda pose: pose @ OPENGL)),
    "opencv-axes-and-focal-half": _both(_each_pose(lambda pose: pose @ OPENGL),
                                        _of_intrinsics(_scale(lambda w, h: 0.5))),
    "turned-world": _turned_world,
    "scaled-world": _each_pose(_of_positions(1000 * np.eye(3))),
}


def write_mistake(name, source, folder):
    """Writes into `folder` the light field of the folder `source`, which has a transforms.json, with a mistake. Images
    are linked, or written anew if the mistake changes them. Returns the folder."""
    source, folder = pathlib.Path(source).resolve(), pathlib.Path(folder)
    folder.mkdir(parents=True)
    field = copy.deepcopy(json.loads((source / "transforms.json").read_text()))
    field.pop("lf_generator", None)
    mistake = {**MISTAKES, **MORE_MISTAKES}[name]
    for i, frame in enumerate(field["frames"]):
        file = source / frame["file_path"]
        new = pathlib.Path("images") / file.name
        (folder / new.parent).mkdir(exist_ok=True)
        if isinstance(mistake, Pixels):
            image = mistake.applied_to(Image.open(file))
            image.save(folder / new, **({"quality": 95} if file.suffix.lower() in (".jpg", ".jpeg")
                                        else {"compress_level": 1}))
        else:
            os.symlink(file, folder / new)
        frame["file_path"] = str(new)
    (mistake.change if isinstance(mistake, Pixels) else mistake)(field)
    (folder / "transforms.json").write_text(json.dumps(field))
    return folder
