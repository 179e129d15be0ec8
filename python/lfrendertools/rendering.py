"""Frames of light fields: a single one, those of a film, or frames that are rendered step by step."""
from __future__ import annotations

import os
import pathlib
import threading
import types
import warnings
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple, Type, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .camera import Camera, Path
from .errors import BlackFrameWarning, MissingImagesWarning, UsageError
from .light_field import LightField

# A function that is called with the number of LF images that were read so far, and the number that will be read in all.
Progress = Callable[[int, int], None]
Frames = Union[None, str, Iterable[int]]

_FORMATS = {".exr": "exr", ".png": "png"}


class Frame:
    """A frame of a light field. Its arrays share its memory: :meth:`save` writes changes that were made to them.

    :func:`render`, :func:`film`, :class:`Renderer` and :meth:`Plate.develop` make frames.
    """

    def __init__(self, core: _core.Frame) -> None:
        self._core = core

    @property
    def number(self) -> int:
        """Number of the frame in its path, from 1."""
        return self._core.number

    @property
    def camera(self) -> Camera:
        """The camera that took the frame."""
        return Camera._of(self._core.camera)

    @property
    def rgb(self) -> npt.NDArray[np.float32]:
        """Linear light with sRGB primaries, of shape (height, width, 3); 1 is display white."""
        return self._core.rgb

    @property
    def count(self) -> npt.NDArray[np.uint32]:
        """Number of rays of each channel, of shape (height, width, 3). With lens weights, sums of weights instead."""
        return self._core.count

    @property
    def coverage(self) -> npt.NDArray[np.float32]:
        """Share of the channels of each element that have a ray of their own, of shape (height, width)."""
        return self._core.coverage

    @property
    def effective(self) -> Optional[npt.NDArray[np.float32]]:
        """Number of LF images of equal weight that would give the same noise, of shape (height, width).

        None if rays have no lens weights.
        """
        return self._core.effective

    @property
    def opacity(self) -> Optional[npt.NDArray[np.float32]]:
        """Opacity, by which `rgb` is multiplied, of shape (height, width). None unless the light field keeps it."""
        return self._core.opacity

    @property
    def interpolated(self) -> Optional[npt.NDArray[np.float32]]:
        """Share of the light that is interpolated, of shape (height, width). None unless rays are rebinned."""
        return self._core.interpolated

    @property
    def densified(self) -> Optional[npt.NDArray[np.float32]]:
        """Share of the light that virtual LF images contribute to, of shape (height, width).

        None unless the light field is densified and `guard` is True.
        """
        return self._core.densified

    @property
    def image_count(self) -> int:
        """Number of recorded LF images with a ray in the frame."""
        return self._core.image_count

    @property
    def metadata(self) -> Dict[str, Union[str, float, int]]:
        """The facts about the frame that its files state."""
        return dict(self._core.metadata)

    def display(self) -> npt.NDArray[np.uint8]:
        """Return the picture for a display: sRGB values from 0 to 255, of shape (height, width, 3)."""
        linear = np.clip(np.nan_to_num(self.rgb.astype(np.float64)), 0, 1)
        srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        values: npt.NDArray[np.uint8] = np.floor(255 * srgb + 0.5).astype(np.uint8)
        return values

    def save(self, path: Union[str, "os.PathLike[str]"], format: Optional[str] = None) -> None:
        """Write the frame as `lfrenderer` does: EXR with linear light and all other channels, or PNG for display.

        Parameters
        ----------
        path : path
            The file. It appears only when it is whole.
        format : str, optional
            "exr" (half floats), "exr-float" (single precision), "png" or "png16"; by default "exr" or "png", by the
            suffix of `path`.
        """
        name = os.fsdecode(arguments.file_name(path))
        chosen = _FORMATS.get(pathlib.Path(name).suffix.lower()) if format is None else arguments.text("format", format)
        if chosen is None:
            raise UsageError(f"{name}: expected a name that ends in .exr or .png, or a format")
        with arguments.naming_arguments():
            self._core.save(os.fsencode(name), chosen)

    def _repr_png_(self) -> bytes:
        return _core.encode_png(self.display())

    def __repr__(self) -> str:
        height, width = self.rgb.shape[:2]
        return f"<Frame {self.number}: {width} x {height} of {self.image_count} LF images>"


class Plate:
    """The sensor plate of a frame: exact sums and counts of rays, as integers.

    The sum of plates of different LF images is the plate of all of them, with the same bits in any order.
    """

    def __init__(self, core: _core.Plate) -> None:
        self._core = core

    @classmethod
    def load(cls, path: Union[str, "os.PathLike[str]"]) -> Plate:
        """Read a plate that `lfrenderer --keep-plates` or `--shard` has written."""
        with arguments.naming_arguments():
            return cls(_core.Plate.load(arguments.file_name(path)))

    @property
    def sums(self) -> npt.NDArray[np.uint64]:
        """Sums of 16-bit values of rays, of shape (height, width, channels): a copy."""
        return self._core.sums

    @property
    def counts(self) -> npt.NDArray[np.uint64]:
        """Numbers of rays or, with lens weights, sums of weights, of shape (height, width, channels): a copy."""
        return self._core.counts

    def __add__(self, other: Plate) -> Plate:
        if not isinstance(other, Plate):
            return NotImplemented
        return Plate(self._core + other._core)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Plate) and bool(self._core == other._core)

    __hash__ = None  # type: ignore[assignment]

    def develop(self, threads: int = 0) -> Frame:
        """Average the rays, fill small gaps, and convert the colours to linear sRGB.

        Parameters
        ----------
        threads : int
            Number of threads; 0: one for each processor.
        """
        return Frame(self._core.develop(_threads_of(threads)))


class Renderer:
    """Renders the frames of a path step by step, so that unfinished frames can be looked at.

    Parameters
    ----------
    field : LightField
        The light field.
    path : Path or Camera
        The cameras of the frames.
    frames : str or iterable of int, optional
        Frames to render, from 1: "1-10,20", "1-100x10", or numbers; by default all.
    mode : {"collect", "rebin", "hybrid"}
        How frames are made from recorded rays (doc/rebinning.md).
    estimator, filter, lens_weights, lf_pixels, order : str
        The options of `lfrenderer` with these names.
    max_images : int, optional
        Largest number of LF images for each frame.
    max_angle_deg : float, optional
        Largest angle between the optical axes of LF camera and frame.
    seed : int
        Seed of the random numbers: of the order "shuffle", and of rebinned rays.
    stop_when : str
        Rule by which a frame is finished early: "noise<=X" or "samples>=N", as `--stop-when` of `lfrenderer`.
    smooth_below, fill : int
        Elements with fewer rays than `smooth_below` are averaged with their neighbours. Elements without rays are
        filled from elements up to `fill` elements away.
    guard : bool
        True: where a frame of a densified light field is in focus, it shows recorded LF images alone. False: it shows
        virtual LF images there, like anywhere else.
    memory : str
        Upper limit of the memory that is used, such as "8G" or "512M".
    strict : bool
        True: a missing or broken LF image is an error; False: it is left out, with a warning.
    threads : int
        Number of threads; 0: one for each processor.

    Notes
    -----
    All frames must fit in the memory at the same time; :func:`film` renders longer paths. The frames are those of
    `lfrenderer`, bit for bit, and the defaults are the same. They do not depend on `threads`, and depend on `memory`
    only if `mode` is "rebin" or "hybrid".
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
        number = arguments.whole("i", i)
        if number < 0:
            raise IndexError(f"frame {number}: frames of a Renderer are numbered from 0")
        return self._film.core, number

    def step(self) -> bool:
        """Read the next batch of LF images. Returns False if no LF image is left.

        Ctrl-C (KeyboardInterrupt) interrupts the batch; another call then repeats it.
        """
        with self._lock:
            core, _ = self._core_of()
            if not self._is_done:
                self._is_done = not core.step()
            return not self._is_done

    @property
    def progress(self) -> Tuple[int, int]:
        """Number of LF images that were read so far, and number that will be read in all."""
        with self._lock:
            return self._core_of()[0].progress()

    @property
    def skipped(self) -> Sequence[Tuple[str, str]]:
        """Names of the LF images that were left out because they are missing or broken, each with the reason."""
        with self._lock:
            return tuple(self._core_of()[0].skipped())

    def preview(self, i: int = 0) -> Frame:
        """Return frame `i` of this renderer, from 0, with the rays that it has so far."""
        with self._lock:
            core, number = self._core_of(i)
            return Frame(core.develop(number))

    def plate(self, i: int = 0) -> Plate:
        """Return a copy of the plate of frame `i` of this renderer, from 0."""
        with self._lock:
            core, number = self._core_of(i)
            return Plate(core.plate(number))

    def stop(self, i: int = 0) -> Frame:
        """Finish frame `i` of this renderer, from 0, with the rays that it has. Returns it, and frees its memory."""
        with self._lock:
            core, number = self._core_of(i)
            frame = Frame(core.develop(number))
            core.release(number)
            return frame


def render(field: LightField, camera: Union[Camera, Path], *, progress: Union[None, bool, Progress] = None,
           **options: Any) -> Frame:
    """Render one frame.

    Parameters
    ----------
    field : LightField
        The light field.
    camera : Camera or Path
        The camera; or a path, whose first frame is rendered unless `frames` names another one.
    progress : bool or callable, optional
        Called with the number of LF images read so far and in all. True: a progress bar, if tqdm is installed.
    **options
        Options of :class:`Renderer`.

    Returns
    -------
    Frame

    Raises
    ------
    InputError
        No LF image contributes to the frame, or all of them are broken.
    """
    frames = options.pop("frames", None)
    film_of_one = _Film(field, camera, [1] if frames is None else frames, options)
    passes = film_of_one.core.passes()
    if sum(map(len, passes)) != 1:
        raise UsageError("render() renders one frame: use film() for several")
    film_of_one.begin(passes[0])
    film_of_one.core.check_any_contributes()
    film_of_one.collect(_teller(progress), 0, 1)
    film_of_one.core.check_not_all_broken()
    film_of_one.warn_of_missing()
    return Frame(film_of_one.core.develop(0))


def film(field: LightField, path: Path, frames: Frames = None, *, progress: Union[None, bool, Progress] = None,
         **options: Any) -> Iterator[Tuple[int, Frame]]:
    """Render the frames of a path. LF images are read once for all frames that fit in the memory together.

    Parameters
    ----------
    field : LightField
        The light field.
    path : Path
        The cameras.
    frames : str or iterable of int, optional
        Frames to render, from 1: "1-10,20", "1-100x10", or numbers; by default all.
    progress : bool or callable, optional
        As for :func:`render`.
    **options
        Options of :class:`Renderer`.

    Yields
    ------
    number, frame : int, Frame
        Frames in the order of their numbers, unless `stop_when` finishes some of them early.
    """
    sequence = _Film(field, path, frames, options)
    tell = _teller(progress)
    passes = sequence.core.passes()
    for number, some in enumerate(passes):
        sequence.begin(some)
        for f in sequence.collect_some(tell, number, len(passes)):
            frame = Frame(sequence.core.develop(f))
            sequence.core.release(f)
            if frame.image_count == 0 and frame.interpolated is None:
                warnings.warn(f"frame {frame.number} is black: no recorded ray passes its lens", BlackFrameWarning,
                              stacklevel=2)
            yield frame.number, frame
        sequence.warn_of_missing()


class _Film:
    """Some frames of a path with their options."""

    def __init__(self, field: LightField, path: Union[Path, Camera], frames: Frames, options: Dict[str, Any]) -> None:
        if not isinstance(field, LightField):
            raise TypeError(f"expected a light field of lf.open(), found {field!r}")
        cameras = Path([path]) if isinstance(path, Camera) else path
        if not isinstance(cameras, Path):
            raise TypeError(f"expected an lf.Camera or an lf.Path, found {path!r}")
        for camera in cameras:
            if camera.unit_m != field.unit_m:
                raise UsageError(f"the camera has unit_m={camera.unit_m:g}, and the light field {field.unit_m:g}: give "
                                 f"the camera unit_m=field.unit_m, or make it by field.camera()")
        words = _core.FilmWords()
        own: Dict[str, Any] = {"memory": "8G", "strict": False, "threads": 0}
        for name, value in options.items():
            if name in own:
                own[name] = value
            elif hasattr(words, name) and not name.startswith("_"):
                try:
                    setattr(words, name, value)
                except TypeError:
                    raise UsageError(f"{name}={value!r}: a value of this type is not possible") from None
            else:
                known = sorted([*own, *(word for word in dir(words) if not word.startswith("_"))])
                raise UsageError(f"unknown option {name}: expected one of {', '.join(known)}")
        angle = words.max_angle_deg
        if angle is not None and not 0 < angle <= 180:
            raise UsageError(f"max_angle_deg={angle:g}: expected a number above 0 and up to 180")
        with arguments.naming_arguments():
            self.core = _core.Film(field._core, [camera._core for camera in cameras],
                                   arguments.positive("fps", cameras.fps), _numbers_of(frames, len(cameras)), words,
                                   str(own["memory"]), arguments.flag("strict", own["strict"]),
                                   _threads_of(own["threads"]))
        self._warned: List[str] = []

    def begin(self, frames: Sequence[int]) -> None:
        with arguments.naming_arguments():
            self.core.begin(list(frames))

    def collect_some(self, tell: Progress, number: int, count: int) -> Iterator[int]:
        """Collect a pass, and yield the indices of its frames, from 0, when they are finished.

        It tells the progress of all passes: this one is pass `number`, from 0, of `count`.
        """
        is_going_on = True
        while is_going_on:
            is_going_on = self.core.step()
            done, total = self.core.progress()
            tell(number * total + done, count * total)
            yield from self.core.stopped()
        yield from self.core.left()

    def collect(self, tell: Progress, number: int, count: int) -> None:
        while self.core.step() and not self.core.stopped():
            done, total = self.core.progress()
            tell(number * total + done, count * total)
        done, total = self.core.progress()
        tell(done, total)

    def warn_of_missing(self) -> None:
        missing = [(name, reason) for name, reason in self.core.skipped() if name not in self._warned]
        if not missing:
            return
        self._warned += [name for name, _ in missing]
        warnings.warn(f"{len(missing)} LF images were left out, the first: {missing[0][1]}", MissingImagesWarning,
                      stacklevel=3)


def _numbers_of(frames: Frames, count: int) -> List[int]:
    """Return ascending numbers of frames."""
    if frames is None:
        return []
    if isinstance(frames, str):
        return _core.parse_frames(frames, count)
    try:
        numbers = {arguments.whole("frames", number) for number in frames}
    except TypeError:
        raise TypeError(f"frames={frames!r}: expected a list of numbers, or text such as \"1-10,20\"") from None
    if not numbers or min(numbers) < 1 or max(numbers) > count:
        raise UsageError(f"frames={frames!r}: the path has the frames 1 to {count}")
    return sorted(numbers)


def _threads_of(value: Any) -> int:
    number = arguments.whole("threads", value)
    if not 0 <= number <= 512:
        raise UsageError(f"threads={value!r}: expected 0 to 512")
    return number


def _teller(progress: Union[None, bool, Progress]) -> Progress:
    if callable(progress):
        return progress
    if progress:
        try:
            import tqdm.auto
        except ImportError:
            warnings.warn("progress=True shows nothing, because tqdm is not installed: give a function instead",
                          stacklevel=3)
        else:
            bar = tqdm.auto.tqdm(unit=" LF images")

            def show(done: int, total: int) -> None:
                bar.total = total
                bar.update(done - bar.n)
                if done == total:
                    bar.close()
            return show
    return lambda done, total: None
