"""The nearest of bare points, held against a search of all pairs in double precision."""

import numpy as np
import pytest

import photile

RANDOM = np.random.default_rng(7)
LATTICE = np.indices((9, 9, 9)).reshape(3, -1).T  # many points at the same distance
CLOUDS = {
    "volume": RANDOM.random((3_000, 3)),
    "plane": RANDOM.random((3_000, 3)) * [1, 1, 0],
    "line": np.linspace(0, 1, 500)[:, None] * [1, 2, -3],
    "one point": np.ones((200, 3)),
    "coincident": np.repeat(RANDOM.random((50, 3)), 40, axis=0),
    "lattice": LATTICE,
    "dense among sparse": RANDOM.random((3_000, 3)) * np.repeat([[1e-4], [1e3]], 1_500, axis=0),
    "huge and far": RANDOM.random((500, 3)) * 1e10 + 8e10,
    "a single one": [[1, 2, 3]],
}


@pytest.mark.parametrize("k, most", [(1, np.inf), (50, np.inf), (50, 0.2), (4_000, np.inf)])
@pytest.mark.parametrize("name", CLOUDS)
def test_neighbours_are_those_of_all_pairs(name, k, most):
    points = np.float32(CLOUDS[name])
    low, high = points.min(axis=0), points.max(axis=0)
    around = RANDOM.uniform(1.3 * low - 0.3 * high, 1.3 * high - 0.3 * low, (20, 3))
    queries = np.float32(np.concatenate([points[:: len(points) // 20 + 1], around, [9 * high]]))
    indices, distances = photile.neighbours(points, queries, k, max_distance=most)
    assert indices.dtype == np.uint32 and distances.dtype == np.float32
    truth = np.sqrt(((queries[:, None].astype(float) - points) ** 2).sum(axis=2))
    padded = np.pad(np.where(truth <= most, truth, np.inf), [(0, 0), (0, k)], constant_values=np.inf)
    assert np.allclose(distances, np.sort(padded, axis=1)[:, :k], rtol=1e-6, atol=0)
    assert np.allclose(np.take_along_axis(padded, indices.astype(int), 1), distances, rtol=1e-6, atol=0)
    assert np.array_equal(indices == len(points), np.isinf(distances))
    assert all(len(np.unique(row[row < len(points)])) == (row < len(points)).sum() for row in indices)


@pytest.mark.parametrize("points", [LATTICE, np.repeat(LATTICE, 10, axis=0), LATTICE + 5_600_000.0])
def test_points_at_the_same_distance_come_by_their_rows(points):
    indices, _ = photile.neighbours(points, points[::20], 60)
    squares = ((points[::20, None] - points) ** 2).sum(axis=2)
    assert np.array_equal(indices, np.argsort(squares, axis=1, kind="stable")[:, :60])


def test_normals_decide_which_points_count():
    points, up = np.float32(CLOUDS["plane"]), np.float32([[0, 0, 1]])
    normals = np.where(np.arange(3_000)[:, None] % 2, up, -up)
    indices, _ = photile.neighbours(points, points[:5], 2_000, normals, np.repeat(up, 5, axis=0))
    assert np.all(indices[:, :1_500] % 2 == 1) and np.all(indices[:, 1_500:] == 3_000)


@pytest.mark.parametrize("wrong, message", [
    ({"points": [[0, 0, 0], [0, np.nan, 0]]}, "point 1 lies"), ({"points": np.empty((0, 3))}, "no points"),
    ({"points": [[0, 0]]}, "points"), ({"points": [[0, 0, 1e13], [0, 0, -1e13]]}, "point 0 lies"),
    ({"points": [[0, 0, 0], [1e6 + 0.1, 0, 0]], "queries": [[0.2, 0, 0]]}, "points: point"),
    ({"queries": [[0, 0, np.inf]]}, "query 0 lies"), ({"queries": [1, 2]}, "queries"),
    ({"k": 0}, "neighbours"), ({"k": -1}, "neighbours"), ({"k": 1_000_001}, "neighbours"), ({"k": 1.5}, "k"),
    ({"max_distance": 0}, "distance"), ({"max_distance": np.nan}, "distance"), ({"angle": 181}, "angle"),
    ({"normals": [[0, 0, 1]]}, "0 normals for 1 queries"), ({"device": "no such"}, "no such"),
    ({"normals": [[0, 0, 2]], "query_normals": [[0, 0, 1]]}, "point 0 has a normal")])
def test_what_is_wrong_is_said_in_a_line(wrong, message):
    with pytest.raises(photile.Error, match=message) as error:
        photile.neighbours(**{"points": [[0, 0, 0]], "queries": [[0, 0, 0]], "k": 1, **wrong})
    assert "\n" not in str(error.value)
    assert photile.neighbours([[0, 0, 0]], np.empty((0, 3)), 2)[1].shape == (0, 2)
