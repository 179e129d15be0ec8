#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfvisualizer --text: its output about cameras agrees with the light field, the path and a render.

usage: lfvisualizer_test.py LFVISUALIZER LFRENDERER [pageless]
"""
import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import unittest
import urllib.parse

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is imported
import cv2
import numpy

import small_field
from program_test_case import ProgramTestCase

VISUALIZER = RENDERER = PAGELESS = None


class VisualizerTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        small_field.SIDE = 5
        self.field = small_field.write_field(self.folder / "field")
        self.path = small_field.write_path(self.folder)

    def lines(self, *options):
        """Returns the numbers in each line of the output, by the first word of the line."""
        words = {"lf_camera": [], "render_camera": [], "collected": []}
        for line in self.succeeds(VISUALIZER, self.field, self.path, "--text",
                                  *options).splitlines():
            first, *rest = line.split()
            words[first].append([float(word) for word in rest])
        return words

    def test_cameras_are_where_the_light_field_and_the_path_say(self):
        words = self.lines()
        frames = json.loads(self.field.read_text())["frames"]
        self.assertEqual(len(words["lf_camera"]), len(frames))
        for (index, *place), frame in zip(words["lf_camera"], frames):
            expected = [row[3] for row in frame["transform_matrix"][:3]]
            for got, wanted in zip(place, expected):
                self.assertAlmostEqual(got, wanted, 12, index)
        self.assertEqual([line[0] for line in words["render_camera"]], [1, 2, 3])

    def test_frames_beyond_the_end_can_be_left_out(self):
        words = self.lines("--frames", "3-7", "--clamp-frames")
        self.assertEqual([line[0] for line in words["render_camera"]], [3])
        words = self.lines("--frames", "4-7", "--clamp-frames")
        self.assertEqual({word: len(lines) for word, lines in words.items()},
                         {"lf_camera": small_field.SIDE**2, "render_camera": 0, "collected": 0})

    # The number of collected LF images equals the number that lfrenderer reports, with weights and without.
    def test_what_is_collected_is_what_a_render_collects(self):
        for weights in ("auto", "none"):
            words = self.lines("--lens-weights", weights, "--frames", "1,3")
            out = self.folder / weights
            self.succeeds(RENDERER, self.field, self.path, "-o", out, "--lens-weights", weights)
            for frame in json.loads((out / "report.json").read_text())["frames"]:
                collected = [line for line in words["collected"] if line[0] == frame["frame"]]
                self.assertEqual(len(collected), 0 if frame["frame"] == 2 else frame["lf_images"])
                self.assertTrue(all(0 < share <= 1 for _, _, share in collected))
        few = self.lines("--max-images", 3)["collected"]
        self.assertLessEqual(len([line for line in few if line[0] == 1]), 3)

    # A build without the page reports this before it opens a port.
    def test_a_port_that_is_taken_is_told(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            self.fails(4, ["page" if PAGELESS else f"--serve {port}"], VISUALIZER, self.field,
                       self.path, "--serve", port)

    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_a_port_has_one_server(self):
        with subprocess.Popen([VISUALIZER, self.field, self.path, "-q"], stdout=subprocess.PIPE,
                              text=True) as server:
            port = server.stdout.readline().split(":")[2].split("/")[0]
            self.fails(4, [f"--serve {port}"], VISUALIZER, self.field, self.path, "--serve", port)
            server.send_signal(signal.SIGINT)
            self.assertEqual(server.wait(), 0)

    # Another page in the same browser can send requests to the server, but does not know the token. After DNS
    # rebinding, its requests also have another Host header. The server must refuse either.
    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_only_its_own_page_can_write_files(self):
        before = self.path.read_text()
        edit = json.dumps({"text": before + "# changed\n", "force": True})
        server = subprocess.Popen([VISUALIZER, self.field, self.path, "-q"], stdout=subprocess.PIPE,
                                  text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.kill)
        address = urllib.parse.urlsplit(server.stdout.readline().strip())

        def status(method, target, host):
            connection = http.client.HTTPConnection("127.0.0.1", address.port, timeout=60)
            self.addCleanup(connection.close)
            connection.request(method, target, edit if method == "POST" else None,
                               {"Host": f"{host}:{address.port}"})
            return connection.getresponse().status

        other = "0" if address.path[-2] != "0" else "1"  # a wrong last digit of the token
        for method, name in (("POST", "save"), ("GET", "scene.json")):
            for folder, host in (("/", "127.0.0.1"), (f"/{'0' * 32}/", "localhost"),
                                 (address.path[:-2] + other + "/", "127.0.0.1"),
                                 (address.path + "../", "127.0.0.1"), (address.path, "evil.example"),
                                 (address.path, "127.0.0.2")):
                self.assertEqual(status(method, folder + name, host), 403, (method, folder, host))
        self.assertEqual(self.path.read_text(), before)
        self.assertEqual(status("GET", address.path + "scene.json", "localhost"), 200)
        self.assertEqual(status("POST", address.path + "save", "localhost"), 200)
        self.assertEqual(self.path.read_text(), before + "# changed\n")
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(), 0)

    # All LF images are in memory, in full size: the plate is as fine as they are.
    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_a_live_picture_is_the_frame_of_a_render(self):
        server = subprocess.Popen([VISUALIZER, self.field, self.path, "-q"], stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.kill)
        address = urllib.parse.urlsplit(server.stdout.readline().strip())
        connection = http.client.HTTPConnection("127.0.0.1", address.port, timeout=60)
        self.addCleanup(connection.close)

        def ask(**wish):
            connection.request("POST", address.path + "live", json.dumps(wish))
            answer = connection.getresponse()
            body = answer.read()
            self.assertEqual(answer.status, 200, body)
            if answer.getheader("Content-Type") == "application/json":
                return json.loads(body), None
            length = int.from_bytes(body[:4], "little")
            picture = body[4 + length:]
            width, height = numpy.frombuffer(picture, "<u4", 2)
            return json.loads(body[4:4 + length]), numpy.frombuffer(picture, "<f2", offset=32).reshape(
                height, width, 4)

        self.succeeds(RENDERER, self.field, self.path, "-o", self.folder / "frames", "--format", "exr",
                      "--filter", "bilinear", "--estimator", "bilinear", "--frames", 1)
        frame = cv2.imread(str(self.folder / "frames" / "frame_0001.exr"), cv2.IMREAD_UNCHANGED)[..., 2::-1]
        wish = {"text": self.path.read_text(), "frame": 1, "width": frame.shape[1]}
        while True:
            facts, picture = ask(**wish)
            if facts["wanted"] and facts["done"] == facts["wanted"] == facts["images"]:
                break
        self.assertEqual((facts["divisor"], facts["broken"]), (1, 0))
        self.assertEqual(picture.shape[:2], frame.shape[:2])
        self.assertGreater(frame.max(), 0.1)
        # lfrenderer stores radiance in 16 bits with another scale, so that last bits differ.
        numpy.testing.assert_allclose(picture[..., :3], frame, rtol=0.001, atol=1e-5)

        facts, picture = ask(**wish | {"width": 10 ** 9})
        self.assertEqual(max(picture.shape), 1280)
        facts, _ = ask(**wish | {"text": wish["text"] + "wrong: 1\n"})
        self.assertIn("wrong", facts["error"])
        connection.request("POST", address.path + "live", json.dumps(wish | {"frame": 10 ** 6}))
        self.assertEqual(connection.getresponse().status, 422)
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(), 0)

    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_an_export_counts_the_lf_images_that_it_lacks(self):
        next(iter(sorted(self.field.parent.glob("*12.png")))).write_text("no picture")
        self.fails(6, ["1 of ", "LF images are not in the export", "the first: " + str(self.field.parent), "12.png",
                       "--allow-missing 1"], VISUALIZER, self.field, self.path, "--export", self.folder / "site")
        self.assertTrue((self.folder / "site" / "index.html").exists())
        self.succeeds(VISUALIZER, self.field, self.path, "--export", self.folder / "again",
                      "--allow-missing", 1)
        self.fails(2, ["--allow-missing", "--export"], VISUALIZER, self.field, self.path, "--text",
                   "--allow-missing", 1)

    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_a_path_of_another_program_becomes_yaml(self):
        path = self.folder / "camera_path.json"
        path.write_text(json.dumps({
            "render_width": 80, "render_height": 60, "fps": 25, "lf_space": "world", "camera_path": [
                {"camera_to_world": [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "fov": 40,
                 "lf_aperture_diameter": 0.04, "lf_focus_distance": 0.8} for x in (0, 0.01)]}))
        self.succeeds(VISUALIZER, self.field, path, "--export", self.folder / "site")
        pages = [file.read_text(errors="replace") for file in (self.folder / "site").rglob("*") if file.is_file()]
        self.assertTrue(any("format: lfpath 1" in page for page in pages))
        self.assertFalse((self.folder / "camera_path.json.yaml").exists())
        (self.folder / "camera_path.json.yaml").write_text("")
        self.fails(2, ["camera_path.json.yaml: exists"], VISUALIZER, self.field, path, "--export", self.folder / "b")

    def test_what_is_missing_or_wrong_is_told(self):
        self.fails(2, ["--text", "packages"], VISUALIZER, self.field, self.path, "no.lfp", "--text")
        self.fails(2, ["--export", "--watch"], VISUALIZER, self.field, self.path, "--export", "x",
                   "--watch", "y")
        self.fails(2, ["--frames", "--text"], VISUALIZER, self.field, self.path, "--frames", 1)
        self.fails(2, ["--serve", "--text"], VISUALIZER, self.field, self.path, "--text", "--serve",
                   0)
        other = self.folder / "other.json"
        other.write_text("{}")
        self.fails(3, ["no camera path"], VISUALIZER, self.field, other)
        self.fails(2, ["--frames '7'"], VISUALIZER, self.field, self.path, "--text", "--frames", 7)
        self.fails(2, ["--clamp-frames", "--text"], VISUALIZER, self.field, self.path, "--clamp-frames")
        self.fails(3, ["nowhere"], VISUALIZER, self.folder / "nowhere", self.path, "--text")


if __name__ == "__main__":
    VISUALIZER, RENDERER = sys.argv[1:3]
    PAGELESS = "pageless" in sys.argv
    unittest.main(argv=sys.argv[:1], verbosity=2)
