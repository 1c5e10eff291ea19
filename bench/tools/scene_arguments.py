"""The arguments of scripts that render scenes which are not part of the repository."""

import argparse
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def parser(description):
    """Knows SCENES and --photile; the script adds its own arguments."""
    made = argparse.ArgumentParser(description=description)
    made.add_argument("scenes", nargs="?", type=pathlib.Path, metavar="SCENES",
                      default=os.environ.get("PHOTILE_SHARED_SCENES", ROOT / "../shared/scenes"),
                      help="default: PHOTILE_SHARED_SCENES, else ../shared/scenes")
    made.add_argument("--photile", type=pathlib.Path, metavar="COMMAND",
                      default=ROOT / "build/release/photile",
                      help="the command; default: %(default)s")
    return made


def interior(scenes, name, size):
    """The scene file of an interior and its reference."""
    return (scenes / name / f"{name}-diffuse.gltf",
            scenes / "references" / f"{name}-diffuse-{size}.exr")
