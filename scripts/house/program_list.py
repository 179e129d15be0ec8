# SPDX-License-Identifier: Apache-2.0
"""Reads the list of the programs, tools/common/programs.h, which scripts and tests take instead of lists of their own.

Each place of PLACES has words of its own for a program, such as its target or a call. It must name every program.
"""
import ast
import pathlib
import re

LIST = "tools/common/programs.h"
STRING = r'"(?:[^"\\]|\\.)*"'
ENTRY = re.compile(rf'ListedProgram\{{\s*"(\w+)",\s*"\w+",\s*((?:{STRING}\s*)+)\}}')
# File: the pattern that matches a program there, and what must be added for a new one.
PLACES = {"tools/CMakeLists.txt": (r"^lf_tool\((\w+)", "its target"),
          "tests/helpers/common_options.py": (r'^    "(\w+)":', "the common options that it offers"),
          "scripts/valgrind.sh": (r"^ *check (\w+)", "a call of it")}


def summaries(root: pathlib.Path) -> dict:
    """Returns {program: summary} of all programs but lfr, in the order of the data flow."""
    path = root / LIST
    entries = ENTRY.findall(path.read_text()) if path.exists() else []
    return {name: "".join(ast.literal_eval(literal) for literal in re.findall(STRING, strings))
            for name, strings in entries}


def names(root: pathlib.Path) -> list:
    """Returns the names of all programs: lfr, which runs the others, and those that it lists."""
    return ["lfr", *summaries(root)]


def missing(root: pathlib.Path):
    """Yields a line for each place that lacks a program or names an unknown one."""
    programs = names(root)
    if len(programs) < 2:
        yield f"{LIST}: lists no programs"
    for place, (pattern, what) in PLACES.items():
        found = set(re.findall(pattern, (root / place).read_text(), re.M))
        for name in programs:
            if name not in found:
                yield f"{place}: has no {name}, which {LIST} lists: add {what}"
        for name in sorted(name for name in found - set(programs) if name.startswith("lf")):
            yield f"{place}: names {name}, which {LIST} does not list"
