# SPDX-License-Identifier: Apache-2.0
"""The processor time of a process and of its descendants, for tests that measure while other tests run."""
import os
import pathlib

TICKS = os.sysconf("SC_CLK_TCK")


def processes_of(pid):
    """Returns the ids of a process and of its descendants."""
    found = [pid]
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            for child in pathlib.Path(f"/proc/{pid}/task/{thread}/children").read_text().split():
                found += processes_of(int(child))
    except OSError:
        pass  # it has ended meanwhile
    return found


def cpu_s(pid):
    """Returns the processor time of a process so far; 0 if it has ended."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return 0 if fields[0] == "Z" else (int(fields[11]) + int(fields[12])) / TICKS


class Clock:
    """Adds up the processor time of a process and its descendants, including those that end meanwhile."""

    def __init__(self, pid):
        self.pid, self.known = pid, {}

    def look(self):
        for pid in processes_of(self.pid):
            self.known[pid] = max(self.known.get(pid, 0), cpu_s(pid))
        return sum(self.known.values())
