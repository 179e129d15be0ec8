# SPDX-License-Identifier: Apache-2.0
"""Runs cells of the matrix (doc/matrix.md), a few at a time, and collects their outcomes."""
import concurrent.futures
import time
import traceback
from typing import NamedTuple

from matrix_page import Cell
from matrix_world import Difference


class Outcome(NamedTuple):
    cell: Cell
    kind: str    # same, refused, wrong
    detail: str  # why a cell was refused, or its fault
    seconds: float


def try_cell(matrix, page, cell):
    start = time.monotonic()
    refusals = page.refusals_of(cell)
    try:
        kind = matrix.check(cell, refusals)
        detail = refusals[0].why if refusals else ""
    except Difference as difference:
        kind, detail = "wrong", str(difference)
    except Exception:  # a fault of this test, or a program that does not end
        kind, detail = "wrong", traceback.format_exc().strip()
    return Outcome(cell, kind, detail, time.monotonic() - start)


def try_cells(matrix, page, cells, at_once=2, should_end=lambda: False):
    """Yields an outcome for each cell as soon as it ends."""
    with concurrent.futures.ThreadPoolExecutor(at_once) as threads:
        waiting, cells = set(), iter(cells)
        while True:
            while len(waiting) < 2 * at_once and not should_end():
                cell = next(cells, None)
                if cell is None:
                    break
                waiting.add(threads.submit(try_cell, matrix, page, cell))
            if not waiting:
                return
            done, waiting = concurrent.futures.wait(
                waiting, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in done:
                yield future.result()
