# SPDX-License-Identifier: Apache-2.0
"""A tiny light field, a film of two frames, and one call of every program."""
import subprocess

SIZE = "48x32"


class Call:
    """One call of a program that writes into one folder.

    name      of the program, and of the mode
    command   words; the first is the program
    again     commands that resume after a failure; all but the last may refuse
    before    commands that first write other results into the same folder
    victim    name of the program that is disturbed, if it is a child of the first
    prints    True if the standard output is the result
    """

    def __init__(self, name, command, again=None, before=(), victim=None, prints=False):
        self.name, self.command, self.again = name, command, again or [command]
        self.before, self.prints = before, prints
        self.victim = victim or command[0].name


class TinyCalls:
    """Makes the inputs in a folder once, and returns the calls.

    programs  folder of the programs
    base      folder for the inputs
    out       file or folder that calls write, without an extension; must lie in a folder of its own
    """

    def __init__(self, programs, base, out, threads=1):
        self.programs, self.base, self.out = programs, base, out
        self.set_threads(threads)
        self.field, self.path, self.other_path = base / "field", base / "path.yaml", base / "other.yaml"
        self.packages, self.other_packages, self.shards = base / "packages", base / "others", base / "shards"
        self.depths = base / "depths.ply"

    def set_threads(self, threads):
        self.end = ["--threads", str(threads), "-q"]

    def words(self, program, *words):
        return [self.programs / program, *map(str, words), *self.end]

    def synth(self, out, *more):
        return self.words("lfsynth", "chart", "--count", "9", "--size", SIZE, "--samples", "1", "--format", "png",
                          "-o", out, *more)

    def render(self, *more, path=None):
        return self.words("lfrenderer", self.field, path or self.path, "--frames", "1-2", *more)

    def example(self, out, focus="3"):
        return self.words("lfexample", self.field, "-o", out, "--move", "dolly", "--focus", focus)

    def preprocess(self, path, out, *more):
        return self.words("lfpreprocessor", self.field, path, "-o", out, "--packages", "2", "--frames", "1-2", *more)

    def quilt(self, *more, reverse=False):
        """Returns a call of lfquilt that joins the LF images."""
        images = sorted(self.field.rglob("*.png"), reverse=reverse)
        return self.words("lfquilt", *images, "-o", self.out.with_suffix(".png"), "--views", f"{len(images)}x1", *more)

    def prepare(self):
        self.base.mkdir(exist_ok=True)
        commands = [self.synth(self.field), self.example(self.path), self.example(self.other_path, "4"),
                    self.preprocess(self.path, self.packages), self.preprocess(self.other_path, self.other_packages)]
        commands += [self.render("-o", self.shards, "--shard", shard) for shard in ("1/2", "2/2")]
        commands.append(self.words("lffocus", "depth", self.field, self.path, "--planes", "3", "--near", "2",
                                   "--far", "4", "--confidence", "0", "--fill", "-o", self.depths))
        for command in commands:
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)

    def submit(self, *more, packages=None):
        """Returns a call of lfsubmit that runs its packages one after the other."""
        files = map(str, sorted((packages or self.packages).glob("*.lfp")))
        return [self.programs / "lfsubmit", *files, "-o", str(self.out), "--jobs", "1",
                "--progress", "none", "-q", *more]

    def writers(self):
        """Returns the calls of all programs that write files, each into an empty folder."""
        out = self.out
        film = self.render("-o", out, "--dump-every", "0.001s", "--keep-plates")
        hybrid = self.render("-o", out, "--format", "png16", "--mode", "hybrid")
        rebin = self.render("-o", out, "--mode", "rebin")
        synth, convert = self.synth(out), self.words("lfimport", self.field, "-o", out)
        store = self.words("lfcompressor", self.field, "-o", out.with_suffix(".lfs"))
        shards = [*store, "--shard-size", "4k"]
        groups = [*shards, "--profile", "group-lossless"]
        dense = self.words("lfdensify", self.field, "-o", out.with_suffix(".lfs"), "--depths", 0.2, 10,
                           "--spacing", 0.25, "--force", "--most", 60)
        packages = self.preprocess(self.path, out)
        convert_path = [self.programs / "lfpath", str(self.path), "-o", str(out.with_suffix(".json")), "-q"]
        merge = self.words("lfmerge", self.shards / "partial" / "shards", "-o", out)
        stack = self.words("lffocus", "stack", self.field, self.path, "--planes", "2", "--near", "2", "--far", "4",
                           "-o", out.with_suffix(".exr"))
        epi = self.words("lffocus", "epi", self.field, "--row", "9", "-o", out.with_suffix(".png"))
        depth = self.words("lffocus", "depth", self.field, self.path, "--planes", "3", "--near", "2", "--far", "4",
                           "--confidence", "0", "-o", out.with_suffix(".exr"), "-o", out.with_suffix(".ply"))
        sharp = self.words("lffocus", "sharp", self.field, self.path, "--planes", "3", "--near", "2", "--far", "4",
                           "--confidence", "0", "-o", out.with_suffix(".png"))
        through = self.words("lffocus", "through", self.field, self.path, "-o", out.with_suffix(".exr"))
        through_film = self.words("lffocus", "through", self.field, self.path, "--frames", "1-2", "-o", out)
        views = self.words("lffocus", "views", self.field, "--grid", "3x3", "-o", out)
        array = self.words("lffocus", "views", self.field, "--grid", "2x4", "--focus-distance", "3", "-o",
                           out.with_suffix(".npy"))
        quilt = self.quilt()
        images = sorted(self.field.rglob("*.png"))
        compare = self.words("lfcompare", *images[:2], "-o", out.with_suffix(".png"))
        compare_films = self.words("lfcompare", self.field / "images", self.field / "images", "-o", out)
        return [Call("lfsynth", synth, [[*synth, "--overwrite"]]),
                Call("lfimport", convert, [[*convert, "--force"]]),
                Call("lfexample", self.words("lfexample", self.field, "-o", out.with_suffix(".yaml"))),
                Call("lfpath", convert_path, [[*convert_path, "--overwrite"]]),
                Call("lfpreprocessor", packages, [[*packages, "--overwrite"]]),
                Call("lfcompressor", store, [[*store, "--resume"], [*store, "--overwrite"]]),
                Call("lfcompressor, shards", shards, [[*shards, "--resume"], [*shards, "--overwrite"]]),
                Call("lfcompressor, groups", groups, [[*groups, "--resume"], [*groups, "--overwrite"]]),
                Call("lfdensify", dense, [[*dense, "--resume"], [*dense, "--overwrite"]]),
                Call("lfrenderer, collect", film, [[*film, "--resume"]]),
                Call("lfrenderer, hybrid", hybrid, [[*hybrid, "--resume"]]),
                Call("lfrenderer, rebin", rebin, [[*rebin, "--resume"]]),
                Call("lfmerge", merge, [[*merge, "--resume"], [*merge, "--overwrite"]]),
                Call("lffocus stack", stack, [[*stack, "--resume"], [*stack, "--overwrite"]]),
                Call("lffocus epi", epi, [[*epi, "--overwrite"]]),
                Call("lffocus depth", depth, [[*depth, "--overwrite"]]),
                Call("lffocus sharp", sharp, [[*sharp, "--overwrite"]]),
                Call("lffocus through", through, [[*through, "--overwrite"]]),
                Call("lffocus through, a film", through_film, [[*through_film, "--resume"]]),
                Call("lffocus views", views, [[*views, "--overwrite"]]),
                Call("lffocus views, an array", array, [[*array, "--overwrite"]]),
                Call("lfquilt", quilt, [[*quilt, "--resume"], [*quilt, "--overwrite"]]),
                Call("lfcompare", compare, [[*compare, "--overwrite"]]),
                Call("lfcompare, folders", compare_films, [[*compare_films, "--overwrite"]])]

    def submitters(self):
        """Returns calls of lfsubmit, in which lfsubmit or its lfrenderer is disturbed, and calls that resume or
        overwrite a job."""
        job = self.submit()
        resume = [self.programs / "lfsubmit", "--resume", str(self.out), "--progress", "none"]
        again = [resume, [*job, "--overwrite"]]
        lost = ["rm", str(self.out / "frame_0002.exr"), str(self.out / "contact_sheet.png")]
        return [Call("lfsubmit", job, again),
                Call("lfsubmit, its lfrenderer", job, again, victim="lfrenderer"),
                Call("lfsubmit --resume", resume, again, before=[job, lost]),
                Call("lfsubmit --overwrite", again[-1], before=[self.submit(packages=self.other_packages)])]

    def overwriters(self):
        """Returns calls that overwrite results of other inputs."""
        out, other = self.out, self.other_path
        film = self.render("-o", out, "--overwrite")
        store = self.words("lfcompressor", self.field, "-o", out.with_suffix(".lfs"))
        shards, anew, resume = [*store, "--shard-size", "4k"], ["--overwrite"], ["--resume"]
        packages = self.preprocess(self.path, out, "--overwrite")
        merge = self.words("lfmerge", self.shards / "partial" / "shards", "-o", out)
        synth = self.synth(out, "--overwrite")
        path = [*self.example(out.with_suffix(".yaml")), *anew]
        convert = self.words("lfimport", self.field, "-o", out, "--force")
        old_import = self.words("lfimport", self.field, "-o", out, "--scale", "2")
        return [Call("lfsynth --overwrite", synth, before=[self.synth(out, "--spacing", "0.03")]),
                Call("lfimport --force", convert, before=[old_import]),
                Call("lfexample --overwrite", path, before=[self.example(out.with_suffix(".yaml"), "4")]),
                Call("lfpreprocessor --overwrite", packages, before=[self.preprocess(other, out)]),
                Call("lfcompressor --overwrite", store + anew, [store + resume, store + anew],
                     before=[[*store, "--threshold", "20"]]),
                Call("lfcompressor --overwrite, shards", shards + anew, [shards + resume, shards + anew],
                     before=[[*shards, "--threshold", "20"]]),
                Call("lfrenderer --overwrite", film, [self.render("-o", out, "--resume"), film],
                     before=[self.render("-o", out, path=other)]),
                Call("lfmerge --overwrite", merge + anew, [merge + resume, merge + anew],
                     before=[self.render("-o", out, path=other)]),
                Call("lfquilt --overwrite", self.quilt(*anew), before=[self.quilt(reverse=True)])]

    def printers(self):
        """Returns the calls of programs that print, and of one that writes a page."""
        view = [self.programs / "lfvisualizer", str(self.field), str(self.path)]
        export = [*view, "--depth", str(self.depths), "--export", str(self.out)]
        anew = ["sh", "-c", 'rm -rf "$1"; shift; exec "$@"', "sh", str(self.out), *map(str, export)]
        return [Call("lfcammvminfo", [self.programs / "lfcammvminfo", str(self.path)], prints=True),
                Call("lfvisualizer --text", [*view, "--text"], prints=True),
                Call("lfvisualizer --export", export, [anew])]
