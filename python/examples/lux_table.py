"""Lux on a working plane, as a table of pandas."""

# %% Points 0.75 m above the floor; the floor's extent is that of the scene's vertices.
import sys
from pathlib import Path

import numpy as np
import pandas

import photile

scene_file = sys.argv[1] if len(sys.argv) > 1 else "scenes/living-room/living-room.gltf"
out = Path(sys.argv[2] if len(sys.argv) > 2 else "out")
out.mkdir(parents=True, exist_ok=True)
scene = photile.load(scene_file)
low, high = (np.asarray(scene.origin) + f(scene.vertices, axis=0) for f in (np.min, np.max))
wide, deep = high[0] - low[0] - 1, high[2] - low[2] - 1  # half a metre from the walls
points = photile.grid([low[0] + 0.5, low[1] + 0.75, low[2] + 0.5], [wide, 0, 0], [0, 0, deep], 6, 4)

# %% Each value with its standard error, and each lamp's part.
measured = photile.measure(scene, points, rays=256, repeats=4, photons_emitted=50_000)
table = pandas.DataFrame(measured.columns())
print(table.round(1).to_string())

# %% As a plan, and what a lighting report asks for.
plan = table.pivot(index="z", columns="x", values="lux")
print(plan.round(0).to_string())
mean, least = table["lux"].mean(), table["lux"].min()
print(f"Em = {mean:.0f} lx, Emin = {least:.0f} lx, Uo = {least / mean:.2f}")
table.to_csv(out / "lux.csv", index=False)
