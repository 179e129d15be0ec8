# SPDX-License-Identifier: Apache-2.0
"""lfrendertools for Blender: captures scenes as light fields, and exchanges camera paths (doc/blender.md)."""
import bpy

from . import panel
from .settings import LFRENDERTOOLS_PG_settings

# Blender 4.2 and later read blender_manifest.toml instead.
bl_info = {
    "name": "lfrendertools",
    "description": "Capture scenes as light fields, and exchange camera paths with lfrendertools",
    "author": "The lfrendertools authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Light Field; File > Export and Import",
    "category": "Render",
}


def register():
    bpy.utils.register_class(LFRENDERTOOLS_PG_settings)
    bpy.types.Scene.lfrendertools = bpy.props.PointerProperty(type=LFRENDERTOOLS_PG_settings)
    for each in panel.CLASSES:
        bpy.utils.register_class(each)
    bpy.types.TOPBAR_MT_file_export.append(panel.draw_export)
    bpy.types.TOPBAR_MT_file_import.append(panel.draw_import)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(panel.draw_import)
    bpy.types.TOPBAR_MT_file_export.remove(panel.draw_export)
    for each in reversed(panel.CLASSES):
        bpy.utils.unregister_class(each)
    del bpy.types.Scene.lfrendertools
    bpy.utils.unregister_class(LFRENDERTOOLS_PG_settings)
