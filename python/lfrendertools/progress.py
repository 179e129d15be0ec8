# SPDX-License-Identifier: Apache-2.0
"""Progress of long work, for people and for functions of the caller."""
from __future__ import annotations

import contextlib
import importlib
import warnings
from typing import Any, Callable, Iterator, Optional, Tuple, Union

import numpy as np

from .errors import caller_level

# A function that is called with the number of steps that are done, and with their total number: LF images, unless the
# description of the caller says otherwise.
Tell = Callable[[int, int], None]
# Such a function that is also called with the number of the phase. Each phase counts from 0.
TellPhase = Callable[[int, int, int], None]
Progress = Union[None, bool, Tell]


class _Bar:
    """Bars of tqdm, one for each phase.

    tqdm is imported by a call, because mypy refuses the import statement where the types of tqdm are not installed.
    """

    def __init__(self, unit: str) -> None:
        self._unit = unit
        self._bar: Any = None

    def show(self, done: int, total: int) -> None:
        if self._bar is None:
            self._bar = importlib.import_module("tqdm.auto").tqdm(unit=f" {self._unit}", total=total)
        self._bar.total = total
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar = None


def checked(progress: Progress) -> Progress:
    """Return the argument `progress`, if it can be one."""
    if progress is not None and not isinstance(progress, (bool, np.bool_)) and not callable(progress):
        raise TypeError(f"progress={progress!r}: expected True, False or a function of two numbers")
    if isinstance(progress, (bool, np.bool_)) and progress and not _has_tqdm():
        warnings.warn("progress=True shows nothing, because tqdm is not installed: give a function instead",
                      stacklevel=caller_level())
        return None
    return progress


def _has_tqdm() -> bool:
    try:
        importlib.import_module("tqdm.auto")
    except ImportError:
        return False
    return True


@contextlib.contextmanager
def telling(progress: Progress, unit: str = "LF images") -> Iterator[TellPhase]:
    """Provide a function to call with each change of the progress. It tells no news twice, ends each phase with
    its total, and closes bars in the end.

    Parameters
    ----------
    progress : None, bool or callable
        The function that is told, or True for bars of tqdm.
    unit : str
        Name of the steps.
    """
    bar = _Bar(unit)
    told: Optional[Tuple[int, int, int]] = None

    def tell(done: int, total: int, phase: int = 0) -> None:
        nonlocal told
        if told is not None and phase != told[2]:
            if told[0] < told[1]:
                show(told[1], told[1])
            bar.close()
        if told != (done, total, phase):
            told = (done, total, phase)
            show(done, total)

    def show(done: int, total: int) -> None:
        if callable(progress):
            progress(done, total)
        elif progress:
            bar.show(done, total)
    try:
        yield tell
    finally:
        bar.close()
