# SPDX-License-Identifier: Apache-2.0
"""Renders the LF images of a plan, and resumes a capture that was interrupted."""
import contextlib
import dataclasses
import json
import os
import pathlib

import bpy
import mathutils

from . import exr
from . import rig as rigs
from . import scene_camera
from .calibration import transforms_json
from .curves import fcurves_of
from .errors import InputError, OutputError

SENSOR_MM = 36  # sensor width of the LF camera, whose focal length follows
SEEDS = 1 << 31


@dataclasses.dataclass(frozen=True)
class Progress:
    rendered: int  # LF images that this capture has rendered
    kept: int  # LF images that an earlier one has rendered
    total: int


def capture(scene, plan, folder):
    """Renders the LF images that the folder lacks, and yields Progress before the first and after each of them.

    A caller may stop between two of them. transforms.json is written first and names all LF images, so that the
    programs of lfrendertools take what is there and say what is missing. InputError if the folder holds another
    capture; OutputError if a file cannot be written.
    """
    folder = pathlib.Path(folder)
    images = folder / "images"
    try:
        images.mkdir(parents=True, exist_ok=True)
        write_calibration(folder / "transforms.json", transforms_json(scene, plan), images)
        missing = [i for i in rigs.coarse_first(plan.rig) if not exr.is_whole(images / plan.name(i), plan.size)]
        progress = Progress(0, plan.rig.count - len(missing), plan.rig.count)
        yield progress
        if not missing:
            return
        first_seed = scene.cycles.seed if scene.render.engine == "CYCLES" else 0
        with lf_camera(scene, plan) as camera:
            for index in missing:
                aim(scene, plan, camera, index, (first_seed + index) % SEEDS)
                render(scene, images / plan.name(index), plan.size)
                progress = dataclasses.replace(progress, rendered=progress.rendered + 1)
                yield progress
    except OSError as error:
        raise OutputError(f"{error.filename or folder}: {error.strerror}") from None


def write_calibration(file, text, images):
    """Writes transforms.json, unless it is there with this text. InputError if it describes another capture."""
    if not file.exists():
        if any(images.glob("[!.]*.exr")):
            raise InputError(f"{images} has LF images, but there is no {file.name}: choose another folder")
        write_file(file, text.encode())
        return
    old = file.read_text()
    if old == text:
        return
    try:
        old = json.loads(old)
        differ = [key for key, value in json.loads(text).items() if old.get(key) != value]
    except (ValueError, AttributeError):
        differ = ["no JSON"]
    raise InputError(f"{file} describes another capture ({', '.join(differ)}): choose another folder, or remove it")


def write_file(file, data):
    """Writes a file under another name first, so that it is either whole or absent."""
    temporary = file.with_name("." + file.name)
    with open(temporary, "wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())
    os.replace(temporary, file)


def render(scene, file, size):
    """Renders the scene into an OpenEXR file without times, so that equal pictures are equal files."""
    temporary = file.with_name("." + file.name)
    scene.render.filepath = str(temporary)
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
    except RuntimeError as error:
        words = str(error).strip().splitlines()[0]
        kind = OutputError if "save" in words else InputError
        raise kind(f"Blender could not render {file.name}: {words}") from None
    if not exr.is_whole(temporary, size):
        raise OutputError(f"Blender wrote no whole picture to {temporary}: is the disk full?")
    write_file(file, exr.without_attributes(temporary.read_bytes(), b"cycles."))


@contextlib.contextmanager
def lf_camera(scene, plan):
    """Adds the LF camera, which is the scene's camera until it is removed at the end. Sets what a capture needs."""
    if sum(layer.use for layer in scene.view_layers) != 1:
        raise InputError(f"{sum(layer.use for layer in scene.view_layers)} view layers of the scene '{scene.name}' are "
                         "rendered: an LF image holds one, so turn the others off")
    original = scene_camera.scene_camera(scene)
    data = original.data.copy()
    data.animation_data_clear()
    data.dof.use_dof = False
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR_MM
    camera = bpy.data.objects.new("LF camera", data)
    camera.rotation_mode = "QUATERNION"
    scene.collection.objects.link(camera)
    try:
        with changed(scene, [*changes(scene, plan), (scene, "camera", camera)]):
            yield camera
    finally:
        bpy.data.cameras.remove(data)  # with the object


def aim(scene, plan, camera, index, seed):
    """Gives the LF camera the pose and the intrinsics of one LF image, and noise of its own."""
    k = plan.intrinsics(index)
    render = scene.render
    camera.matrix_world = mathutils.Matrix(plan.world_from_lf[index].tolist())
    camera.data.lens = k.fx * SENSOR_MM / k.width
    camera.data.shift_x = (k.width / 2 - k.cx) / k.width
    camera.data.shift_y = (k.cy - k.height / 2) / k.width * render.pixel_aspect_y / render.pixel_aspect_x
    if render.engine == "CYCLES":
        scene.cycles.seed = seed


def changes(scene, plan):
    """Yields (owner, attribute, value) of the settings of a capture: pictures in linear light of points of the scene at
    one moment, without depth of field, motion blur, denoising, compositing and times in files."""
    render = scene.render
    yield render, "resolution_x", plan.size[0]
    yield render, "resolution_y", plan.size[1]
    yield render, "resolution_percentage", 100
    yield render, "use_persistent_data", True
    off = ["use_border", "use_crop_to_border", "use_compositing", "use_sequencer", "use_motion_blur", "use_multiview"]
    for name in off + [name for name in dir(render) if name.startswith("use_stamp")]:
        yield render, name, False
    yield render, "filepath", render.filepath
    image = render.image_settings
    if hasattr(image, "media_type"):  # Blender 5
        yield image, "media_type", "IMAGE"
    yield image, "file_format", "OPEN_EXR"
    yield image, "color_mode", "RGBA" if render.film_transparent else "RGB"
    yield image, "color_depth", "32" if scene.lfrendertools.use_float else "16"
    yield image, "exr_codec", "ZIP"
    yield scene.view_settings, "view_transform", "Raw"
    yield scene.view_settings, "exposure", 0
    yield scene.view_settings, "gamma", 1
    yield scene.view_settings, "use_curve_mapping", False
    if render.engine == "CYCLES":
        yield scene.cycles, "use_denoising", False
        yield scene.cycles, "use_animated_seed", False
        yield scene.cycles, "time_limit", 0
        yield scene.cycles, "seed", scene.cycles.seed
    elif hasattr(scene.eevee, "use_motion_blur"):  # EEVEE before Blender 4.2
        yield scene.eevee, "use_motion_blur", False
    for marker in scene.timeline_markers:  # markers may switch cameras
        yield marker, "camera", None


@contextlib.contextmanager
def changed(scene, wanted):
    """Changes attributes, (owner, name, value) each, and restores them at the end. Mutes what animates the scene's
    settings: a driver would set the seed again before each render."""
    animation = scene.animation_data
    curves = [*animation.drivers, *fcurves_of(animation)] if animation else []
    wanted = [(curve, "mute", True) for curve in curves] + list(wanted)
    before = [(owner, name, getattr(owner, name)) for owner, name, _ in wanted]
    try:
        for owner, name, value in wanted:
            setattr(owner, name, value)
        yield
    finally:
        # From the first on, because Blender takes a colour depth only if the file format has it.
        for owner, name, value in before:
            setattr(owner, name, value)
