"""Checks of arguments, so that errors name the argument and say what is expected."""
from __future__ import annotations

import contextlib
import math
import operator
import os
import re
from typing import Any, Dict, Iterator, Mapping, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from .errors import Error, UsageError

FilePath = Union[str, "os.PathLike[str]"]

# Options of the programs whose values are arguments here.
_OPTION = re.compile(r"--(alpha|balance|bayer|background|calibration-only|capture|count|depths|distance|"
                     r"distortion|estimator|fill|filter|fisheye|flip-x|flip-y|focal-px|format|fov|"
                     r"fov-deg|frames|frames-per-package|image-alpha|image-scale|images|jitter|"
                     r"lens-weights|levels|lf-pixels|max-angle|max-angle-deg|max-images|memory|mode|noise|"
                     r"order|overwrite|packages|pitch|plane-distance|profile|quantizer|resume|samples|"
                     r"seed|shard-size|smooth-below|spacing|stop-when|strict|target-psnr|threads|"
                     r"threshold|truth|truth-samples|verify)\b")


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


def choice(name: str, value: Any, words: Sequence[str]) -> str:
    """Return one of these words."""
    if value not in words:
        raise UsageError(f"{name}={value!r}: expected one of {', '.join(words)}")
    return str(value)


def thread_count(value: Any) -> int:
    """Return a number of threads; 0: one for each processor."""
    number = whole("threads", value)
    if not 0 <= number <= 512:
        raise UsageError(f"threads={value!r}: expected 0 to 512")
    return number


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


def set_words(words: object, options: Mapping[str, Any], own: Dict[str, Any]) -> None:
    """Set members of `words`, or entries of `own`, to the options with these names.

    Parameters
    ----------
    words : object of the extension
        Its members are the options of the library.
    options : mapping
        Names and values as the caller gave them.
    own : dict
        The caller's own options with their defaults, which are replaced.
    """
    for name, value in options.items():
        if name in own:
            own[name] = value
        elif hasattr(words, name) and not name.startswith("_"):
            try:
                setattr(words, name, value)
            except TypeError:
                raise UsageError(f"{name}={value!r}: a value of this type is not possible") from None
        else:
            known = sorted([*own, *(word for word in dir(words) if not word.startswith("_"))])
            raise UsageError(f"unknown option {name}: expected one of {', '.join(known)}")


@contextlib.contextmanager
def naming_arguments() -> Iterator[None]:
    """Let errors of the library name arguments instead of options of programs."""
    try:
        yield
    except Error as error:
        raise type(error)(_OPTION.sub(lambda found: found[1].replace("-", "_"), str(error))) from None
