# SPDX-License-Identifier: Apache-2.0
"""Suggests the argument that was meant if a call names one that the function does not have."""
from __future__ import annotations

import difflib
import functools
import inspect
from typing import Any, Callable, Iterable, TypeVar, cast

_Function = TypeVar("_Function", bound=Callable[..., Any])


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean NAME?" with the nearest of the known names, or nothing if none is near."""
    candidates = list(known)
    # The unit may have been left out: focal_length for focal_length_mm.
    near = [candidate for candidate in candidates if candidate.startswith(name + "_")]
    near = near or difflib.get_close_matches(name, candidates, 1, 0.6)
    return f"; did you mean {near[0]}?" if near else ""


def suggests_names(function: _Function) -> _Function:
    """Return the function with an error that suggests the nearest name for an argument that it does not have."""
    parameters = inspect.signature(function).parameters.values()
    known = [parameter.name for parameter in parameters
             if parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY)
             and parameter.name not in ("self", "cls")]

    @functools.wraps(function)
    def checked(*args: Any, **kwargs: Any) -> Any:
        for name in kwargs:
            if name not in known:
                called = function.__qualname__.removesuffix(".__init__")
                raise TypeError(f"{called}(): unknown argument {name}{suggestion(name, known)}")
        return function(*args, **kwargs)
    return cast(_Function, checked)
