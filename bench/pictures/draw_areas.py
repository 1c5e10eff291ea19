#!/usr/bin/python3
"""Draws what clipping discs mends: errors in false colours with whole and with clipped discs.

    bench/pictures/draw_areas.py [SCENES]

SCENES is the folder that holds classroom/ and references/. Writes docs/pictures/*-error-disc.png and
*-error-clipped.png of the classroom, beside the reference of SCENES, and of the living room, beside one
that it path-traces. Takes minutes. Needs the built command and the Debian packages python3-numpy and
python3-openimageio.
"""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments

packages.require("numpy", "OpenImageIO")

from tools import picture_error

AREAS = ("disc", "clipped")
# Many neighbours: what is seen is the bias at borders, not the noise.
SETTINGS = ("--photons", "2M", "-k", "300", "--set", "quota=power", "--samples", "16",
            "--set", "light_maps=off")
REFERENCE_SAMPLES = "512"


def render(photile, scene, size, picture, *options):
    subprocess.run([photile, "render", scene, "--size", size, "-o", picture, "--quiet", *options],
                   check=True)
    return picture_error.read_picture(picture)


def draw(photile, name, scene, size, reference, folder):
    for area in AREAS:
        picture = render(photile, scene, size, folder / f"{area}.exr", "--set", f"area={area}", *SETTINGS)
        error = picture_error.measure(picture, reference)
        print(name, area, " ".join(f"{key}={value:.4f}" for key, value in error.items()), flush=True)
        picture_error.write_png(
            ROOT / f"docs/pictures/{name}-error-{area}.png",
            picture_error.false_colour(picture_error.relative_error(picture, reference)))


def main():
    given = scene_arguments.parser(__doc__.splitlines()[0]).parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        size = "512x384"
        draw(given.photile, "classroom", given.scenes / "classroom/classroom-diffuse.gltf", size,
             picture_error.read_picture(given.scenes / f"references/classroom-diffuse-{size}.exr"),
             folder)
        scene, size = ROOT / "scenes/living-room/living-room.gltf", "432x288"
        reference = render(given.photile, scene, size, folder / "reference.exr", "--integrator",
                           "path", "--samples", REFERENCE_SAMPLES, "--seed", "1001")
        draw(given.photile, "living-room", scene, size, reference, folder)


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"draw_areas.py: error: {error}")
