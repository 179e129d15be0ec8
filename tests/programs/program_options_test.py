#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every program offers the common options that it obeys and refuses the others, and that its help can be
scanned.

usage: program_options_test.py FOLDER_OF_THE_PROGRAMS
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import unittest

import defaults
import message_rules
import small_field
import source_messages
from common_options import COMMON, OFFERED
from program_test_case import ProgramTestCase

BIN = None
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]

VALUES = {"--threads": ["1"], "--seed": ["1"], "--progress": ["none"], "--allow-missing": ["1"]}
# Calls whose only fault is that their files do not exist.
CALLS = {
    "lfcammvminfo": ["no.yaml"],
    "lfpath": ["no.yaml"],
    "lfcompare": ["no.png", "no.png"],
    "lfcompressor": ["no", "-o", "no.lfs"],
    "lfdensify": ["no", "-o", "no.lfs"],
    "lfexample": ["no", "-o", "no.yaml"],
    "lffocus": [],
    "lffocus stack": ["no", "no.yaml", "-o", "no"],
    "lffocus epi": ["no", "--row", "1"],
    "lffocus views": ["no", "--grid", "2x2", "-o", "no"],
    "lffocus depth": ["no", "no.yaml", "-o", "no.exr"],
    "lffocus sharp": ["no", "no.yaml", "-o", "no.exr"],
    "lffocus through": ["no", "no.yaml", "-o", "no.exr"],
    "lfimport": ["no"],
    "lfmerge": ["no", "-o", "no"],
    "lfquilt": ["no.png", "-o", "no.png", "--views", "1x1"],
    "lfsubmit": ["no.lfp", "-o", "no"],
    "lfr": [],
    "lfsynth": ["lights", "-o", "no"],
    "lfvisualizer": ["no", "no.yaml", "--text"],
}


GROUPS = ("Input", "Output", "Picture", "Quality", "Running")
# Matches the line of an option: "  -o, --output DIR    Folder of the frames (all)".
SCANNED = re.compile(r"^  (?:-\w, )?(?P<name>--[\w-]+)(?: (?! ).*?)?  +[A-Za-z].*?(?: \((?P<default>[^()]*)\))?$")
# Values in bench/defaults.txt in whose place --help may show what they mean.
MEANS_SOMETHING = {"0", "-1", "[]"}


def option_lines(text):
    """Returns the lines of options, which begin with two spaces and a dash."""
    return [line for line in text.splitlines() if re.match(r"  -", line)]


def options_in(text):
    """Returns the long names of the options in a help."""
    return [re.search(r"--[\w-]+", line)[0] for line in option_lines(text)]


def hint(count):
    """Returns the last line that --help must have if --help-all shows `count` more options."""
    if count == 0:
        return "--help-all shows the details."
    return f"--help-all shows {count} more option{'s' if count > 1 else ''} and the details."


class ProgramOptionsTest(ProgramTestCase):
    def call(self, name, *arguments):
        """Calls a program, or a command of one, such as "lffocus stack"."""
        program, *command = name.split()
        return super().call(BIN / program, *command, *arguments)

    def test_an_empty_name_is_told_with_its_argument(self):
        for words, name in ((["lfrenderer", "", "p.yaml", "-o", "x"], "INPUT"),
                            (["lfimport", "", "-o", "x"], "LIGHTFIELD"),
                            (["lfsubmit", "", "-o", "x"], "PACKAGES"), (["lffocus epi", ""], "LIGHTFIELD"),
                            (["lfsubmit", "--run-package", "0"], "--run-package NUMBER DIR")):
            done = self.call(*words)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"error: {name}: expected a value", done.stderr)

    def test_an_unknown_option_is_told_with_the_nearest(self):
        for name, words, told in (("lfrenderer", ["a", "b", "-o", "c", "--formt", "png"], "--formt"),
                                  ("lfrenderer", ["--formt=png"], "--formt"),
                                  ("lfrenderer", ["a", "b", "-o", "c", "-format", "png"], "-format")):
            last = self.call(name, *words).stderr.splitlines()[-1]
            self.assertEqual(last, f"error: {told}: unknown option; did you mean --format?")
        for name in OFFERED:
            with self.subTest(program=name):
                done = self.call(name, *CALLS.get(name, ["no", "no", "-o", "no"]), "--hlep")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stderr.splitlines()[-1], "error: --hlep: unknown option; did you mean --help?")
                last = self.call(name, *CALLS.get(name, ["no", "no", "-o", "no"]), "--xyzzyxyzzy").stderr
                self.assertEqual(last.splitlines()[-1], "error: --xyzzyxyzzy: unknown option")

    def test_minus_zero_is_a_number(self):
        for words in (["-0", "1", "2"], ["1", "-0.0", "2"], ["-.5", "-0", "-1e-3"], ["-0e0", "-1.", "0"]):
            last = self.call("lfrenderer", "no", "no", "-o", "no", "--slab-position", *words).stderr
            self.assertIn("no: no such file", last.splitlines()[-1])
        for words in (["--max-images", "-0"], ["--max-images=-0"], ["--beta", "-0.0"]):
            last = self.call("lfrenderer", "no", "no", "-o", "no", *words).stderr
            self.assertIn("no: no such file", last.splitlines()[-1])

    def call_with_closed_pipe(self, name, *words, ignored=False):
        """Calls a program whose output nobody reads. Returns its status and what it says."""
        read, write = os.pipe()
        os.close(read)
        program, *command = name.split()
        try:
            done = subprocess.run([BIN / program, *command, *words], stdout=write, stderr=subprocess.PIPE, text=True,
                                  restore_signals=not ignored, timeout=100)
        finally:
            os.close(write)
        return done.returncode, done.stderr

    def test_a_reader_that_has_read_enough_is_no_error(self):
        for name in OFFERED:
            with self.subTest(program=name):
                for word in ("--help", "--help-all", "--version"):
                    code, said = self.call_with_closed_pipe(name, word)
                    self.assertEqual((code, said), (-signal.SIGPIPE, ""))
        path = small_field.write_path(self.folder)
        self.assertEqual(self.call_with_closed_pipe("lfcammvminfo", path, "--csv"), (-signal.SIGPIPE, ""))
        # A parent that ignores SIGPIPE wants to hear of it, as of a full disk.
        code, said = self.call_with_closed_pipe("lfcammvminfo", path, "--csv", ignored=True)
        self.assertEqual(code, 4)
        self.assertIn("its reader has ended", said.splitlines()[-1])
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([BIN / "lfcammvminfo", path, "--csv"], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 4)
        self.assertIn("No space left on device", done.stderr)

    def test_all_programs_are_listed(self):
        programs = {path.name for path in BIN.iterdir() if path.name.startswith("lf")}
        self.assertEqual(programs, {name.split()[0] for name in OFFERED})

    def test_all_commands_are_listed(self):
        commands = {name.split()[1] for name in OFFERED if name.startswith("lffocus ")}
        last = self.call("lffocus", "no").stderr.splitlines()[-1]
        self.assertEqual(set(re.search("the commands (.*) as the first", last)[1].split(", ")), commands)

    # Every start of a program loads all of its shared libraries. A library for all image formats once brought 250.
    def test_few_libraries_are_loaded(self):
        for name in OFFERED:
            with self.subTest(program=name):
                libraries = subprocess.run(["ldd", BIN / name.split()[0]], capture_output=True, text=True).stdout
                self.assertLess(len(libraries.splitlines()), 50, libraries)

    def test_help_tells_the_options_that_have_an_effect(self):
        for name, offered in OFFERED.items():
            with self.subTest(program=name):
                text = self.succeeds(name, "--help")
                self.assertEqual({option for option in options_in(text) if option in COMMON}, offered)
                if "--progress" in offered:
                    self.assertIn("auto: a bar on a terminal", self.succeeds(name, "--help-all"))

    def test_help_can_be_scanned(self):
        for name in OFFERED:
            with self.subTest(program=name):
                text = self.succeeds(name, "--help")
                everything = self.succeeds(name, "--help-all")
                for line in (text + everything).splitlines():
                    self.assertLessEqual(len(line), 100, line)
                    self.assertEqual(line, line.rstrip())
                headings = re.findall(r"^(\w+):$", text, re.M)
                self.assertEqual(headings[:2], ["Usage", "Examples"])
                sections = ("Commands", *GROUPS)
                self.assertEqual(headings[2:], [name for name in sections if name in headings])
                self.assertNotRegex(text, r"\b(TEXT|INT|UINT|FLOAT)\b")
                self.assertNotRegex(everything, r"\b(TEXT|INT|UINT|FLOAT)\b")
                for line in option_lines(text):
                    self.assertRegex(line, SCANNED)
                    self.assertIn(line, everything.splitlines())
                self.assertEqual(text.splitlines()[-1], hint(len(options_in(everything)) - len(options_in(text)) - 3))

    def test_defaults_in_help_are_those_listed(self):
        listed = dict(line.rsplit(" ", 1) for line in defaults.listed() if " --" in line)
        for name in OFFERED:
            everything = self.succeeds(name, "--help-all")
            for line in option_lines(everything):
                match = re.match(SCANNED, line)
                value = listed.get(f"{name} {match['name']}")
                if value is not None and value not in MEANS_SOMETHING:
                    # "as recorded, else black" is listed by its first word.
                    self.assertEqual((match["default"] or "").split(" ")[0], value, line)

    def test_others_are_refused_with_a_hint(self):
        for name, offered in OFFERED.items():
            for option in COMMON:
                if option in offered:
                    continue
                with self.subTest(program=name, option=option):
                    call = [*CALLS[name], option, *VALUES.get(option, [])]
                    result = self.call(name, *call)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn(f"Try '{name} --help'", result.stderr)
                    self.assertIn(option, result.stderr.splitlines()[-1])

    def refuses(self, name, *words, option):
        result = self.call(name, *words)
        self.assertEqual(result.returncode, 2, (words, result.stderr))
        self.assertIn(option, result.stderr.splitlines()[-1])

    def test_messages_refer_to_options_that_exist(self):
        """Each key in a message of the sources is an option of a program; of the named program, if one is named."""
        options = {}
        for name in OFFERED:
            description = json.loads(self.succeeds(name, "--describe"))
            for group in description["groups"]:
                for option in group["options"]:
                    options.setdefault(name.split()[0], set()).update(option["names"])
        everything = set().union(*options.values())
        count = 0
        for file in source_messages.sources(REPOSITORY):
            if file.relative_to(REPOSITORY).as_posix() in message_rules.OTHER_LANGUAGES:
                continue
            for _, literal in message_rules.literals(file.read_text()):
                for program, key in message_rules.references(literal):
                    count += 1
                    with self.subTest(file=str(file), program=program, key=key):
                        self.assertIn(message_rules.option_of(key), options[program] if program else everything)
        self.assertGreater(count, 300)

    def test_numbers_are_read_whole(self):
        """Every option that takes a number, of every program, refuses a text of which only a part is one."""
        count = 0
        for name in OFFERED:
            description = json.loads(self.succeeds(name, "--describe"))
            options = [option for group in description["groups"] for option in group["options"]]
            for option in options:
                wrong = ["abc", "", "0x1", "1 2", " 1", "1 ", "nan", "inf"]
                if option["type"] == "whole number":
                    wrong += ["1.5", "1e3", "+1"]
                elif option["type"] != "number":
                    continue
                long_name = next(word for word in option["names"] if word.startswith("--"))
                count += 1
                for word in wrong:
                    with self.subTest(program=name, option=long_name, word=word):
                        call = CALLS.get(name, ["no", "no.yaml", "-o", "no"])
                        self.refuses(name, *call, long_name, *[word] * option["value_count"], option=long_name)
        self.assertGreater(count, 100)
        for word in "20x20x", "x20x20", "20xx20":
            self.refuses("lfpath", "no.yaml", "--resolution", word, option="--resolution")

    def test_other_texts_of_numbers_are_read_whole(self):
        """Options whose texts are numbers with a unit, or words."""
        wrong = {"--memory": ["1.2.3G", "8GiB", "0x10G", " 8G", "8G "], "--fill": ["0x1", "1.5", "1 "],
                 "--max-rays": ["1.2.3M", "3Mi", "0x3", " 3M", ""], "--image-scale": ["0.5x", "0x1", "1 "],
                 "--dump-every": ["1.2.3s", "0x1s"], "--allow-missing": ["0x1", "1.5", "1 "],
                 "--background": ["0x1,0,0", "1,1,1x"], "--shard": ["1/2x", "0x1/2", "1.0/2"],
                 "--time-limit": ["1.2.3h", "0x1h"], "--pitch": ["0.5x", "0x1", "1,2,3"],
                 "--quantizer": ["0x10", "16 ", "1e3"], "--focus-distance": ["0.5x", "0x1"]}
        field = small_field.write_field(self.folder / "field")
        path = small_field.write_path(self.folder, frames=2)
        packages = self.folder / "packages"
        self.succeeds("lfpreprocessor", field, path, "-o", packages)
        out = self.folder / "out"
        calls = {"lfrenderer": [field, path, "-o", out, "--mode", "rebin"], "lfimport": [field, "-o", out],
                 "lfcompressor": [field, "-o", f"{out}.lfs", "--profile", "thesis"],
                 "lfsubmit": [*packages.glob("*.lfp"), "-o", out, "--engine", "slurm"],
                 "lffocus views": [field, "--grid", "2x2", "-o", out]}
        tried = set()
        for name, words in calls.items():
            for option in wrong:
                if option not in self.succeeds(name, "--help-all"):
                    continue
                for word in wrong[option]:
                    with self.subTest(program=name, option=option, word=word):
                        self.refuses(name, *words, f"{option}={word}", option=option)
                        tried.add(option)
        self.assertEqual(tried, set(wrong))
        self.assertFalse(out.exists())

    def calls(self):
        """Returns, for each program that prints more with -v, a call and a word of that output."""
        small_field.SIDE = 3
        field = small_field.write_field(self.folder / "field")
        path = small_field.write_path(self.folder, frames=2)
        out = self.folder
        yield "lfexample", [field, "-o", out / "example.yaml", "--focus", "1"], "transforms.json: opened"
        yield "lfimport", [field], "transforms.json"
        yield "lfpreprocessor", [field, path, "-o", out / "packages", "--overwrite"], "octree"
        yield "lfrenderer", [field, path, "-o", out / "frames"], "instruction set"
        yield "lfrenderer", [field, path, "-o", out / "shards", "--shard", "1/1"], "memory: "
        yield "lffocus stack", [field, path, "-o", out / "stack", "--near", 0.3, "--far", 1], "instruction set"
        yield "lffocus epi", [field, "--row", 3, "-o", out / "epi.png", "--overwrite"], "transforms.json: opened"
        yield "lffocus views", [field, "--grid", "3x3", "-o", out / "views", "--overwrite", "--focus-distance",
                                1], "transforms.json: opened"
        for command in ("depth", "sharp"):
            yield f"lffocus {command}", [field, path, "-o", out / "a.exr", "--near", 0.3, "--far", 1,
                                         "--overwrite", "--confidence", 0], "transforms.json: opened"
        yield "lffocus through", [field, path, "-o", out / "b.exr", "--overwrite"], "transforms.json: opened"
        yield "lfmerge", [out / "shards", "-o", out / "merged", "--overwrite"], "plates"
        yield "lfcompressor", [field, "-o", out / "a.lfs", "--overwrite"], "codec default"
        yield "lfdensify", [field, "-o", out / "b.lfs", "--overwrite", "--depths", 0.2, 10, "--force"], "divisor 1"
        yield "lfsubmit", [out / "packages/package-0000.lfp", "-o", out / "film",
                           "--overwrite"], "--resume --progress json"
        yield "lfpath", [path, "-o", out / "a.json", "--overwrite", "--lightfield", field], "transforms.json: opened"
        yield "lfvisualizer", [field, path, "--text"], "transforms.json"

    def test_v_says_more(self):
        verbose = {name for name, offered in OFFERED.items() if "--verbose" in offered}
        called = set()
        for name, arguments, word in self.calls():
            with self.subTest(program=name):
                plain = self.call(name, *arguments)
                told = self.call(name, *arguments, "-v")
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
                          ["lfsynth", "lights", "-o", self.folder / "lights", "--calibration-only", "--overwrite"]):
            plain, quiet = self.call(*arguments), self.call(*arguments, "-q")
            self.assertEqual((plain.returncode, quiet.returncode), (0, 0))
            self.assertNotEqual(plain.stderr, "")
            self.assertFalse([line for line in quiet.stderr.splitlines()
                              if not line.startswith("warning: ")], quiet.stderr)


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv[1])
    unittest.main(argv=sys.argv[:1], verbosity=2)
