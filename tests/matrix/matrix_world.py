# SPDX-License-Identifier: Apache-2.0
"""Makes the films of the matrix (doc/matrix.md): captures, camera paths, packed stores and packages, each on first
use."""
import contextlib
import functools
import json
import pathlib
import sqlite3
import subprocess
import threading

import numpy as np
from PIL import Image

import small_field
from small_field import HEIGHT, WIDTH

FRAMES, PACKAGES = 9, 3
SIDE = 13  # 169 LF cameras: rules are tested after 64 and 128 of them
MOST_IMAGES = 40
MOST_PIXELS, MOST_CELLS = 2000000, 200000  # limits for rebin and hybrid: all that a film needs fits
MODES = {
    "nearest": ["--estimator", "nearest"],
    "nearest none": ["--estimator", "nearest", "--lens-weights", "none"],
    "bilinear": [],
    "bilinear none": ["--lens-weights", "none"],
    "bilinear area": ["--lens-weights", "area"],
    "bilinear hat": ["--lens-weights", "hat"],
    "bicubic": ["--filter", "bicubic"],
    "unguarded": ["--no-guard"],
    "compositing": ["--colour-space", "acescg", "--frame-alpha", "--z"],
    "few channels": ["--channels", "rgba", "--exr-compression", "zips"],
    "rebin": ["--mode", "rebin", "--max-rays", MOST_PIXELS],
    "rebin cells": ["--mode", "rebin", "--interpolation", "cells", "--max-rays", MOST_CELLS],
    "hybrid": ["--mode", "hybrid", "--max-rays", MOST_PIXELS],
    "hybrid none": ["--mode", "hybrid", "--lens-weights", "none", "--max-rays", MOST_PIXELS],
}
OF_FILES = ("compositing", "few channels")  # modes whose options change the files of frames, not their rays
# The pictures of the LF images do not fit one another, so that the depths are arbitrary; they are the same each time.
DENSIFY = ["--depths", 0.3, 20, "--most", 100, "--force"]
BROKEN, MISSING, MASKED, BRIGHTER = 83, 97, (70, 86), 85  # LF images with flaws, near the middle

PATH_YAML = """format: lfpath 1
fps: 25
frames: {frames}
resolution: [160, 120]
{clock}
{focus}
camera:
  field_of_view_deg: 44
  focal_length_mm: 35
  {camera}
  position: [-0.025, 0, 0]
  look_at: [0, 0, -1]
  up: [0, 1, 0]
lens:
  aperture_diameter: {first}
  focus_distance: 0.8
  {lens}
keyframes:
  position: [{{time: 0, value: [-0.025, -0.01, 0]}}, {{time: 0.16, value: [0.005, 0.01, -0.01]}},
             {{time: 0.32, value: [0.03, 0, 0.005]}}]
  field_of_view_deg: [{{time: 0, value: 44}}, {{time: 0.32, value: 36}}]
  aperture_diameter: [{{time: 0, value: {first}}}, {{time: 0.16, value: 0.08}},
                      {{time: 0.32, value: {last}}}]
  focus_distance: [{{time: 0, value: 0.8}}, {{time: 0.32, value: 2}}]
"""
# The focal surfaces of paths: a depth picture for each frame, and a map of a hilly wall across the optical axis.
SURFACES = {
    "depths": "focus: {surface: depth_%d.pfm, kind: depth}",
    "heights": "focus: {surface: heights.pfm, kind: height, origin: [-1.2, 1, -1.1], cell: 0.1, nodata: -9}",
}
# Entries of a path, and of its sections camera and lens, of the fields that are no plain disk at one moment.
SHAPES = {
    "mosaic": ("", "", "blades: 5\n  blade_roundness: 0.5"),
    "falloff": ("", "shift_mm: {horizontal: 2, vertical: -1}", "ratio: 1.6"),
    "opacity": ("", "", "hood_distance: 0.05\n  hood_diameter: 0.06"),
    "shutter": ("shutter: {angle_deg: 270, samples: 5}", "", ""),
}


# Numbers of the first frames of the films of fields; 1 of others.
FIRST_FRAMES = {"falloff": 1001, "shutter": 0, "depths": 1001}


def frames_of(field):
    """Returns the numbers of the frames of the film of a field."""
    first = FIRST_FRAMES.get(field, 1)
    return range(first, first + FRAMES)


class Difference(Exception):
    """The result of a cell differs from the required one."""


class ProgramFailed(Exception):
    """A program ended with an exit code other than 0 and 6."""

    def __init__(self, program, exit_code, last_line):
        super().__init__(f"{program}: exit code {exit_code}: {last_line}")
        self.exit_code, self.last_line = exit_code, last_line


def run(words, seconds=400):
    """Returns the exit code and the last line of stderr of a program."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, timeout=seconds)
    return done.returncode, last_line(done.stderr)


def last_line(text):
    return (text.strip().splitlines() or [""])[-1]


def once(method):
    """Runs a method once for each combination of arguments; other threads wait for the result."""
    @functools.wraps(method)
    def wrapped(self, *arguments):
        with self.lock:
            lock = self.locks.setdefault((method.__name__, arguments), threading.Lock())
        with lock:
            key = (method.__name__, arguments)
            if key not in self.made:
                try:
                    self.made[key] = method(self, *arguments)
                except (Difference, ProgramFailed) as failure:
                    self.made[key] = failure
        if isinstance(self.made[key], Exception):
            raise self.made[key]
        return self.made[key]
    return wrapped


def picture_of(field, index):
    """Returns a smooth picture with noise, different for each LF image."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    waves = 120 + 70 * np.sin(x / 6 + index / 40) * np.cos(y / 5 - index % SIDE / 9)
    noise = np.random.default_rng(index).normal(0, 3, (HEIGHT, WIDTH, 3))
    rgb = np.clip(waves[..., None] + [0, 15, -20] + noise, 0, 255)
    if "mosaic" in field:
        return (rgb[..., 1] * 200).astype(np.uint16)
    if field in ("alpha", "opacity", "depths"):
        opacity = 600 - 25 * np.hypot(x - WIDTH / 2 - index % SIDE, y - HEIGHT / 2)
        rgb = np.dstack([rgb, np.clip(opacity, 0, 255)])
    return rgb.astype(np.uint8)


def write_capture(folder, field):
    small_field.SIDE = SIDE
    keys = {}
    if field == "alpha":
        keys = {"lf_alpha": "straight", "lf_background": [0.1, 0.3, 0.2]}
    if field in ("opacity", "depths"):
        keys = {"lf_alpha": "straight", "lf_background": "none"}
    if field == "falloff":
        keys = {"lf_vignetting": [-0.3, 0.05, -0.1]}
    if "mosaic" in field:
        keys = {"lf_bayer": "RGGB", "lf_transfer": "linear", "lf_black_level": 100,
                "lf_white_level": 52000, "lf_white_balance": [2, 1, 1.5],
                "camera_model": "OPENCV", "k1": 0.03, "k2": -0.01, "p1": 0.001, "p2": 0.0}
    calibration = small_field.write_field(folder, functools.partial(picture_of, field), **keys)
    if is_flawed(field) or field == "alpha":
        add_flaws(field, calibration)
    return calibration


def is_flawed(field):
    """Returns True if a light field has broken and missing files."""
    return "flawed" in field or field == "heights"


def write_pfm(file, values):
    height, width = values.shape
    file.write_bytes(f"Pf\n{width} {height}\n-1\n".encode() + values[::-1].astype("<f4").tobytes())


def write_surfaces(folder, field):
    """Writes the pictures that SURFACES names. They have steps, waves and unknown places."""
    if field == "depths":
        for frame, number in enumerate(frames_of(field), 1):
            y, x = np.mgrid[0:120, 0:160]
            depths = 1.1 + 0.3 * np.sin(x / 25 + frame) * np.cos(y / 31) - np.where(x > 60 + 5 * frame, 0.4, 0)
            depths[40:50, 100:120] = np.inf
            write_pfm(folder / f"depth_{number}.pfm", depths)
    if field == "heights":
        y, x = np.mgrid[0:21, 0:25]
        heights = 0.25 * np.sin(x / 3) * np.cos(y / 2)
        heights[8:10, 12] = -9
        write_pfm(folder / "heights.pfm", heights)


def add_masks(folder, frames):
    for number, index in enumerate(MASKED):
        mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
        mask[:, number * WIDTH // 2:(number + 1) * WIDTH // 2] = 0
        Image.fromarray(mask).save(folder / f"mask_{number}.png")
        frames[index]["lf_mask"] = f"mask_{number}.png"
    frames[BRIGHTER]["lf_gain"] = 1.25


def add_flaws(field, calibration):
    folder, text = calibration.parent, json.loads(calibration.read_text())
    add_masks(folder, text["frames"])
    if is_flawed(field):
        (folder / text["frames"][BROKEN]["file_path"]).write_text("no picture")
        (folder / text["frames"][MISSING]["file_path"]).unlink()
    calibration.write_text(json.dumps(text))


class World:
    """All inputs from which cells are rendered, in one folder.

    programs  the folder of lfrenderer and the other programs
    """

    def __init__(self, programs, folder):
        self.programs, self.folder = pathlib.Path(programs), pathlib.Path(folder)
        self.lock, self.locks, self.made = threading.Lock(), {}, {}
        self.count = 0

    def program(self, name):
        return str(self.programs / name)

    def new_folder(self, name):
        with self.lock:
            self.count += 1
            folder = self.folder / f"{self.count:05d} {name}"
        folder.mkdir(parents=True)
        return folder

    def make(self, program, *words):
        """Runs a program that may leave out broken LF images."""
        exit_code, last = run([self.program(program), *words, "--progress", "none"])
        if exit_code not in (0, 6):
            raise ProgramFailed(program, exit_code, last)

    @once
    def knows(self, program, option):
        """Returns True if a program has an option."""
        done = subprocess.run([self.program(program), "--help-all"], capture_output=True, text=True)
        return option in done.stdout

    @once
    def folder_of(self, field):
        return write_capture(self.new_folder(field) / "capture", field).parent

    @staticmethod
    def name_of(index):
        return f"image_{index:02d}.png"

    @once
    def path_of(self, field):
        has_pinhole = field in ("rgb", "flawed mosaic")
        path = self.folder_of(field).parent / "path.yaml"
        write_surfaces(path.parent, field)
        clock, camera, lens = SHAPES.get(field, ("", "", ""))
        if field in FIRST_FRAMES:
            clock += f"\nfirst_frame: {FIRST_FRAMES[field]}"
        path.write_text(PATH_YAML.format(frames=FRAMES, first=0 if has_pinhole else 0.012,
                                         last=0.015 if has_pinhole else 0.02, clock=clock, camera=camera,
                                         lens=lens, focus=SURFACES.get(field, "")))
        return path

    @once
    def packages(self, field, source, mode, order):
        """Returns the packages of a film.

        source  a value of the axis input
        mode    a value of the axis mode, or "default"
        order   options of lfpreprocessor, a tuple
        """
        folder = self.new_folder(f"packages of {field} {source} {mode}")
        self.make("lfpreprocessor", self.input(field, source, mode), self.path_of(field), "-o", folder,
                  "--packages", PACKAGES, *order, *self.package_options(mode))
        files = tuple(sorted(folder.glob("*.lfp")))
        if len(files) != PACKAGES:
            raise ValueError(f"{folder}: {len(files)} packages, expected {PACKAGES}")
        return files

    def package_options(self, mode):
        """Returns the options of a mode on which packages depend."""
        if mode == "unguarded":
            return MODES[mode]
        options = MODES[mode] if mode != "default" else []
        return [word for name, value in zip(options[::2], options[1::2]) for word in (name, value)
                if name in ("--estimator", "--lens-weights") or
                (name in ("--mode", "--interpolation") and self.knows("lfpreprocessor", name))]

    @once
    def places_of(self, field):
        """Returns the place in the order of each LF image that a frame may use, by name."""
        places = {}
        for file in self.packages(field, "folder", "default", ()):
            with contextlib.closing(
                    sqlite3.connect(f"file:{file}?immutable=1", uri=True)) as package:
                places.update(package.execute("select name, rank from lf_images"))
        return places

    def input(self, field, source, mode):
        """Returns the argument LIGHTFIELD. A store of packages is made from packages for this mode."""
        if source == "folder":
            return self.folder_of(field)
        return self.store(field, source, mode if is_of_packages(source) else "any")

    @once
    def store(self, field, source, mode):
        store = self.new_folder(f"{source} of {field}") / "a.lfs"
        if source == "densified store":
            self.make("lfdensify", self.folder_of(field), "-o", store, *DENSIFY)
            return store
        if is_of_packages(source):
            words = [*self.packages(field, "folder", mode, ())]
            words += ["--needed-pixels"] if "needed" in source else []
        else:
            words = [self.folder_of(field)]
        return self.encode(words, source, store)

    def encode(self, words, source, store):
        """Makes a packed store of a kind of INPUTS from the inputs `words` of lfcompressor, and returns its path."""
        words = [*words]
        profile = {"lossy": "default", "recorded": "recorded", "group": "group-lossless"}.get(
            source.split()[0], "lossless")
        if source in ("store by resolution", "coarser store"):
            words.append("--by-resolution")
        if source in ("store by resolution", "coarser store") or "lossy" in source:
            words += ["--entropy", "contexts"]
        self.make("lfcompressor", *words, "-o", store, "--profile", profile)
        if source == "coarser store":
            # The store of masked LF images alone has one file, which has all their pixels.
            store.with_name("a-r3.lfs").unlink(missing_ok=True)
        return store


def packaged_input(source):
    """Returns the input from which packages are made that take their LF images from another one."""
    return source if source in ("densified store", "coarser store") else "folder"


def is_of_packages(source):
    """Returns True if an input is a packed store that contains only what packages need."""
    return "packages" in source or "needed" in source
