#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every program while one system call fails: the k-th write, flush, rename, ... or allocation.

A program may end with 0 only if its files are those of an undisturbed run, and no temporary file is
left. Otherwise its status is 3, 4 or 6 (6 if an LF image cannot be read, which is then left out and
reported), and its last line begins with "error: ". Every file with a final name must be the old file
or the right one, and a run with --resume, or the same run again, must end with the right files.

usage: faults_test.py SHIM FOLDER_OF_PROGRAMS [--points N] [--only WORD] [--say] [--workers N]

--points  number of system calls that fail in each group. A group is one kind of call, by one function, on files of one
          pattern (default 1, with fewer ways to fail; 0: all of them, which takes hours)
--only    tests only programs whose name contains the word
--say     print every try
--workers number of hunts at the same time (default 2)
"""
import argparse
import collections
import concurrent.futures
import contextlib
import itertools
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from final_files import (faults_of_finals, faults_of_going_on, faults_of_status, faults_of_success, files_of,
                         last_line)
from tiny_calls import TinyCalls

EIO, EINTR = 5, 4
# Ways in which system calls fail: a number of errno, "short" or "kill"; "+": this system call and all later ones.
WAYS = {"open": ["24", "5"], "read": ["5", "short", "4"], "write": ["28+", "5", "short", "4", "kill"],
        "fsync": ["5", "kill"], "rename": ["28", "kill"], "unlink": ["5"], "mkdir": ["28"], "stat": ["5"],
        "mmap": ["12"], "thread": ["11+"], "malloc": ["12"]}
# With --points 1: QUICK_WAYS for most program runs; FEWER_WAYS for lfsubmit, which takes seconds, for runs that
# overwrite old results, and for runs that differ from another run only in the mode.
QUICK_WAYS = {"open": ["24"], "read": ["5", "short"], "write": ["28+", "short", "kill"], "fsync": ["5", "kill"],
              "rename": ["28", "kill"], "unlink": ["5"], "mkdir": ["28"], "stat": ["5"], "mmap": ["12"],
              "thread": ["11+"], "malloc": ["12"]}
FEWER_WAYS = {"open": ["24"], "write": ["28+", "kill"], "fsync": ["kill"], "rename": ["28"], "unlink": ["5"],
              "thread": ["11+"]}
LIKE_OTHERS = ("shards", "rebin", "hybrid")
FEWER_POINTS = 2  # number of system calls of each kind that fail in lfsubmit
GROUPS_OF_MALLOC = 6  # factor of --points for malloc, whose calls form only one group per function
HANGS_S = 120


class Hunt:
    """Makes system calls of programs fail, one program after the other, in a folder of its own."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.work, self.old = folder / "work", folder / "old"
        self.trace, self.log = folder / "trace", folder / "log"
        self.calls = TinyCalls(arguments.programs, folder / "base", self.work / "out")

    def run(self, command, fault=None):
        """Returns the status and the output of a program run, after all of its processes have ended."""
        environment = dict(os.environ, FAULT_PATH=str(self.folder))
        if fault is not None:
            environment.update(fault, LD_PRELOAD=str(self.arguments.shim))
        with subprocess.Popen(list(map(str, command)), env=environment, stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, errors="replace",
                              start_new_session=True) as process:
            try:
                _, errors = process.communicate(timeout=HANGS_S)
                code = process.returncode
            except subprocess.TimeoutExpired:
                code, errors = "hangs", ""
            if not has_ended(process.pid):
                os.killpg(process.pid, signal.SIGKILL)
                code = f"{code}, and processes stay" if code != "hangs" else code
        return code, errors

    def fresh(self, call):
        shutil.rmtree(self.work, ignore_errors=True)
        if call.before:
            shutil.copytree(self.old, self.work)
        else:
            self.work.mkdir()

    def make_old(self, call):
        """Makes the results that the program run overwrites. Returns their digests."""
        if not call.before:
            return {}
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.rmtree(self.old, ignore_errors=True)
        self.work.mkdir()
        for command in call.before:
            code, errors = self.run(command)
            if code != 0:
                raise RuntimeError(f"{call.name}: old results: status {code}: {last_line(errors)}")
        shutil.copytree(self.work, self.old)
        return files_of(self.old)[0]

    def points(self, trace):
        """Returns, by kind, the system calls that are to fail."""
        groups = collections.defaultdict(list)
        for line in trace.splitlines():
            kind, k, function, path = line.split(" ", 3)
            groups[kind, function, re.sub(r"\d+", "#", path)].append(int(k))
        chosen = collections.defaultdict(set)
        for (kind, _, _), calls in groups.items():
            calls = sorted(set(calls))
            most = self.arguments.points * (GROUPS_OF_MALLOC if kind == "malloc" else 1)
            if most == 0 or len(calls) <= most:
                chosen[kind].update(calls)
            elif most == 1:
                chosen[kind].add(calls[-1])
            else:
                chosen[kind].update(calls[round(i * (len(calls) - 1) / (most - 1))] for i in range(most))
        return {kind: sorted(calls) for kind, calls in chosen.items()}

    def ways(self, call, kind, points):
        """Returns how and where system calls of one kind fail."""
        if self.arguments.points != 1:
            return itertools.product(WAYS[kind], points)
        is_submission = call.command[0].name == "lfsubmit"
        if not (is_submission or call.before or call.name.endswith(LIKE_OTHERS)):
            return itertools.product(QUICK_WAYS[kind], points)
        if is_submission:
            points = points[len(points) // FEWER_POINTS::max(1, len(points) // FEWER_POINTS)][-FEWER_POINTS:]
        return itertools.product(FEWER_WAYS.get(kind, []), points)

    def judge(self, call, kind, way, code, errors, right, old):
        final, temporary = files_of(self.work)
        if code == 0:
            return faults_of_success(final, [] if kind == "unlink" else temporary, right)
        if code == 6 and way == str(EIO):  # a disk that cannot deliver an LF image: it is left out and reported
            return []
        # Exit code 5: lfsubmit did not see that a package is done, and reports this and that --resume resumes.
        codes = (3, 4, 5, 6) if kind == "stat" and call.victim == "lfsubmit" else (3, 4, 6)
        faults = [] if way == "kill" and code == -signal.SIGKILL else faults_of_status(code, errors, codes)
        if way == str(EIO) and call.victim != call.command[0].name and kind in ("open", "read"):
            return faults  # every renderer of the job leaves an LF image out, which --resume reports
        if way in ("short", str(EINTR)):
            faults.append(f"not tried again: {last_line(errors)[:200]}")
        faults += faults_of_finals(final, right, old)
        if way == "kill":  # a lock file that is left behind blocks nobody
            return faults + faults_of_going_on(call.again, self.run, self.files_but_locks, right)
        return faults + faults_of_going_on(call.again, self.run, lambda: files_of(self.work), right)

    def files_but_locks(self):
        final, temporary = files_of(self.work)
        return final, [name for name in temporary if not name.endswith("lock")]

    def hunt(self, call):
        """Returns the number of tries, and the failed system call of each try that found a fault."""
        old = self.make_old(call)
        self.fresh(call)
        self.trace.unlink(missing_ok=True)
        code, errors = self.run(call.command, {"FAULT_TRACE": str(self.trace), "FAULT_PROGRAM": call.victim})
        right, temporary = files_of(self.work)
        if code != 0 or temporary:
            print(f"{call.name}: undisturbed: status {code}, left over {temporary}: {errors[-300:]}", flush=True)
            return 0, ["undisturbed"]
        tries, failures = 0, []
        for kind, points in self.points(self.trace.read_text()).items():
            for way, k in self.ways(call, kind, points):
                self.fresh(call)
                self.log.unlink(missing_ok=True)
                code, errors = self.run(call.command, {
                    "FAULT_KIND": kind, "FAULT_K": str(k), "FAULT_ERRNO": way.rstrip("+"),
                    "FAULT_ALWAYS": str(int(way.endswith("+"))), "FAULT_LOG": str(self.log),
                    "FAULT_PROGRAM": call.victim, "FAULT_ONCE": str(int(way == "kill"))})
                if not self.log.exists():
                    continue
                where = self.log.read_text().splitlines()[0].replace(str(self.folder), "")
                faults = self.judge(call, kind, way.rstrip("+"), code, errors, right, old)
                tries += 1
                if faults or self.arguments.say:
                    print(f"{call.name}: {way}: {where}: status {code}: {'; '.join(faults) or 'survived'}", flush=True)
                if faults:
                    failures.append(where)
        return tries, failures


def has_ended(group, seconds=20):
    """Waits until no process of the group remains. Returns True if that happened in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.02)
    return False


def names_of_calls(calls):
    return [call.name for call in chosen_calls(calls)]


def chosen_calls(calls):
    """Returns all program runs, the slowest first."""
    return [*calls.submitters(), *calls.overwriters(), *calls.writers()]


def all_hunts(arguments, folder):
    """Hunts with several workers. Returns tries and failures by the name of the program run."""
    results, tasks = {}, queue.SimpleQueue()

    def work(number):
        own = folder / f"worker {number}"
        own.mkdir()
        hunt = Hunt(arguments, own)
        hunt.calls.prepare()
        calls = chosen_calls(hunt.calls)
        with contextlib.suppress(queue.Empty):
            while True:
                call = calls[tasks.get_nowait()]
                results[call.name] = hunt.hunt(call)

    names = names_of_calls(TinyCalls(arguments.programs, folder, folder / "out"))
    for index, name in enumerate(names):
        if arguments.only in name:
            tasks.put(index)
    with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        for done in [pool.submit(work, number) for number in range(arguments.workers)]:
            done.result()
    return {name: results[name] for name in names if name in results}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shim", type=pathlib.Path)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--say", action="store_true")
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    arguments.shim, arguments.programs = arguments.shim.resolve(), arguments.programs.resolve()
    with tempfile.TemporaryDirectory() as folder:
        results = all_hunts(arguments, pathlib.Path(folder).resolve())
    for name, (tries, failures) in results.items():
        print(f"{name}: {tries} tries, {tries - len(failures)} survived")
    failures = sum(len(failures) for _, failures in results.values())
    tries = sum(tries for tries, _ in results.values())
    print(f"{tries} tries, {failures} failures")
    return 1 if failures or not tries else 0


if __name__ == "__main__":
    sys.exit(main())
