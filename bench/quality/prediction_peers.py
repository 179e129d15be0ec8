# SPDX-License-Identifier: Apache-2.0
"""Video encoders over the LF images of a group, for prediction_gain.py: x265 and libaom with 10 bits and whole colours,
16 pictures of which the first is a key picture, in rows from left to right and from right to left in turn."""
import pathlib
import shutil
import tempfile

import numpy as np

from prediction_captures import GRID
from quality import results

QUANTISERS = {"x265": (12, 18, 24, 30), "libaom": (8, 18, 30, 42)}
PROGRAMS = {"x265": ("x265", "ffmpeg"), "libaom": ("aomenc", "dav1d")}
_REC_709 = np.array([[0.2126, 0.7152, 0.0722], [-0.114572, -0.385428, 0.5], [0.5, -0.454153, -0.045847]])


def exists(peer):
    return all(shutil.which(program) for program in PROGRAMS[peer])


def _planes_of(picture):
    values = picture / 255 @ _REC_709.T + (0, 0.5, 0.5)
    return np.clip(np.rint(values * 1023), 0, 1023).astype("<u2").transpose(2, 0, 1)


def _picture_of(planes):
    values = planes.transpose(1, 2, 0) / 1023 - (0, 0.5, 0.5)
    return np.clip(np.rint(values @ np.linalg.inv(_REC_709).T * 255), 0, 255).astype(np.uint8)


def code(peer, pictures, quantiser):
    """Returns the bytes and the decoded pictures."""
    order = [row * GRID + (column if row % 2 == 0 else GRID - 1 - column)
             for row in range(GRID) for column in range(GRID)]
    height, width = pictures[0].shape[:2]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        source, coded, back = folder / "in.y4m", folder / "coded", folder / "out.yuv"
        with open(source, "wb") as out:
            out.write(f"YUV4MPEG2 W{width} H{height} F25:1 Ip C444p10 XYSCSS=444P10\n".encode())
            for number in order:
                out.write(b"FRAME\n" + _planes_of(pictures[number]).tobytes())
        count = len(pictures)
        if peer == "x265":
            coded = coded.with_suffix(".hevc")
            results.call(["x265", "--log-level", "error", "--y4m", "--input", source, "--output-depth", 10, "--preset",
                          "medium", "--tune", "psnr", "--qp", quantiser, "--keyint", count, "--min-keyint", count,
                          "--no-open-gop", "--no-scenecut", "--pools", "none", "--frame-threads", 1, "--no-wpp",
                          "--bframes", 8, "--b-adapt", 0, "--ref", 4, "-o", coded])
            results.call(["ffmpeg", "-hide_banner", "-loglevel", "error", "-y", "-threads", 1, "-i", coded, "-f",
                          "rawvideo", "-pix_fmt", "yuv444p10le", back])
        else:
            results.call(["aomenc", "--profile=1", "--bit-depth=10", "--i444", "--end-usage=q",
                          f"--cq-level={quantiser}", "--cpu-used=4", "--threads=1", f"--kf-max-dist={count}",
                          f"--lag-in-frames={count}", "--tune=psnr", "--passes=1", "--good",
                          "--enable-keyframe-filtering=0", "--aq-mode=0", "--ivf", "-q", "-o", coded, source])
            results.call(["dav1d", "-q", "--threads", 1, "--muxer", "yuv", "-i", coded, "-o", back])
        planes = np.fromfile(back, "<u2").reshape(count, 3, height, width)
        decoded = [None] * count
        for number, picture in zip(order, planes):
            decoded[number] = _picture_of(picture)
        return coded.stat().st_size, decoded
