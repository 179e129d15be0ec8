#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every program on a machine that lacks something: memory, open files, processes, space on the disk, standard
streams, a point in decimal numbers, plain names.

A program may end with 0 only if its files (or its text) are those of an undisturbed run, and no temporary file is left.
Otherwise its status must be 2, 3, 4 or 6, its last line must begin with "error: ", and files with final names must be
old or right. The same call, or a call that resumes, must make the right files once the machine lacks nothing.

usage: environment_test.py FOLDER_OF_PROGRAMS [--all] [--part PART] [--only WORD] [--say]

--all   long sweeps: more limits for each program, and each odd name alone (about an hour of CPU time)
--part  memory, files, processes, size, disk, streams, locale, names or inputs; default: all of them
--only  only calls whose name contains the word
--say   print every try
"""
import argparse
import collections
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

import odd_places
import run_test
from final_files import faults_of_finals, faults_of_going_on, faults_of_status, faults_of_success, files_of, last_line
from tiny_calls import TinyCalls

MIB = 1 << 20
HANGS_S = 120
CODES = (2, 3, 4, 6)
PARTS = ("memory", "files", "processes", "size", "disk", "streams", "locale", "names", "inputs")
LOADER = "error while loading shared libraries"  # a message of the system's loader, before the program starts
# Beginnings of messages of libraries, of LibRaw and of FFmpeg, that end the process before the program starts.
OF_LIBRARY = ("libgomp: ", "Error in GnuTLS initialization: ")
# Limits of the quick form, of which each call tries every third, and of the long form (ALL_...).
MEMORY_MIB = (16, 28, 40, 56, 72, 88, 104, 120, 144, 176, 240, 400)
FILES = (3, 4, 5, 6, 7, 8, 10, 12, 16)
PROCESSES = (1, 2, 4)
SIZES = (0, 100, 4096, 20000)
DISK_SIZES = ("4k", "16k", "64k", "inodes 3", "inodes 5")
EVERY = 3
ALL_MEMORY_MIB = range(16, 600, 8)
ALL_FILES = range(3, 30)
ALL_PROCESSES = range(1, 12)
ALL_SIZES = (0, 1, 100, 511, 512, 513, 1000, 2000, 4095, 4096, 4097, 6000, 8192, 12000, 20000, 40000, 80000, 160000)
ALL_DISK_SIZES = (*(f"{kib}k" for kib in (4, 8, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)),
                  *(f"inodes {count}" for count in range(1, 12)))


class Lack:
    """One thing that the machine lacks during a call."""

    def __init__(self, name, limits=None, closed=(), user=None, environment=None):
        self.name, self.limits, self.closed, self.user = name, limits or {}, closed, user
        self.environment = environment or {}

    def begin(self):
        """Runs in the child process before it becomes the program."""
        for what, limit in self.limits.items():
            resource.setrlimit(what, (limit, limit))
        if self.user is not None:
            os.setgid(self.user)
            os.setuid(self.user)
        for stream in self.closed:
            os.close(stream)


class Run:
    """The outcome of one call of a program."""

    def __init__(self, command, lack=None):
        environment = {**os.environ, **(lack.environment if lack else {})}
        self.command, self.lack = command, lack
        try:
            done = subprocess.run([os.fspath(word) for word in command], stdin=subprocess.DEVNULL, capture_output=True,
                                  timeout=HANGS_S, env=environment, preexec_fn=lack.begin if lack else None)
            self.code, self.out = done.returncode, done.stdout
            self.errors = done.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired:
            self.code, self.out, self.errors = "hangs", b"", ""

    @property
    def never_began(self):
        """True if the loader, or a library that is prepared before main(), has ended the process."""
        if self.code == 127 and LOADER in self.errors:
            return True

        def is_of_library(errors):
            return not errors or errors.startswith(OF_LIBRARY)

        if self.code != 1 or not is_of_library(self.errors):
            return False
        # Some libraries end the process, most without a word. They do so in any call of the program.
        program = next(word for word in self.command if re.fullmatch(r"lf\w+", pathlib.Path(word).name))
        least = Run([program, "--version"], self.lack)
        return least.code == 1 and is_of_library(least.errors) and not least.out


def free_user():
    """Returns a user without any process."""
    busy = {path.stat().st_uid for path in pathlib.Path("/proc").iterdir() if path.name.isdigit()}
    return next(user for user in range(61000, 61999) if user not in busy)


def own_threads():
    """Returns the number of this user's threads."""
    count = 0
    for status in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if status.stat().st_uid == os.getuid():
                count += len(os.listdir(status / "task"))
        except OSError:
            pass  # the process has ended
    return count


class Environments:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.work = folder / "work"
        self.work.mkdir()
        self.tries, self.survived = collections.Counter(), collections.Counter()
        self.failures = 0
        self.calls = TinyCalls(arguments.programs, folder / "base", self.work / "out")
        self.calls.prepare()
        self.right = {}

    def note(self, part, name, what, faults, said=""):
        program = name.split()[0].rstrip(",")
        self.tries[part, program] += 1
        self.survived[part, program] += not faults
        self.failures += bool(faults)
        if faults or self.arguments.say:
            print(f"{part}: {name}: {what}: {'; '.join(faults) or 'survived'} {said}", flush=True)

    def fresh(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(exist_ok=True)

    def chosen(self):
        calls = [*self.calls.writers(), *self.calls.submitters()[:1], *self.calls.printers()]
        return [call for call in calls if self.arguments.only in call.name]

    def right_of(self, call):
        """Returns the files and the text of an undisturbed run."""
        if call.name not in self.right:
            self.fresh()
            done = Run(call.command)
            final, temporary = files_of(self.work)
            if done.code != 0 or temporary:
                raise RuntimeError(f"{call.name}: undisturbed: status {done.code}: {done.errors[-300:]} {temporary}")
            self.right[call.name] = final, done.out
        return self.right[call.name]

    def judge(self, call, lack, done, right, right_out, repair=None):
        final, temporary = files_of(self.work)
        if done.code == 0:
            faults = faults_of_success(final, temporary, right)
            if call.prints and (done.out != right_out or 1 in lack.closed):
                faults.append(f"status 0, but {len(done.out)} bytes of {len(right_out)} came out")
            return faults
        faults = []
        if not done.never_began:
            faults = faults_of_status(done.code, done.errors, CODES)
            if 2 in lack.closed and done.code in CODES:
                faults = []  # stderr is closed
        faults += faults_of_finals(final, right, {})
        if repair:
            repair()

        def again(command):
            done = Run(command, Lack("nothing", user=lack.user))
            return done.code, done.errors
        return faults + faults_of_going_on(call.again, again, lambda: files_of(self.work), right)

    def try_call(self, part, call, lack, repair=None):
        right, right_out = self.right_of(call)
        self.fresh()
        if lack.user is not None:
            os.chown(self.work, lack.user, lack.user)
        done = Run(call.command, lack)
        faults = self.judge(call, lack, done, right, right_out, repair)
        self.note(part, call.name, lack.name, faults, f"(status {done.code}: {last_line(done.errors)[:160]})")

    def sweep(self, part, quick, everything, lack_of):
        for number, call in enumerate(self.chosen()):
            values = everything if self.arguments.all else quick[number % EVERY::EVERY]
            for value in values:
                self.try_call(part, call, lack_of(value))

    # The parts: one method for each name in PARTS.

    def memory(self):
        self.sweep("memory", MEMORY_MIB, ALL_MEMORY_MIB, lambda mib: Lack(
            f"{mib} MiB of addresses", {resource.RLIMIT_AS: mib * MIB}))

    def files(self):
        self.sweep("files", FILES, ALL_FILES, lambda count: Lack(
            f"{count} open files", {resource.RLIMIT_NOFILE: count}))

    def size(self):
        self.sweep("size", SIZES, ALL_SIZES, lambda size: Lack(
            f"files of {size} bytes", {resource.RLIMIT_FSIZE: size}))

    def processes(self):
        user, there = (free_user(), 0) if os.getuid() == 0 else (None, own_threads())
        self.calls.set_threads(4)
        self.right.clear()
        lack = Lack("", user=user)
        try:
            subprocess.run([self.arguments.programs / "lfmerge", "--version"], preexec_fn=lack.begin, check=True,
                           stdout=subprocess.DEVNULL)
        except OSError as error:
            print(f"processes: skipped: another user cannot run the programs: {error}")
        else:
            # With several threads, chance decides which encoded image lies in which shard.
            for call in (call for call in self.chosen() if not call.name.endswith("shards")):
                for count in ALL_PROCESSES if self.arguments.all else PROCESSES:
                    self.try_call("processes", call, Lack(f"{count} processes and threads",
                                                          {resource.RLIMIT_NPROC: there + count}, user=user))
        self.calls.set_threads(1)
        self.right.clear()

    def streams(self):
        for number, call in enumerate(self.chosen()):
            closed = [(0,), (1,), (2,), (0, 1, 2)]
            for streams in closed if self.arguments.all else (closed[number % 3], closed[3]):
                self.try_call("streams", call, Lack(f"streams {streams} closed", closed=streams))

    def locale(self):
        folder = self.folder / "locales"
        folder.mkdir()
        made = shutil.which("localedef") and subprocess.run(
            ["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], capture_output=True, check=False)
        environment = {"LOCPATH": str(folder), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
        point = subprocess.run([sys.executable, "-c", "import locale; locale.setlocale(locale.LC_ALL, ''); "
                                "print(locale.localeconv()['decimal_point'])"], env={**os.environ, **environment},
                               capture_output=True, text=True, check=False).stdout.strip()
        if not made or point != ",":
            print("locale: skipped: localedef makes no de_DE.UTF-8 (Debian: packages libc-bin and locales)")
            return
        for call in self.chosen():
            self.try_call("locale", call, Lack("decimal comma", environment=environment))

    def disk(self):
        """Tests limits of the disk, in its own mount namespace."""
        if "LF_OWN_MOUNTS" not in os.environ:
            self.disk_elsewhere()
            return
        values = ALL_DISK_SIZES if self.arguments.all else DISK_SIZES
        self.fresh = lambda: self.mount("size=64m")
        for number, call in enumerate(self.chosen()):
            self.right_of(call)
            for value in values if self.arguments.all else values[number % EVERY::EVERY]:
                options = value.replace("inodes ", "size=64m,nr_inodes=") if "inodes" in value else f"size={value}"
                self.fresh = lambda options=options: self.mount(options)
                self.try_call("disk", call, Lack(f"a disk of {value}"), lambda: self.mount_again(
                    "remount,size=64m,nr_inodes=10000"))
                self.fresh = lambda: self.mount("size=64m")
        subprocess.run(["umount", self.work], check=True)

    def disk_elsewhere(self):
        """Starts this test again in an environment where it may mount."""
        words = [word for word in ("unshare -m", "unshare -rm")
                 if subprocess.run([*word.split(), "mount", "-t", "tmpfs", "tmpfs", self.work], check=False,
                                   capture_output=True).returncode == 0]
        if not words:
            print("disk: skipped: nothing may be mounted here")
            return
        again = [*words[0].split(), sys.executable, run_test.__file__, __file__, str(self.arguments.programs),
                 "--part", "disk", "--only", self.arguments.only]
        again += ["--all"] * self.arguments.all + ["--say"] * self.arguments.say
        done = subprocess.run(again, env={**os.environ, "LF_OWN_MOUNTS": "1"}, check=False, text=True,
                              stdout=subprocess.PIPE)
        for line in done.stdout.splitlines():
            counts = re.fullmatch(r"disk +(\w+) +(\d+) tries +(\d+) survived", line)
            if counts:
                self.tries["disk", counts[1]] = int(counts[2])
                self.survived["disk", counts[1]] = int(counts[3])
                self.failures += int(counts[2]) - int(counts[3])
            elif not line.endswith(" failures"):
                print(line, flush=True)
        self.failures += done.returncode not in (0, 1)

    def mount(self, options):
        while os.path.ismount(self.work):
            subprocess.run(["umount", self.work], check=True)
        self.mount_again(options)

    def mount_again(self, options):
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", self.work], check=True)

    def names(self):
        odd_places.try_names(self.calls, self.folder / "names", self.note, self.arguments)

    def inputs(self):
        odd_places.try_inputs_as_outputs(self.calls, self.folder / "inputs", self.note, self.arguments)

    def table(self):
        for part, program in sorted(self.tries):
            tries = self.tries[part, program]
            print(f"{part:10} {program:14} {tries:5} tries {self.survived[part, program]:5} survived")
        print(f"{sum(self.tries.values())} tries, {self.failures} failures", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--part", choices=PARTS)
    parser.add_argument("--only", default="")
    parser.add_argument("--say", action="store_true")
    arguments = parser.parse_args()
    arguments.programs = arguments.programs.resolve()
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)  # other users run the programs
        environments = Environments(arguments, pathlib.Path(folder).resolve())
        for part in PARTS:
            if arguments.part in (None, part):
                getattr(environments, part)()
        environments.table()
    return 1 if environments.failures else 0


if __name__ == "__main__":
    sys.exit(main())
