#!/usr/bin/python3
"""A year of daylight in three rooms by photile and by Radiance's two-phase method; writes docs/measured/daylight.md.

    bench/lighting/daylight.py --radiance FOLDER [--photile COMMAND] [--only ROOM] [--quick]

FOLDER holds Radiance's commands and, in ../lib, its library: that of the Python package pyradiance, say, where
it is pyradiance/bin. rfluxmtx finds the daylight coefficients, gendaymtx the skies and dctimestep their product;
both programs have 577 patches, the sun in the four nearest of them, ground of reflectance 0.2 and the weather of
weather_year.py. Radiance runs several times, with the points in another order each time and so by other random
numbers: the scatter tells its own noise. Needs numpy.
"""

import argparse
import csv
import dataclasses
import json
import math
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages
from tools.processes import timed
from tools.report_section import replace_section
from lighting.weather_year import weather_text

packages.require("numpy")

import numpy as np

RGB_TO_LUX = np.array([47.4, 119.9, 11.6])
HOURS = 8760
RUNS = 4  # of Radiance
RADIANCE = ["-ab", "7", "-ad", "4096", "-lw", "2e-5"]


@dataclasses.dataclass
class Room:
    """Boxes and walls of one reflectance each, metres, y up, -z north; sensors look up."""
    name: str
    caption: str
    size: tuple
    windows: tuple          # (wall, from, to, sill, head); walls: "south", "east", "north"
    boxes: tuple = ()       # (low, high, reflectance)
    reflectance: tuple = (0.2, 0.5, 0.8)  # floor, walls, ceiling
    spacing: float = 0.5


OFFICE_WINDOWS = tuple((side, 0.6 + 2.4 * i, 2.4 + 2.4 * i, 0.9, 2.6) for side in ("south", "north") for i in range(9))
OFFICE_BOXES = tuple(
    box for i in range(9) for j in range(4) for x, z in [(1.2 + 2.4 * i, 1.6 + 2.6 * j)]
    for box in (((x, 0.7, z), (x + 1.6, 0.74, z + 0.8), 0.5), ((x, 0, z + 0.76), (x + 1.6, 1.1, z + 0.8), 0.35),
                ((x + 0.5, 0.78, z + 0.6), (x + 1.1, 1.15, z + 0.64), 0.1))
) + tuple(((x, 0, 5.7), (x + 2, 0.8, 6.2), 0.6) for x in (3, 10, 17)) + (
    ((0, 2.75, 12.05), (24, 2.85, 13.2), 0.6), ((-30, -0.4, -40), (54, -0.3, 40), 0.2), ((-10, -0.3, -30), (40, 9, -22), 0.3))

ROOMS = (
    Room("side window", "A room of 4 m x 5 m with one window of 2.4 m2 to the south.", (4, 2.7, 5),
         (("south", 1.2, 2.8, 0.9, 2.4),)),
    Room("corner", "A room of 6 m x 6 m with windows to the south and east, tables, and an overhang outside.",
         (6, 3, 6), (("south", 1, 4.5, 0.9, 2.5), ("east", 2, 4.5, 0.9, 2.5)),
         (((1, 0.7, 1.2), (2.6, 0.73, 2), 0.4), ((3.4, 0.7, 3.4), (5, 0.73, 4.2), 0.4),
          ((0.5, 2.8, 6.05), (5, 2.9, 7.0), 0.6), ((-12, -0.4, -12), (18, -0.3, 18), 0.2))),
    Room("deep", "A room 9 m deep with a band of windows to the north, and a building opposite.", (5, 2.8, 9),
         (("north", 0.4, 4.6, 1.0, 2.5),),
         (((-6, -0.3, -16), (11, 6, -14), 0.4), ((-20, -0.4, -20), (25, -0.3, 20), 0.2))),
    Room("office", "An office of 24 m x 12 m with windows along two sides, 36 desks with screens, cupboards, piers "
         "and overhangs: 1,012 points.", (24, 3, 12), OFFICE_WINDOWS, OFFICE_BOXES, spacing=0.5),
)


def wall_with_holes(width, height, holes):
    """Rectangles (x0, x1, y0, y1) of a wall around holes side by side, one after the other along x."""
    parts, at = [], 0.0
    for left, right, sill, head in sorted(holes):
        parts += [(at, left, 0, height), (left, right, 0, sill), (left, right, head, height)]
        at = right
    return parts + [(at, width, 0, height)]


def quads(room):
    """(corners, reflectance) of all surfaces."""
    x, y, z = room.size
    floor, walls, ceiling = room.reflectance
    found = [([(0, 0, 0), (0, 0, z), (x, 0, z), (x, 0, 0)], floor),
             ([(0, y, 0), (x, y, 0), (x, y, z), (0, y, z)], ceiling)]
    sides = {"south": (x, lambda a, b: (a, b, z)), "north": (x, lambda a, b: (a, b, 0)),
             "east": (z, lambda a, b: (x, b, a)), "west": (z, lambda a, b: (0, b, a))}
    for side, (width, place) in sides.items():
        holes = [window[1:] for window in room.windows if window[0] == side]
        for x0, x1, y0, y1 in wall_with_holes(width, y, holes):
            found.append(([place(x0, y0), place(x1, y0), place(x1, y1), place(x0, y1)], walls))
    for low, high, reflectance in room.boxes:
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for end in (low, high):
                corners = []
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = [0.0] * 3
                    corner[axis], corner[u], corner[v] = end[axis], (low, high)[a][u], (low, high)[b][v]
                    corners.append(tuple(corner))
                found.append((corners, reflectance))
    return found


def sensors(room):
    """Points 0.85 m above the floor, half a metre and more from the walls."""
    x, _, z = room.size
    steps = [max(1, round((side - 1) / room.spacing)) for side in (x, z)]
    return [(0.5 + (i + 0.5) * (x - 1) / steps[0], 0.85, 0.5 + (j + 0.5) * (z - 1) / steps[1])
            for j in range(steps[1]) for i in range(steps[0])]


def write_obj(room, folder):
    names = {r: f"matte_{round(100 * r)}" for _, r in quads(room)}
    (folder / "room.mtl").write_text("".join(f"newmtl {name}\nKd {r} {r} {r}\n" for r, name in names.items()))
    lines, count = ["mtllib room.mtl"], 0
    for corners, reflectance in quads(room):
        lines += [f"v {a:g} {b:g} {c:g}" for a, b, c in corners]
        lines += [f"usemtl {names[reflectance]}", "f " + " ".join(str(count + i) for i in range(1, 5))]
        count += 4
    (folder / "room.obj").write_text("\n".join(lines) + "\n")
    (folder / "room.pts").write_text("".join(f"{x} {y} {z} 0 1 0\n" for x, y, z in sensors(room)))


def write_radiance(room, folder):
    """The same with z up and y to the north."""
    text = ""
    for reflectance in {r for _, r in quads(room)}:
        text += f"void plastic m{round(100 * reflectance)}\n0\n0\n5 {reflectance} {reflectance} {reflectance} 0 0\n"
    for i, (corners, reflectance) in enumerate(quads(room)):
        numbers = " ".join(f"{x:g} {-z:g} {y:g}" for x, y, z in corners)
        text += f"m{round(100 * reflectance)} polygon p{i}\n0\n0\n12 {numbers}\n"
    (folder / "room.rad").write_text(text)
    (folder / "radiance.pts").write_text("".join(f"{x} {-z} {y} 0 0 1\n" for x, y, z in sensors(room)))
    (folder / "sky.rad").write_text(
        "#@rfluxmtx u=+Y h=u\nvoid glow ground_glow\n0\n0\n4 1 1 1 0\nground_glow source ground\n0\n0\n"
        "4 0 0 -1 180\n#@rfluxmtx u=+Y h=r2\nvoid glow sky_glow\n0\n0\n4 1 1 1 0\nsky_glow source sky\n0\n0\n"
        "4 0 0 1 180\n")


def figures(lux):
    """Annual means and DA of the sensors from lux of shape (sensors, hours), and sDA."""
    occupied = np.array([8 < hour % 24 + 0.5 < 18 for hour in range(HOURS)])
    autonomy = (lux[:, occupied] >= 300).mean(axis=1)
    return {"mean": float(lux.mean()), "points": lux.mean(axis=1), "autonomy": autonomy,
            "sDA": float((autonomy >= 0.5).mean()), "DA": float(autonomy.mean())}


def by_radiance(given, room, folder, weather):
    count = len(sensors(room))
    quick = ["-ab", "3", "-ad", "256", "-lw", "1e-3"] if given.quick else RADIANCE
    os.environ["PATH"] = f"{given.radiance}:{os.environ['PATH']}"
    os.environ["RAYPATH"] = f".:{given.radiance.parent / 'lib'}"
    steps = {
        "rfluxmtx": f"rfluxmtx -v- -n 1 -I+ -y {count} -faf {' '.join(quick)} - sky.rad room.rad "
                    "< radiance.pts > dc.mtx",
        "gendaymtx": f"gendaymtx -m 2 -c 1 1 1 -of {weather} > sky.mtx",
        "dctimestep": "dctimestep -of dc.mtx sky.mtx > lux.mtx"}
    seconds = {name: timed(["bash", "-c", f"cd {folder} && {command}"])[1] for name, command in steps.items()}
    content = (folder / "lux.mtx").read_bytes()
    values = np.frombuffer(content[content.index(b"\n\n") + 2:], dtype=np.float32)
    return values.reshape(count, HOURS, 3) @ RGB_TO_LUX, seconds


def radiance_runs(given, room, folder, weather):
    """Lux of the mean of all runs, the relative standard error of its annual means by point, and seconds of a run."""
    points = np.array((folder / "radiance.pts").read_text().splitlines())
    runs, seconds = [], []
    for run in range(1 if given.quick else RUNS):
        order = np.random.default_rng(run).permutation(len(points)) if run else np.arange(len(points))
        (folder / "radiance.pts").write_text("\n".join(points[order]) + "\n")
        lux, steps = by_radiance(given, room, folder, weather)
        runs.append(lux[np.argsort(order)])
        seconds.append(steps)
    annual = np.array([lux.mean(axis=1) for lux in runs])
    error = annual.std(axis=0, ddof=1) / np.sqrt(len(runs)) if len(runs) > 1 else np.zeros(len(points))
    return (np.mean(runs, axis=0), error / annual.mean(axis=0),
            {step: float(np.mean([each[step] for each in seconds])) for step in seconds[0]})


def by_photile(given, folder, weather):
    options = ["--photons", "20k", "--rays", "64"] if given.quick else []
    _, seconds, _ = timed([given.photile, "daylight", folder / "room.obj", "--weather", weather,
                           "--points", folder / "room.pts", "--suns", "patches", "--honeybee", folder / "bee",
                           "-o", folder / "room.csv", "--quiet", *options])
    up = [int(float(hour)) for hour in (folder / "bee/sun-up-hours.txt").read_text().split()]
    lux = np.zeros((len((folder / "room.pts").read_text().splitlines()), HOURS))
    lux[:, up] = np.loadtxt(folder / "bee/room.ill", ndmin=2)
    with open(folder / "room.csv", encoding="utf-8") as table:
        stated = np.array([float(row["relative_error"]) for row in csv.DictReader(table)])
    return figures(lux), seconds, stated


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def measure(given, room, folder):
    write_obj(room, folder)
    write_radiance(room, folder)
    weather = folder / "year.epw"
    weather.write_text(weather_text(52.5, 13.4, 1, 1))
    own, own_seconds, stated = by_photile(given, folder, weather)
    lux, other_error, seconds = radiance_runs(given, room, folder, weather)
    other = figures(lux)
    ratios = own["points"] / other["points"]
    return {"room": room.name, "points": len(ratios), "sDA": [own["sDA"], other["sDA"]],
            "DA": [own["DA"], other["DA"]], "mean": [own["mean"], other["mean"]],
            "rms of points": rms(ratios - 1), "stated error": rms(stated), "Radiance's error": rms(other_error),
            "seconds": [own_seconds, sum(seconds.values())], "radiance": seconds}


def section(results):
    lines = ["| room | points | sDA 300/50% | mean DA | annual mean, lux | rms of the points | photile's and "
             "Radiance's errors, together | processor seconds |", "|---|--:|--:|--:|--:|--:|--:|--:|"]
    for row in results:
        errors = ("stated error", "Radiance's error")
        own, other = zip(row["sDA"], row["DA"], row["mean"], row["seconds"])
        lines.append(
            f"| {row['room']} | {row['points']} | {own[0]:.1%} / {other[0]:.1%} | {own[1]:.1%} / {other[1]:.1%} "
            f"| {own[2]:.1f} / {other[2]:.1f} ({own[2] / other[2] - 1:+.1%}) | {row['rms of points']:.1%} "
            f"| {row['stated error']:.1%}, {row[errors[1]]:.1%}: {math.hypot(*(row[error] for error in errors)):.1%} "
            f"| {own[3]:.1f} / {other[3]:.1f} ({other[3] / own[3]:.1f}x) |")
    lines += ["", "First photile, then Radiance (" + " ".join(RADIANCE) + "); the rms is that of the annual means of "
              f"the points, photile's over the mean of {RUNS} runs of Radiance. Errors are the rms of those that photile states, "
              "and of Radiance's by the scatter of its runs; seconds are those of one run.", ""]
    return "\n".join(lines + [f"- **{room.name}**: {room.caption}" for room in ROOMS])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--radiance", type=pathlib.Path, required=True)
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--only", choices=[room.name for room in ROOMS])
    parser.add_argument("--quick", action="store_true", help="few rays, writes nothing: a smoke test")
    given = parser.parse_args()
    record = ROOT / "docs/measured/daylight.json"
    results = {row["room"]: row for row in json.loads(record.read_text())} if record.is_file() else {}
    for room in ROOMS:
        if given.only not in (None, room.name):
            continue
        with tempfile.TemporaryDirectory() as name:
            results[room.name] = measure(given, room, pathlib.Path(name))
        print(json.dumps(results[room.name]))
    if given.quick:
        return
    rows = [results[room.name] for room in ROOMS if room.name in results]
    record.write_text(json.dumps(rows, indent=1) + "\n")
    replace_section(ROOT / "docs/measured/daylight.md", "lighting/daylight.py", section(rows),
                    partly=given.only is not None)


if __name__ == "__main__":
    main()
