# SPDX-License-Identifier: Apache-2.0
"""Frames of light fields: a single one, those of a film, or frames that are rendered step by step."""
from __future__ import annotations

import dataclasses
import threading
import types
import warnings
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple, Type, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .camera import Camera
from .camera_path import Path
from .errors import BlackFrameWarning, UsageError, caller_level, warn_of_missing
from .film_options import film_words
from .frames import Frame, Plate
from .light_field import LightField
from .path_arguments import Frames, frame_numbers, index_of, path_in
from .progress import Progress, TellPhase, checked, telling


class Renderer:
    """Renders the frames of a path step by step, so that unfinished frames can be looked at.

    Parameters
    ----------
    field : LightField
        The light field.
    path : Path or Camera
        The cameras of the frames.
    frames : str or iterable of int, optional
        Frames to render, by their numbers: "1-10,20", "1-100x10", or numbers; by default all.
    mode : {"collect", "rebin", "hybrid"}
        How frames are made from recorded rays (doc/rebinning.md). Default "collect".
    estimator : {"auto", "nearest", "bilinear"}
        How LF pixels contribute to elements. "bilinear": each element reads every LF image at the point that it sees.
        "nearest": each LF pixel is added to one element. Default "auto": "bilinear".
    filter : {"auto", "nearest", "bilinear", "bicubic", "mosaic", "prefiltered"}
        Interpolation between LF pixels, with the estimator "bilinear". Default "auto": "mosaic" for mosaics, "bicubic"
        for brackets, otherwise "prefiltered".
    lens_weights : {"auto", "none", "area", "hat"}
        Weight of each LF image in a frame: the same for all, by the part of the lens that is nearest to its LF camera,
        or by interpolation between the nearest LF images. Default "auto": "area" for large lenses, "hat" for small
        ones, and a mix between.
    lf_pixels : {"auto", "areas", "points"}
        What LF pixels show, for the filters "prefiltered" and "mosaic": the mean light of their area, or the light of
        their centre. Default "auto": as the light field states, otherwise measured.
    order : {"spread", "shuffle", "round-robin", "area", "groups"}
        Order in which frames take LF images, which matters if they end early. Default "spread": spread evenly over the
        lens, however many are taken. "groups": predicted LF images of packed stores are decoded with little memory.
    max_images : int, optional
        Largest number of LF images for each frame. Default None: all.
    max_angle_deg : float, optional
        Largest angle between the optical axes of LF camera and frame, up to 180. Default None: no limit.
    seed : int
        Seed of the random numbers: of the orders "spread", "shuffle" and "groups", and of rebinned rays. Default 0.
    stop_when : str
        Rule by which a frame is finished early: "noise<=X" or "samples>=N", as `--stop-when` of `lfrenderer`. Default
        "": none.
    smooth_below, fill : int
        Elements with fewer rays than `smooth_below` are averaged with their neighbours. Elements without rays are
        filled from elements up to `fill` elements away. Default 0 and 2.
    guard : bool
        True: where a frame of a densified light field is in focus, it shows recorded LF images alone. False: it shows
        virtual LF images there, like anywhere else. Default True.
    interpolation, kept, max_rays, average_others, preview, ... : object
        Settings of kept rays, for the modes "rebin" and "hybrid": those of the options of `lfrenderer` with these
        names (doc/rebinning.md), such as `sigma_st=0.7`. The mode "collect" refuses them. The arguments
        average_others and reparameterise are True or False; slab_position and slab_forward are three numbers.
    memory : str
        Upper limit of the memory that is used, such as "8G" or "512M". Default "8G".
    strict : bool
        True: a missing or broken LF image is an error; False: it is left out, with a warning. Default False.
    threads : int
        Number of threads, up to 512. Default 0: one for each processor.

    Notes
    -----
    All frames must fit in the memory at the same time; :func:`film` renders longer paths. The frames are those of
    `lfrenderer`, bit for bit, and the defaults are the same. They do not depend on `threads`, and depend on `memory`
    only if `mode` is "rebin" or "hybrid".

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> with lf.Renderer(field, field.camera()) as renderer:
    ...     while renderer.step():
    ...         unfinished = renderer.preview()
    ...     plate = renderer.plate()
    >>> int(plate.counts.max()) > 0
    True
    """

    def __init__(self, field: LightField, path: Union[Path, Camera], frames: Frames = None, **options: Any) -> None:
        film_of_all = _Film(field, path, frames, options)
        passes = film_of_all.core.passes()
        if len(passes) != 1:
            raise UsageError(f"{sum(map(len, passes))} frames need {len(passes)} passes in this memory: render at most "
                             f"{len(passes[0])} frames at once, give more memory, or use film()")
        film_of_all.begin(passes[0])
        self._film: Optional[_Film] = film_of_all
        self._is_done = False
        # One thread at a time: frames must not be looked at, or freed, while a batch is added to them.
        self._lock = threading.RLock()

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], value: Optional[BaseException],
                 trace: Optional[types.TracebackType]) -> None:
        with self._lock:
            self._film = None

    def _core_of(self, i: Any = 0) -> Tuple[_core.Film, int]:
        """Return the film, unless it is closed, and the number of a frame in it."""
        if self._film is None:
            raise UsageError("this Renderer is closed: its with statement has ended")
        number = arguments.index("i", i)
        if number < 0:
            raise IndexError(f"frame {number}: frames of a Renderer are numbered from 0")
        return self._film.core, number

    def __repr__(self) -> str:
        with self._lock:
            if self._film is None:
                return "<Renderer, closed>"
            done, total = self._film.core.progress()
            return f"<Renderer: {len(self._film.core.left())} frames, {done} of {total} LF images read>"

    def step(self) -> bool:
        """Read the next batch of LF images.

        Returns
        -------
        bool
            False if no LF image is left.

        Notes
        -----
        Ctrl-C (KeyboardInterrupt) interrupts the batch; another call then repeats it.
        """
        with self._lock:
            core, _ = self._core_of()
            if not self._is_done:
                self._is_done = not core.step()
            return not self._is_done

    @property
    def progress(self) -> Tuple[int, int]:
        """Number of LF images that were read, and total number of those to read."""
        with self._lock:
            return self._core_of()[0].progress()

    @property
    def skipped(self) -> Sequence[Tuple[str, str]]:
        """Names of the LF images that were left out because they are missing or broken, each with the reason."""
        with self._lock:
            return tuple(self._core_of()[0].skipped())

    def preview(self, i: int = 0) -> Frame:
        """Return an unfinished frame, with the rays that it has.

        Parameters
        ----------
        i : int
            Number of the frame in this renderer, from 0.

        Returns
        -------
        Frame

        Raises
        ------
        IndexError
            There is no such frame, or it was stopped.
        UsageError
            The renderer is closed.
        """
        with self._lock:
            core, number = self._core_of(i)
            return Frame(core.develop(number))

    def plate(self, i: int = 0) -> Plate:
        """Return a copy of the plate of a frame.

        Parameters
        ----------
        i : int
            Number of the frame in this renderer, from 0.

        Returns
        -------
        Plate

        Raises
        ------
        IndexError
            There is no such frame, or it was stopped.
        UsageError
            The renderer is closed, or has frames of `mode="rebin"` with `interpolation="cells"`.
        """
        with self._lock:
            core, number = self._core_of(i)
            return Plate(core.plate(number))

    def stop(self, i: int = 0) -> Frame:
        """Finish a frame with the rays that it has, and free its memory.

        Parameters
        ----------
        i : int
            Number of the frame in this renderer, from 0.

        Returns
        -------
        Frame

        Raises
        ------
        IndexError
            There is no such frame, or it was stopped.
        UsageError
            The renderer is closed.
        """
        with self._lock:
            core, number = self._core_of(i)
            frame = Frame(core.develop(number))
            core.release(number)
            return frame


def render(field: LightField, camera: Union[Camera, Path], *, progress: Progress = None,
           **options: Any) -> Frame:
    """Render one frame.

    Parameters
    ----------
    field : LightField
        The light field.
    camera : Camera or Path
        The camera; or a path, whose first frame is rendered unless `frames` names another one.
    progress : bool or callable, optional
        Called with the number of LF images that were read, and their total number. True: a progress bar, if tqdm is
        installed.
    **options
        Options of :class:`Renderer`.

    Returns
    -------
    Frame

    Raises
    ------
    InputError
        No LF image contributes to the frame, or all of them are broken.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> frame = lf.render(field, field.camera(resolution=(80, 60)), filter="bilinear")
    >>> frame.rgb.shape, frame.rgb.dtype, frame.display().dtype
    ((60, 80, 3), dtype('float32'), dtype('uint8'))
    """
    told, frames = checked(progress), options.pop("frames", None)
    first = camera.first_frame if isinstance(camera, Path) else 1
    film_of_one = _Film(field, camera, [first] if frames is None else frames, options)
    passes = film_of_one.core.passes()
    if sum(map(len, passes)) != 1:
        raise UsageError("render() renders one frame: use film() for several")
    film_of_one.begin(passes[0])
    film_of_one.core.check_any_contributes()
    with telling(told, "LF images") as tell:
        next(film_of_one.collect_some(tell, 0))
    film_of_one.core.check_not_all_broken()
    film_of_one.warn_of_missing()
    return Frame(film_of_one.core.develop(0))


def film(field: LightField, path: Path, frames: Frames = None, *, progress: Progress = None,
         **options: Any) -> Iterator[Tuple[int, Frame]]:
    """Render the frames of a path. LF images are read once for all frames that fit in the memory together.

    Parameters
    ----------
    field : LightField
        The light field.
    path : Path
        The cameras.
    frames : str or iterable of int, optional
        Frames to render, by their numbers: "1-10,20", "1-100x10", or numbers; by default all.
    progress : bool or callable, optional
        As for :func:`render`.
    **options
        Options of :class:`Renderer`.

    Yields
    ------
    number, frame : int, Frame
        Frames in the order of their numbers, unless `stop_when` finishes some of them early.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> for number, frame in lf.film(field, field.path("focus-pull", focus_distance=1), frames="1-50x25"):
    ...     frame.save(f"frame_{number:04}.png")
    ...     print(number, frame.rgb.shape)
    1 (120, 160, 3)
    26 (120, 160, 3)
    """
    told = checked(progress)
    return _frames_of(_Film(field, path, frames, options), told)


def _frames_of(sequence: _Film, progress: Progress) -> Iterator[Tuple[int, Frame]]:
    passes = sequence.core.passes()
    with telling(progress, "LF images") as tell:
        for number, some in enumerate(passes):
            sequence.begin(some)
            for f in sequence.collect_some(tell, len(passes) - number - 1):
                frame = Frame(sequence.core.develop(f))
                sequence.core.release(f)
                if frame.image_count == 0 and frame.interpolated is None:
                    warnings.warn(f"frame {frame.number} is black: no recorded ray passes its lens",
                                  BlackFrameWarning, stacklevel=caller_level())
                yield frame.number, frame
            sequence.warn_of_missing()


@dataclasses.dataclass(frozen=True, eq=False)
class Selection:
    """The LF images that a frame reads. :func:`select` returns one.

    Attributes
    ----------
    ids : ndarray of uint32 of shape (n,)
        Numbers of the LF images, in the order in which the frame takes them.
    rects : ndarray of int of shape (n, 4)
        x_begin, y_begin, x_end, y_end of the pixels of each LF image that are read.
    rays : ndarray of uint64 of shape (n,)
        Number of pixels of each LF image that are tested as rays of the frame.
    neighbours : ndarray of uint32 of shape (m,)
        Other LF cameras on which the lens weights of these LF images depend. Their LF images are not read.
    """

    ids: npt.NDArray[np.uint32]
    rects: npt.NDArray[np.int32]
    rays: npt.NDArray[np.uint64]
    neighbours: npt.NDArray[np.uint32]


def select(field: LightField, camera: Union[Camera, Path], frame: Optional[int] = None,
           **options: Any) -> Selection:
    """Return the LF images that a frame reads, without reading them.

    Parameters
    ----------
    field : LightField
        The light field.
    camera : Camera or Path
        The camera, or a path.
    frame : int, optional
        Number of the frame in the path. Default None: the first.
    **options
        Options of :class:`Renderer`.

    Returns
    -------
    Selection

    Examples
    --------
    >>> import lfrendertools as lf
    >>> field = lf.open("capture/")
    >>> selection = lf.select(field, field.camera())
    >>> 0 < len(selection.ids) <= len(field), selection.rects.shape[1]
    (True, 4)
    """
    cameras = path_in(field, camera)
    index = index_of(frame, cameras)
    return Selection(*_Film(field, cameras[index:index + 1], None, options).core.needs(cameras.first_frame))


class _Film:
    """Some frames of a path with their options."""

    def __init__(self, field: LightField, path: Union[Path, Camera], frames: Frames, options: Dict[str, Any]) -> None:
        cameras = path_in(field, path)
        own: Dict[str, Any] = {"memory": "8G", "strict": False, "threads": 0}
        words = film_words(options, own)
        self.core = _core.Film(field._core, [camera._core for camera in cameras], cameras.fps,
                               cameras.first_frame, cameras._shutter, frame_numbers(frames, cameras), words,
                               arguments.memory(own["memory"]), arguments.flag("strict", own["strict"]),
                               arguments.thread_count(own["threads"]))
        self._warned: List[str] = []
        self._done = 0

    def begin(self, frames: Sequence[int]) -> None:
        self.core.begin(list(frames))

    def collect_some(self, tell: TellPhase, passes_left: int) -> Iterator[int]:
        """Collect a pass, and yield the indices of its frames, from 0, when they are finished.

        It tells the progress of all passes, as if those that are left had as many LF images as this one.
        """
        is_going_on = True
        while is_going_on:
            is_going_on = self.core.step()
            done, total = self.core.progress()
            tell(self._done + done, self._done + (passes_left + 1) * total, 0)
            yield from self.core.stopped()
        self._done += total
        yield from self.core.left()

    def warn_of_missing(self) -> None:
        missing = [(name, reason) for name, reason in self.core.skipped() if name not in self._warned]
        self._warned += [name for name, _ in missing]
        warn_of_missing([reason for _, reason in missing])
