#!/usr/bin/python3
"""Pictures of glossy scenes beside converged paths: the table in docs/gloss.md.

    bench/gloss.py SCENE.gltf... --references FOLDER [--paths N] [--photile COMMAND]
                   [--options "--quality good"]

A reference is the mean of pictures by path tracing, each of 64 paths a pixel with a seed of its own,
which FOLDER keeps: with more --paths only those that lack are made. Its noise is told from the
difference of its halves. Needs the built command and the Debian packages python3-numpy and
python3-openimageio.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

import packages
import scene_arguments
from processes import timed

packages.require("numpy", "OpenImageIO")

import numpy as np

import picture_error

SIZE = "256x192"
PATHS_OF_PICTURE = 64


def reference_halves(given, scene):
    """Two independent means, each of half of the paths."""
    halves = [[], []]
    for seed in range(1, max(2, given.paths // PATHS_OF_PICTURE) + 1):
        kept = given.references / f"{scene.stem}-{seed}.npy"
        if not kept.exists():
            with tempfile.TemporaryDirectory() as name:
                picture = pathlib.Path(name) / "paths.exr"
                subprocess.run([given.photile, "render", scene, "--integrator", "path", "--size",
                                SIZE, "--samples", str(PATHS_OF_PICTURE), "--seed", str(seed),
                                "--quiet", "-o", picture], check=True)
                np.save(kept, picture_error.read_picture(picture))
        halves[seed % 2].append(np.load(kept))
    return [np.mean(half, axis=0) for half in halves]


def measured(given, scene, folder):
    """A row of the table."""
    halves = reference_halves(given, scene)
    reference = np.mean(halves, axis=0)
    # A half is off the mean of both by half of their difference, which is as noisy as that mean.
    noise = picture_error.measure(halves[0], reference)["rel_mse"]
    _, seconds, _ = timed([given.photile, "render", scene, "--size", SIZE, *given.options.split(),
                           "--quiet", "-o", folder / "picture.exr", "--stats",
                           folder / "stats.json"])
    picture = picture_error.read_picture(folder / "picture.exr")
    figures = picture_error.measure(picture, reference)
    stages = json.loads((folder / "stats.json").read_text())["stages"]
    maps = next(stage["figures"] for stage in stages if stage["stage"] == "light maps")
    return (f"| {scene.stem} | {picture_error.rel_mse_text(figures)} | "
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
    given.references.mkdir(parents=True, exist_ok=True)
    print("| | relMSE | of it the reference's noise | mean | nodes | processor s |")
    print("|---|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as name:
        for scene in given.scenes:
            print(measured(given, scene, pathlib.Path(name)), flush=True)


if __name__ == "__main__":
    main()
