# SPDX-License-Identifier: Apache-2.0
"""A web server on a port of its own that sends ranges of the files of a folder, and may fail as a test says."""
import http.server
import pathlib
import re
import socket
import ssl
import subprocess
import threading


class RangeServer:
    """Serves FOLDER from its construction until stop(). `fault`, if set, is called as fault(handler, path, begin, end)
    before each answer, and answers itself if it returns True. `requests` holds (path, begin, end) of each answer."""

    def __init__(self, folder: pathlib.Path, fault=None, certificate=None, port=0):
        self.folder, self.fault = pathlib.Path(folder), fault
        self.requests = []
        self._open = set()
        self._lock = threading.Lock()
        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", port), self._handler())
        self._server.daemon_threads = True
        self._server.handle_error = lambda *_: None  # clients that go away
        self.scheme = "http"
        if certificate:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(*certificate)
            self._server.socket = context.wrap_socket(self._server.socket, server_side=True)
            self.scheme = "https"
        self.port = self._server.server_address[1]
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()

    def url(self, name: str) -> str:
        return f"{self.scheme}://127.0.0.1:{self.port}/{name}"

    def sent_bytes(self, part="") -> int:
        """Returns how many bytes of the files whose names contain `part` were asked for."""
        with self._lock:
            return sum(end - begin for path, begin, end in self.requests if part in path)

    def stop(self):
        """Ends all connections; later ones are refused."""
        self._server.shutdown()
        self._server.server_close()
        with self._lock:
            for connection in self._open:
                try:
                    connection.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass

    def _handler(self):
        server = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"
            wbufsize = -1

            def setup(self):
                super().setup()
                with server._lock:
                    server._open.add(self.connection)

            def finish(self):
                with server._lock:
                    server._open.discard(self.connection)
                super().finish()

            def log_message(self, *_):
                pass

            def status(self, code, **headers):
                self.send_response(code)
                for name, value in headers.items():
                    self.send_header(name.replace("_", "-"), value)
                self.send_header("Content-Length", "0")
                self.end_headers()

            def do_GET(self):
                path = self.path.partition("?")[0]
                file = server.folder / path.lstrip("/")
                wanted = re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers.get("Range", ""))
                size = file.stat().st_size if file.is_file() else 0
                begin = int(wanted.group(1)) if wanted else 0
                end = min(int(wanted.group(2)) + 1, size) if wanted else size
                if server.fault and server.fault(self, path, begin, end):
                    return
                if not file.is_file():
                    self.status(404)
                    return
                if begin >= end:
                    self.status(416)
                    return
                with server._lock:
                    server.requests.append((path, begin, end))
                self.send_response(206)
                self.send_header("Content-Range", f"bytes {begin}-{end - 1}/{size}")
                self.send_header("Content-Length", str(end - begin))
                self.send_header("ETag", f'"{file.stat().st_mtime_ns}-{size}"')
                self.end_headers()
                with open(file, "rb") as opened:
                    opened.seek(begin)
                    while begin < end:
                        piece = opened.read(min(1 << 20, end - begin))
                        self.wfile.write(piece)
                        begin += len(piece)

        return Handler


def make_certificate(folder: pathlib.Path):
    """Makes a certificate that nobody has signed but itself. Returns its file and that of its key."""
    certificate, key = folder / "certificate.pem", folder / "key.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=127.0.0.1",
                    "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", certificate],
                   check=True, capture_output=True)
    return certificate, key
