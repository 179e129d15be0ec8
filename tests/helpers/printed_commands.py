# SPDX-License-Identifier: Apache-2.0
"""Finds the commands that programs print as advice, and runs them where they were printed.

A printed command ends its line, after ": " (lf/core/shell_word.h).
"""
import json
import os
import pathlib
import re
import shutil
import subprocess

import numpy as np
from PIL import Image

import filmed_card
import pose_mistakes
from small_field import wall, write_field, write_path
from source_messages import PROGRAMS

COMMAND = re.compile(r"(?:: |^  )((?:" + "|".join(PROGRAMS) + r")(?: .*)?)$", re.M)
TRY = re.compile(r"Try '([^']+)'")
# The words that people replace in a printed command, because no program can know them.
PLACEHOLDERS = {
    "PATH.yaml": "a camera path of theirs",
    "LIGHTFIELD": "their light field",
    "OPTIONS": "the options of lfrenderer that the message names",
    "DIR": "a folder of their choice",
}


# stop PATTERN COMMAND: interrupts the command as soon as a file matches the pattern.
STOP = """stop() { local pattern=$1; shift; "$@" & local task=$!
  until compgen -G "$pattern" >/dev/null || ! kill -0 $task 2>/dev/null; do sleep 0.005; done
  kill -INT $task 2>/dev/null; wait $task; test $? = 5; }
"""


class Ended:
    """A command that has ended: its exit code and what it printed."""

    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err
        self.text = out + err

    def commands(self, program="lf"):
        """Returns the commands that were printed, or those of one program."""
        printed = COMMAND.findall(self.text) + TRY.findall(self.text)
        return [command for command in printed if command.startswith(program)]


class Shell:
    """Runs lines in bash, with the programs of a folder on PATH."""

    def __init__(self, programs):
        self.environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", CI="true")
        self.environment.pop("OCIO", None)

    def run(self, line, folder):
        done = subprocess.run(["bash", "-c", STOP + line], cwd=folder, env=self.environment, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=300)
        return Ended(done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace"))

    def must(self, line, folder):
        ended = self.run(line, folder)
        if ended.code != 0:
            raise AssertionError(f"{line}\nended with {ended.code}:\n{ended.text}")
        return ended


def fill(command, values):
    """Returns a printed command with its placeholders replaced, which must be among PLACEHOLDERS."""
    for name, value in values.items():
        if name not in PLACEHOLDERS:
            raise AssertionError(f"{name} is no placeholder")
        command = re.sub(rf"(?<![\w.]){re.escape(name)}(?![\w.])", value, command)
    return command


LENS = """  aperture_diameter: 0.045
"""


def make_world(folder: pathlib.Path, shell: Shell):
    """Makes the small files that the situations of the table start from."""
    folder.mkdir()
    write_field(folder / "capture", wall)
    path = write_path(folder, frames=2)
    text = path.read_text().replace("[80, 60]", "[32, 24]")
    path.write_text(text)
    (folder / "wide.yaml").write_text(text.replace("frames: 2", "frames: 4"))
    (folder / "hood.yaml").write_text(text.replace(LENS, LENS + "  hood_distance: 0.1\n  hood_diameter: 0.1\n"))
    (folder / "glass.yaml").write_text(text.replace(LENS, LENS + "  transmission: \"ff80/80ff\"\n"))
    (folder / "shutter.yaml").write_text(text.replace("lens:", "shutter: {angle_deg: 180, samples: 2}\nlens:"))
    (folder / "pinhole.yaml").write_text(text.replace("aperture_diameter: 0.045", "aperture_diameter: 0"))
    with_alpha(folder / "capture", folder / "alpha")
    with_one_outline(folder / "capture", folder / "outline")
    changed(folder / "capture", folder / "twice", lambda frames: frames.append(dict(frames[3], file_path="again.png")))
    shutil.copy(folder / "capture" / "image_03.png", folder / "twice" / "again.png")
    changed(folder / "capture", folder / "turned", lambda frames: frames[3].update(transform_matrix=[
        [-1, 0, 0, 0], [0, -1, 0, 0.02], [0, 0, 1, 0], [0, 0, 0, 1]]))
    changed(folder / "capture", folder / "away", lambda frames: frames[3].update(transform_matrix=[
        [-1, 0, 0, 0], [0, 1, 0, 0.02], [0, 0, -1, 0], [0, 0, 0, 1]]))
    changed(folder / "capture", folder / "mixed", lambda frames: frames[3].update(w=60))
    with_brackets(folder / "capture", folder / "brackets")
    write_field(folder / "flat", lambda index: np.full((48, 64, 3), 90, np.uint8))
    filmed_card.write_frames(folder / "filmed", frames=3)
    filmed_card.write_poses(folder / "filmed")
    filmed_card.write_path(folder / "moving.yaml", 2, "{from: 0, speed: 0.5}")
    reduced(folder / "capture", folder / "half")
    photographed(folder / "capture", folder / "photos")
    named_by_grid(folder / "capture", folder / "cards")
    for line in SETUP:
        shell.must(line, folder)
    folded(folder / "sparse", folder / "folded")
    pose_mistakes.write_mistake("position-y-negated", folder / "sparse", folder / "mistaken")


SETUP = [
    "lfsynth still-life -o sparse --count 16 --size 160x120 --spacing 0.02 --format png -q",
    "lfexample sparse -o sparse.yaml --move static -q && sed -i 's/diameter: [0-9.]*/diameter: 0.05/' sparse.yaml",
    "lfpreprocessor capture path.yaml -o packages --packages 2 -q",
    "lfpreprocessor capture path.yaml -o plain --lens-weights none -q",
    "lfpreprocessor capture path.yaml -o few --max-images 4 -q",
    "lfcompressor capture -o capture.lfs -q",
    "lfdensify capture path.yaml -o thick.lfs --force --most 40 --spacing 0.5 --cache none -q",
    "lfpreprocessor thick.lfs path.yaml -o guardless --no-guard --lens-weights none -q",
    "lfrenderer capture path.yaml -o frames --format png -q",
    "for k in 1 2; do lfrenderer capture path.yaml -o shards --frames 1 --shard $k/2 -q; done",
    "lfpath path.yaml -o eyes.yaml --stereo 0.01 && lfrenderer capture eyes.yaml -o eyes --format png -q",
    "lfsynth chart -o chart --count 9 --size 48x32 -q",
    "lfsynth lights -o mosaic --bayer --count 9 --size 48x32 -q && lfexample mosaic -o mosaic.yaml --move static -q",
]


def with_alpha(source, folder):
    """Copies a light field; its LF images get an alpha channel with holes."""
    shutil.copytree(source, folder)
    for file in folder.glob("*.png"):
        pixels = np.asarray(Image.open(file))
        alpha = np.full(pixels.shape[:2] + (1,), 255, np.uint8)
        alpha[:10, :10] = 0
        alpha[10:14, :10] = 128
        Image.fromarray(np.concatenate([pixels, alpha], axis=2)).save(file)


def with_one_outline(source, folder):
    """Copies a light field; all its LF images show nothing but their middle."""
    shutil.copytree(source, folder)
    for file in folder.glob("*.png"):
        pixels = np.zeros((48, 64, 4), np.uint8)
        pixels[16:32, 20:44, :3] = np.asarray(Image.open(file))[16:32, 20:44]
        pixels[16:32, 20:44, 3] = 255
        Image.fromarray(pixels).save(file)


def folded(source, folder):
    """Copies a light field of 4 x 4 LF cameras, every second of which sees the world turned upside down, as the
    opposite one sees it."""
    shutil.copytree(source, folder)
    frames = json.loads((folder / "transforms.json").read_text())["frames"]
    for row in range(4):
        for column in range(row % 2, 4, 2):
            opposite = Image.open(source / frames[15 - 4 * row - column]["file_path"])
            opposite.transpose(Image.Transpose.ROTATE_180).save(folder / frames[4 * row + column]["file_path"])


def save_photograph(pixels, file, time_s):
    """Writes a JPEG file that states its exposure."""
    exif = Image.Exif()
    exif[0x8769] = {0x829A: time_s, 0x829D: 8.0, 0x8827: 100}  # exposure time, f-number, ISO sensitivity
    Image.fromarray(pixels).save(file, exif=exif, quality=95)


def photographed(source, folder):
    """Copies a light field as photographs that state their exposure, all but one; one states a wrong time."""
    changed(source, folder, lambda frames: [frame.update(file_path=frame["file_path"].replace(".png", ".jpg"))
                                            for frame in frames])
    for file in list(folder.glob("*.png")):
        save_photograph(np.asarray(Image.open(file)), file.with_suffix(".jpg"),
                        1e-9 if file.stem == "image_09" else 0.01)
        file.unlink()
    Image.open(folder / "image_07.jpg").save(folder / "image_07.jpg")


def changed(source, folder, change):
    """Copies a light field and changes the frames of its transforms.json."""
    shutil.copytree(source, folder)
    file = folder / "transforms.json"
    field = json.loads(file.read_text())
    change(field["frames"])
    file.write_text(json.dumps(field))


def with_brackets(source, folder):
    """Copies a light field that has a second, brighter image at each pose."""
    def double(frames):
        for frame in list(frames):
            frames.append(dict(frame, file_path="bright_" + frame["file_path"], lf_gain=4))
    changed(source, folder, double)
    for file in list(folder.glob("*.png")):
        pixels = np.asarray(Image.open(file)).astype(int) * 2
        Image.fromarray(np.minimum(pixels, 255).astype(np.uint8)).save(folder / f"bright_{file.name}")


def reduced(source, folder):
    """Copies a light field, with images of half the size."""
    shutil.copytree(source, folder)
    for file in folder.glob("*.png"):
        Image.open(file).resize((32, 24)).save(file)


def named_by_grid(source, folder):
    """Makes a folder of images whose names state row and column alone."""
    folder.mkdir()
    for row in range(5):
        for column in range(5):
            shutil.copy(source / f"image_{5 * row + column:02d}.png", folder / f"card_{row:02d}_{column:02d}.png")
