#!/usr/bin/python3
"""What a first picture costs, from the start of the process to its end; writes docs/startup.md.

    bench/first_picture.py [SCENES] [--repeats N] [--results FOLDER]

Renders three scenes at 256x192, 4 samples a pixel: with an empty cache of kernels (the very first
run), with a full one, and from photons that --save-maps kept. Every figure is a median of processes
of their own. Beside Mitsuba's first picture with a denoiser: bench/quality.py.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import scene_arguments

ROOT = scene_arguments.ROOT
CASES = (  # name, scene, paths
    ("classroom, 62,500 paths", "classroom/classroom-diffuse.gltf", 62_500),
    ("classroom, 1M paths", "classroom/classroom-diffuse.gltf", 1_000_000),
    ("living room, 2M paths", None, 2_000_000),
)
STATES = ("empty cache", "full cache", "saved maps")


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=3, help="default: %(default)s")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "docs",
                        help="where startup.json and startup.md go; default: %(default)s")
    return parser.parse_args()


def measured(command, cache):
    """Runs it: wall-clock and processor seconds of the process, most memory in bytes, stages."""
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / "stats.json"
        begin = time.monotonic()
        process = subprocess.Popen([*command, "--stats", stats, "--quiet"],
                                   env={**os.environ, "XDG_CACHE_HOME": str(cache)})
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise OSError(f"{' '.join(map(str, command))}: ended with {process.returncode}")
        return {"seconds": seconds, "processor": usage.ru_utime + usage.ru_stime,
                "bytes": usage.ru_maxrss * 1024, "stages": json.loads(stats.read_text())["stages"]}


def median_of(runs):
    """The run whose processor seconds are the median, with the least and the most."""
    runs = sorted(runs, key=lambda run: run["processor"])
    return {**runs[len(runs) // 2], "least": runs[0]["processor"], "most": runs[-1]["processor"]}


def measure(photile, scene, paths, repeats):
    """Per state of STATES: a run."""
    runs = {state: [] for state in STATES}
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            picture = [photile, "render", scene, "--size", "256x192", "--samples", "4",
                       "--photons", str(paths), "-o", folder / "picture.exr"]
            cache, maps = folder / "cache", folder / "kept.maps"
            cache.mkdir()
            runs["empty cache"].append(measured(picture, cache))
            runs["full cache"].append(measured(picture, cache))
            measured([*picture, "--save-maps", maps], cache)
            runs["saved maps"].append(measured([*picture, "--load-maps", maps], cache))
    return {state: median_of(of_state) for state, of_state in runs.items()}


def table(header, rows):
    lines = [header, ["---"] + ["--:"] * (len(header) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def page(results):
    """The page, from what was measured."""
    costs = [[f"{case}, {state}", f"{run['processor']:.2f} ({run['least']:.2f}-{run['most']:.2f})",
              f"{run['seconds']:.2f}", f"{run['bytes'] / 1e6:.0f}"]
             for case, states in results.items() for state, run in states.items()]
    warm = {case: {stage["stage"]: stage for stage in states["full cache"]["stages"]}
            for case, states in results.items()}
    names = list(dict.fromkeys(name for stages in warm.values() for name in stages))
    stages = [[name, *(f"{of_case[name]['processor_seconds']:.2f}" if name in of_case else "-"
                       for of_case in warm.values())] for name in names]
    return (ROOT / "bench/startup_notes.md").read_text().format(
        costs=table(["run", "processor seconds", "seconds", "MB at most"], costs),
        stages=table(["stage", *warm], stages))


def main():
    options = arguments()
    results = {}
    for case, scene, paths in CASES:
        file = options.scenes / scene if scene else ROOT / "scenes/living-room/living-room.gltf"
        if not file.exists():
            print(f"first_picture.py: {file}: not there; left out", file=sys.stderr)
            continue
        results[case] = measure(options.photile, file, paths, options.repeats)
    (options.results / "startup.json").write_text(json.dumps(results, indent=1) + "\n")
    (options.results / "startup.md").write_text(page(results))


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError) as error:
        sys.exit(f"first_picture.py: error: {error}")
