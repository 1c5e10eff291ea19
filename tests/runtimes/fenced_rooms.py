#!/usr/bin/python3
"""Renders rooms with buffers that end at a page which cannot be touched and begin as NaN, by each
way that light is read: nothing dies, and every pixel has the bits that it has without.

    fenced_rooms.py PHOTILE FENCE_LAYER SOURCES

The rooms of scenes/ below SOURCES, and those beside it or in PHOTILE_SHARED_SCENES, where they are.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

BUNDLED = ("living-room/living-room.gltf", "cornell-box/cornell-box-specular.gltf",
           "gallery/glass-sphere.gltf")
SHARED = ("classroom/classroom.gltf", "kitchen/kitchen.gltf")
# Light maps; an estimate at each hit; a map for each triangle; groups by area.
WAYS = ((), ("--set", "light_maps=off"),
        ("--set", "light_maps=off", "--set", "maps=triangle", "--set", "direct_rays=1"),
        ("--set", "light_maps=off", "--set", "maps=naive", "--set", "passes=3"))


def fail(text):
    sys.exit(f"fenced_rooms.py: error: {text}")


def render(photile, scene, way, picture, layer):
    command = [photile, "render", scene, "-o", picture, "--size", "64x48", "--photons", "50k",
               "--samples", "2", "-q", *way]
    environment = dict(os.environ)
    environment.pop("OPENCL_LAYERS", None)
    if layer:
        mark = picture.with_suffix(".loaded")
        environment |= {"OPENCL_LAYERS": layer, "PHOTILE_LAYER_MARK": str(mark)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        where = " behind the fence" if layer else ""
        fail(f"{scene} with {list(way)}{where}: exit code {done.returncode}: {done.stderr}")
    if layer:
        mark.unlink()  # written by a layer that was loaded


def differing(photile, first, second):
    """Layers whose squared differences are not 0, by photile's own comparison."""
    record = first.with_suffix(".json")
    subprocess.run([photile, "compare", first, second, "--json", record], check=True,
                   stdout=subprocess.DEVNULL)
    layers = json.loads(record.read_text())["layers"]
    if not layers:
        fail(f"nothing was compared in {record}")
    return [layer["light"] for layer in layers if layer["relative_mse"] != 0 or layer["psnr"]]


def main():
    photile, layer, sources = sys.argv[1:]
    shared = os.environ.get("PHOTILE_SHARED_SCENES", os.path.join(sources, "../shared/scenes"))
    rooms = [os.path.join(sources, "scenes", room) for room in BUNDLED]
    rooms += [room for room in (os.path.join(shared, name) for name in SHARED)
              if os.path.isfile(room)]
    with tempfile.TemporaryDirectory() as folder:
        plain, fenced = (pathlib.Path(folder) / name for name in ("plain.exr", "fenced.exr"))
        for scene in rooms:
            for way in WAYS:
                render(photile, scene, way, plain, "")
                render(photile, scene, way, fenced, layer)
                if different := differing(photile, plain, fenced):
                    fail(f"{scene} with {list(way)}: other bits behind the fence: {different}")
    print(f"{len(rooms)} rooms, each in {len(WAYS)} ways: the same bits behind the fence")


if __name__ == "__main__":
    main()
