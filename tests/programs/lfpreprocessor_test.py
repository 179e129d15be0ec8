#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests packages from a user's view: made by lfpreprocessor, rendered by lfrenderer to the same bits.

usage: lfpreprocessor_test.py LFPREPROCESSOR LFRENDERER
"""
import hashlib
import json
import pathlib
import shutil
import signal
import sqlite3
import struct
import subprocess
import sys
import time
import unittest

import numpy as np
from PIL import Image

from program_test_case import ProgramTestCase, wait_until
from small_field import (HEIGHT, SIDE, WALL_DEPTH, WIDTH, wall, write_field,
                         write_path)

PREPROCESSOR = RENDERER = None


class PackagesTest(ProgramTestCase):
    def digests(self, folder):
        return {frame.name: hashlib.sha256(frame.read_bytes()).hexdigest()
                for frame in sorted(folder.glob("frame_*.exr"))}

    def film(self, frames=6, **keys):
        return write_field(self.folder / "field", **keys), write_path(self.folder, frames=frames)

    def packages(self, field, path, *options, name="packages"):
        """Makes packages. Returns the report and the package files."""
        out = self.folder / name
        report = json.loads(self.succeeds(PREPROCESSOR, field, path, "-o", out, "--json", *options))
        files = sorted(out.glob("*.lfp"))
        self.assertEqual([file.stem for file in files], [p["name"] for p in report["packages"]])
        return report, files

    # Identical bits

    def test_packages_render_to_the_bits_of_the_whole_film(self):
        """Holds for all options that select, weight and limit rays."""
        field, path = self.film()
        for number, (preprocess, render) in enumerate([
                ([], []),
                ([], ["--estimator", "nearest"]),
                ([], ["--estimator", "nearest", "--rectangles", "off"]),
                ([], ["--rectangles", "off"]),
                ([], ["--lens-weights", "none", "--stop-when", "samples>=4"]),
                ([], ["--lens-weights", "hat", "--back-end", "reference"]),
                (["--lens-weights", "none"], ["--lens-weights", "none"]),
                (["--max-images", "7"], ["--max-images", "7"]),
                (["--seed", "3", "--max-images", "7"], ["--max-images", "5", "--seed", "3"])]):
            with self.subTest(preprocess=preprocess, render=render):
                _, files = self.packages(field, path, "--packages", "3", *preprocess,
                                         name=f"packages{number}")
                whole, parts = self.folder / f"whole{number}", self.folder / f"parts{number}"
                self.succeeds(RENDERER, field, path, "-o", whole, "-q", *render)
                # Packages contain these choices, so lfrenderer needs no options for them. The bits are the same.
                if set(render) & {"--seed", "off"}:
                    render = render[:-2]
                self.succeeds(RENDERER, *files, "-o", parts, "-q", *render)
                self.assertEqual(len(self.digests(whole)), 6)
                self.assertEqual(self.digests(whole), self.digests(parts))
                for name in ("contact_sheet.png", "report-package-0002.json"):
                    self.assertTrue((parts / name).exists(), name)
                self.assertFalse((parts / "partial").exists())

    def test_mosaics_distortion_masks_and_gains_come_along(self):
        def picture(index):
            return np.random.default_rng(index).integers(0, 60000, (HEIGHT, WIDTH), dtype=np.uint16)
        field = write_field(self.folder / "field", picture, lf_bayer="RGGB", lf_transfer="linear",
                            lf_black_level=100, lf_white_balance=[2, 1, 1.5], k1=0.05, k2=-0.01,
                            p1=0.001, p2=0.0, camera_model="OPENCV")
        text = json.loads(field.read_text())
        mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
        mask[:, :WIDTH // 2] = 0
        Image.fromarray(mask).save(self.folder / "field" / "mask.png")
        text["frames"][3]["lf_mask"] = "mask.png"
        text["frames"][4]["lf_gain"] = 1.25
        field.write_text(json.dumps(text))
        path = write_path(self.folder, frames=4)
        _, files = self.packages(field, path, "--frames-per-package", "3")
        self.assertEqual(len(files), 2)
        self.succeeds(RENDERER, field, path, "-o", self.folder / "whole", "-q")
        self.succeeds(RENDERER, *files, "-o", self.folder / "parts", "-q")
        self.assertEqual(self.digests(self.folder / "whole"), self.digests(self.folder / "parts"))

    def test_every_order_ends_with_the_same_frames(self):
        field, path = self.film()
        whole = self.folder / "whole"
        self.succeeds(RENDERER, field, path, "-o", whole, "-q")
        for order in ("round-robin", "area", "groups"):
            _, files = self.packages(field, path, "--order", order, "--packages", "2", name=order)
            self.succeeds(RENDERER, *files, "-o", self.folder / f"out-{order}", "-q")
            self.assertEqual(self.digests(self.folder / f"out-{order}"), self.digests(whole))

    def test_lf_cameras_beyond_the_angle_have_no_say(self):
        """LF cameras beyond --max-angle are treated as if they had not been recorded."""
        field, path = self.film()
        text = json.loads(field.read_text())
        kept = []
        for index, frame in enumerate(text["frames"]):
            if index % 3 == 0:  # rotated by 3 degrees about y
                c, s = np.cos(np.radians(3)), np.sin(np.radians(3))
                for row, values in enumerate([[c, 0, s], [0, 1, 0], [-s, 0, c]]):
                    frame["transform_matrix"][row][:3] = values
            else:
                kept.append(frame)
        field.write_text(json.dumps(text))
        fewer = field.with_name("fewer.json")
        fewer.write_text(json.dumps({**text, "frames": kept}))
        for weights in ("none", "auto"):
            options = ["--lens-weights", weights]
            _, files = self.packages(field, path, "--max-angle", "2", *options, name=f"p{weights}")
            out, expected = self.folder / f"out{weights}", self.folder / f"expected{weights}"
            self.succeeds(RENDERER, *files, "-o", out, "-q", *options, "--format", "png16")
            self.succeeds(RENDERER, fewer, path, "-o", expected, "-q", *options, "--format", "png16")
            direct = self.folder / f"direct{weights}"
            self.succeeds(RENDERER, field, path, "-o", direct, "-q", *options, "--format", "png16",
                          "--max-angle", "2")
            for name in ("frame_0001.png", "frame_0006.png"):
                with (Image.open(out / name) as a, Image.open(expected / name) as b,
                      Image.open(direct / name) as c):
                    self.assertEqual(a.tobytes(), b.tobytes())
                    self.assertEqual(a.tobytes(), c.tobytes())
            self.fails(2, ["--max-angle", "leave it out"], RENDERER, *files, "-o", out,
                       "--overwrite", "--max-angle", "2")

    def test_frames_of_a_package_may_be_asked_for(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2", "--frames", "1-6x2")
        out = self.folder / "out"
        self.succeeds(RENDERER, *files, "-o", out, "-q", "--frames", "3")
        self.assertEqual(list(self.digests(out)), ["frame_0003.exr"])
        self.fails(2, ["frame 4", "not in any of the given packages"], RENDERER, *files, "-o", out, "--frames",
                   "3-4")

    def test_frames_that_nobody_sees_are_black_in_packages_too(self):
        field = write_field(self.folder / "field")
        path = self.folder / "path.yaml"
        write_path(self.folder, frames=4)
        path.write_text(path.read_text().replace(
            "keyframes:", "keyframes:\n  position: [{time: 0, value: [0, 0, 0]}, "
                          "{time: 0.12, value: [50, 0, 0]}]"))
        options = ["--lens-weights", "none"]
        _, files = self.packages(field, path, "--frames-per-package", "1", *options)
        self.succeeds(RENDERER, field, path, "-o", self.folder / "whole", *options)
        self.succeeds(RENDERER, *files, "-o", self.folder / "parts", *options)
        self.assertEqual(self.digests(self.folder / "whole"), self.digests(self.folder / "parts"))
        # A package whose frames have no rays can be rendered alone.
        self.succeeds(RENDERER, files[-1], "-o", self.folder / "black", *options)
        _, black = self.packages(field, path, "--frames", "1,4", *options, name="some")
        self.assertEqual(len(black), 1)

    # Many machines, one folder

    def test_two_processes_render_into_one_folder(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2")
        whole, parts = self.folder / "whole", self.folder / "parts"
        self.succeeds(RENDERER, field, path, "-o", whole, "-q")
        runs = [subprocess.Popen([RENDERER, file, "-o", parts, "-q", "--no-contact-sheet"])
                for file in files]
        self.assertEqual([run.wait(120) for run in runs], [0, 0])
        self.assertEqual(self.digests(whole), self.digests(parts))

    def test_a_killed_package_goes_on_and_leaves_others_alone(self):
        field, path = self.film(frames=40)
        _, files = self.packages(field, path, "--packages", "2")
        # A killed render leaves nothing of unfinished frames if it was killed between two frames.
        for attempt in range(30):
            out = self.folder / f"out{attempt}"
            options = ["-o", out, "-q", "--no-contact-sheet", "--back-end", "reference",
                       "--dump-every", "0.05s"]
            run = subprocess.Popen([RENDERER, files[1], *map(str, options)])
            partial = out / "partial" / "package-0001"
            wait_until(lambda: any(partial.glob("frame_*")), run)
            run.send_signal(signal.SIGKILL)
            run.wait()
            left = sorted(p.name for p in partial.glob("frame_*"))
            if left:
                break
        self.assertTrue(left)
        self.succeeds(RENDERER, files[0], *options)
        self.assertEqual(sorted(p.name for p in partial.glob("frame_*")), left)
        self.fails(2, ["--resume"], RENDERER, files[1], *options)
        self.succeeds(RENDERER, files[1], *options, "--resume")
        self.assertFalse((out / "partial").exists())
        self.succeeds(RENDERER, field, path, "-o", self.folder / "whole", "-q", "--back-end",
                      "reference")
        self.assertEqual(self.digests(self.folder / "whole"), self.digests(out))

    # Refusals

    def test_damage_and_strangers_are_input_errors(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2")
        out, whole = self.folder / "out", files[0].read_bytes()
        for at in (10, 70, 5000, len(whole) // 2, len(whole) - 3):
            damaged = bytearray(whole)
            damaged[at] ^= 4
            files[0].write_bytes(damaged)
            self.fails(3, ["package-0000.lfp"], RENDERER, files[0], "-o", out)
        files[0].write_bytes(whole[:-1000])
        self.fails(3, ["package-0000.lfp", "damaged"], RENDERER, files[0], "-o", out)
        newer = bytearray(whole)
        newer[63] = 9
        files[0].write_bytes(newer)
        self.fails(3, ["version 9", "newer"], RENDERER, files[0], "-o", out)
        files[0].write_bytes(b"something else")
        self.fails(3, ["is no package"], RENDERER, files[0], "-o", out)
        self.fails(3, ["no such file"], RENDERER, self.folder / "none.lfp", "-o", out)
        self.assertFalse(list(out.glob("frame_*")) if out.exists() else [])

    def test_another_light_field_is_an_input_error(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2")
        out = self.folder / "out"

        # Packages of two light fields are refused together.
        other = write_field(self.folder / "other", fl_y=71)
        _, others = self.packages(other, path, "--packages", "2", name="others")
        self.fails(3, ["another light field"], RENDERER, files[0], others[1], "-o", out)
        _, shuffled = self.packages(field, path, "--packages", "2", "--seed", "1", name="shuffled")
        self.fails(3, ["another order"], RENDERER, files[0], shuffled[1], "-o", out)

        # The light field was moved, with its packages or without them.
        self.succeeds(RENDERER, files[0], "-o", out, "-q", "--lightfield", field)
        self.fails(3, ["another light field", "calibration"], RENDERER, files[0], "-o", out,
                   "--lightfield", other)
        moved = self.folder / "moved"
        shutil.move(self.folder / "field", moved)
        self.fails(3, ["--lightfield"], RENDERER, files[0], "-o", out)
        self.succeeds(RENDERER, files[0], "-o", out, "-q", "--lightfield", moved)

        # Other images have taken their place.
        write_field(self.folder / "field", lambda i: np.zeros((HEIGHT, WIDTH, 3), np.uint8))
        self.fails(3, ["another light field", "bytes"], RENDERER, files[0], "-o", out)

    def test_usage(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2", "--max-images", "9",
                                 "--lens-weights", "none")
        out = self.folder / "out"
        self.fails(2, ["made with lfpreprocessor --lens-weights none"], RENDERER, *files, "-o", out)
        none = ["--lens-weights", "none"]
        self.fails(2, ["--max-images 9"], RENDERER, *files, "-o", out, "--max-images", "10", *none)
        self.fails(2, ["--seed"], RENDERER, *files, "-o", out, "--seed", "1", *none)
        self.fails(2, ["frame 1"], RENDERER, files[0], files[1],
                   self.again(files[0]), "-o", out, *none)
        self.fails(2, ["LIGHTFIELD PATH"], RENDERER, files[0], path, "-o", out)
        self.fails(2, ["LIGHTFIELD PATH"], RENDERER, field, "-o", out)
        self.fails(2, ["--lightfield"], RENDERER, field, path, "-o", out, "--lightfield", field)
        self.fails(2, ["--lightfield"], RENDERER, *files, "-o", out, "--images", "x", *none)
        self.fails(2, [".lfp"], RENDERER, self.folder / "packages", "-o", out)
        self.fails(2, ["--plan"], PREPROCESSOR, field, path)
        self.fails(2, ["--overwrite"], PREPROCESSOR, field, path, "-o", self.folder / "packages")
        self.fails(2, ["less than the far depth"], PREPROCESSOR, field, path, "--plan", "--depths", "3", "2")
        self.fails(2, ["--packages"], PREPROCESSOR, field, path, "--plan", "--packages", "2",
                   "--frames-per-package", "3")
        self.fails(4, ["--memory"], PREPROCESSOR, field, path, "--plan", "--memory", "1M")

    def again(self, file):
        return shutil.copy(file, self.folder / "copy.lfp")

    def test_two_films_do_not_share_a_folder(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2")
        write_path(self.folder, frames=6, aperture=0.03)
        _, others = self.packages(field, path, "--packages", "2", name="others")
        out = self.folder / "out"
        self.succeeds(RENDERER, files[0], "-o", out, "-q")
        self.fails(2, ["report-package-0000.json", "picture.film"], RENDERER, others[1], "-o", out)
        self.fails(2, ["picture.format"], RENDERER, files[1], "-o", out, "--format", "png")
        self.succeeds(RENDERER, files[1], "-o", out, "-q")
        self.assertTrue((out / "contact_sheet-package-0001.png").exists())
        told = self.call(RENDERER, files[0], "-o", out)
        self.assertIn("see " + str(out / "contact_sheet-package-0000.png"), told.stderr)

    def test_a_part_of_a_film_is_told(self):
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "3")
        told = self.call(RENDERER, *files[:2], "-o", self.folder / "out")
        self.assertEqual(told.returncode, 0)
        self.assertIn("2 of the film's 3 packages", told.stderr)

    def test_missing_lf_images_are_told(self):
        field, path = self.film()
        (self.folder / "field" / "image_03.png").unlink()
        text = self.succeeds(PREPROCESSOR, field, path, "--plan", code=6)
        self.assertIn("1 of 25 LF images that packages need do not exist", text)
        self.fails(3, ["--strict", "image_03.png"], PREPROCESSOR, field, path, "-o",
                   self.folder / "strict", "--strict")
        self.assertEqual(list((self.folder / "strict").glob("*.lfp")), [])

    def test_an_interrupted_call_leaves_no_part_of_a_film(self):
        """At any moment, an interrupt leaves either all packages, complete, or none."""
        field, path = self.film(frames=150)
        _, files = self.packages(field, path, "--packages", "3")
        whole = [file.read_bytes() for file in files]
        codes = set()
        for attempt in range(12):
            out = self.folder / f"interrupted{attempt}"
            run = subprocess.Popen([PREPROCESSOR, field, path, "-o", out, "-q", "--packages", "3"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wait_until(out.exists, run)
            time.sleep(0.02 * attempt)
            run.send_signal(signal.SIGINT)
            codes.add(run.wait(60))
            left = [file.read_bytes() for file in sorted(out.iterdir())]
            self.assertEqual(left, whole if run.returncode == 0 else [])
        self.assertIn(5, codes)
        self.assertTrue(codes <= {0, 5}, codes)

    def test_packages_are_replaced_on_request(self):
        field, path = self.film()
        self.packages(field, path, "--packages", "3")
        _, files = self.packages(field, path, "--packages", "2", "--overwrite")
        self.assertEqual(len(files), 2)

    # Reports

    def test_a_forecast_is_the_sum_of_the_stages_of_its_mode(self):
        field, path = self.film()
        memory = {}
        for mode, cells, options in (("collect", False, []), ("rebin", True, ["--lens-weights", "none"]),
                                     ("hybrid", True, ["--interpolation", "cells"]), ("rebin", False, []),
                                     ("hybrid", False, [])):
            plan = json.loads(self.succeeds(PREPROCESSOR, field, path, "--plan", "--json", "--packages", "1",
                                            "--mode", mode, *options))
            package = plan["packages"][0]
            stages = package["cpu_s_of"]
            self.assertAlmostEqual(package["cpu_s"], sum(stages.values()), 9)
            self.assertAlmostEqual(stages["load"], plan["rate"]["cpu_s_per_lf_image"] * package["lf_images"], 9)
            self.assertAlmostEqual(stages["finish"], plan["rate"]["cpu_s_per_frame"] * len(package["frames"]), 9)
            self.assertEqual(stages["rebin"] + stages["complete"] > 0, cells, stages)
            self.assertEqual(stages["collect"] > 0, (mode, cells) != ("rebin", True), stages)
            memory[mode, cells] = package["memory_bytes"]
        # Rays take the memory that they fill, not the part of --memory that is theirs. Cells are refused if this part,
        # a half or a quarter, is less than 192 MiB.
        for (mode, cells), planned in memory.items():
            part = {"rebin": 2, "hybrid": 4}.get(mode, 1)
            self.assertLess(planned, part * 210e6 if cells else 100e6, (mode, cells))
        self.assertGreater(memory["rebin", True], 0)
        self.assertGreater(memory["rebin", False], memory["collect", False])

    def test_a_plan_tells_what_packages_will_be(self):
        field, path = self.film()
        plan = json.loads(self.succeeds(PREPROCESSOR, field, path, "--plan", "--json",
                                        "--packages", "3"))
        made, _ = self.packages(field, path, "--packages", "3")
        self.assertIsNone(plan["output"])
        for a, b in zip(plan["packages"], made["packages"], strict=True):
            for key in ("name", "frames", "lf_images", "neighbours", "rays", "bytes_to_read"):
                self.assertEqual(a[key], b[key], key)
        self.assertLess(plan["largest_over_mean_rays"], 1.1)
        self.assertGreater(plan["rate"]["cpu_s_per_ray"], 0)
        size = sum(image.stat().st_size for image in (self.folder / "field").glob("*.png"))
        self.assertEqual(plan["packages"][0]["bytes_to_read"], size)
        self.assertEqual(len(plan["frames"]), 6)
        text = self.succeeds(PREPROCESSOR, field, path, "--plan")
        for words in ("package-0000", "LF cameras", "displacement", "about"):
            self.assertIn(words, text)

    def test_a_sparse_capture_is_warned_of_in_plain_words(self):
        field, path = self.film()
        # f = 80 / (2 tan 25) = 86 px, spacing 9 mm, focus 0.8 m: 86 x 0.009 x |1/0.1 - 1/0.8| = 7
        text = self.succeeds(PREPROCESSOR, field, path, "--plan", "--depths", "0.1", "4")
        for words in ("expect double edges, 7 px apart, at 100 mm", "mm apart in the lens", "needed",
                      "What would help"):
            self.assertIn(words, text)
        self.assertNotIn("double edges", self.succeeds(
            PREPROCESSOR, field, path, "--plan", "--depths", "0.7", "4"))
        write_path(self.folder, aperture=0.2)
        self.assertIn("are cut off there", self.succeeds(PREPROCESSOR, field, path, "--plan"))

    def test_what_a_forecast_advises_takes_its_warnings_away(self):
        field, path = self.film()
        text = path.read_text()

        def plan(*options):
            return json.loads(self.succeeds(PREPROCESSOR, field, path, "--plan", "--json", *options))

        def focused_at(distance):
            still = text.replace("focus_distance: 0.8", f"focus_distance: {distance!r}")
            return still[:still.index("keyframes:")]

        depths = ["--depths", "0.3", "4"]
        path.write_text(focused_at(3.9))
        warned = plan(*depths)
        self.assertEqual(len(warned["warnings"]), 1)
        self.assertRegex(warned["warnings"][0],
                         "a focus distance between .* and .* in every frame; a scene")
        advice = warned["advice"]
        for distance in advice["focus_distance"]:
            path.write_text(focused_at(distance))
            self.assertEqual(plan(*depths)["warnings"], [], distance)
        near, far = advice["focus_distance"]
        for distance in (0.9 * near, 1.1 * far):  # the range is as large as possible
            path.write_text(focused_at(distance))
            self.assertEqual(len(plan(*depths)["warnings"]), 1, distance)

        path.write_text(focused_at(3.9))
        near, far = advice["depths"]
        self.assertIsNone(far)
        self.assertEqual(plan("--depths", str(near), "1e6")["warnings"], [])
        self.assertEqual(len(plan("--depths", str(0.95 * near), "1e6")["warnings"]), 1)

        width, height = advice["resolution"]
        path.write_text(focused_at(3.9).replace("[80, 60]", f"[{width}, {height}]"))
        self.assertEqual(plan(*depths)["warnings"], [])

        # With depths from 0.1 to 4, every focus gives double edges.
        path.write_text(focused_at(0.3))
        hopeless = plan("--depths", "0.1", "4")
        self.assertIsNone(hopeless["advice"]["focus_distance"])
        self.assertNotIn("a focus distance", hopeless["warnings"][0])

        write_path(self.folder, aperture=0.2)
        wide = plan("--depths", "0.7", "4")
        self.assertIn("beyond the LF cameras", wide["warnings"][-1])
        self.assertIn("an aperture of at most", wide["warnings"][-1])
        write_path(self.folder, aperture=wide["advice"]["largest_aperture"])
        self.assertEqual(plan("--depths", "0.7", "4")["warnings"], [])

    def test_depths_are_those_that_lf_images_show(self):
        path = write_path(self.folder)
        path.write_text(path.read_text().replace("0.8", "0.09"))

        def plan(field):
            return json.loads(self.succeeds(PREPROCESSOR, field, path, "--plan", "--json"))
        shown = plan(write_field(self.folder / "wall", wall))
        self.assertEqual(shown["depths_from"], "LF images")
        near, far = shown["frames"][0]["depths"]
        self.assertTrue(0.85 * WALL_DEPTH < near < WALL_DEPTH < far < 1.15 * WALL_DEPTH, (near, far))
        nearest, farthest = shown["advice"]["focus_distance"]
        self.assertLess(nearest, WALL_DEPTH)
        self.assertTrue(farthest is None or farthest > WALL_DEPTH, farthest)
        told = plan(write_field(self.folder / "told", wall, lf_depth_range=[0.2, 3]))
        self.assertEqual((told["depths_from"], told["frames"][0]["depths"]), ("the calibration", [0.2, 3]))
        noise = plan(write_field(self.folder / "noise"))
        self.assertIsNone(noise["depths_from"])
        self.assertIsNone(noise["advice"]["focus_distance"])
        for words in ("--depths NEAR FAR", "lf_depth_range", "points3D", "no focus distance is advised"):
            self.assertIn(words, noise["warnings"][0])

    def test_parts_of_a_film_share_a_folder(self):
        field, path = self.film(frames=5)
        packages, out = self.folder / "packages", self.folder / "frames"
        for frames in ("1-2", "3-5"):
            self.succeeds(PREPROCESSOR, field, path, "-o", packages, "--frames", frames, "--packages", "1")
            self.fails(2, ["contains 1 packages", "--overwrite"], PREPROCESSOR, field, path, "-o", packages,
                       "--frames", frames)
        names = ["package-0000-of-frames-1-2", "package-0000-of-frames-3-5"]
        self.assertEqual(sorted(file.stem for file in packages.glob("*.lfp")), names)
        self.succeeds(PREPROCESSOR, field, path, "-o", packages, "--frames", "1-2", "--packages", "2",
                      "--overwrite")
        files = sorted(packages.glob("*.lfp"))
        self.assertEqual([file.stem for file in files], names[:1] + names[1:] + [
            "package-0001-of-frames-1-2"])
        for file in files:
            self.succeeds(RENDERER, file, "-o", out)
        for file in files:
            report = json.loads((out / f"report-{file.stem}.json").read_text())
            self.assertTrue(report["frames"])
        self.assertEqual(len(list(out.glob("frame_*.exr"))), 5)
        self.succeeds(PREPROCESSOR, field, path, "-o", packages, "--overwrite", "--packages", "1")
        self.assertEqual([file.stem for file in packages.glob("*.lfp")], ["package-0000"])

    def test_packages_can_be_asked_by_sql(self):
        """The tables follow the schema of doc/formats/package.md."""
        field, path = self.film()
        _, files = self.packages(field, path, "--packages", "2")
        with sqlite3.connect(f"file:{files[1]}?immutable=1", uri=True) as db:
            self.assertEqual(db.execute("pragma integrity_check").fetchone(), ("ok",))
            frames = db.execute("select frame, rays from frames where is_rendered").fetchall()
            self.assertEqual([frame for frame, _ in frames], [4, 5, 6])
            places = [place for place, in db.execute("select rank from lf_images")]
            self.assertEqual(sorted(places), list(range(SIDE * SIDE)))
            for x0, y0, x1, y1, count, rays in db.execute(
                    "select x_begin, y_begin, x_end, y_end, frames, rays from lf_images where frames > 0"):
                self.assertTrue(0 <= x0 < x1 <= WIDTH and 0 <= y0 < y1 <= HEIGHT)
                self.assertTrue(0 < rays <= count * (x1 - x0) * (y1 - y0))
            self.assertEqual(db.execute("select sum(rays) from lf_images").fetchone()[0],
                             sum(rays for _, rays in frames))
            # Every frame of the film has surroundings, also the frames of other packages.
            for distance, blob in db.execute("select camera_distance, surroundings from frames"):
                numbers = struct.unpack("<6d", blob[:-8])
                self.assertEqual(numbers[0], distance)
                self.assertTrue(all(number > 0 for number in (*numbers[:2], numbers[5])), numbers)


if __name__ == "__main__":
    PREPROCESSOR, RENDERER = map(pathlib.Path, sys.argv[1:3])
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
