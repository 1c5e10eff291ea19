#!/usr/bin/python3
"""Renders an interior of diffuse surfaces with LuxCore and PhotonGI; quality.py runs it once per picture.

    bench/rivals/quality_luxcore.py SCENE --size WxH --samples N [--denoise] [--next] --begin SECONDS
                             -o FILE.npy

Path tracing on the processor, whose paths end in LuxCore's cache of indirect light (PhotonGI); with
--denoise its own plugin of Open Image Denoise. The output is that of tools/one_picture.py. Needs the
package pyluxcore.
"""

import math
import os
import pathlib
import sys
import time

os.environ["OCL_ICD_VENDORS"] = os.devnull  # it looks for OpenCL devices, and crashes on PoCL's

import numpy as np
import pyluxcore

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import one_picture
from tools.gltf_meshes import read_gltf

PHOTONS = 1_000_000  # LuxCore's default of 20 million traces for minutes
DEPTH = 64  # of paths and photons: with its default of 4 the cache lacks a fifth of the light


def properties(values):
    result = pyluxcore.Properties()
    for name, value in values.items():
        result.Set(pyluxcore.Property(name, value))
    return result


def materials(meshes):
    """Reflect, and emit, on the front alone unless they are double-sided."""
    values = {"scene.materials.black.type": "matte", "scene.materials.black.kd": [0.0, 0.0, 0.0]}
    for i, mesh in enumerate(meshes):
        front = f"scene.materials.m{i}" + ("" if mesh.double_sided else "-front")
        values |= {f"{front}.type": "matte", f"{front}.kd": [float(k) for k in mesh.reflectance]}
        if not mesh.double_sided:
            whole = f"scene.materials.m{i}"
            values |= {f"{whole}.type": "twosided", f"{whole}.frontmaterial": f"m{i}-front",
                       f"{whole}.backmaterial": "black"}
        if any(mesh.radiance):
            values[f"scene.materials.m{i}.emission"] = [float(k) for k in mesh.radiance]
    return values


def seen_scene(meshes, view, width, height):
    scene = pyluxcore.Scene()
    position, forward, up = (view.to_world[:3, k] for k in (3, 2, 1))
    aspect = width / height
    scene.Parse(properties(
        {"scene.camera.type": "perspective",
         "scene.camera.lookat.orig": [float(v) for v in position],
         "scene.camera.lookat.target": [float(v) for v in position - forward],
         "scene.camera.up": [float(v) for v in up],
         # The field of view is that of the shorter side, which the screen window measures as 2.
         "scene.camera.fieldofview": math.degrees(view.vertical_field_of_view),
         # Rows that begin at the bottom leave the picture one row too low.
         "scene.camera.screenwindow": [-aspect, aspect, -1.0 - 2.0 / height, 1.0 - 2.0 / height],
         "scene.camera.autovolume.enable": False} | materials(meshes)))
    for i, mesh in enumerate(meshes):
        scene.DefineMesh(f"mesh{i}", [tuple(map(float, p)) for p in mesh.positions],
                         [tuple(map(int, t)) for t in mesh.triangles], None, None, None, None)
        scene.Parse(properties({f"scene.objects.o{i}.shape": f"mesh{i}",
                                f"scene.objects.o{i}.material": f"m{i}"}))
    return scene


def settings(width, height, samples, denoise, seed):
    values = {"renderengine.type": "PATHCPU", "sampler.type": "SOBOL",
              "renderengine.seed": 1 + seed,
              "native.threads.count": os.cpu_count(), "batch.haltspp": samples,
              "film.width": width, "film.height": height, "film.filter.type": "NONE",
              "path.pathdepth.total": DEPTH, "path.pathdepth.diffuse": DEPTH,
              "path.photongi.sampler.type": "METROPOLIS",
              "path.photongi.photon.maxcount": PHOTONS, "path.photongi.photon.maxdepth": DEPTH,
              "path.photongi.indirect.enabled": True,
              "path.photongi.caustic.enabled": False,
              "film.imagepipelines.0.0.type": "NOP"}
    if denoise:
        values |= {"film.imagepipelines.0.1.type": "INTEL_OIDN",
                   "film.outputs.0.type": "ALBEDO", "film.outputs.0.filename": "albedo.exr",
                   "film.outputs.1.type": "AVG_SHADING_NORMAL",
                   "film.outputs.1.filename": "normal.exr"}
    return properties(values)


def render(scene, width, height, samples, denoise, seed):
    configuration = pyluxcore.RenderConfig(settings(width, height, samples, denoise, seed), scene)
    session = pyluxcore.RenderSession(configuration)
    session.Start()
    while not session.HasDone():
        session.UpdateStats()
        time.sleep(0.01)
    film = session.GetFilm()
    pixels = np.zeros((height, width, 3), dtype=np.float32)
    film.GetOutputFloat(pyluxcore.FilmOutputType.RGB_IMAGEPIPELINE, pixels)
    session.Stop()
    return pixels[::-1]  # its rows begin at the bottom


def main():
    options = one_picture.parser(__doc__.splitlines()[0]).parse_args()
    pyluxcore.Init(lambda message: None)
    scene = seen_scene(*read_gltf(options.scene), *options.size)
    one_picture.write(options, lambda seed: render(scene, *options.size, options.samples, options.denoise,
                                                   seed))
    os._exit(0)  # its libraries crash while they are unloaded


if __name__ == "__main__":
    main()
