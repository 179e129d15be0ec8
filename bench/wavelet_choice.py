#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares transforms, quantisers and packings as prototypes in NumPy, to choose those of the codec (doc/codec.md).

usage: bench/wavelet_choice.py [--data ../shared] [--name NAME] [--write doc/codec.md]
       bench/wavelet_choice.py --again JSON [--write doc/codec.md]

The data are one LF image of `blender-shop` and one of `beer-colmap`, as RGGB mosaics of 8 bits. The table shows ratios
at equal PSNR (found by bisection of the step). All schemes but the thesis's have uniform quantisers with a dead zone,
whose steps give the same error per coefficient in every band. They pack one, two or four coefficients into a byte,
whichever is shortest (escapes are stored separately), and compress the bytes by zstd -1. The whole image is one tile.
"""
import argparse
import json
import lzma
import pathlib
import sys

import cv2
import numpy as np
import zstandard

import record as results


def shifted(a, k, count):
    """Returns a[i + k], with the last value repeated beyond the ends."""
    return a[np.clip(np.arange(count) + k, 0, len(a) - 1)]


# Lifting steps: (the changed half, taps by offset in the other half), ...
LIFTING = {
    "5/3": [("high", {0: -1 / 2, 1: -1 / 2}), ("low", {-1: 1 / 4, 0: 1 / 4})],
    "(4, 4)": [("high", {-1: 1 / 16, 0: -9 / 16, 1: -9 / 16, 2: 1 / 16}),
               ("low", {-2: -1 / 32, -1: 9 / 32, 0: 9 / 32, 1: -1 / 32})],
    "9/7": [("high", {0: -1.586134342, 1: -1.586134342}), ("low", {-1: -0.05298011854, 0: -0.05298011854}),
            ("high", {0: 0.8829110762, 1: 0.8829110762}), ("low", {-1: 0.4435068522, 0: 0.4435068522})],
    "Haar": [("high", {0: -1}), ("low", {0: 1 / 2})],
}


def lift(wavelet, low, high, sign):
    for what, taps in LIFTING[wavelet][::sign]:
        to, of = (high, low) if what == "high" else (low, high)
        to += sign * sum(tap * shifted(of, k, len(to)) for k, tap in taps.items())


def analyze(wavelet, x):
    low, high = x[0::2].copy(), x[1::2].copy()
    lift(wavelet, low, high, 1)
    return low, high


def synthesize(wavelet, low, high):
    low, high = low.copy(), high.copy()
    lift(wavelet, low, high, -1)
    x = np.empty((len(low) + len(high),) + low.shape[1:])
    x[0::2], x[1::2] = low, high
    return x


def bands_of(wavelet, plane):
    """Returns the subbands LL, LH, HL, HH; the first letter is of the horizontal direction."""
    low, high = (half.T for half in analyze(wavelet, plane.T))
    return [*analyze(wavelet, low), *analyze(wavelet, high)][::1]


def plane_of(wavelet, low_low, low_high, high_low, high_high):
    low, high = synthesize(wavelet, low_low, low_high), synthesize(wavelet, high_low, high_high)
    return synthesize(wavelet, low.T, high.T).T


def norm(wavelet, path):
    """Returns the norm of the signal that one coefficient becomes. path: for each level, from the deepest on, True
    for high."""
    x = np.zeros(16)
    x[8] = 1
    for high in path:
        x = synthesize(wavelet, np.zeros_like(x), x) if high else synthesize(wavelet, x, np.zeros_like(x))
    return np.sqrt((x ** 2).sum())


def squeezed(codes):
    """Returns the number of bytes of a stream with the shortest packing."""
    numbers = (codes << 1) ^ (codes >> 31)
    best = None
    for per_byte, escape in ((1, 255), (2, 15), (4, 3)):
        few = np.minimum(numbers, escape)
        few = np.pad(few, (0, -len(few) % per_byte)).reshape(-1, per_byte)
        packed = sum(few[:, place] << (8 // per_byte * place) for place in range(per_byte)).astype(np.uint8)
        escapes = (numbers[numbers >= escape] - escape).astype("<u2")
        size = sum(len(zstandard.ZstdCompressor(level=1).compress(part.tobytes()))
                   for part in (packed, escapes.view(np.uint8)[0::2], escapes.view(np.uint8)[1::2]))
        best = size if best is None else min(best, size)
    return best


class Scheme:
    """A way to split a mosaic into planes, and the wavelet that transforms them."""

    def __init__(self, planes, wavelet, levels=3, dead_zone=2 / 3):
        self.planes, self.wavelet, self.levels, self.dead_zone = planes, wavelet, levels, dead_zone

    def split(self, mosaic):
        """Returns the planes, and for each plane the norm of the synthesis of one of its values."""
        quads = [mosaic[y::2, x::2] for y in (0, 1) for x in (0, 1)]
        if self.planes == "colours":
            return quads, [1] * 4
        if self.planes == "sums":
            r, g1, g2, b = quads
            return [(r + g1 + g2 + b) / 4, g1 - g2, (g1 + g2 - r - b) / 2, r - b], [2, 0.5 ** 0.5, 1, 0.5 ** 0.5]
        low, high = (norm(self.planes, [h]) for h in (False, True))
        return bands_of(self.planes, mosaic), [low * low, low * high, high * low, high * high]

    def join(self, planes):
        if self.planes == "sums":
            y, d, e, f = planes
            planes = [y - e / 2 + f / 2, y + e / 2 + d / 2, y + e / 2 - d / 2, y - e / 2 - f / 2]
        elif self.planes != "colours":
            return plane_of(self.planes, *planes)
        mosaic = np.empty([2 * n for n in planes[0].shape])
        for i, plane in enumerate(planes):
            mosaic[i // 2::2, i % 2::2] = plane
        return mosaic

    def code(self, mosaic, step):
        """Returns the number of bytes and the decoded mosaic."""
        size, decoded = 0, []
        for plane, weight in zip(*self.split(mosaic - 128.0)):
            levels, low = [], plane
            for level in range(1, self.levels + 1):
                bands = bands_of(self.wavelet, low)
                low, details, codes = bands[0], [], []
                for band, (across, down) in zip(bands[1:], ((0, 1), (1, 0), (1, 1))):
                    rest = [False] * (level - 1)
                    of_band = step / weight / norm(self.wavelet, [across, *rest]) / norm(self.wavelet, [down, *rest])
                    code = (np.sign(band) * np.floor(np.abs(band) / of_band + 1 - self.dead_zone)).astype(np.int32)
                    codes.append(code.ravel())
                    details.append(code * of_band)
                size += squeezed(np.concatenate(codes))
                levels.append(details)
            of_band = step / weight / norm(self.wavelet, [False] * self.levels) ** 2
            code = np.round(low / of_band).astype(np.int32)
            size += squeezed(np.diff(code, axis=0, prepend=0).ravel())
            low = code * of_band
            for details in reversed(levels):
                low = plane_of(self.wavelet, low, *details)
            decoded.append(low)
        return size, np.clip(np.round(self.join(decoded) + 128), 0, 255)


def thesis(mosaic, threshold, levels):
    """Returns the number of bytes after compression by xz, and the decoded mosaic."""
    coefficients = []
    for i in range(4):
        low, details = mosaic[i // 2::2, i % 2::2].astype(float), []
        for _ in range(levels):
            even, odd = low.T[0::2], low.T[1::2]
            across_low, across_high = ((even + odd) / 2).T, ((even - odd) / 2).T
            low, *bands = [(half[0::2] + s * half[1::2]) / 2 for half in (across_low, across_high) for s in (1, -1)]
            details.append([np.where(np.abs(b) < threshold, 0, b) for b in bands])
        coefficients.append((low, details))
    values = [b for low, details in coefficients for b in [low, *sum(details, [])]]
    least, most = min(v.min() for v in values), max(v.max() for v in values)
    rounded = lambda b: np.round((b - least) / (most - least) * 255)
    data = b"".join(rounded(b).astype(np.uint8).tobytes() for b in values)
    decoded = np.empty(mosaic.shape)
    for i, (low, details) in enumerate(coefficients):
        back = lambda b: rounded(b) / 255 * (most - least) + least
        low = back(low)
        for bands in reversed(details):
            down, across, both = (back(b) for b in bands)
            finer = np.empty([2 * n for n in low.shape])
            for y in (0, 1):
                for x in (0, 1):
                    finer[y::2, x::2] = low + (1 - 2 * y) * down + (1 - 2 * x) * (across + (1 - 2 * y) * both)
            low = finer
        decoded[i // 2::2, i % 2::2] = low
    return len(lzma.compress(data, preset=6)), np.clip(np.round(decoded), 0, 255)


def psnr(a, b):
    return 10 * np.log10(255 ** 2 / np.mean((a.astype(float) - b) ** 2))


def ratio_at(mosaic, target, code):
    """Returns the ratio at which code(strength) has this PSNR, interpolated between two strengths."""
    weak, strong = 0.2, 60.0
    for _ in range(8):
        middle = (weak * strong) ** 0.5
        size, decoded = code(middle)
        weak, strong = (middle, strong) if psnr(mosaic, decoded) > target else (weak, middle)
    points = sorted((psnr(mosaic, decoded), np.log(mosaic.size / size))
                    for size, decoded in (code(weak * f) for f in (0.8, 1, 1.25)))
    dbs = [db for db, _ in points]
    if not dbs[0] <= target <= dbs[-1]:
        return None
    return np.exp(np.interp(target, dbs, [value for _, value in points]))


ROWS = [("thesis: planes of colours, Haar, xz", None)] + [
    (f"{planes}, {wavelet}", Scheme(planes.split(":")[0], wavelet, levels)) for planes, wavelet, levels in (
        ("colours", "Haar", 4), ("colours", "5/3", 4), ("colours", "9/7", 4), ("sums", "9/7", 3),
        ("5/3", "5/3", 3), ("5/3", "9/7", 3), ("5/3", "(4, 4)", 3), ("9/7", "9/7", 3))] + [
    (f"5/3, 5/3, dead zone {zone}", Scheme("5/3", "5/3", 3, zone)) for zone in (0.5, 0.6, 0.75)] + [
    (f"5/3, 5/3, {levels} levels", Scheme("5/3", "5/3", levels)) for levels in (2, 4)]


TARGETS_DB = (40, 45)


def mosaics_of(data):
    """Returns one RGGB mosaic of each light field."""
    mosaics = {}
    for name, pattern in (("blender-shop", "*_13_13_*"), ("beer-colmap", "*")):
        files = sorted((data / "data" / name / "images").glob(pattern + ".jpg"))
        picture = cv2.imread(str(files[len(files) // 2]))
        height, width = (n // 16 * 16 for n in picture.shape[:2])
        mosaic = np.empty((height, width))
        for y, x, channel in ((0, 0, 2), (0, 1, 1), (1, 0, 1), (1, 1, 0)):
            mosaic[y::2, x::2] = picture[y:height:2, x:width:2, channel]
        mosaics[name] = mosaic
    return mosaics


def measure(data):
    """Returns one row per scheme: its ratios in the order of the columns, None if a target is out of reach."""
    rows = []
    mosaics = mosaics_of(data)
    for words, scheme in ROWS:
        ratios = []
        for mosaic, target in ((mosaic, target) for mosaic in mosaics.values() for target in TARGETS_DB):
            if scheme:
                ratios.append(ratio_at(mosaic, target, lambda step: scheme.code(mosaic, step)))
            else:
                found = [ratio_at(mosaic, target, lambda t: thesis(mosaic, t, levels)) for levels in (1, 2, 3)]
                ratios.append(max((r for r in found if r), default=None))
        rows.append({"scheme": words, "ratios": ratios})
        print(rows[-1], file=sys.stderr, flush=True)
    return {"contents": list(mosaics), "rows": rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    else:
        record = results.context() | measure(arguments.data)
    columns = [f"{name}, {target} dB" for name in record["contents"] for target in TARGETS_DB]
    lines = ["| planes, wavelet | " + " | ".join(columns) + " |", "|" + " --- |" * (1 + len(columns))]
    for row in record["rows"]:
        lines.append(f"| {row['scheme']} | " + " | ".join("-" if ratio is None else f"{ratio:.2f}"
                                                          for ratio in row["ratios"]) + " |")
    results.publish(arguments, "wavelet_choice.py", record, results.sentence(record) + "\n\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
