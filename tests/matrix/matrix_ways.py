# SPDX-License-Identifier: Apache-2.0
"""Renders a cell of the matrix (doc/matrix.md) and compares it with its plain render."""
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import time
from typing import NamedTuple

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy as np

from exr_file import read_header
from matrix_world import (BROKEN, FRAMES, MISSING, MODES, MOST_IMAGES, OF_FILES, Difference,
                          ProgramFailed, World, frames_of, is_flawed, is_of_packages, last_line, once,
                          packaged_input, run)

SHARDS = 2
LEAST_PSNR_DB = 38
# The least PSNR where decoded pixels decide which rays are used, so that a packed store may have others than the image
# files: noise rules may stop at another LF image, and rebinning may keep other rays. Two frames that each stop at a
# noise of 0.02 differ by 0.028, which is 31 dB below white, and fewer dB below the brightest element, which is darker.
LEAST_PSNR_OF_DRAWN_DB = 28
DUMP_OFTEN = ["--dump-every", "0.001s"]
RUNS = {  # options with which a run changes the content of the frames
    "once": [], "killed": [], "interrupted": [], "small": [], "finish": [],
    "samples": ["--stop-when", "samples>=1"],
    "noise": ["--stop-when", "noise<=0.02"],
    "noise killed": ["--stop-when", "noise<=0.02"],
    "max-images": ["--max-images", MOST_IMAGES],
    "round-robin": ["--order", "round-robin", "--max-images", MOST_IMAGES],
    "area": ["--order", "area", "--max-images", MOST_IMAGES],
    "groups": ["--order", "groups"],
}
INPUTS = ("folder", "store", "lossy store", "recorded store", "store by resolution", "coarser store",
          "group store", "store of packages", "lossy store of packages", "group store of packages", "needed pixels",
          "lossy needed pixels", "group needed pixels", "densified store")
CUTS = ("whole", "packages", "moved packages", "shards", "shards of packages", "lfsubmit")
FIELDS = ("rgb", "mosaic", "alpha", "opacity", "falloff", "shutter", "depths", "heights", "flawed", "flawed mosaic")
VALUES = {"field": FIELDS, "input": INPUTS, "cut": CUTS, "mode": tuple(MODES), "run": tuple(RUNS)}


class Step(NamedTuple):
    words: list   # command line of a program
    resume: list  # the call that resumes after an interruption


class Rendered(NamedTuple):
    exit_code: int
    last_line: str
    digests: dict = {}   # SHA-256 of the frames' files
    facts: dict = {}     # facts about each frame, from reports
    skipped: list = []   # names of LF images
    early: dict = {}     # by frame that was finished early: place of the first LF image that it lacks
    early_pixels: dict = {}  # pixels_of() each of these frames
    seconds: float = 0
    is_one_batch: bool = False  # the frames had all their rays whenever they could be finished early


def render_mode(mode):
    return mode.split()[0] if mode.split()[0] in ("rebin", "hybrid") else "collect"


def is_order(run_name):
    return run_name in ("round-robin", "area", "groups")


class Matrix(World):
    """Renders cells. May be called by several threads."""

    early_count = 0  # frames that were finished early and have been checked

    # Calls of a cell

    def steps(self, cell, out):
        """Returns the calls that render a cell into a folder, without the options of its run."""
        options = [*MODES[cell.mode], *RUNS[cell.run]]
        order = tuple(RUNS[cell.run]) if is_order(cell.run) else ()
        from_packages = cell.cut in ("packages", "moved packages", "shards of packages", "lfsubmit")
        if not from_packages:
            inputs = [self.input_of(cell), self.path_of(cell.field)]
        else:
            if order:  # lfpreprocessor gets the order and the limit of LF images, which packages store
                options = MODES[cell.mode]
            source = packaged_input(cell.input) if self.is_moved(cell) else cell.input
            inputs = self.packages(cell.field, source, cell.mode, order)
        moved = ["--lightfield", self.input_of(cell)] if self.is_moved(cell) else []
        if cell.cut == "lfsubmit":
            words = [self.program("lfsubmit"), *inputs, "-o", out, "--no-contact-sheet",
                     "--lfrenderer", self.program("lfrenderer"), "--jobs", 2, "--", *moved, *options]
            return [Step(words, [self.program("lfsubmit"), "--resume", out])]
        words = [self.program("lfrenderer"), *inputs, "-o", out, *moved]
        if "shards" not in cell.cut:
            words += [*options, "--no-contact-sheet"]
            return [Step(words, [*words, "--resume"])]
        of_files = MODES[cell.mode] if cell.mode in OF_FILES else []  # options of lfmerge, which writes the files
        words += [word for word in options if word not in of_files]
        parts = [[*words, "--shard", f"{k}/{SHARDS}"] for k in range(1, SHARDS + 1)]
        merge = [self.program("lfmerge"), out / "partial" / "shards", "-o", out,
                 "--no-contact-sheet", *of_files]
        return [*(Step(part, [*part, "--resume"]) for part in parts),
                Step(merge, [*merge, "--resume"])]

    def is_moved(self, cell):
        """Returns True if the packages were made from packaged_input(), but read another input."""
        return cell.cut == "moved packages" or (
            cell.cut == "lfsubmit" and is_of_packages(cell.input))

    def input_of(self, cell):
        return self.input(cell.field, cell.input, cell.mode)

    # The plain render

    def plain_cell(self, cell):
        """Returns the cell whose frames a cell must have: cut whole or as moved packages, and run without an
        interruption."""
        source, cut = cell.input, "whole"
        run_name = {"killed": "once", "interrupted": "once", "small": "once", "finish": "once",
                    "noise killed": "noise"}.get(cell.run, cell.run)
        if run_name == "groups" and render_mode(cell.mode) == "collect":
            run_name = "once"  # sums of all rays do not depend on the order
        if source == "coarser store":
            pass
        elif "lossy" not in source:
            source = packaged_input(source)
        elif source != "lossy needed pixels":
            source = "lossy store"
        else:
            cut = "moved packages"
        return cell._replace(input=source, cut=cut, run=run_name)

    @once
    def plain(self, cell):
        """Returns the frames that cells like this one must have."""
        plain = self.render_once(cell)
        if plain.exit_code not in (0, 6):
            raise Difference(f"the plain render: exit code {plain.exit_code}: {plain.last_line}")
        if len(plain.digests) != FRAMES:
            raise Difference(f"the plain render has {len(plain.digests)} frames")
        if (cell.input, cell.cut) == ("lossy needed pixels", "moved packages"):
            self.check_near(cell)
        unasked = set(plain.skipped) - {self.name_of(index) for index in (BROKEN, MISSING)}
        if unasked or (plain.skipped and not is_flawed(cell.field)):
            raise Difference(f"the plain render skipped {len(plain.skipped)} LF images that are not "
                             f"broken, the first: {min(unasked or plain.skipped)}")
        return plain

    def render_once(self, cell):
        out = self.new_folder("plain")
        start = time.monotonic()
        step, = self.steps(cell, out)
        exit_code, last = run(step.words)
        plain = self.look_at(cell, out, exit_code, last, time.monotonic() - start)
        shutil.rmtree(out)
        return plain

    def check_near(self, cell):
        """Compares a render of encoded rectangles, whose bits no other render has, with one of the image files."""
        ours = self.pictures(cell)
        theirs = self.pictures(cell._replace(input="folder"))
        error = np.mean(np.square(ours - theirs)) / np.max(theirs) ** 2
        is_drawn = cell.run == "noise" or render_mode(cell.mode) == "rebin"
        least = LEAST_PSNR_OF_DRAWN_DB if is_drawn else LEAST_PSNR_DB
        if not -10 * np.log10(max(error, 1e-12)) > least:
            raise Difference(f"the plain render is {-10 * np.log10(error):.1f} dB from that of the "
                             f"image files, expected {least}")

    @once
    def pictures(self, cell):
        """Returns the frames of a plain render: [frame][row][column][B, G, R]."""
        out = self.new_folder("pictures")
        step, = self.steps(cell, out)
        run(step.words)
        frames = [cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., :3].astype(np.float32)
                  for path in sorted(out.glob("frame_*.exr"))]
        shutil.rmtree(out)
        return np.stack(frames)

    @once
    def pixels_before(self, cell, place):
        """Returns pixels_of() all frames if the files of all LF images from a place of the order on are missing. Lens
        weights depend on the cameras and not on the files."""
        folder = self.new_folder("before")
        gone = {name for name, at in self.places_of(cell.field).items() if at >= place}
        for path in self.folder_of(cell.field).iterdir():
            if path.name not in gone:
                (folder / path.name).hardlink_to(path)
        light_field = folder
        if cell.input != "folder":
            light_field = self.encode([folder], cell.input, folder / "a.lfs")
        out = folder / "out"
        self.make("lfrenderer", light_field, self.path_of(cell.field), "-o", out,
                  "--no-contact-sheet", *MODES[cell.mode])
        pixels = {frame: pixels_of(out / f"frame_{frame:04d}.exr") for frame in frames_of(cell.field)}
        shutil.rmtree(folder)
        return pixels

    # The cell

    def render(self, cell, out, shall_be_refused):
        """Renders a cell as its run requires. A cell that must be refused is not interrupted."""
        steps = self.steps(cell, out)
        if shall_be_refused:
            finishes = cell.run == "finish" and cell.cut != "lfsubmit"  # lfsubmit is refused when the job is submitted
            numbers = frames_of(cell.field)
            finish = ["--resume", "--finish", f"{numbers[0]}-{numbers[-1]}"] if finishes else []
            return self.ended(cell, out, [step._replace(words=[*step.words, *finish])
                                          for step in steps])
        if cell.run in ("killed", "noise killed"):
            return self.resumed(cell, out, steps, [signal.SIGKILL] * 2, [])
        if cell.run == "interrupted":
            return self.resumed(cell, out, steps, [signal.SIGTERM], ["--threads", 3])
        if cell.run == "finish":
            return self.finished_early(cell, out, steps)
        if cell.run == "small":
            return self.in_small_memory(cell, out, steps)
        return self.ended(cell, out, steps)

    def ended(self, cell, out, steps):
        """Runs the steps until one fails."""
        exit_code, last = 0, ""
        for step in steps:
            exit_code, last = run(step.words)
            if exit_code not in (0, 6):
                break
        return self.look_at(cell, out, exit_code, last)

    def in_small_memory(self, cell, out, steps):
        """Runs the steps with the least memory that their error messages name."""
        memory_mib = 2
        for _ in range(5):
            exit_code, last = 0, ""
            for step in steps:
                options = ["--threads", 3, "--memory", f"{memory_mib}M"]
                if step.words[0].endswith("lfmerge"):
                    options = ["--threads", 3]
                exit_code, last = run(with_options(step.words, options))
                if exit_code not in (0, 6):
                    break
            named = [int(mib) for mib in re.findall(r"(?:at least|take) (\d+) MiB", last)]
            if exit_code != 4 or not named:
                break
            memory_mib = max(named) + (150 if "take" in last else 0)
            shutil.rmtree(out, ignore_errors=True)
        return self.look_at(cell, out, exit_code, last)

    def resumed(self, cell, out, steps, signals, options):
        """Runs the first step, ends it with each signal in turn, and then runs all steps to their end."""
        seconds = self.plain(self.plain_cell(cell)).seconds
        chance = random.Random(cell.name)
        words = [*steps[0].words, *DUMP_OFTEN]
        resume = steps[0].resume if cell.cut == "lfsubmit" else [*steps[0].resume, *DUMP_OFTEN]
        for sign in signals:
            self.interrupt(words, out, chance.uniform(0, 0.7) * seconds, sign)
            if cell.cut != "lfsubmit" or (out / "cluster" / "job.json").exists():
                words = resume
        return self.ended(cell, out, [Step(with_options(words, options), []), *steps[1:]])

    def interrupt(self, words, out, seconds, sign, has_begun=None):
        """Starts a program and sends it a signal some seconds after it has begun. Returns its exit code and last
        line."""
        has_begun = has_begun or is_at_work
        process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not has_begun(out):
            time.sleep(0.001)
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(sign)
        _, text = process.communicate(timeout=240)
        return process.returncode, last_line(text)

    def finished_early(self, cell, out, steps):
        """Interrupts a render when it has a state, then has all begun frames finished early. Tries again if the begun
        frames had all their rays already. Some films take all LF images in one batch, so that their frames always
        have: they must be the frames of the whole film."""
        complete_count = 0
        for attempt in range(60):  # the frames of small films are complete within milliseconds
            exit_code, last = self.interrupt([*steps[0].words, *DUMP_OFTEN], out, 0.002 * (attempt % 8),
                                             signal.SIGTERM, has_state)
            if exit_code not in (0, 5, 6):
                return self.look_at(cell, out, exit_code, last)
            if exit_code == 5 and has_state(out):
                rendered = self.finish_begun(cell, out, steps[0])
                if rendered.early or rendered.exit_code not in (0, 6):
                    return rendered
                complete_count += 1
                if complete_count == 20:
                    return rendered._replace(is_one_batch=True)
            shutil.rmtree(out)
            out.mkdir()
        raise Difference("could not be interrupted between begin and end")

    def finish_begun(self, cell, out, step):
        """Finishes the frames of an interrupted render that have begun, and renders the others."""
        pictures = {int(path.stem[6:]): pixels_of(path)
                    for path in out.glob("partial/**/frame_*.exr")}
        begun = sorted({int(path.stem[6:]) for path in out.glob("partial/**/frame_*.plate")})
        numbers = frames_of(cell.field)
        frames = ",".join(map(str, begun)) or f"{numbers[0]}-{numbers[-1]}"
        if cell.cut == "lfsubmit":
            if not begun:  # rebinned rays and kept pixels belong to all frames of their package
                job = json.loads((out / "cluster" / "job.json").read_text())
                frames = ",".join(package["frames"] for package in job["packages"]
                                  if holds_any(out / "partial" / package["name"], "*.rays", "*.pixels"))
            exit_code, last = run([self.program("lfsubmit"), "--finish", out, frames])
            if exit_code == 0:
                exit_code, last = run(step.resume)
        else:
            exit_code, last = run([*step.resume, "--finish", frames])
        rendered = self.look_at(cell, out, exit_code, last)
        # With `rebin`, a picture is collected when it is written, and may be older than the state.
        for frame in set(rendered.early) & set(pictures) if cell.mode != "rebin" else ():
            if rendered.early_pixels[frame] != pictures[frame]:
                raise Difference(f"frame {frame}, finished early, is not the picture that was left")
        return rendered

    # Results of a cell

    def look_at(self, cell, out, exit_code, last, seconds=0):
        digests = {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
                   for path in sorted(out.glob("frame_*.exr"))}
        if exit_code not in (0, 6):
            return Rendered(exit_code, last, digests)
        pattern = {"packages": "report-package-*.json", "moved packages": "report-package-*.json",
                   "lfsubmit": "cluster/report.json"}.get(cell.cut, "report.json")
        facts, skipped, early = {}, set(), {}
        for path in sorted(out.glob(pattern)):
            report = json.loads(path.read_text())
            skipped |= {image["name"] for image in report["skipped_lf_images"]}
            for frame in report["frames"]:
                facts[frame["frame"]] = {key: frame[key] for key in
                                         ("lf_images", "rays_accepted") if key in frame}
                if "finished_early_before_rank" in frame:
                    early[frame["frame"]] = frame["finished_early_before_rank"]
        pixels = {frame: pixels_of(out / f"frame_{frame:04d}.exr") for frame in early}
        return Rendered(exit_code, last, digests, facts, sorted(skipped), early, pixels, seconds)

    def check(self, cell, refusals):
        """Renders a cell. Returns "same" or "refused"; raises Difference."""
        out = self.new_folder("cell")
        try:
            try:
                rendered = self.render(cell, out, bool(refusals))
            except ProgramFailed as failure:
                rendered = Rendered(failure.exit_code, str(failure.last_line))
            if refusals:
                return self.check_refused(rendered, refusals)
            return self.check_same(cell, rendered)
        finally:
            shutil.rmtree(out, ignore_errors=True)

    def check_refused(self, rendered, refusals):
        if rendered.exit_code in (0, 6):
            raise Difference(f"is not refused: exit code {rendered.exit_code}")
        faults = [refusal.misses(rendered.exit_code, rendered.last_line) for refusal in refusals]
        if all(faults):
            raise Difference(f"{faults[0]}: {rendered.last_line}")
        if rendered.digests:
            raise Difference(f"{len(rendered.digests)} frames were written before it was refused: "
                             f"{rendered.last_line}")
        return "refused"

    def check_same(self, cell, rendered):
        if rendered.exit_code not in (0, 6):
            raise Difference(f"exit code {rendered.exit_code}: {rendered.last_line}")
        plain_cell = self.plain_cell(cell)
        plain = self.plain(plain_cell)
        if set(rendered.digests) != set(plain.digests):
            raise Difference(f"frames {sorted(rendered.digests)}, expected {sorted(plain.digests)}")
        if cell.run == "finish" and not rendered.early and not rendered.is_one_batch:
            raise Difference("no frame was finished early")
        self.early_count += len(rendered.early)
        wrong = [name for name, digest in plain.digests.items()
                 if rendered.digests[name] != digest and int(name[6:10]) not in rendered.early]
        if wrong:
            raise Difference(f"{len(wrong)} of {len(plain.digests)} frames have other bits: "
                             f"{', '.join(name[6:10].lstrip('0') for name in wrong)}")
        if cell.run == "finish":
            self.check_early(cell, plain_cell, rendered)
        else:
            self.check_facts(plain, rendered)
        if rendered.exit_code != (6 if rendered.skipped else 0):
            raise Difference(f"exit code {rendered.exit_code} with {len(rendered.skipped)} skipped "
                             f"LF images: {rendered.last_line}")
        return "same"

    def check_facts(self, plain, rendered):
        if rendered.facts != plain.facts:
            frame = next(frame for frame in plain.facts
                         if rendered.facts.get(frame) != plain.facts[frame])
            raise Difference(f"the report says of frame {frame} {rendered.facts.get(frame)}, "
                             f"expected {plain.facts[frame]}")
        if rendered.skipped != plain.skipped:
            raise Difference(f"skipped LF images {rendered.skipped}, expected {plain.skipped}")

    def check_early(self, cell, plain_cell, rendered):
        """Compares frames that were finished early with renders of the LF images that they name. Cells and the gaps
        of hybrids depend on all LF images, so they are skipped, as are rectangles that are encoded with loss, and
        densified stores, whose virtual LF images are made of many files each."""
        if (render_mode(cell.mode) != "collect" and cell.mode != "rebin") or is_of_packages(plain_cell.input):
            return
        if cell.input == "densified store":
            return
        for frame, place in rendered.early.items():
            if rendered.early_pixels[frame] != self.pixels_before(plain_cell, place)[frame]:
                raise Difference(f"frame {frame}, finished early before place {place}, has other "
                                 "bits than without the LF images from there on")


def pixels_of(path):
    """Returns the SHA-256 of all channels of an EXR file, without its header."""
    exr = path.read_bytes()
    _, at = read_header(exr)
    first_chunk = int.from_bytes(exr[at:at + 8], "little")  # the start of the table of offsets
    return hashlib.sha256(exr[first_chunk:]).hexdigest()


def with_options(words, options):
    """Returns a call with more options for its program."""
    words = list(words)
    at = words.index("--") if "--" in words else len(words)
    return [*words[:at], *options, *words[at:]]


def holds_any(out, *patterns):
    try:
        return any(any(out.glob(pattern)) for pattern in patterns)
    except FileNotFoundError:  # the folder was removed in the meantime
        return False


def is_at_work(out):
    """Returns True if a render in a folder has begun and handles signals."""
    return holds_any(out, "partial/**/lock", "frame_*")


def has_state(out):
    """Returns True if an unfinished frame, rebinned rays or kept pixels are on the disk."""
    return holds_any(out, "partial/**/frame_*.plate", "partial/**/*.rays", "partial/**/*.pixels")
