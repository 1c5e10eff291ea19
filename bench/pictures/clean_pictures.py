#!/usr/bin/python3
"""What gathering at the nodes of light maps makes of pictures, and what it costs: the table in
docs/light-maps.md.

    bench/pictures/clean_pictures.py [SCENES] [--photile COMMAND]

SCENES holds <scene>/<scene>-diffuse.gltf and references/<scene>-diffuse-256x192.exr, as for
bench/pictures/quality.py. Takes about ten minutes. Needs the built command and the Debian packages
python3-numpy and python3-openimageio.
"""

import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import packages, scene_arguments
from tools.processes import timed

packages.require("numpy", "OpenImageIO")

from tools import picture_error

SIZE = "256x192"
ROWS = tuple((scene, options) for scene in ("classroom", "kitchen") for options in (
    "--set light_map_rays=0 --photons 500k -k 100 --samples 16", "--quality good",
    "--quality good --photons 1M", "--quality final"))


def measured(given, scene, options, folder):
    """A row of the table."""
    file, reference_file = scene_arguments.interior(given.scenes, scene, SIZE)
    _, seconds, _ = timed([given.photile, "render", file, "--size", SIZE, "--set", "quota=power",
                           *options.split(), "--quiet", "-o", folder / "picture.exr",
                           "--stats", folder / "stats.json"])
    picture = picture_error.read_picture(folder / "picture.exr")
    reference = picture_error.read_picture(reference_file)
    figures = picture_error.measure(picture, reference)
    stages = json.loads((folder / "stats.json").read_text())["stages"]
    maps = next(stage["figures"] for stage in stages if stage["stage"] == "light maps")
    stated = maps.get("standard error percent")
    return (f"| {scene} | `{options}` | {picture_error.rel_mse_text(figures)} | "
            f"{100 * picture_error.mottle(picture, reference):.1f}% | "
            f"{figures['mean_ratio']:.3f} | {f'{stated:.1f}%' if stated else ''} | "
            f"{maps['new nodes']:,.0f} | {seconds:.1f} |")


def main():
    given = scene_arguments.parser(__doc__.splitlines()[0]).parse_args()
    print("| | settings | relMSE | mottle | mean | stated error | nodes | processor s |")
    print("|---|---|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as name:
        for scene, options in ROWS:
            print(measured(given, scene, options, pathlib.Path(name)), flush=True)


if __name__ == "__main__":
    main()
