# SPDX-License-Identifier: Apache-2.0
"""Runs a command of the add-on in Blender without a window; nothing needs to be installed.

usage: blender -b SCENE.blend --python headless.py -- lfrendertools capture DIR [OPTIONS]
       blender -b SCENE.blend --python headless.py -- lfrendertools export-path PATH.yaml [OPTIONS]
       blender -b SCENE.blend --python headless.py -- lfrendertools import-path PATH.yaml -o SCENE.blend [OPTIONS]
"""
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import lfrendertools_blender
from lfrendertools_blender import command

if not hasattr(bpy.types.Scene, "lfrendertools"):  # the add-on may be switched on
    lfrendertools_blender.register()
command.main()
