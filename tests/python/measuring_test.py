"""Lux at points."""

import numpy as np
import pytest

import photile


@pytest.mark.parametrize("integrator", ["photon-map", "path"])
def test_lux_below_a_lamp(plate, integrator):
    points = np.array([[0, 0, 0], [1, 0, 0.5], [3, 2, 1]], float)
    measured = photile.measure(
        plate, points, (0, 0, 2), integrator=integrator, rays=64, repeats=3, photons_emitted=2_000
    )
    towards = np.array([0, 0, 2]) - points
    squares = (towards**2).sum(axis=1)
    expected = 1000 / (4 * np.pi) * towards[:, 2] / squares**1.5
    assert measured.lux == pytest.approx(expected, rel=1e-4)
    assert len(measured) == 3 and np.all(measured.error <= 1e-4 * expected)
    least, most = measured.lux.min(), measured.lux.max()
    assert repr(measured) == f"<photile.Illuminance: 3 points, {least:.4g} to {most:.4g} lx>"


def test_each_light_and_the_error_of_their_sum(lamps):
    points = photile.grid([0.5, 0.5, 0.8], [3, 0, 0], [0, 2, 0], 3, 2)
    assert points.shape == (6, 3) and np.allclose(points[0], [1, 1, 0.8])
    measured = photile.measure(
        lamps, points, (0, 0, 1), rays=128, repeats=8, photons_emitted=20_000
    )
    by_light = sum(measured.by_light.values())
    assert np.allclose(measured.lux, by_light, rtol=1e-5)
    truth = photile.measure(lamps, points, (0, 0, 1), rays=4096, repeats=4, integrator="path")
    off = (measured.lux - truth.lux) / np.hypot(measured.error, truth.error)
    # Six readings of Student's law with 7 degrees of freedom, and the bias of density estimates.
    assert np.abs(measured.lux - truth.lux).max() < 0.03 * truth.lux.max()
    assert np.median(np.abs(off)) < 4
    table = measured.columns()
    assert list(table) == ["x", "y", "z", "lux", "error", "warm", "cold"]
    assert all(len(column) == 6 for column in table.values())


def test_maintenance_scales_everything(plate):
    one, other = (
        photile.measure(plate, [[0, 0, 0]], (0, 0, 1), rays=16, repeats=2, photons_emitted=1_000,
                        maintenance=factor)
        for factor in (1.0, 0.8)
    )
    assert other.lux == pytest.approx(0.8 * one.lux, rel=1e-5)
