#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests calibrations, camera paths, images and masks made to do harm, and things that are no files: pipes, devices,
loops of links. Programs must keep to the limits of memory and time and report one error.

usage: hostile_files_test.py LFRENDERER LFIMPORT LFEXAMPLE LFPREPROCESSOR LFPATH
"""
import functools
import json
import os
import pathlib
import shutil
import struct
import sys
import tempfile
import unittest
import zlib

import numpy as np

from bounded_runs import BoundedRuns
from small_field import PATH_YAML, HEIGHT, WIDTH, wall, write_field, write_path

PROGRAMS = []
MEMORY_MIB = 128  # a good run takes 30
FRAME = {"file_path": "image_00.png", "transform_matrix": np.eye(4).tolist()}


# Images

def chunk(kind, data, length=None):
    return struct.pack(">I", len(data) if length is None else length) + kind + data + struct.pack(
        ">I", zlib.crc32(kind + data))


def png(width, height, chunks=b"", data=b"", depth=8, colour=2):
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0))
            + chunks + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


@functools.cache
def zeros_compressed(count):
    """Returns `count` zeros compressed by zlib, without allocating them."""
    compressor = zlib.compressobj(9)
    part = bytes(1 << 20)
    return b"".join(compressor.compress(part) for _ in range(count >> 20)) + compressor.flush()


def exr(width, height, channels=b"", lines=b""):
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    box = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    channels = channels or b"".join(name + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for name in (b"B", b"G", b"R"))
    return (struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels + b"\0")
            + attribute(b"compression", b"compression", b"\3") + attribute(b"dataWindow", b"box2i", box)
            + attribute(b"displayWindow", b"box2i", box) + attribute(b"lineOrder", b"lineOrder", b"\0")
            + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", bytes(8))
            + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0" + lines)


def tiff(width, height, rows_per_strip, offset, count, bits=8, kind=4):
    entries = [(256, kind, 1, width), (257, kind, 1, height), (258, 3, 1, bits), (259, 3, 1, 1), (262, 3, 1, 1),
               (273, 4, 1, offset), (277, 3, 1, 1), (278, 4, 1, rows_per_strip), (279, 4, 1, count)]
    return (b"II*\0" + struct.pack("<IH", 8, len(entries))
            + b"".join(struct.pack("<HHII", *entry) for entry in entries) + struct.pack("<I", 8))


def jpeg(width, height):
    return (b"\xff\xd8\xff\xc2\0\x11\x08" + struct.pack(">HH", height, width) + b"\3\1\x22\0\2\x11\1\3\x11\1"
            + b"\xff\xda\0\x0c\3\1\0\2\x11\3\x11\0\x3f\0" + bytes(1000))


def images():
    """Yields (name, suffix, bytes) of images whose content contradicts their header."""
    yield "a PNG of 30000 x 30000", ".png", png(30000, 30000)
    yield "a PNG of 2^31 x 2^31", ".png", png(2**31 - 1, 2**31 - 1)
    yield "a PNG without pixels", ".png", png(WIDTH, HEIGHT)
    yield "a PNG of 0 x 0", ".png", png(0, 0)
    yield "a PNG whose pixels are a gigabyte", ".png", png(WIDTH, HEIGHT)[:33] + chunk(
        b"IDAT", zeros_compressed(1 << 30)) + chunk(b"IEND", b"")
    yield "a PNG with a text of a gigabyte", ".png", png(
        WIDTH, HEIGHT, chunk(b"zTXt", b"Comment\0\0" + zeros_compressed(1 << 30)), bytes(HEIGHT * (1 + 3 * WIDTH)))
    yield "a PNG with a profile of a gigabyte", ".png", png(
        WIDTH, HEIGHT, chunk(b"iCCP", b"icc\0\0" + zeros_compressed(1 << 30)), bytes(HEIGHT * (1 + 3 * WIDTH)))
    yield "a PNG with a chunk of 2 GiB", ".png", png(WIDTH, HEIGHT, chunk(b"tEXt", b"a\0b", 2**31 - 1))
    yield "an EXR of 2^31 x 2^31", ".exr", exr(2**31 - 1, 2**31 - 1)
    yield "an EXR of 60000 x 60000", ".exr", exr(60000, 60000)
    yield "an EXR without lines", ".exr", exr(WIDTH, HEIGHT)
    yield "an EXR with offsets beyond its end", ".exr", exr(WIDTH, HEIGHT, lines=b"\xff\xff\xff\x7f\0\0\0\0" * HEIGHT)
    yield "an EXR with a thousand channels", ".exr", exr(
        WIDTH, HEIGHT, b"".join(b"c%04d\0" % i + struct.pack("<iiii", 1, 0, 1, 1) for i in range(1000)))
    yield "a TIFF of 2^31 x 2^31", ".tif", tiff(2**31 - 1, 2**31 - 1, 2**31 - 1, 8, 2**31 - 1)
    yield "a TIFF whose strip is beyond its end", ".tif", tiff(WIDTH, HEIGHT, HEIGHT, 2**31, WIDTH * HEIGHT)
    yield "a TIFF whose directories are a ring", ".tif", tiff(WIDTH, HEIGHT, HEIGHT, 8, 100)
    yield "a JPEG of 65535 x 65535", ".jpg", jpeg(65535, 65535)
    yield "a JPEG without its pixels", ".jpg", jpeg(WIDTH, HEIGHT)
    yield "an empty file", ".png", b""
    yield "zeros", ".png", bytes(1 << 20)
    yield "a shell script", ".png", b"#!/bin/sh\ntouch owned\n"


# Things that are no files

def no_files():
    """Yields (name, make(path)) of things in place of a file."""
    yield "a pipe", os.mkfifo
    yield "a folder", os.mkdir
    yield "a link to itself", lambda path: os.symlink(path.name, path)
    yield "a link to nothing", lambda path: os.symlink("nothing", path)
    for device in ("zero", "null", "full", "tty", "stdin"):
        yield f"a link to /dev/{device}", lambda path, device=device: os.symlink(f"/dev/{device}", path)
    yield "a link to endless memory", lambda path: os.symlink("/proc/self/mem", path)


# Texts

def calibrations():
    """Yields (name, text) of transforms.json."""
    good = {"fl_x": 70, "w": WIDTH, "h": HEIGHT, "frames": [FRAME]}

    def changed(**keys):
        return json.dumps({**good, **keys})

    def framed(**keys):
        return json.dumps({**good, "frames": [{**FRAME, **keys}]})
    yield "brackets, a million deep", "[" * 1_000_000
    yield "objects, a hundred thousand deep", '{"a":' * 100_000
    yield "a number of a million digits", changed().replace("70", "7" * 1_000_000)
    yield "an exponent of a million", changed().replace("70", "7e1000000")
    yield "a name of ten million letters", framed(file_path="a" * 10_000_000)
    yield "a million frames of one name", json.dumps(good)[:-2] + (", " + json.dumps(FRAME)) * 100_000 + "]}"
    yield "frames that are no list", changed(frames={"a": 1})
    yield "frames that are numbers", changed(frames=[1, 2, 3])
    for size in (0, -1, 2**31, 1e300, "64", None, [64]):
        yield f"a width of {size}", changed(w=size)
    for focal in (0, -70, 1e-300, 1e300, "NaN"):
        yield f"a focal length of {focal}", changed(fl_x=focal)
    for entry in (1e300, 1e155, -1e300, None, "x"):
        yield f"a pose of {entry}", framed(transform_matrix=[[entry] * 4] * 4)
    yield "a pose of three million rows", framed(transform_matrix=[[1, 0, 0, 0]] * 300_000)
    for name in ("", ".", "/", "..", "../" * 10_000, "/dev/zero", "/dev/stdin", "/proc/self/mem", "a\0b", "\ud800",
                 "a\nerror: b", "http://127.0.0.1/a.png", "x.png%s%n"):
        yield f"an image named {name[:20]!r}", framed(file_path=name)
    for key in ("lf_mask", "lf_gain", "lf_alpha", "lf_clipped", "lf_vignetting", "lf_max_radiance", "lf_background",
                "lf_transfer", "camera_model", "k1", "aabb_scale", "applied_transform", "ply_file_path"):
        for value in (None, -1, 1e300, "x" * 100_000, [1e300] * 5, {"a": {}}):
            yield f"{key} of {str(value)[:12]}", changed(**{key: value})
    yield "keys twice", '{"w": 64, ' + changed()[1:]
    yield "a byte that is no UTF-8", changed().replace("image_00", "image_\udcff")
    yield "nothing", ""
    yield "a byte order mark alone", "\ufeff"


def paths():
    """Yields (name, text) of PATH.yaml."""
    good = PATH_YAML.format(frames=1, aperture=0.045, x=0)
    yield "aliases that grow to 10^9", "a0: &a0 [x,x,x,x,x,x,x,x,x,x]\n" + "".join(
        f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 9)) + good
    yield "keyframes that are such aliases", good.replace("keyframes:", "b: &b0 [0,0,0,0,0,0,0,0,0,0]\n" + "".join(
        f"b{i}: &b{i} [{','.join([f'*b{i - 1}'] * 10)}]\n" for i in range(1, 9)) + "keyframes:\n  position: *b8")
    yield "brackets, a hundred thousand deep", good + "x: " + "[" * 100_000
    yield "maps, ten thousand deep", good + "x: " + "{a: " * 10_000
    yield "indents, ten thousand deep", good + "".join(" " * i + "a:\n" for i in range(10_000))
    for frames in (0, -1, 2**31, 10**12, 1e300, "x"):
        yield f"{frames} frames", good.replace("frames: 1", f"frames: {frames}")
    for size in ("[0, 0]", "[-1, 5]", "[1000000, 1000000]", "[2147483647, 2147483647]", "[80]", "80"):
        yield f"a resolution of {size}", good.replace("[80, 60]", size)
    for number in ("0", "-1", "1e300", ".nan", ".inf", "1e-300", "x"):
        yield f"an aperture of {number}", good.replace("0.045", number)
        yield f"a focus distance of {number}", good.replace("focus_distance: 0.8", f"focus_distance: {number}")
        yield f"a position at {number}", good.replace("position: [0, 0, 0]", f"position: [{number}, 0, 0]")
        yield f"a focal length of {number}", good.replace("focal_length_mm: 35", f"focal_length_mm: {number}")
        yield f"keyframes at {number} s", good.replace("{time: 0,", "{time: %s," % number)
    yield "a hundred thousand keyframes", good.replace("{time: 1, value: 2}", ", ".join(
        f"{{time: {1 + i}, value: 2}}" for i in range(20_000)))
    yield "a key of a million letters", good + "k" * 1_000_000 + ": 1\n"
    yield "a tag", good + "x: !!python/object/apply:os.system ['touch owned']\n"
    yield "a NUL", good.replace("frames", "fra\0mes")
    yield "nothing", ""


POSE = np.eye(4).ravel().tolist()
NUMBERS = (0, -1, 1e300, -1e300, 1e-300, float("nan"), float("inf"), "x", None, [1], {}, True, 2**64)


def foreign_paths():
    """Yields (name, file name, text) of camera paths of other programs."""
    studio = {"camera_type": "perspective", "render_width": 80, "render_height": 60, "fps": 25, "seconds": 1,
              "camera_path": [{"camera_to_world": POSE, "fov": 50}] * 2}
    ngp = {"path": [{"R": [0, 0, 0, 1], "T": [0.5, 0.5, 0.5], "slice": 0, "scale": 1.5, "fov": 50,
                     "aperture_size": 0.01, "timestamp": time} for time in (1, 2)], "duration_seconds": 1}
    splat = [{"id": 0, "img_name": "a", "width": 80, "height": 60, "fx": 70, "fy": 70, "position": [0, 0, 0],
              "rotation": np.eye(3).tolist()}]
    for key in ("render_width", "render_height", "fps", "seconds", "camera_path"):
        for value in NUMBERS:
            yield f"{key} {value}"[:40], "n.json", json.dumps({**studio, key: value})
    for value in NUMBERS:
        yield f"fov {value}"[:40], "n.json", json.dumps(
            {**studio, "camera_path": [{"camera_to_world": POSE, "fov": value}]})
        yield f"a pose with {value}"[:40], "n.json", json.dumps(
            {**studio, "camera_path": [{"camera_to_world": [value, *POSE[1:]], "fov": 50}]})
        yield f"instant-ngp, duration {value}"[:40], "b.json", json.dumps({**ngp, "duration_seconds": value})
        yield f"instant-ngp, order {value}"[:40], "b.json", json.dumps({**ngp, "spline_order": value})
        for key in ("R", "T", "scale", "fov", "aperture_size", "timestamp"):
            wrong = value if key not in ("R", "T") else [value, *ngp["path"][0][key][1:]]
            yield f"instant-ngp, {key} {value}"[:40], "b.json", json.dumps(
                {**ngp, "path": [{**ngp["path"][0], key: wrong}]})
        for key in ("width", "height", "fx", "position", "rotation"):
            yield f"splats, {key} {value}"[:40], "cameras.json", json.dumps([{**splat[0], key: value}])
    yield "half an hour of instant-ngp", "b.json", json.dumps({**ngp, "duration_seconds": 1800})
    yield "40,000 frames of nerfstudio", "n.json", json.dumps({**studio, "camera_path": studio["camera_path"] * 20_000})
    yield "a curve of 30,000 keys", "b.json", json.dumps({**ngp, "path": ngp["path"] * 15_000})
    yield "brackets, a million deep", "n.json", '{"camera_path": ' + "[" * 1_000_000
    yield "maps, a million deep", "b.json", '{"path": [' + '{"a": ' * 1_000_000
    yield "keys twice", "n.json", '{"camera_path": [], ' + json.dumps(studio)[1:]
    yield "a key of ten million letters", "n.json", json.dumps({**studio, "k" * 10_000_000: 1})
    line = "{} 0 0 0 0 0 0 50\n"
    yield "50,000 lines of a .chan", "c.chan", "".join(line.format(i) for i in range(1, 50_001))
    yield "a line of ten million blanks", "c.chan", "1" + " " * 10_000_000 + line.format("")[1:]
    yield "a line of a million columns", "c.chan", "1 " * 1_000_000
    yield "a number of a million digits", "c.chan", line.format("1" * 1_000_000)
    yield "a comment of ten million letters", "c.chan", "#" * 10_000_000 + "\n" + line.format(1)
    for number in ("1e18", "-5", "1.5", "nan", "inf", "0x10", "1e400", "\0"):
        yield f"a frame number {number!r}", "c.chan", line.format(number)
        yield f"a position {number!r}", "c.chan", line.format(1).replace(" 0", f" {number}", 1)
        yield f"a field of view {number!r}", "c.chan", line.format(1).replace("50", number)
    yield "a byte order mark", "c.chan", "\ufeff" + line.format(1)
    yield "bytes that are no UTF-8", "n.json", json.dumps(studio).replace("perspective", "\udcff")


class HostileFilesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.field = write_field(cls.folder / "field", wall)
        cls.path = write_path(cls.folder, frames=1)
        cls.runs = BoundedRuns(cls.folder, MEMORY_MIB)
        cls.number = 0

    @classmethod
    def tearDownClass(cls):
        print(cls.runs.table(), file=sys.stderr)

    def tearDown(self):
        faults, self.runs.faults[:] = list(self.runs.faults), []
        self.assertEqual([], faults, "\n".join(faults))
        self.assertFalse(list(self.folder.rglob("owned")))

    def new_folder(self):
        type(self).number += 1
        folder = self.folder / str(self.number)
        folder.mkdir()
        return folder

    def render(self, name, field, path):
        out = self.new_folder() / "out"
        return name, [PROGRAMS[0], field, path, "-o", out, "--no-contact-sheet", "--memory", "256M"]

    def field_with(self, file_name, make, key="file_path"):
        """Returns a light field in which an image, or its mask, was made by make(path)."""
        folder = self.new_folder() / "field"
        shutil.copytree(self.field.parent, folder)
        content = json.loads((folder / "transforms.json").read_text())
        make(folder / file_name)
        content["frames"][12][key] = file_name
        (folder / "transforms.json").write_text(json.dumps(content))
        return folder

    def whole_field_of(self, file_name, make):
        """Returns a light field that states no image size and has only this image, so that programs must read the image
        to find its size."""
        folder = self.new_folder() / "field"
        folder.mkdir()
        make(folder / file_name)
        (folder / "transforms.json").write_text(json.dumps(
            {"camera_angle_x": 0.8, "frames": [{**FRAME, "file_path": file_name}]}))
        return folder

    def test_images(self):
        calls, masks, sizes = [], [], []
        for name, suffix, data in images():
            def write(path, data=data):
                path.write_bytes(data)
            calls.append(self.render(name, self.field_with("odd" + suffix, write), self.path))
            masks.append(self.render(name, self.field_with("odd" + suffix, write, "lf_mask"), self.path))
            sizes.append((name, [PROGRAMS[1], self.whole_field_of("odd" + suffix, write)]))
        # One of 25 images is left out and reported as broken; superfluous texts, profiles and pixels are ignored.
        self.runs.all("images", calls, accepts=(0, 6))
        self.runs.all("masks", masks, accepts=(0, 6))
        self.runs.all("sizes of images", sizes, accepts=(0, 2, 3, 6))

    def test_what_is_no_file(self):
        calls, masks, fields, paths_of = [], [], [], []
        for name, make in no_files():
            calls.append(self.render(name, self.field_with("odd.png", make), self.path))
            masks.append(self.render(name, self.field_with("odd.png", make, "lf_mask"), self.path))
            folder = self.new_folder()
            make(folder / "transforms.json")
            make(folder / "path.yaml")
            fields.append((name, [PROGRAMS[1], folder / "transforms.json"]))
            paths_of.append(self.render(name, self.field, folder / "path.yaml"))
        self.runs.all("images that are no files", calls, accepts=(6,))
        self.runs.all("masks that are no files", masks, accepts=(6,))
        self.runs.all("calibrations that are no files", fields, accepts=(2, 3))
        self.runs.all("camera paths that are no files", paths_of, accepts=(2, 3))

    def test_calibrations(self):
        calls, imports = [], []
        for name, text in calibrations():
            folder = self.new_folder()
            shutil.copyfile(self.field.parent / "image_00.png", folder / "image_00.png")
            (folder / "transforms.json").write_bytes(text.encode(errors="surrogateescape"))
            imports.append((name, [PROGRAMS[1], folder]))
            calls.append((name, [PROGRAMS[2], folder, "-o", folder / "path.yaml"]))
        self.runs.all("transforms.json, lfimport", imports, accepts=(0, 2, 3, 6))
        self.runs.all("transforms.json, lfexample", calls, accepts=(0, 2, 3, 6))

    def test_camera_paths(self):
        calls, plans = [], []
        for name, text in paths():
            folder = self.new_folder()
            (folder / "path.yaml").write_bytes(text.encode(errors="surrogateescape"))
            calls.append(self.render(name, self.field, folder / "path.yaml"))
            plans.append((name, [PROGRAMS[3], self.field, folder / "path.yaml", "--plan"]))
        self.runs.all("camera paths, lfrenderer", calls, accepts=(0, 2, 3))
        self.runs.all("camera paths, lfpreprocessor", plans, accepts=(0, 2, 3))

    def test_foreign_camera_paths(self):
        calls = []
        for name, file_name, text in foreign_paths():
            folder = self.new_folder()
            (folder / file_name).write_bytes(text.encode(errors="surrogateescape"))
            calls.append((name, [PROGRAMS[4], folder / file_name, "-o", folder / "out" / "path.json"]))
            (folder / "out").mkdir()
        self.runs.all("foreign camera paths, lfpath", calls, accepts=(0, 2, 3))


if __name__ == "__main__":
    PROGRAMS = sys.argv[1:6]
    unittest.main(argv=sys.argv[:1], verbosity=2)
