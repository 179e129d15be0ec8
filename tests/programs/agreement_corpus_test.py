#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A corpus of captures, right ones and ones with a usual mistake, of which lfimport must judge whether images and poses
belong together. An answer may be "not sure", but none may be wrong. The repairs that lfimport prints are applied, and
must make images and poses agree.

usage: agreement_corpus_test.py LFIMPORT LFSYNTH TEST_DATA [--all]
Without --all, every capture is judged as it is and with a third of the mistakes, such that each mistake is made in two
captures, at least one of them drawn. With --all, every mistake is made in every capture, and the table that is printed
is that of doc/judgements.md.
"""
import collections
import json
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

import pose_mistakes

PROGRAMS = DATA = None
ALL = False  # True: every mistake is made in every capture

# Drawn captures: options of lfsynth. The thresholds of the verdict were chosen with those of the first half.
CHOSEN = {
    "grid": "still-life --count 25",
    "arc": "still-life --capture band --count 24",
}
REPORTED = {
    "dense grid": "still-life --count 81",
    "jittered grid": "chart --count 25 --jitter 0.3",
    "dome": "still-life --capture hemisphere --count 150",
}
# All captures in which all mistakes can be made, real ones last. No two real ones are SECOND apart, in a circle.
CAPTURES = [*CHOSEN, *REPORTED, "templeRing", "beer"]
SECOND = 3
# Captures with hardly any texture, of which nothing can be told.
PLAIN = {"lights": "lights --count 25"}
PARALLEL = ("grid", "dense grid")
# Mistakes that leave a grid as it is: rotations that are their own inverses, and, with parallel cameras, the same shift
# of all principal points.
HARMLESS_ON_GRIDS = {"rotation-transposed", "colmap-rotation-transposed"}
INTRINSICS = {"focal-in-mm", "focal-of-width", "all-normalised", "focal-half", "focal-twice", "principal-point-swapped"}


def judged(folder, *options):
    """Returns the report of lfimport about a light field."""
    done = subprocess.run([PROGRAMS / "lfimport", folder, "--json", *options], capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"lfimport {folder}: {done.stderr}")
    return json.loads(done.stdout)


def mistakes_of(capture):
    """Returns the mistakes that are made in a capture."""
    if ALL:
        return list(pose_mistakes.MISTAKES)
    at = CAPTURES.index(capture)
    mistakes = [mistake for mistake in pose_mistakes.MISTAKES if mistake != "none"]
    return ["none", *(mistake for i, mistake in enumerate(mistakes)
                      if at in (i % len(CAPTURES), (i + SECOND) % len(CAPTURES)))]


def answer_to(agreement, is_right, mistake):
    """Returns "right", "not sure" or "wrong"."""
    verdict = agreement["verdict"]
    if verdict == "not-sure":
        return "not sure"
    if verdict == "agree" and (mistake in INTRINSICS and not agreement["tells_intrinsics"] or
                               mistake.startswith("names-") and not agreement["tells_order"]):
        return "not sure"  # the line says so
    return "right" if (verdict == "agree") == is_right else "wrong"


class AgreementCorpusTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.table = collections.defaultdict(collections.Counter)
        cls.repairs = collections.Counter()

    @classmethod
    def tearDownClass(cls):
        for capture, counts in cls.table.items():
            print(f"| {capture} | {counts['right']} | {counts['not sure']} | {counts['wrong']} |")
        print(f"repairs: {cls.repairs['applied']} applied, {cls.repairs['agree']} agree afterwards")

    def draw(self, name, options):
        folder = self.folder / name.replace(" ", "-")
        subprocess.run([PROGRAMS / "lfsynth", *options.split(), "-o", folder, "--format", "png", "--size", "320x240",
                        "-q"], check=True)
        return folder

    def repair(self, report, folder, name):
        """Makes the call that a warning prints, and checks that images and poses agree afterwards."""
        warning = next(one for one in report["warnings"] if one["kind"] == "poses-disagree")
        words = shlex.split(warning["message"].rpartition("Repair the poses: ")[2])
        self.assertEqual(pathlib.Path(words[0]).name, "lfimport", warning["message"])
        native = self.folder / "native"
        words[words.index("-o") + 1] = native
        done = subprocess.run([PROGRAMS / "lfimport", *words[1:]], capture_output=True, text=True)  # with --json
        self.assertEqual(done.returncode, 0, done.stderr)
        after = json.loads(done.stdout)["agreement"]
        self.assertTrue((native / "transforms.json").exists())
        shutil.rmtree(native)
        self.repairs["applied"] += 1
        self.repairs["agree"] += after["verdict"] == "agree"
        self.assertNotEqual(after["verdict"], "disagree", f"{name}: {after}")
        self.assertGreater(after["share"], report["agreement"]["share"] - 0.03, name)

    def try_mistakes(self, capture, source):
        for mistake in mistakes_of(capture):
            with self.subTest(capture=capture, mistake=mistake):
                place = pose_mistakes.write_mistake(mistake, source, self.folder / "wrong")
                try:
                    report = judged(place)
                    is_right = mistake == "none" or capture in PARALLEL and mistake in HARMLESS_ON_GRIDS
                    answer = answer_to(report["agreement"], is_right, mistake)
                    self.table[capture][answer] += 1
                    self.assertNotEqual(answer, "wrong", report["agreement"])
                    if mistake == "none":
                        self.assertEqual(answer, "right", report["agreement"])
                    if report["agreement"]["repair"]:
                        self.repair(report, place, f"{capture}, {mistake}")
                finally:
                    shutil.rmtree(place)

    def real(self, name):
        """Returns a real capture as a transforms.json; skips the test without it."""
        source = DATA / "data" / name
        if not source.exists():
            self.skipTest(f"{source} is not here")
        folder = self.folder / pathlib.Path(name).name
        subprocess.run([PROGRAMS / "lfimport", source, "-o", folder, "-q"], check=True, capture_output=True)
        return folder

    def test_drawn_captures_that_thresholds_were_chosen_with(self):
        for capture, options in CHOSEN.items():
            self.try_mistakes(capture, self.draw(capture, options))

    def test_other_drawn_captures(self):
        for capture, options in REPORTED.items():
            self.try_mistakes(capture, self.draw(capture, options))

    def test_plain_captures_are_not_judged(self):
        for capture, options in PLAIN.items():
            source = self.draw(capture, options)
            for mistake in ("none", "opencv-axes", "mirrored", "names-reversed"):
                place = pose_mistakes.write_mistake(mistake, source, self.folder / "wrong")
                answer = answer_to(judged(place)["agreement"], mistake == "none", mistake)
                shutil.rmtree(place)
                self.table[capture][answer] += 1
                self.assertNotEqual(answer, "wrong", mistake)

    def test_a_ring_of_a_gantry(self):
        self.try_mistakes("templeRing", self.real("middlebury-templeRing/templeRing"))

    def test_each_mistake_in_a_colmap_capture_is_named_and_repaired(self):
        source = self.real("beer-colmap")
        self.try_mistakes("beer", source)
        self.assertEqual(self.table["beer"], {"right": len(mistakes_of("beer"))})

    def test_every_mistake_is_made_in_a_drawn_capture_and_in_another(self):
        made = collections.defaultdict(set)
        for capture in CAPTURES:
            for mistake in mistakes_of(capture):
                made[mistake].add(capture)
        self.assertEqual(set(made), set(pose_mistakes.MISTAKES))
        for mistake, captures in made.items():
            self.assertGreaterEqual(len(captures), 2, mistake)
            self.assertTrue(captures & {*CHOSEN, *REPORTED}, mistake)

    def test_flipped_axes_of_a_grid_are_named_and_repaired(self):
        source = DATA / "data" / "stanford-cards-9x9"
        if not source.exists():
            self.skipTest(f"{source} is not here")
        geometry = ("--pitch", "1", "--focal-px", "768", "--plane-distance", "100")
        self.assertEqual(judged(source, *geometry)["agreement"]["verdict"], "agree")
        for flip in "--flip-x", "--flip-y":
            flipped = judged(source, *geometry, flip)["agreement"]
            self.assertEqual(flipped["verdict"], "disagree", flipped)
            # Rectified images do not tell which axis was flipped: mirror-x and mirror-y differ by a scene whose depth
            # is reversed about the plane without parallax. The line names both.
            self.assertEqual(flipped["repair"]["words"], "mirror-y")
            self.assertIn("or mirror-x", flipped["repair"]["supposes"])
            for words in "mirror-x", "mirror-y":
                again = judged(source, *geometry, flip, "--repair", words)["agreement"]
                self.assertEqual(again["verdict"], "agree", again)


if __name__ == "__main__":
    PROGRAMS, DATA = pathlib.Path(sys.argv[1]).resolve().parent, pathlib.Path(sys.argv[3]).resolve()
    ALL = "--all" in sys.argv[4:]
    unittest.main(argv=sys.argv[:1])
