#!/usr/bin/python3
"""Has Honeybee read a year of photile's, with blinds, and compares the figures; writes docs/measured/daylight.md.

    bench/lighting/honeybee.py --tools FOLDER [--photile COMMAND] [--quick]

FOLDER holds honeybee-radiance-postprocess, of the Python package of that name. The room is `corner` of
bench/lighting/daylight.py; its blinds leave the lowest fifth of the windows open.
"""

import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lighting.daylight import ROOMS, ROOT, write_obj
from tools.report_section import replace_section
from lighting.weather_year import weather_text


def closed(room):
    return dataclasses.replace(room, windows=tuple(
        (side, left, right, sill, sill + 0.2 * (head - sill)) for side, left, right, sill, head in room.windows))


def numbers(folder):
    files = sorted(path for path in folder.rglob("room.*"))
    return [float(word) for word in files[0].read_text().split()]


def mean(values):
    return sum(values) / len(values)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tools", type=pathlib.Path, required=True)
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--quick", action="store_true", help="writes nothing")
    given = parser.parse_args()
    room = next(room for room in ROOMS if room.name == "corner")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene, which in (("open", room), ("closed", closed(room))):
            (folder / scene).mkdir()
            write_obj(which, folder / scene)
        (folder / "year.epw").write_text(weather_text(52.5, 13.4, 1, 1))
        (folder / "hours.csv").write_text("".join(f"{int(8 <= hour % 24 < 18)}\n" for hour in range(8760)))
        subprocess.run([given.photile, "daylight", folder / "open/room.obj", "--blinds", folder / "closed/room.obj",
                        "--weather", folder / "year.epw", "--points", folder / "open/room.pts", "--honeybee",
                        folder / "bee", "-o", folder / "room.json", "--quiet"], check=True, stdout=subprocess.PIPE)
        stated = json.loads((folder / "room.json").read_text())[0]

        def honeybee(command, *options):
            target = folder / command / str(len(options))
            subprocess.run([given.tools / "honeybee-radiance-postprocess", "post-process", command, folder / "bee",
                            "--schedule", folder / "hours.csv", "--sub-folder", target, *options],
                           check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            return target

        states = ["--states", folder / "bee/states_schedule.json"]
        by_schedule, without = honeybee("annual-daylight", *states), honeybee("annual-daylight")
        sun = honeybee("annual-sunlight-exposure")
        rows = []
        for label, target, own in (("by schedule", by_schedule, stated), ("open", without, stated["blinds"]["states"][0])):
            da = numbers(target / "da")
            rows += [(f"mean DA, {label}", mean(da), 100 * own["DA"]),
                     (f"sDA, {label}", 100 * mean([value >= 50 for value in da]), 100 * own["sDA"]),
                     (f"UDI 100 to 3,000 lux, {label}", mean(numbers(target / "udi")),
                      100 * (own["UDI"]["100 to 300"] + own["UDI"]["300 to 3000"]))]
        above = numbers(sun / "hours_above")
        rows.append(("ASE, open", 100 * mean([hours > 250 for hours in above]), 100 * stated["ASE"]))
    lines = ["| per cent | Honeybee | photile |", "|---|--:|--:|"]
    lines += [f"| {label} | {theirs:.2f} | {own:.2f} |" for label, theirs, own in rows]
    print("\n".join(lines))
    if not given.quick:
        replace_section(ROOT / "docs/measured/daylight.md", "lighting/honeybee.py", "\n".join(lines))


if __name__ == "__main__":
    main()
