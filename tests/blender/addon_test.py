"""The add-on in Blender without a window: export, render, sliders.

blender -b --factory-startup --python-exit-code 1 --python addon_test.py -- PHOTILE SCRATCH
"""

import re
import subprocess
import sys
from pathlib import Path

import addon_utils
import bpy
import numpy as np
import OpenImageIO as oiio

photile, scratch = sys.argv[sys.argv.index("--") + 1 :]
scratch = Path(scratch)
DESK, BULB = "Desk_lamp_001", "Bulb"


def room():
    """A grey room with an orange rectangle and a white bulb, and what the add-on is told."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("photile", default_set=True)
    bpy.context.preferences.addons["photile"].preferences.command = photile
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1.25))
    cube = bpy.context.object
    cube.scale = (4, 3, 2.5)
    cube.data.flip_normals()
    grey = bpy.data.materials.new("grey")
    grey.use_nodes = True
    surface = grey.node_tree.nodes["Principled BSDF"].inputs
    surface["Base Color"].default_value = (0.5, 0.5, 0.5, 1)
    surface["Specular"].default_value = 0
    surface["Roughness"].default_value = 1
    cube.data.materials.append(grey)

    bpy.ops.object.light_add(type="AREA", location=(1, 0, 2.4))
    desk = bpy.context.object
    desk.name = "Desk lamp.001"
    desk.data.shape, desk.data.size, desk.data.size_y = "RECTANGLE", 0.25, 0.3
    desk.data.energy, desk.data.color = 20, (1.0, 0.5, 0.2)
    desk.scale = (2, 1, 1)
    bpy.ops.object.light_add(type="POINT", location=(-1, 0, 2))
    bulb = bpy.context.object
    bulb.name, bulb.data.energy = BULB, 10
    bpy.ops.object.light_add(type="POINT", location=(0, 1, 2))
    bpy.context.object.hide_render = True

    bpy.ops.object.camera_add(location=(0, -1.3, 1.2), rotation=(np.pi / 2, 0, 0))
    scene = bpy.context.scene
    scene.camera = bpy.context.object
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    scene.render.resolution_percentage = 100
    bpy.ops.wm.save_as_mainfile(filepath=str(scratch / "room.blend"))
    scene.photile.folder, scene.photile.quality = "//", "draft"
    scene.photile.options = "--photons 50000 --samples 1"
    return scene


def channels(file, prefix):
    """(height, width, 3) of three channels of an EXR."""
    image = oiio.ImageInput.open(str(file))
    names = list(image.spec().channelnames)
    return image.read_image("float")[..., [names.index(prefix + c) for c in "RGB"]]


def composited(scene):
    """What the compositor makes of the sliders as they are."""
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 1, False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(scratch / "composited.exr")
    bpy.ops.render.render(write_still=True)
    return channels(scratch / "composited.exr", "")


def relit(*changes):
    """The same by the command."""
    options = [part for change in changes for part in ("--light", change)]
    subprocess.run([photile, "relight", scratch / "picture.exr", *options, "-o",
                    scratch / "relit.exr"], check=True)
    return channels(scratch / "relit.exr", "")


def error_of(operation):
    try:
        operation()
    except RuntimeError as error:
        return str(error)
    raise AssertionError("no error")


scene = room()
assert bpy.ops.photile.render() == {"FINISHED"}

# Powers: 90 lm for each of Blender's watts; the hidden lamp is not there.
listed = subprocess.run([photile, "relight", scratch / "picture.exr"], check=True, text=True,
                        stdout=subprocess.PIPE).stdout
powers = dict(re.findall(r"light: (\S+): ([0-9.]+) lm", listed))
assert {name: float(power) for name, power in powers.items()} == {DESK: 1800, BULB: 900}, listed

# The rectangle is 0.5 m x 0.3 m: its scale counts.
told = subprocess.run([photile, "info", scratch / "scene.gltf", "--json"], check=True, text=True,
                      stdout=subprocess.PIPE).stdout
assert re.search(r'"triangles": 14\b', told), told

# Its colour is that of the lamp: grey walls keep the ratio.
desk = channels(scratch / "picture.exr", f"Combined_{DESK}.").mean(axis=(0, 1))
assert np.allclose(desk / desk[0], (1, 0.5, 0.2), atol=0.01), desk

# Nothing of the export stays in the scene.
assert not [key for one in scene.objects for key in one.keys() if key.startswith("photile")]

# Sliders: one for each lamp, which do what `photile relight` does.
node = scene.node_tree.nodes["photile lamps"]
sliders = [socket.name for socket in node.inputs if socket.type == "VALUE"]
assert sorted(sliders) == sorted([DESK, BULB]), sliders
assert np.allclose(composited(scene), relit(), rtol=1e-4, atol=1e-4)
node.inputs[DESK].default_value, node.inputs[BULB].default_value = 2.5, 0
assert np.allclose(composited(scene), relit(f"{DESK}=x2.5", f"{BULB}=off"), rtol=1e-4, atol=1e-4)
node.inputs[BULB].default_value = 1
node.inputs[f"{BULB} colour"].default_value = (1, 0, 0, 1)
bulb = channels(scratch / "picture.exr", f"Combined_{BULB}.") * (1, 0, 0)
expected = 2.5 * channels(scratch / "picture.exr", f"Combined_{DESK}.") + bulb
assert np.allclose(composited(scene), expected, rtol=1e-4, atol=1e-4)

# Read again, sliders stay where they were.
assert bpy.ops.photile.read_layers() == {"FINISHED"}
node = scene.node_tree.nodes["photile lamps"]
assert node.inputs[DESK].default_value == 2.5
assert len([one for one in bpy.data.node_groups if one.name.startswith("photile lamps")]) == 1

# Errors are one line of the command's.
scene.photile.options = "--photons 0"
assert "--photons" in error_of(bpy.ops.photile.render)
bpy.context.preferences.addons["photile"].preferences.command = str(scratch / "no-such-program")
assert "no-such-program" in error_of(bpy.ops.photile.render)
print("the add-on works")
