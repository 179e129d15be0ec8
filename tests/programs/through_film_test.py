#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests films of lffocus through: the files, names, reports and interruptions of a render, from every kind of input.

usage: through_film_test.py LFFOCUS LFRENDERER LFSYNTH LFCOMPRESSOR LFPREPROCESSOR
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from exr_file import channels_of
from program_test_case import ProgramTestCase, wait_until

FOCUS = RENDERER = SYNTH = COMPRESSOR = PREPROCESSOR = None
PATH = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [{size}]
{more}
camera: {{field_of_view_deg: 53.13, position: [0, 0, -1], look_at: [0, 0, 0]}}
lens: {{aperture_diameter: 0.2, focus_distance: 1{lens}}}
keyframes: {{position: [{{time: 0, value: [{start}, 0, -1]}}, {{time: 0.08, value: [0.03, 0.01, -1]}}]}}
"""
ONE_FRAME = "160M"  # suffices for the values of one frame of 600 x 400 elements, and not for two
CLOCK = "shutter: {angle_deg: 180, samples: 4}"


def write_pfm(file, values):
    height, width = values.shape
    file.write_bytes(f"Pf\n{width} {height}\n-1\n".encode() + values[::-1].astype("<f4").tobytes())


class ThroughFilmTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.field = pathlib.Path(temporary.name) / "foliage"
        subprocess.run([SYNTH, "foliage", "-o", cls.field, "--size", "120x80", "--count", "49", "--spacing", "0.032",
                        "--samples", "1", "--format", "png16", "-q"], check=True)

    def path(self, frames=3, size="120, 80", more="", lens="", start=-0.03):
        file = self.folder / f"path{len(list(self.folder.glob('path*')))}.yaml"
        file.write_text(PATH.format(frames=frames, size=size, more=more, lens=lens, start=start))
        return file

    def film(self, name, path, *options, field=None, code=0):
        out = self.folder / name
        said = self.succeeds(FOCUS, "through", field or self.field, path, "-o", out, *options, code=code)
        return out, said

    def single(self, path, frame, *options, field=None):
        out = self.folder / "single.exr"
        self.succeeds(FOCUS, "through", field or self.field, path, "-o", out, "--frame", frame, "--overwrite",
                      *options)
        return out.read_bytes()

    def frames_of(self, folder):
        return {file.name: file.read_bytes() for file in sorted(folder.glob("frame_*"))}

    def field_of(self, name, change):
        """Makes a light field of the LF images and other keys that `change` sets in the calibration."""
        folder = self.folder / name
        folder.mkdir()
        (folder / "images").symlink_to(self.field / "images")
        calibration = json.loads((self.field / "transforms.json").read_text())
        change(calibration)
        (folder / "transforms.json").write_text(json.dumps(calibration))
        return folder

    def test_frames_are_those_of_single_calls(self):
        path = self.path()
        out, said = self.film("film", path, "--statistic", "trimmed", "--trim", 0.3, "--json")
        frames = self.frames_of(out)
        self.assertEqual(list(frames), [f"frame_000{n}.exr" for n in (1, 2, 3)])
        self.assertEqual(len(set(frames.values())), 3)
        for n in (1, 2, 3):
            self.assertEqual(frames[f"frame_000{n}.exr"],
                             self.single(path, n, "--statistic", "trimmed", "--trim", 0.3))
        self.assertTrue((out / "contact_sheet.png").exists())
        self.assertFalse((out / "partial").exists())
        report, said = json.loads((out / "report.json").read_text()), json.loads(said)
        self.assertEqual(said.pop("through"), {"statistic": "trimmed", "order": "channels", "trim": 0.3})
        self.assertEqual(said, report)
        self.assertEqual([frame["frame"] for frame in report["frames"]], [1, 2, 3])
        self.assertEqual(report["inputs"]["statistic"], "trimmed")
        self.assertGreater(report["frames"][0]["lf_images"], 20)
        for frame, values in zip(report["frames"], (channels_of(out / name)["count_green"] for name in frames)):
            self.assertEqual(frame["rays_per_element_median"][1], np.sort(values.ravel())[values.size // 2])

    def test_frames_and_formats_are_chosen_as_for_a_render(self):
        path = self.path(frames=5)
        out, _ = self.film("film", path, "--frames", "2,4-5", "--format", "png", "--no-contact-sheet", "--clamp-frames")
        self.assertEqual(list(self.frames_of(out)), [f"frame_000{n}.png" for n in (2, 4, 5)])
        self.assertFalse((out / "contact_sheet.png").exists())
        self.fails(2, ["--frames", "9"], FOCUS, "through", self.field, path, "-o", out, "--frames", "9")
        none, said = self.film("none", path, "--frames", "9", "--clamp-frames", "--json")
        self.assertFalse(none.exists())
        self.assertEqual(json.loads(said)["frames"], [])
        rich, _ = self.film("rich", path, "--frames", 1, "--frame-alpha", "--z", "--colour-space", "acescg")
        channels = channels_of(rich / "frame_0001.exr")
        self.assertTrue({"A", "Z"} <= set(channels))
        np.testing.assert_allclose(channels["Z"], 1, rtol=1e-5)
        self.fails(2, ["--z", "png"], FOCUS, "through", self.field, path, "-o", self.folder / "p", "--z", "--format",
                   "png")

    def test_a_video_shows_the_frames(self):
        path = self.path()
        video = self.folder / "seen.mp4"
        result = self.call(FOCUS, "through", self.field, path, "-o", self.folder / "film", "--video", video)
        if "ffmpeg" in result.stderr and result.returncode == 4:
            self.skipTest("no ffmpeg")
        self.assertEqual(result.returncode, 0, result.stderr)
        capture = cv2.VideoCapture(str(video))
        self.assertEqual(int(capture.get(cv2.CAP_PROP_FRAME_COUNT)), 3)

    def test_frames_that_fit_together_read_each_lf_image_once(self):
        path = self.path(frames=4, size="600, 400")
        passes, films = [], []
        for memory in ("8G", "300M", ONE_FRAME, "80M"):
            out = self.folder / memory
            result = self.call(FOCUS, "through", self.field, path, "-o", out, "--memory", memory, "--threads", 2,
                               "--no-contact-sheet", "--progress", "json")
            self.assertEqual(result.returncode, 0, result.stderr)
            report = json.loads((out / "report.json").read_text())
            passes.append(report["passes"])
            films.append(self.frames_of(out))
            last = json.loads([line for line in result.stderr.splitlines() if line.startswith("{")][-1])
            to_read = last["counts"]["LF image"][1]
            if memory == "8G":  # fewer than the sum of all frames
                self.assertEqual(to_read, report["lf_images_selected"])
                self.assertGreater(sum(frame["lf_images"] for frame in report["frames"]), 2 * to_read)
        self.assertEqual((passes[0], passes[2]), (1, 4), passes)
        self.assertTrue(1 < passes[1] < 4 < passes[3], passes)
        for film in films:
            self.assertEqual(film, films[0])

    def test_packages_give_the_frames_of_the_film(self):
        path = self.path(frames=4)
        packages = self.folder / "packages"
        self.succeeds(PREPROCESSOR, self.field, path, "-o", packages, "--packages", 2)
        files = sorted(packages.glob("*.lfp"))
        self.assertEqual(len(files), 2)
        whole, _ = self.film("whole", path)
        for name, calls in (("alone", [[file] for file in files]), ("together", [files])):
            out = self.folder / name
            for call in calls:
                self.succeeds(FOCUS, "through", self.field, *call, "-o", out)
            self.assertEqual(self.frames_of(out), self.frames_of(whole))
            self.assertEqual({file.stem for file in out.glob("report*")}, {f"report-{file.stem}" for file in files})
        self.assertTrue((self.folder / "alone" / f"contact_sheet-{files[1].stem}.png").exists())
        self.assertTrue((self.folder / "together/contact_sheet.png").exists())
        some = self.folder / "some"
        self.succeeds(FOCUS, "through", self.field, *files, "-o", some, "--frames", "2-3")
        self.assertEqual(list(self.frames_of(some)), ["frame_0002.exr", "frame_0003.exr"])
        for words, arguments in ((["folder", "a.exr"], [files[0], "-o", self.folder / "a.exr"]),
                                 (["--max-angle"], [*files, "-o", "out", "--max-angle", 9]),
                                 (["one PATH", "packages"], [files[0], path, "-o", "out"]),
                                 (["--image-alpha"], [*files, "-o", "out", "--image-alpha", "mask"])):
            self.fails(2, words, FOCUS, "through", self.field, *arguments)
        # Frames of another statistic would look like frames of this film.
        self.fails(2, ["statistic"], FOCUS, "through", self.field, files[0], "-o", some, "--statistic", "min",
                   "--filter", "prefiltered")

    def test_a_statistic_of_fewer_lf_images(self):
        path = self.path(frames=2)
        few, _ = self.film("few", path, "--max-images", 9, "--statistic", "mean", "--format", "exr-float")
        report = json.loads((few / "report.json").read_text())
        self.assertEqual(report["inputs"]["max_images"], "9")
        rendered = self.folder / "rendered"
        self.succeeds(RENDERER, self.field, path, "-o", rendered, "--lens-weights", "none", "--format", "exr-float",
                      "--max-images", 9, "--filter", "prefiltered")
        theirs = json.loads((rendered / "report.json").read_text())
        for ours, theirs in zip(report["frames"], theirs["frames"]):
            self.assertLessEqual(ours["lf_images"], 9)
            self.assertEqual(ours["lf_images"], theirs["lf_images"])
        for name in self.frames_of(few):
            ours, theirs = channels_of(few / name), channels_of(rendered / name)
            for channel in ("R", "G", "B", "count_red"):
                np.testing.assert_array_equal(ours[channel], theirs[channel])
        self.assertEqual(self.frames_of(few)["frame_0002.exr"],
                         self.single(path, 2, "--max-images", 9, "--statistic", "mean", "--format", "exr-float"))
        self.fails(2, ["max_images"], FOCUS, "through", self.field, path, "-o", few, "--resume", "--statistic", "mean",
                   "--format", "exr-float")

    def begin(self, out, path, *options):
        """Begins a film whose frames are made one after another, because the values of two do not fit together."""
        return subprocess.Popen(list(map(str, [FOCUS, "through", self.field, path, "-o", out, "--progress", "none",
                                               "--memory", ONE_FRAME, "--no-contact-sheet", *options])),
                                stderr=subprocess.PIPE, text=True)

    def test_interrupted_and_killed_it_resumes_to_the_same_bits(self):
        path = self.path(frames=4, size="600, 400")
        whole, _ = self.film("whole", path, "--no-contact-sheet")
        for sign in (signal.SIGTERM, signal.SIGKILL):
            with self.subTest(sign):
                out = self.folder / sign.name
                process = self.begin(out, path)
                wait_until((out / "partial/frame_0001.json").exists, process)  # frame 1 is finished, 2 is begun
                process.send_signal(sign)
                _, said = process.communicate()
                self.assertEqual(process.returncode, 5 if sign == signal.SIGTERM else -sign, said)
                if sign == signal.SIGTERM:
                    self.assertIn("--resume", said)
                    self.assertIn("of 4 frames", said)
                first = (out / "frame_0001.exr").stat()
                self.fails(2, ["unfinished render", "--resume"], FOCUS, "through", self.field, path, "-o", out)
                self.fails(2, ["statistic", "min"], FOCUS, "through", self.field, path, "-o", out, "--resume",
                           "--statistic", "min", "--filter", "prefiltered")
                self.succeeds(FOCUS, "through", self.field, path, "-o", out, "--resume", "--threads", 1,
                              "--memory", "128M", "--no-contact-sheet")
                self.assertEqual(self.frames_of(out), self.frames_of(whole))
                now = (out / "frame_0001.exr").stat()
                self.assertEqual((now.st_ino, now.st_mtime_ns), (first.st_ino, first.st_mtime_ns))
                self.assertFalse((out / "partial").exists())
                self.assertEqual(len(json.loads((out / "report.json").read_text())["frames"]), 4)
        # A complete film is neither rendered again nor confused with another one.
        self.succeeds(FOCUS, "through", self.field, path, "-o", whole, "--resume")
        self.assertTrue((whole / "contact_sheet.png").exists())
        self.fails(2, ["statistic"], FOCUS, "through", self.field, path, "-o", whole, "--resume", "--statistic",
                   "mean")

    def test_overwrite_begins_anew(self):
        path = self.path(frames=3, size="600, 400")
        out = self.folder / "film"
        process = self.begin(out, path, "--statistic", "mean")
        wait_until((out / "partial/frame_0001.json").exists, process)
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.film("film", path, "--overwrite", "--no-contact-sheet")
        median, _ = self.film("median", path, "--no-contact-sheet")
        self.assertEqual(self.frames_of(out), self.frames_of(median))

    def test_a_focal_surface_is_seen_through(self):
        y, x = np.mgrid[0:80, 0:120]
        for n in (1, 2, 3):
            write_pfm(self.folder / f"z{n}.pfm", 0.9 + 0.15 * np.sin(x / 17 + n) * np.cos(y / 13))
        path = self.path(more="focus: {surface: z%d.pfm, kind: depth}")
        mean, _ = self.film("mean", path, "--statistic", "mean", "--format", "exr-float")
        rendered = self.folder / "rendered"
        self.succeeds(RENDERER, self.field, path, "-o", rendered, "--lens-weights", "none", "--format", "exr-float")
        for n in (1, 2, 3):
            ours, theirs = (channels_of(folder / f"frame_000{n}.exr") for folder in (mean, rendered))
            for channel in ("R", "G", "B", "count_red"):
                np.testing.assert_array_equal(ours[channel], theirs[channel])
        many, _ = self.film("many", path)
        few, _ = self.film("few", path, "--threads", 1, "--memory", "64M")
        self.assertEqual(self.frames_of(many), self.frames_of(few))
        self.assertEqual(self.frames_of(many)["frame_0002.exr"], self.single(path, 2))
        flat, _ = self.film("flat", self.path())
        self.assertNotEqual(self.frames_of(flat)["frame_0002.exr"], self.frames_of(many)["frame_0002.exr"])
        # Pictures of frames that are not made need not exist, unless a film is resumed.
        (self.folder / "z3.pfm").unlink()
        self.film("begin", path, "--frames", "1-2")
        self.fails(3, ["z3.pfm"], FOCUS, "through", self.field, path, "-o", self.folder / "end", "--frames", "3")

    def test_every_kind_of_lf_image(self):
        path = self.path(frames=2)
        kinds = {"raw": ["--bayer"], "clear": ["--alpha", "straight", "--format", "png"],
                 "wide": ["--distortion", "0.1,-0.1", "--format", "png"], "plain": ["--format", "png"]}
        for name, options in kinds.items():
            with self.subTest(name):
                field, store = self.folder / name, self.folder / f"{name}.lfs"
                self.succeeds(SYNTH, "foliage", "-o", field, "--size", "60x40", "--count", 9, "--spacing", 0.05,
                              "--samples", 1, *options, "-q")
                self.succeeds(COMPRESSOR, field, "-o", store, "--profile", "lossless", "-q")
                more = ["--background", "none"] if name == "clear" else []
                of_files, _ = self.film(f"{name}-files", path, *more, field=field)
                of_store, _ = self.film(f"{name}-store", path, *more, field=store)
                self.assertEqual(self.frames_of(of_files), self.frames_of(of_store))
                self.assertEqual("A" in channels_of(of_files / "frame_0001.exr"), name == "clear")

    def test_masks_gains_hoods_and_brackets_are_those_of_the_renderer(self):
        def brackets(calibration):
            # Each pose has a second exposure, one stop darker in the file, which its gain makes up for.
            for frame in list(calibration["frames"]):
                name = pathlib.Path(frame["file_path"]).name
                pixels = cv2.imread(str(self.field / "images" / name), cv2.IMREAD_UNCHANGED)
                cv2.imwrite(str(self.folder / f"dark_{name}"), pixels // 2)
                calibration["frames"].append(dict(frame, file_path=f"../dark_{name}", lf_gain=2))
            calibration["lf_transfer"] = "linear"

        def masks(calibration):
            mask = np.full((80, 120), 255, np.uint8)
            mask[:, :60] = 0
            cv2.imwrite(str(self.folder / "mask.png"), mask)
            for i in range(10, 30):
                calibration["frames"][i]["lf_mask"] = "../mask.png"
            calibration["frames"][24]["lf_gain"] = 1.5
        for name, change, lens in (("brackets", brackets, ""), ("masks", masks, ""),
                                   ("hood", lambda _: None, ", hood_distance: 0.2, hood_diameter: 0.25"),
                                   ("blades", lambda _: None, ", blades: 5, ratio: 1.5")):
            with self.subTest(name):
                field, path = self.field_of(name, change), self.path(frames=1, lens=lens)
                for statistic in ("mean", "median"):
                    self.film(f"{name}-{statistic}", path, "--statistic", statistic, "--format", "exr-float",
                              field=field)
                rendered = self.folder / f"{name}-rendered"
                self.succeeds(RENDERER, field, path, "-o", rendered, "--lens-weights", "none", "--format", "exr-float")
                mean, median, theirs = (channels_of(self.folder / f"{name}-{kind}/frame_0001.exr")
                                        for kind in ("mean", "median", "rendered"))
                for channel in ("R", "G", "B", "count_red"):
                    np.testing.assert_array_equal(mean[channel], theirs[channel])
                np.testing.assert_array_equal(median["count_red"], mean["count_red"])
                self.assertFalse(np.array_equal(median["G"], mean["G"]))
                plain = channels_of(self.film(f"{name}-plain", self.path(frames=1), "--statistic", "mean")[0] /
                                    "frame_0001.exr")
                self.assertFalse(np.array_equal(plain["count_red"], mean["count_red"]))

    def test_grey_values_of_sixteen_bits_are_kept(self):
        # A thermal camera writes TIFF files of one channel and 16 bits, whose values are linear. All LF images show
        # one temperature in front of a plane, so that each statistic must return this value.
        field = self.folder / "thermal"
        field.mkdir()
        calibration = json.loads((self.field / "transforms.json").read_text())
        calibration.update(lf_transfer="linear")
        values = np.full((80, 120), 29315, np.uint16)  # 20.0 degrees Celsius in hundredths of a kelvin
        values[:, 60:] = 31000
        for i, frame in enumerate(calibration["frames"]):
            cv2.imwrite(str(field / f"{i}.tif"), values if i % 5 else values + 100)
            frame["file_path"] = f"{i}.tif"
        (field / "transforms.json").write_text(json.dumps(calibration))
        path = self.path(frames=1)
        for statistic in ("median", "min", "trimmed"):
            out, _ = self.film(statistic, path, "--statistic", statistic, "--format", "exr-float", field=field)
            channels = channels_of(out / "frame_0001.exr")
            left = channels["G"][:, :20] * 65535
            np.testing.assert_allclose(left, 29315, atol=1.5)
            for other in "RB":
                np.testing.assert_array_equal(channels[other], channels["G"])
        store = self.folder / "thermal.lfs"
        self.succeeds(COMPRESSOR, field, "-o", store, "--profile", "lossless", "-q")
        of_store, _ = self.film("store", path, "--format", "exr-float", field=store)
        self.assertEqual(self.frames_of(of_store), self.frames_of(self.folder / "median"))

    def test_broken_and_missing_lf_images_are_left_out_and_told_once(self):
        def breaks(calibration):
            calibration["frames"][24]["file_path"] = "../broken.png"
            calibration["frames"][25]["file_path"] = "../missing.png"
        (self.folder / "broken.png").write_bytes(next((self.field / "images").iterdir()).read_bytes()[:2000])
        field, path = self.field_of("broken", breaks), self.path(frames=2)
        arguments = [FOCUS, "through", field, path, "-o", self.folder / "film"]
        self.fails(6, ["2 of", "left out", "--allow-missing"], *arguments)
        report = json.loads((self.folder / "film/report.json").read_text())
        self.assertEqual(report["lf_images_skipped"], 2)
        self.film("accepted", path, "--allow-missing", 2, field=field)
        self.fails(3, ["broken.png"], FOCUS, "through", field, path, "-o", self.folder / "strict", "--strict")

        def removes(calibration):
            del calibration["frames"][24:26]
        without, _ = self.film("without", path, field=self.field_of("less", removes))
        for name in self.frames_of(without):
            ours, theirs = channels_of(self.folder / "film" / name), channels_of(without / name)
            for channel, values in theirs.items():
                np.testing.assert_array_equal(ours[channel], values)

    def test_frames_beside_the_capture_are_black_unless_all_are(self):
        path = self.path(start=-9)
        out, _ = self.film("film", path)
        self.assertEqual(channels_of(out / "frame_0001.exr")["count_red"].max(), 0)
        self.assertGreater(channels_of(out / "frame_0003.exr")["count_red"].max(), 5)
        self.fails(3, ["no LF image contributes"], FOCUS, "through", self.field, path, "-o", self.folder / "black",
                   "--frames", 1)
        self.assertEqual(list((self.folder / "black").glob("*")), [])

    def test_wrong_calls_are_refused_before_anything_is_written(self):
        path = self.path()
        lens = self.path(lens=', transmission: "00ff/ff00"')
        for words, code, arguments in (
                (["--frames", "a.exr", "folder"], 2, [path, "-o", "a.exr", "--frames", "1-2"]),
                (["--resume", "a.exr"], 2, [path, "-o", "a.exr", "--resume"]),
                (["--video", "a.exr"], 2, [path, "-o", "a.exr", "--video", "a.mp4"]),
                (["--frame ", "--frames"], 2, [path, "-o", "film", "--frame", 2]),
                (["film", "one folder"], 2, [path, "-o", "a.exr", "-o", "film"]),
                (["a.mp4"], 2, [path, "-o", "a.mp4"]),
                (["--trim"], 2, [path, "-o", "film", "--trim", 0.1]),
                (["transmission"], 2, [lens, "-o", "film"]),
                (["shutter"], 2, [self.path(more=CLOCK), "-o", "film"]),
                (["--memory", "at least"], 4, [path, "-o", "film", "--memory", "1M"])):
            with self.subTest(words):
                arguments = [self.folder / a if a in ("a.exr", "film", "a.mp4") else a for a in arguments]
                self.fails(code, words, FOCUS, "through", self.field, *arguments)
                self.assertEqual(list(self.folder.glob("film/frame*")) + list(self.folder.glob("a.*")), [])

    def test_lf_images_are_not_replaced(self):
        folder = self.folder / "own"
        folder.mkdir()
        calibration = json.loads((self.field / "transforms.json").read_text())
        for i, frame in enumerate(calibration["frames"]):
            (folder / f"frame_{i:04d}.png").write_bytes((self.field / frame["file_path"]).read_bytes())
            frame["file_path"] = f"frame_{i:04d}.png"
        (folder / "transforms.json").write_text(json.dumps(calibration))
        before = (folder / "frame_0001.png").read_bytes()
        self.fails(2, ["frame_0001.png", "LF image"], FOCUS, "through", folder, self.path(), "-o", folder,
                   "--format", "png", "--overwrite")
        self.assertEqual((folder / "frame_0001.png").read_bytes(), before)


if __name__ == "__main__":
    FOCUS, RENDERER, SYNTH, COMPRESSOR, PREPROCESSOR = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1] + sys.argv[6:])
