# SPDX-License-Identifier: Apache-2.0
"""Focus stacks: pictures of one camera that differ only in their focus distance."""
from __future__ import annotations

import dataclasses
from typing import Any, Iterable, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .camera import Camera
from .camera_path import Path
from .errors import UsageError
from .light_field import LightField
from .path_arguments import index_of, path_in
from .progress import Progress
from .rendering import film

# Limits of lf/analysis/focus_stack/focus_planes.h.
_LEAST, _MOST, _MOST_PLANES = 1e-9, 1e9, 10_000


@dataclasses.dataclass(frozen=True, eq=False)
class FocusStack:
    """Pictures of one camera that differ only in their focus distance. :func:`focus_stack` returns one.

    Attributes
    ----------
    distances : ndarray of shape (n,)
        Focus distances in world units.
    rgb : ndarray of float32 of shape (n, height, width, 3)
        Linear light with sRGB primaries; 1 is display white.
    coverage : ndarray of float32 of shape (n, height, width)
        Share of the channels of each element that have a ray of their own.
    cameras : Path
        The cameras of the pictures.
    """

    distances: npt.NDArray[np.float64]
    rgb: npt.NDArray[np.float32]
    coverage: npt.NDArray[np.float32]
    cameras: Path

    def __len__(self) -> int:
        return len(self.distances)

    def __repr__(self) -> str:
        height, width = self.rgb.shape[1:3]
        return (f"<FocusStack of {len(self)} planes from {self.distances[0]:.4g} to {self.distances[-1]:.4g}, "
                f"{width} x {height}>")


def focus_stack(field: LightField, camera: Union[Camera, Path], distances: Optional[Iterable[float]] = None, *,
                planes: int = 30, near: Optional[float] = None, far: Optional[float] = None,
                frame: Optional[int] = None, progress: Progress = None, **options: Any) -> FocusStack:
    """Render pictures of one camera that differ only in their focus distance, as `lffocus stack`.

    LF images are read once for all planes that fit in the memory together.

    Parameters
    ----------
    field : LightField
        The light field.
    camera : Camera or Path
        The camera, or a path.
    distances : iterable of float, optional
        Focus distances in world units, in any order.
    planes : int
        Number of planes from `near` to `far`, even in 1 / distance, if `distances` is not given.
    near, far : float, optional
        Nearest and farthest focus distance. By default the depths of the scene that the light field states; if it
        states none, LF images are compared.
    frame : int, optional
        Number of the frame of a path whose camera is used. Default None: the first.
    progress : bool or callable, optional
        As for :func:`render`.
    **options
        Options of :class:`Renderer`.

    Returns
    -------
    FocusStack

    Raises
    ------
    InputError
        The depths of the scene are neither stated nor found.

    Notes
    -----
    The pictures are those of :func:`render` for cameras that are focused at these distances, bit for bit, unless `mode`
    is "rebin" or "hybrid". They are all in memory: 12 bytes for each element and plane.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> stack = lf.focus_stack(field, field.camera(resolution=(80, 60), focus_distance=1), near=0.5, far=2, planes=4)
    >>> stack.rgb.shape, stack.distances.round(3).tolist()
    ((4, 60, 80, 3), [0.5, 0.667, 1.0, 2.0])
    """
    cameras = path_in(field, camera)
    index = index_of(frame, cameras)
    chosen = cameras[index]._core
    if distances is None:
        found = _even_distances(field, chosen, planes, near, far, options)
    elif near is not None or far is not None or planes != 30:
        raise UsageError("distances cannot be used with planes, near or far")
    else:
        found = _checked(distances)
    stack = Path([Camera._of(_core.focused_at(chosen, distance)) for distance in found], cameras.fps)
    shutter = cameras[index:index + 1]._shutter
    if shutter is not None:  # all planes are exposed while the camera moves as in this frame
        stack._shutter = (*shutter[:2], [_core.focused_at(instant, distance) for distance in found
                                         for instant in shutter[2]])
    width, height = stack[0].resolution
    rgb = np.empty((len(found), height, width, 3), np.float32)
    coverage = np.empty((len(found), height, width), np.float32)
    for number, picture in film(field, stack, progress=progress, **options):
        rgb[number - 1] = picture.rgb
        coverage[number - 1] = picture.coverage
    return FocusStack(np.array(found), rgb, coverage, stack)


def _checked(distances: Iterable[float]) -> "list[float]":
    found = [arguments.within("distances", distance, _LEAST, _MOST)
             for distance in arguments.iterator("distances", distances, "numbers")]
    if not 1 <= len(found) <= _MOST_PLANES:
        raise UsageError(f"distances: expected 1 to {_MOST_PLANES} numbers, found {len(found)}")
    return found


def _even_distances(field: LightField, camera: _core.RenderCamera, planes: int, near: Optional[float],
                    far: Optional[float], options: Any) -> "list[float]":
    count = arguments.whole_within("planes", planes, 1, _MOST_PLANES)
    near_w = None if near is None else arguments.within("near", near, _LEAST, _MOST)
    far_w = None if far is None else arguments.within("far", far, _LEAST, _MOST)
    if near_w is None or far_w is None:
        range_w = _core.focus_range(field._core, camera, arguments.thread_count(options.get("threads", 0)))
        near_w = range_w[0] if near_w is None else near_w
        far_w = range_w[1] if far_w is None else far_w
    if not near_w < far_w:
        raise UsageError(f"near={near_w:g}, far={far_w:g}: expected near below far")
    return _core.even_distances(near_w, far_w, count)
