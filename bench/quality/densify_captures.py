# SPDX-License-Identifier: Apache-2.0
"""Thinned and spoiled light fields for densify_quality.py, and the frames in which they are compared."""
import json
import pathlib
import re

import cv2
import numpy as np

import lens_weights
import quality

SEED = 1
PLANAR = ("planar_d8_f20", "planar_d8_f20_penta", "planar_d8_f45_tilt", "planar_d4_f50")
BAND = ("band_d4_f40", "band_d3_f22")


def row_and_column(frame):
    return tuple(map(int, re.search(r"r(\d+)_c(\d+)", frame["file_path"]).groups()))


def number_of(frame):
    """Returns the last number in the name of a picture."""
    return int(re.findall(r"\d+", pathlib.Path(frame["file_path"]).stem)[-1])


def grid(frames, step):
    """Returns every `step`-th row and column of `planar`, from the third to the 19th: the lenses of the cases look
    through these alone."""
    return [frame for frame in frames if all(2 <= at <= 18 and (at - 2) % step == 0 for at in row_and_column(frame))]


def band(frames, columns, rows):
    return [frame for frame in frames
            if row_and_column(frame)[1] % columns == 0 and row_and_column(frame)[0] % rows == 0]


def at_random(frames, count, seed):
    kept = np.random.RandomState(seed).permutation(len(frames))[:count]
    return [frames[i] for i in sorted(kept)]


def square(frames, kept):
    """Returns those of a square of LF cameras, in the order of rows, whose numbers of row and column are in `kept`."""
    side = round(len(frames) ** 0.5)
    return [frame for i, frame in enumerate(frames) if i // side in kept and i % side in kept]


def cards_field(images):
    """Returns the light field of stanford-cards-9x9. Its pictures are rectified: the plane at a depth of 200 camera
    distances is at the same pixel in all. The names have no positions; the cameras stand on a regular grid."""
    focal_px, depth, size = 1000, 200, 768
    frames = []
    for file in sorted(images.glob("out_*.jpg")):
        row, column = (int(word) - 8 for word in file.stem.split("_")[1:])
        pose = np.eye(4)
        pose[:2, 3] = column, -row
        frames.append({"file_path": str(file), "transform_matrix": pose.tolist(),
                       "cx": size / 2 + focal_px * column / depth, "cy": size / 2 + focal_px * row / depth})
    return {"camera_model": "PINHOLE", "fl_x": focal_px, "fl_y": focal_px, "cx": size / 2, "cy": size / 2,
            "w": size, "h": size, "frames": frames}


def case_of(truth_folder, name):
    return next(case for case in json.loads((truth_folder / "cases.json").read_text())["cases"] if case["name"] == name)


def ground_truth_frames(truth_folder, names, folder):
    """Returns [(name, path, true picture)] of cases of the ground truth."""
    frames = []
    for name in names:
        case, path = case_of(truth_folder, name), folder / f"{name}.yaml"
        path.write_text(quality.path_yaml(case))
        frames.append((name.partition("_")[2], path, lens_weights.linear_pfm(truth_folder / case["linear"])))
    return frames


def moving_path(case, path, diameter, way, frames):
    """Writes the path of a case whose camera moves to the right by `way`, half of it before the place of the case."""
    pose = np.array(case["transform_matrix"])
    right = pose[:3, 0].copy()
    pose[:3, 3] -= way / 2 * right
    yaml = quality.path_yaml(case | {"transform_matrix": pose.tolist(), "aperture_diameter_m": diameter})
    speed = (25 * way / (frames - 1) * right).tolist()  # per second of 25 frames
    path.write_text(yaml.replace("frames: 1\n", f"frames: {frames}\n").replace(
        "lens:\n", f"  follow: direction\n  speed: {speed}\nlens:\n"))
    return path


def middle_path(field, path, size, elements_per_focal_length, diameter, focus):
    """Writes the path of a camera in the middle of a plane of LF cameras that look in one direction."""
    pose = np.array(field["frames"][len(field["frames"]) // 2]["transform_matrix"])
    pose[:3, 3] = np.mean([frame["transform_matrix"] for frame in field["frames"]], axis=0)[:3, 3]
    width, height = size
    fov_deg = float(2 * np.degrees(np.arctan(width / 2 / elements_per_focal_length)))
    path.write_text(quality.path_yaml({
        "w": width, "h": height, "fov_x_deg": fov_deg, "transform_matrix": pose.tolist(),
        "aperture_diameter_m": diameter, "blades": 0, "blade_rotation_deg": 0.0, "focus_distance_m": focus,
        "focus_plane": {"normal": (-pose[:3, 2]).tolist()}}))
    return path


def camera_path(field, path, number, diameter, focus):
    """Writes the path of a frame that stands at an LF camera, with its picture."""
    pose = np.array(field["frames"][number]["transform_matrix"])
    fov_deg = float(2 * np.degrees(np.arctan(field["w"] / 2 / field["fl_x"])))
    path.write_text(quality.path_yaml({
        "w": field["w"], "h": field["h"], "fov_x_deg": fov_deg, "transform_matrix": pose.tolist(),
        "aperture_diameter_m": diameter, "blades": 0, "blade_rotation_deg": 0.0, "focus_distance_m": focus,
        "focus_plane": {"normal": (-pose[:3, 2]).tolist()}}))
    return path


def with_pictures(frames, folder, change):
    """Returns frames whose pictures are those of `change(number, 8-bit picture)`."""
    folder.mkdir()
    changed = []
    for number, frame in enumerate(frames):
        file = folder / f"{number:04}.png"
        picture = change(number, cv2.imread(frame["file_path"]))
        cv2.imwrite(str(file), np.clip(np.rint(picture.astype(float)), 0, 255).astype(np.uint8))
        changed.append(dict(frame, file_path=str(file)))
    return changed


def with_noise(frames, folder):
    dice = np.random.RandomState(SEED)
    return with_pictures(frames, folder, lambda _, picture: picture + dice.normal(0, 6, picture.shape))


def with_gains(frames, folder):
    """Returns frames whose light is multiplied by up to 1.05 or down to 0.95."""
    dice = np.random.RandomState(SEED)
    gains = dice.uniform(0.95, 1.05, len(frames))

    return with_pictures(frames, folder, lambda number, picture: 255 * quality.encoded(
        gains[number] * quality.linear(picture / 255)))


def with_object(frames, folder):
    """Returns frames of which every tenth shows a dark ball with a light rim at a place of its own."""
    dice = np.random.RandomState(SEED)

    def change(number, picture):
        height, width = picture.shape[:2]
        centre = (int(dice.uniform(0.2, 0.8) * width), int(dice.uniform(0.2, 0.8) * height))
        if number % 10 == 5:
            cv2.circle(picture, centre, width // 8, (40, 60, 150), -1, cv2.LINE_AA)
            cv2.circle(picture, centre, width // 8, (220, 230, 240), 4, cv2.LINE_AA)
        return picture
    return with_pictures(frames, folder, change)


def with_turned_poses(frames, focal_px, rms_px):
    """Returns frames whose poses are turned about both axes of their pictures, so that pixels move by rms_px."""
    dice = np.random.RandomState(SEED)
    changed = []
    for frame in frames:
        pose = np.array(frame["transform_matrix"])
        about_x, about_y = dice.normal(0, rms_px / focal_px, 2)
        turn, _ = cv2.Rodrigues(np.array([about_x, about_y, 0.0]))
        pose[:3, :3] = pose[:3, :3] @ turn
        changed.append(dict(frame, transform_matrix=pose.tolist()))
    return changed
