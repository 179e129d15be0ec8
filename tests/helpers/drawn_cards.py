# SPDX-License-Identifier: Apache-2.0
"""Photographs cards of known light and opacity with planar light fields and with exact lenses."""
import functools
import json
import math

import numpy as np

WIDTH, HEIGHT, FOCAL_PX = 96, 72, 100
SIDE, PITCH = 13, 0.006
FOCUS = 1.0
CENTRE = (0.001, 0.002)  # centre of the lens
SAMPLES = 4  # samples of a pixel along each axis

PATH_YAML = """format: lfpath 1
fps: 25
frames: 1
resolution: [{width}, {height}]
camera:
  field_of_view_deg: {view}
  focal_length_mm: 0.1
  position: [{x}, {y}, 0]
  look_at: [{x}, {y}, -1]
  up: [0, 1, 0]
lens:
  aperture_diameter: {aperture}
  focus_distance: {focus}
"""


def write_path(folder, aperture):
    path = folder / "path.yaml"
    view = 2 * math.degrees(math.atan(WIDTH / 2 / FOCAL_PX))
    path.write_text(PATH_YAML.format(width=WIDTH, height=HEIGHT, view=view, x=CENTRE[0], y=CENTRE[1],
                                     aperture=aperture, focus=FOCUS))
    return path


def srgb_of(light):
    return np.where(light <= 0.0031308, 12.92 * light,
                    1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def ring_and_glass(x, y, depth):
    """Returns light and opacity of points of a plane: a striped ring, and a bar of glass nearer to the camera."""
    if depth == FOCUS:
        r = np.hypot(x, y)
        light = [0.55 + 0.4 * np.sin(30 * x), 0.5 + 0.3 * np.cos(24 * y),
                 0.3 + 0.2 * np.sin(20 * (x + y))]
        return np.stack(light, -1), ((r < 0.26) & (r > 0.08)).astype(float)
    return (np.broadcast_to([0.1, 0.7, 0.2], x.shape + (3,)),
            0.4 * (np.abs(x + 0.3 * y - 0.05) < 0.04))


def photograph(x, y, shift=(0, 0), scene=ring_and_glass, depths=(0.8, FOCUS)):
    """Returns the premultiplied light and opacity that a pinhole camera at x, y records.

    shift  offset of the camera from the lens centre; the picture is moved so that points at depth FOCUS stay in place
    scene  light and opacity of points of a plane at one of the depths, which ascend
    """
    at = (np.arange(SAMPLES) + 0.5) / SAMPLES
    columns = (np.arange(WIDTH)[:, None] + at).ravel()
    rows = (np.arange(HEIGHT)[:, None] + at).ravel()
    u, v = np.meshgrid((columns - WIDTH / 2) / FOCAL_PX - shift[0] / FOCUS,
                       -(rows - HEIGHT / 2) / FOCAL_PX - shift[1] / FOCUS)
    light, opacity = np.zeros(u.shape + (3,)), np.zeros(u.shape)
    for depth in depths:
        own, covers = scene(x + u * depth, y + v * depth, depth)
        share = (1 - opacity) * covers
        light += share[..., None] * own
        opacity += share
    return tuple(of.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, -1).mean((1, 3))
                 for of in (light, opacity))


def lens_picture(opening, **scene):
    """Returns premultiplied light and opacity, averaged over points of a lens. `opening` lists them relative to its
    centre."""
    pictures = [photograph(CENTRE[0] + x, CENTRE[1] + y, (x, y), **scene) for x, y in opening]
    return tuple(np.mean([picture[k] for picture in pictures], axis=0) for k in (0, 1))


@functools.lru_cache(maxsize=2)
def photographs(scene):
    """Returns [(x, y, light, opacity)] of the LF cameras of a planar light field. The last two scenes are kept, because
    drawing one takes seconds.

    scene  the keyword arguments of photograph(), as a tuple of (name, value)
    """
    places = [((index % SIDE - SIDE // 2) * PITCH, (index // SIDE - SIDE // 2) * PITCH) for index in range(SIDE * SIDE)]
    pictures = [(x, y, *photograph(x, y, **dict(scene))) for x, y in places]
    for _, _, light, opacity in pictures:
        light.flags.writeable = opacity.flags.writeable = False
    return pictures


def write_field(folder, write, scene=None, **keys):
    """Writes a planar light field. write(file without suffix, light, opacity) writes its LF images."""
    folder.mkdir()
    frames = []
    for index, (x, y, light, opacity) in enumerate(photographs(tuple((scene or {}).items()))):
        write(folder / f"{index:03d}", light, opacity)
        name = next(folder.glob(f"{index:03d}.*")).name
        frames.append({"file_path": name, "transform_matrix": [
            [1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]]})
    text = {"fl_x": FOCAL_PX, "fl_y": FOCAL_PX, "cx": WIDTH / 2, "cy": HEIGHT / 2, "w": WIDTH,
            "h": HEIGHT, "lf_max_radiance": 1, "frames": frames, **keys}
    (folder / "transforms.json").write_text(json.dumps(text))
    return folder


def psnr_db(a, b):
    return -10 * np.log10(np.mean((a - b) ** 2))
