# SPDX-License-Identifier: Apache-2.0
"""Chains of packages, plates, pictures, depths, videos and jobs: what renders leave, and what reads it."""
import json

from chain_world import seen_frames  # prepares cv2
import cv2
import numpy as np

from exr_file import attributes_of, channels_of, parts_of
from matrix_world import once

SRGB = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)

FLOATS = ("--format", "exr-float", "--no-contact-sheet")
COMPOSITING = ("--colour-space", "acescg", "--frame-alpha", "--z")


class FrameChains:
    # Packages, which see_packages_NAME(folder, flaws) reads. The direct way is the film without packages.

    @once
    def whole_film(self, flaws, *options):
        return self.film(self.field(flaws), self.path("plain", flaws), options=options)

    def see_package_film(self, packages, flaws):
        return self.film(*sorted(packages.glob("*.lfp")))

    def see_package_job(self, packages, flaws):
        return seen_frames(self.submitted(packages))

    def submitted(self, packages, *options):
        out = self.new_folder("job")
        self.run("lfsubmit", *sorted(packages.glob("*.lfp")), "-o", out, "--jobs", 1,
                 rest=("--", *FLOATS[:2], "--allow-missing", 2, *options))
        return out

    def see_package_store(self, packages, flaws):
        """Sees a film of packages whose LF images are in a store of the pixels that they need."""
        files = sorted(packages.glob("*.lfp"))
        store = self.make("lfcompressor", *files, "--needed-pixels", "--profile", "lossless",
                          to=self.new_folder("needed.lfs"))
        return self.film(*files, options=("--lightfield", store))

    # Plates, which see_plates_NAME(folder, flaws) adds. The direct way is the film.

    @once
    def plates_of_shards(self, flaws):
        out = self.new_folder("shards")
        for shard in ("1/2", "2/2"):
            self.run("lfrenderer", self.field(flaws), self.path("plain", flaws), "-o", out, "--shard", shard)
        return out / "partial" / "shards"

    @once
    def plates_kept(self, flaws):
        return self.make("lfrenderer", self.field(flaws), self.path("plain", flaws), "--keep-plates", *FLOATS[2:],
                         to=self.new_folder("kept"))

    @once
    def plates_of_package(self, flaws):
        out = self.new_folder("kept")
        self.run("lfrenderer", *sorted(self.packages_of(flaws).glob("*.lfp")), "-o", out, "--keep-plates", *FLOATS[2:])
        return out

    @once
    def plates_of_job(self, flaws):
        return self.submitted(self.packages_of(flaws), "--keep-plates")

    def merged(self, plates, *options):
        return self.make("lfmerge", plates, *options, to=self.new_folder("merged"))

    def see_plates_merged(self, plates, flaws):
        return seen_frames(self.merged(plates, *FLOATS))

    def see_plates_recoloured(self, plates, flaws):
        return seen_frames(self.merged(plates, *FLOATS, *COMPOSITING))

    def direct_recoloured(self, flaws):
        return self.whole_film(flaws, *COMPOSITING)

    # Pictures: the files of a film, or one. see_pictures_NAME(files, flaws) reads them; the direct way reads them by
    # NumPy alone.

    @once
    def frames(self, flaws, *options):
        out = self.make("lfrenderer", self.field(flaws), self.stereo_path(flaws), *options, "--no-contact-sheet",
                        to=self.new_folder("frames"))
        return tuple(sorted(out.glob("frame_*.[ep][xn][rg]")))

    @once
    def stereo_path(self, flaws):
        return self.make("lfpath", self.path("plain", flaws), "--lightfield", self.field(flaws), "--stereo",
                         0.01 if flaws != "synth" else 0.05, to=self.new_folder("stereo.json"))

    def pictures_exr(self, flaws):
        return self.frames(flaws, "--format", "exr")

    def pictures_float(self, flaws):
        return self.frames(flaws, "--format", "exr-float")

    def pictures_acescg(self, flaws):
        return self.frames(flaws, "--format", "exr-float", *COMPOSITING)

    def pictures_rgb(self, flaws):
        return self.frames(flaws, "--format", "exr", "--channels", "rgb", "--exr-compression", "zips")

    def pictures_png(self, flaws):
        return self.frames(flaws, "--format", "png")

    def pictures_png16(self, flaws):
        return self.frames(flaws, "--format", "png16", "--frame-alpha")

    @once
    def pictures_merged(self, flaws):
        out = self.new_folder("shards")
        for shard in ("1/2", "2/2"):
            self.run("lfrenderer", self.field(flaws), self.stereo_path(flaws), "-o", out, "--shard", shard)
        return tuple(sorted(self.merged(out / "partial" / "shards").glob("frame_*.exr")))

    @once
    def pictures_of_job(self, flaws):
        packages = self.make("lfpreprocessor", self.field(flaws), self.stereo_path(flaws), "--packages", 2,
                             to=self.new_folder("packages"))
        return tuple(sorted(self.submitted(packages).glob("frame_*.exr")))

    @once
    def pictures_through(self, flaws):
        out = self.make("lffocus through", self.field(flaws), self.stereo_path(flaws), "--format", "exr",
                        "--no-contact-sheet", to=self.new_folder("through"))
        return tuple(sorted(out.glob("frame_*.exr")))

    @once
    def pictures_truth(self, flaws):
        out = self.new_folder("truth")
        self.run("lfsynth", "chart", "-o", out, "--count", 9, "--size", "48x32", "--calibration-only", "--truth",
                 self.stereo_path("synth"), "--truth-samples", 1)
        return tuple(sorted((out / "truth").glob("frame_*.exr")))

    @once
    def pictures_stack(self, flaws):
        out = self.make("lffocus stack", self.field(flaws), self.path("plain", flaws), *self.planes(flaws),
                        to=self.new_folder("stack"))
        return tuple(sorted(out.glob("frame_*.exr")))

    @once
    def pictures_stack_file(self, flaws):
        return (self.make("lffocus stack", self.field(flaws), self.path("plain", flaws), *self.planes(flaws),
                          to=self.new_folder("stack.exr")),)

    def picture_of(self, call, flaws, name, *options):
        return (self.make(call, self.field(flaws), self.path("plain", flaws), *options, to=self.new_folder(name)),)

    @once
    def pictures_through_exr(self, flaws):
        return self.picture_of("lffocus through", flaws, "through.exr")

    @once
    def pictures_through_png(self, flaws):
        return self.picture_of("lffocus through", flaws, "through.png")

    @once
    def pictures_sharp_exr(self, flaws):
        return self.picture_of("lffocus sharp", flaws, "sharp.exr", *self.planes(flaws))

    @once
    def pictures_sharp_png(self, flaws):
        return self.picture_of("lffocus sharp", flaws, "sharp.png", *self.planes(flaws))

    @once
    def pictures_depth_exr(self, flaws):
        return self.picture_of("lffocus depth", flaws, "depth.exr", *self.planes(flaws))

    @once
    def pictures_depth_png(self, flaws):
        return self.picture_of("lffocus depth", flaws, "depth.png", *self.planes(flaws))

    @once
    def pictures_epi_exr(self, flaws):
        return (self.make("lffocus epi", self.field(flaws), "--row", 16, to=self.new_folder("epi.exr")),)

    @once
    def pictures_epi_png(self, flaws):
        return (self.make("lffocus epi", self.field(flaws), "--row", 16, to=self.new_folder("epi.png")),)

    @once
    def pictures_quilt_exr(self, flaws):
        return self.quilt(self.pictures_exr(flaws), "quilt.exr")

    @once
    def pictures_quilt_png(self, flaws):
        return self.quilt(self.pictures_png16(flaws), "quilt.png")

    @once
    def pictures_difference(self, flaws):
        one, other = self.pictures_exr(flaws)[:2]
        return (self.make("lfcompare", one, other, to=self.new_folder("difference.png")),)

    def quilt(self, files, name, *options):
        out = self.new_folder(name)
        self.run("lfquilt", *files, "-o", out, *(options or ("--views", "2x1")))
        return tuple(sorted(out.parent.glob(f"{out.stem}*{out.suffix}")))

    def see_pictures_compared(self, files, flaws):
        """Sees how lfcompare compares each picture with one that NumPy wrote anew, with primaries of sRGB: the PSNR,
        and the number of pixels that do not count."""
        seen = {}
        for file in files:
            light, is_display = read_picture(file)
            again = self.new_folder("again" + (".png" if is_display else ".exr"))
            cv2.imwrite(str(again), light if is_display else with_srgb_primaries(file, light))
            for name, call in (("test", (again, file)), ("reference", (file, again))):
                result = json.loads(self.run("lfcompare", *call, "--json")[0])["pictures"][0]
                seen[f"{file.stem} as {name}"] = [(result["linear_psnr_db"] or 999) > 90, result["undefined"]]
        return seen

    def direct_compared(self, files):
        undefined = [int(np.sum(~np.isfinite(read_picture(file)[0][..., :3].astype(float)).all(2))) for file in files]
        return {f"{file.stem} as {name}": [True, count] for file, count in zip(files, undefined)
                for name in ("test", "reference")}

    def see_pictures_joined(self, files, flaws):
        """Sees the pictures of lfquilt --layout side-by-side."""
        joined = self.quilt(even(files), f"joined{files[0].suffix}", "--layout", "side-by-side")
        return dict(enumerate(read_picture(file)[0] for file in joined))

    def direct_joined(self, files):
        pictures = [read_picture(file)[0] for file in even(files)]
        return dict(enumerate(np.hstack(pair) for pair in zip(pictures[::2], pictures[1::2])))


def even(files):
    """Returns an even number of pictures: a single one twice, and otherwise without the last if their number is odd."""
    return files * 2 if len(files) == 1 else files[:len(files) // 2 * 2]


def read_picture(file):
    """Returns the values of a picture without programs of ours, [row][column][B, G, R], or with A, and True if they are
    values for a display. If a file has several parts, the first is read."""
    if file.suffix == ".png":
        picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        return (picture if picture.ndim == 3 else np.repeat(picture[..., None], 3, 2)), True
    try:
        channels = parts_of(file)[0][1]
    except AssertionError:
        channels = channels_of(file)
    return np.dstack([channels[name] for name in "BGRA" if name in channels]), False


def xyz_from_rgb(chromaticities):
    """Returns the matrix of primaries that are given as x, y of red, green, blue and white, and its white."""
    xyz = np.array([[x / y, 1, (1 - x - y) / y] for x, y in np.reshape(chromaticities, (4, 2))]).T
    return xyz[:, :3] * np.linalg.solve(xyz[:, :3], xyz[:, 3]), xyz[:, 3]


def with_srgb_primaries(file, light):
    """Returns the light of an EXR file, [row][column][B, G, R (, A)], with the primaries of sRGB."""
    stated = attributes_of(file).get("chromaticities", SRGB)
    theirs, white = xyz_from_rgb(stated)
    ours, our_white = xyz_from_rgb(SRGB)
    cone = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])  # Bradford
    adapted = np.linalg.solve(cone, np.diag(cone @ our_white / (cone @ white)) @ cone)
    matrix = np.linalg.solve(ours, adapted @ theirs)[::-1, ::-1]
    light = light.astype(np.float32)
    if not np.allclose(stated, SRGB):
        light[..., :3] = light[..., :3] @ matrix.T.astype(np.float32)
    return light
