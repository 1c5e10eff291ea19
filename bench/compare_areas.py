#!/usr/bin/python3
"""Compares whole and clipped discs: error against path-traced references and time of the estimate.

    bench/compare_areas.py [SCENES] [--runs N]

SCENES is the folder that holds kitchen/, classroom/ and references/. Prints a Markdown table. Needs
the built command and the Debian packages python3-numpy and python3-openimageio.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

import scene_arguments

try:
    import picture_error
except ImportError as missing:
    sys.exit(f"compare_areas.py: error: {missing}; install the Debian packages python3-numpy and "
             "python3-openimageio, and run it with /usr/bin/python3")

SIZE = "512x384"
AREAS = ("disc", "clipped")


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=3,
                        help="of each area in turn; the fastest counts; default: %(default)s")
    return parser.parse_args()


def render(photile, scene, area, picture):
    """Renders a scene; returns the seconds of the estimate kernel."""
    run = subprocess.run([photile, "render", scene, "--size", SIZE, "--area", area, "-o", picture,
                          "--profile"], check=True, text=True, capture_output=True)
    table = run.stdout + run.stderr
    return float(re.search(r"^estimate\s+\d+\s+([\d.]+)", table, re.MULTILINE).group(1))


def main():
    given = arguments()
    print("| scene | area | mean ratio | relMSE | without the worst 5% | kernel seconds |")
    print("|---|---|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("classroom", "kitchen"):
            reference = given.scenes / "references" / f"{name}-diffuse-{SIZE}.exr"
            scene = given.scenes / name / f"{name}-diffuse.gltf"
            seconds = {area: [] for area in AREAS}
            for _ in range(given.runs):
                for area in AREAS:  # in turn, so that both see the same load
                    picture = pathlib.Path(folder) / f"{area}.exr"
                    seconds[area].append(render(given.photile, scene, area, picture))
            for area in AREAS:
                error = picture_error.measure(
                    picture_error.read_picture(pathlib.Path(folder) / f"{area}.exr"),
                    picture_error.read_picture(reference))
                print(f"| {name} | {area} | {error['mean_ratio']:.3f} | {error['rel_mse']:.4f} "
                      f"| {error['rel_mse_without_worst']:.4f} | {min(seconds[area]):.3f} |")


if __name__ == "__main__":
    main()
