# SPDX-License-Identifier: Apache-2.0
"""Finished and unfinished frames, and their sensor plates."""
from __future__ import annotations

import os
import pathlib
from typing import Dict, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .arguments import FilePath
from .camera import Camera
from .display import display_values
from .errors import UsageError

_FORMATS = {".exr": "exr", ".png": "png"}


class Frame:
    """A frame of a light field. Its arrays share its memory: :meth:`save` writes changes that were made to them.

    :func:`render`, :func:`film`, :func:`through`, :class:`Renderer` and :meth:`Plate.develop` make frames.
    """

    def __init__(self, core: _core.Frame) -> None:
        self._core = core

    @property
    def number(self) -> int:
        """Number of the frame in its path."""
        return self._core.number

    @property
    def camera(self) -> Camera:
        """The camera that took the frame."""
        return Camera._of(self._core.camera)

    @property
    def rgb(self) -> npt.NDArray[np.float32]:
        """Linear light with sRGB primaries, of shape (height, width, 3); 1 is display white.

        Shown as it is, by a plot or in a window, linear light looks too dark: :meth:`display` returns the values for a
        display, such as `plt.imshow(frame.display())`.
        """
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
        """Share of the light that is interpolated, of shape (height, width).

        None unless `mode` is "hybrid", or "rebin" with `interpolation="cells"`.
        """
        return self._core.interpolated

    @property
    def densified(self) -> Optional[npt.NDArray[np.float32]]:
        """Share of the light that virtual LF images contribute to, of shape (height, width).

        None unless the light field is densified and `guard` is True.
        """
        return self._core.densified

    @property
    def trust(self) -> Optional[npt.NDArray[np.float32]]:
        """How far the light of all LF images can be trusted, from 0 to 1, of shape (height, width).

        1 where the frame is in focus and therefore shows recorded light. None unless `densified` is there.
        """
        return self._core.trust

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
        return display_values(self.rgb)

    def save(self, path: FilePath, format: Optional[str] = None, *, colour_space: str = "rec709",
             alpha: bool = False, channels: str = "all", exr_compression: str = "zip") -> None:
        """Write the frame as `lfrenderer` does: EXR with linear light and all other channels, or PNG for display.

        Parameters
        ----------
        path : path
            The file. It appears only when it is whole.
        format : str, optional
            "exr" (half floats), "exr-float" (single precision), "png" or "png16"; by default "exr" or "png", by the
            suffix of `path`.
        colour_space : {"rec709", "rec2020", "acescg"}
            Primaries of an EXR file, as `--colour-space` of `lfrenderer` (doc/formats/frame.md). The light stays
            linear. `rgb` does not change. Default "rec709", the only one for PNG files.
        alpha : bool
            True: the file has alpha, as by `--frame-alpha`: 1 where light was recorded, filled or interpolated, and
            0 elsewhere. Colours are multiplied by it in EXR files, and are not in PNG files. A frame that has
            `opacity` keeps it in any case. Default False.
        channels : {"all", "rgba", "rgb"}
            Channels of an EXR file, as by `--channels` of `lfrenderer`: "rgba" has R, G, B and alpha, as `alpha` adds
            it; "rgb" has R, G and B. Default "all", the only one for PNG files.
        exr_compression : {"zip", "zips"}
            Compression of an EXR file: 16 rows together, or each row by itself. Neither loses anything. Default "zip",
            the only one for PNG files.

        Raises
        ------
        UsageError
            The name, the format or another text is none of these, or a PNG file was to have what only EXR files have.
        OutputError
            The file cannot be written.
        """
        name = os.fsdecode(arguments.file_name("path", path))
        suffix = pathlib.Path(name).suffix.lower()
        chosen = _FORMATS.get(suffix, "") if format is None else arguments.text("format", format)
        if suffix not in _FORMATS or not chosen.startswith(_FORMATS[suffix]):
            ends = " or ".join(end for end, kind in _FORMATS.items() if format is None or chosen.startswith(kind))
            raise UsageError(f"{name}: expected a name that ends in {ends}" if ends else
                             f"format={format!r}: expected exr, exr-float, png or png16")
        self._core.save(os.fsencode(name), chosen, arguments.text("colour_space", colour_space),
                        arguments.flag("alpha", alpha), arguments.text("channels", channels),
                        arguments.text("exr_compression", exr_compression))

    def _repr_png_(self) -> bytes:
        return _core.encode_png(self.display())

    def __repr__(self) -> str:
        height, width = self.rgb.shape[:2]
        of = "rebinned rays" if self.image_count == 0 and self.interpolated is not None else \
            f"{self.image_count} LF images"
        return f"<Frame {self.number}: {width} x {height} of {of}>"


class Plate:
    """The sensor plate of a frame: exact sums and counts of rays, as integers.

    Plates of the shards of a frame (`lfrenderer --shard`) can be added: their sum is the plate of all LF images, with
    the same bits in any order. A :class:`UsageError` tells if two plates are of different cameras, light fields or
    options, or if both have the rays of the same LF images. The plate of a hybrid (`mode="hybrid"`) also has the rays
    that complete it, unless they are interpolated from cells; :meth:`develop` mixes them.
    """

    def __init__(self, core: _core.Plate) -> None:
        self._core = core

    @classmethod
    def load(cls, path: FilePath) -> Plate:
        """Read a plate that :meth:`save`, `lfrenderer --keep-plates` or `lfrenderer --shard` has written."""
        return cls(_core.Plate.load(arguments.file_name("path", path)))

    def save(self, path: FilePath) -> None:
        """Write the plate with all that :meth:`load` and :meth:`develop` need (doc/formats/plate.md).

        Parameters
        ----------
        path : path
            The file. It appears only when it is whole.
        """
        self._core.save(arguments.file_name("path", path))

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

    def __radd__(self, other: object) -> Plate:
        # sum() begins with 0.
        if isinstance(other, int) and other == 0:
            return self
        return NotImplemented

    def __repr__(self) -> str:
        width, height = self._core.size
        return f"<Plate of frame {self._core.number}: {width} x {height} of {self._core.image_count} LF images>"

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
        return Frame(self._core.develop(arguments.thread_count(threads)))
