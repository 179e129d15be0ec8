#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares films from a packed store of predicted LF images with films from stores of LF images that are encoded each
by itself, packed or by contexts: bytes where frames are equally good, and CPU time and memory of films.

usage: group_films.py BIN SHARED [--only CAPTURE,...] [--views 16] [--size 480x320] [--frames 1-50x12] [--group PROFILE]
                      [--write doc/codec.md]
       group_films.py --again JSON [--write doc/codec.md]

BIN      folder of lfcompressor, lfrenderer, lfimport, lfexample and lfsynth
SHARED   folder with data/blender-shop
--group  the profile of the store of predicted LF images, and with -lossless its lossless one (group)

`still-life` has --views x --views LF images of lfsynth (8 bits); `noisy` the same with noise, whose frames are compared
with those of the scene without; `mosaics` are RGGB mosaics of it; `shop` are the JPEG files in the middle of
blender-shop. Each is encoded by the profile default, without and with --entropy contexts, and by the group's, at
several thresholds, and lossless. Frames of a focus pull are rendered by the defaults from each store. Their PSNR is
that of all frames together, as sRGB pictures of 16 bits, against frames of the original light field. Bytes at a PSNR
are interpolated between thresholds.

The first of these frames is rendered once more from the stores of threshold 3: in the order spread with enough memory
and with the least that lfrenderer accepts, and in the order groups with as little. It must have the same bits. (A film
of several frames would read its LF images once for each, because the least memory has room for one plate.)
"""
import argparse
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import cv2
import numpy as np

from equal_quality import bytes_at
from quality import results

THRESHOLDS = (3, 5, 8, 12, 16)
COMPARED = 3  # threshold of the stores whose films are measured
WAYS = ("single", "contexts", "group")
TARGETS_DB = {"still-life": 52, "shop": 54}  # other captures: what the profile default reaches at COMPARED
COLLECT = "--mode collect --estimator bilinear --filter auto --lens-weights auto".split()
NOISE = 2.5  # standard deviation, in grey steps
ENOUGH = "8G"


def synthetic(*options):
    def make(bench, folder):
        results.call([bench.programs / "lfsynth", "still-life", "-o", folder, "--count", bench.views ** 2, "--size",
                      bench.size, "-q", *options])
        return folder
    return make


def shop(bench, folder):
    """Makes a light field of the JPEG files themselves. Their names state row and column, of 27."""
    (folder / "images").mkdir(parents=True)
    first = 13 - bench.views // 2
    for file in sorted((bench.shared / "data/blender-shop/images").glob("*.jpg")):
        if all(first <= int(word) < first + bench.views for word in file.stem.split("_")[1:3]):
            (folder / "images" / file.name).symlink_to(file)
    results.call([bench.programs / "lfimport", folder / "images", "-o", folder / "field", "-q"])
    return folder / "field"


def noisy(bench, folder):
    synthetic("--format", "png")(bench, folder)
    dice = np.random.default_rng(1)
    for file in sorted((folder / "images").glob("*.png")):
        picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        values = picture + dice.normal(0, NOISE, picture.shape)
        cv2.imwrite(str(file), np.clip(np.rint(values), 0, 255).astype(np.uint8))
    return folder


# Name: (function that makes the light field, the one that makes it without noise or None)
CAPTURES = {"still-life": (synthetic("--format", "png"), None), "shop": (shop, None),
            "noisy": (noisy, synthetic("--format", "png")),
            "mosaics": (synthetic("--bayer"), None)}


class Bench:
    def __init__(self, arguments, folder):
        self.programs, self.shared = arguments.programs.resolve(), arguments.shared.resolve()
        self.views, self.size, self.range, self.group = (arguments.views, arguments.size, arguments.frames,
                                                         arguments.group)
        self.folder = folder

    def ways(self, is_lossless=False):
        """Returns words of lfcompressor by the ways that are compared."""
        single = ["--profile", "lossless" if is_lossless else "default"]
        group = f"{self.group}-lossless" if is_lossless else self.group
        return {"single": single, "contexts": [*single, "--entropy", "contexts"], "group": ["--profile", group]}


class Capture:
    """A light field, a path, and the frames of the light field without noise."""

    def __init__(self, bench, name):
        self.bench, self.name = bench, name
        self.folder = bench.folder / name
        self.folder.mkdir()
        make, make_clean = CAPTURES[name]
        self.field = make(bench, self.folder / "field")
        clean = make_clean(bench, self.folder / "clean") if make_clean else self.field
        self.path = self.folder / "path.yaml"
        results.call([bench.programs / "lfexample", clean, "-o", self.path, "--move", "focus-pull", "-q"])
        self.truth = self.frames(clean)

    def words(self, light_field, *options, frames=None):
        """Returns a call of lfrenderer, and the folder of its frames."""
        out = self.folder / "frames"
        shutil.rmtree(out, ignore_errors=True)
        return [self.bench.programs / "lfrenderer", light_field, self.path, "-o", out, "--frames",
                frames or self.bench.range, "--format", "png16", "--no-contact-sheet", "-q", *COLLECT, *options], out

    def frames(self, light_field, *options):
        words, out = self.words(light_field, *options)
        results.call(words)
        return pictures_of(out)

    def store(self, way, words, threshold):
        """Encodes the light field. Returns the store and the report of lfcompressor."""
        store = self.folder / f"{way}-{threshold}.lfs"
        words = [*words, *(() if threshold is None else ("--threshold", threshold))]
        report = json.loads(results.call([self.bench.programs / "lfcompressor", self.field, "-o", store, "--reencode",
                                          "--overwrite", "--json", "--progress", "none", *words]))
        return store, report

    def film(self, store, order, memory):
        """Renders the first frame. Returns its use of resources, and the frame."""
        words, out = self.words(store, "--order", order, "--memory", memory, "--json", frames=1)
        used = results.timed(words)
        load_s = re.search(r'"load_cpu_s": ([\d.e-]+)', used["stdout"])
        return {"cpu_s": used["cpu_s"], "load_cpu_s": float(load_s[1]),
                "peak_mib": used["peak_bytes"] / 2 ** 20}, pictures_of(out)

    def least_memory(self, store):
        """Returns the least --memory, in MiB, that lfrenderer accepts for a frame."""
        mib = 1
        for _ in range(4):
            words, _ = self.words(store, "--memory", f"{mib}M", frames=1)
            done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
            if done.returncode == 0:
                return mib
            named = re.findall(r"at least (\d+) MiB", done.stderr)
            if not named:
                raise SystemExit(f"{store}: --memory {mib}M: {done.stderr}")
            mib = int(named[-1])
        raise SystemExit(f"{store}: no --memory that the messages named was accepted, the last: {mib}M")


def pictures_of(folder):
    files = sorted(folder.glob("frame_*.png"))
    if not files:
        raise SystemExit(f"{folder}: expected frames")
    return [cv2.imread(str(file), cv2.IMREAD_UNCHANGED) for file in files]


def decibels(truth, frames):
    error = np.mean([np.mean((a.astype(float) - b) ** 2) for a, b in zip(truth, frames, strict=True)])
    return 10 * math.log10(65535 ** 2 / error) if error > 0 else None


def store_rows(capture, stores):
    """Encodes by each profile and threshold. Returns rows, and keeps the stores whose films are measured."""
    rows = []
    for is_lossless in (False, True):
        for threshold in (None,) if is_lossless else THRESHOLDS:
            for way, words in capture.bench.ways(is_lossless).items():
                store, report = capture.store(way, words, threshold)
                rows.append({"capture": capture.name, "way": way, "threshold": threshold,
                             "lf_images": report["lf_images"],
                             "bytes": report["code_bytes"], "encode_cpu_s": report["encode_cpu_s"],
                             "frame_db": decibels(capture.truth, capture.frames(store))})
                print(rows[-1], file=sys.stderr, flush=True)
                if threshold == COMPARED:
                    stores[way] = store
                else:
                    remove(store)
    return rows


def remove(store):
    for file in store.parent.glob(store.stem + "*.lfs"):
        file.unlink()


def film_rows(capture, stores):
    rows, bits = [], {}
    for way, store in stores.items():
        least = f"{capture.least_memory(store)}M"
        for order, memory in (("spread", ENOUGH), ("spread", least), ("groups", least)):
            used, frames = capture.film(store, order, memory)
            bits.setdefault(way, frames)
            if not all(map(np.array_equal, bits[way], frames)):
                raise SystemExit(f"{capture.name}, {way}: frames have other bits with --order {order} --memory "
                                 f"{memory}")
            rows.append({"capture": capture.name, "way": way, "order": order, "memory": memory} | used)
            print(rows[-1], file=sys.stderr, flush=True)
    return rows


def measure(bench, names):
    rows, films = [], []
    for name in names:
        capture, stores = Capture(bench, name), {}
        rows += store_rows(capture, stores)
        films += film_rows(capture, stores)
        shutil.rmtree(capture.folder)
    return rows, films


def of(rows, capture, way, is_lossless=False):
    return [row for row in rows if row["capture"] == capture and row["way"] == way
            and (row["threshold"] is None) == is_lossless]


def at(rows, threshold):
    return next(row for row in rows if row["threshold"] == threshold)


def mb(size):
    return "-" if size is None else f"{size / 1e6:.2f}"


def change(now, before):
    return "-" if now is None or before is None else f"{100 * (now / before - 1):+.1f} %".replace("-", "−")


def changes(sizes):
    *others, group = sizes
    return ", ".join(change(group, other) for other in others)


def bytes_table(record):
    lines = ["| capture | frames, dB | MB: single, contexts, group | group / single, contexts | encoding, CPU s | "
             "lossless, MB | group / single, contexts |", "|" + " --- |" * 7]
    for name in record["captures"]:
        of_ways = [of(record["rows"], name, way) for way in WAYS]
        target = TARGETS_DB.get(name, at(of_ways[0], COMPARED)["frame_db"])
        sizes = [bytes_at([(row["frame_db"], row["bytes"]) for row in rows], target) for rows in of_ways]
        cpu = ", ".join(f"{at(rows, COMPARED)['encode_cpu_s']:.1f}" for rows in of_ways)
        exact = [of(record["rows"], name, way, True)[0]["bytes"] for way in WAYS]
        lines.append(f"| {name} | {target:.1f} | {', '.join(map(mb, sizes))} | {changes(sizes)} | {cpu} | "
                     f"{', '.join(map(mb, exact))} | {changes(exact)} |")
    return lines


def thresholds_table(record):
    lines = ["| capture | store | " + " | ".join(f"threshold {t:g}" for t in THRESHOLDS) + " |",
             "|" + " --- |" * (2 + len(THRESHOLDS))]
    for name in record["captures"]:
        for way in WAYS:
            rows = of(record["rows"], name, way)
            cells = [f"{at(rows, t)['frame_db']:.1f} dB, {mb(at(rows, t)['bytes'])} MB" for t in THRESHOLDS]
            lines.append(f"| {name} | {way} | " + " | ".join(cells) + " |")
    return lines


def films_table(record):
    lines = ["| capture | store | order | `--memory` | CPU s | of it loading LF images | "
             "peak MiB |", "|" + " --- |" * 7]
    for row in record["films"]:
        lines.append(f"| {row['capture']} | {row['way']} | `{row['order']}` | {row['memory']} | {row['cpu_s']:.2f} | "
                     f"{row['load_cpu_s']:.2f} | {row['peak_mib']:.0f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", default=",".join(CAPTURES), help="captures, with commas between")
    parser.add_argument("--views", type=int, default=16, help="rows and columns of LF cameras, at most 27")
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--frames", default="1-50x12")
    parser.add_argument("--group", default="group", metavar="PROFILE")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    else:
        if not arguments.shared:
            parser.error("BIN SHARED or --again is needed")
        names = arguments.only.split(",")
        record = results.context() | {"captures": names, "group": arguments.group}
        with tempfile.TemporaryDirectory() as temporary:
            record["rows"], record["films"] = measure(Bench(arguments, pathlib.Path(temporary)), names)
    words = (f"Profile of the groups: `{record['group']}`. The frame of the third table is of the stores of threshold "
             f"{COMPARED}; each store gives it the same bits in all of its rows.")
    tables = [*bytes_table(record), "", *thresholds_table(record), "", *films_table(record)]
    text = "\n".join([results.sentence(record), words, "", *tables]) + "\n"
    results.publish(arguments, "quality/group_films.py", record, text)


if __name__ == "__main__":
    main()
