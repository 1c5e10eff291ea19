"""Photons of one's own: their k nearest around points, and the density of their flux."""

# %% 200,000 photons on a floor of 2 m x 2 m; together they carry 400 lm.
import numpy as np

import photile

random = np.random.default_rng(1)
count = 200_000
positions = np.zeros((count, 3), np.float32)
positions[:, :2] = random.uniform(-1, 1, (count, 2))
normals = np.broadcast_to(np.float32([0, 0, 1]), (count, 3))
flux = np.full((count, 3), 400 / count, np.float32)

# %% Maps on the best OpenCL device. Photons without normals are found in space alone.
maps = photile.PhotonMaps(positions, flux, normals=normals, radius=0.1)
print(maps, maps.statistics)

# %% The nearest of three points: rows of `positions`, and distances in metres.
points = np.array([[0, 0, 0], [0.3, -0.4, 0], [0, 0, 5]])
up = np.broadcast_to([0, 0, 1], points.shape)
near = maps.nearest(points, up, k=8)
for point, row, distance in zip(points, near.photons, near.distance):
    found = row != photile.NONE
    print(point, row[found], np.round(distance[found], 4))

# %% Their lux: 400 lm on 4 m2 are 100 lx, but for noise of 3% and for the corner.
lux = maps.irradiance(points, up, k=1000)[:, 0, 0]
print("lux:", np.round(lux, 1))

# %% The same as a picture: lux on a grid.
places = photile.grid([-1, -1, 0], [2, 0, 0], [0, 2, 0], 64, 64)
plan = maps.irradiance(places, np.broadcast_to([0, 0, 1], places.shape), k=1000)[:, 0, 0]
plan = plan.reshape(64, 64)
print(f"within the border: {plan[8:-8, 8:-8].mean():.1f} lx on average")
