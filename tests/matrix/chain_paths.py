# SPDX-License-Identifier: Apache-2.0
"""Chains of camera paths: each format that a program writes, and each program that reads one."""
import json
import math

from chain_world import seen_numbers, seen_words
from exr_file import channels_of
from matrix_world import once

# Paths with which chains are tried: those of chain_world, the one of lfexample, and paths with several views.
KINDS = ("plain", "lens", "shutter", "surface", "example", "stereo", "quilt")
# The lens and the picture of the path `still`.
LENS = ("--aperture-diameter-mm", 24, "--focus-distance", 0.25, "--resolution", "40x30", "--fps", 25,
        "--sensor-width-mm", 70 * math.tan(math.radians(20)))
VIEWS = {"stereo": ("--stereo", 0.01, "--convergence", 0.27),
         "quilt": ("--quilt", "3x1", "--view-angle", 4, "--convergence", 0.27)}


class PathChains:
    """Camera paths of a film of the light field `masks`. They are written by path_NAME(flaws), and read by
    see_path_NAME(path, flaws)."""

    @once
    def original_path(self, flaws):
        if flaws == "example":
            return self.example("masks")
        if flaws in VIEWS:
            return self.convert(self.path("plain"), "views.json", *VIEWS[flaws])
        return self.path(flaws)

    def convert(self, path, name, *options):
        folder = self.new_folder(name)
        for surface in path.parent.glob("depth_*.pfm"):  # a path names its surface relative to its folder
            (folder.parent / surface.name).hardlink_to(surface)
        return self.make("lfpath", path, "--lightfield", self.field("masks"), *options, to=folder)

    # Writers

    @once
    def path_yaml(self, flaws):
        return self.convert(self.original_path(flaws), "a.yaml")

    @once
    def path_nerfstudio(self, flaws):
        return self.convert(self.original_path(flaws), "a.json")

    @once
    def path_ngp(self, flaws):
        return self.convert(self.original_path(flaws), "a.json", "--format", "instant-ngp")

    @once
    def path_chan(self, flaws):
        """Returns a path whose lens is stated again, which the file does not keep."""
        chan = self.convert(self.path("still") if flaws == "plain" else self.original_path(flaws), "a.chan")
        path = self.convert(chan, "b.json", *LENS)
        self.texts[path] += self.texts[chan]
        return path

    @once
    def path_usda(self, flaws):
        return self.convert(self.original_path(flaws), "a.usda")

    @once
    def path_round_trip(self, flaws):
        """Returns a path that went through all formats that keep a lens."""
        path, said = self.path_nerfstudio(flaws), ""
        for name, options in (("b.json", ("--format", "instant-ngp")), ("c.yaml", ()), ("d.json", ())):
            said += self.texts[path]
            path = self.convert(path, name, *options)
        self.texts[path] += said
        return path

    @once
    def path_slower(self, flaws):
        """Returns a path of three moments instead of two."""
        views = {"stereo": 2, "quilt": 3}.get(flaws, 1)
        return self.convert(self.original_path(flaws), "slower.json", "--frames", 3 * views)

    @once
    def direct_slower(self, flaws):
        """Returns the path whose moments are resampled before it gets its views."""
        return self.convert(self.convert(self.path("plain"), "slow.json", "--frames", 3), "views.json", *VIEWS[flaws])

    # Readers

    def see_path_film(self, path, flaws):
        return self.film(self.field("masks"), path)

    def see_path_packages(self, path, flaws):
        packages = self.make("lfpreprocessor", self.field("masks"), path, "--packages", 2,
                             to=self.new_folder("packages"))
        return self.film(*sorted(packages.glob("*.lfp")))

    def see_path_cameras(self, path, flaws):
        del flaws
        return seen_numbers(json.loads(self.run("lfcammvminfo", path, "--json")[0]))

    def see_path_poses(self, path, flaws):
        cameras = self.see_path_cameras(path, flaws)
        return {name: value for name, value in cameras.items() if any(word in name for word in (
            "position", "forward", "up", "field_of_view"))}

    def see_path_again(self, path, flaws):
        return self.see_path_cameras(self.convert(path, "again.json"), flaws)

    def see_path_scene(self, path, flaws):
        del flaws
        text, _ = self.run("lfvisualizer", self.field("masks"), path, "--text")
        return seen_words(text, path)

    def of_frame(self, call, path, *words):
        file = self.make(call, self.field("masks"), path, *words, to=self.new_folder("picture.exr"))
        return {f"frame.{name}": values for name, values in channels_of(file).items()}

    def see_path_stack(self, path, flaws):
        del flaws
        out = self.make("lffocus stack", self.field("masks"), path, "--distances", "0.25,0.3", "--format", "exr-float",
                        to=self.new_folder("stack"))
        return {f"{file.stem}.{name}": values for file in sorted(out.glob("frame_*.exr"))
                for name, values in channels_of(file).items()}

    def see_path_depth(self, path, flaws):
        del flaws
        return self.of_frame("lffocus depth", path, "--near", 0.2, "--far", 0.4, "--planes", 5, "--confidence", 0)

    def see_path_sharp(self, path, flaws):
        del flaws
        return self.of_frame("lffocus sharp", path, "--near", 0.2, "--far", 0.4, "--planes", 5)

    def see_path_through(self, path, flaws):
        del flaws
        return self.of_frame("lffocus through", path)

    def see_path_densified(self, path, flaws):
        store = self.make("lfdensify", self.field("masks"), path, "--force", "--most", 30, "--spacing", 0.3,
                          "--depths", 0.2, 0.4,
                          to=self.new_folder("dense.lfs"))
        return self.film(store, path, options=("--no-guard",))

    def see_path_truth(self, path, flaws):
        del flaws
        out = self.new_folder("truth")
        self.run("lfsynth", "chart", "-o", out, "--count", 9, "--size", "48x32", "--calibration-only", "--truth", path,
                 "--truth-samples", 1)
        return {f"{file.stem}.{name}": values for file in sorted((out / "truth").glob("*.exr"))
                for name, values in channels_of(file).items()}

    def eyes(self, path, flaws):
        """Returns the vectors between the first and the last view of each moment."""
        views = {"stereo": 2, "quilt": 3}[flaws]
        cameras = json.loads(self.run("lfcammvminfo", path, "--json")[0])["cameras"]
        places = [camera["position_w"] for camera in cameras]
        return {f"eyes {moment}": [b - a for a, b in zip(places[moment * views], places[moment * views + views - 1])]
                for moment in range(len(places) // views)}
