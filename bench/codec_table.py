#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures Table 5.3 of the thesis again: how small LF images become, and what that does to rendered frames.

usage: bench/codec_table.py BUILD_DIR [--data ../shared] [--only shop,synth,noisy] [--no-peers] [--views 7]
                            [--size 480x320] [--frames 1-50x12] [--name NAME] [--write doc/codec.md]
       bench/codec_table.py BUILD_DIR --pictures doc/images
       bench/codec_table.py --again JSON [--write doc/codec.md]

The light fields are RGGB mosaics: `shop`, the 7 x 7 views (--views) in the middle of blender-shop, reduced to one
colour per pixel (8 bits, sRGB); `synth` and `noisy`, as many LF images of lfsynth's still life, --size large (16 bits,
linear), without and with sensor noise. Each is encoded by `lfcompressor` with many settings, and frames of a focus pull
are rendered from the store and from the originals: by plain interpolation without lens weights, and for our own codec
also by the defaults. The thesis's bytes are also compressed by xz, bzip2 and zstd -19 (with a separate implementation
of the thesis's scheme, in NumPy, on three LF images); "best" is the shortest result. Peers encode the four planes of
each mosaic side by side as one grey picture: JPEG and JPEG 2000 by OpenCV, PNG, and JPEG XL if `cjxl` is installed
(libjxl-tools). The PSNR of images is computed from stored values, the PSNR of frames from 16-bit sRGB pictures.
--pictures measures nothing: it draws artefacts in a frame of `still`, 8-bit sRGB mosaics of lfsynth's still life.
"""
import argparse
import bz2
import itertools
import json
import lzma
import math
import pathlib
import shutil
import tempfile
import time

import cv2
import numpy as np
import zstandard

import record as results

WAYS = {"none": ("--mode", "collect", "--estimator", "bilinear", "--filter", "bilinear", "--lens-weights", "none"),
        "default": ()}
THESIS = [(1, t) for t in (0.5, 1, 2, 4, 8, 16)] + [(2, t) for t in (0.5, 1, 2, 4, 8)] + \
         [(3, t) for t in (0.5, 1, 2, 4)]
TABLE_5_3 = {(1, 2): 11.7, (1, 4): 13.7, (1, 8): 15.1, (2, 0.5): 7.5, (2, 2): 21.1, (2, 4): 30.6, (3, 4): 44.6}
DEFAULT = (1, 1.5, 2, 3, 4, 6, 8, 12, 16)
# Our own ways to encode, with and without a loss.
OURS = {"default": ((), ("--profile", "lossless")),
        "default, contexts": (("--entropy", "contexts"), ("--profile", "lossless", "--entropy", "contexts")),
        "group": (("--profile", "group"), ("--profile", "group-lossless"))}


def run(*words, **more):
    return results.call(words, **more)


def mosaic_of(picture):
    """Returns RGGB made from BGR."""
    mosaic = np.empty(picture.shape[:2], picture.dtype)
    mosaic[0::2, 0::2] = picture[0::2, 0::2, 2]
    mosaic[0::2, 1::2] = picture[0::2, 1::2, 1]
    mosaic[1::2, 0::2] = picture[1::2, 0::2, 1]
    mosaic[1::2, 1::2] = picture[1::2, 1::2, 0]
    return mosaic


class Content:
    """A light field of mosaics, a path, and the frames rendered from the original mosaics."""

    def __init__(self, arguments, name, folder):
        build, data, reach = arguments.build.resolve(), arguments.data, arguments.views // 2
        self.build, self.folder, self.name, self.range = build, folder, name, arguments.frames
        self.field = folder / "field"
        if name == "shop":
            (folder / "mosaics").mkdir(parents=True)
            for file in sorted((data / "data/blender-shop/images").glob("*.jpg")):
                row, column = (int(word) for word in file.stem.split("_")[1:3])
                if abs(row - 13) <= reach and abs(column - 13) <= reach:
                    cv2.imwrite(str(folder / "mosaics" / (file.stem + ".png")), mosaic_of(cv2.imread(str(file))))
            run(build / "bin/lfimport", folder / "mosaics", "-o", self.field, "--bayer", "RGGB", "-q")
            calibration = self.field / "transforms.json"  # mosaics are linear unless their calibration says otherwise
            calibration.write_text(json.dumps(json.loads(calibration.read_text()) | {"lf_transfer": "sRGB"}))
        elif name == "still":
            run(build / "bin/lfsynth", "still-life", "-o", folder / "colours", "--count", arguments.views ** 2,
                "--size", arguments.size, "--format", "png", "-q")
            for file in (folder / "colours" / "images").glob("*.png"):
                cv2.imwrite(str(file), mosaic_of(cv2.imread(str(file))))
            run(build / "bin/lfimport", folder / "colours", "-o", self.field, "--bayer", "RGGB", "-q")
            calibration = self.field / "transforms.json"
            calibration.write_text(json.dumps(json.loads(calibration.read_text()) | {"lf_transfer": "sRGB"}))
        else:
            run(build / "bin/lfsynth", "still-life", "-o", self.field, "--count", arguments.views ** 2, "--size",
                arguments.size, "--bayer",
                "--noise", 0.005 if name == "noisy" else 0, "-q")
        self.path = folder / "path.yaml"
        run(build / "bin/lfexample", self.field, "-o", self.path, "--move", "focus-pull", "-q")
        calibration = json.loads((self.field / "transforms.json").read_text())
        self.images = [self.field / frame["file_path"] for frame in calibration["frames"]]
        self.bits = 8 if cv2.imread(str(self.images[0]), cv2.IMREAD_UNCHANGED).dtype == np.uint8 else 16
        self.pixel_bytes = sum(cv2.imread(str(i), cv2.IMREAD_UNCHANGED).nbytes for i in self.images)
        self.frames = {way: self.render(self.field, way) for way in WAYS}

    def render(self, light_field, way="none"):
        out = self.folder / "frames"
        shutil.rmtree(out, ignore_errors=True)
        run(self.build / "bin/lfrenderer", light_field, self.path, "-o", out, "--frames", self.range, "--format",
            "png16", "--no-contact-sheet", "-q", *WAYS[way])
        return [cv2.imread(str(f), cv2.IMREAD_UNCHANGED) for f in sorted(out.glob("frame_*.png"))]

    def frame_psnr(self, frames, way="none"):
        error = np.mean([np.mean((a.astype(float) - b) ** 2) for a, b in zip(self.frames[way], frames)])
        return 10 * math.log10(65535 ** 2 / error) if error > 0 else math.inf

    def code(self, *options, and_by_defaults=False):
        """Returns one row (the report of lfcompressor and the quality of the frames), and the frames."""
        store = self.folder / "field.lfs"
        report = json.loads(run(self.build / "bin/lfcompressor", self.field, "-o", store, "--reencode", "--overwrite",
                                "--json", "--progress", "none", *options))
        frames = self.render(store)
        default_psnr = self.frame_psnr(self.render(store, "default"), "default") if and_by_defaults else None
        return {"default_psnr": default_psnr, "ratio": report["ratio"],
                "psnr": float(str(report["psnr_db"]).replace("exact", "inf")),
                "frame_psnr": self.frame_psnr(frames), "cpu_s": report["encode_cpu_s"],
                "bytes": report["code_bytes"], "total_s": report["total_s"]}, frames

    def peer(self, coder):
        """Returns a row as code() does, for coder(picture) -> bytes, decoded picture."""
        folder = self.folder / "peer"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        calibration = json.loads((self.field / "transforms.json").read_text())
        size, error, seconds = 0, 0.0, 0.0
        for i, (file, frame) in enumerate(zip(self.images, calibration["frames"])):
            mosaic = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
            planes = np.vstack([np.hstack([mosaic[y::2, x::2] for x in (0, 1)]) for y in (0, 1)])
            begin = time.process_time()
            code, decoded = coder(planes)
            seconds += time.process_time() - begin
            size += code
            height, width = planes.shape[0] // 2, planes.shape[1] // 2
            back = np.empty_like(mosaic)
            for y in (0, 1):
                for x in (0, 1):
                    back[y::2, x::2] = decoded[y * height:(y + 1) * height, x * width:(x + 1) * width]
            error += np.mean((back.astype(float) - mosaic) ** 2)
            frame["file_path"] = f"{i}.png"
            cv2.imwrite(str(folder / f"{i}.png"), back, [cv2.IMWRITE_PNG_COMPRESSION, 1])
        (folder / "transforms.json").write_text(json.dumps(calibration))
        error /= len(self.images)
        # Only lfcompressor compares 16-bit images, along the curve of a display.
        psnr = math.inf if error == 0 else 10 * math.log10(255 ** 2 / error) if self.bits == 8 else None
        return {"ratio": self.pixel_bytes / size, "cpu_s": seconds, "bytes": size, "psnr": psnr,
                "frame_psnr": self.frame_psnr(self.render(folder))}


def haar(plane):
    """Returns one level of averages and differences: low, across, down, both (thesis 2.5.1)."""
    def split(a):
        even, odd = a[0::2], a[1::2]
        low = even.copy()
        low[:len(odd)] = (even[:len(odd)] + odd) / 2
        return low, (even[:len(odd)] - odd) / 2
    low, high = (half.T for half in split(plane.T))
    low_low, down = split(low)
    across, both = split(high)
    return low_low, across, down, both


def best_lossless(content, levels, threshold, quantizer):
    """Returns by how much the best of four lossless coders beats zstd -1 on the thesis's bytes."""
    step = 1 if content.bits == 8 else 257
    sizes = np.zeros(4)
    for file in content.images[:: len(content.images) // 2 - 1][:3]:
        mosaic = cv2.imread(str(file), cv2.IMREAD_UNCHANGED).astype(float)
        planes = []
        for y in (0, 1):
            for x in (0, 1):
                low, details = mosaic[y::2, x::2], []
                for _ in range(levels):
                    low, *bands = haar(low)
                    details.append([np.where(np.abs(b) < threshold * step, 0, b) for b in bands])
                planes.append((low, details))
        values = [b for low, details in planes for b in [low] + sum(details, [])]
        least, most = min(b.min() for b in values), max(b.max() for b in values)

        def picture(low, details):
            for across, down, both in reversed(details):
                low = np.vstack([np.hstack([low, across]), np.hstack([down, both])])
            return low
        pictures = [picture(*plane) for plane in planes]
        whole = np.vstack([np.hstack(pictures[:2]), np.hstack(pictures[2:])])
        codes = np.round((whole - least) / (most - least) * (quantizer - 1))
        data = codes.astype(np.uint8 if quantizer <= 256 else "<u2").tobytes()
        sizes += [len(zstandard.ZstdCompressor(level=1).compress(data)),
                  len(zstandard.ZstdCompressor(level=19).compress(data)), len(bz2.compress(data, 9)),
                  len(lzma.compress(data, preset=6))]
    return sizes[0] / sizes.min()


def at(rows, key, target):
    """Returns the ratio at which the PSNR `key` reaches `target`, interpolated between rows; None if no row reaches it,
    or if all exceed it."""
    points = sorted((row[key], math.log(row["best"])) for row in rows
                    if row[key] is not None and math.isfinite(row[key]))
    values = [value for value, _ in points]
    if not points or not values[0] <= target <= values[-1]:
        return None
    return math.exp(np.interp(target, values, [ratio for _, ratio in points]))


def best_at(rows, key, target):
    """Returns the best ratio of all levels."""
    kinds = {(r["levels"], r.get("quantizer")) for r in rows}
    ratios = [at([r for r in rows if (r["levels"], r.get("quantizer")) == kind], key, target) for kind in kinds]
    return max((ratio for ratio in ratios if ratio), default=None)


def jpeg(quality):
    def code(picture):
        data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_JPEG_OPTIMIZE, 1])[1]
        return len(data), cv2.imdecode(data, cv2.IMREAD_UNCHANGED)
    return code


def jpeg_2000(thousandths):
    def code(picture):
        data = cv2.imencode(".jp2", picture, [cv2.IMWRITE_JPEG2000_COMPRESSION_X1000, thousandths])[1]
        return len(data), cv2.imdecode(data, cv2.IMREAD_UNCHANGED)
    return code


def png(picture):
    data = cv2.imencode(".png", picture, [cv2.IMWRITE_PNG_COMPRESSION, 6])[1]
    return len(data), picture


def jpeg_xl(distance, effort=3):
    def code(picture):
        with tempfile.TemporaryDirectory() as temporary:
            source, coded, back = (pathlib.Path(temporary) / name for name in ("a.png", "a.jxl", "b.png"))
            cv2.imwrite(str(source), picture)
            run("cjxl", source, coded, "-d", distance, "-e", effort, "--quiet")
            run("djxl", coded, back, "--quiet")
            return coded.stat().st_size, cv2.imread(str(back), cv2.IMREAD_UNCHANGED)
    return code


def peers_of(content):
    peers = {"JPEG 2000": [(f"{t / 10:g} %", jpeg_2000(t)) for t in (20, 40, 70, 120, 200, 300)]}
    if content.bits == 8:
        peers["JPEG"] = [(f"quality {q}", jpeg(q)) for q in (70, 80, 90, 95, 98)]
    if shutil.which("cjxl"):
        peers["JPEG XL"] = [(f"distance {d:g}", jpeg_xl(d)) for d in (0.2, 0.5, 1, 2, 3)]
    lossless = {"PNG": png}
    if shutil.which("cjxl"):
        lossless["JPEG XL"] = jpeg_xl(0)
    return peers, lossless


def number(value, digits=1):
    return "exact" if value == math.inf else "-" if value is None else f"{value:.{digits}f}"


def measure(content, with_peers):
    rows = []
    # With 16 bits, highlights alone take most of the 256 values of the 8-bit quantizer.
    quantizers = ("8bit",) if content.bits == 8 else ("8bit", 4096)
    for quantizer, (levels, threshold) in itertools.product(quantizers, THESIS):
        row, _ = content.code("--profile", "thesis", "--levels", levels, "--threshold", threshold,
                              "--quantizer", quantizer)
        row |= {"profile": "thesis", "levels": levels, "threshold": threshold, "quantizer": quantizer,
                "best": row["ratio"] * best_lossless(content, levels, threshold,
                                                     256 if quantizer == "8bit" else quantizer)}
        rows.append(row)
        print(content.name, row, flush=True)
    for profile, (lossy, lossless) in OURS.items():
        for threshold in DEFAULT:
            row, _ = content.code(*lossy, "--threshold", threshold, and_by_defaults=True)
            rows.append(row | {"profile": profile, "levels": 4, "threshold": threshold, "best": row["ratio"]})
            print(content.name, rows[-1], flush=True)
        row, _ = content.code(*lossless, and_by_defaults=True)
        name = profile.replace("default", "lossless")
        rows.append(row | {"profile": name + ("-lossless" if name == "group" else ""), "levels": 4, "threshold": None,
                           "best": row["ratio"]})
    if with_peers:
        peers, lossless = peers_of(content)
        for name, coders in peers.items():
            for setting, coder in coders:
                row = content.peer(coder)
                rows.append(row | {"profile": name, "levels": 0, "threshold": setting, "best": row["ratio"]})
                print(content.name, rows[-1], flush=True)
        for name, coder in lossless.items():
            row = content.peer(coder)
            rows.append(row | {"profile": f"{name}, lossless", "levels": 0, "threshold": None, "best": row["ratio"]})
            print(content.name, rows[-1], flush=True)
    return rows


def draw_artefacts(content, path):
    """Draws a frame from the originals, by the thesis's scheme with two settings, by the default, and in
    groups of the same quality."""
    frames = [content.frames["none"][1]]
    for levels, threshold in ((1, 8), (2, 4)):
        row, coded = content.code("--profile", "thesis", "--levels", levels, "--threshold", threshold, "--quantizer",
                                  "8bit")
        frames.append(coded[1])
        print(f"thesis, {levels} levels, threshold {threshold}: {row['bytes']} bytes, {row['frame_psnr']:.1f} dB")
    row, coded = content.code("--threshold", 8)
    frames.append(coded[1])
    print(f"default, threshold 8: {row['bytes']} bytes, {row['frame_psnr']:.1f} dB")
    groups = [(threshold, *content.code("--profile", "group", "--threshold", threshold))
              for threshold in (8, 9, 10, 11, 12, 14, 16)]
    threshold, of_group, coded = min(groups, key=lambda group: abs(group[1]["frame_psnr"] - row["frame_psnr"]))
    frames.append(coded[1])
    print(f"group, threshold {threshold}: {of_group['bytes']} bytes, {of_group['frame_psnr']:.1f} dB")
    draw(frames, path)


def draw(frames, path):
    """Draws a part of the frames at double size, above the difference from the first, amplified 16 times."""
    height, width = frames[0].shape[:2]
    parts = [f[height // 2 - 60:height // 2 + 100, width // 2 - 80:width // 2 + 80].astype(float) / 257 for f in frames]
    rows = [np.hstack(parts), np.hstack([128 + 16 * (part - parts[0]) for part in parts])]
    picture = np.clip(np.round(np.vstack(rows)), 0, 255).astype(np.uint8)
    cv2.imwrite(str(path), cv2.resize(picture, None, fx=2, fy=2, interpolation=cv2.INTER_NEAREST),
                [cv2.IMWRITE_JPEG_QUALITY, 90])


def table_of(name, rows):
    lines = [f"**{name}**", "", "| profile | levels | threshold | ratio (thesis) | size, MB | "
                                "CPU s | PSNR of images | of frames | "
             "of frames by the defaults |", "|" + " --- |" * 9]
    for row in rows:
        is_thesis = row["profile"] == "thesis"
        if is_thesis and ((row["levels"], row["threshold"]) not in TABLE_5_3 or row["quantizer"] != "8bit"):
            continue
        ratio = f"{row['ratio']:.1f}"
        if row["profile"] == "thesis":
            ratio += f", best {row['best']:.1f} ({TABLE_5_3[row['levels'], row['threshold']]})"
        lines.append(f"| {row['profile']} | {row['levels'] or '-'} | {row['threshold'] or '-'} | {ratio} | "
                     f"{row['bytes'] / 1e6:.2f} | {row['cpu_s']:.1f} | "
                     f"{number(row['psnr'])} | {number(row['frame_psnr'])} | "
                     f"{number(row['default_psnr']) if row.get('default_psnr') else ''} |")
    thesis = [r for r in rows if r["profile"] == "thesis"]
    ours = {p: [r for r in rows if r["profile"] == p] for p in OURS}
    lines += ["", "| at equal PSNR | dB | thesis, best coder | default | default, contexts | group | default / thesis |"
                  " group / thesis |" + "".join(f" {p} |" for p in ("JPEG", "JPEG 2000", "JPEG XL")),
              "|" + " --- |" * 11]
    for key, what, targets in (("psnr", "of images", (40, 42.5, 45, 48)),
                               ("frame_psnr", "of frames", (45, 48, 50, 52))):
        for target in targets:
            a = best_at(thesis, key, target)
            by_profile = {p: at(ours[p], key, target) for p in OURS}
            others = [at([r for r in rows if r["profile"] == p], key, target) for p in ("JPEG", "JPEG 2000", "JPEG XL")]
            lines.append(f"| {what} | {target} | {number(a, 2)} |" +
                         "".join(f" {number(b, 2)} |" for b in by_profile.values()) +
                         "".join(f" {number(b / a if a and b else None, 2)} |"
                                 for b in (by_profile["default"], by_profile["group"])) +
                         "".join(f" {number(o, 2)} |" for o in others))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared"))
    parser.add_argument("--only", default="shop,synth,noisy")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--views", type=int, default=7, help="along an edge of the grid; an odd number")
    parser.add_argument("--size", default="480x320", help="of LF images of lfsynth")
    parser.add_argument("--frames", default="1-50x12")
    parser.add_argument("--pictures", type=pathlib.Path, help="folder of the picture of artefacts, which alone is made")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.build and arguments.pictures:
        with tempfile.TemporaryDirectory() as temporary:
            draw_artefacts(Content(arguments, "still", pathlib.Path(temporary)),
                           arguments.pictures / "codec_artefacts.jpg")
        return
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        record = results.context() | {"views": arguments.views, "size": arguments.size, "rows": {}}
        with tempfile.TemporaryDirectory() as temporary:
            for name in arguments.only.split(","):
                content = Content(arguments, name, pathlib.Path(temporary) / name)
                record["rows"][name] = measure(content, not arguments.no_peers)
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = results.sentence(record) + "\n\n" + "\n".join(
        table_of(name, rows) for name, rows in record["rows"].items())
    results.publish(arguments, "codec_table.py", record, text)


if __name__ == "__main__":
    main()
