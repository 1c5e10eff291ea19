"""Grids, luminaires, skies, glare and years: the numbers of the command with the same seed."""

import datetime
import importlib.util
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import box

import photile

OFFICE = Path(__file__).resolve().parents[2] / "scenes" / "office"
ROOM = OFFICE / "office.gltf"
PANELS = {"file": str(OFFICE / "panel.ies"), "position": "ceiling", "count": [2, 1], "spacing": np.array([1.8, 0])}
QUICK = {"rays": 16, "repeats": 2}
DRAWS = all(map(importlib.util.find_spec, ("jinja2", "contourpy")))
reports = pytest.mark.skipif(not DRAWS, reason="apt-get install python3-jinja2 python3-contourpy")


def of_command(folder, *arguments):
    subprocess.run([os.environ["PHOTILE_COMMAND"], *map(str, arguments), "--rays", "16", "--repeats", "2",
                    "--quiet", "-o", folder / "a.json"], check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "a.json").read_text())


def panels_in(folder):
    (folder / "panel.ies").write_bytes((OFFICE / "panel.ies").read_bytes())
    (folder / "l.json").write_text(json.dumps([{**PANELS, "file": "panel.ies", "spacing": [1.8, 0]}]))
    return folder / "l.json"


@pytest.fixture
def weather(tmp_path):
    """A year of eight sunny hours each day, in Berlin."""
    days = [datetime.date(2026, 1, 1) + datetime.timedelta(number) for number in range(365)]
    rows = [f"2026,{day.month},{day.day},{hour},60,?,20,10,50,101325,0,0,300,0,{400 * sun},{150 * sun}" + ",0" * 19
            for day in days for hour in range(1, 25) for sun in [8 < hour < 17]]
    (tmp_path / "a.epw").write_text("\n".join(["LOCATION,a,b,c,d,e,52.5,13.4,1,30", *"bcdefg",
                                               "DATA PERIODS,1,1,Data,Sunday,1/1,12/31", *rows, ""]))
    return tmp_path / "a.epw"


def test_lux_on_planes_and_walls_is_that_of_the_command(tmp_path, weather):
    hour = datetime.datetime(2026, 6, 21, 12, 30)
    results = of_command(tmp_path, "measure", ROOM, "--plane", "floor+0.75", "--walls", "--photons", 5000,
                         "--weather", weather, "--time", "2026-06-21T12:30", "--set", "north=30",
                         "--reflectance", "wall*=0.4")
    room = photile.load(ROOM, weather=weather, time=hour, north=30, reflectance={"wall*": 0.4})
    grids = photile.grids(room, "floor+0.75", walls=True)
    measured = photile.measure(room, grids, photons_emitted=5000, **QUICK)
    assert [grid.name for grid in grids] == [grid["name"] for grid in results["grids"]] and len(grids) == 5
    for own, grid in zip(measured, results["grids"]):
        assert own.lux.tolist() == [sensor["lux"] for sensor in grid["sensors"]]
        assert own.statistics["Uo"] == tuple(grid["statistics"]["Uo"].values())
    assert np.nanmean(measured[0].map()) == pytest.approx(measured[0].statistics["Em"][0])


def test_glare_is_that_of_the_command(tmp_path):
    file = panels_in(tmp_path)
    room, same = (photile.load(ROOM, luminaires=which) for which in ([PANELS], file))
    assert room.layers == same.layers and len(room.lights) == 2
    options = ["glare", ROOM, "--luminaires", file, "--photons", 5000]
    results = of_command(tmp_path, *options, "--grid", "--spacing", 3)
    rated = photile.glare(room, photile.grids(room, "floor+1.2", spacing=3), photons_emitted=5000, **QUICK)
    assert rated.observers == results["observers"] and np.nanmax(rated.ugr) > 10 and np.isnan(rated.dgp).all()
    results = of_command(tmp_path, *options, "--camera", 0, "--picture-size", 32)
    rated = photile.glare(room, 0, picture_size=32, photons_emitted=5000, **QUICK)
    assert rated.observers == results["observers"] and 0 < rated.dgp[0] < 1
    assert set(map(len, rated.columns().values())) == {1}


def test_a_year_is_that_of_the_command(tmp_path, weather):
    results = of_command(tmp_path, "daylight", ROOM, "--plane", "floor+0.75", "--spacing", 2, "--weather", weather,
                         "--patches", 145, "--blinds", "pane=0.05", "--occupied", "9-17", "--seed", 7,
                         "--luminaires", panels_in(tmp_path), "--lamps-to", 400, "--lamp-efficacy", 80, "--light",
                         "panel=x2", "--photons", 5000, *(["-o", tmp_path / "a.html"] if DRAWS else []))
    room = photile.load(ROOM, sky=("overcast", 1000), luminaires=[PANELS])
    year, = photile.daylight(room, photile.grids(room, "floor+0.75", spacing=2), weather, patches=145,
                             blinds={"pane": 0.05}, occupied="9-17", seed=7, lamps_to=400, lamp_efficacy=80,
                             light={"panel": 2}, photons_emitted=5000, **QUICK)
    assert year.figures == results[0] and year.lux.shape == (len(year), 8760)
    assert 0 < year.figures["lamps"][0]["kilowatt_hours"] < year.figures["lamps"][0]["undimmed_kilowatt_hours"]
    assert np.allclose((year.lux[:, year.occupied] >= 300).mean(axis=1), year.autonomy)
    if DRAWS:
        photile.write_report(tmp_path / "b.html", year)
        assert (tmp_path / "b.html").read_bytes() == (tmp_path / "a.html").read_bytes()
    assert str(year.hours[year.occupied][0]) == "2005-01-01T09:30" and year.occupied.sum() == 8 * 365


SKY = "overcast", 9000
DESK = {"target": "office-desk", "project": "P"}
MOOD = {"photile_moods": 1, "moods": {"dusk": {"sky": {"power": 5e5, "unit": "lm"}, "ground": {"on": False}}}}


@reports
@pytest.mark.parametrize("ending, options, loading, measuring, reporting", [
    ("html", ["--sky", "overcast=9000", "--target", "office-desk", "--project", "P", "--rooms", "*"], {"sky": SKY}, {},
     DESK),
    ("html", ["--sky", "overcast=9000", "--target", "escape-route"], {"sky": SKY}, {"target": "escape-route"}, {}),
    ("html", ["--sky", "overcast=9000", "--mood", "dusk", "--light", "sky=x2"], {"sky": SKY},
     {"mood": "dusk", "light": {"sky": 2}}, {}),
    ("svg", ["--daylight-factor"], {"sky": SKY}, {"daylight_factor": True}, {})])
def test_a_report_is_that_of_the_command(tmp_path, ending, options, loading, measuring, reporting):
    (tmp_path / "moods.json").write_text(json.dumps(MOOD))
    moods = ["--moods", tmp_path / "moods.json"] if "mood" in measuring else []
    of_command(tmp_path, "measure", ROOM, "--plane", "floor+0.75", "--photons", 5000, *options, *moods,
               "-o", tmp_path / f"a.{ending}")
    room = photile.load(ROOM, **loading)
    grids = photile.grids(room, "floor+0.75", rooms="*" if "--rooms" in options else "")
    measured = photile.measure(room, grids, photons_emitted=5000, **QUICK, **measuring,
                               **({"moods": moods[1]} if moods else {}))
    photile.write_report(tmp_path / f"b.{ending}", measured, **reporting)
    assert (tmp_path / f"b.{ending}").read_bytes() == (tmp_path / f"a.{ending}").read_bytes()


@reports
def test_glare_and_daylight_factors_stand_in_a_report(tmp_path):
    room = photile.load(ROOM, luminaires=[PANELS])
    rated = photile.glare(room, photile.grids(room, "floor+1.2", spacing=3), photons_emitted=5000, **QUICK)
    photile.write_report(tmp_path / "a.html", rated)
    assert f"<td>{np.nanmax(rated.ugr):.1f} " in (tmp_path / "a.html").read_text()
    lux, factors = (photile.measure(room, photile.grids(room, "floor+0.75"), photons_emitted=5000, **QUICK, **more)
                    for more in ({}, {"daylight_factor": True}))
    outlook = photile.view_out(room, lux[0].grid), photile.sun_hours(room, "2026-03-20", site=(50, 0, 0))
    photile.write_report(tmp_path / "a.html", lux, factors, *outlook)
    told = f"<td>{factors[0].lux.mean():.2f}%</td>", "View out (EN 17037)", "Sunlight (EN 17037)"
    assert all(text in (tmp_path / "a.html").read_text() for text in told) and factors[0].unit == "%"


def test_the_sun_stands_where_the_hour_and_the_site_have_it():
    # Noon of the equinox on the equator: in the zenith, but for a degree.
    room = photile.load(ROOM, site=(0, 0, 0), time="2026-03-20T12:07", sun=50_000, ground=0)
    assert room.lights[-1].direction[1] < -np.cos(np.radians(1))


def test_luminaires_light_a_scene_of_arrays():
    panel = {**PANELS, "position": [2, 2.4, 2], "lumens": 1000, "name": "row"}
    room = photile.Scene(box(4, 4, 2.5), luminaires=[panel])
    assert room.layers == {"row": pytest.approx(2000)} and len(room.triangles) == 16
    assert photile.measure(room, [[2, 0.5, 2]], **QUICK, photons_emitted=5000).lux[0] > 100
