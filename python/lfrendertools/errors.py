# SPDX-License-Identifier: Apache-2.0
"""The exceptions of this package. Each has the exit code with which the programs report the same error."""
from __future__ import annotations

import inspect
import os
import warnings
from typing import Sequence


class Error(Exception):
    """Any error of this package.

    Attributes
    ----------
    exit_code : int
        The exit code of `lfrenderer` for an error of this kind.
    """

    exit_code = 1


class UsageError(Error, ValueError):
    """An argument is wrong, or arguments contradict each other."""

    exit_code = 2


class InputError(Error, ValueError):
    """A file, or a value in it, is wrong."""

    exit_code = 3


class OutputError(Error, OSError):
    """The disk, the memory or a program that was called failed."""

    exit_code = 4


class InterruptedRender(Error):
    """The work was interrupted."""

    exit_code = 5


class BelowRequired(Error):
    """The result is less than was asked for."""

    exit_code = 6


class MissingImagesWarning(UserWarning):
    """LF images were left out of frames because they are missing or broken."""


class BlackFrameWarning(UserWarning):
    """No recorded ray passes the lens of a frame, which is therefore black."""


class UncertainFocusWarning(UserWarning):
    """The distance of the subject is not sure, so that a camera of the light field is almost a pinhole."""


def caller_level() -> int:
    """Return the stacklevel with which warnings.warn() names the line that called this package."""
    frame, level, package = inspect.currentframe(), 0, os.path.dirname(__file__)
    while frame and os.path.dirname(frame.f_code.co_filename) == package:
        frame, level = frame.f_back, level + 1
    return level


def warn_of_missing(reasons: Sequence[str]) -> None:
    """Warn if LF images were left out, for these reasons."""
    if reasons:
        were = "1 LF image was" if len(reasons) == 1 else f"{len(reasons)} LF images were"
        warnings.warn(f"{were} left out, the first: {reasons[0]}" if len(reasons) > 1 else
                      f"{were} left out: {reasons[0]}", MissingImagesWarning, stacklevel=caller_level())
