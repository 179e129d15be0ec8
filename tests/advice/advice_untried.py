# SPDX-License-Identifier: Apache-2.0
"""Messages that recommend a command or an option and that advice_test.py does not provoke, each with the reason."""
MEMORY = "needs a machine without memory or threads"
TOO_SHORT = "needs an interruption within milliseconds; the tests of the program interrupt larger calls and resume them"
SCRIPT = "a script or a template for a farm, which farms_test.py and slurm_test.py run"
SLURM = "needs Slurm; slurm_test.py calls its programs"
HELP = "is no message: a text of the help, or the name of a command"
BEFORE = "is the library's own check, for Python and C++; the options of the programs are checked before"
CAPTURE = "needs a capture of another kind: "

UNTRIED = {
    "process_start: lower --threads, or allow": MEMORY,
    "process_start: out of memory; lower --memory": MEMORY,
    "lf_image_store: lower --memory, or use a machine with more": MEMORY,
    "match_exposure: match one part of the light field at a time (--exclude)": MEMORY,
    "render_memory: needs a plate of {} MiB for each frame": MEMORY,
    "compress: interrupted after ": TOO_SHORT,
    "verify_store: interrupted after ": TOO_SHORT,
    "focus_views: ; start again with --overwrite": TOO_SHORT,
    "merge_shards: interrupted after ": TOO_SHORT,
    "packed_store_writer: this shard of the unfinished store is missing": TOO_SHORT,
    "farm_files: - name: Packages": SCRIPT,
    "farm_files: - name: Film": SCRIPT,
    "farm_files: #!/bin/bash": SCRIPT,
    "farm_files: # Made by lfsubmit": SCRIPT,
    "slurm: # Slurm may requeue": SCRIPT,
    "slurm: # Made by lfsubmit": SCRIPT,
    "agreement: px at {:.1f} % with --repair {}": "is a line of --verbose about the repairs that were tried",
    "focus_depth: The camera is that of one frame": HELP,
    "lffocus: lffocus {}": HELP,
    "focus_depth: , by --near and --far": "is the end of a line that tells what was found",
    "focus_stack: , by --near and --far": "is the end of a line that tells what was found",
    "render_summary: (--image-alpha), exclude the pixels": "names a cause, not a remedy",
    "find_threshold: --target-psnr cannot be used with --profile lossless": BEFORE,
    "read_stanford: the grid (--grid) has": BEFORE,
    "check_film_settings: exposures of the same poses (lf_clipped)": CAPTURE + "brackets that were filmed",
    "check_film_settings: state its key time, or open one time": BEFORE,
    "video_frames: name a folder for them (--frame-cache)": "needs a folder that this user cannot write",
    "foreign_path: state the same quantity: leave one of them out": BEFORE,
    "rig: give 1 or more (--count)": BEFORE,
    "rig: expected a share of the camera spacing from 0 to 1": BEFORE,
    "merge_shards: no plates are given": BEFORE,
    "statistic_film: divide the frames with --frames or packages": BEFORE,
    "statistic_film: leave them out, or take fewer LF images with --max-images": BEFORE,
    "statistic_film: rebinned rays are interpolated": BEFORE,
    "statistic_film: has no sums that could be kept": BEFORE,
    "packed_store_writer: an unfinished store of this name exists": BEFORE,
    "packed_store: compress the light field again with the --image-alpha of this run": BEFORE,
    "packed_store_file: is an unfinished packed store": "needs an unfinished store that somebody has renamed",
    "packed_store_file: lfcompressor --resume": "needs an unfinished store that somebody has renamed",
    "packed_store_writer: give a larger --shard-size": CAPTURE + "thousands of shards",
    "film_renderer_save: make --r-st or --r-uv smaller": CAPTURE + "millions of rays in one cell",
    "display_view: this program was built without OpenColorIO": "depends on how the programs were built",
    "page_server: or use --text": "depends on how the programs were built",
    "page_port: or --serve 0 for any free port": "serves until it is interrupted; lfvisualizer_test.py does it",
    "orbit: or let the camera stand (--move focus-pull)": CAPTURE + "a bent one; lfexample_test.py has it",
    "example_path: (--densify chooses one that they fill), or set aperture_diameter": CAPTURE + "a sparse, deep scene",
    "view_grid: LF cameras look up to {:.0f} degrees": CAPTURE + "cameras around a subject; focus_views_test.py",
    "camera_plane: densify each side by itself": CAPTURE + "cameras around a subject; lfdensify_test.py has it",
    "complete_light_field: or import with lfimport --bayer RGGB": CAPTURE + "camera raw files without a pattern",
    "read_stanford: correct --pitch, or the position": CAPTURE + "positions beyond 1e12 world units",
    "ngp_path: give their number (lfpath --frames)": CAPTURE + "a path of instant-ngp of many hours",
    "render_densified: once they are mended, render again with --overwrite": CAPTURE + "a sparse one",
}
