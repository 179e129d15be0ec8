#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the matrix of doc/matrix.md, every mode in every way, and reports the wrong cells.

scripts/matrix.py BIN -o matrix.json             renders all cells, in a shuffled order
scripts/matrix.py BIN -o matrix.json --resume    resumes after an interruption
scripts/matrix.py BIN --strength 3               renders cells that cover all combinations of any three axes
scripts/matrix.py BIN --cell rgb/folder/whole/rebin/killed --keep /tmp/cell
scripts/matrix.py --again matrix.json --write doc/matrix.md

BIN is the folder of the programs. The exit code is 3 if a cell is wrong.
"""
import argparse
import collections
import hashlib
import itertools
import json
import os
import pathlib
import random
import shlex
import signal
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "tests"))
import run_test

run_test.add_rooms()

import defaults
import record
from covering_cells import covering_cells
from matrix_page import AXES, Cell, read_page
from matrix_run import Outcome, try_cells
from matrix_ways import VALUES, Matrix


def parse():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", nargs="?", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="JSON")
    parser.add_argument("--resume", action="store_true", help="go on with the cells in JSON")
    parser.add_argument("--strength", type=int, metavar="N",
                        help="only cells in which any N axes have every combination")
    parser.add_argument("--most", type=int, metavar="N", help="only so many cells of the order")
    parser.add_argument("--at-once", type=int, default=os.cpu_count(), metavar="N")
    parser.add_argument("--cell", action="append", default=[], metavar="F/I/C/M/R")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="keep films and frames here")
    for axis in AXES:
        parser.add_argument(f"--{axis}", action="append", choices=VALUES[axis])
    record.add_options(parser)
    options = parser.parse_args()
    if not options.again and not options.bin:
        parser.error("BIN or --again JSON is needed")
    return options


def cells_of(options):
    if options.cell:
        return [Cell(*name.split("/")) for name in options.cell]
    axes = [getattr(options, axis) or list(VALUES[axis]) for axis in AXES]
    if options.strength and options.strength < len(axes):
        cells = covering_cells(axes, options.strength)
    else:
        cells = list(itertools.product(*axes))
        random.Random(0).shuffle(cells)
    return [Cell(*cell) for cell in cells[:options.most]]


def begun(options, result):
    """Returns the outcomes in the file that a call with --resume continues; an empty list for other calls."""
    if not options.resume or not options.output or not options.output.exists():
        return []
    old = json.loads(options.output.read_text())
    if (old.get("sources"), old["page"]) != (result["sources"], result["page"]):
        sys.exit(f"error: {options.output}: is of other sources ({old.get('sources')}), or of another page: leave "
                 "--resume out")
    return [Outcome(Cell(*cell), *rest) for cell, *rest in old["outcomes"]]


def save(path, result, outcomes):
    if not path:
        return
    result = {**result, "outcomes": [[*outcome] for outcome in outcomes]}
    part = path.with_suffix(".part")
    part.write_text(json.dumps(result, indent=None, separators=(",", ":")))
    part.replace(path)


def tell(done, total, kinds, start_s, tried):
    left_s = (time.monotonic() - start_s) / max(tried, 1) * (total - done)
    text = (f"{done} of {total} cells: {kinds['same']} same, {kinds['refused']} refused, "
            f"{kinds['wrong']} wrong; {left_s / 60:.0f} min left")
    print(text, end="\r" if sys.stderr.isatty() else "\n", file=sys.stderr)


def run(options):
    cells = cells_of(options)
    defaults_today = defaults.of_programs([options.bin.resolve() / name for name in defaults.PROGRAMS])
    # Cells call programs with thousands of different options, so the record names only the call of this script.
    result = {**record.context(), "cells": len(cells), "page": hash_of_page(),
              "commands": [shlex.join(map(record.shown, sys.argv))], "defaults": defaults_today,
              "defaults_hash": defaults.hash_of(defaults_today)}
    outcomes = begun(options, result)
    known = {outcome.cell for outcome in outcomes}
    todo = [cell for cell in cells if cell not in known]
    kinds = collections.Counter(outcome.kind for outcome in outcomes)
    stop = []
    signal.signal(signal.SIGINT, lambda *_: stop.append(True))
    start_s = told_s = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        matrix = Matrix(options.bin, options.keep or temporary)
        for outcome in try_cells(matrix, read_page(), todo, options.at_once, lambda: bool(stop)):
            outcomes.append(outcome)
            kinds[outcome.kind] += 1
            if outcome.kind == "wrong":
                print(f"wrong: {outcome.cell.name}: {outcome.detail}", file=sys.stderr)
            if time.monotonic() > told_s + 10:
                told_s = time.monotonic()
                tell(len(outcomes), len(cells), kinds, start_s, len(outcomes) - len(known))
                save(options.output, result, outcomes)
    save(options.output, result, outcomes)
    return {**result, "outcomes": [[*outcome] for outcome in outcomes]}


def hash_of_page():
    """Returns a hash of the text that decides which cells exist and how they must end."""
    page = read_page()
    text = repr((page.axes, [(r.values and [v and sorted(v) for v in r.values], *r[1:]) for r in
                 page.refusals]))
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def summary(result):
    outcomes = [Outcome(Cell(*cell), *rest) for cell, *rest in result["outcomes"]]
    kinds = collections.Counter(outcome.kind for outcome in outcomes)
    lines = [record.sentence(result), "",
             f"{len(outcomes)} of {result['cells']} cells: {kinds['same']} have the same bits, "
             f"{kinds['refused']} are refused, {kinds['wrong']} are wrong.", "",
             "| refused because | cells |", "| --- | --- |"]
    reasons = collections.Counter(o.detail for o in outcomes if o.kind == "refused")
    lines += [f"| {why} | {count} |" for why, count in reasons.most_common()]
    for axis in AXES:
        lines += ["", f"| {axis} | same bits | refused | wrong |", "| --- | --- | --- | --- |"]
        for value in VALUES[axis]:
            of_value = collections.Counter(o.kind for o in outcomes if getattr(o.cell, axis) == value)
            lines.append(f"| {value} | {of_value['same']} | {of_value['refused']} | "
                         f"{of_value['wrong']} |")
    wrong = sorted((o for o in outcomes if o.kind == "wrong"), key=lambda o: (o.detail, o.cell))
    if wrong:
        lines += ["", "| wrong | what |", "| --- | --- |"]
        lines += [f"| {o.cell.name} | {o.detail.splitlines()[-1]} |" for o in wrong]
    return "\n".join(lines) + "\n"


def main():
    options = parse()
    result = json.loads(options.again.read_text()) if options.again else run(options)
    of_all = {key: value for key, value in result.items() if key != "outcomes"}
    of_all["made_by"] = result["commands"][0]
    record.publish(options, "scripts/matrix.py", of_all, summary(result))
    return 3 if any(outcome[1] == "wrong" for outcome in result["outcomes"]) else 0


if __name__ == "__main__":
    sys.exit(main())
