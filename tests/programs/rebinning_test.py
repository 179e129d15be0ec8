#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfrenderer --mode rebin and hybrid: the bits do not depend on threads or kills, memory stays below its limit,
and messages are correct.

usage: rebinning_test.py LFRENDERER LFPREPROCESSOR LFMERGE
"""
import hashlib
import itertools
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy as np

import small_field
from program_test_case import ProgramTestCase, wait_until

RENDERER = PREPROCESSOR = MERGE = None


def digests(folder):
    """Returns the sha256 of the frames of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.glob("frame_*.exr"))}


def report(folder):
    return json.loads((folder / "report.json").read_text())


def rays_of(partial):
    """Returns the files of rebinned rays and of kept pixels in the state of a render."""
    return [*partial.glob("rays_*.rays"), *partial.glob("kept_*.pixels")]


class RebinningTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 13  # 169 LF images: rules are tested after 64 and 128 of them
        self.field = small_field.write_field(self.folder / "field")

    def path(self, **keys):
        return small_field.write_path(self.folder, **keys)

    def command(self, out, *options):
        return [RENDERER, self.field, self.folder / "path.yaml", "-o", self.folder / out, "--format",
                "exr-float", "--no-contact-sheet", *options]

    def render(self, out, *options, code=0):
        self.succeeds(*self.command(out, *options), code=code)
        return digests(self.folder / out)

    def test_the_same_bits_for_any_threads(self):
        self.path(aperture=0.02)
        for mode in ("rebin", "hybrid"):
            for options in ([], ["--kept", "edges", "--seed", "3"], ["--max-rays", "20000"],
                            ["--preview", "on"], ["--preview", "on", "--colour-sigma", "1"],
                            ["--interpolation", "cells", "--max-rays", "20000"]):
                expected = self.render("one", "--mode", mode, "--threads", "1", *options)
                self.assertEqual(len(expected), 3)
                for threads in ("2", "3"):
                    shutil.rmtree(self.folder / "many", ignore_errors=True)
                    self.assertEqual(self.render("many", "--mode", mode, "--threads", threads,
                                                 *options), expected)
                shutil.rmtree(self.folder / "one")

    def test_another_seed_keeps_other_rays(self):
        self.path(aperture=0.02, frames=1)
        options = ["--mode", "rebin", "--kept", "edges", "--alpha", "0.1"]
        self.assertNotEqual(self.render("a", *options, "--seed", "1"),
                            self.render("b", *options, "--seed", "2"))

    # Kills the render at any moment, also between writing two files of a state.
    def test_killed_and_resumed_the_same_bits(self):
        self.path(aperture=0.02, frames=6)
        for mode, way in itertools.product(("rebin", "hybrid"), ("pixels", "cells")):
            options = ["--mode", mode, "--interpolation", way, "--dump-every", "0.001s", "--kept", "edges"]
            if way == "cells":
                options += ["--preview", "on"]
            name = f"{mode}-{way}"
            start = time.monotonic()
            expected = self.render("whole-" + name, *options)
            whole_s = time.monotonic() - start
            kills = 0
            for attempt in range(12):
                process = subprocess.Popen(
                    list(map(str, self.command("cut-" + name, *options, "--resume"))),
                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                try:
                    process.wait(whole_s * (attempt + 2) / 14)
                except subprocess.TimeoutExpired:
                    process.send_signal(signal.SIGKILL if attempt % 2 else signal.SIGTERM)
                    kills += 1
                process.communicate()
                if process.returncode == 0:
                    break
                # A signal ends a program that cannot catch signals yet.
                self.assertIn(process.returncode, (-signal.SIGKILL, -signal.SIGTERM, 5))
            self.assertGreater(kills, 2)
            self.assertEqual(self.render("cut-" + name, *options, "--resume"), expected)
            self.assertFalse((self.folder / ("cut-" + name) / "partial").exists())

    def interrupted(self, out, delay_s, *options):
        """Returns pictures of the unfinished frames of a render that was interrupted `delay_s` after it wrote the
        first of them."""
        process = subprocess.Popen(list(map(str, self.command(out, *options))),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        partial = self.folder / out / "partial"
        wait_until(lambda: any(partial.glob("frame_*.exr")), process)
        time.sleep(delay_s)
        process.send_signal(signal.SIGTERM)
        process.communicate()
        if process.returncode != 5:
            return {}
        return {path.name: cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
                for path in partial.glob("frame_*.exr")}

    def test_frames_are_finished_early_with_the_rays_of_the_state(self):
        self.path(aperture=0.05, frames=6)  # with several batches of LF images
        for mode in ("rebin", "hybrid"):
            options = ["--mode", mode, "--dump-every", "0.001s", "--threads", "1", "--back-end",
                       "reference" if mode == "hybrid" else "fast"]
            expected = self.render("whole-" + mode, *options)
            was_cut = False
            for attempt in range(90):  # on a busy machine most signals come too late
                out = f"{mode}-{attempt}"
                pictures = self.interrupted(out, 0.001 * (attempt % 15), *options)
                unfinished = sorted(set(pictures) - set(digests(self.folder / out)))
                if not unfinished:
                    continue
                early = unfinished[-1]
                frames = self.render(out, *options, "--resume", "--finish", str(int(early[6:10])))
                self.assertEqual({name: bits for name, bits in frames.items() if name != early},
                                 {name: bits for name, bits in expected.items() if name != early})
                told = {frame["frame"]: frame.get("finished_early_before_rank")
                        for frame in report(self.folder / out)["frames"]}
                place = told.pop(int(early[6:10]))
                self.assertEqual(set(told.values()), {None})
                if place is None:  # it had all its rays when it was interrupted
                    self.assertEqual(frames[early], expected[early])
                    continue
                self.assertTrue(0 < place <= 169, place)
                picture = cv2.imread(str(self.folder / out / early), cv2.IMREAD_UNCHANGED)
                np.testing.assert_array_equal(picture, pictures[early])
                was_cut = True
                break
            self.assertTrue(was_cut, mode)

    def test_resumed_with_other_choices_is_refused(self):
        self.path(aperture=0.02)
        cells = ["--mode", "rebin", "--interpolation", "cells"]
        # A render that ends before it can be killed removes its rays.
        for attempt in range(30):
            out = f"out{attempt}"
            process = subprocess.Popen(
                list(map(str, self.command(out, *cells, "--dump-every", "0.001s"))),
                stderr=subprocess.PIPE)
            partial = self.folder / out / "partial"
            wait_until(lambda: any(rays_of(partial)), process)
            process.kill()
            process.communicate()
            rays = rays_of(partial)
            if rays:
                break
        self.assertTrue(rays)
        self.fails(2, ["--resume", "--overwrite"], *self.command(out, *cells))
        self.fails(2, ["sigma_st 0.5, this call has 0.7"],
                   *self.command(out, *cells, "--resume", "--sigma-st", "0.7"))
        self.fails(2, ["interpolation cells, this call has pixels"],
                   *self.command(out, "--mode", "rebin", "--interpolation", "pixels", "--lens-weights", "none",
                                 "--resume"))
        rays[0].write_bytes(rays[0].read_bytes()[:-5])
        self.fails(3, [rays[0].name, "remove the file"],
                   *self.command(out, *cells, "--resume"))

    # If LF cameras fill a lens, nothing is interpolated.
    def test_hybrid_of_a_full_lens_is_what_is_collected(self):
        path = self.path(aperture=0.045)
        # All LF cameras see the whole frame.
        path.write_text(path.read_text().replace("field_of_view_deg: 50", "field_of_view_deg: 25"))
        self.render("collect")
        self.render("hybrid", "--mode", "hybrid")
        for frame in report(self.folder / "hybrid")["frames"]:
            self.assertEqual(frame["interpolated_share"], 0)
        pictures = ["frame_0001.exr", "frame_0003.exr"]
        for name in pictures:
            self.assertEqual(self.rgb("collect", name), self.rgb("hybrid", name))

    def rgb(self, out, name):
        return cv2.imread(str(self.folder / out / name), cv2.IMREAD_UNCHANGED).tobytes()

    # Between LF cameras nothing is collected, and the whole frame is interpolated.
    def test_a_small_lens_between_cameras_is_interpolated(self):
        self.path(aperture=0.002, x=0.005)
        words = self.call(*self.command("collect", "--lens-weights", "none"))
        self.assertNotEqual(words.returncode, 0)
        self.assertIn("no LF image contributes", words.stderr)
        for mode in ("rebin", "hybrid"):
            self.render(mode, "--mode", mode, "--lens-weights", "none", "--interpolation", "cells")
            for frame in report(self.folder / mode)["frames"]:
                self.assertGreater(frame["interpolated_share"], 0.7)

    def test_the_cap_of_rays_and_the_memory_hold(self):
        self.path(aperture=0.06, frames=2)
        self.render("out", "--mode", "rebin", "--max-rays", "5000", "-v")
        self.fails(4, ["--max-rays"], *self.command("no", "--mode", "rebin", "--max-rays",
                                                    "9000000000"))
        self.fails(4, ["--memory"], *self.command("no", "--mode", "hybrid", "--memory", "20M"))

    def test_what_rebinning_cannot_do_is_refused(self):
        self.path()
        for options in (["--stop-when", "samples>=3"], ["--require", "samples>=3"], ["--smooth-below", "2"],
                        ["--keep-plates", "--interpolation", "cells"], ["--keep-plates", "--lens-weights", "none"]):
            self.fails(2, ["--mode rebin"], *self.command("no", "--mode", "rebin", *options))
        self.fails(2, ["--interpolation pixels", "--sigma-st 0.7", "use --interpolation cells"],
                   *self.command("no", "--mode", "rebin", "--interpolation", "pixels", "--sigma-st", "0.7"))
        self.fails(2, ["--shard", "--kept edges", "leave out"],
                   *self.command("no", "--mode", "rebin", "--kept", "edges", "--shard", "1/2"))
        self.fails(2, ["--lens-sets"], *self.command("no", "--mode", "rebin", "--reparameterise",
                                                     "off", "--lens-sets", "2"))
        self.fails(2, ["--max-rays 1", "1000"],
                   *self.command("no", "--mode", "rebin", "--max-rays", "1"))
        self.fails(2, ["--slab-forward"],
                   *self.command("no", "--mode", "rebin", "--slab-forward", "0", "0", "0"))
        self.fails(2, ["--slab-forward 0 0 2.5:", "frame 1 is 180 degrees away", "within 60 degrees"],
                   *self.command("no", "--mode", "rebin", "--slab-forward", "0", "0", "2.5"))
        self.fails(2, ["--nearest", "--back-end reference"],
                   *self.command("no", "--mode", "rebin", "--nearest", "4"))

    # Without a mode that rebins, they would be ignored. Defaults may be stated.
    def test_options_of_rebinning_need_a_mode(self):
        self.path(frames=1)
        for options in (["--kept", "all"], ["--xi", "0.2"], ["--max-rays", "5000"], ["--interpolation", "pixels"],
                        ["--alpha", "0"], ["--preview", "off"], ["--nearest", "2", "--back-end", "reference"],
                        ["--slab-position", "0", "0", "0"], ["--mode", "collect", "--coverage-cells", "32"]):
            self.fails(2, ["changes nothing in --mode collect: add --mode rebin or --mode hybrid"],
                       *self.command("no", *options))
        self.assertFalse((self.folder / "no").exists())
        self.fails(2, ["--kept all, --xi 0.2 change nothing"], *self.command("no", "--kept", "all", "--xi", "0.2"))
        self.fails(2, ["--interpolation cells changes nothing"], PREPROCESSOR, self.field, self.folder / "path.yaml",
                   "-o", self.folder / "no", "--interpolation", "cells")
        self.render("defaults", "--alpha", "8", "--kept", "auto", "--max-rays", "0")

    # A plate of kept pixels has what collection keeps, if all pixels are kept; lfmerge makes the frame of any.
    def test_kept_pixels_have_plates(self):
        self.path(aperture=0.02, frames=2)
        self.render("collected", "--keep-plates")
        for name, options in (("all", []), ("edges", ["--kept", "edges"]), ("noise", ["--stop-when", "noise<=0.0001"])):
            frames = self.render(name, "--mode", "rebin", "--keep-plates", *options)
            plates = sorted((self.folder / name).glob("*.plate"))
            self.assertEqual(len(plates), 2)
            merged = self.folder / f"merged-{name}"
            self.succeeds(MERGE, *plates, "-o", merged, "--format", "exr-float", "--no-contact-sheet")
            self.assertEqual(digests(merged), frames)
        self.assertEqual(self.plate_words("all"), self.plate_words("collected"))
        self.assertNotEqual(self.plate_words("edges"), self.plate_words("collected"))

    def plate_words(self, out):
        """Returns the sums and counts in the plates of a folder, without head and text (doc/formats/plate.md)."""
        plates = [path.read_bytes() for path in sorted((self.folder / out).glob("*.plate"))]
        return [plate[48 + int.from_bytes(plate[12:16], "little"):] for plate in plates]

    def test_all_pixels_are_kept_or_the_render_does_not_begin(self):
        self.path(aperture=0.02, frames=2)
        for mode in ("rebin", "hybrid"):
            options = ["--mode", mode, "--lens-weights", "none", "--interpolation", "pixels", "--kept", "all"]
            self.fails(2, ["--kept all: frames ask for about", "--max-rays 1000 has no room", "use --kept auto"],
                       *self.command("few-" + mode, *options, "--max-rays", "1000"))
            self.assertFalse(list((self.folder / ("few-" + mode)).glob("frame_*")))
            self.render(mode, *options)
            rebinning = report(self.folder / mode)["rebinning"]
            self.assertEqual((rebinning["kept"], rebinning["kept_share"]), ("all", 1))
            self.assertEqual(rebinning["pixels"], rebinning["lf_pixels_looked_at"])
            self.assertEqual((rebinning["cells"], rebinning["slabs"]), (0, 0))
        self.render("auto", "--mode", "rebin", "--max-rays", "5000")
        rebinning = report(self.folder / "auto")["rebinning"]
        self.assertLessEqual(rebinning["pixels"], 5000)
        self.assertAlmostEqual(rebinning["kept_share"], rebinning["pixels"] / rebinning["lf_pixels_looked_at"])

    # The reference back end queries a k-d tree element by element. If it uses the rays within reach, the result equals
    # the result of splats. If it uses the nearest rays (--nearest), it finds a ray for every point of the lens.
    def test_the_reference_back_end_asks_a_tree(self):
        self.path(aperture=0.004, frames=1, x=0.005)
        options = ["--mode", "rebin", "--lens-points", "4"]
        pictures = {}
        for name, more in (("fast", []), ("reference", ["--back-end", "reference"]),
                           ("nearest", ["--back-end", "reference", "--nearest", "1"])):
            self.render(name, *options, *more)
            pictures[name] = cv2.imread(str(self.folder / name / "frame_0001.exr"),
                                        cv2.IMREAD_UNCHANGED)[..., :3].astype(float)
        self.assertLess(np.sqrt(((pictures["fast"] - pictures["reference"]) ** 2).mean()), 0.1 / 255)
        off = np.sqrt(((pictures["fast"] - pictures["nearest"]) ** 2).mean())
        self.assertGreater(off, 1e-4)
        self.assertLess(off, 0.3)

    def test_slabs_may_be_placed_and_left_as_they_are(self):
        self.path(aperture=0.02, frames=1)
        plain = self.render("plain", "--mode", "rebin", "--interpolation", "cells")
        for i, options in enumerate((["--reparameterise", "off"],
                                     ["--slab-distance", "1.5", "--reparameterise", "off"],
                                     ["--slab-position", "0", "0", "0.1"],
                                     ["--slab-forward", "0.1", "0", "-1"],
                                     ["--r-st", "0.004", "--r-uv", "0.02"],
                                     ["--lens-sets", "2", "--lens-points", "9"],
                                     ["--average-others", "on", "--kept", "edges"])):
            other = self.render(f"other{i}", "--mode", "rebin", *options)
            self.assertNotEqual(plain, other)
            self.assertGreater(report(self.folder / f"other{i}")["frames"][0]["interpolated_share"],
                               0.8, options)

    def test_packages_and_broken_images(self):
        path = self.path(aperture=0.02)
        (self.folder / "field" / "image_84.png").write_bytes(b"broken")
        expected = self.render("whole", "--mode", "hybrid", code=6)
        self.assertEqual(len(report(self.folder / "whole")["skipped_lf_images"]), 1)
        self.succeeds(PREPROCESSOR, self.field, path, "-o", self.folder / "packages")
        self.succeeds(RENDERER, *sorted((self.folder / "packages").glob("*.lfp")), "-o",
                      self.folder / "frames", "--mode", "hybrid", "--format", "exr-float",
                      "--no-contact-sheet", code=6)
        self.assertEqual(len(digests(self.folder / "frames")), len(expected))

    def test_stop_rules_and_plates_go_with_hybrid(self):
        self.path(aperture=0.045)
        self.render("plain", "--keep-plates", "--lens-weights", "none")
        self.render("hybrid", "--keep-plates", "--lens-weights", "none", "--mode", "hybrid",
                    "--require", "samples>=1")
        self.render("stopped", "--stop-when", "samples>=2", "--mode", "hybrid")


if __name__ == "__main__":
    RENDERER, PREPROCESSOR, MERGE = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1], verbosity=2)
