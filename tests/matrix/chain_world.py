# SPDX-License-Identifier: Apache-2.0
"""Makes the light fields and camera paths of the chains (doc/matrix.md), and runs programs, each call once."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import threading

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from common_options import OFFERED
from exr_file import channels_of
from matrix_world import Difference, last_line, once

WIDTH, HEIGHT, SIDE = 48, 32, 5  # pixels of an LF image; columns and rows of LF cameras
PITCH, FOCAL_PX = 0.01, 50
WALL_DEPTH, SLANT = 0.25, 0.6  # depth of the wall in the middle, and its growth to the right
MIDDLE = (SIDE * SIDE) // 2
BROKEN, MASKED = 7, (6, 18)
VIGNETTING = (-0.3, 0.05, -0.1)
FIELDS = ("masks", "light", "opacity", "floats", "mosaic", "synth")

PATH_YAML = """format: lfpath 1
fps: 25
frames: 2
resolution: {resolution}
{more}
camera: {{field_of_view_deg: 40, focal_length_mm: 35, shift_mm: {{horizontal: {shift}, vertical: 0}},
         position: [0, 0, 0], look_at: [0, 0, -1], up: [0, 1, 0]}}
lens: {{aperture_diameter: 0.024, focus_distance: 0.25, focus_tilt_deg: {{horizontal: {tilt}, vertical: 0}}{lens}}}
keyframes:
  position: [{{time: 0, value: [-0.004, 0, 0]}}, {{time: 0.04, value: [0.006, 0.004, -0.002]}}]
  focus_distance: [{{time: 0, value: 0.25}}, {{time: 0.04, value: {last_focus}}}]
"""
PLAIN = {"resolution": [40, 30], "more": "", "shift": 0, "tilt": 0, "lens": "", "last_focus": 0.32}
PATHS = {
    "plain": PLAIN,
    "fine": {**PLAIN, "resolution": [160, 120]},
    "still": {**PLAIN, "last_focus": 0.25},
    "lens": {**PLAIN, "shift": 1.5, "tilt": 10, "lens": ", blades: 5, blade_roundness: 0.5, ratio: 1.3, "
             "hood_distance: 0.02, hood_diameter: 0.04"},
    "shutter": {**PLAIN, "more": "shutter: {angle_deg: 270, samples: 3}"},
    "surface": {**PLAIN, "more": "focus: {surface: depth_%d.pfm, kind: depth}"},
}


class Refused(Exception):
    """A program ended with an exit code other than 0."""

    def __init__(self, program, exit_code, said):
        super().__init__(f"{program}: exit code {exit_code}: {last_line(said)}")
        self.exit_code, self.last_line = exit_code, last_line(said)


def light_at(index):
    """Returns the radiance of a slanted wall that an LF camera sees, up to 2.5: [row][column][R, G, B]."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    u, v = (x - WIDTH / 2) / FOCAL_PX, (y - HEIGHT / 2) / FOCAL_PX
    place = (index % SIDE - SIDE // 2) * PITCH
    z = (WALL_DEPTH + SLANT * place) / (1 - SLANT * u)
    x_w, y_w = place + u * z, v * z - (index // SIDE - SIDE // 2) * PITCH
    waves = 0.6 * np.sin(x_w * 190 + 1) * np.cos(y_w * 160) + 0.45 * np.sin(x_w * 83 - y_w * 120 + 2)
    return (1.25 + waves)[..., None] * [1.05, 0.9, 0.7]


def opacity_at(index):
    """Returns an opacity that falls towards the rims of an LF image: 1 in the middle, 0 in the corners."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    return np.clip(3.4 - np.hypot((x - WIDTH / 2) / 8, (y - HEIGHT / 2) / 6.5) - 0.05 * (index % SIDE), 0, 1)


def falloff():
    """Returns the share of light that the lens leaves (lf_vignetting)."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    r2 = ((x - WIDTH / 2) ** 2 + (y - HEIGHT / 2) ** 2) / (WIDTH ** 2 + HEIGHT ** 2) * 4
    return (1 + r2 * (VIGNETTING[0] + r2 * (VIGNETTING[1] + r2 * VIGNETTING[2])))[..., None]


def gain_of(index):
    """Returns the gain of an LF image: no recorded value clips, and all recorded light is about a third."""
    return ([3, 2.8, 3.2], 3, 3.3)[index % 3]


def srgb_of(light):
    light = np.clip(light, 0, 1)
    return np.where(light > 0.0031308, 1.055 * light ** (1 / 2.4) - 0.055, 12.92 * light)


def write_image(file, field, index):
    """Writes what an LF camera records: light with dark corners, divided by its gain."""
    light = light_at(index) * falloff() / gain_of(index)
    if field == "floats":
        light = (4 * light[..., ::-1]).astype(np.float32)
        light[5 + index % 3, 9] = [np.nan, np.inf, -0.5]
        return cv2.imwrite(str(file), light, [cv2.IMWRITE_EXR_TYPE, cv2.IMWRITE_EXR_TYPE_HALF])
    if field == "mosaic":
        rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH] % 2
        colours = np.take_along_axis(light, (rows + columns)[..., None], 2)[..., 0]  # RGGB
        return cv2.imwrite(str(file), (colours * 60000 + 500).astype(np.uint16))
    alpha = opacity_at(index)
    if field == "masks":  # 8 bits, and an alpha that masks pixels
        return cv2.imwrite(str(file), np.dstack([srgb_of(light)[..., ::-1], alpha > 0.3]) * 255 + 0.5)
    return cv2.imwrite(str(file), (np.dstack([srgb_of(light)[..., ::-1], alpha]) * 65535 + 0.5).astype(np.uint16))


KEYS = {
    "masks": {"lf_alpha": "mask", "lf_max_radiance": 5},
    "light": {"lf_alpha": "straight", "lf_background": [0.3, 1.6, 0.2], "lf_max_radiance": 5},
    "opacity": {"lf_alpha": "straight", "lf_background": "none", "lf_max_radiance": 5},
    "floats": {"lf_max_radiance": 16, "lf_unit_m": 0.5},
    "mosaic": {"lf_bayer": "RGGB", "lf_transfer": "linear", "lf_black_level": 500, "lf_white_level": 60500,
               "lf_max_radiance": 5},
}


def write_field(folder, field):
    """Writes 25 LF cameras in a plane, with gains of 3, dark corners, two mask files and a broken file."""
    folder.mkdir(parents=True)
    frames = []
    for index in range(SIDE * SIDE):
        name = f"image_{index:02}.{'exr' if field == 'floats' else 'png'}"
        if index == BROKEN:
            (folder / name).write_text("no picture")
        else:
            write_image(folder / name, field, index)
        x, y = (index % SIDE - SIDE // 2) * PITCH, (index // SIDE - SIDE // 2) * PITCH
        frames.append({"file_path": name, "lf_gain": gain_of(index), "transform_matrix": [
            [1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]]})
    for number, index in enumerate(MASKED):
        mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
        mask[:, number * WIDTH // 2:(number + 1) * WIDTH // 2] = 0
        cv2.imwrite(str(folder / f"mask_{number}.png"), mask)
        frames[index]["lf_mask"] = f"mask_{number}.png"
    text = {"fl_x": FOCAL_PX, "fl_y": FOCAL_PX, "cx": WIDTH / 2, "cy": HEIGHT / 2, "w": WIDTH, "h": HEIGHT,
            "lf_vignetting": VIGNETTING, "lf_depth_range": [0.2, 0.4], **KEYS[field],
            "frames": frames}
    (folder / "transforms.json").write_text(json.dumps(text))


class World:
    """All files of the chains, in one folder. May be used by several threads.

    programs  the folder of lfrenderer and the other programs
    """

    def __init__(self, programs, folder):
        self.programs, self.folder = pathlib.Path(programs), pathlib.Path(folder)
        self.lock, self.locks, self.made = threading.Lock(), {}, {}
        self.count = 0
        self.texts = {}  # messages of programs on stderr, by the file that they wrote

    def new_folder(self, name="out"):
        with self.lock:
            self.count += 1
            folder = self.folder / f"{self.count:04}"
        folder.mkdir(parents=True)
        return folder / name

    def run(self, call, *words, rest=()):
        """Runs a program on one thread, and accepts broken LF images. Returns its stdout and stderr; raises Refused.

        call   such as "lfrenderer" or "lffocus stack"
        words  an output file or folder follows "-o"
        rest   options that follow "--"
        """
        program, *command = call.split()
        options = {"--threads": ["--threads", 1], "--progress": ["--progress", "none"],
                   "--allow-missing": ["--allow-missing", 2]}
        if call == "lfvisualizer" and "--export" not in words:
            del options["--allow-missing"]
        more = [word for name, option in options.items() if name in OFFERED[call] for word in option]
        line = [self.programs / program, *command, *words, *more, *rest]
        done = subprocess.run(list(map(str, line)), capture_output=True, text=True, timeout=400)
        if done.returncode != 0:
            raise Refused(call, done.returncode, done.stderr)
        return done.stdout, done.stderr

    def make(self, call, *words, to, rest=()):
        """Runs a program that writes a file or folder, which it returns."""
        _, said = self.run(call, *words, "-o", to, rest=rest)
        if not to.exists():
            raise Difference(f"{call}: exit code 0, but there is no {to.name}")
        with self.lock:
            self.texts[to] = said
        return to

    @once
    def field(self, field):
        folder = self.new_folder("capture")
        if field == "synth":
            self.run("lfsynth", "chart", "-o", folder, "--count", 25, "--size", f"{WIDTH}x{HEIGHT}", "--samples", 1,
                     "--spacing", 0.03)
        else:
            write_field(folder, field)
        return folder

    def example(self, field):
        """Returns the path of lfexample, shortened to two small frames."""
        focus = 2 if field == "synth" else 0.25
        file = self.make("lfexample", self.field(field), "--move", "focus-pull", "--focus", focus,
                         to=self.new_folder("path.yaml"))
        text = re.sub(r"(?m)^frames:.*$", "frames: 2", file.read_text())
        file.write_text(re.sub(r"(?m)^resolution:.*$", "resolution: [40, 30]", text))
        return file

    @once
    def path(self, kind="plain", field="masks"):
        """Returns a camera path of one of the PATHS, or, for the scene of lfsynth, that of lfexample."""
        file = self.new_folder("path.yaml")
        if field == "synth":
            return self.example(field)
        text = PATH_YAML.format(**PATHS[kind])
        if field == "views":  # whose world has z forward and y down
            text = text.replace("[0, 0, -1], up: [0, 1, 0]", "[0, 0, 1], up: [0, -1, 0]")
        file.write_text(text)
        for frame in (1, 2):
            y, x = np.mgrid[0:30, 0:40]
            depths = 0.26 + 0.03 * np.sin(x / 9 + frame) * np.cos(y / 7) - np.where(x > 15 + 4 * frame, 0.05, 0)
            depths[10:14, 5:9] = np.inf
            write_pfm(file.parent / f"depth_{frame}.pfm", depths)
        return file


def write_pfm(file, values):
    height, width = values.shape
    file.write_bytes(f"Pf\n{width} {height}\n-1\n".encode() + values[::-1].astype("<f4").tobytes())


# A reader shows a dictionary of arrays, numbers and texts by name. Light has the names FRAME.R, FRAME.G, FRAME.B,
# and FRAME.coverage tells where it was recorded.


def seen_frames(folder):
    """Returns all channels of the EXR frames in a folder, which is removed."""
    files = sorted(folder.glob("frame_*.exr"))
    if not files:
        raise Difference("there are no frames")
    seen = {f"{file.stem}.{name}": values for file in files for name, values in channels_of(file).items()}
    shutil.rmtree(folder)
    return seen


def seen_numbers(value, name=""):
    """Returns the numbers and texts of a JSON value by their places in it."""
    if isinstance(value, dict):
        pairs = [(f"{name}.{key}", part) for key, part in value.items()]
    elif isinstance(value, list):
        pairs = [(f"{name}[{place}]", part) for place, part in enumerate(value)]
    else:
        return {name: value}
    return {key: part for at, child in pairs for key, part in seen_numbers(child, at).items()}


def without_folders(text):
    """Returns a text in which the names of images, light fields and paths have no folders."""
    return re.sub(r"(?:[\w.-]*/)+([\w.-]+)", r"\1", text)


NUMBER = re.compile(r"-?\d+(\.\d*)?(e-?\d+)?")


def seen_words(text, *files):
    """Returns the words of a text, and its numbers, without the names of files."""
    for file in sorted(map(str, files), key=len, reverse=True):
        text = text.replace(file, "FILE")
    lines = without_folders(text).splitlines()
    return {f"line {number}, word {place}": float(word) if NUMBER.fullmatch(word) else word
            for number, line in enumerate(lines, 1) for place, word in enumerate(re.split(r"[\s,\[\]]+", line))}


def seen_picture(file, name):
    """Returns the channels of a picture of the page."""
    picture = cv2.imread(str(file), cv2.IMREAD_COLOR)
    return {f"{name}.{'BGR'[channel]}": picture[..., channel] for channel in range(3)}
