# SPDX-License-Identifier: Apache-2.0
"""Reads the list of mutants, scripts/mutants.toml, and checks that it fits the code.

A mutant is a mistake that somebody could make, planted into one file. Its fields:

    name      letters, digits and hyphens; occurs once in the list
    area      the part of the project it is in
    file      where it is planted, from the top of the repository
    function  the function, method or constant in whose definition it is planted; overloads count as one
    old, new  a short text that occurs in the function exactly once, and its replacement. White space may differ, and
              other lines of the function may change
    effect    one sentence: what a user would see
    targets   what is built for the tests: test programs, programs, or "page"
    tests     a regular expression of test names of ctest: the tests expected to fail
"""
import pathlib
import re
import tomllib
from typing import NamedTuple

import function_text

LIST = "scripts/mutants.toml"
WORDS = ("name", "area", "file", "function", "old", "new", "effect", "tests")


class Mutant(NamedTuple):
    name: str
    area: str
    file: str
    function: str
    old: str
    new: str
    effect: str
    tests: str
    targets: tuple

    @property
    def is_quick(self):
        """True if only test programs of folders are built, which takes seconds."""
        return all(target.endswith("_test") for target in self.targets)


def read_list(path: pathlib.Path) -> list:
    """Returns the mutants of a list, the quick ones first. Raises ValueError if the text is no list."""
    try:
        entries = tomllib.loads(path.read_text())["mutant"]
        mutants = [Mutant(*(str(entry[word]) for word in WORDS), tuple(entry["targets"])) for entry in entries]
    except KeyError as error:
        raise ValueError(f"a mutant has no {error}") from error
    return sorted(mutants, key=lambda mutant: not mutant.is_quick)


def planted(mutant: Mutant, text: str) -> str:
    """Returns the text with the mistake planted. Raises ValueError if the function has `old` not exactly once."""
    functions = function_text.spans(text, mutant.function)
    if not functions:
        raise ValueError(f"{mutant.name}: {mutant.file} has no function or constant {mutant.function}")
    old = re.compile(r"\s+".join(map(re.escape, mutant.old.split())))
    found = {place.span() for begin, end in functions for place in old.finditer(text, begin, end)}
    if len(found) != 1:
        raise ValueError(f"{mutant.name}: {mutant.function} of {mutant.file} has its old text {len(found)} times, "
                         "expected once")
    (begin, end), = found
    return text[:begin] + mutant.new + text[end:]


def faults_of(mutant: Mutant, root: pathlib.Path, tests: set):
    """Yields the faults of one mutant of the list."""
    if not re.fullmatch(r"[a-z0-9-]+", mutant.name):
        yield f"{mutant.name}: a name has small letters, digits and hyphens"
    if mutant.old == mutant.new:
        yield f"{mutant.name}: its new text is the old one"
    if not mutant.old.strip():
        yield f"{mutant.name}: its old text is empty"
    if not (root / mutant.file).is_file():
        yield f"{mutant.name}: there is no {mutant.file}"
    else:
        try:
            planted(mutant, (root / mutant.file).read_text())
        except ValueError as error:
            yield str(error)
    if not mutant.targets:
        yield f"{mutant.name}: has no targets"
    try:
        is_known = any(re.search(mutant.tests, name) for name in tests)
    except re.error as error:
        yield f"{mutant.name}: its tests are no regular expression: {error}"
    else:
        if not is_known:
            yield f"{mutant.name}: no test is named like {mutant.tests}"


def check_list(root: pathlib.Path, tests: set):
    """Yields the faults of the list as lines."""
    path = root / LIST
    if not path.is_file():
        return
    try:
        mutants = read_list(path)
    except ValueError as error:
        yield f"{LIST}: {error}"
        return
    names = [mutant.name for mutant in mutants]
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield f"{LIST}: {name}: is there twice"
    for mutant in mutants:
        yield from (f"{LIST}: {fault}" for fault in faults_of(mutant, root, tests))
