#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Installs the project and builds another project against it, with CMake and with pkg-config.

usage: install_test.py CMAKE BUILD_FOLDER SOURCE_FOLDER
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import small_field
from source_messages import PROGRAMS

CMAKE = BUILD = SOURCE = None
INCLUDE = re.compile(r'^#include "(lf/[^"]+)"', re.M)


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.prefix = cls.folder / "installed"
        cls.run_tool(CMAKE, "--install", BUILD, "--prefix", cls.prefix)
        # The installation must not depend on its original place.
        moved = cls.folder / "elsewhere"
        cls.prefix.rename(moved)
        cls.prefix = moved
        cls.library = next(moved.rglob("liblfrendertools.a")).parent

    @staticmethod
    def run_tool(*command, **keys):
        result = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=600,
                                **keys)
        if result.returncode != 0:
            raise AssertionError(f"{command}: exit {result.returncode}\n{result.stdout[-4000:]}"
                                 f"{result.stderr[-4000:]}")
        return result.stdout

    def film(self, program):
        with tempfile.TemporaryDirectory() as temporary:
            work = pathlib.Path(temporary)
            field = small_field.write_field(work / "field")
            path = small_field.write_path(work, frames=2)
            self.assertEqual(self.run_tool(program, field, path, work / "frames"), "2 frames\n")
            self.assertTrue((work / "frames" / "frame_0002.png").exists())

    def frame(self, program):
        """Frames of the library have the bytes of the frames of lfrenderer."""
        ways = {  # settings of the program tests/foreign/frame.cc, options of lfrenderer, and lines of the path
            "default": ([], [], ""),
            "nearest": (["nearest", "no weights"], ["--estimator", "nearest", "--lens-weights", "none"], ""),
            "hybrid": (["hybrid"], ["--mode", "hybrid"], ""),
            "surface": ([], [], "focus: {surface: depths.pfm, kind: depth}\n"),
            "transmission": ([], [], 'transmission: "00ff/ff80"\n')}
        with tempfile.TemporaryDirectory() as temporary:
            work = pathlib.Path(temporary)
            field = small_field.write_field(work / "field")
            depths = np.linspace(0.6, 2, 80 * 60, dtype="<f4").reshape(60, 80)
            (work / "depths.pfm").write_bytes(b"Pf\n80 60\n-1\n" + depths.tobytes())
            frames = {}
            for way, (settings, options, lines) in ways.items():
                path = small_field.write_path(work, frames=1)
                text = path.read_text()
                indented = lines.startswith("transmission")
                path.write_text(text.replace("lens:\n", f"lens:\n  {lines}") if indented else text + lines)
                self.run_tool(program, field, path, work / f"{way}.exr", *settings)
                self.run_tool(self.prefix / "bin" / "lfrenderer", field, path, "-o", work / way, *options)
                frames[way] = (work / f"{way}.exr").read_bytes()
                with self.subTest(way):
                    self.assertEqual(frames[way], (work / way / "frame_0001.exr").read_bytes())
            self.assertEqual(len(set(frames.values())), len(ways), "two ways give one frame")
            refused = subprocess.run([program, field, path, work / "frame.jpg"], capture_output=True, text=True)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("frame.jpg: expected a name that ends in .exr or .png", refused.stderr)

    def steps(self, program):
        """Frames that are looked at while they grow have in the end the bytes of the frames of lfrenderer."""
        with tempfile.TemporaryDirectory() as temporary:
            work = pathlib.Path(temporary)
            field = small_field.write_field(work / "field")
            path = small_field.write_path(work, frames=2)
            steps = [line.split() for line in self.run_tool(program, field, path, work).splitlines()]
            self.assertEqual(steps[-1][0], "1")
            counts = [int(count) for _, count in steps]
            self.assertEqual(counts, sorted(counts))
            self.run_tool(self.prefix / "bin" / "lfrenderer", field, path, "-o", work / "frames")
            for number in 1, 2:
                self.assertEqual((work / f"{number}.exr").read_bytes(),
                                 (work / "frames" / f"frame_000{number}.exr").read_bytes())

    def test_a_foreign_project_by_cmake(self):
        build = self.folder / "by-cmake"
        self.run_tool(CMAKE, "-G", "Ninja", "-S", SOURCE / "tests" / "foreign", "-B", build,
                      f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.run_tool(CMAKE, "--build", build)
        self.film(build / "film")
        self.frame(build / "frame")
        self.steps(build / "steps")

    def flags(self, *which):
        environment = {**os.environ, "PKG_CONFIG_PATH": str(self.library / "pkgconfig")}
        return self.run_tool("pkg-config", *which, "lfrendertools", env=environment).split()

    def test_a_foreign_program_by_pkg_config(self):
        program = self.folder / "film-by-pkg-config"
        self.run_tool("c++", SOURCE / "tests" / "foreign" / "film.cc", "-o", program, *self.flags("--cflags", "--libs"))
        self.film(program)

    def test_the_program_in_the_first_header_prints_the_light_of_a_frame(self):
        header = (self.prefix / "include/lf/lfrendertools.h").read_text()
        lines = [line.removeprefix("//   ") for line in header.splitlines() if line.startswith("//   ") or line == "//"]
        source = self.folder / "light.cc"
        source.write_text("\n".join("" if line == "//" else line for line in lines) + "\n")
        program = self.folder / "light"
        self.run_tool("c++", source, "-o", program, *self.flags("--cflags", "--libs"))
        with tempfile.TemporaryDirectory() as temporary:
            work = pathlib.Path(temporary)
            field = small_field.write_field(work / "field")
            light = float(self.run_tool(program, field, small_field.write_path(work, frames=1)))
        self.assertGreater(light, 0)

    def test_programs_and_documents_are_installed(self):
        for name in PROGRAMS:
            self.run_tool(self.prefix / "bin" / name, "--version")
        for name in ("README.md", "LICENSE", "CITATION.cff", "doc/conventions.md"):
            self.assertTrue(list(self.prefix.rglob(name)), name)

    def test_schemas_are_installed_for_editors_and_beside_the_pages_that_link_to_them(self):
        names = sorted(path.name for path in (SOURCE / "schemas").iterdir())
        for folder in "share/lfrendertools/schemas", "share/doc/lfrendertools/schemas":
            self.assertEqual(sorted(path.name for path in (self.prefix / folder).iterdir()), names)

    def test_man_pages_and_completion_are_installed(self):
        share = self.prefix / "share"
        for name in ("man/man1/lfrenderer.1", "man/man1/lffocus-stack.1", "man/man1/lfr.1",
                     "bash-completion/completions/lfrenderer", "bash-completion/completions/lfr",
                     "zsh/site-functions/_lfrendertools", "fish/vendor_completions.d/lfrenderer.fish",
                     "doc/lfrendertools/doc/programs.md"):
            self.assertGreater((share / name).stat().st_size, 500, name)
        page = self.run_tool("man", "-l", share / "man/man1/lfrenderer.1")
        self.assertIn("EXIT STATUS", page)

    def installed_headers(self):
        """Returns {"lf/api/film.h": [headers of the library that it includes], ...}."""
        include = self.prefix / "include"
        return {path.relative_to(include).as_posix(): INCLUDE.findall(path.read_text())
                for path in include.rglob("*") if path.is_file()}

    def test_the_promised_headers_are_installed_and_what_they_include(self):
        promised = [line.split()[0] for line in (SOURCE / "lf/public_headers.txt").read_text().splitlines()
                    if line.startswith("lf/")]
        headers = self.installed_headers()
        self.assertEqual(sorted(name for name in headers if not name.startswith("lf/detail/")), sorted(promised))
        reached = ["lf/lfrendertools.h"]
        for name in reached:
            reached += [each for each in headers[name] if each not in reached]
        self.assertEqual(sorted(reached), sorted(headers))
        self.assertLess(len(headers), 50)
        for name in headers:  # nothing but #include lines is changed
            source = SOURCE / name.replace("lf/detail/", "lf/")
            self.assertEqual((self.prefix / "include" / name).read_text().replace('"lf/detail/', '"lf/'),
                             source.read_text())

    def compile_alone(self, header):
        source = self.folder / "alone.cc"
        source.write_text(f"#include <{header}>\n")
        return subprocess.run(["c++", "-std=c++20", "-fsyntax-only", source, *self.flags("--cflags")],
                              capture_output=True, text=True)

    def test_each_promised_header_compiles_alone(self):
        for header in self.installed_headers():
            if not header.startswith("lf/detail/"):
                with self.subTest(header):
                    self.assertEqual(self.compile_alone(header).stderr, "")

    def test_programs_cannot_include_what_is_not_promised(self):
        for header in "lf/core/child_process.h", "lf/core/ids.h", "lf/render/pipeline/film_renderer.h":
            self.assertTrue((SOURCE / header).exists())
            self.assertIn(f"{header}: No such file", self.compile_alone(header).stderr)


if __name__ == "__main__":
    CMAKE, BUILD, SOURCE = map(pathlib.Path, sys.argv[1:4])
    if not shutil.which("pkg-config"):
        sys.exit("pkg-config is missing: apt-get install pkgconf")
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
