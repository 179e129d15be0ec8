# SPDX-License-Identifier: Apache-2.0
"""Makes a small scene of Blender to try the tutorial with: glass, metal and lights on a table.

usage: blender -b --factory-startup --python examples/blender_scene.py -- SCENE.blend
"""
import math
import os
import sys

import bpy
import mathutils


def material(name, colour, **inputs):
    """Returns a material with the inputs of Blender's Principled BSDF, such as Metallic=1."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made


def add(kind, place, look, **sizes):
    """Adds a mesh by its operator, for example uv_sphere, with smooth shading."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=place, **sizes)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(look)


def light(place, colour, strength):
    made = bpy.data.materials.new("light")
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (*colour, 1), strength
    made.node_tree.links.new(emission.outputs[0], output.inputs["Surface"])
    add("uv_sphere", place, made, radius=0.025)


for each in list(bpy.data.objects):
    bpy.data.objects.remove(each)
scene = bpy.context.scene
add("plane", (0, 3, 0), material("table", (0.25, 0.12, 0.06), Roughness=0.25), size=14)
add("uv_sphere", (-0.3, 1.4, 0.16), material("red", (0.7, 0.05, 0.03), Roughness=0.15), radius=0.16)
add("uv_sphere", (0.16, 1.9, 0.2), material("glass", (0.95, 0.98, 1), Transmission=1, Roughness=0), radius=0.2)
add("torus", (0.62, 2.5, 0.08), material("gold", (0.9, 0.6, 0.2), Metallic=1, Roughness=0.2), major_radius=0.2,
    minor_radius=0.08)
add("monkey", (-0.35, 3.1, 0.36), material("blue", (0.05, 0.15, 0.6), Roughness=0.3), size=0.75)
for number in range(14):
    place = (-1.9 + 0.29 * number, 4.6 + 0.25 * math.sin(9 * number), 0.35 + 0.45 * (0.5 + 0.5 * math.sin(5 * number)))
    light(place, [(1, 0.5, 0.15), (0.3, 0.6, 1), (1, 0.85, 0.6)][number % 3], 12)
bpy.ops.object.light_add(type="AREA", location=(-1.5, 0.5, 3))
bpy.context.object.data.energy, bpy.context.object.data.size = 120, 1.5
bpy.context.object.rotation_euler = mathutils.Vector((1.5, 1.8, -3)).to_track_quat("-Z", "Y").to_euler()
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.02, 0.03, 0.05, 1)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.location = (0, 0, 0.5)
camera.rotation_euler = mathutils.Vector((0, 2, -0.3)).to_track_quat("-Z", "Y").to_euler()
camera.data.lens = 40
camera.data.dof.use_dof = True
camera.data.dof.aperture_fstop = 0.45  # 40 mm / 0.45: a lens of 89 mm
camera.data.dof.aperture_blades = 6
scene.frame_start, scene.frame_end = 1, 48
for frame, distance in ((1, 1.4), (8, 1.4), (30, 3.0), (48, 3.0)):
    camera.data.dof.focus_distance = distance
    camera.data.dof.keyframe_insert("focus_distance", frame=frame)
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y = 360, 240
scene.cycles.samples = 16
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(sys.argv[sys.argv.index("--") + 1]))
