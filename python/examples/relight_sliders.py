"""A slider for each lamp of a picture, in Jupyter."""

# %% A picture of which every lamp has a layer: rendered once, or any EXR of photile or Blender.
import sys
import time
from pathlib import Path

import photile

scene_file = sys.argv[1] if len(sys.argv) > 1 else "scenes/living-room/living-room.gltf"
out = Path(sys.argv[2] if len(sys.argv) > 2 else "out")
out.mkdir(parents=True, exist_ok=True)
file = out / "sliders.exr"
if not file.exists():
    scene = photile.load(scene_file)
    settings = {"samples_per_pixel": 4, "photons_emitted": 100_000}
    photile.render(scene, size=(320, 240), quality="draft", **settings).save(file)

picture = photile.relight(file)
for name, light in picture.lights.items():
    print(f"{name}: {light.power:.4g} {light.unit}s")

# %% The time that a mix takes: every lamp at a power of its own.
start = time.perf_counter()
mixed = picture.mix({name: 1 / (1 + number) for number, name in enumerate(picture)})
print(f"mixed {mixed.shape} in {1e3 * (time.perf_counter() - start):.1f} ms")

# %% Sliders, where there are widgets; each turn mixes the layers anew.
try:
    import ipywidgets
    from IPython.display import display
except ImportError:
    ipywidgets = None

if ipywidgets:
    image = ipywidgets.Image(value=photile.png_of(picture.display()), format="png")
    sliders = {
        name: ipywidgets.FloatSlider(1.0, min=0, max=4, description=name) for name in picture
    }

    def show(change=None):
        changes = {name: slider.value for name, slider in sliders.items()}
        image.value = photile.png_of(picture.display(changes))

    for slider in sliders.values():
        slider.observe(show, names="value")
    display(ipywidgets.HBox([image, ipywidgets.VBox(list(sliders.values()))]))
else:
    print("no ipywidgets here: a mood in their place")

# %% A mood as a file.
first = next(iter(picture))
picture.save(out / "mood.png", {first: "2700K" if picture.lights[first].power else "x1"})
