#!/usr/bin/python3
"""Measures a box and reads the report as a strict XML parser does: every picture is in it, nothing
refers to another file, figures are those of the JSON, nothing is drawn beyond its drawing's border.

    report_test.py PHOTILE
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

SVG = "{http://www.w3.org/2000/svg}"
BOX = """mtllib box.mtl
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
o walls\nusemtl wall
f 1 2 3 4\nf 8 7 6 5\nf 1 4 8 5\nf 2 6 7 3\nf 4 3 7 8\nf 1 5 6 2
v -0.8 0.99 -0.2\nv -0.4 0.99 -0.2\nv -0.4 0.99 0.2\nv -0.8 0.99 0.2
o left\nusemtl lamp\nf 9 10 11 12
v 0.4 0.99 -0.2\nv 0.8 0.99 -0.2\nv 0.8 0.99 0.2\nv 0.4 0.99 0.2
o right\nusemtl lamp\nf 13 14 15 16
"""
MTL = "newmtl wall\nKd 0.7 0.6 0.5\nnewmtl lamp\nKd 0 0 0\nKe 5 5 20\n"
PLANES = [
    {"name": "desk <1> & \"2\"", "origin": [-0.8, -0.25, 0.8], "u": [1.6, 0, 0], "v": [0, 0, -0.8],
     "columns": 8, "rows": 4},
    # A plane as narrow as a shelf: its title is longer than it is wide.
    {"name": "the narrow shelf behind the door", "origin": [-0.8, 0.2, 0.8], "u": [0.1, 0, 0],
     "v": [0, 0, -1.6], "columns": 1, "rows": 16},
]
FIGURES = ("Em", "Emin", "Emax", "Uo", "Ud")


def fail(text):
    sys.exit(f"report_test.py: error: {text}")


def measure(photile, folder):
    scene = folder / "room & <lamps>.obj"
    scene.write_text(BOX)
    (folder / "box.mtl").write_text(MTL)
    (folder / "planes.json").write_text(json.dumps(PLANES))
    (folder / "points.pts").write_text("0 0 0  0 1 0\n")
    report, record = folder / "report.html", folder / "values.json"
    subprocess.run([photile, "measure", scene, "--grid", folder / "planes.json", "--points",
                    folder / "points.pts", "--photons", "20k", "--rays", "64", "--repeats", "3",
                    "-s", "auto", "--quiet", "-o", report, "-o", record],
                   check=True, stdout=subprocess.DEVNULL)
    return report.read_text(encoding="utf-8"), json.loads(record.read_text())


def words(element):
    return "".join(element.itertext())


def check_self_contained(page):
    for element in page.iter():
        for name, value in element.attrib.items():
            if name in ("src", "href", "data") or "url(" in value:
                fail(f"{element.tag} refers to {value}")
    if "@import" in words(page) or "url(" in words(page):
        fail("the style refers to another file")


def check_figures(table, grid):
    """Each row against the statistics of the JSON: all lights together, then each."""
    rows = table.findall("tr")[1:]
    expected = [("all lights", grid["statistics"]), *grid["lights"].items()]
    if [row[0].text for row in rows] != [name for name, _ in expected]:
        fail(f"rows {[row[0].text for row in rows]}")
    for row, (name, statistics) in zip(rows, expected):
        for cell, figure in zip(row[1:], FIGURES):
            shown, truth = float(cell.text), statistics[figure]["value"]
            if abs(shown - truth) > 0.001 * abs(truth) + 0.0006:
                fail(f"{name}, {figure}: {shown} for {truth}")
            error = float(words(cell[0]).lstrip("± "))
            if abs(error - statistics[figure]["standard_error"]) > 0.06 * error + 1e-9:
                fail(f"{name}, {figure}: an error of {error}")


def check_drawing(svg, title):
    """The title is there, and every word and bar lies within the drawing."""
    _, _, width, height = map(float, svg.get("viewBox").split())
    texts = svg.findall(f"{SVG}text")
    if re.sub(r", 1:[0-9.]+$", "", texts[0].text) != title:
        fail(f"a drawing is called {texts[0].text!r}, not {title!r}")
    for text in texts:
        size = float(text.get("font-size", svg.get("font-size")))
        x, y, across = float(text.get("x")), float(text.get("y")), 0.55 * size * len(text.text)
        if "rotate" in text.get("transform", ""):
            if x - size < 0 or y - across / 2 < 0 or y + across / 2 > height:
                fail(f"{title}: '{text.text}' is cut off")
            continue
        left = x - across * {"middle": 0.5, "end": 1}.get(text.get("text-anchor"), 0)
        if left < 0 or left + across > width or y - size < 0 or y > height:
            fail(f"{title}: '{text.text}' is cut off")
    for bar in svg.findall(f"{SVG}rect")[1:]:
        x, y = float(bar.get("x")), float(bar.get("y"))
        if x + float(bar.get("width")) > width or y + float(bar.get("height")) > height:
            fail(f"{title}: a rectangle reaches beyond the border")
    if title != "Luminaires" and "lux" not in [text.text for text in texts]:
        fail(f"{title}: the legend has no unit")


def main():
    with tempfile.TemporaryDirectory() as folder:
        text, record = measure(sys.argv[1], pathlib.Path(folder))
    if not text.startswith("<!DOCTYPE html>"):
        fail("no document type")
    page = ElementTree.fromstring(text)
    check_self_contained(page)
    if page.find("head/title").text != "room & <lamps>.obj":
        fail(f"the title is {page.find('head/title').text!r}")
    body = page.find("body")
    headings = [words(heading) for heading in body.iter("h2")]
    if "Key figures" not in headings or "counter(pages)" not in words(page.find("head/style")):
        fail(f"{headings} have no key figures; or pages have no numbers")
    headings = headings[headings.index("Key figures") + 1:]
    grids = record["grids"]
    for heading, grid in zip(headings, grids):
        if not re.match(re.escape(f"{grid['name']}: {grid['points']} points"), heading):
            fail(f"{heading!r} is no heading of {grid['name']!r}")
    tables = list(body.iter("table"))[1:]
    alone = [f"{grid['name']}: each light alone" for grid in grids if "plane" in grid]
    if (len(tables) != len(grids) + 3
            or headings[len(grids):-1] != [*alone, "Luminaires", "List of parts", "Reflectances"]):
        fail(f"{len(tables)} tables under {len(headings)} headings for {len(grids)} grids")
    for table, grid in zip(tables, grids):
        check_figures(table, grid)
    planes = [grid for grid in grids if "plane" in grid]
    titles = [grid["name"] for grid in planes] + [light for grid in planes for light in grid["lights"]]
    titles.append("Luminaires")
    drawings = list(page.iter(f"{SVG}svg"))
    if len(drawings) != len(titles):
        fail(f"{len(drawings)} drawings, not {len(titles)}")
    for drawing, title in zip(drawings, titles):
        check_drawing(drawing, title)
    if sum("mm" in drawing.get("width") for drawing in drawings) != len(PLANES) + 1:
        fail("the plans are at no scale")
    facts = dict(zip([name.text for name in body.iter("dt")],
                     [value.text for value in body.iter("dd")]))
    if facts["illuminance"] != "planar" or facts["seed"] != "1":
        fail(f"facts: {facts}")
    lamps, parts, reflectances = ([[cell.text for cell in row] for row in table.findall("tr")[1:]]
                                  for table in tables[len(grids):])
    if [lamp[:2] for lamp in lamps] != [["A1", "left"], ["B2", "right"]] or lamps[0][3] != "-0.60, 0.99, 0.00":
        fail(f"lamps: {lamps}")
    if [part[:3] for part in parts[:2]] != [["A", "1", "left"], ["B", "1", "right"]]:
        fail(f"parts: {parts}")
    # The wall's luminance: 0.2126 x 0.7 + 0.7152 x 0.6 + 0.0722 x 0.5.
    if reflectances[0] != ["wall", "61%"]:
        fail(f"reflectances: {reflectances}")
    print(f"{len(grids)} grids, {len(drawings)} drawings")


main()
