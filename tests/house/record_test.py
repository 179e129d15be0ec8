#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how bench/record.py writes records of tables, and that all records in bench/results/ are written so.

usage: record_test.py REPOSITORY
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

REPOSITORY = pathlib.Path(sys.argv.pop()).resolve()
sys.path.insert(0, str(REPOSITORY / "bench"))

import record


class Records(unittest.TestCase):
    def test_each_row_and_command_has_a_line(self):
        rows = [{"way": "nearest", "seconds": [0.1234567891, 2], "report": {"rays": 123456789012, "kept": None}},
                {"way": "default", "seconds": [], "report": {}}]
        self.assertEqual(record.text_of(record.rounded({"load": 1.5, "rows": rows, "commands": ["lfsynth", "lfimport"],
                                                        "none": []})), """{
 "load": 1.5,
 "rows": [
  {"way": "nearest", "seconds": [0.1234568, 2], "report": {"rays": 123456789012, "kept": null}},
  {"way": "default", "seconds": [], "report": {}}
 ],
 "commands": ["lfsynth", "lfimport"],
 "none": []
}""")

    def test_rows_of_several_tables_have_a_line_each(self):
        row = {"profile": "thesis, 1 level, threshold 8, and so on", "ratio": 1.5}
        self.assertEqual(record.text_of({"rows": {"shop": [row, row], "beer": [row]}}).count("\n"), 8)

    def test_what_is_written_is_read_back(self):
        content = {"a": [1.5, "b", None, True, {"c": [[], {}, ["d"]]}], "e": {"f": {"g": "h" * 200}}}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "a.json")
            record.write_json(path, content)
            self.assertEqual(json.loads(path.read_text()), content)
            self.assertEqual([entry.name for entry in path.parent.iterdir()], ["a.json"])

    def test_the_hash_of_sources_survives_squashing_and_rebasing(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(
                record, "HERE", pathlib.Path(folder, "bench")):
            pathlib.Path(folder, "bench").mkdir()
            git = lambda *words: subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@example.org", *words],
                                                cwd=folder, check=True, capture_output=True)
            for name in ("doc/c.md", *("lf/a.cc" if pattern == "../lf" else f"bench/{pattern.replace('*', 'd')}"
                                       for pattern in record.SOURCES)):
                pathlib.Path(folder, name).parent.mkdir(parents=True, exist_ok=True)
                pathlib.Path(folder, name).write_text("1\n")
            git("init", "-q")
            git("add", ".")
            git("commit", "-q", "-m", "first")
            first = record.sources_of("HEAD")
            pathlib.Path(folder, "doc/c.md").write_text("2\n")
            self.assertEqual(record.present_sources(), first)  # a page is no source
            pathlib.Path(folder, "lf/a.cc").write_text("2\n")
            measured = record.present_sources()
            self.assertNotEqual(measured, first)
            self.assertEqual(record.sources_of("HEAD"), first)
            git("commit", "-q", "-a", "-m", "second")
            self.assertEqual(record.sources_of("HEAD"), measured)
            git("reset", "-q", "--soft", "HEAD~")
            git("commit", "-q", "--amend", "-m", "both")
            self.assertEqual(record.sources_of("HEAD"), measured)

    def test_all_records_are_written_so(self):
        paths = list((REPOSITORY / "bench/results").glob("*.json"))
        self.assertGreater(len(paths), 0)
        for path in paths:
            text = path.read_text()
            self.assertEqual(record.text_of(record.rounded(json.loads(text))) + "\n", text, path.name)


if __name__ == "__main__":
    unittest.main()
