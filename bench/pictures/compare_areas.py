#!/usr/bin/python3
"""Compares areas and kernels of the density estimate by their error against path-traced references,
and writes the table of docs/measured/density.md.

    bench/pictures/compare_areas.py [SCENES]

SCENES is the folder that holds kitchen/, classroom/ and references/. Needs the built command and the
Debian packages python3-numpy and python3-openimageio.
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import packages, scene_arguments
from tools.report_section import replace_section

packages.require("numpy", "OpenImageIO")

from tools import picture_error

SIZE = "512x384"
# Area, kernel and k; k = 75 has the noise of 50 with the constant kernel.
CASES = (("disc", "constant", 50), ("clipped", "constant", 50), ("clipped", "cone", 50),
         ("clipped", "cone", 75))


def rows(given, name, folder):
    """The rows of one scene."""
    scene, reference_file = scene_arguments.interior(given.scenes, name, SIZE)
    reference = picture_error.read_picture(reference_file)
    picture = pathlib.Path(folder) / "picture.exr"
    text = ""
    for area, kernel, k in CASES:
        subprocess.run([given.photile, "render", scene, "--size", SIZE, "--set", f"area={area}",
                        "--set", f"kernel={kernel}", "-k", str(k), "--photons", "1M", "--samples", "4",
                        "--set", "light_maps=off", "-q", "-o", picture], check=True)
        error = picture_error.measure(picture_error.read_picture(picture), reference)
        text += (f"| {name} | {area} | {kernel} | {k} | {error['mean_ratio']:.3f} "
                 f"| {error['rel_mse']:.4f} | {error['rel_mse_without_worst']:.4f} |\n")
    return text


def main():
    given = scene_arguments.parser(__doc__.splitlines()[0]).parse_args()
    text = ("| scene | area | kernel | k | mean ratio | relMSE | without the worst 5% |\n"
            "|---|---|---|--:|--:|--:|--:|\n")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("classroom", "kitchen"):
            text += rows(given, name, folder)
    print(text)
    replace_section(scene_arguments.ROOT / "docs/measured/density.md", "pictures/compare_areas.py", text)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"compare_areas.py: error: {error}")
