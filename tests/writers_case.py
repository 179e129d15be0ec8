# SPDX-License-Identifier: Apache-2.0
"""Calls of all programs on a tiny light field, in two ways each, and digests of what they write."""
import contextlib
import hashlib
import json
import pathlib
import re
import sqlite3
import subprocess
import tempfile

from program_test_case import ProgramTestCase

TEMPORARY = re.compile(r"^\..*\.tmp(\.[^.]*)?$|\.unfinished")


class WritersCase(ProgramTestCase):
    programs = pathlib.Path(".")

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.world = pathlib.Path(temporary.name)
        field, path = cls.world / "field", cls.world / "path.yaml"
        cls.field, cls.path = field, path
        cls.made("lfsynth", "chart", "-o", field, "--count", "9", "--size", "48x32", "--samples", "1",
                 "--format", "png")
        cls.made("lfexample", field, "-o", path, "--move", "dolly", "--focus", "3")
        text = re.sub(r"(?m)^frames:.*$", "frames: 4", path.read_text())
        path.write_text(re.sub(r"(?m)^resolution:.*$", "resolution: [60, 40]", text))
        cls.ways = {"a": "nearest", "b": "bilinear"}
        for way, estimator in cls.ways.items():
            cls.made("lfpreprocessor", field, path, "-o", cls.world / f"packages_{way}", "--packages", "2",
                     "--estimator", estimator)
            for shard in ("1/2", "2/2"):
                cls.made("lfrenderer", field, path, "-o", cls.world / f"cut_{way}", "--shard", shard, "--estimator",
                         estimator)
        cls.expected = {}

    @classmethod
    def made(cls, program, *arguments):
        subprocess.run([cls.programs / program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    def words(self, program, way, out):
        """Returns a call that writes to `out`. The ways "a" and "b" write different files of the same names."""
        estimator = self.ways[way]
        return [str(word) for word in {
            "lfrenderer": [self.field, self.path, "-o", out, "--estimator", estimator, "--no-contact-sheet"],
            "lfpreprocessor": [self.field, self.path, "-o", out, "--packages", 2, "--seed", int(way == "b")],
            "lfmerge": [self.world / f"cut_{way}" / "partial" / "shards", "-o", out, "--no-contact-sheet"],
            "lfcompressor": [self.field, "-o", out / "store.lfs", "--threshold", 2 + 6 * (way == "b")],
            "lfdensify": [self.field, "-o", out / "store.lfs", "--depths", 0.2, 10, "--force", "--most", 60,
                          "--spacing", 0.25 + 0.05 * (way == "b")],
            "lfsynth": ["chart", "-o", out, "--count", 9, "--size", "32x24", "--samples", 1, "--format", "png",
                        "--distance", 3 + (way == "b")],
            "lfimport": [self.field, "-o", out, "--unit-m", 1 + (way == "b"), "--check", "none"],
            "lfexample": [self.field, "-o", out / "path.yaml", "--focus", 3 + (way == "b")],
            "lfquilt": [*sorted(self.field.rglob("*.png"), reverse=way == "b"), "-o", out / "film.png", "--views",
                        "3x3"],
            "lfsubmit": [*sorted((self.world / f"packages_{way}").glob("*.lfp")), "-o", out, "--jobs", 2,
                         "--", "--estimator",
                         estimator],
        }[program]]

    def command(self, program, way, out, *more):
        words = self.words(program, way, out)
        cut = words.index("--") if "--" in words else len(words)
        return [str(self.programs / program), *words[:cut], *more, *words[cut:]]

    @staticmethod
    def digest(path):
        """Returns the sha256 of a file's content, which does not depend on the file's folder or the order of writing.
        The folder and the random number of a store are left out."""
        content = path.read_bytes()
        if path.suffix in (".lfp", ".lfs"):
            with contextlib.closing(sqlite3.connect(f"file:{path}?immutable=1", uri=True)) as database:
                tables = [name for name, in database.execute("select name from sqlite_master where type = 'table'")]
                rows = [(table, row) for table in tables for row in database.execute(f"select * from {table}")
                        if not str(row[0]).startswith(("folder", "store"))]
            content = repr(sorted(map(repr, rows))).encode()
        elif path.name == "transforms.json":
            field = json.loads(content)
            names = [frame.pop("file_path").rpartition("/")[2] for frame in field["frames"]]
            field = {key: value for key, value in field.items() if not isinstance(value, str)}
            content = json.dumps([field, names], sort_keys=True).encode()
        return hashlib.sha256(content).hexdigest()

    @classmethod
    def files(cls, program, out):
        """Returns digests of a program's results, without reports, which contain times."""
        kinds = {"lfrenderer": "frame_*", "lfmerge": "frame_*", "lfsubmit": "frame_*", "lfpreprocessor": "*.lfp",
                 "lfcompressor": "*.lfs", "lfdensify": "*.lfs", "lfimport": "*.json", "lfexample": "*.yaml",
                 "lfquilt": "*.png",
                 "lfsynth": "**/[!.]*"}
        return {str(path.relative_to(out)): cls.digest(path)
                for path in sorted(out.glob(kinds[program])) if path.is_file()}

    def expect(self, program, way):
        """Returns the digests of the files that the call makes when it runs alone. The call runs only once for all
        tests."""
        if (program, way) not in self.expected:
            out = self.world / f"{program}_{way}"
            out.mkdir()
            result = subprocess.run(self.command(program, way, out), capture_output=True, text=True, timeout=240)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.expected[program, way] = self.files(program, out)
            self.assertTrue(self.expected[program, way])
        return self.expected[program, way]

    def leftovers(self, out):
        return [str(path) for path in out.rglob("*") if TEMPORARY.search(path.name)]
