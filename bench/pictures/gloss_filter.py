#!/usr/bin/python3
"""What the filter of gloss gains, and writes it into docs/measured/gloss.md.

    bench/pictures/gloss_filter.py [--size 288x192] [--photile COMMAND]

Bundled scenes with the rays of lobes as they are, and filtered, beside 256 samples a pixel of the same photons and
nodes: all differences are then those of the samples. Takes minutes. Needs the built command and the
Debian packages python3-numpy and python3-openimageio.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages
from tools.report_section import replace_section

packages.require("numpy", "OpenImageIO")

from tools import picture_error

SCENES = ["living-room/living-room", "gallery/metal-ring", "gallery/glossy-floor"]
WAYS = {"rays": ["--set", "gloss=rays"],
        "filtered": []}
REFERENCE = ["--set", "gloss=rays", "--samples", "256"]


def picture(given, scene, options, folder):
    file = folder / "picture.exr"
    subprocess.run([given.photile, "render", ROOT / f"scenes/{scene}.gltf", "--size", given.size, *options,
                    "--quiet", "-o", file], check=True)
    return picture_error.read_picture(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="288x192")
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    given = parser.parse_args()
    rows = ["| scene | gloss | relMSE (without the worst 5%) | mean |", "|---|---|--:|--:|"]
    with tempfile.TemporaryDirectory() as name:
        for scene in SCENES:
            reference = picture(given, scene, REFERENCE, pathlib.Path(name))
            for way, options in WAYS.items():
                own = picture(given, scene, options, pathlib.Path(name))
                figures = picture_error.measure(own, reference)
                rows.append(f"| {scene.split('/')[1]} | {way} | {figures['rel_mse']:.5f} "
                            f"({figures['rel_mse_without_worst']:.5f}) | {figures['mean_ratio']:.4f} |")
                print(rows[-1], flush=True)
    replace_section(ROOT / "docs/measured/gloss.md", "pictures/gloss_filter.py", "\n".join(rows))


if __name__ == "__main__":
    main()
