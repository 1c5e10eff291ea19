#!/usr/bin/env python3
"""Pictures of light maps that grow for a time, beside those of the same work at once: a table of docs/light-maps.md.

    bench/pictures/rounds.py SCENES [--photile FILE] [--size WxH] [--seconds S ...] [--at-once]

SCENES is the folder of the interiors and their references, which are not part of this repository, as
for bench/pictures/quality.py. Renders each room for each of these times by `--for`, and says when the last
picture was there. With --at-once renders the same work in one round, too. Nothing else should run.
Needs the built command and the Debian packages python3-numpy and python3-openimageio.
"""
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import scene_arguments
from tools.processes import timed

try:
    from tools import picture_error
except ImportError as missing:
    sys.exit(f"rounds.py: error: {missing}; install the Debian packages python3-numpy and "
             "python3-openimageio, and run it with /usr/bin/python3")

MADE = re.compile(r"^picture (\d+): standard error ([\d.e+-]+%), ([^;]+); (.*)$", re.M)


def figures(path, reference):
    picture = picture_error.read_picture(path)
    found = picture_error.measure(picture, reference)
    return (f"{picture_error.rel_mse_text(found)} | {100 * picture_error.mottle(picture, reference):.1f}% | "
            f"{found['mean_ratio']:.3f}")


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--size", default="256x192", help="default: %(default)s")
    parser.add_argument("--seconds", type=float, nargs="+", default=[4, 8, 16, 32], metavar="S",
                        help="default: %(default)s")
    parser.add_argument("--at-once", action="store_true")
    given = parser.parse_args()
    print("| | time | pictures, the last | relMSE | mottle | mean | processor s |\n|---|--:|---|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "a.exr"
        for room in ("classroom", "kitchen"):
            scene, reference = scene_arguments.interior(given.scenes, room, given.size)
            reference = picture_error.read_picture(reference)
            render = [given.photile, "render", scene, "--size", given.size, "-o", file]
            for seconds in given.seconds:
                _, used, told = timed([*render, "--set", "quota=power", "--for", f"{seconds:g}s"])
                number, _, when, options = MADE.findall(told)[-1]
                print(f"| {room} | {seconds:g} s | {number}, after {when} | {figures(file, reference)} | "
                      f"{used:.1f} |", flush=True)
                if given.at_once:
                    _, used, _ = timed([*render, *options.split(), "--set", "passes=1"])
                    print(f"| | | the same work at once | {figures(file, reference)} | {used:.1f} |", flush=True)


if __name__ == "__main__":
    main()
