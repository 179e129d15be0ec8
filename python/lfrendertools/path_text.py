# SPDX-License-Identifier: Apache-2.0
"""The text of camera path files (doc/formats/path.md)."""
from __future__ import annotations

from typing import Any, Dict, Tuple

import numpy as np

from .errors import UsageError


def _value_text(value: Any) -> str:
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, bytes)):
        raise TypeError("text is no number")
    return "[" + ", ".join(_value_text(entry) for entry in value) + "]"


def _entry_text(key: str, value: Any) -> str:
    try:
        if key not in ("focus_tilt_deg", "shift_mm"):
            return _value_text(value)
        horizontal, vertical = value
        return f"{{horizontal: {_value_text(horizontal)}, vertical: {_value_text(vertical)}}}"
    except TypeError:
        name = key.replace("focus_tilt_deg", "tilt_deg")
        raise TypeError(f"{name}={value!r}: expected a number, or as many numbers as it has") from None
    except ValueError:
        name = key.replace("focus_tilt_deg", "tilt_deg")
        raise UsageError(f"{name}={value!r}: expected two numbers") from None


def text_of_camera(unit_m: float, resolution: Tuple[int, int], camera: Dict[str, Any], lens: Dict[str, Any]) -> str:
    """Return the text of a path of one frame. Values that are None are left out."""
    lines = ["format: lfpath 1", "fps: 1", "frames: 1", f"unit_m: {_entry_text('unit_m', unit_m)}",
             f"resolution: {_entry_text('resolution', resolution)}"]
    for section, values in (("camera", camera), ("lens", lens)):
        lines.append(f"{section}:")
        lines += [f"  {key}: {_entry_text(key, value)}" for key, value in values.items() if value is not None]
    return "\n".join(lines) + "\n"
