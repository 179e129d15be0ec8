# SPDX-License-Identifier: Apache-2.0
"""Chooses cells of a matrix that cover every combination of a few axes, to test N axes in few runs."""
import itertools
import random


def covering_cells(axes, strength=2, seed=0):
    """Returns cells, tuples of one value per axis. For any `strength` axes, every combination of their values occurs in
    some cell.

    axes      lists of values, at least `strength` of them
    strength  2: all pairs; 3: all triples; the number of axes: the whole matrix
    seed      selects other cells with the same property

    Greedy: each cell begins with a missing combination. For each of the other axes in turn, it takes the value that
    completes most missing combinations.
    """
    if not 1 <= strength <= len(axes):
        raise ValueError(f"strength {strength}: expected 1 to {len(axes)}, the number of axes")
    chance = random.Random(seed)
    missing = {columns: set(itertools.product(*(axes[c] for c in columns)))
               for columns in itertools.combinations(range(len(axes)), strength)}
    cells = []
    while any(missing.values()):
        columns = max(missing, key=lambda c: len(missing[c]))
        cell = dict(zip(columns, chance.choice(sorted(missing[columns]))))
        for axis in chance.sample(range(len(axes)), len(axes)):
            if axis not in cell:
                cell[axis] = _best_value(axes[axis], axis, cell, missing, chance)
        cells.append(tuple(cell[axis] for axis in range(len(axes))))
        for columns, combinations in missing.items():
            combinations.discard(tuple(cell[c] for c in columns))
    return cells


def _best_value(values, axis, cell, missing, chance):
    """Returns the value of an axis that, together with the values of a cell, completes most missing combinations."""
    def completed(value):
        filled = {**cell, axis: value}
        return sum(tuple(filled[c] for c in columns) in combinations
                   for columns, combinations in missing.items()
                   if axis in columns and all(c in filled for c in columns))
    # Among equally good values, one is chosen at random.
    return max(chance.sample(values, len(values)), key=completed)
