"""Plans of planes whose values are known, and the lines between these values."""

import math
import re

import numpy as np
import pytest
from conftest import COLOURS, grid_of

pytest.importorskip("jinja2")
pytest.importorskip("contourpy")
from photile_report import plans
from photile_report.pages import Report

BEGIN, METRE = 58, 160  # pixels of the plan of a plane of 3 x 2 m, at 1:25


def plan(record, lux, name="desk", **colours):
    record["grids"] = [grid_of(name, lux)]
    record["report"]["colours"].update(colours)
    return Report(record).plans()[0]


def isolines(svg):
    return re.findall(r'stroke-width="1.5"[^>]* d="([^"]*)"', svg)


def check_runs_at(path, x):
    places = [float(place) for place in re.findall(r"[ML]([0-9.]+) ", path)]
    assert len(places) >= 2
    assert places == pytest.approx([x] * len(places), abs=0.01)


def numbers(svg, size):
    return re.findall(rf'font-size="{size}"[^>]*>([^<]*)<', svg)


def test_each_cell_has_the_colour_of_its_value_and_its_number(record):
    svg = plan(record, [50, 100, 150, 200, None, 1000], scale=200)
    colours = re.findall('fill="(#[0-9a-f]+)" shape-rendering', svg)
    assert colours == [f"#{math.floor(255 * min(lux / 200, 1) + 0.5):02x}0000"
                       for lux in (50, 100, 150, 200, 1000)]
    assert numbers(svg, 9) == ["50", "100", "150", "200", "1000"]


def test_the_legend_has_the_middles_of_its_steps_the_label_and_the_planes_name(record):
    svg = plan(record, [1, 2, 3, 4, 5, 6], 'a <desk> & "more"', scale=200, steps=4)
    assert "a &lt;desk&gt; &amp; &#34;more&#34;, 1:25</text>" in svg and ">lux</text>" in svg
    assert re.findall(r'<text x="[0-9.]+" y="[0-9.]+">([0-9.]+)</text>', svg) == [
        "25", "75", "125", "175"]


def test_isolines_of_a_slope_run_where_it_has_the_steps_of_the_standard(record):
    svg = plan(record, [100, 200, 300] * 2, scale=500, steps=1)
    lines = isolines(svg)
    assert len(lines) == 2 and ">3.00</text>" in svg
    check_runs_at(lines[0], BEGIN + METRE)  # 150 lux
    check_runs_at(lines[1], BEGIN + 1.5 * METRE)  # 200 lux


def test_isolines_alone_lie_in_the_middles_of_the_legends_steps(record):
    lines = isolines(plan(record, [100, 200, 300] * 2, scale=500, steps=1, contours="isolines"))
    assert len(lines) == 1
    check_runs_at(lines[0], BEGIN + 2 * METRE)  # 250 lux


def test_a_level_has_its_number_beside_those_of_cells_or_none(record):
    hill = [200, 100, 100, 100, 100, 100]
    # Its place is on the middle line between values, less than 12 pixels from 198 of the first.
    for level, seen in ((150, ["150"]), (198, [])):
        assert numbers(plan(record, hill, scale=2 * level, steps=1, contours="isolines"), 11) == seen


@pytest.mark.parametrize("width, depth, scale", [(6, 5, "50"), (7, 5, "75"), (4, 11, "75"),
                                                 (120, 80, "1000")])
def test_a_plan_has_the_largest_scale_at_which_it_fits_on_a_page(record, width, depth, scale):
    record["grids"][0]["plane"].update(u=[width, 0, 0], v=[0, 0, -depth])
    svg = Report(record).plans()[0]
    wide, high = (float(re.search(rf'{side}="([0-9.]+)mm"', svg)[1]) for side in ("width", "height"))
    assert wide <= 180 and high <= 190 and f"working plane, 1:{scale}<" in svg


def test_a_narrow_plan_is_as_wide_as_its_title(record):
    record["grids"][0].update(name="a plane with a name that is much longer than it is wide")
    record["grids"][0]["plane"]["u"] = [0.1, 0, 0]
    assert float(re.search('viewBox="0 0 ([0-9]+) ', Report(record).plans()[0])[1]) > 20 + 7 * 55


def test_walls_lamps_crosses_and_the_room_are_drawn(record):
    grid = record["grids"][0]
    grid["plan"] = {"reach": 1, "walls": "M-0.5 -0.5L3.5 -0.5", "furniture": "M1 1L2 1",
                    "lamps": [{"number": 7, "position": [1.5, 1]}], "room": [[-0.5, -0.5], [3.5, 2.5]]}
    grid["blank"] = [{"position": [0.5, 0.75, -0.5], "reason": "x"}]
    grid["sensors"][5]["mark"] = "y"
    svg = Report(record).plans()[0]
    # At 1:40 a metre is 100 pixels; the corner lies a metre within what is shown.
    assert 'transform="matrix(100 0 0 -100 158.00 348.00)" d="M-0.5 -0.5L3.5 -0.5"' in svg
    assert '<circle cx="308.00" cy="248.00"' in svg and ">7</text>" in svg
    assert ">4.00</text>" in svg and ">3.00</text>" in svg
    assert svg.count('class="crosses" d="M200.00 290.00') == 1 and svg.count("M400.00 190.00") == 1


def test_steps_of_illuminance_are_those_of_en_12464_1():
    assert plans.illuminance_steps(40, 1200) == [50, 75, 100, 150, 200, 300, 500, 750, 1000]
    assert plans.illuminance_steps(300, 500) == [] == plans.illuminance_steps(0, 0)
    assert len(plans.illuminance_steps(0, 1e-3)) < 20


def test_values_between_middles_keep_those_given_follow_slopes_and_leave_gaps():
    y, x = np.mgrid[0:4, 0:5] + 0.5
    values = 3 * x - 2 * y + 10
    fine, per_cell = plans.refined(values)
    v, u = np.mgrid[0:fine.shape[0], 0:fine.shape[1]] / per_cell + 0.5
    assert per_cell > 1 and fine == pytest.approx(3 * u - 2 * v + 10)
    values[0, 0] = 100  # a peak is kept, whatever its neighbours are
    values[1, 2] = np.nan
    fine, _ = plans.refined(values)
    assert fine[0, 0] == 100 and np.isnan(fine[per_cell, 2 * per_cell - 1])
    assert fine[-1, -1] == pytest.approx(3 * 4.5 - 2 * 3.5 + 10)


def field(record, columns, rows, value, **colours):
    y, x = np.mgrid[0:rows, 0:columns] + 0.5
    grid = grid_of("hill", list(value(x, y).ravel()), columns, rows)
    return plans.Plan(grid, [sensor["lux"] for sensor in grid["sensors"]], "", {**COLOURS, **colours})


def test_isolines_of_few_values_are_curves_not_chords(record):
    """A ring of 4 cells radius on 12 x 12: chords leave its circle by several hundredths."""
    drawn = field(record, 12, 12, lambda x, y: 100 - (x - 6) ** 2 - (y - 6) ** 2, scale=168, steps=1,
                  contours="isolines")  # 84
    (_, path), = drawn.isolines
    places = np.array(re.findall(r"([0-9.]+) ([0-9.]+)", path), float)
    metre = drawn.frame[2] / 12
    middle = [drawn.frame[0] + 6 * metre, drawn.frame[1] + 6 * metre]
    assert np.hypot(*(places - middle).T) / metre == pytest.approx(4, abs=0.01)


@pytest.mark.parametrize("scale, wanted", [(150, math.pi * (40**2 - 10**2)), (400, 0)])
def test_the_band_of_a_hill_is_a_ring_or_nothing(record, scale, wanted):
    """0.4 to 0.6 of the scale: 60 to 90 lux are 40 to 10 m from the top."""
    drawn = field(record, 80, 80, lambda x, y: 100 - np.hypot(x - 40, y - 40), scale=scale, steps=1,
                  contours="bands")
    area, metre = 0.0, drawn.frame[2] / 80
    for _, path in drawn.bands:
        for loop in path.split("Z")[:-1]:
            x, y = np.array(re.findall(r"([0-9.]+) ([0-9.]+)", loop), float).T / metre
            area += (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
    assert abs(area) == pytest.approx(wanted, rel=0.005)


def test_posterized_values_have_the_colour_of_their_step():
    steps, filled = (plans.Scale({**COLOURS, "contours": kind}, 0) for kind in ("steps", "cells"))
    for value, middle in ((2.01, 2.5), (2.99, 2.5), (40, 7.5)):
        assert steps.colour(value * 125) == filled.colour(middle * 125)
    assert filled.colour(5000) == filled.colour(1000) and filled.colour(-5) == filled.colour(0)
    assert plans.Scale({**COLOURS, "scale": 0}, 123).top == 123
    logarithmic = plans.Scale({**COLOURS, "decades": 2}, 0)
    assert [logarithmic.value_at(share) for share in (0, 0.5)] == pytest.approx([10, 100])
    assert plans.automatic_top(np.arange(1.0, 101.0)) == 98 and plans.automatic_top(np.zeros(3)) == 0
    assert plans.rounded_top(97, 8) == pytest.approx(128) and plans.rounded_top(0, 8) == 0
