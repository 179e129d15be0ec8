# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments, so that errors name the argument and say what is expected."""
from __future__ import annotations

import math
import operator
import os
import sys
from typing import Any, Iterator, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from .errors import UsageError

FilePath = Union[str, "os.PathLike[str]"]


def whole(name: str, value: Any) -> int:
    """Return a whole number, also of NumPy."""
    try:
        return int(operator.index(value))
    except TypeError:
        raise TypeError(f"{name}={value!r}: expected a whole number") from None


def whole_within(name: str, value: Any, least: int, most: int) -> int:
    """Return a whole number from `least` to `most`."""
    number = whole(name, value)
    if not least <= number <= most:
        raise UsageError(f"{name}={value!r}: expected a whole number from {least} to {most}")
    return number


def seed(name: str, value: Any) -> int:
    """Return a seed of random numbers."""
    return whole_within(name, value, 0, 2**64 - 1)


def index(name: str, value: Any) -> int:
    """Return a whole number, or the nearest one of 64 bits, which is then out of the range of every sequence."""
    return min(max(whole(name, value), -2**63), 2**63 - 1)


def real(name: str, value: Any) -> float:
    """Return a number as float."""
    try:
        if not isinstance(value, (str, bytes, bytearray)):
            return float(value)
    except OverflowError:
        return math.copysign(math.inf, value)
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{name}={value!r}: expected a number")


def within(name: str, value: Any, least: float, most: float) -> float:
    """Return a number from `least` to `most`."""
    number = real(name, value)
    if not least <= number <= most:
        raise UsageError(f"{name}={value!r}: expected a number from {least:g} to {most:g}")
    return number


def positive(name: str, value: Any, most: float = sys.float_info.max) -> float:
    """Return a number above 0 and up to `most`."""
    number = real(name, value)
    if not 0 < number <= most:
        limit = "" if most == sys.float_info.max else f" and up to {most:g}"
        raise UsageError(f"{name}={value!r}: expected a number above 0{limit}")
    return number


def reals(name: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return numbers as an array of floats."""
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name}: expected an array of numbers: {error}") from None


def entries(name: str, value: Any, expected: str) -> Tuple[Any, ...]:
    """Return the entries of a sequence, which text is not. `expected` tells what they are."""
    try:
        if not isinstance(value, (str, bytes)):
            return tuple(value)
    except TypeError:
        pass
    raise TypeError(f"{name}={value!r}: expected {expected}")


def iterator(name: str, value: Any, expected: str) -> Iterator[Any]:
    """Return an iterator over the entries of the argument. `expected` tells what they are."""
    try:
        return iter(value)
    except TypeError:
        raise TypeError(f"{name}={value!r}: expected {expected}") from None


def rows(name: str, value: npt.ArrayLike, columns: int) -> Tuple[npt.NDArray[np.float64], Tuple[int, ...]]:
    """Return an array (..., columns) of numbers as rows (n, columns), and its leading dimensions."""
    array = reals(name, value)
    if array.shape == (0,):
        array = array.reshape(0, columns)
    if array.ndim == 0 or array.shape[-1] != columns:
        raise UsageError(f"{name}: expected an array of shape (..., {columns}), found {array.shape}")
    return array.reshape(-1, columns), array.shape[:-1]


def whole_numbers(name: str, value: Any, count: int) -> Tuple[int, ...]:
    """Return so many whole numbers."""
    found = entries(name, value, f"{count} whole numbers")
    try:
        numbers = tuple(int(operator.index(number)) for number in found)
    except TypeError:
        raise TypeError(f"{name}={value!r}: expected {count} whole numbers") from None
    if len(numbers) != count:
        raise UsageError(f"{name}={value!r}: expected {count} whole numbers, found {len(numbers)}")
    return numbers


def numbers(name: str, value: Any, least_count: int, most_count: int) -> Tuple[float, ...]:
    """Return from `least_count` to `most_count` numbers."""
    count = f"{least_count}" if least_count == most_count else f"{least_count} to {most_count}"
    found = entries(name, value, f"{count} numbers")
    try:
        floats = tuple(real(name, number) for number in found)
    except TypeError:
        raise TypeError(f"{name}={value!r}: expected {count} numbers") from None
    if not least_count <= len(floats) <= most_count:
        raise UsageError(f"{name}={value!r}: expected {count} numbers, found {len(floats)}")
    return floats


def choice(name: str, value: Any, words: Sequence[str]) -> str:
    """Return one of these words."""
    if value not in words:
        raise UsageError(f"{name}={value!r}: expected one of {', '.join(words)}")
    return str(value)


def thread_count(value: Any) -> int:
    """Return a number of threads; 0: one for each processor."""
    return whole_within("threads", value, 0, 512)


def flag(name: str, value: Any) -> bool:
    """Return True or False."""
    if value is not None and not (isinstance(value, (int, np.bool_)) and value in (0, 1)):
        raise TypeError(f"{name}={value!r}: expected True or False")
    return bool(value)


def text(name: str, value: Any) -> str:
    """Return a string."""
    if not isinstance(value, str):
        raise TypeError(f"{name}={value!r}: expected a string")
    return value


def memory(value: Any) -> str:
    """Return a size of memory, which the library parses."""
    if not isinstance(value, str):
        raise TypeError(f"memory={value!r}: expected a string such as \"8G\" or \"512M\"")
    return value


def file_name(name: str, path: Any) -> bytes:
    """Return the bytes of a path, which need not be UTF-8."""
    try:
        encoded = os.fsencode(path)
    except TypeError:
        raise TypeError(f"{name}={path!r}: expected a path: str, bytes or os.PathLike") from None
    except UnicodeEncodeError:
        raise UsageError(f"{name}={path!r}: has characters that no file name has") from None
    if not encoded:
        raise UsageError(f"{name}: expected a path, found an empty string")
    if b"\0" in encoded:
        raise UsageError(f"{name}={os.fsdecode(encoded)!r}: a path has no character 0")
    return encoded
