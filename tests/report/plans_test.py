"""Plans of planes whose values are known, and the lines between these values."""

import math
import re

import numpy as np
import pytest
from conftest import COLOURS, grid_of

pytest.importorskip("jinja2")
pytest.importorskip("contourpy")
from photile_report import isolines as lines_of
from photile_report import luminaires, plans, scale
from photile_report.pages import Report

BEGIN, METRE = 46, 200  # pixels of the plan of a plane of 3 x 2 m, at 1:20


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
    return re.findall(rf'font-size="{size}"(?![^>]*border)[^>]*>([^<]*)<', svg)


def test_each_cell_has_the_colour_of_its_value_and_its_number(record):
    svg = plan(record, [50, 100, 150, 200, None, 1000], scale=200)
    colours = re.findall('fill="(#[0-9a-f]+)" shape-rendering', svg)
    assert colours[:5] == [f"#{math.floor(255 * min(lux / 200, 1) + 0.5):02x}0000"
                           for lux in (50, 100, 150, 200, 1000)]
    assert numbers(svg, 9) == ["50", "100", "150", "200", "1000"]


def test_the_legend_has_the_edges_of_steps_or_the_levels_of_isolines(record):
    svg = plan(record, [1, 2, 3, 4, 5, 6], 'a <desk> & "more"', scale=200, steps=4)
    assert "a &lt;desk&gt; &amp; &#34;more&#34;, 1:20</text>" in svg and ">lux</text>" in svg
    assert re.findall('class="legend"[^>]*>([0-9.]+)<', svg) == ["0", "50", "100", "150", "200"]
    svg = plan(record, [1, 2, 3, 4, 5, 6], contours="isolines")
    assert re.findall('class="legend"[^>]*>([0-9.]+)<', svg) == ["25", "75", "125", "175"]


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


def corners(label):
    half = 0.5 * np.array([label.width, 0.7 * label.size])  # as high as digits
    return half * [[1, 1], [-1, 1], [-1, -1], [1, -1]] @ rotation(math.radians(label.turned)) + (label.x, label.y)


def rotation(angle):
    """Of rows."""
    return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])


def apart(a, b):
    """Whether a side of one separates two rectangles."""
    return any(max(a @ side) < min(b @ side) or max(b @ side) < min(a @ side)
               for side in (a[1] - a[0], a[2] - a[1], b[1] - b[0], b[2] - b[1]))


def test_numbers_lie_along_their_isolines_and_no_text_on_another(record):
    """A hill with 1,600 values: numbers of isolines are tangents of circles around its top."""
    lamps = {"reach": 0, "lamps": [{"number": i, "position": [8 + 2 * i, 20], "outline": [
        [8 + 2 * i, 19], [9 + 2 * i, 19], [9 + 2 * i, 21], [8 + 2 * i, 21]]} for i in range(10)]}
    drawn = field(record, 40, 40, lambda x, y: 1000 - 40 * np.hypot(x - 20, y - 20), plan=lamps)
    boxes = [corners(label) for label in drawn.labels]
    assert all(apart(a, b) for i, a in enumerate(boxes) for b in boxes[:i])
    levels = [label for label in drawn.labels if label.size == 11]
    assert {label.text for label in levels} >= {"200", "300", "500"}
    for label in levels:
        across, up = np.array([1, -1]) * ((np.array([label.x, label.y]) - drawn.frame[:2]) / drawn.cell - 20)
        assert math.hypot(across, up) == pytest.approx((1000 - float(label.text)) / 40, abs=0.3)
        tangent = math.degrees(math.atan2(across, up))
        assert (label.turned - tangent + 45) % 180 - 45 == pytest.approx(0, abs=6) and abs(label.turned) <= 90


@pytest.mark.parametrize("width, depth, denominator, sheet", [
    (6, 5, 50, (180, 226)), (7.9, 5, 50, (180, 226)), (12, 5, 50, (267, 143)), (4, 11, 100, (180, 226)),
    (1, 0.5, 5, (267, 143)), (0.7, 0.9, 5, (180, 226)), (100, 80, 1000, (180, 226))])
def test_a_plan_has_the_largest_scale_at_which_it_fits_on_a_page(record, width, depth, denominator, sheet):
    record["grids"][0]["plane"].update(u=[width, 0, 0], v=[0, 0, -depth])
    svg = Report(record).plans()[0]
    wide, high = (float(re.search(rf'{side}="([0-9.]+)mm"', svg)[1]) for side in ("width", "height"))
    assert wide <= sheet[0] and high <= sheet[1] and f"working plane, 1:{denominator}<" in svg
    assert f'{4000 * width / denominator:.2f}" height="{4000 * depth / denominator:.2f}" fill="none"' in svg


def test_a_narrow_plan_is_as_wide_as_its_title(record):
    record["grids"][0].update(name="a plane with a name that is much longer than it is wide")
    record["grids"][0]["plane"]["u"] = [0.1, 0, 0]
    assert float(re.search('viewBox="0 0 ([0-9]+) ', Report(record).plans()[0])[1]) > 20 + 7 * 55


def test_walls_lamps_crosses_and_the_room_are_drawn(record):
    grid = record["grids"][0]
    grid["plan"] = {"reach": 1, "walls": "M-0.5 -0.5L3.5 -0.5", "furniture": "M1 1L2 1",
                    "lamps": [{"number": 1, "position": [1.5, 1]}], "room": [[-0.5, -0.5], [3.5, 2.5]],
                    "north": [1, 0]}
    grid["blank"] = [{"position": [0.5, 0.75, -0.5], "reason": "x"}]
    grid["sensors"][5]["mark"] = "y"
    svg = Report(record).plans()[0]
    # At 1:50 a metre is 80 pixels; the corner lies a metre within what is shown.
    assert 'transform="matrix(80 0 0 -80 126.00 274.00)" d="M-0.5 -0.5L3.5 -0.5"' in svg
    assert 'class="luminaire" d="M250.00 194.00L' in svg and ">A1</text>" in svg
    assert ">4.00</text>" in svg and ">3.00</text>" in svg and "rotate(90.0)" in svg
    assert svg.count('class="crosses" d="M158.00 226.00') == 1 and svg.count("M318.00 146.00") == 1


def test_a_round_opening_has_the_area_of_its_rectangle_in_the_scene():
    x, y = luminaires.outline_of(np.array([[0, 0], [2, 0], [2, 1], [0, 1]]) @ rotation(0.5), True).T
    assert abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2 == pytest.approx(2, rel=0.006)


def test_types_have_the_tags_of_the_list_of_parts(record):
    lamp = record["luminaires"][0]
    files = ["", "b.ies", "a.ies", "b.ies", ""]
    record["luminaires"] = [{**lamp, "number": i, "name": f"lamp_{i}_1", "file": file}
                            for i, file in enumerate(files, 1)] + [{**lamp, "number": 9, "position": None}]
    record["photometry"] += [{**record["photometry"][0], "name": "b.ies"}]
    found = luminaires.Luminaires(record)
    assert [found.tag(i) for i in range(1, 6)] == ["C1", "A2", "B3", "A4", "C5"]
    assert [(part.tag, part.name) for part in found.parts] == [("A", "b.ies"), ("B", "a.ies")]
    assert [luminaires.tag(i) for i in (0, 25, 26, 51, 52, 702)] == ["A", "Z", "AA", "AZ", "BA", "AAA"]


@pytest.mark.parametrize("lux, top, steps", [(80, 100, 10), (101, 150, 6), (700, 750, 5), (1900, 2000, 8)])
def test_the_scale_ends_at_a_step_of_the_standard_that_all_plans_share(record, lux, top, steps):
    dim = np.full(6, lux / 4)
    fitted = scale.fitted({**COLOURS, "scale": 0}, [dim, np.full(6, lux)])
    assert (fitted["scale"], fitted["steps"]) == (pytest.approx(top), steps)
    record["grids"] = [grid_of("dim", list(dim)), grid_of("bright", [lux] * 6)]
    record["report"]["colours"]["scale"] = 0
    for svg in Report(record).plans():
        assert float(re.findall('class="legend"[^>]*>([0-9.]+)<', svg)[-1]) == pytest.approx(top)
    assert scale.fitted(COLOURS, [dim]) == COLOURS


def test_steps_of_illuminance_are_those_of_en_12464_1():
    assert scale.illuminance_steps(40, 1200) == [50, 75, 100, 150, 200, 300, 500, 750, 1000]
    assert scale.illuminance_steps(300, 500) == [] == scale.illuminance_steps(0, 0)
    assert len(scale.illuminance_steps(0, 1e-3)) < 20


def test_values_between_middles_keep_those_given_follow_slopes_and_leave_gaps():
    y, x = np.mgrid[0:4, 0:5] + 0.5
    values = 3 * x - 2 * y + 10
    fine, per_cell = lines_of.refined(values)
    v, u = np.mgrid[0:fine.shape[0], 0:fine.shape[1]] / per_cell + 0.5
    assert per_cell > 1 and fine == pytest.approx(3 * u - 2 * v + 10)
    values[0, 0] = 100  # a peak is kept, whatever its neighbours are
    values[1, 2] = np.nan
    fine, _ = lines_of.refined(values)
    assert fine[0, 0] == 100 and np.isnan(fine[per_cell, 2 * per_cell - 1])
    assert fine[-1, -1] == pytest.approx(3 * 4.5 - 2 * 3.5 + 10)


def field(record, columns, rows, value, plan=None, **colours):
    y, x = np.mgrid[0:rows, 0:columns] + 0.5
    grid = grid_of("hill", list(value(x, y).ravel()), columns, rows, plan=plan)
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
    steps, filled = (scale.Scale({**COLOURS, "contours": kind}) for kind in ("steps", "cells"))
    for value, middle in ((2.01, 2.5), (2.99, 2.5), (40, 7.5)):
        assert steps.colour(value * 125) == filled.colour(middle * 125)
    assert filled.colour(5000) == filled.colour(1000) and filled.colour(-5) == filled.colour(0)
    logarithmic = scale.Scale({**COLOURS, "decades": 2})
    assert [logarithmic.value_at(share) for share in (0, 0.5)] == pytest.approx([10, 100])
    assert scale.automatic_top(np.arange(1.0, 101.0)) == 98 and scale.automatic_top(np.zeros(3)) == 0
