# SPDX-License-Identifier: Apache-2.0
"""Reads the folders of the library from the lf_folder(...) calls in lf/ (cmake/LfFolder.cmake)."""
import pathlib
import re

KEYWORDS = {"WORDS", "SOURCES", "ALONE", "DEPENDS", "LIBS", "PUBLIC_LIBS", "TESTS", "TEST_LIBS", "FUZZ", "BENCH"}


def read_call(cmake: str) -> dict:
    """Returns {"": [path], "SOURCES": [...], ...} of the lf_folder(...) call in a CMakeLists.txt, or {} without one."""
    call = re.search(r"^lf_folder\((.*?)\)", cmake, re.S | re.M)
    words = {}
    keyword = ""
    for word in call.group(1).split() if call else ():
        if word in KEYWORDS:
            keyword = word
        else:
            words.setdefault(keyword, []).append(word)
    return words


def read_folders(root: pathlib.Path) -> dict:
    """Returns {"camera/path": {"DEPENDS": ["core", "camera"], ...}, ...}: all folders of lf/ by their paths."""
    top = root / "lf"
    found = {}
    for cmake in sorted(top.rglob("CMakeLists.txt")):
        call = read_call(cmake.read_text())
        if call:
            found[cmake.parent.relative_to(top).as_posix()] = call
    return found


def room_of(folder: str) -> str:
    """Returns the room of a folder, which is directly in lf/: camera for camera/path."""
    return folder.split("/")[0]


def test_group(folder: str) -> str:
    """Returns what the names of a folder's tests begin with: camera.path for camera/path."""
    return folder.replace("/", ".")
