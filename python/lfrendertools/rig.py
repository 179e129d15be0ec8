# SPDX-License-Identifier: Apache-2.0
"""The places of the LF cameras of a light field: rows and columns, and a plot."""
from __future__ import annotations

import dataclasses
from typing import Optional, Tuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True, eq=False)
class Grid:
    """LF cameras that stand in rows and columns.

    Attributes
    ----------
    ids : ndarray of int of shape (rows, columns)
        Numbers of the LF cameras. Row 0 is the upper one and column 0 the left one, seen in the direction in which the
        LF cameras look.
    pitch : tuple of float
        Mean distance between neighbouring columns, and between neighbouring rows, in world units.
    """

    ids: npt.NDArray[np.int64]
    pitch: Tuple[float, float]

    @property
    def shape(self) -> Tuple[int, int]:
        """Number of rows and columns."""
        return self.ids.shape[0], self.ids.shape[1]


def _lines(values: Floats, tolerance: float) -> Tuple[npt.NDArray[np.int64], Floats]:
    """Group values that are closer than the tolerance. Returns the group of each value, and the mean of each group."""
    order = np.argsort(values)
    steps = np.diff(values[order]) > tolerance
    groups = np.empty(len(values), np.int64)
    groups[order] = np.concatenate([[0], np.cumsum(steps)])
    return groups, np.bincount(groups, values) / np.bincount(groups)


def find_grid(centres: Floats, poses: Floats) -> Optional[Grid]:
    if len(centres) == 0:
        return None
    right, down = poses[:, 0, :3].mean(axis=0), poses[:, 1, :3].mean(axis=0)
    if min(np.linalg.norm(right), np.linalg.norm(down)) < 0.5:
        return None
    x, y = centres @ (right / np.linalg.norm(right)), centres @ (down / np.linalg.norm(down))
    extent = max(np.ptp(x), np.ptp(y))
    if extent == 0:
        return Grid(np.zeros((1, 1), np.int64), (0.0, 0.0)) if len(centres) == 1 else None
    tolerance = 0.25 * extent / max(1, len(centres) - 1) if min(np.ptp(x), np.ptp(y)) == 0 else \
        0.35 * np.sqrt(np.ptp(x) * np.ptp(y) / len(centres))
    columns, at_x = _lines(x, tolerance)
    rows, at_y = _lines(y, tolerance)
    if len(at_x) * len(at_y) != len(centres):
        return None
    ids = np.full((len(at_y), len(at_x)), -1, np.int64)
    ids[rows, columns] = np.arange(len(centres))
    if (ids < 0).any():
        return None
    pitch = tuple(float(np.ptp(at) / max(1, len(at) - 1)) for at in (at_x, at_y))
    for at, step, values, groups in ((at_x, pitch[0], x, columns), (at_y, pitch[1], y, rows)):
        places = at[0] + step * np.arange(len(at))
        if len(at) > 1 and np.abs(values - places[groups]).max() > 0.25 * step:
            return None
    return Grid(ids, (pitch[0], pitch[1]))


def plot_of_rig(centres: Floats, poses: Floats) -> str:
    """Return a plot of at most 2,000 LF cameras, seen from behind, as SVG."""
    chosen = np.linspace(0, len(centres) - 1, min(len(centres), 2000)).astype(int)
    right, down = poses[:, 0, :3].mean(axis=0), poses[:, 1, :3].mean(axis=0)
    xy = np.stack([centres[chosen] @ right, centres[chosen] @ down], axis=1)
    xy -= xy.min(axis=0)
    xy *= 280 / max(float(xy.max()), 1e-300)
    dots = "".join(f'<circle cx="{x + 10:.1f}" cy="{y + 10:.1f}" r="2"/>' for x, y in xy)
    height = float(xy[:, 1].max()) + 20
    return f'<svg width="300" height="{height:.0f}" fill="currentColor">{dots}</svg>'
