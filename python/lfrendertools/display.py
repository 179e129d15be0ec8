# SPDX-License-Identifier: Apache-2.0
"""Linear light as values for a display."""
from __future__ import annotations

import numpy as np
import numpy.typing as npt


from . import arguments


def display_values(light: npt.ArrayLike) -> npt.NDArray[np.uint8]:
    """Return linear light as sRGB values for a display.

    Parameters
    ----------
    light : array_like
        Linear light of any shape, where 1 is white.

    Returns
    -------
    ndarray of uint8
        Values from 0 to 255, of the same shape. NaN becomes 0.
    """
    linear = np.clip(np.nan_to_num(arguments.reals("light", light)), 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    values: npt.NDArray[np.uint8] = np.floor(255 * srgb + 0.5).astype(np.uint8)
    return values
