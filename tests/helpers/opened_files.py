# SPDX-License-Identifier: Apache-2.0
"""Counts how often the files of a folder are opened, by inotify of Linux."""
import collections
import ctypes
import os
import struct

_IN_OPEN = 0x20
_EVENT = struct.Struct("iIII")  # watch, mask, cookie, length of the name behind it
_LIBC = ctypes.CDLL(None, use_errno=True)


class OpenedFiles:
    """Counts from the beginning of a with statement on.

    folder  folder whose files are watched; files in folders below it are not
    """

    def __init__(self, folder):
        self.folder = folder

    def __enter__(self):
        self.watch = _LIBC.inotify_init1(os.O_NONBLOCK)
        if self.watch < 0 or _LIBC.inotify_add_watch(self.watch, os.fsencode(self.folder), _IN_OPEN) < 0:
            raise OSError(ctypes.get_errno(), "inotify cannot watch", str(self.folder))
        return self

    def __exit__(self, *_):
        os.close(self.watch)

    def counts(self):
        """Returns {name: how often it was opened} since the last call."""
        counts = collections.Counter()
        while True:
            try:
                events = os.read(self.watch, 1 << 16)
            except BlockingIOError:
                return counts
            while events:
                _, mask, _, length = _EVENT.unpack_from(events)
                name = events[_EVENT.size:_EVENT.size + length].rstrip(b"\0")
                if mask & _IN_OPEN and name:
                    counts[os.fsdecode(name)] += 1
                events = events[_EVENT.size + length:]
