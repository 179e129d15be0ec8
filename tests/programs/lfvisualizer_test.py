#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests lfvisualizer --text: its output about cameras agrees with the light field, the path and a render.

usage: lfvisualizer_test.py LFVISUALIZER LFRENDERER [pageless]
"""
import base64
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
from judgements import scenes
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

    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_a_page_says_that_images_and_poses_do_not_agree(self):
        field = self.folder / "upside down"
        cameras = scenes.grid(5, 0.05)
        shown = [((x, -y, z), rotation) for (x, y, z), rotation in cameras]
        scenes.draw(field, scenes.Capture(cameras, drawn=shown), [scenes.wall(2), scenes.card(0, 0, 1.2, 0.5, 0.4)])
        server = subprocess.Popen([VISUALIZER, field, self.path, "-q"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.stderr.close)
        self.addCleanup(server.kill)
        address = urllib.parse.urlsplit(server.stdout.readline().strip())
        connection = http.client.HTTPConnection("127.0.0.1", address.port, timeout=60)
        self.addCleanup(connection.close)
        connection.request("GET", address.path + "events", headers={"Host": address.netloc})
        news = connection.getresponse()
        for _ in range(60):  # without news, a line comes each second
            if news.readline() == b"event: poses\n":
                break
        else:
            self.fail("the page is not told")
        warning = json.loads(news.readline().partition(b":")[2])["warning"]
        self.assertIn("images and poses do not agree", warning)
        self.assertIn("lfimport", warning)
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(), 0)

    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_a_reverse_proxy_has_an_origin_that_is_told(self):
        for wrong in ("fields.example", "null", "*", "ftp://fields.example", "https://fields.example/lf",
                      "https://a@fields.example", "https://fields.example:0", "", "https://"):
            self.fails(2, [f"--allow-origin {wrong}: expected http:// or https://, a host"], VISUALIZER, self.field,
                       self.path, "--allow-origin", wrong)
        self.fails(2, ["--allow-origin", "--text"], VISUALIZER, self.field, self.path, "--text", "--allow-origin",
                   "https://fields.example")
        server = subprocess.Popen([VISUALIZER, self.field, self.path, "--allow-origin", "https://Fields.example/",
                                   "--allow-origin", "http://10.0.0.7:80"], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.stderr.close)
        self.addCleanup(server.kill)
        address = urllib.parse.urlsplit(server.stdout.readline().strip())

        def ask(host, origin):
            connection = http.client.HTTPConnection("127.0.0.1", address.port, timeout=60)
            self.addCleanup(connection.close)
            connection.request("POST", address.path + "check", json.dumps({"text": self.path.read_text()}),
                               {"Host": host, "Origin": origin})
            answer = connection.getresponse()
            return answer.status, json.loads(answer.read()).get("error", "")

        for host in ("fields.example", "10.0.0.7", address.netloc):
            self.assertEqual(ask(host, "https://fields.example"), (200, ""))
            self.assertEqual(ask(host, "http://10.0.0.7"), (200, ""))
            status, error = ask(host, "http://fields.example")
            self.assertEqual(status, 403)
            self.assertIn("or http://10.0.0.7; if this is your reverse proxy, start lfvisualizer with --allow-origin "
                          "http://fields.example", error)
        status, error = ask("other.example", "https://fields.example")
        self.assertEqual(status, 403)
        self.assertIn('not served to the host "other.example": open it at 127.0.0.1 or localhost, with any port, or '
                      "https://fields.example, or http://10.0.0.7;", error)
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.wait(), 0)
        self.assertIn(f"through the reverse proxy, open https://fields.example{address.path}, or ",
                      server.stderr.read())

    def test_without_a_path_a_command_that_makes_one_is_printed(self):
        self.fails(2, ["PATH is missing", f": lfexample {self.field} -o path"], VISUALIZER, self.field)
        self.fails(3, ["nothing"], VISUALIZER, self.folder / "nothing")

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

    def write_points(self, name, places, unit="1"):
        """Writes a point cloud as lffocus depth does; point i has the colour (i, 2, 3) and the confidence 0.5."""
        record = numpy.dtype([("xyz", "<f4", 3), ("rgb", "u1", 3), ("confidence", "<f4")])
        points = numpy.zeros(len(places), record)
        points["xyz"] = places
        points["rgb"] = numpy.stack([numpy.arange(len(places)) % 256, *numpy.full((2, len(places)), [[2], [3]])], -1)
        points["confidence"] = 0.5
        kinds = [("float", "x y z"), ("uchar", "red green blue"), ("float", "confidence")]
        head = "".join(f"property {kind} {word}\n" for kind, words in kinds for word in words.split())
        file = self.folder / name
        file.write_bytes(f"ply\nformat binary_little_endian 1.0\ncomment world units; {unit} m each\n"
                         f"element vertex {len(places)}\n{head}end_header\n".encode() + points.tobytes())
        return file

    @unittest.skipIf("pageless" in sys.argv, "it has no page")
    def test_an_export_has_the_points_of_depth_files(self):
        places = numpy.random.default_rng(1).uniform(-2, 2, (700001, 3)).astype("<f4")
        small, large = self.write_points("a.ply", places[:100]), self.write_points("b.ply", places)
        run = subprocess.run([VISUALIZER, self.field, self.path, "--depth", small, "--depth", large, "--export",
                              self.folder / "site"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("shows 350001 of its 700001 points: one of each 2, chosen at random", run.stderr)
        self.assertNotIn("a.ply: the page shows", run.stderr)

        def data(name):
            text = (self.folder / "site" / f"{name}.js").read_text()
            return base64.b64decode(text.split('"')[3])
        scene = json.loads(data("scene.json"))
        self.assertEqual([(one["name"], one["points"], one["points_in_file"]) for one in scene["depths"]],
                         [(str(small), 100, 100), (str(large), 350001, 700001)])
        points = data("depth/0.bin")
        self.assertEqual(len(points), 4 + 16 * 100)
        shown = numpy.frombuffer(points, "<f4", 300, 4).reshape(100, 3) + scene["light_field"]["origin"]
        numpy.testing.assert_allclose(shown, places[:100], atol=1e-6)
        tints = numpy.frombuffer(points, "u1", 400, 4 + 1200).reshape(100, 4)
        self.assertEqual(tints.tolist(), [[i, 2, 3, 128] for i in range(100)])

    def test_a_depth_file_that_cannot_be_shown_is_told(self):
        good, unit = self.write_points("a.ply", numpy.ones((3, 3))), 3
        view = [VISUALIZER, self.field, self.path]
        self.fails(2, ["--text", "--depth"], *view, "--depth", good, "--text")
        self.fails(2, ["--depth is given 9 times", "at most 8"], *view, *["--depth", good] * 9)
        self.fails(2, ["a.pfm", ".exr", ".ply"], *view, "--depth", self.folder / "a.pfm")
        self.fails(3, ["none.exr"], *view, "--depth", self.folder / "none.exr")
        picture = self.folder / "p.exr"
        cv2.imwrite(str(picture), numpy.ones((4, 5, 3), "f4"))
        self.fails(3, ["p.exr", "no channel Z", "lffocus depth"], *view, "--depth", picture)
        self.fails(3, ["b.ply", "world units of 3 m"], *view, "--depth",
                   self.write_points("b.ply", numpy.ones((3, 3)), unit))
        self.fails(3, ["c.ply", "point 1 is at nan"], *view, "--depth",
                   self.write_points("c.ply", numpy.array([[1, 1, 1], [numpy.nan, 1, 1]])))
        good.write_bytes(good.read_bytes()[:-1])
        self.fails(3, ["a.ply", "is truncated"], *view, "--depth", good)

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
