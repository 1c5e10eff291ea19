#!/usr/bin/python3
"""Pictures of caustics by Mitsuba 3's light tracer, which shares nothing with photile: references of caustics.py.

    bench/rivals/caustics_mitsuba.py SCENE.gltf --size WxH --samples N --pictures COUNT -o FILE.npy
                              [--camera NAME] [--sun AZIMUTH,ELEVATION,LUX]

Paths start at the lights and are joined with the camera at each surface (Mitsuba's "ptracer"), so that light
which mirrors and glass throw on matt surfaces is found without bias and without a search for it. Surfaces that the
camera sees in mirrors or through glass are black. Writes COUNT independent pictures of N paths a pixel, an array of
shape (count, height, width, 3). Mirrors, solid glass with vertex normals, matt surfaces, lamps, and metals and coats as
in gloss_mitsuba.py. A sun of 0.533 degrees is 64 parallel lights spread evenly over its disc. Needs the packages numpy
and mitsuba (DRJIT_LIBLLVM_PATH names LLVM 19).
"""

import argparse
import math
import pathlib
import sys

import mitsuba
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools.gltf_meshes import read_gltf

mitsuba.set_variant("llvm_ad_rgb")

from rivals import quality_mitsuba

SAMPLES_AT_A_TIME = 256  # paths a pixel: bounds the memory of Mitsuba's wavefronts
MIRROR_ROUGHNESS = 0.05  # metals up to here are mirrors
SUN_DEGREES = 0.533
PARTS_OF_SUN = 64


def material(mesh):
    if mesh.index > 0:
        return mitsuba.load_dict({"type": "dielectric", "int_ior": mesh.index, "ext_ior": 1.0})
    if mesh.metallic == 1 and mesh.roughness <= MIRROR_ROUGHNESS:
        return mitsuba.load_dict({"type": "twosided", "bsdf": {
            "type": "conductor", "material": "none",
            "specular_reflectance": {"type": "rgb", "value": mesh.reflectance}}})
    if mesh.metallic == 0 and mesh.specular == 0:
        return quality_mitsuba.diffuse(mesh)
    from rivals import gloss_mitsuba  # pylint: disable=import-outside-toplevel; needs OpenImageIO
    return gloss_mitsuba.material(mesh)


def mitsuba_mesh(mesh):
    """Of glass and metals with the normals of the file, as photile sees them."""
    if mesh.index == 0 and mesh.metallic == 0:
        return quality_mitsuba.mitsuba_mesh(mesh, material(mesh))
    properties = mitsuba.Properties()
    properties["bsdf"] = material(mesh)
    made = mitsuba.Mesh(mesh.name, len(mesh.positions), len(mesh.triangles), has_vertex_normals=True, props=properties)
    values = mitsuba.traverse(made)
    values["vertex_positions"] = mesh.positions.ravel()
    values["vertex_normals"] = mesh.normals.ravel()
    values["faces"] = mesh.triangles.ravel()
    values.update()
    return made


def sun_lights(text):
    """AZIMUTH,ELEVATION,LUX as photile has it: north is -z, east +x; lux on a surface that faces the sun."""
    azimuth, elevation, lux = (float(word) for word in text.split(","))
    azimuth, elevation = math.radians(azimuth), math.radians(elevation)
    towards = np.array([math.sin(azimuth) * math.cos(elevation), math.sin(elevation),
                        -math.cos(azimuth) * math.cos(elevation)])
    across = np.cross(towards, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    up = np.cross(across, towards)
    golden = math.pi * (3 - math.sqrt(5))
    lights = {}
    for part in range(PARTS_OF_SUN):  # a sunflower's seeds: even over the disc
        radius = math.tan(math.radians(SUN_DEGREES / 2)) * math.sqrt((part + 0.5) / PARTS_OF_SUN)
        place = towards + radius * (math.cos(golden * part) * across + math.sin(golden * part) * up)
        lights[f"sun_{part}"] = {"type": "directional", "direction": (-place / np.linalg.norm(place)).tolist(),
                                 "irradiance": {"type": "rgb", "value": [lux / PARTS_OF_SUN] * 3}}
    return lights


def pictures(given):
    width, height = (int(side) for side in given.size.split("x"))
    meshes, view = read_gltf(given.scene, diffuse=False, camera_name=given.camera)
    parts = {"type": "scene", "sensor": quality_mitsuba.camera_of(view, width, height)}
    parts.update({f"mesh_{i}": mitsuba_mesh(mesh) for i, mesh in enumerate(meshes)})
    if given.sun:
        parts.update(sun_lights(given.sun))
    scene = mitsuba.load_dict(parts)
    method = mitsuba.load_dict({"type": "ptracer", "max_depth": -1})
    for picture in range(given.pictures):
        total, done = 0, 0
        while done < given.samples:
            count = min(SAMPLES_AT_A_TIME, given.samples - done)
            seed = picture * 100_000 + done
            total = total + count * np.array(mitsuba.render(scene, integrator=method, spp=count, seed=seed),
                                             dtype=np.float64)
            done += count
        yield total / given.samples


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path, metavar="SCENE.gltf")
    parser.add_argument("--size", required=True, metavar="WxH")
    parser.add_argument("--samples", type=int, required=True, help="paths a pixel of each picture")
    parser.add_argument("--pictures", type=int, default=8)
    parser.add_argument("--camera", metavar="NAME")
    parser.add_argument("--sun", metavar="AZIMUTH,ELEVATION,LUX")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    given = parser.parse_args()
    np.save(given.output, np.array(list(pictures(given))))


if __name__ == "__main__":
    main()
