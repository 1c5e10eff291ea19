#!/usr/bin/python3
"""Renders the scenes of scenes/gallery by the default and by paths and writes docs/measured/gallery.md.

    bench/pictures/gallery.py [--photile COMMAND] [--only SCENE] [--references FOLDER] [--quick --results FOLDER]

Takes about half an hour, nearly all of it for the paths, which FOLDER keeps. Needs the built command and
the Debian packages python3-numpy and python3-openimageio.
"""

import argparse
import dataclasses
import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages
from tools.processes import timed
from tools.report_section import replace_section

packages.require("numpy", "OpenImageIO")

import numpy as np

from tools import path_references, picture_error

SIZE, REFERENCE_PATHS = "960x720", 64
BLOCK = 2  # pixels of a block's side: errors are those of means over blocks, which see 256 paths


@dataclasses.dataclass
class Subject:
    """One scene: its file's name, what it shows, and the options of its lights."""
    name: str
    caption: str
    lights: tuple = ()


SUBJECTS = (
    Subject("glass-sphere", "The caustic of a glass sphere below a small round lamp."),
    Subject("metal-ring", "The caustic inside a mirroring ring; beside it a band of rough steel."),
    Subject("glossy-floor", "A window and its reflection in a floor of polished stone."),
    Subject("sun-and-sky", "A room lit by the sun and a clear sky through a window, "
            "`--sun 60,40,40000 --sky clear=12000 --set ground=0`.",
            lights=("--sun", "60,40,40000", "--sky", "clear=12000", "--set", "ground=0")),
    Subject("downlights", "Three lamps with an IES file, close to a wall."),
    Subject("coloured-lamps", "Lamps in red, green and blue, and what their shadows mix."),
)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--only", choices=[subject.name for subject in SUBJECTS],
                        help="render this alone, the results keep the others")
    parser.add_argument("--references", type=pathlib.Path, default=ROOT / "build/gallery",
                        metavar="FOLDER", help="pictures by paths; default: %(default)s")
    parser.add_argument("--quick", action="store_true", help="tiny pictures: a smoke test")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "docs/pictures/gallery",
                        help="where pictures and figures go; default: %(default)s")
    return parser.parse_args()


def in_blocks(picture):
    """Means over blocks of pixels, of shape (height / BLOCK, width / BLOCK, 3)."""
    height, width, channels = picture.shape
    return picture.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, channels).mean(axis=(1, 3))


def measure(given, subject, folder):
    """Renders a scene both ways, writes the two side by side, and returns the figures."""
    size = "32x24" if given.quick else SIZE
    few = ["--quality", "draft", "--photons", "20k", "-k", "20"] if given.quick else []
    scene, picture = ROOT / f"scenes/gallery/{subject.name}.gltf", folder / "photons.exr"
    _, seconds, _ = timed([given.photile, "render", scene, *subject.lights, *few, "--size", size,
                           "-o", picture, "--quiet"])
    own = picture_error.read_picture(picture)
    found = path_references.pictures(
        given.photile, scene, size, 4 if given.quick else REFERENCE_PATHS,
        folder if given.quick else given.references, subject.lights,
        paths_of_picture=REFERENCE_PATHS // 2)
    paths = np.mean(found, axis=0)
    blocks, noise = path_references.mean_and_noise([in_blocks(each) for each in found])
    factor = picture_error.exposure(paths)
    both = [picture_error.displayed(own, factor), np.ones((own.shape[0], 4, 3)),
            picture_error.displayed(paths, factor)]
    picture_error.write_png(given.results / f"{subject.name}.png", np.concatenate(both, axis=1))
    figures = picture_error.measure(in_blocks(own), blocks)
    return {"scene": subject.name, "processor seconds": seconds,
            "mean ratio": figures["mean_ratio"],
            "relMSE": figures["rel_mse"], "noise of the reference": noise,
            "relMSE without the worst 5%": figures["rel_mse_without_worst"]}


def section(results):
    text = ""
    for subject in SUBJECTS:
        row = results.get(subject.name)
        if row is None:
            continue
        options = " ".join(["photile render", f"{subject.name}.gltf", *subject.lights,
                            "--size", SIZE])
        text += (f"## {subject.name.replace('-', ' ').capitalize()}\n\n{subject.caption}\n\n"
                 f"![By the default, and by paths](../pictures/gallery/{subject.name}.png)\n\n"
                 f"Mean ratio {row['mean ratio']:.3f}, relMSE {row['relMSE']:.4f}, of which the noise of the "
                 f"reference is {row['noise of the reference']:.4f}; without the worst 5% of the pixels "
                 f"{row['relMSE without the worst 5%']:.4f}, after "
                 f"{row['processor seconds']:.0f} processor seconds: `{options}` beside "
                 f"{REFERENCE_PATHS} paths a pixel.\n\n")
    return text.rstrip()


def main():
    given = arguments()
    given.results.mkdir(parents=True, exist_ok=True)
    record = given.results / "gallery.json"
    results = {}
    if given.only and record.is_file():
        results = {row["scene"]: row for row in json.loads(record.read_text())}
    with tempfile.TemporaryDirectory() as name:
        for subject in SUBJECTS:
            if given.only in (None, subject.name):
                results[subject.name] = measure(given, subject, pathlib.Path(name))
                print(json.dumps(results[subject.name]))
    record.write_text(json.dumps(list(results.values()), indent=1) + "\n")
    if not given.quick:
        replace_section(ROOT / "docs/measured/gallery.md", "pictures/gallery.py", section(results),
                        partly=given.only is not None)


if __name__ == "__main__":
    main()
