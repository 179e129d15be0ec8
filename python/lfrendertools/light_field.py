# SPDX-License-Identifier: Apache-2.0
"""Light fields: their LF cameras and LF images as arrays."""
from __future__ import annotations

import base64
import dataclasses
import functools
import html
import os
import warnings
from typing import Any, Iterable, Iterator, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .arguments import FilePath
from .camera import Camera
from .camera_path import Path as CameraPath
from .display import display_values
from .errors import Error, UncertainFocusWarning, UsageError, caller_level
from .keywords import suggests_names
from .reading import loaded_ahead
from .rig import Grid, find_grid, plot_of_rig

Floats = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True, eq=False)
class Intrinsics:
    """How LF cameras map directions to pixels.

    Attributes
    ----------
    K : ndarray of shape (3, 3)
        Calibration matrix in pixels. The centre of the upper left pixel is (0.5, 0.5).
    width, height : int
        Size of the LF images in pixels.
    distortion : str
        Model of the lens distortion: "pinhole" (none), "radial-tangential", "fisheye", "fov", "division", "unified",
        "thin-prism fisheye", "radial-tangential thin-prism fisheye" or "brown".
    parameters : tuple of float
        12 numbers, of which the last are 0 if the model has fewer: OpenCV's k1, k2, p1, p2, k3, k4, k5, k6 for
        "radial-tangential" and k1, k2, k3, k4 for "fisheye"; k1, k2, p1, p2, k3, k4 for "brown"; omega for "fov"; k
        for "division"; alpha, beta for "unified"; k1, k2, p1, p2, k3, k4, sx1, sy1 and k0 to k5, p0, p1, s0 to s3 for
        the thin prisms.
    """

    K: Floats
    width: int
    height: int
    distortion: str
    parameters: Tuple[float, ...]


class LightField:
    """A recorded light field: calibrated LF images of one scene. :func:`open` returns one.

    World axes are those of the calibration. The axes of a camera are x to the right, y down, z forward. Pixel
    positions are continuous: the centre of the upper left pixel is (0.5, 0.5). Arrays of all LF cameras are read-only
    views of the light field's own memory, unless their description says otherwise.
    """

    def __init__(self, core: _core.LightField, source: str) -> None:
        self._core = core
        self._source = source
        self._centres: Optional[Floats] = None

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        return f"<LightField {self._source}: {len(self)} LF images>"

    @property
    def source(self) -> str:
        """Absolute path of the file or folder that was opened."""
        return self._source

    @property
    def unit_m(self) -> float:
        """Metres per world unit."""
        return self._core.unit_m

    @property
    def depth_range(self) -> Optional[Tuple[float, float]]:
        """Nearest and farthest depth of the scene in world units, if the calibration states them."""
        return self._core.depth_range

    @functools.cached_property
    def names(self) -> Sequence[str]:
        """Names of the LF images as the calibration states them."""
        return tuple(self._core.names)

    @property
    def cam_from_world(self) -> Floats:
        """Poses, of shape (n, 3, 4): [R|t], which map world points to camera axes."""
        return self._core.cam_from_world

    @property
    def centres(self) -> Floats:
        """Positions of the LF cameras in the world, of shape (n, 3). Computed at the first use, and then kept."""
        if self._centres is None:
            centres = self._core.centres()
            centres.setflags(write=False)
            self._centres = centres
        return self._centres

    @functools.cached_property
    def intrinsics(self) -> Sequence[Intrinsics]:
        """The intrinsics of all LF cameras, each distinct set once."""
        all_of_them = []
        for matrix, width, height, distortion, parameters in self._core.intrinsics():
            matrix.setflags(write=False)
            all_of_them.append(Intrinsics(matrix, width, height, distortion, tuple(parameters)))
        return tuple(all_of_them)

    @property
    def intrinsics_index(self) -> npt.NDArray[np.uint32]:
        """Index into `intrinsics` for each LF camera, of shape (n,)."""
        return self._core.intrinsics_index

    @functools.cached_property
    def K(self) -> Floats:
        """Calibration matrices in pixels, of shape (n, 3, 3). If all LF cameras share one, memory holds it once."""
        matrices = np.array([k.K for k in self.intrinsics])
        if len(matrices) == 1:
            return np.broadcast_to(matrices[0], (len(self), 3, 3))
        chosen: Floats = matrices[self.intrinsics_index]
        chosen.setflags(write=False)
        return chosen

    @property
    def gains(self) -> npt.NDArray[np.float32]:
        """Factors by which the light of LF images is multiplied when it is loaded, of shape (n, 3): R, G, B."""
        return self._core.gains

    @property
    def is_virtual(self) -> npt.NDArray[np.bool_]:
        """True for LF images that were interpolated from recorded ones (doc/densify.md), of shape (n,)."""
        return self._core.is_virtual

    @property
    def times(self) -> Sequence[float]:
        """Recording times of the LF images; empty if none are known (doc/formats/light_field_video.md)."""
        return self._core.times

    @functools.cached_property
    def spacing(self) -> float:
        """Median distance from an LF camera to its nearest neighbour, in world units. Computed at the first use."""
        return self._core.spacing()

    def project(self, i: int, points: npt.ArrayLike) -> Floats:
        """Project points of the world into LF image `i`, lens distortion included.

        Parameters
        ----------
        i : int
            Number of the LF camera, from 0.
        points : array_like of shape (..., 3)
            Points in world units.

        Returns
        -------
        ndarray of shape (..., 2)
            Pixel positions, which may lie outside of the LF image; NaN for points that the lens cannot see.
        """
        rows, shape = arguments.rows("points", points, 3)
        return self._core.project(arguments.index("i", i), rows).reshape(*shape, 2)

    def rays(self, i: int, pixels: npt.ArrayLike) -> Tuple[Floats, Floats]:
        """Return the rays that LF camera `i` records at pixel positions.

        Parameters
        ----------
        i : int
            Number of the LF camera, from 0.
        pixels : array_like of shape (..., 2)
            Pixel positions.

        Returns
        -------
        origins, directions : ndarray of shape (..., 3)
            The LF camera's position, for each ray, and directions of length 1, in world axes. A direction is NaN if no
            ray arrives at the pixel position.
        """
        rows, shape = arguments.rows("pixels", pixels, 2)
        i = arguments.index("i", i)
        directions = self._core.ray_directions(i, rows).reshape(*shape, 3)
        return np.broadcast_to(self.centres[i], directions.shape), directions

    @suggests_names
    def image(self, i: int, rect: Optional[Tuple[int, int, int, int]] = None, masked: float = float("nan"), *,
              stored: bool = False) -> npt.NDArray[Any]:
        """Load an LF image as linear light, with the values that a render reads, or as its file stores it.

        Parameters
        ----------
        i : int
            Number of the LF image, from 0.
        rect : tuple of int, optional
            x_begin, y_begin, x_end, y_end of the part to load, in pixels; by default the whole LF image.
        masked : float, optional
            Value of masked pixels, which send no ray.
        stored : bool, optional
            True: return what the image file stores (:func:`read_image`), without `masked`. If its orientation tag
            turns the picture, rows and columns of `rect` are those of the file.

        Returns
        -------
        ndarray of shape (height, width, 3), or (height, width, channels) if `stored`
            Linear light with sRGB primaries, where 1 is display white. Mosaics are demosaicked.

        Raises
        ------
        InputError
            The LF image is missing or broken.
        UsageError
            `rect` is not within the LF image, or `stored` is asked of a packed store, which has no image files.
        """
        i, part = arguments.index("i", i), None
        if rect is not None:
            # Positions that need more than 32 bits are outside of every LF image, as are their nearest ones.
            x0, y0, x1, y1 = (min(max(at, -2**31), 2**31 - 1) for at in arguments.whole_numbers("rect", rect, 4))
            part = (x0, y0, x1, y1)
        if arguments.flag("stored", stored):
            values = read_image(self._core.image_file(i))
            return values if part is None else values[_part_of(values, part)]
        return self._core.image(i, part, arguments.real("masked", masked))

    @suggests_names
    def images(self, ids: Optional[Iterable[int]] = None, ahead: int = 8, *, masked: float = float("nan"),
               stored: bool = False, strict: bool = False) -> Iterator[Tuple[int, npt.NDArray[Any]]]:
        """Load LF images one after the other. Other threads load the next ones in advance.

        Parameters
        ----------
        ids : iterable of int, optional
            Numbers of LF images; by default all of them.
        ahead : int, optional
            Largest number of LF images that are in memory at the same time.
        masked, stored : float, bool
            As for :meth:`image`.
        strict : bool
            True: a missing or broken LF image is an error; False: it is left out, with a warning in the end.

        Yields
        ------
        i, picture : int, ndarray
            Number of the LF image, and what :meth:`image` returns.
        """
        ahead = arguments.whole("ahead", ahead)
        if ahead < 1:
            raise UsageError(f"ahead={ahead}: expected 1 or more")
        wanted = range(len(self)) if ids is None else arguments.iterator("ids", ids, "numbers of LF images")
        load = functools.partial(self.image, masked=arguments.real("masked", masked),
                                 stored=arguments.flag("stored", stored))
        return loaded_ahead((arguments.whole("ids", i) for i in wanted), load, ahead, arguments.flag("strict", strict))

    def grid(self) -> Optional[Grid]:
        """Find the rows and columns in which the LF cameras stand.

        Returns
        -------
        Grid or None
            None unless every place of one regular grid has exactly one LF camera. LF cameras may stand up to a quarter
            of the pitch beside their places.
        """
        return find_grid(self.centres, self.cam_from_world)

    @suggests_names
    def array(self, views: Optional[Tuple[int, int]] = None, reduce: int = 1, out: Any = None, *,
              strict: bool = False) -> Any:
        """Load LF images of a grid into one array.

        Parameters
        ----------
        views : tuple of int, optional
            Number of rows and columns to load, spread evenly over the grid; by default all of them.
        reduce : int, optional
            Each pixel of the result is the mean of `reduce` x `reduce` pixels. Columns and rows that do not fill a
            square are cut off on the right and below.
        out : array, optional
            Receives the values, such as a `numpy.memmap` or a dataset of h5py, for light fields larger than the memory.
            Its values must be floats.
        strict : bool
            True: a missing or broken LF image is an error; False: its values are NaN, and a warning tells it.

        Returns
        -------
        ndarray of shape (rows, columns, height, width, 3)
            Linear light; masked pixels are NaN.

        Raises
        ------
        UsageError
            The LF cameras do not stand in a regular grid, their images have several sizes, or an argument is wrong.
        """
        grid = self.grid()
        if grid is None:
            raise UsageError("the LF cameras do not stand in a regular grid: use images() instead of array()")
        if len(self.intrinsics) != 1:
            sizes = {(k.width, k.height) for k in self.intrinsics}
            if len(sizes) != 1:
                raise UsageError(f"the LF images have {len(sizes)} sizes: use images() instead of array()")
        rows, columns = grid.shape if views is None else arguments.whole_numbers("views", views, 2)
        reduce = arguments.whole("reduce", reduce)
        if not (1 <= rows <= grid.shape[0] and 1 <= columns <= grid.shape[1]):
            raise UsageError(f"views=({rows}, {columns}): the grid has {grid.shape[0]} rows, {grid.shape[1]} columns")
        k = self.intrinsics[0]
        if reduce < 1 or reduce > min(k.width, k.height):
            raise UsageError(f"reduce={reduce}: expected 1 to {min(k.width, k.height)}")
        size = (k.height // reduce, k.width // reduce)
        shape = (rows, columns, *size, 3)
        if out is None:
            out = np.empty(shape, np.float32)
        elif not hasattr(out, "shape") or not hasattr(out, "dtype"):
            raise TypeError(f"out={out!r}: expected an array")
        elif not np.issubdtype(out.dtype, np.floating):
            raise UsageError(f"out: expected an array of floats, found {out.dtype}")
        elif isinstance(out, np.ndarray) and not out.flags.writeable:
            raise UsageError("out: the array cannot be written to")
        elif tuple(out.shape) != shape:
            raise UsageError(f"out has the shape {tuple(out.shape)}, expected {shape}")
        v = np.linspace(0, grid.shape[0] - 1, rows).round().astype(int)
        u = np.linspace(0, grid.shape[1] - 1, columns).round().astype(int)
        ids = grid.ids[np.ix_(v, u)]
        places = {i: divmod(number, columns) for number, i in enumerate(ids.ravel().tolist())}
        missing = set(places)
        for i, picture in self.images(places, strict=strict):
            if reduce > 1:
                whole = picture[:size[0] * reduce, :size[1] * reduce]
                picture = whole.reshape(size[0], reduce, size[1], reduce, 3).mean(axis=(1, 3))
            out[places[i]] = picture
            missing.remove(i)
        for i in missing:
            out[places[i]] = np.nan
        return out

    @suggests_names
    def path(self, move: str = "auto", *, start: Optional[int] = None,
             focus_distance: Optional[float] = None) -> CameraPath:
        """Return the camera path that `lfexample` writes, as a path to start from.

        Parameters
        ----------
        move : {"auto", "static", "along", "orbit", "dolly", "focus-pull"}
            Movement of the camera. A static path has one frame, others have 50, or up to 101 along a recorded track.
            "auto" is "along" if the LF images are a dense track, such as a hand-held video, otherwise "focus-pull".
        start : int, optional
            Number of the LF camera at which the path begins, which it passes or moves around; by default the one in
            the middle of the capture.
        focus_distance : float, optional
            Distance of the subject in world units. By default it is found by comparing LF images, which takes seconds.

        Returns
        -------
        Path

        Warns
        -----
        UncertainFocusWarning
            The distance of the subject is not sure: state `focus_distance`.

        Raises
        ------
        InputError
            The camera has no room for a visible movement, or the LF images are no recorded track ("along").
        """
        path, doubt = self._example(move, start, focus_distance)
        self._warn_of_focus(doubt)
        return path

    def _example(self, move: str, start: Optional[int], focus_distance: Optional[float]) -> Tuple[CameraPath, str]:
        """Return a first path, and the reason why its focus may be wrong; "" if it is sure."""
        text, doubt = self._core.example(
            os.fsencode(self._source), arguments.text("move", move),
            None if start is None else arguments.index("start", start),
            None if focus_distance is None else arguments.positive("focus_distance", focus_distance, 1e9))
        return CameraPath.parse(text, self._source, self.unit_m), doubt

    def _warn_of_focus(self, doubt: str) -> None:
        if doubt:
            warnings.warn(f"{self._source}: the focus distance is not sure, so that the camera is almost a pinhole: "
                          f"{doubt}; state the distance of the subject as focus_distance=", UncertainFocusWarning,
                          stacklevel=caller_level())

    @functools.cached_property
    def _first_example(self) -> Tuple[CameraPath, str]:
        return self._example("static", None, None)

    def camera(self, **changes: Any) -> Camera:
        """Return a camera that sees the subject of the light field sharply.

        The camera is that of the static path (:meth:`path`). It stands at the LF camera in the middle of the capture
        and is focused on the subject. Its aperture is eight times as wide as the spacing of the LF cameras, or narrower
        if double edges would be visible. The first call takes seconds; later calls use its result.

        Parameters
        ----------
        **changes
            Arguments of :class:`Camera` to replace, such as `focus_distance` or `blades`.

        Returns
        -------
        Camera

        Warns
        -----
        UncertainFocusWarning
            The distance of the subject is not sure, so that the camera is almost a pinhole: state `focus_distance`.
        """
        path, doubt = self._first_example
        if doubt and changes.get("focus_distance") is not None:
            path, doubt = self._example("static", None, changes["focus_distance"])
        self._warn_of_focus(doubt)
        return path[0].replace(**changes)

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in (
            ("LF images", len(self)),
            ("sizes", ", ".join(sorted({f"{k.width} x {k.height}" for k in self.intrinsics}))),
            ("spacing", f"{self.spacing:.4g} units of {self.unit_m:.4g} m")))
        return f"<table>{rows}</table>{plot_of_rig(self.centres, self.cam_from_world)}{self._contact_sheet()}"

    def _contact_sheet(self, count: int = 8, width: int = 120) -> str:
        """Return small pictures of LF images, spread over the light field, as HTML. Leaves out those that fail."""
        pictures = []
        for i in np.linspace(0, len(self) - 1, min(count, len(self))).astype(int):
            try:
                light = self._core.thumbnail(int(i), width)
            except Error:
                continue
            png = base64.b64encode(_core.encode_png(display_values(light))).decode()
            pictures.append(f'<img width="{width}" title="{html.escape(self.names[i])}" '
                            f'src="data:image/png;base64,{png}">')
        return f"<div>{''.join(pictures)}</div>"


def read_image(path: FilePath) -> npt.NDArray[Any]:
    """Read a picture (EXR, PNG, JPEG, TIFF, WebP, ..., or camera raw) as the programs do.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    ndarray of shape (height, width, channels)
        The stored values: uint8, uint16 or, for floats, float32. Channels of EXR files are in the order R, G, B, A,
        then the others.

    Raises
    ------
    InputError
        The file is missing, damaged or of another kind, or holds several pictures, as a focus stack does.
    """
    return _core.read_image(arguments.file_name("path", path))


def _part_of(values: npt.NDArray[Any], rect: Tuple[int, int, int, int]) -> Tuple[slice, slice]:
    x_begin, y_begin, x_end, y_end = rect
    height, width = values.shape[:2]
    if not (0 <= x_begin < x_end <= width and 0 <= y_begin < y_end <= height):
        raise UsageError(f"rect={rect!r}: expected x_begin, y_begin, x_end, y_end within {width} x {height} pixels")
    return slice(y_begin, y_end), slice(x_begin, x_end)
