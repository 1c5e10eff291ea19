"""Layouts of luminaires: fields in rooms whose walls are known, and light that has a closed form."""

import json

import numpy as np
import pytest
from conftest import run_photile

from photile.arrangements import Designer, Room

SQUARE, L_SHAPE = [(0, 0), (6, 0), (6, 6), (0, 6)], [(0, 0), (8, 0), (8, 3.4), (3, 3.4), (3, 6), (0, 6)]
ANGLES = np.arange(0, 91, 5)
CANDELA = 1000 * np.cos(np.radians(ANGLES)).clip(0)  # Lambertian
IES = (f"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {len(ANGLES)} 1 1 2 0.05 0.05 0\n1 1 25\n"
       f"{' '.join(map(str, ANGLES))}\n0\n{' '.join(f'{x:.4f}' for x in CANDELA)}\n")


def pairs(columns, rows):
    return np.array(list(np.ndindex(columns, rows)))


def turned(points, degrees):
    angle = np.radians(degrees)
    return np.array(points) @ [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]


def to_walls(points, corners):
    """Metres from points to the walls between corners, anticlockwise; negative is beyond a wall."""
    corners = np.array(corners, float)
    ways = np.roll(corners, -1, axis=0) - corners
    normals = np.stack([-ways[:, 1], ways[:, 0]], axis=1) / np.hypot(*ways.T)[:, None]
    return ((np.array(points)[..., None, :] - corners) * normals).sum(axis=-1)


def to_walls_of_l(points):
    """Metres to the nearest wall of L_SHAPE, or less."""
    arms = ([(0, 0), (x, 0), (x, y), (0, y)] for x, y in ((8, 3.4), (3, 6)))
    return np.max([to_walls(points, arm).min(axis=-1) for arm in arms], axis=0)


def room_of(corners, to_wall=None):
    """A room 3 m high with a plane at 0.75 m; x and y of the plan are x and -z of the file."""
    to_wall = to_wall or (lambda points: to_walls(points, corners).min(axis=-1))
    low, cell = np.min(corners, axis=0), 0.05
    columns, rows = np.round((np.max(corners, axis=0) - low) / cell).astype(int)
    floor = to_wall(low + cell * (pairs(columns, rows) + 0.5)).reshape(columns, rows).T > 0
    walls = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1) - low
    return Room(np.array([low[0], 0.75, -low[1]]), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
                -0.75, 2.25, 30.0, np.array([cell, cell]), floor, walls)


def test_luminaires_hang_below_slopes():
    plane = {"origin": [2, 1.8, 0], "u": [2, 0, 0], "v": [0, 0, -6], "columns": 2, "rows": 1, "cells": [0, 1]}
    room = room_of(SQUARE).with_obstacles({"grids": [{"plane": plane}, {"plane": plane | {"cells": [1]}}]})
    assert list(room.is_clear(np.array([[1.9, 3], [2.1, 3], [3.1, 3], [3.9, 3], [4.1, 3]]))) == [0, 0, 1, 1, 0]


def middles(entries):
    """x, -z of all luminaires of a list."""
    found = []
    for entry in entries:
        x, _, z = entry["position"]
        count = np.array(entry.get("count", [1, 1]))
        steps = (pairs(*count) - (count - 1) / 2) * entry.get("spacing", 0)
        found += (turned(steps, entry.get("rotation", 0)) + [x, -z]).tolist()
    return np.array(sorted(found))


@pytest.mark.parametrize("degrees, across", [(0, False), (0, True), (25, True), (-40, False)])
def test_a_field_is_half_a_spacing_from_the_walls(degrees, across):
    corners = turned([(0, 0), (4, 0), (4, 7), (0, 7)], degrees)
    entries = Designer(room_of(corners), 2.2, {"name": "a"}, across).field(5, 2).entries  # five along the 7 m
    assert [entry["count"] for entry in entries] == [[2, 5] if across else [5, 2]]
    distances = np.sort(to_walls(middles(entries), corners), axis=0)
    symmetric = [np.repeat([0.7, 2.1, 3.5, 4.9, 6.3], 2), np.repeat([1.0, 3.0], 5)] * 2
    assert distances == pytest.approx(np.stack(symmetric, axis=1), abs=0.005)


def test_what_is_not_over_the_floor_is_left_out():
    designer = Designer(room_of(L_SHAPE, to_walls_of_l), 2.2, {"name": "a"})
    kept = middles(designer.field(4, 2).entries)  # the second of the upper row is over a wall
    assert kept == pytest.approx(np.array([(1, 1.5), (1, 4.5), (3, 1.5), (5, 1.5), (7, 1.5)]))
    assert designer.field(4, 3).count == 7  # the last two of the middle row light too little floor
    for count, columns, rows in designer.fields(3)[:20]:
        kept = middles(designer.field(columns, rows).entries)
        assert len(kept) == count and to_walls_of_l(kept).min() >= min(2 / columns, 1.5 / rows, 0.3) - 0.05


def laid_out(folder, options):
    words = (f"room.obj --luminaire lamp.ies -o out.json --inside 1,1,-1 {options} -- "
             "--rays 64 --repeats 2 --photons 1000 --spacing 0.5").split()
    return run_photile("layout", *words, cwd=folder)


def make_room(folder, corners, *cabinets):
    """A black room 3 m high as OBJ, cabinets 2.3 m high in it, and a luminaire beside it."""
    lines = ["mtllib room.mtl", "usemtl black"]
    for outline, height in [(corners, 3), *((cabinet, 2.3) for cabinet in cabinets)]:
        around = -np.arange(2 * len(outline), len(outline), -1)
        top, after = around + len(outline), np.roll(around, -1)
        faces = [around, top[::-1], *np.stack([around, top, np.roll(top, -1), after], axis=1)]
        lines += [f"v {x} {y} {-z}" for y in (0, height) for x, z in outline]
        lines += [f"f {' '.join(map(str, face))}" for face in faces]
    (folder / "room.obj").write_text("\n".join([*lines, ""]))
    (folder / "room.mtl").write_text("newmtl black\nKd 0 0 0\n")
    (folder / "lamp.ies").write_text(IES)


def mean_lux(columns, rows):
    """Of a field in a black room of 6 m x 6 m, at points of 0.5 m half a metre or more from the walls."""
    points, lamps = 0.75 + 0.5 * pairs(10, 10), (pairs(columns, rows) + 0.5) * 6 / (columns, rows)
    polar = np.arctan(np.linalg.norm(points[:, None] - lamps, axis=-1) / 2.245)  # 5 mm below the ceiling
    return (np.interp(np.degrees(polar), ANGLES, CANDELA) * np.cos(polar) ** 3 / 2.245**2).sum(axis=1).mean()


def test_the_smallest_field_that_meets_the_target_is_found(tmp_path):
    make_room(tmp_path, SQUARE)
    fields = Designer(room_of(SQUARE), 2.245, {}).fields(3)  # spacings as equal as can be
    assert fields[:5] == [(4, 2, 2), (6, 2, 3), (8, 2, 4), (9, 3, 3), (12, 3, 4)] and (72, 8, 9) in fields
    target = (max(mean_lux(2, 2), mean_lux(2, 3), mean_lux(2, 4)) + mean_lux(3, 3)) / 2
    run = laid_out(tmp_path, f"--target Em={target:.3f}")
    (entry,) = json.loads((tmp_path / "out.json").read_text())
    assert entry["count"] == [3, 3] and entry["position"] == pytest.approx([3, 2.995, -3])
    utilance, number = run.stdout.split("utilance ")[1].split()[:2]  # of 2 x 2 onto the 5 m x 5 m measured
    assert float(utilance[:-1]) == pytest.approx(mean_lux(2, 2) * 25 / (4 * np.pi * 1000), rel=0.01)
    assert float(number) == pytest.approx(4 * target / mean_lux(2, 2), rel=0.01)
    found = run.stdout.split("9 luminaires, 3 x 3, 2.00 x 2.00 m apart: Em ")[1]
    assert float(found.split()[0]) == pytest.approx(mean_lux(3, 3), rel=0.01)
    assert f"power: 225 W, {225 / 36:.3g} W/m2, " in found and f"target Em={target:.3f}: met\n" in found


def test_luminaires_hang_and_aim_as_asked_for(tmp_path):
    pytest.importorskip("contourpy")  # for the plan
    # Of the five, one is 0.2 m above a cabinet; the other cabinet is beside one.
    make_room(tmp_path, L_SHAPE, *([(x, 1), (x + 0.8, 1), (x + 0.8, 2), (x, 2)] for x in (6.6, 3.5)))
    run = laid_out(tmp_path, "--field 4x2 --suspension 0.5 --aim 3,0.75,-1.5 --plan plan.svg")
    entries = json.loads((tmp_path / "out.json").read_text())
    assert run.returncode == 0 and "4 x 2 (4 left out)" in run.stdout and "<svg" in (tmp_path / "plan.svg").read_text()
    assert [entry["position"][1] for entry in entries] == pytest.approx([2.5] * 4)
    assert np.allclose([np.add(entry["position"], entry["aim"]) for entry in entries], [3, 0.75, -1.5], atol=1e-3)


def test_bad_input_is_told_in_one_line(tmp_path):
    make_room(tmp_path, L_SHAPE)
    (tmp_path / "out.json").write_text("kept")
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    for code, told, options in (
            (2, "give --target", ""), (2, "target 'desk'", "--target desk"), (2, "'3x' is not", "--field 3x"),
            (2, "no room", "--line 2 --inside 20,1,1"), (2, "name a .json", "--line 2 -o room.obj"),
            (2, "copy it", "--line 2 --luminaire /dev/null"), (3, "no.ies", "--line 2 --luminaire no.ies"),
            (2, "another height", "--line 2 --suspension 2.3"), (2, "beyond the floor", "--circle 5,1"),
            (3, "out.json: luminaire 1", "--field 4x2 --luminaire room.obj")):
        run = laid_out(tmp_path, options)
        assert run.returncode == code and told in run.stderr and run.stderr.count("\n") == 1, run.stderr
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before
