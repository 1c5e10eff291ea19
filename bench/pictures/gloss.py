#!/usr/bin/python3
"""Pictures of glossy scenes beside converged paths, the bundled office by day among them
(docs/method/gloss.md).

    bench/pictures/gloss.py SCENE.gltf... --references FOLDER [--paths N] [--photile COMMAND]
                   [--options "--quality good"]

A reference is the mean of pictures by path tracing, each of 64 paths a pixel with a seed of its own,
which FOLDER keeps: with more --paths only those that lack are made. Its noise is told from the
difference of its halves. Needs the built command and the Debian packages python3-numpy and
python3-openimageio.
"""

import argparse
import json
import pathlib
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1]), str(pathlib.Path(__file__).resolve().parent)]
from tools import packages, scene_arguments
from tools.processes import timed

packages.require("numpy", "OpenImageIO")

import details
from tools import path_references, picture_error

SIZE = "256x192"


def measured(given, name, picture, folder):
    """A row of the table.

    picture   a details.Picture
    """
    reference, noise = path_references.mean_and_noise(
        path_references.pictures(given.photile, picture.scene, SIZE, given.paths, given.references,
                                 picture.options))
    _, seconds, _ = timed([given.photile, "render", picture.scene, *picture.options, "--size", SIZE,
                           *given.options.split(), "--quiet", "-o", folder / "picture.exr", "--stats",
                           folder / "stats.json"])
    figures = picture_error.measure(picture_error.read_picture(folder / "picture.exr"), reference)
    stages = json.loads((folder / "stats.json").read_text())["stages"]
    maps = next(stage["figures"] for stage in stages if stage["stage"] == "light maps")
    return (f"| {name} | {picture_error.rel_mse_text(figures)} | "
            f"{noise:.4f} | {figures['mean_ratio']:.3f} | "
            f"{maps['new nodes']:,.0f} | {seconds:.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=pathlib.Path, nargs="+", metavar="SCENE.gltf")
    parser.add_argument("--references", type=pathlib.Path, required=True, metavar="FOLDER")
    parser.add_argument("--paths", type=int, default=4096, help="of a pixel of the reference")
    parser.add_argument("--photile", type=pathlib.Path, metavar="COMMAND",
                        default=scene_arguments.ROOT / "build/release/photile")
    parser.add_argument("--options", default="--quality good")
    given = parser.parse_args()
    print("| | relMSE | of it the reference's noise | mean | nodes | processor s |")
    print("|---|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as name:
        rows = {scene.stem: details.Picture(scene) for scene in given.scenes}
        rows["office by day"] = details.PICTURES["day"]
        for row, picture in rows.items():
            print(measured(given, row, picture, pathlib.Path(name)), flush=True)


if __name__ == "__main__":
    main()
