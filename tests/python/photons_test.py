"""Photons of a scene."""

import numpy as np
import pytest
from conftest import box

import photile

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def test_light_stored_in_a_closed_box_is_a_geometric_series(furnace):
    # Each meeting with a wall stores the flux that is left: 1 + 0.5 + 0.25 + ... = 2.
    photons = photile.trace(furnace, 100_000, seed=3)
    assert (photons.flux @ LUMINANCE).sum() == pytest.approx(2, rel=0.01)
    assert photons.absorbed_flux == pytest.approx([1], abs=1e-6)
    assert photons.escaped_flux == pytest.approx([0], abs=1e-6)
    assert photons.emitted.sum() == 100_000


def test_paths_in_a_white_room_are_followed_to_their_end():
    # 1 + 0.99 + 0.99^2 + ... = 100; without what comes after 64 surfaces it were 47.
    white = photile.Scene(box(1, 1, 1), materials=[photile.Material("white", (0.99, 0.99, 0.99))],
                          lights=[photile.Light("walls", 600, "area", triangles=range(12))])
    photons = photile.trace(white, 5_000, seed=3)
    # A hundred surfaces a path, give or take a hundred: 1.4% for 5,000.
    assert (photons.flux @ LUMINANCE).sum() == pytest.approx(100, rel=0.07)


def test_photons_lie_on_their_triangles(lamps):
    photons = photile.trace(lamps, 5_000)
    corners = lamps.vertices[lamps.triangles[photons.triangle]].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    height = np.einsum("nc,nc->n", normals, photons.position - corners[:, 0])
    assert np.abs(height).max() < 1e-5
    sides = np.where(photons.side == 0, 1, -1)[:, None]
    assert np.allclose(photons.normal, sides * normals, atol=1e-6)


def test_each_lamp_has_its_photons(plate, lamps):
    photons = photile.trace(lamps, 20_000, quota="equal")
    assert photons.layer_names == ["warm", "cold"]
    assert photons.power.tolist() == [800, 500]
    by_lamp = np.bincount(photons.light, weights=photons.flux @ LUMINANCE)
    assert by_lamp == pytest.approx([2, 2], rel=0.05)
    assert np.all(photile.trace(plate, 100).light == 0)


def test_arrays_are_views_that_outlive_the_photons(lamps):
    photons = photile.trace(lamps, 1_000)
    for name in ("position", "flux", "light"):
        array = getattr(photons, name)
        assert np.shares_memory(array, getattr(photons, name)), name
        assert not array.flags.writeable
    position = photons.position
    expected = position.copy()
    del photons
    assert np.array_equal(position, expected)
    assert photile.trace(lamps, 100).incoming is None  # nothing is glossy


def test_a_structured_array_has_the_same_values(lamps):
    photons = photile.trace(lamps, 1_000)
    fields = np.asarray(photons)
    assert fields.dtype.names == ("position", "flux", "light", "triangle", "side")
    assert len(fields) == len(photons)
    assert np.array_equal(fields["position"], photons.position)
    assert np.array_equal(fields["triangle"], photons.triangle)


def test_the_seed_alone_decides(lamps):
    one, same, other = (photile.trace(lamps, 2_000, seed) for seed in (1, 1, 2))
    assert np.array_equal(one.position, same.position) and np.array_equal(one.flux, same.flux)
    assert not np.array_equal(one.position[:100], other.position[:100])


def test_photons_that_come_straight_may_be_left_out(plate):
    assert len(photile.trace(plate, 1_000, store_direct=False)) == 0


def test_a_scene_outlives_its_name():
    photons = photile.trace(photile.Scene(box(1, 1, 1), lights=[photile.Light("a", 1)]), 100)
    assert len(photons.normal) == len(photons)
