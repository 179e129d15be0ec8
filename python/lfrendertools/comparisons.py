# SPDX-License-Identifier: Apache-2.0
"""Measures how far pictures are from references."""
from __future__ import annotations

import dataclasses
import os
from typing import Any, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _core, arguments
from .arguments import FilePath
from .errors import UsageError
from .frames import Frame
from .keywords import suggests_names

_MOST_BORDER, _MOST_PER_DEGREE = 1 << 20, 10000
_Picture = Union[FilePath, bytes, Frame, npt.ArrayLike]


@dataclasses.dataclass(frozen=True, eq=False)
class Comparison:
    """How far a picture is from a reference. :func:`compare` returns one.

    Attributes
    ----------
    psnr : float
        Peak signal-to-noise ratio of sRGB values, clipped to black and white, in dB; infinite if they are equal.
    linear_psnr : float
        Peak signal-to-noise ratio of linear light, not clipped, with the peak 1, in dB; infinite if it is equal.
    ssim : float
        Mean structural similarity of brightness; 1 if the pictures are equal.
    flip : float
        Mean of FLIP, the difference that a person sees who alternates between the pictures, from 0 to 1.
    pixel_count : int
        Number of pixels that count.
    undefined_count : int
        Number of pixels that are left out because a value is not a number or infinite.
    flip_map : ndarray of float32 of shape (height, width)
        FLIP of each pixel, also of those that do not count.
    """

    psnr: float
    linear_psnr: float
    ssim: float
    flip: float
    pixel_count: int
    undefined_count: int
    flip_map: npt.NDArray[np.float32]
    _pictures: Tuple[_core.PictureLight, _core.PictureLight] = dataclasses.field(repr=False)

    def picture(self, show: str = "flip", gain: float = 8) -> npt.NDArray[np.uint8]:
        """Return a picture of the differences, as `lfcompare -o` writes it.

        Parameters
        ----------
        show : {"flip", "difference"}
            "flip": FLIP, from black (no difference) over violet and orange to yellow. "difference": grey where the
            pictures are equal, brighter where the test is brighter.
        gain : float
            Factor of the differences of sRGB values, with "difference".

        Returns
        -------
        ndarray of uint8 of shape (height, width, 3)
            sRGB values.
        """
        if arguments.choice("show", show, ("flip", "difference")) == "flip":
            return _core.flip_picture(self.flip_map)
        return _core.difference_picture(*self._pictures, arguments.positive("gain", gain))

    def __repr__(self) -> str:
        return f"<Comparison: PSNR {self.psnr:.2f} dB, SSIM {self.ssim:.4f}, FLIP {self.flip:.4f}>"


@suggests_names
def compare(reference: _Picture, test: _Picture, *, border: int = 0, coverage: float = 0,
            pixels_per_degree: Optional[float] = None, threads: int = 0, any_range: bool = False) -> Comparison:
    """Measure how far a picture is from a reference, as `lfcompare`.

    Parameters
    ----------
    reference, test : path, Frame or array_like
        Two pictures of one size. A path names a PNG, JPEG, TIFF or EXR file. An array has the shape (height, width) or
        (height, width, channels): grey; grey and alpha; R, G and B; or these and alpha. Values of uint8 and uint16 are
        sRGB values, whose alpha is not multiplied into the colours yet. Floats are linear light with sRGB primaries,
        whose alpha is; they are converted to single precision. Transparent pictures are composited over black.
    border : int
        Number of pixels at each side that do not count.
    coverage : float
        Least coverage of pixels that count, from 0 to 1. Frames and their EXR files have a coverage; other pictures
        are covered everywhere.
    pixels_per_degree : float, optional
        Distance of the observer, for FLIP: pixels per degree of the visual angle, from 1 to 10000. By default a display
        with 3840 columns is seen from as far as it is wide.
    threads : int
        Number of threads; 0: one for each processor. The result does not depend on it.
    any_range : bool
        True: floats are linear light, even if they look like 8-bit values of a display. By default such arrays are
        refused, because they would be compared as light up to 255 times as bright as white.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        A file cannot be read, the sizes differ, or no pixel counts.
    UsageError
        An argument is out of range, or an array of floats looks like 8-bit values: from 0 to 255, above 16 somewhere,
        and either whole numbers or mostly above 4.

    Examples
    --------
    >>> import numpy as np
    >>> import lfrendertools as lf
    >>> grey = np.full((48, 64, 3), 128, np.uint8)
    >>> result = lf.compare(grey, grey + np.uint8(2))
    >>> f"{result.psnr:.2f} dB, {result.pixel_count} pixels"
    '42.11 dB, 3072 pixels'
    """
    is_light = arguments.flag("any_range", any_range)
    pictures = _picture("reference", reference, is_light), _picture("test", test, is_light)
    per_degree = None if pixels_per_degree is None else arguments.within(
        "pixels_per_degree", pixels_per_degree, 1, _MOST_PER_DEGREE)
    name = os.fsencode(test) if isinstance(test, (str, bytes, os.PathLike)) else b"test"
    pixels, undefined, psnr, linear_psnr, ssim, flip, flip_map = _core.compare(
        *pictures, arguments.whole_within("border", border, 0, _MOST_BORDER),
        arguments.within("coverage", coverage, 0, 1), per_degree, name, arguments.thread_count(threads))
    return Comparison(psnr, linear_psnr, ssim, flip, pixels, undefined, flip_map, pictures)


def _refuse_display_values(name: str, values: npt.NDArray[Any]) -> None:
    """Refuse floats that are 8-bit values rather than light."""
    known = values[np.isfinite(values)]
    if known.size == 0 or known.min() < 0 or not 16 < known.max() <= 255.5:
        return
    median = float(np.median(known))
    if median <= 4 and not np.array_equal(known, np.rint(known)):
        return
    raise UsageError(f"{name}: found floats up to {known.max():.4g} with the median {median:.4g}, which look like "
                     f"values of a display from 0 to 255; expected linear light, in which 1 is white: give them as "
                     f"{name}.round().astype(np.uint8), or any_range=True if they are light")


def _picture(name: str, source: _Picture, is_light: bool) -> _core.PictureLight:
    if isinstance(source, (str, bytes, os.PathLike)):
        return _core.picture_of_file(arguments.file_name(name, source))
    if isinstance(source, Frame):
        return _core.picture_of_array(source.rgb, source.coverage)
    values: npt.NDArray[Any] = np.asarray(source)
    if np.issubdtype(values.dtype, np.floating):
        if not is_light:
            _refuse_display_values(name, values)
        values = values.astype(np.float32)
    if values.dtype not in (np.uint8, np.uint16, np.float32):
        raise TypeError(f"{name}: expected a path, a Frame, or an array of uint8, uint16 or floats, found an array of "
                        f"{values.dtype}")
    if values.ndim not in (2, 3) or 0 in values.shape or (values.ndim == 3 and values.shape[2] > 4):
        raise UsageError(f"{name}: expected an array of shape (height, width) or (height, width, channels) with 1 to 4 "
                         f"channels, found {values.shape}")
    return _core.picture_of_array(np.ascontiguousarray(values), None)
