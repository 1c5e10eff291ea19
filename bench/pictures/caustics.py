#!/usr/bin/python3
"""Errors of caustics beside references that know no photons (docs/method/caustics.md), and a pool.

    bench/pictures/caustics.py [--references FOLDER] [--mitsuba PYTHON] [--quality good final] [--photile COMMAND]
    bench/pictures/caustics.py --picture docs/pictures/gallery/pool.png

The glass sphere and the metal ring of scenes/gallery are compared with photile's own path tracer, whose lamp rays
find by chance; the pool, whose sun they would not find, with Mitsuba's light tracer (bench/rivals/caustics_mitsuba.py),
as its camera under water sees it. Pixels that see the underside of the water, or are next to such, are left out there.
Takes a quarter of an hour the first time, for the references. PYTHON has the package mitsuba; without it there is no row
of the pool. Needs the built command and the Debian packages python3-numpy and python3-openimageio.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import packages, scene_arguments
from tools.processes import timed

packages.require("numpy", "OpenImageIO")

import numpy as np

from tools import path_references, picture_error

SIZE = "128x96"
PATHS = {"glass-sphere": 16384, "metal-ring": 8192}  # of a pixel
PATHS_OF_PICTURE = 2048
POOL = ("--camera", "under water", "--sun", "215,55,60000", "--set", "ground=0")
LIGHT_PATHS, LIGHT_PICTURES = 1024, 16  # of a pixel of a picture by Mitsuba
BRIGHT_SHARE = 0.03  # of the pixels: the caustic itself


def scene_of(name):
    return scene_arguments.ROOT / f"scenes/gallery/{name}.gltf"


def by_light_tracing(given):
    """Pictures of the pool, (count, height, width, 3)."""
    kept = given.references / f"pool-{SIZE}-light.npy"
    if not kept.exists():
        given.references.mkdir(parents=True, exist_ok=True)
        camera, sun = POOL[1], POOL[3]
        subprocess.run([given.mitsuba, scene_arguments.ROOT / "bench/rivals/caustics_mitsuba.py", scene_of("pool"),
                        "--size", SIZE, "--samples", str(LIGHT_PATHS), "--pictures", str(LIGHT_PICTURES),
                        "--camera", camera, "--sun", sun, "-o", kept], check=True)
    return list(np.load(kept))


def far_from_black(reference):
    """Mask (height, width) of the pixels that have light, and whose neighbours have."""
    return picture_error.windows(reference.sum(axis=2), 1).min(axis=0) > 0


def figures(picture, reference, noise, mask):
    """relMSE less the reference's noise, that noise, mottle, and mean ratios of all and of the bright pixels."""
    # What is left out is taken from the reference, and shares in no mean.
    compared = np.where(mask[..., None], picture, reference)
    share = mask.mean()
    bright = reference @ picture_error.LUMINANCE
    bright = mask & (bright > np.quantile(bright[mask], 1 - BRIGHT_SHARE))
    return {"rel_mse": (picture_error.measure(compared, reference)["rel_mse"] - noise) / share, "noise": noise / share,
            "mottle": picture_error.mottle(compared, reference),
            "mean": picture[mask].mean() / reference[mask].mean(),
            "bright": picture[bright].mean() / reference[bright].mean()}


def row(given, name, quality, folder):
    if name == "pool":
        found, options = by_light_tracing(given), POOL
    else:
        found, options = path_references.pictures(given.photile, scene_of(name), SIZE, PATHS[name], given.references,
                                                  paths_of_picture=PATHS_OF_PICTURE), ()
    reference, noise = path_references.mean_and_noise(found)
    mask = far_from_black(reference) if name == "pool" else picture_error.without_lamps(reference)
    picture = folder / "picture.exr"
    _, seconds, _ = timed([given.photile, "render", scene_of(name), *options, "--size", SIZE, "--quality", quality,
                           "--quiet", "-o", picture])
    found = figures(picture_error.read_picture(picture), reference, noise, mask)
    return (f"| {name} | `{quality}` | {found['rel_mse']:.4f} | {found['noise']:.4f} | {100 * found['mottle']:.1f}% | "
            f"{found['mean']:.3f} | {found['bright']:.3f} | {seconds:.1f} |")


def draw_pool(given, folder):
    """The pool as both of its cameras see it, side by side."""
    seen = []
    for camera in ("camera", "under water"):
        picture = folder / "picture.exr"
        subprocess.run([given.photile, "render", scene_of("pool"), "--camera", camera, *POOL[2:], "--size", "640x480",
                        "--quiet", "-o", picture], check=True)
        pixels = picture_error.read_picture(picture)
        seen += [picture_error.displayed(pixels, picture_error.exposure(pixels)), np.ones((pixels.shape[0], 4, 3))]
    picture_error.write_png(given.picture, np.concatenate(seen[:-1], axis=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--references", type=pathlib.Path, metavar="FOLDER",
                        default=scene_arguments.ROOT / "build/caustics")
    parser.add_argument("--mitsuba", type=pathlib.Path, metavar="PYTHON")
    parser.add_argument("--picture", type=pathlib.Path, metavar="FILE.png", help="draw the pool and do nothing else")
    parser.add_argument("--quality", nargs="+", default=["good", "final"])
    parser.add_argument("--photile", type=pathlib.Path, metavar="COMMAND",
                        default=scene_arguments.ROOT / "build/release/photile")
    given = parser.parse_args()
    if given.picture:
        with tempfile.TemporaryDirectory() as name:
            draw_pool(given, pathlib.Path(name))
        return
    print("| | | relMSE less noise | the reference's noise | mottle | mean | of the brightest 3% | processor s |")
    print("|---|---|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as name:
        for scene in [*PATHS, *(["pool"] if given.mitsuba else [])]:
            for quality in given.quality:
                print(row(given, scene, quality, pathlib.Path(name)), flush=True)


if __name__ == "__main__":
    main()
