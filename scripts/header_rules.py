# SPDX-License-Identifier: Apache-2.0
"""Checks which headers are installed, for check_house.py. lf_folder(... INTERNAL ...) names the headers of its folder
that are not installed (cmake/LfFolder.cmake); the first comment of such a header says so: "Internal to ...".
"""
import pathlib
import re

import comment_rules
import folder_list

INCLUDE = re.compile(r'\s*#\s*include\s*"(lf/[^"]+)"')
OF_TESTS = ("test_", "testing_")


def first_comment(lines) -> str:
    """Returns the comment that a header begins with, in one line, without the line that states the licence."""
    comment = []
    for line in lines[1 if lines and comment_rules.LICENCE_TAG in lines[0] else 0:]:
        if not line.startswith("//"):
            break
        comment.append(line.lstrip("/ "))
    return " ".join(comment)


def header_fault(name, lines, is_listed):
    """Returns what is wrong with the place of a header in INTERNAL, or None."""
    if name.startswith(OF_TESTS):
        return "INTERNAL lists it, which is needless for a header of tests" if is_listed else None
    says_internal = bool(re.search(r"\bInternal to\b", first_comment(lines)))
    if says_internal and not is_listed:
        return "its first comment says 'Internal to', but INTERNAL does not list it"
    if is_listed and not says_internal:
        return "INTERNAL lists it, but its first comment does not say 'Internal to'"
    return None


def check_headers(root: pathlib.Path, text_lines):
    """Yields faults: headers that only their comment or only INTERNAL calls internal, and public headers that include
    internal ones."""
    internal, headers = set(), {}
    for folder, words in folder_list.read_folders(root).items():
        place = pathlib.PurePosixPath("lf", folder)
        names = words.get("INTERNAL", ())
        internal.update(str(place / name) for name in names)
        for path in sorted((root / place).glob("*.h")):
            headers[str(place / path.name)] = text_lines(path)
    for name, lines in headers.items():
        fault = header_fault(pathlib.PurePosixPath(name).name, lines, name in internal)
        if fault:
            yield f"{name}: {fault}"
        if name in internal or pathlib.PurePosixPath(name).name.startswith(OF_TESTS):
            continue
        for number, line in enumerate(lines, 1):
            match = INCLUDE.match(line)
            if match and match[1] in internal:
                yield f"{name}:{number}: a header that is installed includes {match[1]}, which is not"
    for name in sorted(internal - set(headers)):
        yield f"{name}: INTERNAL lists it, but it does not exist"
