#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how bench/record.py writes records of tables, and that all records in bench/results/ are written so.

usage: record_test.py REPOSITORY
"""
import json
import pathlib
import sys
import tempfile
import unittest

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

    def test_all_records_are_written_so(self):
        paths = list((REPOSITORY / "bench/results").glob("*.json"))
        self.assertGreater(len(paths), 0)
        for path in paths:
            text = path.read_text()
            self.assertEqual(record.text_of(record.rounded(json.loads(text))) + "\n", text, path.name)


if __name__ == "__main__":
    unittest.main()
