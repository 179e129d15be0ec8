#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfrenderer --shard and lfmerge: parts of the LF images, merged in any order, give the frames of one machine bit
for bit; missing parts are reported.

usage: shards_test.py LFRENDERER LFMERGE LFPREPROCESSOR
"""
import fcntl
import hashlib
import json
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest

import xxhash

import small_field
from program_test_case import ProgramTestCase

RENDERER = MERGE = PREPROCESSOR = None


def digests(folder, pattern="frame_*.exr"):
    """Returns the sha256 of the files of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.glob(pattern))}


def after_rays(plate, at):
    """Returns where the rays of a plate, of one chunk and without wide words, end in a plate file if they begin at `at`
    (doc/formats/plate.md)."""
    return at + 16 + struct.unpack_from("<I", plate, at)[0] + 8


def front_of(plate):
    """Returns head and text of a plate file of 80 x 60 elements with gaps."""
    version, text_bytes, width, height, channels, rows = struct.unpack_from("<6I", plate, 8)
    assert (version, width, height, channels) == (4, 80, 60, 3) and rows >= height
    return plate[:40 + text_bytes]


def without_gaps(plate):
    """Returns the bytes of a plate file without the gaps of its lens."""
    begin = len(front_of(plate)) + 8
    front = plate[:8] + struct.pack("<I", 3) + front_of(plate)[12:]
    return front + struct.pack("<Q", xxhash.xxh3_64_intdigest(front)) + plate[begin:after_rays(plate, begin)]


def with_shares_of_0(plate):
    """Returns the bytes of a plate file whose gaps have no share in any element."""
    shares = after_rays(plate, after_rays(plate, len(front_of(plate)) + 8) + 16)
    # A frame of zstd with one block, which repeats a byte.
    size = 80 * 60 * 4
    stored = bytes.fromhex("28b52ffda0") + struct.pack("<I", size) + struct.pack("<I", size << 3 | 3)[:3] + b"\0"
    return plate[:shares] + struct.pack("<IIQ", len(stored), 0, xxhash.xxh3_64_intdigest(stored, seed=2)) + stored


class ShardsTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 3
        self.field = small_field.write_field(self.folder / "field")
        self.path = small_field.write_path(self.folder)

    def render(self, out, *options):
        self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / out, *options)
        return digests(self.folder / out)

    def shards(self, out, count, *options, of=None):
        for number in of or range(1, count + 1):
            self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / out, "--shard",
                          f"{number}/{count}", *options)
        return self.folder / out / "partial" / "shards"

    def merge(self, out, *plates, options=()):
        self.succeeds(MERGE, *plates, "-o", self.folder / out, *options)
        return digests(self.folder / out)

    def test_frames_of_two_light_fields_are_no_film(self):
        self.render("film", "--keep-plates")
        other = small_field.write_field(self.folder / "other", fl_x=71)
        self.succeeds(RENDERER, other, self.path, "-o", self.folder / "film", "--frames", 2, "--keep-plates",
                      "--overwrite")
        self.fails(3, ["frame_0002.plate", "light_field.", "plates of one light field only"], MERGE,
                   self.folder / "film", "-o", self.folder / "merged")
        self.assertFalse(list(self.folder.glob("merged/frame_*")))

    def test_one_program_at_a_time_writes_into_the_folder(self):
        plates = self.shards("cut", 2)
        lock = self.folder / "out" / "partial" / "lock"
        lock.parent.mkdir(parents=True)
        with open(lock, "w", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.write("4711\n")
            file.flush()
            self.fails(4, ["partial/lock", "process 4711"], MERGE, plates, "-o", self.folder / "out")
        self.assertEqual(digests(self.folder / "out", "*.*"), {})
        self.assertEqual(len(self.merge("out", plates)), 3)
        self.assertFalse(lock.parent.exists())

    # The cuts include one with more shards than LF images, so that a shard is empty.
    def test_any_cut_gives_the_same_bits(self):
        for weights in ("auto", "none"):
            options = ["--lens-weights", weights]
            expected = self.render("whole-" + weights, *options)
            self.assertEqual(len(expected), 3)
            for count in (2,) if weights == "none" else (1, 2, 5, 10):
                out = f"{weights}-{count}"
                plates = self.shards(out, count, *options)
                self.assertEqual(digests(self.folder / out), {})
                self.assertEqual(self.merge(out, plates), expected)
            report = json.loads((self.folder / out / "report.json").read_text())
            whole = json.loads((self.folder / f"whole-{weights}" / "report.json").read_text())
            for frame in report["frames"] + whole["frames"]:
                frame.pop("develop_s")
            self.assertEqual(report["frames"], whole["frames"])
            self.assertEqual(report["inputs"], whole["inputs"])

    def test_the_order_of_plates_does_not_matter_nor_what_shards_are_interrupted(self):
        expected = self.render("whole", "--keep-plates", "--format", "png16")
        pictures = digests(self.folder / "whole", "frame_*.png")
        self.assertEqual(len(pictures), 3)
        command = [RENDERER, self.field, self.path, "-o", self.folder / "out", "--shard", "2/3",
                   "--dump-every", "0.001s"]
        for attempt in range(4):
            process = subprocess.Popen(list(map(str, command + ["--resume"])),
                                       stderr=subprocess.DEVNULL)
            time.sleep(0.03 * (attempt + 1))
            process.send_signal(signal.SIGKILL if attempt % 2 else signal.SIGTERM)
            process.communicate()
        self.succeeds(*command, "--resume")
        plates = list(self.shards("out", 3, of=(3, 1)).rglob("*.plate"))
        self.assertEqual(len(plates), 9)
        self.merge("png", *reversed(plates), options=["--format", "png16"])
        self.assertEqual(digests(self.folder / "png", "frame_*.png"), pictures)
        # Plates that were kept are developed again.
        self.merge("again", *sorted((self.folder / "whole").glob("*.plate")))
        self.assertEqual(self.merge("exr", *plates), digests(self.folder / "again"))
        self.assertEqual(expected, {})

    def test_frames_without_plates_are_named(self):
        self.render("whole", "--keep-plates")
        plates = sorted((self.folder / "whole").glob("*.plate"))
        for given, gap in ((plates, None), (plates[:2], None), (plates[::2], "frames 2:")):
            result = self.call(MERGE, *given, "-o", self.folder / "gap", "--overwrite")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("no plates are given" in result.stderr, gap is not None, result.stderr)
            self.assertIn(gap or "", result.stderr)

    def test_packages_may_be_cut_too(self):
        small_field.write_path(self.folder, aperture=0.06)
        for mode in ("collect", "hybrid"):
            expected = self.render("whole-" + mode, "--mode", mode)
            made, out = self.folder / f"packages-{mode}", self.folder / f"out-{mode}"
            self.succeeds(PREPROCESSOR, self.field, self.path, "-o", made, "--packages", "2", "--mode", mode)
            packages = sorted(made.glob("*.lfp"))
            self.assertEqual(len(packages), 2)
            for shard in ("1/2", "2/2"):
                self.succeeds(RENDERER, *packages, "-o", out, "--shard", shard, "--mode", mode)
            self.assertEqual(self.merge(out.name, out / "partial" / "shards"), expected)

    def test_what_is_missing_double_or_of_another_render_is_named(self):
        plates = self.shards("out", 3, of=(1, 3))
        self.fails(3, ["frame 1", "3 shards are expected, but 2 are given", "missing are 2"], MERGE, plates, "-o",
                   self.folder / "no")
        self.assertFalse((self.folder / "no").exists())
        self.shards("out", 3, of=(2,))
        for there, missing in (((1, 2), 3), ((2, 3), 1)):  # the last one and the first one are missing
            self.fails(3, ["frame 1", "3 shards are expected, but 2 are given", f"missing are {missing}:"], MERGE,
                       *(plates / f"shard_{k}_of_3" for k in there), "-o", self.folder / "no")
        self.shards("twice", 3, of=(2,))
        self.fails(3, ["frame 1", "shard 2/3", "give each shard once"], MERGE, plates,
                   self.folder / "twice", "-o", self.folder / "no")
        other = self.shards("other", 3, "--lens-weights", "none", of=(2,))
        shutil.copytree(other / "shard_2_of_3", plates / "shard_2_of_3", dirs_exist_ok=True)
        self.fails(3, ["lens_weights", "none"], MERGE, plates, "-o", self.folder / "no")
        two = self.shards("cut", 2, of=(1,))
        self.fails(3, ["1/2", "the same K"], MERGE, two, plates / "shard_1_of_3", "-o",
                   self.folder / "no")
        self.fails(3, ["no plates", "--shard"], MERGE, self.folder / "field", "-o",
                   self.folder / "no")
        plate = next(plates.rglob("*.plate"))
        self.fails(2, ["twice"], MERGE, plate, plate, "-o", self.folder / "no")
        shutil.rmtree(plates / "shard_2_of_3")
        self.shards("out", 3, "--overwrite", of=(2,))
        whole = plate.read_bytes()
        for rest in whole[:-9], whole[:60]:  # the first is noticed when rays are read, the second at once
            plate.write_bytes(rest)
            self.fails(3, [plate.name, "truncated", "copy the plate again, or render it again"], MERGE, plates, "-o",
                       self.folder / "no")

    def test_frames_that_are_there_are_asked_about(self):
        plates = self.shards("out", 2)
        expected = self.merge("out", plates)
        self.fails(2, ["frame_0001.exr", "--resume", "--overwrite"], MERGE, plates, "-o",
                   self.folder / "out")
        second = self.folder / "out" / "frame_0002.exr"
        second.unlink()
        first = self.folder / "out" / "frame_0001.exr"
        before = first.stat().st_mtime_ns
        self.assertEqual(self.merge("out", plates, options=["--resume"]), expected)
        self.assertEqual(first.stat().st_mtime_ns, before)
        self.assertEqual(len(json.loads((self.folder / "out" / "report.json").read_text())["frames"]),
                         3)
        self.assertEqual(self.merge("out", plates, options=["--overwrite"]), expected)
        self.assertNotEqual(first.stat().st_mtime_ns, before)

    def test_resuming_with_fewer_plates_shortens_no_video(self):
        plates = self.shards("out", 2)
        film, video = self.folder / "film", self.folder / "film.mp4"
        self.succeeds(MERGE, plates, "-o", film, "--video", video)
        before = video.read_bytes(), (film / "report.json").read_bytes()
        few = [*plates.rglob("frame_0001.plate"), *plates.rglob("frame_0002.plate")]
        self.fails(2, ["no plates are given of 1 finished frame, the first:", "frame_0003.exr", "film.mp4"], MERGE,
                   *few, "-o", film, "--video", video, "--resume")
        self.assertEqual((video.read_bytes(), (film / "report.json").read_bytes()), before)
        done = self.call(MERGE, *few, "-o", film, "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("warning: no plates are given of 1 finished frame", done.stderr)

    # A limit of the file size stands for a full disk. Existing files stay, and no partial file is left.
    def test_a_full_disk_costs_no_frame(self):
        plates = self.shards("out", 2)
        expected = self.merge("whole", plates)
        first = sorted(plates.rglob("frame_0001.plate"))
        self.assertEqual(len(first), 2)
        self.merge("cut", *first, options=["--no-contact-sheet"])
        size = (self.folder / "cut" / "frame_0001.exr").stat().st_size
        result = subprocess.run(
            [MERGE, plates, "-o", self.folder / "cut", "--resume"], capture_output=True, text=True,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size // 2, size // 2)))
        self.assertEqual(result.returncode, 4, result.stderr)
        for word in ("frame_0002", "cannot be written"):
            self.assertIn(word, result.stderr.strip().splitlines()[-1])
        self.assertEqual(sorted(path.name for path in (self.folder / "cut").iterdir()),
                         ["frame_0001.exr", "report.json"])
        self.assertEqual(self.merge("cut", plates, options=["--resume"]), expected)
        frames = json.loads((self.folder / "cut" / "report.json").read_text())["frames"]
        self.assertEqual([frame["frame"] for frame in frames], [1, 2, 3])

    # The first lens is larger than the capture, the second lies between LF cameras. One cut has more shards than LF
    # images, another one is killed.
    def test_shards_of_hybrids_add(self):
        for name, lens in (("large", {"aperture": 0.06}), ("small", {"aperture": 0.002, "x": 0.005})):
            small_field.write_path(self.folder, **lens)
            expected = self.render(name, "--mode", "hybrid", "--keep-plates")
            whole = json.loads((self.folder / name / "report.json").read_text())
            for frame in whole["frames"]:
                self.assertGreater(frame["interpolated_share"], 0.01)
            for count in (2, 10):
                if count == 2:
                    self.killed("2/2", f"{name}-2", "--mode", "hybrid")
                plates = self.shards(f"{name}-{count}", count, "--mode", "hybrid", "--threads", "1",
                                     of=(1,) if count == 2 else None)
                self.assertEqual(self.merge(f"{name}-{count}", plates), expected)
                report = json.loads((self.folder / f"{name}-{count}" / "report.json").read_text())
                for frame in report["frames"] + whole["frames"]:
                    frame.pop("develop_s", None)
                self.assertEqual(report["frames"], whole["frames"])
                self.assertEqual(report["inputs"], whole["inputs"])
            # Plates that a whole render kept are completed in the same way.
            self.assertEqual(self.merge(name + "-again", *sorted((self.folder / name).glob("*.plate"))), expected)
            looks = ["--frame-alpha", "--z", "--colour-space", "acescg", "--exr-compression", "zips"]
            self.assertEqual(self.merge(name + "-look", plates, options=looks),
                             self.render(name + "-whole-look", "--mode", "hybrid", *looks))
            shutil.rmtree(plates / "shard_7_of_10")
            self.fails(3, ["10 shards are expected, but 9 are given", "missing are 7"], MERGE, plates, "-o",
                       self.folder / "no")

    def killed(self, shard, out, *options):
        """Renders a shard that is killed several times and resumed."""
        command = [RENDERER, self.field, self.path, "-o", self.folder / out, "--shard", shard, "--dump-every", "0.001s",
                   *options, "--resume"]
        for attempt in range(4):
            process = subprocess.Popen(list(map(str, command)), stderr=subprocess.DEVNULL)
            time.sleep(0.03 * (attempt + 1))
            process.send_signal(signal.SIGTERM if attempt == 2 else signal.SIGKILL)
            process.communicate()
        self.succeeds(*command)

    def test_parts_of_other_hybrids_are_refused(self):
        small_field.write_path(self.folder, aperture=0.06)
        plates = self.shards("hybrid", 2, "--mode", "hybrid")
        for options in (["--mode", "collect"], ["--mode", "hybrid", "--lens-weights", "none"]):
            other = self.shards("other-" + options[-1], 2, *options, of=(2,))
            self.fails(3, ["shard_2_of_2"], MERGE, plates / "shard_1_of_2", other, "-o", self.folder / "no")
        plate = plates / "shard_1_of_2" / "frame_0001.plate"
        whole = plate.read_bytes()
        plate.write_bytes(without_gaps(whole))
        self.fails(3, ["shard_1_of_2/frame_0001.plate has 3 channels and no gaps of a lens, but", "shard_2_of_2"],
                   MERGE, plates, "-o", self.folder / "no")
        self.assertFalse((self.folder / "no").exists())
        plate.write_bytes(with_shares_of_0(whole))
        self.fails(3, ["shard_2_of_2/frame_0001.plate", "the gaps of its lens have a share of",
                       "but 0 in the plates before", "render it again"], MERGE, plates, "-o", self.folder / "no")
        self.assertFalse(list((self.folder / "no").glob("frame_*")))
        plate.write_bytes(whole)
        self.assertEqual(len(self.merge("merged", plates)), 3)

    # Cells do not add, and plates do not hold the light that is interpolated between them.
    def test_plates_without_the_cells_of_a_hybrid_are_told(self):
        small_field.write_path(self.folder, aperture=0.06)
        for way, is_told in (("cells", True), ("pixels", False)):
            self.render(way, "--mode", "hybrid", "--interpolation", way, "--keep-plates")
            plates = sorted((self.folder / way).glob("*.plate"))
            result = self.call(MERGE, *plates, "-o", self.folder / (way + "-again"))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("has collected rays only" in result.stderr, is_told, result.stderr)
        self.assertNotEqual(digests(self.folder / "cells"), digests(self.folder / "cells-again"))

    def test_a_shard_whose_pixels_do_not_fit_is_refused(self):
        small_field.write_path(self.folder, aperture=0.06)
        for mode, words in (("rebin", "frames ask"), ("hybrid", "gaps of lenses ask")):
            self.fails(2, ["--shard", f"--mode {mode}", words, "--max-rays 1000", "use more shards"], RENDERER,
                       self.field, self.path, "-o", self.folder / "no", "--shard", "1/2", "--mode", mode,
                       "--max-rays", "1000")

    def test_what_shards_cannot_do_is_refused(self):
        for options in (["--mode", "hybrid", "--kept", "edges"], ["--mode", "hybrid", "--interpolation", "cells"],
                        ["--mode", "rebin", "--kept", "edges"],
                        ["--mode", "rebin", "--interpolation", "cells"],
                        ["--stop-when", "samples>=3"], ["--keep-plates"],
                        ["--video", self.folder / "a.mp4"], ["--require", "samples>=2"]):
            self.fails(2, ["--shard"], RENDERER, self.field, self.path, "-o", self.folder / "no",
                       "--shard", "1/2", *options)
        for shard in ("0/2", "3/2", "1", "1/", "/2", "1/2/3", "a/b", "-1/2", "1/99999999999"):
            self.fails(2, ["--shard", "expected k/K"], RENDERER, self.field, self.path, "-o",
                       self.folder / "no", "--shard", shard)


if __name__ == "__main__":
    RENDERER, MERGE, PREPROCESSOR = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1], verbosity=2)
