#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests light field videos: every form, the question for a time, single times, films through time, and errors.

usage: light_field_video_test.py LFIMPORT LFEXAMPLE LFRENDERER LFMERGE LFPREPROCESSOR LFPATH LFVISUALIZER
"""
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np
from PIL import Image

import filmed_card
from filmed_card import FPS, FRAMES, NAMES
from program_test_case import ProgramTestCase, wait_until

IMPORT = EXAMPLE = RENDERER = MERGE = PREPROCESSOR = PATH = VISUALIZER = None
SHOWN = 7  # the frame of the videos that most tests show
TIME = SHOWN / FPS


def pixels_of(file):
    return cv2.imread(str(file), cv2.IMREAD_UNCHANGED)


def frames_of(folder, pattern="frame_*.exr"):
    """Returns the bytes of the pixels of the frames in a folder."""
    files = sorted(folder.glob(pattern))
    assert files, folder
    return [pixels_of(file).tobytes() for file in files]


def red_middle(file):
    """Returns the x coordinate of the middle of what is red in a frame, in elements."""
    blue, green, red = np.moveaxis(pixels_of(file)[..., :3].astype(float), -1, 0)
    is_red = red > 3 * (blue + green)
    return (np.nonzero(is_red)[1] + 0.5).mean()


class LightFieldVideoTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.shared = pathlib.Path(temporary.name)
        cls.frames = cls.shared / "frames"  # CAMERA/0000.png
        filmed_card.write_frames(cls.frames)
        filmed_card.write_poses(cls.frames)
        cls.videos = cls.shared / "videos"
        filmed_card.write_videos(cls.videos, cls.frames)
        filmed_card.write_poses(cls.videos)
        cls.still = filmed_card.write_still(cls.shared / "still", TIME)
        cls.path = filmed_card.write_path(cls.shared / "path.yaml")
        subprocess.run([RENDERER, cls.still, cls.path, "-o", cls.shared / "expected", "-q"], check=True)
        cls.expected = frames_of(cls.shared / "expected")

    def render(self, field, path, *options, code=0):
        out = self.folder / f"film{len(list(self.folder.glob('film*')))}"
        result = self.call(RENDERER, field, path, "-o", out, "-q", *options)
        self.assertEqual(result.returncode, code, result.stderr)
        return out

    def copy(self, source):
        return pathlib.Path(shutil.copytree(source, self.folder / source.name))

    # One time

    def test_a_time_of_videos_is_the_light_field_of_its_frames(self):
        self.assertEqual(frames_of(self.render(self.videos, self.path, "--time", TIME)), self.expected)

    def test_frames_in_folders_are_a_light_field_video(self):
        for inner in ("", "images"):
            with self.subTest(inner):
                folder = self.folder / f"frames-{inner}"
                filmed_card.write_frames(folder, inner)
                filmed_card.write_poses(folder)
                out = self.render(folder, self.path, "--time", TIME, "--recorded-fps", FPS)
                self.assertEqual(frames_of(out), self.expected)

    def test_models_json_states_the_cameras_of_videos_and_of_folders(self):
        for source in (self.videos, self.frames):
            with self.subTest(source.name):
                folder = self.copy(source)
                (folder / "poses_bounds.npy").unlink()
                filmed_card.write_models(folder)
                fps = ["--recorded-fps", FPS] if source == self.frames else []
                shown = self.render(folder, self.path, "--time", TIME, *fps)
                self.assertEqual(frames_of(shown), self.expected)

    def test_any_ending_that_ffmpeg_reads(self):
        for ending, codec in ((".mkv", ("-c:v", "ffv1", "-pix_fmt", "bgr0")), (".mov", ("-c:v", "png")),
                              (".avi", ("-c:v", "ffv1", "-pix_fmt", "bgr0"))):
            with self.subTest(ending):
                folder = self.folder / ending[1:]
                filmed_card.write_videos(folder, self.frames, ending, codec=codec)
                filmed_card.write_poses(folder)
                self.assertEqual(frames_of(self.render(folder, self.path, "--time", TIME)), self.expected)

    def test_the_nearest_frame_is_shown(self):
        for time in (TIME - 0.049, TIME + 0.049):
            self.assertEqual(frames_of(self.render(self.videos, self.path, "--time", time)), self.expected)
        self.assertNotEqual(frames_of(self.render(self.videos, self.path, "--time", TIME + 0.06)), self.expected)

    def check_decoded(self, decoded):
        """Checks that a folder has all frames of all cameras with the drawn bits."""
        for camera, name in enumerate(NAMES):
            files = sorted(decoded.glob(f"{name}-*/*.png"))
            self.assertEqual([file.name for file in files], [f"{frame:06d}.png" for frame in range(FRAMES)])
            for frame, file in enumerate(files):
                np.testing.assert_array_equal(np.asarray(Image.open(file)),
                                              filmed_card.picture(camera, frame / FPS))

    def test_every_frame_of_a_video_is_decoded_exactly(self):
        """Asks for frames one by one from the last one on, so that each is sought."""
        for frame in range(FRAMES - 1, -1, -1):
            self.succeeds(IMPORT, self.videos, "--time", frame / FPS, "-q", "--frame-cache", self.folder / "decoded")
        self.check_decoded(self.folder / "decoded")

    def test_only_frames_that_are_asked_for_are_decoded_and_decoded_once(self):
        folder = self.copy(self.videos)
        self.succeeds(IMPORT, folder, "--time", TIME, "-q")
        files = sorted((self.folder / "videos.frames").rglob("*.*"))
        self.assertEqual([file.name for file in files], [f"{SHOWN:06d}.png"] * 9)
        before = [file.stat().st_ino for file in files]
        self.succeeds(IMPORT, folder, "--time", TIME, "-q")
        self.assertEqual([file.stat().st_ino for file in files], before)
        # A video that was changed is decoded again.
        filmed_card.encode(self.frames / NAMES[1], folder / f"{NAMES[0]}.mp4")
        self.succeeds(IMPORT, folder, "--time", TIME, "-q")
        again = sorted((self.folder / "videos.frames").glob(f"{NAMES[0]}-*/*.png"))
        self.assertEqual(len(again), 2)
        self.assertEqual(sorted(filmed_card.picture(c, TIME).tobytes() for c in (0, 1)),
                         sorted(np.asarray(Image.open(file)).tobytes() for file in again))

    def check_colours(self, source, colour, matrix, bits, tags):
        folder = self.folder / f"{matrix}-{bits}"
        folder.mkdir()
        filmed_card.encode(source, folder / f"{NAMES[0]}.mkv", codec=(
            "-vf", f"scale=out_color_matrix={matrix}:out_range=tv", "-c:v", "ffv1",
            "-pix_fmt", "yuv444p" if bits == 8 else "yuv444p10le", *tags))
        for name in NAMES[1:]:
            shutil.copy(folder / f"{NAMES[0]}.mkv", folder / f"{name}.mkv")
        filmed_card.write_poses(folder)
        native = self.folder / f"{matrix}-{bits}-native"
        self.succeeds(IMPORT, folder, "--time", 0, "-o", native, "-q")
        found = cv2.imread(str(next((native / "frames").rglob("*.png"))), cv2.IMREAD_UNCHANGED)[..., ::-1]
        self.assertEqual(found.dtype, np.uint8 if bits == 8 else np.uint16)
        # The tolerance is that of Y, Cb and Cr, which are rounded to 8 or 10 bits.
        difference = np.abs(found / (1 if bits == 8 else 257) - colour).max()
        self.assertLess(difference, 2.0 if bits == 8 else 0.7)

    def test_colours_are_converted_by_their_tags(self):
        """A colour that is converted to Y, Cb and Cr of limited range comes back, by BT.709 if the file says so, and by
        BT.601 if it says nothing and has fewer than 720 lines."""
        colour = (200, 60, 30)
        source = self.folder / "colour"
        source.mkdir()
        for frame in range(2):
            Image.fromarray(np.full((72, 96, 3), colour, np.uint8)).save(source / f"{frame:04d}.png")
        for matrix, tags in (("bt709", ("-colorspace", "bt709")), ("bt601", ())):
            for bits in (8, 10):
                with self.subTest(f"{matrix}-{bits}"):
                    self.check_colours(source, colour, matrix, bits, tags)

    def test_lfimport_writes_the_light_field_of_a_time(self):
        native = self.folder / "native"
        said = self.succeeds(IMPORT, self.videos, "--time", TIME, "-o", native)
        self.assertIn("video", said)
        self.assertIn("9 cameras, 12 times from 0 to 1.1 s, 10 per second; shows 0.7 s", said)
        field = json.loads((native / "transforms.json").read_text())
        self.assertEqual({frame["time"] for frame in field["frames"]}, {TIME})
        self.assertEqual(len(list((native / "frames").rglob("*.png"))), 9)
        self.assertEqual(frames_of(self.render(native, self.path)), self.expected)
        report = json.loads(self.succeeds(IMPORT, self.videos, "--time", TIME, "--json", "-q"))
        self.assertEqual(report["video"], {"cameras": 9, "times": 12, "begin": 0, "end": report["video"]["end"],
                                           "rate": report["video"]["rate"], "shown": [report["video"]["shown"][0]],
                                           "in_seconds": True})
        self.assertAlmostEqual(report["video"]["end"], 1.1, 6)
        self.assertAlmostEqual(report["video"]["rate"], 10, 6)

    def test_the_card_is_where_it_was_at_the_time(self):
        for frame in (2, 9):
            out = self.render(self.videos, self.path, "--time", frame / FPS)
            focal = 48 / np.tan(np.radians(25))
            # The camera looks at the middle of the plane of the card.
            expected = 48 + focal * filmed_card.card_x(frame / FPS)
            self.assertAlmostEqual(red_middle(out / "frame_0001.exr"), expected, delta=0.7)

    # The question

    def test_without_a_time_the_times_are_told_and_the_printed_call_works(self):
        for program, options in ((IMPORT, []), (EXAMPLE, ["-o", self.folder / "new.yaml", "--move", "static"]),
                                 (RENDERER, [self.path, "-o", self.folder / "new"])):
            with self.subTest(program.name):
                result = self.call(program, self.videos, *options)
                self.assertEqual(result.returncode, 2, result.stderr)
                last = result.stderr.strip().splitlines()[-1]
                self.assertIn("is a light field video of 9 cameras, from 0 to 1.1 s (12 times, 10 per second)", last)
                command = shlex.split(last.partition("for instance by: ")[2])
                self.assertEqual(command[0], str(program))
                self.assertIn("--time", command)
                self.succeeds(*command)

    def test_lfexample_advises_a_call_that_shows_the_time(self):
        path = self.folder / "new.yaml"
        result = self.call(EXAMPLE, self.videos, "--time", TIME, "-o", path, "--move", "static")
        self.assertEqual(result.returncode, 0, result.stderr)
        said = result.stdout + result.stderr
        command = next(line for line in said.splitlines() if "next: lfrenderer" in line).partition("lfrenderer")[2]
        words = shlex.split(command)
        words[words.index("-o") + 1] = str(self.folder / "advised")
        self.succeeds(RENDERER, *[word for word in words if not word.startswith("#")])
        self.assertTrue(list((self.folder / "advised").glob("frame_*")))

    def test_times_outside_of_the_video_are_refused(self):
        for time in (-1, 1.2, 50):
            self.fails(2, [f"--time {time}", "from 0 to 1.1 s"], IMPORT, self.videos, "--time", time)
        self.fails(2, ["--time", "no light field video"], IMPORT, self.still, "--time", 0)
        self.fails(2, ["--recorded-fps", "leave the option out"], IMPORT, self.videos, "--time", 0, "--recorded-fps", 5)

    def test_recorded_videos_are_not_replaced(self):
        folder = self.copy(self.videos)
        before = (folder / f"{NAMES[0]}.mp4").read_bytes()
        self.fails(2, [f"{NAMES[0]}.mp4"], RENDERER, folder, self.path, "--time", 0, "-o", self.folder / "new",
                   "--video", folder / f"{NAMES[0]}.mp4", "--overwrite")
        self.assertEqual((folder / f"{NAMES[0]}.mp4").read_bytes(), before)

    def test_stills_beside_videos_stay_a_light_field_without_times(self):
        folder = self.copy(self.videos)
        shutil.copytree(self.still / "images", folder / "images")
        self.assertEqual(frames_of(self.render(folder, self.path)), self.expected)
        other = self.render(folder, self.path, "--time", 0)
        self.assertNotEqual(frames_of(other), self.expected)

    # transforms.json

    def test_times_of_a_transforms_json(self):
        field = filmed_card.write_timed(self.folder / "timed", [0, 0.25, 0.5, 0.75, 1], [0, 0.2, 0.4, TIME, 1])
        result = self.call(IMPORT, field)
        self.assertEqual(result.returncode, 2)
        self.assertIn("is a light field video, from 0 to 1 (5 times, 4 per unit)", result.stderr)
        self.succeeds(*shlex.split(result.stderr.strip().rpartition("for instance by: ")[2]))
        self.assertEqual(frames_of(self.render(field, self.path, "--time", 0.75)), self.expected)
        self.assertEqual(frames_of(self.render(field, self.path, "--time", 0.8)), self.expected)

    def test_one_image_for_each_time_opens_as_before(self):
        field = filmed_card.write_timed(self.folder / "timed", [TIME])
        file = field / "transforms.json"
        text = json.loads(file.read_text())
        for number, frame in enumerate(text["frames"]):
            frame["time"] = number / 9
        file.write_text(json.dumps(text))
        result = self.call(RENDERER, field, self.path, "-o", self.folder / "film")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("each LF image has another recording time", result.stderr)
        self.assertEqual(frames_of(self.folder / "film"), self.expected)
        for value in ("noon", None):
            text["frames"][3]["time"] = value
            file.write_text(json.dumps(text))
            self.assertEqual(frames_of(self.render(field, self.path)), self.expected)

    # Cameras that lack something

    def test_a_broken_video_is_a_missing_image(self):
        folder = self.copy(self.videos)
        whole = (folder / f"{NAMES[4]}.mp4").read_bytes()
        (folder / f"{NAMES[4]}.mp4").write_bytes(whole[:len(whole) // 2])
        result = self.call(IMPORT, folder, "--time", TIME)
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertIn(f"{NAMES[4]}.mp4", result.stderr)
        self.assertIn("1 of 9 images are missing", result.stderr)
        for name in NAMES:
            (folder / f"{name}.mp4").write_bytes(b"no video")
        self.fails(3, [f"{NAMES[0]}.mp4", "cannot be read as a video"], IMPORT, folder, "--time", TIME)

    def test_damaged_frames_are_not_shown(self):
        folder = self.copy(self.videos)
        video = folder / f"{NAMES[5]}.mp4"
        data = bytearray(video.read_bytes())
        begin, end = int(0.3 * len(data)), int(0.8 * len(data))
        data[begin:end] = bytes(end - begin)
        video.write_bytes(data)
        result = self.call(IMPORT, folder, "--time", TIME)
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertIn(f"{NAMES[5]}.mp4", result.stderr)
        self.assertIn("1 of 9 images are missing", result.stderr)

    def test_a_camera_that_ends_early_is_a_missing_image(self):
        folder = self.copy(self.videos)
        few = self.folder / "few"
        few.mkdir()
        for frame in range(5):
            shutil.copy(self.frames / NAMES[2] / f"{frame:04d}.png", few)
        filmed_card.encode(few, folder / f"{NAMES[2]}.mp4")
        result = self.call(IMPORT, folder, "--time", TIME)
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertIn(f"{NAMES[2]} has no frame at 1 of the 1 times", result.stderr)
        self.assertIn(f"{NAMES[2]} has 5 frames up to 0.4 s", result.stderr)
        self.succeeds(IMPORT, folder, "--time", 0.4)

    def test_cameras_of_other_rates_show_their_nearest_frame(self):
        folder = self.copy(self.videos)
        half = self.folder / "half"
        half.mkdir()
        for frame in range(0, FRAMES, 2):
            shutil.copy(self.frames / NAMES[0] / f"{frame:04d}.png", half / f"{frame // 2:04d}.png")
        filmed_card.encode(half, folder / f"{NAMES[0]}.mp4", fps=FPS / 2)
        result = self.call(IMPORT, folder, "--time", 0.8, "-o", self.folder / "native")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{NAMES[0]} has 6 frames", result.stderr)
        shown = next((self.folder / "native/frames").glob(f"{NAMES[0]}-*/*.png"))
        self.assertEqual(shown.name, "000004.png")
        np.testing.assert_array_equal(np.asarray(Image.open(shown)), filmed_card.picture(0, 0.8))

    def test_a_lost_file_of_a_folder_shifts_no_other(self):
        folder = self.copy(self.frames)
        (folder / NAMES[3] / f"{SHOWN - 2:04d}.png").unlink()
        out = self.render(folder, self.path, "--time", TIME, "--recorded-fps", FPS)
        self.assertEqual(frames_of(out), self.expected)
        lost = self.call(IMPORT, folder, "--time", (SHOWN - 2) / FPS, "--recorded-fps", FPS)
        self.assertEqual(lost.returncode, 6)
        self.assertIn(f"{NAMES[3]} has no frame", lost.stderr)

    def test_numbers_of_videos_and_poses_must_agree(self):
        folder = self.copy(self.videos)
        (folder / f"{NAMES[8]}.mp4").unlink()
        self.fails(3, ["holds 9 poses, but there are 8 videos"], IMPORT, folder, "--time", 0)

    def test_a_missing_ffmpeg_is_named(self):
        folder = self.copy(self.videos)
        result = subprocess.run([IMPORT, folder, "--time", "0"], capture_output=True, text=True,
                                env={**os.environ, "PATH": "/nonexistent"})
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("apt-get install ffmpeg", result.stderr)

    # Through time

    def film_path(self, name="film.yaml", frames=6, time="{from: 0.11, speed: 0.5}", **options):
        return filmed_card.write_path(self.folder / name, frames, time, **options)

    def still_frames(self, times, field=None, options=(), path_options=None):
        """Renders each frame of a path alone, from the light field of its time."""
        path = filmed_card.write_path(self.folder / "still.yaml", len(times), **(path_options or {}))
        frames = []
        for number, time in enumerate(times, 1):
            out = self.render(field or self.videos, path, "--time", f"{time:.9g}", "--frames", number, *options)
            frames += frames_of(out)
        return frames

    def test_all_frames_are_decoded_at_once(self):
        folder = self.copy(self.videos)
        self.render(folder, self.film_path(frames=FRAMES, time="{from: 0}"))
        self.check_decoded(self.folder / "videos.frames")

    def test_a_signal_ends_decoding_and_leaves_no_half_file(self):
        folder = self.folder / "long"
        folder.mkdir()
        filmed_card.encode(self.frames / NAMES[0], folder / f"{NAMES[0]}.mp4", codec=(
            "-vf", "scale=960:720,loop=20:12", "-c:v", "libx264", "-preset", "ultrafast"))
        for name in NAMES[1:]:
            shutil.copy(folder / f"{NAMES[0]}.mp4", folder / f"{name}.mp4")
        filmed_card.write_poses(folder)
        decoded = self.folder / "long.frames"
        path = filmed_card.write_path(self.folder / "long.yaml", 200, "{from: 0, speed: 1}")
        with subprocess.Popen([RENDERER, folder, path, "-o", self.folder / "film", "-q"],
                              stderr=subprocess.DEVNULL) as process:
            wait_until(lambda: list(decoded.rglob(".*.png")), process)
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=120)
        self.assertEqual(process.returncode, 5)
        for file in decoded.rglob("[0-9]*.png"):
            Image.open(file).load()  # files under their own names are whole

    def test_a_film_through_time_is_its_frames_one_by_one(self):
        times = [0.11 + 0.5 * frame / 10 for frame in range(6)]
        path = self.film_path()
        expected = self.still_frames(times)
        self.assertEqual(len(set(expected)), 6)
        for field in (self.videos, self.frames):
            fps = ["--recorded-fps", FPS] if field == self.frames else []
            self.assertEqual(frames_of(self.render(field, path, *fps)), expected)
        for options in (["--lens-weights", "none"], ["--estimator", "nearest"], ["--max-images", 4],
                        ["--order", "area"], ["--threads", 1, "--memory", "64M"]):
            with self.subTest(options):
                if options[0] in ("--max-images", "--order"):  # ranks differ from those of one time
                    self.render(self.videos, path, *options)
                    continue
                self.assertEqual(frames_of(self.render(self.videos, path, *options)),
                                 self.still_frames(times, options=options))

    def test_most_images_are_counted_within_a_slice(self):
        """A limit of all nine cameras is no limit, though the film has many more LF images."""
        path = self.film_path()
        self.assertEqual(frames_of(self.render(self.videos, path, "--max-images", 9)),
                         frames_of(self.render(self.videos, path)))

    def test_slow_motion_shows_each_time_for_several_frames(self):
        path = self.film_path(time="{from: 0, speed: 0.25}", frames=7)
        expected = self.still_frames([0.025 * frame for frame in range(7)])
        self.assertEqual(frames_of(self.render(self.videos, path)), expected)

    def test_time_may_run_backwards_and_stand_still(self):
        path = self.film_path(time="{from: 1.1, speed: -1}", frames=4)
        self.assertEqual(frames_of(self.render(self.videos, path)), self.still_frames([1.1, 1.0, 0.9, 0.8]))
        still = self.film_path("bullet.yaml", time="{from: 0.7, speed: 0}", frames=3)
        expected = self.still_frames([TIME] * 3)
        self.assertEqual(frames_of(self.render(self.videos, still)), expected)
        # A film of one time has all modes and packages.
        self.render(self.videos, still, "--mode", "hybrid")
        self.succeeds(PREPROCESSOR, self.videos, still, "-o", self.folder / "packages", "-q")
        packed = self.folder / "packed"
        self.succeeds(RENDERER, *self.folder.glob("packages/*.lfp"), "-o", packed, "-q")
        self.assertEqual(frames_of(packed), expected)

    def test_a_shutter_exposes_several_times(self):
        """A frame with a shutter is the mean of its instants, whose LF images are those of their times."""
        shutter = "shutter: {angle_deg: 360, samples: 2}"
        path = self.film_path(frames=1, time="{from: 0.5, speed: 4}", more=shutter)
        blurred = pixels_of(self.render(self.videos, path, "--format", "exr-float") / "frame_0001.exr")
        parts = [pixels_of(self.render(self.videos, filmed_card.write_path(self.folder / "still.yaml", 1), "--time",
                                       time, "--format", "exr-float") / "frame_0001.exr") for time in (0.4, 0.6)]
        # The camera moves by less than a thousandth of an element within the frame.
        self.assertLess(np.abs(blurred - np.mean(parts, axis=0))[..., :3].mean(), 2e-3)
        self.assertGreater(np.abs(blurred - parts[0])[..., :3].mean(), 5e-3)

    def test_times_of_a_transforms_json_are_filmed(self):
        field = filmed_card.write_timed(self.folder / "timed", [0, 0.5, 1], [0.2, 0.4, TIME])
        path = self.film_path(time="{from: 0, speed: 2}", frames=6)
        self.assertEqual(frames_of(self.render(field, path)),
                         self.still_frames([0, 0.2, 0.4, 0.6, 0.8, 1.0], field=field))

    def test_shards_of_a_film_through_time(self):
        path = self.film_path()
        expected = frames_of(self.render(self.videos, path))
        for shard in (1, 2):
            out = self.render(self.videos, path, "--shard", f"{shard}/2")
            shutil.copytree(out / "partial" / "shards", self.folder / "shards", dirs_exist_ok=True)
        self.succeeds(MERGE, self.folder / "shards", "-o", self.folder / "merged", "-q")
        self.assertEqual(frames_of(self.folder / "merged"), expected)

    def test_a_killed_film_resumes_to_the_same_bits(self):
        path = self.film_path(resolution=(240, 180))
        expected = frames_of(self.render(self.videos, path))
        out = self.folder / "killed"
        words = [RENDERER, self.videos, path, "-o", out, "-q", "--dump-every", "0.001s", "--memory", "96M"]
        resume = []
        for _ in range(3):
            with subprocess.Popen([*map(str, words), *resume], stderr=subprocess.DEVNULL) as process:
                wait_until(lambda: list(out.glob("partial/*.plate")), process)
                process.send_signal(signal.SIGKILL)
            resume = ["--resume"]
        self.succeeds(*words, "--resume")
        self.assertEqual(frames_of(out), expected)
        other = self.film_path("other.yaml", time="{from: 0.115, speed: 0.5}", resolution=(240, 180))
        self.fails(2, ["frame.recording_time"], RENDERER, self.videos, other, "-o", out, "--resume")

    def test_a_missing_image_of_one_time_is_missing_there_alone(self):
        folder = self.copy(self.frames)
        (folder / NAMES[3] / "0003.png").unlink()
        path = self.film_path(frames=6, time="{from: 0.1, speed: 1}")
        whole = frames_of(self.render(self.frames, path, "--recorded-fps", FPS))
        part = frames_of(self.render(folder, path, "--recorded-fps", FPS, "--allow-missing", 1))
        self.assertEqual([a == b for a, b in zip(whole, part)], [True, True, False, True, True, True])

    def test_what_cannot_move_through_time_says_so(self):
        path = self.film_path()
        film = [self.videos, path, "-o", self.folder / "a"]
        self.fails(2, ["moves through time", "--time"], RENDERER, *film, "--time", 0)
        self.fails(2, ["moves through time", "no light field video"], RENDERER, self.still, *film[1:])
        self.fails(2, ["--mode hybrid", "move", "--interpolation pixels"], RENDERER, *film, "--mode", "hybrid",
                   "--interpolation", "cells")
        self.fails(2, ["--densify"], RENDERER, *film, "--densify")
        self.fails(2, ["packages", "--shard"], PREPROCESSOR, *film)
        self.succeeds(PREPROCESSOR, self.videos, path, "--plan", "-q")
        far = self.film_path("far.yaml", time="{from: 1, speed: 1}")
        self.fails(2, ["from 0 to 1.1 s", "path"], RENDERER, self.videos, far, "-o", self.folder / "a")
        self.fails(2, ["shows one time"], VISUALIZER, self.videos, path, "--time", 0, "--text")

    def test_lfpath_keeps_the_times(self):
        path = self.film_path()
        for options, count in (([], 6), (["--fps", 20], 11)):
            written = self.folder / f"written{count}.yaml"
            self.succeeds(PATH, path, "-o", written, *options)
            self.assertIn("time: {from: 0.11, speed: 0.5", written.read_text())
            self.assertIn(f"frames: {count}", written.read_text())
        self.assertEqual(frames_of(self.render(self.videos, self.folder / "written6.yaml")),
                         frames_of(self.render(self.videos, path)))


if __name__ == "__main__":
    IMPORT, EXAMPLE, RENDERER, MERGE, PREPROCESSOR, PATH, VISUALIZER = map(pathlib.Path, sys.argv[1:8])
    sys.exit(unittest.main(argv=sys.argv[:1], verbosity=2))
