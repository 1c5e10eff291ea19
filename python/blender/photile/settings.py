# SPDX-License-Identifier: MIT
"""What the user chooses, kept with the scene, and its panel."""

import shutil

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty


class PhotilePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    command: StringProperty(
        name="Command",
        description="The program photile",
        subtype="FILE_PATH",
        default=shutil.which("photile") or "photile",
    )

    options: StringProperty(
        name="Options",
        description="Options of `photile render` for all scenes, those with files too",
    )

    def draw(self, context):
        self.layout.prop(self, "command")
        self.layout.prop(self, "options")


class PhotileSettings(bpy.types.PropertyGroup):
    folder: StringProperty(
        name="Folder",
        description="Where the exported scene and the picture are written, below the .blend file",
        subtype="DIR_PATH",
        default="//photile",
    )
    quality: EnumProperty(
        name="Quality",
        items=(
            ("draft", "Draft", "Quick, and soft: nodes of light maps lie far apart"),
            ("good", "Good", "Clean to the eye"),
            ("final", "Final", "More photons, samples and rays, for stills"),
        ),
        default="good",
    )
    efficacy: FloatProperty(
        name="Lumens per watt",
        description="What Blender's watts of a lamp, and of emission, become",
        default=90.0,
        min=0.001,
        max=683.0,
    )
    seed: IntProperty(name="Seed", description="The same seed gives the same picture", default=1, min=0)
    options: StringProperty(
        name="Options",
        description="More options of `photile render`, as on its command line, but none that names "
        "a file: those are in the preferences of the add-on",
    )


class PHOTILE_PT_render(bpy.types.Panel):
    bl_label = "photile"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, chosen = self.layout, context.scene.photile
        layout.use_property_split = True
        for name in ("quality", "efficacy", "seed", "folder", "options"):
            layout.prop(chosen, name)
        layout.operator("photile.render", icon="RENDER_STILL")
        layout.operator("photile.view", icon="VIEWZOOM")
        layout.operator("photile.read_layers", icon="NODE_COMPOSITING")


CLASSES = (PhotilePreferences, PhotileSettings, PHOTILE_PT_render)
