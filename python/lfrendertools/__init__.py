# SPDX-License-Identifier: Apache-2.0
"""Films densely recorded light fields with a thin-lens camera.

A light field is opened, looked at as arrays, and rendered through a lens:

>>> import lfrendertools as lf
>>> field = lf.open("capture/")
>>> frame = lf.render(field, field.camera(focus_distance=2.5))
>>> frame.save("frame.exr")
>>> field
<LightField ...capture: 49 LF images>
>>> frame
<Frame 1: 160 x 120 of ... LF images>

Lengths are world units unless a name ends in `_mm`. The axes of cameras are x to the right, y down, z forward. Light is
linear, with sRGB primaries. Messages go to the logger "lfrendertools".
"""
from __future__ import annotations

import logging

from . import extension as _extension  # noqa: F401  is first, because it says why this Python cannot load _core
from . import _core
from .camera import Camera
from .camera_path import Path
from .captures import compress, forecast, report, synth, write_packages
from .comparisons import Comparison, compare
from .densifying import densify
from .depth_maps import DepthMap, depth_map
from .display import display_values
from .epipolar import EpipolarPicture, epi
from .errors import (BelowRequired, BlackFrameWarning, Error, InputError, InterruptedRender, MissingImagesWarning,
                     OutputError, UncertainFocusWarning, UsageError)
from .focus_stacks import FocusStack, focus_stack
from .frames import Frame, Plate
from .lens_statistics import through
from .light_field import Intrinsics, LightField, read_image
from .opening import open
from .rendering import Renderer, Selection, film, render, select
from .rig import Grid
from .view_grids import Views, views

__version__: str = _core.version

__all__ = ["BelowRequired", "BlackFrameWarning", "Camera", "Comparison", "DepthMap", "EpipolarPicture", "Error",
           "FocusStack", "Frame", "Grid", "InputError", "InterruptedRender", "Intrinsics", "LightField",
           "MissingImagesWarning", "OutputError", "Path", "Plate", "Renderer", "Selection", "UncertainFocusWarning",
           "UsageError", "Views", "compare", "compress", "densify", "depth_map", "display_values", "epi", "film",
           "focus_stack", "forecast", "open", "read_image", "render", "report", "select", "synth", "through", "views",
           "write_packages"]

logging.getLogger("lfrendertools").addHandler(logging.NullHandler())
