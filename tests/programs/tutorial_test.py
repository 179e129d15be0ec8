#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of doc/tutorial.md that need no COLMAP and no phone: those of the gantry with recorded photographs,
and those of Blender with a coarse rig. What is missing on this machine is skipped and named.

usage: tutorial_test.py PROGRAMS SOURCE DATA
"""
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

PROGRAMS, SOURCE, DATA = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
del sys.argv[1:]
sys.path.insert(0, str(SOURCE / "doc/figures"))

import page_commands

SKIPPED = 77


class Tutorial(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        for name in ("blender", "examples"):
            (self.folder / name).symlink_to(SOURCE / name)

    def run_blocks(self, need, edit=lambda commands: commands):
        blocks = [block for block in page_commands.blocks_of(SOURCE / "doc/tutorial.md") if need in block.needs]
        self.assertGreater(len(blocks), 2)
        for block in blocks:
            block.commands = edit(block.commands)
            code, output = page_commands.run_block(block, self.folder, PROGRAMS)
            self.assertEqual(code, 0, f"doc/tutorial.md:{block.line}:\n{output}")

    def test_photographs_from_a_gantry_become_a_film(self):
        images = DATA / "data/stanford-cards-9x9/images"
        if not images.is_dir():
            self.skipTest(f"there is no {images}")
        (self.folder / "cards").symlink_to(images)
        self.run_blocks("cards", lambda commands: commands.replace("--video", "--frames 1-50x10 --video"))
        self.assertEqual(len(list((self.folder / "cards-frames").glob("frame_*.png"))), 5)
        self.assertGreater((self.folder / "cards.mp4").stat().st_size, 10_000)

    def test_a_scene_of_blender_becomes_a_film(self):
        if not shutil.which("blender"):
            self.skipTest("there is no Blender")
        # A coarser rig of the same width.
        self.run_blocks("blender", lambda commands: re.sub("15 15 --spacing 0.007 0.007", "4 4 --spacing 0.033 0.033",
                                                           commands))
        self.assertEqual(len(list((self.folder / "frames").glob("frame_*.png"))), 48)
        self.assertGreater((self.folder / "film.mp4").stat().st_size, 10_000)


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=2).result
    for _, reason in result.skipped:
        print(f"skipped: {reason}")
    all_skipped = result.testsRun == len(result.skipped)
    sys.exit(SKIPPED if all_skipped else not result.wasSuccessful())
