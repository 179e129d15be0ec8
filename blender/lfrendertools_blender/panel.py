# SPDX-License-Identifier: Apache-2.0
"""The panel "Light Field" in the sidebar of the 3D view, its operators, and their entries in the menu File."""
import pathlib

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import camera_path
from .capture import capture
from .errors import Failure
from .plan import measured_depths, plan_capture, readout


def has_camera(context):
    return context.scene.camera is not None


class LFRENDERTOOLS_OT_measure_depths(bpy.types.Operator):
    """Measure the smallest and the largest depth of the scene by rays of the outer LF cameras"""
    bl_idname = "lfrendertools.measure_depths"
    bl_label = "Measure Depths"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return has_camera(context)

    def execute(self, context):
        depsgraph = context.evaluated_depsgraph_get()
        try:
            depths = measured_depths(context.scene, depsgraph, plan_capture(context.scene, depsgraph))
        except Failure as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.scene.lfrendertools.near, context.scene.lfrendertools.far = depths
        return {"FINISHED"}


class LFRENDERTOOLS_OT_capture(bpy.types.Operator):
    """Render the LF images that the folder lacks. Esc stops after the current one, and another call continues"""
    bl_idname = "lfrendertools.capture"
    bl_label = "Capture"

    @classmethod
    def poll(cls, context):
        return has_camera(context)

    def invoke(self, context, _):
        scene = context.scene
        depsgraph = context.evaluated_depsgraph_get()
        try:
            plan = plan_capture(scene, depsgraph)
            if plan.depth_range is None:
                plan.depth_range = measured_depths(scene, depsgraph, plan)
        except Failure as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.work = capture(scene, plan, pathlib.Path(bpy.path.abspath(scene.lfrendertools.folder)))
        manager = context.window_manager
        self.timer = manager.event_timer_add(0.01, window=context.window)
        manager.progress_begin(0, plan.rig.count)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            return self.end(context, {"WARNING"}, "Stopped; Capture continues", {"CANCELLED"})
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            progress = next(self.work)
        except StopIteration:
            return self.end(context, {"INFO"}, "All LF images are rendered", {"FINISHED"})
        except Failure as error:
            return self.end(context, {"ERROR"}, str(error), {"CANCELLED"})
        done = progress.kept + progress.rendered
        context.window_manager.progress_update(done)
        context.workspace.status_text_set(f"{done} of {progress.total} LF images. Esc: stop")
        return {"RUNNING_MODAL"}

    def end(self, context, kind, words, result):
        self.work.close()  # restores the settings of the scene
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        self.report(kind, words)
        return result


class LFRENDERTOOLS_OT_export_path(bpy.types.Operator, ExportHelper):
    """Write the scene's camera, frame by frame, as a camera path of lfrendertools"""
    bl_idname = "lfrendertools.export_path"
    bl_label = "Export Camera Path"
    filename_ext = ".yaml"

    @classmethod
    def poll(cls, context):
        return has_camera(context)

    def execute(self, context):
        scene = context.scene
        try:
            path = camera_path.export_path(scene, self.filepath, scene.frame_start, scene.frame_end)
        except Failure as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{path.count} frames")
        for words in camera_path.warnings_of(scene, path):
            self.report({"WARNING"}, words)
        return {"FINISHED"}


class LFRENDERTOOLS_OT_import_path(bpy.types.Operator, ImportHelper):
    """Add a camera that follows a camera path of lfrendertools"""
    bl_idname = "lfrendertools.import_path"
    bl_label = "Import Camera Path"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".yaml"
    # Annotations, as in settings.py.
    __annotations__ = {"program": StringProperty(name="lfcammvminfo", default="lfcammvminfo",
                                                 description="The program of lfrendertools that reads the path")}

    def execute(self, context):
        try:
            camera_path.import_path(context.scene, self.filepath, self.program)
        except Failure as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class LFRENDERTOOLS_PT_light_field(bpy.types.Panel):
    bl_label = "Light Field"
    bl_idname = "LFRENDERTOOLS_PT_light_field"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Light Field"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        settings = context.scene.lfrendertools
        layout.prop(settings, "shape")
        column = layout.column(align=True)
        column.prop(settings, "columns")
        column.prop(settings, "rows")
        if settings.shape == "PLANE":
            layout.prop(settings, "spacing")
        else:
            layout.prop(settings, "angle", index=-1 if settings.shape == "DOME" else 0,
                        text="Angle")
            if settings.shape == "ARC":
                layout.prop(settings, "spacing", index=1, text="Row Spacing")
        layout.prop(settings, "pivot")
        layout.prop(settings, "overscan")
        if settings.shape == "PLANE":
            layout.prop(settings, "converge")
        column = layout.column(align=True)
        column.prop(settings, "near")
        column.prop(settings, "far")
        layout.operator("lfrendertools.measure_depths")
        self.draw_readout(context)
        layout.prop(settings, "use_float")
        layout.prop(settings, "max_radiance")
        layout.prop(settings, "folder")
        layout.operator("lfrendertools.capture", icon="RENDER_STILL")

    def draw_readout(self, context):
        box = self.layout.box().column(align=True)
        try:
            lines = readout(context.scene, plan_capture(context.scene, context.evaluated_depsgraph_get()))
        except Failure as error:
            box.label(text=str(error), icon="ERROR")
            return
        for name, value, is_warning in lines:
            row = box.split(factor=0.55)
            row.label(text=name)
            row.label(text=value, icon="ERROR" if is_warning else "NONE")


def draw_export(self, _):
    self.layout.operator("lfrendertools.export_path", text="Camera Path of lfrendertools (.yaml)")


def draw_import(self, _):
    self.layout.operator("lfrendertools.import_path", text="Camera Path of lfrendertools (.yaml)")


CLASSES = (LFRENDERTOOLS_OT_measure_depths, LFRENDERTOOLS_OT_capture, LFRENDERTOOLS_OT_export_path,
           LFRENDERTOOLS_OT_import_path, LFRENDERTOOLS_PT_light_field)
