"""Pages of records that are known, of templates of one's own, and of what others wrote."""

import json
import pathlib
import re
import subprocess
import sys
import tarfile
import time
import xml.etree.ElementTree as ElementTree

import pytest
from conftest import FOLDER, grid_of, measured

pytest.importorskip("jinja2")
pytest.importorskip("contourpy")
from photile_report import melanopic, pages, texts
from photile_report.included import Included
from photile_report.pages import Report

HOSTILE = "</style><script>alert(1)</script> {{ 7 * 7 }} \" ' \\ &amp;"
OBSERVER = {"name": "desk", "position": [0.5, 1.2, -0.5], "ugr": measured(17.2),
            "illuminance": measured(300, 2)}
JUDGED = {"grid": "working plane", "figure": "Em", "required": 150, "at_most": False, "value": 200.0,
          "standard_error": 1, "met": True, "doubtful": False}
PLANE = {"origin": [0, 1.2, 0], "u": [3, 0, 0], "v": [0, 0, -2], "columns": 3, "rows": 2}
# An L of 12 m2 around the grid of the record, with a foot beyond it.
L_ROOM = {"name": "101", "storey": "Level <1>", "area": 12, "height": 2.5, "floor": 0, "holes": [],
          "outline": [[x, 0, z] for x, z in ((0, 0), (3, 0), (3, -2), (9, -2), (9, -3), (0, -3))]}
OUTLOOK = {"view_out": [{"grid": "102", "points": 6, "level": "none", "angle": 20.5, "distance": distance,
                         "levels": {"none": 3, "minimum": 1, "medium": 2, "high": 0}} for distance in (7.5, None)],
           "sunlight": {"date": "2026-03-21", "level": "medium", "places": [{"position": [1, 2, 3], "hours": 3.25}]}}
FACTORS = {"unit": "DF %", "grids": [grid_of("desks", [1, 3, 3, 5], 2, 2)]}
FAR_ROOM = {**L_ROOM, "name": "102", "floor": 10}


def run(*arguments):
    """As the command does: the folder as it lies there, without what the environment says."""
    return subprocess.run([sys.executable, "-I", "-B", FOLDER, *map(str, arguments)], text=True,
                          capture_output=True, check=False)


def page_of(record, template=None):
    page = Report(record, template).page()
    ElementTree.fromstring(page)
    return page


def test_a_page_has_what_the_record_has(record):
    page = page_of(record)
    for part in ("<title>room &lt;1&gt;.gltf</title>", "<h1>Illuminance: room &lt;1&gt;.gltf</h1>",
                 "<dd>6.0 m\u00b2</dd>", "<dd>100 W</dd>", "16.67 W/m\u00b2, 8.33 W/m\u00b2 / 100 lx",
                 "working plane: 6 points, 3.00 x 2.00 m, 1.00 m apart", "12,000 lm", "Good &amp; Ltd",
                 "<td>61%</td>", "120 lm/W", "cd/klm", "photon maps, 20,000 photons, k = 50",
                 "<td>1.50, 2.20, -1.00</td>", "<dt>seed</dt><dd>1</dd>", "<dd>2026-11-28</dd>"):
        assert part in page, part
    assert "200 <span" in page and "0.500 <span" in page
    assert page == page_of(record)  # to the byte


def test_grids_of_several_rooms_have_no_room_of_their_own(record):
    other = json.loads(json.dumps(record["grids"][0]))
    record["grids"][0]["plan"] = {"room": [[-0.5, -0.5], [3.5, 2.5]]}
    record["grids"].append(other)
    for height, corners, one in ((0.75, [[-0.5, -0.5], [3.5, 2.5]], True), (0.1, [[-0.5, -0.5], [3.5, 2.5]], True),
                                 (3.75, [[-0.5, -0.5], [3.5, 2.5]], False), (0.75, [[3.6, -0.5], [7, 2.5]], False)):
        other["plan"], other["plane"]["origin"][1] = {"room": corners}, height
        page = page_of(record)
        assert ("<dd>6.0 m²</dd>" in page) == ("16.67 W/m²" in page) == one and "<dd>100 W</dd>" in page


def test_what_is_required_is_judged(record):
    record["target"] = {"name": "Em=150", "reference": "", "what": "", "ugr_limit": 19, "ra": 80,
                        "judgements": [JUDGED]}
    page = page_of(record)
    assert "at least 150" in page and ">met<" in page and "see photile glare" in page
    assert "90, by the luminaires&#39; data sheets" in page and "<b>" not in page
    record["photometry"][0]["ra"] = 0
    record["target"]["judgements"].append({
        **JUDGED, "grid": "desk", "figure": "UGR", "required": 19, "at_most": True, "value": 21.44, "met": False})
    page = page_of(record)
    assert "see the luminaires&#39; data sheets" in page and "<td>21.4</td>" in page
    assert "<b>not met</b>" in page and "see photile glare" not in page


def test_names_of_others_stay_text(record):
    record["scene"] = record["grids"][0]["name"] = record["luminaires"][0]["name"] = HOSTILE
    record["report"].update(project=HOSTILE, client=HOSTILE)
    record["warnings"] = [HOSTILE]
    page = page_of(record)
    assert "<script" not in page and "49 &#34;" not in page
    style = re.search("<style>(.*?)</style>", page, re.S)[1]
    assert "\\3c /style\\3e " in style and "script>" not in style


@pytest.fixture
def full(record):
    """A record that has all that reports show."""
    record["warnings"] = [
        "2 materials on 12 triangles reflect 90% of light and more, 'snow' 95%; white paint reflects 85%: set "
        "lower values with --reflectance", "light 'a lamp' reaches no point; it may hang outside the room, or "
        "above a closed ceiling", "3 of 9 points have no light at all; they may lie outside the room or inside "
        "objects"]
    grid = record["grids"][0]
    grid["blank"] = [{"position": [0.5, 0.75, -0.5], "reason": "less than 0.25 m from a surface"}]
    grid["sensors"][5]["mark"] = "inside an object or a closed room"
    grid["statistics"]["Emin"]["at_most"] = 150
    grid["lights"] = {"lamp": grid["statistics"]}
    for sensor in grid["sensors"]:
        sensor["lights"] = {"lamp": {"lux": sensor["lux"]}}
    record["grids"] += [grid_of("desk surroundings", [1, 2, 3, 4, 5, 6])]
    record["grids"] += [grid_of("cylindrical", [100] * 6), grid_of("102", [200] * 6, level=10.75)]
    record["photometry"][0]["data"] += [["power", "50 W, 120 lm/W"], ["colour temperature", "4000 K"]]
    record["targets"] = [
        {"name": "", "reference": f"EN 12464-1:2021, table {number}, required values", "what": what, "ugr_limit": 19,
         "ra": 80, "judgements": judgements} for number, what, judgements in (
            (34, "writing, typing, reading and data processing", [{**JUDGED, "grid": "north wall", "value": 12500.5},
                                                                 JUDGED]),
            (9, "circulation areas and corridors", [{**JUDGED, "grid": "102", "required": 100}]))]
    results = pathlib.Path(__file__).parent / "results"
    contents = [json.loads((results / name).read_text()) for name in ("observers.json", "planes.json")]
    record["report"] |= {"project": "P", "client": "C", "designer": "D", "included": [
        {"file": "", "content": content} for content in (*contents, [L_ROOM, FAR_ROOM], FACTORS, OUTLOOK)]}
    return record


def texts_of(page):
    return {text.strip() for text in ElementTree.fromstring(page.split("\n", 1)[1]).itertext()}


def test_a_page_in_german_has_no_english_words(full):
    """But names, units and symbols: what both languages have in common."""
    english = page_of(full)
    full["report"]["language"] = "de"
    german = page_of(full)
    same = {text for text in texts_of(english) & texts_of(german) if re.search("[A-Za-z]{2}", text)}
    names = {full["scene"], "lamp", "wall", "Good & Ltd", "A: a.ies", "Good & Ltd\na.ies", "photile 0.1",
             "LENI (EN 15193)", "Name", "Material", "UGR", "DGP", "sDA", "ASE", "DA", "cd/klm", "max", "min",
            "UDI", "IES LM-83", "101", "102", "Level <1>", "desks", "Uo", "Good & Ltd \u00b7 a.ies"}
    units = re.compile(r"[-<\d.,;:\u00b1\u00d7\u00b2/() m]*(lm|lm/W|W|kWh|lx|m)?")
    assert {text for text in same - names if not units.fullmatch(text)} == set()
    for text in ("Nutzebene, 1:50", "12.000 lm", "24,0 m\u00b2", "0,500", "8,33 W/m\u00b2; 4,17 W/m\u00b2 / 100 lx",
                 "4000 K", "desk: unmittelbarer Umgebungsbereich, 1:50", "1,50; 2,20; -1,00",
                 "\u00d7 1 Punkte sind ausgelassen: weniger als 0,25 m von einer Fläche."):
        assert text in texts_of(german), text


def test_every_word_of_templates_and_tables_is_translated_and_every_translated_one_is_used(full):
    words = json.loads((FOLDER / "words/de.json").read_text(encoding="utf-8"))
    said = re.findall(r'_\("((?:[^"\\]|\\.)*)"', (FOLDER / "templates/report.html").read_text())
    assert len(said) > 20
    report = Report(full)
    for table in (*report._results(), *report._lists(), report._building.table()):
        said += [table["heading"], *table["columns"], table.get("remark", "lux")]
    symbols, german_words = {"lux", "UGR", "DGP", "DA", "sDA", "ASE", "IES LM-83", "Uo"}, texts.Words("de")
    assert [one for one in said if german_words(one) == one and one not in symbols] == []
    assert {english for english, german in words.items() if english == german} == {"LENI (EN 15193)"}
    for english, german in words.items():
        assert sorted(re.findall("{.*?}", english)) == sorted(re.findall("{.*?}", german)), english
    files = [*(FOLDER.parents[2] / "host").rglob("*.[ch][ps][pv]"), *FOLDER.glob("*.py"), *FOLDER.glob("templates/*")]
    sources = re.sub(r'"\s*"|\s', "", " ".join(file.read_text(encoding="utf-8") for file in files))
    unused = [english for english in words if not english.endswith(" wall") and not any(
        re.sub(r"\s", "", part) in sources for part in re.split(r"{.*?}|: |; ", english) if len(part) > 1)]
    assert unused == []


def test_templates_of_ones_own_replace_and_extend_those_of_photile(record, tmp_path):
    (tmp_path / "words").mkdir()
    (tmp_path / "words/fr.json").write_text('{"Key figures": "Valeurs clés"}')
    (tmp_path / "logo.svg").write_text("<svg/>")
    (tmp_path / "report.html").write_text(
        '{% extends "photile/report.html" %}{% block head %}<h1>Firm</h1>'
        '<img alt="" src="{{ embedded("logo.svg") }}"/>{% endblock %}')
    record["report"]["language"] = "fr"
    page = page_of(record, str(tmp_path))
    assert "<h1>Firm</h1>" in page and "data:image/svg+xml;base64,PHN2Zy8+" in page
    assert "Valeurs clés" in page and "working plane: 6 points" in page
    for bad, said in (("{% broken", "report.html"), ('{{ embedded("../secret") }}', "secret"),
                      ("{{ ''.__class__.__mro__[1].__subclasses__() }}", "unsafe")):
        (tmp_path / "report.html").write_text(bad)
        with pytest.raises(pages.BadInput, match=said):
            Report(record, str(tmp_path)).page()
    with pytest.raises(pages.BadInput, match="not a folder"):
        Report(record, str(tmp_path / "none"))
    record["report"]["language"] = "xx"
    with pytest.raises(pages.UnknownLanguage, match="en, de, fr"):
        Report(record, str(tmp_path))


def test_results_of_other_commands_are_included(record):
    observers = [{**OBSERVER, "name": f"desk {i}", "ugr": measured(15 + i / 10)} for i in range(20)]
    observers.append({**OBSERVER, "ugr": None, "position": [1.5, 1.2, -0.5]})
    year = [{"name": "desks", "mean_lux": 812.3, "DA": 0.61, "sDA": 0.8, "target_lux": 300,
             "standard_errors": {"DA": 0.004}, "EN 17037": {"target_lux": 310, "minimum_target_lux": 120},
             "ASE": 0.1, "lamps": [{"kilowatt_hours": 44}], "plane": PLANE, "sensors": [
                 {"position": [0.5 + i, 1.2, -0.5], "DA": 0.2, "UDI": {"100 to 300": 0.1, "300 to 3000": 0.5},
                  "sun_hours": 20, "median_lux": lux} for i, lux in enumerate((299, 310, 500))]}]
    year[0]["EN 17037"]["level"] = "minimum"
    record["report"]["included"] = [
        {"file": "glare.json", "content": {"observers": observers, "plane": PLANE}},
        {"file": "year.json", "content": year}]
    page = page_of(record)
    for part in ("Glare (the worst 12 of 21 observers)", "16.9 \u00b1 0.1", "the highest UGR",
                 "DA 300 lux", "UDI 100 to 3000 lux", "61.0 \u00b1 0.4%", "7.3 kWh/(m\u00b2 a), 44 kWh / a",
                 "<td>preferred</td><td>10.0%</td><td>met</td>", "sun, line at 250 h", "median lux (EN 17037)",
                 "<td>67% / 100%</td><td>33% / 67%</td><td>0% / 33%</td><td>minimum</td>"):
        assert part in page, part
    assert "desk 7<" not in page
    record["grids"] = []
    assert len(Report(record).plans()) == 3


@pytest.mark.parametrize("content", [
    {}, 1, [1], {"observers": [], "plane": 1}, {"observers": [{"name": "x"}]},
    {"observers": [], "plane": {**PLANE, "u": [0, 0, 0]}},
    {"observers": [], "plane": {**PLANE, "u": [1, 0], "v": [0, 1], "origin": [0, 0]}},
    {"observers": [], "plane": {**PLANE, "columns": 99999, "rows": 99999}}])
def test_what_is_no_result_is_refused_by_name(record, content):
    record["report"]["included"] = [{"file": "b.json", "content": content}]
    with pytest.raises(pages.BadInput, match="b.json: this is neither a result.*photile glare"):
        Report(record)


def test_results_that_fuzzing_gathered_are_read_or_refused(record):
    """When C++ read them."""
    folder = pathlib.Path(__file__).parent
    texts_of_all = [file.read_bytes() for file in sorted((folder / "results").iterdir())]
    with tarfile.open(folder / "results.tar.xz") as archive:
        texts_of_all += [archive.extractfile(member).read() for member in archive if member.isfile()]
    read = 0
    for text in texts_of_all:
        try:
            content = json.loads(text)
        except (ValueError, RecursionError):
            continue
        record["report"]["included"] = [{"file": "fuzzed.json", "content": content}]
        try:
            tables = Report(record)._included.tables
        except pages.BadInput:
            continue
        assert all(len(row) == len(table["columns"]) for table in tables for row in table["rows"])
        read += 1
    assert read > 0


def test_contents_name_each_part_of_a_long_report(record):
    assert 'class="page contents"' not in page_of(record)
    record["grids"] *= 3
    root = ElementTree.fromstring(page_of(record).split("\n", 1)[1])
    entries = {link.get("href"): link.text for link in root.iter("a")}
    assert entries == {"#" + part.get("id"): part.text for part in root.iter("h2") if part.get("id")}
    assert "Glossary" in entries.values()


def test_each_room_of_a_building_has_a_row_and_a_page(record):
    record["targets"] = [{"name": name, "reference": "EN", "what": what, "ugr_limit": 0, "ra": 0, "judgements": [
        {**JUDGED, "grid": grid, "required": required, "met": required < 200}]} for name, what, grid, required in (
            ("corridor", "corridors", "working plane", 150), ("Em=300", "", "102", 300))]
    record["grids"].append(grid_of("102", [100] * 6, level=10.75))
    record["report"]["included"] = [{"file": "", "content": [L_ROOM, FAR_ROOM]}]
    page = re.sub(r"\n\s*", "", page_of(record))
    for part in ("<td>12.0</td><td>corridors</td><td>200 (150)</td><td>0.50</td><td>met</td>",
                 "<td>12.0</td><td>Em=300</td><td>100 (300)</td><td>1.00</td><td><b>not met</b></td>",
                 "<th>Em, lux (at least)</th>", "<dt>target</dt><dd>EN: corridors</dd>",
                 "<td>102</td><td>Level &lt;1&gt;</td>", "<dt>target met</dt><dd>1 / 2</dd>", "<dd>24.0 m\u00b2</dd>",
                 "<dd>8.33 W/m\u00b2, 4.17 W/m\u00b2 / 100 lx</dd>", "<td>A1</td><td>lamp</td><td>point</td><td>101"):
        assert part in page, part
    assert page.count('class="room"') == 2 and ">9.00</text>" in page and page.count("<dd>100 W</dd>") == 2
    places = pages.np.array([[1, 0.7, -1], [8, 0.7, -2.5], [8, 0.7, -1], [1, 3.2, -1], [1, -0.2, -1]])
    assert Report(record)._building.rooms[0].room.holds(places).tolist() == [True, True, False, False, False]


def test_daylight_factors_have_levels_by_the_light_outdoors(record):
    record["report"]["included"] = [{"file": "", "content": FACTORS}]
    row, = Report(record)._results()[0]["rows"]
    assert row == ["desks", "3.00%", "3.00%", "1.00%", "10,000", "30,000", "50,000"]
    record["report"]["outdoor_lux"] = 10000  # targets of 3% and 1%, 5% and 3%, 7.5% and 5%
    assert Report(record)._results()[0]["rows"][0][4:] == ["75% / 100%", "25% / 75%", "0% / 25%", "minimum"]
    del record["report"]["outdoor_lux"]
    year = json.loads((pathlib.Path(__file__).parent / "results" / "daylight.json").read_text())
    year[0]["EN 17037"]["median_outdoor_lux"] = 10000
    record["report"]["included"].append({"file": "", "content": year})
    assert Report(record)._results()[0]["rows"][0][-1] == "minimum"
    page = page_of({**record, **FACTORS})
    assert "<h1>Daylight factors: room" in page and "List of parts" not in page and "cd/klm" not in page


def test_melanopic_light_is_that_of_the_luminaires_colours(record):
    eyes = grid_of("cylindrical", [100, 200, 600, 100, 200, 600])
    record["grids"].append(eyes)
    assert melanopic.melanopic_table(record) is None  # the file states no colour
    record["photometry"][0]["data"].append(["colour temperature", "4103 K"])
    row, = melanopic.melanopic_table(record)["rows"]
    assert row[1:] == ["300", "0.63", "190", "63", "33%", "33%"]
    warm = {**record["photometry"][0], "data": [["colour temperature", "2998 K"]], "kelvin": 2998}
    record["luminaires"][0]["kelvin"], stated = 2998, {**record, "photometry": [*record["photometry"], warm]}
    assert melanopic.melanopic_table(stated)["rows"][0][2] == "0.46"
    warm["maintenance_factor"] = record["luminaires"][0]["maintenance_factor"] = 0.85
    parts = Report(stated)._lists()[1]
    assert parts["columns"][3] == "maintenance factor" and [row[3] for row in parts["rows"]] == ["0.85", "", ""]
    assert parts["rows"][0][2] == ["a.ies", "2998 K"]
    del record["luminaires"][0]["kelvin"], record["luminaires"][0]["maintenance_factor"]
    record["luminaires"].append({"name": "sky", "position": None, "file": "", "lumens": 1})
    assert melanopic.melanopic_table(record) is None
    record["lights"] = [{"name": "sky"}, {"name": "all lamps"}]
    for sensor in eyes["sensors"]:
        sensor["lights"] = {name: {"lux": sensor["lux"] / 2} for name in ("sky", "all lamps")}
    assert melanopic.melanopic_table(record)["rows"][0][2:4] == ["0.82", "245"]
    record["photometry"][0]["data"][-1][1] = "2700 to 6500 K"
    assert melanopic.melanopic_table(record) is None and melanopic.ratio_of(1800) is None


def test_numbers_are_those_that_people_read():
    assert [texts.number(value, 4) for value in (12500.4, 0.58571, 9999.6, None)] == [
        "12500", "0.5857", "10000", "nan"]
    assert [texts.grouped(value, 4) for value in (6000, 11990, 0.5857)] == ["6000", "11,990", "0.5857"]
    assert texts.glare(9.9) == "<10" and texts.glare(19.26) == "19.3"
    assert Included().kilowatt_hours == 0


def test_the_program_writes_whole_files_and_says_what_is_wrong_in_a_line(record, tmp_path):
    results, page, plan = (tmp_path / name for name in ("r.json", "a.html", "p.svg"))
    record["grids"].append(grid_of("second", [1, 2, 3, 4, 5, 6]))
    record["scene"] = "\ud800 \x01"
    results.write_text(json.dumps(record))
    done = run(results, "--outdoor-lux", 9000, "-o", page, "-o", plan)
    assert (done.returncode, done.stderr) == (0, "")
    assert "<title>? ?</title>" in page.read_text(encoding="utf-8")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.html", "p-1.svg", "p-2.svg", "r.json"]
    del record["grids"][0]["statistics"]
    results.write_text(json.dumps(record))
    page.write_text("before")
    for arguments, code, said in (((results, "-o", page), 3, "r.json"), ((page, "-o", plan), 3, "a.html"),
                                  ((results, "-o", tmp_path / "no/a.svg"), 1, "a-1.svg"),
                                  ((results, "-o", tmp_path / "a.txt"), 2, ".html"),
                                  ((results, "--include", page, "-o", plan), 3, "a.html"),
                                  ((results, "--outdoor-lux", "none", "-o", plan), 2, "--outdoor-lux none")):
        done = run(*arguments)
        assert (done.returncode, done.stderr.count("\n")) == (code, 1), done.stderr
        assert done.stderr.startswith("photile.report: error: ") and said in done.stderr
    assert page.read_text() == "before"
    # Without Debian's packages: modules of the standard library alone.
    for more, package in ((("-o", page), "jinja2"), (("--honeybee", tmp_path), "numpy"), (("--ugr-table",), "numpy")):
        done = subprocess.run([sys.executable, "-I", "-S", "-B", FOLDER, results, *more], text=True,
                              capture_output=True, check=False)
        assert done.returncode == 1 and f"apt-get install python3-{package}" in done.stderr


def test_a_pdf_is_printed_without_fetching(record):
    pytest.importorskip("weasyprint")
    pdf = pages.printed(Report(record).page())
    assert pdf.startswith(b"%PDF")
    time.sleep(1.1)
    assert pages.printed(Report(record).page()) == pdf
    with_file = Report(record).page().replace("<h1>", '<img src="file:///etc/passwd"/><h1>')
    assert len(pages.printed(with_file)) < len(pdf) + 200
