#!/usr/bin/python3
"""Shows a baked room in Mitsuba 3, beside photile's own picture of it.

    bench/rivals/baked_mitsuba.py [SCENES] [--photile COMMAND] [--pictures FOLDER]

SCENES holds <scene>/<scene>-diffuse.gltf and references/<scene>-diffuse-256x192.exr, as for
bench/pictures/quality.py. `photile bake` writes the room; Mitsuba reads its triangles, TEXCOORD_1, base colours
and EXR files, looks at it with the camera of the scene, and shows base colour x irradiance / pi: no ray
of it looks for light. Pixels that see a lamp, or nothing, are left out: these are not baked. Needs the
packages mitsuba, for which DRJIT_LIBLLVM_PATH names LLVM, python3-numpy and python3-openimageio.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

try:
    import mitsuba
    import numpy as np

    from tools import picture_error
    mitsuba.set_variant("llvm_ad_rgb")
except ImportError as missing:
    sys.exit(f"baked_mitsuba.py: error: {missing}; see the top of this file")

from tools import scene_arguments
from tools.gltf_meshes import read_accessor, read_gltf
from rivals.quality_mitsuba import mitsuba_scene, seen_scene

WIDTH, HEIGHT, SAMPLES = 256, 192, 16
APART = 5e-5  # metres
LIGHT = ("--photons", "1M", "-k", "250", "--set", "quota=power")


def baked_mesh(file, binary, primitive):
    """A mesh whose texture coordinates are the places of its light."""
    positions, places = (read_accessor(file, binary, primitive["attributes"][name])
                         for name in ("POSITION", "TEXCOORD_1"))
    # Two sides of a surface are two triangles, of which Mitsuba leaves none out: each is moved to where
    # it is seen from.
    corners = positions.reshape(-1, 3, 3).astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    positions = (corners + APART * normals[:, None]).astype(np.float32).reshape(-1, 3)
    colour = file["materials"][primitive["material"]]["pbrMetallicRoughness"]
    properties = mitsuba.Properties()
    properties["bsdf"] = mitsuba.load_dict({"type": "twosided", "bsdf": {
        "type": "diffuse",
        "reflectance": {"type": "rgb", "value": colour.get("baseColorFactor", [1, 1, 1])[:3]}}})
    triangles = np.arange(len(positions)).reshape(-1, 3)
    made = mitsuba.Mesh("baked", len(positions), len(triangles), has_vertex_texcoords=True,
                        props=properties)
    values = mitsuba.traverse(made)
    values["vertex_positions"] = positions.ravel()
    values["vertex_texcoords"] = places.ravel()
    values["faces"] = triangles.astype(np.uint32).ravel()
    values.update()
    return made


def light_of(folder, file):
    """Irradiance of all lights as a texture of Mitsuba."""
    layers = file["scenes"][0]["extras"]["photile"]["light_maps"]
    light = sum(picture_error.read_picture(folder / layer["uri"]) for layer in layers)
    return mitsuba.load_dict({"type": "bitmap", "raw": True, "filter_type": "bilinear",
                              "wrap_mode": "clamp",
                              "bitmap": mitsuba.Bitmap(light.astype(np.float32))})


class LightMapIntegrator(mitsuba.SamplingIntegrator):
    """Base colour x irradiance / pi of what a ray meets."""

    light = None

    def sample(self, scene, sampler, ray, medium=None, active=True):
        met = scene.ray_intersect(ray, active)
        seen = active & met.is_valid()
        colour = met.bsdf().eval_diffuse_reflectance(met, seen)
        radiance = colour * self.light.eval(met, seen) / math.pi
        return mitsuba.Spectrum(radiance) & seen, seen, []


def shown(baked, scene):
    """The picture of a baked file, by the camera of the scene it was baked from."""
    file = json.loads(baked.read_text(encoding="utf-8"))
    binary = (baked.parent / file["buffers"][0]["uri"]).read_bytes()
    _, view = read_gltf(scene)
    view.to_world[:3, 3] -= file["nodes"][0].get("translation", (0, 0, 0))
    meshes = [baked_mesh(file, binary, primitive) for primitive in file["meshes"][0]["primitives"]]
    room = seen_scene(meshes, view, WIDTH, HEIGHT)
    integrator = LightMapIntegrator(mitsuba.Properties())
    integrator.light = light_of(baked.parent, file)
    return np.array(integrator.render(room, spp=4 * SAMPLES), dtype=np.float64)


class OtherIntegrator(mitsuba.SamplingIntegrator):
    """1 where a ray meets a lamp or nothing, else 0."""

    def sample(self, scene, sampler, ray, medium=None, active=True):
        met = scene.ray_intersect(ray, active)
        lamp = mitsuba.luminance(met.emitter(scene).eval(met, active)) > 0
        return mitsuba.Spectrum(1) & (lamp | ~met.is_valid()), active, []


def sees_surface(scene):
    """Pixels (height, width) of which all of the rays meet surface that is no lamp."""
    room = mitsuba_scene(scene, WIDTH, HEIGHT)
    other = np.array(OtherIntegrator(mitsuba.Properties()).render(room, spp=4 * SAMPLES))
    return other.max(axis=-1) == 0


def row(given, name, folder):
    """A row of the table."""
    scene, reference = scene_arguments.interior(given.scenes, name, f"{WIDTH}x{HEIGHT}")
    baked, own = folder / f"{name}.gltf", folder / f"{name}.exr"
    subprocess.run([given.photile, "bake", scene, "-o", baked, *LIGHT, "--quiet"], check=True)
    subprocess.run([given.photile, "render", scene, "-o", own, "--size", f"{WIDTH}x{HEIGHT}",
                    "--set", "light_map_rays=0", "--samples", str(SAMPLES), "--set", "light_maps=on", *LIGHT,
                    "--quiet"], check=True)
    pictures = {"Mitsuba": shown(baked, scene), "photile": picture_error.read_picture(own)}
    reference = picture_error.read_picture(reference)
    if given.pictures:
        scale = 0.18 / np.median(reference @ picture_error.LUMINANCE)
        both = np.concatenate(list(pictures.values()), axis=1)
        picture_error.write_png(given.pictures / f"baked-{name}.png",
                                np.clip(scale * both, 0, 1) ** (1 / 2.2))
    surface = sees_surface(scene)
    beside = picture_error.measure(pictures["Mitsuba"][surface][None],
                                   pictures["photile"][surface][None])
    errors = [picture_error.measure(pictures[key][surface][None], reference[surface][None])
              for key in ("Mitsuba", "photile")]
    return (f"| {name} | {picture_error.rel_mse_text(beside)} | "
            f"{beside['mean_ratio']:.3f} | "
            + " | ".join(f"{picture_error.rel_mse_text(error)} | {error['mean_ratio']:.3f}"
                         for error in errors) + " |")


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="folder of both pictures, as PNG")
    given = parser.parse_args()
    print("| | Mitsuba's picture beside photile's: relMSE | mean | Mitsuba's beside the reference | "
          "mean | photile's | mean |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("classroom", "kitchen"):
            print(row(given, name, pathlib.Path(folder)), flush=True)


if __name__ == "__main__":
    main()
