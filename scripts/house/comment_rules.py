# SPDX-License-Identifier: Apache-2.0
"""The rules for how a comment begins and ends (doc/style.md), and the house check that no comment breaks them.

A comment is a run of whole lines of // or #, a comment behind code, or the first line of a Python docstring. The line
that states the licence (licence_headers.py) belongs to no comment.
"""
import pathlib
import re

MARKS = {".cc": "//", ".h": "//", ".c": "//", ".ts": "//", ".mjs": "//", ".py": "#", ".sh": "#", ".cmake": "#",
         ".txt": "#"}
# Begins the statement of a licence. In two parts, so that this line states none.
LICENCE_TAG = "SPDX-License-" "Identifier:"
OPENING = re.compile(r"(Of|Those|That|What|Where|Whether|The same|So|Else)\b(?! (is|are)\?)")
ENDING = re.compile(r"\b(too|as well|alike)[.:;]?$")


def comments_of(lines: list, mark: str):
    """Yields (line number, text) of each comment; the lines of a run are joined by spaces."""
    begin, run = 0, []
    for number, line in enumerate(lines + [""], 1):
        text = line.strip()
        if text.startswith(mark) and not text.startswith("#!") and LICENCE_TAG not in text:
            if not run:
                begin = number
            run.append(text.lstrip("/#<! ").strip())
            if run[-1]:
                continue
        if run:
            yield begin, " ".join(run).strip()
            run = []
        if mark == "//":
            behind = re.search(r"[;{},)]\s+//\s*(.*)$", line)
        else:
            behind = re.search(r"\S  #\s+(.*)$", line)
        if behind:
            yield number, behind.group(1)
        docstring = re.match(r'\s*"""(\w.*?)(""")?$', line) if mark == "#" else None
        if docstring:
            yield number, docstring.group(1)


def faults_of(path: pathlib.Path, lines: list):
    """Yields what is wrong with the comments of a file, as (line number, what)."""
    mark = MARKS.get(path.suffix)
    if mark is None or (path.suffix == ".txt" and path.name != "CMakeLists.txt"):
        return
    for number, text in comments_of(lines, mark):
        opening = OPENING.match(text)
        if opening:
            yield number, f"a comment begins with '{opening.group(1)}': {text[:60]}"
        ending = ENDING.search(text)
        if ending:
            yield number, f"a comment ends with '{ending.group(1)}': {text[-60:]}"
