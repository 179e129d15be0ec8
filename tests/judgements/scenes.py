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


@dataclasses.dataclass(frozen=True)
class Lens:
    """A lens without distortion unless k1 (of OpenCV's model) says something else."""
    width: int = 200
    height: int = 150
    focal_px: float = 210
    k1: float = 0

    def rays(self, x, y):
        """Returns the directions, in camera axes, of positions in pixels: [..., 3], with z = -1."""
        u, v = (np.asarray(x) - self.width / 2) / self.focal_px, (np.asarray(y) - self.height / 2) / self.focal_px
        a, b = u, v
        for _ in range(12 if self.k1 else 0):
            scale = 1 + self.k1 * (a * a + b * b)
            a, b = u / scale, v / scale
        return np.stack([a, -b, -np.ones_like(a)], -1)


LENS = Lens()
WIDTH, HEIGHT, FOCAL_PX = LENS.width, LENS.height, LENS.focal_px
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


class Capture(list):
    """The cameras that a calibration states, and what differs from other captures."""

    def __init__(self, cameras, lens=LENS, drawn=None, gains=None, grain=1.0):
        super().__init__(cameras)
        self.lens = lens
        self.drawn = drawn or cameras  # the cameras that photographed
        self.gains = gains or [1] * len(cameras)  # brightness of each photograph
        self.grain = grain  # standard deviation of the noise, of 255


def capture_of(cameras):
    return cameras if isinstance(cameras, Capture) else Capture(cameras)


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
    pattern: str = "noise"  # or "checks", or "stripes"
    flickers: bool = False  # another texture in each photograph, as leaves in wind
    slides: float = 0  # by how much the texture moves with the LF camera, to the right and down: a highlight does


def pattern_of(quad, seed):
    """Returns the texture of a quad."""
    if quad.pattern == "noise":
        return texture(seed)
    y, x = np.indices((TEXTURE_SIDE, TEXTURE_SIDE)) // TEXELS % 2
    return ((x if quad.pattern == "stripes" else x ^ y) * np.float32(1)).astype(np.float32)


def wall(depth, **keys):
    return Quad((0, 0, -depth), **keys)


def card(x, y, depth, width, height, **keys):
    return Quad((x, y, -depth), (width / 2, height / 2), **keys)


def hits(position, rays, quads):
    """Follows rays (in world axes) from a position. Returns the nearest t of each ray, the number of the quad there
    (-1: none), and the places on it (across, up)."""
    nearest = np.full(rays.shape[:-1], np.inf, np.float32)
    number = np.full(nearest.shape, -1)
    places = np.zeros((2, *nearest.shape), np.float32)
    for index, quad in enumerate(quads):
        x_axis, y_axis = (np.asarray(axis, np.float32) for axis in quad.axes)
        normal = np.cross(x_axis, y_axis)
        offset = np.asarray(quad.middle, np.float32) - np.asarray(position, np.float32)
        slope = rays @ normal
        t = np.where(np.abs(slope) < 1e-9, np.inf, (offset @ normal) / np.where(slope == 0, 1, slope))
        with np.errstate(invalid="ignore"):
            across = t * (rays @ x_axis) - offset @ x_axis
            up = t * (rays @ y_axis) - offset @ y_axis
            hit = (t > 0) & (t < nearest) & (np.abs(across) < quad.half[0]) & (np.abs(up) < quad.half[1])
        nearest = np.where(hit, t, nearest)
        number = np.where(hit, index, number)
        places = np.where(hit, (across, up), places)
    return nearest, number, places


def window_of(quad, position, rotation, lens):
    """Returns the rows and columns of samples that may see a quad."""
    axes = np.asarray(quad.axes, float) * np.asarray(quad.half)[:, None]
    corners = [np.add(quad.middle, a * axes[0] + b * axes[1]) for a in (-1, 1) for b in (-1, 1)]
    x, y, z = (np.subtract(corners, position) @ np.asarray(rotation, float)).T
    if lens.k1 or (z > -1e-3).any():
        return slice(None), slice(None)
    across, up = lens.focal_px * x / -z + lens.width / 2, lens.focal_px * y / z + lens.height / 2

    def span(places, size):
        return slice(*(int(np.clip(place, 0, size)) * FINER for place in (min(places) - 1, max(places) + 2)))
    return span(up, lens.height), span(across, lens.width)


def photograph(position, rotation, quads, textures, lens=LENS):
    """Returns what a camera sees, as values of sRGB from 0 to 255; black beside the quads."""
    wide, high = lens.width * FINER, lens.height * FINER
    x, y = np.meshgrid((np.arange(wide) + 0.5) / FINER, (np.arange(high) + 0.5) / FINER)
    rays = (lens.rays(x, y) @ np.asarray(rotation, float).T).astype(np.float32)
    picture, nearest = np.zeros(x.shape, np.float32), np.full(x.shape, np.inf, np.float32)
    for quad, pattern in zip(quads, textures):
        window = window_of(quad, position, rotation, lens)
        if not rays[window].size:
            continue
        t, _, places = hits(position, rays[window], [quad])
        hit = t < nearest[window]
        cell = quad.cell or 5 / lens.focal_px * abs(quad.middle[2] - quad.seen_from_w)
        slide = quad.slides * np.array([position[0], -position[1]])
        at = [((np.where(hit, place, 0) + moved) / cell * TEXELS % TEXTURE_SIDE).astype(np.float32)
              for place, moved in zip(places, slide)]
        seen = cv2.remap(pattern, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)
        picture[window] = np.where(hit, quad.grey + quad.contrast * (seen - 0.5), picture[window])
        nearest[window] = np.where(hit, t, nearest[window])
    return picture.reshape(lens.height, FINER, lens.width, FINER).mean((1, 3)) * 255


def draw(folder, cameras, quads, seed=0, names=None, **keys):
    """Writes the light field. names: those of the files."""
    folder.mkdir()
    generator = np.random.default_rng(seed)
    capture = capture_of(cameras)
    lens = capture.lens
    textures = [pattern_of(quad, 1000 * seed + 10 * number + quad.seed) for number, quad in enumerate(quads)]
    frames = []
    for number, (position, rotation) in enumerate(cameras):
        seen = [texture(1000 * seed + 10 * index + 7919 * (number + 1)) if quad.flickers else pattern
                for index, (quad, pattern) in enumerate(zip(quads, textures))]
        picture = capture.gains[number] * photograph(*capture.drawn[number], quads, seen, lens)
        picture = picture + capture.grain * generator.standard_normal(picture.shape)
        name = names[number] if names else f"{number:03d}.png"
        Image.fromarray(np.clip(picture, 0, 255).round().astype(np.uint8)).convert("RGB").save(
            folder / name, compress_level=1)
        frames.append({"file_path": name,
                       "transform_matrix": pose(*position, rotation=np.asarray(rotation).T.tolist())})
    if lens.k1:
        keys["k1"] = lens.k1
    write_transforms(folder, frames, fl_x=lens.focal_px, w=lens.width, h=lens.height, **keys)


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
    return lattice(side, side, spacing, meeting)


def lattice(rows, columns, spacing, meeting=None):
    """Cameras in a rectangle, as those of grid()."""
    places = [((column - columns // 2) * spacing, (rows // 2 - row) * spacing, 0.0)
              for row in range(rows) for column in range(columns)]
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


def shaken(cameras, generator, places_w=0.0, degrees=0.0):
    """Returns cameras with random changes of their positions and directions."""
    changed = []
    for position, rotation in cameras:
        turn = np.radians(degrees) * generator.standard_normal(3)
        matrix, _ = cv2.Rodrigues(turn)
        changed.append((tuple(np.add(position, places_w * generator.uniform(-1, 1, 3))), np.asarray(rotation) @ matrix))
    return changed


def spiral(count, turns, degrees, radius):
    """Cameras on a spiral around (0, 0, -radius), from its front up to `degrees` off."""
    cameras = []
    for k in range(count):
        tilt, turn = np.radians(degrees) * np.sqrt((k + 0.5) / count), 2 * np.pi * turns * k / count
        place = (radius * np.sin(tilt) * np.cos(turn), radius * np.sin(tilt) * np.sin(turn),
                 radius * np.cos(tilt) - radius)
        cameras.append((place, looking(place, (0, 0, -radius))))
    return cameras


def hand_held(count, generator, reach_w, target, degrees=5.0):
    """Cameras anywhere in a box of these half sizes around the origin, which look about at the target."""
    places = [tuple(generator.uniform(-1, 1, 3) * reach_w) for _ in range(count)]
    return shaken([(place, looking(place, target)) for place in places], generator, 0, degrees)


def box(x, y, depth, width, height, length, **keys):
    """The front, the sides, the top and the bottom of a box, whose front is at a depth."""
    back = -depth - length / 2
    across, up, away = (1, 0, 0), (0, 1, 0), (0, 0, -1)
    sides = [Quad((x + side * width / 2, y, back), (length / 2, height / 2), (away, up), seed=3 + side, **keys)
             for side in (-1, 1)]
    lids = [Quad((x, y + side * height / 2, back), (width / 2, length / 2), (across, away), seed=6 + side, **keys)
            for side in (-1, 1)]
    return [card(x, y, depth, width, height, **keys), *sides, *lids]
