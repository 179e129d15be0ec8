# SPDX-License-Identifier: Apache-2.0
"""Runs lfvisualizer and asks it for live pictures, as its page does (doc/formats/page_data.md, POST live)."""
import http.client
import json
import os
import signal
import struct
import subprocess
import time
import urllib.parse

import numpy as np

from measured import read_bytes_of


class LiveServer:
    """A running lfvisualizer. Use it as `with LiveServer(...) as server`."""

    def __init__(self, *command):
        """command  lfvisualizer, light field, path and options"""
        self.started = time.monotonic()
        self.process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        address = urllib.parse.urlparse(self.process.stdout.readline().strip())
        if not address.port:
            raise RuntimeError(f"{command[0]} serves no page: exit code {self.process.wait()}")
        self.folder = address.path
        self.connection = http.client.HTTPConnection(address.hostname, address.port)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait()
        self.process.stdout.close()

    def ask(self, path, width, budget_ms=None):
        """Returns the facts of a live picture and the picture, [height][width][3] in linear light.

        path       text of a camera path, whose first frame is rendered
        width      width of the picture, in elements
        budget_ms  time for the picture; None: a still picture, of all LF images in memory
        """
        wish = {"text": path, "frame": 1, "width": width}
        if budget_ms is not None:
            wish["budget_ms"] = budget_ms
        self.connection.request("POST", self.folder + "live", json.dumps(wish))
        answer = self.connection.getresponse().read()
        if answer.startswith(b"{"):
            raise RuntimeError(answer.decode())
        (length,) = struct.unpack("<I", answer[:4])
        facts, picture = json.loads(answer[4:4 + length]), answer[4 + length:]
        columns, rows = struct.unpack("<2I", picture[:8])
        return facts, np.frombuffer(picture, "<f2", offset=32).reshape(rows, columns, 4)[..., :3].astype(np.float64)

    def load_all(self, path, width):
        """Waits until all LF images that the frame needs are in memory, as far as there is room. Returns the facts."""
        while True:
            facts, _ = self.ask(path, width, 1)
            if facts["wanted"] and facts["done"] == facts["wanted"]:
                return facts
            time.sleep(0.05)

    def seconds(self):
        """Returns the time since the program was started."""
        return time.monotonic() - self.started

    def cpu_s(self):
        """Returns the CPU time that the program has used so far."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as facts:
            user, system = facts.read().rpartition(")")[2].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def read_bytes(self):
        """Returns the bytes that the program has read by system calls so far."""
        return read_bytes_of(self.process.pid)

    def peak_mib(self):
        """Returns the largest memory that the program has had so far."""
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            return next(int(line.split()[1]) for line in status if line.startswith("VmHWM:")) / 1024
