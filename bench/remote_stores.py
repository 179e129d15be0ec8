#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what programs do with web servers that fail, or that are hostile.

usage: bench/remote_stores.py BUILD_DIR [--name NAME] [--write PAGE]
       bench/remote_stores.py --again JSON [--write PAGE]

`lfimport` opens the URL of a packed store of 10 MiB on a server of its own on this machine, by the defaults of all
programs, once for each kind of server. All calls run at the same time, because most of them wait. Measured are the
exit code, the time, the peak of memory, and the bytes of bodies that the server has sent before the connection ended.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import threading
import time

import record as results
from measured import watch

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/helpers"))
from range_server import RangeServer, make_certificate

PIECE = bytes(1 << 20)


def head(handler, begin, end, size, **headers):
    handler.send_response(206)
    handler.send_header("Content-Range", f"bytes {begin}-{end - 1}/{size}")
    for name, value in ({"Content-Length": end - begin} | headers).items():
        handler.send_header(name.replace("_", "-"), str(value))
    handler.end_headers()
    handler.wfile.flush()


class Faults:
    """Bad answers of servers. `sent` counts the bytes of endless bodies."""

    def __init__(self):
        self.sent = 0

    def pour(self, handler, piece=PIECE):
        try:
            while True:
                handler.wfile.write(piece)
                handler.wfile.flush()
                self.sent += len(piece)
        except OSError:
            handler.close_connection = True
            return True

    def good(self, *_):
        return False

    def breaks_off(self, handler, _, begin, end):
        head(handler, begin, end, 10 << 20)
        handler.wfile.write(PIECE[:(end - begin) // 2])
        handler.close_connection = True
        return True

    def never_answers(self, *_):
        time.sleep(1000)
        return True

    def stalls(self, handler, _, begin, end):
        head(handler, begin, end, 10 << 20)
        time.sleep(1000)
        return True

    def no_ranges(self, handler, *_):
        handler.send_response(200)
        handler.send_header("Content-Length", str(1 << 40))
        handler.end_headers()
        return self.pour(handler)

    def endless_body(self, handler, _, begin, end):
        handler.send_response(206)
        handler.send_header("Content-Range", f"bytes {begin}-{end - 1}/{10 << 20}")
        handler.end_headers()
        return self.pour(handler)

    def endless_headers(self, handler, *_):
        handler.send_response(206)
        handler.flush_headers()
        return self.pour(handler, b"X: " + b"x" * 1000 + b"\r\n")

    def another_range(self, handler, _, begin, end):
        head(handler, begin + 1, end + 1, 10 << 20)
        return self.pour(handler)

    def compressed(self, handler, _, begin, end):
        head(handler, begin, end, 10 << 20, Content_Encoding="gzip")
        return self.pour(handler)

    def huge_file(self, handler, _, begin, end):
        head(handler, begin, end, 1 << 50)
        handler.wfile.write(PIECE[:end - begin])
        return True

    def redirects(self, handler, *_):
        handler.status(302, Location="/field.lfs")
        return True

    def redirects_to_a_file(self, handler, *_):
        handler.status(302, Location="file:///etc/hostname")
        return True

    def missing(self, handler, *_):
        handler.status(404)
        return True

    def refuses(self, handler, *_):
        handler.status(403)
        return True

    def fails(self, handler, *_):
        handler.status(500)
        return True

    def is_busy(self, handler, *_):
        handler.status(429, Retry_After="3600")
        return True


KINDS = {"good": "sends what it is asked for", "breaks_off": "ends each transfer in the middle",
         "never_answers": "takes the connection and never answers", "stalls": "sends headers and no body",
         "no_ranges": "sends 1 TiB in place of each range (status 200)",
         "endless_body": "sends a body without an end", "endless_headers": "sends headers without an end",
         "another_range": "sends another range than that asked for", "compressed": "compresses what it sends",
         "huge_file": "says that the file has 1 PiB", "redirects": "redirects to itself",
         "redirects_to_a_file": "redirects to a local file", "missing": "status 404", "refuses": "status 403",
         "fails": "status 500", "is_busy": "status 429, `Retry-After: 3600`",
         "self_signed": "has a certificate of its own"}


def row_of(kind, arguments, folder):
    faults = Faults()
    served = folder / kind
    served.mkdir()
    (served / "field.lfs").symlink_to(folder / "field.lfs")
    certificate = make_certificate(served) if kind == "self_signed" else None
    server = RangeServer(served, getattr(faults, kind, faults.good), certificate)
    begin = time.monotonic()
    process = subprocess.Popen([arguments.build.resolve() / "bin/lfimport", server.url("field.lfs"), "-q"],
                               env=os.environ | {"XDG_CACHE_HOME": str(folder / f"cache-{kind}")},
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    errors = []
    reader = threading.Thread(target=lambda: errors.append(process.stderr.read()))
    reader.start()
    watch(process.pid, 0.02, "-")
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    reader.join()
    return {"kind": kind, "exit": process.returncode, "seconds": time.monotonic() - begin,
            "peak_bytes": usage.ru_maxrss * 1024, "sent_bytes": faults.sent + server.sent_bytes(),
            "message": errors[0].strip().splitlines()[-1:]}


def rows_of(arguments, folder):
    results.call([arguments.build.resolve() / "bin/lfsynth", "chart", "-o", folder / "chart", "--count", 25, "-q"])
    results.call([arguments.build.resolve() / "bin/lfcompressor", folder / "chart", "-o", folder / "field.lfs", "-q"])
    rows = {}
    threads = [threading.Thread(target=lambda kind=kind: rows.update({kind: row_of(kind, arguments, folder)}))
               for kind in KINDS]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [rows[kind] for kind in KINDS]


def table(record):
    lines = ["| server | exit code | time | memory | bytes sent |", "| --- | --- | --- | --- | --- |"]
    for row in record["rows"]:
        lines.append(f"| {KINDS[row['kind']]} | {row['exit']} | {row['seconds']:.1f} s | "
                     f"{row['peak_bytes'] / 2**20:.0f} MiB | {row['sent_bytes'] / 2**20:.1f} MiB |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    results.add_options(parser)
    arguments = parser.parse_args()
    record = results.record_of(parser, arguments, arguments.build, lambda folder: {"rows": rows_of(arguments, folder)})
    text = "\n".join([results.sentence(record), ""] + table(record)) + "\n"
    results.publish(arguments, "remote_stores.py", record, text)


if __name__ == "__main__":
    main()
