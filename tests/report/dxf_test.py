"""Drawings in DXF of fields that are known, read back by ezdxf."""

import math

import numpy as np
import pytest
from conftest import grid_of

ezdxf = pytest.importorskip("ezdxf")
pytest.importorskip("jinja2")
from photile_report.pages import Report

HEIGHT, TOP, TURN = 3.0, 1000.0, math.radians(30)
RADII = {level: HEIGHT * math.sqrt(math.sqrt(TOP / level) - 1)
         for level in (50, 75, 100, 150, 200, 300, 500, 750)}


@pytest.fixture
def drawing(record, tmp_path):
    """A small lambertian source 3 m above the middle of 12 x 12 m, whose corner is (1, 0.75, -2): by the cos^4
    law E = 1000 lux / (1 + r^2 / h^2)^2. A luminaire turned by 30 degrees."""
    y, x = np.mgrid[0:24, 0:24] / 2 + 0.25
    grid = grid_of("floor", list((TOP / (1 + ((x - 6)**2 + (y - 6)**2) / HEIGHT**2)**2).ravel()), 24, 24)
    grid["plane"].update(origin=[1, 0.75, -2], u=[12, 0, 0], v=[0, 0, -12])
    along, across = (np.array([math.cos(turn), math.sin(turn)]) for turn in (TURN, TURN + math.pi / 2))
    outline = [(3, 4) + 0.6 * i * along + 0.15 * j * across for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    grid["plan"] = {"reach": 1, "walls": "M-0.500 -0.500L12.500 -0.500L12.500 2.000", "furniture": "",
                    "lamps": [{"number": 1, "position": [3, 4], "outline": outline}],
                    "room": [[-0.5, -0.5], [12.5, 12.5]]}
    record["luminaires"][0].update(position=[4, 2.5, -6], name="two\nlines")
    record["grids"] = [grid]
    written, = Report(record).drawings()
    assert Report(record).drawings() == [written]  # to the byte
    (tmp_path / "a.dxf").write_bytes(written)
    document = ezdxf.readfile(tmp_path / "a.dxf")
    assert not document.audit().has_errors and document.header["$INSUNITS"] == 6
    return document.modelspace()


def places(polyline):
    return np.array([point[:2] for point in polyline.get_points()])


def test_isolines_of_the_cos4_law_are_circles_with_their_levels_along_them(drawing):
    circles = [np.hypot(*(places(line) - (7, 8)).T) for line in drawing.query('LWPOLYLINE[layer=="ISOLINES"]')
               if line.closed and line.dxf.elevation == 0.75]
    assert sorted(circle.mean() for circle in circles) == pytest.approx(sorted(RADII.values()), abs=0.01)
    assert all(np.ptp(circle) < 0.02 for circle in circles)
    texts = {float(text.dxf.text): text.dxf.align_point for text in drawing.query('TEXT[layer=="ISOLINES"]')}
    assert set(texts) >= {100, 200, 300}
    for level in set(texts) & set(RADII):
        x, y, z = texts[level]
        assert math.hypot(x - 7, y - 8) == pytest.approx(RADII[level], abs=0.05) and z == 0.75


def test_rooms_points_and_luminaires_lie_where_the_scene_has_them(drawing):
    lines = [places(line).tolist() for line in drawing.query('LWPOLYLINE[layer=="ROOM"]')]
    assert lines == [[[0.5, 1.5], [13.5, 1.5], [13.5, 4]], [[0.5, 1.5], [13.5, 1.5], [13.5, 14.5], [0.5, 14.5]]]
    points = drawing.query('POINT[layer=="POINTS"]')
    assert len(points) == len(drawing.query('TEXT[layer=="VALUES"]')) == 576
    assert tuple(points[0].dxf.location) == pytest.approx((1.25, 2.25, 0.75))
    insert, = drawing.query('INSERT[layer=="LUMINAIRES"]')
    assert (*insert.dxf.insert, insert.dxf.rotation) == pytest.approx((4, 6, 2.5, 30))
    attributes = [insert.get_attrib_text(tag) for tag in ("TAG", "TYPE", "NAME")]
    assert attributes == ["A1", "Good & Ltd a.ies", "two lines"]
    outline, = drawing.doc.blocks.get("LUMINAIRE_A").query("LWPOLYLINE")
    assert np.abs(places(outline)) == pytest.approx(np.tile([0.6, 0.15], (4, 1)))
