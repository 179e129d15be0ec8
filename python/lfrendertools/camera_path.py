# SPDX-License-Identifier: Apache-2.0
"""Camera paths."""
from __future__ import annotations

import warnings
import os
from typing import Any, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union, overload

from . import _core, arguments
from .camera import Camera
from .errors import UsageError, caller_level
from .keywords import suggests_names


class Path(Sequence[Camera]):
    """A camera path: one camera for each frame. The items of this sequence are numbered from 0, frames
    from `first_frame`.

    Parameters
    ----------
    cameras : iterable of Camera
        The cameras of the frames. All must have the same resolution and `unit_m`.
    fps : float, optional
        Frames per second.
    shutter : tuple of float and int, or mapping, optional
        Angle in degrees, from 0 to 360, and number of samples, from 1 to 64; or a mapping with the keys angle_deg and
        samples. Each frame is exposed for this part of its duration, centred at its time, and is the mean of this many
        cameras. Between the frames, cameras are interpolated. None: each frame is one moment.
    views : int, optional
        Number of views of each moment, as in the paths of stereo pairs and light field displays that ``lfpath`` makes
        (``--stereo``, ``--quilt``). The first cameras are the views of the first moment, the next ones those of the
        second moment, and so on; `fps` is the rate of the moments. With more than one, there is no shutter.
    first_frame : int, optional
        Number of the first frame, such as 1001, for names of files and the option `frames`. A part of the path (a
        slice) begins with the same number.

    Examples
    --------
    >>> import lfrendertools as lf
    >>> near = lf.open("capture/").camera(focus_distance=0.8)
    >>> path = lf.Path([near, near.replace(focus_distance=1.6)], fps=25)
    >>> path.save("path.yaml")
    >>> [round(camera.focus_distance, 3) for camera in lf.Path.load("path.yaml")]
    [0.8, 1.6]
    """

    @suggests_names
    def __init__(self, cameras: Iterable[Camera], fps: float = 24,
                 shutter: Union[None, Tuple[float, int], Mapping[str, Any]] = None, views: int = 1,
                 first_frame: int = 1) -> None:
        self._cameras: List[Camera] = list(arguments.iterator("cameras", cameras, "lf.Camera objects"))
        self.fps = fps
        for camera in self._cameras:
            if not isinstance(camera, Camera):
                raise TypeError(f"a path consists of lf.Camera objects, found {camera!r}")
        if not self._cameras:
            raise UsageError("a path needs at least one camera")
        for what in ("resolution", "unit_m"):
            values = {getattr(camera, what) for camera in self._cameras}
            if len(values) > 1:
                raise UsageError(f"the cameras of a path must have one {what}, found {sorted(values)[:4]}")
        self._views = arguments.whole_within("views", views, 1, 1_000_000)
        if len(self._cameras) % self._views:
            raise UsageError(f"views={self._views}: does not divide the {len(self._cameras)} cameras of the path; "
                             f"expected the same number of views of every moment")
        self._first_frame = arguments.whole_within("first_frame", first_frame, 0, 100_000_000 - len(self._cameras))
        # Angle, number of samples, and the cameras of all instants; None if each frame is one moment.
        self._shutter: _core._Shutter = None
        if shutter is not None:
            angle, samples = _angle_and_samples(shutter)
            if samples > 1 and self._views > 1:
                raise UsageError(f"shutter: the path has {self._views} views of each moment, between which no camera "
                                 f"moves; leave the shutter out")
            if samples > 1:
                self._shutter = (angle, samples, _core.instants([camera._core for camera in self._cameras], self.fps,
                                                                angle, samples))

    @classmethod
    def _of(cls, cameras: Iterable[_core.RenderCamera], fps: float, first_frame: int, shutter: _core._Shutter,
            views: int) -> Path:
        path = cls((Camera._of(core) for core in cameras), fps, views=views, first_frame=first_frame)
        path._shutter = shutter
        return path

    @property
    def shutter(self) -> Optional[Tuple[float, int]]:
        """Angle in degrees and number of samples of the shutter; None if each frame is one moment."""
        return None if self._shutter is None else self._shutter[:2]

    @property
    def views(self) -> int:
        """Number of views of each moment. A part of the path (a slice) has as many if it consists of whole moments,
        otherwise 1."""
        return self._views

    @property
    def first_frame(self) -> int:
        """Number of the first frame, which is at time 0."""
        return self._first_frame

    @property
    def fps(self) -> float:
        """Frames per second. Camera i of the path, from 0, is at the time i / fps."""
        return self._fps

    @fps.setter
    def fps(self, fps: float) -> None:
        self._fps = arguments.within("fps", fps, 0.001, 1e6)

    @classmethod
    @suggests_names
    def load(cls, path: Union[str, os.PathLike[str]], unit_m: Optional[float] = None) -> Path:
        """Read a camera path of any form: our own (doc/formats/path.md) or that of another program
        (doc/formats/foreign_paths.md).

        What the file does not state has a default, which a message tells; :meth:`Camera.replace` changes it.

        Parameters
        ----------
        path : path
            The file, or the folder of a COLMAP model or a transforms.json, whose cameras become the frames.
        unit_m : float, optional
            Metres per world unit of the light field.

        Raises
        ------
        InputError
            The file cannot be read, has a mistake, or states another unit than `unit_m`.
        """
        unit = None if unit_m is None else arguments.positive("unit_m", unit_m)
        cameras, fps, first_frame, shutter, views = _core.read_path(arguments.file_name("path", path), unit)
        return cls._of(cameras, fps, first_frame, shutter, views)

    @classmethod
    @suggests_names
    def parse(cls, text: str, name: str = "path", unit_m: Optional[float] = None) -> Path:
        """Read a camera path as :meth:`load` does, but from the text of a file. Error messages call it `name`."""
        # Text that is not Unicode cannot be in a path, and stands in messages with question marks.
        utf8, utf8_name = (arguments.text(what, value).encode("utf-8", "replace")
                           for what, value in (("text", text), ("name", name)))
        unit = None if unit_m is None else arguments.positive("unit_m", unit_m)
        cameras, fps, first_frame, shutter, views = _core.parse_path(utf8, utf8_name, unit)
        return cls._of(cameras, fps, first_frame, shutter, views)

    @suggests_names
    def save(self, path: Union[str, os.PathLike[str]], format: Optional[str] = None) -> None:
        """Write a camera path file. Each frame gets a camera of its own. Only YAML keeps the shutter, and interpolates
        its cameras between those of the frames.

        When a YAML file is read again, directions and fields of view differ by at most 1e-12 (entries of the rotation
        matrix, and relative), and other values by no more than the rounding of double precision. JSON files give the
        same bits. The file appears only when it is whole, and replaces an older camera path of this name. A warning
        tells what the file does not hold.

        Parameters
        ----------
        path : path
            The file.
        format : str, optional
            "yaml", "nerfstudio", "instant-ngp", "chan" or "usda" (doc/formats/foreign_paths.md). By default, the
            extension tells: .json for nerfstudio, .chan or .usda; files of other names are YAML.

        Raises
        ------
        UsageError
            The format is unknown, or is "yaml" and cannot express the cameras, such as numbers of blades that differ;
            or a file of this name exists that is no camera path, such as a calibration.
        OutputError
            The file cannot be written.
        """
        file = arguments.file_name("path", path)
        if format is None and os.path.splitext(os.fsdecode(file))[1] not in (".json", ".chan", ".usda"):
            format = "yaml"
        lost = _core.save_path(file, [camera._core for camera in self._cameras], self.fps, self._first_frame,
                               self._shutter, self._views, None if format is None else arguments.text("format", format))
        if lost:
            warnings.warn(f"{os.fsdecode(file)}: the format has no place for {'; for '.join(lost)}",
                          stacklevel=caller_level())
        if self._shutter and format == "yaml":
            warnings.warn(f"{os.fsdecode(file)}: before the first frame and after the last one, the camera stands "
                          "still, so that these two frames are blurred less", stacklevel=caller_level())

    @property
    def cameras(self) -> Sequence[Camera]:
        """The cameras of the frames."""
        return tuple(self._cameras)

    def __len__(self) -> int:
        return len(self._cameras)

    @overload
    def __getitem__(self, i: int) -> Camera:
        ...

    @overload
    def __getitem__(self, i: slice) -> Path:
        ...

    def __getitem__(self, i: Union[int, slice]) -> Union[Camera, Path]:
        if isinstance(i, slice):
            frames = range(len(self))[i]
            whole = frames.step == 1 and frames.start % self._views == 0 and len(frames) % self._views == 0
            part = Path(self._cameras[i], self.fps, views=self._views if whole else 1,
                        first_frame=self._first_frame)
            if self._shutter is not None:
                angle, samples, instants = self._shutter
                part._shutter = (angle, samples, [instants[frame * samples + k]
                                                  for frame in frames for k in range(samples)])
            return part
        return self._cameras[i]

    def __iter__(self) -> Iterator[Camera]:
        return iter(self._cameras)

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, Path) and self.fps == other.fps and self._cameras == other._cameras
                and self._shutter == other._shutter and self._views == other._views
                and self._first_frame == other._first_frame)

    def __repr__(self) -> str:
        shutter = "" if self._shutter is None else f", shutter {self._shutter[0]:g} degrees"
        views = "" if self._views == 1 else f", {self._views} views of each moment"
        first = "" if self._first_frame == 1 else f" from {self._first_frame} on"
        return f"<Path of {len(self)} frames{first}, {self.fps:g} per second{shutter}{views}>"


def _angle_and_samples(shutter: Union[Tuple[float, int], Mapping[str, Any]]) -> Tuple[float, int]:
    names = ("angle_deg", "samples")
    if isinstance(shutter, Mapping):
        for key in (*shutter, *names):
            if key not in names or key not in shutter:
                found = f"found the key {key!r}" if key in shutter else f"{key} is missing"
                raise UsageError(f"shutter={dict(shutter)!r}: {found}; expected angle_deg and samples")
        shutter = (shutter["angle_deg"], shutter["samples"])
    try:
        angle, samples = shutter
    except (TypeError, ValueError):
        raise UsageError(f"shutter={shutter!r}: expected an angle in degrees and a number of samples, such as "
                         f"(180, 8)") from None
    return (arguments.within("shutter: angle_deg", angle, 0, 360),
            arguments.whole_within("shutter: samples", samples, 1, 64))
