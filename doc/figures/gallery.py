#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of doc/gallery.md, and compares the pictures that they make with those in doc/images/.

usage: doc/figures/gallery.py PROGRAMS [--write]

PROGRAMS  the folder of the programs, such as build/release/bin
--write   replaces the pictures in doc/images/ instead

Exit codes: 0 success, 1 a command failed or a picture differs, 2 wrong usage.
"""
import pathlib
import re
import shutil
import sys
import tempfile
import time

import numpy as np
from PIL import Image, ImageSequence

import page_commands

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE, PICTURES = ROOT / "doc/gallery.md", ROOT / "doc/images"
LARGEST_BYTES = 200_000
LEAST_PSNR = 38.0  # other versions of encoders change pictures by less


def pictures_of(page: pathlib.Path) -> list:
    return re.findall(r"\(images/(gallery_\w+\.\w+)\)", page.read_text())


def frames_of(file: pathlib.Path) -> np.ndarray:
    """Returns the frames of a picture or film as an array [frame, row, column, channel]."""
    with Image.open(file) as picture:
        return np.stack([np.asarray(frame.convert("RGB"), float) for frame in ImageSequence.Iterator(picture)])


def fault_of(made: pathlib.Path, kept: pathlib.Path):
    """Returns what is wrong with a picture, or None."""
    if not made.exists():
        return "no command of the page makes it"
    if made.stat().st_size > LARGEST_BYTES:
        return f"has {made.stat().st_size} bytes, the limit is {LARGEST_BYTES}"
    if not kept.exists():
        return "is not in doc/images/: call doc/figures/gallery.py with --write"
    new, old = frames_of(made), frames_of(kept)
    if new.shape != old.shape:
        return f"has the shape {new.shape}, in doc/images/ {old.shape}"
    error = np.mean((new - old) ** 2)
    psnr = 10 * np.log10(255 ** 2 / error) if error > 0 else np.inf
    return f"{psnr:.1f} dB from the one in doc/images/, expected {LEAST_PSNR} or more" if psnr < LEAST_PSNR else None


def main() -> int:
    arguments = [argument for argument in sys.argv[1:] if argument != "--write"]
    if len(arguments) != 1 or not (pathlib.Path(arguments[0]) / "lfrenderer").is_file():
        print(__doc__, file=sys.stderr)
        return 2
    programs, is_writing = pathlib.Path(arguments[0]).resolve(), "--write" in sys.argv
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="lf-gallery-") as scratch:
        folder = pathlib.Path(scratch)
        for block in page_commands.blocks_of(PAGE):
            start = time.monotonic()
            code, output = page_commands.run_block(block, folder, programs)
            if code:
                print(f"{PAGE.relative_to(ROOT)}:{block.line}: a command of this block failed with {code}:\n{output}")
                return 1
            print(f"{time.monotonic() - start:5.1f} s  line {block.line}", flush=True)
        names = pictures_of(PAGE)
        if is_writing:
            for name in names:
                shutil.copyfile(folder / name, PICTURES / name)
        faults = [(name, fault_of(folder / name, PICTURES / name)) for name in names]
    for name, fault in faults:
        if fault:
            print(f"{name}: {fault}")
    print(f"{len(names)} pictures in {time.monotonic() - begin:.0f} s")
    return 1 if any(fault for _, fault in faults) or not names else 0


if __name__ == "__main__":
    sys.exit(main())
