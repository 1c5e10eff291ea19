"""A running `photile view` for tests: its address, requests as nobody's browser would send them, and its end."""

import json
import re
import shutil
import signal
import socket
import subprocess
import threading
import urllib.parse

HALL = {"hall.mtl": "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl left\nKd 0 0 0\nKe 100 90 80\n",
        "hall.obj": "mtllib hall.mtl\nv 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 1 2 1\nv 2 2 1\nv 2 2 2\nv 1 2 2\n"
                    "usemtl grey\nf 4 3 2 1\nusemtl left\nf 5 6 7 8\n"}


def write_hall(folder):
    for name, text in HALL.items():
        (folder / name).write_text(text)
    return folder / "hall.obj"


def room_of_gallery(source, folder):
    """Without lamps, beside a photometric file."""
    for name in ("sun-and-sky.gltf", "sun-and-sky.bin", "downlight.ies"):
        shutil.copy(source / "scenes/gallery" / name, folder)
    return folder / "sun-and-sky.gltf"


class Served:
    """Ends with the block that it is opened for."""

    def __init__(self, photile, scene, *options):
        self.process = subprocess.Popen([photile, "view", str(scene), "--no-browser", *map(str, options)],
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.said = []
        self.url = None
        for line in self.process.stdout:
            self.said.append(line)
            found = re.search(r"http://\S+/[0-9a-f]{32}/", line)
            if found:
                self.url = found.group()
                break
        assert self.url, "".join(self.said)
        threading.Thread(target=lambda: self.said.extend(self.process.stdout), daemon=True).start()
        parts = urllib.parse.urlsplit(self.url)
        self.host, self.port, self.path = parts.hostname, parts.port, parts.path

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def interrupt(self):
        """The exit code after Ctrl-C."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(60)

    def room(self):
        """What its page says of the room."""
        return json.loads(re.search('id="room">(.*?)</script>', self.request()[2].decode()).group(1))

    def connect(self):
        return socket.create_connection((self.host, self.port), timeout=20)

    def request(self, what="", method="GET", path=None, host=None, body=None, **headers):
        """Status, headers and body of the answer."""
        lines = [f"{method} {self.path + what if path is None else path} HTTP/1.1",
                 f"Host: {host or f'{self.host}:{self.port}'}"]
        if body is not None and "Transfer_Encoding" not in headers:
            headers.setdefault("Content_Length", len(body))
        lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items() if value is not None]
        with self.connect() as connection:
            connection.sendall("\r\n".join(lines).encode() + b"\r\n\r\n" + (body or b""))
            answer = b""
            try:
                while part := connection.recv(1 << 16):
                    answer += part
            except ConnectionResetError:  # a body that was not read
                assert answer
        head, _, content = answer.partition(b"\r\n\r\n")
        first, *rest = head.decode().split("\r\n")
        return int(first.split()[1]), dict(line.split(": ", 1) for line in rest), content

    def post(self, what, viewer, message, **headers):
        body = message if isinstance(message, bytes) else json.dumps(message).encode()
        sent = {"Origin": f"http://{self.host}:{self.port}", "Content_Type": "application/json", **headers}
        return self.request(f"{what}?viewer={viewer}", "POST", body=body, **sent)[0]


class Page:
    """Listens to news as a page does."""

    def __init__(self, served, viewer):
        self.connection = served.connect()
        self.connection.sendall(f"GET {served.path}events?viewer={viewer} HTTP/1.1\r\n"
                                f"Host: {served.host}:{served.port}\r\n\r\n".encode())
        self.lines = self.connection.makefile("r")
        assert "200" in self.lines.readline()

    def hear(self, what, condition=lambda news: True):
        """Waits for news of this kind."""
        for line in self.lines:
            if line.startswith("data: "):
                news = json.loads(line[6:])
                if what in news and condition(news[what]):
                    return news[what]
        raise AssertionError(f"no {what}: the server has gone")

    def close(self):
        self.lines.close()
        self.connection.close()
