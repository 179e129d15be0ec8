# SPDX-License-Identifier: Apache-2.0
"""Runs programs on hostile files with limits of memory, time and temporary disk, and records how much of each they
used."""
import concurrent.futures
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time

MIB = 1 << 20
CPU_LIMIT_S = 60  # CPU time after which a run is killed; a run on good files takes less than a tenth of a second
ADDRESS_LIMIT = 8 << 30
FILE_LIMIT = 1024 * MIB
WAIT_S = 240


def _limit():
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT_S, CPU_LIMIT_S))
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_LIMIT, ADDRESS_LIMIT))
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_LIMIT, FILE_LIMIT))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Run:
    """The outcome of one call of a program."""

    def __init__(self, name, words, folder, environment):
        self.name, self.words = name, [str(word) for word in words]
        temporary = tempfile.mkdtemp(prefix="tmp ", dir=folder)
        with tempfile.TemporaryFile() as said, tempfile.TemporaryFile() as out:
            process = subprocess.Popen(self.words, stdout=out, stderr=said, stdin=subprocess.DEVNULL,
                                       env={**os.environ, **environment, "TMPDIR": temporary}, preexec_fn=_limit)
            timer = threading.Timer(WAIT_S, process.kill)
            timer.start()
            _, status, usage = os.wait4(process.pid, 0)
            timer.cancel()
            process.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            self.errors = said.read().decode(errors="replace")
            self.out_bytes = os.fstat(out.fileno()).st_size
        self.code = process.returncode
        self.peak_mib = usage.ru_maxrss / 1024
        self.cpu_s = usage.ru_utime + usage.ru_stime
        self.left_behind = sorted(str(path) for path in pathlib.Path(temporary).rglob("*"))
        shutil.rmtree(temporary)

    @property
    def last_line(self):
        lines = self.errors.strip().splitlines()
        return lines[-1] if lines else ""


class BoundedRuns:
    """Runs many programs in parallel and keeps the largest use of each kind.

    folder      for temporary files
    memory_mib  larger use is a fault
    """

    def __init__(self, folder, memory_mib):
        self.folder, self.memory_mib = folder, memory_mib
        self.kinds = {}
        self.faults = []
        self.begin = time.monotonic()

    def all(self, kind, calls, accepts=(2, 3, 6)):
        """Runs `calls`, which are (name, words) or (name, words, environment). A run must end with a status in
        `accepts`."""
        calls = [(*call, {})[:3] for call in calls]
        assert calls, kind
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            runs = list(pool.map(lambda call: Run(call[0], call[1], self.folder, call[2]), calls))
        for run in runs:
            self._judge(kind, run, accepts)
        self.kinds.setdefault(kind, []).extend(runs)
        return runs

    def _judge(self, kind, run, accepts):
        def fault(text):
            self.faults.append(f"{kind}, {run.name}: {text}\n    {' '.join(run.words)}\n    {run.errors[-400:]}")
        if run.code not in accepts:
            fault(f"exit code {run.code}, expected one of {accepts}")
        elif run.code != 0 and not run.last_line.startswith("error: "):
            fault("the last line is no error")
        if "this is a bug" in run.errors:
            fault("it calls itself a bug")
        if run.peak_mib > self.memory_mib:
            fault(f"{run.peak_mib:.0f} MiB")
        if run.left_behind:
            fault(f"temporary files: {run.left_behind[:3]}")

    def table(self):
        lines = [f"{'kind':34} {'runs':>5} {'refused':>7} {'MiB':>5} {'CPU s':>6}  worst"]
        for kind, runs in self.kinds.items():
            refused = sum(run.code != 0 for run in runs)
            largest = max(runs, key=lambda run: run.peak_mib)
            longest = max(runs, key=lambda run: run.cpu_s)
            lines.append(f"{kind:34} {len(runs):5} {refused:7} {largest.peak_mib:5.0f} {longest.cpu_s:6.2f}  "
                         f"{largest.name}; {longest.name}")
        total = sum(map(len, self.kinds.values()))
        lines.append(f"{total} runs, {len(self.faults)} faults, {time.monotonic() - self.begin:.0f} s")
        return "\n".join(lines)

    def report(self):
        print(self.table(), file=sys.stderr)
        return "\n".join(self.faults)
