#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Follows the advice of all programs: each command that they print, and each option that a message recommends, is tried
in the situation in which it is printed. A message in the sources that no situation provokes fails the test.

usage: advice_test.py PROGRAMS REPOSITORY
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import sys
import tempfile
import threading
import unittest

import advice_cases
import advice_commands
import advice_untried
import help_examples
import printed_commands
import source_messages

PROGRAMS, REPOSITORY = map(pathlib.Path, sys.argv[1:3])
AT_ONCE = 2


class AdviceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.shell = printed_commands.Shell(PROGRAMS.resolve())
        printed_commands.make_world(cls.folder / "world", cls.shell)
        cls.lock = threading.Lock()
        cls.number = 0

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def place(self, text, world=None):
        """Returns a fresh folder with those files of a world that a text names."""
        with self.lock:
            AdviceTest.number += 1
            folder = self.folder / f"place {self.number}"
        folder.mkdir()
        for entry in (world or self.folder / "world").iterdir():
            if re.search(rf"\b{re.escape(entry.stem)}\b", text):
                copy = shutil.copytree if entry.is_dir() else shutil.copy
                copy(entry, folder / entry.name)
        return folder

    def provoked(self, case):
        """Returns a folder in which the call of a case has failed, and the end of this call."""
        folder = self.place(f"{case.before} {case.call} {case.remedies}")
        if case.before:
            self.shell.must(case.before, folder)
        ended = self.shell.run(case.call, folder)
        if ended.code != case.code or case.words not in ended.text:
            raise AssertionError(f"{case.call}\nended with {ended.code}, expected {case.code} and \"{case.words}\":\n"
                                 f"{ended.text}")
        return folder, ended

    def follow(self, case):
        """Follows each remedy of a case. Returns what failed."""
        failures = []
        for remedy, code in case.remedies:
            try:
                folder, ended = self.provoked(case)
                line = advice_cases.edited(case.call, remedy)
                again = self.shell.run(line, folder)
                if again.code != code:
                    failures.append(f"{case.call}\n{ended.text}\nadvises: {line}\nwhich ended with {again.code}, "
                                    f"expected {code}:\n{again.text}")
                shutil.rmtree(folder)
            except AssertionError as error:
                failures.append(str(error))
        return failures

    def run_all(self, task, items):
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            for failures in pool.map(task, items):
                for failure in failures:
                    with self.subTest():
                        self.fail(failure)

    def test_options(self):
        cases = advice_cases.read_cases()
        self.run_all(self.follow, cases)
        print(f"{sum(len(case.remedies) for case in cases)} recommended options of {len(cases)} situations were tried")

    def test_commands(self):
        def follow(situation):
            folder = self.place(f"{situation} path frames")
            try:
                return situation.follow(self.shell, folder)
            except AssertionError as error:
                return [f"{situation.call}: {error}"], 0
            finally:
                shutil.rmtree(folder)

        count = 0
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            for failures, found in pool.map(follow, advice_commands.SITUATIONS):
                count += found
                for failure in failures:
                    with self.subTest():
                        self.fail(failure)
        print(f"{count} printed commands of {len(advice_commands.SITUATIONS)} situations were found, and all were run")

    def test_help_examples(self):
        world = self.folder / "examples"
        help_examples.make_world(world, self.shell)
        examples = help_examples.examples_of(self.shell, self.folder)
        to_run = [(call, example) for call, example in examples if not help_examples.reason_not_to_run(example)]

        def run(item):
            call, example = item
            folder = self.place(f"{call} {example} path short deep", world)
            ended = self.shell.run(help_examples.line_of(call, example), folder)
            shutil.rmtree(folder)
            return [] if ended.code == 0 else [f"{call} --help: {example}\nended with {ended.code}:\n{ended.text}"]

        self.run_all(run, to_run)
        for begin in help_examples.NOT_RUN:
            self.assertTrue(any(example.startswith(begin) for _, example in examples), f"{begin}: is no example")
        print(f"{len(to_run)} of {len(examples)} examples of --help were run")

    def test_each_message_is_provoked(self):
        """Each message of the sources that advises something belongs to a situation, or to the list of those that
        cannot be tried here; and each entry of these belongs to a message."""
        keys = [case.key for case in advice_cases.read_cases()]
        keys += [key for situation in advice_commands.SITUATIONS for key in situation.keys]
        untried = advice_untried.UNTRIED
        messages = source_messages.messages(REPOSITORY)
        used = set()
        count = 0
        for message in messages:
            names = [key for key in [*keys, *untried] if message.matches(key)]
            used.update(names)
            count += any(name in keys for name in names)
            with self.subTest(message=str(message)):
                self.assertTrue(names, "no situation provokes this message: add one to tests/advice")
        words = source_messages.all_literals(REPOSITORY)
        for key in [*keys, *untried]:
            with self.subTest(key=key):
                self.assertTrue(key in used or any(message.matches(key) for message in words),
                                "no message contains these words")
        print(f"{len(messages)} messages advise a command or an option; {count} are provoked, "
              f"{len(messages) - count} are listed as not tried")


if __name__ == "__main__":
    os.environ.setdefault("LANG", "C.UTF-8")
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
