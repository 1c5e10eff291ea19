#!/usr/bin/python3
"""Times buildings from their file to a report, by the commands of the guide alone; writes docs/measured/buildings.md.

    bench/lighting/buildings.py [--photile COMMAND] [--write] NAME=FILE...

FILE is an IFC file or a model of Honeybee, which `photile import` reads: it prints the command that measures. Of
another scene all rooms that are found are measured under an overcast sky. VIRTUAL_ENV names the environment that has
ifcopenshell and honeybee-radiance.
"""

import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

IMPORTED = {".ifc", ".hbjson"}


def run(photile, *words, folder):
    """What it prints, and the seconds that it takes."""
    start = time.monotonic()
    done = subprocess.run([photile, *words], cwd=folder, text=True, capture_output=True)
    if done.returncode:
        sys.exit(f"buildings.py: error: photile {shlex.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout, time.monotonic() - start


def row(name, file, photile, folder):
    scene, import_seconds = file, None
    words = ["measure", file, "--plane", "floor+0.75", "--rooms", "*", "--sky", "overcast=10000"]
    if file.suffix.lower() in IMPORTED:
        scene = folder / "building.glb"
        printed, import_seconds = run(photile, "import", file, "-o", scene, folder=folder)
        words = shlex.split(printed.splitlines()[0])[1:]
    printed, seconds = run(photile, *words, "-o", folder / "report.html", "-o", folder / "report.json", folder=folder)
    grids = json.loads((folder / "report.json").read_text())["grids"]
    facts = json.loads(run(photile, "info", scene, "--json", "--sky", "overcast=1", folder=folder)[0])
    area = sum(room["area"] for room in facts["rooms"])
    kind = file.suffix.lower()[1:] + (", rooms found" if import_seconds is None else "")
    taken = "" if import_seconds is None else f"{import_seconds:.0f} s"
    return (f"| {name} | {kind} | {facts['triangles']:,} | {len(facts['rooms'])} | {area:.0f} m2 | "
            f"{sum(grid['points'] for grid in grids):,} | {taken} | {seconds:.0f} s |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("buildings", metavar="NAME=FILE", nargs="+")
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--write", action="store_true", help="write the table into docs/measured/buildings.md")
    options = parser.parse_args()
    lines = ["| building | file | triangles | rooms | floor area | points | import | measure and report |",
             "|---|---|--:|--:|--:|--:|--:|--:|"]
    for building in options.buildings:
        if not (match := re.fullmatch(r"(.+?)=(.+)", building)):
            parser.error(f"{building}: give NAME=FILE")
        with tempfile.TemporaryDirectory() as folder:
            lines.append(row(match[1], pathlib.Path(match[2]).resolve(), options.photile.resolve(), pathlib.Path(folder)))
        print(lines[-1], flush=True)
    if options.write:
        replace_section(ROOT / "docs/measured/buildings.md", "lighting/buildings.py", "\n".join(lines))


if __name__ == "__main__":
    main()
