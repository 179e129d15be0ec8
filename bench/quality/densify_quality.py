#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Densifies thinned light fields, renders them, compares the frames with those of true lenses or of all LF images, and
makes the tables of doc/densify.md.

usage: densify_quality.py BIN SHARED [--only GROUP] [--write doc/densify.md]
       densify_quality.py --again JSON [--write doc/densify.md]

BIN      folder of lfdensify, lfrenderer, lfimport and lfsynth
SHARED   folder with groundtruth/ (as for quality.py) and data/: blender-shop, stanford-cards-9x9, beer-colmap and
         middlebury-templeRing
GROUP    planar    ground truth: every 2nd, 4th and 8th column and row of `planar`, and some at random
         band      ground truth: every 2nd, 4th and 8th column and 2nd row of `band`
         scenes    scenes of lfsynth against true pictures
         around    scenes of lfsynth, photographed on domes and tracks around them, against true pictures
         turntables  scenes of lfsynth with alpha, photographed in a circle, against true pictures
         orbits    films within such domes and tracks, against true films
         left-out  LF images of several captures, made of those around them
         trust     the share of wrong elements by trust, in scenes of lfsynth photographed from all around
         shop      blender-shop against the frames of all 729 LF images
         cards     stanford-cards against the frames of all 81 LF images
         spoiled   ground truth, with noise, wrong exposures, poses and depths, and an object that moves
         flicker   films of a camera that moves slowly, against the films of all LF images

Each group makes a table with a record of its own. Without --only, all are made, one after the other.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

import densify_captures as captures
import drawn_captures as drawn
import lens_weights
import quality
from lens_weights import decibels, text
from quality import results

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "tests/helpers"))
import exr_file  # noqa: E402

NO_GUARD = "--no-guard --mode collect --estimator auto --lens-weights auto"
FEWER = ("--most", 600)  # keeps the time short
TRUTH_SAMPLES = 400
COLUMNS = ("recorded LF images", "virtual", "frame", "*R*", "*V*", "guarded")


class Bench:
    """The programs, and a folder for what they write."""

    def __init__(self, programs, shared, folder):
        self.programs, self.shared, self.folder = programs, shared, folder
        self.truth = shared / "groundtruth"
        self.renderer = programs / "lfrenderer"

    def planar(self):
        return quality.read_field(self.truth / "data/planar/transforms.json")

    def densify(self, calibration, *options):
        """Returns (store, report), or (None, the refusal)."""
        store = self.folder / f"{calibration.parent.name}.lfs"
        words = [self.programs / "lfdensify", calibration, "-o", store, "--overwrite", "--json", "-q", "--cache",
                 "none", "--progress", "none", *options]
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
        if done.returncode in (0, 6):
            return store, json.loads(done.stdout)
        refusal = done.stderr.strip().splitlines()[-1]
        print(calibration.parent.name, refusal, file=sys.stderr)
        return None, refusal

    def measure(self, table, cells, calibration, frames, options=(), more=lambda frame, report: ()):
        """Densifies a light field and adds a row for each frame (name, path, true picture). Returns whether lfdensify
        refused it.

        cells  the first cells, which later rows leave empty
        more   returns the last cells for a frame and the report of lfdensify
        """
        store, report = self.densify(calibration, *options)
        cells = [*cells, report["virtual"] if store else "refused"]
        for frame, path, truth in frames:
            recorded = decibels(self.renderer, truth, calibration, path, "")
            dense = [decibels(self.renderer, truth, store, path, words) if store else (None, 0)
                     for words in (NO_GUARD, "")]
            table.add(*cells, frame, text(recorded), *map(text, dense), *more(frame, report))
            cells = [""] * len(cells)
        if store:
            store.unlink()
        return not store

    def of_all(self, calibration, frames):
        """Returns {name of a frame: PSNR of R of a whole light field}."""
        return {name: text(decibels(self.renderer, truth, calibration, path, "")) for name, path, truth in frames}


def compare_with_all(bench, table, source, subsets, names):
    """Adds the rows of parts of a light field of the ground truth; the last column is R of all LF images."""
    field = quality.read_field(bench.truth / f"data/{source}/transforms.json")
    frames = captures.ground_truth_frames(bench.truth, names, bench.folder)
    of_all = bench.of_all(bench.truth / f"data/{source}/transforms.json", frames)
    for number, (name, kept, options) in enumerate(subsets(field["frames"])):
        calibration = quality.write_field(bench.folder / f"{source}_{number}", field, kept)
        bench.measure(table, [f"{len(kept)}, {name}"], calibration, frames, options, lambda frame, _: (of_all[frame],))


def planar(bench):
    table = lens_weights.Table(*COLUMNS, "all 361")
    compare_with_all(bench, table, "planar", lambda frames: [
        *((f"every {nth} column and row", captures.grid(frames, step), ())
          for step, nth in ((2, "2nd"), (4, "4th"), (8, "8th"))),
        *((words, captures.at_random(frames, count, seed), ())
          for words, count, seed in (("at random", 36, 1), ("at random", 25, 1), ("others at random", 25, 2)))],
        captures.PLANAR)
    return table


def band(bench):
    table = lens_weights.Table(*COLUMNS, "all 288")
    compare_with_all(bench, table, "band", lambda frames: [
        ("all", frames, ()),
        ("all, `--force --spacing 0.5`", frames, ("--force", "--spacing", 0.5, *FEWER)),
        ("every 2nd column", captures.band(frames, 2, 1), ()),
        ("every 2nd column, `--force --spacing 1`", captures.band(frames, 2, 1), ("--force", "--spacing", 1, *FEWER)),
        ("every 4th column", captures.band(frames, 4, 1), ()),
        ("every 4th column and 2nd row", captures.band(frames, 4, 2), ()),
        ("every 8th column and 2nd row", captures.band(frames, 8, 2), ())],
        captures.BAND)
    return table


def scenes(bench):
    """The lens is as wide as 14.6 distances between the LF cameras of 17 x 17."""
    spacing, side = 0.003, 17
    table = lens_weights.Table("scene", *COLUMNS, f"all {side * side}")
    for scene, focus_distances, steps in (("still-life", (0.45, 0.8, 1.6), (2, 4, 8)),
                                          ("lights", (0.45, 1.6), (4,)), ("chart", (0.45, 1.6), (4,))):
        calibration = bench.folder / scene / "transforms.json"
        synth = [bench.programs / "lfsynth", scene, "-q", "-o"]
        results.call([*synth, calibration.parent, "--count", side * side, "--size", "320x240", "--spacing", spacing])
        field = quality.read_field(calibration)
        frames = []
        for focus in focus_distances:
            path = captures.middle_path(field, bench.folder / f"{scene}_{focus}.yaml", (320, 240),
                                        field["fl_x"] / 0.8, 14.6 * spacing, focus)
            out = bench.folder / f"truth_{scene}_{focus}"
            results.call([*synth, out, "--calibration-only", "--truth", path, "--truth-samples", 400])
            frames.append((f"focus {focus}", path, lens_weights.linear_exr(next(out.rglob("frame_0001.exr")))))
        of_all = bench.of_all(calibration, frames)
        for step in steps:
            kept = captures.square(field["frames"], range(0, side, step))
            part = quality.write_field(bench.folder / f"{scene}_{step}", field, kept)
            bench.measure(table, [scene, len(kept)], part, frames, FEWER, lambda frame, _: (of_all[frame],))
    return table


def dome(bench, scene, count):
    """Photographs a scene all around. Returns the calibration, and the path and true picture of a frame at one of the
    LF cameras."""
    calibration = bench.folder / f"{scene}_{count}" / "transforms.json"
    synth = [bench.programs / "lfsynth", scene, "-q", "--capture", "hemisphere", "--count", count, "-o"]
    results.call([*synth, calibration.parent, "--size", "320x240"])
    field = quality.read_field(calibration)
    path = captures.camera_path(field, bench.folder / f"{scene}_{count}.yaml", round(0.3 * count), 0.04, 0.85)
    out = bench.folder / f"truth_{scene}_{count}"
    results.call([*synth, out, "--calibration-only", "--truth", path, "--truth-samples", 400])
    return calibration, path, lens_weights.linear_exr(next(out.rglob("frame_0001.exr")))


def degrees_apart(count):
    return f"{np.degrees(np.sqrt(2 * np.pi / count)):.0f}"


def figures_of_tests(report):
    """Returns (median PSNR of LF images that lfdensify left out and made, what they are better by than a mean)."""
    tests = [test for test in report["tests"] if not test["beyond"]]
    if not tests:
        return "-", "-"
    return (f"{np.median([test['virtual_psnr_db'] for test in tests]):.1f}",
            f"{np.median([test['virtual_psnr_db'] - test['mean_psnr_db'] for test in tests]):.1f}")


def around(bench):
    """Photographs around an object, and one frame between two of them; virtual LF cameras fill its lens alone."""
    diameter = 0.04
    table = lens_weights.Table("scene", "photographs", "degrees apart", "virtual", "lens, cm", *COLUMNS[3:],
                               "left out, dB", "better than a mean by")
    for scene in ("still-life", "chart"):
        for name, cameras in (("dome", drawn.dome), ("track", drawn.track)):
            for degrees in (4, 8, 12, 15):
                folder = bench.folder / f"{scene}_{name}_{degrees}"
                directions = cameras(degrees)
                calibration = drawn.photographs(bench.programs, scene, directions, folder)
                middle = len(directions) // 2
                between = np.mean([directions[middle], directions[middle + 1]], axis=0)
                path = drawn.film(folder / "path.yaml", between, between, 1, diameter)
                truth = lens_weights.linear_exr(
                    drawn.true_pictures(bench.programs, scene, path, folder / "true", TRUTH_SAMPLES)[0])
                store, report = bench.densify(calibration, path, *FEWER)
                found = [decibels(bench.renderer, truth, source, path, words) if source else (None, 0)
                         for source, words in ((calibration, ""), (store, NO_GUARD), (store, ""))]
                more = ((report["virtual"], f"{100 * min(report['filled_diameter_w'] or diameter, diameter):.1f}",
                         *map(text, found), *figures_of_tests(report))
                        if store else ("refused", "-", *map(text, found), "-", "-"))
                table.add(scene, f"{len(directions)}, {name}", degrees, *more)
    return table


def turntables(bench):
    """Photographs in a circle around cut-out objects, and one frame between two of them."""
    green = np.array([0, 1, 0])
    table = lens_weights.Table("scene", "photographs", "degrees apart", "virtual", *COLUMNS[3:],
                               *(f"{column} near outlines" for column in COLUMNS[3:]),
                               *(f"{column}, opacity" for column in COLUMNS[3:]))
    for scene in ("still-life", "chart"):
        for count in (72, 36, 24):
            folder = bench.folder / f"{scene}_{count}"
            calibration = drawn.photographs(bench.programs, scene, drawn.turntable(count), folder, alpha=True)
            path = drawn.film(folder / "path.yaml", *2 * [np.array((180 / count, 25))], 1, 0.04)
            truth = drawn.linear(
                drawn.true_pictures(bench.programs, scene, path, folder / "true", TRUTH_SAMPLES, "straight")[0])
            over_green = lambda picture: picture[..., :3] + (1 - picture[..., 3:4]) * green
            outline = (truth[..., 3] > 0) & (truth[..., 3] < 1)
            near = cv2.dilate(outline.astype(np.uint8), np.ones((7, 7), np.uint8)) > 0
            store, report = bench.densify(calibration, path, *FEWER)
            found = []
            for source, words in ((calibration, ""), (store, NO_GUARD), (store, "")):
                drawn.frames_of(bench.renderer, source, path, folder / "frames", words.split())
                frame = drawn.linear(folder / "frames/frame_0001.exr")
                pairs = over_green(truth), over_green(frame)
                found.append([lens_weights.psnr(*pairs), lens_weights.psnr(pairs[0][near], pairs[1][near]),
                              lens_weights.psnr(truth[..., 3], frame[..., 3])])
            table.add(scene, count, f"{360 / count:g}", report["virtual"],
                      *(f"{figures[i]:.2f}" for i in range(3) for figures in found))
    return table


def orbits(bench):
    """Films whose camera moves between the photographs; errors that change from frame to frame flicker."""
    frames, seen = 9, 10  # a change by this many of 255 is seen
    table = lens_weights.Table("scene", "photographs", "degrees apart", "film", "PSNR", "flicker, rms",
                               "elements that flicker, %")
    for scene, name, cameras, degrees in (("still-life", "dome", drawn.dome, 8), ("still-life", "dome", drawn.dome, 12),
                                          ("chart", "track", drawn.track, 8)):
        folder = bench.folder / f"orbit_{scene}_{name}_{degrees}"
        directions = cameras(degrees)
        calibration = drawn.photographs(bench.programs, scene, directions, folder)
        path = drawn.film(folder / "path.yaml", (-degrees / 2, 26), (degrees / 2, 26), frames, 0.04)
        truth = np.array([255 * quality.encoded(np.clip(lens_weights.linear_exr(file), 0, 1)) for file in
                          drawn.true_pictures(bench.programs, scene, path, folder / "true", TRUTH_SAMPLES)])
        store, _ = bench.densify(calibration, path, *FEWER)
        for film, source, words in (("*R*", calibration, ""), ("*V*", store, NO_GUARD), ("guarded", store, "")):
            pictures, _ = drawn.frames_of(bench.renderer, source, path, folder / "frames", words.split())
            error = np.array([255 * quality.encoded(np.clip(picture, 0, 1)) for picture in pictures]) - truth
            # Errors that stay, or change evenly, do not flicker.
            change = error[1:-1] - (error[:-2] + error[2:]) / 2
            table.add(scene, f"{len(directions)}, {name}", degrees, film,
                      f"{20 * np.log10(255 / rms(error)):.2f}", f"{rms(change):.2f}",
                      f"{100 * np.mean(np.abs(change).max(axis=3) > seen):.2f}")
    return table


def trust(bench):
    """The share of elements of V that are visibly wrong, by their trust. Elements without virtual light have no trust
    to be judged."""
    visible, few = 10, 50
    columns, shares = [], []
    for scene, count in (("still-life", 142), ("still-life", 92), ("lights", 142), ("chart", 142), ("foliage", 142)):
        calibration, path, truth = dome(bench, scene, count)
        store, _ = bench.densify(calibration, path, *FEWER)
        columns.append(f"{scene}, {degrees_apart(count)} degrees")
        if not store:
            shares.append(["refused"] * 10)
            continue
        shown, _ = lens_weights.first_frame(bench.renderer, store, path, NO_GUARD)
        out = bench.folder / "guarded"
        results.call([bench.renderer, store, path, "-o", out, "--overwrite", "--format", "exr-float", "-q",
                      "--no-contact-sheet"])
        channels = exr_file.channels_of(out / "frame_0001.exr")
        wrong = 255 * np.abs(quality.encoded(shown) - quality.encoded(truth)).max(axis=2) > visible
        tenth = np.clip((10 * channels["trust"]).astype(int), 0, 9)
        judged = (channels["densified"] > 0) | (channels["trust"] < 1)
        of_tenths = [wrong[judged & (tenth == i)] for i in range(10)]
        shares.append([f"{of.mean():.2f}" + (f" ({of.size})" if of.size < few else "") if of.size else "-"
                       for of in of_tenths])
    table = lens_weights.Table("trust", "expected", *columns)
    for i in range(2, 10):
        table.add(f"{i / 10:.1f} to {(i + 1) / 10:.1f}", "up to 0.1" if i == 9 else f"{0.95 - i / 10:.2f}",
                  *(of_capture[i] for of_capture in shares))
    return table


def left_out(bench):
    """The test of lfdensify, which makes LF images of those around them, on captures of several kinds. The size of
    virtual LF images does not matter for it."""
    table = lens_weights.Table("capture", "LF images", "left out", "degrees", "made, dB", "mean, dB", "gain, dB",
                               "better than the mean")
    for name, calibration, path in left_out_captures(bench):
        _, report = bench.densify(calibration, *([path] if path else []), "--divisor", 4, "--most", 100, "--force")
        tests = [test for test in report["tests"] if not test["beyond"]]
        median = lambda value: f"{np.median([value(test) for test in tests]):.1f}"
        gain = lambda test: test["virtual_psnr_db"] - test["mean_psnr_db"]
        table.add(name, report["recorded"], len(tests), median(lambda test: test["angle_deg"]),
                  median(lambda test: test["virtual_psnr_db"]), median(lambda test: test["mean_psnr_db"]),
                  median(gain), f"{sum(gain(test) > 0 for test in tests)} of {len(tests)}")
    return table


def left_out_captures(bench):
    """Yields (name, calibration, path or None)."""
    data = bench.shared / "data"

    def imported(name, source, *more):
        out = bench.folder / name
        results.call([bench.programs / "lfimport", source, "-o", out, "-q", *more])
        return quality.read_field(out / "transforms.json")

    def part(name, field, kept, number=None, diameter=0, focus=1):
        calibration = quality.write_field(bench.folder / name.replace(" ", "_"), field, kept)
        path = captures.camera_path(dict(field, frames=kept), bench.folder / f"{calibration.parent.name}.yaml", number,
                                    diameter, focus) if number is not None else None
        return name, calibration, path

    can = imported("can", data / "beer-colmap/sparse", "--images", data / "beer-colmap/images")
    is_first = lambda frame: captures.number_of(frame) in (*range(14), *range(35, 53))
    for side, is_kept in (("A", is_first), ("B", lambda frame: not is_first(frame))):
        kept = [frame for frame in can["frames"] if is_kept(frame)]
        yield part(f"beer-colmap side {side}", can, kept, len(kept) // 2, 1, 4.7)
    temple = imported("temple", data / "middlebury-templeRing/templeRing")
    yield part("templeRing", temple, temple["frames"], 30, 0.15, 0.55)
    shop_field = imported("shop", data / "blender-shop/images")
    yield part("blender-shop 5 x 5", shop_field, captures.square(shop_field["frames"], (0, 6, 13, 20, 26)))
    cards_field = captures.cards_field(data / "stanford-cards-9x9/images")
    yield part("stanford-cards 5 x 5", cards_field, captures.square(cards_field["frames"], range(0, 9, 2)))
    for scene, count in (("chart", 142), ("foliage", 142), ("lights", 92)):
        calibration = bench.folder / f"{scene}_{count}" / "transforms.json"
        results.call([bench.programs / "lfsynth", scene, "-q", "--capture", "hemisphere", "--count", count, "-o",
                      calibration.parent, "--size", "320x240", "--format", "png"])
        field = quality.read_field(calibration)
        noisy = captures.with_noise(field["frames"], bench.folder / f"noise_{scene}_{count}")
        yield part(f"{scene} {degrees_apart(count)} degrees with noise", field, noisy, round(0.3 * count), 0.3, 0.85)


def against_all(bench, field, paths, parts):
    """Returns the table of parts of a light field, against the frames of all its LF images. LF images are reduced to
    half their size first: LF pixels are then about as large as elements, as in the ground truth.

    paths  {name of the frame: path}
    parts  [(name, function that chooses among the frames of the light field)]
    """
    table = lens_weights.Table(*COLUMNS)
    whole = quality.of_areas(quality.write_field(bench.folder / "whole", field, field["frames"]), bench.folder / "half")
    frames = [(name, path, lens_weights.first_frame(bench.renderer, whole, path, "")[0])
              for name, path in paths.items()]
    half = quality.read_field(whole)
    for number, (name, choose) in enumerate(parts):
        kept = choose(half["frames"])
        part = quality.write_field(bench.folder / f"part_{number}", half, kept)
        bench.measure(table, [f"{len(kept)}, {name}"], part, frames, FEWER)
    return table


def shop(bench):
    imported = bench.folder / "imported"
    results.call([bench.programs / "lfimport", bench.shared / "data/blender-shop/images", "-o", imported, "-q"])
    field = quality.read_field(imported / "transforms.json")
    grid = lambda kept: lambda frames: captures.square(frames, kept)
    return against_all(
        bench, field,
        {f"focus {focus}": captures.middle_path(field, bench.folder / f"{focus}.yaml", (384, 256), 400, 0.7, focus)
         for focus in (4.6, 8.12, 13)},
        [("9 x 9", grid((0, 3, 6, 10, 13, 16, 20, 23, 26))), ("5 x 5", grid((0, 6, 13, 20, 26))),
         ("at random", lambda frames: captures.at_random(frames, 51, 1))])


def cards(bench):
    field = captures.cards_field(bench.shared / "data/stanford-cards-9x9/images")
    return against_all(
        bench, field,
        {f"focus {focus}": captures.middle_path(field, bench.folder / f"{focus}.yaml", (320, 320), 500, 14.4, focus)
         for focus in (148, 286)},
        [("5 x 5 of 9 x 9", lambda frames: captures.square(frames, range(0, 9, 2)))])


def gain_of(report):
    """Returns the gain that the test of lfdensify found."""
    if isinstance(report, str):
        return "-"
    return f"{np.median([test['virtual_psnr_db'] - test['mean_psnr_db'] for test in report['tests']]):.1f}"


def spoiled(bench):
    field = bench.planar()
    kept = captures.grid(field["frames"], 4)
    frames = captures.ground_truth_frames(bench.truth, ("planar_d8_f20", "planar_d4_f50"), bench.folder)
    table = lens_weights.Table("spoiled", *COLUMNS[1:], "test")
    nearer, farther = (0.0744, 1.14), (0.297, 4.58)  # half and twice of what is found
    for number, (name, made, options) in enumerate((
            ("nothing", lambda folder: kept, ()),
            ("noise of 6 of 255", lambda folder: captures.with_noise(kept, folder), ()),
            ("gains of 0.95 to 1.05", lambda folder: captures.with_gains(kept, folder), ()),
            ("poses, 0.3 px", lambda folder: captures.with_turned_poses(kept, field["fl_x"], 0.3), ()),
            ("a ball in every tenth", lambda folder: captures.with_object(kept, folder), ()),
            ("depths, half", lambda folder: kept, ("--depths", *nearer)),
            ("depths, twice", lambda folder: kept, ("--depths", *farther)))):
        calibration = quality.write_field(bench.folder / f"spoiled_{number}", field,
                                          made(bench.folder / f"pictures_{number}"))
        more = lambda _, report: (gain_of(report),)
        if bench.measure(table, [name], calibration, frames, options, more):
            bench.measure(table, [f"{name}, `--force`"], calibration, frames, (*options, "--force"), more)
    return table


def film_of(bench, calibration, path, options):
    """Returns the frames of a film, as sRGB of 8 bits with fractions."""
    folder = bench.folder / "film"
    results.call([bench.renderer, calibration, path, "-o", folder, "--format", "exr-float", "-q", "--no-contact-sheet",
                  "--overwrite", *options.split()])
    return np.array([255 * quality.encoded(lens_weights.linear_exr(file))
                     for file in sorted(folder.glob("frame_*.exr"))], dtype=np.float32)


def flicker(bench):
    """The lens moves by 2 mm, which is the distance between the recorded LF cameras, in 60 frames."""
    field = bench.planar()
    path = captures.moving_path(captures.case_of(bench.truth, "planar_d8_f20"), bench.folder / "film.yaml",
                                diameter=0.005, way=0.002, frames=60)
    sparse = quality.write_field(bench.folder / "sparse", field, captures.grid(field["frames"], 4))
    store, _ = bench.densify(sparse)
    of_all = film_of(bench, bench.truth / "data/planar/transforms.json", path, "")
    table = lens_weights.Table("film", "PSNR (sRGB)", "flicker, rms", "of the worst 0.1 %", "from frame to frame, rms")
    for name, calibration, options in (("*R*", sparse, ""), ("*V*", store, NO_GUARD), ("guarded", store, "")):
        error = film_of(bench, calibration, path, options) - of_all
        deviation = error.std(axis=0)
        table.add(name, *(f"{x:.2f}" for x in (
            20 * np.log10(255 / rms(error)), rms(deviation), np.quantile(deviation, 0.999),
            rms(np.diff(error, axis=0)))))
    return table


def rms(values):
    return float(np.sqrt(np.mean(values.astype(float) ** 2)))


def publish(arguments, group):
    record = results.context()
    with tempfile.TemporaryDirectory() as temporary:
        table = GROUPS[group](Bench(arguments.programs.resolve(), arguments.shared.resolve(),
                                    pathlib.Path(temporary)))
    table.publish(arguments, f"densify_quality.py {group}", record)


GROUPS = {"planar": planar, "band": band, "scenes": scenes, "around": around, "turntables": turntables,
          "orbits": orbits, "left-out": left_out, "trust": trust, "shop": shop, "cards": cards, "spoiled": spoiled,
          "flicker": flicker}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, nargs="?", metavar="BIN")
    parser.add_argument("shared", type=pathlib.Path, nargs="?", metavar="SHARED")
    parser.add_argument("--only", choices=list(GROUPS), metavar="GROUP")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.shared:
        parser.error("BIN SHARED or --again is needed")
    if not (arguments.shared / "groundtruth/cases.json").exists():
        print(f"skipped: no ground truth in {arguments.shared}")
        return 77
    if arguments.only:
        publish(arguments, arguments.only)
        return 0
    # A process for each group, so that each record has the commands of its own table.
    return max(subprocess.run([sys.executable, *sys.argv, "--only", group]).returncode for group in GROUPS)


if __name__ == "__main__":
    sys.exit(main())
