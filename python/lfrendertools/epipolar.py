# SPDX-License-Identifier: Apache-2.0
"""Epipolar pictures: the same line of pixels of each LF image of a row or a column of LF cameras."""
from __future__ import annotations

import dataclasses
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .errors import UsageError, warn_of_missing
from .keywords import suggests_names
from .light_field import LightField

# In the order of EpipolarLines (lf/analysis/epi/epipolar_picture.h).
_LINES = ("auto", "recorded", "nearest", "linear")
_MOST_LINES = 100_000


@dataclasses.dataclass(frozen=True, eq=False)
class EpipolarPicture:
    """One line of pixels of each LF image of a row or a column of LF cameras. :func:`epi` returns one.

    A point at depth z moves by `-focal_px * (1 / z - 1 / g)` pixels for each world unit that the position of a line
    advances, where g is the focus distance.

    Attributes
    ----------
    rgb : ndarray of float32 of shape (lines, pixels, 3)
        Linear light with sRGB primaries. Lines are ordered from left to right, of a column from top to bottom. Pixels
        that an LF image does not show are NaN.
    positions : ndarray of shape (lines,)
        Position of each line along the row or column in world units; 0 at the LF camera `through`.
    ids : ndarray of int of shape (lines,)
        Number of the LF image that each line is made of, or the nearest one.
    lines : {"recorded", "nearest", "linear"}
        How lines are made of LF images.
    focal_px : float
        Focal length along the line of pixels.
    direction : ndarray of shape (3,)
        Direction of the row or column in the world, of length 1.
    view_from_world : ndarray of shape (3, 3)
        Rotation from world axes to those of the view, whose z axis depths are measured along.
    """

    rgb: npt.NDArray[np.float32]
    positions: npt.NDArray[np.float64]
    ids: npt.NDArray[np.int64]
    lines: str
    focal_px: float
    direction: npt.NDArray[np.float64]
    view_from_world: npt.NDArray[np.float64]

    def __repr__(self) -> str:
        return f"<EpipolarPicture of {self.rgb.shape[0]} lines of {self.rgb.shape[1]} pixels, {self.lines}>"


@suggests_names
def epi(field: LightField, *, row: Optional[int] = None, column: Optional[int] = None,
        through: Union[None, int, str] = None, focus_distance: Optional[float] = None, lines: str = "auto",
        count: Optional[int] = None, tolerance: Optional[float] = None, strict: bool = False,
        threads: int = 0) -> EpipolarPicture:
    """Make the epipolar picture of a row or a column of LF cameras, as `lffocus epi`.

    LF images are first resampled, without lens distortion, to cameras of one orientation.

    Parameters
    ----------
    field : LightField
        The light field.
    row, column : int
        Pixel row, for a row of LF cameras; or pixel column, for a column of them. They are counted in the view of the
        LF camera `through`, from 0. One of them is required.
    through : int or str, optional
        Number or name of an LF image of the row or column. By default the one in the middle of the light field.
    focus_distance : float, optional
        Depth of the points that do not move from line to line. Default None: infinity.
    lines : {"auto", "recorded", "nearest", "linear"}
        "recorded": one line for each LF image. "nearest", "linear": lines at even positions, of the nearest LF image
        or interpolated. Default "auto": "recorded" if the positions are even, otherwise "nearest".
    count : int, optional
        Number of lines at even positions. Default None: as many as LF images.
    tolerance : float, optional
        How far an LF camera may be beside the line, in world units. Default None: a quarter of the median distance
        between LF cameras.
    strict : bool
        True: a missing or broken LF image is an error; False: its line is NaN, with a warning. Default False.
    threads : int
        Number of threads. Default 0: one for each processor.

    Returns
    -------
    EpipolarPicture

    Raises
    ------
    InputError
        `through` stands in no row or column of LF cameras.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> picture = lf.epi(lf.open("capture/"), row=60)
    >>> picture
    <EpipolarPicture of 7 lines of 160 pixels, recorded>
    >>> slope = -picture.focal_px / 0.8                   # pixels per world unit, of a point at depth 0.8
    """
    if (row is None) == (column is None):
        raise UsageError(f"row={row!r}, column={column!r}: expected one of them")
    pixel = arguments.whole_within("column", column, 0, 2**20) if row is None else \
        arguments.whole_within("row", row, 0, 2**20)
    kind = _LINES.index(arguments.choice("lines", lines, _LINES))
    if count is not None and lines == "recorded":
        raise UsageError("count cannot be used with lines=\"recorded\"")
    chosen = None if count is None else arguments.whole_within("count", count, 2, _MOST_LINES)
    within = None if tolerance is None else arguments.positive("tolerance", tolerance)
    focus = None if focus_distance is None else arguments.positive("focus_distance", focus_distance)
    rgb, positions, ids, made, focal_px, direction, rotation, missing = _core.epi(
        field._core, row is not None, pixel, _id_of(field, through), within, focus, kind, chosen,
        arguments.flag("strict", strict), arguments.thread_count(threads))
    warn_of_missing(missing)
    return EpipolarPicture(rgb, np.array(positions), np.array(ids), _LINES[made], focal_px, direction, rotation)


def _id_of(field: LightField, through: Union[None, int, str]) -> int:
    if through is None:
        return _core.middle_id(field._core)
    if isinstance(through, str):
        return _core.id_of_name(field._core, through)
    return arguments.whole_within("through", through, 0, len(field) - 1)
