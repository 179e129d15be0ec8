# SPDX-License-Identifier: Apache-2.0
"""Opens light fields."""
from __future__ import annotations

import os
import pathlib
import re
from typing import Any, Optional, Sequence, Tuple, Union

from . import _core, arguments
from .arguments import FilePath
from .keywords import suggests_names
from .light_field import LightField

_URL = re.compile("[A-Za-z][A-Za-z0-9+.-]*://")
_LAYOUTS = ("", "mosaic", "quilt", "lenslets")
_ALPHAS = ("auto", "mask", "straight", "premultiplied")


@suggests_names
def open(path: FilePath, *, focal_px: Optional[float] = None, fov_deg: Optional[float] = None,
         images: Optional[FilePath] = None, image_scale: str = "auto", image_alpha: str = "auto",
         background: str = "", pitch: Union[None, float, Tuple[float, float]] = None,
         plane_distance: Optional[float] = None, flip_x: bool = False, flip_y: bool = False,
         grid: Optional[Tuple[int, int]] = None, serpentine: bool = False, layout: str = "",
         time: Union[None, float, Sequence[float]] = None, recorded_fps: Optional[float] = None,
         frame_cache: Optional[FilePath] = None, store_cache: Optional[FilePath] = None, reduce: int = 1
         ) -> LightField:
    """Open a light field of any supported form.

    Parameters
    ----------
    path : path
        A calibration file or its folder (transforms.json, COLMAP, Middlebury, LLFF, HCI, AOS, exports of other
        programs), a packed store (STORE.lfs), the URL of one on a web server (https://HOST/STORE.lfs), a folder of
        images with Stanford names, or a picture that holds the views of a grid of cameras.
    focal_px : float, optional
        Focal length in pixels, for folders with Stanford names and trajectories in the form of TUM's benchmark.
    fov_deg : float, optional
        Field of view of the square LF images, for poses of Airborne Optical Sectioning (AOS).
    images : path, optional
        Folder that is searched for the image files by their names, if they are not where the calibration says.
    image_scale, image_alpha, background : str, optional
        The options of `lfrenderer` with these names.
    pitch : float or tuple of float, optional
        For folders with Stanford names: distance between columns, and between rows, in world units.
    plane_distance : float, optional
        For folders with Stanford names: distance, in world units, of the plane to which the images are rectified.
    flip_x, flip_y : bool, optional
        For folders with Stanford names: True if columns or rows are counted in the opposite direction.
    grid : tuple of int, optional
        For folders of images with any names: columns and rows of the LF cameras, whose images follow each other in the
        order of their names (numbers by their value), row by row from the upper left one on.
    serpentine : bool, optional
        True if every second row of `grid` runs from right to left.
    layout : str, optional
        How one picture holds the views of `grid`: "mosaic", "quilt" or "lenslets". "": as its name says, or a mosaic.
    time : float or sequence of float, optional
        For light field videos: the time that is shown, in seconds from the first frame (in a transforms.json, in units
        of its key time). Several times open the slices that a path with the key `time` shows.
    recorded_fps : float, optional
        For light field videos in folders of frames: frames per second; 30 if it is not given.
    frame_cache : path, optional
        For light field videos: folder into which frames are decoded, in place of the one beside the light field.
    store_cache : path, optional
        For URLs: folder for local copies, in place of the one in the user's cache folder.
    reduce : int, optional
        Load LF images at 1/reduce of their width and height: 1, 2, 4 or 8.

    Returns
    -------
    LightField

    Raises
    ------
    UsageError
        `path` is a light field video, and `time` is missing or outside of it.
    InputError
        There is no light field at `path`, or its calibration is wrong.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> field.cam_from_world.shape, field.K.shape, field.cam_from_world.flags.writeable
    ((49, 3, 4), (49, 3, 3), False)
    >>> field.image(0).shape, field.image(0, stored=True).dtype
    ((120, 160, 3), dtype('uint8'))
    >>> field.array(views=(3, 3), reduce=2).shape
    (3, 3, 60, 80, 3)
    """
    # The working directory may change while the light field is open.
    source = _name_of_light_field(path)
    if pitch is not None:
        pair = arguments.numbers("pitch", pitch if hasattr(pitch, "__len__") else (pitch, pitch), 2, 2)
        pitch = (pair[0], pair[1])
    if grid is not None:
        sides = arguments.whole_numbers("grid", grid, 2)
        grid = (sides[0], sides[1])
    times: Any = () if time is None else time if hasattr(time, "__len__") else (time,)
    core = _core.open_light_field(
        os.fsencode(source), 0.0 if focal_px is None else arguments.positive("focal_px", focal_px),
        0.0 if fov_deg is None else arguments.positive("fov_deg", fov_deg),
        b"" if images is None else os.fsencode(_absolute("images", images)),
        arguments.text("image_scale", image_scale), arguments.choice("image_alpha", image_alpha, _ALPHAS),
        arguments.text("background", background), pitch,
        None if plane_distance is None else arguments.real("plane_distance", plane_distance),
        grid, arguments.choice("layout", layout, _LAYOUTS),
        (arguments.flag("flip_x", flip_x), arguments.flag("flip_y", flip_y), arguments.flag("serpentine", serpentine)),
        [arguments.real("time", value) for value in times],
        0.0 if recorded_fps is None else arguments.positive("recorded_fps", recorded_fps),
        b"" if frame_cache is None else os.fsencode(_absolute("frame_cache", frame_cache)),
        b"" if store_cache is None else os.fsencode(_absolute("store_cache", store_cache)),
        arguments.whole("reduce", reduce))
    return LightField(core, source)


def _name_of_light_field(path: FilePath) -> str:
    name = os.fsdecode(arguments.file_name("path", path))
    return name if _URL.match(name) else _absolute("path", path)


def _absolute(name: str, path: FilePath) -> str:
    return str(pathlib.Path(os.fsdecode(arguments.file_name(name, path))).absolute())
