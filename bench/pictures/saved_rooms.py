#!/usr/bin/python3
"""What it takes to open a room whose photons and light maps were saved; writes the table of docs/measured/saved-rooms.md.

    bench/pictures/saved_rooms.py [SCENES] [--photile COMMAND]

SCENES holds <scene>/<scene>-diffuse.gltf and references/<scene>-diffuse-256x192.exr, as for
bench/pictures/quality.py. `photile walk --quick` turns once round
in each room, from where its camera stands, and saves photons and light maps; then it draws the first
frame, and all of them, from the file. The table has processor seconds of whole processes, the least of five
for single frames; and of frames of 256x192 with 16 samples, what each costs more than the first, and the error
of the first. Needs the built command and the Debian packages python3-numpy and
python3-openimageio.
"""

import json
import math
import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import packages, scene_arguments
from tools.processes import timed
from tools.report_section import replace_section

packages.require("numpy", "OpenImageIO")

from tools import picture_error
from tools.gltf_meshes import read_gltf

SIZE = "256x192"
ROWS = (("classroom", "--set light_map_rays=0 --photons 1M -k 250"),
        ("classroom", "--photons 500k -k 100 --set light_map_rays=32"))
FRAMES = 24
REPEATS = 5


def turn(scene, file, degrees, time_of_turn=1.0):
    """Writes keyframes that turn about the vertical."""
    _, view = read_gltf(scene)
    forward, eye = -view.to_world[:3, 2], view.to_world[:3, 3]
    steps = 24
    keys = []
    for step in range(steps + 1):
        angle = math.radians(degrees * step / steps)
        keys.append({"time": step * time_of_turn / steps, "position": eye.tolist(),
                     "direction": [forward[0] * math.cos(angle) + forward[2] * math.sin(angle),
                                   forward[1],
                                   forward[2] * math.cos(angle) - forward[0] * math.sin(angle)]})
    file.write_text(json.dumps({"interpolation": "linear", "keyframes": keys}))


def row(given, name, options, folder):
    scene, reference = scene_arguments.interior(given.scenes, name, SIZE)
    maps = folder / "room.maps"
    paths = {name: folder / f"{name}.json" for name in ("round", "still", "one")}
    turn(scene, paths["round"], 360)
    turn(scene, paths["still"], 0)
    turn(scene, paths["one"], 0, 1e-3)  # ends before a second frame

    def walk(path, frames, size, samples, *more):
        for frame in folder.glob("frame.*"):
            frame.unlink()
        return timed([given.photile, "walk", scene, "-o", folder / frames, "--quick", "--size", size,
                      "--samples", str(samples), "--set", "quota=power", "--fps", str(FRAMES),
                      "--camera-path", paths[path], *options.split(), *more])

    def without_photons(*arguments):
        taken = walk(*arguments, "--load-maps", maps)
        if re.search("trace photons|build photon maps", taken[2]):
            sys.exit(f"saved_rooms.py: error: {name} asked for photons: {taken[2]}")
        return taken

    window, small = ("frame.###.png", "512x512", 1), ("frame.###.exr", SIZE, 16)
    saved = walk("round", *window, "--save-maps", maps)
    first = min(without_photons("one", *window)[1] for _ in range(REPEATS))
    whole = without_photons("round", *window)[1]
    size = maps.stat().st_size
    walk("one", *small, "--save-maps", maps)
    one = min(without_photons("one", *small)[1] for _ in range(REPEATS))
    still = min(without_photons("still", *small)[1] for _ in range(REPEATS))
    picture = picture_error.read_picture(folder / "frame.001.exr")
    error = picture_error.measure(picture, picture_error.read_picture(reference))
    return (f"| {name} | `{options}` | {saved[1]:.1f} | {size / 1e6:.0f} | "
            f"{first:.2f} | {whole:.2f} | "
            f"{1000 * (still - one) / FRAMES:.0f} | "
            f"{picture_error.rel_mse_text(error)} |")


def main():
    given = scene_arguments.parser(__doc__.splitlines()[0]).parse_args()
    lines = ["| processor seconds | | look round and save | file, MB | first frame from the file "
             f"| {FRAMES + 1} frames round | each further frame of 256x192, 16 samples, ms | its relMSE |",
             "|---|---|--:|--:|--:|--:|--:|--:|"]
    with tempfile.TemporaryDirectory() as folder:
        for name, options in ROWS:
            lines.append(row(given, name, options, pathlib.Path(folder)))
            print(lines[-1], flush=True)
    replace_section(scene_arguments.ROOT / "docs/measured/saved-rooms.md", "pictures/saved_rooms.py", "\n".join(lines))


if __name__ == "__main__":
    main()
