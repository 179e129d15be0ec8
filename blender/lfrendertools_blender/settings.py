# SPDX-License-Identifier: Apache-2.0
"""The settings of a capture, which are stored in the scene as `scene.lfrendertools`."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty


PROPERTIES = {
    "shape": EnumProperty(
        name="Rig", default="PLANE", description="Arrangement of the LF cameras around the scene's camera",
        items=[("PLANE", "Plane", "A grid in the plane of the camera; all LF cameras look in its direction"),
               ("ARC", "Arc", "Columns on an arc around the pivot, rows one above the other"),
               ("DOME", "Dome", "A part of a sphere around the pivot; all LF cameras face it")]),
    "columns": IntProperty(name="Columns", default=15, min=1, max=10000),
    "rows": IntProperty(name="Rows", default=15, min=1, max=10000),
    "spacing": FloatVectorProperty(
        name="Spacing", size=2, default=(0.02, 0.02), min=1e-6, soft_max=10, unit="LENGTH", precision=4,
        description="Distance between neighbouring LF cameras, right and up"),
    "angle": FloatVectorProperty(
        name="Angle", size=2, default=(0.5, 0.5), min=0, max=6.2, unit="ROTATION",
        description="Angle at the pivot between the outer LF cameras, right and up"),
    "pivot": FloatProperty(
        name="Pivot", default=0, min=0, unit="LENGTH",
        description="Distance in front of the camera to the point that an arc or dome faces, and to the plane that all "
                    "shifted LF images share. 0: the camera's focus distance"),
    "overscan": FloatProperty(
        name="Overscan", default=0.1, min=0, max=4, subtype="FACTOR", soft_max=1,
        description="Margin of the LF images on each side, as a share of the picture's width and height"),
    "converge": BoolProperty(
        name="Shift", default=False,
        description="Lens shift of the LF cameras of a plane, so that all of them show the same part of the plane at "
                    "the pivot. They do not turn"),
    "near": FloatProperty(name="Near", default=0, min=0, unit="LENGTH",
                          description="Smallest depth of the scene along the optical axes. 0: measured"),
    "far": FloatProperty(name="Far", default=0, min=0, unit="LENGTH",
                         description="Largest depth of the scene along the optical axes. 0: measured"),
    "use_float": BoolProperty(name="32 Bits", default=False,
                              description="32 instead of 16 bits for each value of an LF image"),
    "max_radiance": FloatProperty(
        name="Brightest", default=16, min=0.001, soft_max=1000,
        description="Largest radiance that films keep (lf_max_radiance). White is 1"),
    "folder": StringProperty(name="Folder", default="//capture", subtype="DIR_PATH",
                             description="Folder of transforms.json and the LF images"),
}


class LFRENDERTOOLS_PG_settings(bpy.types.PropertyGroup):
    # Blender takes properties from annotations. They are no types, so they are not written as annotations.
    __annotations__ = PROPERTIES
