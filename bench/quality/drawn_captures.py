# SPDX-License-Identifier: Apache-2.0
"""Photographs of the scenes of lfsynth from any places around their object, and films with their true pictures."""
import json

import cv2
import numpy as np

import lens_weights
import quality
from quality import results

SUBJECT = np.array([0.0, -0.05, 0.0])  # in the middle of the objects of still-life, lights and chart
DISTANCE = 0.9
FIELD_OF_VIEW_DEG = 48
SIZE = (320, 240)
SAMPLES = 4    # rays of a pixel of a photograph
DOWN = np.array([0.0, 1.0, 0.0])  # of the scenes


def pose_at(direction, distance=DISTANCE):
    """Returns the camera-to-world matrix, with OpenGL axes, of a camera that looks at the subject.

    direction  (angle around the vertical, angle above the horizon), in degrees
    """
    around, above = np.radians(direction)
    backward = np.array([np.sin(around) * np.cos(above), -np.sin(above), -np.cos(around) * np.cos(above)])
    right = np.cross(-DOWN, backward)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(backward, right), backward])
    pose[:3, 3] = SUBJECT + distance * backward
    return pose


def dome(degrees, rings=3, above=25):
    """Returns the directions of LF cameras on a part of a dome: `rings` hexagons around the one in the middle."""
    rows = 0.75 ** 0.5 * degrees
    return [((column + row % 2 / 2) * degrees / np.cos(np.radians(above + row * rows)), above + row * rows)
            for row in range(-rings, rings + 1) for column in range(-rings, rings + 1)
            if np.hypot((column + row % 2 / 2) * degrees, row * rows) <= (rings + 0.2) * degrees]


def track(degrees, count=9, above=25):
    """Returns the directions of LF cameras along an arc."""
    return [((i - count // 2) * degrees / np.cos(np.radians(above)), above) for i in range(count)]


def turntable(count, above=25):
    """Returns the directions of LF cameras in a circle, as of an object on a turntable."""
    return [(360 * i / count, above) for i in range(count)]


def video(count=120, degrees=0.3, above=25):
    """Returns the directions of a video's images along an arc, held by hand."""
    walk = np.cumsum(np.random.RandomState(2).normal(0, 0.15, (count, 2)), axis=0)
    walk -= np.linspace(0, 1, count)[:, None] * walk[-1]
    return [((i - count / 2) * degrees + walk[i, 0], above + walk[i, 1]) for i in range(count)]


def true_pictures(programs, scene, path, folder, samples, alpha="none"):
    """Returns the files of the pictures that true lenses of a camera path take."""
    results.call([programs / "lfsynth", scene, "-q", "--calibration-only", "--overwrite", "-o", folder, "--truth", path,
                  "--truth-samples", samples, "--alpha", alpha])
    return sorted((folder / "truth").glob("frame_*.exr"))


def photographs(programs, scene, directions, folder, alpha=False, noise=0, gains=None):
    """Writes a light field of 8-bit photographs. Returns its calibration.

    alpha  True: straight alpha, and nothing around the objects
    noise  standard deviation, in steps of 8 bits
    gains  of each photograph: its light is multiplied by this
    """
    folder.mkdir()
    width, height = SIZE
    poses = [pose_at(direction) for direction in directions]
    fov_x = np.radians(FIELD_OF_VIEW_DEG)
    fov_y_deg = float(np.degrees(2 * np.arctan(np.tan(fov_x / 2) * height / width)))
    path = folder / "cameras.json"
    path.write_text(json.dumps({
        "camera_type": "perspective", "render_width": width, "render_height": height, "fps": 25,
        "seconds": len(poses) / 25,
        "camera_path": [{"camera_to_world": pose.ravel().tolist(), "fov": fov_y_deg, "aspect": width / height}
                        for pose in poses]}))
    pictures = true_pictures(programs, scene, path, folder, SAMPLES, "straight" if alpha else "none")
    random = np.random.RandomState(1)
    for number, file in enumerate(pictures):
        light = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        file.unlink()
        light[..., :3] *= 1 if gains is None else gains[number]
        if alpha:
            light[..., :3] /= np.maximum(light[..., 3:], 1e-6)  # premultiplied in the file
        picture = 255 * quality.encoded(np.clip(light[..., :3], 0, 1))
        picture = picture + random.normal(0, noise, picture.shape) if noise else picture
        if alpha:
            picture = np.dstack([picture, 255 * light[..., 3]])
        cv2.imwrite(str(folder / f"photograph_{number:04}.png"), np.clip(picture + 0.5, 0, 255).astype(np.uint8))
    focal_px = width / 2 / np.tan(fov_x / 2)
    calibration = folder / "transforms.json"
    calibration.write_text(json.dumps({
        "camera_model": "PINHOLE", "fl_x": focal_px, "fl_y": focal_px, "cx": width / 2, "cy": height / 2, "w": width,
        "h": height, **({"lf_alpha": "straight", "lf_background": "none"} if alpha else {}),
        "frames": [{"file_path": f"photograph_{i:04}.png", "transform_matrix": pose.tolist()}
                   for i, pose in enumerate(poses)]}))
    return calibration


def film(path, first, last, frames, diameter, focus=DISTANCE):
    """Writes the path of a camera that moves from one direction to another and looks at the subject."""
    width, height = SIZE
    times = np.linspace(0, (frames - 1) / 25, min(frames, 9))
    places = [pose_at((1 - s) * np.array(first) + s * np.array(last))[:3, 3] for s in np.linspace(0, 1, len(times))]
    numbers = lambda values: "[" + ", ".join(repr(float(value)) for value in values) + "]"
    keys = "".join(f"    - {{time: {time!r}, value: {numbers(place)}}}\n"
                   for time, place in zip(times.tolist(), places))
    path.write_text(f"""format: lfpath 1
fps: 25
frames: {frames}
resolution: [{width}, {height}]
camera:
  field_of_view_deg: {FIELD_OF_VIEW_DEG}
  position: {numbers(places[0])}
  look_at: {numbers(SUBJECT)}
  follow: look_at
lens:
  aperture_diameter: {diameter!r}
  focus_distance: {focus!r}
""" + ("keyframes:\n  position:\n" + keys if frames > 1 else ""))
    return path


def linear(file):
    """Returns a picture with its channels, R, G and B first."""
    picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED).astype(np.float64)
    return np.dstack([picture[..., 2::-1], *(picture[..., c] for c in range(3, picture.shape[2]))])


def frames_of(renderer, calibration, path, folder, options):
    """Renders a film. Returns its frames and its report."""
    results.call([renderer, calibration, path, "-o", folder, "--format", "exr-float", "-q", "--no-contact-sheet",
                  "--overwrite", *options])
    return ([lens_weights.linear_exr(file) for file in sorted(folder.glob("frame_*.exr"))],
            json.loads((folder / "report.json").read_text()))
