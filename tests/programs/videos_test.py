#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the videos of every program that writes one: a video that cannot be written whole is an error and replaces
nothing, and a video has a name by which players know it.

usage: videos_test.py LFRENDERER LFQUILT LFFOCUS LFMERGE LFSUBMIT LFPATH
"""
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest

import small_field
from program_test_case import ProgramTestCase

RENDERER, QUILT, FOCUS, MERGE, SUBMIT, PATH = sys.argv[1:7] if len(sys.argv) > 6 else [""] * 6
FRAMES = 24
OTHER_NAMES = ("film.gif", "film.webm", "film.mov", "film", ".mp4", "film.mp4.part")
# The shell script runs a command on a disk of few bytes, and copies what is there afterwards.
ON_A_SMALL_DISK = """mount -t tmpfs -o size="$1" tmpfs "$OF" || exit
shift
"$@"
code=$?
cp -a "$OF/." "$TO"
exit $code
"""


def may_mount(words, folder):
    return subprocess.run([*words, "mount", "-t", "tmpfs", "tmpfs", folder], capture_output=True).returncode == 0


class VideosTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.base = pathlib.Path(cls.shared.name)
        # A narrow lens keeps the noise of the LF images, so that the video is larger than all other files.
        cls.field = small_field.write_field(cls.base / "field")
        cls.path, cls.film = small_field.write_path(cls.base, frames=FRAMES // 2, aperture=0.012), cls.base / "film"
        cls.path.write_text(cls.path.read_text().replace("[80, 60]", "[160, 120]"))
        subprocess.run([PATH, cls.path, "-o", cls.base / "eyes.yaml", "--stereo", "0.01"], check=True)
        subprocess.run([RENDERER, cls.field, cls.base / "eyes.yaml", "-o", cls.film, "--format", "png",
                        "--no-contact-sheet", "-q"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.shared.cleanup()

    def calls(self, video):
        """Returns a call of each program that writes `video`, and the number of pictures in it. Frames are finished
        already, where there are any, so that only the video is written."""
        film, seen = self.folder / "film", self.folder / "seen"
        if not film.exists():
            shutil.copytree(self.film, film)
            self.succeeds(FOCUS, "through", self.field, self.path, "-o", seen, "--format", "png", "--frames", "1-12",
                          "--no-contact-sheet", "-q")
        return {
            "lfrenderer": ([RENDERER, self.field, self.base / "eyes.yaml", "-o", film, "--format", "png",
                            "--no-contact-sheet", "--resume", "--video", video, "-q"], FRAMES),
            "lfquilt": ([QUILT, self.film, "-o", video, "--layout", "side-by-side", "--overwrite", "-q"],
                        FRAMES // 2),
            "lffocus stack": ([FOCUS, "stack", self.field, self.path, "-o", video, "--near", 0.3, "--far", 2,
                               "--planes", 12, "--overwrite", "-q"], 12),
            "lffocus through": ([FOCUS, "through", self.field, self.path, "-o", seen, "--format", "png", "--frames",
                                 "1-12", "--no-contact-sheet", "--resume", "--video", video, "-q"], 12)}

    def pictures(self, video):
        """Returns the number of pictures that a player finds in the video."""
        found = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames",
                                "-of", "csv=p=0", video], capture_output=True, text=True)
        self.assertEqual((found.returncode, found.stderr), (0, ""), video)
        return int(found.stdout)

    def test_an_odd_size_loses_a_pixel_and_a_warning_says_so(self):
        path = self.folder / "odd.yaml"
        for size, words, left in (("[81, 61]", "the last column and the last row", "80,60"),
                                  ("[81, 60]", "the last column of", "80,60"),
                                  ("[80, 61]", "the last row of", "80,60"), ("[80, 60]", "", "80,60")):
            path.write_text(small_field.write_path(self.folder).read_text().replace("[80, 60]", size))
            video, out = self.folder / "odd.mp4", self.folder / f"odd {size}"
            done = self.call(RENDERER, self.field, path, "-o", out, "--format", "png", "--video", video,
                             "--overwrite", "-q")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stderr.count("warning: "), bool(words), done.stderr)
            self.assertIn(words, done.stderr)
            found = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=width,height", "-of",
                                    "csv=p=0", video], capture_output=True, text=True)
            self.assertEqual(found.stdout.strip(), left)

    def test_a_fraction_is_a_rate(self):
        video = self.folder / "film.mp4"
        self.succeeds(QUILT, self.film, "-o", video, "--layout", "side-by-side", "--fps", "24000/1001", "-q")
        found = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=r_frame_rate", "-of", "csv=p=0",
                                video], capture_output=True, text=True)
        self.assertEqual(found.stdout.strip(), "24000/1001")
        self.succeeds(PATH, self.path, "-o", self.folder / "slow.yaml", "--fps", "12000/1001")
        self.assertIn("fps: 11.988011988", (self.folder / "slow.yaml").read_text())
        self.fails(2, ["--fps RATE", "found '24/0'"], QUILT, self.film, "-o", video, "--layout", "side-by-side",
                   "--fps", "24/0", "--overwrite")

    def run_limited(self, command, size_bytes):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size_bytes, size_bytes))
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=400, preexec_fn=limit)

    def test_a_video_that_may_not_become_whole_is_an_error(self):
        for program in self.calls("none.mp4"):
            video = self.folder / "film.mp4"
            command, count = self.calls(video)[program]
            self.succeeds(*command)
            self.assertEqual(self.pictures(video), count, program)
            whole = video.read_bytes()
            # The index, the last thing that is written, is cut; then the pictures are.
            for size in (len(whole) - 1, len(whole) - 300, len(whole) * 9 // 10):
                with self.subTest(program=program, size=size, of=len(whole)):
                    done = self.run_limited(command, size)
                    self.assertEqual(done.returncode, 4, done.stderr)
                    last = done.stderr.strip().splitlines()[-1]
                    self.assertRegex(last, r"^error: .*film\.mp4: the video could not be written: .*File too large")
                    self.assertEqual(video.read_bytes(), whole)
                    self.assertEqual([path.name for path in self.folder.glob("*unfinished*")], [])
            self.succeeds(*command)
            self.assertEqual(self.pictures(video), count, program)
            video.unlink()

    def test_a_full_disk_leaves_a_whole_video_or_none(self):
        disk = self.folder / "disk"
        disk.mkdir()
        words = next((words for words in (["unshare", "-m"], ["unshare", "-rm"]) if may_mount(words, disk)), None)
        if words is None:
            self.skipTest("nothing may be mounted here")
        for program in ("lfrenderer", "lfquilt"):
            command, count = self.calls(disk / "film.mp4")[program]
            self.succeeds(*command)
            pages = -(-(disk / "film.mp4").stat().st_size // 4096)
            (disk / "film.mp4").unlink()
            ends = []
            # lfquilt also has a lock on the disk, which takes a page.
            for free in (pages + 1, pages - 1, pages // 2):
                left = self.folder / f"left {program} {free}"
                left.mkdir()
                done = subprocess.run([*words, "sh", "-c", ON_A_SMALL_DISK, "sh", f"{4 * free}k",
                                       *map(str, command)], capture_output=True, text=True, timeout=400,
                                      env={**os.environ, "OF": str(disk), "TO": str(left)})
                files = [path.name for path in left.iterdir()]
                ends.append(done.returncode)
                with self.subTest(program=program, pages=free, of=pages):
                    self.assertIn(done.returncode, (0, 4), done.stderr)
                    self.assertEqual(files, ["film.mp4"] if done.returncode == 0 else [], done.stderr)
                    if done.returncode == 0:
                        self.assertEqual(self.pictures(left / "film.mp4"), count)
            self.assertEqual((ends[0], set(ends[1:])), (0, {4}), program)

    def test_other_names_are_refused_before_any_work(self):
        film = self.folder / "new"
        calls = [[RENDERER, self.field, self.path, "-o", film], [MERGE, self.folder / "a.plate", "-o", film],
                 [SUBMIT, self.folder / "a.lfp", "-o", film],
                 [FOCUS, "through", self.field, self.path, "-o", film],
                 [FOCUS, "stack", self.field, self.path, "-o", film]]
        for command in calls:
            for name in OTHER_NAMES:
                with self.subTest(program=command[0], name=name):
                    self.fails(2, ["--video", "ends in .mp4", f"'{self.folder / name}'"], *command, "--video",
                               self.folder / name)
                    self.assertEqual(list(self.folder.iterdir()), [])
        for name in OTHER_NAMES[:3]:
            with self.subTest(name=name):
                self.fails(2, [name, ".mp4"], QUILT, self.film, "-o", self.folder / name, "--layout", "anaglyph")
                self.fails(2, [name, "rack.mp4"], FOCUS, "stack", self.field, self.path, "-o", self.folder / name)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_name_in_capitals_is_that_of_a_video(self):
        video = self.folder / "FILM.MP4"
        for program, (command, count) in self.calls(video).items():
            with self.subTest(program=program):
                self.succeeds(*command)
                self.assertEqual(self.pictures(video), count)
                video.unlink()


if __name__ == "__main__":
    if shutil.which("ffmpeg") is None or shutil.which("ffprobe") is None:
        print("skipped: ffmpeg is not installed")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[7:])
