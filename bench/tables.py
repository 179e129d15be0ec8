#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the tables of doc/ again, one after the other, each with its record in bench/results/.

usage: bench/tables.py BUILD_DIR [--only NAME,...] [--resume] [--tiny] [--data ../shared]
       bench/tables.py --list
       bench/tables.py --find HASH

--only    these tables alone (names of --list)
--resume  leave out tables whose record was made with the present sources and defaults
--tiny    run every script with settings that take a few seconds, and write nothing: tests whether the scripts work
--find    print the newest commit whose sources have the hash that tables and records name
--data    folder with data/blender-shop, data/beer-colmap, data/stanford-cards-9x9 and groundtruth

A script that fails is reported at the end;
the other tables are made nevertheless. bench/run tables builds first. On two free cores all of it takes about two
hours, half of it a million LF cameras with lens weights.
"""
import argparse
import json
import pathlib
import shlex
import subprocess
import sys
import time

import defaults
import record as results

ROOT = results.HERE.parent
WEIGHTS = "bench/quality/lens_weights.py {build}/bin/lfrenderer {data}/groundtruth --tables "
# name of the record: (page, script with its words, words of --tiny)
TABLES = {
    "workloads": ("performance", "bench/workloads.py {build}",
                  "--density 0.005 --size 48x32 --runs 1 --threads 2 --only stack"),
    "opencv-blender-shop": ("performance", "bench/compare_opencv.py {build} {data}/data/blender-shop",
                            "--frames 1 --rounds 1"),
    "large_photographs": ("performance", "bench/large_photographs.py {build} {data}/data/blender-shop",
                          "--count 2 --size 600x400 --frames 1 --runs 1"),
    "million_cameras": ("performance", "bench/million_cameras.py {build}", "--counts 1000 --frames 3 --runs 1"),
    "packages": ("performance", "bench/packages.py {build}", "--density 0.005 --size 48x32 --runs 1"),
    "hybrid_cost": ("rebinning", "bench/hybrid_cost.py {build} --runs 1",
                    "--density 0.005 --size 48x32 --only stack"),
    "simultaneous_packages": ("performance", "bench/simultaneous_packages.py {build}",
                              "--density 0.005 --size 48x32 --packages 1,2 --runs 1"),
    "noise_remedies": ("rebinning", "bench/quality/noise_remedies.py {build} {data}/groundtruth", "--only nothing"),
    "noise_rule": ("checkpoints", "bench/quality/noise_rule.py {build} --data {data}", None),
    "order_quality": ("checkpoints", "bench/quality/order_quality.py {build}/bin {data}", "--only cards --seeds 1"),
    "group_order": ("checkpoints", "bench/quality/group_order.py {build}/bin {data}", "--only band --seeds 1"),
    "coefficient_rounds": ("checkpoints", "bench/quality/coefficient_rounds.py {build}/bin {data}", "--only cards"),
    "reduced_programs": ("codec", "bench/reduced_programs.py {build} --data {data}",
                         "--only 'stanford-cards, 384' --runs 1"),
    "reduced_frames": ("codec", "bench/quality/reduced_frames.py {build} {data}", None),
    "codec_speed": ("codec", "bench/codec_speed.py {build} --data {data} --runs 3", "--runs 2"),
    "group_films": ("codec", "bench/quality/group_films.py {build}/bin {data} --views 10", "--only mosaics --views 4"),
    "group_decoding": ("codec", "bench/group_decoding.py {build}",
                       "--only 'still-life, 3 mm' --size 96x64 --runs 1"),
    "focus_numpy": ("focus", "bench/focus_numpy.py {build} {data}/data/stanford-cards-9x9", "--runs 1 --planes 2"),
    "scale": ("performance", "bench/scale.py {build}", "--counts 100,200 --weighed 100 --frames 5 --packages 2"),
    "memory_bound": ("performance", "bench/memory_bound.py {build} {data}/data/blender-shop", "--frames 1 --images 4"),
    "packed_stores": ("codec", "bench/packed_stores.py {build}", "--count 4 --size 64x64 --runs 1"),
    "remote_stores": ("remote_stores", "bench/remote_stores.py {build}", None),
    "remote_reads": ("remote_stores", "bench/remote_reads.py {build}", "--count 9 --size 64x48"),
    "live_speed": ("visualizer", "bench/live_speed.py {build} --data {data}",
                   "--only many --cameras 1000 --pictures 3"),
    "codec": ("codec", "bench/codec_table.py {build} --data {data} --pictures doc/images",
              "--only synth --views 3 --size 64x48 --frames 1-2"),
    "quality": ("quality", "bench/quality/quality.py {build}/bin/lfrenderer {data}/groundtruth", ""),
    "quality-areas": ("quality", "bench/quality/quality.py --areas --joint {build}/bin/lfrenderer {data}/groundtruth",
                      ""),
    "kept_edges": ("rebinning", "bench/quality/kept_edges.py {build}/bin/lfrenderer {data}/groundtruth",
                   "--only planar_d8_f20_tri_rot"),
    "rebinning_quality": ("rebinning", "bench/quality/rebinning_quality.py {build}/bin/lfrenderer {data}/groundtruth",
                          "--only band_d3"),
    "lens_weights-captures": ("lens-integral", WEIGHTS + "captures", "--only band_d3"),
    "lens_weights-lenses": ("lens-integral", WEIGHTS + "lenses", "--only nothing"),
    "lens_weights-magnifications": ("lens-integral", WEIGHTS + "magnifications", "--only nothing"),
    "mosaics": ("quality", "bench/quality/mosaics.py {build}/bin/lfrenderer", "--only nothing"),
    "photographs": ("quality", "bench/quality/photographs.py {build}/bin/lfrenderer {data}/data", "--only nothing"),
    **{f"densify_quality-{group}": ("densify",
                                    "bench/quality/densify_quality.py {build}/bin {data} --only " + group, None)
       for group in ("planar", "band", "scenes", "around", "turntables", "orbits", "left-out", "trust", "shop",
                     "cards", "spoiled", "flicker")},
    "first_lenses": ("densify", "bench/quality/first_lenses.py {build}/bin --data {data}", "--only survey"),
    "image_orders": ("performance", "bench/image_orders.py {build}", "--density 0.002"),
    "forecast_table": ("cluster", "bench/forecast_table.py {build}", "--count 400 --packages 1,2"),
    "forecasts": ("formats/forecast", "bench/forecasts.py {build} {data}/data",
                  "--runs 1 --frames 2 --scale 0.2 --only shop --modes collect"),
    "ray_usage": ("quality", "bench/ray_usage.py {build}", "--density 0.001"),
    "selection_table": ("performance", "bench/selection_table.py {build}", ""),
    "kept_frames": ("rebinning", "bench/kept_frames.py {build}", "--frames 2 --runs 1"),
    "hybrid_cost-stack-sharp": ("rebinning", "bench/hybrid_cost.py {build} --runs 1 --density 0.02 --size 240x160 "
                                "--frames-share 0.25 --only stack,sharp", "--density 0.005 --size 48x32"),
    "rebinning_peers": ("rebinning", "bench/rebinning_peers.py {build}", "--runs 2"),
    "kernels": ("performance", "bench/kernel_table.py {build} --rounds 3", "--cases disk --rounds 1"),
    "kernels-of-elements": ("performance", "bench/kernel_table.py {build} --rounds 3 --cases "
                            "'disk|rgb|prefiltered.*|bilinear|bicubic|mosaic|bilinear_0.5'",
                            "--cases disk --rounds 1"),
    "wavelet_choice": ("codec", "bench/wavelet_choice.py --data {data}", None),
    **{f"prediction_gain-{table}": ("codec", f"bench/quality/prediction_gain.py {table} {{build}}/bin {{data}}", None)
       for table in ("contexts", "gain", "choices", "steps")},
}


def command_of(name, arguments):
    page, script, tiny = TABLES[name]
    words = shlex.split(script.format(build=arguments.build, data=arguments.data))
    if arguments.tiny:
        words = [word for i, word in enumerate(words) if "--pictures" not in words[max(0, i - 1):i + 1]]
        return words + shlex.split(tiny)
    return words + ["--name", name, "--write", f"doc/{page}.md"]


def is_fresh(name, build):
    """Returns True if the record was made with these sources and these defaults of the programs."""
    path = results.HERE / "results" / f"{name}.json"
    try:
        record = json.loads(path.read_text())
        sources, lines = record["sources"], record["defaults"]
    except (OSError, ValueError, KeyError):
        return False
    today = defaults.of_programs([build / "bin" / name for name in defaults.PROGRAMS])
    return sources == results.present_sources() and set(lines) <= set(today)


def find(sources):
    """Prints the newest commit with these sources. Returns the exit code."""
    for commit in results.git("rev-list", "HEAD", "--", *results.SOURCES).split():
        if results.sources_of(commit) == sources:
            print(results.git("show", "--no-patch", "--format=%h %as %s", commit))
            return 0
    print(f"no commit of this history has the sources {sources}", file=sys.stderr)
    return 1


def make(names, arguments):
    """Runs the scripts. Returns the names of those that failed."""
    failed = []
    for number, name in enumerate(names, 1):
        if arguments.tiny and TABLES[name][2] is None:
            print(f"[{number}/{len(names)}] {name}: no tiny settings, left out", flush=True)
            continue
        if arguments.resume and is_fresh(name, arguments.build.resolve()):
            print(f"[{number}/{len(names)}] {name}: is of these sources", flush=True)
            continue
        words = command_of(name, arguments)
        print(f"[{number}/{len(names)}] {name}: {shlex.join(words)}", flush=True)
        if not (ROOT / words[0]).exists():
            print(f"[{number}/{len(names)}] {name}: {words[0]} does not exist", flush=True)
            failed.append(name)
            continue
        begin = time.monotonic()
        done = subprocess.run([sys.executable, ROOT / words[0], *words[1:]], cwd=ROOT)
        print(f"[{number}/{len(names)}] {name}: {time.monotonic() - begin:.0f} s, exit code {done.returncode}",
              flush=True)
        if done.returncode != 0:
            failed.append(name)
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default=",".join(TABLES))
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--tiny", action="store_true")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--find", metavar="HASH")
    arguments = parser.parse_args()
    if arguments.find:
        return find(arguments.find)
    if arguments.list:
        print("\n".join(f"{name:28} doc/{page}.md  {script}" for name, (page, script, _) in TABLES.items()))
        return 0
    if not arguments.build:
        parser.error("BUILD_DIR or --list is needed")
    names = arguments.only.split(",")
    unknown = [name for name in names if name not in TABLES]
    if unknown:
        parser.error(f"--only {','.join(unknown)}: expected names of --list")
    failed = make(names, arguments)
    print(f"{len(names) - len(failed)} of {len(names)} done" + (f"; failed: {', '.join(failed)}" if failed else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
