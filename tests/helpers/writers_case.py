# SPDX-License-Identifier: Apache-2.0
"""Calls of all programs on a tiny light field, in several ways each, and digests of what they write."""
import contextlib
import hashlib
import json
import pathlib
import re
import shutil
import sqlite3
import subprocess
import tempfile

from program_test_case import ProgramTestCase

TEMPORARY = re.compile(r"^\..*\.tmp(\.[^.]*)?$|\.unfinished")
TINY = ("--count", 9, "--size", "48x32", "--samples", 1, "--format", "png")
# The files that are results; the others are reports, which contain times.
KINDS = {"lfrenderer": "frame_*", "lfmerge": "frame_*", "lfsubmit": "frame_*", "lfpreprocessor": "*.lfp",
         "lfcompressor": "*.lfs", "lfdensify": "*.lfs", "lfimport": "*.json", "lfexample": "*.yaml", "lfpath": "*.json",
         "lfquilt": "film*", "lfcompare": "**/*.png", "lfsynth": "**/[!.]*", "lffocus stack": "*stack*",
         "lffocus through": "[!.]*_*.exr", "lffocus depth": "depth.*", "lffocus sharp": "*.exr", "lffocus epi": "*.png",
         "lffocus views": "*", "lfvisualizer": "**/*.js"}
# Further calls of these programs, which write files of other kinds.
VARIANTS = {"lffocus stack": ("a folder", "a video"), "lffocus through": ("two files",), "lfquilt": ("a video",)}


class WritersCase(ProgramTestCase):
    """The ways "a" and "b" of a call differ in an option, "a" and "c" in an input that has the same name and form."""
    programs = pathlib.Path(".")

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.world = pathlib.Path(temporary.name)
        cls.field, cls.path, cls.other = cls.world / "field", cls.world / "path.yaml", cls.world / "other"
        cls.made("lfsynth", "chart", "-o", cls.field, *TINY)
        cls.made("lfsynth", "chart", "-o", cls.other, *TINY, "--distance", 4)
        cls.made("lfexample", cls.field, "-o", cls.path, "--move", "dolly", "--focus", "3")
        text = re.sub(r"(?m)^frames:.*$", "frames: 4", cls.path.read_text())
        cls.path.write_text(re.sub(r"(?m)^resolution:.*$", "resolution: [60, 40]", text))
        (cls.world / "path_c.yaml").write_text(cls.path.read_text().replace("focus_distance: 3", "focus_distance: 2"))
        # A store of the light field with other pixels, which only the settings of its codec tell from the light field.
        cls.made("lfcompressor", cls.field, "-o", cls.world / "lossy.lfs", "--threshold", 20)
        cls.ways = {"a": "nearest", "b": "bilinear", "c": "nearest"}
        for way in "abc":
            field = cls.field_of(way)
            cls.made("lfpreprocessor", field, cls.path, "-o", cls.world / f"packages_{way}", "--packages", "2",
                     "--estimator", cls.ways[way])
            for shard in ("1/2", "2/2"):
                cls.made("lfrenderer", field, cls.path, "-o", cls.world / f"cut_{way}", "--shard", shard,
                         "--estimator", cls.ways[way])
            pictures = cls.world / f"pictures_{way}"
            pictures.mkdir()
            source = cls.other if way == "c" else cls.field
            for number, image in enumerate(sorted(source.rglob("*.png"), reverse=way == "b"), 1):
                shutil.copy(image, pictures / f"frame_{number:04d}.png")
        cls.expected = {}

    @classmethod
    def field_of(cls, way):
        return cls.world / "lossy.lfs" if way == "c" else cls.field

    @classmethod
    def made(cls, program, *arguments):
        subprocess.run([cls.programs / program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    @classmethod
    def calls(cls):
        """Returns the names of all calls: programs, commands of lffocus, and variants of both."""
        names = [name for name in KINDS if (cls.programs / name.split()[0]).exists()]
        return names + [f"{name}, {variant}" for name in names for variant in VARIANTS.get(name, ())]

    def words(self, call, way, out):
        """Returns the words of a call that writes to `out`. Its ways write different files of the same names."""
        is_b, estimator, pictures = way == "b", self.ways[way], self.world / f"pictures_{way}"
        field, other = self.field_of(way), self.other if way == "c" else self.field
        path = self.world / "path_c.yaml" if way == "c" else self.path
        packages = sorted((self.world / f"packages_{way}").glob("*.lfp"))
        stack = [field, self.path, "--planes", 2, "--near", 2, "--far", 4 + is_b, "-o"]
        through = [field, self.path, "--statistic", "max" if is_b else "min", "-o"]
        depth = [other, self.path, "--planes", 3, "--near", 2, "--far", 4 + is_b, "--confidence", 0, "--fill", "-o"]
        quilt = [pictures, "--layout", "over-under" if is_b else "side-by-side", "-o"]
        return [str(word) for word in {
            "lfrenderer": [field, self.path, "-o", out, "--estimator", estimator, "--no-contact-sheet"],
            "lfpreprocessor": [field, self.path, "-o", out, "--packages", 2, "--seed", int(is_b)],
            "lfmerge": [self.world / f"cut_{way}" / "partial" / "shards", "-o", out, "--no-contact-sheet"],
            "lfcompressor": [other, "-o", out / "store.lfs", "--threshold", 2 + 6 * is_b],
            "lfdensify": [other, "-o", out / "store.lfs", "--depths", 0.2, 10, "--force", "--most", 60, "--spacing",
                          0.25 + 0.05 * is_b],
            "lfsynth": ["chart", "-o", out, *TINY, "--distance", 3 + is_b],
            "lfimport": [other, "-o", out, "--unit-m", 1 + is_b, "--check", "none"],
            "lfexample": [other, "-o", out / "path.yaml", "--focus", 3 + is_b],
            "lfpath": [path, "-o", out / "path.json", "--scale", 1 + is_b],
            "lfquilt": [*sorted(pictures.glob("*.png")), "-o", out / "film.png", "--views", "3x3"],
            "lfquilt, a video": [*sorted(pictures.glob("*.png"))[:8], *quilt[1:], out / "film.mp4"],
            "lfcompare": [self.world / "pictures_a", self.world / "pictures_c", "-o", out / "seen", "--show",
                          "difference" if is_b else "flip"],
            "lfsubmit": [*packages, "-o", out, "--jobs", 2, "--", "--estimator", estimator],
            "lfvisualizer": [other, path, "--export", out / "page", "--seed", int(is_b), "--max-images", 3],
            "lffocus stack": [*stack, out / "stack.exr"],
            "lffocus stack, a folder": [*stack, out / "stack"],
            "lffocus stack, a video": [*stack, out / "stack.mp4"],
            "lffocus through": [*through, out, "--frames", "1-2"],
            "lffocus through, two files": [*through, out / "of_8.exr", "-o", out / "of_16.exr"],
            "lffocus depth": [*depth, out / "depth.exr", "-o", out / "depth.ply"],
            "lffocus sharp": [*depth[:-2], "-o", out / "sharp.exr"],
            "lffocus epi": [other, "--row", 9 + is_b, "-o", out / "epi.png"],
            "lffocus views": [self.other if is_b else other, "--grid", "3x3", "-o", out, "--focus-distance", 3],
        }[call]]

    def command(self, call, way, out, *more):
        words = self.words(call, way, out)
        cut = words.index("--") if "--" in words else len(words)
        program, *command = call.partition(",")[0].split()
        return [str(self.programs / program), *command, *words[:cut], *map(str, more), *words[cut:]]

    @staticmethod
    def digest(path):
        """Returns the sha256 of a file's content, which does not depend on the file's folder or the order of writing.
        The folder, the place of the light field and the random number of a store are left out."""
        content = path.read_bytes()
        if path.suffix in (".lfp", ".lfs"):
            with contextlib.closing(sqlite3.connect(f"file:{path}?immutable=1", uri=True)) as database:
                tables = [name for name, in database.execute("select name from sqlite_master where type = 'table'")]
                rows = [(table, row) for table in tables for row in database.execute(f"select * from {table}")
                        if not str(row[0]).startswith(("folder", "store", "light_field.path"))]
            content = repr(sorted(map(repr, rows))).encode()
        elif path.name == "transforms.json":
            field = json.loads(content)
            names = [frame.pop("file_path").rpartition("/")[2] for frame in field["frames"]]
            field = {key: value for key, value in field.items() if not isinstance(value, str)}
            content = json.dumps([field, names], sort_keys=True).encode()
        return hashlib.sha256(content).hexdigest()

    @classmethod
    def files(cls, call, out):
        """Returns digests of the results of a call."""
        found = out.glob(KINDS[call.partition(",")[0]])
        whole = [file for path in found for file in ([path] if path.is_file() else path.glob("frame_*"))]
        return {str(path.relative_to(out)): cls.digest(path) for path in sorted(whole)}

    def expect(self, call, way):
        """Returns the digests of the files that the call makes when it runs alone. The call runs only once for all
        tests."""
        if (call, way) not in self.expected:
            out = self.world / f"{call}_{way}"
            out.mkdir()
            result = subprocess.run(self.command(call, way, out), capture_output=True, text=True, timeout=240)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.expected[call, way] = self.files(call, out)
            self.assertTrue(self.expected[call, way])
        return self.expected[call, way]

    def leftovers(self, out):
        return [str(path) for path in out.rglob("*") if TEMPORARY.search(path.name)]
