#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks Containerfile without building it: its stages, that the files it copies exist and are not ignored, that the
scripts it runs can be executed, that the image runs as an ordinary user; and scripts/runtime_packages.sh.

usage: container_test.py REPOSITORY
"""
import fnmatch
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop()).resolve()
TEXT = (REPOSITORY / "Containerfile").read_text()
PACKAGES = REPOSITORY / "scripts/runtime_packages.sh"


def instructions():
    """Returns (instruction, words) of each line of the Containerfile; lines that end with a backslash are joined."""
    lines = re.sub(r"^#.*\n", "", TEXT, flags=re.M).replace("\\\n", " ").splitlines()
    return [tuple(line.split(maxsplit=1)) for line in lines if line.strip()]


class Containerfile(unittest.TestCase):
    def test_two_stages_of_one_base_that_ends_as_an_ordinary_user(self):
        found = instructions()
        self.assertEqual([words for name, words in found if name == "FROM"], ["${BASE} AS build", "${BASE}"])
        self.assertEqual(found[0], ("ARG", "BASE=docker.io/library/debian:12"))
        self.assertLessEqual({name for name, _ in found}, {"ARG", "FROM", "COPY", "RUN", "WORKDIR", "USER", "CMD"})
        users = [words for name, words in found if name == "USER"]
        self.assertEqual(users, ["lf"])
        self.assertIn(f"--uid 1000 {users[0]}", TEXT)
        # Only the last instructions may follow, because commands before them need root.
        self.assertNotIn("RUN", [name for name, _ in found[found.index(("USER", "lf")):]])

    def test_scripts_that_are_run_exist_and_are_not_ignored(self):
        ignored = [line for line in (REPOSITORY / ".dockerignore").read_text().splitlines() if line and line[0] != "#"]
        run = re.findall(r"scripts/[\w.]+", " ".join(words for name, words in instructions() if name == "RUN"))
        self.assertEqual(run, ["scripts/build.sh", "scripts/runtime_packages.sh"])
        for name in [*run, "LICENSE", "VERSION", "CMakeLists.txt", "web/package.json"]:
            self.assertTrue((REPOSITORY / name).is_file(), name)
            self.assertFalse([rule for rule in ignored if fnmatch.fnmatch(name, rule) or name.startswith(f"{rule}/")],
                             name)
        for name in run:
            self.assertTrue(os.access(REPOSITORY / name, os.X_OK), name)
        self.assertIn("build", ignored)
        self.assertIn("web/node_modules", ignored)


@unittest.skipUnless(shutil.which("dpkg-query"), "this is no Debian")
class RuntimePackages(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def packages(self):
        done = subprocess.run([PACKAGES, self.folder], capture_output=True, text=True)
        return done.returncode, done.stdout.split(), done.stderr

    def test_the_packages_of_a_program_are_those_of_its_libraries(self):
        shutil.copy("/usr/bin/env", self.folder)
        (self.folder / "script").write_text("#!/bin/sh\n")
        self.assertEqual(self.packages(), (0, ["ffmpeg", "libc6"], ""))

    def test_a_folder_without_programs_is_an_error(self):
        (self.folder / "script").write_text("#!/bin/sh\n")
        code, out, err = self.packages()
        self.assertEqual((code, out), (1, []))
        self.assertIn("there are no programs", err)


if __name__ == "__main__":
    unittest.main()
