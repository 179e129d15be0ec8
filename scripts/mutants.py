#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Plants mistakes into a copy of the project, one at a time, and reports those that no test notices.

scripts/mutants.py BUILD_DIR -o mutants.json             every mutant of scripts/mutants.toml
scripts/mutants.py BUILD_DIR -o mutants.json --resume    resumes; mutants that survived are tried again
scripts/mutants.py BUILD_DIR --only count-limit,red-is-counted
scripts/mutants.py --list
scripts/mutants.py --again mutants.json --write doc/mutants.md

The working tree is only read: it is copied with its build folder, which must be up to date, and the copy is
mounted in the place of the original in a mount namespace of its own (root, or user namespaces), so that only
what a mutant changes is built. Before that, the tests must pass without any mutant. The exit code is 3 if a mutant
survived, or could not be built.
"""
import argparse
import collections
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scripts/house")]

import record
from mutant_list import LIST, planted, read_list

KILLED, SURVIVED, BROKEN = "killed", "survived", "does not build"
BUILD_LIMIT_S = 900
SKIPPED_FOLDERS = {"build", ".git", "__pycache__", "demo-output"}


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, help="an up-to-date build folder")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="JSON", help="where each outcome is kept")
    parser.add_argument("--resume", action="store_true", help="go on with JSON: killed mutants are left out")
    parser.add_argument("--only", metavar="NAME,...", help="these mutants alone")
    parser.add_argument("--list", action="store_true", help="print the mutants and end")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N")
    parser.add_argument("--timeout", type=int, default=600, metavar="S",
                        help="seconds after which a test counts as failed")
    parser.add_argument("--scratch", type=pathlib.Path, metavar="DIR", help="where the copy lies for a while")
    record.add_options(parser)
    options = parser.parse_args()
    if not (options.again or options.list or options.build):
        parser.error("BUILD_DIR, --list or --again JSON is needed")
    return options


def chosen(options):
    mutants = read_list(ROOT / LIST)
    if not options.only:
        return mutants
    names = options.only.split(",")
    unknown = set(names) - {mutant.name for mutant in mutants}
    if unknown:
        sys.exit(f"error: --only: there is no mutant {', '.join(sorted(unknown))}")
    return [mutant for mutant in mutants if mutant.name in names]


def hash_of(mutant):
    """Returns a hash of everything that decides the outcome of a mutant, except for the code and its tests."""
    return hashlib.sha256(repr(mutant).encode()).hexdigest()[:12]


class Copy:
    """A copy of the project with its build folder, mounted in the place of the original."""

    def __init__(self, build, scratch):
        self.build = build.resolve()
        if not self.build.is_relative_to(ROOT) or not (self.build / "build.ninja").exists():
            sys.exit(f"error: {build}: is no build folder of Ninja in {ROOT}")
        self.tree = scratch / "tree"
        self.pristine = scratch / "pristine"
        if subprocess.run(self.unshared("true"), capture_output=True).returncode != 0:
            sys.exit("error: unshare --mount fails: root or user namespaces are needed")
        skipped = lambda folder, names: [n for n in names if pathlib.Path(folder) == ROOT and n in SKIPPED_FOLDERS]
        shutil.copytree(ROOT, self.tree, symlinks=True, ignore=skipped)
        self.work = self.tree / self.build.relative_to(ROOT)
        shutil.copytree(self.build, self.work, symlinks=True)

    @staticmethod
    def unshared(text):
        """Returns the words of a command that runs the text with bash in its own mount namespace."""
        own = [] if os.geteuid() == 0 else ["--map-root-user"]
        return ["unshare", "--mount", *own, "bash", "-c", text]

    def run(self, command, limit_s):
        """Runs a command in the build folder of the copy. Returns its exit code (None: too slow) and its output."""
        text = (f"mount --bind {shlex.quote(str(self.tree))} {shlex.quote(str(ROOT))} && "
                f"cd {shlex.quote(str(self.build))} && exec {shlex.join(command)}")
        process = subprocess.Popen(self.unshared(text), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   text=True, errors="replace", start_new_session=True)
        try:
            output = process.communicate(timeout=limit_s)[0]
            return process.returncode, output
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return None, process.communicate()[0]
        except KeyboardInterrupt:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            raise

    def keep(self):
        """Stores the state of the build folder to which `restore` returns."""
        shutil.rmtree(self.pristine, ignore_errors=True)
        shutil.copytree(self.work, self.pristine, symlinks=True)

    def restore(self):
        """Restores changed files of the build folder with their times, so that Ninja finds nothing to do."""
        def files_of(folder):
            stats = {}
            for path in folder.rglob("*"):
                if path.is_file() or path.is_symlink():
                    status = path.lstat()
                    stats[path.relative_to(folder)] = (status.st_size, status.st_mtime_ns)
            return stats
        now, before = files_of(self.work), files_of(self.pristine)
        for name in now.keys() - before.keys():
            (self.work / name).unlink()
        for name, status in before.items():
            if now.get(name) != status:
                (self.work / name).parent.mkdir(parents=True, exist_ok=True)
                (self.work / name).unlink(missing_ok=True)
                shutil.copy2(self.pristine / name, self.work / name, follow_symlinks=False)

    def build_targets(self, targets, jobs):
        return self.run(["ninja", "-j", str(jobs), *targets], BUILD_LIMIT_S)

    def failing(self, tests, options):
        """Runs tests until one fails. Returns the names of failed tests, and how many tests ran."""
        report = self.work / "mutants.xml"
        report.unlink(missing_ok=True)
        code, output = self.run(["ctest", "-R", tests, "-j", str(options.jobs), "--stop-on-failure",
                                 "--no-tests=error", "--timeout", str(options.timeout),
                                 "--output-junit", report.name], 2 * options.timeout + 60)
        if code is None:
            return [f"{tests} (too slow)"], 1
        if not report.exists():
            sys.exit(f"error: ctest -R '{tests}' ended with {code}:\n{output[-2000:]}")
        cases = xml.etree.ElementTree.parse(report).getroot().findall("testcase")
        report.unlink()
        if unbuilt := [case.get("name") for case in cases if case.get("name").endswith(".is_not_built")]:
            sys.exit(f"error: {unbuilt[0]}: build all tests before, because ctest stops at this one")
        ran = [case for case in cases if case.get("status") in ("run", "fail")]
        return [case.get("name") for case in ran if case.get("status") == "fail"], len(ran)


def try_mutant(copy, mutant, options):
    """Returns the outcome of one mutant, as a dictionary for the record."""
    path = copy.tree / mutant.file
    before, status = path.read_text(), path.stat()
    begin_s = time.monotonic()
    path.write_text(planted(mutant, before))
    try:
        code, output = copy.build_targets(mutant.targets, options.jobs)
        build_s = time.monotonic() - begin_s
        if code != 0:
            return {"outcome": BROKEN, "detail": output[-1500:], "seconds": round(build_s)}
        failing, ran = copy.failing(mutant.tests, options)
        if ran == 0:
            sys.exit(f"error: {mutant.name}: all tests like {mutant.tests} are skipped here")
        return {"outcome": KILLED if failing else SURVIVED, "by": failing[:1], "build_s": round(build_s),
                "seconds": round(time.monotonic() - begin_s)}
    finally:
        path.write_text(before)
        os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
        copy.restore()


def check_baseline(copy, mutants, options):
    """Ends the script unless the tests pass without a mutant."""
    targets = sorted({target for mutant in mutants for target in mutant.targets})
    code, output = copy.build_targets(targets, options.jobs)
    if code != 0:
        sys.exit(f"error: the copy does not build without a mutant either:\n{output[-3000:]}")
    copy.keep()
    # The regular expressions are joined without groups, because CMake allows at most nine groups.
    failing, ran = copy.failing("|".join(sorted({mutant.tests for mutant in mutants})), options)
    copy.restore()
    if ran == 0:
        sys.exit("error: no test ran: are they built, and none skipped?")
    if failing:
        sys.exit(f"error: without a mutant, this fails already: {', '.join(failing)}")
    print(f"without a mutant, {ran} tests pass", flush=True)


def save(path, result):
    if path:
        record.write_json(path, result)


def run(options):
    mutants = chosen(options)
    result = {**record.context(), "commands": [shlex.join(map(record.shown, sys.argv))], "defaults": [],
              "defaults_hash": hashlib.sha256(b"").hexdigest()[:16], "mutants": {}}
    if options.resume and options.output and options.output.exists():
        old = json.loads(options.output.read_text())["mutants"]
        result["mutants"] = {m.name: old[m.name] for m in read_list(ROOT / LIST)
                             if old.get(m.name, {}).get("hash") == hash_of(m)}
    killed = {name for name, outcome in result["mutants"].items() if outcome["outcome"] == KILLED}
    todo = [mutant for mutant in mutants if mutant.name not in killed]
    if not todo:
        return result
    with tempfile.TemporaryDirectory(prefix="mutants-", dir=options.scratch) as scratch:
        copy = Copy(options.build, pathlib.Path(scratch))
        check_baseline(copy, todo, options)
        for number, mutant in enumerate(todo, 1):
            outcome = try_mutant(copy, mutant, options)
            result["mutants"][mutant.name] = {"hash": hash_of(mutant), "sources": result["sources"], **outcome}
            save(options.output, result)
            by = f" by {outcome['by'][0]}" if outcome.get("by") else ""
            print(f"[{number}/{len(todo)}] {mutant.name}: {outcome['outcome']}{by} in {outcome['seconds']} s",
                  flush=True)
            if outcome["outcome"] == BROKEN:
                print(outcome["detail"], flush=True)
    return result


def summary(result):
    """Returns the table of a page: the number of killed mutants per area, and the survivors."""
    mutants = [mutant for mutant in read_list(ROOT / LIST) if mutant.name in result["mutants"]]
    outcome = lambda mutant: result["mutants"][mutant.name]["outcome"]
    of_area = collections.defaultdict(list)
    for mutant in mutants:
        of_area[mutant.area].append(mutant)
    killed = sum(outcome(mutant) == KILLED for mutant in mutants)
    seconds = sum(entry["seconds"] for entry in result["mutants"].values())
    lines = [record.sentence(result), "",
             f"{killed} of {len(mutants)} mutants are killed; {seconds / 60:.0f} minutes of building and testing.", "",
             "| area | killed | of | killed by, for example |", "| --- | --- | --- | --- |"]
    for area, members in sorted(of_area.items()):
        dead = [mutant for mutant in members if outcome(mutant) == KILLED]
        example = f"{dead[0].name}: {result['mutants'][dead[0].name]['by'][0]}" if dead else ""
        lines.append(f"| {area} | {len(dead)} | {len(members)} | {example} |")
    left = [mutant for mutant in mutants if outcome(mutant) != KILLED]
    if left:
        lines += ["", "| survived | where | effect |", "| --- | --- | --- |"]
        lines += [f"| {mutant.name} | `{mutant.file}` | {mutant.effect} |" for mutant in left]
    return "\n".join(lines) + "\n"


def main():
    options = parse()
    if options.list:
        for mutant in chosen(options):
            print(f"{mutant.name}  {mutant.file}: {mutant.effect}")
        return 0
    result = json.loads(options.again.read_text()) if options.again else run(options)
    record.publish(options, "scripts/mutants.py", result, summary(result))
    return 3 if any(entry["outcome"] != KILLED for entry in result["mutants"].values()) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("interrupted; --resume goes on with what -o has")
