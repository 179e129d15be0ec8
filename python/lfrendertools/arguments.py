"""Checks of arguments, so that errors name the argument and say what is expected."""
from __future__ import annotations

import contextlib
import math
import operator
import os
import re
from typing import Any, Iterator, Tuple, Union

import numpy as np
import numpy.typing as npt

from .errors import Error, UsageError

FilePath = Union[str, "os.PathLike[str]"]

# Options of the programs whose values are arguments here.
_OPTION = re.compile(r"--(focal-px|fov-deg|images|image-scale|image-alpha|background|pitch|plane-distance|flip-x|"
                     r"flip-y|memory|max-images|max-angle|max-angle-deg|stop-when|smooth-below|lens-weights|lf-pixels|"
                     r"filter|estimator|mode|order|fill|seed|strict|threads|frames)\b")


def whole(name: str, value: Any) -> int:
    """Return a whole number, also of NumPy. Numbers beyond 64 bits become the largest one."""
    try:
        number = int(operator.index(value))
    except TypeError:
        raise TypeError(f"{name}={value!r}: expected a whole number") from None
    return min(max(number, -2**63), 2**63 - 1)


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


def positive(name: str, value: Any) -> float:
    """Return a finite number above 0."""
    number = real(name, value)
    if not 0 < number < math.inf:
        raise UsageError(f"{name}={value!r}: expected a number above 0")
    return number


def reals(name: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return numbers as an array of floats."""
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name}: expected an array of numbers: {error}") from None


def whole_numbers(name: str, value: Any, count: int) -> Tuple[int, ...]:
    """Return so many whole numbers."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__iter__"):
        raise TypeError(f"{name}={value!r}: expected {count} whole numbers")
    numbers = tuple(whole(name, number) for number in value)
    if len(numbers) != count:
        raise UsageError(f"{name}={value!r}: expected {count} whole numbers, found {len(numbers)}")
    return numbers


def flag(name: str, value: Any) -> bool:
    """Return True or False."""
    if value is not None and not (isinstance(value, (int, np.bool_)) and value in (0, 1)):
        raise TypeError(f"{name}={value!r}: expected True or False")
    return bool(value)


def text(name: str, value: Any) -> str:
    """Return a text."""
    if not isinstance(value, str):
        raise TypeError(f"{name}={value!r}: expected a text")
    return value


def file_name(path: FilePath) -> bytes:
    """Return the bytes of a path, whose name need not be UTF-8."""
    name = os.fsencode(path)
    if not name:
        raise UsageError("expected a path, found an empty text")
    if b"\0" in name:
        raise UsageError(f"{os.fsdecode(name)!r}: a path has no character 0")
    return name


@contextlib.contextmanager
def naming_arguments() -> Iterator[None]:
    """Let errors of the library name arguments instead of options of programs."""
    try:
        yield
    except Error as error:
        raise type(error)(_OPTION.sub(lambda found: found[1].replace("-", "_"), str(error))) from None
