#!/usr/bin/python3
"""Tests that every program offers the common options that it obeys, and refuses the others.

usage: program_options_test.py FOLDER_OF_THE_PROGRAMS
"""
import pathlib
import re
import sys
import unittest

import small_field
from program_test_case import ProgramTestCase

BIN = None

COMMON = ("--threads", "--seed", "--strict", "--progress", "--verbose", "--quiet", "--json",
          "--allow-missing")
# A program has a common option only if the option has this effect:
#   --threads        the program has a thread pool, or passes the number to lfrenderer
#   --seed           sets poses and noise (lfsynth), the order of LF images, rebinned rays
#   --strict         a missing or broken LF image is an error
#   --progress       the work is long enough to be shown
#   --verbose        the program, or a library that it calls, has debugging messages
#   --quiet          the program has messages that are no warnings
#   --json           the program has a report
#   --allow-missing  the program may leave out requested LF images
OFFERED = {
    "lfcammvminfo": {"--json"},
    "lfcompressor": set(COMMON) - {"--seed"},
    "lfexample": {"--threads", "--verbose", "--quiet"},
    "lfimport": set(COMMON) - {"--seed"},
    "lfmerge": set(COMMON) - {"--seed", "--strict"},
    "lfpreprocessor": set(COMMON),
    "lfrenderer": set(COMMON),
    # --allow-missing follows the two dashes, because it is an option of lfrenderer.
    "lfsubmit": set(COMMON) - {"--seed", "--allow-missing"},
    "lfsynth": {"--threads", "--seed", "--progress", "--quiet"},
    "lfvisualizer": set(COMMON) - {"--strict", "--json"},
}
VALUES = {"--threads": ["1"], "--seed": ["1"], "--progress": ["none"], "--allow-missing": ["1"]}
# Calls whose only fault is that their files do not exist.
CALLS = {
    "lfcammvminfo": ["no.yaml"],
    "lfcompressor": ["no", "-o", "no.lfs"],
    "lfexample": ["no", "-o", "no.yaml"],
    "lfimport": ["no"],
    "lfmerge": ["no", "-o", "no"],
    "lfsubmit": ["no.lfp", "-o", "no"],
    "lfsynth": ["lights", "-o", "no"],
    "lfvisualizer": ["no", "no.yaml", "--text"],
}


class ProgramOptionsTest(ProgramTestCase):
    def program(self, name):
        return BIN / name

    def test_all_programs_are_listed(self):
        programs = {path.name for path in BIN.iterdir() if path.name.startswith("lf")}
        self.assertEqual(programs, set(OFFERED))

    def test_help_tells_the_options_that_have_an_effect(self):
        for name, offered in OFFERED.items():
            with self.subTest(program=name):
                text = self.succeeds(self.program(name), "--help")
                told = {option for option in COMMON
                        if re.search(rf"^ .*{option}(\W|$)", text.split("Examples:")[0], re.M)}
                self.assertEqual(told, offered)
                if "--progress" in offered:
                    self.assertRegex(re.sub(r"\s+", " ", text), r"--progress .* auto \(bar on")

    def test_others_are_refused_with_a_hint(self):
        for name, offered in OFFERED.items():
            for option in COMMON:
                if option in offered:
                    continue
                with self.subTest(program=name, option=option):
                    call = [*CALLS[name], option, *VALUES.get(option, [])]
                    result = self.call(self.program(name), *call)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn(f"Try '{name} --help'", result.stderr)
                    self.assertIn(option, result.stderr.splitlines()[-1])

    def calls(self):
        """Returns, for each program that prints more with -v, a call and a word of that output."""
        small_field.SIDE = 3
        field = small_field.write_field(self.folder / "field")
        path = small_field.write_path(self.folder, frames=2)
        out = self.folder
        yield "lfexample", [field, "-o", out / "example.yaml", "--focus", "1"], "transforms.json"
        yield "lfimport", [field], "transforms.json"
        yield "lfpreprocessor", [field, path, "-o", out / "packages", "--overwrite"], "octree"
        yield "lfrenderer", [field, path, "-o", out / "frames"], "instruction set"
        yield "lfrenderer", [field, path, "-o", out / "shards", "--shard", "1/1"], "memory: "
        yield "lfmerge", [out / "shards", "-o", out / "merged", "--overwrite"], "plates"
        yield "lfcompressor", [field, "-o", out / "a.lfs", "--overwrite"], "codec default"
        yield "lfsubmit", [out / "packages/package-0000.lfp", "-o", out / "film",
                           "--overwrite"], "--resume --progress json"
        yield "lfvisualizer", [field, path, "--text"], "transforms.json"

    def test_v_says_more(self):
        verbose = {name for name, offered in OFFERED.items() if "--verbose" in offered}
        called = set()
        for name, arguments, word in self.calls():
            with self.subTest(program=name):
                plain = self.call(self.program(name), *arguments)
                told = self.call(self.program(name), *arguments, "-v")
                self.assertEqual((plain.returncode, told.returncode), (0, 0), told.stderr)
                self.assertGreater(len(told.stderr.splitlines()), len(plain.stderr.splitlines()))
                self.assertIn(word, told.stderr)
                self.assertNotIn(word, plain.stderr)
                self.assertEqual(told.stdout.count("\n"), plain.stdout.count("\n"))
            called.add(name)
        self.assertEqual(called, verbose)

    def test_q_says_less(self):
        small_field.SIDE = 3
        field = small_field.write_field(self.folder / "field")
        path = small_field.write_path(self.folder, frames=2)
        for arguments in (["lfrenderer", field, path, "-o", self.folder / "frames"],
                          ["lfexample", field, "-o", self.folder / "example.yaml"],
                          ["lfsynth", "lights", "-o", self.folder / "lights", "--calibration-only"]):
            arguments[0] = self.program(arguments[0])
            plain, quiet = self.call(*arguments), self.call(*arguments, "-q")
            self.assertEqual((plain.returncode, quiet.returncode), (0, 0))
            self.assertNotEqual(plain.stderr, "")
            self.assertFalse([line for line in quiet.stderr.splitlines()
                              if not line.startswith("warning: ")], quiet.stderr)


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv[1])
    unittest.main(argv=sys.argv[:1], verbosity=2)
