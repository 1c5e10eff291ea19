#!/usr/bin/python3
"""Stands in for tev while `photile render --preview` runs, and compares the picture that it puts
together with the EXR.

    preview_test.py PHOTILE
"""

import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading

import numpy as np
import OpenImageIO as oiio

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SCENE = SOURCE / "scenes/cornell-box/cornell-box.gltf"
CREATE, UPDATE = 4, 6


def fail(text):
    sys.exit(f"preview_test.py: error: {text}")


class Tev:
    """Decodes packets as tev's src/Ipc.cpp does."""

    def __init__(self):
        self.server = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self.server.getsockname()[1]}"
        self.pictures, self.updates = {}, 0
        self.first = None  # what the first packet with pixels shows, where that is a whole picture
        self.thread = threading.Thread(target=self.serve)
        self.thread.start()

    def serve(self):
        connection, _ = self.server.accept()
        stream = connection.makefile("rb")
        while head := stream.read(4):
            length = struct.unpack("<I", head)[0]
            self.take(stream.read(length - 4))

    def take(self, packet):
        self.bytes, self.at = packet, 0
        kind, _ = self.numbers("<BB")
        name = self.text()
        if kind == CREATE:
            width, height, channels = self.numbers("<3i")
            if [self.text() for _ in range(channels)] != ["R", "G", "B"]:
                fail("other channels than R, G and B")
            self.pictures[name] = np.zeros((height, width, 3), np.float32)
        elif kind == UPDATE:
            channels, = self.numbers("<i")
            [self.text() for _ in range(channels)]
            x, y, width, height = self.numbers("<4i")
            offsets = self.numbers(f"<{channels}q")
            strides = self.numbers(f"<{channels}q")
            data = np.frombuffer(self.bytes, "<f4", offset=self.at)
            for channel, (offset, stride) in enumerate(zip(offsets, strides)):
                values = data[offset::stride][:width * height]
                self.pictures[name][y:y + height, x:x + width, channel] = values.reshape(
                    height, width)
            if self.updates == 0 and self.pictures[name].shape[:2] == (height, width):
                self.first = self.pictures[name].copy()
            self.updates += 1
        else:
            fail(f"a packet of type {kind}")

    def numbers(self, layout):
        values = struct.unpack_from(layout, self.bytes, self.at)
        self.at += struct.calcsize(layout)
        return values

    def text(self):
        end = self.bytes.index(b"\0", self.at)
        value = self.bytes[self.at:end].decode()
        self.at = end + 1
        return value


def rgb_of(file):
    source = oiio.ImageInput.open(str(file))
    spec = source.spec()
    pixels = np.asarray(source.read_image(format="float")).reshape(spec.height, spec.width, -1)
    names = list(spec.channelnames)
    return pixels[:, :, [names.index(channel) for channel in "RGB"]]


def main():
    photile = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        for extra in ([], ["--passes", "2"], ["--integrator", "path"]):
            tev = Tev()
            picture = pathlib.Path(folder) / "picture.exr"
            photons = [] if "path" in extra else ["--photons", "50k"]
            subprocess.run([photile, "render", SCENE, "-o", picture, "--size", "80x60", "--samples",
                            "2", "--quiet", "--light", "lamp=x2", "--preview", tev.address,
                            "--quality", "draft", *photons, *extra], check=True)
            tev.thread.join(60)
            if tev.thread.is_alive():
                fail("the connection was not closed")
            if list(tev.pictures) != [SCENE.name]:
                fail(f"pictures {list(tev.pictures)}")
            if "path" not in extra and tev.updates < 10:
                fail(f"only {tev.updates} updates: no live picture")
            if "path" not in extra:
                if tev.first is None:
                    fail("rows come before a first picture")
                # By other photons, of surfaces: few samples meet a lamp's border, and those count most.
                last = rgb_of(picture).mean(axis=2)
                ratio = np.median(tev.first.mean(axis=2)[last > 0]) / np.median(last[last > 0])
                if not 0.85 < ratio < 1.15:
                    fail(f"{extra}: the first picture is {ratio:.2f} times as bright as the last")
            if not np.allclose(tev.pictures[SCENE.name], rgb_of(picture), rtol=1e-5, atol=1e-6):
                fail(f"{extra}: tev shows another picture than the EXR holds")
    print("tev shows what the EXR holds")


main()
