# SPDX-License-Identifier: Apache-2.0
"""The chains of doc/matrix.md: what is handed on, who writes and who reads it, and the direct way."""
import threading
from typing import Callable, NamedTuple

from chain_frames import FrameChains
from chain_light import LightChains
from chain_page import Chain
from chain_paths import KINDS, PathChains
from chain_python import READERS, WRITERS, PythonChains, python_package
from chain_results import ResultChains
from chain_views import ViewChains
from chain_world import FIELDS
from covering_cells import covering_cells
from matrix_world import once


class Thing(NamedTuple):
    """Something that programs hand on. Methods of Ways are named by the words that the table has for them.

    direct  method(ways, chain, written): what the reader sees in the direct way
    skips   True for chains that make no sense, each with the reason in a comment
    """
    flaws: tuple
    writers: dict
    readers: dict
    direct: Callable
    skips: Callable = lambda chain: False


LIGHT_WRITERS = {
    "lfimport": "light_import",
    "lfcompressor --profile lossless": "light_store",
    "lfcompressor": "light_lossy_store",
    "lfcompressor PACKAGE": "light_store_of_packages",
    "lfcompressor PACKAGE --needed-pixels": "light_needed_pixels",
    "lfdensify": "light_densified",
    "lfrenderer --densify": "light_densified_film",
    "lffocus views": "light_views",
    "lffocus views --values srgb16": "light_views_16",
    "lffocus views --values linear": "light_linear_views",
}
VIEW_WRITERS = {
    "lfimport --grid": "imported_grid",
    "lfimport --grid --serpentine": "imported_serpentine",
    "lfimport --grid --layout mosaic": "imported_mosaic",
    "lfimport --grid --layout lenslets": "imported_lenslets",
    "lfimport .npy": "imported_array",
    "lfimport .h5": "imported_hdf5",
    "lfimport --time": "imported_time",
}
LIGHT_READERS = {
    "lfrenderer": "see_film",
    "lfrenderer --mode rebin": "see_rebinned_film",
    "lfpreprocessor": "see_packages",
    "lfpreprocessor --plan": "see_plan",
    "lfcompressor": "see_store",
    "lfdensify": "see_densified_film",
    "lfimport": "see_report",
    "lfexample": "see_example",
    "lffocus stack": "see_stack",
    "lffocus depth": "see_depth",
    "lffocus sharp": "see_sharp",
    "lffocus through": "see_through",
    "lffocus epi": "see_epi",
    "lffocus views": "see_views",
    "lfvisualizer --text": "see_scene",
    "lfvisualizer --export": "see_page",
    "lfpath --lightfield": "see_unit_and_focus",
    "lfcammvminfo": "see_cameras",
}
PATH_WRITERS = {
    "lfpath .yaml": "path_yaml",
    "lfpath .json": "path_nerfstudio",
    "lfpath --format instant-ngp": "path_ngp",
    "lfpath .chan": "path_chan",
    "lfpath .usda": "path_usda",
    "lfpath, four times": "path_round_trip",
    "lfpath --frames": "path_slower",
}
PATH_READERS = {
    "lfrenderer": "see_path_film",
    "lfpreprocessor": "see_path_packages",
    "lfcammvminfo": "see_path_cameras",
    "lfpath": "see_path_again",
    "lfvisualizer --text": "see_path_scene",
    "lffocus stack": "see_path_stack",
    "lffocus depth": "see_path_depth",
    "lffocus sharp": "see_path_sharp",
    "lffocus through": "see_path_through",
    "lfdensify": "see_path_densified",
    "lfsynth --truth": "see_path_truth",
}
PLATE_WRITERS = {
    "lfrenderer --shard": "plates_of_shards",
    "lfrenderer --keep-plates": "plates_kept",
    "lfrenderer PACKAGE --keep-plates": "plates_of_package",
    "lfsubmit -- --keep-plates": "plates_of_job",
}
PICTURE_WRITERS = {
    "lfrenderer": "pictures_exr",
    "lfrenderer --format exr-float": "pictures_float",
    "lfrenderer --colour-space --frame-alpha --z": "pictures_acescg",
    "lfrenderer --channels rgb --exr-compression zips": "pictures_rgb",
    "lfrenderer --format png": "pictures_png",
    "lfrenderer --format png16 --frame-alpha": "pictures_png16",
    "lfmerge": "pictures_merged",
    "lfsubmit": "pictures_of_job",
    "lfsynth --truth": "pictures_truth",
    "lffocus stack": "pictures_stack",
    "lffocus stack .exr": "pictures_stack_file",
    "lffocus through": "pictures_through",
    "lffocus through .exr": "pictures_through_exr",
    "lffocus through .png": "pictures_through_png",
    "lffocus sharp .exr": "pictures_sharp_exr",
    "lffocus sharp .png": "pictures_sharp_png",
    "lffocus depth .exr": "pictures_depth_exr",
    "lffocus depth .png": "pictures_depth_png",
    "lffocus epi .exr": "pictures_epi_exr",
    "lffocus epi .png": "pictures_epi_png",
    "lfquilt .exr": "pictures_quilt_exr",
    "lfquilt .png": "pictures_quilt_png",
    "lfcompare": "pictures_difference",
}
DEPTH_WRITERS = {
    "lffocus depth .exr": "depths_exr",
    "lffocus depth .pfm": "depths_pfm",
    "lffocus depth .ply": "depths_ply",
    "lffocus depth .png": "depths_png",
    "lfrenderer --z": "depths_frame",
    "lfsynth --truth": "depths_truth",
}
VIDEO_WRITERS = {
    "lfrenderer --video": "video_film",
    "lfmerge --video": "video_merged",
    "lfsubmit --video": "video_job",
    "lffocus through --video": "video_through",
    "lffocus stack --video": "video_stack",
    "lffocus stack .mp4": "video_rack",
    "lfquilt .mp4": "video_quilt",
}


def _is_of_another_capture(chain):
    """Returns True if a reader shows or needs all LF images, and the light field has others by intention: a store of
    packages has the LF images of one film, a densified light field has virtual ones, and views are numbered anew."""
    if chain.writer.startswith("lfcompressor PACKAGE"):
        return chain.reader not in ("lfrenderer", "lfpreprocessor")
    if "densify" in chain.writer:
        # The LF cameras of `synth` are so far apart that the direct way has double edges.
        return chain.flaws == "synth" or chain.reader in (
            "lfpreprocessor --plan", "lfvisualizer --text", "lfvisualizer --export", "lfimport", "lfexample")
    return "views" in chain.writer and chain.reader in ("lfvisualizer --text", "lfvisualizer --export")


def _direct_path(ways, chain, written):
    original = ways.original_path(chain.flaws)
    if chain.writer == "lfpath --frames":
        original = ways.direct_slower(chain.flaws)
    if chain.writer == "lfpath .chan":
        original = ways.path("still")
    return ways.direct_of(chain.what, chain.reader, original, chain.flaws)


THINGS = {
    "light field": Thing(
        FIELDS, LIGHT_WRITERS, LIGHT_READERS,
        lambda ways, chain, written: ways.direct_of(chain.what, chain.reader, ways.field(chain.flaws), chain.flaws),
        _is_of_another_capture),
    "grid of views": Thing(
        ("views",), VIEW_WRITERS, LIGHT_READERS,
        lambda ways, chain, written: ways.direct_of(
            chain.what, chain.reader,
            ways.field_of_views("serpentine" if "serpentine" in chain.writer else "grid"), chain.flaws),
        # The page holds the names of LF images.
        lambda chain: chain.reader == "lfvisualizer --export"),
    "path": Thing(
        KINDS, PATH_WRITERS, PATH_READERS, _direct_path,
        # Only paths of views have a direct way of --frames: the moments are resampled before they get their views.
        # The package tells by a warning of Python what a file of a path with a shutter lacks (python/tests).
        lambda chain: (chain.writer == "lfpath --frames" and chain.flaws not in ("stereo", "quilt", "surface")) or
        (chain.writer.startswith("lf.") and chain.flaws == "shutter")),
    "packages": Thing(
        FIELDS, {"lfpreprocessor": "packages_of"},
        {"lfrenderer": "see_package_film", "lfsubmit": "see_package_job", "lfcompressor": "see_package_store"},
        lambda ways, chain, written: ways.whole_film(chain.flaws)),
    "plates": Thing(
        FIELDS, PLATE_WRITERS,
        {"lfmerge": "see_plates_merged", "lfmerge --colour-space": "see_plates_recoloured"},
        lambda ways, chain, written: (
            ways.direct_recoloured if chain.reader.endswith("space") else ways.whole_film)(chain.flaws)),
    "pictures": Thing(
        FIELDS, PICTURE_WRITERS, {"lfcompare": "see_pictures_compared", "lfquilt": "see_pictures_joined"},
        lambda ways, chain, written: {
            "lfcompare": ways.direct_compared, "lfquilt": ways.direct_joined,
            "lf.read_image()": ways.direct_python}[chain.reader](written),
        # The true frames are those of a scene of lfsynth.
        lambda chain: chain.writer == "lfsynth --truth" and chain.flaws != "synth"),
    "depths": Thing(
        FIELDS, DEPTH_WRITERS, {"focus: {surface}": "see_depths_film", "lfvisualizer --depth": "see_depths_page"},
        lambda ways, chain, written: (
            ways.direct_points if chain.reader.startswith("lf") else ways.direct_film_on)(written, chain.flaws),
        lambda chain: chain.writer == "lfsynth --truth" and chain.flaws != "synth"),
    "video": Thing(
        FIELDS, VIDEO_WRITERS, {"ffmpeg": "see_video"}, lambda ways, chain, written: ways.direct_video(written)),
    "job": Thing(
        FIELDS, {"lfsubmit": "job_of"},
        {"lfsubmit --status": "see_job_status", "lfsubmit --resume": "see_job_resumed"},
        lambda ways, chain, written: ways.direct_job(chain.reader)),
}


def all_chains(strength=2):
    """Returns chains in which each writer of a thing occurs with each of its readers, and each of both with each of its
    flaws. Strength 3: every writer with every reader and all flaws."""
    chains = [Chain(what, *cell) for what, thing in THINGS.items()
              for cell in covering_cells([list(thing.writers), list(thing.readers), list(thing.flaws)], strength)]
    return [chain for chain in chains if not THINGS[chain.what].skips(chain)]


def add_python():
    """Adds the chains of the Python package. ImportError if it is not there."""
    python_package()
    for what, writers in WRITERS.items():
        THINGS[what].writers.update(writers)
    for what, readers in READERS.items():
        THINGS[what].readers.update(readers)


class Ways(LightChains, ViewChains, PathChains, FrameChains, ResultChains, PythonChains):
    """All writers, readers and direct ways."""

    def __init__(self, programs, folder):
        super().__init__(programs, folder)
        self.heard = threading.local()

    def run(self, call, *words, rest=()):
        out, said = super().run(call, *words, rest=rest)
        self.heard.text = getattr(self.heard, "text", "") + said
        return out, said

    def see(self, chain):
        """Returns what the reader sees of what the writer wrote, and what both said on stderr."""
        thing = THINGS[chain.what]
        written = getattr(self, thing.writers[chain.writer])(chain.flaws)
        self.heard.text = self.texts.get(written, "")
        seen = getattr(self, thing.readers[chain.reader])(written, chain.flaws)
        return seen, self.heard.text

    def direct(self, chain):
        thing = THINGS[chain.what]
        written = getattr(self, thing.writers[chain.writer])(chain.flaws)
        return thing.direct(self, chain, written)

    @once
    def direct_of(self, what, reader, original, flaws):
        """Returns what a reader sees of the original; once for all writers."""
        return getattr(self, THINGS[what].readers[reader])(original, flaws)

    def direct_job(self, reader):
        return {"frames": 2} if reader.endswith("resume") else {"state": "done", "frames": 2, "frames_done": 2}
