# SPDX-License-Identifier: MIT
"""Renders the scene with photile, and brings each lamp back as a slider of the compositor."""

import bpy

from . import operators, settings

bl_info = {
    "name": "photile",
    "author": "The photile developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > photile",
    "description": "Photon-mapped pictures with a layer per lamp, relit by sliders of the compositor",
    "category": "Render",
}

CLASSES = (*settings.CLASSES, *operators.CLASSES)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.photile = bpy.props.PointerProperty(type=settings.PhotileSettings)


def unregister():
    del bpy.types.Scene.photile
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
