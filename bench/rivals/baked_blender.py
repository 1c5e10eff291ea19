#!/usr/bin/python3
"""Shows a baked room in Blender, beside photile's own picture of it.

    bench/rivals/baked_blender.py [SCENES] [--photile COMMAND] [--pictures FOLDER]

SCENES holds <scene>/<scene>-diffuse.gltf and references/<scene>-diffuse-256x192.exr, as for
bench/pictures/quality.py. `photile bake` writes the room; Blender imports it by docs/examples/show_baked.py, and
Cycles looks at it with the camera of the scene, without any bounce. Pixels that see a lamp, whose own
light is not baked, or nothing are left out. Needs the Debian packages blender, python3-numpy and
python3-openimageio.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
WIDTH, HEIGHT, SAMPLES = 256, 192, 64
LIGHT = ("--photons", "1M", "-k", "250", "--set", "quota=power")


def render_in_blender(baked, view, picture):
    """Within Blender."""
    import bpy
    import mathutils
    sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "docs/examples")]
    import show_baked
    from rivals import quality_cycles
    show_baked.show(baked)
    for name in view["lamps"]:  # holes in the picture
        tree = bpy.data.materials[name].node_tree
        output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        tree.links.new(tree.nodes.new("ShaderNodeHoldout").outputs["Holdout"],
                       output.inputs["Surface"])
    upright = mathutils.Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
    scene = quality_cycles.seen_scene(upright @ mathutils.Matrix(view["to_world"]), view["fov"],
                                      (WIDTH, HEIGHT))
    scene.render.film_transparent = True
    scene.render.filepath = str(picture)
    scene.render.image_settings.color_mode = "RGBA"
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces, cycles.transparent_max_bounces = SAMPLES, 0, 32
    bpy.ops.render.render(write_still=True)


def lamps_of(scene):
    """Names of materials that emit light."""
    document = json.loads(scene.read_text(encoding="utf-8"))
    return [material["name"] for material in document["materials"]
            if any(material.get("emissiveFactor", ()))]


def row(given, name, folder):
    """A row of the table."""
    scene, reference = scene_arguments.interior(given.scenes, name, f"{WIDTH}x{HEIGHT}")
    baked, own, shown = folder / f"{name}.gltf", folder / f"{name}.exr", folder / "blender.exr"
    subprocess.run([given.photile, "bake", scene, "-o", baked, *LIGHT, "--quiet"], check=True)
    subprocess.run([given.photile, "render", scene, "-o", own, "--size", f"{WIDTH}x{HEIGHT}",
                    "--set", "light_map_rays=0", "--samples", "16", "--set", "light_maps=on", *LIGHT,
                    "--quiet"], check=True)
    _, view = read_gltf(scene)
    place = folder / "view.json"
    place.write_text(json.dumps({"fov": view.vertical_field_of_view,
                                 "to_world": view.to_world.tolist(), "lamps": lamps_of(scene)}))
    subprocess.run(["blender", "--background", "--python-exit-code", "1", "--python", __file__, "--",
                    baked, place, shown], check=True, stdout=subprocess.DEVNULL)
    ours, truth = picture_error.read_picture(own), picture_error.read_picture(reference)
    theirs = picture_error.read_picture(shown)
    surface = picture_error.read_picture(shown, "A")[:, :, 0] > 0.999
    if given.pictures:
        scale = 0.18 / np.median(truth @ picture_error.LUMINANCE)
        picture_error.write_png(given.pictures / f"baked-blender-{name}.png",
                                np.clip(scale * np.concatenate((theirs, ours), axis=1), 0, 1)
                                ** (1 / 2.2))
    errors = [picture_error.measure(a[surface][None], b[surface][None])
              for a, b in ((theirs, ours), (theirs, truth), (ours, truth))]
    return f"| {name} | " + " | ".join(
        f"{picture_error.rel_mse_text(error)} | {error['mean_ratio']:.3f}" for error in errors) + " |"


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="folder of both pictures, as PNG")
    given = parser.parse_args()
    print("| | Blender's picture beside photile's: relMSE | mean | Blender's beside the reference | "
          "mean | photile's | mean |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("classroom", "kitchen"):
            print(row(given, name, pathlib.Path(folder)), flush=True)


if "bpy" in sys.modules or "--background" in sys.argv:
    to_show, seen_from, written = (pathlib.Path(each) for each in
                                   sys.argv[sys.argv.index("--") + 1:])
    render_in_blender(to_show, json.loads(seen_from.read_text()), written)
elif __name__ == "__main__":
    sys.path.insert(0, str(ROOT / "bench"))
    from tools import packages, scene_arguments
    packages.require("numpy", "OpenImageIO")
    import numpy as np
    from tools import picture_error
    from tools.gltf_meshes import read_gltf
    main()
