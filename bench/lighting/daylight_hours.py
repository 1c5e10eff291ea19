#!/usr/bin/python3
"""Hours of a year beside the same hours with a sun and a sky of their own; writes docs/measured/daylight.md.

    bench/lighting/daylight_hours.py [--photile COMMAND] [--quick]

The rooms are those of daylight.py, without light of the ground. `photile measure` follows paths under the
Perez sky and the sun's disc of an hour, `photile daylight` has found all of the year. Hours with the sun in the
windows are listed: what differs is light of the sun that comes by reflection.
"""

import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lighting.daylight import ROOMS, ROOT, write_obj
from tools.report_section import replace_section
from lighting.weather_year import weather_text

HOURS = ((79, "2026-03-21", 9), (79, "2026-03-21", 12), (171, "2026-06-21", 8), (171, "2026-06-21", 13),
         (354, "2026-12-21", 11), (262, "2026-09-20", 15))
SETTINGS = (("577 patches", ["--patches", "577"]), ("2,305 patches", ["--patches", "2305"]),
            ("577 patches, `--suns patches`", ["--patches", "577", "--suns", "patches"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--quick", action="store_true", help="few rays, writes nothing")
    given = parser.parse_args()
    lines = ["| room | sky | mean of the points, rms over the hours | worst hour | a point, rms |",
             "|---|---|--:|--:|--:|"]
    for room in ROOMS[:2]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_obj(room, folder)
            # Clear all year, so that the sun shines in every hour.
            weather = folder / "year.epw"
            rows = weather_text(52.5, 13.4, 1, 1).splitlines()
            for line, row in enumerate(rows[8:], 8):
                fields = row.split(",")
                fields[14], fields[15] = ("700", "110") if int(fields[15]) > 0 else ("0", "0")
                rows[line] = ",".join(fields)
            weather.write_text("\n".join(rows) + "\n")
            base = [folder / "room.obj", "--points", folder / "room.pts", "--quiet"]
            truth = []
            for _, date, hour in HOURS:
                subprocess.run([given.photile, "measure", *base, "--integrator", "path", "--rays",
                                "64" if given.quick else "2048", "--weather", weather, "--time", f"{date}T{hour:02}:30",
                                "--set", "ground=0", "-o", folder / "hour.csv"], check=True, stdout=subprocess.PIPE)
                with open(folder / "hour.csv") as table:
                    truth.append([float(row["lux"]) for row in csv.DictReader(table)])
            for label, options in SETTINGS:
                bee = folder / label.replace("`", "").replace(",", "").replace(" ", "_")
                subprocess.run([given.photile, "daylight", *base, "--weather", weather, "--set", "ground=0", "--honeybee", bee,
                                "--rays", "64" if given.quick else "4096", *options], check=True, stdout=subprocess.PIPE)
                up = [int(float(hour)) for hour in (bee / "sun-up-hours.txt").read_text().split()]
                year = [[float(word) for word in line.split()] for line in (bee / "room.ill").read_text().splitlines()]
                of_room, of_points = [], []
                for (day, _, hour), exact in zip(HOURS, truth):
                    own = [row[up.index(24 * day + hour)] for row in year]
                    of_room.append(sum(own) / sum(exact) - 1)
                    of_points += [a / b - 1 for a, b in zip(own, exact)]
                rms = [(sum(x * x for x in xs) / len(xs)) ** 0.5 for xs in (of_room, of_points)]
                worst = max(of_room, key=abs)
                lines.append(f"| {room.name} | {label} | {rms[0]:.1%} | {worst:+.1%} | {rms[1]:.1%} |")
    print("\n".join(lines))
    if not given.quick:
        replace_section(ROOT / "docs/measured/daylight.md", "lighting/daylight_hours.py", "\n".join(lines))


if __name__ == "__main__":
    main()
