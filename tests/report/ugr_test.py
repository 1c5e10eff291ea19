"""UGR tables against published factors and a sum of their own."""

import json
import math

import numpy as np
import pytest

from photile_report import ugr


def lamp(polar, azimuth, candela, opening, flux=1000.0):
    x, y, shape = opening
    return {"flux": flux, "axes": [[1, 0, 0], [0, 1, 0], [0, 0, -1]], "polar": list(np.radians(polar)),
            "azimuth": list(np.radians(azimuth)), "intensity": candela, "spacing": 0.25,
            "per_thousand_lumens": False, "opening": {"x": x, "y": y, "heights": [0] * 4, "shape": shape}}


def lambertian(lumens, diameter):
    candela = list(lumens / math.pi * np.cos(np.radians(range(91)))) * 2
    return lamp(range(91), [0, 360], candela, (diameter, diameter, "upright cylinder"), lumens)


def rated(record, spacing=0.25):
    return {view: np.array(rows, float) for view, rows in ugr.table(ugr.Luminaire(record), spacing).items()}


def test_transfer_factors_are_those_of_cie_190_table_5_for_4h_x_8h():
    published = [[0.115, 0.211, 0.307], [0.106, 0.117, 0.283], [0.100, 0.187, 0.211], [0.093, 0.104, 0.196],
                 [0.081, 0.092, 0.114]]
    for room in ((4, 8), (8, 4)):
        found = np.array([ugr.transfer_factors(room, each) for each in ugr.reflectances])
        assert np.abs(found - published).max() < 6e-4


def test_a_disc_has_the_ratings_of_a_sum_over_its_array():
    lumens, diameter, h = 2000, 0.3, 2
    # A lambertian source is as bright from everywhere. The room is 8H across, 4H along.
    area = math.pi / 4 * diameter**2
    x, y = np.meshgrid(np.arange(-7 * h / 2, 4 * h, h), np.arange(h / 2, 4 * h, h))
    r = np.sqrt(x * x + y * y + h * h)
    sigma, tau = np.degrees(np.arccos(y / r)), np.degrees(np.arctan2(abs(x), h))
    guth = np.exp((35.2 - 0.31889 * tau - 1.22 * np.exp(-2 * tau / 9)) * 1e-3 * sigma
                  + (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma)
    contrast = np.sum(((lumens / (math.pi * area))**2 * area * h / r**3 / guth**2)[abs(x) <= 3 * y])
    # The floor below a Lambertian array that fills the ceiling gets nearly the form factor, 0.7043: k = 2.67.
    floor, walls, _ = ugr.transfer_factors((8, 4), (0.7, 0.5, 0.2))
    indirect = lumens * 32 / (2 * h * (8 + 4) * h) * (0.7043 * floor + (1 - 0.7043) * walls)
    expected = 8 * math.log10(0.25 * math.pi / indirect * contrast)
    table = rated(lambertian(lumens, diameter), 1)
    assert [table[view][12][0] for view in ugr.views] == pytest.approx(2 * [expected], abs=0.05)


def test_twice_the_flux_is_8_log10_2_worse_and_twice_the_area_as_much_better():
    once, twice, wide = (rated(lambertian(*each)) for each in ((1000, 0.3), (2000, 0.3), (1000, 0.3 * 2**0.5)))
    assert twice["crosswise"] - once["crosswise"] == pytest.approx(8 * math.log10(2), abs=1e-4)
    assert once["endwise"] - wide["endwise"] == pytest.approx(8 * math.log10(2), abs=1e-4)


def test_a_long_lamp_that_shines_to_its_sides_alone_glares_crosswise():
    candela = [value for side in (200, 20, 200, 20, 200) for value in (300 if side > 20 else 20, side, side)]
    # C0 is across the length, as in EULUMDAT, or along it, as an LM-63 file may have it.
    across, along = (rated(lamp([0, 60, 90], [0, 90, 180, 270, 360], candela, (x, y, "box")))
                     for x, y in ((0.1, 1.2), (1.2, 0.1)))
    assert across["crosswise"][10][0] > across["endwise"][10][0] + 3
    assert along["endwise"][10][0] > along["crosswise"][10][0] + 3


@pytest.mark.parametrize("shape, surface", [
    ("box", 2 * (0.3 * 0.4 + 0.3 * 0.2 + 0.4 * 0.2)), ("upright cylinder", math.pi * (0.3**2 / 2 + 0.3 * 0.2)),
    ("cylinder along x", math.pi * (0.3**2 / 2 + 0.3 * 0.2)), ("cylinder along y", math.pi * (0.3**2 / 2 + 0.3 * 0.2)),
    ("ellipsoid", math.pi * 0.3**2)])
def test_openings_cover_a_quarter_of_their_surface_in_the_mean_over_all_directions(shape, surface):
    # Cauchy's law of convex bodies.
    x, y, height = {"box": (0.3, 0.4, 0.2), "ellipsoid": (0.3, 0.3, 0.3), "cylinder along x": (0.2, 0.3, 0.3),
                    "cylinder along y": (0.3, 0.2, 0.3)}.get(shape, (0.3, 0.3, 0.2))
    record = lamp([0, 90], [0, 360], [1] * 4, (x, y, shape))
    record["opening"]["heights"] = 4 * [height]
    directions = np.random.default_rng(1).normal(size=(200_000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    assert ugr.Luminaire(record).projected_area(directions).mean() == pytest.approx(surface / 4, rel=5e-3)


def test_what_is_seen_beyond_85_degrees_from_below_does_not_count():
    texts = ugr.written(lamp([0, 85, 85.05, 90], [0, 360], [0, 0, 1000, 1000] * 2, (0.3, 0.3, "box")))
    assert texts[".txt"].splitlines()[4].split() == ["2H", "x", "2H", *"-" * 10]
    assert texts[".csv"].splitlines()[1] == "2,2" + 10 * ","
    assert json.loads(texts[".json"])["rooms"][0]["crosswise"] == 5 * [None]


def test_texts_have_a_row_for_each_room_and_uncorrected_values_are_of_1000_lm():
    dim = ugr.written(lambertian(20, 0.3))
    lines, content = dim[".txt"].splitlines(), json.loads(dim[".json"])
    assert lines[0] == "ceiling      0.70  0.70  0.50  0.50  0.30    0.70  0.70  0.50  0.50  0.30"
    assert lines[3] == "room         crosswise                       endwise" and len(lines) == 4 + 19
    assert lines[13].startswith("4H x 6H       <10   <10") and content["rooms"][9]["crosswise"][0] < 10
    uncorrected = ugr.written({**lambertian(20, 0.3), "per_thousand_lumens": True})
    more = json.loads(uncorrected[".json"])["rooms"][9]["crosswise"][0] - content["rooms"][9]["crosswise"][0]
    assert more == pytest.approx(8 * math.log10(50)) and "<10" not in uncorrected[".txt"]
