# SPDX-License-Identifier: Apache-2.0
"""Computes the content of a disk after a power failure, from the log of tests/faults/written_log.c.

Two disks are modelled. The patient disk does not store names before their folder is flushed. The hasty disk stores
names at once, in order. Neither disk stores any byte of a file that was not flushed.
"""
import pathlib


class File:
    def __init__(self, content=b""):
        self.flushed = content


class Folder:
    """entries: the content that programs see; kept: the content that is on the disk"""

    def __init__(self):
        self.entries, self.kept = {}, {}


def read_log(log):
    """Returns the events, each with the content of the file that it flushes, or None."""
    events = []
    for line in log.read_text(errors="surrogateescape").splitlines():
        kind, first, second = line.split("\t")
        content = pathlib.Path(f"{log}.{second}").read_bytes() if kind == "flush" else None
        events.append((kind, pathlib.Path(first), pathlib.Path(second), content))
    return events


class Disk:
    """The disk under a folder, whose present content is already stored."""

    def __init__(self, root, is_hasty):
        self.root, self.is_hasty = root, is_hasty
        self.top = self._read(root)

    def _read(self, path):
        if not path.is_dir():
            return File(path.read_bytes())
        folder = Folder()
        folder.entries = {child.name: self._read(child) for child in path.iterdir()}
        folder.kept = dict(folder.entries)
        return folder

    def _find(self, path):
        node = self.top
        for name in path.relative_to(self.root).parts:
            node = node.entries[name]
        return node

    def _folder(self, path):
        return self._find(path.parent)

    def happens(self, kind, first, second, content):
        """Applies one event of the log. KeyError if the log lacks an earlier event."""
        if kind in ("make", "folder"):
            self._folder(first).entries[first.name] = File() if kind == "make" else Folder()
        elif kind == "cut":
            if self.is_hasty:
                self._find(first).flushed = b""
        elif kind == "flush":
            if not first.name.endswith(" (deleted)"):
                self._find(first).flushed = content
        elif kind == "flush_folder":
            folder = self._find(first)
            folder.kept = dict(folder.entries)
        elif kind == "rename":
            self._folder(second).entries[second.name] = self._folder(first).entries.pop(first.name)
        elif kind == "remove":
            self._folder(first).entries.pop(first.name)
        else:
            raise ValueError(f"{kind}: no such event")

    def content(self):
        """Returns what the disk holds: the bytes of each file by its name, and None for each folder."""
        found = {}

        def visit(folder, at):
            for name, node in (folder.entries if self.is_hasty else folder.kept).items():
                found[f"{at}{name}"] = None if isinstance(node, Folder) else node.flushed
                if isinstance(node, Folder):
                    visit(node, f"{at}{name}/")
        visit(self.top, "")
        return found

    def names_seen(self):
        """Returns the names that programs see."""
        found = set()

        def visit(folder, at):
            for name, node in folder.entries.items():
                found.add(f"{at}{name}")
                if isinstance(node, Folder):
                    visit(node, f"{at}{name}/")
        visit(self.top, "")
        return found


def write_content(content, folder):
    """Fills an empty folder with what a disk held."""
    for name, written in sorted(content.items()):
        if written is None:
            (folder / name).mkdir(parents=True, exist_ok=True)
    for name, written in content.items():
        if written is not None:
            (folder / name).write_bytes(written)
