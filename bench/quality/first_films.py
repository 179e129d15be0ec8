#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Goes from folders of captures to a first picture and to a film of each move, as a newcomer would: with the commands
that the programs print, and without editing a file. Writes a sheet of what came out.

usage: bench/quality/first_films.py BIN -o FOLDER [--data DIR] [--only NAME]... [--sheet-only]

BIN           the folder of the programs, such as build/release/bin
-o FOLDER     gets results.json, some frames of each film, drawn.jpg with the captures that are drawn here, and
              all.png with those of DIR as well
--data DIR    the folder that holds data/ and cases/ (LF_TEST_DATA, else ../shared); left out if it does not exist
--only NAME   only captures whose name contains NAME; the others keep the results that they have
--sheet-only  draws the sheets again, of what FOLDER holds

doc/images/first_films.jpg is drawn.jpg, and doc/inputs.md says what all captures show. They are copied or drawn before
time is measured. The exit code is 1 if a command failed without a reason, or if a capture drawn here was not filmed.
"""
import argparse
import dataclasses
import itertools
import json
import os
import pathlib
import re
import shlex
import shutil
import sys
import tempfile
import time

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests"))
import run_test

run_test.add_rooms()

from judgements import focus, scenes
from printed_commands import COMMAND

MOVES = ("focus-pull", "along", "orbit", "dolly")
CASES = ("02", "03", "05", "06", "07", "10", "11", "12", "13", "17", "18")
SHOWN = (0, 0.5, 1)  # the frames of each film on the sheet, as shares of it
SHOWN_OF_ORBIT = (0, 0.25, 0.5)  # it ends as it begins
MOST_ADVICE = 3  # printed commands that are followed before the first picture
CELL_PX = 14  # size of the details of what is drawn, in LF pixels
COLOURS = np.array([[1.3, 0.85, 0.5], [0.55, 0.85, 1.2], [0.7, 1.2, 0.6], [1.2, 0.7, 0.9], [1.2, 1.1, 0.5]])
TILE, LABEL_WIDTH, FONT = (150, 112), 190, "DejaVuSans.ttf"


# Captures

def synth(*options):
    """Returns a maker of a capture that lfsynth photographs."""
    def make(folder, programs):
        words = shlex.join([str(programs / "lfsynth"), *options, "--format", "png", "-q", "-o", str(folder)])
        if os.system(words) != 0:
            raise RuntimeError(f"failed: {words}")
    return make


def drawn(kind, is_cut_out=False):
    """Returns a maker of a capture of tests/judgements/focus.py, larger than there, in colours, and with coarser
    textures, so that people see what is sharp.

    is_cut_out  the images have alpha, as turntables cut objects out
    """
    def make(folder, _):
        cameras, quads, _ = kind(np.random.default_rng(2))
        for quad in quads:
            quad.cell = CELL_PX / scenes.FOCAL_PX * abs(quad.middle[2])
        scenes.draw(folder, cameras, quads, seed=2)
        for number, camera in enumerate(cameras):
            file = folder / f"{number:03d}.png"
            paint(file, [share_of(quad, camera, quads) for quad in quads], is_cut_out)
    return make


def share_of(quad, camera, quads):
    """Returns the share of a quad in each pixel, from 0 to 1."""
    flat = [dataclasses.replace(one, grey=float(one is quad), contrast=0) for one in quads]
    texture = np.full((scenes.TEXTURE_SIDE, scenes.TEXTURE_SIDE), 0.5, np.float32)
    return scenes.photograph(*camera, flat, [texture] * len(quads)) / 255


def paint(file, shares, is_cut_out):
    """Gives each quad of a grey image its colour."""
    light = np.asarray(Image.open(file), float)[..., :3]
    opacity = sum(shares)
    tint = sum(share[..., None] * colour for share, colour in zip(shares, itertools.cycle(COLOURS)))
    pixels = light * tint / np.maximum(opacity, 1e-3)[..., None]
    if is_cut_out:
        pixels /= np.maximum(opacity, 1e-3)[..., None]
        pixels[opacity == 0] = 0
        pixels = np.concatenate([pixels, 255 * opacity[..., None]], -1)
    Image.fromarray(np.clip(pixels, 0, 255).round().astype(np.uint8)).save(file)


DRAWN = {
    "grid 17 x 17": synth("still-life", "--size", "480x320"),
    "grid 5 x 5": synth("still-life", "--size", "480x320", "--count", "25", "--spacing", "0.02"),
    "grid 3 x 3": synth("still-life", "--size", "480x320", "--count", "9", "--spacing", "0.01"),
    "grid, axes meet behind": drawn(focus.meeting_behind),
    "arc": drawn(focus.arc_with_object_before_the_meeting),
    "dome": drawn(focus.dense_dome),
    "track": drawn(focus.video_track),
    "survey": drawn(focus.drone_survey),
    "turntable, cut out": drawn(focus.turntable, is_cut_out=True),
    "hemisphere, cut out": synth("chart", "--capture", "hemisphere", "--alpha", "straight", "--size", "480x320"),
}


def copy_of(source):
    def make(folder, _):
        shutil.copytree(source, folder, copy_function=shutil.copyfile)
        for at in [folder, *folder.rglob("*/")]:
            at.chmod(0o755)
    return make


def given(data):
    """Returns the captures of a folder: name -> maker."""
    folders = sorted((data / "data").glob("*/"))
    for number in CASES:
        folders += sorted((data / "cases").glob(f"{number}-*"))
    return {folder.name: copy_of(folder) for folder in folders}


# Commands

class Commands:
    """Runs commands in a folder, as they are typed there."""

    def __init__(self, programs, folder):
        self.folder = folder
        self.environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", CI="true")
        self.ran = []  # of each command: its line, exit code, elapsed and CPU seconds, and its last line

    def run(self, line):
        """Runs a line. Returns (exit code, what was printed)."""
        log = self.folder / "log.txt"
        start = time.monotonic()
        child = os.posix_spawn("/bin/bash", ["bash", "-c", line], self.environment | {"PWD": str(self.folder)},
                               file_actions=[(os.POSIX_SPAWN_OPEN, 1, str(log), os.O_WRONLY | os.O_CREAT | os.O_TRUNC,
                                              0o644), (os.POSIX_SPAWN_DUP2, 1, 2)])
        _, status, used = os.wait4(child, 0)
        text = log.read_text(errors="replace")
        code = os.waitstatus_to_exitcode(status)
        lines = text.strip().splitlines() or [""]
        self.ran.append({"line": line, "code": code, "elapsed_s": time.monotonic() - start,
                         "cpu_s": used.ru_utime + used.ru_stime, "last": lines[-1],
                         "said": [one for one in lines if re.match(r"error|warning|note", one)]})
        return code, text

    def seconds(self, first=0):
        """Returns the elapsed and CPU seconds of the commands since a number."""
        return [sum(one[key] for one in self.ran[first:]) for key in ("elapsed_s", "cpu_s")]


def understand(commands, name):
    """Calls lfimport, and follows the commands of lfimport that it prints until it understands the capture. Returns
    the folder to film, or None."""
    line = shlex.join(["lfimport", name])
    for _ in range(MOST_ADVICE):
        code, text = commands.run(line)
        words = shlex.split(line)
        if code in (0, 6):
            return words[words.index("-o") + 1] if "-o" in words else words[1]
        advice = [one for one in COMMAND.findall(text) if one.startswith("lfimport")]
        if not advice:
            return None
        line = advice[0]
    return None


def frames_of(folder, kept, shown):
    """Moves frames spread over a film to `kept`. Returns their names and the number of frames."""
    frames = sorted(folder.glob("frame_*.png"))
    names = []
    for at in sorted({round(share * (len(frames) - 1)) for share in shown} if frames else {}):
        kept.mkdir(parents=True, exist_ok=True)
        shutil.move(frames[at], kept / frames[at].name)
        names.append(frames[at].name)
    shutil.rmtree(folder, ignore_errors=True)
    return names, len(frames)


def film(commands, field, move, kept):
    """Writes the path of a move and renders it. Returns what came out."""
    first = len(commands.ran)
    options = "" if move == "auto" else f" --move {move}"
    code, text = commands.run(f"lfexample {shlex.quote(field)} -o {move}.yaml{options}")
    told = [one for one in text.strip().splitlines() if not one.startswith("next:")]
    result = {"told": told, "frames": [], "count": 0}
    if code == 0:
        code, text = commands.run(f"lfrenderer {shlex.quote(field)} {move}.yaml -o {move} --format png")
        result["rendered"] = text.strip().splitlines()[-3:]
        shown = SHOWN_OF_ORBIT if move == "orbit" else SHOWN
        result["frames"], result["count"] = frames_of(commands.folder / move, kept, shown)
        result["path"] = (commands.folder / f"{move}.yaml").read_text()
    else:
        result["refused"] = told[-1] if told else "without a word"
    result["code"] = code
    result["elapsed_s"], result["cpu_s"] = commands.seconds(first)
    return result


def try_capture(name, make, programs, kept):
    """Makes the capture in a temporary folder and films it. Returns the results."""
    shutil.rmtree(kept, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix="lf-first-films-") as scratch:
        os.chdir(scratch)
        folder = pathlib.Path(scratch)
        capture = re.sub(r"\W+", "-", name)
        make(folder / capture, programs)
        commands = Commands(programs, folder)
        field = understand(commands, capture)
        result = {"field": field, "moves": {}, "default": None}
        if field:
            result["picture"] = film(commands, field, "static", kept / "static")
            result["first_elapsed_s"], result["first_cpu_s"] = commands.seconds()
            for move in MOVES:
                result["moves"][move] = film(commands, field, move, kept / move)
            # The default repeats one of the moves: the path tells which.
            commands.run(f"lfexample {shlex.quote(field)} -o auto.yaml")
            auto = folder / "auto.yaml"
            result["default"] = next((move for move in MOVES if auto.exists() and
                                      result["moves"][move].get("path") == auto.read_text()), None)
        result["commands"] = commands.ran
        os.chdir(ROOT)
    return result


# The sheet

def tile_of(file):
    """Returns a frame in the size of a tile; what is transparent shows a light grey."""
    with Image.open(file) as picture:
        rgba = picture.convert("RGBA")
    ground = Image.new("RGBA", rgba.size, (190, 190, 190, 255))
    frame = Image.alpha_composite(ground, rgba).convert("RGB")
    frame.thumbnail((TILE[0] - 4, TILE[1] - 4), Image.LANCZOS)
    return frame


def wrapped(text, font, width):
    lines, line = [], ""
    for word in text.split():
        if line and font.getlength(f"{line} {word}") > width:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}".strip()
    return [*lines, line]


def font_of(size):
    """Returns the font and the height of its lines; a small font if DejaVu is not installed."""
    try:
        return ImageFont.truetype(FONT, size), size + 2
    except OSError:
        return ImageFont.load_default(), 12


def write_sheet(file, results, names, folder):
    """Draws a row for each capture: its name and seconds, the first picture, and three frames of each film."""
    font, small = font_of(13), font_of(10)
    columns = 1 + len(SHOWN) * len(MOVES)
    width, height, head = TILE[0], TILE[1], 22
    sheet = Image.new("RGB", (LABEL_WIDTH + columns * width, head + len(names) * height), "white")
    draw = ImageDraw.Draw(sheet)
    for number, title in enumerate(["first picture", *MOVES]):
        at = LABEL_WIDTH + width * (number and 1 + len(SHOWN) * (number - 1))
        draw.text((at + 4, 4), title, fill="black", font=font[0])

    def write(x, y, text, space, face=small, most=9):
        for line in wrapped(text, face[0], space - 8)[:most]:
            draw.text((x + 4, y), line, fill="black", font=face[0])
            y += face[1]
        return y

    for row, name in enumerate(names):
        result, top = results[name], head + row * height
        draw.line((0, top, sheet.width, top), fill=(200, 200, 200))
        y = write(0, top + 4, name, LABEL_WIDTH, font)
        if not result["field"]:
            write(LABEL_WIDTH, top + 4, result["commands"][-1]["last"], 6 * width)
            continue
        write(0, y, f"first picture: {result['first_cpu_s']:.1f} CPU s; default: {result['default']}", LABEL_WIDTH)
        for number, (move, made) in enumerate([("static", result["picture"]), *result["moves"].items()]):
            left = LABEL_WIDTH + width * (number and 1 + len(SHOWN) * (number - 1))
            shown = made["frames"][:1] if move == "static" else made["frames"]
            for at, frame in enumerate(shown):
                sheet.paste(tile_of(folder / slug_of(name) / move / frame), (left + at * width + 2, top + 3))
            if not shown:
                write(left, top + 4, made.get("refused") or made["rendered"][-1], (len(SHOWN) if number else 1) * width)
    quality = {"quality": 72} if file.suffix == ".jpg" else {}
    sheet.save(file, optimize=True, **quality)
    print(f"{file}: {file.stat().st_size / 1000:.0f} kB")


def slug_of(name):
    return re.sub(r"\W+", "-", name)


# Words

def table_of(results, names):
    """Returns Markdown rows: the capture, the commands up to its first picture, and the CPU seconds of the first
    picture and of each film, or where the film was refused."""
    rows = []
    for name in names:
        result = results[name]
        if not result["field"]:
            rows.append(f"| {name} | {len(result['commands'])} | none |" + " |" * len(MOVES))
            continue
        before = 1 + next(at for at, one in enumerate(result["commands"]) if one["line"].startswith("lfrenderer"))
        films = [f"{made['cpu_s']:.0f}" if made["count"] else "refused" for made in result["moves"].values()]
        rows.append(f"| {name} | {before} | {result['first_cpu_s']:.1f} | {' | '.join(films)} |")
    return rows


def faults_of(name, result):
    """Returns sentences about commands that failed without a reason, and about captures drawn here whose first picture
    or default film is missing."""
    faults = [f"{name}: {one['line']} ended with {one['code']}: {one['last']}" for one in result["commands"]
              if one["code"] not in (0, 6) and not (one["code"] == 3 and one["last"].startswith("error: "))]
    if name in DRAWN:
        if not (result["field"] and result["picture"]["frames"]):
            faults.append(f"{name}: has no first picture")
        if not (result["default"] and result["moves"][result["default"]]["frames"]):
            faults.append(f"{name}: has no film of the default move")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("LF_TEST_DATA", ROOT.parent / "shared"))
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--sheet-only", action="store_true")
    options = parser.parse_args()
    programs, folder, data = options.bin.resolve(), options.output.resolve(), options.data.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    scenes.WIDTH, scenes.HEIGHT, scenes.FOCAL_PX = 400, 300, 420
    captures = DRAWN | (given(data) if data.is_dir() else {})
    record = folder / "results.json"
    results = json.loads(record.read_text()) if record.exists() else {}
    for name, make in captures.items():
        if options.sheet_only or options.only and not any(part in name for part in options.only):
            continue
        results[name] = try_capture(name, make, programs, folder / slug_of(name))
        record.write_text(json.dumps(results, indent=1))
        print(table_of(results, [name])[0], flush=True)
    names = [name for name in captures if name in results]
    print("\n".join(table_of(results, names)))
    write_sheet(folder / "drawn.jpg", results, [name for name in names if name in DRAWN], folder)
    write_sheet(folder / "all.png", results, names, folder)
    faults = [fault for name in names for fault in faults_of(name, results[name])]
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults or not names else 0


if __name__ == "__main__":
    sys.exit(main())
