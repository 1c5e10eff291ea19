"""The k nearest of bare points, and how evenly they lie."""

# %% 100,000 points in a cube.
import numpy as np

import photile

random = np.random.default_rng(1)
points = random.random((100_000, 3), np.float32)

# %% The 8 nearest of three places: rows of `points`, and distances in the unit of the coordinates.
places = np.array([[0.5, 0.5, 0.5], [0, 0, 0], [1, 1, 2]])
rows, distances = photile.neighbours(points, places, k=8)
for place, near, distance in zip(places, rows, distances):
    print(place, near, np.round(distance, 4))

# %% Those within 0.04 alone: where there are fewer, the row is that of no point.
rows, distances = photile.neighbours(points, places, k=8, max_distance=0.04)
print("found:", (rows < len(points)).sum(axis=1))

# %% The mean distance of each point to its nearest other one; in a Poisson process it is 0.554 n^(-1/3).
_, distances = photile.neighbours(points, points, k=2)
print(f"nearest: {distances[:, 1].mean() * len(points) ** (1 / 3):.3f}")
