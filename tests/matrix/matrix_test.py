#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every mode rendered in every way gives the bits of the plain render, or the refusal of doc/matrix.md. The
cells cover all pairs of values of different axes; scripts/matrix.py tests the whole matrix.

usage: matrix_test.py BIN   (the folder of lfrenderer, lfpreprocessor, lfcompressor, lfmerge, lfsubmit)
"""
import itertools
import random
import resource
import sys
import tempfile
import unittest

from covering_cells import covering_cells
from matrix_page import AXES, Cell, Page, Refusal, read_page
from matrix_run import try_cells
from matrix_ways import VALUES, Matrix

BIN = None


class CoveringCellsTest(unittest.TestCase):
    def test_any_axes_have_every_combination(self):
        chance = random.Random(1)
        for strength in (1, 2, 3):
            for _ in range(20):
                axes = [[f"{axis}{i}" for i in range(chance.randint(1, 6))]
                        for axis in range(chance.randint(strength, 5))]
                cells = covering_cells(axes, strength)
                self.assertTrue(all(value in axis for cell in cells
                                    for value, axis in zip(cell, axes)))
                for columns in itertools.combinations(range(len(axes)), strength):
                    found = {tuple(cell[c] for c in columns) for cell in cells}
                    expected = set(itertools.product(*(axes[c] for c in columns)))
                    self.assertEqual(found, expected)

    def test_they_are_few_and_always_those(self):
        axes = [list(range(n)) for n in (4, 7, 6, 9, 11)]
        cells = covering_cells(axes)
        self.assertEqual(cells, covering_cells(axes))
        self.assertNotEqual(cells, covering_cells(axes, seed=1))
        self.assertLessEqual(len(cells), 9 * 11 * 1.25)  # 99 is the least possible number
        self.assertEqual(sorted(covering_cells([[1, 2], [3], [4, 5]], 3)),
                         [(1, 3, 4), (1, 3, 5), (2, 3, 4), (2, 3, 5)])
        with self.assertRaises(ValueError):
            covering_cells([[1], [2]], 3)


class PageTest(unittest.TestCase):
    def test_the_page_has_the_axes_of_the_test(self):
        axes = read_page().axes
        for axis in AXES:
            self.assertEqual(axes[axis], list(VALUES[axis]), axis)

    def test_every_row_refuses_some_cells_and_none_refuses_plain_renders(self):
        page = read_page()
        self.assertTrue(page.refusals)
        for refusal in page.refusals:
            cells = [cell for cell in map(Cell._make, itertools.product(*VALUES.values()))
                     if refusal.fits(cell)]
            self.assertTrue(0 < len(cells) < len(list(itertools.product(*VALUES.values()))) / 2)
            self.assertIn(refusal.exit_code, (2, 3))

    def test_a_row_is_read_and_unknown_values_are_errors(self):
        text = "".join(f"<!-- axis: {axis} -->\n|a|b|\n|-|-|\n|`{axis}1`|x|\n|`{axis}2`|x|\n"
                       "<!-- end of axis -->\n" for axis in AXES)
        row = "| any | `input1`, `input2` | any | `mode2` | any | 2 | `--a b`, `c` | so |\n"
        table = "<!-- refusals -->\n|h|\n|-|\n{}<!-- end of refusals -->"
        refusal, = Page(text + table.format(row)).refusals
        self.assertTrue(refusal.fits(Cell("field1", "input2", "cut1", "mode2", "run1")))
        self.assertFalse(refusal.fits(Cell("field1", "input2", "cut1", "mode1", "run1")))
        self.assertEqual((refusal.exit_code, refusal.words, refusal.why), (2, ["--a b", "c"], "so"))
        for wrong in (row.replace("`mode2`", "`mode3`"), row.replace("`mode2`", "mode2"),
                      row.replace("`--a b`, `c`", "")):
            with self.assertRaises(ValueError):
                Page(text + table.format(wrong))

    def test_what_a_refusal_lacks_is_told(self):
        refusal = Refusal((None,) * len(AXES), 2, ["--shard", "leave out"], "")
        self.assertEqual(refusal.misses(2, "error: --shard: leave out --mode"), "")
        for exit_code, line, words in ((0, "error: --shard: leave out", "exit code 0"),
                                       (1, "error: --shard: leave out", "exit code 1"),
                                       (2, "warning: --shard: leave out", "error: "),
                                       (2, "error: --shard", "'leave out'")):
            self.assertIn(words, refusal.misses(exit_code, line))


class MatrixTest(unittest.TestCase):
    def test_pairs(self):
        page = read_page()
        cells = list(map(Cell._make, covering_cells(list(VALUES.values()))))
        wrong, kinds = [], {"same": 0, "refused": 0, "wrong": 0}
        with tempfile.TemporaryDirectory() as folder:
            matrix = Matrix(BIN, folder)
            for outcome in try_cells(matrix, page, cells):
                kinds[outcome.kind] += 1
                if outcome.kind == "wrong":
                    wrong.append(f"{outcome.cell.name}: {outcome.detail}")
                    print(f"wrong: {wrong[-1]}", file=sys.stderr, flush=True)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"{len(cells)} cells: {kinds['same']} have the same bits, {kinds['refused']} are "
              f"refused, {kinds['wrong']} are wrong; {spent.ru_utime + spent.ru_stime:.0f} s of CPU",
              file=sys.stderr)
        self.assertEqual(len(wrong), 0, "wrong cells are listed above")
        self.assertGreater(kinds["same"], len(cells) / 2)
        self.assertGreater(matrix.early_count, 0)


if __name__ == "__main__":
    BIN = sys.argv[1]
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
