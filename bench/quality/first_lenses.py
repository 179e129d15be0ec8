#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the lenses that lfexample chooses for the captures of first_films.py without and with --densify, and makes
the table of doc/densify.md.

usage: first_lenses.py BIN [--data DIR] [--only NAME]... [--write doc/densify.md]
       first_lenses.py --again JSON [--write doc/densify.md]

BIN          the folder of the programs, such as build/release/bin
--data DIR   the folder that holds data/ and cases/ (LF_TEST_DATA, else ../shared); left out if it does not exist
--only NAME  only captures whose name contains NAME
"""
import argparse
import os
import pathlib
import re
import shlex
import sys
import tempfile

import first_films
import lens_weights
from quality import results

# The diameter of a lens of 50 mm at f/4, in focus on somebody 1.25 m away, as a share of this distance.
LIKE_F4 = 0.01


def lens_of(path):
    """Returns the diameter of the lens of a path that lfexample wrote, as a share of the focus distance."""
    text = path.read_text()
    distance = re.search(r"focus_distance: ([\d.e+-]+)", text) or re.search(r"([\d.e+-]+) from the LF camera", text)
    return float(re.search(r"aperture_diameter: ([\d.e+-]+)", text)[1]) / float(distance[1])


def try_capture(name, make, programs):
    """Returns the lens without and with --densify (None where lfexample refuses), and what it says of the second."""
    with tempfile.TemporaryDirectory(prefix="lf-first-lenses-") as scratch:
        os.chdir(scratch)
        folder = pathlib.Path(scratch)
        capture = re.sub(r"\W+", "-", name)
        make(folder / capture, programs)
        commands = first_films.Commands(programs, folder)
        field = first_films.understand(commands, capture)
        lenses, said = [], ""
        for option in ("", " --densify") if field else ():
            code, said = commands.run(f"lfexample {shlex.quote(field)} -o path.yaml --overwrite --move static{option}")
            lenses.append(lens_of(folder / "path.yaml") if code in (0, 6) else None)
        os.chdir(first_films.ROOT)
    return lenses, said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("--data", type=pathlib.Path,
                        default=os.environ.get("LF_TEST_DATA", first_films.ROOT.parent / "shared"))
    parser.add_argument("--only", action="append", default=[])
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.programs:
        parser.error("BIN or --again is needed")
    record = results.context()
    first_films.scenes.WIDTH, first_films.scenes.HEIGHT, first_films.scenes.FOCAL_PX = 400, 300, 420
    data = arguments.data.resolve()
    captures = first_films.DRAWN | (first_films.given(data) if data.is_dir() else {})
    table = lens_weights.Table("capture", "lens / focus distance", "with `--densify`")
    counts = [0, 0]
    for name, make in captures.items():
        if arguments.only and not any(part in name for part in arguments.only):
            continue
        lenses, said = try_capture(name, make, arguments.programs.resolve())
        print(said, file=sys.stderr)
        table.add(name, *(f"{100 * lens:.2f} %" if lens else "refused" for lens in lenses or (None, None)))
        counts = [count + bool(lens and lens >= LIKE_F4) for count, lens in zip(counts, lenses or (None, None))]
    table.add(f"at least {100 * LIKE_F4:g} %", *counts)
    table.publish(arguments, "first_lenses.py", record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
