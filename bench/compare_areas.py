#!/usr/bin/python3
"""Compares areas and kernels of the density estimate: error against path-traced references and time,
for the tables of docs/density.md.

    bench/compare_areas.py [SCENES] [--runs N]

SCENES is the folder that holds kitchen/, classroom/ and references/. Needs the built command and the
Debian packages python3-numpy and python3-openimageio.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

import scene_arguments
from report_section import replace_section

try:
    import picture_error
except ImportError as missing:
    sys.exit(f"compare_areas.py: error: {missing}; install the Debian packages python3-numpy and "
             "python3-openimageio, and run it with /usr/bin/python3")

SIZE = "512x384"
# Area, kernel and k; the last two k have the noise of 50 with the constant kernel.
CASES = (("disc", "constant", 50), ("clipped", "constant", 50), ("clipped", "cone", 50),
         ("clipped", "epanechnikov", 50), ("clipped", "cone", 75), ("clipped", "epanechnikov", 67))


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=3,
                        help="of each case in turn; the fastest counts; default: %(default)s")
    return parser.parse_args()


def render(photile, scene, case, picture):
    """Renders a scene; returns the seconds of the estimate kernel."""
    area, kernel, k = case
    run = subprocess.run([photile, "render", scene, "--size", SIZE, "--area", area, "--kernel", kernel,
                          "-k", str(k), "-o", picture, "--profile"],
                         check=True, text=True, capture_output=True)
    table = run.stdout + run.stderr
    return float(re.search(r"^estimate\s+\d+\s+([\d.]+)", table, re.MULTILINE).group(1))


def rows(given, name, folder):
    """The rows of one scene."""
    scene = given.scenes / name / f"{name}-diffuse.gltf"
    reference = picture_error.read_picture(
        given.scenes / "references" / f"{name}-diffuse-{SIZE}.exr")
    seconds = {case: [] for case in CASES}
    pictures = {case: pathlib.Path(folder) / f"{case[0]}-{case[1]}-{case[2]}.exr" for case in CASES}
    for _ in range(given.runs):
        for case in CASES:  # in turn, so that all see the same load
            seconds[case].append(render(given.photile, scene, case, pictures[case]))
    text = ""
    for case in CASES:
        error = picture_error.measure(picture_error.read_picture(pictures[case]), reference)
        text += (f"| {name} | {case[0]} | {case[1]} | {case[2]} | {error['mean_ratio']:.3f} "
                 f"| {error['rel_mse']:.4f} | {error['rel_mse_without_worst']:.4f} "
                 f"| {min(seconds[case]) / min(seconds[CASES[0]]):.2f} |\n")
    return text


def main():
    given = arguments()
    text = ("| scene | area | kernel | k | mean ratio | relMSE | without the worst 5% | time |\n"
            "|---|---|---|--:|--:|--:|--:|--:|\n")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("classroom", "kitchen"):
            text += rows(given, name, folder)
    text += (f"\nTime: of the estimate's kernels over those of the first row, the fastest of {given.runs} "
             f"in turn; {os.cpu_count()} cores, load average {os.getloadavg()[0]:.0f} at the end.\n")
    print(text)
    replace_section(scene_arguments.ROOT / "docs/density.md", "compare_areas.py", text)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"compare_areas.py: error: {error}")
