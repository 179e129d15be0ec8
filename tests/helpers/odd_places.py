# SPDX-License-Identifier: Apache-2.0
"""Tries odd names for light fields, paths, images and outputs, and outputs that are inputs of the same call."""
import hashlib
import json
import os
import shutil
import subprocess

CODES = (2, 3, 4, 6)
NAMES = {
    "spaces": "two  words ", "quotes": "it's \"so\"", "newline": "two\nlines", "dash": "-o", "dashes": "--help",
    "UTF-8": "Grün 光場 é", "percents": "%d%s%n %04d", "braces": "{} {0} {x}", "globs": "[a-z]*?",
    "backslash": "a\\b\\n", "shell": "#;&|$HOME`x`>y", "hidden": ".name", "tab": "a\tb", "comma": "a,b=c:d",
    "tilde": "~root", "control": "a\x01\x1b[2Kb",
    "200 characters": "n" * 200, "dots": "a..b.", "ending": "film.exr.lfs", "file://": "file:x"}
# The names of the quick form, which combine all kinds of characters.
MIXED = {"mixed characters": "-it's \"so\" %d%s {}\nGrün 光場 [a]*;&$HOME\\n,", "200 characters": "n" * 200}
# Bytes that are no text. Images cannot have such names, since transforms.json is text.
NO_TEXT = os.fsdecode(b"a\xff\xfeb")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def frames_of(folder):
    return {path.name: digest(path) for path in folder.glob("frame_*")}


def move_images(field, name):
    """Renames the images of a light field and their folder."""
    calibration = field / "transforms.json"
    text = json.loads(calibration.read_text())
    (field / name).mkdir()
    for number, frame in enumerate(text["frames"]):
        image = f"{name}/{name}{number}.png"
        (field / frame["file_path"]).rename(field / image)
        frame["file_path"] = image
    calibration.write_text(json.dumps(text))


class OddNames:
    """Runs all programs one after the other, with a folder and a file of one name for each."""

    def __init__(self, calls, folder, expected):
        self.calls, self.folder, self.expected = calls, folder, expected
        self.programs = calls.programs

    def call(self, program, *words, cwd=None):
        words = [os.fspath(word) for word in words]
        quiet = [] if program == "lfcammvminfo" or "--text" in words else ["-q"]
        done = subprocess.run([self.programs / program, *quiet, *words], capture_output=True,
                              stdin=subprocess.DEVNULL, cwd=cwd, timeout=120)
        if done.returncode != 0:
            raise OSError(f"{program}: status {done.returncode}: {done.stderr[-300:]}")
        return done.stdout

    def same(self, what, is_same):
        if not is_same:
            raise OSError(f"{what}: other files")

    def steps(self, name, is_text=True):
        """Yields each program after its call. OSError: the call failed, or its files are wrong."""
        calls, here, image_name = self.calls, self.folder / name, name if is_text else "image"
        here.mkdir(parents=True)
        # All names are absolute but those of lfexample, which begin with "./".
        field, path, store = here / name, here / f"{name}.yaml", here / f"{name}.lfs"
        self.call("lfsynth", *map(str, calls.synth(field)[1:-1]))
        self.same("lfsynth", digest(field / "transforms.json") == digest(calls.field / "transforms.json"))
        yield "lfsynth"
        move_images(field, image_name)
        if is_text:  # otherwise a transforms.json cannot name the folder of the images
            self.call("lfimport", field, "-o", here / f"{name} import")
            yield "lfimport"
            field = here / f"{name} import"
        self.call("lfexample", "--move", "dolly", "--focus", "3", f"--output=./{name}.yaml", "--", f"./{field.name}",
                  cwd=here)
        yield "lfexample"
        self.call("lfcammvminfo", path)
        yield "lfcammvminfo"
        self.call("lfpath", path, "-o", here / f"{name}.json")
        yield "lfpath"
        self.same("lfvisualizer", self.call("lfvisualizer", field, path, "--text") == self.expected["text"])
        self.call("lfvisualizer", field, path, "--export", here / f"{name} page")
        yield "lfvisualizer"
        self.call("lfcompressor", field, "-o", store, "--profile", "lossless")
        yield "lfcompressor"
        packages, film = here / f"{name} packages", here / f"{name} film"
        self.call("lfpreprocessor", store, path, "-o", packages, "--packages", "2", "--frames", "1-2")
        yield "lfpreprocessor"
        self.call("lfrenderer", *sorted(packages.glob("*.lfp")), "-o", film)
        self.same("lfrenderer", frames_of(film) == self.expected["frames"])
        yield "lfrenderer"
        for shard in ("1/2", "2/2"):
            self.call("lfrenderer", field, path, "-o", here / f"{name} cut", "--frames", "1-2", "--shard", shard)
        self.call("lfmerge", here / f"{name} cut" / "partial" / "shards", "-o", here / f"{name} merged")
        self.same("lfmerge", frames_of(here / f"{name} merged") == self.expected["frames"])
        yield "lfmerge"
        frame = film / "frame_0001.exr"
        self.call("lfquilt", frame, frame, "-o", here / f"{name} quilt.exr", "--layout", "left-right")
        self.same("lfquilt", len(list(here.glob("*quilt_*.exr"))) == 2)
        yield "lfquilt"
        self.call("lfcompare", film, here / f"{name} merged", "-o", here / f"{name} differences", "--max-flip", "0")
        self.same("lfcompare", len(list((here / f"{name} differences").iterdir())) == 2)
        yield "lfcompare"
        self.call("lfsubmit", *sorted(packages.glob("*.lfp")), "-o", here / f"{name} job", "--progress", "none")
        self.same("lfsubmit", frames_of(here / f"{name} job") == self.expected["frames"])
        yield "lfsubmit"

    def dash_steps(self):
        """Yields each program after a call whose relative names begin with a dash, behind "=" and behind "--"."""
        here = self.folder / "dashes in front"
        here.mkdir()
        shutil.copytree(self.calls.field, here / "-field")
        for program, words in (("lfimport", ["--output=-import", "--", "-field"]),
                               ("lfexample", ["--output=-p.yaml", "--move", "dolly", "--focus", "3", "--", "-field"]),
                               ("lfcammvminfo", ["--", "-p.yaml"]),
                               ("lfcompressor", ["--output=-s.lfs", "--", "-field"]),
                               ("lfpreprocessor", ["--output=-p", "--packages", "2", "--", "-s.lfs", "-p.yaml"]),
                               ("lfrenderer", ["--output=-film", "--frames", "1-2", "--", "-field", "-p.yaml"]),
                               ("lfsynth", ["--output=-synth", "--count", "4", "--size", "32x32", "--", "chart"])):
            if program != "lfcammvminfo":
                words = ["-q", *words]
            done = subprocess.run([self.programs / program, *words], capture_output=True, stdin=subprocess.DEVNULL,
                                  cwd=here, timeout=120)
            if done.returncode != 0:
                raise OSError(f"{program}: status {done.returncode}: {done.stderr[-300:]}")
            yield program
        self.same("lfrenderer", frames_of(here / "-film") == self.expected["frames"])


def try_names(calls, folder, note, arguments):
    """Notes, for every name, each program that accepts it."""
    folder.mkdir()
    plain = folder / "plain film"
    subprocess.run(calls.render("-o", plain), check=True)
    text = subprocess.run([calls.programs / "lfvisualizer", calls.field, calls.path, "--text"], check=True,
                          capture_output=True).stdout
    odd = OddNames(calls, folder, {"frames": frames_of(plain), "text": text})
    names = {**MIXED, **NAMES} if arguments.all else MIXED
    rounds = {what: odd.steps(name) for what, name in names.items()}
    rounds["no text"] = odd.steps(NO_TEXT, is_text=False)
    rounds["dashes in front"] = odd.dash_steps()
    for what, steps in rounds.items():
        try:
            for program in steps:
                note("names", program, what, [])
        except OSError as failure:
            program, _, fault = str(failure).partition(": ")
            note("names", program, what, [fault])


class Inputs:
    """Copies of all kinds of inputs in one folder."""

    def __init__(self, calls, folder):
        self.folder, self.calls = folder, calls
        self.field, self.path, self.store = folder / "field", folder / "path.yaml", folder / "store.lfs"
        self.packages, self.shards, self.image = folder / "packages", folder / "shards", self.field / "frame_0001.png"

    def make(self):
        shutil.copytree(self.calls.field, self.field)
        calibration = self.field / "transforms.json"
        text = json.loads(calibration.read_text())
        # An LF image with the name of a future frame.
        first = text["frames"][0]
        (self.field / first["file_path"]).rename(self.image)
        first["file_path"] = self.image.name
        calibration.write_text(json.dumps(text))
        shutil.copy(self.calls.path, self.path)
        shutil.copytree(self.calls.packages, self.packages)
        shutil.copytree(self.calls.shards, self.shards)
        subprocess.run(self.calls.words("lfcompressor", self.field, "-o", self.store), check=True,
                       stdout=subprocess.DEVNULL)

    def content(self):
        return {str(path.relative_to(self.folder)): digest(path) for path in self.folder.rglob("*") if path.is_file()}

    def all_calls(self):
        """Yields calls whose output is one of their inputs, and the names that a call may replace if it ends with 0."""
        words, field, path, store = self.calls.words, self.field, self.path, self.store
        calibration = field / "transforms.json"
        package = self.packages / sorted(self.calls.packages.glob("*.lfp"))[0].name
        places = [calibration, self.image, field, path, store, package]
        for place in places:
            yield "lfexample", words("lfexample", field, "-o", place), {"path.yaml"}
            yield "lfcompressor", words("lfcompressor", field, "-o", place, "--overwrite"), {"store.lfs"}
            yield "lfrenderer", words("lfrenderer", field, path, "-o", place, "--frames", "1", "--format", "png",
                                      "--overwrite"), set()
            yield "lfrenderer", words("lfrenderer", field, path, "-o", self.folder / "film", "--frames", "1", "--video",
                                      place), set()
            yield "lfpreprocessor", words("lfpreprocessor", field, path, "-o", place, "--overwrite"), set()
            yield "lfimport", words("lfimport", field, "-o", place), set()
            yield "lfsynth", words("lfsynth", "chart", "-o", place, "--count", "4", "--size", "32x32"), set()
            yield "lfvisualizer", [self.calls.programs / "lfvisualizer", field, path, "--export", place], set()
            yield "lfmerge", words("lfmerge", self.shards / "partial/shards", "-o", place), set()
            yield "lfquilt", words("lfquilt", self.image, self.image, "-o", place, "--layout", "over-under"), set()
            yield "lfcompare", words("lfcompare", self.image, self.image, "-o", place), set()
            yield "lfsubmit", [self.calls.programs / "lfsubmit", package, "-o", place, "--progress", "none"], set()
        yield "lfcompressor", words("lfcompressor", store, "-o", store, "--overwrite"), set()
        yield "lfcompressor", words("lfcompressor", package, "-o", package, "--overwrite"), set()
        yield "lfpreprocessor", words("lfpreprocessor", store, path, "-o", self.packages), set()
        yield "lfrenderer", words("lfrenderer", package, "-o", self.packages, "--overwrite"), set()
        yield "lfrenderer", words("lfrenderer", store, path, "-o", self.folder, "--overwrite", "--frames", "1"), set()
        yield "lfmerge", words("lfmerge", self.shards / "partial/shards", "-o", self.shards / "partial/shards",
                               "--overwrite"), set()
        yield "lfquilt", words("lfquilt", self.image, self.image, "-o", self.image, "--layout", "anaglyph",
                               "--overwrite"), set()
        yield "lfcompare", words("lfcompare", self.image, self.image, "-o", self.image, "--overwrite"), set()
        yield "lfsubmit", [self.calls.programs / "lfsubmit", package, "-o", self.packages, "--overwrite",
                           "--progress", "none"], set()
        yield "lfsynth", words("lfsynth", "chart", "-o", self.folder / "truth", "--count", "4", "--size", "32x32",
                               "--truth", path), set()


def try_inputs_as_outputs(calls, folder, note, arguments):
    """Notes each call whose output is one of its inputs. Inputs must not change."""
    whole, here = Inputs(calls, folder / "whole"), Inputs(calls, folder / "here")
    folder.mkdir()
    whole.folder.mkdir()
    whole.make()
    for program, words, may_replace in here.all_calls():
        if arguments.only not in program:
            continue
        shutil.rmtree(here.folder, ignore_errors=True)
        shutil.copytree(whole.folder, here.folder)
        before = here.content()
        done = subprocess.run(words, capture_output=True, stdin=subprocess.DEVNULL, timeout=120)
        after = here.content()
        changed = [name for name, what in before.items() if after.get(name) != what]
        faults = []
        if done.returncode == 0:
            faults += [f"status 0, {name} is changed" for name in changed if name not in may_replace]
        else:
            last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
            if done.returncode not in CODES or not (last and last[0].startswith("error: ")):
                faults.append(f"status {done.returncode}: {last}")
            faults += [f"status {done.returncode}, but {name} is changed" for name in changed]
        shown = " ".join(str(word).replace(f"{here.folder}/", "") for word in words[1:])
        note("inputs", program, shown, faults, f"(status {done.returncode})")
