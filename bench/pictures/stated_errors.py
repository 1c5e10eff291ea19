#!/usr/bin/env python3
"""Errors that photile states, and is asked for, beside those measured (docs/method/rounds.md).

    bench/pictures/stated_errors.py SCENES [--photile FILE] [--only NAME] [--seeds N] [--size WxH]

SCENES is the folder of the interiors and their references, which are not part of this repository, as
for bench/pictures/quality.py. Renders each room with several seeds: what differs between them is noise, which is
what photile states. The error beside the reference holds blur and the reference's noise, too. Takes
about half an hour. Needs the built command and the Debian packages python3-numpy and python3-openimageio.
"""
import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import scene_arguments
from tools.processes import timed

try:
    import numpy as np
    import OpenImageIO as oiio

    from tools import picture_error
except ImportError as missing:
    sys.exit(f"stated_errors.py: error: {missing}; install the Debian packages python3-numpy and "
             "python3-openimageio, and run it with /usr/bin/python3")

OPTIONS = ("--quality good", "--target-error 1%")
OPTIONS_OF_LIGHTS = OPTIONS[0]


def luminances(file):
    """Luminance of each light, by name."""
    image = oiio.ImageBuf(str(file))
    names, pixels = list(image.spec().channelnames), image.get_pixels(oiio.FLOAT).astype(float)
    lights = sorted({name[9:-2] for name in names if name.startswith("Combined_")})
    return {light: sum(weight * pixels[:, :, names.index(f"Combined_{light}.{channel}")]
                       for channel, weight in zip("RGB", picture_error.LUMINANCE))
            for light in lights}


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def rendered(given, scene, options, seed, folder):
    """Lights, their stated errors, the stated error of the picture in percent, its pixels, what it took."""
    picture, errors, stats = (folder / name for name in ("a.exr", "errors.exr", "a.json"))
    _, seconds, _ = timed([given.photile, "render", scene, "--size", given.size, "--set", "quota=power",
                    *options.split(), "--seed", str(seed), "--quiet", "-o", picture, "--errors",
                    errors, "--stats", stats])
    stages = json.loads(stats.read_text())["stages"]
    stated = next(stage["figures"]["standard error percent"] for stage in stages
                  if stage["stage"] == "light maps")
    return (luminances(picture), luminances(errors), stated, picture_error.read_picture(picture),
            seconds)


def rows(given, name, scene, reference, options, folder):
    """A row of the table of pictures, and those of the table of lights."""
    runs = [rendered(given, scene, options, seed, folder) for seed in range(1, given.seeds + 1)]
    pictures = np.array([run[3] @ picture_error.LUMINANCE for run in runs])
    light = pictures.mean(0)
    mask = (light > 0) & picture_error.without_lamps(np.mean([run[3] for run in runs], axis=0))
    noise = rms(pictures.std(0, ddof=1)[mask] / light[mask])
    beside = ""
    if reference is not None:
        true = reference @ picture_error.LUMINANCE
        beside = f"{100 * np.mean([rms((p - true)[mask] / true[mask]) for p in pictures]):.1f}%"
    stated = np.mean([run[2] for run in runs])
    picture_row = (f"| {name} | `{options}` | {stated:.1f}% | {100 * noise:.1f}% | {beside} |")
    light_rows = []
    # Errors of lights are taken to be independent; 4 seeds tell the scatter of a pixel but roughly.
    said = np.sqrt(sum(np.mean([run[1][layer] ** 2 for run in runs], axis=0) for layer in runs[0][1]))
    ratios = said[mask] / np.maximum(pictures.std(0, ddof=1)[mask], 1e-30)
    near = np.mean((ratios > 0.5) & (ratios < 1.5))
    picture_row += (f" {np.median(ratios):.2f}, {100 * near:.0f}% | "
                    f"{np.mean([run[4] for run in runs]):.1f} |")
    for layer in runs[0][0]:
        shown = np.array([run[0][layer] for run in runs])
        said = rms(np.array([run[1][layer] for run in runs])[:, mask])
        got = rms(shown.std(0, ddof=1)[mask])
        if shown.max() > 0:
            mean = shown.mean(0)[mask].mean()
            light_rows.append(f"| {name} | {layer} | {100 * said / mean:.1f}% | "
                              f"{100 * got / mean:.1f}% |")
    return picture_row, light_rows


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=4, help="default: %(default)s")
    parser.add_argument("--size", default="256x192", help="default: %(default)s")
    parser.add_argument("--only", metavar="ROOM", help="as the table names it")
    given = parser.parse_args()
    scenes = [(name, ROOT / f"scenes/{name}/{name}.gltf", None) for name in ("cornell-box", "living-room")]
    for room in ("classroom", "kitchen"):
        scenes.append((f"{room}, glossy", given.scenes / room / f"{room}.gltf", None))
    for room in ("classroom", "kitchen"):
        scenes.append((room, *scene_arguments.interior(given.scenes, room, given.size)))
    lights = []
    print("| | settings | stated | scatter | beside the reference | stated / scatter: median, "
          "pixels within 0.5 to 1.5 | processor s |\n|---|---|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for name, scene, reference in scenes:
            if given.only not in (None, name):
                continue
            reference = reference and picture_error.read_picture(reference)
            for options in OPTIONS:
                row, of_lights = rows(given, name, scene, reference, options, pathlib.Path(folder))
                print(row, flush=True)
                if options == OPTIONS_OF_LIGHTS:
                    lights += of_lights
    print("\n| | light | stated | measured |\n|---|---|--:|--:|", *lights, sep="\n")


if __name__ == "__main__":
    main()
