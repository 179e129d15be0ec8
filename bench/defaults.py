#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes and checks bench/defaults.txt: the defaults of the programs, which figures depend on.

usage: bench/defaults.py FOLDER            prints the defaults of the programs in the folder
       bench/defaults.py FOLDER --write    writes them into bench/defaults.txt
       bench/defaults.py FOLDER --check    exits with 1 if bench/defaults.txt says otherwise

FOLDER  with lfrenderer, lfpreprocessor, ..., such as build/release/bin

A default is read from the program itself: the line "Default: ..." that --help-all shows below an option. What
`auto` becomes is read from the reports of two small renders, one of RGB images and one of mosaics. An option
without a default, such as a flag that is off, is not listed. Neither is --progress: it changes no picture and no speed.
The order is that of bench/defaults.txt, and new options come last: help may be arranged anew without another hash.

Each table's record holds the lines of the programs that made it, and their hash (bench/record.py). The check
`tables` of scripts/check_house.py reports tables that were made with defaults that differ today.
"""
import argparse
import functools
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

LISTING = pathlib.Path(__file__).resolve().parent / "defaults.txt"
PROGRAMS = ("lfsynth", "lfimport", "lfexample", "lfpreprocessor", "lfcompressor", "lfrenderer", "lfmerge",
            "lfsubmit")
NOT_LISTED = {"--progress"}
# Match "  -o, --output DIR    Folder of the frames" and "      Default: 0 (all); values: 0 to 180" in --help-all.
OPTION = re.compile(r"^  (?:-\w, )?(--[\w-]+)")
DEFAULT = re.compile(r"^      Default: ([^\s;]+)")
RESOLVED = ("ray_model", "estimator", "filter", "lens_weights", "back_end", "order")
HEAD = """\
# Defaults of the programs, that figures depend on. Made by bench/defaults.py, which tells more;
# a test compares them with what the programs say.
"""


def hash_of(lines):
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def options_of(program):
    """Returns ["--memory 8G", ...] as --help-all shows them, in the order of bench/defaults.txt."""
    text = subprocess.run([program, "--help-all"], check=True, capture_output=True, text=True).stdout
    found, option = {}, None
    for line in text.splitlines():
        if match := OPTION.match(line):
            option = match[1]
        elif (match := DEFAULT.match(line)) and option not in NOT_LISTED:
            found[option] = "[]" if match[1] == "empty" else match[1]
    order = [words[1] for words in map(str.split, listed()) if words[0] == program.name]
    names = sorted(found, key=lambda name: order.index(name) if name in order else len(order))
    return [f"{name} {found[name]}" for name in names]


def resolved(folder):
    """Returns what a render that names no options reports about itself, for RGB images and for mosaics."""
    lines = []
    with tempfile.TemporaryDirectory() as temporary:
        work = pathlib.Path(temporary)
        for name, options in (("RGB", ["--format", "png"]), ("mosaic", ["--bayer"])):
            field, path, out = (work / f"{name}{suffix}" for suffix in ("", ".yaml", "-frames"))
            for words in ([folder / "lfsynth", "lights", "-o", field, "--count", "9", "--size", "16x16",
                           "--samples", "1", *options],
                          [folder / "lfexample", field, "-o", path],
                          [folder / "lfrenderer", field, path, "-o", out, "--frames", "1", "--no-contact-sheet"]):
                subprocess.run([*words, "-q"], check=True, capture_output=True)
            inputs = json.loads((out / "report.json").read_text())["inputs"]
            lines.append(f"{name}: " + ", ".join(f"{key} {inputs[key]}" for key in RESOLVED if key in inputs))
    return lines


@functools.lru_cache(maxsize=None)
def of_program(program):
    """Returns the lines of one program, each after the program's name."""
    lines = options_of(program)
    if program.name == "lfrenderer":
        lines += resolved(program.parent)
    return [f"{program.name} {line}" for line in lines]


def of_programs(programs):
    """Returns the lines of the programs (paths), in the order of PROGRAMS; other programs have none."""
    by_name = {program.name: program for program in programs}
    return [line for name in PROGRAMS if name in by_name for line in of_program(by_name[name])]


def listed(listing=LISTING):
    """Returns the lines of bench/defaults.txt."""
    return [line for line in listing.read_text().splitlines() if line and not line.startswith("#")]


def difference(old, new):
    """Returns the lines that are in only one of `old` and `new`, for messages."""
    return [f"- {line}" for line in old if line not in new] + [f"+ {line}" for line in new if line not in old]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    lines = of_programs([folder / name for name in PROGRAMS])
    if arguments.write:
        LISTING.write_text(HEAD + "\n".join(lines) + "\n")
    elif arguments.check:
        changes = difference(listed(), lines)
        if changes or listed() != lines:
            print("\n".join(changes) or "the lines are in another order")
            print(f"bench/defaults.txt is not what the programs say: bench/defaults.py {arguments.folder} --write, "
                  "and make again the tables that scripts/check_house.py . tables names")
            return 1
        print(f"{len(lines)} defaults, as listed")
    else:
        print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
