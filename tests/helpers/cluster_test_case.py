# SPDX-License-Identifier: Apache-2.0
"""A small light field with its packages, the frames of one lfrenderer, and jobs that render the packages."""
import hashlib
import json
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import time

import small_field
from program_test_case import ProgramTestCase

RENDERER = PREPROCESSOR = SUBMIT = None


def take_programs():
    """Takes LFRENDERER LFPREPROCESSOR LFSUBMIT from the command line."""
    global RENDERER, PREPROCESSOR, SUBMIT
    RENDERER, PREPROCESSOR, SUBMIT = sys.argv[1:4]


def digests(folder):
    """Returns the sha256 of the frames of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.glob("frame_*"))}


class ClusterTestCase(ProgramTestCase):
    packages = 3
    frames = 9
    side, pitch = 4, 0.01  # LF cameras per side of their grid; their pitch
    resolution = None      # None: the resolution of small_field

    @classmethod
    def setUpClass(cls):
        """Makes the light field, path, packages and frames of one lfrenderer that all tests share."""
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        small_field.SIDE, small_field.PITCH = cls.side, cls.pitch
        cls.field = small_field.write_field(folder / "field")
        cls.path = small_field.write_path(folder, frames=cls.frames)
        if cls.resolution:
            cls.path.write_text(cls.path.read_text().replace("[80, 60]", str(cls.resolution)))
        for command in ([PREPROCESSOR, cls.field, cls.path, "-o", folder / "packages", "--packages",
                         cls.packages],
                        [RENDERER, cls.field, cls.path, "-o", folder / "whole"]):
            subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
        cls.package_files = sorted((folder / "packages").glob("*.lfp"))
        cls.expected = digests(folder / "whole")
        assert (len(cls.package_files), len(cls.expected)) == (cls.packages, cls.frames)

    def setUp(self):
        super().setUp()
        self.film = self.folder / "film"

    def submit(self, *options, code=0, words=()):
        """Runs lfsubmit and returns its last line, which must contain these words."""
        result = self.call(SUBMIT, *self.package_files, "-o", self.film, *options)
        self.assertEqual(result.returncode, code, result.stderr)
        last = result.stderr.strip().splitlines()[-1]
        for word in words:
            self.assertIn(word, last)
        return last

    def status(self):
        return json.loads(self.succeeds(SUBMIT, "--status", self.film, "--json"))

    def wait_for(self, what, seconds=240):
        end = time.monotonic() + seconds
        while not what():
            self.assertLess(time.monotonic(), end, "waited in vain")
            time.sleep(0.02)

    def is_held(self, number):
        """Returns true if a package has a checkpoint and its renderer is stopped (held_renderer)."""
        if not any((self.film / "partial" / f"package-{number:04d}").glob("frame_*.plate")):
            return False
        try:
            state = json.loads((self.film / "cluster" / "packages" / f"package-{number:04d}.json").read_text())
            stat = pathlib.Path("/proc", str(state["process"]), "stat").read_text()
        except (FileNotFoundError, ProcessLookupError):
            return False
        return stat.rpartition(")")[2].split()[0] == "T"

    def unlucky_renderer(self, script: str) -> pathlib.Path:
        """Returns a program that stands in for lfrenderer. The script is bash: $package is the name of a package or
        "finish", $start counts the starts for it from 1, and run executes the real program."""
        counter = self.folder / "starts"
        counter.mkdir(exist_ok=True)
        program = self.folder / "lfrenderer"
        program.write_text(f"""#!/bin/bash
run() {{ exec {RENDERER} "${{arguments[@]}}"; }}
arguments=("$@")
package=finish
[[ $2 == *.lfp ]] || package=$(basename "$1" .lfp)
echo >> {counter}/$package
start=$(wc -l < {counter}/$package)
{script}
run
""")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        return program

    def held_renderer(self, packages=None) -> pathlib.Path:
        """Returns a stand-in for lfrenderer. The first start of each of these packages (default: all) stops as soon as
        it has begun a frame, until a signal is sent to it (see is_held). A test can then rely on running packages,
        however busy the machine is."""
        names = "|".join(f"package-{number:04d}" for number in packages or range(self.packages))
        return self.unlucky_renderer(f"""
            if [[ $start == 1 && $package =~ ^({names})$ ]]; then
                (trap '' HUP INT TERM
                # The renderer runs in pulses, so that it gets no further than its first checkpoint.
                while kill -STOP $$
                do
                    compgen -G "{self.film}/partial/$package/frame_*.plate" && break
                    kill -CONT $$
                    sleep 0.02
                done
                # Continues the renderer when one of the signals 1 to 16 is pending, or after some minutes. STOP, which
                # may also be pending, is signal 19.
                for ((i = 0; i < 20000; ++i)); do
                    grep -qE '^S(ig|hd)Pnd:.*[1-9a-f][0-9a-f]{{0,3}}$' /proc/$$/status && break
                    kill -0 $$ || break
                    sleep 0.01
                done
                kill -CONT $$) < /dev/null &> /dev/null &
            fi""")

    def start(self, *options):
        """Starts lfsubmit and returns the process."""
        process = subprocess.Popen([SUBMIT, *map(str, self.package_files), "-o", str(self.film),
                                    *map(str, options)], stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(lambda: process.poll() is None and os.kill(process.pid, 9))
        self.addCleanup(process.stderr.close)
        return process
