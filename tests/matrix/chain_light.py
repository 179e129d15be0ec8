# SPDX-License-Identifier: Apache-2.0
"""Chains of light fields and packages: each program that writes one, and each program that reads one."""
import base64
import hashlib
import json

from chain_world import World, seen_frames, seen_numbers, seen_picture, seen_words, without_folders
from exr_file import channels_of, parts_of
from matrix_world import once

import numpy as np

PLANES = ("--near", 0.2, "--far", 0.4, "--planes", 5)


class LightChains(World):
    """Light fields are written by light_NAME(flaws), which returns a file or folder, and read by see_NAME(light_field,
    flaws), which returns what the reader shows."""

    # Writers of light fields

    def light_import(self, flaws):
        return self.make("lfimport", self.field(flaws), to=self.new_folder("native"))

    @once
    def light_store(self, flaws):
        return self.make("lfcompressor", self.field(flaws), "--profile", "lossless", to=self.new_folder("a.lfs"))

    @once
    def light_lossy_store(self, flaws):
        return self.make("lfcompressor", self.field(flaws), to=self.new_folder("a.lfs"))

    @once
    def packages_of(self, flaws):
        """Returns the folder of the packages of a film."""
        return self.make("lfpreprocessor", self.field(flaws), self.path("plain", flaws), "--packages", 2,
                         to=self.new_folder("packages"))

    @once
    def light_store_of_packages(self, flaws):
        return self.make("lfcompressor", *sorted(self.packages_of(flaws).glob("*.lfp")), "--profile", "lossless",
                         to=self.new_folder("a.lfs"))

    @once
    def light_needed_pixels(self, flaws):
        return self.make("lfcompressor", *sorted(self.packages_of(flaws).glob("*.lfp")), "--needed-pixels",
                         "--profile", "lossless", to=self.new_folder("a.lfs"))

    @once
    def light_densified(self, flaws):
        return self.make("lfdensify", self.field(flaws), "--force", "--most", 60, "--spacing", 0.5, "--depths",
                         *((0.2, 0.4) if flaws != "synth" else (1, 4)), to=self.new_folder("dense.lfs"))

    @once
    def light_densified_film(self, flaws):
        out = self.make("lfrenderer", self.field(flaws), self.path("fine", flaws), "--densify",
                        "--no-contact-sheet", to=self.new_folder("film"))
        return out / "densified.lfs"

    def views(self, flaws, values):
        columns = json.loads((self.field(flaws) / "transforms.json").read_text())["frames"]
        side = round(len(columns) ** 0.5)
        return self.make("lffocus views", self.field(flaws), "--grid", f"{side}x{side}", "--values", values,
                         to=self.new_folder("views"))

    @once
    def light_views(self, flaws):
        return self.views(flaws, "srgb8")

    @once
    def light_views_16(self, flaws):
        return self.views(flaws, "srgb16")

    @once
    def light_linear_views(self, flaws):
        return self.views(flaws, "linear")

    # Readers of light fields

    def film(self, *inputs, options=(), rest=()):
        out = self.new_folder("film")
        self.run("lfrenderer", *inputs, "-o", out, "--format", "exr-float", "--no-contact-sheet", *options, rest=rest)
        return seen_frames(out)

    def see_film(self, light_field, flaws):
        return self.film(light_field, self.path("plain", flaws))

    def see_rebinned_film(self, light_field, flaws):
        return self.film(light_field, self.path("plain", flaws), options=("--mode", "rebin", "--max-rays", 2000000))

    def see_packages(self, light_field, flaws):
        packages = self.make("lfpreprocessor", light_field, self.path("plain", flaws), "--packages", 2,
                             to=self.new_folder("packages"))
        return self.film(*sorted(packages.glob("*.lfp")))

    def see_plan(self, light_field, flaws):
        text, _ = self.run("lfpreprocessor", light_field, self.path("plain", flaws), "--plan", "--json")
        forecast = json.loads(text)
        return seen_numbers({key: forecast[key] for key in ("frames", "lf_images") if key in forecast})

    def see_store(self, light_field, flaws):
        # Encoded images of a packed store are copied as they are.
        profile = () if str(light_field).endswith(".lfs") else ("--profile", "lossless")
        store = self.make("lfcompressor", light_field, *profile, to=self.new_folder("b.lfs"))
        return self.see_film(store, flaws)

    def see_densified_film(self, light_field, flaws):
        store = self.make("lfdensify", light_field, "--force", "--most", 60, "--spacing", 0.5, "--depths",
                          *((0.2, 0.4) if flaws != "synth" else (1, 4)), to=self.new_folder("dense.lfs"))
        return self.film(store, self.path("plain", flaws), options=("--no-guard",) if flaws == "mosaic" else ())

    def see_report(self, light_field, flaws):
        """Sees what lfimport says of the LF cameras."""
        report = json.loads(self.run("lfimport", light_field, "--json")[0])
        seen = {key: report[key] for key in ("positions_w", "spacing_w", "depth_range_w", "unit_m")}
        for camera in report["cameras"]:
            del camera["images"]  # virtual LF images have cameras of their own
        return seen_numbers({**seen, "camera": report["cameras"][0], "alpha": json.dumps(report["alpha"])})

    def see_example(self, light_field, flaws):
        file = self.make("lfexample", light_field, to=self.new_folder("path.yaml"))
        # The last line is a hash of the others, which name the light field.
        return seen_words(file.read_text().rpartition("# Not edited")[0], light_field)

    def picture(self, call, *words):
        file = self.make(call, *words, to=self.new_folder("picture.exr"))
        return {f"frame.{name}": values for name, values in channels_of(file).items()}

    def planes(self, flaws):
        return PLANES if flaws != "synth" else ("--near", 1, "--far", 4, "--planes", 5)

    def see_stack(self, light_field, flaws):
        file = self.make("lffocus stack", light_field, self.path("plain", flaws), *self.planes(flaws),
                         to=self.new_folder("stack.exr"))
        return {f"{header['name']}.{name}": values for header, channels in parts_of(file)
                for name, values in channels.items()}

    def see_depth(self, light_field, flaws):
        return self.picture("lffocus depth", light_field, self.path("plain", flaws), *self.planes(flaws),
                            "--confidence", 0)

    def see_sharp(self, light_field, flaws):
        return self.picture("lffocus sharp", light_field, self.path("plain", flaws), *self.planes(flaws))

    def see_through(self, light_field, flaws):
        return self.picture("lffocus through", light_field, self.path("plain", flaws))

    def see_epi(self, light_field, flaws):
        return self.picture("lffocus epi", light_field, "--row", 16)

    def see_views(self, light_field, flaws):
        file = self.make("lffocus views", light_field, "--grid", "3x3", "--values", "linear",
                         *(("--focus-distance", 0.25) if flaws != "synth" else ("--focus-distance", 2)),
                         to=self.new_folder("views.npy"))
        views = np.load(file)
        return {f"view {row} {column}.{'RGB'[channel]}": views[row, column, ..., channel]
                for row in range(3) for column in range(3) for channel in range(3)}

    def see_scene(self, light_field, flaws):
        text, _ = self.run("lfvisualizer", light_field, self.path("plain", flaws), "--text")
        return seen_words(text, light_field)

    def see_page(self, light_field, flaws):
        folder = self.new_folder("page")
        self.run("lfvisualizer", light_field, self.path("plain", flaws), "--export", folder)
        seen = {}
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            name = str(file.relative_to(folder))
            is_picture = file.suffix in (".jpg", ".png")
            seen.update(seen_picture(file, name) if is_picture else {name: seen_file(file, light_field)})
        return seen

    def see_unit_and_focus(self, light_field, flaws):
        """Sees a path of another program that takes unit and focus from the light field."""
        chan = self.new_folder("a.chan")
        chan.write_text("1 0 0 0 0 0 0 40\n2 0.01 0 0 0 0 0 40\n")
        file = self.make("lfpath", chan, "--lightfield", light_field, to=self.new_folder("path.yaml"))
        return seen_words(file.read_text(), light_field, chan)

    def see_cameras(self, light_field, flaws):
        """Sees the LF cameras as frames of a path."""
        path = json.loads(self.run("lfcammvminfo", light_field, "--json")[0])
        cameras = sorted(path["cameras"], key=lambda camera: [round(x, 6) for x in camera["position_w"]])
        for camera in cameras:
            del camera["frame"], camera["time_s"]
        return seen_numbers(cameras)


def seen_file(file, light_field):
    """Returns the digest of a file of the page. Descriptions are without the name of the light field, and without the
    folders of its images."""
    content = file.read_bytes()
    if file.name.endswith(".json.js"):
        text = base64.b64decode(content.split(b'"')[3]).decode()
        content = without_folders(text.replace(str(light_field), "FILE")).encode()
    return hashlib.sha256(content).hexdigest()
