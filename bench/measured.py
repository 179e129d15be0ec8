#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs one command and writes how much time, memory, files and disk it used, and how many bytes it read, as JSON, into
RESULT.

usage: measured.py RESULT PERIOD_S FOLDER COMMAND...

PERIOD_S  time between counts of the open files and of the space that FOLDER takes; 0: nothing is counted
FOLDER    a folder that the command writes to; - for none

bench/record.py starts it. It stands between a script and the program that is measured because Linux counts
the peak memory of the process that calls exec() as the peak of the program that it becomes: a script that has
loaded NumPy would add its own 100 MiB to every figure. This file imports next to nothing.

Exits with the exit status of the command, or 128 and the signal that ended it.
"""
import json
import os
import sys
import time


def space_of(folder):
    """Returns the bytes on the disk of the files in the folder and its subfolders."""
    total = 0
    try:
        for entry in os.scandir(folder):
            try:
                if entry.is_dir(follow_symlinks=False):
                    total += space_of(entry.path)
                else:
                    total += 512 * entry.stat(follow_symlinks=False).st_blocks
            except FileNotFoundError:  # a temporary file that was renamed in the meantime
                continue
    except FileNotFoundError:
        return 0
    return total


def read_bytes_of(pid):
    """Returns the bytes that a process has read by system calls, also one that has ended and is not yet waited for."""
    with open(f"/proc/{pid}/io") as counts:
        return next(int(line.split()[1]) for line in counts if line.startswith("rchar:"))


def watch(pid, period_s, folder):
    """Samples the process until it ends. Returns (most open files, most bytes in the folder)."""
    files = space = 0
    while not os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT | os.WNOHANG):
        try:
            files = max(files, len(os.listdir(f"/proc/{pid}/fd")))
        except OSError:  # the process is ending
            pass
        if folder != "-":
            space = max(space, space_of(folder))
        time.sleep(period_s)
    return files, space


def main():
    result, period_s, folder, *command = sys.argv[1:]
    begin = time.monotonic()
    pid = os.fork()
    if pid == 0:
        try:
            os.execvp(command[0], command)
        except OSError as error:
            print(f"{command[0]}: {error.strerror}", file=sys.stderr, flush=True)
        os._exit(127)
    files = space = 0
    if float(period_s) > 0:
        files, space = watch(pid, float(period_s), folder)
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    seconds = time.monotonic() - begin
    read_bytes = read_bytes_of(pid)
    _, status, usage = os.wait4(pid, 0)
    with open(result, "w") as out:
        json.dump({"seconds": seconds, "cpu_s": usage.ru_utime + usage.ru_stime,
                   "peak_bytes": usage.ru_maxrss * 1024, "open_files": files, "folder_bytes": space,
                   "read_bytes": read_bytes}, out)
    code = os.waitstatus_to_exitcode(status)
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(main())
