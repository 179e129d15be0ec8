# SPDX-License-Identifier: Apache-2.0
"""Plans a capture: the LF cameras in the world, their intrinsics, the depths of the scene, and what this costs."""
import dataclasses
import functools
import math

import bpy
import numpy as np

from . import rig as rigs
from . import scene_camera
from .errors import InputError

RAYS_ACROSS = 32  # rays across an LF image, and down, that measure the depths of the scene
DEPTH_MARGIN = 0.05  # share by which the measured range is widened, because rays miss what is between them


@dataclasses.dataclass
class Plan:
    rig: rigs.Rig
    world_from_camera: np.ndarray  # pose of the scene's camera, 4 x 4
    filmed: scene_camera.Intrinsics  # of the scene's camera
    overscan: float
    converge: bool
    depth_range: tuple  # near, far; None if not known
    focus: float  # distance of the focus plane of the scene's camera
    aperture: float  # diameter of its lens

    @functools.cached_property
    def world_from_lf(self):
        """Poses of the LF cameras, [LF camera][4][4]."""
        return self.world_from_camera @ rigs.poses(self.rig)

    @property
    def margin(self):
        """Pixels that LF images have beyond the picture on the left and right, and above and below."""
        return tuple(math.ceil(self.overscan * side - 1e-6) for side in (self.filmed.width, self.filmed.height))

    @property
    def size(self):
        return self.filmed.width + 2 * self.margin[0], self.filmed.height + 2 * self.margin[1]

    def intrinsics(self, index):
        """Returns the intrinsics of an LF camera: those of the scene's camera with the margin, and with a principal
        point that follows the LF camera if all of them show the same part of the plane at the pivot."""
        k, (width, height), (margin_x, margin_y) = self.filmed, self.size, self.margin
        right = up = 0.0
        if self.converge:
            column, row = index % self.rig.columns, index // self.rig.columns
            right = rigs.offsets(self.rig.columns)[column] * self.rig.spacing[0] / self.rig.pivot
            up = -rigs.offsets(self.rig.rows)[row] * self.rig.spacing[1] / self.rig.pivot
        return dataclasses.replace(k, width=width, height=height, cx=float(k.cx + margin_x + k.fx * right),
                                   cy=float(k.cy + margin_y - k.fy * up))

    def name(self, index):
        """Returns the file name of an LF image, which tells its row and column."""
        return f"{index // self.rig.columns:03d}_{index % self.rig.columns:03d}.exr"


def plan_capture(scene, depsgraph, depth_range=None):
    """Returns the capture that the settings of the scene describe. It has no depths if they state none.

    depth_range  near and far, instead of those of the settings
    """
    settings = scene.lfrendertools
    camera = scene_camera.scene_camera(scene).evaluated_get(depsgraph)
    world_from_camera = scene_camera.pose(camera.name, camera.matrix_world)
    lens = scene_camera.lens(camera.data, world_from_camera, depsgraph)
    pivot = settings.pivot or lens.focus_distance
    if pivot <= 0:
        raise InputError(f"the focus distance of the camera '{camera.name}' is 0: set it, or the pivot of the rig")
    if depth_range is None and 0 < settings.near < settings.far:
        depth_range = settings.near, settings.far
    return Plan(rigs.Rig(settings.shape, settings.columns, settings.rows, tuple(settings.spacing),
                         tuple(settings.angle), pivot),
                world_from_camera,
                scene_camera.intrinsics(camera.data, scene_camera.render_size(scene.render), scene.render),
                settings.overscan, settings.converge and settings.shape == "PLANE", depth_range,
                lens.focus_distance, lens.aperture_diameter)


def measured_depths(scene, depsgraph, plan):
    """Returns the depths (near, far) at which rays of the outer LF cameras and of the middle hit surfaces of the scene.
    InputError if no ray hits any."""
    rig = plan.rig
    views = [(plan.world_from_camera, plan.filmed)]
    for index in {0, rig.columns - 1, rig.count - rig.columns, rig.count - 1}:
        views.append((plan.world_from_lf[index], plan.intrinsics(index)))
    depths = [depth for pose, k in views for depth in depths_along_rays(scene, depsgraph, pose, k)]
    if not depths:
        raise InputError("no ray of the cameras hits a surface: state the smallest and the largest depth of the scene")
    return round_to(min(depths) * (1 - DEPTH_MARGIN), 4), round_to(max(depths) * (1 + DEPTH_MARGIN), 4)


def depths_along_rays(scene, depsgraph, pose, k):
    """Yields the depths at which evenly spread rays of a camera hit surfaces."""
    grid = (np.arange(RAYS_ACROSS) + 0.5) / RAYS_ACROSS
    origin = pose[:3, 3]
    for v in grid * k.height:
        for u in grid * k.width:
            direction = pose[:3, :3] @ [(u - k.cx) / k.fx, (k.cy - v) / k.fy, -1]
            hit, place, *_ = scene.ray_cast(depsgraph, origin, direction / np.linalg.norm(direction))
            if hit:
                yield float((np.array(place) - origin) @ -pose[:3, 2])


def round_to(number, digits):
    return float(f"{number:.{digits}g}")


def readout(scene, plan):
    """Returns what the panel and the command show about a plan: lines of (name, value, is a warning)."""
    length = functools.partial(length_words, scene)
    lines = [("LF images", str(plan.rig.count), False), ("Pixels", "{} x {}".format(*plan.size), False),
             ("Size at most", size_words(scene, plan), False)]
    spacing = max(rigs.spacings(plan.rig))
    if plan.depth_range:
        steps = [rigs.step_px(plan.filmed.fx, spacing, plan.focus, depth) for depth in plan.depth_range]
        for name, step in zip(("Step near", "Step far"), steps):
            lines.append((name, f"{step:.2f} px", step > 1))
        lines.append(("Focus", length(plan.focus), False))
        if max(steps) > 1:
            lines.append(("1 px spacing", length(spacing / max(steps)), False))
    widest = rigs.widest_aperture(plan.rig)
    lines.append(("Widest lens", length(widest), False))
    if plan.aperture > 0:
        lines.append(("Camera's lens", length(plan.aperture), plan.aperture > widest))
    else:
        lines.append(("Camera's lens", "none: Depth of Field is off", True))
    return lines


def length_words(scene, length):
    units = scene.unit_settings
    return bpy.utils.units.to_string(units.system, "LENGTH", length * units.scale_length, precision=3).strip()


def size_words(scene, plan):
    """Returns the size of all LF images before they are compressed."""
    value_bytes = 4 if scene.lfrendertools.use_float else 2
    size = plan.rig.count * plan.size[0] * plan.size[1] * value_bytes * (4 if scene.render.film_transparent else 3)
    for unit in ("kB", "MB", "GB", "TB"):
        size /= 1000
        if size < 1000:
            break
    return f"{size:.3g} {unit}"
