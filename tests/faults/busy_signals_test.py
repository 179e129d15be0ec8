#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that each program ends within two seconds of SIGTERM while a long step of its work runs. The processor time
after the signal is measured, because other tests run on the machine at the same time.

usage: busy_signals_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from common_options import OFFERED
from processor_clock import Clock

PROGRAMS = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
MOMENTS_S = (0.3, 2.5)  # processor times at which the signal is sent
THREADS = 2
MOST_CPU_S = 2 * THREADS
MOST_WALL_S = 20


class BusySignalsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.world = pathlib.Path(temporary.name)
        one, field, small = (cls.world / name for name in ("one", "field", "small"))
        cls.made("lfsynth", "chart", "-o", one, "--count", 1, "--size", "4000x3000", "--samples", 1, "--format", "png")
        cls.made("lfsynth", "chart", "-o", field, "--count", 625, "--size", "4000x3000", "--format", "png",
                 "--calibration-only")
        cls.image = next((one / "images").iterdir())
        for frame in json.loads((field / "transforms.json").read_text())["frames"]:
            (field / frame["file_path"]).parent.mkdir(exist_ok=True)
            os.link(cls.image, field / frame["file_path"])
        cls.copy = cls.world / "copy.png"
        shutil.copyfile(cls.image, cls.copy)
        cls.made("lfsynth", "chart", "-o", small, "--count", 81, "--size", "60x40", "--samples", 1, "--format", "png")
        path = cls.world / "path.yaml"
        cls.made("lfexample", small, "-o", path, "--move", "orbit", "--focus", 3)
        text = path.read_text()
        cls.large = cls.world / "large.yaml"
        cls.large.write_text(re.sub(r"(?m)^resolution:.*$", "resolution: [4000, 3000]", text))
        cls.film = cls.world / "film.yaml"
        cls.film.write_text(re.sub(r"(?m)^frames:.*$", "frames: 1000000", re.sub(r"(?m)^fps:.*$", "fps: 500000", text)))
        cls.packages = cls.world / "packages"
        cls.made("lfpreprocessor", small, path, "-o", cls.packages, "--packages", 2)
        cls.wide = cls.world / "wide"
        cls.made("lfpreprocessor", field, cls.large, "-o", cls.wide, "--packages", 2)
        for shard in ("1/2", "2/2"):
            cls.made("lfrenderer", small, cls.large, "-o", cls.world / "cut", "--frames", "1-2", "--shard", shard)
        cls.field, cls.small = field, small

    @classmethod
    def made(cls, program, *arguments):
        subprocess.run([PROGRAMS / program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    def calls(self, out):
        """Returns a call of each program, and of each command of lffocus, that takes at least five seconds."""
        field, large, film = self.field, self.large, self.film
        depths = ["--near", 2, "--far", 4]
        synth = ["chart", "-o", out, "--count", 4, "--size", "4000x3000", "--samples", 64]
        return {
            "lfsynth": synth,
            "lfimport": [field, "--check", "pixels"],
            "lfexample": [field, "-o", out / "path.yaml"],
            "lfcammvminfo": [film],
            "lfpath": [film, "-o", out / "path.json"],
            "lfpreprocessor": [self.small, film, "-o", out],
            "lfcompressor": [field, "-o", out / "store.lfs"],
            "lfdensify": [field, "-o", out / "store.lfs", "--depths", 2, 4, "--force"],
            "lfrenderer": [field, large, "-o", out],
            "lfr": ["synth", *synth],
            "lffocus stack": [field, large, "-o", out / "stack.exr", *depths],
            "lffocus epi": [field, "-o", out / "epi.png", "--row", 1500, "--lines", "linear", "--count", 8000],
            "lffocus views": [field, "-o", out / "views", "--grid", "5x5", "--focus-distance", 3],
            "lffocus depth": [field, large, "-o", out / "depth.exr", *depths],
            "lffocus sharp": [field, large, "-o", out / "sharp.exr", *depths],
            "lffocus through": [field, large, "-o", out / "through.exr"],
            "lfsubmit": [*sorted(self.wide.glob("*.lfp")), "-o", out, "--jobs", 1],
            "lfmerge": [self.world / "cut" / "partial" / "shards", "-o", out],
            "lfquilt": [*[self.image] * 64, "-o", out / "quilt.png", "--views", "8x8"],
            "lfcompare": [self.image, self.copy],
            "lfvisualizer": [self.small, film, "--export", out / "site"],
        }

    def hit(self, name, moment_s, out):
        program, *command = name.split()
        words = [*command, *map(str, self.calls(out)[name])]
        if "--threads" in OFFERED[name] or name == "lfr":
            words += ["--threads", str(THREADS)]
        process = subprocess.Popen([PROGRAMS / program, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        clock = Clock(process.pid)
        while clock.look() < moment_s and process.poll() is None:
            time.sleep(0.01)
        if process.poll() is not None:
            self.fail(f"{name} ended before the signal: its call must take longer: {process.communicate()[1][-400:]}")
        before_s, begin_s = clock.look(), time.monotonic()
        process.send_signal(signal.SIGTERM)
        while process.poll() is None and clock.look() - before_s <= MOST_CPU_S:
            time.sleep(0.01)
        cpu, wall = clock.known and sum(clock.known.values()) - before_s, time.monotonic() - begin_s
        if process.poll() is None:
            process.kill()
        said = process.communicate(timeout=240)[1]
        facts = (name, moment_s, f"{cpu:.2f} s of processors, {wall:.2f} s", said[-400:])
        print(*facts[:3], process.returncode, flush=True)
        self.assertLessEqual(cpu, MOST_CPU_S, facts)
        self.assertLessEqual(wall, MOST_WALL_S, facts)
        self.assertEqual(process.returncode, 5, facts)
        self.assertTrue(said.strip().splitlines()[-1].startswith("error: "), facts)

    def test_every_program_has_a_call(self):
        self.assertEqual(set(self.calls(self.world)), set(OFFERED) - {"lffocus"})

    def test_each_program_ends_soon(self):
        for name in self.calls(self.world):
            for moment_s in MOMENTS_S:
                with self.subTest(name, moment_s=moment_s), tempfile.TemporaryDirectory(dir=self.world) as out:
                    self.hit(name, moment_s, pathlib.Path(out))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
