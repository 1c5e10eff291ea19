"""Every structure on the same photons: times of building and of a query, as a plot."""

# %% Photons of a scene, and points among them to ask for.
import sys
import time
from pathlib import Path

import matplotlib
import numpy as np

if "ipykernel" not in sys.modules:
    matplotlib.use("Agg")
import matplotlib.pyplot as plt

import photile

scene_file = sys.argv[1] if len(sys.argv) > 1 else "scenes/cornell-box/cornell-box.obj"
out = Path(sys.argv[2] if len(sys.argv) > 2 else "out")
out.mkdir(parents=True, exist_ok=True)
scene = photile.load(scene_file)
chosen_structures = sys.argv[3].split(",") if len(sys.argv) > 3 else photile.STRUCTURES[:-1]
counts = [10_000, 40_000]  # and not brute-force, the last, which looks at every photon near by
queries, k = 20_000, 50

# %% The first query of each compiles its kernels; the best of three more counts.
seconds = {}
for count in counts:
    photons = photile.trace(scene, count, seed=1)
    chosen = np.random.default_rng(2).choice(len(photons), queries)
    points, normals = photons.position[chosen], photons.normal[chosen]
    radius = None
    for structure in chosen_structures:
        maps = photile.PhotonMaps(photons, radius=radius, neighbours=k, structure=structure)
        radius = maps.radius
        times = []
        for _ in range(4):
            start = time.perf_counter()
            found = maps.nearest(points, normals, k)
            times.append(time.perf_counter() - start)
        seconds[structure, count] = (maps.statistics["seconds"], min(times[1:]))
        print(f"{structure:22} {len(photons):8} photons: built in {seconds[structure, count][0]:.3f} s,"
              f" {1e6 * min(times[1:]) / queries:.2f} us a query")

# %% The plot.
figure, axes = plt.subplots(figsize=(7, 4))
for structure in dict.fromkeys(name for name, _ in seconds):
    axes.plot(counts, [1e6 * seconds[structure, count][1] / queries for count in counts],
              marker="o", label=structure)
axes.set(xscale="log", yscale="log", xlabel="photon paths", ylabel=f"microseconds for {k} nearest")
axes.legend(fontsize=7)
figure.tight_layout()
figure.savefig(out / "structures.svg")
