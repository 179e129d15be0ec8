# SPDX-License-Identifier: Apache-2.0
"""Draws a light field video with a known answer: a red card that slides to the right before a patterned wall.

Nine cameras stand in a grid in the plane z = 0 and look along z. The card is 0.2 wide, at the depth 1, and its middle
is at x = CARD_START + CARD_SPEED t. The wall is at the depth 3.
"""
import json
import pathlib
import subprocess

import numpy as np
from PIL import Image

WIDTH, HEIGHT, FOCAL = 96, 72, 90.0
FPS, FRAMES = 10, 12
PITCH = 0.05
CARD_START, CARD_SPEED, CARD_HALF, CARD_DEPTH, WALL_DEPTH = -0.2, 0.4, 0.1, 1.0, 3.0
CENTRES = [((column - 1) * PITCH, (row - 1) * PITCH) for row in range(3) for column in range(3)]
NAMES = [f"cam{i:02d}" for i in range(9)]


def card_x(time_s):
    return CARD_START + CARD_SPEED * time_s


def picture(camera, time_s):
    """Returns what a camera sees at a time, [height][width][3] of 8 bits."""
    x, y = CENTRES[camera]
    columns, rows = np.meshgrid((np.arange(WIDTH) + 0.5 - WIDTH / 2) / FOCAL,
                                (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / FOCAL)
    wall_x, wall_y = columns * WALL_DEPTH + x, rows * WALL_DEPTH + y
    grey = 90 + 40 * np.sin(9 * wall_x) * np.cos(11 * wall_y) + 20 * np.sin(23 * wall_x + 17 * wall_y)
    pixels = np.repeat(grey[..., None], 3, axis=2)
    on_card = ((np.abs(columns * CARD_DEPTH + x - card_x(time_s)) < CARD_HALF)
               & (np.abs(rows * CARD_DEPTH + y) < CARD_HALF))
    pixels[on_card] = (230, 20, 20)
    return pixels.round().astype(np.uint8)


def write_poses(folder):
    """Writes poses_bounds.npy, whose columns are the camera axes down, right and backwards, and the centre."""
    rows = [[0, 1, 0, x, HEIGHT, 1, 0, 0, y, WIDTH, 0, 0, -1, 0, FOCAL, 0.5, 5] for x, y in CENTRES]
    np.save(folder / "poses_bounds.npy", np.array(rows, float))


def write_models(folder):
    """Writes Google's models.json."""
    (folder / "models.json").write_text(json.dumps([[
        {"name": name, "width": WIDTH, "height": HEIGHT, "focal_length": FOCAL, "pixel_aspect_ratio": 1.0,
         "principal_point": [WIDTH / 2, HEIGHT / 2], "position": [x, y, 0], "orientation": [0, 0, 0],
         "projection_type": "perspective"} for name, (x, y) in zip(NAMES, CENTRES)]]))


def write_frames(folder, inner="", frames=FRAMES):
    """Writes a folder of frames of each camera: CAMERA/0000.png, or CAMERA/INNER/0000.png."""
    for camera, name in enumerate(NAMES):
        place = folder / name / inner
        place.mkdir(parents=True)
        for frame in range(frames):
            Image.fromarray(picture(camera, frame / FPS)).save(place / f"{frame:04d}.png")


def encode(frames, video, fps=FPS, codec=("-c:v", "libx264rgb", "-qp", "0", "-g", "3", "-bf", "2")):
    """Encodes files NNNN.png as a video; by default without loss."""
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-framerate", str(fps), "-i", frames / "%04d.png", *codec, video],
                   check=True)


def write_videos(folder, frames_of, ending=".mp4", **options):
    """Encodes the frames that write_frames() has written as videos."""
    folder.mkdir(exist_ok=True)
    for name in NAMES:
        encode(frames_of / name, folder / (name + ending), **options)


def write_still(folder, time_s):
    """Writes the light field of one time, with poses_bounds.npy and images."""
    (folder / "images").mkdir(parents=True)
    write_poses(folder)
    for camera, name in enumerate(NAMES):
        Image.fromarray(picture(camera, time_s)).save(folder / "images" / f"{name}.png")
    return folder


def write_timed(folder, times, drawn=None):
    """Writes a transforms.json with the key time: all cameras at each of the times. `drawn` are the times in seconds
    that the pictures show, if the file states others."""
    folder.mkdir()
    frames = []
    for time, time_s in zip(times, drawn or times):
        for camera, (x, y) in enumerate(CENTRES):
            name = f"{NAMES[camera]}_{len(frames):03d}.png"
            Image.fromarray(picture(camera, time_s)).save(folder / name)
            frames.append({"file_path": name, "time": time, "transform_matrix":
                           [[1, 0, 0, x], [0, -1, 0, y], [0, 0, -1, 0], [0, 0, 0, 1]]})
    (folder / "transforms.json").write_text(json.dumps(
        {"w": WIDTH, "h": HEIGHT, "fl_x": FOCAL, "fl_y": FOCAL, "cx": WIDTH / 2, "cy": HEIGHT / 2, "frames": frames}))
    return folder


def write_path(file: pathlib.Path, frames=1, time="", more="", resolution=(96, 72), fps=10):
    """Writes a path whose camera stands among the cameras and is focused on the card."""
    file.write_text(f"""format: lfpath 1
fps: {fps}
frames: {frames}
resolution: [{resolution[0]}, {resolution[1]}]
{"time: " + time if time else ""}
{more}
camera: {{field_of_view_deg: 50, position: [0, 0, 0], look_at: [0, 0, 1]}}
lens: {{aperture_diameter: 0.09, focus_distance: {CARD_DEPTH}}}
keyframes: {{position: [{{time: 0, value: [-0.01, 0, 0]}}, {{time: 4, value: [0.03, 0, 0]}}]}}
""")
    return file
