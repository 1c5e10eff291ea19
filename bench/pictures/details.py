#!/usr/bin/python3
"""Details of pictures as a person sees them: by photile and by paths; the strips of docs/measured/details.md.

    bench/pictures/details.py [FOLDER] [--photile COMMAND] [--before COMMAND] [--kitchen FILE.gltf]
                              [--denoiser LIBRARY] [--only DETAIL ...]

Renders 960x720 pixels by `--quality good`, and 128 paths a pixel that Open Image Denoise has cleaned, which
--denoiser names: single pixels of these are judged by eye alone. FOLDER keeps the pictures, and those of
another command (--before) are rendered only where they are missing; without one the strips are two pictures
wide. All of a strip have one exposure, that of the paths. Writes docs/pictures/details/<detail>.png. About an
hour on two cores. Needs the built command and the Debian packages python3-numpy and python3-openimageio.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scenes"), str(ROOT / "bench/pictures")]
from tools import packages

packages.require("numpy", "OpenImageIO")

import numpy as np

import hard_rooms
from lighting import worked_project
from tools import picture_error

SIZE = "960x720"
PATHS = 128  # of a pixel
ENLARGED = 2
GAP = 6  # pixels between the pictures of a strip

SCENES = ROOT / "scenes"
OFFICE = SCENES / "office/office.gltf"
SURFACES = tuple(worked_project.SURFACES.split())
BY_DAY = (*SURFACES, "--site", "52.5,13.4,1", "--time", "2026-03-10T15:00", "--sky", "perez=500,120",
          "--set", "ground=0")


class Detail(NamedTuple):
    scene: str
    left: int
    top: int
    width: int = 200
    height: int = 150


class Picture(NamedTuple):
    scene: pathlib.Path
    options: tuple = ()


PICTURES = {
    "cornell": Picture(SCENES / "cornell-box/cornell-box.gltf"),
    "living": Picture(SCENES / "living-room/living-room.gltf"),
    "office": Picture(OFFICE, (*SURFACES, "--luminaires", "lamps.json")),
    "day": Picture(OFFICE, BY_DAY),
    "coloured": Picture(SCENES / "gallery/coloured-lamps.gltf"),
    "downlights": Picture(SCENES / "gallery/downlights.gltf"),
    "sky": Picture(SCENES / "gallery/sun-and-sky.gltf", ("--sun", "60,40,40000", "--sky", "clear=12000",
                                                               "--set", "ground=0")),
    "cove": Picture(pathlib.Path("cove.gltf")),
}

DETAILS = {
    "cove": Detail("cove", 520, 180),
    "monitors": Detail("office", 560, 380),
    "chair-feet": Detail("office", 400, 570),
    "wall-by-day": Detail("day", 180, 110),
    "sun-by-day": Detail("day", 600, 560),
    "board-by-day": Detail("day", 620, 190),
    "foot-of-block": Detail("cornell", 470, 560),
    "ceiling-line": Detail("living", 660, 60),
    "floor-lamp": Detail("living", 430, 270),
    "sconce": Detail("living", 60, 190),
    "window-frame": Detail("living", 570, 190),
    "coloured-shadows": Detail("coloured", 400, 170),
    "above-downlights": Detail("downlights", 380, 90),
    "sun-and-sky": Detail("sky", 380, 480),
    "sink": Detail("kitchen", 480, 320),
    "worktop": Detail("kitchen", 640, 420),
    "floor": Detail("kitchen", 60, 520),
}


def rendered(command, picture, target, options=()):
    if not target.exists():
        subprocess.run([command, "render", picture.scene, *picture.options, *options, "--size", SIZE, "--quiet",
                        "-o", target], check=True, cwd=target.parent)
    return picture_error.read_picture(target)


def strip(given, detail):
    """The detail before, now and by paths, side by side."""
    picture = PICTURES[detail.scene]
    if detail.scene in hard_rooms.ROOMS:
        picture = picture._replace(scene=given.folder / picture.scene)
        if not picture.scene.exists():
            hard_rooms.ROOMS[detail.scene][0](picture.scene)
    paths = rendered(given.photile, picture, given.folder / f"{detail.scene}-paths.exr",
                     ("--integrator", "path", "--samples", str(PATHS), f"--denoise={given.denoiser}"))
    others = [rendered(command, picture, given.folder / f"{detail.scene}-{name}.exr")
              for name, command in (("before", given.before), ("now", given.photile)) if command]
    factor = picture_error.exposure(paths)
    rows = slice(detail.top, detail.top + detail.height)
    columns = slice(detail.left, detail.left + detail.width)
    parts = []
    for whole in (*others, paths):
        shown = picture_error.displayed(whole[rows, columns], factor)
        parts += [np.ones((ENLARGED * detail.height, GAP, 3)), shown.repeat(ENLARGED, 0).repeat(ENLARGED, 1)]
    return np.concatenate(parts[1:], axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "build/details")
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--before", type=pathlib.Path, help="command of another edition")
    parser.add_argument("--kitchen", type=pathlib.Path, help="kitchen.gltf of the shared scenes; left out without")
    parser.add_argument("--denoiser", default="libOpenImageDenoise.so.2", help="the library")
    parser.add_argument("--only", nargs="+", choices=DETAILS, default=list(DETAILS))
    given = parser.parse_args()
    given.folder = given.folder.resolve()
    given.folder.mkdir(parents=True, exist_ok=True)
    given.photile = given.photile.resolve()
    given.before = given.before and given.before.resolve()
    (given.folder / "lamps.json").write_text(worked_project.SIX)
    shutil.copy(OFFICE.parent / "panel.ies", given.folder)
    if given.kitchen:
        PICTURES["kitchen"] = Picture(given.kitchen.resolve())
    for name in given.only:
        if DETAILS[name].scene in PICTURES:
            picture_error.write_png(ROOT / f"docs/pictures/details/{name}.png", strip(given, DETAILS[name]))


if __name__ == "__main__":
    main()
