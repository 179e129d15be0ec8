# SPDX-License-Identifier: Apache-2.0
"""The options that decide the rays and pictures of frames, which several functions take."""
from __future__ import annotations

import functools
from typing import Any, Callable, Dict, Mapping, Optional

from . import _core, arguments
from .errors import UsageError

_count = functools.partial(arguments.whole_within, least=0, most=2**32 - 1)


def _max_images(name: str, value: Any) -> Optional[int]:
    return None if value is None else arguments.whole_within(name, value, 1, 2**32 - 1)


def _max_angle(name: str, value: Any) -> Optional[float]:
    return None if value is None else arguments.positive(name, value, 180)


# The library checks words, and the range of `fill`.
_CHECKS: Dict[str, Callable[[str, Any], Any]] = {
    "mode": arguments.text, "estimator": arguments.text, "filter": arguments.text, "lens_weights": arguments.text,
    "lf_pixels": arguments.text, "order": arguments.text, "stop_when": arguments.text, "max_images": _max_images,
    "max_angle_deg": _max_angle, "seed": arguments.seed, "smooth_below": _count, "fill": _count,
    "guard": arguments.flag}


def film_words(options: Mapping[str, Any], own: Dict[str, Any]) -> _core.FilmWords:
    """Return the options with these names and values. Those that the caller has of its `own` replace its defaults."""
    words = _core.FilmWords()
    for name, value in options.items():
        if name in own:
            own[name] = value
        elif name in _CHECKS:
            setattr(words, name, _CHECKS[name](name, value))
        else:
            raise UsageError(f"unknown option {name}: expected one of {', '.join(sorted([*own, *_CHECKS]))}")
    return words
