#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that long films do not slow the page down: for a path of a million frames, its requests take hardly more
processor time and memory than for one of ten.

usage: long_film_test.py LFVISUALIZER
"""
import http.client
import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import threading
import time
import unittest
import urllib.parse

import small_field
from program_test_case import ProgramTestCase, wait_until

VISUALIZER = None
FRAMES = 1_000_000
MOST_MORE_CPU_S = 0.05  # of a live request
MOST_MORE_MIB = 50
THREADS = 2
TICKS = os.sysconf("SC_CLK_TCK")


class Server:
    def __init__(self, field, path):
        self.path = path
        self.process = subprocess.Popen([VISUALIZER, field, path, "--threads", str(THREADS)], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.address = urllib.parse.urlsplit(self.process.stdout.readline().strip())

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return 0 if fields[0] == "Z" else (int(fields[11]) + int(fields[12])) / TICKS

    def most_mib(self):
        """Returns the largest memory of the server so far."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s*(\d+) kB", status)[1]) / 1024

    def ask(self, name, body=None):
        connection = http.client.HTTPConnection(self.address.hostname, self.address.port, timeout=200)
        connection.request("GET" if body is None else "POST", self.address.path + name,
                           None if body is None else json.dumps(body))
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, content

    def live(self, number):
        """Asks for a live picture by a text that was never sent before, as while something is dragged."""
        text = self.path.read_text() + f"# {number}\n"
        status, content = self.ask("live", {"text": text, "frame": 1 + number % 10, "width": 64, "budget_ms": 5})
        assert status == 200 and not content.startswith(b"{"), content[:300]

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.stdout.close()
        self.process.wait()


class LongFilmTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = small_field.write_field(self.folder / "field")
        short = small_field.write_path(self.folder)
        text = re.sub(r"(?m)^frames:.*$", "frames: 10", short.read_text())
        short.write_text(text)
        self.long = self.folder / "long.yaml"
        self.long.write_text(text.replace("frames: 10", f"frames: {FRAMES}"))
        self.servers = [self.open(path) for path in (short, self.long)]

    def open(self, path):
        server = Server(self.field, path)
        self.addCleanup(server.end)
        return server

    def head(self, server):
        return json.loads(server.ask("scene.json")[1])["path"]

    def test_a_live_picture_costs_no_frames_but_its_own(self):
        cpu_s, more_mib = [], []
        for server in self.servers:
            for number in range(10):
                server.live(number)
            before_s, before_mib = server.cpu_s(), server.most_mib()
            for number in range(10, 30):
                server.live(number)
            cpu_s.append((server.cpu_s() - before_s) / 20)
            threads = [threading.Thread(target=server.live, args=(number,)) for number in range(30, 38)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            more_mib.append(server.most_mib() - before_mib)
        print("CPU seconds of a live request, and MiB more:", cpu_s, more_mib)
        self.assertLess(cpu_s[1], cpu_s[0] + MOST_MORE_CPU_S)
        self.assertLess(more_mib[1], more_mib[0] + MOST_MORE_MIB)

    def test_answers_do_not_grow_with_the_film(self):
        server = self.servers[1]
        head = self.head(server)
        self.assertEqual(head["frames"], FRAMES)
        before_mib = server.most_mib()
        for name, most_bytes in (("frames.bin", 3e6), ("film.json", 3e5), ("film.bin", 1e3), ("path.json", 1e3),
                                 ("frames/7.bin", 1e5), (f"use/{FRAMES}.bin", 1e4), ("density/777777.json", 1e3)):
            status, content = server.ask(f"path/{head['id']}/{name}")
            self.assertEqual(status, 200, name)
            self.assertLess(len(content), most_bytes, name)
        status, content = server.ask("check", {"text": self.long.read_text() + "# another\n"})
        self.assertEqual(json.loads(content)["frames"], FRAMES)
        self.assertLess(server.most_mib() - before_mib, MOST_MORE_MIB)

    def test_the_shown_frames_are_those_of_the_path(self):
        server = self.servers[1]
        head = self.head(server)
        size = 35 * 8
        shown = server.ask(f"path/{head['id']}/frames.bin")[1]
        for block in (0, 39, 3906):
            frames = server.ask(f"path/{head['id']}/frames/{block}.bin")[1]
            self.assertEqual(len(frames), size * min(256, FRAMES - 256 * block))
            for i in range(len(frames) // size):
                frame = frames[size * i:size * (i + 1)]
                number = 256 * block + i
                self.assertAlmostEqual(struct.unpack("<d", frame[23 * 8:24 * 8])[0], number / head["fps"], 6)
                index, rest = divmod(number, head["shown_step"])
                if rest == 0:
                    self.assertEqual(shown[size * index:size * (index + 1)], frame)
        self.assertEqual(shown[-size:], frames[-size:])
        self.assertEqual(server.ask(f"path/{head['id']}/frames/3907.bin")[0], 404)

    def test_a_fault_of_a_late_frame_is_told(self):
        server = self.servers[1]
        text = re.sub(r"(?m)^fps:.*$", "fps: 1", self.long.read_text())
        text += "\naccelerations:\n  - {quantity: aperture_diameter, from: 900000, to: 1000000, value: -1}\n"
        answer = json.loads(server.ask("check", {"text": text})[1])
        self.assertIn("at frame 900", answer.get("error", ""))
        self.assertNotEqual(server.ask("live", {"text": text, "frame": 5, "width": 64})[1][:1], b"{")
        answer = json.loads(server.ask("live", {"text": text, "frame": 950_000, "width": 64})[1])
        self.assertIn("at frame 950000", answer["error"])

    def test_it_ends_soon_while_requests_are_answered(self):
        server = self.servers[1]

        def ask(number):
            try:
                server.ask("check", {"text": self.long.read_text() + f"# {number}\n"})
            except (OSError, http.client.HTTPException):
                pass  # the server has ended
        threads = [threading.Thread(target=ask, args=(number,)) for number in range(24)]
        for thread in threads:
            thread.start()
        begin_s = server.cpu_s()
        wait_until(lambda: server.cpu_s() > begin_s + 0.5, server.process)
        before_s = last_s = server.cpu_s()
        server.process.send_signal(signal.SIGINT)
        while server.process.poll() is None:
            last_s = max(last_s, server.cpu_s())
            time.sleep(0.005)
        for thread in threads:
            thread.join()
        self.assertLess(last_s - before_s, 2 * THREADS)
        self.assertEqual(server.process.returncode, 0)


if __name__ == "__main__":
    VISUALIZER = sys.argv.pop(1)
    unittest.main()
