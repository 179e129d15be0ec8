# SPDX-License-Identifier: Apache-2.0
"""Builds scenes in Blender for blender_test.py, and renders what they are compared with. Everything in the scenes
shines and nothing is lit, so that few samples have little noise.

usage: blender -b --factory-startup --python blender_scene.py -- JOB JSON     JSON has the arguments of the function JOB
"""
import json
import math
import pathlib
import sys

import bpy
import mathutils

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "blender" / "lfrendertools_blender"))
from curves import fcurves_of

DEPTH_OF_DOTS = 4.0


def shining(name, colour, scale=0.0):
    """Returns a material that shines with this colour; with soft waves of `scale` if that is above 0."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    emission.inputs["Color"].default_value = (*colour, 1)
    links.new(emission.outputs[0], output.inputs["Surface"])
    if scale > 0:
        place, waves = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexMagic")
        waves.inputs["Scale"].default_value = scale
        waves.turbulence_depth = 2
        links.new(place.outputs["Object"], waves.inputs["Vector"])
        links.new(waves.outputs["Color"], emission.inputs["Color"])
        emission.inputs["Strength"].default_value = 0.6
    return material


def shape(kind, place, material, **sizes):
    """Adds a mesh by its operator, for example uv_sphere, at a place."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=place, **sizes)
    bpy.context.object.data.materials.append(material)
    return bpy.context.object


def empty_scene(width, height, samples):
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene, camera


def shop(file, unit):
    """A scene of things at depths 2.5 to 8, whose camera moves, zooms and pulls the focus in frames 1 to 5. Its
    aperture is a turned triangle that is squeezed, and the lens shifts. `unit`: metres of a Blender unit."""
    scene, camera = empty_scene(192, 128, 8)
    scene.unit_settings.scale_length = unit
    scene.frame_end = 5
    shape("plane", (0, 8, 0), shining("wall", (1, 1, 1), 1.2), size=20).rotation_euler = (math.pi / 2, 0, 0)
    rings = [(-0.7, 2.5, -0.4, (0.8, 0.3, 0.1)), (0.7, 3, 0.4, (0.1, 0.6, 0.3)), (0, 4, 0, (0.7, 0.7, 0.6)),
             (-1.2, 5, 0.7, (0.1, 0.2, 0.7)), (1.3, 6, -0.6, (0.7, 0.1, 0.4))]
    for number, (x, depth, z, colour) in enumerate(rings):
        shape("torus", (x, depth, z), shining(f"ring {number}", colour), major_radius=0.06 * depth,
              minor_radius=0.02 * depth).rotation_euler = (0.4 * number, 0.3, 0.2 * number)
    for number in range(5):
        shape("uv_sphere", (-1.2 + 0.6 * number, 3 + 0.9 * number, 0.2 - 0.25 * (number % 3)),
              shining(f"light {number}", (1.5, 1.35, 0.9)), radius=0.06)
    target = bpy.data.objects.new("target", None)
    scene.collection.objects.link(target)
    lens = camera.data
    lens.lens, lens.sensor_width = 35, 36
    lens.dof.use_dof = True
    lens.dof.focus_object = target
    lens.dof.aperture_fstop = 0.15
    lens.dof.aperture_blades = 3
    lens.dof.aperture_rotation = math.radians(20)
    lens.dof.aperture_ratio = 1.5
    camera.rotation_euler = (math.pi / 2, 0, 0)
    for frame, x, depth, focal, shift in ((1, 0.0, 4.0, 35.0, 0.0), (5, 0.03, 3.0, 38.0, 0.05)):
        camera.location, target.location, lens.lens = (x, 0, 0.3 * x), (0.5, depth, 0.2), focal
        lens.shift_x, lens.shift_y = shift, -shift
        camera.keyframe_insert("location", frame=frame)
        target.keyframe_insert("location", frame=frame)
        for name in ("lens", "shift_x", "shift_y"):
            lens.keyframe_insert(name, frame=frame)
    scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=file)


def dots(file, places, size, percentage, fit, shift, parent_scale, aspect):
    """A scene of shining dots, seen by a camera of every unusual kind. Writes their places in the world beside it.

    places        where the dots are in the picture, as shares of its width and height
    parent_scale  scale of the camera's parent, which is turned and moved; null if it has none
    """
    scene, camera = empty_scene(*size, 256)
    scene.render.resolution_percentage = percentage
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
    lens = camera.data
    lens.lens, lens.sensor_width, lens.sensor_height, lens.sensor_fit = 30, 36, 20, fit
    lens.shift_x, lens.shift_y = shift
    lens.dof.focus_distance = DEPTH_OF_DOTS
    camera.location = (0.3, -0.2, 0.5)
    camera.rotation_euler = (1.3, 0.2, 0.4)
    if parent_scale:
        parent = bpy.data.objects.new("parent", None)
        scene.collection.objects.link(parent)
        parent.scale = parent_scale
        parent.location, parent.rotation_euler = (1, 2, 0.5), (0.2, -0.1, 0.9)
        camera.parent = parent
        camera.rotation_euler = (math.pi / 2, 0, 0)  # other rotations would shear a camera in an unevenly scaled parent
    bpy.context.view_layer.update()
    corners = [corner * (DEPTH_OF_DOTS / -corner.z) for corner in lens.view_frame(scene=scene)]
    low = [min(corner[axis] for corner in corners) for axis in (0, 1)]
    high = [max(corner[axis] for corner in corners) for axis in (0, 1)]
    world_from_camera = mathutils.Matrix.LocRotScale(*camera.matrix_world.decompose()[:2], None)
    world = []
    for x, y in places:
        place = world_from_camera @ mathutils.Vector((low[0] + x * (high[0] - low[0]), high[1] - y * (high[1] - low[1]),
                                                      -DEPTH_OF_DOTS))
        shape("uv_sphere", place, shining("dot", (1, 1, 1)), radius=0.04)
        world.append(list(place))
    with open(file + ".json", "w") as stream:
        json.dump(world, stream)
    bpy.ops.wm.save_as_mainfile(filepath=file)


def traveller(file):
    """A scene whose camera has everything that moves: a scaled and turning parent, a constraint to look at something,
    zoom, focus, aperture and blades. A marker switches to another camera, which is upside down, in frame 7."""
    scene, camera = empty_scene(90, 150, 1)
    scene.frame_start, scene.frame_end = 3, 8
    scene.render.fps, scene.render.fps_base = 24, 1.001
    parent, target = bpy.data.objects.new("parent", None), bpy.data.objects.new("target", None)
    other = bpy.data.objects.new("other", camera.data.copy())
    for each in (parent, target, other):
        scene.collection.objects.link(each)
    parent.scale = (2, 2, 2)
    target.location = (3, 8, 1)
    camera.parent = parent
    camera.location = (0.1, -0.5, 0.2)
    track = camera.constraints.new("TRACK_TO")
    track.target, track.track_axis, track.up_axis = target, "TRACK_NEGATIVE_Z", "UP_Y"
    lens, field = camera.data, camera.data.dof
    lens.sensor_fit, lens.sensor_height, field.use_dof, field.aperture_blades = "VERTICAL", 24, True, 6
    field.aperture_ratio, lens.shift_y = 0.5, -0.2
    for frame, turn, focal, focus, stop, rotation in ((3, 0, 20, 2, 1.4, 0), (8, 1.5, 80, 9, 8, 0.7)):
        parent.rotation_euler, lens.lens = (0.1, turn, 2 * turn), focal
        lens.shift_x = 0.1 * turn
        field.focus_distance, field.aperture_fstop, field.aperture_rotation = focus, stop, rotation
        parent.keyframe_insert("rotation_euler", frame=frame)
        lens.keyframe_insert("lens", frame=frame)
        lens.keyframe_insert("shift_x", frame=frame)
        for name in ("focus_distance", "aperture_fstop", "aperture_rotation"):
            field.keyframe_insert(name, frame=frame)
    other.rotation_euler = (math.pi / 2, math.pi, 0.3)
    other.data.sensor_fit, other.data.sensor_height = "VERTICAL", 24
    other.data.dof.aperture_blades, other.data.dof.aperture_ratio = 6, 0.5
    scene.timeline_markers.new("first", frame=3).camera = camera
    scene.timeline_markers.new("other", frame=7).camera = other
    bpy.ops.wm.save_as_mainfile(filepath=file)


def chan(file, path, order, size, frames):
    """A scene whose camera is read from a .chan by the add-on that comes with Blender, which also writes it again, into
    path.again. `order`: of the rotations, which a .chan does not state."""
    scene, camera = empty_scene(*size, 1)
    scene.frame_start, scene.frame_end = 1, frames
    bpy.ops.preferences.addon_enable(module="io_anim_nuke_chan")
    bpy.context.view_layer.objects.active = camera
    words = {"rotation_order": order, "filepath": path}
    bpy.ops.import_scene.import_chan(**words, z_up=False, sensor_width=36, sensor_height=36 * size[1] / size[0])
    for curve in [*fcurves_of(camera.animation_data), *fcurves_of(camera.data.animation_data)]:
        assert len(curve.keyframe_points) == frames, curve.data_path
    words["filepath"] += ".again"
    bpy.ops.export.export_chan(**words, y_up=False, check_existing=False)
    bpy.ops.wm.save_as_mainfile(filepath=file)


def numbered(file, first, last):
    """A scene of some lights on a wall, whose camera moves from frame `first` to `last`."""
    scene, camera = empty_scene(64, 48, 1)
    scene.frame_start, scene.frame_end = first, last
    shape("plane", (0, 4, 0), shining("wall", (1, 0.8, 0.6), 1.2), size=20).rotation_euler = (math.pi / 2, 0, 0)
    camera.rotation_euler = (math.pi / 2, 0, 0)
    camera.data.dof.use_dof, camera.data.dof.focus_distance, camera.data.dof.aperture_fstop = True, 4, 0.5
    for frame, x in ((first, -0.1), (last, 0.1)):
        camera.location.x = x
        camera.keyframe_insert("location", frame=frame)
    bpy.ops.wm.save_as_mainfile(filepath=file)


def plain(file, size, frames):
    """A scene with Blender's usual camera, which stands still."""
    scene, camera = empty_scene(*size, 1)
    scene.frame_end = frames
    camera.data.dof.focus_distance = 4
    bpy.ops.wm.save_as_mainfile(filepath=file)


def changed(file, **values):
    """Changes attributes of the scene's camera in a file."""
    bpy.ops.wm.open_mainfile(filepath=file)
    for name, value in values.items():
        owner, _, name = name.rpartition("__")
        setattr(getattr(bpy.context.scene.camera.data, owner) if owner else bpy.context.scene.camera.data, name, value)
    bpy.ops.wm.save_mainfile()


def truth(file, frame, output, samples):
    """Renders a frame of a scene with Cycles' own depth of field."""
    bpy.ops.wm.open_mainfile(filepath=file)
    scene = bpy.context.scene
    scene.frame_set(frame)
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    scene.render.filepath = output
    bpy.ops.render.render(write_still=True)


def cameras(file, output):
    """Writes what Blender says about the camera of each frame."""
    bpy.ops.wm.open_mainfile(filepath=file)
    scene = bpy.context.scene
    result = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        camera, lens, field = scene.camera, scene.camera.data, scene.camera.data.dof
        corners = lens.view_frame(scene=scene)  # of the picture, at some depth
        middle = sum(corners, mathutils.Vector()) / len(corners) / -corners[0].z
        result.append({"position": list(camera.matrix_world.translation),
                       "axes": [list(axis) for axis in camera.matrix_world.to_3x3().normalized().transposed()],
                       "half_view": max(corner.x for corner in corners) / -corners[0].z - middle.x,
                       "middle": [middle.x, middle.y],
                       "lens": lens.lens, "use_dof": field.use_dof, "fstop": field.aperture_fstop,
                       "focus": field.focus_distance, "blades": field.aperture_blades,
                       "rotation": field.aperture_rotation, "ratio": field.aperture_ratio})
    with open(output, "w") as stream:
        json.dump(result, stream)


def shown(files, folder):
    """Writes what Blender shows of pictures in three ways: as image N_image.exr, in the sequencer N_sequencer.exr and
    in the compositor N_compositor.exr. N counts the pictures from 0."""
    for number, file in enumerate(files):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        image = bpy.data.images.load(file)
        assert list(image.size) != [0, 0] and len(image.pixels), f"{file}: is empty as an image"
        scene.render.resolution_x, scene.render.resolution_y = image.size
        scene.render.resolution_percentage = 100
        scene.frame_start = scene.frame_end = 1
        scene.view_settings.view_transform = "Raw"
        settings = scene.render.image_settings
        settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
        copy = bpy.data.images.new("copy", *image.size, alpha=True, float_buffer=True)
        copy.pixels = image.pixels[:]
        copy.file_format = "OPEN_EXR"
        copy.save_render(f"{folder}/{number}_image.exr", scene=scene)
        strips_of(scene.sequence_editor_create()).new_image("frames", file, 1, 1)
        scene.render.filepath = f"{folder}/{number}_sequencer.exr"
        bpy.ops.render.render(write_still=True)
        scene.sequence_editor_clear()
        compose(scene, image)
        scene.render.filepath = f"{folder}/{number}_compositor.exr"
        bpy.ops.render.render(write_still=True)


def strip(files, first, frames, folder):
    """Renders frames of a strip of images that begins at frame `first`, into the files N.exr of a folder."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    size = bpy.data.images.load(files[0]).size
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = *size, 100
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    images = strips_of(scene.sequence_editor_create()).new_image("frames", files[0], 1, first)
    for file in files[1:]:
        images.elements.append(pathlib.Path(file).name)
    assert (images.frame_final_start, images.frame_final_duration) == (first, len(files))
    scene.frame_start, scene.frame_end = first, first + len(files) - 1
    for frame in frames:
        scene.frame_set(frame)
        scene.render.filepath = f"{folder}/{frame}.exr"
        bpy.ops.render.render(write_still=True)


def strips_of(editor):
    """Returns the strips of a sequence editor; before Blender 4.4, they are called sequences."""
    return editor.strips if hasattr(editor, "strips") else editor.sequences


def compose(scene, image):
    """Makes the compositor show an image. A scene needs a camera, although nothing of it is seen."""
    if hasattr(scene, "compositing_node_group"):  # Blender 5
        tree = bpy.data.node_groups.new("compositor", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        scene.compositing_node_group = tree
        result = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        result = tree.nodes.new("CompositorNodeComposite")
    source = tree.nodes.new("CompositorNodeImage")
    source.image = image
    tree.links.new(source.outputs[0], result.inputs[0])
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)


job, arguments = sys.argv[sys.argv.index("--") + 1:]
try:
    globals()[job](**json.loads(arguments))
except BaseException:
    sys.excepthook(*sys.exc_info())
    sys.exit(1)
