"""Photon maps, held against a search of all photons in double precision."""

import numpy as np
import pytest

import photile

K, RADIUS = 50, 0.1
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def cloud(count=4_000):
    """Photons on a floor and a wall, and some in the air between."""
    random = np.random.default_rng(5)
    place = random.uniform(0, 1, (count, 3)).astype(np.float32)
    place[: count // 2, 2] = 0
    place[count // 2 : count - 200, 0] = 0
    normals = np.zeros_like(place)
    normals[: count // 2, 2] = 1
    normals[count // 2 :, 0] = 1
    flux = random.uniform(0, 1, (count, 3)).astype(np.float32)
    lights = random.integers(0, 3, count)
    return place, normals, flux, lights


def queries(normals=True):
    random = np.random.default_rng(6)
    points = random.uniform(0, 1, (200, 3))
    points[:100, 2] = 0
    points[100:, 0] = 0
    facing = np.zeros_like(points)
    facing[:100, 2] = 1
    facing[100:, 0] = 1
    return np.float32(points), facing if normals else None


def squared_distances(points, positions, allowed):
    """All pairs in double precision; infinity where they are too far or face elsewhere."""
    squares = ((points[:, None].astype(float) - positions[None].astype(float)) ** 2).sum(axis=2)
    return np.where(allowed & (squares <= RADIUS**2), squares, np.inf)


@pytest.mark.parametrize("photons_per_cell", [4, 1e6])
def test_nearest_is_that_of_all_pairs(photons_per_cell):
    positions, normals, _, _ = cloud()
    points, facing = queries()
    maps = photile.PhotonMaps(positions, normals=normals, radius=RADIUS,
                              photons_per_cell=photons_per_cell)
    found = maps.nearest(points, facing, K)
    truth = squared_distances(points, positions, facing @ normals.T > 0.5)
    expected = np.sort(truth, axis=1)[:, :K]
    assert np.array_equal(np.isinf(found.squared_distance), np.isinf(expected))
    near = np.isfinite(expected)
    assert near.any() and not near.all()
    assert np.allclose(found.squared_distance[near], expected[near], rtol=1e-4, atol=1e-9)
    # The photons named are those at the distances told.
    rows = np.minimum(found.photons, len(positions) - 1)
    named = np.take_along_axis(truth, rows.astype(np.int64), axis=1)
    assert np.allclose(named[near], found.squared_distance[near], rtol=1e-4, atol=1e-9)
    assert np.all(found.photons[~near] == photile.NONE)


# A national grid, in metres: floats lie half a metre apart there.
FAR = np.array([560_000.0, 5_600_000.0, 0.0])


@pytest.mark.parametrize("layout", [np.asarray, lambda places: places.tolist()], ids=["array", "list"])
def test_photons_far_from_the_origin_have_the_neighbours_that_they_have_near_it(layout):
    random = np.random.default_rng(1)
    positions, points = random.random((5_000, 3)), random.random((20, 3))
    maps = photile.PhotonMaps(layout(positions + FAR), radius=1.0)
    found = maps.nearest(layout(points + FAR), k=10)
    squares = ((points[:, None] - positions[None]) ** 2).sum(axis=2)
    assert np.array_equal(found.photons, np.argsort(squares, axis=1)[:, :10])
    assert np.allclose(found.squared_distance, np.sort(squares, axis=1)[:, :10], rtol=1e-4)
    near = photile.PhotonMaps(positions, radius=1.0).irradiance(points, k=10)
    assert np.allclose(maps.irradiance(layout(points + FAR), k=10), near, rtol=1e-3)


def test_photons_too_far_apart_for_floats_are_refused():
    here, there = np.random.default_rng(3).random((2, 500, 3))
    positions = np.concatenate([here, there + FAR])
    with pytest.raises(photile.InputError, match="positions: photon"):
        photile.PhotonMaps(positions, radius=0.5)
    photile.PhotonMaps(positions, radius=100.0)
    photile.PhotonMaps(np.float32(positions), radius=0.5)  # floats are what they are


def test_no_photons_are_no_neighbours():
    maps = photile.PhotonMaps(np.empty((0, 3)), radius=1.0)
    found = maps.nearest([[0, 0, 0]], k=3)
    assert np.all(found.photons == photile.NONE) and np.all(np.isinf(found.squared_distance))
    assert not maps.irradiance([[0, 0, 0]]).any()
    assert len(maps) == 0
    with pytest.raises(photile.Error, match="radius"):
        photile.PhotonMaps(np.empty((0, 3)))


def test_irradiance_is_flux_over_the_disc_through_the_kth():
    positions, normals, flux, lights = cloud()
    points, facing = queries()
    maps = photile.PhotonMaps(positions, flux, normals=normals, lights=lights, radius=RADIUS)
    found = maps.irradiance(points, facing, K)
    assert found.shape == (200, 3, 3) and found.dtype == np.float32
    truth = squared_distances(points, positions, facing @ normals.T > 0.5)
    for point in range(0, 200, 7):
        order = np.argsort(truth[point])[:K]
        full = np.isfinite(truth[point, order[-1]])
        counted = order[:-1] if full else order[np.isfinite(truth[point, order])]
        area = np.pi * (truth[point, order[-1]] if full else RADIUS**2)
        for light in range(3):
            own = counted[lights[counted] == light]
            expected = flux[own].astype(float).sum(axis=0) / area
            assert np.allclose(found[point, light], expected, rtol=2e-3), (point, light)


def test_photons_of_a_scene_give_the_light_of_a_lamp(plate):
    photons = photile.trace(plate, 400_000, seed=2)
    maps = photile.PhotonMaps(photons, neighbours=500)
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0]])
    up = np.broadcast_to([0, 0, 1], points.shape)
    found = maps.irradiance(points, up, k=500)[:, 0] @ LUMINANCE * photons.power
    squares = (points**2).sum(axis=1) + 4
    expected = 1000 / (4 * np.pi) * 2 / squares**1.5  # I cos / r^2
    assert found == pytest.approx(expected, rel=4 / np.sqrt(500))


@pytest.mark.parametrize(
    "call, message",
    [(lambda m: m.nearest([[0, 0, np.nan]], [[0, 0, 1]]), "number"),
     (lambda m: m.nearest([[0, 0]], [[0, 0, 1]]), "points"), (lambda m: m.nearest([[0, 0, 0]]), "normals"),
     (lambda m: m.nearest([[0, 0, 0]], [[0, 0, 1]], k=0), "neighbours"),
     (lambda m: m.nearest([[0, 0, 0]], [[0, 0, 1]], radius=2 * RADIUS), "radius"),
     (lambda m: m.irradiance([[0, 0, 0]], [[0, 0, 1]], kernel="cube"), "cube")],
)
def test_what_is_wrong_with_a_query(call, message):
    positions, normals, _, _ = cloud(1_000)
    maps = photile.PhotonMaps(positions, normals=normals, radius=RADIUS)
    with pytest.raises(photile.Error, match=message):
        call(maps)


@pytest.mark.parametrize("wrong", [{"radius": 0}, {"radius": -1.0}, {"photons_per_cell": 0},
                                   {"flux": np.ones((5, 3))}, {"lights": [0.5] * 1_000},
                                   {"lights": [-1] * 1_000}, {"device": "no such device"}])
def test_what_is_wrong_with_photons(wrong):
    positions, _, _, _ = cloud(1_000)
    with pytest.raises(photile.Error) as error:
        photile.PhotonMaps(positions, **{"radius": RADIUS, **wrong})
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("layout", [
    np.asfortranarray,
    lambda points: np.repeat(points, 2, axis=0)[::2],
    lambda points: points.astype(">f4"),
    lambda points: np.frombuffer(b"0" + points.tobytes(), np.float32, offset=1).reshape(-1, 3),
    lambda points: points.astype(float),
    lambda points: points.tolist(),
    lambda points: np.ma.masked_array(points),
], ids=["columns", "every other row", "big-endian", "unaligned", "double", "list", "masked"])
def test_points_are_the_same_in_every_layout(layout):
    positions, _, _, _ = cloud()
    points, _ = queries(normals=False)
    maps = photile.PhotonMaps(layout(positions), radius=RADIUS)
    found = maps.nearest(layout(points), k=K)
    expected = np.sort(squared_distances(points, positions, True), axis=1)[:, :K]
    assert np.allclose(found.squared_distance, expected, rtol=1e-4, atol=1e-9)


def test_no_points_have_no_neighbours():
    positions, _, _, _ = cloud(1_000)
    maps = photile.PhotonMaps(positions, radius=RADIUS)
    found = maps.nearest(np.empty((0, 3)), k=K)
    assert found.photons.shape == (0, K) and found.squared_distance.dtype == np.float32
    assert maps.irradiance(np.empty((0, 3))).shape == (0, 1, 3)
    assert len(maps) == 1_000 and maps.radius == RADIUS
    assert maps.statistics["photons"] == 1_000
