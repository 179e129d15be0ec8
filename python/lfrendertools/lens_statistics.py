# SPDX-License-Identifier: Apache-2.0
"""Frames by a statistic over the lens, which see through leaves, rain and fences."""
from __future__ import annotations

from typing import Optional, Union

from . import _core, arguments
from .camera import Camera
from .camera_path import Path
from .errors import UsageError, warn_of_missing
from .frames import Frame
from .keywords import suggests_names
from .light_field import LightField
from .path_arguments import index_of, path_in
from .progress import Progress, checked, telling

_STATISTICS = ("median", "trimmed", "min", "max", "mean")
_FILTERS = ("auto", "nearest", "bilinear", "bicubic", "prefiltered")
_TRIM = 0.25


@suggests_names
def through(field: LightField, camera: Union[Camera, Path], statistic: str = "median", trim: float = _TRIM,
            order: str = "channels", *, frame: Optional[int] = None, filter: str = "auto", lf_pixels: str = "auto",
            max_angle_deg: Optional[float] = None, strict: bool = False, memory: str = "8G", threads: int = 0,
            progress: Progress = None) -> Frame:
    """See through leaves and rain: make a frame by a statistic over the lens, as `lffocus through`.

    Each LF camera in the lens has one ray in each element, and all rays count the same. The frame shows a statistic of
    these rays instead of their mean, so that things in front of the focus plane vanish if they hide it from some LF
    cameras only. What is not in the focus plane becomes wrong, because the statistics of blur are no blur.

    Parameters
    ----------
    field : LightField
        The light field. Virtual LF images are left out.
    camera : Camera or Path
        The camera, or a path. Open its lens as wide as the LF cameras reach, and focus it on what is to be seen.
    statistic : {"median", "trimmed", "min", "max", "mean"}
        "median": the value in the middle; of an even number the mean of the two in the middle. "trimmed": the mean
        without the share `trim` of the values at each end. "min", "max": the lowest and the highest value, which show
        what is behind brighter and behind darker things as long as one ray is free. "mean": the mean, as
        :func:`render` with `lens_weights="none"`. Default "median".
    trim : float
        Share of the values that "trimmed" leaves out at each end, from 0 to below 0.5: floor(trim * n) of n values.
        Default 0.25. Another value is an error with the other statistics.
    order : {"channels", "luminance"}
        Values that are sorted: each colour by itself, so that a colour may be one that no ray has; or whole rays by
        their luminance. Default "channels".
    frame : int, optional
        Number of the frame of a path that is made. Default None: the first.
    filter : {"auto", "nearest", "bilinear", "bicubic", "prefiltered"}
        Interpolation between LF pixels. Default "auto": "bilinear" for "min" and "max", because other filters
        undershoot and overshoot beside edges; "bicubic" for brackets; otherwise "prefiltered".
    lf_pixels : {"auto", "areas", "points"}
        As for :class:`Renderer`.
    max_angle_deg : float, optional
        Largest angle in degrees between the optical axes of LF camera and frame, up to 180. Default None: no limit.
    strict : bool
        True: a missing or broken LF image is an error; False: it is left out, with a warning.
    memory : str
        Upper limit of the memory that is used, such as "8G". If the values of all rays need more, the frame is made in
        parts, and LF images are read once for each.
    threads : int
        Number of threads; 0: one for each processor.
    progress : bool or callable, optional
        Called with the number of LF images that are done, and their total number. Each part counts its LF images.

    Returns
    -------
    Frame
        `rgb`, of shape (height, width, 3), is linear light with sRGB primaries. `count`, of the same shape, is the
        number of rays of each element, of which the statistic takes some. :meth:`Frame.save` writes the files of the
        program, byte for byte.

    Raises
    ------
    UsageError
        A lens with a transmission or a path with a shutter, which have no share in an order of rays.
    InputError
        No LF camera has a ray through the lens.
    OutputError
        The memory is too small for the values of one row of elements.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> frame = lf.through(field, field.camera(resolution=(80, 60), focus_distance=1), "trimmed", trim=0.3)
    >>> frame.rgb.shape, frame.metadata["lf:statistic"]
    ((60, 80, 3), 'trimmed')
    """
    cameras = path_in(field, camera)
    index = index_of(frame, cameras)
    if cameras.shutter is not None:
        raise UsageError("the path has a shutter, whose blur has no share in an order of rays: leave the shutter out")
    arguments.choice("statistic", statistic, _STATISTICS)
    share = arguments.real("trim", trim)
    if share != _TRIM and statistic != "trimmed":
        raise UsageError(f"trim={trim!r} cannot be used with statistic={statistic!r}: use statistic='trimmed', or "
                         f"leave trim out")
    if not 0 <= share < 0.5:
        raise UsageError(f"trim={trim!r}: expected a share from 0 to below 0.5: the statistic 'median' is the limit")
    angle = None if max_angle_deg is None else arguments.positive("max_angle_deg", max_angle_deg, 180)
    with telling(checked(progress), "LF images") as tell:
        made, skipped = _core.through(
            field._core, cameras.first_frame + index, cameras[index]._core, cameras.fps, statistic, share,
            arguments.choice("order", order, ("channels", "luminance")), arguments.choice("filter", filter, _FILTERS),
            arguments.choice("lf_pixels", lf_pixels, ("auto", "areas", "points")), angle,
            arguments.flag("strict", strict), arguments.memory(memory), arguments.thread_count(threads), tell)
    warn_of_missing([reason for _, reason in skipped])
    return Frame(made)
