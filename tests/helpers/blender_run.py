# SPDX-License-Identifier: Apache-2.0
"""Runs Blender without a window: jobs of blender_scene.py, and commands of the add-on."""
import json
import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLENDER = shutil.which("blender")


def scene_of(job, **arguments):
    """Runs a job of blender_scene.py. Returns what Blender prints."""
    result = subprocess.run([BLENDER, "-b", "--factory-startup", "--python", ROOT / "tests/helpers/blender_scene.py",
                             "--", job, json.dumps(arguments)], capture_output=True, text=True, timeout=800)
    if result.returncode:
        raise RuntimeError(result.stderr)
    return result.stdout


def command(scene, *words):
    """Returns the words that run a command of the add-on."""
    return [BLENDER, "-b", scene, "--python", ROOT / "blender" / "headless.py", "--", "lfrendertools",
            *map(str, words)]


def addon(scene, *words, code=0):
    """Runs a command of the add-on, which must end with this code. Returns what it says."""
    result = subprocess.run(command(scene, *words), capture_output=True, text=True, timeout=800)
    if result.returncode != code:
        raise AssertionError(f"exit code {result.returncode}: {result.stderr}")
    return result.stderr
