#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the JSON schemas describe what the programs print and write: every key of an output is in its schema, and
every key of a schema is in an output.

usage: schemas_test.py PROGRAMS SOURCE
"""
import base64
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import numpy as np
from PIL import Image

import filmed_card
import found_captures
import pose_mistakes
import schema_files
import small_field
from common_options import OFFERED
from program_test_case import ProgramTestCase, wait_until

PROGRAMS = SOURCE = None
EXIF_IFD, EXPOSURE_TIME, F_NUMBER, ISO = 0x8769, 0x829A, 0x829D, 0x8827
# A camera that looks at the still life of lfsynth.
STILL_LIFE_PATH = """format: lfpath 1
fps: 25
frames: 2
resolution: [60, 40]
shutter: {angle_deg: 180, samples: 2}
camera: {field_of_view_deg: 40, position: [0.002, -0.157, -0.7975], look_at: [0.02, -0.1, 0.2], speed: [0.1, 0, 0]}
lens: {aperture_diameter: 0.05, focus_distance: 0.8}
"""


class SchemasTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.shared = pathlib.Path(temporary.name)
        side, small_field.SIDE = small_field.SIDE, 13  # so many LF images that checkpoints are written between them
        cls.many = small_field.write_field(cls.shared / "many")
        small_field.SIDE = side
        cls.field = small_field.write_field(cls.shared / "field")
        cls.path = small_field.write_path(cls.shared, frames=3)
        cls.still_path = cls.shared / "still.yaml"
        cls.still_path.write_text(STILL_LIFE_PATH)
        cls.still_life = cls.shared / "still-life"
        subprocess.run([PROGRAMS / "lfsynth", "still-life", "-o", cls.still_life, "--count", "16", "--size", "160x120",
                        "--spacing", "0.02", "--format", "png", "-q"], check=True)
        cls.densified = cls.shared / "dense.lfs"
        done = subprocess.run([PROGRAMS / "lfdensify", cls.still_life, "-o", cls.densified, "--most", "60", "--json",
                               "-q"], check=True, capture_output=True)
        cls.densify_report = json.loads(done.stdout)

    def setUp(self):
        super().setUp()
        self.schemas = schema_files.SchemaFiles(SOURCE / "schemas")

    def valid(self, name, instance):
        """Fails unless an instance fits its schema, closed as well as published. Returns the instance."""
        self.assertEqual(self.schemas.faults(name, instance), [])
        self.assertEqual(self.schemas.faults(name, instance, is_closed=False), [])
        return instance

    def valid_file(self, name, path):
        return self.valid(name, json.loads(path.read_text()))

    def prints(self, name, *words, code=0):
        """Calls a program that must print what a schema describes."""
        program, *arguments = words
        return self.valid(name, json.loads(self.succeeds(PROGRAMS / program, *arguments, "--json", code=code)))

    def covered(self, name, unseen=()):
        """Fails if no instance of this test had a key of the schema, unless it is listed."""
        places = {f"{name}.schema.json#/{place}" for place in unseen}
        self.assertEqual(sorted(self.schemas.described(name) - self.schemas.seen - places), [])

    def broken_field(self):
        """Returns a light field with an LF image that cannot be read."""
        field = small_field.write_field(self.folder / "broken")
        (field.parent / "image_12.png").write_text("no picture")
        return field

    # The schemas themselves

    def test_every_schema_is_one_and_describes_each_key(self):
        self.assertGreater(len(self.schemas.published), 20)
        for name, schema in self.schemas.published.items():
            with self.subTest(name):
                jsonschema.Draft7Validator.check_schema(schema)
                self.assertEqual((schema["$schema"], schema["$id"]), (jsonschema.Draft7Validator.META_SCHEMA["$id"],
                                                                      name))
                self.assertTrue(schema["title"] and schema["description"])
                keys = list(schema_files.properties_of(schema))
                self.assertEqual([key for key, text in keys if not text.endswith(".")], [])
                self.assertGreater(len(keys), 0)

    def test_pages_name_every_schema(self):
        listed = set(re.findall(r"schemas/(\w+\.schema\.json)\)", (SOURCE / "doc/formats/README.md").read_text()))
        self.assertEqual(listed, set(self.schemas.published))

    def test_a_missing_key_a_wrong_type_and_an_unknown_key_are_faults(self):
        report = self.prints("compare_report", "lfcompare", self.field.parent / "image_00.png",
                             self.field.parent / "image_01.png")
        for key in report:
            less = dict(report)
            del less[key]
            self.assertEqual(len(self.schemas.faults("compare_report", less)), 1, key)
            self.assertTrue(self.schemas.faults("compare_report", report | {key: 7}), key)
            whole = self.schemas.closed["compare_report.schema.json"]
            self.schemas.closed["compare_report.schema.json"] = schema_files.without(whole, key)
            self.assertIn(key, self.schemas.faults("compare_report", report)[0])
            self.schemas.closed["compare_report.schema.json"] = whole
        self.assertIn("colour", self.schemas.faults("compare_report", report | {"colour": 1})[0])
        nested = json.loads(json.dumps(report))
        nested["pictures"][0]["colour"] = 1
        self.assertIn("colour", self.schemas.faults("compare_report", nested)[0])
        self.assertEqual(self.schemas.faults("compare_report", nested, is_closed=False), [])

    def test_failing_programs_print_no_json(self):
        for program, *words in (["lfrenderer", self.field, "none.yaml", "-o", self.folder / "out"],
                                ["lfimport", "none"], ["lfcammvminfo", "none.yaml"], ["lfpath", "none.yaml"],
                                ["lfpreprocessor", "none", self.path, "--plan"],
                                ["lfcompressor", "none", "-o", self.folder / "a.lfs"],
                                ["lfdensify", "none", "-o", self.folder / "a.lfs"],
                                ["lfcompare", "none", "none"], ["lfquilt", "none", "-o", self.folder / "a.png"],
                                ["lfmerge", "none", "-o", self.folder / "out"], ["lfsubmit", "--status", "none"],
                                *(["lffocus", command, "none", *words] for command, words in
                                  {"stack": [self.path, "-o", "s.exr"], "depth": [self.path, "-o", "d.exr"],
                                   "sharp": [self.path, "-o", "s.exr"], "through": [self.path, "-o", "t.exr"],
                                   "epi": ["--row", 1, "-o", "e.png"],
                                   "views": ["--grid", "3x3", "-o", "v"]}.items())):
            result = self.call(PROGRAMS / program, *words, "--json")
            self.assertIn(result.returncode, (2, 3), (program, result.stderr))
            self.assertEqual(result.stdout, "", program)

    def test_every_program_with_json_is_tested_here(self):
        """Fails for a new program, or a new command, whose output nothing here validates."""
        text = pathlib.Path(__file__).read_text()
        for call in (call for call, options in OFFERED.items() if "--json" in options):
            self.assertIn('"' + '", "'.join(call.split()) + '"', text)

    # Renders

    def slow_path(self):
        """Returns the path of one frame that the reference back end renders for seconds, of the LF images of `many`."""
        path = small_field.write_path(self.folder, frames=1, aperture=0.12)
        path.write_text(path.read_text().replace("[80, 60]", "[640, 480]"))
        return path

    def interrupted(self, *words):
        """Interrupts a render after its first checkpoint, and returns its folder."""
        out = self.folder / "interrupted"
        process = subprocess.Popen([PROGRAMS / "lfrenderer", *words, "-o", out, "--back-end", "reference",
                                    "--dump-every", "0.001s", "--threads", "1", "-q"], stderr=subprocess.DEVNULL)
        wait_until(lambda: list(out.glob("partial/frame_*.plate")), process)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 5)
        return out

    def test_reports_of_renders(self):
        render = ["lfrenderer", self.field, self.path, "-o"]
        for options in (["--require", "samples>=1", "--mode", "hybrid"], ["--stop-when", "noise<=0.5"],
                        ["--estimator", "nearest", "--lens-weights", "none", "--mode", "rebin"]):
            self.prints("report", *render, self.folder / "out", "--overwrite", *options)
            self.valid_file("report", self.folder / "out/report.json")
        # Nothing is left of the range of frames.
        self.prints("report", *render, self.folder / "none", "--frames", "90-99", "--clamp-frames")
        self.prints("report", "lfrenderer", self.broken_field(), self.path, "-o", self.folder / "less", code=6)
        self.succeeds(PROGRAMS / "lfpreprocessor", self.densified, self.still_path, "-o", self.folder / "packages",
                      "--no-guard")
        self.prints("report", "lfrenderer", *(self.folder / "packages").glob("*.lfp"), "-o", self.folder / "film",
                    "--no-guard")
        self.valid_file("report", next((self.folder / "film").glob("report-*.json")))
        sharp = self.folder / "sharp.yaml"
        sharp.write_text(re.sub("shutter.*\n", "", self.still_path.read_text()))
        guarded = self.prints("report", "lfrenderer", self.densified, sharp, "-o", self.folder / "guarded")
        self.assertGreater(guarded["densified_share"], guarded["doubtful_share"])
        slow = self.slow_path()
        out = self.interrupted(self.many, slow, "--require", "noise<=0.01")
        for record in (out / "partial").glob("*.json"):
            self.valid_file("report", record)
        self.prints("report", "lfrenderer", self.many, slow, "-o", out, "--back-end", "reference", "--resume",
                    "--finish", 1, "--require", "noise<=0.01", code=6)
        for shard in "1/2", "2/2":
            self.prints("report", *render, self.folder / "shards", "--shard", shard)
        self.prints("report", "lfmerge", self.folder / "shards/partial/shards", "-o", self.folder / "merged")
        self.covered("report", ["focus_stack"])

    def test_progress(self):
        path = self.folder / "long.yaml"
        path.write_text(self.path.read_text().replace("frames: 3", "frames: 60"))
        with subprocess.Popen([PROGRAMS / "lfrenderer", self.field, path, "-o", self.folder / "out", "--back-end",
                               "reference", "--progress", "json"], stderr=subprocess.PIPE, text=True) as process:
            lines = []
            for line in process.stderr:
                if line.startswith("{"):
                    lines.append(self.valid("progress", json.loads(line)))
                    process.kill()
        self.assertTrue(lines)
        self.assertEqual(set(lines[0]["counts"]), {"LF image", "frame"})
        self.covered("progress")

    # lffocus

    def test_focus_stacks(self):
        stack = ["lffocus", "stack", self.field, self.path, "--near", 0.4, "--far", 2, "--planes", 3, "-o"]
        for name in "stack", "stack.exr":
            report = self.prints("focus_stack", *stack, self.folder / name)
            self.assertEqual(report["format"], "lfreport 2")
        self.assertEqual(list(self.prints("focus_stack", *stack, self.folder / "stack.exr", "--resume")),
                         ["focus_stack"])
        self.valid_file("focus_planes", self.folder / "stack/planes.json")
        self.covered("focus_stack")
        self.covered("focus_planes")

    def test_depths_and_statistics(self):
        pair = [self.still_life, self.still_path, "-o"]
        sharp = self.folder / "still.yaml"
        sharp.write_text(re.sub("shutter.*\n", "", self.still_path.read_text()))
        pair[1] = sharp
        self.prints("focus_depth", "lffocus", "depth", *pair, self.folder / "d.exr", "--planes", 8)
        self.prints("focus_depth", "lffocus", "sharp", *pair, self.folder / "s.png", "--planes", 8)
        self.covered("focus_depth")
        for statistic in "median", "trimmed":
            self.prints("focus_through", "lffocus", "through", *pair, self.folder / f"{statistic}.exr", "--statistic",
                        statistic)
        self.covered("focus_through")

    def test_epipolar_pictures_and_views(self):
        epi = ["lffocus", "epi", self.still_life]
        self.prints("focus_epi", *epi, "--row", 50, "-o", self.folder / "row.png", "--focus-distance", 1)
        self.prints("focus_epi", *epi, "--column", 50, "-o", self.folder / "column.exr")
        self.covered("focus_epi")
        self.prints("focus_views", "lffocus", "views", self.still_life, "--grid", "3x3", "-o", self.folder / "views")
        self.prints("focus_views", "lffocus", "views", self.still_life, "--grid", "4x4", "-o", self.folder / "v.npy")
        self.covered("focus_views")
        self.valid_file("transforms", self.folder / "views/transforms.json")

    # Whole light fields

    def bracketed(self):
        """Returns a light field of photographs with two exposures at each pose."""
        field = small_field.write_field(self.folder / "brackets", small_field.wall)
        text, frames = json.loads(field.read_text()), []
        for frame in text["frames"]:
            picture = Image.open(field.parent / frame["file_path"])
            for stops in 0, 2:
                exif = Image.Exif()
                exif[EXIF_IFD] = {EXPOSURE_TIME: 0.01 * 2 ** stops, F_NUMBER: 8.0, ISO: 100}
                name = f"{stops}_{frame['file_path']}"
                picture.point(lambda value, s=stops: value >> (2 - s)).save(field.parent / name, exif=exif)
                frames.append(frame | {"file_path": name})
        field.write_text(json.dumps(text | {"frames": frames}))
        return field

    def store_of_packages(self):
        """Returns a store that has only the calibration of some LF images, and was encoded for a film."""
        packages, store = self.folder / "few", self.folder / "few.lfs"
        self.succeeds(PROGRAMS / "lfpreprocessor", self.field,
                      small_field.write_path(self.folder, frames=1, aperture=0.01), "-o", packages)
        self.succeeds(PROGRAMS / "lfcompressor", *packages.glob("*.lfp"), "-o", store, "--quality-by-use")
        return store

    def test_reports_of_imports(self):
        self.prints("import_report", "lfimport", self.field, "--check", "none")
        self.prints("import_report", "lfimport", self.broken_field(), code=6)
        self.prints("import_report", "lfimport", self.densified)
        self.prints("import_report", "lfimport", self.store_of_packages())
        predicted = SOURCE / "fuzz/corpus/packed_store_file/predicted.lfs"
        self.prints("import_report", "lfimport", predicted, "--check", "none")
        alpha = {"lf_alpha": "straight", "lf_depth_range": [0.3, 2]}
        for background in "none", [0, 0.5, 1]:
            field = small_field.write_field(self.folder / "alpha", lambda index: np.full((48, 64, 4), index, np.uint8),
                                            lf_background=background, **alpha)
            self.prints("import_report", "lfimport", field)
        phone = small_field.write_field(self.folder / "phone").parent
        for file in phone.glob("*.png"):
            Image.open(file).save(file, icc_profile=found_captures.display_p3_profile())
        self.prints("import_report", "lfimport", phone)
        filmed = filmed_card.write_timed(self.folder / "filmed", [0, 1])
        self.prints("import_report", "lfimport", filmed, "--time", 0, "-o", self.folder / "shown")
        self.valid_file("transforms", self.folder / "shown/transforms.json")
        mistaken = pose_mistakes.write_mistake("opencv-axes", self.still_life, self.folder / "mistaken")
        self.prints("import_report", "lfimport", mistaken)
        brackets = self.bracketed()
        self.prints("import_report", "lfimport", brackets, "--gain-from-exif", "-o", self.folder / "gains")
        self.valid_file("transforms", self.folder / "gains/transforms.json")
        report = self.prints("import_report", "lfimport", self.still_life, "--match-exposure", "--vignetting", "-o",
                             self.folder / "matched")
        self.valid_file("transforms", self.folder / "matched/transforms.json")
        falloff = {"corner_min": 0.5, "corner_max": 0.6, "reach": 0.7, "cameras": 1}
        report["exposure"]["falloff"] = report["exposure"]["falloff"] or falloff  # chance decides whether one is found
        self.valid("import_report", report)
        self.covered("import_report")

    def test_forecasts(self):
        plan = ["lfpreprocessor", self.field, self.path, "--plan"]
        self.prints("forecast", *plan)
        self.prints("forecast", *plan, "--depths", 0.2, 3)
        self.prints("forecast", "lfpreprocessor", self.densified, self.still_path, "-o", self.folder / "packages",
                    "--packages", 2, "--no-guard")
        self.assertTrue(self.prints("forecast", *plan, "--frames", "90-99", "--clamp-frames")["advice"] is None)
        self.covered("forecast")

    def test_reports_of_packed_stores(self):
        compress = ["lfcompressor", self.field, "-o", self.folder / "a.lfs"]
        self.prints("compress_report", *compress, "--verify")
        self.prints("compress_report", *compress, "--resume")
        self.prints("compress_report", *compress, "--overwrite", "--profile", "lossless")
        self.prints("compress_report", *compress, "--overwrite", "--profile", "auto")
        self.prints("compress_report", "lfcompressor", self.broken_field(), "-o", self.folder / "b.lfs", code=6)
        self.succeeds(PROGRAMS / "lfsynth", "still-life", "-o", self.folder / "mosaics", "--bayer", "--count", 16,
                      "--size", "120x80", "--spacing", 0.003, "-q")
        self.prints("compress_report", "lfcompressor", self.folder / "mosaics", "-o", self.folder / "rgb.lfs",
                    "--demosaic", "joint")
        self.store_of_packages()
        self.prints("compress_report", "lfcompressor", *(self.folder / "few").glob("*.lfp"), "--quality-by-use", "-o",
                    self.folder / "c.lfs")
        self.covered("compress_report")

    def test_reports_of_densified_stores(self):
        self.valid("densify_report", self.densify_report)
        field = self.folder / "less"
        self.succeeds(PROGRAMS / "lfsynth", "still-life", "-o", field, "--count", 16, "--size", "160x120", "--spacing",
                      0.02, "--format", "png", "-q")
        next((field / "images").glob("*.png")).write_text("no picture")
        self.prints("densify_report", "lfdensify", field, "-o", self.folder / "less.lfs", "--most", 10, code=6)
        self.covered("densify_report")

    def test_files_of_light_fields(self):
        self.valid_file("transforms", self.still_life / "transforms.json")
        for name in "bayer", "fisheye", "alpha":
            words = {"bayer": ["--bayer", "--noise", 0.01], "fisheye": ["--fisheye", "0.1,0.01"],
                     "alpha": ["--alpha", "straight", "--format", "png"]}[name]
            self.succeeds(PROGRAMS / "lfsynth", "chart", "-o", self.folder / name, "--calibration-only", "--count", 9,
                          "-q", *words)
            self.valid_file("transforms", self.folder / name / "transforms.json")
        for path in sorted((SOURCE / "fuzz/corpus/transforms_json").glob("good_*.json")):
            self.assertEqual(self.schemas.faults("transforms", json.loads(path.read_text()), is_closed=False), [], path)
        good = json.loads(self.field.read_text())
        for matrix in [500, 0, 160, 0, 500, 120, 0, 0, 1], [[500, 0, 160], [0, 500, 120], [0, 0, 1]]:
            right = self.folder / "transforms.json"
            for key in "K", "intrinsic_matrix":
                right.write_text(json.dumps(good | {key: matrix}))
                self.succeeds(PROGRAMS / "lfimport", right, "--check", "none")
                self.assertEqual(self.schemas.faults("transforms", json.loads(right.read_text()), is_closed=False), [])
        for key, value in (("K", [[500, 0], [0, 500]]), ("lf_blak_level", 1), ("lf_bayer", "RGBG"), ("w", 0),
                           ("frames", []), ("lf_gain", 1)):
            wrong = self.folder / "transforms.json"
            wrong.write_text(json.dumps(good | {key: value}))
            self.fails(3, [key], PROGRAMS / "lfimport", wrong, "--check", "none")
            self.assertTrue(self.schemas.faults("transforms", good | {key: value}, is_closed=False), key)

    # Films and pictures

    def test_reports_of_comparisons(self):
        pair = [self.field.parent / "image_00.png", self.field.parent / "image_01.png"]
        self.prints("compare_report", "lfcompare", *pair, "-o", self.folder / "d.png")
        self.prints("compare_report", "lfcompare", pair[0], pair[0])
        self.prints("compare_report", "lfcompare", *pair, "--min-psnr", 90, code=6)
        self.covered("compare_report")

    def test_cameras_of_paths(self):
        self.prints("cameras", "lfcammvminfo", self.path)
        self.prints("cameras", "lfcammvminfo", self.still_path, "--frame", 2)
        pinhole = self.folder / "pinhole.yaml"
        pinhole.write_text(self.path.read_text().replace("aperture_diameter: 0.045", "aperture_diameter: 0"))
        self.assertIsNone(self.prints("cameras", "lfcammvminfo", pinhole)["cameras"][0]["f_number"])
        self.prints("cameras", "lfpath", self.path, "-o", self.folder / "out.yaml")
        self.covered("cameras")

    def test_reports_of_quilts(self):
        views = self.folder / "views.yaml"
        self.succeeds(PROGRAMS / "lfpath", self.path, "-o", views, "--quilt", "2x2", "-q")
        self.succeeds(PROGRAMS / "lfrenderer", self.field, views, "-o", self.folder / "frames", "--format", "png", "-q")
        for name in "quilt.png", "quilt.mp4":
            self.prints("quilt_report", "lfquilt", self.folder / "frames", "-o", self.folder / name, "--views", "2x2")
        self.covered("quilt_report")

    # Jobs

    def test_jobs(self):
        film = self.folder / "film"
        self.succeeds(PROGRAMS / "lfpreprocessor", self.field, self.path, "-o", self.folder / "packages", "--packages",
                      2, "-q")
        submit = ["lfsubmit", *sorted((self.folder / "packages").glob("*.lfp")), "-o", film]
        self.prints("job_status", *submit, "--frames", "90-99", "--clamp-frames")
        slow = self.folder / "lfrenderer"
        slow.write_text(f"#!/bin/bash\nexec {PROGRAMS}/lfrenderer \"$@\" --back-end reference --dump-every 0.001s\n")
        slow.chmod(0o755)
        self.succeeds(PROGRAMS / "lfpreprocessor", self.many, self.slow_path(), "-o", self.folder / "slow", "-q")
        words = [PROGRAMS / "lfsubmit", *(self.folder / "slow").glob("*.lfp"), "-o", film, "--lfrenderer", slow,
                 "--threads", 1, "-q"]
        with subprocess.Popen([*map(str, words)], stderr=subprocess.DEVNULL) as process:
            status = ["lfsubmit", "--status", film]
            wait_until(lambda: list(film.glob("partial/*/frame_*.plate")) and
                       "seconds_left" in self.prints("job_status", *status), process)
            self.assertIsNone(process.poll(), "the job ended before its status was seen")
            self.succeeds(PROGRAMS / "lfsubmit", "--finish", film, 1)
        self.assertEqual(process.returncode, 0)
        self.valid_file("job_finish", film / "cluster/finish_frames.json")
        self.prints("job_status", "lfsubmit", "--cancel", film)
        self.assertEqual(self.prints("job_status", *status)["state"], "done")
        self.valid_file("job", film / "cluster/job.json")
        for task in [film / "cluster/finish.json", *(film / "cluster/packages").glob("*.json")]:
            self.valid_file("job_task", task)
        self.valid_file("job", SOURCE / "fuzz/corpus/job_files/job.json")
        no_text = self.folder / os.fsdecode(b"names\xff")  # a name that is not UTF-8
        (self.folder / "packages").rename(no_text)
        for package in no_text.glob("*.lfp"):
            package.rename(no_text / (package.stem + os.fsdecode(b"\xff.lfp")))
        self.succeeds(PROGRAMS / "lfsubmit", *no_text.glob("*.lfp"), "-o", no_text / "film", "--engine", "array", "-q")
        self.valid_file("job", no_text / "film/cluster/job.json")
        self.covered("job", [f"{key}/bytes" for key in ("working_folder", "arguments", "video")])
        for name in "job_task", "job_finish":
            self.covered(name)
        # Only a batch system gives these.
        slurm = ["queue_error", *(f"{task}/{key}" for task in ("packages", "finishing") for key in
                                  ("queue", "rays_per_second"))]
        self.covered("job_status", [*slurm, "finishing/px_per_second", "finishing/seconds_left"])

    # The page

    def exported(self, *words):
        """Returns the data of an exported page: {name: JSON}."""
        folder = self.folder / f"page {len(list(self.folder.iterdir()))}"
        result = self.call(PROGRAMS / "lfvisualizer", *words, "--export", folder, "-q")
        if "built without its page" in result.stderr:
            self.skipTest("lfvisualizer was built without its page")
        self.assertEqual(result.returncode, 0, result.stderr)
        data = {}
        for path in folder.rglob("*.json.js"):
            name, text = re.fullmatch(r'lfvisualizerFile\("([^"]+)","([^"]+)"\)\n', path.read_text()).groups()
            data[name] = json.loads(base64.b64decode(text))
        return data

    def test_data_of_the_page(self):
        names = {r"scene\.json": "page_scene", r"path/\w+/path\.json": "page_path", r"live\.json": "page_live",
                 r"path/\w+/film\.json": "page_film", r"path/\w+/density/\d+\.json": "page_density",
                 r"camera/\d+\.json": "page_camera"}
        self.succeeds(PROGRAMS / "lfpreprocessor", self.field, self.path, "-o", self.folder / "packages", "-q")
        lens = self.folder / "lens.yaml"
        lens.write_text(self.path.read_text().replace("lens:", "lens:\n  transmission: \"00ff/ff00\""))
        ranged = small_field.write_field(self.folder / "ranged", lf_depth_range=[0.2, 3])
        for words in ([self.densified, self.still_path], [ranged, lens],
                      [self.field, self.path, *(self.folder / "packages").glob("*.lfp")]):
            data = self.exported(*words)
            for file, instance in data.items():
                schemas = [schema for pattern, schema in names.items() if re.fullmatch(pattern, file)]
                self.assertEqual(len(schemas), 1, file)
                self.valid(schemas[0], instance)
        for schema in names.values():
            self.covered(schema)

    # --describe

    def test_descriptions_of_programs(self):
        commands = ["lfr", "lffocus", *(call for call in OFFERED if call not in ("lfr", "lffocus"))]
        for call in commands:
            program, *words = call.split()
            text = self.succeeds(PROGRAMS / program, *words, "--describe")
            self.assertEqual(self.valid("program", json.loads(text))["name"], call)
        self.covered("program")


if __name__ == "__main__":
    PROGRAMS, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    del sys.argv[1:3]
    unittest.main()
