"""Films densely recorded light fields with a thin-lens camera.

A light field is opened, looked at as arrays, and rendered through a lens:

>>> import lfrendertools as lf
>>> field = lf.open("capture/")                                         # doctest: +SKIP
>>> frame = lf.render(field, field.camera(focus_distance=2.5))         # doctest: +SKIP
>>> frame.save("frame.exr")                                             # doctest: +SKIP

Lengths are world units unless a name ends in `_mm`. The axes of cameras are x to the right, y down, z forward. Light is
linear, with sRGB primaries. Messages go to the logger "lfrendertools".
"""
from __future__ import annotations

import logging

from . import _core
from .camera import Camera, Path
from .errors import (BelowRequired, BlackFrameWarning, Error, InputError, InterruptedRender, MissingImagesWarning,
                     OutputError, UsageError)
from .light_field import Grid, Intrinsics, LightField, open
from .rendering import Frame, Plate, Renderer, film, render

__version__: str = _core.version

__all__ = ["BelowRequired", "BlackFrameWarning", "Camera", "Error", "Frame", "Grid", "InputError", "InterruptedRender",
           "Intrinsics", "LightField", "MissingImagesWarning", "OutputError", "Path", "Plate", "Renderer", "UsageError",
           "film", "open", "render"]

logging.getLogger("lfrendertools").addHandler(logging.NullHandler())
