# SPDX-License-Identifier: Apache-2.0
"""Checks of the arguments `path` and `frames`, which several functions share."""
from __future__ import annotations

from typing import Iterable, List, Optional, Union

from . import _core, arguments
from .camera import Camera
from .camera_path import Path
from .errors import UsageError
from .light_field import LightField

Frames = Union[None, str, Iterable[int]]


def path_in(field: LightField, path: Union[Path, Camera]) -> Path:
    """Return the path, or the path of one camera, if it can film this light field."""
    if not isinstance(field, LightField):
        raise TypeError(f"expected a light field of lf.open(), found {field!r}")
    cameras = Path([path]) if isinstance(path, Camera) else path
    if not isinstance(cameras, Path):
        raise TypeError(f"expected an lf.Camera or an lf.Path, found {path!r}")
    # All cameras of a path have the same unit.
    if cameras[0].unit_m != field.unit_m:
        raise UsageError(f"the camera has unit_m={cameras[0].unit_m:g}, and the light field {field.unit_m:g}: give the "
                         f"camera unit_m=field.unit_m, or make it by field.camera()")
    return cameras


def frame_numbers(frames: Frames, path: Path) -> List[int]:
    """Return ascending numbers of frames."""
    if frames is None:
        return []
    if isinstance(frames, str):
        return _core.parse_frames(frames, path.first_frame, len(path))
    try:
        numbers = {arguments.whole("frames", number) for number in frames}
    except TypeError:
        raise TypeError(f"frames={frames!r}: expected a list of numbers, or a string such as \"1-10,20\"") from None
    last = path.first_frame + len(path) - 1
    if not numbers or min(numbers) < path.first_frame or max(numbers) > last:
        raise UsageError(f"frames={frames!r}: the path has the frames {path.first_frame} to {last}")
    return sorted(numbers)


def index_of(frame: Optional[int], path: Path) -> int:
    """Return the index of a frame in the path, from 0; None means the first frame."""
    if frame is None:
        return 0
    return arguments.whole_within("frame", frame, path.first_frame, path.first_frame + len(path) - 1) - path.first_frame
