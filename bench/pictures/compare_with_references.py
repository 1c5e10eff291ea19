#!/usr/bin/python3
"""Renders two interiors, compares them with path-traced references and writes docs/references.md.

    bench/pictures/compare_with_references.py [SCENES] [--redraw]

SCENES is the folder that holds kitchen/, classroom/ and references/. Needs the built command and
the Debian packages python3-numpy and python3-openimageio.
"""

import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments
from tools.processes import processor_seconds

packages.require("numpy", "OpenImageIO")

from tools import picture_error

SCENES = ("kitchen", "classroom")
SIZE = "512x384"
SETTINGS = ("--photons", "1M", "--neighbours", "50", "--set", "quota=power", "--samples", "16",
            "--set", "light_maps=off")


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--redraw", action="store_true",
                        help="use the pictures in out/references instead of rendering")
    return parser.parse_args()


def render(photile, scene, picture, stats):
    """Renders a scene. Adds the processor seconds of all threads to the statistics."""
    before = processor_seconds()
    subprocess.run([photile, "render", scene, "--size", SIZE, *SETTINGS,
                    "-o", picture, "--stats", stats], check=True)
    record = json.loads(stats.read_text())
    record["processor_seconds"] = processor_seconds() - before
    record["load_average"] = os.getloadavg()[0]
    stats.write_text(json.dumps(record, indent=1))


def machine(record):
    """The machine in words: cores, processor, OpenCL platform."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    fields = {line.split(":")[0].strip(): line.partition(":")[2].strip() for line in lines}
    vectors = " with AVX-512" if "avx512f" in fields.get("flags", "").split() else ""
    device = record["devices"][0]
    platform = device["platform"].replace("Portable Computing Language", "PoCL")
    return (f"{os.cpu_count()} cores, {fields.get('model name', 'unknown processor')}{vectors}, "
            f"{platform} {device['driver_version']}")


def megabytes(count):
    return f"{count / 1e6:.1f}" if count else "-"


def stage_table(record):
    rows = ["| stage | seconds | host MB | device MB |", "|---|--:|--:|--:|"]
    for stage in record["stages"]:
        rows.append(f"| {stage['stage']} | {stage['seconds']:.2f} "
                    f"| {megabytes(stage['host_bytes'])} | {megabytes(stage['device_bytes'])} |")
    rows.append(f"| **whole process** | **{record['total_seconds']:.2f}** "
                f"| **{megabytes(record['peak_host_bytes'])}** (peak) | |")
    return "\n".join(rows)


def section(name, record, figures):
    """One interior: pictures, then time and memory by stage."""
    parameters = record["parameters"]
    return f"""## {name.capitalize()}

| photile | path-traced reference | relative error |
|---|---|---|
| ![photile](pictures/{name}-photile.png) | ![reference](pictures/{name}-reference.png) | \
![error](pictures/{name}-error.png) |

{parameters['photons_emitted']:,} photon paths left {record['photons_stored']:,} photons; \
R = {parameters['radius']:.3f} m.
{100 * figures['lamp_fraction']:.1f}% of the pixels see a lamp and \
are left out of the figures.

{stage_table(record)}

Processor seconds of all threads together: {record['processor_seconds']:.0f}.
"""


def page(records, figures):
    first = records[SCENES[0]]
    load = max(record["load_average"] for record in records.values())
    busy = (f" Other programs were running (load\naverage {load:.0f}), so the seconds by stage are "
            "longer than on an idle machine; the processor seconds\nare less so."
            if load > 1.5 * os.cpu_count() else "")
    rows = "\n".join(
        f"| {name} | {figures[name]['mean_ratio']:.3f} | {figures[name]['rel_mse']:.3f} "
        f"| {figures[name]['rel_mse_without_worst']:.3f} | {records[name]['total_seconds']:.0f} |"
        for name in SCENES)
    sections = "\n".join(section(name, records[name], figures[name]) for name in SCENES)
    return f"""# Beside path-traced references

After this page you can judge photile's pictures beside those of an independent path tracer: two interiors with all
surfaces diffuse, their errors, time and memory. `bench/pictures/compare_with_references.py` writes this page.

| interior | mean ratio | relMSE | relMSE without the worst 5% of pixels | seconds |
|---|--:|--:|--:|--:|
{rows}

- **Mean ratio**: mean of photile's picture over that of the reference; 1 is right.
- **relMSE**: mean over pixels and channels of (a - b)^2 / (b^2 + 0.01 mean(b)^2), with a photile's
  picture and b the reference. Pixels that see a lamp (more than {picture_error.LAMP_LEVEL} times \
the median) are left out.
  About 0.004 of it is the noise of the references.

What is left is the noise of k = 50, and light that falls through gaps onto what lies behind them; see
[density](density.md).

**Settings**: `--size {WIDTH}x{HEIGHT} {' '.join(SETTINGS)}`: an estimate at
each hit, not the default, whose errors are in [quality](quality.md).

**Machine**: {machine(first)}.{busy}

The pictures of an interior have one exposure: the mean of the reference is mid grey, white clips.
The error is (a - b) / sqrt(b^2 + 0.01 mean(b)^2) of the luminance; its colours mean

![blue is -100%, white 0, red +100%](pictures/relative-error-scale.png)

-100% or less (blue: photile is too dark), 0 (white), +100% or more (red: too bright).

{sections}
## Scenes

Kitchen (82,742 triangles with area) and classroom (111,164) are LuxCore's test scenes, converted to
glTF; they are not part of this repository. The references have 2,048 samples a pixel.

## See also

[Neighbour groups](neighbour-groups.md), [the command line](command-line.md).
"""


def draw(name, picture, reference, folder):
    """Writes the three pictures of an interior."""
    factor = picture_error.exposure(reference)
    error = picture_error.relative_error(picture, reference)
    for kind, colours in (("photile", picture_error.displayed(picture, factor)),
                          ("reference", picture_error.displayed(reference, factor)),
                          ("error", picture_error.false_colour(error))):
        picture_error.write_png(folder / f"{name}-{kind}.png", colours)


def main():
    options = arguments()
    for path in [path for name in SCENES for path in scene_arguments.interior(options.scenes, name, SIZE)]:
        if not path.is_file():
            sys.exit(f"compare_with_references.py: error: {path} is missing; "
                     "name the folder of the scenes as argument or in PHOTILE_SHARED_SCENES")
    if not options.photile.is_file():
        sys.exit(f"compare_with_references.py: error: {options.photile} is missing; "
                 "build it with cmake/build.sh")
    out, pictures = ROOT / "out/references", ROOT / "docs/pictures"
    out.mkdir(parents=True, exist_ok=True)
    pictures.mkdir(parents=True, exist_ok=True)
    records, figures = {}, {}
    for name in SCENES:
        scene, reference_path = scene_arguments.interior(options.scenes, name, SIZE)
        picture_path, stats = out / f"{name}.exr", out / f"{name}.json"
        if not options.redraw:
            render(options.photile, scene, picture_path, stats)
        records[name] = json.loads(stats.read_text())
        picture = picture_error.read_picture(picture_path)
        reference = picture_error.read_picture(reference_path)
        figures[name] = picture_error.measure(picture, reference)
        draw(name, picture, reference, pictures)
        print(name, " ".join(f"{key}={value:.4f}" for key, value in figures[name].items()))
    picture_error.write_png(pictures / "relative-error-scale.png", picture_error.colour_scale())
    (ROOT / "docs/references.md").write_text(page(records, figures))


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"compare_with_references.py: error: {error}")
