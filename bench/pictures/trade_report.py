#!/usr/bin/python3
"""Measures the trade of three views and writes the tables of docs/trade.md and docs/trade/*.svg.

    bench/pictures/trade_report.py [SCENES] [--redraw] [--only VIEW]...

SCENES is a folder with classroom/classroom-diffuse.gltf and references/; without it, only the
bundled scenes are measured. Needs the built command.
"""

import json
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import scene_arguments
from pictures import trade_plot
from tools.report_section import read_section, replace_section

PAGE = ROOT / "docs/trade.md"
REQUESTED = (0.10, 0.05, 0.02, 0.01)


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--redraw", action="store_true", help="use the results in out/trade")
    parser.add_argument("--only", action="append", metavar="VIEW",
                        help="measure this alone, the page keeps the others; repeatable")
    return parser.parse_args()


def subjects(scenes):
    """Name, scene file and further options of each view."""
    views = [("cornell-box", ROOT / "scenes/cornell-box/cornell-box.obj", []),
             ("living-room", ROOT / "scenes/living-room/living-room.gltf", ["--set", "quota=power"])]
    classroom = pathlib.Path(scenes) / "classroom/classroom-diffuse.gltf"
    if classroom.is_file():
        reference = pathlib.Path(scenes) / "references/classroom-diffuse-512x384.exr"
        views.append(("classroom", classroom, ["--set", "quota=power", "--size", "512x384",
                                               "--reference", str(reference)]))
    return views


def row(label, point):
    memory = (point["host_bytes"] + point["device_bytes"]) / 1e6
    return (f"| {label} | {point['first_picture_seconds']:.2f} s "
            f"| {1e3 * point['frame_seconds']:.0f} ms | {memory:.0f} MB | `{point['options']}` |")


def table(record):
    points = record["renderings"]
    lines = ["| error | first picture | each frame | memory | fastest settings |",
             "|--:|--:|--:|--:|---|"]
    for requested in REQUESTED:
        within = [p for p in points if p["relative_error"] <= requested]
        label = f"{100 * requested:.0f}%"
        if within:
            lines.append(row(label, min(within, key=lambda p: p["first_picture_seconds"])))
        else:
            lines.append(f"| {label} | - | - | - | none of those tried |")
    best = min(points, key=lambda p: p["relative_error"])
    lines.append(row(f"{100 * best['relative_error']:.1f}% (least)", best))
    return "\n".join(lines)


def ways_of_light(record):
    """What photons, rays to lamps and nodes that gather give."""
    lines = ["| settings | error | worst region | mean ratio | first picture | each frame |",
             "|---|--:|--:|--:|--:|--:|"]
    for point in record["renderings"]:
        if point["varied"] in ("nothing", "direct_rays", "work of good"):
            lines.append(f"| `{point['options']}` | {100 * point['relative_error']:.1f}% "
                         f"| {100 * point['worst_region']:.1f}% | {point['mean_ratio']:.3f} "
                         f"| {point['first_picture_seconds']:.2f} s "
                         f"| {1e3 * point['frame_seconds']:.0f} ms |")
    return "\n".join(lines)


def machine(record):
    return (f"{os.cpu_count()} cores, {record['devices'][0]}; load average at the end "
            f"{os.getloadavg()[0]:.1f}.")


def section(name, record, measured_on):
    size = f"{record['width']}x{record['height']}"
    noise = ""
    if "reference_relative_mse" in record:
        own = math.sqrt(record["reference_relative_mse"])
        noise = (f" The reference has {record['reference_samples']} paths a pixel and itself an "
                 f"error of {100 * own:.1f}%, which is in all figures.")
    return (f"### {name}\n\n{size} pixels.{noise}\n\n![Error against time](trade/{name}.svg)\n\n"
            f"{table(record)}\n\nLight by photons alone, lamps by rays, and gathering at nodes:\n\n"
            f"{ways_of_light(record)}\n\n{measured_on}\n\n")


def sections_by_name(text):
    """Those that a page has, by the name of the view."""
    parts = text.split("### ")[1:]
    return {part.split("\n", 1)[0]: "### " + part.rstrip() + "\n\n" for part in parts}


def main():
    options = arguments()
    if not options.redraw and not options.photile.is_file():
        sys.exit(f"trade_report.py: error: {options.photile} is missing; "
                 "build it with cmake/build.sh")
    folder = ROOT / "docs/trade"
    folder.mkdir(exist_ok=True)
    texts = sections_by_name(read_section(PAGE, "pictures/trade_report.py"))
    for name, scene, more in subjects(options.scenes):
        if options.only and name not in options.only:
            continue
        out = ROOT / "out/trade" / name
        if not options.redraw:
            subprocess.run([options.photile, "trade", scene, "-o", out, *more], check=True)
        record = json.loads((out / "trade.json").read_text())
        trade_plot.draw(record, folder / f"{name}.svg")
        measured_on = texts[name].rstrip().splitlines()[-1] if options.redraw else machine(record)
        texts[name] = section(name, record, measured_on)
    replace_section(PAGE, "pictures/trade_report.py", "".join(texts.values()).rstrip() + "\n")


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"trade_report.py: error: {error}")
