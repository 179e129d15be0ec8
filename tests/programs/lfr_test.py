#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfr, which runs the other programs: names, exit codes, signals, and which program it finds.

usage: lfr_test.py FOLDER_OF_THE_PROGRAMS
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import unittest

import small_field
from common_options import OFFERED
from program_test_case import ProgramTestCase, wait_until

BIN = None


def is_ready(pid):
    """Returns True if the process is lfsynth and catches SIGINT."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return "Name:\tlfsynth\n" in status and int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16) & 1 << signal.SIGINT - 1


class LfrTest(ProgramTestCase):
    def lfr(self, *words, **keys):
        return subprocess.run([BIN / "lfr", *map(str, words)], capture_output=True, text=True, timeout=120, **keys)

    def commands(self):
        """Returns {command: summary} from the list in the help."""
        block = self.lfr("--help").stdout.split("Commands:\n")[1].split("\n\n")[0]
        found = {}
        for line in block.splitlines():
            if line[2] != " ":
                command, _, summary = line.strip().partition(" ")
                found[command] = summary.strip()
            else:
                found[command] += " " + line.strip()
        return found

    def test_every_program_has_a_command_with_its_summary(self):
        commands = self.commands()
        programs = {name for name in OFFERED if " " not in name and name != "lfr"}
        self.assertEqual(len(commands), len(programs))
        helps = {" ".join((self.call(BIN / name, "--help").stdout.split("\n\n")[0]).split()): name for name in programs}
        for command, summary in commands.items():
            program = helps[summary]
            for word in (command, program, program.removeprefix("lf")):
                self.assertEqual(self.lfr(word, "--version").stdout, f"{program} 0.1.0\n".replace(
                    "0.1.0", self.lfr("--version").stdout.split()[1]))

    def test_without_a_command_or_with_help_the_list_is_shown(self):
        listed = self.lfr("--help")
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        self.assertEqual(self.lfr().stdout, listed.stdout)
        self.assertEqual(self.lfr("help").stdout, listed.stdout)

    def test_help_of_a_command_is_that_of_its_program(self):
        for words, program in ((["render"], ["lfrenderer"]), (["focus", "stack"], ["lffocus", "stack"])):
            help_text = self.succeeds(BIN / program[0], *program[1:], "--help")
            self.assertEqual(self.lfr("help", *words).stdout, help_text)
            self.assertEqual(self.lfr(*words, "--help").stdout, help_text)

    def test_an_unknown_command_names_the_nearest(self):
        self.fails(2, ["rendr: unknown command; did you mean 'render'?"], BIN / "lfr", "rendr", "--whatever")
        self.fails(2, ["xyzzy: unknown command; to list the commands: lfr --help"], BIN / "lfr", "xyzzy")
        self.fails(2, ["rendr: unknown command"], BIN / "lfr", "help", "rendr")
        self.fails(2, ["--no-such-option"], BIN / "lfr", "--no-such-option")
        self.fails(2, [": unknown command"], BIN / "lfr", "")

    def test_arguments_and_exit_codes_pass(self):
        field = small_field.write_field(self.folder / "field")
        path = small_field.write_path(self.folder, frames=1)
        words = ["-o", self.folder / "a frame's folder", "-q", "--threads", 1]
        self.assertEqual(self.lfr("render", field, path, *words).returncode, 0)
        self.assertTrue((self.folder / "a frame's folder" / "frame_0001.exr").exists())
        for code, more in ((2, ["--no-such-option"]), (3, [self.folder / "none", path, *words])):
            direct = self.call(BIN / "lfrenderer", *more)
            by_name = self.lfr("render", *more)
            self.assertEqual((by_name.returncode, by_name.stderr), (code, direct.stderr))
        result = self.lfr("synth", "lights", "-o", "/proc/none")
        self.assertEqual(result.returncode, 4, result.stderr)

    def test_signals_reach_the_program(self):
        for ending in (signal.SIGINT, signal.SIGTERM):
            field = self.folder / f"field{ending}"
            process = subprocess.Popen([BIN / "lfr", "synth", "still-life", "-o", field, "--count", "4000",
                                        "--threads", "1", "--progress", "none"], stderr=subprocess.PIPE)
            # The process has become the program: there is no other that a signal could miss.
            wait_until(lambda: is_ready(process.pid), process)
            process.send_signal(ending)
            told = process.communicate(timeout=120)[1].decode()
            self.assertEqual(process.returncode, 5, told)

    def test_the_program_beside_it_is_run_before_that_of_the_path(self):
        def fake(folder, words):
            folder.mkdir()
            (folder / "lfrenderer").write_text(f"#!/bin/sh\necho {words}: \"$@\"\n")
            (folder / "lfrenderer").chmod(0o755)
            return folder
        beside, elsewhere = fake(self.folder / "beside", "beside"), fake(self.folder / "elsewhere", "elsewhere")
        environment = {**os.environ, "PATH": f"{elsewhere}:/usr/bin:/bin"}
        shutil.copy(BIN / "lfr", beside / "lfr")
        # A link to lfr, as in a folder of the user, is resolved.
        (self.folder / "lfr").symlink_to(beside / "lfr")
        for lfr in (beside / "lfr", self.folder / "lfr"):
            result = subprocess.run([lfr, "render", "a b"], capture_output=True, text=True, env=environment)
            self.assertEqual(result.stdout, "beside: a b\n", result.stderr)
        (beside / "lfrenderer").unlink()
        result = subprocess.run([beside / "lfr", "render", "-h"], capture_output=True, text=True, env=environment)
        self.assertEqual(result.stdout, "elsewhere: -h\n", result.stderr)
        (elsewhere / "lfrenderer").unlink()
        result = subprocess.run([beside / "lfr", "render"], capture_output=True, text=True, env=environment)
        self.assertEqual(result.returncode, 2)
        self.assertIn("lfrenderer: the program is neither beside lfr", result.stderr.splitlines()[-1])


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv[1])
    unittest.main(argv=sys.argv[:1], verbosity=2)
