"""Writes the scene's camera as a camera path of lfrendertools (doc/formats/path.md), and reads such a path.

The path has a key for each frame and quantity that moves, so that nothing depends on how either program interpolates.
"""
import dataclasses
import json
import math
import pathlib
import subprocess

import bpy
import mathutils
import numpy as np

from . import scene_camera
from .calibration import unit_m
from .errors import InputError, OutputError
from .plan import round_to

# Camera axes of a path: x right, y down, z forward.
BLENDER_FROM_PATH = np.diag([1.0, -1.0, -1.0])
SENSOR_MM = 36  # sensor width of imported cameras
FLOAT_DIGITS = 9  # digits that tell apart all 32-bit floats, which Blender's numbers are
# Largest angle between two frames that becomes a key to turn to. A camera that turns farther has been exchanged.
LARGEST_TURN_RAD = 3


@dataclasses.dataclass(frozen=True)
class CameraKey:
    position: tuple
    quaternion: tuple  # w, x, y, z of world_from_camera, with the axes of a path
    focal_mm: float
    sensor_mm: float  # width of the sensor
    aperture_diameter: float
    focus_distance: float
    blades: int
    blade_rotation_deg: float


def export_path(scene, file, first, last):
    """Writes the frames first to last of the scene, by its frame step. Returns their number.

    InputError if a path cannot describe the camera; OutputError if the file cannot be written.
    """
    before = scene.frame_current, scene.frame_subframe
    keys = []
    try:
        for frame in range(first, last + 1, scene.frame_step):
            scene.frame_set(frame)
            try:
                keys.append(camera_key(scene, bpy.context.evaluated_depsgraph_get(), keys[-1] if keys else None))
            except InputError as error:
                raise InputError(f"frame {frame}: {error}") from None
    finally:
        scene.frame_set(before[0], subframe=before[1])
    text = path_yaml(scene, keys)
    try:
        pathlib.Path(file).write_text(text)
    except OSError as error:
        raise OutputError(f"{file}: {error.strerror}") from None
    return len(keys)


def camera_key(scene, depsgraph, previous):
    """Returns the scene's camera in its current frame. InputError if a path cannot describe it."""
    camera = scene_camera.scene_camera(scene).evaluated_get(depsgraph)
    pose = scene_camera.pose(camera.name, camera.matrix_world)
    k = scene_camera.intrinsics(camera.data, scene_camera.render_size(scene.render), scene.render)
    lens = scene_camera.lens(camera.data, pose, depsgraph)
    refuse_foreign_lens(camera, k, lens)
    quaternion = quaternion_of(pose[:3, :3] @ BLENDER_FROM_PATH)
    if previous and np.dot(quaternion, previous.quaternion) < 0:
        quaternion = -quaternion
    rounded = [round_to(number, FLOAT_DIGITS) for number in pose[:3, 3]]
    return CameraKey(tuple(rounded), tuple(map(float, quaternion)), round_to(lens.focal_mm, FLOAT_DIGITS),
                     round_to(lens.focal_mm * k.width / k.fx, FLOAT_DIGITS),
                     round_to(lens.aperture_diameter, FLOAT_DIGITS),
                     round_to(lens.focus_distance, FLOAT_DIGITS) if lens.focus_distance > 0 else 1.0,
                     lens.blades, round_to(lens.blade_rotation_deg, FLOAT_DIGITS))


def refuse_foreign_lens(camera, k, lens):
    if camera.data.shift_x != 0 or camera.data.shift_y != 0:
        raise InputError(f"the camera '{camera.name}' has a lens shift, which a path does not have: set it to 0")
    if k.fx != k.fy:
        raise InputError("pixels are not square, as they are in a path: set both values of the pixel aspect to 1")
    if lens.aperture_diameter > 0 and lens.ratio != 1:
        raise InputError(f"the camera '{camera.name}' has the anamorphic ratio {lens.ratio:g}, which a path does not "
                         "have: set it to 1")
    if lens.aperture_diameter > 0 and lens.focus_distance <= 0:
        raise InputError(f"the focus distance of the camera '{camera.name}' is 0")


def quaternion_of(rotation):
    """Returns the quaternion (w, x, y, z) of a rotation in double precision, of length 1.

    The largest of its numbers comes first, from the diagonal; the others follow from sums of elements.
    """
    m = rotation
    squares = 1 + np.array([np.trace(m), *(2 * m[i, i] - np.trace(m) for i in range(3))])  # 4 w^2, 4 x^2, ...
    products = np.array([[squares[0], m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]],
                         [m[2, 1] - m[1, 2], squares[1], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0]],
                         [m[0, 2] - m[2, 0], m[0, 1] + m[1, 0], squares[2], m[1, 2] + m[2, 1]],
                         [m[1, 0] - m[0, 1], m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], squares[3]]])
    row = products[np.argmax(squares)]  # a multiple of the quaternion
    return row / np.linalg.norm(row)


def path_yaml(scene, keys):
    """Returns the text of the path. InputError if something moves that a path keeps."""
    first = keys[0]
    for name, words in (("sensor_mm", "sensor size"), ("blades", "number of blades")):
        if any(getattr(key, name) != getattr(first, name) for key in keys):
            raise InputError(f"the {words} of the camera changes, which a path cannot tell: animate the focal length")
    fps = scene.render.fps / round_to(scene.render.fps_base, 7)
    width, height = scene_camera.render_size(scene.render)
    still, moving = {}, []
    for name, values in quantities(keys):
        if all(value == values[0] for value in values):
            still[name] = values[0]
        else:
            moving.append((name, values))
    line = lambda name: f"  {name}: {number_words(still[name])}\n" if name in still else ""
    text = (f"# The camera of the scene {json.dumps(scene.name)}, from Blender {bpy.app.version_string}.\n"
            f"format: lfpath 1\nfps: {fps!r}\nframes: {len(keys)}\nunit_m: {unit_m(scene)!r}\n"
            f"resolution: [{width}, {height}]\ncamera:\n  sensor_width_mm: {first.sensor_mm!r}\n"
            f"{line('focal_length_mm')}{line('position')}{line('quaternion')}"
            f"lens:\n{line('aperture_diameter')}{line('focus_distance')}"
            f"  blades: {first.blades}\n{line('blade_rotation_deg')}")
    if moving:
        text += "keyframes:\n" + "".join(keyframes(name, values, fps) for name, values in moving)
    return text


def quantities(keys):
    """Returns the quantities of a path that may move, as (key of the file, value in each frame)."""
    names = {"position": "position", "quaternion": "quaternion", "focal_length_mm": "focal_mm",
             "aperture_diameter": "aperture_diameter", "focus_distance": "focus_distance",
             "blade_rotation_deg": "blade_rotation_deg"}
    return [(name, [getattr(key, field) for key in keys]) for name, field in names.items()]


def keyframes(name, values, fps):
    lines = [f"  {name}:\n"]
    for index, value in enumerate(values):
        has_cut = name == "quaternion" and index and turn_rad(value, values[index - 1]) > LARGEST_TURN_RAD
        way = "step" if has_cut else "linear"
        lines.append(f"    - {{time: {index / fps!r}, value: {number_words(value)}, interpolation: {way}}}\n")
    return "".join(lines)


def turn_rad(a, b):
    """Returns the angle between two quaternions of length 1."""
    return 2 * math.acos(min(1, abs(np.dot(a, b))))


def number_words(value):
    return "[" + ", ".join(map(repr, value)) + "]" if isinstance(value, tuple) else repr(value)


def read_path(file, program):
    """Returns what lfcammvminfo says about a path: the camera of every frame. InputError if it refuses the path."""
    try:
        result = subprocess.run([program, str(file), "--json"], capture_output=True, text=True)
    except OSError as error:
        raise InputError(f"{program}, which reads the path, cannot be run ({error.strerror}): build lfrendertools, and "
                         "name its program lfcammvminfo") from None
    if result.returncode:
        raise InputError((result.stderr.strip().splitlines() or ["lfcammvminfo failed"])[-1].removeprefix("error: "))
    return json.loads(result.stdout)


def import_path(scene, file, program="lfcammvminfo"):
    """Adds a camera that moves as a path says, from the first frame of the scene on, and makes it the scene's camera.
    The scene takes over resolution, frame rate and length. Returns the camera.

    program  the program lfcammvminfo, which evaluates keyframes and accelerations
    """
    path = read_path(file, program)
    cameras = path["cameras"]
    if any(angle for camera in cameras for angle in camera["focus_tilt_deg"]):
        raise InputError(f"{file} tilts the focus plane, which Blender's camera cannot")
    set_frames(scene, path)
    name = pathlib.Path(file).stem
    camera = bpy.data.objects.new(name, bpy.data.cameras.new(name))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.rotation_mode = "QUATERNION"
    data = camera.data
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR_MM
    data.dof.aperture_blades = cameras[0]["blades"]
    scale = path["unit_m"] / unit_m(scene)
    animate(scene, camera, "location", [[x * scale for x in c["position_w"]] for c in cameras])
    animate(scene, camera, "rotation_quaternion", quaternions(cameras))
    focals = [SENSOR_MM / 2 / math.tan(math.radians(c["field_of_view_deg"][0]) / 2) for c in cameras]
    animate(scene, data, "lens", focals)
    # A millimetre of Blender's lens is a thousandth of a Blender unit (scene_camera.lens).
    diameters = [c["aperture_diameter_mm"] / 1000 / unit_m(scene) for c in cameras]
    animate(scene, data.dof, "use_dof", [diameter > 0 for diameter in diameters])
    animate(scene, data.dof, "aperture_fstop",
            [focal / 1000 / diameter if diameter > 0 else 128 for focal, diameter in zip(focals, diameters)])
    animate(scene, data.dof, "focus_distance", [c["focus_distance_w"] * scale for c in cameras])
    animate(scene, data.dof, "aperture_rotation", [math.radians(c["blade_rotation_deg"] - 90) for c in cameras])
    scene.frame_set(scene.frame_start)
    return camera


def set_frames(scene, path):
    render = scene.render
    render.resolution_x, render.resolution_y = path["resolution"]
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1
    render.fps = max(1, math.ceil(path["fps"] - 1e-6))
    render.fps_base = render.fps / path["fps"]
    scene.frame_step = 1
    scene.frame_end = scene.frame_start + path["frames"] - 1


def quaternions(cameras):
    """Returns the rotations of the cameras for Blender, without changes of sign from frame to frame."""
    result = []
    for camera in cameras:
        up, backward = np.array(camera["up"]), -np.array(camera["forward"])
        quaternion = quaternion_of(np.stack([np.cross(up, backward), up, backward], axis=1))
        if result and np.dot(quaternion, result[-1]) < 0:
            quaternion = -quaternion
        result.append(mathutils.Quaternion(quaternion))
    return result


def animate(scene, owner, name, values):
    """Sets an attribute, with a key in each frame if it moves."""
    moves = any(value != values[0] for value in values)
    for frame, value in enumerate(values[:None if moves else 1], scene.frame_start):
        setattr(owner, name, value)
        if moves:
            owner.keyframe_insert(name, frame=frame)
