#!/usr/bin/python3
"""Traces the system calls of scenes that name files elsewhere: none outside the scene's folder is
opened, whatever the name is made of. Exit code 77: strace is not installed.

    opened_files_test.py PHOTILE
"""

import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

# "= 3</folder/file>": what a call has opened, as strace -y resolves it.
OPENED = re.compile(r"\b(?:open|openat|openat2|creat)\(.*= \d+<(.*)>(?:\(deleted\))?$")
SQUARE = struct.pack("<12f6H", 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 1, 2, 0, 2, 3)


def fail(text):
    sys.exit(f"opened_files_test.py: error: {text}")


def names(place):
    """Of the file `secret` beside the scene's folder, of devices, and of what has no end."""
    secret, inner = place / "secret", place / "scene"
    for name, target in (("link", "../secret"), ("absolute link", secret), ("chain", "link"), ("up", "..")):
        (inner / name).symlink_to(target)
    os.mkfifo(inner / "pipe")
    return ["../secret", "%2e%2e/secret", "..%2fsecret", "%2E%2E%2Fsecret", "./../secret",
            "below/../../secret", "absent/../../secret", "..//secret", "..\\secret", str(secret),
            f"file://{secret}", f"/{secret}", f"{inner}/../secret", "link", "absolute link", "chain",
            "up/secret", "up/scene/../secret", "pipe", "/dev/zero"]


def obj(folder, name):
    scene = folder / "scene.obj"
    scene.write_text(f"mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl lamp\n"
                     "f 1/1 2/2 3/3\n")
    return scene


def mtl(folder, name):
    (folder / "scene.mtl").write_text(f"newmtl lamp\nKd 1 1 1\nKe 1 1 1\nmap_Kd {name}\nmap_Ke {name}\n")
    return obj(folder, "scene.mtl")


def gltf(folder, name, picture):
    """A square whose points, or whose picture, are in a file of that name."""
    material = {"emissiveFactor": [1, 1, 1]}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1,
                                    "material": 0}]}],
        "materials": [material],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                      {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"uri": "scene.bin" if picture else name, "byteLength": 60}]}
    (folder / "scene.bin").write_bytes(SQUARE)
    if picture:
        material["emissiveTexture"] = {"index": 0}
        document |= {"textures": [{"source": 0}], "images": [{"uri": name}]}
    scene = folder / "scene.gltf"
    scene.write_text(json.dumps(document))
    return scene


KINDS = {"OBJ": obj, "MTL": mtl, "glTF buffer": lambda folder, name: gltf(folder, name, False),
         "glTF image": lambda folder, name: gltf(folder, name, True)}


def opened(photile, scene, *options):
    """Files and folders that `photile info` opens, by their true names."""
    log = scene.parent.parent / "calls"
    command = ["strace", "-f", "-y", "-s", "4096", "-e", "trace=open,openat,openat2,creat", "-o", log,
               photile, "info", scene, *options]
    done = subprocess.run(command, capture_output=True, timeout=600, check=False)
    if done.returncode not in (0, 1, 2, 3):
        fail(f"{scene.name}: exit code {done.returncode}: {done.stderr.decode()}")
    # The C library looks for the stack of a process in its own /proc/self/maps.
    return {re.sub(r"^/proc/\d+/", "/proc/self/", match.group(1))
            for match in map(OPENED.search, log.read_text().splitlines()) if match}


def main():
    photile = sys.argv[1]
    if shutil.which("strace") is None or subprocess.run(
            ["strace", "-o", "/dev/null", "true"], capture_output=True, check=False).returncode != 0:
        print("skipped: strace is not installed, or may not trace")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as temporary:
        place = pathlib.Path(temporary).resolve()
        folder, secret = place / "scene", place / "secret"
        (folder / "below").mkdir(parents=True)
        secret.write_bytes(SQUARE)
        tried = names(place)
        for kind, write in KINDS.items():
            # What a sound scene opens besides itself: libraries, the machine's description.
            (folder / "inside").write_bytes(SQUARE)
            usual = opened(photile, write(folder, "inside"))
            if str(folder / "inside") not in usual:
                fail(f"{kind}: not even a file in the scene's folder is seen to be opened")
            if str(secret) not in opened(photile, write(folder, "../secret"), "--set", "allow_outside=on"):
                fail(f"{kind}: with --set allow_outside=on, the file outside is not seen to be opened")
            for name in tried:
                for path in sorted(opened(photile, write(folder, name)) - usual):
                    if pathlib.Path(path).parent != folder:
                        fail(f"{kind} that names '{name}' made photile open {path}")
    print(f"{len(KINDS)} kinds of {len(tried)} names: nothing outside the scene's folder was opened")


main()
