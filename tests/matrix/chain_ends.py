# SPDX-License-Identifier: Apache-2.0
"""The files that programs take, as --describe lists them, and the chains (chain_ways.py) that they are ends of.

An option that takes files, or that changes what is written, and that is not named here fails tests.chain, so that a new
program or output gets chains, or a reason why it is no end of any.
"""
import json
import subprocess

from common_options import OFFERED

# Files that programs write, by call and kind of file (tools/common/file_kinds.h): the thing and the writer of THINGS;
# or a reason.
WRITTEN = {
    ("lfsynth", "folder"): "the light field `synth` of all chains",
    ("lfimport", "folder"): ("light field", "lfimport"),
    ("lfexample", "path"): "the path `example` of all chains",
    ("lfpath", ".yaml"): ("path", "lfpath .yaml"),
    ("lfpath", ".json"): ("path", "lfpath .json"),
    ("lfpath", ".chan"): ("path", "lfpath .chan"),
    ("lfpath", ".usda"): ("path", "lfpath .usda"),
    ("lfpreprocessor", "folder"): ("packages", "lfpreprocessor"),
    ("lfcompressor", "store"): ("light field", "lfcompressor"),
    ("lfdensify", "store"): ("light field", "lfdensify"),
    ("lfrenderer", "folder"): ("pictures", "lfrenderer"),
    ("lfrenderer", ".mp4"): ("video", "lfrenderer --video"),
    ("lffocus stack", ".exr"): ("pictures", "lffocus stack .exr"),
    ("lffocus stack", ".mp4"): ("video", "lffocus stack .mp4"),
    ("lffocus stack", "folder"): ("pictures", "lffocus stack"),
    ("lffocus epi", ".png"): ("pictures", "lffocus epi .png"),
    ("lffocus epi", ".exr"): ("pictures", "lffocus epi .exr"),
    ("lffocus views", ".npy"): "an array for NumPy, which see_views() of chain_light.py reads",
    ("lffocus views", "folder"): ("light field", "lffocus views"),
    ("lffocus depth", ".exr"): ("depths", "lffocus depth .exr"),
    ("lffocus depth", ".pfm"): ("depths", "lffocus depth .pfm"),
    ("lffocus depth", ".ply"): ("depths", "lffocus depth .ply"),
    ("lffocus depth", ".png"): ("depths", "lffocus depth .png"),
    ("lffocus sharp", ".exr"): ("pictures", "lffocus sharp .exr"),
    ("lffocus sharp", ".png"): ("pictures", "lffocus sharp .png"),
    ("lffocus through", ".exr"): ("pictures", "lffocus through .exr"),
    ("lffocus through", ".png"): ("pictures", "lffocus through .png"),
    ("lffocus through", "folder"): ("pictures", "lffocus through"),
    ("lffocus through", ".mp4"): ("video", "lffocus through --video"),
    ("lfsubmit", "folder"): ("job", "lfsubmit"),
    ("lfsubmit", ".mp4"): ("video", "lfsubmit --video"),
    ("lfmerge", "folder"): ("pictures", "lfmerge"),
    ("lfmerge", ".mp4"): ("video", "lfmerge --video"),
    ("lfquilt", ".png"): ("pictures", "lfquilt .png"),
    ("lfquilt", ".exr"): ("pictures", "lfquilt .exr"),
    ("lfquilt", ".mp4"): ("video", "lfquilt .mp4"),
    ("lfcompare", ".png"): ("pictures", "lfcompare"),
    ("lfcompare", "folder"): ("pictures", "lfcompare"),
    ("lfvisualizer", "folder"): "a page for browsers, which see_page() of chain_light.py reads",
}
WRITING = ("--output", "--video", "--export")

# The thing that a kind of file is for its readers. A reader of THINGS whose name begins with the call must exist.
READ = {"light_field": "light field", "store": "light field", "path": "path", "package": "packages",
        "plate": "plates", "image": "pictures", ".png": "pictures", ".exr": "pictures"}
# Options whose files no program of ours writes, or that are read in another way; (call or "any", option): reason.
NOT_READ = {
    ("any", "--images"): "images that were moved",
    ("any", "--store-cache"): "copies of stores on web servers, tests.remote_store",
    ("any", "--frame-cache"): "frames that programs decode for themselves, tests.light_field_video",
    ("any", "--cache"): "depths that programs keep for themselves, tests.densify_cache",
    ("lfimport", "--masks"): "masks that people or other programs made, tests.found_captures",
    ("lfimport", "--transform"): "a matrix that people write",
    ("lfpath", "--transform"): "a matrix that people write",
    ("lfpath", "--dataparser-transforms"): "a file of nerfstudio",
    ("lfpath", "--out-dataparser-transforms"): "a file of nerfstudio",
    ("lffocus stack", "--distances"): "numbers that people write",
    ("lfsubmit", "--lfrenderer"): "a program",
    ("lfsubmit", "--cancel"): "looks at a job that runs, tests.farms",
    ("lfsubmit", "--finish"): "looks at a job that runs, tests.farms",
    ("lfsubmit", "--write"): "the job is for another scheduler, tests.farms",
    ("lfvisualizer", "--watch"): "frames of a render that runs, web.page",
    ("lfvisualizer", "PACKAGE"): "shows which LF images a package has, tests.lfvisualizer",
}
# Readers of options whose kind of file does not tell which thing they read.
READ_AS = {
    ("lfvisualizer", "--depth"): ("depths", "lfvisualizer --depth"),
    ("lfsubmit", "--status"): ("job", "lfsubmit --status"),
    ("lfsubmit", "--resume"): ("job", "lfsubmit --resume"),
    ("lfquilt", "FRAMES"): ("pictures", "lfquilt"),
    ("lfcompare", "REFERENCE"): ("pictures", "lfcompare"),
    ("lfcompare", "TEST"): ("pictures", "lfcompare"),
}

# Options of the group Output that take no file. Options of TRIED change what is written, and are in the name of a
# writer or reader; options of OTHERS choose how much is written, or are tried in other ways.
TRIED = ("--format", "--values", "--colour-space", "--frame-alpha", "--z", "--channels", "--exr-compression",
         "--keep-plates", "--stereo", "--quilt", "--frames", "--text", "--plan", "--fill", "--views", "--layout",
         "--json", "--convergence", "--view-angle")
OTHERS = ("--calibration-only", "--overwrite", "--force", "--clip", "--scale", "--unit-m", "--distance", "--frame",
          "--csv", "--fps", "--stereo-mm", "--clamp-frames", "--packages", "--frames-per-package", "--balance",
          "--shard-size", "--view", "--display", "--no-contact-sheet", "--back-and-forth", "--show", "--gain",
          "--serve", "--allow-origin", "--export-images", "--export-live", "--live-memory", "--by-resolution",
          "--device", "--tile", "--first-frame")


def options_of(programs):
    """Yields the call, the longest name and the kinds of files of each option that takes files or is of Output."""
    for call in OFFERED:
        program, *command = call.split()
        text = subprocess.run([programs / program, *command, "--describe"], capture_output=True, text=True, check=True)
        for group in json.loads(text.stdout)["groups"]:
            for option in group["options"]:
                if option["files"] or group["name"] == "Output":
                    yield call, max(option["names"], key=len), tuple((option["files"] or {"kinds": ()})["kinds"])


def faults_of_ends(programs, things):
    """Returns what is missing in the tables above, or is in them although no program has it."""
    faults, used = [], set()
    for call, option, kinds in options_of(programs):
        if not kinds and option not in TRIED + OTHERS:
            faults.append(f"{call} {option}: is neither in TRIED nor in OTHERS")
        for kind in kinds:
            key = (call, kind) if option in WRITING else (call, option)
            found = (WRITTEN if option in WRITING else {**NOT_READ, **READ_AS}).get(key)
            found = found or NOT_READ.get(("any", option))
            used |= {key, ("any", option), option}
            if found is None and option not in WRITING and kind in READ:
                readers = things[READ[kind]].readers
                found = (READ[kind], next((name for name in readers if name.split(" --")[0] == call), None))
            if found is None:
                faults.append(f"{call} {option}: files of the kind {kind} belong to no chain")
            elif isinstance(found, tuple) and found[1] not in {**things[found[0]].writers, **things[found[0]].readers}:
                faults.append(f"{call} {option}: no chain of {found[0]} has the end {found[1]}")
        used.add(option)
    unknown = {*WRITTEN, *NOT_READ, *READ_AS, *TRIED, *OTHERS} - used
    return faults + [f"{name}: is an option of no program" for name in sorted(map(str, unknown))]
