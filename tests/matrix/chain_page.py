# SPDX-License-Identifier: Apache-2.0
"""Reads the chains of doc/matrix.md: what one program writes and another reads, and what is promised of the result."""
import re
from typing import NamedTuple

import numpy as np

from matrix_page import PAGE, quoted, rows

COLUMNS = ("what", "written by", "read by", "with")


class Chain(NamedTuple):
    what: str    # such as "light field"
    writer: str
    reader: str
    flaws: str   # light field or path with which it is tried

    @property
    def name(self):
        return f"{self.what}: {self.writer} -> {self.reader}, {self.flaws}"


class Promise:
    """A promise of the table, such as "same bits", ">= 40 dB, light to 0.1 %", or "refused: `words`"."""

    def __init__(self, text):
        self.text, self.words = text, quoted(text)
        self.decibels = self._number(r"≥ ([\d.]+) dB")
        self.light_percent = self._number(r"light to ([\d.]+) %")
        self.values_percent = self._number(r"values to ([\d.e-]+) %")
        self.is_bits = text == "same bits"
        self.is_refusal, self.is_warning = text.startswith("refused: "), text.startswith("warned: ")
        kinds = [self.is_bits, self.is_refusal, self.is_warning, self.values_percent is not None,
                 (self.decibels or self.light_percent) is not None]
        if sum(kinds) != 1 or (self.is_refusal or self.is_warning) != bool(self.words):
            raise ValueError(f"doc/matrix.md: {text!r}: expected 'same bits', '≥ N dB', 'light to N %', "
                             "'values to N %', or 'refused: ' or 'warned: ' and words in backquotes")

    def _number(self, pattern):
        found = re.search(pattern, self.text)
        return float(found[1]) if found else None

    def fault_of(self, seen, direct):
        """Returns how a result differs from the direct way more than is promised, or an empty text."""
        if self.is_bits:
            return fault_of_bits(seen, direct)
        if self.values_percent is not None:
            return fault_of_values(seen, direct, self.values_percent)
        return fault_of_light(seen, direct, self.decibels, self.light_percent)


class Row(NamedTuple):
    values: tuple  # a set of values for each of COLUMNS, or None: any value
    promise: Promise

    def fits(self, chain):
        return all(values is None or value in values for values, value in zip(self.values, chain))


class Chains:
    """The table of the page. The first row that fits a chain has its promise."""

    def __init__(self, text):
        self.rows = []
        groups = {word: set(quoted(names)) for word, names in rows(text, "chain groups", "end of chain groups")}
        for cells in rows(text, "chains", "end of chains"):
            values = [None if cell == "any" else set(quoted(cell)) or groups.get(cell, {cell})
                      for cell in cells[:len(COLUMNS)]]
            self.rows.append(Row(tuple(values), Promise(cells[len(COLUMNS)])))

    def row_of(self, chain):
        return next((row for row in self.rows if row.fits(chain)), None)


def read_chains(page=PAGE):
    return Chains(page.read_text())


def fault_of_bits(seen, direct):
    if set(seen) != set(direct):
        return f"other names: {sorted(set(seen) ^ set(direct))[:6]}"
    for name, value in seen.items():
        if isinstance(value, np.ndarray):
            if value.shape != direct[name].shape:
                return f"{name}: {value.shape}, not {direct[name].shape}"
            if not np.array_equal(value, direct[name], equal_nan=value.dtype.kind == "f"):
                return f"{name}: {np.mean(value != direct[name]):.1%} of the values differ"
        elif value != direct[name]:
            return f"{name}: {value!r}, not {direct[name]!r}"
    return ""


def fault_of_values(seen, direct, percent):
    """Compares all numbers that the direct way shows. Texts are not compared."""
    for name, value in direct.items():
        if isinstance(value, str) or value is None:
            continue
        if name not in seen:
            return f"{name} is missing"
        ours, theirs = np.asarray(seen[name], float), np.asarray(value, float)
        if ours.shape != theirs.shape:
            return f"{name}: {ours.shape}, not {theirs.shape}"
        finite = np.isfinite(theirs)
        if not np.array_equal(finite, np.isfinite(ours)):
            return f"{name}: other values are finite"
        most = np.max(np.abs(theirs[finite]), initial=0)
        off = np.max(np.abs(ours - theirs)[finite], initial=0)
        if off > percent / 100 * most + 1e-12:
            return f"{name}: off by {off:.3g} of {most:.3g}"
    return ""


def recorded_light(seen, direct, frame):
    """Returns the light of a frame where both ways have recorded it: two arrays [place][R, G, B]."""
    recorded = True
    for ways in (seen, direct):
        light = np.dstack([ways[f"{frame}.{channel}"] for channel in "RGB"]).astype(float)
        has_rays = ways.get(f"{frame}.coverage", np.ones(light.shape[:2])) > 0.5
        recorded = recorded & (has_rays | (ways.get(f"{frame}.interpolated", np.zeros(light.shape[:2])) > 0))
        recorded = recorded & np.isfinite(light).all(2)
    return tuple(np.dstack([ways[f"{frame}.{channel}"] for channel in "RGB"]).astype(float)[recorded]
                 for ways in (seen, direct))


def fault_of_light(seen, direct, decibels, percent):
    for name, value in direct.items():
        if isinstance(value, (int, float)) and seen.get(name) != value:
            return f"{name}: {seen.get(name)}, not {value}"
    frames = sorted(name[:-2] for name in direct if name.endswith(".R"))
    if not frames:
        return "the direct way shows no light"
    for frame in frames:
        if f"{frame}.R" not in seen or seen[f"{frame}.R"].shape != direct[f"{frame}.R"].shape:
            return f"{frame}: is missing or has another size"
        ours, theirs = recorded_light(seen, direct, frame)
        if len(ours) < 0.25 * direct[f"{frame}.R"].size:
            return f"{frame}: only {len(ours)} of {direct[f'{frame}.R'].size} elements have been recorded in both"
        error = np.mean((ours - theirs) ** 2) / np.max(theirs) ** 2
        found = -10 * np.log10(max(error, 1e-12))
        if decibels is not None and found < decibels:
            return f"{frame}: {found:.1f} dB; mean light {ours.mean():.4f}, not {theirs.mean():.4f}"
        if percent is not None and abs(ours.mean() / theirs.mean() - 1) > percent / 100:
            return f"{frame}: mean light {ours.mean():.5f}, not {theirs.mean():.5f}"
    return ""
