#!/usr/bin/python3
"""Runs the commands of the documentation, page by page, as they stand there: on a small room by the names that
the page has for its files, and with few photons and small pictures in place of the defaults. Each has to end
with exit code 0.

Usage: commands.py PHOTILE SOURCE_FOLDER README.md|docs/PAGE.md...
"""

import json
import os
import pathlib
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import time

PHOTILE, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
sys.path[:0] = [str(SOURCE / "scenes"), str(SOURCE / "bench/lighting")]
from scene_tools.gltf_writer import GltfDocument  # noqa: E402
from scene_tools.shapes import Shape  # noqa: E402

# What stands for something that is not there, in the synopses and beside schedulers; tests/python import files.
PLACEHOLDER = re.compile(r"^photile import|\b(SCENE|FILE|FIRST|PICTURE|FOLDER|PATTERN|HEIGHT|TOPIC)\b|\.\.\.|#FRAMESPEC#|\[--")
LAMPS = ("desk_lamp", "daylight", "lamp", "ceiling_panel", "ceiling_left", "desk1", "picture_spot", "floor_lamp",
         "downlight")
IMAGE = ["--size", "24x16"]
PHOTONS = ["--photons", "3000"]
NODES = ["--set", "light_map_rays=4"]
# Added to a command that does not have them, and in place of the values that it has.
SMALL = {
    "render": [*IMAGE, *PHOTONS, *NODES],
    "walk": [*IMAGE, *PHOTONS, *NODES],
    "measure": [*PHOTONS, "--rays", "16", "--repeats", "2"],
    "glare": [*PHOTONS, "--rays", "16", "--repeats", "2"],
    "daylight": [*PHOTONS],
    "bake": [*PHOTONS, *NODES],
    "view": [*PHOTONS, *NODES],
    "publish": [*PHOTONS, *NODES, "--texel", "0.5"],
    "trace": PHOTONS,
    "trade": [*IMAGE, *PHOTONS],
}
REPLACED = {"--size": "24x16", "--photons": "3000", "--for": "500ms", "--samples": "2", "--frames": "1-2",
            "--target-error": "30%"}
PATIENCE = 300


def commands_of(page):
    """The lines of a page's blocks that begin with photile, or have it behind something that starts it."""
    lines, fenced, found = [], False, []
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            lines.append(line.strip())
    joined = re.sub(r"\\\n", " ", "\n".join(lines))
    for line in joined.splitlines():
        line = re.split(r" {3,}(?!#|-)", line)[0]  # a synopsis: what it does stands in a column beside it
        match = re.match(r"(?:\$ )?(?:[\w]+=\S+ )*(?:build/release/)?(photile [a-z-].*)", line)
        if match:
            found.append(re.sub(r"\$SLURM_\w+", "1", match[1]))
    return found


def words_of(command):
    """As a shell has them, without the comment."""
    return shlex.split(command.replace("####", "\0"), comments=True)


def small(words):
    """The command with little to compute."""
    words = [word.replace("\0", "####") for word in words]
    added = IMAGE if " --integrator path" in " ".join(words) else SMALL.get(words[1], [])
    if words[1] == "layout":
        return [*words, "--", *SMALL["measure"]]
    kept = [REPLACED.get(option, word) for option, word in zip(["", *words], words)]
    for option, value in zip(added[::2], added[1::2]):
        text = f"{option} {value.split('=')[0]}" if option == "--set" else option
        if text not in " ".join(kept):
            kept += [option, value]
    return kept


def rectangle(corner, u, v):
    at = lambda i, j: tuple(c + i * p + j * q for c, p, q in zip(corner, u, v))
    return Shape().polygon([at(0, 0), at(1, 0), at(1, 1), at(0, 1)])


def write_room(file):
    """A room of 5 x 2.8 x 5 m with a window of thin glass, lamps of every name, cameras and a walk."""
    room = GltfDocument("room")
    wall, carpet = room.matte("wall", (0.5, 0.5, 0.5)), room.matte("carpet", (0.2, 0.2, 0.2))
    ceiling = room.matte("ceiling", (0.8, 0.8, 0.8))
    south, east = room.pane("South glass", 0.8), room.pane("East glass", 0.8)
    room.thing("floor", (carpet, rectangle((0, 0, 0), (0, 0, 5), (5, 0, 0))))
    room.thing("ceiling", (ceiling, rectangle((0, 2.8, 0), (5, 0, 0), (0, 0, 5))))
    room.thing("walls", (wall, rectangle((0, 0, 0), (5, 0, 0), (0, 2.8, 0))),
               (wall, rectangle((0, 0, 0), (0, 2.8, 0), (0, 0, 5))),
               (wall, rectangle((5, 0, 0), (0, 0, 5), (0, 1.0, 0))),
               (wall, rectangle((0, 0, 5), (0, 1.0, 0), (5, 0, 0))))
    room.thing("panes", (south, rectangle((0, 1.0, 5), (0, 1.8, 0), (5, 0, 0))),
               (east, rectangle((5, 1.0, 0), (0, 0, 5), (0, 1.8, 0))))
    for number, name in enumerate(LAMPS):
        at = (1 + number % 3 * 1.5, 2.6, 1 + number // 3 * 1.5)
        room.spot(name, at, (at[0], 0, at[2]), 300, (1, 0.9, 0.8), 30, 60)
    room.camera("door", (0.5, 1.6, 0.5), (3, 1, 3), 55, 1.5)
    room.camera("towards the desk", (4, 1.6, 4), (1, 1, 1), 55, 1.5)
    times, places = room._accessor([(0.0,), (0.04,)], "SCALAR", 5126), room._accessor(
        [(0.5, 1.6, 0.5), (0.6, 1.6, 0.5)], "VEC3", 5126)
    room.json["accessors"][times].update(min=[0.0], max=[0.04])
    node = next(i for i, one in enumerate(room.json["nodes"]) if one["name"] == "door")
    room.json["animations"] = [{"channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}],
                                "samplers": [{"input": times, "output": places}]}]
    room.save(file)


# EULUMDAT, whose fields are lines: of the file and the shape; of one lamp; ratios of ten rooms; angles and candela.
LDT = """Maker 2 1 1 0 3 45 none lamp 1 lamp.ldt today 600 600 50 580 580 0 0 0 0 100 100 1 0
1 1 LED 1000 4000 80 10
0.5 0.55 0.6 0.65 0.7 0.75 0.8 0.85 0.9 0.95
0 0 45 90 300 200 0""".split()


def write_inputs(folder):
    """Each kind of input by all names that the pages have for it."""
    write_room(folder / "room.gltf")
    for name in ("scene", "house", "hall", "kitchen", "airport", "office", "office-empty", "living-room",
                 "room-with-closed-blinds"):
        shutil.copy(folder / "room.gltf", folder / f"{name}.gltf")
    text = (folder / "room.gltf").read_bytes()
    text += b" " * (-len(text) % 4)
    (folder / "house.glb").write_bytes(struct.pack("<4s4I", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A) + text)
    (folder / "scenes").symlink_to(SOURCE / "scenes")
    for name in ("er100.ies", "batwing.ies", "panel.ies"):
        shutil.copy(SOURCE / "scenes/office/panel.ies", folder / name)
    (folder / "panel.ldt").write_text("".join(f"{field}\r\n" for field in LDT))
    subprocess.run([sys.executable, SOURCE / "bench/lighting/weather_year.py", folder / "berlin.epw"], check=True)
    shutil.copy(folder / "berlin.epw", folder / "year.epw")
    path = [{"time": 0, "position": [1, 1.6, 4], "look_at": [3, 1, 0], "fov": 50},
            {"time": 0.04, "position": [1.1, 1.6, 4], "look_at": [3, 1, 0]}]
    grid = {"name": "desks", "origin": [1, 0.75, 3], "u": [1.6, 0, 0], "v": [0, 0, -0.8], "spacing": 0.8}
    lamps = {"name": "panels", "file": "panel.ies", "position": "ceiling", "count": [2, 1], "spacing": [2, 2]}
    moods = {"photile_moods": 1, "moods": {"evening": {"desk_lamp": {"power": 200}, "lamp": {"on": False}}}}
    for names, content in ((("p.json", "path.json"), path), (("desks.json", "house.grids.json"), grid),
                           (("office.moods.json",), moods), (("lamps.json", "four.json"), lamps)):
        for name in names:
            (folder / name).write_text(json.dumps(content))
    (folder / "room.pts").write_text("1 0.75 1 0 1 0\n2 0.75 2 0 1 0\n")
    (folder / "eyes.pts").write_text("1 1.2 1 1 0 1\n")


def run(words, folder):
    """Its exit code and what it wrote."""
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}  # where xdg-open opens nothing
    # A page is served until somebody ends it.
    ended = ["timeout", "--preserve-status", "-s", "INT", "5"] if words[1] == "view" else []
    done = subprocess.run([*ended, PHOTILE, *words[1:]], cwd=folder, env=environment, timeout=PATIENCE, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def main():
    failures = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_inputs(folder)
        # Pages on pictures begin with one.
        subprocess.run([PHOTILE, *small(["photile", "render", "room.gltf", "-o", "room.exr", "-q"])[1:]], cwd=folder,
                       check=True)
        for page in sys.argv[3:]:
            for command in commands_of(SOURCE / page):
                if PLACEHOLDER.search(command):
                    continue
                words, start = small(words_of(command)), time.monotonic()
                code, output = run(words, folder)
                print(f"{page}: {time.monotonic() - start:5.1f} s: {shlex.join(words)}", flush=True)
                # A busy machine may still make the page when it is asked to end.
                if code != 0 and not (words[1] == "view" and code == 130 and "http://" in output):
                    failures += 1
                    print(f"  exit code {code}\n{output}")
    if failures:
        sys.exit(f"{failures} commands of the documentation fail")


main()
