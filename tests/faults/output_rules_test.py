#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of every program: --resume keeps nothing that other inputs made, and no output is an input or another output.

The lists below name every program and every command of lffocus. A new one fails the first test until it has attacks, or
a reason why it needs none.

usage: output_rules_test.py FOLDER_OF_PROGRAMS
"""
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from PIL import Image

from tiny_calls import TinyCalls
from writers_case import KINDS, TINY, VARIANTS, WritersCase

WritersCase.programs = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")

NO_FILES = "it writes no files"
NO_RESUME = "it has no --resume"
# Programs whose two writers are not raced (tests/faults/writers_test.py).
NOT_RACED = {"lfcammvminfo": NO_FILES, "lffocus": "its commands are"}
# Programs of which no finished result is resumed with other inputs.
NOT_RESUMED = dict.fromkeys(["lfsynth", "lfimport", "lfexample", "lfcammvminfo", "lfpath", "lfpreprocessor",
                             "lfcompare", "lfvisualizer", "lffocus", "lffocus epi", "lffocus views", "lffocus depth",
                             "lffocus sharp"], NO_RESUME)
RESUMED = ("lfrenderer", "lfmerge", "lfcompressor", "lfdensify", "lfquilt", "lfquilt, a video", "lfsubmit",
           "lffocus stack", "lffocus stack, a folder", "lffocus stack, a video", "lffocus through")
# Programs without an output that could be an input or another output.
HARMLESS = {"lfcammvminfo": NO_FILES, "lffocus": "its commands are attacked"}


def content(folder):
    """Returns digests of all files below a folder."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class OutputRulesTest(WritersCase):
    def described(self, *words):
        done = subprocess.run([self.programs / words[0], *words[1:], "--describe"], check=True, capture_output=True,
                              text=True)
        return json.loads(done.stdout)

    def all_names(self):
        """Returns the programs that lfr lists, and the commands of lffocus, with the options of each."""
        names = {}
        for command in self.described("lfr")["commands"]:
            name = command["call"].split()[0]
            if (self.programs / name).exists():
                told = self.described(name)
                names[name] = told
                for inner in told["commands"]:
                    names[inner["call"]] = self.described(*inner["call"].split())
        return {name: {word for group in told["groups"] for option in group["options"] for word in option["names"]}
                for name, told in names.items()}

    def test_no_program_is_left_out(self):
        names = self.all_names()
        self.assertGreater(len(names), 18)
        attacked = {name for name, _, _ in self.attacks(self.folder)}
        tiny = TinyCalls(self.programs, self.folder, self.folder / "out" / "out")
        disturbed = {re.split(",| --", call.name)[0]
                     for call in [*tiny.writers(), *tiny.submitters(), *tiny.printers()]}
        for name, options in names.items():
            with self.subTest(name):
                self.assertIn(name, [*KINDS, *NOT_RACED], "needs calls in writers_case.py, or a reason")
                self.assertIn(name, [*attacked, *HARMLESS], "needs attacks on outputs, or a reason")
                self.assertIn(name, [*RESUMED, *NOT_RESUMED], "needs attacks on --resume, or a reason")
                self.assertIn(name, [*disturbed, "lffocus"], "needs a call in tiny_calls.py")
                self.assertEqual(NOT_RESUMED.get(name) == NO_RESUME, "--resume" not in options)
                if options & {"-o", "--output", "--export", "--video"}:
                    self.assertNotIn(name, HARMLESS)
                    self.assertNotIn(name, NOT_RACED)
        for name, variants in VARIANTS.items():
            for variant in variants:
                self.assertEqual(f"{name}, {variant}" in RESUMED or variant == "two files", name in RESUMED, variant)

    # --resume

    def resumes(self, call, out, way):
        """Returns a command that resumes the finished result of the way "a" with the inputs of another way."""
        if call != "lfsubmit":
            return self.command(call, way, out, "--resume")
        packages = sorted((self.world / f"packages_{way}").glob("*.lfp"))
        return [self.programs / "lfsubmit", "--resume", out, *packages, "--", "--estimator", self.ways[way]]

    def test_what_other_inputs_made_is_not_kept(self):
        for call in RESUMED:
            for way in "bc":
                with self.subTest(call, way=way):
                    out = self.folder / f"{call}_{way}"
                    out.mkdir()
                    subprocess.run(self.command(call, "a", out), check=True, capture_output=True, timeout=240)
                    made = self.files(call, out)
                    self.assertEqual(made, self.expect(call, "a"))
                    same = subprocess.run(self.resumes(call, out, "a"), capture_output=True, text=True, timeout=240)
                    self.assertEqual(same.returncode, 0, same.stderr)
                    self.assertEqual(self.files(call, out), made)
                    done = subprocess.run(self.resumes(call, out, way), capture_output=True, text=True, timeout=240)
                    if done.returncode == 0:  # it was made again
                        self.assertEqual(self.files(call, out), self.expect(call, way), done.stderr)
                        self.assertNotEqual(self.files(call, out), made)
                        continue
                    self.assertIn(done.returncode, (2, 3), done.stderr)
                    self.assertRegex(done.stderr.strip().splitlines()[-1], "^error: .*(--overwrite|another -o)")
                    self.assertEqual(self.files(call, out), made)

    # Films in one folder

    def test_two_films_are_not_mixed_in_a_folder(self):
        """Renders frames of the way "a", then some frames of another way into the same folder."""
        packages = sorted((self.world / "packages_a").glob("*.lfp"))
        path = self.folder / "path.yaml"
        path.write_text(re.sub("aperture_diameter: [^ ]+", "aperture_diameter: 0.5", self.path.read_text()))
        self.assertNotEqual(path.read_text(), self.path.read_text())
        whole = [self.field, self.path]
        first = {"a film": whole, "packages": packages, "a film in two calls": whole}
        self.made("lfsynth", "chart", "-o", self.folder / "moved", *TINY, "--jitter", 0.1)
        others = {"light field": [self.folder / "moved", self.path], "pixels": [self.world / "lossy.lfs", self.path],
                  "path": [self.field, path], "options": [self.field, self.path, "--estimator", "bilinear"]}
        for name, words in first.items():
            for other, more in others.items():
                with self.subTest(name, other=other):
                    film = self.folder / f"{name}, other {other}"
                    frames = ["-o", film, "--no-contact-sheet", "--threads", 2]
                    self.made("lfrenderer", *words, *frames, "--estimator", "nearest")
                    if name == "a film in two calls":
                        self.made("lfrenderer", *words, *frames, "--estimator", "nearest", "--frames", "1")
                    before = content(film)
                    estimator = [] if other == "options" else ["--estimator", "nearest"]
                    call = [self.programs / "lfrenderer", *more, *frames, *estimator, "--frames", "1"]
                    done = subprocess.run([*map(str, call)], capture_output=True, text=True, timeout=240)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertRegex(done.stderr.strip().splitlines()[-1],
                                     r"^error: .* files are frames of another film; the first, frame_000[12]\.exr, was")
                    self.assertEqual(content(film), before)
                    done = subprocess.run([*map(str, call), "--overwrite"], capture_output=True, text=True, timeout=240)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertRegex(done.stderr, r"warning: .* files are frames of another film; the first, frame_")
                    now = content(film)
                    self.assertNotEqual(now["frame_0001.exr"], before["frame_0001.exr"])
                    self.assertEqual(now["frame_0002.exr"], before["frame_0002.exr"])

    # Outputs that are inputs or other outputs

    def attacks(self, here):
        """Yields (name, words, output) for calls in a folder of copies; `output` must not appear or change."""
        field, path, image = here / "field", here / "path.yaml", here / "field" / "frame_0001.png"
        calibration, store, film = field / "transforms.json", here / "image.lfs", here / "film"
        packages = [here / "packages" / f"package-000{number}.lfp" for number in (0, 1)]
        plates = here / "cut" / "partial" / "shards"
        for name in ("frame_0002.exr", "contact_sheet.png", "report.json", "partial/run.json", "partial/film.mp4"):
            video = film / name
            yield "lfrenderer", [field, path, "-o", film, "--video", video], video
            yield "lfrenderer", [*packages, "-o", film, "--video", video], video
            yield "lfmerge", [plates, "-o", film, "--video", video], video
            yield "lfsubmit", [*packages, "-o", film, "--video", video, "--progress", "none"], video
            yield "lffocus through", [field, path, "-o", film, "--video", video], video
            yield "lffocus stack", [field, path, "-o", film, "--planes", 2, "--near", 2, "--far", 4, "--video",
                                    video], video
        near = ["--planes", 2, "--near", 2, "--far", 4]
        yield "lfrenderer", [field, path, "-o", film, "--keep-plates", "--video", film / "frame_0001.plate"], film
        yield "lfrenderer", [*packages, "-o", film, "--video", film / f"report-{packages[0].stem}.json"], film
        yield "lffocus stack", [field, path, "-o", film, *near, "--video", film / "planes.json"], film
        for victim in (calibration, path, image, packages[0]):
            anew = ["--overwrite"]
            yield "lfrenderer", [field, path, "-o", film, "--video", victim], victim
            yield "lfmerge", [plates, "-o", film, "--video", victim], victim
            yield "lfsubmit", [*packages, "-o", film, "--video", victim, "--progress", "none"], victim
            yield "lfexample", [field, "-o", victim if victim != path else image], victim
            if victim != path:  # with --overwrite, a path may be changed in its place
                yield "lfpath", [path, "--lightfield", field, "-o", victim, "--format", "nerfstudio", *anew], victim
            yield "lfcompressor", [field, "-o", victim, *anew], victim
            yield "lfdensify", [field, "-o", victim, "--force", *anew], victim
            yield "lfpreprocessor", [field, path, "-o", victim, *anew], victim
            yield "lfimport", [field, "-o", victim], victim
            yield "lfvisualizer", [field, path, "--export", victim], victim
            yield "lffocus through", [field, path, "-o", film, "--video", victim], victim
        yield "lfvisualizer", [field, path, "--export", field], calibration
        yield "lfimport", [field, "-o", field, "--unit-m", 2], calibration
        yield "lfsynth", ["chart", "-o", field, "--count", 4], calibration
        yield "lfsynth", ["chart", "-o", here / "named", "--count", 4, "--overwrite", "--truth",
                          here / "named" / "transforms.json"], here / "named" / "transforms.json"
        yield "lfcompressor", [here / "store.lfs", "-o", here / "store.lfs", "--overwrite"], here / "store.lfs"
        yield "lfcompressor", [field, "-o", store, "--overwrite"], store
        yield "lfdensify", [field, "-o", store, "--force", "--overwrite"], store
        packed, named = here / "package-0000.lfp", here / "package-0001.lfp"
        yield "lfpreprocessor", [packed, path, "-o", here, "--overwrite"], packed
        yield "lfpreprocessor", [field, named, "-o", here, "--packages", 2, "--overwrite"], named
        yield "lfquilt", [image, image, "-o", image, "--layout", "anaglyph", "--overwrite"], image
        text = here / "text.mp4"
        yield "lfquilt", [image, image, "-o", text, "--layout", "anaglyph", "--overwrite"], text
        yield "lfcompare", [image, image, "-o", image, "--overwrite"], image
        yield "lfcompare", [field, field, "-o", field, "--overwrite"], image
        yield "lfcompare", [here / "some", here / "others", "-o", here / "some"], here / "some" / "a.png"
        yield "lfcompare", [here / "some", here / "others", "-o", here.parent / "link" / "others", "--overwrite"], \
            here / "others" / "a.png"
        for command, *more in (["epi", field, "--row", 9], ["sharp", field, path, *near, "--confidence", 0],
                               ["depth", field, path, *near, "--confidence", 0], ["through", field, path],
                               ["stack", field, path, *near]):
            yield f"lffocus {command}", [*more, "-o", here / "field" / "frame_0001.png"], calibration
        yield "lffocus epi", [field, "--row", 9, "-o", image, "--overwrite"], image
        yield "lffocus sharp", [field, path, "-o", image, "--overwrite"], image
        yield "lffocus depth", [field, path, "-o", image, "--overwrite"], image
        one, other = here / "one.exr", here.parent / "link" / "one.exr"
        yield "lffocus depth", [field, path, *near, "-o", one, "-o", other], one
        yield "lffocus through", [field, path, "-o", one, "-o", other], one
        yield "lffocus through", [field, path, "-o", image, "--overwrite"], image
        film = here / "path.exr"
        yield "lffocus stack", [field, film, "-o", film, *near, "--overwrite"], film
        yield "lffocus views", [here / "views", "--grid", "3x3", "-o", here / "views",
                                "--overwrite"], here / "views" / "transforms.json"
        yield "lffocus views", [field, "--grid", "3x3", "-o", field], calibration

    def make_copies(self, here):
        """Makes all kinds of inputs in a folder. An LF image has the name of a future frame."""
        shutil.copytree(self.field, here / "field")
        calibration = here / "field" / "transforms.json"
        text = json.loads(calibration.read_text())
        (here / "field" / text["frames"][0]["file_path"]).rename(here / "field" / "frame_0001.png")
        text["frames"][0]["file_path"] = "frame_0001.png"
        image = here / "field" / text["frames"][1]["file_path"]
        image.rename(here / "image.lfs")
        text["frames"][1]["file_path"] = "../image.lfs"
        calibration.write_text(json.dumps(text))
        for name in ("path.yaml", "path.exr", "package-0001.lfp", "named/transforms.json"):
            (here / name).parent.mkdir(exist_ok=True)
            shutil.copy(self.path, here / name)
        self.made("lfcompressor", self.field, "-o", here / "store.lfs")
        shutil.copy(here / "store.lfs", here / "package-0000.lfp")
        self.made("lfpreprocessor", here / "field", here / "path.yaml", "-o", here / "packages", "--packages", "2")
        shutil.copytree(self.world / "cut_a", here / "cut")
        self.made("lffocus", "views", self.field, "--grid", "3x3", "--focus-distance", 3, "-o", here / "views")
        for folder in ("some", "others"):
            (here / folder).mkdir()
            Image.open(here / "field" / "frame_0001.png").convert("RGB").save(here / folder / "a.jpg")
        (here / "text.mp4").write_text("no video")
        (here.parent / "link").symlink_to(here)

    def test_no_output_is_an_input_or_another_output(self):
        here, whole = self.folder / "here", self.folder / "whole"
        here.mkdir()
        self.make_copies(here)
        before = content(here)
        shutil.copytree(here, whole)
        for name, words, output in self.attacks(here):
            program, *command = name.split()
            if not (self.programs / program).exists():
                continue
            shown = [str(word).replace(f"{here}/", "") for word in words]
            with self.subTest(name, words=" ".join(shown)):
                os.makedirs(output.parent, exist_ok=True)
                done = subprocess.run([self.programs / program, *command, *map(str, words)], capture_output=True,
                                      text=True, stdin=subprocess.DEVNULL, timeout=240)
                after = content(here)
                if after != before:
                    shutil.rmtree(here)
                    shutil.copytree(whole, here)
                self.assertIn(done.returncode, (2, 3, 4), done.stderr)
                last = done.stderr.strip().splitlines()[-1]
                self.assertTrue(last.startswith("error: "), done.stderr)
                if name != "lfsynth":  # which reads nothing, and may replace a light field of its own
                    self.assertNotIn("--overwrite", last, "it replaces no input either")
                self.assertEqual({key: after.get(key) for key in before}, before, done.stderr)
                # No frame was made before the refusal.
                self.assertEqual([key for key in after if "frame_" in key and key not in before], [], done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
