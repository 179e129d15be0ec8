#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the chains of doc/matrix.md and their promises: one program reads what another wrote, and the result is
compared with the direct way.

usage: chain_test.py BIN [MODULE] [--all] [WORD...]
  BIN     folder of the programs
  MODULE  the file _core.*.so of the Python package, whose chains are tried
  --all   tries all light fields and paths with every writer and reader, not in turn
  WORD    only chains whose names have all words are tried
"""
import concurrent.futures
import os
import pathlib
import resource
import sys
import tempfile
import time
import traceback
import unittest

from chain_ends import faults_of_ends
from chain_page import read_chains
from chain_ways import THINGS, Ways, add_python, all_chains
from chain_world import Refused
from matrix_world import Difference

BIN, WORDS, STRENGTH, HAS_PYTHON = None, [], 2, False


def try_chain(ways, chain, promise):
    """Returns how a chain differs from its promise, or an empty text."""
    try:
        try:
            seen, said = ways.see(chain)
        except Refused as refused:
            if not promise.is_refusal:
                return str(refused)
            if refused.exit_code not in (2, 3) or not refused.last_line.startswith("error: "):
                return str(refused)
            missing = [word for word in promise.words if word not in refused.last_line]
            return f"{refused.last_line}: lacks {missing}" if missing else ""
        if promise.is_refusal:
            return "is not refused"
        if promise.is_warning:
            missing = [word for word in promise.words if word not in said]
            return f"the programs said {said.strip()!r}: lacks {missing}" if missing else ""
        return promise.fault_of(seen, ways.direct(chain))
    except Difference as difference:
        return str(difference)
    except Refused as refused:
        return f"the direct way: {refused}"
    except Exception:  # a fault of this test, or a program that does not end
        return " | ".join(traceback.format_exc().strip().splitlines()[-3:])


def chosen_chains(table):
    """Returns the chains of a run, and the rows of the table that are the first to fit no chain at all. Each row of the
    others is the first to fit one of the returned chains, unless words choose among them."""
    chains = list(all_chains(STRENGTH))
    untried = {id(row): row for row in table.rows} if HAS_PYTHON else {}
    for chain in chains:
        untried.pop(id(table.row_of(chain)), None)
    for chain in all_chains(3) if untried else []:
        if untried.pop(id(table.row_of(chain)), None):
            chains.append(chain)
    return [chain for chain in chains if all(word in chain.name for word in WORDS)], list(untried.values())


class ChainTest(unittest.TestCase):
    def test_chains(self):
        table = read_chains()
        chains, unused = chosen_chains(table)
        faults, times = [], []
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as threads:
            ways = Ways(BIN, folder)

            def try_one(chain):
                start = time.monotonic()
                row = table.row_of(chain)
                fault = "no row of the table fits it" if row is None else try_chain(ways, chain, row.promise)
                times.append((time.monotonic() - start, chain.name))
                return row, fault

            for chain, (row, fault) in zip(chains, threads.map(try_one, chains)):
                if fault:
                    faults.append(f"{chain.name}: {row and row.promise.text}: {fault}")
                    print(f"wrong: {faults[-1]}", file=sys.stderr, flush=True)
        if os.environ.get("LF_CHAIN_TIMES"):
            for seconds, name in sorted(times, reverse=True)[:30]:
                print(f"{seconds:6.2f} s {name}", file=sys.stderr)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"{len(chains)} chains: {len(faults)} are wrong; {spent.ru_utime + spent.ru_stime:.0f} s of CPU",
              file=sys.stderr)
        self.assertEqual(len(faults), 0, "wrong chains are listed above")
        self.assertEqual(unused, [], "rows that are the first to fit no chain")


class TableTest(unittest.TestCase):
    def test_the_table_names_only_what_is_tried(self):
        if not HAS_PYTHON:
            self.skipTest("the Python package was not built: its chains are not tried")
        axes = [set(values) for values in zip(*all_chains(3))]
        for row in read_chains().rows:
            for values, axis in zip(row.values, axes):
                self.assertLessEqual(values or set(), axis)

    def test_each_file_that_a_program_takes_is_the_end_of_a_chain(self):
        self.assertEqual(faults_of_ends(pathlib.Path(BIN), THINGS), [])


if __name__ == "__main__":
    BIN, *WORDS = sys.argv[1:]
    if WORDS and WORDS[0].endswith(".so"):
        sys.path.insert(0, str(pathlib.Path(WORDS.pop(0)).parent.parent))
        add_python()
        HAS_PYTHON = True
    if "--all" in WORDS:
        WORDS.remove("--all")
        STRENGTH = 3
    unittest.main(argv=sys.argv[:1], verbosity=2)
