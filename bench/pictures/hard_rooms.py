#!/usr/bin/python3
"""Rooms whose light few photons find or many thin things part, and the noise and bias of their pictures: the
tables in docs/measured/accuracy.md.

    bench/pictures/hard_rooms.py [FOLDER] [--photile COMMAND] [--only ROOM ...] [--seeds N] [--options "..."]

Writes small scenes to FOLDER and renders each by `--quality good` with some seeds. Prints the relMSE
of a picture beside the mean of all seeds' (as of one picture, without bias), what the mean and a sixteenth
of the picture scatter by from seed to seed, and processor seconds. With `--paths` the means of the picture
and of its sixteenths are held against photile's path tracer, whose pictures FOLDER keeps: single pixels of
these are too noisy, since paths from the camera hardly find such lamps. Needs the built command and the
Debian packages python3-numpy and python3-openimageio.
"""

import argparse
import math
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scenes")]
from tools import packages
from tools.processes import timed

packages.require("numpy", "OpenImageIO")

import numpy as np

from scene_tools.gltf_writer import GltfDocument
from scene_tools.shapes import Shape, box, rectangle
from tools import path_references, picture_error

SIZE = "96x72"
WHITE, GREY, OAK = (0.8, 0.8, 0.8), (0.4, 0.4, 0.4), (0.45, 0.3, 0.18)
LAMP = (1.0, 0.9, 0.75)
WIDTH, DEPTH, HEIGHT, WALL = 4.0, 5.0, 2.6, 0.12  # metres: along x, along z, along y, of a wall
DOOR_WIDTH, DOOR_HEIGHT, LEAF = 0.9, 2.1, 0.04
GAP = 0.15  # metres by which a door stands open


class House:
    """Rooms in a row along x, whose walls have holes; one floor spans them all."""

    def __init__(self, title, rooms):
        self.document = GltfDocument(title)
        self.white = self.document.matte("white", WHITE)
        self.grey = self.document.matte("grey", GREY)
        self.oak = self.document.matte("oak", OAK)
        self.rooms = rooms
        self.length = rooms * WIDTH + (rooms - 1) * WALL
        self.holes = {}  # of the wall at the right of a room: (z0, y0, z1, y1), metres
        self.window = None  # of the back wall of the last room: (x0, y0, x1, y1), metres from its corner

    def left_of(self, room):
        return room * (WIDTH + WALL)

    def door(self, wall, z):
        """A hole in a wall, and a leaf that stands ajar in it, hung at its far side."""
        self.holes[wall] = (z, 0.0, z + DOOR_WIDTH, DOOR_HEIGHT)
        leaf = box((LEAF, DOOR_HEIGHT - 0.01, DOOR_WIDTH - 0.01), (0, 0.005, (DOOR_WIDTH - 0.01) / 2))
        turned = leaf.turned("y", math.degrees(math.asin(GAP / DOOR_WIDTH)))
        self.document.thing(f"door {wall}",
                            (self.oak, turned.moved(self.left_of(wall) + WIDTH + WALL - LEAF / 2, 0, z + 0.005)))

    def build(self):
        self.document.thing("floor", (self.grey, rectangle((0, 0, DEPTH), (self.length, 0, 0), (0, 0, -DEPTH))))
        for room in range(self.rooms):
            self._room(room)
        for wall, hole in self.holes.items():
            self._lining(self.left_of(wall) + WIDTH, *hole)

    def _room(self, room):
        x = self.left_of(room)
        shape = rectangle((x, HEIGHT, 0), (WIDTH, 0, 0), (0, 0, DEPTH))  # ceiling, looks down
        shape.add(rectangle((x + WIDTH, 0, DEPTH), (-WIDTH, 0, 0), (0, HEIGHT, 0)))
        back = []
        if self.window and room == self.rooms - 1:
            x0, y0, x1, y1 = self.window
            back = [(x0 / WIDTH, y0 / HEIGHT, x1 / WIDTH, y1 / HEIGHT)]
        shape.add(rectangle((x, 0, 0), (WIDTH, 0, 0), (0, HEIGHT, 0), back))
        left, right = self.holes.get(room - 1), self.holes.get(room)
        shape.add(rectangle((x, 0, DEPTH), (0, 0, -DEPTH), (0, HEIGHT, 0),
                            [(1 - left[2] / DEPTH, left[1] / HEIGHT, 1 - left[0] / DEPTH, left[3] / HEIGHT)]
                            if left else ()))
        shape.add(rectangle((x + WIDTH, 0, 0), (0, 0, DEPTH), (0, HEIGHT, 0),
                            [(right[0] / DEPTH, right[1] / HEIGHT, right[2] / DEPTH, right[3] / HEIGHT)]
                            if right else ()))
        self.document.thing(f"room {room}", (self.white, shape))

    def _lining(self, x, z0, y0, z1, y1):
        """Of a hole in a wall between two rooms; its floor is the rooms' where it begins there."""
        deep, high = z1 - z0, y1 - y0
        shape = rectangle((x, y0, z0), (WALL, 0, 0), (0, high, 0))
        shape.add(rectangle((x, y0, z1), (0, high, 0), (WALL, 0, 0)))
        shape.add(rectangle((x, y1, z0), (WALL, 0, 0), (0, 0, deep)))
        if y0 > 0:
            shape.add(rectangle((x, y0, z0), (0, 0, deep), (WALL, 0, 0)))
        self.document.thing("lining", (self.white, shape))

    def furniture(self, room):
        x = self.left_of(room)
        self.document.thing("chest", (self.oak, box((0.9, 0.8, 0.45), (x + 2.8, 0, 0.4))))
        self.document.thing("table", (self.white, box((0.8, 0.5, 1.2), (x + 2.2, 0, 2.6))))
        self.document.thing("stool", (self.grey, box((0.4, 0.45, 0.4), (x + 1.2, 0, 1.6))))

    def lamp(self, name, lumen, shape):
        self.document.thing(name, (self.document.lamp(name, lumen, shape.area(), LAMP), shape))

    def ceiling_lamp(self, room, lumen):
        x = self.left_of(room) + WIDTH / 2
        self.lamp("lamp", lumen, rectangle((x - 0.3, HEIGHT - 0.02, 2.2), (0.6, 0, 0), (0, 0, 0.6)))

    def save(self, path, target):
        x = self.left_of(self.rooms - 1)
        self.document.camera("camera", (x + WIDTH - 0.3, 1.6, DEPTH - 0.3), target, 60, 4 / 3)
        self.document.save(path)


def doors_ajar(path):
    """Three rooms, a lamp in the first, doors ajar between them."""
    house = House("doors ajar", 3)
    house.door(0, 0.6)
    house.door(1, 3.2)
    house.build()
    for room in range(3):
        house.furniture(room)
    house.ceiling_lamp(0, 3000)
    house.save(path, (house.left_of(2) + 0.8, 0.9, 1.2))


def cove(path):
    """A lamp strip on a shelf under the ceiling, behind its panel."""
    house = House("cove", 1)
    house.build()
    house.furniture(0)
    shelf, panel, top = 0.15, 0.14, HEIGHT - 0.2
    house.document.thing("shelf", (house.white, box((shelf, 0.02, DEPTH), (shelf / 2, top - 0.02, DEPTH / 2),
                                                    without=("-x", "-z", "+z"))))
    house.document.thing("panel", (house.white, box((0.02, panel, DEPTH), (shelf + 0.01, top - 0.02, DEPTH / 2),
                                                    without=("-z", "+z"))))
    house.lamp("strip", 4000, rectangle((0.05, top + 0.01, DEPTH - 0.1), (0.03, 0, 0), (0, 0, -DEPTH + 0.2)))
    house.save(path, (0.8, 1.2, 1.2))


def hatch(path):
    """A lamp in the room next door, and a hole of 30 cm in the wall."""
    house = House("hatch", 2)
    house.holes[0] = (1.0, 1.6, 1.3, 1.9)
    house.build()
    for room in range(2):
        house.furniture(room)
    house.ceiling_lamp(0, 3000)
    house.save(path, (house.left_of(1) + 0.8, 0.9, 1.2))


def small_window(path):
    """A window of 30 cm, a sun and a sky."""
    house = House("small window", 1)
    house.window = (1.5, 1.5, 1.8, 1.8)
    house.build()
    house.furniture(0)
    house.save(path, (0.8, 0.9, 1.2))


def blinds(path):
    """A window behind a blind of slats 25 mm wide; before it a table on thin legs, with small things on it."""
    house = House("blinds", 1)
    house.window = (1.0, 0.9, 2.8, 2.2)
    house.build()
    x0, y0, x1, y1 = house.window
    slats = Shape()
    for row in range(round((y1 - y0) / 0.022)):
        slats.add(box((x1 - x0, 0.0006, 0.025)).turned("x", 40).moved((x0 + x1) / 2, y0 + 0.022 * row, 0.03))
    house.document.thing("blind", (house.white, slats))
    house.document.thing("table", (house.oak, box((1.4, 0.03, 0.7), (1.9, 0.7, 1.1))))
    legs, cups = Shape(), Shape()
    for x in (-0.65, 0.65):
        for z in (-0.3, 0.3):
            legs.add(box((0.02, 0.7, 0.02), (1.9 + x, 0, 1.1 + z)))
    for i in range(6):
        cups.add(box((0.06, 0.09, 0.06), (1.4 + 0.2 * i, 0.73, 1.0 + 0.12 * (i % 3))))
    house.document.thing("legs", (house.grey, legs))
    house.document.thing("cups", (house.white, cups))
    house.save(path, (1.2, 0.9, 0.6))


SKY = ("--site", "52.5,13.4,1", "--time", "2026-06-21T18:30", "--sky", "perez=500,120", "--set", "north=180",
       "--set", "ground=0")
ROOMS = {"doors": (doors_ajar, ()), "cove": (cove, ()), "hatch": (hatch, ()),
         "window": (small_window, (*SKY, "--set", "portals=off")), "blinds": (blinds, SKY)}
PATHS_OF_PICTURE = 1024  # of a pixel, of one picture of the reference


def sixteenths(picture):
    """Mean luminance of each of 4 x 4 parts."""
    luminance = picture @ picture_error.LUMINANCE
    return np.array([part.mean() for rows in np.array_split(luminance, 4, axis=0)
                     for part in np.array_split(rows, 4, axis=1)])


def measured(given, name, folder):
    write, options = ROOMS[name]
    scene = given.folder / f"{name}.gltf"
    if not scene.exists():
        write(scene)
    pictures, seconds = [], 0.0
    for seed in range(1, given.seeds + 1):
        target = folder / "picture.exr"
        _, taken, _ = timed([given.photile, "render", scene, *options, "--size", SIZE, "--seed", str(seed),
                             "--quality", "good", "--quiet", "-o", target, *given.options.split()])
        seconds += taken / given.seeds
        pictures.append(picture_error.read_picture(target))
    mean = np.mean(pictures, axis=0)
    spread = np.mean([picture_error.measure(picture, mean)["rel_mse"] for picture in pictures])
    means = [picture.mean() for picture in pictures]
    parts = np.array([sixteenths(picture) for picture in pictures])
    print(f"| {name} | {spread * given.seeds / (given.seeds - 1):.4f} | {ratio_text(given, scene, options, mean)} | "
          f"{100 * np.std(means, ddof=1) / np.mean(means):.1f}% | "
          f"{100 * np.sqrt(np.mean((np.std(parts, axis=0, ddof=1) / parts.mean(axis=0)) ** 2)):.1f}% | "
          f"{seconds:.1f} |", flush=True)


def ratio_text(given, scene, options, mean):
    """Of the means to paths, and the standard error of the paths, of the picture and of the sixteenth that is
    farthest off; nothing where none are asked for."""
    if not given.paths:
        return " | "
    found = path_references.pictures(given.photile, scene, SIZE, given.paths, given.folder / "references",
                                     options, PATHS_OF_PICTURE)
    own, of_paths = sixteenths(mean), np.array([sixteenths(picture) for picture in found])
    part = np.argmax(np.abs(own / of_paths.mean(axis=0) - 1))
    return " | ".join(f"{ours / np.mean(paths):.3f} +-{np.std(paths, ddof=1) / np.sqrt(len(paths)) / np.mean(paths):.3f}"
                      for ours, paths in ((own.mean(), of_paths.mean(axis=1)), (own[part], of_paths[:, part])))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "build/hard-rooms")
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--only", nargs="+", choices=ROOMS, default=list(ROOMS))
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--paths", type=int, help="of a pixel, for references that means are held against")
    parser.add_argument("--options", default="", help="further options of photile render")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    print("| | noise, relMSE | mean to that of paths | of the sixteenth farthest off | "
          "scatter of the mean | of a sixteenth | processor s |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as name:
        for room in given.only:
            measured(given, room, pathlib.Path(name))


if __name__ == "__main__":
    main()
