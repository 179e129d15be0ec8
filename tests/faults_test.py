#!/usr/bin/python3
"""Every program, while one call of the system fails: the k-th write, flush, rename, ... or allocation.

A program may end with 0 only if its files are those of an undisturbed run, and no temporary file is
left. Else its status is 3, 4 or 6 (6 where a disk cannot give an LF image, which is left out and
told), its last line begins with "error: ", every file that has its final name is the old one or the
right one, and going on, or the same call once more, ends with the right files.

usage: faults_test.py SHIM FOLDER_OF_PROGRAMS [--points N] [--only WORD] [--say]

--points  calls that fail of each group: of one kind, by one function, on files of one pattern
          (default 1; 0: all of them, which takes hours)
--only    programs whose name holds the word
--say     print every try
"""
import argparse
import collections
import hashlib
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

EIO, EINTR = 5, 4
# What fails how: a number of errno, or "short" or "kill"; "+" from there on always.
WAYS = {"open": ["24", "5"], "read": ["5", "short", "4"], "write": ["28+", "5", "short", "4", "kill"],
        "fsync": ["5", "kill"], "rename": ["28", "kill"], "unlink": ["5"], "mkdir": ["28"], "stat": ["5"],
        "mmap": ["12"], "thread": ["11+"], "malloc": ["12"]}
GROUPS_OF_MALLOC = 6  # sizes are no pattern: so many points for all of them
TEMPORARY = re.compile(r"^\..*\.tmp|\.unfinished|-journal$|(^|\.)lock$")


class Case:
    """One call of a program, in a folder of its own."""

    def __init__(self, name, command, again=None):
        self.name, self.command, self.again = name, command, again or command


def store_digest(path):
    """of the tables, but for what differs from run to run"""
    database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
    digest = hashlib.sha256()
    for (table,) in sorted(database.execute("select name from sqlite_master where type = 'table'")):
        for row in database.execute(f"select * from {table} order by 1"):
            # Lengths of image files are for people, and unknown where stat() fails.
            if table == "codes":
                row = row[:-1]
            elif table == "lf_images" and path.suffix == ".lfp":
                row = row[:10] + row[11:]
            if table != "settings" or row[0] not in ("store",):
                digest.update(repr(row).encode())
    database.close()
    return digest.hexdigest()


def digest(path):
    if path.suffix in (".lfs", ".lfp"):
        return store_digest(path)
    if path.name in ("report.json", "run.json") or "report" in path.name:
        json.loads(path.read_text())  # times differ
        return "a report"
    return hashlib.sha256(path.read_bytes()).hexdigest()


class Hunt:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.work, self.base = folder / "work", folder / "base"
        self.trace, self.log = folder / "trace", folder / "log"
        self.tried, self.failures = collections.Counter(), []

    def call(self, command, fault=None):
        environment = dict(os.environ, FAULT_PATH=str(self.folder))
        if fault is not None:
            environment.update(fault, LD_PRELOAD=str(self.arguments.shim),
                               FAULT_PROGRAM=pathlib.Path(command[0]).name)
        try:
            result = subprocess.run(list(map(str, command)), env=environment, capture_output=True, timeout=120,
                                    stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return "hangs", ""
        return result.returncode, result.stderr.decode("utf8", "replace")

    def fresh(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()

    def files(self):
        """final files and what they hold, and temporary ones"""
        final, temporary = {}, []
        for path in sorted(self.work.rglob("*")):
            name = str(path.relative_to(self.work))
            if not path.is_file() or "partial" in name.split("/"):
                continue
            if TEMPORARY.search(path.name):
                temporary.append(name)
                continue
            try:
                final[name] = digest(path)
            except (ValueError, sqlite3.Error) as error:
                final[name] = f"damaged: {error}"
        return final, temporary

    def points(self, trace):
        """the calls that shall fail, by kind"""
        groups = collections.defaultdict(list)
        for line in trace.splitlines():
            kind, k, function, path = line.split(" ", 3)
            groups[kind, function, re.sub(r"\d+", "#", path)].append(int(k))
        chosen = collections.defaultdict(set)
        for (kind, _, _), calls in groups.items():
            most = self.arguments.points * (GROUPS_OF_MALLOC if kind == "malloc" else 1)
            if most == 0 or len(calls) <= most:
                chosen[kind].update(calls)
            elif most == 1:
                chosen[kind].add(calls[-1])
            else:
                chosen[kind].update(calls[round(i * (len(calls) - 1) / (most - 1))] for i in range(most))
        return {kind: sorted(calls) for kind, calls in chosen.items()}

    def judge(self, case, kind, way, code, errors, right):
        final, temporary = self.files()
        last = errors.strip().splitlines()[-1] if errors.strip() else ""
        faults = []
        if code == 0:
            wrong = sorted(name for name in {*right, *final} if right.get(name) != final.get(name))
            if wrong:
                faults.append(f"status 0, other files: {wrong[:4]}")
            if temporary and kind != "unlink":
                faults.append(f"status 0, left over: {temporary[:4]}")
            return faults
        if code == 6 and way == str(EIO):  # a disk that cannot give an LF image: it is left out, and told
            return faults
        if way != "kill":
            if code not in (3, 4, 6):
                faults.append(f"status {code}: {last[:200]}")
            elif not last.startswith("error: "):
                faults.append(f"last line: {last[:200]}")
        if way in ("short", str(EINTR)):
            faults.append(f"not tried again: {last[:200]}")
        faults += [f"{name} is {what[:60]}, not what it should be" for name, what in final.items()
                   if what != right.get(name)]
        code, errors = self.call(case.again)
        final, temporary = self.files()
        wrong = sorted(name for name in {*right, *final} if right.get(name) != final.get(name))
        if way == "kill":  # who is killed cannot remove its own, and others do not know whose it is
            temporary = [name for name in temporary if ".tmp" not in name]
        if code != 0 or wrong or temporary:
            faults.append(f"once more: status {code}, {errors.strip().splitlines()[-1:]}, other files {wrong[:4]}, "
                          f"left over {temporary[:4]}")
        return faults

    def hunt(self, case):
        self.fresh()
        self.trace.unlink(missing_ok=True)
        code, errors = self.call(case.command, {"FAULT_TRACE": str(self.trace)})
        right, temporary = self.files()
        if code != 0 or temporary:
            self.failures.append("undisturbed")
            print(f"{case.name}: undisturbed: status {code}, left over {temporary}: {errors[-300:]}", flush=True)
            return
        for kind, calls in self.points(self.trace.read_text()).items():
            for way in WAYS[kind]:
                for k in calls:
                    self.fresh()
                    self.log.unlink(missing_ok=True)
                    code, errors = self.call(case.command, {
                        "FAULT_KIND": kind, "FAULT_K": str(k), "FAULT_ERRNO": way.rstrip("+"),
                        "FAULT_ALWAYS": str(int(way.endswith("+"))), "FAULT_LOG": str(self.log)})
                    if not self.log.exists():
                        continue
                    where = self.log.read_text().splitlines()[0].replace(str(self.folder), "")
                    faults = self.judge(case, kind, way.rstrip("+"), code, errors, right)
                    self.tried[case.name] += 1
                    if faults or self.arguments.say:
                        print(f"{case.name}: {way}: {where}: status {code}: {'; '.join(faults) or 'survived'}",
                              flush=True)
                    if faults:
                        self.failures.append(where)

    def prepare(self):
        programs = self.arguments.programs
        self.base.mkdir()
        path, field = self.base / "path.yaml", self.base / "field"
        synth = [programs / "lfsynth", "chart", "--count", "9", "--size", "48x32", "--samples", "1", "--format", "png",
                 "--threads", "1", "-q"]
        subprocess.run([*synth, "-o", field], check=True)
        subprocess.run([programs / "lfexample", field, "-o", path, "--move", "dolly", "--focus", "3", "-q"], check=True)
        render = [programs / "lfrenderer", field, path, "--frames", "1-2", "--threads", "1", "-q"]
        for shard in ("1/2", "2/2"):
            subprocess.run([*render, "-o", self.base / "shards", "--shard", shard], check=True)
        return path, field, synth, render

    def cases(self):
        programs = self.arguments.programs
        path, field, synth, render = self.prepare()
        out = self.work / "out"
        film = [*render, "-o", out, "--dump-every", "0.001s", "--keep-plates"]
        pictures = [*render, "-o", out, "--format", "png16", "--mode", "hybrid"]
        store = [programs / "lfcompressor", field, "-o", out.with_suffix(".lfs"), "--threads", "1", "-q"]
        packages = [programs / "lfpreprocessor", field, path, "-o", out, "--packages", "2", "--frames",
                    "1-2", "--threads", "1", "-q"]
        merge = [programs / "lfmerge", self.base / "shards/partial/shards", "-o", out, "--threads", "1", "-q"]
        convert = [programs / "lfimport", field, "-o", out, "-q", "--threads", "1"]
        return [Case("lfsynth", [*synth, "-o", out], [*synth, "-o", out, "--overwrite"]),
                Case("lfimport", convert, [*convert, "--force"]),
                Case("lfexample", [programs / "lfexample", field, "-o", out.with_suffix(".yaml"), "--threads", "1", "-q"]),
                Case("lfpreprocessor", packages, [*packages, "--overwrite"]),
                Case("lfcompressor", store, [*store, "--overwrite"]),
                Case("lfrenderer, collect", film, [*film, "--resume"]),
                Case("lfrenderer, hybrid", pictures, [*pictures, "--resume"]),
                Case("lfmerge", merge, [*merge, "--overwrite"])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shim", type=pathlib.Path)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--say", action="store_true")
    arguments = parser.parse_args()
    arguments.shim, arguments.programs = arguments.shim.resolve(), arguments.programs.resolve()
    with tempfile.TemporaryDirectory() as folder:
        hunt = Hunt(arguments, pathlib.Path(folder).resolve())
        for case in hunt.cases():
            if arguments.only in case.name:
                hunt.hunt(case)
    for name, count in hunt.tried.items():
        print(f"{name}: {count} tries")
    print(f"{sum(hunt.tried.values())} tries, {len(hunt.failures)} failures")
    return 1 if hunt.failures or not hunt.tried else 0


if __name__ == "__main__":
    sys.exit(main())
