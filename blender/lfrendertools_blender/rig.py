# SPDX-License-Identifier: Apache-2.0
"""Rigs: the LF cameras around a camera, and how densely they sample the light. Nothing here needs Blender.

A pose of a rig is camera_from_lf, 4 x 4, with the axes x right, y up, z backward: the identity is the scene's camera.
LF cameras stand in rows from the top, each from left to right, as the photographer sees them.
"""
import dataclasses
import math

import numpy as np

SHAPES = ("PLANE", "ARC", "DOME")


@dataclasses.dataclass(frozen=True)
class Rig:
    shape: str = "PLANE"
    columns: int = 15
    rows: int = 15
    spacing: tuple = (0.02, 0.02)  # Blender units, right and up: the plane takes both, the arc that between its rows
    angle: tuple = (0.5, 0.5)  # radians between the outer columns and rows: the dome takes both, the arc the first
    pivot: float = 4.0  # distance to the point that an arc or dome faces, and to the plane that shifted cameras share

    @property
    def count(self):
        return self.columns * self.rows


def offsets(count):
    """Returns count numbers that are 1 apart and have the mean 0."""
    return np.arange(count) - (count - 1) / 2


def turned(yaw, pitch):
    """Returns the rotation of a camera that stands to the right by the angle yaw and above by pitch, and looks back."""
    about_y = np.array([[math.cos(yaw), 0, math.sin(yaw)], [0, 1, 0], [-math.sin(yaw), 0, math.cos(yaw)]])
    about_x = np.array([[1, 0, 0], [0, math.cos(pitch), math.sin(pitch)], [0, -math.sin(pitch), math.cos(pitch)]])
    return about_y @ about_x


def steps(rig):
    """Returns the angles between neighbouring columns and rows."""
    return rig.angle[0] / max(rig.columns - 1, 1), rig.angle[1] / max(rig.rows - 1, 1)


def poses(rig):
    """Returns camera_from_lf of every LF camera, [rows * columns][4][4]."""
    result = np.tile(np.eye(4), (rig.count, 1, 1))
    yaw_step, pitch_step = steps(rig)
    index = 0
    for up in -offsets(rig.rows):
        for right in offsets(rig.columns):
            if rig.shape == "PLANE":
                result[index, :2, 3] = right * rig.spacing[0], up * rig.spacing[1]
            else:
                rotation = turned(right * yaw_step, up * pitch_step if rig.shape == "DOME" else 0)
                result[index, :3, :3] = rotation
                result[index, :3, 3] = rig.pivot * (rotation[:, 2] - [0, 0, 1])
                if rig.shape == "ARC":
                    result[index, 1, 3] = up * rig.spacing[1]
            index += 1
    return result


def coarse_first(rig):
    """Returns the indices of the LF cameras, coarse grids first: every 8th column and row, then every 4th, and so on.
    The first part of a capture is therefore a light field of the whole rig that is less dense."""
    def grid(number):
        return number & -number or 1 << 30  # the largest power of two that divides the number

    return sorted(range(rig.count), key=lambda i: -min(grid(i % rig.columns), grid(i // rig.columns)))


def spacings(rig):
    """Returns the distances between neighbouring LF cameras, right and up; 0 where there are no neighbours."""
    yaw_step, pitch_step = steps(rig)
    right = rig.spacing[0] if rig.shape == "PLANE" else 2 * rig.pivot * math.sin(yaw_step / 2)
    up = 2 * rig.pivot * math.sin(pitch_step / 2) if rig.shape == "DOME" else rig.spacing[1]
    return right if rig.columns > 1 else 0.0, up if rig.rows > 1 else 0.0


def widest_aperture(rig):
    """Returns the diameter of the widest lens at the middle of the rig that LF cameras fill. A lens reaches half a
    camera distance beyond the outer LF cameras (doc/lens-integral.md)."""
    right, up = spacings(rig)
    if rig.shape == "PLANE":
        extents = right * (rig.columns - 1), up * (rig.rows - 1)
    else:
        extents = (2 * rig.pivot * math.sin(rig.angle[0] / 2) if right else 0.0,
                   up * (rig.rows - 1) if rig.shape == "ARC" else 2 * rig.pivot * math.sin(rig.angle[1] / 2)
                   if up else 0.0)
    return min(extents) + max(right, up)


def step_px(fx_px, spacing, focus, depth):
    """Returns how far apart two neighbouring LF cameras show a point, in pixels of an LF image, in a frame that is
    focused at another depth: fx * spacing * |1 / focus - 1 / depth|. Copies more than about a pixel apart are visible
    as ghosts."""
    return fx_px * spacing * abs(1 / focus - 1 / depth)
