"""What a .blend file from somebody else can make the add-on do: no Blender is needed, only names of
its module that the add-on mentions.

python3 options_test.py PHOTILE SOURCE-FOLDER
"""

import os
import shutil
import stat
import subprocess
import sys
import tempfile
from types import ModuleType, SimpleNamespace
from unittest.mock import MagicMock

photile, source = sys.argv[1:]
bpy = ModuleType("bpy")
bpy.props, bpy.data, bpy.utils, bpy.path = MagicMock(), MagicMock(), MagicMock(), MagicMock()
bpy.types = SimpleNamespace(
    AddonPreferences=object, Operator=object, Panel=object, PropertyGroup=object, Scene=object
)
sys.modules.update({"bpy": bpy, "bpy.props": bpy.props, "addon_utils": ModuleType("addon_utils")})
sys.path.insert(0, f"{source}/python/blender")
from photile import operators  # noqa: E402

scratch = tempfile.mkdtemp()
notes = f"{scratch}/notes.txt"


def command_line(options="", camera="Camera"):
    scene = SimpleNamespace(
        photile=SimpleNamespace(quality="draft", seed=1, efficacy=90.0, options=options, folder="//p"),
        render=SimpleNamespace(resolution_percentage=100, resolution_x=8, resolution_y=8),
        camera=SimpleNamespace(name=camera), objects=[],
    )
    return operators.render_command(photile, [], scene, f"{scratch}/none.gltf", "picture.exr")


def refusal(options):
    try:
        return f"taken: {command_line(options)}"
    except ValueError as error:
        return str(error)


# Every option of the command whose value is a file or a library, in each way of writing it.
told = subprocess.run([photile, "render", "--help"], check=True, text=True, stdout=subprocess.PIPE)
files = [line.split()[0].split(",")[-1] for line in told.stdout.splitlines()
         if line.startswith("  -") and any(word in line[:30] for word in ("FILE", "LIBRARY"))]
assert {"--output", "--stats", "--denoise", "--ies", "--environment"} <= set(files), files
for option in files:
    assert "preferences" in refusal(f"{option}={notes}"), option
    assert "preferences" in refusal(f"{option} {notes}"), option
assert "preferences" in refusal(f"-o {notes}")
assert "preferences" in refusal(f"--samples 4 {notes}")

# A value that looks like an option is a value, and so is a camera's name.
for words in (command_line(f"--samples --stats={notes}"), command_line(camera=f"--stats={notes}")):
    assert not [word for word in words if word.startswith("--stats")], words
    run = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert run.returncode != 0 and not os.path.exists(notes), words

# What is harmless reaches the command.
options = "--samples 4 -k 60 --light 'Desk lamp=off' --denoise --set radius=0.1"
expected = ["--samples=4", "--neighbours=60", "--light=Desk lamp=off", "--denoise", "--set=radius=0.1"]
assert command_line(options)[-5:] == expected

# A scene without a file is exported where nobody else can lay a link.
bpy.data.filepath = ""
folder = operators.folder_of(SimpleNamespace(photile=SimpleNamespace(folder="//photile")))
assert stat.S_IMODE(folder.stat().st_mode) == 0o700 and not os.listdir(folder)
folder.rmdir()

# A scene of a file writes below the file alone.
bpy.data.filepath = f"{scratch}/room/room.blend"
bpy.path.abspath = lambda path: path.replace("//", f"{scratch}/room/", 1)
os.makedirs(f"{scratch}/room")
os.symlink(scratch, f"{scratch}/room/link")
for name, taken in (("//photile", True), ("//", True), (f"{scratch}/room/a/b", True), (scratch, False),
                    ("//../other", False), ("//link", False), ("/etc/photile", False)):
    try:
        operators.folder_of(SimpleNamespace(photile=SimpleNamespace(folder=name)))
        assert taken, name
    except ValueError as error:
        assert not taken and "use //photile" in str(error), name
shutil.rmtree(scratch)
