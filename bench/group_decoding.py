#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the CPU time of decoding a group of predicted LF images with that of a video decoder.

usage: bench/group_decoding.py BUILD_DIR [--only "CAPTURE;..."] [--size 960x640] [--runs 5] [--write doc/codec.md]
       bench/group_decoding.py --again JSON [--write doc/codec.md]

BUILD_DIR is a build with LF_BENCH=ON, for lf_predicted_group. Each capture of lfsynth is a group of 4 x 4 LF images in
8-bit RGB. lf_predicted_group encodes it relative to each other, by contexts as `--profile group` does and packed, and
tells the CPU time of decoding. The peer is HEVC:
libx265 in ffmpeg, preset medium, 16 pictures of which the first is a key picture, in rows from left to right and from
right to left in turn, with whole colours (yuv444p), and with halved ones (yuv420p) where these reach the PSNR. Its QP
is the largest with which the PSNR of the RGB pictures is at least that of the group. ffmpeg decodes the file with one
thread, 20 times in a row; the time of the first, with the start of the program, is left out. It is FFmpeg's decoder, in
assembly for this machine, and does not convert to RGB. Figures are medians of --runs, which alternate.
"""
import argparse
import csv
import io
import json
import pathlib
import re
import statistics
import subprocess
import tempfile

import cv2
import numpy as np

import record as results

SIDE = 4
COUNT = SIDE * SIDE
CAPTURES = {  # scene, metres between LF cameras, nearest and farthest depth
    "still-life, 3 mm": ("still-life", 0.003, 0.4, 3.3),
    "still-life, 9 mm": ("still-life", 0.009, 0.4, 3.3),
    "foliage, 5 mm": ("foliage", 0.005, 0.4, 3.3),
}
FORMATS = ("yuv444p", "yuv420p")
REPEATS = 19
REC_709 = np.array([[0.2126, 0.7152, 0.0722], [-0.114572, -0.385428, 0.5], [0.5, -0.454153, -0.045847]])
OFFSET = (0, 128, 128)


def planes_of(picture):
    """Returns Y, Cb, Cr of the whole range, [3][height][width], of B, G, R."""
    values = picture[..., ::-1] @ REC_709.T + OFFSET
    return np.clip(np.rint(values), 0, 255).astype(np.uint8).transpose(2, 0, 1)


def picture_of(planes):
    values = (planes.transpose(1, 2, 0) - np.float64(OFFSET)) @ np.linalg.inv(REC_709).T
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)[..., ::-1]


class Video:
    """The LF images of a group as a video."""

    def __init__(self, pictures, folder):
        order = [row * SIDE + (column if row % 2 == 0 else SIDE - 1 - column)
                 for row in range(SIDE) for column in range(SIDE)]
        self.pictures = [pictures[number] for number in order]
        self.height, self.width = pictures[0].shape[:2]
        self.source, self.coded, self.back = folder / "in.yuv", folder / "coded.mkv", folder / "out.yuv"
        with open(self.source, "wb") as out:
            for picture in self.pictures:
                out.write(planes_of(picture).tobytes())

    def encode(self, pixel_format, qp):
        """Returns the bytes and the PSNR."""
        raw = ["-f", "rawvideo", "-pix_fmt", "yuv444p"]
        quiet = ["ffmpeg", "-hide_banner", "-loglevel", "error", "-y"]
        chroma = ["-sws_flags", "bicubic+accurate_rnd+full_chroma_int"]
        results.call([*quiet, *raw, "-s", f"{self.width}x{self.height}", "-r", 25, "-i", self.source, *chroma,
                      "-pix_fmt", pixel_format, "-c:v", "libx265", "-preset", "medium", "-tune", "psnr", "-x265-params",
                      f"log-level=error:qp={qp}:keyint={COUNT}:min-keyint={COUNT}:open-gop=0:scenecut=0:bframes=8:"
                      "b-adapt=0:ref=4:pools=none:frame-threads=1", self.coded])
        results.call([*quiet, "-threads", 1, "-i", self.coded, *chroma, *raw, self.back])
        shape = (COUNT, 3, self.height, self.width)
        decoded = np.fromfile(self.back, np.uint8).reshape(shape)
        error = np.mean([np.mean((picture.astype(float) - picture_of(planes)) ** 2)
                         for picture, planes in zip(self.pictures, decoded, strict=True)])
        return self.coded.stat().st_size, float(10 * np.log10(255 ** 2 / error))

    def encode_at(self, pixel_format, decibels):
        """Encodes with the largest QP that reaches the PSNR. Returns {qp, bytes, db}; None if none does."""
        low, high = 0, 45  # `low` reaches it, as far as known; `high` does not
        while high - low > 1:
            middle = (low + high) // 2
            _, found = self.encode(pixel_format, middle)
            low, high = (middle, high) if found >= decibels else (low, middle)
        if low == 0:
            return None
        size, found = self.encode(pixel_format, low)
        return {"qp": low, "bytes": size, "db": found}

    def decode_cpu_s(self):
        """Returns the CPU time of decoding the 16 pictures once."""
        def spent(loops):
            done = subprocess.run(["ffmpeg", "-hide_banner", "-benchmark", "-threads", "1", "-stream_loop", str(loops),
                                   "-i", str(self.coded), "-f", "null", "-"], capture_output=True, text=True)
            if done.returncode != 0:
                raise SystemExit(f"ffmpeg ended with {done.returncode}:\n{done.stderr}")
            found = re.search(r"bench: utime=([\d.]+)s stime=([\d.]+)s", done.stderr)
            frames = re.findall(r"frame= *(\d+)", done.stderr)
            if not found or int(frames[-1]) != COUNT * (loops + 1):
                raise SystemExit(f"ffmpeg decoded {frames[-1:]} pictures, expected {COUNT * (loops + 1)}:\n"
                                 f"{done.stderr}")
            return float(found[1]) + float(found[2])
        return (spent(REPEATS) - spent(0)) / REPEATS


def group_rows(build, field, near, far):
    """Returns the rows of lf_predicted_group, by threshold."""
    text = results.call([build / "bench/lf_predicted_group", field, COUNT, near, far])
    return {float(row["threshold"]): {key: float(value) for key, value in row.items()}
            for row in csv.DictReader(io.StringIO(text))}


WAYS = {"group": "contexts", "packed": "predicted", "alone": "alone"}  # columns of lf_predicted_group


def cpu_s(row, way):
    """Returns the CPU time of decoding all LF images. The key image of a group takes that of an LF image that is
    encoded alone."""
    return row[f"{WAYS[way]} decode s"] + row["alone decode s"] / (COUNT - 1)


def measure(build, names, size, runs, folder):
    rows = []
    for number, name in enumerate(names):
        scene, spacing, near, far = CAPTURES[name]
        field = folder / f"field{number}"
        results.call([build / "bin/lfsynth", scene, "-o", field, "--count", COUNT, "--size", size, "--format", "png",
                      "--spacing", spacing, "-q"])
        frames = json.loads((field / "transforms.json").read_text())["frames"]
        pictures = [cv2.imread(str(field / frame["file_path"])) for frame in frames]
        videos = {}
        first = group_rows(build, field, near, far)
        for threshold, row in first.items():
            if threshold == 0:  # lossless
                continue
            for pixel_format in FORMATS:
                place = folder / f"{number}-{threshold:g}-{pixel_format}"
                place.mkdir()
                video = Video(pictures, place)
                if found := video.encode_at(pixel_format, row["predicted dB"]):
                    videos[threshold, pixel_format] = video, found
        times = {}
        for _ in range(runs):
            for threshold, row in group_rows(build, field, near, far).items():
                for way in WAYS:
                    times.setdefault((threshold, way), []).append(cpu_s(row, way))
            for key, (video, _) in videos.items():
                times.setdefault(key, []).append(video.decode_cpu_s())
        pixels = COUNT * pictures[0].shape[0] * pictures[0].shape[1]
        for (threshold, way), seconds in times.items():
            found = videos[threshold, way][1] if (threshold, way) in videos else {}
            row = first[threshold]
            words = WAYS.get(way)
            rows.append({"capture": name, "threshold": threshold, "way": way,
                         "bytes": row[f"{words} bytes"] if words else found["bytes"],
                         "db": (row[f"{words} dB"] if words else found["db"]) if threshold else None,
                         "qp": found.get("qp"),
                         "ns_per_pixel": 1e9 * statistics.median(seconds) / pixels})
    return rows


def table(record):
    lines = ["| capture | threshold | way | dB | bytes | decoding, ns of CPU per pixel | / group |",
             "|" + " --- |" * 7]
    names = {"group": "group", "packed": "group, packed", "alone": "each alone, packed",
             "yuv444p": "HEVC, yuv444p", "yuv420p": "HEVC, yuv420p"}
    order = list(names)
    rows = sorted(record["rows"], key=lambda row: (list(CAPTURES).index(row["capture"]), row["threshold"],
                                                   order.index(row["way"])))
    group = {(row["capture"], row["threshold"]): row["ns_per_pixel"] for row in rows if row["way"] == "group"}
    for row in rows:
        threshold = f"{row['threshold']:g}" if row["threshold"] else "lossless"
        decibels = f"{row['db']:.1f}" if row["threshold"] else "exact"
        ratio = row["ns_per_pixel"] / group[row["capture"], row["threshold"]]
        lines.append(f"| {row['capture']} | {threshold} | {names[row['way']]} | {decibels} | {row['bytes']:.0f} | "
                     f"{row['ns_per_pixel']:.1f} | {ratio:.2f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?", metavar="BUILD_DIR")
    parser.add_argument("--only", help="captures, with semicolons between")
    parser.add_argument("--size", default="960x640")
    parser.add_argument("--runs", type=int, default=5)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        names = arguments.only.split(";") if arguments.only else list(CAPTURES)
        record = results.context() | {"size": arguments.size, "runs": arguments.runs}
        with tempfile.TemporaryDirectory() as temporary:
            record["rows"] = measure(arguments.build.resolve(), names, arguments.size, arguments.runs,
                                     pathlib.Path(temporary))
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record), f"Groups of {COUNT} LF images of {record['size']}; medians of "
                      f"{record['runs']} runs.", ""] + table(record)) + "\n"
    results.publish(arguments, "group_decoding.py", record, text)


if __name__ == "__main__":
    main()
