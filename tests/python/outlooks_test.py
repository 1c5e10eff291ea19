"""View out and hours of sun of EN 17037, against geometry that hides a known part."""

import json
import pathlib

import numpy as np
import pytest
from conftest import quad, run_photile

import photile

LAMP = photile.Light("lamp", 1, position=(2, 1, 2))
DEGREES_PER_HOUR = 15
WIDE, SILL, HEAD, FACE, PANE = 1.0, 1.1, 2.2, 4.0, 4.3  # metres; a wall of 0.3 m, the pane on its outer face


def upright(a, b, low, high):
    """A rectangle over a line of the floor plan."""
    (ax, az), (bx, bz) = a, b
    return quad([ax, low, az], [bx - ax, 0, bz - az], [0, high - low, 0])


def flat(left, right, near, far, height):
    return quad([left, height, near], [right - left, 0, 0], [0, 0, far - near])


def room(*more):
    """4 x 4 x 2.5 m, with a window in the middle of its wall to the south, and what stands around."""
    left, right = 2 - WIDE / 2, 2 + WIDE / 2
    walls = [flat(0, 4, 0, 4, 0), flat(0, 4, 0, 4, 2.5), *(upright(a, b, 0, 2.5) for a, b in (
        ((0, 0), (4, 0)), ((0, 0), (0, 4)), ((4, 0), (4, 4)), ((0, FACE), (left, FACE)), ((right, FACE), (4, FACE)))),
        upright((left, FACE), (right, FACE), 0, SILL), upright((left, FACE), (right, FACE), HEAD, 2.5),
        *(flat(left, right, FACE, PANE, height) for height in (SILL, HEAD)),
        *(upright((x, FACE), (x, PANE), SILL, HEAD) for x in (left, right)), *more]
    triangles = np.concatenate([*walls, upright((left, PANE), (right, PANE), SILL, HEAD)])
    pane = photile.Material("pane", interaction="glass", thin=True)
    return photile.Scene(triangles, materials=[photile.Material("wall"), pane], lights=[LAMP],
                         cameras=[photile.Camera((2, 1.2, 1), (2, 1.2, 3))],
                         triangle_materials=[0] * (len(triangles) - 2) + [1] * 2)


def test_a_wall_hides_the_sun_until_it_stands_above_it():
    # At the equinox on the equator the sun goes from east through the zenith to west.
    walls = photile.Scene(upright((1, -99), (1, 99), 0, 1), lights=[LAMP])
    sun = photile.sun_hours(walls, "2026-03-20", [[0, 0, 0]], site=(0, 0, 0), lowest_sun=11)
    assert sun.hours[0] == pytest.approx((180 - 45 - 11) / DEGREES_PER_HOUR, abs=0.05) and sun.level == "high"
    assert sun.sunlit.shape == (1, len(sun.times)) and sun.together == sun.hours[0]
    early = photile.sun_hours(walls, "2026-01-31", [[0, 0, 0]], site=(0, 0, 0))
    assert early.level == "" and early.hours[0] > 7


def test_reveals_hide_the_sun_from_the_reference_point_of_a_window():
    # At the equinox in 50 degrees north, the sun is to the south by sin 50 cos h, to the side by sin h.
    sun = photile.sun_hours(room(), "2026-03-20", site=(50, 0, 0), windows="pane")
    assert sun.points[0] == pytest.approx([2, max(1.2, SILL + 0.3), FACE], abs=0.03)
    depth = PANE - sun.points[0][2]
    hidden_from = np.degrees(np.arctan(WIDE / 2 * np.sin(np.radians(50)) / depth))
    assert sun.hours[0] == pytest.approx(2 * hidden_from / DEGREES_PER_HOUR, abs=0.05)


def test_the_view_is_as_wide_as_the_window_and_ends_at_the_house_opposite():
    house = upright((-99, PANE + 25), (99, PANE + 25), 0, 12)
    eyes = np.array([[2, 1.2, 1], [3.2, 1.2, 2], [2, 1.2, FACE + 0.2], [2, 1.2, 6]])
    view = photile.view_out(room(house), eyes, windows="pane")
    for eye, angle in zip(eyes[:3], view.angle):  # the reveal hides some, by steps of 1/64 of the window
        left, right = (np.arctan((2 + side - eye[0]) / ([FACE, PANE] - eye[2])) for side in (-WIDE / 2, WIDE / 2))
        if eye[2] < FACE:
            assert angle == pytest.approx(np.degrees(right.min() - left.max()), rel=1e-4 if eye[0] == 2 else 0.02)
    assert view.angle[3] == 0  # behind the pane
    assert view.distance[0] == pytest.approx(25, rel=0.01) and view.landscape[:3].all()
    # Under the head the line of the first eye meets the house at 1.2 + (2.2 - 1.2) 28.3 / 3.3 = 9.8 m.
    assert view.sky.tolist() == [False, True, True, False] and not view.ground[0] and view.levels[0] == "minimum"
    assert photile.view_out(room(house), eyes[:1]).angle == view.angle[:1]  # all glass is the pane
    assert set(map(len, view.columns().values())) == {4}


def test_a_screen_takes_its_part_of_the_view_and_the_horizon_is_landscape():
    half = photile.view_out(room(upright((2, 3), (3, 3), 0, 2.5)), [[2, 1.2, 1], [2, 1.2, 3.5]], windows="pane")
    assert half.angle[0] == pytest.approx(np.degrees(np.arctan(WIDE / 2 / (PANE - 1))), rel=0.02)
    assert half.angle[1] == pytest.approx(2 * np.degrees(np.arctan(WIDE / 2 / (PANE - 3.5))), rel=1e-4)
    assert np.isinf(half.distance).all() and half.landscape.all() and half.sky.all() and half.ground.all()
    assert half.levels.tolist() == ["none", "high"] and half.level == "none"


def test_what_faces_upwards_is_ground_and_what_is_near_is_no_layer():
    garden = flat(-99, 99, PANE, PANE + 99, -3)
    fence = upright((-99, PANE + 5), (99, PANE + 5), -3, 9)
    over, behind = (photile.view_out(room(*around), [[2, 1.5, 1]], windows="pane")
                    for around in ([garden], [garden, fence]))
    assert over.ground.all() and over.landscape.all() and over.level == "minimum"
    assert not (behind.ground.any() or behind.landscape.any()) and behind.level == "none"
    assert behind.distance == pytest.approx(5, rel=0.02)


def test_the_command_rates_rooms_of_a_file_as_the_functions_do(tmp_path):
    file, site = pathlib.Path(__file__).parents[2] / "scenes/office/office.gltf", (50, 0, 0)
    words = ("outlook", file, "--rooms", "room 1", "--date", "2026-03-20", "-o", tmp_path / "a.json")
    ran = run_photile(*words, "--site=50,0,0", check=True)
    scene = photile.load(file, sky=("uniform", 1))
    grid, = photile.grids(scene, "floor+1.2", rooms="room 1")
    view, sun = photile.view_out(scene, grid), photile.sun_hours(scene, "2026-03-20", site=site)
    assert json.loads((tmp_path / "a.json").read_text()) == {**view._content, **sun._content}
    assert f"room 1: view out {view.level}" in ran.stdout and "sun on 2026-03-20" in ran.stdout
    refused = run_photile(*words).stderr + run_photile(*words, "--site=1,1,1", "--lowest-sun=nan").stderr
    assert "--date" in refused and "lowest_sun: nan" in refused
