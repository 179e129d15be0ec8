#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what programs read of a store by resolution on a web server, as a share of all its bytes.

usage: bench/remote_reads.py BUILD_DIR [--count 100] [--size 640x480] [--latency-ms 20] [--name NAME] [--write PAGE]
       bench/remote_reads.py --again JSON [--write PAGE]

The store holds `still-life` in the default profile; the lens is eight distances of LF cameras wide. Rows with
--reduce name mode, estimator and lens weights, the others render by the defaults. Each call begins without a local
copy, but for the last one. The server is on this machine, and waits for the latency before each answer. Times are
those of one call, `local` those of the same call with the store as a local file.
"""
import argparse
import json
import pathlib
import re
import sys
import tempfile
import time

import record as results

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/helpers"))
from range_server import RangeServer

CHOICES = ("--mode", "collect", "--estimator", "bilinear", "--lens-weights", "area")
LENS = 8  # diameter of the lens, in distances of LF cameras
CALLS = {"the report of `lfimport`, without checks": ("lfimport", "{field}", "--check", "none"),
         "`lfrenderer --frames 1 --reduce 8 --max-images 16`":
             ("lfrenderer", "{field}", "{path}", "-o", "{out}", "--frames", 1, "--reduce", 8, "--max-images", 16,
              *CHOICES),
         **{f"`lfrenderer --frames 1 --reduce {n}`": ("lfrenderer", "{field}", "{path}", "-o", "{out}", "--frames", 1,
                                                      "--reduce", n, *CHOICES) for n in (8, 4, 2)},
         "`lfrenderer --frames 1`": ("lfrenderer", "{field}", "{path}", "-o", "{out}", "--frames", 1),
         "`lfrenderer --frames 1-5`": ("lfrenderer", "{field}", "{path}", "-o", "{out}", "--frames", "1-5"),
         "`lfrenderer --frames 1-5`, from the local copy":
             ("lfrenderer", "{field}", "{path}", "-o", "{out}", "--frames", "1-5")}


def timed_call(arguments, call, field, folder, cache):
    words = [str(word).format(field=field, path=folder / "path.yaml", out=folder / "out") for word in call]
    begin = time.monotonic()
    more = ["--overwrite"] if words[0] == "lfrenderer" else []
    results.call([arguments.build.resolve() / "bin" / words[0], *words[1:], *more, "--store-cache", cache, "-q"])
    return time.monotonic() - begin


def rows_of(arguments, folder):
    programs = arguments.build.resolve() / "bin"
    served = folder / "served"
    served.mkdir()
    results.call([programs / "lfsynth", "still-life", "-o", folder / "field", "--count", arguments.count, "--size",
                  arguments.size, "--format", "png", "-q"])
    results.call([programs / "lfexample", folder / "field", "-o", folder / "path.yaml", "-q"])
    path = (folder / "path.yaml").read_text()
    spacing = float(re.search(r"LF cameras are (\S+) apart", path).group(1))
    (folder / "path.yaml").write_text(re.sub(r"aperture_diameter: \S+", f"aperture_diameter: {LENS * spacing}", path))
    results.call([programs / "lfcompressor", folder / "field", "-o", served / "field.lfs", "--by-resolution", "-q"])
    whole = sum(file.stat().st_size for file in served.iterdir())
    server = RangeServer(served, lambda *_: time.sleep(arguments.latency_ms / 1000))
    rows = []
    for number, (name, call) in enumerate(CALLS.items()):
        cache = folder / (f"cache{number - 1}" if "copy" in name else f"cache{number}")
        before, requests = server.sent_bytes(), len(server.requests)
        seconds = timed_call(arguments, call, server.url("field.lfs"), folder, cache)
        rows.append({"call": name, "share": (server.sent_bytes() - before) / whole,
                     "requests": len(server.requests) - requests, "seconds": seconds,
                     "local_seconds": timed_call(arguments, call, served / "field.lfs", folder, cache)})
    return rows, whole


def table(record):
    lines = [f"{record['count']} LF images of {record['size']}, {record['whole_bytes'] / 2**20:.1f} MiB; latency "
             f"{record['latency_ms']} ms.", "", "| call | bytes read | requests | time | local |",
             "| --- | --- | --- | --- | --- |"]
    for row in record["rows"]:
        lines.append(f"| {row['call']} | {row['share']:.1%} | {row['requests']} | {row['seconds']:.1f} s | "
                     f"{row['local_seconds']:.1f} s |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--latency-ms", type=int, default=20)
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        record = json.loads(arguments.again.read_text())
    elif arguments.build:
        record = results.context() | {"count": arguments.count, "size": arguments.size,
                                      "latency_ms": arguments.latency_ms}
        with tempfile.TemporaryDirectory() as temporary:
            record["rows"], record["whole_bytes"] = rows_of(arguments, pathlib.Path(temporary))
    else:
        parser.error("BUILD_DIR or --again is needed")
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "remote_reads.py", record, text)


if __name__ == "__main__":
    main()
