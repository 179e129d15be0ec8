# SPDX-License-Identifier: Apache-2.0
"""Lists and reads the files of the repository, for the rules of check_house.py."""
import functools
import pathlib
import subprocess


def tracked_files(root: pathlib.Path) -> list:
    """Returns the files that git knows; in an unpacked archive, all files except build outputs."""
    git = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True)
    if git.returncode == 0 and git.stdout:
        names = [root / name for name in git.stdout.decode().split("\0") if name]
        return sorted(name for name in names if name.is_file())
    skipped = {"build", "demo-output", ".git"}
    return sorted(p for p in root.rglob("*")
                  if p.is_file() and p.relative_to(root).parts[0] not in skipped)


@functools.lru_cache(maxsize=None)
def text_lines(path: pathlib.Path) -> tuple:
    """Returns the lines of a text file, or none for a binary one (it contains a NUL)."""
    data = path.read_bytes()
    return () if b"\0" in data else tuple(data.decode("utf-8", "replace").splitlines())
