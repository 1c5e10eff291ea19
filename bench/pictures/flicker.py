#!/usr/bin/python3
"""How much the frames of a slow turn flicker: as docs/measured/quality.md states it.

    bench/pictures/flicker.py [SCENES] [--only NAME] [--frames N] [--photile COMMAND]

The camera of an interior turns about the vertical by a tenth of a degree a frame. Nothing else moves and
all is diffuse, so each point of a wall should have the same light in all frames. They are laid over the
first, whose reference says where walls are smooth; flicker is the root mean square there of a pixel's
standard deviation over its mean, from frame to frame. Needs the built command and the packages numpy and
OpenImageIO; beside photile Mitsuba 3 with Open Image Denoise, where mitsuba and pyoidn are installed
(DRJIT_LIBLLVM_PATH names LLVM 19).
"""

import importlib.util
import json
import math
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import packages, scene_arguments
from tools.processes import timed

packages.require("numpy", "OpenImageIO")

import numpy as np

from tools import picture_error
from tools.gltf_meshes import View, read_gltf

SIZE = (256, 192)
DEGREES = 0.1  # a frame: half a pixel
PHOTILE = ("--set light_map_rays=0 --photons 1M -k 500", "--set light_maps=off --photons 1M -k 500", "--quality good")
PATHS = 16  # of a pixel of the path tracer
FRAMES_PER_SECOND = 10


def turned(view, degrees):
    """The view after a turn about the world's vertical."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    to_world = view.to_world.copy()
    to_world[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ to_world[:3, :3]
    return View(to_world, view.vertical_field_of_view)


def laid_over(picture, view, first):
    """The picture as the first view shows it, bilinear between pixels; NaN beyond it. The views look from
    one place, so that the same direction means the same point."""
    width, height = SIZE
    scale = math.tan(first.vertical_field_of_view / 2)
    x, y = np.meshgrid((2 * (np.arange(width) + 0.5) / width - 1) * scale * width / height,
                       (1 - 2 * (np.arange(height) + 0.5) / height) * scale)
    directions = np.stack([x, y, -np.ones_like(x)], axis=-1) @ (
        first.to_world[:3, :3].T @ view.to_world[:3, :3])
    columns = (directions[..., 0] / -directions[..., 2] / scale * height / width + 1) * width / 2 - 0.5
    rows = (1 - directions[..., 1] / -directions[..., 2] / scale) * height / 2 - 0.5
    left, top = np.floor(columns).astype(int), np.floor(rows).astype(int)
    inside = (left >= 0) & (left + 1 < width) & (top >= 0) & (top + 1 < height)
    left, top = np.clip(left, 0, width - 2), np.clip(top, 0, height - 2)
    right, below = columns - left, rows - top
    found = ((1 - below) * ((1 - right) * picture[top, left] + right * picture[top, left + 1]) +
             below * ((1 - right) * picture[top + 1, left] + right * picture[top + 1, left + 1]))
    return np.where(inside, found, np.nan)


def flicker(pictures, views, reference):
    """Of luminances (height, width), as said above, and the share of pixels that it is measured at."""
    over = np.array([laid_over(picture, view, views[0]) for picture, view in zip(pictures, views)])
    true = reference @ picture_error.LUMINANCE
    around = picture_error.windows(true, 2)
    smooth = around.max(0) - around.min(0) < 0.1 * around.mean(0)
    smooth &= picture_error.without_lamps(reference) & np.isfinite(over).all(axis=0)
    over = over[:, smooth]
    return float(np.sqrt(np.mean((over.std(axis=0, ddof=1) / over.mean(axis=0)) ** 2))), smooth.mean()


def photile_frames(given, scene, views, options, folder):
    """Luminances of the frames, and the processor seconds of them all."""
    path = folder / "turn.json"
    path.write_text(json.dumps({"interpolation": "linear", "keyframes": [
        {"time": i / FRAMES_PER_SECOND, "position": view.to_world[:3, 3].tolist(),
         "direction": (-view.to_world[:3, 2]).tolist()} for i, view in enumerate(views)]}))
    for frame in folder.glob("frame.*"):
        frame.unlink()
    _, seconds, _ = timed([given.photile, "walk", scene, "-o", folder / "frame.###.exr", "--size",
                           "{}x{}".format(*SIZE), "--set", "quota=power", "--fps", str(FRAMES_PER_SECOND),
                           "--camera-path", path, "--quiet", *options.split()])
    return [picture_error.read_picture(frame) @ picture_error.LUMINANCE
            for frame in sorted(folder.glob("frame.*"))], seconds


def mitsuba_frames(scene, views):
    """The same by denoised paths, each frame with a seed of its own."""
    import time  # pylint: disable=import-outside-toplevel; with what needs it

    import mitsuba  # pylint: disable=import-outside-toplevel; not everywhere
    mitsuba.set_variant("llvm_ad_rgb")
    import quality_mitsuba as tool  # pylint: disable=import-outside-toplevel
    meshes, _ = read_gltf(scene)
    own = [tool.mitsuba_mesh(mesh, tool.diffuse(mesh)) for mesh in meshes]
    begin = time.process_time()
    pictures = [tool.render(tool.seen_scene(own, view, *SIZE), tool.integrator(True), PATHS, seed, True)
                @ picture_error.LUMINANCE for seed, view in enumerate(views)]
    return pictures, time.process_time() - begin


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--only", choices=("classroom", "kitchen"), nargs="+",
                        default=("classroom", "kitchen"))
    parser.add_argument("--frames", type=int, default=60)
    given = parser.parse_args()
    rival = all(importlib.util.find_spec(package) for package in ("mitsuba", "pyoidn"))
    print("| | | flicker | processor s a frame |\n|---|---|--:|--:|")
    for name in given.only:
        scene, reference_file = scene_arguments.interior(given.scenes, name, "{}x{}".format(*SIZE))
        reference = picture_error.read_picture(reference_file)
        _, view = read_gltf(scene)
        views = [turned(view, DEGREES * i) for i in range(given.frames)]
        with tempfile.TemporaryDirectory() as folder:
            rows = [(f"`{options}`", lambda options=options, folder=folder: photile_frames(
                given, scene, views, options, pathlib.Path(folder))) for options in PHOTILE]
            rows += [(f"Mitsuba, {PATHS} spp, denoised", lambda: mitsuba_frames(scene, views))] * rival
            for what, frames in rows:
                pictures, seconds = frames()
                share, _ = flicker(pictures, views, reference)
                print(f"| {name} | {what} | {100 * share:.2f}% | {seconds / given.frames:.2f} |",
                      flush=True)


if __name__ == "__main__":
    main()
