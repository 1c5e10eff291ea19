#!/usr/bin/python3
"""What a first picture costs, from the start of the process to its end; writes docs/startup.md.

    bench/pictures/first_picture.py [SCENES] [--repeats N] [--installed FOLDER] [--results FOLDER] [--redraw]

Renders three scenes at 256x192, 4 samples a pixel: with an empty cache of kernels (the very first
run), with an empty one where kernels are installed for all users, with a full one (every later
run), from photons that --save-maps kept, and by the default quality. Kernels are installed into a
folder of the bench's own first. Every figure is a median of processes of their own. Beside them
stands Mitsuba's first picture with a denoiser, where the interpreter finds the packages mitsuba and
pyoidn (docs/quality.md tells how); what is not there becomes a row that says so.
"""

import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import scene_arguments

SIZE, SAMPLES = "256x192", "4"
CASES = (  # name, scene, paths, whether the default quality is measured, too
    ("classroom, 62,500 paths", "classroom/classroom-diffuse.gltf", 62_500, False),
    ("classroom, 1M paths", "classroom/classroom-diffuse.gltf", 1_000_000, True),
    ("kitchen, 1M paths", "kitchen/kitchen-diffuse.gltf", 1_000_000, True),
    ("living room, 2M paths", None, 2_000_000, True),
)
MEMORY = "/dev/shm" if pathlib.Path("/dev/shm").is_dir() else None
STATES = ("empty cache", "installed kernels", "full cache", "saved maps", "default quality")
STAGES_OF = ("empty cache", "full cache")  # the states whose stages are told
# Mitsuba's script knows diffuse surfaces alone.
RIVALS = (("classroom", "classroom/classroom-diffuse.gltf"),
          ("kitchen", "kitchen/kitchen-diffuse.gltf"))
RIVAL_STATES = ("empty cache", "full cache")
RIVAL_PACKAGES = ("mitsuba", "pyoidn")


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=3, help="default: %(default)s")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "docs",
                        help="where startup.json and startup.md go; default: %(default)s")
    parser.add_argument("--installed", type=pathlib.Path, metavar="FOLDER",
                        help="kernels are installed in FOLDER/photile/kernels; default: they are "
                             "compiled first")
    parser.add_argument("--redraw", action="store_true",
                        help="write the page from startup.json instead of measuring")
    return parser.parse_args()


def cost_of(command, variables):
    """Runs it: wall-clock and processor seconds of the process, most memory in bytes."""
    begin = time.monotonic()
    process = subprocess.Popen(command, env={**os.environ, **variables}, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.monotonic() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise OSError(f"{' '.join(map(str, command))}: ended with {process.returncode}")
    return {"seconds": seconds, "processor": usage.ru_utime + usage.ru_stime,
            "bytes": usage.ru_maxrss * 1024}


def install_kernels(photile, folder):
    """As `cmake --install BUILD --component kernels` does, below `folder`/photile."""
    subprocess.run([photile, "devices", "--compile"], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "XDG_CACHE_HOME": str(folder)})


def measured(command, cache, installed=""):
    """A run of photile with its stages, and how many photons it stored. The record lies in memory:
    to wait for a disk that keeps it is no part of the picture, and in no stage."""
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        stats = pathlib.Path(folder) / "stats.json"
        cost = cost_of([*command, "--stats", stats, "--quiet"],
                       {"XDG_CACHE_HOME": str(cache), "XDG_DATA_DIRS": str(installed) or "/none"})
        record = json.loads(stats.read_text())
    return {**cost, "stages": record["stages"], "photons": record["photons_stored"]}


def median_of(runs):
    """The run whose processor seconds are the median, with the least and the most."""
    runs = sorted(runs, key=lambda run: run["processor"])
    return {**runs[len(runs) // 2], "least": runs[0]["processor"], "most": runs[-1]["processor"]}


def measure(photile, scene, paths, with_default, installed, repeats):
    """Per state of STATES: a run. `installed`: where kernels are installed."""
    runs = {state: [] for state in STATES}
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            default = [photile, "render", scene, "--size", SIZE, "-o", folder / "picture.exr"]
            picture = [*default, "--set", "light_map_rays=0", "-k", "50", "--samples", SAMPLES,
                       "--photons", str(paths)]
            cache, fresh, maps = folder / "cache", folder / "fresh", folder / "kept.maps"
            cache.mkdir()
            fresh.mkdir()
            runs["installed kernels"].append(measured(picture, fresh, installed))
            runs["empty cache"].append(measured(picture, cache))
            runs["full cache"].append(measured(picture, cache))
            measured([*picture, "--save-maps", maps], cache)
            runs["saved maps"].append(measured([*picture, "--load-maps", maps], cache))
            if with_default:
                runs["default quality"].append(measured(default, fresh, installed))
    return {state: median_of(of_state) for state, of_state in runs.items() if of_state}


def missing_packages():
    return [name for name in RIVAL_PACKAGES if importlib.util.find_spec(name) is None]


def measure_rival(scene, repeats):
    """Per state of RIVAL_STATES: a run; its compiled kernels are kept below HOME."""
    runs = {state: [] for state in RIVAL_STATES}
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as home:
            for state in RIVAL_STATES:
                command = [sys.executable, ROOT / "bench/rivals/quality_mitsuba.py", scene, "--size", SIZE,
                           "--samples", SAMPLES, "--denoise", "--begin", str(time.monotonic()),
                           "-o", pathlib.Path(home) / "picture.npy"]
                runs[state].append(cost_of(command, {"HOME": home}))
    return {state: median_of(of_state) for state, of_state in runs.items()}


def rivals(options):
    """Per scene: a run for each state, or why there is none."""
    if missing := missing_packages():
        return {name: f"not installed: {', '.join(missing)}" for name, _ in RIVALS}
    results = {}
    for name, scene in RIVALS:
        try:
            results[name] = measure_rival(options.scenes / scene, options.repeats)
        except OSError:
            results[name] = "did not run: DRJIT_LIBLLVM_PATH should name LLVM 19"
    return results


def table(header, rows):
    lines = [header, ["---"] + ["--:"] * (len(header) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def cost_row(name, run):
    photons = run.get("photons")
    several = run["least"] < run["most"]
    scatter = f" ({run['least']:.2f}-{run['most']:.2f})" if several else ""
    return [name, f"{run['processor']:.2f}{scatter}",
            f"{run['seconds']:.2f}", f"{run['bytes'] / 1e6:.0f}",
            f"{run['bytes'] / photons:.0f}" if photons else "-", told(run)]


def told(run):
    """Which part of the process's time its own stages tell of."""
    if "stages" not in run:
        return "-"
    return f"{100 * sum(stage['seconds'] for stage in run['stages']) / run['seconds']:.1f}%"


def rival_rows(results):
    rows = []
    for name, of_scene in results.items():
        tool = f"Mitsuba, {SAMPLES} samples, denoised: {name}"
        if isinstance(of_scene, str):
            rows.append([tool, of_scene, "-", "-", "-", "-"])
        else:
            rows += [cost_row(f"{tool}, {state}", run) for state, run in of_scene.items()]
    return rows


def stage_table(results, state):
    """Processor seconds and wall-clock seconds of each stage, for all cases."""
    runs = {case: {stage["stage"]: stage for stage in states[state]["stages"]}
            for case, states in results.items()}
    names = list(dict.fromkeys(name for stages in runs.values() for name in stages))

    def cell(stages, name):
        if name not in stages:
            return "-"
        return f"{stages[name]['processor_seconds']:.2f} / {stages[name]['seconds']:.2f}"

    return table(["stage", *runs],
                 [[name, *(cell(stages, name) for stages in runs.values())] for name in names])


def page(results):
    """The page, from what was measured."""
    cases = results["photile"]
    rows = [cost_row(f"{case}, {state}", run)
            for case, states in cases.items() for state, run in states.items()]
    return (ROOT / "bench/pictures/startup_notes.md").read_text().format(
        costs=table(["run", "processor seconds", "seconds", "MB at most",
                     "bytes a stored photon", "told by the stages"],
                    rows + rival_rows(results["rivals"])),
        empty=stage_table(cases, STAGES_OF[0]), full=stage_table(cases, STAGES_OF[1]),
        load=f"{results['load']:.0f}")


def measurements(options, installed):
    """The results so far, after each case."""
    results = {"photile": {}, "rivals": rivals(options)}
    for case, scene, paths, with_default in CASES:
        path = options.scenes / scene if scene else ROOT / "scenes/living-room/living-room.gltf"
        if not path.exists():
            print(f"first_picture.py: {path}: not there; left out", file=sys.stderr)
            continue
        results["photile"][case] = measure(options.photile, path, paths, with_default, installed,
                                           options.repeats)
        results["load"] = os.getloadavg()[2]
        yield results


def main():
    options = arguments()
    file = options.results / "startup.json"
    if not options.redraw:
        with tempfile.TemporaryDirectory() as folder:
            installed = (options.installed or pathlib.Path(folder)).resolve()
            if not options.installed:
                install_kernels(options.photile, folder)
            for results in measurements(options, installed):  # what is there is kept
                file.write_text(json.dumps(results, indent=1) + "\n")
    (options.results / "startup.md").write_text(page(json.loads(file.read_text())))


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError) as error:
        sys.exit(f"first_picture.py: error: {error}")
