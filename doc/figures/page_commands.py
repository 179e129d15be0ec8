# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of a page, for gallery.py and the test of the tutorial.

A block of commands begins with ```sh. A block that cannot run everywhere, because it needs COLMAP, Blender or
somebody's photographs, is preceded by a line <!-- run: NEEDS --> with the names of what it needs.
"""
import os
import pathlib
import re
import subprocess

BLOCK = re.compile(r"^(?:<!-- run: (?P<needs>[\w ]+) -->\n\n?)?```sh\n(?P<commands>.*?)^```$", re.M | re.S)


class Block:
    """Commands of a page: the line where they begin, what they need, and their text."""

    def __init__(self, line, needs, commands):
        self.line, self.needs, self.commands = line, needs, commands


def blocks_of(page: pathlib.Path) -> list:
    text = page.read_text()
    return [Block(text.count("\n", 0, match.start("commands")) + 1, set((match["needs"] or "").split()),
                  match["commands"]) for match in BLOCK.finditer(text)]


def run_block(block: Block, folder: pathlib.Path, programs: pathlib.Path, **variables):
    """Runs commands in a folder by bash, which stops at the first that fails. Returns (exit code, output)."""
    environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", **variables)
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", block.commands], cwd=folder, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout
