#!/usr/bin/python3
"""Runs the project of docs/guide/project.md as it is written there: puts the commands with what they print into the
page and their pictures into docs/pictures.

    bench/lighting/worked_project.py [--photile FILE] [--quick]

Needs the built command, pdftoppm, and about ten minutes on two cores. The weather is made up
(bench/lighting/weather_year.py).
"""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lighting.example_steps import ROOT, Step, arguments, run_page

SURFACES = "--reflectance wall=0.7 --reflectance carpet=0.3"
LAMPS = f"{SURFACES} --luminaires lamps.json"
FOUR = """{"name": "panels", "file": "panel.ies", "position": "ceiling",
 "count": [2, 2], "spacing": [3, 2.5]}
"""
SIX = """[{"name": "window_row", "file": "panel.ies", "position": [3, 2.795, 3.75],
  "count": [3, 1], "spacing": [2, 0]},
 {"name": "inner_row", "file": "panel.ies", "position": [3, 2.795, 1.25],
  "count": [3, 1], "spacing": [2, 0]}]
"""
DESKS = """{"name": "desks", "origin": [2.2, 0.75, 4.1], "u": [1.6, 0, 0], "v": [0, 0, -3.4],
 "surroundings": 0.4, "background": 3}
"""
EYES = """# four who sit, and look over their screens
1.98 1.2 1.5   1 0 0
4.02 1.2 1.5  -1 0 0
1.98 1.2 3.3   1 0 0
4.02 1.2 3.3  -1 0 0
"""
MOODS = """{"photile_moods": 1, "moods": {
  "working after dark": {"window_row": {"power": 10800}, "inner_row": {"power": 10800}},
  "presentation": {"window_row": {"power": 1500}, "inner_row": {"power": 6000, "kelvin": 3000}}}}
"""
PLANE = ("working plane", "lux", "all lights", "target", "UGR", "Ra")
FIGURES = ("desks", "eyes", "lux", "all lights", "target", "UGR", "Ra", "north", "east", "south", "west", "ceiling", "cylindrical")

STEPS = (
    Step("## The room\n\nThe architect's file is an empty room. What is it made of?",
         "photile info office-empty.gltf", {}, ("scene", "extents", "material", "warning")),
    Step("Walls of 0.5 and a carpet of 0.2 waste light. The client agrees to 0.7 and 0.3; from here on each command "
         "is told so.",
         f"photile info office-empty.gltf {SURFACES}", {}, ("material: wall", "material: carpet")),
    Step("## A first attempt\n\nFour panels of a maker's file, spread from the middle of the ceiling:",
         files={"four.json": FOUR}),
    Step("Are they enough for desks, by EN 12464-1, when lamps and room have aged to 80%?",
         f"photile measure office-empty.gltf {SURFACES} --luminaires four.json --plane floor+0.75 --maintenance 0.8 "
         "--target office-desk -s 750 -o four.svg",
         {"four.svg": "Four panels: too little for desks"}, PLANE),
    Step("They are not: uniform, but a sixth short of 500 lux. Six of them, in two rows that can be switched apart:",
         files={"lamps.json": SIX}),
    Step("", f"photile measure office-empty.gltf {LAMPS} --plane floor+0.75 --maintenance 0.8 "
         "--target office-desk -s 750 -o six.svg",
         {"six.svg": "Six panels in two rows"}, PLANE),
    Step("That is enough for the whole room, and as even as one may ask. The first plan was the lumen method by eye; the "
         "second is what it takes at the end of the maintenance cycle.\n\n"
         "## With furniture\n\nThe furnished file has four desks. Their tops are the task, 0.4 m around "
         "them its surroundings (the standard's half metre would reach into the shelf), and what the room has up to three "
         "metres beyond that the background:", files={"desks.json": DESKS}),
    Step("Four people sit there. Does the lighting dazzle them?", files={"eyes.pts": EYES}),
    Step("", f"photile glare office.gltf {LAMPS} --observers eyes.pts --ratings ugr --target office-desk "
         "-o glare.json", {}, ("observer", "eyes", "target")),
    Step("It does not: prisms dim the panels towards the horizon, and all four see less than the 19 that the standard "
         "allows. `photile ies panel.ies --ugr-table` would have said so before any room was there. An opal panel of the "
         "same lumens would be worth the same commands: another `file` in `lamps.json`.\n\nAnd elsewhere in the room? "
         "Observers at the grid of EN 12464-1 who look four ways, for a map in the report:",
         f"photile glare office.gltf {LAMPS} --grid -o everywhere.json", {}, ("highest",)),
    Step("## Daylight\n\nHow much of the daylight outside reaches the desks under an overcast sky?",
         f"photile measure office.gltf {SURFACES} --grid desks.json --daylight-factor", {},
         ("desks", "DF", "all lights")),
    Step("The window row of desks has several times what the inner one has, so the two rows of lamps earn their own "
         "switches. And over a year, with lamps that are dimmed to what daylight lacks of 500 lux? Ten seconds of rays "
         "give the figures errors:",
         f"photile daylight office.gltf {LAMPS} --weather year.epw --grid desks.json --lamps-to 500 "
         "--for 10s -o year.json",
         {}, ("desks", "sDA", "ASE", "DA", "UDI", "EN", "window_row", "inner_row", "lamps", "mean")),
    Step("EN 17037 calls that medium, and daylight saves nine tenths of the lamps' energy. But half of the points have more "
         "than 250 hours of sun a year (ASE): these windows need blinds, and glare by daylight is to be rated with "
         "`--ratings dgp`.\n\n## Moods\n\nThe room on an afternoon in March, with ground outside that reflects "
         "a fifth:",
         f"photile render office.gltf {LAMPS} --weather year.epw --time 2026-03-10T15:00 --set ground=0.2 "
         "--size 960x640 -o day.exr -o day.png",
         {"day.png": "An afternoon in March, all lamps on"}),
    Step("`photile relight day.exr --light sun=off --light sky=off --light ground=off` shows the room after "
         "dark. A picture of its own has less noise, for all its rays look for lamps. It has a layer for each row of them.",
         f"photile render office.gltf {LAMPS} --size 960x640 -o office.exr"),
    Step("Moods are kept on the live page, or written by hand beside the scene; a power of 0 is off:",
         files={"office.moods.json": MOODS}),
    Step("", "photile relight office.exr --sheet moods.png",
         {"moods.png": "Both moods with one exposure and one white"}),
    Step("A mood that names a lamp which is not there is refused, with the likest names.\n\n## The report\n\nOne command measures the task, its surroundings, the background, walls, ceiling and faces, and brings all of "
         "it together, with the maintenance factor by its parts:",
         f"photile measure office.gltf {LAMPS} --grid desks.json --walls --ceiling --cylindrical-at floor+1.2 "
         "--maintenance LLMF=0.92,LSF=1,LMF=0.92,RSMF=0.945 --target office-desk -s auto --picture office.exr "
         "--include glare.json --include everywhere.json --include year.json "
         "--project 'Office 3.07' --client 'The Client Ltd' --designer 'A. Designer' -o report.html -o report.pdf",
         {"report-1.png": "The first page of report.pdf"}, ("target", *FIGURES)),
    Step("All is met: the report may be handed over, and signed on its first page. A page for each grid has its figures, and "
         "its plan at a scale with furniture, luminaires and isolines; then come maps of glare and of the year:",
         pictures={"report-3.png": "The desks, at 1:40", "report-12.png": "UGR, daylight autonomy and useful daylight"}),
    Step("The last pages hold the schedule of lamps, the list of parts, reflectances, data sheets, and settings with seed, "
         "version and date, from which the same figures come again."),
)


def add_weather(folder):
    subprocess.run([sys.executable, ROOT / "bench/lighting/weather_year.py", folder / "year.epw"], check=True)


if __name__ == "__main__":
    run_page(ROOT / "docs/guide/project.md", "lighting/worked_project.py", STEPS, ROOT / "scenes/office", "project",
             arguments(__doc__), add_weather)
