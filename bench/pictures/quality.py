#!/usr/bin/python3
"""Error against time of photile beside what a user would pick instead; writes docs/measured/quality.md.

    bench/pictures/quality.py [SCENES] [--only VIEW] [--tool TOOL] [--redraw] [--quick] [--results FOLDER]

Renders the two diffuse interiors of SCENES in two sizes with photile, by its qualities, by photons alone
and by denoised paths, with the path tracers of Mitsuba 3 and Blender (Cycles), with and without Open Image
Denoise, and with LuxCore and its PhotonGI; compares with the path-traced references of SCENES by relMSE,
mottle and FLIP. Needs the built command, and numpy, matplotlib and OpenImageIO. The rivals are those that
the interpreter finds: the packages mitsuba, pyoidn, bpy, pyluxcore and flip-evaluator of PyPI, for example
in an environment made with `/usr/bin/python3 -m venv --system-site-packages`. Mitsuba wants LLVM, which
DRJIT_LIBLLVM_PATH names. What is not there becomes a row that says so.
"""

import importlib.metadata
import importlib.util
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments

packages.require("matplotlib", "numpy", "OpenImageIO")

import numpy as np

from tools import picture_error
from pictures import quality_report

INTERIORS = ("kitchen", "classroom")
SIZES = ("256x192", "512x384")
VIEWS = tuple(f"{name} {size}" for size in SIZES for name in INTERIORS)
QUALITIES = ("draft", "good", "final")
PHOTONS = (62_500, 250_000, 1_000_000)
PASSES = (1, 2, 4)
PHOTONS_PER_PASS = 500_000
PATHS = (1, 4, 16, 64, 128)  # of a pixel
FEW_PATHS = (4, 16, 64)  # in large pictures, and of the tools with less to show
MOST_PATHS_OF_FRAMES = 16  # beyond, a further frame takes what the first takes
PACKAGES = ("mitsuba", "pyoidn", "bpy", "pyluxcore", "flip-evaluator")


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--only", choices=VIEWS, nargs="+", default=VIEWS, metavar="VIEW",
                        help="measure these alone, the results keep the others: " + ", ".join(VIEWS))
    parser.add_argument("--tool", choices=TOOLS, nargs="+", default=TOOLS, metavar="TOOL",
                        help="measure these alone, the results keep the others: " + ", ".join(TOOLS))
    parser.add_argument("--qualities", nargs="+", choices=QUALITIES, default=QUALITIES,
                        help="rows of photile to measure; default: all")
    parser.add_argument("--redraw", action="store_true",
                        help="use the results in the folder instead of measuring")
    parser.add_argument("--quick", action="store_true",
                        help="few photons and paths in the bundled Cornell box: a smoke test")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "docs/measured/quality",
                        help="where JSON and plots go; default: %(default)s")
    return parser.parse_args()


def neighbours(photons):
    """k, growing as the photons to the power 2/3, so that noise and bias fall alike."""
    return max(12, round(12 * (photons / 10_000) ** (2 / 3)))


def installed(package):
    return importlib.util.find_spec(package) is not None


def processor_seconds(process):
    """Of all threads of a running process, from proc(5)."""
    fields = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(") ")[2].split()
    return sum(int(field) for field in fields[11:13]) / os.sysconf("SC_CLK_TCK")


def run_photile(command):
    """Runs it; returns the costs of the process and of its last stage, that of a further frame.

    The processor seconds of the frame are those between the lines that the command prints when the
    photon maps and the picture are ready; None where it has several passes.
    """
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    built, frames, said = 0.0, [], ""
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        for line in process.stderr:
            said = line
            if "%, " in line:  # how far a stage is
                continue
            if line.startswith("build photon maps:"):
                built = processor_seconds(process.pid)
            elif line.startswith("estimate radiance:"):
                frames.append(processor_seconds(process.pid) - built)
    if process.returncode != 0:
        raise OSError(f"photile ended with {process.returncode}: {said.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    first = {"seconds": time.monotonic() - begin,
             "processor": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}
    return first, frames[0] if len(frames) == 1 else None


def compile_kernels(command, scene, folder, options):
    """Fills the cache with the kernels of these options."""
    few = list(options)
    if "--photons" in few:
        few[few.index("--photons") + 1] = "10k"
    else:
        few += ["--photons", "10k"]
    subprocess.run([command, "render", scene, "--size", "8x8", "--quiet", "-o",
                    folder / "compiled.exr", *few], check=True)


def photile(command, scene, size, folder, options):
    """A picture and its costs. What nodes gather is no cost of a further frame: none is told."""
    if "--integrator" not in options:
        options = ["--set", "quota=power", *options]
        compile_kernels(command, scene, folder, options)
    picture, stats = folder / "photile.exr", folder / "photile.json"
    first, frame_processor = run_photile(
        [command, "render", scene, "--size", size, "-o", picture, "--stats", stats, *options])
    stages = {stage["stage"]: stage["seconds"] for stage in json.loads(stats.read_text())["stages"]}
    costs = {"first": first}
    if frame_processor is not None and any(word.startswith("light_maps=") for word in options):
        costs["frame"] = {"processor": frame_processor,
                          "seconds": sum(stages.get(stage, 0) for stage in
                                         ("primary hits", "radiance estimate", "film"))}
    return picture_error.read_picture(picture), costs


class NoRival(Exception):
    """Why a rival renders nothing here."""


def rival(script, scene, size, folder, options):
    """A picture and its costs by one of the scripts beside this one."""
    picture = folder / "rival.npy"
    done = subprocess.run(
        [sys.executable, ROOT / "bench/rivals" / script, scene, "--size", size, "-o", picture,
         "--begin", str(time.monotonic()), *options], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        remedy = "; DRJIT_LIBLLVM_PATH should name LLVM 19" if script == "quality_mitsuba.py" else ""
        raise NoRival(f"ended with {done.returncode}{remedy}")
    return np.load(picture).astype(np.float64), json.loads(done.stdout[done.stdout.rindex('{"first"'):])


def photon_settings(photons, passes=1):
    """Options of passes of so many photons, which are estimated at each hit."""
    return ["--quality", "draft", "--set", "light_maps=off", "--photons", str(photons * passes),
            "--set", f"passes={passes}", "-k", str(neighbours(photons))]


def path_settings(paths):
    return ["--samples", str(paths), *(["--next"] if paths <= MOST_PATHS_OF_FRAMES else [])]


def denoising_library():
    """The shared library of Open Image Denoise that pyoidn carries."""
    folder = pathlib.Path(importlib.util.find_spec("pyoidn").origin).parent
    return next(folder.rglob("libOpenImageDenoise.so.2"))


def denoised_paths(paths):
    return ["--integrator", "path", "--samples", str(paths), "--denoise", str(denoising_library())]


# Name of a tool, what renders, the packages that it needs.
TOOLS = {"photile": ("photile", ()),
         "photile, photons alone": ("photile", ()),
         "photile, photons in passes": ("photile", ()),
         "photile, paths denoised": ("photile", ("pyoidn",)),
         "Mitsuba": ("quality_mitsuba.py", ("mitsuba",)),
         "Mitsuba, low discrepancy": ("quality_mitsuba.py", ("mitsuba",)),
         "Mitsuba, denoised": ("quality_mitsuba.py", ("mitsuba", "pyoidn")),
         "Cycles": ("quality_cycles.py", ("bpy",)),
         "Cycles, denoised": ("quality_cycles.py", ("bpy",)),
         "LuxCore, PhotonGI": ("quality_luxcore.py", ("pyluxcore",)),
         "LuxCore, PhotonGI, denoised": ("quality_luxcore.py", ("pyluxcore",))}


def points(tool, qualities, large, quick):
    """Settings of each picture of a tool in words and as options.

    large: a view in which each picture takes four times as long
    """
    few_paths = FEW_PATHS[:1] if quick else FEW_PATHS
    paths = few_paths if quick or large else PATHS
    photons, passes = ((20_000,), (2,)) if quick else (PHOTONS, PASSES)
    per_pass = 10_000 if quick else PHOTONS_PER_PASS
    if quick:
        qualities = qualities[:1]
    elif large:
        photons, passes = photons[-1:], passes[-1:]
        qualities = [quality for quality in qualities if quality != "final"]

    def by_paths(chosen, options):
        return [(f"{n} spp", options(n)) for n in chosen]

    return {
        "photile": lambda: [(f"`--quality {quality}`", ["--quality", quality])
                            for quality in qualities],
        "photile, photons alone": lambda: [(f"{n:,} photons", photon_settings(n)) for n in photons],
        "photile, photons in passes": lambda: [
            (f"{n} x {per_pass:,} photons", photon_settings(per_pass, n)) for n in passes],
        "photile, paths denoised": lambda: by_paths(few_paths, denoised_paths),
        "Mitsuba": lambda: by_paths(paths, path_settings),
        "Mitsuba, low discrepancy": lambda: by_paths(
            few_paths, lambda n: ["--samples", str(n), "--sampler", "multijitter"]),
        "Mitsuba, denoised": lambda: by_paths(paths, lambda n: [*path_settings(n), "--denoise"]),
        "Cycles": lambda: by_paths(few_paths, path_settings),
        "Cycles, denoised": lambda: by_paths(few_paths, lambda n: [*path_settings(n), "--denoise"]),
        # Its photons alone take a minute, and nothing of it gains by more pixels.
        "LuxCore, PhotonGI": lambda: by_paths([] if large else few_paths,
                                              lambda n: ["--samples", str(n)]),
        "LuxCore, PhotonGI, denoised": lambda: by_paths([] if large else few_paths, lambda n: [
            "--samples", str(n), "--denoise"]),
    }[tool]()


def flip(picture, reference):
    """Mean HDR-FLIP (Andersson et al. 2021), 0 to 1; None where it is not installed."""
    if not installed("flip_evaluator"):
        return None
    import flip_evaluator  # pylint: disable=import-outside-toplevel; not everywhere
    return float(flip_evaluator.evaluate(reference.astype(np.float32),
                                         np.maximum(picture, 0).astype(np.float32), "HDR")[1])


def subjects(options, folder):
    """Name, scene file, size and reference of each view."""
    if not options.quick:
        for view in options.only:
            name, size = view.split()
            yield view, *scene_arguments.interior(options.scenes, name, size), size
        return
    scene, reference = ROOT / "scenes/cornell-box/cornell-box.gltf", folder / "reference.exr"
    subprocess.run([options.photile, "render", scene, "--size", "32x32", "--integrator", "path",
                    "--samples", "64", "--quiet", "-o", reference], check=True)
    yield "cornell-box", scene, reference, "32x32"


def measure_tool(tool, chosen, render, view, reference):
    """Rows of one tool in one view."""
    rows = []
    for setting, options in chosen:
        picture, costs = render(options)
        rows.append({"view": view, "tool": tool, "setting": setting, **costs,
                     **picture_error.measure(picture, reference),
                     "mottle": picture_error.mottle(picture, reference),
                     "flip": flip(picture, reference)})
        print(json.dumps(rows[-1]), flush=True)
    return rows


def measure(options, folder):
    rows = []
    for view, scene, reference_file, size in subjects(options, folder):
        reference = picture_error.read_picture(reference_file)
        for tool in options.tool:
            renderer, needed = TOOLS[tool]

            def render(more, scene=scene, size=size, renderer=renderer):
                if renderer == "photile":
                    return photile(options.photile, scene, size, folder, more)
                return rival(renderer, scene, size, folder, more)

            try:
                for package in needed:
                    if not installed(package):
                        raise NoRival("not installed")
                chosen = points(tool, options.qualities, size != SIZES[0] and not options.quick,
                                options.quick)
                if renderer == "quality_mitsuba.py":
                    render(chosen[0][1])  # fills its cache of kernels
                rows += measure_tool(tool, chosen, render, view, reference)
            except NoRival as reason:
                rows.append({"view": view, "tool": tool, "missing": str(reason)})
    return rows


def version(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def merged(known, rows):
    """Rows known before with these in place of their own, by view, tool and time. That a tool could not run
    is left out where there are figures of it."""
    def key(row):
        return row["view"], row["tool"], row.get("setting")

    tools = list(TOOLS)
    new = {key(row) for row in rows}
    all_rows = [row for row in known if row["view"] in VIEWS and key(row) not in new] + rows
    measured = {(row["view"], row["tool"]) for row in all_rows if "missing" not in row}
    return sorted([row for row in all_rows if "missing" not in row or (row["view"], row["tool"]) not in measured],
                  key=lambda row: (VIEWS.index(row["view"]), tools.index(row["tool"]),
                                   row["first"]["processor"] if "first" in row else 0))


def main():
    options = arguments()
    options.results.mkdir(parents=True, exist_ok=True)
    file = options.results / "quality.json"
    if not options.redraw:
        with tempfile.TemporaryDirectory() as folder:
            rows = measure(options, pathlib.Path(folder))
        known = json.loads(file.read_text()) if file.is_file() else {"results": [], "versions": {}}
        if not options.quick:
            rows = merged(known["results"], rows)
        record = {"bench": "quality", "cores": os.cpu_count(), "processor": quality_report.processor(),
                  "load_average": os.getloadavg()[1],
                  "versions": {package: version(package) or known["versions"].get(package)
                               for package in PACKAGES}, "results": rows}
        file.write_text(json.dumps(record, indent=1) + "\n")
    quality_report.write(json.loads(file.read_text()), options.results,
                         None if options.quick else ROOT / "docs/measured/quality.md",
                         partly=options.redraw or set(options.only) != set(VIEWS) or set(options.tool) != set(TOOLS))


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"quality.py: error: {error}")
