#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Attacks lfvisualizer's page as a hostile browser or program on the same machine would.

Each attack has a server of its own. The answer must be the expected refusal, the server must answer a good request
during or after the attack, and it must not have used more than MOST_MIB of memory. A table of the attacks is printed
at the end.

usage: page_attacks_test.py LFVISUALIZER [MOST_MIB]
"""
import collections
import gzip
import json
import os
import pathlib
import re
import select
import signal
import socket
import subprocess
import sys
import time
import unittest

import small_field
from program_test_case import ProgramTestCase

VISUALIZER = None
# The server's peak memory may grow by this much in an attack: two bodies of 8 MiB, whose buffers may just have doubled,
# and what answers need.
MOST_MIB = 40
GIVE_UP_S = 60   # a server that has not answered after this time never will
MIB = 1 << 20
TABLE = []


def hung_up(status):
    """Returns what a client may see of a server that answers with `status` and hangs up while more bytes arrive: the
    answer may be lost on the way."""
    return {status, None}


class Client:
    """A connection that sends any bytes."""
    opened = []

    def __init__(self, port):
        Client.opened.append(self)
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=GIVE_UP_S)
        self.received = b""
        self.is_open = True

    def send(self, data):
        """Returns False if the server has answered or closed the connection, and reads no more."""
        view = memoryview(data)
        try:
            while view and self.is_open and not self.received:
                readable, writable, _ = select.select([self.socket], [self.socket], [], GIVE_UP_S)
                if readable:
                    self.receive()
                elif writable:
                    view = view[self.socket.send(view[:65536]):]
                else:
                    raise TimeoutError("the server neither reads nor answers")
        except ConnectionError:
            self.is_open = False
        return not view and self.is_open

    def receive(self):
        try:
            data = self.socket.recv(65536)
        except ConnectionError:
            data = b""
        self.received += data
        self.is_open = bool(data)

    def status(self):
        """Returns the status of the first answer, or None if the server closed the connection without one."""
        while self.is_open and b"\r\n\r\n" not in self.received:
            self.receive()
        match = re.match(rb"HTTP/1\.1 (\d+) ", self.received)
        return int(match[1]) if match else None

    def rest(self):
        """Returns all that is received until the server closes the connection."""
        while self.is_open:
            self.receive()
        return self.received

    @classmethod
    def close_all(cls):
        while cls.opened:
            cls.opened.pop().socket.close()


class Server:
    def __init__(self, folder):
        small_field.SIDE = 3
        self.temporary = folder / "tmp"
        self.temporary.mkdir()
        field = small_field.write_field(folder / "field")
        self.path = small_field.write_path(folder)
        self.program = subprocess.Popen(
            [VISUALIZER, field, self.path, "--serve", "0", "-q"], stdout=subprocess.PIPE, text=True,
            env={**os.environ, "TMPDIR": str(self.temporary)})
        address = self.program.stdout.readline()
        self.port, self.token = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/(\w{32})/\n",
                                             address).groups()
        self.port = int(self.port)

    def head(self, name="scene.json", method="GET", host=None, token=None, path=None, **headers):
        """Returns the head of a request without the empty line at its end, so that headers can be added."""
        path = f"/{token or self.token}/{name}" if path is None else path
        lines = [f"{method} {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{self.port}'}"]
        lines += [f"{key.replace('_', '-')}: {value}" for key, value in headers.items()]
        return "\r\n".join(lines).encode() + b"\r\n"

    def ask(self, *pieces):
        client = Client(self.port)
        for piece in pieces:
            if not client.send(piece):
                break
        status = client.status()
        client.socket.close()
        Client.opened.remove(client)
        return status

    def post(self, name, json_object, **how):
        body = json.dumps(json_object).encode()
        return self.ask(self.head(name, "POST", Content_Length=len(body), **how) + b"\r\n" + body)

    def peak_mib(self):
        text = pathlib.Path(f"/proc/{self.program.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s+(\d+) kB", text)[1]) / 1024

    def stop(self):
        self.program.send_signal(signal.SIGINT)
        code = self.program.wait(GIVE_UP_S)
        self.program.stdout.close()
        return code


class PageAttacksTest(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.server = Server(self.folder)
        self.addCleanup(self.server.program.kill)
        for name in ("", "scene.json", "page.js"):
            self.assertEqual(self.server.ask(self.server.head(name) + b"\r\n"), 200)
        self.assertEqual(self.server.post("check", {"text": self.server.path.read_text()}), 200)
        self.peak_before_mib = self.server.peak_mib()
        self.text_before = self.server.path.read_text()

    def tearDown(self):
        Client.close_all()
        self.assert_alive()
        self.assertEqual(self.server.stop(), 0)

    @classmethod
    def tearDownClass(cls):
        width = max(len(what) for what, *_ in TABLE)
        print(f"\n{'attack':{width}}  {'status':>16}  seconds  peak, MiB more")
        for what, statuses, seconds, mib in TABLE:
            told = ", ".join(f"{count} x {status}" if count > 1 else str(status)
                             for status, count in statuses.items())
            print(f"{what:{width}}  {told:>16}  {seconds:7.2f}  {mib:6.1f}")

    def assert_alive(self):
        self.assertEqual(self.server.ask(self.server.head() + b"\r\n"), 200)

    def attack(self, what, expected, body):
        """body() returns a status or a list of them, which must be `expected`: one status, or a set."""
        begin = time.monotonic()
        statuses = body()
        seconds = time.monotonic() - begin
        statuses = collections.Counter(statuses if isinstance(statuses, list) else [statuses])
        self.assert_alive()
        grown = self.server.peak_mib() - self.peak_before_mib
        TABLE.append((what, statuses, seconds, grown))
        self.assertLessEqual(set(statuses), expected if isinstance(expected, set) else {expected},
                             what)
        self.assertLess(grown, MOST_MIB, what)
        Client.close_all()

    # ---- too much

    def test_headers_without_end(self):
        def headers():
            return self.server.ask(self.server.head(), *[b"X-More: " + b"a" * 8000 + b"\r\n"] * 8000)
        self.attack("60 MB of headers", hung_up(431), headers)
        self.attack("60 MB in one header", hung_up(431), lambda: self.server.ask(
            self.server.head(), b"X-More: ", *[b"a" * 60000] * 1000))
        self.attack("60 MB of an address", hung_up(414), lambda: self.server.ask(
            b"GET /", *[b"a" * 60000] * 1000))
        self.attack("a million short headers", hung_up(431), lambda: self.server.ask(
            self.server.head(), *[b"a:\r\n" * 10000] * 100))

    def chunks(self, mib, piece=b"\0" * MIB):
        return [f"{len(piece):x}\r\n".encode() + piece + b"\r\n"] * mib + [b"0\r\n\r\n"]

    def test_bodies_without_end(self):
        for token, expected in (("0" * 32, 403), (None, 413)):
            head = self.server.head("check", "POST", token=token, Transfer_Encoding="chunked")
            self.attack(f"300 MiB chunked, {'with the' if token is None else 'no'} token", hung_up(expected),
                        lambda: self.server.ask(head + b"\r\n", *self.chunks(300)))
        head = self.server.head("check", "POST", Content_Length=300 * MIB)
        self.attack("300 MiB with their length", hung_up(413), lambda: self.server.ask(
            head + b"\r\n", *[b"\0" * MIB] * 300))

    def test_bodies_that_expand(self):
        bomb = gzip.compress(bytes(200 * MIB), 1)
        for token, expected in (("0" * 32, 403), (None, 415)):
            head = self.server.head("check", "POST", token=token, Content_Encoding="gzip",
                                    Content_Length=len(bomb))
            self.attack(f"gzip bomb, {'with the' if token is None else 'no'} token", hung_up(expected),
                        lambda: self.server.ask(head + b"\r\n", bomb))

    def test_many_bodies_at_once(self):
        def bodies():
            clients = [Client(self.server.port) for _ in range(40)]
            head = self.server.head("check", "POST", Transfer_Encoding="chunked") + b"\r\n"
            for piece in [head] + self.chunks(8)[:-1]:
                for client in clients:
                    client.send(piece)
            statuses = [client.status() for client in clients if client.received]
            self.assert_alive()
            return statuses
        self.attack("40 bodies of 8 MiB at once", 503, bodies)

    def test_lengths_that_lie(self):
        def post(length, body=b"{}", *more):
            head = self.server.head("check", "POST", Content_Length=length)
            return self.server.ask(head + b"".join(more) + b"\r\n" + body)
        self.attack("a length too long", 413, lambda: [post(9 * MIB + 1), post(2**63), post(10**30)])
        self.attack("a length that is none", 400,
                    lambda: [post(length) for length in ("-1", "", "0x5", "two", "1 2")])
        self.attack("two lengths", 400, lambda: [
            post(2, b"{}", b"Content-Length: 3\r\n"),
            post(2, b"{}", b"Transfer-Encoding: chunked\r\n")])
        self.attack("a body of a GET", 400, lambda: self.server.ask(
            self.server.head(Content_Length=2) + b"\r\n{}"))

        def shorter():
            clients = [Client(self.server.port) for _ in range(20)]
            for client in clients:
                client.send(self.server.head("check", "POST", Content_Length=9 * MIB) + b"\r\n{")
                client.socket.shutdown(socket.SHUT_WR)
            return [client.status() for client in clients]
        self.attack("20 bodies shorter than told", None, shorter)
        chunk_sizes = (b"-1", b"ffffffffffffffffff", b"xyz", b"\0")
        self.attack("chunks of no length", {400, 413}, lambda: [self.server.ask(
            self.server.head("check", "POST", Transfer_Encoding="chunked") + b"\r\n" + size +
            b"\r\n{}\r\n0\r\n\r\n") for size in chunk_sizes])

    def test_bodies_that_grow_when_they_are_read(self):
        def post(body, head=b'{"a": '):
            body = head + body + b"}"
            return self.server.ask(self.server.head("check", "POST", Content_Length=len(body)) +
                                   b"\r\n" + body)
        self.attack("9 million brackets", 400, lambda: post(b"[" * 9_000_000))
        self.attack("two million objects", 400, lambda: post(b'{"a":' * 1_800_000))
        self.attack("five million numbers", 400, lambda: post(b"[" + b"0," * 4_500_000 + b"0]"))
        self.attack("a million keys", 200, lambda: post(
            b"".join(b',"%x":0' % number for number in range(900_000)), b'{"text":""'))

    # ---- too slow

    def besides(self, clients, rounds=20):
        """Sends good requests while each client sends a byte now and then, so that no client is silent."""
        statuses = []
        for _ in range(rounds):
            for client in clients:
                if client.is_open:
                    client.send(b"a")
            statuses.append(self.server.ask(self.server.head() + b"\r\n"))
        return statuses

    def test_half_requests_keep_nobody_out(self):
        def half_requests(count, start):
            clients = []
            for _ in range(count):
                clients.append(Client(self.server.port))
                clients[-1].send(start)
            return self.besides(clients)
        self.attack("good ones beside 200 half requests", 200,
                    lambda: half_requests(200, b"GET / HTTP/1.1\r\nHost: "))
        self.attack("good ones beside 200 half, with the token", 200,
                    lambda: half_requests(200, self.server.head()))
        self.attack("good ones beside 600 silent connections", 200,
                    lambda: half_requests(600, b""))

    def test_a_storm_of_connections_keeps_nobody_out(self):
        storm = f"""import socket
kept, is_full = [], False
while True:
    kept.append(socket.create_connection(("127.0.0.1", {self.server.port})))
    try:
        kept[-1].send(b"GET /")
    except ConnectionError:
        pass
    if len(kept) > 300:
        is_full = is_full or print("full", flush=True) is None
        del kept[0]
"""
        with subprocess.Popen([sys.executable, "-c", storm], stdout=subprocess.PIPE) as attacker:
            try:
                self.assertTrue(select.select([attacker.stdout], [], [], GIVE_UP_S)[0])
                self.attack("good ones in a storm of half requests", 200, lambda: [
                    self.server.ask(self.server.head() + b"\r\n") for _ in range(500)])
                self.assertIsNone(attacker.poll())
            finally:
                attacker.kill()

    def test_half_requests_are_hung_up(self):
        def half():
            client = Client(self.server.port)
            client.send(self.server.head())
            for _ in range(5 * GIVE_UP_S):
                if not client.send(b"X"):
                    return client.status()
                time.sleep(0.2)
            return "it is still heard"
        self.attack("a half request, a byte at a time", None, half)

    def test_slow_bodies_keep_nobody_out(self):
        def slow():
            head = self.server.head("check", "POST", Content_Length=MIB) + b"\r\n"
            clients = [Client(self.server.port) for _ in range(60)]
            for client in clients:
                client.send(head)
            return self.besides(clients)
        self.attack("good ones beside 60 slow bodies", 200, slow)

    def test_clients_that_never_read(self):
        def deaf():
            clients = [Client(self.server.port) for _ in range(60)]
            requests = (self.server.head("page.js") + b"\r\n") * 100
            for client in clients:
                client.socket.setblocking(False)
                client.socket.send(requests)
            statuses = [self.server.ask(self.server.head() + b"\r\n") for _ in range(20)]
            return statuses
        self.attack("good ones beside 60 that never read", 200, deaf)

    def test_streams_are_counted(self):
        def streams():
            clients = [Client(self.server.port) for _ in range(40)]
            for client in clients:
                client.send(self.server.head("events") + b"\r\n")
            statuses = [client.status() for client in clients]
            self.assert_alive()
            return statuses
        self.attack("40 streams", {200, 503}, streams)
        self.assertEqual(TABLE[-1][1], {200: 16, 503: 24})
        while self.server.ask(self.server.head("events") + b"\r\n") != 200:  # streams that ended are available again
            time.sleep(0.1)

    # ---- from elsewhere

    def test_requests_without_the_token_do_nothing(self):
        refused = [{"token": "0" * 32}, {"path": f"/{self.server.token[:-1]}/save"}, {"path": "/save"},
                   {"host": f"evil.example:{self.server.port}"}, {"host": "evil.example"},
                   {"host": f"localhost.evil.example:{self.server.port}"},
                   {"host": f"localhost.:{self.server.port}"},
                   {"host": f"localhost@evil.example:{self.server.port}"},
                   {"Origin": "http://evil.example"}, {"Origin": "null"},
                   {"Origin": f"http://127.0.0.1:{self.server.port + 1}"},
                   {"Origin": f"http://127.0.0.1:{self.server.port + 1}", "Sec_Fetch_Site": "same-site"},
                   {"Origin": f"http://localhost:{self.server.port}"},
                   {"Origin": f"http://evil.example:{self.server.port}", "Sec_Fetch_Site": "same-origin"},
                   {"host": "127.0.0.1:9000", "Origin": f"http://127.0.0.1:{self.server.port}"},
                   {"host": f"evil.example:{self.server.port}",
                    "Origin": f"http://evil.example:{self.server.port}", "Sec_Fetch_Site": "same-origin"},
                   {"host": f"evil.example:{self.server.port}", "X_Forwarded_Host": "127.0.0.1"},
                   {"Sec_Fetch_Site": "cross-site"}, {"Sec_Fetch_Site": "same-site"}]
        edit = {"text": self.text_before.replace("fps: 25", "fps: 24"), "frame": 1, "force": True}
        for how in refused:
            what = ", ".join(f"{key.replace('_', '-')} {value}" for key, value in how.items())
            what = what.replace(self.server.token[:-1], "HALF-A-TOKEN")
            what = re.sub(r":\d+\b", ":PORT", what)
            self.attack(f"POST with {what}", 403, lambda: [
                self.server.post("save", edit, **how), self.server.post("preview", edit, **how)])
            self.attack(f"GET with {what}", 403, lambda: [
                self.server.ask(self.server.head(name, **how) + b"\r\n")
                for name in ("scene.json", "events", "", "page.js")])
        self.assertEqual(self.server.path.read_text(), self.text_before)
        self.assertEqual(list(self.server.temporary.iterdir()), [])
        preview = self.server.head("preview/1.bin") + b"\r\n"
        self.assertEqual(self.server.ask(preview), 404)
        # The page itself may do what was refused to others.
        own = {"Origin": f"http://127.0.0.1:{self.server.port}", "Sec_Fetch_Site": "same-origin"}
        forwarded = {"host": "localhost:9000", "Origin": "http://localhost:9000"}
        self.assertEqual(self.server.post("check", edit, **forwarded), 200)
        self.assertEqual(self.server.post("save", edit, **own), 200)
        self.assertIn("fps: 24", self.server.path.read_text())
        self.assertEqual(self.server.post("preview", edit, **own), 200)
        while self.server.ask(preview) != 200:
            time.sleep(0.05)

    def test_paths_that_lead_outside(self):
        token = self.server.token
        paths = [f"/{token}/../../etc/passwd", f"/{token}/..", f"/{token}/%2e%2e/%2e%2e/etc/passwd",
                 f"/{token}/image/..\\..\\passwd", f"/{token}/..%5cpasswd", f"/../{token}/scene.json",
                 f"/{token}/%00", f"//{token}/scene.json", "*", "/", f"http://127.0.0.1/{token}/"]
        self.attack("paths that lead outside", 403, lambda: [
            self.server.ask(self.server.head(path=path) + b"\r\n") for path in paths])

    def test_other_methods(self):
        methods = ("PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "BREW")
        self.attack("other methods", 405, lambda: [
            self.server.ask(self.server.head(method=method) + b"\r\n") for method in methods])
        self.attack("other methods, no token", 403, lambda: [
            self.server.ask(self.server.head(method=method, token="0" * 32) + b"\r\n")
            for method in methods])

    # ---- garbage

    def test_garbage_behind_a_request(self):
        garbage = bytes(range(256)) * 200
        for what, more in (("garbage", garbage), ("half a request", b"GET /"), ("zeros", bytes(MIB))):
            def pipelined():
                client = Client(self.server.port)
                client.send(self.server.head() + b"\r\n" + more)
                statuses = [int(status) for status in
                            re.findall(rb"HTTP/1\.1 (\d+) ", client.rest())]
                self.assertEqual(statuses[:1], [200])
                return statuses
            self.attack(f"{what} behind a request", {200, 400, 403, 414, 431}, pipelined)

    def test_many_requests_at_once(self):
        def pipelined():
            client = Client(self.server.port)
            client.send((self.server.head() + b"\r\n") * 200)
            client.socket.shutdown(socket.SHUT_WR)
            return [int(status) for status in re.findall(rb"HTTP/1\.1 (\d+) ", client.rest())]
        self.attack("200 requests behind each other", {200}, pipelined)

    def test_zero_bytes(self):
        head = self.server.head()
        requests = [bytes(100000), b"\0" + head, head.replace(b"GET ", b"GET \0"),
                    head.replace(b"/scene", b"\0/../scene"), head.replace(b"Host: ", b"Host: \0"),
                    head.replace(b"Host", b"Ho\0st")]
        self.attack("zero bytes", {400, 403, 414}, lambda: [
            self.server.ask(request + b"\r\n") for request in requests])
        # The server ignores what follows a zero byte.
        self.attack("zero bytes behind what is asked", 200, lambda: [
            self.server.ask(request + b"\r\n") for request in
            (head.replace(b".json", b".json\0/../x"), head + b"\0\r\n")])


if __name__ == "__main__":
    VISUALIZER = sys.argv[1]
    MOST_MIB = int(sys.argv[2]) if len(sys.argv) > 2 else MOST_MIB
    unittest.main(argv=sys.argv[:1], verbosity=2)
