"""Progress of long work, for people and for functions of the caller."""
from __future__ import annotations

import warnings
from typing import Callable, Union

# A function that is called with what is done so far, and with what will be done in all: LF images, unless the
# description of the caller says otherwise.
Tell = Callable[[int, int], None]
Progress = Union[None, bool, Tell]


def teller(progress: Progress, unit: str = "LF images") -> Tell:
    """Return the function to call: the one that was given, a bar of tqdm (True), or one that does nothing."""
    if callable(progress):
        return progress
    if progress:
        try:
            import tqdm.auto
        except ImportError:
            warnings.warn("progress=True shows nothing, because tqdm is not installed: give a function instead",
                          stacklevel=3)
        else:
            bar = tqdm.auto.tqdm(unit=f" {unit}")

            def show(done: int, total: int) -> None:
                bar.total = total
                bar.update(done - bar.n)
                if done == total:
                    bar.close()
            return show
    return lambda done, total: None
