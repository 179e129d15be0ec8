#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the judgements that programs make before they render, on drawn captures whose answers are known. No answer may
be wrong, and most must be right; the others are "not sure" (doc/judgements.md).

usage: judgements_test.py LFIMPORT LFEXAMPLE [--all] [TEST...]     --all also prints right answers
"""
import json
import os
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import numpy as np

from judgements import alpha, focus, scenes
from judgements.captures import RIGHT, WRONG, Answer, halves, table
from program_test_case import ProgramTestCase

IMPORT = EXAMPLE = None
ANSWERS = []


class JudgementsTest(ProgramTestCase):
    def expect(self, question, least_right):
        """No answer to the question is wrong, and this share of the answers is right, in either half."""
        answers = [one for one in ANSWERS if one.question == question]
        for one in answers:
            if one.verdict != RIGHT or "--all" in sys.argv:
                print(f"{one.verdict}: {question}, {one.name} {one.half}: {one.words}", file=sys.stderr)
        self.assertEqual([f"{one.name} {one.half}" for one in answers if one.verdict == WRONG], [])
        for half in "AB":
            of_half = [one.verdict for one in answers if one.half == half]
            self.assertGreaterEqual(of_half.count(RIGHT), least_right * len(of_half), half)

    def test_alpha(self):
        for name, half, seed, kind in halves((kind.__name__.replace("_", " "), kind) for kind in alpha.KINDS):
            folder = self.folder / f"{seed}"
            answers = alpha.draw(folder, kind, seed)
            called = self.call(IMPORT, folder, "--json")
            self.assertEqual(called.returncode, 0, called.stderr)
            verdict = alpha.judge(json.loads(called.stdout), called.stderr, answers)
            ANSWERS.append(Answer("alpha", name, half, verdict, called.stderr.strip()))
        self.expect("alpha", 0.85)

    def test_focus_and_aperture(self):
        for name, half, seed, kind in halves((kind.__name__.replace("_", " "), kind) for kind in focus.KINDS):
            folder, path = self.folder / f"{seed}", self.folder / f"{seed}.yaml"
            cameras, quads, depths = kind(np.random.default_rng(seed))
            scenes.draw(folder, cameras, quads, seed, grain=6 if kind is focus.grainy else 1)
            called = self.call(EXAMPLE, folder, "-o", path, "--move", "static")
            self.assertEqual(called.returncode, 0, called.stderr)
            said = focus.Said.of(path.read_text(), called.stderr)
            words = f"{called.stderr.strip()} (subject: {depths})"
            ANSWERS.append(Answer("focus", name, half, focus.judge_focus(said, depths), words))
            verdict, why = focus.judge_aperture(said, cameras, quads)
            ANSWERS.append(Answer("aperture", name, half, verdict, f"{why}: {words}"))
        for question in ("focus", "aperture"):
            with self.subTest(question):
                self.expect(question, 0.8)


if __name__ == "__main__":
    IMPORT, EXAMPLE = sys.argv[1:3]
    tests = [word for word in sys.argv[3:] if word != "--all"]
    result = unittest.main(argv=sys.argv[:1] + tests, verbosity=2, exit=False).result
    print("\n".join(table(ANSWERS)))
    sys.exit(not result.wasSuccessful())
