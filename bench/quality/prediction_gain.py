#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what contexts of the entropy coder and prediction between LF images would save, by prototypes in NumPy.

usage: prediction_gain.py TABLE BIN SHARED [--cache DIR] [--only CAPTURE;...] [--write doc/codec.md]
       prediction_gain.py TABLE --again JSON [--write doc/codec.md]

TABLE    gain, choices, steps or contexts
BIN      folder of lfsynth
SHARED   folder with groundtruth/, data/blender-shop and data/stanford-cards-9x9
--cache  folder for light fields and for rows that are measured already; an interrupted run resumes

Groups are 4 x 4 LF images, of which a part of at most 256 x 256 pixels is coded. A frame is the mean of the 16 LF
images in linear light, warped by the plane that is in focus, at three focus distances. The PSNR is that of display
values.
`gain` tells the bytes of each way as a share of today's where frames are equally good. `choices` changes one parameter
at a time, for captures that parameters were chosen with. `steps` compares steps of the quantiser, with noise and
without; `contexts` compares contexts of the entropy coder.
"""
import argparse
import dataclasses
import json
import pathlib
import sys
import tempfile

import cv2
import numpy as np

import prediction_captures as captures
import prediction_contexts as contexts
import prediction_groups as groups
import prediction_model as model
import prediction_peers as peers
from equal_quality import bytes_at
from quality import results

TODAY = (3, 7)  # thresholds; ways are compared where frames are as good as these make them
REPORTED = (3, 5, 8, 12)
CHOSEN = (4, 9)
NOISY = (3, 5, 8)  # near the PSNR that noise allows, two thresholds are too few
CHOICES = {
    "blocks of 4 x 4": {"block": 4},
    "blocks of 16 x 16": {"block": 16},
    "blocks of 32 x 32": {"block": 32},
    "1 reference": {"references": 1},
    "2 references": {"references": 2},
    "4 references": {"references": 4},
    "mean of any references": {"modes": "any"},
    "mean of all references": {"modes": "mean"},
    "mean of all, weighted by distance": {"modes": "weighted"},
    "blocks do not overlap": {"overlap": "none"},
    "windows overlap fully": {"overlap": "full"},
    "depths interpolated between blocks": {"overlap": "depths"},
    "2 taps": {"taps": "linear"},
    "4 taps, Keys −0.5": {"taps": "cubic -0.5"},
    "6 taps, Lanczos": {"taps": "lanczos 6"},
    "8 taps, Lanczos": {"taps": "lanczos 8"},
    "32 depths": {"depths": 32},
    "128 depths": {"depths": 128},
    "smoothness 0": {"smoothness": 0.0},
    "smoothness 0.5": {"smoothness": 0.5},
    "smoothness 2": {"smoothness": 2.0},
    "key image in the middle": {"key": "middle"},
    "all LF images may be references": {"leaves": "used"},
    "depths searched in decoded references": {"closed": True},
    "one map of depths for the group": {"shared": True},
    "predictions not rounded": {"rounded": False},
}
STEPS = {
    "1, 1, 1": ("equal steps", {"steps": (1, 1, 1)}),
    "0.75, 0.87, 1.07": ("steps × 0.75, 0.87, 1.07", {"steps": (0.75, 0.87, 1.07)}),
    "0.6, 0.8, 1.1": ("both", {}),
    "0.5, 0.7, 1.2": ("steps × 0.5, 0.7, 1.2", {"steps": (0.5, 0.7, 1.2)}),
}
STEPPED = ("planar, 0.5 mm", "still-life, 9 mm", "shop at half size, 31 mm", "foliage, 5 mm",
           "still-life, 3 mm, noisy", "foliage, 5 mm, noisy")
CONTEXTS_OF = ("planar, 0.5 mm", "still-life, 3 mm", "shop at half size, 31 mm", "stanford-cards, 1 step")
CHOSEN_WITH = ("planar, 0.5 mm", "still-life, 9 mm", "shop at half size, 31 mm")


class Bench:
    """Captures, and rows that are measured once."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.file, self.rows, self.loaded = folder / "rows.jsonl", {}, {}
        if self.file.exists():
            for line in self.file.read_text().splitlines():
                row = json.loads(line)
                self.rows[row["capture"], row["way"], row["threshold"]] = row

    def capture(self, name):
        """Returns the capture, the group and the frames of the LF images without noise."""
        if name not in self.loaded:
            found = captures.CAPTURES[name][1](self.arguments.programs, self.folder, self.arguments.shared)
            self.loaded = {name: (found, groups.Group(found), found.frames(found.clean))}
        return self.loaded[name]

    def row(self, name, way, threshold, measure):
        key = name, way, threshold
        if key not in self.rows:
            capture, group, truth = self.capture(name)
            row = {"capture": name, "way": way, "threshold": threshold}
            found = measure(capture, group)
            pictures = found.pop("pictures", None)
            if pictures is not None:
                row |= {"image_db": captures.decibels(zip(capture.pictures, pictures)),
                        "frame_db": captures.decibels(zip(truth, capture.frames(pictures)))}
            self.rows[key] = results.rounded(row | found)
            with open(self.file, "a") as out:
                out.write(json.dumps(self.rows[key]) + "\n")
            print(self.rows[key], file=sys.stderr, flush=True)
        return self.rows[key]

    def today(self, name, threshold):
        def measure(capture, _):
            if threshold is None:
                return {"bytes": sum(map(model.code_lossless, capture.pictures)).tolist()}
            coded = [model.code(picture.astype(np.float32) - 128, threshold) for picture in capture.pictures]
            return {"bytes": sum(size for size, _ in coded).tolist(),
                    "pictures": [model.clipped(values + 128) for _, values in coded]}
        return self.row(name, "today", threshold, measure)

    def group(self, name, words, threshold, way):
        return self.row(name, words, threshold, lambda capture, group: group.code(threshold, way))

    def peer(self, name, peer, quantiser):
        def measure(capture, _):
            size, pictures = peers.code(peer, capture.pictures, quantiser)
            return {"bytes": [size], "pictures": pictures}
        return self.row(name, peer, quantiser, measure)

    def disparities(self, name):
        def measure(capture, group):
            return {"disparities": disparities_of(capture, group)}
        return self.row(name, "disparities", 0, measure)["disparities"]


def disparities_of(capture, group):
    """Returns where 5 and 95 % of the blocks move from one LF image to its neighbour on the right, in pixels."""
    order = groups.order_of(capture, "middle")
    links = groups.references_of(capture, order[-1], order[:-1], 3)
    errors = group.search.errors(order[-1], links, capture.pictures, 64, "mean or one", group.scale)
    depth, _ = groups.chosen(groups.in_blocks(errors, 4), 4.0)
    a, b = capture.homography(5, 6)
    height, width = capture.pictures[0].shape[:2]
    middle = np.array([width / 2, height / 2, 1])
    ends = np.percentile(groups.inverse_depths_of(capture, 64)[depth], (5, 95))
    moved = [(a @ middle + inverse * b) for inverse in ends]
    return sorted(float(middle[0] - at[0] / at[2]) * group.scale for at in moved)


def shares_at(rows, today, coder, of="frame_db"):
    """Returns for each of today's rows the bytes at its PSNR as a share of today's."""
    points = [(row[of], row["bytes"][coder]) for row in rows]
    found = [bytes_at(points, row[of]) for row in today]
    return [None if size is None else size / row["bytes"][0] for size, row in zip(found, today)]


def measure_gain(bench, names):
    rows = []
    for name in names:
        today = [bench.today(name, threshold) for threshold in TODAY]
        ours = [bench.group(name, "both", threshold, groups.Way()) for threshold in REPORTED]
        row = {"capture": name, "is_chosen": captures.CAPTURES[name][0], "disparities": bench.disparities(name),
               "frame_db": [r["frame_db"] for r in today],
               "contexts": [r["bytes"][1] / r["bytes"][0] for r in today],
               "prediction": shares_at(ours, today, 0), "both": shares_at(ours, today, 1),
               "images": shares_at(ours, today, 1, "image_db"),
               "side": [r["side"] / r["bytes"][1] for r in ours[1:3]]}
        if "mosaics" not in name:
            for peer, quantisers in peers.QUANTISERS.items():
                if peers.exists(peer):
                    row[peer] = shares_at([bench.peer(name, peer, q) for q in quantisers], today, 0)
        if "noisy" not in name:
            exact, group = bench.today(name, None), bench.group(name, "both", None, groups.Way())
            row["lossless"] = [size / exact["bytes"][0] for size in (exact["bytes"][1], *group["bytes"])]
        rows.append(row)
    return rows


def measure_choices(bench, names):
    rows = [{"change": change, "values": []} for change in CHOICES]
    for name in names:
        today = [bench.today(name, threshold) for threshold in TODAY]
        base = shares_at([bench.group(name, "both", t, groups.Way()) for t in CHOSEN], today, 1)
        for row in rows:
            way = dataclasses.replace(groups.Way(), **CHOICES[row["change"]])
            shares = shares_at([bench.group(name, row["change"], t, way) for t in CHOSEN], today, 1)
            row["values"].append([a / b - 1 for a, b in zip(shares, base)])
    return rows


def measure_steps(bench, names):
    rows = [{"steps": steps, "values": []} for steps in STEPS]
    for name in names:
        today = [bench.today(name, threshold) for threshold in TODAY]
        for row in rows:
            words, change = STEPS[row["steps"]]
            way = dataclasses.replace(groups.Way(), **change)
            thresholds = NOISY if "noisy" in name else CHOSEN
            row["values"].append(shares_at([bench.group(name, words, t, way) for t in thresholds], today, 1))
    return rows


def measure_contexts(bench, names):
    rows = [{"contexts": words, "values": []} for words in contexts.ROWS]
    for name in names:
        for is_predicted in (False, True):
            packets = [contexts.packets_of(bench.capture(name)[0], threshold, is_predicted)
                       for threshold in contexts.THRESHOLDS]
            for row in rows:
                row["values"].append([contexts.change_of(part, *contexts.ROWS[row["contexts"]]) for part in packets])
    return rows


def cell(values):
    return ", ".join("-" if value is None else f"{value:.2f}" for value in values) if values else ""


def gain_table(record):
    lines = ["| capture | used to choose | disparities, px | frames, dB | contexts | prediction | both | both, "
             "equal LF images | x265 | libaom | lossless: contexts, prediction, both |", "|" + " --- |" * 11]
    for row in record["rows"]:
        low, high = (f"{value:.1f}".replace("-", "−") for value in row["disparities"])
        lines.append(f"| {row['capture']} | {'yes' if row['is_chosen'] else 'no'} | {low} to {high} | "
                     f"{', '.join(f'{db:.1f}' for db in row['frame_db'])} | " + " | ".join(
                         cell(row.get(key)) for key in ("contexts", "prediction", "both", "images", "x265", "libaom",
                                                        "lossless")) + " |")
    return lines


def percent(value):
    return f"{100 * value:+.1f}".replace("-", "−")


def choices_table(record):
    lines = ["| change | " + " | ".join(record["captures"]) + " | mean |",
             "|" + " --- |" * (2 + len(record["captures"]))]
    for row in record["rows"]:
        lines.append(f"| {row['change']} | " + " | ".join(", ".join(map(percent, pair)) for pair in row["values"]) +
                     f" | {percent(np.mean(row['values']))} |")
    return lines


def steps_table(record):
    lines = ["| steps | " + " | ".join(record["captures"]) + " |", "|" + " --- |" * (1 + len(record["captures"]))]
    return lines + [f"| {row['steps']} | " + " | ".join(map(cell, row["values"])) + " |" for row in record["rows"]]


def contexts_table(record):
    columns = [f"{name}{words}" for name in record["captures"] for words in ("", ", predicted")]
    lines = ["| contexts | " + " | ".join(columns) + " | mean |", "|" + " --- |" * (2 + len(columns))]
    for row in record["rows"]:
        lines.append(f"| {row['contexts']} | " + " | ".join(", ".join(map(percent, pair)) for pair in row["values"]) +
                     f" | {percent(np.mean(row['values']))} |")
    return lines


TABLES = {"gain": (tuple(captures.CAPTURES), measure_gain, gain_table),
          "choices": (CHOSEN_WITH, measure_choices, choices_table),
          "contexts": (CONTEXTS_OF, measure_contexts, contexts_table),
          "steps": (STEPPED, measure_steps, steps_table)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=tuple(TABLES))
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--cache", type=pathlib.Path)
    parser.add_argument("--only", help="names of captures, with semicolons between")
    results.add_options(parser)
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    names, measure, table = TABLES[arguments.table]
    names = arguments.only.split(";") if arguments.only else list(names)
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    else:
        if not arguments.shared:
            parser.error("BIN SHARED or --again is needed")
        record = results.context() | {"captures": names}
        with tempfile.TemporaryDirectory() as temporary:
            bench = Bench(arguments, arguments.cache or pathlib.Path(temporary))
            record["rows"] = measure(bench, names)
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, f"quality/prediction_gain.py {arguments.table}", record, text)


if __name__ == "__main__":
    main()
