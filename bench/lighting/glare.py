#!/usr/bin/python3
"""Holds `photile glare` against evalglare on the same fisheye pictures, and UGR tables against
another program's; puts the tables into docs/measured/glare.md.

    bench/lighting/glare.py [--photile FILE] [--evalglare FILE] [--write]

evalglare is Radiance's: `pip install pyradiance` brings it (in the package's folder bin). The tables
of luminaires are compared where the Python package eulumdat-ugr is installed.
"""

import argparse
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

PAGE = ROOT / "docs/measured/glare.md"
LIVING = ROOT / "scenes/living-room/living-room.gltf"

# What is looked at: name, scene, eyes and directions, options.
VIEWS = (
    ("living room, towards the window", LIVING, "3 1.2 3.5 0 0 -1", ()),
    ("living room, along the window", LIVING, "1 1.2 2.2 1 0 0", ()),
    ("evening, panel of 6,400 lm", LIVING, "1.2 1.2 1.6 1 0.1 0",
     ("--light", "daylight=off", "--light", "ceiling_panel=6400")),
    ("evening, panel of 20,000 lm, looking up", LIVING, "4.1 1.2 4 0 0.25 -1",
     ("--light", "daylight=off", "--light", "ceiling_panel=20000")),
)
SETTINGS = ("--samples", "16", "--photons", "1M", "--picture-size", "800", "--rays", "4096")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photile", default=ROOT / "build/release/photile", type=pathlib.Path)
    parser.add_argument("--evalglare", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="put the tables into docs/measured/glare.md")
    return parser.parse_args()


def evalglare_of(options):
    if options.evalglare:
        return options.evalglare
    found = shutil.which("evalglare")
    if found:
        return pathlib.Path(found)
    try:
        import pyradiance
    except ImportError:
        sys.exit("glare.py: error: no evalglare; pip install pyradiance, or give --evalglare FILE")
    return pathlib.Path(pyradiance.__file__).parent / "bin/evalglare"


def run(*command):
    done = subprocess.run([str(each) for each in command], text=True, capture_output=True, check=False)
    if done.returncode != 0:
        sys.exit(f"glare.py: error: {' '.join(str(each) for each in command)}: {done.stderr.strip()}")
    return done.stdout


def evalglare_figures(program, picture):
    """The last line of -d: dgp,av_lum,E_v,lum_backg,E_v_dir,dgi,ugr,... : figures."""
    for line in reversed(run(program, "-d", picture).splitlines()):
        if line.startswith("dgp,") and ":" in line:
            names, values = line.split(":", 1)
            return dict(zip(names.split(","), map(float, values.split())))
    sys.exit(f"glare.py: error: evalglare says nothing of {picture}")


def cell(value, digits):
    return "-" if value is None or not math.isfinite(value) else f"{value:.{digits}f}"


def glare_table(options, evalglare):
    lines = ["| view | | Ev | Lb | sources | DGP | DGI | UGR |", "|---|---|--:|--:|--:|--:|--:|--:|"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for number, (name, scene, eye, more) in enumerate(VIEWS):
            eyes, record = folder / "eyes.pts", folder / "glare.json"
            eyes.write_text(eye + "\n")
            views = folder / f"views{number}"
            run(options.photile, "glare", scene, "--observers", eyes, "-o", record, "--pictures", views,
                "-q", *SETTINGS, *more)
            seen = json.loads(record.read_text())["observers"][0]
            picture = seen["picture"]
            other = evalglare_figures(evalglare, views / "view-0001.hdr")
            ugr = seen["ugr"] and seen["ugr"]["value"]
            lines.append(f"| {name} | evalglare | {cell(other['E_v'], 0)} | {cell(other['lum_backg'], 1)} "
                         f"| | {cell(other['dgp'], 4)} | {cell(other['dgi'], 2)} | {cell(other['ugr'], 2)} |")
            lines.append(f"| | the same picture | {cell(picture['illuminance'], 0)} "
                         f"| {cell(picture['background_luminance'], 1)} | {len(picture['sources'])} "
                         f"| {cell(picture['dgp'], 4)} | {cell(seen['dgi'], 2)} | {cell(picture['ugr'], 2)} |")
            lines.append(f"| | sensor, luminaires | {cell(seen['illuminance']['value'], 0)} "
                         f"| {cell(seen['background_luminance']['value'], 1)} | "
                         f"{len(seen['luminaires'])} | {cell(seen['dgp']['value'], 4)} | | {cell(ugr, 2)} |")
    return lines


def lamp_file(cosine_power, width, length):
    """A EULUMDAT file of a luminaire of 4,000 lm whose intensity is cos^n of gamma, wider across."""
    planes, gammas = range(0, 360, 15), range(0, 181, 5)

    def intensity(c, gamma):
        if gamma >= 90:
            return 0.0
        spread = cosine_power + 1.5 * math.cos(math.radians(c)) ** 2
        return math.cos(math.radians(gamma)) ** spread
    total = 0.0
    for c in planes:
        for gamma in range(90):
            total += (intensity(c, gamma + 0.5) * math.sin(math.radians(gamma + 0.5)) *
                      math.radians(1) * math.radians(15))
    head = ["photile", "1", "4", "24", "15", "37", "5", "", "lamp", "", "lamp.ldt", "",
            str(length), str(width), "50", str(length), str(width), "0", "0", "0", "0",
            "100", "100", "1", "0", "1", "1", "LED", "4000", "4000K", "80", "40"]
    direct = ["0"] * 10
    values = [f"{1000 / total * intensity(c, gamma):.4f}" for c in range(0, 91, 15) for gamma in gammas]
    return "\n".join([*head, *direct, *map(str, planes), *map(str, gammas), *values]) + "\n"


def table_differences(options):
    try:
        from eulumdat_ugr import UgrCalculator
        from pyldt import LdtReader
    except ImportError:
        return ["eulumdat-ugr is not installed: no tables are compared."]
    lines = ["| luminaire of 4,000 lm | 4H x 8H, 70/50/20, crosswise | endwise | difference of all 190 values: mean, largest |",
             "|---|--:|--:|--:|"]
    with tempfile.TemporaryDirectory() as folder:
        for name, power, width, length in (("square, 0.6 x 0.6 m, near lambertian", 1, 600, 600),
                                           ("linear, 0.1 x 1.2 m, near lambertian", 1, 100, 1200),
                                           ("linear, 0.1 x 1.2 m, narrow beam", 4, 100, 1200)):
            file = pathlib.Path(folder) / "lamp.ldt"
            file.write_text(lamp_file(power, width, length))
            record = pathlib.Path(folder) / "table.json"
            run(options.photile, "ies", file, "--ugr-table", "-o", record)
            rooms = json.loads(record.read_text())["rooms"]
            own = [each["crosswise"] + each["endwise"] for each in rooms]
            other = UgrCalculator.compute(LdtReader.read(str(file))).values
            differences = [a - b for mine, theirs in zip(own, other) for a, b in zip(mine, theirs)
                           if a is not None and math.isfinite(b)]
            mean = sum(differences) / len(differences)
            largest = max(differences, key=abs)
            lines.append(f"| {name} | {own[10][0]:.1f} ({other[10][0]:.1f}) | {own[10][5]:.1f} "
                         f"({other[10][5]:.1f}) | {mean:+.2f}, {largest:+.2f} |")
    return lines


def main():
    options = arguments()
    options.photile = options.photile.resolve()
    evalglare = evalglare_of(options)
    told = subprocess.run([evalglare, "-v"], text=True, capture_output=True, check=False)
    version = (told.stdout + told.stderr).strip().splitlines()[0]
    text = [f"{version}. Three rows a view: evalglare on the picture that `photile glare --pictures` wrote, photile on the "
            "same picture, and what `photile glare` prints: illuminance by sensor rays, UGR by luminaires.", "",
            *glare_table(options, evalglare), "",
            "UGR tables beside those of the Python package eulumdat-ugr (in brackets), which interpolates the printed "
            "tables of CIE 117 and CIE 190:", "", *table_differences(options)]
    print("\n".join(text))
    if options.write:
        replace_section(PAGE, "lighting/glare.py", "\n".join(text))


if __name__ == "__main__":
    main()
