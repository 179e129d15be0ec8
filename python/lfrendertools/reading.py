# SPDX-License-Identifier: Apache-2.0
"""Reads LF images in advance."""
from __future__ import annotations

import collections
import concurrent.futures
import os
from typing import Any, Callable, Iterator, Tuple

import numpy.typing as npt

from .errors import InputError, warn_of_missing


def loaded_ahead(ids: Iterator[int], load: Callable[[int], npt.NDArray[Any]], ahead: int,
                 strict: bool) -> Iterator[Tuple[int, npt.NDArray[Any]]]:
    """Load LF images in advance.

    Parameters
    ----------
    ids : iterator of int
        Numbers of the LF images.
    load : callable
        Loads an LF image by its number. Several threads call it.
    ahead : int
        Largest number of LF images that are in memory at the same time.
    strict : bool
        True: an LF image that is missing or broken is an error; False: it is left out, with a warning in the end.

    Yields
    ------
    i, picture : int, ndarray
    """
    loading: "collections.deque[Tuple[int, concurrent.futures.Future[npt.NDArray[Any]]]]" = collections.deque()
    reasons = []
    with concurrent.futures.ThreadPoolExecutor(min(ahead, os.cpu_count() or 1)) as threads:
        try:
            is_going_on = True
            while is_going_on or loading:
                i = next(ids, None) if is_going_on else None
                is_going_on = i is not None
                if i is not None:
                    loading.append((i, threads.submit(load, i)))
                if loading and (len(loading) == ahead or not is_going_on):
                    first, future = loading.popleft()
                    try:
                        picture = future.result()
                    except InputError as error:
                        if strict:
                            raise
                        reasons.append(str(error))
                    else:
                        yield first, picture
        finally:
            for _, future in loading:
                future.cancel()
    warn_of_missing(reasons)
