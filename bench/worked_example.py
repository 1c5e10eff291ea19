#!/usr/bin/python3
"""Runs the worked example of docs/walkthrough.md as it is written there: puts the commands with
what they print into the page and their pictures into docs/pictures.

    bench/worked_example.py [--photile FILE] [--quick]

Needs the built command and half a minute a command.
"""

import argparse
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

from report_section import replace_section

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/walkthrough.md"
PICTURES = ROOT / "docs/pictures"
ROOM = ROOT / "scenes/living-room"
EVENING = ("--light daylight=off --light ceiling_panel=off --light floor_lamp=1500 "
           "--light floor_lamp=2700K")

# What a command is for, the command, the pictures it leaves with their captions, what begins the
# lines that are shown of what it prints.
STEPS = (
    ("What does the file hold, and which lamps?",
     "photile info living-room.gltf", {}, ("scene", "extents", "light:")),
    ("Render it once, a layer for each lamp.",
     "photile render living-room.gltf --size 960x640 -o room.exr --png day.png",
     {"day.png": "By day, every lamp on"}, ()),
    ("How much light is there to read and work by? Points in or just over furniture are left out.",
     "photile measure living-room.gltf --plane floor+0.75 --clearance 0.1 --maintenance 0.8 "
     "-s 600 -o report.html -o plan.svg",
     {"plan.svg": "Illuminance on the working plane"}, ("working plane", "lux", "all lights")),
    ("A mood for work after dark: the ceiling in neutral white, the floor lamp off.",
     "photile relight room.exr --light daylight=off --light floor_lamp=off "
     "--light ceiling_panel=4000K -o work.exr --png work.png", {}, ()),
    ("And one for the evening: the floor lamp, warm, and the ceiling off.",
     f"photile relight room.exr {EVENING} -o evening.exr --png evening.png",
     {"evening.png": "In the evening"}, ()),
    ("How do they differ? Red is where work is brighter, blue where the evening is.",
     "photile compare work.exr evening.exr -o moods.png",
     {"moods.png": "Work, evening, and the difference of their luminances"},
     ("work.exr", "luminance,", "illuminance,")),
    ("What is left of the light on the plane in the evening?",
     f"photile measure living-room.gltf {EVENING} --plane floor+0.75 --clearance 0.1 "
     "--maintenance 0.8 -s 600 --cb -o evening.svg",
     {"evening.svg": "The evening's contour bands"}, ("working plane", "lux", "all lights")),
    ("Is a reflection five times as bright as the mean of the picture?",
     "photile render living-room.gltf --glare glare.png",
     {}, ("glare",)),
)
QUICK = {"render": "--quality draft --photons 20k -k 50 --size 96x64",
         "measure": "--rays 16 --repeats 2 --photons 20k"}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photile", default=ROOT / "build/release/photile", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true",
                        help="few photons and rays: shows that the commands work, writes nothing")
    return parser.parse_args()


def output_of(photile, command, folder):
    """All that a command prints, line by line."""
    words = shlex.split(command)
    done = subprocess.run([photile, *words[1:]], cwd=folder, text=True, capture_output=True,
                          check=False)
    if done.returncode != 0:
        sys.exit(f"worked_example.py: error: {command}: {done.stderr.strip()}")
    return (done.stderr + done.stdout).splitlines()


def quick(command):
    return " ".join([command, *(less for word, less in QUICK.items() if word in command.split())])


def shown(lines, starts):
    return [line for line in lines if any(line.strip().startswith(start) for start in starts)]


def main():
    options = arguments()
    photile = options.photile.resolve()
    text = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        shutil.copytree(ROOM, folder, dirs_exist_ok=True)
        for purpose, command, pictures, starts in STEPS:
            lines = output_of(photile, quick(command) if options.quick else command, folder)
            text += [purpose, "", f"    $ {command}"]
            text += [f"    {line}" for line in shown(lines, starts)] + [""]
            for picture, caption in pictures.items():
                name = f"example-{picture}"
                if not (folder / picture).is_file():
                    sys.exit(f"worked_example.py: error: {command}: leaves no {picture}")
                if not options.quick:
                    shutil.copy(folder / picture, PICTURES / name)
                text += [f"![{caption}](pictures/{name})", ""]
    if not options.quick:
        replace_section(PAGE, "worked_example.py", "\n".join(text).strip("\n"))


if __name__ == "__main__":
    main()
