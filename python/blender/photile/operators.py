# SPDX-License-Identifier: MIT
"""Buttons: render, walk in the window, read layers."""

import functools
import shlex
import subprocess
import tempfile
from pathlib import Path

import bpy

from . import compositor, options, scene_export


@functools.cache
def temporary_folder():
    """A folder of this Blender alone: in a folder whose name others know, they could place links."""
    return Path(tempfile.mkdtemp(prefix="photile-blender-"))


def folder_of(scene):
    """Where files go: below the folder of the .blend file, or a temporary folder without one.

    Raises ValueError for other folders: the .blend file may be anyone's, and files are overwritten.
    """
    if not bpy.data.filepath:
        return temporary_folder()
    folder = Path(bpy.path.abspath(scene.photile.folder)).resolve()
    if not folder.is_relative_to(Path(bpy.data.filepath).resolve().parent):
        raise ValueError(f"Folder: '{folder}' is not below that of the .blend file; use //photile")
    return folder


def command_of(context):
    """The program, and the user's own options of `photile render`."""
    addon = context.preferences.addons.get(__package__)
    if addon is None:
        return "photile", []
    return addon.preferences.command, shlex.split(addon.preferences.options)


def export_files(scene):
    """Exports the scene; returns its file and that of the picture."""
    folder = folder_of(scene)
    file = folder / "scene.gltf"
    scene_export.export(scene, file, scene.photile.efficacy)
    return file, folder / "picture.exr"


def size_of(scene):
    share = scene.render.resolution_percentage / 100
    return f"{round(scene.render.resolution_x * share)}x{round(scene.render.resolution_y * share)}"


def render_command(command, own_options, scene, file, picture):
    """The command line of a rendering. Names come from the .blend file, which may be anyone's: they
    follow an equals sign, so that none is taken for an option."""
    chosen = scene.photile
    arguments = [command, "render", str(file), "-o", str(picture), "--size", size_of(scene),
                 "--quality", chosen.quality, "--seed", str(chosen.seed),
                 "--set", f"emissive_scale={chosen.efficacy:g}"]
    if scene.camera:
        arguments.append(f"--camera={scene.camera.name}")
    return arguments + tint_options(scene) + options.without_files(chosen.options) + own_options


def tint_options(scene):
    return [f"--light={name}={colour}" for name, colour in scene_export.tints(scene)]


class PHOTILE_OT_render(bpy.types.Operator):
    bl_idname = "photile.render"
    bl_label = "Render with photile"
    bl_description = "Export the scene, render it, and bring its lamps back as sliders"

    _process = None
    _timer = None

    def _start(self, context):
        scene = context.scene
        try:
            file, self._picture = export_files(scene)
            arguments = render_command(*command_of(context), scene, file, self._picture)
            # A file, since nobody reads a pipe while the window is drawn.
            self._log = tempfile.TemporaryFile("w+")
            self._process = subprocess.Popen(arguments, stdout=self._log, stderr=self._log)
        except (OSError, RuntimeError, ValueError) as error:
            self.report({"ERROR"}, f"photile: {error}")
            return False
        return True

    def _finish(self, context):
        if self._process.returncode != 0:
            self._log.seek(0)
            lines = self._log.read().strip().splitlines() or ["it ended without a message"]
            self.report({"ERROR"}, lines[-1])
            return {"CANCELLED"}
        try:
            compositor.read_layers(context.scene, self._picture)
        except (RuntimeError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"photile: {self._picture}")
        return {"FINISHED"}

    def execute(self, context):
        """Waits for the rendering: for scripts, and for Blender without a window."""
        if not self._start(context):
            return {"CANCELLED"}
        self._process.wait()
        return self._finish(context)

    def invoke(self, context, event):
        if not self._start(context):
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.5, window=context.window)
        manager.modal_handler_add(self)
        context.workspace.status_text_set("photile is rendering; Esc stops it")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._process.terminate()
            self._process.wait()
        elif event.type != "TIMER" or self._process.poll() is None:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        return self._finish(context)


class PHOTILE_OT_view(bpy.types.Operator):
    bl_idname = "photile.view"
    bl_label = "Walk through in photile"
    bl_description = "Export the scene and open it on the live page of photile"

    def execute(self, context):
        try:
            file, _ = export_files(context.scene)
            command, _ = command_of(context)
            subprocess.Popen([command, "view", str(file), "--set",
                              f"emissive_scale={context.scene.photile.efficacy:g}",
                              *tint_options(context.scene)])
        except (OSError, RuntimeError, ValueError) as error:
            self.report({"ERROR"}, f"photile: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}


class PHOTILE_OT_read_layers(bpy.types.Operator):
    bl_idname = "photile.read_layers"
    bl_label = "Read layers again"
    bl_description = "Make the sliders of the last picture"

    def execute(self, context):
        try:
            compositor.read_layers(context.scene, folder_of(context.scene) / "picture.exr")
        except (RuntimeError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (PHOTILE_OT_render, PHOTILE_OT_view, PHOTILE_OT_read_layers)
