# SPDX-License-Identifier: Apache-2.0
"""The command line: blender -b SCENE.blend --python .../headless.py -- lfrendertools COMMAND ...

The settings of a capture are those that the panel has stored in the scene, unless options replace them.
"""
import argparse
import math
import pathlib
import signal
import sys
import time
import traceback

import bpy

from . import camera_path
from .capture import capture
from .errors import Failure, UsageError
from .plan import measured_depths, plan_capture, readout

INTERRUPTED = 5
EXIT_CODES = """Exit codes: 0 success, 1 internal error (a bug), 2 wrong usage, 3 bad input, 4 failed output, 5
interrupted. The last line on stderr states the reason."""


def parser():
    main = argparse.ArgumentParser(prog="lfrendertools", epilog=EXIT_CODES,
                                   description="Captures the scene as a light field, and exchanges camera paths.")
    commands = main.add_subparsers(dest="command", required=True, metavar="COMMAND")

    one = commands.add_parser("capture", epilog=EXIT_CODES, help="render the LF images that DIR lacks",
                              description="Renders the LF images that DIR lacks, into linear OpenEXR files, and "
                              "writes transforms.json. The same call continues a capture that was interrupted.")
    one.add_argument("folder", metavar="DIR", type=pathlib.Path)
    one.add_argument("--rig", choices=["plane", "arc", "dome"])
    one.add_argument("--count", nargs=2, type=int, metavar=("COLUMNS", "ROWS"))
    one.add_argument("--spacing", nargs=2, type=float, metavar=("RIGHT", "UP"),
                     help="distance between LF cameras of a plane, and between the rows of an arc, in Blender units")
    one.add_argument("--angle", nargs=2, type=float, metavar=("RIGHT", "UP"),
                     help="degrees between the outer LF cameras of an arc or dome")
    one.add_argument("--pivot", type=float, metavar="DISTANCE",
                     help="distance to what an arc or dome faces, and to the plane of --shift; 0: the focus distance")
    one.add_argument("--overscan", type=float, metavar="SHARE", help="margin on each side, as a share of the picture")
    one.add_argument("--shift", action=argparse.BooleanOptionalAction, default=None,
                     help="shift the lenses of a plane, so that all LF images show the same part of the plane at "
                     "the pivot")
    one.add_argument("--depth-range", nargs=2, type=float, metavar=("NEAR", "FAR"),
                     help="depths of the scene along the optical axes; without: measured by rays")
    one.add_argument("--float", action=argparse.BooleanOptionalAction, default=None,
                     help="32 instead of 16 bits for each value")
    one.add_argument("--max-radiance", type=float, metavar="RADIANCE", help="largest radiance that films keep")
    one.add_argument("--frame", type=int, metavar="N", help="frame of the scene; without: the current one")
    one.add_argument("--plan", action="store_true", help="print what would be rendered, and end")

    one = commands.add_parser("export-path", epilog=EXIT_CODES, help="write the scene's camera as a camera path",
                              description="Writes the scene's camera in each frame of the scene's range as a camera "
                              "path of lfrendertools.")
    one.add_argument("file", metavar="PATH.yaml", type=pathlib.Path)
    one.add_argument("--frames", nargs=2, type=int, metavar=("FIRST", "LAST"), help="instead of the scene's range")

    one = commands.add_parser("import-path", epilog=EXIT_CODES, help="add a camera that follows a camera path",
                              description="Adds a camera with keyframes of a camera path of lfrendertools, makes it "
                              "the scene's camera, and saves the scene.")
    one.add_argument("file", metavar="PATH.yaml", type=pathlib.Path)
    one.add_argument("-o", "--output", required=True, metavar="SCENE.blend", type=pathlib.Path)
    one.add_argument("--lfcammvminfo", default="lfcammvminfo", metavar="PROGRAM",
                     help="the program that reads the path; without: the one that the shell finds")
    return main


def apply(arguments, scene):
    """Puts the options into the settings of the scene."""
    settings = scene.lfrendertools
    if arguments.rig:
        settings.shape = arguments.rig.upper()
    if arguments.count:
        settings.columns, settings.rows = arguments.count
        if list(arguments.count) != [settings.columns, settings.rows]:
            raise UsageError("--count: 1 to 10000 columns and rows")
    if arguments.spacing:
        require(min(arguments.spacing) > 0, "--spacing: more than 0")
        settings.spacing = arguments.spacing
    if arguments.angle:
        require(0 < min(arguments.angle) and max(arguments.angle) < 355, "--angle: more than 0, less than 355 degrees")
        settings.angle = [math.radians(angle) for angle in arguments.angle]
    if arguments.pivot is not None:
        require(arguments.pivot >= 0, "--pivot: 0 or more")
        settings.pivot = arguments.pivot
    if arguments.overscan is not None:
        require(0 <= arguments.overscan <= 4, "--overscan: 0 to 4")
        settings.overscan = arguments.overscan
    if arguments.max_radiance is not None:
        require(arguments.max_radiance > 0, "--max-radiance: more than 0")
        settings.max_radiance = arguments.max_radiance
    if arguments.shift is not None:
        settings.converge = arguments.shift
    if arguments.float is not None:
        settings.use_float = arguments.float
    require(not (arguments.shift and settings.shape != "PLANE"), "--shift: only the rig plane has it")
    if arguments.depth_range:
        require(0 < arguments.depth_range[0] < arguments.depth_range[1], "--depth-range: 0 < NEAR < FAR")


def require(holds, words):
    if not holds:
        raise UsageError(words)


def say(words):
    print(words, file=sys.stderr, flush=True)


def run_capture(arguments, scene):
    apply(arguments, scene)
    if arguments.frame is not None:
        scene.frame_set(arguments.frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    plan = plan_capture(scene, depsgraph, arguments.depth_range and tuple(arguments.depth_range))
    if plan.depth_range is None:
        plan.depth_range = measured_depths(scene, depsgraph, plan)
    say("Depths: {} to {}".format(*plan.depth_range))
    for name, value, is_warning in readout(scene, plan):
        say(f"{name}: {value}" + (" (see doc/blender.md)" if is_warning else ""))
    return 0 if arguments.plan else render_all(scene, plan, arguments.folder)


def render_all(scene, plan, folder):
    """Captures until everything is rendered, or the first Ctrl-C or SIGTERM. Returns the exit code."""
    signals = []

    def stop(number, _):
        signals.append(number)
        signal.signal(number, signal.SIG_DFL)  # a second one ends Blender at once

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    begin = time.monotonic()
    for progress in capture(scene, plan, folder):
        done = progress.kept + progress.rendered
        each_s = (time.monotonic() - begin) / max(progress.rendered, 1)
        left_s = each_s * (progress.total - done)
        say(f"{done} of {progress.total} LF images" +
            (f", {each_s:.3g} s each, {left_s:.0f} s left" if progress.rendered else " are there"))
        if signals and done < progress.total:
            say("error: interrupted; the same call continues")
            return INTERRUPTED
    say(f"{progress.rendered} LF images rendered into {folder}, {progress.kept} were there")
    return 0


def run_export(arguments, scene):
    first, last = arguments.frames or (scene.frame_start, scene.frame_end)
    require(first <= last, "--frames: FIRST is after LAST")
    path = camera_path.export_path(scene, arguments.file, first, last)
    for words in camera_path.warnings_of(scene, path):
        say(f"warning: {words}")
    say(f"{path.count} frames in {arguments.file}")
    return 0


def run_import(arguments, scene):
    camera = camera_path.import_path(scene, arguments.file, arguments.lfcammvminfo)
    bpy.ops.wm.save_as_mainfile(filepath=str(arguments.output.absolute()), copy=True)
    say(f"the camera '{camera.name}' follows {arguments.file} in {arguments.output}")
    return 0


COMMANDS = {"capture": run_capture, "export-path": run_export, "import-path": run_import}


def main():
    """Runs the command behind `-- lfrendertools`, and ends Blender with its exit code."""
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    try:
        if words[:1] != ["lfrendertools"]:
            raise UsageError("the command begins with '-- lfrendertools', for example '-- lfrendertools capture DIR'")
        arguments = parser().parse_args(words[1:])
        code = COMMANDS[arguments.command](arguments, bpy.context.scene)
    except Failure as error:
        say(f"error: {error}")
        code = error.exit_code
    except Exception:
        traceback.print_exc()
        say("error: internal error, please report it")
        code = 1
    sys.stdout.flush()
    sys.exit(code)
