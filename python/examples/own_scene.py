"""A room made of arrays: a picture, and the photons below it."""

# %% A box of 5 m x 4 m x 2.5 m whose insides show, and a lamp of 0.6 m x 0.6 m below its ceiling.
import sys
from pathlib import Path

import numpy as np

import photile

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(parents=True, exist_ok=True)


def quad(corner, u, v):
    """Two triangles whose front is on the side of u x v."""
    a, u, v = (np.asarray(x, float) for x in (corner, u, v))
    return [[a, a + u, a + u + v], [a, a + u + v, a + v]]


x, y, z = np.diag([5.0, 4.0, 2.5])
walls = (
    quad([0, 0, 0], x, y)  # floor
    + quad(z, y, x)  # ceiling
    + quad([0, 0, 0], y, z) + quad(x, z, y)  # left and right
    + quad([0, 0, 0], z, x) + quad(y, x, z)  # front and back
)
lamp = quad([2.2, 1.7, 2.45], [0, 0.6, 0], [0.6, 0, 0])  # shines down
triangles = np.array(walls + lamp)

# %% Materials by triangle; the lamp is the last two triangles.
white = photile.Material("white", diffuse=(0.8, 0.8, 0.8))
red = photile.Material("red", diffuse=(0.6, 0.1, 0.1))
green = photile.Material("green", diffuse=(0.1, 0.5, 0.1))
materials = [0, 0, 0, 0, 1, 1, 2, 2, 0, 0, 0, 0, 0, 0]
scene = photile.Scene(
    triangles,
    materials=[white, red, green],
    triangle_materials=materials,
    lights=[
        photile.Light("panel", 3000, "area", triangles=[12, 13]),
        photile.Light("bulb", 400, "point", position=(0.5, 3.5, 1.2), color=(1, 0.7, 0.4)),
    ],
    cameras=[photile.Camera((2.5, 0.1, 1.4), (2.5, 4, 1.2), up=(0, 0, 1), field_of_view=60)],
    name="room",
)
print(scene, scene.layers)

# %% Photons where they land: what the walls absorb.
photons = photile.trace(scene, 100_000, seed=1)
print(photons, "absorbed:", photons.absorbed_flux.round(3))
by_triangle = np.bincount(photons.triangle, minlength=len(scene.triangles))
print("photons by triangle:", by_triangle)

# %% A picture with a layer for each light.
picture = photile.render(scene, size=(160, 120), quality="draft", photons_emitted=100_000)
for name in picture:
    print(f"{name}: {picture.illuminance(name).mean():.0f} lx on average over the picture")
picture.save(out / "room.exr")
picture.save(out / "room.png")
picture.save(out / "evening.png", {"panel": "off", "bulb": 2})
