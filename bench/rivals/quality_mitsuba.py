#!/usr/bin/python3
"""Renders an interior of diffuse surfaces with Mitsuba 3; quality.py runs it once per picture.

    bench/rivals/quality_mitsuba.py SCENE --size WxH --samples N [--sampler NAME] [--denoise] [--next]
                             --begin SECONDS -o FILE.npy

Path tracing with the llvm_ad_rgb variant, by default with independent samples; with --denoise Open Image
Denoise, led by albedo and normals that are denoised first. The output is that of tools/one_picture.py.
Needs the packages mitsuba and, with --denoise, pyoidn.
"""

import math
import os
import pathlib
import sys

import drjit
import mitsuba
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import one_picture
from tools.gltf_meshes import read_gltf

SAMPLES_AT_A_TIME = 64  # of a pixel: bounds the memory of Mitsuba's wavefronts
VARIANT = "llvm_ad_rgb"


def diffuse(mesh):
    """Its material. Single-sided ones reflect on their front only."""
    matt = {"type": "diffuse", "reflectance": {"type": "rgb", "value": mesh.reflectance}}
    return mitsuba.load_dict({"type": "twosided", "bsdf": matt} if mesh.double_sided else matt)


def mitsuba_mesh(mesh, material):
    """A mesh with flat normals."""
    properties = mitsuba.Properties()
    properties["bsdf"] = material
    if any(mesh.radiance):
        properties["emitter"] = mitsuba.load_dict(
            {"type": "area", "radiance": {"type": "rgb", "value": mesh.radiance}})
    made = mitsuba.Mesh(mesh.name, len(mesh.positions), len(mesh.triangles), props=properties)
    values = mitsuba.traverse(made)
    values["vertex_positions"] = mesh.positions.ravel()
    values["faces"] = mesh.triangles.ravel()
    values.update()
    return made


def camera_of(view, width, height, sampler="independent"):
    flip = np.diag([-1.0, 1.0, -1.0, 1.0])  # Mitsuba's cameras look along +z, with x to the left
    return {"type": "perspective", "fov_axis": "y",
            "fov": math.degrees(view.vertical_field_of_view),
            "to_world": mitsuba.ScalarTransform4f(view.to_world @ flip),
            "film": {"type": "hdrfilm", "width": width, "height": height,
                     "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": sampler}}


def seen_scene(meshes, view, width, height, sampler="independent"):
    """Meshes of Mitsuba's as the camera of a file sees them."""
    return mitsuba.load_dict({"type": "scene", "sensor": camera_of(view, width, height, sampler),
                              **{f"mesh_{i}": mesh for i, mesh in enumerate(meshes)}})


def mitsuba_scene(path, width, height, sampler="independent"):
    meshes, view = read_gltf(path)
    return seen_scene([mitsuba_mesh(mesh, diffuse(mesh)) for mesh in meshes], view, width, height, sampler)


def integrator(denoise):
    path = {"type": "path", "max_depth": -1}
    if denoise:
        path = {"type": "aov", "aovs": "albedo:albedo,normal:sh_normal", "integrator": path}
    return mitsuba.load_dict(path)


def render(scene, method, samples, seed, denoise):
    """A picture; the samples come in parts, each with a seed of its own."""
    total = 0
    for first in range(0, samples, SAMPLES_AT_A_TIME):
        count = min(SAMPLES_AT_A_TIME, samples - first)
        part = mitsuba.render(scene, integrator=method, spp=count, seed=1000 * seed + first)
        total = total + count * np.array(part)
    pixels = (total / samples).astype(np.float32)
    if not denoise:
        return pixels
    return denoised(*(np.ascontiguousarray(pixels[..., i:i + 3]) for i in (0, 3, 6)))


def denoised(colour, albedo, normal):
    """By Open Image Denoise as its authors advise: the guides are denoised first, each on its own."""
    import pyoidn  # pylint: disable=import-outside-toplevel; only here is it needed
    device = pyoidn.Device()
    device.commit()

    def filtered(switches=(), **images):
        output = np.empty_like(colour)
        with pyoidn.Filter(device, "RT") as denoiser:
            for name, pixels in (*images.items(), ("output", output)):
                denoiser.set_image(name, pixels, pyoidn.OIDN_FORMAT_FLOAT3)
            for switch in switches:
                denoiser.set_bool(switch, True)
            denoiser.commit()
            denoiser.execute()
        return output

    return filtered(("hdr", "cleanAux"), color=colour, albedo=filtered(albedo=albedo),
                    normal=filtered(normal=normal))


def main():
    parser = one_picture.parser(__doc__.splitlines()[0])
    parser.add_argument("--sampler", default="independent", help="plugin of Mitsuba")
    options = parser.parse_args()
    mitsuba.set_variant(VARIANT)
    drjit.set_thread_count(os.cpu_count())
    scene = mitsuba_scene(options.scene, *options.size, options.sampler)
    method = integrator(options.denoise)
    one_picture.write(options, lambda seed: render(scene, method, options.samples, seed, options.denoise))


if __name__ == "__main__":
    main()
