#!/usr/bin/env python3
"""Processor time of rendering scenes of garbage, against that of a sound scene of as many triangles:
what Embree's tests of garbage geometry ask, with its bar of 2.5 times.

    bench/pictures/garbage_times.py [--photile PATH] [--triangles N] [--repeats N] [--seed N]

Prints a row a kind of garbage: the least of the processor seconds of its runs, their ratio to the
sound scene's, and what photile made of it. The exit code is 1 where a ratio is above the bar.
"""

import argparse
import os
import pathlib
import random
import subprocess
import sys
import tempfile

BAR = 2.5
HEAD = "mtllib scene.mtl\n"
WILD = ("nan", "inf", "-inf", "1e400", "1e-320", "1e-45", "-0", "3.4e38", "1e30", "1e10", "-1e20")


def triangle(dice, size=0.03):
    """Three corners near each other in the room."""
    centre = [dice.uniform(-0.9, 0.9) for _ in range(3)]
    return [[c + dice.uniform(-size, size) for c in centre] for _ in range(3)]


def sound(dice, _index):
    return triangle(dice)


def wild_coordinates(dice, _index):
    return [[dice.choice(WILD) if dice.randrange(32) == 0 else c for c in corner]
            for corner in triangle(dice)]


def finite_but_huge(dice, _index):
    return [[dice.choice((1e3, -1e5, 1e8)) if dice.randrange(32) == 0 else c for c in corner]
            for corner in triangle(dice)]


def denormal(dice, _index):
    return [[c * 1e-42 for c in corner] for corner in triangle(dice)]


def one_place(dice, _index):
    corners = triangle(random.Random(1))
    dice.shuffle(corners)
    return corners


def nearly_one_place(dice, _index):
    return [[c + dice.uniform(-1e-7, 1e-7) for c in corner] for corner in triangle(random.Random(1))]


def points(dice, _index):
    return [triangle(dice)[0]] * 3


def needles(dice, _index):
    a = [dice.uniform(-0.9, 0.9) for _ in range(3)]
    b = [dice.uniform(-0.9, 0.9) for _ in range(3)]
    return [a, b, [x + dice.uniform(-1e-6, 1e-6) for x in b]]


def fan(dice, _index):
    """All share an edge."""
    return [[0, -0.5, 0], [0, 0.5, 0], [dice.uniform(-0.9, 0.9) for _ in range(3)]]


KINDS = (sound, wild_coordinates, finite_but_huge, denormal, one_place, nearly_one_place, points,
         needles, fan)


def room():
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 3, 7, 5), (2, 6, 8, 4), (3, 4, 8, 7), (1, 5, 6, 2))
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "o room\nusemtl wall\n"
    text += "".join("f " + " ".join(map(str, face)) + "\n" for face in faces)
    text += "".join(f"v {x} 0.99 {z}\n" for x, z in ((-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)))
    return text + "o lamp\nusemtl lamp\nf 9 10 11 12\no things\nusemtl thing\n"


def write(folder, kind, count, seed):
    dice = random.Random(seed)
    lines = [HEAD, room()]
    for index in range(count):
        lines += ["v " + " ".join(map(str, corner)) + "\n" for corner in kind(dice, index)]
    for index in range(count):
        corners = [13 + 3 * index + c for c in range(3)]
        if kind is wild_coordinates and dice.randrange(32) == 0:  # of another one
            corners[dice.randrange(3)] = dice.randrange(1, 13 + 3 * count)
        lines.append("f {} {} {}\n".format(*corners))
    scene = folder / f"{kind.__name__}.obj"
    scene.write_text("".join(lines))
    return scene


def processor_seconds(command):
    before = os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = os.times()
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds, done


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    root = pathlib.Path(__file__).resolve().parents[2]
    parser.add_argument("--photile", default=root / "build/release/photile")
    parser.add_argument("--triangles", type=int, default=5_000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    above = []
    print("| things | processor s | times sound | exit code | said |\n|---|--:|--:|--:|---|")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "scene.mtl").write_text(
            "newmtl wall\nKd 0.7 0.7 0.7\nnewmtl thing\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n")
        usual = None
        for kind in KINDS:
            scene = write(folder, kind, options.triangles, options.seed)
            command = [options.photile, "render", scene, "-o", folder / "out.exr", "--size", "64x48",
                       "--photons", "50k", "--samples", "2", "-q"]
            if usual is None:  # its kernels are compiled, and everything is read once
                processor_seconds(command)
            runs = [processor_seconds(command) for _ in range(options.repeats)]
            seconds, done = min(runs, key=lambda run: run[0])
            usual = usual or seconds
            if seconds > BAR * usual:
                above.append(kind.__name__)
            said = (done.stderr.splitlines() or [""])[-1].replace(str(folder) + "/", "")[:100]
            print(f"| {kind.__name__.replace('_', ' ')} | {seconds:.2f} | {seconds / usual:.2f} | "
                  f"{done.returncode} | {said} |", flush=True)
    if above:
        sys.exit(f"bench/pictures/garbage_times.py: above {BAR} times: {', '.join(above)}")


if __name__ == "__main__":
    main()
