# SPDX-License-Identifier: Apache-2.0
"""The settings that decide the rays and pictures of frames, which several functions take.

The extension has a table of them, from which the options of the programs are made as well.
"""
from __future__ import annotations

import math
from typing import Any, Dict, Mapping, NamedTuple

from . import _core, arguments
from .errors import UsageError
from .keywords import suggestion


class _Setting(NamedTuple):
    name: str
    kind: str  # choice, switch, whole, number, point or text
    is_optional: bool  # None means that it is unset
    least: float
    most: float

    def text(self, value: Any) -> str:
        """Return the text of a value. The extension checks words and ranges that are not stated here."""
        if self.kind == "switch":
            return "on" if arguments.flag(self.name, value) else "off"
        if self.kind == "point":
            return "auto" if value is None else " ".join(map(repr, arguments.numbers(self.name, value, 3, 3)))
        if self.is_optional and value is None:
            return "0"
        if self.kind == "whole":
            least = 1 if self.is_optional else int(self.least)
            most = int(self.most) if math.isfinite(self.most) else 2**64 - 1
            return str(arguments.whole_within(self.name, value, least, most))
        if self.kind == "number":
            is_above_0 = self.is_optional or math.isinf(self.most)
            return repr(arguments.positive(self.name, value, self.most) if is_above_0 else
                        arguments.within(self.name, value, self.least, self.most))
        if self.kind == "text" and not isinstance(value, str):  # such as fill=2, and "off"
            return str(arguments.whole(self.name, value))
        return arguments.text(self.name, value)


_SETTINGS: Dict[str, _Setting] = {row[0]: _Setting(*row) for row in _core.settings()}


def film_words(options: Mapping[str, Any], own: Dict[str, Any]) -> Dict[str, str]:
    """Return the texts of these settings. Options that the caller has of its `own` are set there instead."""
    words = {}
    for name, value in options.items():
        if name in own:
            own[name] = value
        elif name in _SETTINGS:
            words[name] = _SETTINGS[name].text(value)
        else:
            known = sorted([*own, *_SETTINGS])
            raise UsageError(f"unknown option {name}{suggestion(name, known)}: expected one of {', '.join(known)}")
    return words
