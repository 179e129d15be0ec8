#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the judgements that programs make before they render, on drawn captures whose answers are known. No answer may
be wrong, and most must be right; the others are "not sure" (doc/judgements.md).

usage: judgements_test.py LFIMPORT LFEXAMPLE [--all] [--every] [--half=LETTERS] [TEST...]
    --all           also prints right answers
    --every         draws the kinds of C for D as well, and makes each mistake in each capture; takes 20 minutes
    --half=LETTERS  draws only the captures of these halves, such as --half=CD
"""
import json
import os
import shlex
import shutil
import sys
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import numpy as np

from judgements import agreement, alpha, alpha_later, alpha_unseen, focus, focus_later, focus_unseen, scenes
from judgements.captures import HALVES, NOT_SURE, RIGHT, WRONG, Answer, drawn, table
from pose_mistakes import MISTAKES, MORE_MISTAKES, write_mistake
from program_test_case import ProgramTestCase

IMPORT = EXAMPLE = None
ANSWERS = []
HALVES_ASKED = HALVES


def all_drawn(kinds, unseen, later):
    """Yields (name, half, seed, kind) of all kinds: those of A and B, of C, and the further ones of D."""
    for kinds_of, halves, first_seed in ((kinds, "AB", 0), (unseen, "C", 1000), (later, "D", 3000),
                                         (unseen if "--every" in sys.argv else [], "D", 2000)):
        for one in drawn(kinds_of, halves, first_seed):
            if one[1] in HALVES_ASKED:
                yield one


class JudgementsTest(ProgramTestCase):
    def expect(self, question, least_right):
        """No answer to the question is wrong, and this share of the answers is right, in each half."""
        answers = [one for one in ANSWERS if one.question == question]
        for one in answers:
            if one.verdict != RIGHT or "--all" in sys.argv:
                print(f"{one.verdict}: {question}, {one.name} {one.half}: {one.words}", file=sys.stderr)
        self.assertEqual([f"{one.name} {one.half}" for one in answers if one.verdict == WRONG], [])
        for half in HALVES:
            of_half = [one.verdict for one in answers if one.half == half]
            self.assertGreaterEqual(of_half.count(RIGHT), least_right[half] * len(of_half), half)

    def test_alpha(self):
        for name, half, seed, kind in all_drawn(alpha.KINDS, alpha_unseen.KINDS, alpha_later.KINDS):
            folder = self.folder / f"{seed}"
            answers = alpha.draw(folder, kind, seed)
            called = self.call(IMPORT, folder, "--json")
            self.assertEqual(called.returncode, 0, called.stderr)
            verdict = alpha.judge(json.loads(called.stdout), called.stderr, answers)
            words = f"{json.loads(called.stdout)['alpha']} {called.stderr.strip()}"
            ANSWERS.append(Answer("alpha", name, half, verdict, words))
        self.expect("alpha", {"A": 0.85, "B": 0.85, "C": 0.6, "D": 0.55})

    def test_focus_and_aperture(self):
        for name, half, seed, kind in all_drawn(focus.KINDS, focus_unseen.KINDS, focus_later.KINDS):
            folder, path = self.folder / f"{seed}", self.folder / f"{seed}.yaml"
            cameras, quads, depths = kind(np.random.default_rng(seed))
            scenes.draw(folder, cameras, quads, seed)
            called = self.call(EXAMPLE, folder, "-o", path, "--move", "static")
            if called.returncode == 3:  # the program refuses the capture, which is no answer
                for question in ("focus", "aperture"):
                    ANSWERS.append(Answer(question, name, half, NOT_SURE, called.stderr))
                continue
            self.assertEqual(called.returncode, 0, called.stderr)
            said = focus.Said.of(path.read_text(), called.stderr)
            if callable(depths):
                depths = depths(cameras[said.start])
            words = f"{called.stderr.strip()} (subject: {depths})"
            ANSWERS.append(Answer("focus", name, half, focus.judge_focus(said, depths, cameras), words))
            verdict, why = focus.judge_aperture(said, cameras, quads)
            ANSWERS.append(Answer("aperture", name, half, verdict, f"{why}: {words}"))
        for question in ("focus", "aperture"):
            with self.subTest(question):
                self.expect(question, {"A": 0.8, "B": 0.8, "C": 0.6, "D": 0.6})

    def explained_after_repair(self, report, tracks, mistake, size):
        """Makes the call that a warning prints. Returns the share of the places that are then explained."""
        warning = next(one for one in report["warnings"] if one["kind"] == "poses-disagree")
        words = shlex.split(warning["message"].rpartition("Repair the poses: ")[2])
        native = self.folder / "native"
        words[words.index("-o") + 1] = native
        called = self.call(IMPORT, *words[1:])
        self.assertEqual(called.returncode, 0, called.stderr)
        share = agreement.explained_share(native, tracks, mistake, size)
        shutil.rmtree(native)
        return share

    def test_agreement(self):
        for index, (name, half, seed, kind) in enumerate(all_drawn([], agreement.KINDS, agreement.LATER_KINDS)):
            source = self.folder / f"{seed}"
            cameras, quads, names = kind(np.random.default_rng(seed))
            size = cameras.lens.width, cameras.lens.height
            scenes.draw(source, cameras, quads, seed, names, cx=size[0] / 2, cy=size[1] / 2)
            tracks = agreement.tracks_of(source, quads, np.random.default_rng(seed))
            mistakes = [*MISTAKES, *MORE_MISTAKES] if "--every" in sys.argv else agreement.mistakes_for(index, 4)
            for mistake in mistakes:
                wrong = write_mistake(mistake, source, self.folder / "wrong")
                called = self.call(IMPORT, wrong, "--json")
                self.assertIn(called.returncode, (0, 3), called.stderr)
                report = json.loads(called.stdout) if called.returncode == 0 else None
                share = agreement.explained_share(wrong, tracks, mistake, size)
                repaired = None
                if report and report["agreement"]["repair"]:
                    repaired = self.explained_after_repair(report, tracks, mistake, size)
                verdict, why = agreement.judge(report, mistake, share, repaired)
                ANSWERS.append(Answer("agreement", f"{name}, {mistake}", half, verdict,
                                      f"{why}: {report['agreement'] if report else called.stderr.strip()}"))
                shutil.rmtree(wrong)
        self.expect("agreement", {"A": 0, "B": 0, "C": 0.55, "D": 0.55})


if __name__ == "__main__":
    IMPORT, EXAMPLE = sys.argv[1:3]
    tests = [word for word in sys.argv[3:] if not word.startswith("--")]
    HALVES_ASKED = next((word.split("=")[1] for word in sys.argv[3:] if word.startswith("--half=")), HALVES)
    result = unittest.main(argv=sys.argv[:1] + tests, verbosity=2, exit=False).result
    print("\n".join(table(ANSWERS)))
    sys.exit(not result.wasSuccessful())
