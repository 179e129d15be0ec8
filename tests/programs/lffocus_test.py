#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lffocus stack from a user's view: its pictures have the bits of single renders, each LF image is read once, and
files and folders obey the rules of lfrenderer.

usage: lffocus_test.py LFFOCUS LFRENDERER LFSYNTH
"""
import json
import re
import signal
import subprocess
import sys
import unittest

import numpy as np

import small_field
from exr_file import channels_of, parts_of
from opened_files import OpenedFiles
from program_test_case import ProgramTestCase, wait_until

FOCUS = RENDERER = SYNTH = None
DISTANCES = (0.3, 0.5, 0.8, 2)


class FocusStackTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = small_field.write_field(self.folder / "field", small_field.wall)
        self.path = small_field.write_path(self.folder)

    def stack(self, out, *options, code=0, path=None):
        return self.succeeds(FOCUS, "stack", self.field, path or self.path, "-o", self.folder / out, *options,
                             code=code)

    def stack_of_distances(self, out, *options, **keys):
        return self.stack(out, "--distances", ",".join(map(str, DISTANCES)), *options, **keys)

    def refused(self, words, out, *options, code=2):
        self.fails(code, words, FOCUS, "stack", self.field, self.path, "-o", self.folder / out, *options)

    def write_path_at(self, distance, **replaced):
        """Writes a path of one frame that is focused at a distance, with these texts replaced."""
        text = self.path.read_text().split("keyframes:")[0]
        text = re.sub("focus_distance: .*", f"focus_distance: {distance}", text)
        for old, new in replaced.values():
            self.assertIn(old, text)
            text = text.replace(old, new)
        path = self.folder / f"at-{distance}.yaml"
        path.write_text(text.replace("frames: 3", "frames: 1"))
        return path

    def assert_same_channels(self, found, expected):
        self.assertEqual(list(found), list(expected))
        for name, channel in expected.items():
            self.assertEqual(channel.tobytes(), found[name].tobytes(), name)

    def check_bits(self, *options, frame=2, **replaced):
        """Compares each picture of a stack with a single render of lfrenderer."""
        stack_path = self.write_path_at(0.7, **replaced) if replaced else self.path
        frame = 1 if replaced else frame
        self.stack_of_distances("stack", "--frame", frame, "--format", "exr-float", "--overwrite", *options,
                                path=stack_path)
        pictures = []
        for number, distance in enumerate(DISTANCES, 1):
            single = self.folder / "single"
            self.succeeds(RENDERER, self.field, self.write_path_at(distance, **replaced), "-o", single,
                          "--format", "exr-float", "--overwrite", *options)
            found = channels_of(self.folder / f"stack/frame_{number:04}.exr")
            self.assert_same_channels(found, channels_of(single / "frame_0001.exr"))
            pictures.append(found["G"])
        self.assertFalse(np.array_equal(pictures[0], pictures[1]))

    # Pictures

    def test_pictures_have_the_bits_of_single_renders(self):
        self.check_bits()

    def test_so_they_have_with_other_options(self):
        for options in (["--estimator", "nearest", "--lens-weights", "none"], ["--lens-weights", "hat"],
                        ["--filter", "bicubic", "--max-images", "7", "--seed", "3"],
                        ["--stop-when", "noise<=0.05"], ["--z", "--frame-alpha", "--fill", "off"],
                        ["--max-angle", "1", "--order", "area"], ["--back-end", "reference", "--threads", "1"]):
            with self.subTest(options=options):
                self.check_bits(*options)

    def test_the_tilt_of_the_focus_plane_is_kept(self):
        self.check_bits(tilt=("lens:", "lens:\n  focus_tilt_deg: {horizontal: 20, vertical: -10}"))

    def test_a_lens_that_breathes_does_so(self):
        breathing = ("lens:", "lens:\n  breathing: true")
        shift = ("camera:", "camera:\n  shift: {horizontal: 0.002, vertical: 0.001}")
        self.check_bits(breathing=breathing, shift=shift)
        self.fails(3, ["focus distance 0.03", "focal length"], FOCUS, "stack", self.field,
                   self.write_path_at(0.7, breathing=breathing), "-o", self.folder / "near", "--distances", "0.03")

    def test_modes_with_rebinned_rays_have_the_bits_of_the_same_film(self):
        steps = ", ".join(f"{{time: {i / 25}, value: {distance}, interpolation: step}}"
                          for i, distance in enumerate(DISTANCES))
        film = self.folder / "film.yaml"
        film.write_text(re.sub("focus_distance: \\[.*", f"focus_distance: [{steps}]",
                               self.path.read_text().replace("frames: 3", f"frames: {len(DISTANCES)}")))
        for mode in ("rebin", "hybrid"):
            self.stack_of_distances(mode, "--mode", mode)
            self.succeeds(RENDERER, self.field, film, "-o", self.folder / f"film-{mode}", "--mode", mode)
            for number in range(1, len(DISTANCES) + 1):
                name = f"frame_{number:04}.exr"
                self.assert_same_channels(channels_of(self.folder / mode / name),
                                          channels_of(self.folder / f"film-{mode}" / name))

    def test_lf_images_are_opened_as_often_as_for_one_frame(self):
        with OpenedFiles(self.field.parent) as opened:
            self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / "single", "--frames", 1)
            of_a_frame = opened.counts()
            report = json.loads(self.stack("stack", "--planes", 12, "--near", 0.3, "--far", 2, "--json"))
            of_the_stack = opened.counts()
        self.assertEqual(sum(name.endswith(".png") for name in of_a_frame), 25)
        self.assertEqual(of_the_stack, of_a_frame)
        self.assertEqual((len(report["frames"]), report["passes"], report["lf_images_selected"]), (12, 1, 25))

    def test_a_densified_light_field_is_rendered(self):
        """Virtual LF images are made in the folder of the frames, which is removed when a file is complete."""
        self.field = self.folder / "still-life"
        self.succeeds(SYNTH, "still-life", "-o", self.field, "--count", 16, "--size", "160x120", "--spacing", 0.02,
                      "-q")
        poses = [np.array(frame["transform_matrix"])
                 for frame in json.loads((self.field / "transforms.json").read_text())["frames"]]
        centre, axes = np.mean([pose[:3, 3] for pose in poses], axis=0), poses[0][:3, :3]
        text = self.path.read_text().replace("[0, 1, 0]", str(axes[:, 1].tolist())).replace("0.045", "0.05")
        for old, new in (("[0, 0, 0]", centre), ("[0, 0, -1]", centre - axes[:, 2])):
            text = text.replace(old, str(new.tolist()))
        self.path.write_text(text)
        options = ["--distances", "0.8,1.2", "--densify", "--filter", "bilinear"]
        self.stack("stack", *options)
        self.stack("stack.exr", *options)
        self.assertTrue((self.folder / "stack/densified.lfs").exists())
        self.assertFalse((self.folder / "stack.exr.partial").exists())
        self.refused(["stack.exr: exists"], "stack.exr", *options)
        self.assertFalse((self.folder / "stack.exr.partial").exists())
        dense = self.folder / "stack/densified.lfs"
        self.succeeds(FOCUS, "stack", dense, self.path, "-o", self.folder / "again", *options[:2], "--filter",
                      "bilinear")
        for number, (_, channels) in enumerate(parts_of(self.folder / "stack.exr"), 1):
            name = f"frame_{number:04}.exr"
            self.assertIn("densified", channels)
            self.assert_same_channels(channels, channels_of(self.folder / "stack" / name))
            self.assert_same_channels(channels, channels_of(self.folder / "again" / name))

    # Planes

    def planes(self, out):
        listed = json.loads((self.folder / out / "planes.json").read_text())
        return [plane["focus_distance_w"] for plane in listed["planes"]]

    def test_planes_are_even_in_inverse_distance(self):
        self.stack("stack", "--planes", 5, "--near", 0.25, "--far", "2000mm", "--json")
        found = self.planes("stack")
        np.testing.assert_allclose(1 / np.array(found), np.linspace(4, 0.5, 5), rtol=1e-15)
        self.assertEqual((found[0], found[-1]), (0.25, 2))
        self.stack("single", "--planes", 1, "--near", 0.25, "--far", 2)
        self.assertEqual(self.planes("single"), [2 / (4 + 0.5)])

    def test_distances_come_from_a_file_in_its_order(self):
        listing = self.folder / "distances.txt"
        listing.write_text("# the nose\n0.5, 300mm\n\n2\t0.8  # the wall\n")
        self.stack("stack", "--distances", listing)
        self.assertEqual(self.planes("stack"), [0.5, 0.3, 2, 0.8])

    def test_the_range_is_that_of_the_light_field(self):
        small_field.write_field(self.field.parent, small_field.wall, lf_depth_range=[0.4, 3])
        self.stack("stack", "--planes", 3)
        self.assertEqual([self.planes("stack")[0], self.planes("stack")[-1]], [0.4, 3])
        self.stack("farther", "--planes", 3, "--far", 5)
        self.assertEqual([self.planes("farther")[0], self.planes("farther")[-1]], [0.4, 5])

    def test_the_range_is_found_in_the_lf_images(self):
        self.stack("stack", "--planes", 3)
        near, _, far = self.planes("stack")
        self.assertTrue(0.15 < near < small_field.WALL_DEPTH < far < 0.4, (near, far))

    def test_a_range_that_cannot_be_found_is_an_error(self):
        small_field.write_field(self.field.parent)  # noise
        self.refused(["depths of the scene", "--near and --far"], "stack", code=3)

    # Outputs

    def test_a_file_has_a_part_for_each_plane(self):
        out = self.folder / "stack.exr"
        self.stack_of_distances("stack.exr")
        self.stack_of_distances("stack")
        self.assertFalse((self.folder / "stack.exr.partial").exists())
        parts = parts_of(out)
        self.assertEqual([attributes["name"] for attributes, _ in parts],
                         [f"focus_{i:04}" for i in range(1, len(DISTANCES) + 1)])
        for number, (attributes, channels) in enumerate(parts, 1):
            self.assertEqual(attributes["lf:focus_distance_w"], DISTANCES[number - 1])
            self.assertEqual(attributes["focus"], np.float32(DISTANCES[number - 1]))
            self.assert_same_channels(channels, channels_of(self.folder / f"stack/frame_{number:04}.exr"))

    def test_a_video_shows_the_planes_back_and_forth(self):
        self.stack("rack.mp4", "--planes", 6, "--near", 0.3, "--far", 2, "--fps", 10)
        self.stack("both.mp4", "--planes", 6, "--near", 0.3, "--far", 2, "--back-and-forth")
        for name, rate, count in (("rack.mp4", "10/1", 6), ("both.mp4", "25/1", 10)):
            shown = self.succeeds("ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                  "stream=nb_read_frames,r_frame_rate", "-of", "csv=p=0", self.folder / name)
            self.assertEqual(shown.strip(), f"{rate},{count}")
        self.assertEqual(list(self.folder.glob("*.partial")), [])

    def test_the_report_lists_the_planes(self):
        report = json.loads(self.stack_of_distances("stack.exr", "--json"))
        self.assertEqual(report["passes"], 1)
        self.assertEqual([(plane["part"], plane["focus_distance_mm"]) for plane in report["focus_stack"]["planes"]],
                         [(f"focus_{i:04}", 1000 * distance) for i, distance in enumerate(DISTANCES, 1)])

    def test_a_file_is_replaced_only_on_demand(self):
        out = self.folder / "stack.exr"
        out.write_text("mine")
        self.refused(["stack.exr: exists", "--overwrite"], "stack.exr", "--distances", "1")
        self.refused(["stack.exr: exists", "--overwrite"], "stack.exr", "--distances", "1", "--resume")
        self.assertEqual(out.read_text(), "mine")
        self.stack_of_distances("stack.exr", "--overwrite")
        self.assertEqual(len(parts_of(out)), len(DISTANCES))

    def test_a_folder_of_something_else_is_kept(self):
        mine = self.folder / "stack.exr.partial" / "mine.txt"
        mine.parent.mkdir()
        mine.write_text("mine")
        self.refused(["stack.exr.partial", "something else"], "stack.exr", "--distances", "1", "--overwrite")
        self.assertEqual(mine.read_text(), "mine")

    def test_an_interrupted_file_is_resumed_to_the_same_bytes(self):
        options = ["--planes", "400", "--near", "0.3", "--far", "2", "--threads", "1"]
        self.stack("whole.exr", *options)
        out = self.folder / "stack.exr"
        begun = subprocess.Popen([FOCUS, "stack", self.field, self.path, "-o", out, *options], stderr=subprocess.PIPE,
                                 text=True)
        wait_until((self.folder / "stack.exr.partial/partial/run.json").exists, begun)
        begun.send_signal(signal.SIGTERM)
        words = begun.communicate()[1]
        self.assertEqual(begun.returncode, 5, words)
        self.assertIn(f"stack {self.field} {self.path} -o {out}", words.splitlines()[-1])
        self.assertTrue(words.splitlines()[-1].endswith(" --resume"))
        self.assertFalse(out.exists())
        self.refused(["unfinished render", "--resume"], "stack.exr", *options)
        self.refused(["focus_distance_w", "--resume"], "stack.exr", *options[:-3], "3", "--resume")
        self.stack("stack.exr", *options, "--resume")
        self.assertEqual(out.read_bytes(), (self.folder / "whole.exr").read_bytes())
        self.assertFalse((self.folder / "stack.exr.partial").exists())

    def test_a_finished_file_is_kept_by_resume(self):
        for name in ("stack.exr", "rack.mp4"):
            self.stack_of_distances(name)
            before = (self.folder / name).read_bytes()
            result = self.call(FOCUS, "stack", self.field, self.path, "-o", self.folder / name, "--distances",
                               ",".join(map(str, DISTANCES)), "--resume", "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f"{name}: is complete already", result.stderr)
            self.assertEqual(len(json.loads(result.stdout)["focus_stack"]["planes"]), len(DISTANCES))
            self.assertEqual((self.folder / name).read_bytes(), before)
        for words, distances in ((f"has {len(DISTANCES)} planes", "1"),
                                 ("its plane 1 is at", ",".join(str(2 * one) for one in DISTANCES))):
            self.refused(["stack.exr", words, "--overwrite"], "stack.exr", "--distances", distances, "--resume")
        planes = ["--distances", ",".join(map(str, DISTANCES)), "--resume"]
        for words, options in (("made with estimator ", ["--estimator", "nearest"]),
                               ("lens_weights", ["--lens-weights", "none"]),
                               ("picture.format exr, and this call has exr-float", ["--format", "exr-float"]),
                               ("seed", ["--seed", "7"]), ("max_images", ["--max-images", "9"]),
                               ("max_angle", ["--max-angle", "20"]), ("fill", ["--fill", "off"]),
                               ("mode", ["--mode", "hybrid"])):
            with self.subTest(options=options):
                self.refused(["stack.exr: exists already", words, "--overwrite"], "stack.exr", *planes, *options)
        self.path.write_text(self.path.read_text().replace("field_of_view_deg: 50", "field_of_view_deg: 40"))
        self.refused(["stack.exr", "was made with cameras"], "stack.exr", *planes)

    # Errors

    def test_wrong_calls_are_refused(self):
        for words, out, options in (
                (["--frame 4", "has 3 frames", "1 to 3"], "stack", ["--frame", "4"]),
                (["--near 0", "expected a distance"], "stack", ["--near", "0"]),
                (["--far 3cm", "expected a distance"], "stack", ["--far", "3cm"]),
                (["--distances", "0.4x", "400mm"], "stack", ["--distances", "0.3,0.4x"]),
                (["expected --near below --far"], "stack", ["--near", "2", "--far", "1"]),
                (["--back-and-forth", "no video"], "stack", ["--back-and-forth", "--distances", "1"]),
                (["--fps", "no video"], "stack.exr", ["--fps", "10", "--distances", "1"]),
                (["--fps", "--video"], "stack", ["--fps", "10", "--distances", "1"]),
                (["--format png", "exr-float"], "stack.exr", ["--format", "png", "--distances", "1"]),
                (["--format", "leave the option out"], "rack.mp4", ["--format", "png", "--distances", "1"]),
                (["--keep-plates", "give a folder"], "stack.exr", ["--keep-plates", "--distances", "1"]),
                (["--no-contact-sheet"], "stack.exr", ["--no-contact-sheet", "--distances", "1"]),
                (["--video", "give a folder"], "stack.exr", ["--video", "film.mp4", "--distances", "1"]),
                (["--planes N", "from 1 to 10000", "'10001'"], "stack", ["--planes", "10001"]),
                (["--fps RATE", "from 0.001 to 1000", "'0'"], "stack", ["--fps", "0"]),
                (["vx.png", "no .png file", "folder", "stack.exr or rack.mp4"], "vx.png", ["--distances", "1"]),
                (["--planes excludes --distances"], "stack", ["--distances", "1", "--planes", "3"])):
            with self.subTest(options=options):
                self.refused(words, out, *options)
                self.assertFalse((self.folder / out).exists())
        listing = self.folder / "distances.txt"
        listing.write_text("0.4\nnear\n")
        self.refused(["distances.txt:2:", "near", "expected a distance"], "stack", "--distances", listing)

    def test_inputs_are_not_replaced(self):
        path = self.folder / "path.exr"
        path.write_bytes(self.path.read_bytes())
        self.fails(2, ["path.exr", "would be replaced"], FOCUS, "stack", self.field, path, "-o", path, "--overwrite",
                   "--distances", "1")

    def test_missing_lf_images_are_told(self):
        (self.field.parent / "image_07.png").unlink()
        self.refused(["1 of 25 LF images were left out"], "stack", "--distances", "1", code=6)
        self.stack("accepted", "--distances", "1", "--allow-missing", "1")
        self.refused(["image_07.png"], "strict", "--distances", "1", "--strict", code=3)


if __name__ == "__main__":
    FOCUS, RENDERER, SYNTH = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1], verbosity=2)
