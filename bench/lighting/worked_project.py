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
EYES = """# four seated people who look over their screens
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
    Step("## The room\n\nThe architect's file is an empty room. Which materials does it have?",
         "photile info office-empty.gltf", {}, ("scene", "extents", "material", "warning")),
    Step("Reflectances of 0.5 and 0.2 waste light. The client agrees to 0.7 and 0.3, which all further commands set.",
         f"photile info office-empty.gltf {SURFACES}", {}, ("material: wall", "material: carpet")),
    Step("## A first attempt\n\nFour panels with a manufacturer's photometric file, around the middle of the ceiling:",
         files={"four.json": FOUR}),
    Step("Are they enough for desks by EN 12464-1 at a maintenance factor of 0.8?",
         f"photile measure office-empty.gltf {SURFACES} --luminaires four.json --plane floor+0.75 --maintenance 0.8 "
         "--target office-desk -o four.svg",
         {"four.svg": "Four panels: too little for desks"}, PLANE),
    Step("They are not: the light is uniform, but a sixth short of 500 lux. Six panels, in two rows for separate "
         "switches:",
         files={"lamps.json": SIX}),
    Step("", f"photile measure office-empty.gltf {LAMPS} --plane floor+0.75 --maintenance 0.8 "
         "--target office-desk -o six.svg",
         {"six.svg": "Six panels in two rows"}, PLANE),
    Step("That is enough for the whole room at the end of the maintenance cycle, and very uniform.\n\n## With "
         "furniture\n\nThe furnished file has four desks. Their tops are the task area. The surroundings are a "
         "band of 0.4 m, because the standard's half metre would reach into the shelf, and the background a band "
         "of three metres:", files={"desks.json": DESKS}),
    Step("Four people sit there. Does the lighting cause glare?", files={"eyes.pts": EYES}),
    Step("", f"photile glare office.gltf {LAMPS} --observers eyes.pts --ratings ugr --target office-desk "
         "-o glare.json", {}, ("observer", "eyes", "target")),
    Step("It does not: prisms reduce the luminance of the panels near the horizontal, and all four UGR values are "
         "below the limit. `photile ies panel.ies --ugr-table` predicts this without a room. To try another "
         "panel, change `file` in `lamps.json`.\n\nObservers on the grid of EN 12464-1, each with four directions "
         "of view, give a map for the report:",
         f"photile glare office.gltf {LAMPS} --grid -o everywhere.json", {}, ("highest",)),
    Step("## Daylight\n\nHow much of the daylight outside reaches the desks under an overcast sky?",
         f"photile measure office.gltf {SURFACES} --grid desks.json --daylight-factor", {},
         ("desks", "DF", "all lights")),
    Step("The desks at the window have several times the daylight of the inner ones, so separate switches for the "
         "two rows of lamps are worthwhile. The figures of the year assume lamps that are dimmed so that they "
         "reach 500 lux together with daylight. With `--for 10s` they have standard errors:",
         f"photile daylight office.gltf {LAMPS} --weather year.epw --grid desks.json --lamps-to 500 "
         "--for 10s -o year.json",
         {}, ("desks", "sDA", "ASE", "DA", "UDI", "EN", "window_row", "inner_row", "lamps", "mean")),
    Step("The level of EN 17037 is medium, and daylight saves nine tenths of the lamps' energy. But half of the "
         "points have more than 250 hours of sun a year (ASE): these windows need blinds, and daylight glare "
         "should be rated with `--ratings dgp`.\n\n## Moods\n\nThe room on an afternoon in March, with a ground "
         "reflectance of 0.2:",
         f"photile render office.gltf {LAMPS} --weather year.epw --time 2026-03-10T15:00 --set ground=0.2 "
         "--size 960x640 -o day.exr -o day.png",
         {"day.png": "An afternoon in March, all lamps on"}),
    Step("`photile relight day.exr --light sun=off --light sky=off --light ground=off` shows the room after dark. "
         "A separate picture has less noise, because all its rays sample lamps. It has a layer for each row of "
         "lamps.",
         f"photile render office.gltf {LAMPS} --size 960x640 -o office.exr"),
    Step("Moods are saved on the live page, or written by hand beside the scene; a power of 0 turns a lamp off:",
         files={"office.moods.json": MOODS}),
    Step("", "photile relight office.exr --sheet moods.png",
         {"moods.png": "Both moods with one exposure and one white"}),
    Step("A mood that names an unknown lamp is refused; the message suggests similar names.\n\n## The "
         "report\n\nOne command measures all grids and writes the report. The maintenance factor is given by its "
         "parts:",
         f"photile measure office.gltf {LAMPS} --grid desks.json --walls --ceiling --cylindrical-at floor+1.2 "
         "--maintenance LLMF=0.92,LSF=1,LMF=0.92,RSMF=0.945 --target office-desk --picture office.exr "
         "--include glare.json --include everywhere.json --include year.json "
         "--project 'Office 3.07' --client 'The Client Ltd' --designer 'A. Designer' -o report.html -o report.pdf",
         {"report-1.png": "The first page of report.pdf"}, ("target", *FIGURES)),
    Step("All targets are met. The first page has lines for signatures. Each grid has a page with its figures and "
         "a plan to scale with furniture, luminaires and isolines. Maps of glare and of the year follow:",
         pictures={"report-4.png": "The desks, to scale", "report-17.png": "Maps of the daylight of the year"}),
    Step("The last pages have the luminaire schedule, the parts list, reflectances, data sheets, and the settings "
         "with seed, version and date that reproduce the figures."),
)


def add_weather(folder):
    subprocess.run([sys.executable, ROOT / "bench/lighting/weather_year.py", folder / "year.epw"], check=True)


if __name__ == "__main__":
    run_page(ROOT / "docs/guide/project.md", "lighting/worked_project.py", STEPS, ROOT / "scenes/office", "project",
             arguments(__doc__), add_weather)
