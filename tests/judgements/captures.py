# SPDX-License-Identifier: Apache-2.0
"""Captures that were drawn, with the answers that a judgement may give, and a table of the answers that it gave."""
import collections
import dataclasses
import json

RIGHT, NOT_SURE, WRONG = "right", "not sure", "wrong"
# Thresholds were chosen with captures of A, and changed after failures with captures of B. Kinds of C were drawn when
# the thresholds were fixed, and those of D while the faults that C had shown were mended. doc/judgements.md has the
# first, blind answers.
HALVES = "ABCD"


def pose(x, y, z=0.0, rotation=None):
    """Returns a transform_matrix of a camera, which looks along -z unless `rotation` (columns: right, up, back) says
    something else."""
    columns = rotation or [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return [[*(column[row] for column in columns), at] for row, at in enumerate((x, y, z))] + [[0, 0, 0, 1]]


def write_transforms(folder, frames, **keys):
    (folder / "transforms.json").write_text(json.dumps({**keys, "frames": frames}))


@dataclasses.dataclass
class Answer:
    """One capture and what was answered about it."""
    question: str  # such as alpha
    name: str
    half: str
    verdict: str  # RIGHT, NOT_SURE or WRONG
    words: str  # what the program said


def drawn(kinds, halves, first_seed):
    """Numbers kinds so that each is drawn once for each half. Yields (name, half, seed, kind)."""
    for index, kind in enumerate(kinds):
        for place, half in enumerate(halves):
            yield kind.__name__.replace("_", " "), half, first_seed + len(halves) * index + place, kind


def table(answers):
    """Returns Markdown rows: question, half, number of captures, and how many answers were right, not sure, wrong."""
    counts = collections.Counter((one.question, one.half, one.verdict) for one in answers)
    rows = ["| question | half | captures | right | not sure | wrong |", "| --- | --- | --- | --- | --- | --- |"]
    for question in dict.fromkeys(one.question for one in answers):
        for half in HALVES:
            of_half = [counts[question, half, verdict] for verdict in (RIGHT, NOT_SURE, WRONG)]
            if sum(of_half):
                rows.append(f"| {question} | {half} | {sum(of_half)} | " + " | ".join(map(str, of_half)) + " |")
    return rows
