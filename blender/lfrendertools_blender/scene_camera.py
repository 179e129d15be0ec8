# SPDX-License-Identifier: Apache-2.0
"""The camera of a scene in numbers: intrinsics, pose and lens, by our conventions (doc/conventions.md).

Pixel coordinates are continuous, and (0, 0) is the upper left corner of the image. Poses are world_from_camera with
Blender's (OpenGL's) camera axes: x right, y up, z backward. Lengths are Blender units, unless a name says otherwise.
"""
import dataclasses
import math

import numpy as np

from .errors import InputError

# Largest cosine between two axes of a camera that its parents have not sheared: rounding gives about 1e-7.
ORTHOGONAL = 1e-5


@dataclasses.dataclass(frozen=True)
class Intrinsics:
    width: int
    height: int
    fx: float  # pixels, as the next three
    fy: float
    cx: float
    cy: float


@dataclasses.dataclass(frozen=True)
class Lens:
    focal_mm: float
    aperture_diameter: float  # 0 for a pinhole, that is, if depth of field is off
    focus_distance: float  # along the optical axis
    blades: int  # 0 for a round aperture
    blade_rotation_deg: float  # by our convention: 0 is a vertex straight up
    ratio: float  # Blender's anamorphic ratio


def scene_camera(scene):
    """Returns the camera of the scene. InputError unless it is a perspective camera."""
    camera = scene.camera
    if camera is None or camera.type != "CAMERA":
        raise InputError(f"the scene '{scene.name}' has no camera: add one, or make one the active camera")
    if camera.data.type != "PERSP":
        raise InputError(f"the camera '{camera.name}' is of the type {camera.data.type}: a light field and a path need "
                         "the type Perspective")
    return camera


def render_size(render):
    """Returns width and height of rendered pictures, rounded down as Blender does."""
    return (render.resolution_x * render.resolution_percentage // 100,
            render.resolution_y * render.resolution_percentage // 100)


def intrinsics(camera, size, render):
    """Returns the intrinsics of a camera (bpy.types.Camera) for pictures of this size.

    Blender lets the sensor span the width or the height of the picture (`sensor_fit`); AUTO is the longer one, which
    then takes sensor_width. Its lens shift moves the picture by a share of that side.
    """
    width, height = size
    pixel_ratio = render.pixel_aspect_y / render.pixel_aspect_x
    fit = camera.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if width >= height * pixel_ratio else "VERTICAL"
    sensor_mm = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    spanned = width if fit == "HORIZONTAL" else height * pixel_ratio  # in widths of a pixel
    fx = camera.lens * spanned / sensor_mm
    return Intrinsics(width, height, fx, fx / pixel_ratio, width / 2 - camera.shift_x * spanned,
                      height / 2 + camera.shift_y * spanned / pixel_ratio)


def pose(name, matrix_world):
    """Returns world_from_camera (4 x 4) without the scale of parents, which Blender's renderers ignore.

    name  the camera's name, for the InputError that is raised if parents shear or mirror it
    """
    matrix = np.array(matrix_world, dtype=float)
    axes = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    if np.abs(axes.T @ axes - np.eye(3)).max() > ORTHOGONAL or np.linalg.det(axes) < 0:
        raise InputError(f"the camera '{name}' is sheared or mirrored by its parents: apply their scale")
    right, _, backward = axes.T
    right = right - backward * (right @ backward)
    right /= np.linalg.norm(right)
    matrix[:3, :3] = np.stack([right, np.cross(backward, right), backward], axis=1)
    return matrix


def focus_distance(camera, world_from_camera, depsgraph):
    """Returns the distance of the focus plane along the optical axis, for the focus object if there is one."""
    field = camera.dof
    if field.focus_object is None:
        return field.focus_distance
    target = field.focus_object.evaluated_get(depsgraph)
    matrix = target.matrix_world
    if target.type == "ARMATURE" and field.focus_subtarget in target.pose.bones:
        matrix = matrix @ target.pose.bones[field.focus_subtarget].matrix
    position = np.array(matrix.translation, dtype=float)
    return abs(float((world_from_camera[:3, 3] - position) @ world_from_camera[:3, 2]))


def lens(camera, world_from_camera, depsgraph):
    """Returns the lens of a camera (bpy.types.Camera).

    Cycles takes a millimetre of the focal length for a thousandth of a Blender unit, whatever the scene's unit scale:
    the diameter is therefore in Blender units. Its polygons have a vertex at the left at rotation 0, ours have one at
    the top. Both turn counter-clockwise, as the photographer sees it.
    """
    field = camera.dof
    return Lens(focal_mm=camera.lens,
                aperture_diameter=camera.lens * 1e-3 / field.aperture_fstop if field.use_dof else 0.0,
                focus_distance=focus_distance(camera, world_from_camera, depsgraph),
                blades=field.aperture_blades if field.aperture_blades >= 3 else 0,
                blade_rotation_deg=90 + math.degrees(field.aperture_rotation),
                ratio=field.aperture_ratio)
