"""Scenes that the tests share, made of arrays."""

import os
import subprocess
import sys

import numpy as np
import pytest

import photile


def run_photile(*words, start=(os.environ.get("PHOTILE_COMMAND", "photile"),), **options):
    """The command, which starts the Python that runs the tests."""
    return subprocess.run([*start, *map(str, words)], capture_output=True, text=True,
                          env={**os.environ, "VIRTUAL_ENV": sys.prefix}, **options)


def quad(corner, u, v):
    """Two triangles whose front is on the side of u x v."""
    a, u, v = (np.asarray(x, float) for x in (corner, u, v))
    return np.array([[a, a + u, a + u + v], [a, a + u + v, a + v]])


def box(width, depth, height):
    """Twelve triangles whose fronts look inwards: floor, ceiling, four walls."""
    x, y, z = np.diag(np.array([width, depth, height], float))
    faces = [([0, 0, 0], x, y), (z, y, x), ([0, 0, 0], y, z), (x, z, y), ([0, 0, 0], z, x),
             (y, x, z)]
    return np.concatenate([quad(*face) for face in faces])


@pytest.fixture
def furnace():
    """A cube of 1 m whose walls shine and reflect 0.5: its radiance is the same everywhere."""
    return photile.Scene(box(1, 1, 1), materials=[photile.Material("grey", (0.5, 0.5, 0.5))],
                         lights=[photile.Light("walls", 600, "area", triangles=range(12))],
                         cameras=[photile.Camera((0.5, 0.5, 0.5), (0.5, 1, 0.5), (0, 0, 1), 60)])


@pytest.fixture
def lamps():
    """A grey room with two lamps."""
    return photile.Scene(
        box(4, 3, 2.5),
        materials=[photile.Material("grey", (0.5, 0.5, 0.5))],
        lights=[photile.Light("warm", 800, position=(1, 1, 2), color=(1.0, 0.6, 0.3)),
                photile.Light("cold", 500, position=(3, 2, 2))],
        cameras=[photile.Camera((2, 0.2, 1.2), (2, 3, 1), (0, 0, 1), 60)],
    )


@pytest.fixture
def plate():
    """A black floor of 10 m x 10 m below a lamp of 1000 lm at 2 m, and its photons' truth."""
    return photile.Scene(quad([-5, -5, 0], [10, 0, 0], [0, 10, 0]),
                         materials=[photile.Material("black", (0, 0, 0))],
                         lights=[photile.Light("lamp", 1000, position=(0, 0, 2))])
