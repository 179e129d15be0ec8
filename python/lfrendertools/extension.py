# SPDX-License-Identifier: Apache-2.0
"""Loads the extension. If it was built for another Python, the error says for which one."""
from __future__ import annotations

import importlib.machinery
import pathlib
import re
import sys

__all__ = ["_core"]


def _why_not(folder: pathlib.Path) -> str:
    """Return why this Python finds no extension in a folder; "" if it finds one that fails for another reason."""
    files = sorted(path.name for path in folder.glob("_core*.so"))
    if any("_core" + suffix in files for suffix in importlib.machinery.EXTENSION_SUFFIXES):
        return ""
    runs = f"{sys.implementation.name} {sys.version_info.major}.{sys.version_info.minor} ({sys.executable})"
    if not files:
        return (f"{folder}: has no extension _core*.so: the package was not built; build and install it for {runs}: "
                f"{sys.executable} -m pip install PATH_OF_THE_SOURCES")
    install = f"build and install the package for this one: {sys.executable} -m pip install PATH_OF_THE_SOURCES"
    built = re.fullmatch(r"_core\.(?P<name>[a-z]+)-(?P<major>\d)(?P<minor>\d+).*", files[0])
    if not built:
        return f"{folder / files[0]} was not built for {runs}: {install}"
    other = f"{built['major']}.{built['minor']}"
    return (f"{folder / files[0]} was built for {built['name']} {other}, but this is {runs}: run python{other}, or "
            f"{install}")


try:
    from . import _core
except ImportError as error:
    if reason := _why_not(pathlib.Path(__file__).parent):
        raise ImportError(reason) from error
    raise
