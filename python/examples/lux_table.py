"""Lux on a working plane, as a table of pandas, and as a report."""

# %% The grid of EN 12464-1 over the floor of the first camera's room.
import sys
from pathlib import Path

import pandas

import photile

scene_file = sys.argv[1] if len(sys.argv) > 1 else "scenes/living-room/living-room.gltf"
out = Path(sys.argv[2] if len(sys.argv) > 2 else "out")
out.mkdir(parents=True, exist_ok=True)
scene = photile.load(scene_file)
grid, = photile.grids(scene, "floor+0.75")
print(grid)

# %% Each value with its standard error, and each lamp's part.
measured = photile.measure(scene, grid, rays=256, repeats=4, photons_emitted=50_000, progress=True)
table = pandas.DataFrame(measured.columns())
print(table.round(1).to_string())
table.to_csv(out / "lux.csv", index=False)

# %% As a plan, and what a lighting report asks for.
print(pandas.DataFrame(measured.map()).round(0).to_string())
for name, (value, error) in measured.statistics.items():
    print(f"{name} = {value:.3g} +-{error:.1g}")

# %% The report of `photile measure`.
photile.write_report(out / "lux.html", measured, project="Living room")
