#!/usr/bin/env python3
"""Bias and scatter of light maps' pictures: a table of docs/irradiance-gathering.md.

    bench/pictures/filter_bias.py SCENES [--photile FILE] [--size WxH] [--seeds N] [-- OPTIONS]

SCENES is the folder of the interiors and their references, which are not part of this repository, as
for bench/pictures/quality.py. Renders each room with so many seeds. What they share is bias: of the filter, of
photons, of lattices and of the reference; what they do not is scatter. OPTIONS go to `photile render`.
The filter's constants are compiled in (include/photile/defaults.hpp): a row of the table is a build.
Needs the built command and the Debian packages python3-numpy and python3-openimageio.
"""
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments
from tools.processes import timed

packages.require("numpy", "OpenImageIO")

import numpy as np

from tools import picture_error


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--size", default="256x192", help="default: %(default)s")
    parser.add_argument("--seeds", type=int, default=6, metavar="N", help="2 or more; default: %(default)s")
    parser.add_argument("options", nargs="*", help="of photile render, after --")
    given = parser.parse_args()
    if given.seeds < 2:
        parser.error("--seeds: give 2 or more, since scatter is between seeds")
    print("| | relMSE | of it bias | scatter | mottle | mean | processor s |\n|---|--:|--:|--:|--:|--:|--:|")
    for room in ("classroom", "kitchen"):
        scene, reference = scene_arguments.interior(given.scenes, room, given.size)
        reference = picture_error.read_picture(reference)
        pictures, seconds = [], []
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.exr"
            for seed in range(1, given.seeds + 1):
                _, used, _ = timed([given.photile, "render", scene, "--size", given.size, "-o", file, "--quiet",
                                    "--set", "quota=power", "--seed", str(seed), *given.options])
                pictures.append(picture_error.read_picture(file))
                seconds.append(used)
        one = np.mean([picture_error.measure(picture, reference)["rel_mse"] for picture in pictures])
        mean = picture_error.measure(np.mean(pictures, axis=0), reference)
        # The error of a mean of n pictures is the bias and an n-th of the scatter.
        scatter = (one - mean["rel_mse"]) * given.seeds / (given.seeds - 1)
        mottle = np.mean([picture_error.mottle(picture, reference) for picture in pictures])
        print(f"| {room} | {one:.5f} | {one - scatter:.5f} | {scatter:.5f} | {100 * mottle:.1f}% | "
              f"{mean['mean_ratio']:.4f} | {np.mean(seconds):.1f} |", flush=True)


if __name__ == "__main__":
    main()
