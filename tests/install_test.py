#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Installs the project and builds another project against it, with CMake and with pkg-config.

usage: install_test.py CMAKE BUILD_FOLDER SOURCE_FOLDER
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import small_field

CMAKE = BUILD = SOURCE = None


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

    def test_a_foreign_project_by_cmake(self):
        build = self.folder / "by-cmake"
        self.run_tool(CMAKE, "-G", "Ninja", "-S", SOURCE / "tests" / "foreign", "-B", build,
                      f"-DCMAKE_PREFIX_PATH={self.prefix}",
                      f"-DLF_INCLUDE={self.prefix / 'include'}")
        self.run_tool(CMAKE, "--build", build)
        self.film(build / "film")
        self.frame(build / "frame")

    def test_a_foreign_program_by_pkg_config(self):
        environment = {**os.environ, "PKG_CONFIG_PATH": str(self.library / "pkgconfig")}
        flags = self.run_tool("pkg-config", "--cflags", "--libs", "lfrendertools", env=environment)
        program = self.folder / "film-by-pkg-config"
        self.run_tool("c++", SOURCE / "tests" / "foreign" / "film.cc", "-o", program,
                      *flags.split())
        self.film(program)

    def test_programs_and_documents_are_installed(self):
        for name in ("lfrenderer", "lfexample", "lfsynth", "lfimport", "lfcammvminfo", "lfpath",
                     "lfpreprocessor", "lfcompressor", "lfdensify", "lffocus", "lfmerge", "lfquilt", "lfsubmit",
                     "lfcompare", "lfvisualizer", "lfr"):
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

    def test_internal_headers_stay_behind(self):
        headers = sorted(p.name for p in (self.prefix / "include").rglob("*.h"))
        self.assertIn("render.h", headers)
        self.assertTrue((self.prefix / "include" / "lf" / "lfrendertools.h").exists())
        self.assertNotIn("plan_on_arcs.h", headers)
        self.assertFalse([name for name in headers if name.startswith("test")])


if __name__ == "__main__":
    CMAKE, BUILD, SOURCE = map(pathlib.Path, sys.argv[1:4])
    if not shutil.which("pkg-config"):
        sys.exit("pkg-config is missing: apt-get install pkgconf")
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
