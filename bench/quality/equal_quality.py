# SPDX-License-Identifier: Apache-2.0
"""Bytes of encoded LF images where frames or images are equally good."""
import numpy as np


def bytes_at(points, target):
    """Returns the bytes at this PSNR: the logarithm is interpolated between the two nearest of (dB, bytes), or
    extrapolated by at most 3 dB; None if that is not enough."""
    points = sorted(points)
    decibels, logs = np.array([db for db, _ in points]), np.log([size for _, size in points])
    if len(points) < 2 or not decibels[0] - 3 <= target <= decibels[-1] + 3:
        return None
    i = int(np.clip(np.searchsorted(decibels, target) - 1, 0, len(points) - 2))
    slope = (logs[i + 1] - logs[i]) / (decibels[i + 1] - decibels[i])
    return float(np.exp(logs[i] + slope * (target - decibels[i])))
