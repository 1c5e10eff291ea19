#!/usr/bin/python3
"""Runs the worked example of docs/guide/living-room.md, and the measurement of docs/guide/measure.md, as they are
written there: puts the commands with what they print into the pages and their pictures into docs/pictures.

    bench/lighting/worked_example.py [--photile FILE] [--quick]

Needs the built command and half a minute a command.
"""

import pathlib
import sys
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lighting.example_steps import ROOT, Step, arguments, run_page

EVENING = ("--light daylight=off --light ceiling_panel=off --light floor_lamp=1500 "
           "--light floor_lamp=2700K")

# What a command is for, the command, the pictures it leaves with their captions, what begins the
# lines that are shown of what it prints.
STEPS = (
    Step("What does the file contain, and which lamps?",
         "photile info living-room.gltf", {}, ("scene", "extents", "light:")),
    Step("Render it once, with a layer for each lamp.",
         "photile render living-room.gltf --size 960x640 -o room.exr -o dusk.png",
         {"dusk.png": "On a summer evening, every lamp on"}, ()),
    Step("How much light is there for reading and work? Points in furniture or just above it are left out.",
         "photile measure living-room.gltf --plane floor+0.75 --clearance 0.1 --maintenance 0.8 "
         "-o report.html -o plan.svg",
         {"plan.svg": "Illuminance on the working plane"}, ("working plane", "lux", "all lights")),
    Step("A mood for work after dark: the ceiling panel in neutral white, the floor lamp off.",
         "photile relight room.exr --light daylight=off --light floor_lamp=off "
         "--light ceiling_panel=4000K -o work.exr -o work.png", {}, ()),
    Step("And one for the evening: the floor lamp in warm white, the ceiling panel off.",
         f"photile relight room.exr {EVENING} -o evening.exr -o evening.png",
         {"evening.png": "Evening: the floor lamp, the sconces and the picture light"}, ()),
    Step("How do they differ? Red is where the work mood is brighter, blue where the evening mood is.",
         "photile compare work.exr evening.exr -o moods.png",
         {"moods.png": "Work, evening, and the difference of their luminances"},
         ("work.exr", "luminance,", "illuminance,")),
    Step("How much light does the working plane get in the evening?",
         f"photile measure living-room.gltf {EVENING} --plane floor+0.75 --clearance 0.1 "
         "--maintenance 0.8 --cb -o evening.svg",
         {"evening.svg": "Contour bands in the evening"}, ("working plane", "lux", "all lights")),
    Step("Is any reflection more than five times as bright as the mean of the picture?",
         "photile render living-room.gltf --glare glare.png",
         {}, ("glare",)),
)

MEASUREMENT = (Step("", "photile measure living-room.gltf --plane floor+0.75 --maintenance 0.8 -q", {}, ("",)),)


if __name__ == "__main__":
    run_page(ROOT / "docs/guide/measure.md", "lighting/worked_example.py", MEASUREMENT, ROOT / "scenes/living-room",
             "example", arguments(__doc__))
    run_page(ROOT / "docs/guide/living-room.md", "lighting/worked_example.py", STEPS, ROOT / "scenes/living-room",
             "example", arguments(__doc__))
