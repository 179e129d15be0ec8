#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""States the licence in the first lines of every source: one line, in the comment form of the language.

usage: scripts/house/licence_headers.py --write [REPOSITORY]    adds the missing lines, and prints how many

The check `licences` of check_house.py names the files whose line is missing or wrong.

The line is the first of its file, but follows the line of the interpreter (#!) and the <!doctype> of a page, which must
be first. The comment that says what the file is follows it. The copyright of all files, and the licence of files that
have no comments (pictures, JSON) or whose text readers see (pages, lists, examples), are in .reuse/dep5. A file of a
type that this script does not know is a fault: add it to COMMENTS or to STATED_BY_DEP5.
"""
import pathlib
import re
import sys

import comment_rules
from repository_files import text_lines, tracked_files

LICENCE = f"{comment_rules.LICENCE_TAG} Apache-2.0"
SLASHES, HASH, STAR, MARKUP = "// {}", "# {}", "/* {} */", "<!-- {} -->"
# The comment form for the ends of names.
COMMENTS = {".cc": SLASHES, ".h": SLASHES, ".c": SLASHES, ".cu": SLASHES, ".ts": SLASHES, ".mjs": SLASHES,
            ".js": SLASHES, ".py": HASH, ".pyi": HASH, ".sh": HASH, ".cmake": HASH, "CMakeLists.txt": HASH,
            ".toml": HASH, ".yml": HASH, ".cmake.in": HASH, ".pc.in": HASH, "Containerfile": HASH, ".css": STAR,
            ".html": MARKUP}
STATED_BY_DEP5 = {".md", ".json", ".txt", ".yaml", ".jpg", ".png", ".webp", ".svg", ".exr", ".dng", ".tif", ".bin",
                  ".lfs", ".lfp", ".chan", ".typed", ".supp", ".cff", ".1"}
# Settings of tools and other files whose names have no end, or none that tells their form.
NAMES_IN_DEP5 = {"VERSION", ".clang-format", ".clang-tidy", ".editorconfig", ".flake8", ".gitignore", ".gitattributes",
                 ".npmrc", ".prettierignore", ".dockerignore"}
# Folders whose files are inputs of tests, licences, or files whose form other programs prescribe.
FOLDERS_IN_DEP5 = ("fuzz/corpus", "LICENSES", ".reuse", "debian")
MUST_BE_FIRST = re.compile(r"#!|<!doctype", re.I)
# Matches a script that prints its own lines by their numbers, which the new line changes.
PRINTS_BY_NUMBER = re.compile(r"sed -n '?[0-9]")


def comment_form(name: str, lines):
    """Returns the comment form of a file, None if .reuse/dep5 states its licence, or "" for an unknown type."""
    path = pathlib.PurePosixPath(name)
    if name.startswith("LICENSE") or any(path.is_relative_to(folder) for folder in FOLDERS_IN_DEP5):
        return None
    for end, form in COMMENTS.items():
        if path.name.endswith(end):
            return form
    if not path.suffix and lines and lines[0].startswith("#!"):
        return HASH
    return None if path.suffix in STATED_BY_DEP5 or path.name in NAMES_IN_DEP5 else ""


def place_of(lines) -> int:
    """Returns the index at which the line belongs."""
    return 1 if lines and MUST_BE_FIRST.match(lines[0]) else 0


def fault_of(name: str, lines):
    """Returns (line number, fault) of a file, or None."""
    form = comment_form(name, lines)
    if form == "":
        return 1, "unknown type of file: list it in scripts/house/licence_headers.py"
    if form is None or not lines:
        return None
    for number, line in enumerate(lines, 1):
        if PRINTS_BY_NUMBER.search(line) and form == HASH and not name.endswith(".py"):
            return number, "prints its own lines by number; name them by their words: sed -n '/^# usage:/s/^# //p'"
    place, expected = place_of(lines), form.format(LICENCE)
    found = [number for number, line in enumerate(lines, 1) if line == expected]
    if found != [place + 1]:
        return place + 1, f"expected '{expected}' here and nowhere else: scripts/house/licence_headers.py --write"
    return None


def faults_of(root, files):
    """Yields the faults of all files."""
    for path in files:
        name = path.relative_to(root).as_posix()
        fault = fault_of(name, text_lines(path))
        if fault:
            yield f"{name}:{fault[0]}: {fault[1]}"


def write(path: pathlib.Path, name: str) -> bool:
    """Puts the line in its place if the file lacks it there. Returns whether the file was changed. Keeps all other
    bytes."""
    text = path.read_bytes().decode("utf-8", "surrogateescape")
    lines = text.splitlines(keepends=True)
    bare = [line.rstrip("\r\n") for line in lines]
    form = comment_form(name, bare)
    if not form or not lines:
        return False
    expected = form.format(LICENCE)
    kept = [line for line, words in zip(lines, bare) if words != expected]
    kept.insert(place_of(kept), expected + "\n")
    if kept == lines:
        return False
    path.write_bytes("".join(kept).encode("utf-8", "surrogateescape"))
    return True


def main() -> int:
    if len(sys.argv) not in (2, 3) or sys.argv[1] != "--write":
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[2] if len(sys.argv) == 3 else __file__.rpartition("/scripts/")[0] or ".")
    changed = sum(write(path, path.relative_to(root).as_posix()) for path in tracked_files(root))
    print(f"{changed} files changed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
