#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every program that writes, and lets the power fail after each of its steps: what was not flushed is lost.

A call is logged once (faults/written_log.c). Then the disk is composed as it would be if the power had failed after one
event of the log. By one rule, a name is on the disk once its folder is flushed; by the other, at once. Content is on
the disk once its file is flushed. On each of these disks, files with final names must be absent, old or right, and a
call that resumes must make the right files. After status 0, all files must be there.

usage: power_failure_test.py LOGGER FOLDER_OF_PROGRAMS [--points N] [--only WORD] [--say]

--points  number of moments tried for each call and rule (default 5; 0: all, which takes some minutes)
--only    only calls whose name contains the word
--say     print every try
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from disk_replay import Disk, read_log, write_content
from final_files import differing, faults_of_finals, faults_of_going_on, files_of, last_line
from tiny_calls import TinyCalls

RULES = {"names count when flushed": False, "names count at once": True}
# Events of these kinds are the most critical moments.
TELLING = ("rename", "flush_folder", "flush", "cut", "remove")


def run(command, environment=None):
    result = subprocess.run(list(map(str, command)), env={**os.environ, **(environment or {})}, capture_output=True,
                            stdin=subprocess.DEVNULL, timeout=120)
    return result.returncode, result.stderr.decode(errors="replace")


class PowerFailures:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.work, self.log = folder / "work", folder / "logs" / "log"
        self.calls = TinyCalls(arguments.programs, folder / "base", self.work / "out")

    def empty(self, *folders):
        for folder in folders:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()

    def moments(self, events):
        """Returns the numbers of events after which the power fails."""
        most = self.arguments.points
        moments = range(1, len(events) + 1)
        if most == 0 or len(events) <= most:
            return moments
        telling = [moment for moment in moments if events[moment - 1][0] in TELLING]
        chosen = {telling[round(i * (len(telling) - 1) / (most - 1))] for i in range(most)} if most > 1 else set()
        return sorted({*chosen, len(events)})

    def try_disk(self, call, content, right, old, is_last):
        """Returns the faults of one disk."""
        self.empty(self.work)
        write_content(content, self.work)
        final, _ = files_of(self.work)
        faults = faults_of_finals(final, right, old)
        if is_last and (lost := differing(final, right)):
            faults.append(f"status 0, but not on the disk: {lost[:4]}")

        def files():
            final, temporary = files_of(self.work)
            return final, [name for name in temporary if not name.endswith("lock")]  # lock files block nobody
        return faults + faults_of_going_on(call.again, run, files, right)

    def hunt(self, call):
        """Returns the numbers of tries and of failures."""
        self.empty(self.work, self.log.parent)
        for command in call.before:
            code, errors = run(command)
            assert code == 0, errors
        old, _ = files_of(self.work)
        disks = {rule: Disk(self.work, is_hasty) for rule, is_hasty in RULES.items()}
        code, errors = run(call.command, {"LD_PRELOAD": str(self.arguments.logger), "WRITTEN_LOG": str(self.log),
                                          "WRITTEN_PATH": str(self.work)})
        right, temporary = files_of(self.work)
        if code != 0 or temporary:
            print(f"{call.name}: undisturbed: status {code}, left over {temporary}: {last_line(errors)}")
            return 0, 1
        there = {str(path.relative_to(self.work)) for path in self.work.rglob("*")}
        events = read_log(self.log)
        moments = self.moments(events)
        tries = failures = 0
        for rule, disk in disks.items():
            tried = []
            for moment, event in enumerate(events, 1):
                disk.happens(*event)
                content = disk.content()
                is_last = moment == len(events)
                if moment not in moments or (content in tried and not is_last):
                    continue
                tried.append(content)
                faults = self.try_disk(call, content, right, old, is_last)
                tries += 1
                failures += bool(faults)
                if faults or self.arguments.say:
                    print(f"{call.name}: {rule}: after event {moment} of {len(events)}, {event[0]} "
                          f"{event[1].relative_to(self.work)}: {'; '.join(faults) or 'survived'}", flush=True)
            if missed := there ^ disk.names_seen():
                print(f"{call.name}: the log misses {sorted(missed)[:4]}")
                failures += 1
        return tries, failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logger", type=pathlib.Path)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=5)
    parser.add_argument("--only", default="")
    parser.add_argument("--say", action="store_true")
    arguments = parser.parse_args()
    arguments.logger, arguments.programs = arguments.logger.resolve(), arguments.programs.resolve()
    all_tries = all_failures = 0
    with tempfile.TemporaryDirectory() as folder:
        power = PowerFailures(arguments, pathlib.Path(folder).resolve())
        power.calls.prepare()
        for call in [*power.calls.writers(), *power.calls.overwriters()]:
            if arguments.only in call.name:
                tries, failures = power.hunt(call)
                print(f"{call.name}: {tries} tries, {tries - failures} survived", flush=True)
                all_tries, all_failures = all_tries + tries, all_failures + failures
    print(f"{all_tries} tries, {all_failures} failures")
    return 1 if all_failures or not all_tries else 0


if __name__ == "__main__":
    sys.exit(main())
