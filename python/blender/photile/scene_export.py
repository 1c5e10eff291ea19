# SPDX-License-Identifier: MIT
"""The scene as a glTF file that photile reads, with the area lights that Blender's exporter drops."""

import math
import re
from contextlib import contextmanager
from pathlib import Path

import addon_utils
import bpy

# What the area lights of Blender are drawn as: photile's are rectangles, so a disc becomes the square
# of the same area.
_SQUARE_OF_DISC = math.sqrt(math.pi) / 2


def size_of(light):
    """Width and height of an area light in metres, along its x and y axes."""
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else width
    factor = _SQUARE_OF_DISC if light.shape in {"DISK", "ELLIPSE"} else 1.0
    return width * factor, height * factor


def lamps(scene):
    """Lamps that are rendered and have a power; that of the sun is an irradiance."""
    return [
        one
        for one in scene.objects
        if one.type == "LIGHT" and one.data.type != "SUN" and not one.hide_render
    ]


def layer_name(name):
    """The name of an object's layer in photile: of ASCII, letters, digits and - are kept."""
    return re.sub(r"[\x00-\x2c.-/:-@\[-`{-\x7f]", "_", name)


@contextmanager
def custom_properties(scene, efficacy):
    """Lamps have photile's custom properties meanwhile; those that they have already stay."""
    added = []

    def add(lamp, name, value):
        if name not in lamp:
            lamp[name] = value
            added.append((lamp, name))

    for lamp in lamps(scene):
        scale = lamp.matrix_world.to_scale()
        add(lamp, "photile_lumens", efficacy * lamp.data.energy)
        if lamp.data.type == "AREA":
            width, height = size_of(lamp.data)
            add(lamp, "photile_area", [width * abs(scale.x), height * abs(scale.y)])
    try:
        yield
    finally:
        for lamp, name in added:
            del lamp[name]


def export(scene, file, efficacy):
    """Writes `file` (.gltf) with its buffers and textures beside it."""
    if "io_scene_gltf2" not in bpy.context.preferences.addons:
        addon_utils.enable("io_scene_gltf2")
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    with custom_properties(scene, efficacy):
        bpy.ops.export_scene.gltf(
            filepath=str(file),
            export_format="GLTF_SEPARATE",
            export_lights=True,
            export_cameras=True,
            export_extras=True,
            export_apply=True,
            export_animations=False,
            export_tangents=False,
            use_renderable=True,
        )


def tints(scene):
    """Colours of area lights, which custom properties cannot express: pairs of a layer and #RRGGBB."""
    result = []
    for lamp in lamps(scene):
        red, green, blue = lamp.data.color
        if lamp.data.type != "AREA" or max(red, green, blue) <= 0 or red == green == blue:
            continue
        largest = max(red, green, blue)
        srgb = [_srgb(value / largest) for value in (red, green, blue)]
        result.append((layer_name(lamp.name), "#%02X%02X%02X" % tuple(srgb)))
    return result


def _srgb(linear):
    curve = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return round(255 * min(max(curve, 0), 1))
