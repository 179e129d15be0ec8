# SPDX-License-Identifier: Apache-2.0
"""Light fields as regular grids of views in one orientation, in memory or in a file."""
from __future__ import annotations

import contextlib
import dataclasses
import importlib
import math
import os
import pathlib
from typing import Any, Callable, Iterator, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .arguments import FilePath
from .display import display_values
from .errors import OutputError, UsageError, warn_of_missing
from .keywords import suggests_names
from .light_field import LightField
from .progress import Progress, checked, telling

Floats = npt.NDArray[np.float64]

_MOST_ACROSS = 4096  # limit of lf/analysis/views/view_grid.h
_TYPES = {"linear": np.float32, "srgb8": np.uint8, "srgb16": np.uint16}


@dataclasses.dataclass(frozen=True, eq=False)
class Views:
    """A regular grid of views that all look in one direction. :func:`views` returns one.

    Row 0 is the upper one, column 0 the left one.

    Attributes
    ----------
    array : array of shape (rows, columns, height, width, 3), or None
        The views; the array `out` if it was given, None if they were written into a file.
    positions : ndarray of shape (rows, columns, 2)
        Position of each view from the middle of the LF cameras in world units: x to the right, y down.
    K : ndarray of shape (rows, columns, 3, 3)
        Calibration matrices in pixels.
    cam_from_world : ndarray of shape (rows, columns, 3, 4)
        [R|t], which map world points to camera axes. R is the same for all views.
    ids : ndarray of int of shape (rows, columns)
        Number of the LF image that a view shows; -1 if the view is rendered.
    focus_distance : float, or None
        Depth at which rendered views are sharp; None if none is rendered.
    """

    array: Any
    positions: Floats
    K: Floats
    cam_from_world: Floats
    ids: npt.NDArray[np.int64]
    focus_distance: Optional[float]

    def __repr__(self) -> str:
        rows, columns = self.ids.shape
        return f"<Views of {columns} columns and {rows} rows, {int((self.ids < 0).sum())} of them rendered>"


@suggests_names
def views(field: LightField, grid: Tuple[int, int], *, focus_distance: Optional[float] = None, values: str = "linear",
          out: Any = None, file: Optional[FilePath] = None, memory: str = "8G", strict: bool = False,
          threads: int = 0, progress: Progress = None) -> Views:
    """Resample a light field to a regular grid of views in one orientation, as `lffocus views`.

    Parameters
    ----------
    field : LightField
        The light field.
    grid : tuple of int
        Number of rows and columns. The views are spread evenly over the rectangle around the LF cameras.
    focus_distance : float, optional
        Depth at which rendered views are sharp. Default None: in the middle of the depths of the scene.
    values : {"linear", "srgb8", "srgb16"}
        "linear": linear light, float32, NaN where no LF image shows anything. "srgb8", "srgb16": sRGB for display with
        8 or 16 bits, clipped at black and display white, and black where no LF image shows anything.
    out : array, optional
        Receives the views, such as a `numpy.memmap` or a dataset of h5py, for light fields larger than the memory.
    file : path, optional
        A file to write instead of an array: .npy; or .h5 with the dataset "views" and the datasets "positions", "K",
        "cam_from_world" and "ids", which needs h5py. It appears when it is complete, and replaces an old one.
    memory : str
        Upper limit of the memory of rendered views. Default "8G".
    strict : bool
        True: a missing or broken LF image is an error; False: it is left out, with a warning. Default False.
    threads : int
        Number of threads. Default 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of views that are done, and their total number.

    Returns
    -------
    Views

    Raises
    ------
    InputError
        The LF cameras look in too many directions; or the depths of the scene are neither stated nor found, but needed.
    UsageError
        The LF images are transparent in front of nothing (the background "none"), but views have no opacity.

    Notes
    -----
    Where an LF camera stands at the place of a view, the view is its LF image: unchanged if orientation and intrinsics
    agree, otherwise resampled without lens distortion. Other views are interpolated between LF images.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> grid = lf.views(lf.open("capture/"), (3, 5), focus_distance=0.9, values="srgb8")
    >>> grid.array.shape, grid
    ((3, 5, 120, 160, 3), <Views of 5 columns and 3 rows, 6 of them rendered>)
    """
    rows, columns = (arguments.whole_within("grid", number, 1, _MOST_ACROSS)
                     for number in arguments.whole_numbers("grid", grid, 2))
    kind = _TYPES[arguments.choice("values", values, tuple(_TYPES))]
    focus = None if focus_distance is None else arguments.positive("focus_distance", focus_distance)
    if out is not None and file is not None:
        raise UsageError("out and file: expected at most one of them")
    told = checked(progress)
    height, width, described = _core.describe_views(field._core, columns, rows)
    positions, matrices, poses = (np.array([view[i] for view in described]) for i in range(3))
    made = Views(None, positions.reshape(rows, columns, 2), matrices.reshape(rows, columns, 3, 3),
                 poses.reshape(rows, columns, 3, 4), np.array([view[3] for view in described]).reshape(rows, columns),
                 None)
    shape = (rows, columns, height, width, 3)
    with _target(shape, kind, out, file, made) as target:
        def put(view: int, light: npt.NDArray[np.float32]) -> None:
            target[divmod(view, columns)] = _converted(light, values)
        with telling(told, "views") as tell:
            distance, missing = _core.make_views(
                field._core, columns, rows, focus, arguments.memory(memory), arguments.flag("strict", strict),
                arguments.thread_count(threads), put, tell)
    warn_of_missing(missing)
    return dataclasses.replace(made, array=None if file is not None else target, focus_distance=distance)


def _converted(light: npt.NDArray[np.float32], values: str) -> npt.NDArray[Any]:
    if values == "linear":
        return light
    if values == "srgb8":
        return display_values(light)
    clipped = np.clip(np.nan_to_num(light.astype(np.float64)), 0, 1)
    shown = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    numbers: npt.NDArray[np.uint16] = np.rint(65535 * shown).astype(np.uint16)
    return numbers


@contextlib.contextmanager
def _target(shape: Tuple[int, ...], kind: Any, out: Any, file: Optional[FilePath], made: Views) -> Iterator[Any]:
    """Provide the array that the views are put into."""
    if file is None:
        yield _checked_out(out, shape, kind) if out is not None else _empty(shape, kind)
        return
    path = pathlib.Path(os.fsdecode(arguments.file_name("file", file)))
    if path.suffix == ".npy":
        writer: Callable[..., Any] = _numpy_file
    elif path.suffix in (".h5", ".hdf5"):
        writer = _hdf5_file
    else:
        raise UsageError(f"file={os.fspath(path)!r}: expected a name that ends in .npy or .h5")
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.tmp{path.suffix}")
    try:
        with writer(temporary, shape, kind, made) as target:
            yield target
        with open(temporary, "rb+") as complete:
            os.fsync(complete.fileno())
        os.replace(temporary, path)
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path}: cannot be written: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def _empty(shape: Tuple[int, ...], kind: Any) -> Any:
    try:
        return np.empty(shape, kind)
    except (MemoryError, ValueError) as error:  # ValueError: more elements than NumPy can count
        size = math.prod(shape) * np.dtype(kind).itemsize
        raise MemoryError(f"{shape[0]} x {shape[1]} views of {shape[3]} x {shape[2]} pixels need {size} bytes "
                          f"({size / 2**30:.3g} GiB): write them into a file (file=\"views.npy\"), or ask for fewer "
                          f"views or for values=\"srgb8\"") from error


def _checked_out(out: Any, shape: Tuple[int, ...], kind: Any) -> Any:
    if not hasattr(out, "shape") or not hasattr(out, "dtype"):
        raise TypeError(f"out={out!r}: expected an array")
    if tuple(out.shape) != shape or out.dtype != kind:
        raise UsageError(f"out: expected an array of {np.dtype(kind)} of the shape {shape}, found {out.dtype} and "
                         f"{tuple(out.shape)}")
    return out


@contextlib.contextmanager
def _numpy_file(path: pathlib.Path, shape: Tuple[int, ...], kind: Any, made: Views) -> Iterator[Any]:
    open_memmap: Any = np.lib.format.open_memmap  # NumPy 1.24 does not state its type
    mapped = open_memmap(path, mode="w+", dtype=kind, shape=shape)
    yield mapped
    mapped.flush()


@contextlib.contextmanager
def _hdf5_file(path: pathlib.Path, shape: Tuple[int, ...], kind: Any, made: Views) -> Iterator[Any]:
    try:
        h5py: Any = importlib.import_module("h5py")
    except ImportError:
        raise UsageError(f"{path.suffix}: h5py is missing, which writes HDF5: install it (python3-h5py), or give a "
                         f"name that ends in .npy") from None
    with h5py.File(path, "w") as written:
        for name in ("positions", "K", "cam_from_world", "ids"):
            written[name] = getattr(made, name)
        yield written.create_dataset("views", shape, kind, chunks=(1, 1, *shape[2:]))
