# SPDX-License-Identifier: Apache-2.0
"""Checks the headers of the library, for check_house.py: which of them other programs get, and which belong to one
folder.

lf/public_headers.txt lists the headers that the library promises. They are installed with all that they include
(cmake/installed_headers.cmake). A header whose first comment says "Internal to ..." is included only by sources of its
own folder, and of folders that this comment names.
"""
import pathlib
import re

import comment_rules
import folder_list

LIST = "lf/public_headers.txt"
FRONT = "lf/lfrendertools.h"
INCLUDE = re.compile(r'\s*#\s*include\s*"(lf/[^"]+)"')
INTERNAL = re.compile(r"\bInternal to ([\w/ ,]+)")
OF_TESTS = ("test_", "testing_")
# Largest number of headers that are installed because promised ones include them. Whoever includes a promised header
# compiles all of them, and sees their names: a new one is often avoided by a forward declaration.
MOST_INCLUDED = 31


def promised_headers(root: pathlib.Path) -> dict:
    """Returns {"lf/api/film.h": heading, ...}: the headers that the library promises, in the order of the list."""
    lines = (line.partition(" ") for line in (root / LIST).read_text().splitlines() if line.startswith("lf/"))
    return {name: heading.strip() for name, _, heading in lines}


def includes_of(lines) -> list:
    return [match[1] for match in map(INCLUDE.match, lines) if match]


def included_by(root: pathlib.Path, names, without=()) -> list:
    """Returns these headers, and all headers of lf/ that they include, directly or through others: but not those of
    `without`, nor what only these include."""
    found = list(names)
    for name in found:  # which grows
        path = root / name
        lines = path.read_text().splitlines() if path.is_file() else ()
        found += [each for each in dict.fromkeys(includes_of(lines)) if each not in found and each not in without]
    return found


def first_comment(lines) -> str:
    """Returns the comment that a header begins with, in one line, without the line that states the licence."""
    comment = []
    for line in lines[1 if lines and comment_rules.LICENCE_TAG in lines[0] else 0:]:
        if not line.startswith("//"):
            break
        comment.append(line.lstrip("/ "))
    return " ".join(comment)


def internal_headers(root: pathlib.Path, text_lines) -> dict:
    """Returns {"lf/focus/a.h": {"focus"}, ...}: the folders that may include each internal header."""
    folders = folder_list.read_folders(root)
    found = {}
    for folder in folders:
        for path in sorted((root / "lf" / folder).glob("*.h")):
            says = INTERNAL.search(first_comment(text_lines(path)))
            if says:
                named = {word.removeprefix("lf/") for word in re.split(r"[ ,]+", says[1])}
                found[path.relative_to(root).as_posix()] = {folder, *named & set(folders)}
    return found


def internal_faults(root, files, text_lines):
    """Yields the places where a header that is internal to a folder is included from elsewhere."""
    internal = internal_headers(root, text_lines)
    for path in files:
        if path.suffix not in {".cc", ".h"}:
            continue
        name = path.relative_to(root)
        folder = name.parent.as_posix().removeprefix("lf/")
        for number, line in enumerate(text_lines(path), 1):
            match = INCLUDE.match(line)
            if match and match[1] in internal and folder not in internal[match[1]]:
                yield f"{name}:{number}: {match[1]} is internal to {', '.join(sorted(internal[match[1]]))}, as it says"


def promise_faults(root, text_lines):
    """Yields what is wrong with the headers that other programs get."""
    if not (root / LIST).is_file():
        return
    promised = promised_headers(root)
    internal = internal_headers(root, text_lines)
    yield from (f"{LIST}: {name} does not exist" for name in promised if not (root / name).is_file())
    reached = included_by(root, [FRONT])
    yield from (f"{FRONT}: does not include {name}, which {LIST} promises" for name in promised if name not in reached)
    installed = included_by(root, promised)
    for name in installed:
        if name in internal or pathlib.PurePosixPath(name).name.startswith(OF_TESTS):
            yield f"{name}: promised headers ({LIST}) include it, but it is internal or of tests"
    others = [name for name in installed if name not in promised]
    if len(others) > MOST_INCLUDED:
        yield (f"{LIST}: promised headers include {len(others)} other headers, the limit is {MOST_INCLUDED}; a forward "
               f"declaration may do: {', '.join(others)}")


def check_headers(root: pathlib.Path, files, text_lines):
    """Yields faults: headers that are promised but missing, promised headers that include what other programs should
    not get or too much, and internal headers that are included from elsewhere."""
    yield from promise_faults(root, text_lines)
    yield from internal_faults(root, files, text_lines)
