# SPDX-License-Identifier: Apache-2.0
"""Reads doc/matrix.md: the axes of the matrix, and the cells that must be refused."""
import pathlib
import re
from typing import NamedTuple

PAGE = pathlib.Path(__file__).resolve().parents[2] / "doc" / "matrix.md"
AXES = ("field", "input", "cut", "mode", "run")


class Cell(NamedTuple):
    field: str
    input: str
    cut: str
    mode: str
    run: str

    @property
    def name(self):
        return "/".join(self)


class Refusal(NamedTuple):
    values: tuple  # a set of values for each axis, or None: any value
    exit_code: int
    words: list
    why: str

    def fits(self, cell):
        return all(values is None or value in values for values, value in zip(self.values, cell))

    def misses(self, exit_code, last_line):
        """Returns how the end of a program differs from this refusal, or an empty text."""
        if exit_code != self.exit_code:
            return f"exit code {exit_code}, expected {self.exit_code}"
        if not last_line.startswith("error: "):
            return "the last line does not begin with 'error: '"
        missing = [word for word in self.words if word not in last_line]
        return f"the last line lacks {', '.join(map(repr, missing))}" if missing else ""


class Page:
    def __init__(self, text):
        self.axes = {axis: [quoted(row[0])[0] for row in rows(text, f"axis: {axis}", "end of axis")]
                     for axis in AXES}
        self.refusals = [self._refusal(row)
                         for row in rows(text, "refusals", "end of refusals")]

    def _refusal(self, row):
        values = []
        for axis, column in zip(AXES, row):
            found = set(quoted(column))
            unknown = found - set(self.axes[axis])
            if unknown or bool(found) == (column == "any"):
                raise ValueError(f"doc/matrix.md: {column!r} in the table of refusals: expected any, "
                                 f"or values of the axis {axis}: {self.axes[axis]}")
            values.append(found or None)
        exit_code, words, why = row[len(AXES):]
        if not quoted(words):
            raise ValueError(f"doc/matrix.md: no words that a refusal must have: {row}")
        return Refusal(tuple(values), int(exit_code), quoted(words), why)

    def refusals_of(self, cell):
        return [refusal for refusal in self.refusals if refusal.fits(cell)]


def read_page(page=PAGE):
    return Page(page.read_text())


def quoted(text):
    return re.findall(r"`([^`]+)`", text)


def rows(text, begin, end):
    """Returns the cells of each row of a table between two comments, without the header."""
    table = text.split(f"<!-- {begin} -->", 1)[1].split(f"<!-- {end} -->", 1)[0]
    lines = [line for line in table.strip().splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]
