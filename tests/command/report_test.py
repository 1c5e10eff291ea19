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


def check(condition, text):
    if not condition:
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
    targets = {f"#{element.get('id')}" for element in page.iter()}
    for element in page.iter():
        for name, value in element.attrib.items():
            check((name not in ("src", "href", "data") or value in targets) and "url(" not in value,
                  f"{element.tag} refers to {value}")
    check(not re.search(r"@import|url\(", words(page)), "the style refers to another file")


def check_figures(table, grid):
    """Each row against the statistics of the JSON: all lights together, then each."""
    rows = table.findall("tr")[1:]
    expected = [("all lights", grid["statistics"]), *grid["lights"].items()]
    check([row[0].text for row in rows] == [name for name, _ in expected], f"rows {[row[0].text for row in rows]}")
    for row, (name, statistics) in zip(rows, expected):
        for cell, figure in zip(row[1:], FIGURES):
            shown, truth = float(cell.text), statistics[figure]["value"]
            check(abs(shown - truth) <= 0.001 * abs(truth) + 0.0006, f"{name}, {figure}: {shown} for {truth}")
            error = float(words(cell[0]).lstrip("± "))
            check(abs(error - statistics[figure]["standard_error"]) <= 0.06 * error + 1e-9,
                  f"{name}, {figure}: an error of {error}")


def check_drawing(svg, title):
    """The title is there, and every word and bar lies within the drawing."""
    _, _, width, height = map(float, svg.get("viewBox").split())
    texts = svg.findall(f"{SVG}text")
    check(re.sub(r", 1:[0-9.]+$", "", texts[0].text) == title, f"the drawing {texts[0].text!r} for {title!r}")
    for text in texts:
        size = float(text.get("font-size", svg.get("font-size")))
        x, y, across = float(text.get("x")), float(text.get("y")), 0.55 * size * len(text.text)
        if "rotate" in text.get("transform", ""):
            within = x - size >= 0 and y - across / 2 >= 0 and y + across / 2 <= height
        else:
            left = x - across * {"middle": 0.5, "end": 1}.get(text.get("text-anchor"), 0)
            within = left >= 0 and left + across <= width and y - size >= 0 and y <= height
        check(within, f"{title}: '{text.text}' is cut off")
    for bar in svg.findall(f"{SVG}rect")[1:]:
        x, y, across, down = (float(bar.get(name)) for name in ("x", "y", "width", "height"))
        check(x + across <= width and y + down <= height, f"{title}: a rectangle reaches beyond the border")
    check(title == "Luminaires" or "lux" in [text.text for text in texts], f"{title}: the legend has no unit")


def main():
    with tempfile.TemporaryDirectory() as folder:
        text, record = measure(sys.argv[1], pathlib.Path(folder))
    check(text.startswith("<!DOCTYPE html>"), "no document type")
    page = ElementTree.fromstring(text)
    check_self_contained(page)
    check(page.find("head/title").text == "room & <lamps>.obj", f"the title is {page.find('head/title').text!r}")
    body = page.find("body")
    headings = [words(heading) for heading in body.iter("h2")]
    check("counter(pages)" in words(page.find("head/style")), "pages have no numbers")
    check("Key figures" in headings, f"{headings} have no key figures")
    headings = headings[headings.index("Contents") + 1:]
    grids = record["grids"]
    for heading, grid in zip(headings, grids):
        check(heading.startswith(f"{grid['name']}: {grid['points']} points"),
              f"{heading!r} is no heading of {grid['name']!r}")
    tables = list(body.iter("table"))[1:]
    planes = [grid for grid in grids if "plane" in grid]
    alone = [f"{grid['name']}: each light alone" for grid in planes]
    check(len(tables) == len(grids) + 3
          and headings[len(grids):-2] == [*alone, "Luminaires", "List of parts", "Reflectances"],
          f"{len(tables)} tables under {len(headings)} headings for {len(grids)} grids")
    for table, grid in zip(tables, grids):
        check_figures(table, grid)
    titles = [grid["name"] for grid in planes] + [light for grid in planes for light in grid["lights"]]
    titles.append("Luminaires")
    drawings = list(page.iter(f"{SVG}svg"))
    check(len(drawings) == len(titles), f"{len(drawings)} drawings, not {len(titles)}")
    for drawing, title in zip(drawings, titles):
        check_drawing(drawing, title)
    check(sum("mm" in drawing.get("width") for drawing in drawings) == len(PLANES) + 1, "the plans are at no scale")
    facts = {name.text: value.text for name, value in zip(body.iter("dt"), body.iter("dd"))}
    check(facts["illuminance"] == "planar" and facts["seed"] == "1", f"facts: {facts}")
    lamps, parts, reflectances = ([[cell.text for cell in row] for row in list(table.iter("tr"))[1:]]
                                  for table in tables[len(grids):])
    check([lamp[:2] for lamp in lamps] == [["A1", "left"], ["B2", "right"]] and lamps[0][3] == "-0.60, 0.99, 0.00",
          f"lamps: {lamps}")
    check([part[:3] for part in parts[:2]] == [["A", "1", "left"], ["B", "1", "right"]], f"parts: {parts}")
    # The wall's luminance: 0.2126 x 0.7 + 0.7152 x 0.6 + 0.0722 x 0.5.
    check(reflectances[0] == ["wall", "61%"], f"reflectances: {reflectances}")
    print(f"{len(grids)} grids, {len(drawings)} drawings")


main()
