"""Linear light as values for a display."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


def display_values(light: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """Return sRGB values from 0 to 255 of linear light, where 1 is white. NaN becomes 0."""
    linear = np.clip(np.nan_to_num(light.astype(np.float64)), 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    values: npt.NDArray[np.uint8] = np.floor(255 * srgb + 0.5).astype(np.uint8)
    return values
