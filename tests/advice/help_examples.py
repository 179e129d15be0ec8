# SPDX-License-Identifier: Apache-2.0
"""Runs the examples of --help, as they are printed, on small files of the names that they use."""
import json
import pathlib
import re

import numpy as np
from PIL import Image

import small_field
from printed_commands import PROGRAMS, save_photograph

COMMANDS = ("stack", "depth", "sharp", "through", "epi", "views")
# Examples that are not run, each with the reason. A key is the beginning of the example.
NOT_RUN = {
    "lfsynth": "makes hundreds of large images; lfsynth_test.py makes few and small ones",
    "lfexample capture/transforms.json -o orbit.yaml --move orbit --camera 364": "needs 365 LF cameras",
    "lfsubmit packages/*.lfp -o film --engine slurm": "needs Slurm",
    "lfdensify capture/": "needs a sparse capture of things at several depths; lfdensify_test.py has it",
}
# Servers, which Ctrl-C ends.
SERVES = re.compile(r"lfvisualizer (?!.*(--export|--text))")
FRAMES = 100
WIDTH, HEIGHT = 330, 250


def examples_of(shell, folder):
    """Returns the examples of all programs and commands."""
    calls = list(PROGRAMS) + [f"lffocus {command}" for command in COMMANDS]
    found = []
    for call in calls:
        text = shell.must(f"{call} --help", folder).out
        block = re.search(r"^Examples:\n((?:  .*\n)+)", text, re.M)
        if not block:
            raise AssertionError(f"{call} --help: has no examples")
        found += [(call, re.sub(r"\s+#.*", "", line.strip())) for line in block[1].splitlines()]
    return found


def reason_not_to_run(example):
    return next((reason for begin, reason in NOT_RUN.items() if example.startswith(begin)), None)


def line_of(call, example):
    """Returns what bash runs: the example without what it is about to write, and with an end for servers."""
    lines = []
    for name in re.findall(r" -o (\S+)| --(?:write|export) (\S+)", example):
        output = "".join(name)
        # A render that is resumed, or merged shards, continue what is there.
        if not re.search(r"--resume|^lfmerge|cards/ -o cards|--calibration-only|--watch", example):
            lines.append(f"rm -rf {output}")
    if call == "lfquilt":
        lines.append("cp short.yaml path.yaml")
    if re.match("lffocus (depth|sharp)", example):
        lines.append("cp deep.yaml path.yaml")
    if SERVES.match(example):
        example = f"(trap - INT; exec {example}) & sleep 1; kill -INT $!; wait $!"
    return "; ".join([*lines, example])


def make_world(folder: pathlib.Path, shell):
    """Makes the files that the examples read."""
    folder.mkdir()
    before = small_field.WIDTH, small_field.HEIGHT, small_field.WALL_DEPTH
    small_field.WIDTH, small_field.HEIGHT, small_field.WALL_DEPTH = WIDTH, HEIGHT, 0.5
    try:
        calibration = small_field.write_field(folder / "capture", small_field.wall)
    finally:
        small_field.WIDTH, small_field.HEIGHT, small_field.WALL_DEPTH = before
    field = json.loads(calibration.read_text())
    names = ["IMG_0100.jpg", "IMG_0377.jpg"] + [f"image_{i:04d}.png" for i in range(2, 25)]
    for frame, name in zip(field["frames"], names):
        image = Image.open(folder / "capture" / frame["file_path"])
        (folder / "capture" / frame["file_path"]).unlink()
        image.save(folder / "capture" / name)
        frame["file_path"] = name
    calibration.write_text(json.dumps(field))
    (folder / "bad.txt").write_text("IMG_0377.jpg\n")
    (folder / "upright.txt").write_text("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
    path = small_field.write_path(folder, frames=FRAMES).read_text().replace("[80, 60]", "[8, 6]")
    (folder / "path.yaml").write_text(path)
    (folder / "short.yaml").write_text(path.replace(f"frames: {FRAMES}", "frames: 2"))
    (folder / "deep.yaml").write_text(path.replace(f"frames: {FRAMES}", "frames: 12").replace("[8, 6]", "[64, 48]"))
    (folder / "cards").mkdir()
    for row in range(2):
        for column in range(3):
            Image.fromarray(small_field.wall(5 * row + column)).save(folder / "cards" / f"c_{row:02d}_{column:02d}.png")
    (folder / "brackets").mkdir()
    frames = []
    for i in range(4):
        for stop, time_s in enumerate((0.01, 0.04)):
            name = f"b{i}_{stop}.jpg"
            save_photograph(np.minimum(small_field.wall(i).astype(int) * 4 ** stop, 255).astype(np.uint8),
                            folder / "brackets" / name, time_s)
            frames.append(dict(field["frames"][i], file_path=name))
    small = {"fl_x": 70, "fl_y": 70, "cx": 32, "cy": 24, "w": 64, "h": 48, "frames": frames}
    (folder / "brackets" / "transforms.json").write_text(json.dumps(small))
    for line in SETUP:
        shell.must(line, folder)


SETUP = [
    "cp -r capture handheld",
    "lfsynth lights -o mosaics --bayer --count 9 --size 48x32 -q",
    "lfpath path.yaml -o camera_path.json --format nerfstudio -q && lfpath path.yaml -o nuke.chan -q",
    "lfpreprocessor capture path.yaml -o packages --packages 2 -q",
    "lfcompressor capture -o capture.lfs -q && lfcompressor packages/*.lfp -o film.lfs -q",
    "cp capture.lfs dense.lfs",  # any store, because its content does not matter
    "lfrenderer capture path.yaml -o frames -q --frames 1-3 --keep-plates --format exr",
    "for k in 1 2 3; do lfrenderer capture path.yaml -o frames --frames 7 --shard $k/3 -q; done",
    "for k in 1 2; do lfrenderer capture path.yaml -o $(echo xab | cut -c$((k+1))) --frames 7 --shard $k/2 -q; done",
    "cp -r frames reference && cp frames/frame_0001.exr . && cp frames/frame_0001.exr truth.exr",
    "lfpath short.yaml -o views.yaml --quilt 8x6 -q && lfrenderer capture views.yaml -o views -q",
    "lfpath short.yaml -o stereo.yaml --stereo-mm 6 -q && lfrenderer capture stereo.yaml -o stereo -q",
    "cp capture/IMG_0377.jpg photo.jpg && cp capture/image_0002.png frame.png",
    "lffocus depth capture deep.yaml -o depth.exr --near 0.4 --far 0.6 --planes 4 --confidence 0 -q",
    "lfsubmit packages/*.lfp -o film -q",
]
