#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Films light fields of up to 100,000 LF images that exist as files: time and memory of the programs, and their growth.

usage: bench/scale.py BUILD_DIR [--counts 1000,10000,100000] [--weighed 1000,10000] [--frames 300]
                      [--size 48x32] [--memory 256M] [--packages 8] [--threads 2] [--folder DIR]
                      [--name NAME] [--write PAGE]
       bench/scale.py --again JSON [--write PAGE]

lfsynth photographs the scene `chart` from a square grid, 0.1 m wide whatever the number of LF cameras. The film
winds over all of it; its lens is so wide that frames together see every LF camera, each in two or three frames.
It is rendered in one go (lfrenderer LIGHTFIELD PATH) and from packages (lfpreprocessor, then lfrenderer
PACKAGE...), without lens weights; frames of both ways must have the same bits. Light fields of --weighed are also
rendered with the defaults.

Peak memory is that of each program alone. Open files, and the space that the frames' folder takes, are counted 20 times
a second. CPU per LF image is the additional CPU time compared with the smallest light field, divided by the number of
additional LF images; all light fields are filmed with the same number of frames.

--folder DIR  folder to work in, instead of a new one; each light field in it is removed once it is measured
"""
import argparse
import hashlib
import json
import math
import pathlib
import shutil

import record as results

SIDE_M, DISTANCE_M, FPS = 0.1, 1, 30
WATCH_S = 0.05
PLAIN = ("--mode", "collect", "--estimator", "bilinear", "--filter", "bilinear", "--lens-weights", "none")
MIB = 1 << 20


def film(frames, size):
    """Returns a PATH.yaml of lines from edge to edge of the grid. The distance between two lines equals the distance
    between two frames of a line. The lens reaches the corners of the squares between lines."""
    pitch_m = SIDE_M / math.sqrt(frames)
    lines = max(1, math.floor(SIDE_M / pitch_m))
    reach, gap = SIDE_M / 2, SIDE_M / lines
    points = []
    for line in range(lines):
        ends = (-reach, reach) if line % 2 == 0 else (reach, -reach)
        points += [(x, -SIDE_M / 2 + gap * (line + 0.5)) for x in ends]
    lengths = [0.0]
    for a, b in zip(points, points[1:]):
        lengths.append(lengths[-1] + math.dist(a, b))
    seconds = (frames - 1) / FPS
    keys = ", ".join(f"{{time: {seconds * length / lengths[-1]:.6f}, value: [{x:.6f}, {y:.6f}, {-DISTANCE_M}], "
                     "interpolation: linear}" for length, (x, y) in zip(lengths, points))
    diameter_mm = 1000 * 1.25 * math.hypot(gap, lengths[-1] / (frames - 1))
    return f"""format: lfpath 1
fps: {FPS}
frames: {frames}
resolution: [{size.replace("x", ", ")}]
camera:
  sensor_width_mm: 36
  focal_length_mm: 36
  position: [{points[0][0]:.6f}, {points[0][1]:.6f}, {-DISTANCE_M}]
  look_at: [{points[0][0]:.6f}, {points[0][1]:.6f}, 0]
  follow: direction
lens:
  aperture_diameter_mm: {diameter_mm:.4f}
  focus_distance: 0.8
keyframes:
  position: [{keys}]
"""


def digest(folder):
    """Returns a digest of the bytes of all frames."""
    whole = hashlib.sha256()
    for frame in sorted(folder.glob("frame_*")):
        whole.update(hashlib.sha256(frame.read_bytes()).digest())
    return whole.hexdigest()


class Scale:
    """One light field, and the rows of its measurements."""

    def __init__(self, arguments, folder, count):
        self.programs = arguments.build.resolve() / "bin"
        # The smallest square grid with at least `count` cameras.
        self.arguments, self.folder, self.count = arguments, folder, math.ceil(math.sqrt(count)) ** 2
        self.threads = ("--threads", arguments.threads)
        self.field, self.path = folder / "field", folder / "film.yaml"
        self.path.write_text(film(arguments.frames, arguments.size))
        self.rows = []

    def run(self, what, program, *words, out=None, is_bounded=True):
        """Measures one program. Returns its row, with numbers of its report if it has one."""
        folder = None
        if out:
            folder = self.folder / out
            shutil.rmtree(folder, ignore_errors=True)
            words = (*words, "-o", folder)
        bound = ("--memory", self.arguments.memory) if is_bounded else ()
        used = results.timed([self.programs / program, *words, *bound, *self.threads, "-q"],
                             watch=WATCH_S, folder=folder)
        used.pop("stdout")
        row = {"count": self.count, "what": what, "program": program, **used}
        if folder:
            row["left_bytes"] = sum(512 * file.stat().st_blocks for file in folder.rglob("*") if file.is_file())
            report = folder / "report.json"
            if report.exists():
                told = json.loads(report.read_text())
                row |= {key: told[key] for key in ("lf_images_selected", "passes", "load_cpu_s", "collect_cpu_s")}
                row["pairs"] = sum(frame["lf_images"] for frame in told["frames"])
                row["skipped"] = len(told["skipped_lf_images"])
        self.rows.append(row)
        print(f"{self.count} {what}: {used['seconds']:.1f} s, {used['cpu_s']:.1f} CPU s, "
              f"{used['peak_bytes'] / MIB:.0f} MiB", flush=True)
        return row

    def photograph(self):
        spacing_m = SIDE_M / math.sqrt(self.count)
        self.run("LF images made", "lfsynth", "chart", "-o", self.field, "--count", self.count, "--size",
                 self.arguments.size, "--spacing", f"{spacing_m:.9f}", "--distance", DISTANCE_M, "--format", "png",
                 "--samples", "1", is_bounded=False)
        files = list((self.field / "images").iterdir())
        if len(files) != self.count:
            raise SystemExit(f"lfsynth made {len(files)} LF images, expected {self.count}")
        self.rows[-1] |= {"files": len(files), "files_bytes": sum(512 * file.stat().st_blocks for file in files)}

    def render(self):
        """Renders the film in one run and by packages. The frames of both must be bit-identical."""
        self.run("in one go", "lfrenderer", self.field, self.path, "--no-contact-sheet", *PLAIN, out="whole")
        self.run("packages made", "lfpreprocessor", self.field, self.path, "--packages", self.arguments.packages,
                 "--estimator", "bilinear", "--lens-weights", "none", out="packages")
        packages = sorted((self.folder / "packages").glob("*.lfp"))
        self.run("by packages", "lfrenderer", *packages, "--no-contact-sheet", *PLAIN, out="parts")
        if digest(self.folder / "whole") != digest(self.folder / "parts"):
            raise SystemExit(f"{self.count} LF images: packages give other frames than one go")
        taken = self.rows[-3]["lf_images_selected"]
        if taken < 0.999 * self.count:
            raise SystemExit(f"the film takes {taken} of {self.count} LF images: "
                             "it should take all but a few in corners")

    def render_stores(self):
        """Renders the film from stores without loss, of single LF images and of groups. Both must give the bits of
        the files."""
        for words, profile in (("", "lossless"), (" of groups", "group-lossless")):
            store = self.folder / "field.lfs"
            self.run(f"store{words} made", "lfcompressor", self.field, "-o", store, "--profile", profile, "--reencode",
                     is_bounded=False)
            self.rows[-1] |= {"files": 1, "files_bytes": store.stat().st_size}
            self.run(f"film from a store{words}", "lfrenderer", store, self.path, "--no-contact-sheet", *PLAIN,
                     out="stored")
            if digest(self.folder / "whole") != digest(self.folder / "stored"):
                raise SystemExit(f"{self.count} LF images: a store{words} gives other frames than the files")
            shutil.rmtree(self.folder / "stored")
            store.unlink()

    def render_weighed(self):
        self.run("in one go, defaults", "lfrenderer", self.field, self.path, "--no-contact-sheet", out="weighed")


def measure(arguments, folder):
    rows = []
    weighed = list(map(int, arguments.weighed.split(","))) if arguments.weighed else []
    for count in map(int, arguments.counts.split(",")):
        scale = Scale(arguments, folder, count)
        try:
            scale.photograph()
            scale.render()
            scale.render_stores()
            if count in weighed:
                scale.render_weighed()
        finally:
            for name in ("field", "whole", "packages", "parts", "weighed", "stored"):
                shutil.rmtree(folder / name, ignore_errors=True)
        rows += scale.rows
    return rows


def per_image_us(rows, row):
    """Returns the additional CPU microseconds per additional LF image, compared with the smallest light field; None
    for it."""
    same = [other for other in rows if other["what"] == row["what"]]
    least = min(same, key=lambda other: other["count"])
    if least is row:
        return None
    return 1e6 * (row["cpu_s"] - least["cpu_s"]) / (row["count"] - least["count"])


def table(record):
    lines = ["| LF images | | LF images x frames | "
             "s | CPU s | CPU µs per LF image more | CPU s: decoding, collecting | "
             "peak MiB | open files | MB in its folder: most, left |", "|" + " --- |" * 10]
    for row in sorted(record["rows"], key=lambda row: row["count"]):
        extra = per_image_us(record["rows"], row)
        parts = (f"{row['load_cpu_s']:.1f}, {row['collect_cpu_s']:.1f}" if "load_cpu_s" in row else "")
        space = (f"{row['folder_bytes'] / 1e6:.1f}, {row['left_bytes'] / 1e6:.1f}" if "left_bytes" in row
                 else f"{row['files']:,} files, {row['files_bytes'] / 1e6:.0f}")
        lines.append(f"| {row['count']:,} | {row['what']} | {row.get('pairs', '')} | {row['seconds']:.1f} | "
                     f"{row['cpu_s']:.1f} | {'' if extra is None else f'{extra:.0f}'} | {parts} | "
                     f"{row['peak_bytes'] / MIB:.0f} | {row['open_files']} | {space} |")
    return lines


def goals(record):
    """Returns the goals for growing light fields, and whether they were reached."""
    lines = []

    def goal(what, value, is_reached):
        lines.append(f"- {'reached' if is_reached else 'MISSED'}: {what}: {value}")

    bounded = [row for row in record["rows"] if row["program"] not in ("lfsynth", "lfcompressor")]
    peak, bound = max(row["peak_bytes"] for row in bounded) / MIB, record["memory"]
    goal(f"no program takes more than --memory {bound}", f"{peak:.0f} MiB", peak <= float(bound.rstrip("M")))
    files = [row["open_files"] for row in bounded]
    goal("no program opens more than 32 files at once", max(files), max(files) <= 32)
    for what in ("in one go", "packages made", "by packages"):
        costs = [per_image_us(record["rows"], row) for row in bounded if row["what"] == what]
        if len(costs) > 2:
            ratio = costs[-1] / costs[-2]
            goal(f"CPU per LF image, {what}, the most LF images to those before, within 1.25", f"{ratio:.2f}",
                 ratio <= 1.25)
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--counts", default="1000,10000,100000")
    parser.add_argument("--weighed", default="1000,10000")
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--size", default="48x32")
    parser.add_argument("--memory", default="256M")
    parser.add_argument("--packages", type=int, default=8)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--folder", type=pathlib.Path)
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build, lambda folder: {
        **{key: getattr(arguments, key) for key in ("frames", "size", "memory", "packages", "threads")},
        "rows": measure(arguments, arguments.folder or folder)})
    text = "\n".join([results.sentence(record) + f" {record['frames']} frames of "
                                                 f"{record['size']} elements from LF images "
                      f"as large, --memory {record['memory']}, {record['threads']} threads, "
                      f"{record['packages']} packages; "
                      "frames of both ways have the same bits.", ""] + table(record) + [""] + goals(record)) + "\n"
    results.publish(arguments, "scale.py", record, text)


if __name__ == "__main__":
    main()
