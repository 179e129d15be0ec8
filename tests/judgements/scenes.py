# SPDX-License-Identifier: Apache-2.0
"""Draws captures of textured rectangles, whose depths are known, with pinhole LF cameras in any arrangement.

Cameras look along -z of a world in which y points up. A camera is (position, rotation), whose columns are its right, up
and back axis.
"""
import dataclasses

import cv2
import numpy as np
from PIL import Image

from judgements.captures import pose, write_transforms

WIDTH, HEIGHT, FOCAL_PX = 200, 150, 210
FINER = 2  # samples of a pixel along each axis
TEXTURE_SIDE, TEXELS = 512, 8  # a texture repeats itself after 64 cells of 8 texels


def texture(seed):
    """Returns smooth noise from 0 to 1 with details of one cell."""
    generator = np.random.default_rng(seed)
    cells = TEXTURE_SIDE // TEXELS
    total = np.zeros((TEXTURE_SIDE, TEXTURE_SIDE), np.float32)
    for cells_of, share in ((cells, 0.6), (cells // 4, 0.4)):
        grid = np.pad(generator.random((cells_of, cells_of), dtype=np.float32), 2, mode="wrap")
        side = TEXTURE_SIDE // cells_of
        large = cv2.resize(grid, None, fx=side, fy=side, interpolation=cv2.INTER_CUBIC)
        total += share * large[2 * side:-2 * side, 2 * side:-2 * side]
    low, high = np.percentile(total, (2, 98))
    return np.clip((total - low) / (high - low), 0, 1).astype(np.float32)


@dataclasses.dataclass
class Quad:
    """A rectangle: its middle, its axes (unit vectors), half its width and height."""
    middle: tuple
    half: tuple = (100.0, 100.0)
    axes: tuple = ((1, 0, 0), (0, 1, 0))
    contrast: float = 0.8
    grey: float = 0.5
    seed: int = 0
    cell: float = 0  # world size of a detail; 0: 5 LF pixels at the distance of `middle` from `seen_from_w`
    seen_from_w: float = 0  # z of the LF cameras


def wall(depth, **keys):
    return Quad((0, 0, -depth), **keys)


def card(x, y, depth, width, height, **keys):
    return Quad((x, y, -depth), (width / 2, height / 2), **keys)


def photograph(position, rotation, quads, textures):
    """Returns what a camera sees, as values of sRGB from 0 to 255; black beside the quads."""
    wide, high = WIDTH * FINER, HEIGHT * FINER
    u, v = np.meshgrid((np.arange(wide) + 0.5 - wide / 2) / (FOCAL_PX * FINER),
                       -(np.arange(high) + 0.5 - high / 2) / (FOCAL_PX * FINER))
    rays = (np.stack([u, v, -np.ones_like(u)], -1) @ np.asarray(rotation, float).T).astype(np.float32)
    nearest = np.full(u.shape, np.inf, np.float32)
    picture = np.zeros(u.shape, np.float32)
    for quad, pattern in zip(quads, textures):
        x_axis, y_axis = (np.asarray(axis, np.float32) for axis in quad.axes)
        normal = np.cross(x_axis, y_axis)
        offset = np.asarray(quad.middle, np.float32) - np.asarray(position, np.float32)
        slope = rays @ normal
        t = np.where(np.abs(slope) < 1e-9, np.inf, (offset @ normal) / np.where(slope == 0, 1, slope))
        across = t * (rays @ x_axis) - offset @ x_axis
        up = t * (rays @ y_axis) - offset @ y_axis
        with np.errstate(invalid="ignore"):
            hit = (t > 0) & (t < nearest) & (np.abs(across) < quad.half[0]) & (np.abs(up) < quad.half[1])
        cell = quad.cell or 5 / FOCAL_PX * abs(quad.middle[2] - quad.seen_from_w)
        at = [(np.where(hit, axis, 0) / cell * TEXELS % TEXTURE_SIDE).astype(np.float32) for axis in (across, up)]
        seen = cv2.remap(pattern, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)
        picture = np.where(hit, quad.grey + quad.contrast * (seen - 0.5), picture)
        nearest = np.where(hit, t, nearest)
    return picture.reshape(HEIGHT, FINER, WIDTH, FINER).mean((1, 3)) * 255


def draw(folder, cameras, quads, seed=0, grain=1.0, **keys):
    """Writes the light field. grain: standard deviation of the noise, of 255. cameras.drawn, if it exists, holds the
    cameras that photographed instead of those that the calibration states."""
    folder.mkdir()
    generator = np.random.default_rng(seed)
    textures = [texture(1000 * seed + 10 * number + quad.seed) for number, quad in enumerate(quads)]
    frames = []
    for number, (position, rotation) in enumerate(cameras):
        picture = photograph(*getattr(cameras, "drawn", cameras)[number], quads, textures)
        picture = picture + grain * generator.standard_normal(picture.shape)
        Image.fromarray(np.clip(picture, 0, 255).round().astype(np.uint8)).convert("RGB").save(
            folder / f"{number:03d}.png", compress_level=1)
        frames.append({"file_path": f"{number:03d}.png",
                       "transform_matrix": pose(*position, rotation=np.asarray(rotation).T.tolist())})
    write_transforms(folder, frames, fl_x=FOCAL_PX, w=WIDTH, h=HEIGHT, **keys)


# Arrangements

AHEAD = np.eye(3)


def looking(position, target, up=(0, 1, 0)):
    back = np.subtract(position, target)
    back = back / np.linalg.norm(back)
    right = np.cross(up, back)
    right = right / np.linalg.norm(right)
    return np.stack([right, np.cross(back, right), back], 1)


def grid(side, spacing, meeting=None):
    """Cameras in a square; their axes meet at the distance `meeting`, or are parallel."""
    places = [((column - side // 2) * spacing, (side // 2 - row) * spacing, 0.0)
              for row in range(side) for column in range(side)]
    return [(place, looking(place, (0, 0, -meeting)) if meeting else AHEAD) for place in places]


def arc(count, degrees, radius, height=0.0):
    """Cameras on an arc around (0, 0, -radius); the one in the middle stands at the origin if height is 0."""
    angles = np.radians(np.linspace(-degrees / 2, degrees / 2, count))
    places = [(radius * np.sin(a), height, radius * np.cos(a) - radius) for a in angles]
    return [(place, looking(place, (0, 0, -radius))) for place in places]


def dome(count, degrees, radius):
    """Cameras on a spherical cap around (0, 0, -radius), whose middle is the origin, evenly spread."""
    places = []
    for k in range(count):
        tilt = np.radians(degrees / 2) * np.sqrt(k / count)
        turn = k * np.pi * (3 - np.sqrt(5))
        places.append((radius * np.sin(tilt) * np.cos(turn), radius * np.sin(tilt) * np.sin(turn),
                       radius * np.cos(tilt) - radius))
    return [(place, looking(place, (0, 0, -radius))) for place in places]


def track(count, spacing, generator, sway=0.0):
    """A hand-held camera that is moved to the right; parallel axes but for `sway`, in degrees."""
    cameras = []
    for k in range(count):
        place = ((k - count // 2) * spacing, *(0.15 * spacing * generator.standard_normal(2)))
        turn = np.radians(sway) * generator.standard_normal(2)
        cameras.append((place, looking(place, np.add(place, (turn[0], turn[1], -1)))))
    return cameras


def survey(lines, per_line, spacing):
    """A drone that looks straight down (along -z) and turns round after each line."""
    cameras = []
    for line in range(lines):
        heading = 1 if line % 2 == 0 else -1
        for k in range(per_line):
            place = (heading * (k - (per_line - 1) / 2) * spacing, (line - (lines - 1) / 2) * spacing, 0.0)
            cameras.append((place, AHEAD if heading == 1 else np.diag([-1.0, -1.0, 1.0])))
    return cameras
