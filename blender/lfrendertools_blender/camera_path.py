# SPDX-License-Identifier: Apache-2.0
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

from . import rig as rigs
from . import scene_camera
from .calibration import unit_m
from .errors import InputError, OutputError
from .plan import round_to

# Camera axes of a path: x right, y down, z forward.
BLENDER_FROM_PATH = np.diag([1.0, -1.0, -1.0])
LEAST_FSTOP = 0.1  # of Blender's cameras
SENSOR_MM = 36  # sensor width of imported cameras
FLOAT_DIGITS = 9  # digits that tell apart all 32-bit floats, which Blender's numbers are
# Largest angle between two frames that becomes a key to turn to. A camera that turns farther has been exchanged.
LARGEST_TURN_RAD = 3


# The quantities of a path that may move.
MOVING = ("position", "quaternion", "focal_length_mm", "shift_mm", "aperture_diameter", "focus_distance",
          "blade_rotation_deg")


@dataclasses.dataclass(frozen=True)
class CameraKey:
    """The camera in one frame. The names are the keys of a path."""
    position: tuple
    quaternion: tuple  # w, x, y, z of world_from_camera, with the axes of a path
    focal_length_mm: float
    sensor_width_mm: float
    shift_mm: tuple  # right and up, on the sensor
    aperture_diameter: float  # of the longer side, if the ratio is not 1
    focus_distance: float
    blades: int
    blade_rotation_deg: float
    ratio: float


@dataclasses.dataclass(frozen=True)
class Exported:
    first: int  # frame of the scene at which the path begins
    count: int  # of frames
    is_pinhole: bool  # True: depth of field is off in all of them


def export_path(scene, file, first, last):
    """Writes the frames first to last of the scene, by its frame step. Returns Exported.

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
    text = path_yaml(scene, keys, first)
    try:
        pathlib.Path(file).write_text(text)
    except OSError as error:
        raise OutputError(f"{file}: {error.strerror}") from None
    return Exported(first, len(keys), all(key.aperture_diameter == 0 for key in keys))


def warnings_of(scene, path):
    """Yields the warnings about an exported path (Exported)."""
    if path.first < 0:
        yield (f"frame {path.first} of the scene is frame 1 of the path, because frames of a path have no numbers "
               "below 0: let the scene begin at frame 0 or later")
    if path.is_pinhole:
        yield pinhole_words(scene)


def pinhole_words(scene):
    """Returns the warning about a path without depth of field. It proposes a lens that the rig of the panel fills."""
    words = ("depth of field is off, so that the path films a pinhole, which sees few LF cameras and has no blur. For "
             "a lens, switch Depth of Field on in the properties of the camera")
    camera, settings = scene.camera.data, scene.lfrendertools
    widest = rigs.widest_aperture(rigs.Rig(settings.shape, settings.columns, settings.rows, tuple(settings.spacing),
                                           tuple(settings.angle), settings.pivot or camera.dof.focus_distance))
    if widest <= 0:
        return words
    stop = max(camera.lens * 1e-3 / widest, LEAST_FSTOP)
    return f"{words}, with an F-Stop of at least {stop:.2g}, which the rig of the panel fills"


def camera_key(scene, depsgraph, previous):
    """Returns the scene's camera in its current frame. InputError if a path cannot describe it."""
    camera = scene_camera.scene_camera(scene).evaluated_get(depsgraph)
    pose = scene_camera.pose(camera.name, camera.matrix_world)
    k = scene_camera.intrinsics(camera.data, scene_camera.render_size(scene.render), scene.render)
    lens = scene_camera.lens(camera.data, pose, depsgraph)
    refuse_foreign_lens(camera, k, lens)
    sensor_mm = lens.focal_mm * k.width / k.fx
    shift_px = k.width / 2 - k.cx, k.cy - k.height / 2
    quaternion = quaternion_of(pose[:3, :3] @ BLENDER_FROM_PATH)
    if previous and np.dot(quaternion, previous.quaternion) < 0:
        quaternion = -quaternion
    return CameraKey(tuple(map(rounded, pose[:3, 3])), tuple(map(float, quaternion)), rounded(lens.focal_mm),
                     rounded(sensor_mm), tuple(rounded(shift * sensor_mm / k.width) for shift in shift_px),
                     rounded(lens.aperture_diameter * max(1, 1 / lens.ratio)),
                     rounded(lens.focus_distance) if lens.focus_distance > 0 else 1.0,
                     lens.blades, rounded(lens.blade_rotation_deg), rounded(lens.ratio))


def rounded(number):
    return round_to(number, FLOAT_DIGITS)


def refuse_foreign_lens(camera, k, lens):
    if k.fx != k.fy:
        raise InputError("pixels are not square, as they are in a path: set both values of the pixel aspect to 1")
    if not 0.1 <= lens.ratio <= 10:
        raise InputError(f"the anamorphic ratio of the camera '{camera.name}' is {lens.ratio:g}: it must be 0.1 to 10")
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


def path_yaml(scene, keys, first_frame):
    """Returns the text of the path, whose frames are numbered from first_frame, as in the scene. InputError if
    something moves that a path keeps constant."""
    first = keys[0]
    constant = {"sensor_width_mm": "sensor size", "blades": "number of blades", "ratio": "anamorphic ratio"}
    for name, words in constant.items():
        if any(getattr(key, name) != getattr(first, name) for key in keys):
            raise InputError(f"the {words} of the camera changes, which a path does not have: keep the first value")
    fps = scene.render.fps / round_to(scene.render.fps_base, 7)
    width, height = scene_camera.render_size(scene.render)
    still, moving = {}, []
    for name in MOVING:
        values = [getattr(key, name) for key in keys]
        if all(value == values[0] for value in values):
            still[name] = values[0]
        else:
            moving.append((name, values))
    line = lambda name: f"  {name}: {value_words(name, still[name])}\n" if name in still else ""
    text = (f"# The camera of the scene {json.dumps(scene.name)}, from Blender {bpy.app.version_string}.\n"
            f"format: lfpath 1\nfps: {fps!r}\nframes: {len(keys)}\n"
            f"{number_line(first_frame)}unit_m: {unit_m(scene)!r}\n"
            f"resolution: [{width}, {height}]\ncamera:\n  sensor_width_mm: {first.sensor_width_mm!r}\n"
            f"{line('focal_length_mm')}{line('shift_mm')}{line('position')}{line('quaternion')}"
            f"lens:\n{line('aperture_diameter')}{line('focus_distance')}"
            f"  blades: {first.blades}\n{line('blade_rotation_deg')}  ratio: {first.ratio!r}\n")
    if moving:
        text += "keyframes:\n" + "".join(keyframes(name, values, fps) for name, values in moving)
    return text


def number_line(first_frame):
    """Returns the line of a path that states the number of its first frame. Frames of a path have no numbers below 0: a
    scene that begins earlier has a path that begins at 1."""
    return f"first_frame: {first_frame}\n" if first_frame >= 0 else ""


def keyframes(name, values, fps):
    lines = [f"  {name}:\n"]
    for index, value in enumerate(values):
        has_cut = name == "quaternion" and index and turn_rad(value, values[index - 1]) > LARGEST_TURN_RAD
        way = "step" if has_cut else "linear"
        lines.append(f"    - {{time: {index / fps!r}, value: {value_words(name, value)}, interpolation: {way}}}\n")
    return "".join(lines)


def turn_rad(a, b):
    """Returns the angle between two quaternions of length 1."""
    return 2 * math.acos(min(1, abs(np.dot(a, b))))


def value_words(name, value):
    if name == "shift_mm":
        return f"{{horizontal: {value[0]!r}, vertical: {value[1]!r}}}"
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
    """Adds a camera that moves as a path says, and makes it the scene's camera. The scene takes over resolution, frame
    rate, and the numbers of the frames. Returns the camera.

    program  the program lfcammvminfo, which evaluates keyframes and accelerations
    """
    path = read_path(file, program)
    cameras = path["cameras"]
    if any(angle for camera in cameras for angle in camera["focus_tilt_deg"]):
        raise InputError(f"{file} tilts the focus plane, which Blender's camera cannot")
    if cameras[0]["blades"] and cameras[0]["blade_roundness"]:
        raise InputError(f"{file} has rounded blades, which Blender's camera does not have")
    if any(camera["hood_mm"][1] for camera in cameras):
        raise InputError(f"{file} has a lens with a hood, which Blender's camera does not have")
    set_frames(scene, path)
    name = pathlib.Path(file).stem
    camera = bpy.data.objects.new(name, bpy.data.cameras.new(name))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.rotation_mode = "QUATERNION"
    scale = path["unit_m"] / unit_m(scene)
    animate(scene, camera, "location", [[x * scale for x in c["position_w"]] for c in cameras])
    animate(scene, camera, "rotation_quaternion", quaternions(cameras))
    animate_lens(scene, camera.data, path)
    scene.frame_set(scene.frame_start)
    return camera


def animate_lens(scene, data, path):
    """Gives a camera (bpy.types.Camera) the lens of a path."""
    cameras = path["cameras"]
    scale = path["unit_m"] / unit_m(scene)
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR_MM
    ratio = cameras[0]["ratio"]
    animate(scene, data.dof, "aperture_blades", [cameras[0]["blades"]])
    animate(scene, data.dof, "aperture_ratio", [ratio])
    views = [plate_width(camera, path["resolution"]) for camera in cameras]  # as multiples of the focal length
    focals = [SENSOR_MM / view for view in views]
    animate(scene, data, "lens", focals)
    for axis, name in enumerate(("shift_x", "shift_y")):
        shifts = [c["shift_mm"][axis] / c["focal_length_mm"] / view for c, view in zip(cameras, views)]
        animate(scene, data, name, shifts)
    # A millimetre of Blender's lens is a thousandth of a Blender unit (scene_camera.lens).
    diameters = [c["aperture_diameter_mm"] * min(1, ratio) / 1000 / unit_m(scene) for c in cameras]
    animate(scene, data.dof, "use_dof", [diameter > 0 for diameter in diameters])
    animate(scene, data.dof, "aperture_fstop",
            [focal / 1000 / diameter if diameter > 0 else 128 for focal, diameter in zip(focals, diameters)])
    animate(scene, data.dof, "focus_distance", [c["focus_distance_w"] * scale for c in cameras])
    turns = [math.radians(c["blade_rotation_deg"] - 90) for c in cameras]
    animate(scene, data.dof, "aperture_rotation", [math.remainder(turn, 2 * math.pi) for turn in turns])


def plate_width(camera, resolution):
    """Returns the width of the plate divided by its distance from the lens.

    The field of view a is the sum of the angles on both sides of the optical axis, whose tangents are x / 2 + s and
    x / 2 - s, with the shift s and the side x of the plate. Hence x = 2 (sqrt(1 + (s sin a)^2) - cos a) / sin a.
    InputError if width and height disagree: s is the shift divided by the focal length, if the lens does not breathe.
    """
    sides = []
    for view_deg, shift_mm in zip(camera["field_of_view_deg"], camera["shift_mm"]):
        view = math.radians(view_deg)
        root = math.hypot(1, shift_mm / camera["focal_length_mm"] * math.sin(view))
        sides.append(2 * (root - math.cos(view)) / math.sin(view))
    if abs(sides[1] * resolution[0] / (sides[0] * resolution[1]) - 1) > 1e-6:
        raise InputError("the path has a lens that is shifted and breathes: lfcammvminfo does not tell how far")
    return sides[0]


def set_frames(scene, path):
    render = scene.render
    render.resolution_x, render.resolution_y = path["resolution"]
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1
    render.fps = max(1, math.ceil(path["fps"] - 1e-6))
    render.fps_base = render.fps / path["fps"]
    scene.frame_step = 1
    # Programs of earlier builds tell no number: the path then begins at the first frame of the scene.
    scene.frame_start = path.get("first_frame", scene.frame_start)
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
    """Sets an attribute, with a key in each frame if it moves. InputError if Blender has another range of values."""
    moves = any(value != values[0] for value in values)
    for frame, value in enumerate(values[:None if moves else 1], scene.frame_start):
        setattr(owner, name, value)
        is_number = isinstance(value, (int, float))
        if is_number and not math.isclose(getattr(owner, name), value, rel_tol=1e-6, abs_tol=1e-6):
            raise InputError(f"{name} {value:g} in frame {frame} is beyond what Blender's cameras have")
        if moves:
            owner.keyframe_insert(name, frame=frame)
