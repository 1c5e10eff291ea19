#!/usr/bin/python3
"""Lux at points by photile beside Radiance: error against processor seconds; writes docs/measured/beside-radiance.md.

    bench/rivals/radiance.py [--radiance FOLDER] [--photile COMMAND] [--again] [--redraw] [--quick]

Measures what is missing in docs/measured/benchmarks/radiance.json, a row at a time, so that it can be stopped and
started again. FOLDER holds Radiance's rtrace, oconv and mkpmap, such as bin/ of the package pyradiance; what
is not there becomes a line that says so. Needs the built command and the Debian packages python3-numpy and
python3-matplotlib.
"""

import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import measured, plots, processes
from tools.report_section import replace_page
from rivals.radiance_scene import write_plain_gltf, write_radiance_scene

RESULTS = ROOT / "docs/measured/benchmarks/radiance.json"
PLOT = ROOT / "docs/measured/benchmarks/radiance.svg"
PAGE = ROOT / "docs/measured/beside-radiance.md"
LUMINANCE = (0.2126, 0.7152, 0.0722)  # Rec.709
SEEDS = (1, 2, 3)  # photile's errors are root mean squares over these

# Points: what to ask photile measure for.
SCENES = {
    "living room": ("scenes/living-room/living-room.gltf",
                    "--plane floor+0.75 --clearance 0.1 --spacing 0.45"),
    "Cornell box": ("scenes/cornell-box/cornell-box.gltf", "--grid grid.json"),
}
GRID = {"name": "plane", "origin": [0.05, 0.4, 0.05], "u": [0, 0, 0.45], "v": [0.45, 0, 0],
        "columns": 9, "rows": 9}  # above the blocks

REFERENCE = "--integrator path --rays 32768 --repeats 4"
REFERENCE_SEEDS = (101, 102)
DIRECT = "-dt 0.03 -dc 0.75 -ds 0.1 -dj 0.9"  # of rtrace: lamps subdivided and jittered
RTRACE = {
    "rtrace": ("-ab 3 -ad 256 -as 64 -aa 0.25 -ar 32", "-ab 4 -ad 512 -as 128 -aa 0.2 -ar 64"),
    "rtrace -aa 0": (
        "-ab 8 -ad 64 -as 0 -aa 0 -lw 1e-2", "-ab 8 -ad 256 -as 0 -aa 0 -lw 4e-3",
        "-ab 8 -ad 1024 -as 0 -aa 0 -lw 1e-3", "-ab 8 -ad 4096 -as 0 -aa 0 -lw 2.5e-4"),
}
# mkpmap's photons, and rtrace's settings after it.
PHOTON_MAPS = (("50k", "-ab 1 -ad 256 -as 0 -aa 0"), ("500k", "-ab 1 -ad 512 -as 0 -aa 0"),
               ("500k", "-ab 1 -ad 2048 -as 0 -aa 0"), ("2m", "-ab 1 -ad 4096 -as 0 -aa 0"))
PHOTILE = {
    "photile, maps": (
        "--photons 62500 --rays 64 --repeats 2", "--photons 125k --rays 256 --repeats 2",
        "--photons 250k --rays 1024 --repeats 2", "--photons 500k --rays 2048 --repeats 2",
        "--photons 1M --rays 4096 --repeats 2"),
    "photile, paths": (
        "--integrator path --rays 64 --repeats 2", "--integrator path --rays 256 --repeats 2",
        "--integrator path --rays 1024 --repeats 2", "--integrator path --rays 4096 --repeats 2",
        "--integrator path --rays 16384 --repeats 2"),
}
TOOLS = ("rtrace", "rtrace -aa 0", "mkpmap, rtrace", "photile, maps", "photile, paths")
ERRORS = (0.05, 0.02, 0.01)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--radiance", type=pathlib.Path, metavar="FOLDER", help="default: PATH is searched")
    parser.add_argument("--photile", type=pathlib.Path, metavar="COMMAND", default=ROOT / "build/release/photile",
                        help="default: %(default)s")
    parser.add_argument("--again", action="store_true", help="forget the results of before")
    parser.add_argument("--redraw", action="store_true", help="write the page from the results there are")
    parser.add_argument("--quick", action="store_true",
                        help="the cheapest row of each tool and a rough reference: shows that it works, writes nothing")
    return parser.parse_args()


def program(options, name):
    """Path of one of Radiance's programs, or None."""
    if options.radiance:
        found = options.radiance / name
        return found if found.is_file() else None
    return shutil.which(name)


def environment(options):
    """Radiance's programs find their files by RAYPATH; the package pyradiance has them beside bin/."""
    library = options.radiance.parent / "lib" if options.radiance else None
    return {"RAYPATH": str(library), **os.environ} if library and library.is_dir() else None


def run(command, folder, input_file=None, output_file=None, variables=None):
    """Processor seconds of a command that has to succeed."""
    before = processes.processor_seconds()
    with (open(input_file or os.devnull, "rb") as source,
          open(output_file or folder / "output", "wb") as target,
          open(folder / "messages", "w+", encoding="utf-8") as messages):
        done = subprocess.run([str(word) for word in command], cwd=folder, stdin=source, stdout=target,
                              stderr=messages, env=variables, check=False)
        if done.returncode != 0:
            messages.seek(0)
            raise RuntimeError(f"{command[0]}: {messages.read().strip().splitlines()[-1:]}")
    return processes.processor_seconds() - before


class Subject:
    """A scene with its points, as both programs read them."""

    def __init__(self, options, name, folder):
        self.options, self.name, self.folder = options, name, folder
        source, plane = SCENES[name]
        self.gltf = write_plain_gltf(ROOT / source, folder)
        write_radiance_scene(self.gltf, folder / "scene.rad")
        (folder / "grid.json").write_text(json.dumps(GRID))
        rows = self.measure(f"{plane} --photons 20k --rays 16 --repeats 2")[1]
        rows = [row for row in rows if row["lux"]]  # those in solids are blank
        with open(folder / "points.pts", "w", encoding="utf-8") as points:
            for row in rows:
                points.write(" ".join(row[key] for key in ("x", "y", "z", "dx", "dy", "dz")) + "\n")
        self.points = len(rows)

    def measure(self, settings):
        """Processor seconds of `photile measure`, and the lines of its table."""
        table = self.folder / "measured.csv"
        table.unlink(missing_ok=True)
        seconds = run([self.options.photile, "measure", self.gltf, *settings.split(), "--quiet", "-o", table],
                      self.folder)
        with open(table, encoding="utf-8") as lines:
            return seconds, list(csv.DictReader(lines))

    def lux(self, settings):
        seconds, rows = self.measure(f"--points points.pts {settings}")
        return seconds, np.array([float(row["lux"]) for row in rows])

    def reference(self, settings, seed):
        rows = self.measure(f"--points points.pts {settings} --seed {seed}")[1]
        return {"seed": seed, "lux": [float(row["lux"]) for row in rows],
                "standard_error": [float(row["standard_error"]) for row in rows]}

    def octree(self):
        """Processor seconds of oconv, whose file rtrace reads."""
        return self.radiance("oconv", "scene.rad", output_file=self.folder / "scene.oct")

    def radiance(self, name, *words, **files):
        """Processor seconds of one of Radiance's programs."""
        return run([program(self.options, name), *words], self.folder, variables=environment(self.options), **files)

    def traced(self, settings, more=()):
        """Processor seconds of rtrace, and lux."""
        lux = self.folder / "irradiance"
        seconds = self.radiance("rtrace", "-h", "-I+", "-ov", *DIRECT.split(), *settings.split(), *more, "scene.oct",
                                input_file=self.folder / "points.pts", output_file=lux)
        return seconds, np.loadtxt(lux)[:, :3] @ LUMINANCE

    def photon_mapped(self, photons, settings):
        (self.folder / "global.pm").unlink(missing_ok=True)
        seconds = self.radiance("mkpmap", "-apg", "global.pm", photons, "-fo+", "scene.oct")
        more, lux = self.traced(settings, ("-ap", "global.pm", "50"))
        return seconds + more, lux


def figures(lux, reference):
    """Of one run or several, rows of `lux`: root of the mean squared relative error, largest error, ratio of means."""
    errors = np.atleast_2d(lux) / reference - 1
    return {"error": float(np.sqrt(np.mean(errors**2))), "largest": float(np.max(np.abs(errors))),
            "mean": float(np.mean(lux) / np.mean(reference))}


def rows_to_measure(options):
    """(rank, tool, setting, what of a Subject gives processor seconds and lux); the cheapest have rank 0."""
    quick = slice(0, 1) if options.quick else slice(None)
    if program(options, "rtrace") and program(options, "oconv"):
        for tool, settings in RTRACE.items():
            for rank, setting in enumerate(settings[quick]):
                dear = 3 if tool == "rtrace" else 1  # with an ambient cache minutes go into a row
                yield dear * rank, tool, setting, lambda subject, setting=setting: subject.traced(setting)
        if program(options, "mkpmap"):
            for rank, (photons, setting) in enumerate(PHOTON_MAPS[quick]):
                yield (rank, "mkpmap, rtrace", f"-apg {photons}; -ap 50 {setting}",
                       lambda subject, photons=photons, setting=setting: subject.photon_mapped(photons, setting))
    for tool, settings in PHOTILE.items():
        for rank, setting in enumerate(settings[quick]):
            yield rank, tool, setting, lambda subject, setting=setting: several_seeds(subject, setting)


def several_seeds(subject, setting):
    runs = [subject.lux(f"{setting} --seed {seed}") for seed in SEEDS]
    return float(np.mean([seconds for seconds, _ in runs])), np.array([lux for _, lux in runs])


def version(options):
    rtrace = program(options, "rtrace")
    if not rtrace:
        return "not there"
    return subprocess.run([rtrace, "-version"], check=False, capture_output=True, text=True,
                          env=environment(options)).stdout.strip()


def truth_of(scene):
    """Lux of the points by all runs of the reference, and their standard errors."""
    lux = np.mean([run["lux"] for run in scene["references"]], axis=0)
    errors = np.array([run["standard_error"] for run in scene["references"]])
    return lux, np.sqrt(np.sum(errors**2, axis=0)) / len(errors)


def find_reference(options, subject, scene, keep):
    """Adds the runs of the reference that a scene's record lacks; calls `keep` after each."""
    for seed in REFERENCE_SEEDS[:1 if options.quick else None]:
        if seed not in [run["seed"] for run in scene["references"]]:
            scene["references"].append(subject.reference(
                "--integrator path --rays 1024 --repeats 2" if options.quick else REFERENCE, seed))
            keep()


def measure(options, record, keep):
    """Adds what the record lacks, cheap rows of both scenes first, so that one may stop at any time."""
    with tempfile.TemporaryDirectory() as folder:
        subjects = {}
        for name in SCENES:
            of_scene = pathlib.Path(folder) / name.replace(" ", "-")
            of_scene.mkdir()
            subjects[name] = Subject(options, name, of_scene)
            scene = record["scenes"].setdefault(name, {"references": [], "rows": []})
            if scene.get("points", subjects[name].points) != subjects[name].points:
                scene.update(references=[], rows=[])  # of other points
            find_reference(options, subjects[name], scene, keep)
            scene["points"] = subjects[name].points
        octrees = {name: subject.octree() if program(options, "oconv") else 0 for name, subject in subjects.items()}
        for _, tool, setting, work in sorted(rows_to_measure(options), key=lambda row: row[0]):
            for name, subject in subjects.items():
                scene = record["scenes"][name]
                if (tool, setting) in {(row["tool"], row["setting"]) for row in scene["rows"]}:
                    continue
                seconds, lux = work(subject)
                seconds += 0 if tool.startswith("photile") else octrees[name]
                scene["rows"].append({"tool": tool, "setting": setting, "seconds": seconds,
                                      **figures(lux, truth_of(scene)[0])})
                print(name, json.dumps(scene["rows"][-1]), flush=True)
                keep()


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---|" + "--:|" * (len(header) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def seconds_for(rows, tool, error):
    """The least processor seconds by which a tool's row had at most this error."""
    enough = [row["seconds"] for row in rows if row["tool"] == tool and row["error"] <= error]
    return f"{min(enough):.2g} s" if enough else "not reached"


def scene_section(name, scene):
    rows = scene["rows"]
    tools = [tool for tool in TOOLS if any(row["tool"] == tool for row in rows)]
    reference, errors = truth_of(scene)
    noise = np.sqrt(np.mean((errors / reference) ** 2))
    short = table(["tool", *(f"error of {100 * error:.0f}%" for error in ERRORS)],
                  [[tool, *(seconds_for(rows, tool, error) for error in ERRORS)] for tool in tools])
    long = table(["tool and setting", "processor s", "error", "largest", "mean ratio"],
                 [[f"{row['tool']}: `{row['setting']}`", f"{row['seconds']:.2f}", f"{100 * row['error']:.2f}%",
                   f"{100 * row['largest']:.1f}%", f"{row['mean']:.4f}"]
                  for tool in tools for row in rows if row["tool"] == tool])
    return (f"## {name[0].upper() + name[1:]}\n\n{scene['points']} points of {reference.min():.0f} to "
            f"{reference.max():.0f} lx; the reference's own error is {100 * noise:.2f}%. Least processor seconds of "
            f"a measured row for an error:\n\n{short}\n\n{long}")


def all_settings():
    """(tool, setting) of each row that there should be."""
    maps = [("mkpmap, rtrace", f"-apg {photons}; -ap 50 {setting}") for photons, setting in PHOTON_MAPS]
    return maps + [(tool, setting) for tools in (RTRACE, PHOTILE) for tool, settings in tools.items()
                   for setting in settings]


def page(record):
    missing = [f"{tool} `{setting}` ({name})" for name, scene in record["scenes"].items()
               for tool, setting in all_settings()
               if (tool, setting) not in {(row["tool"], row["setting"]) for row in scene["rows"]}]
    lacking = f"\n\nNot measured: {'; '.join(missing)}." if missing else ""
    sections = "\n\n".join(scene_section(name, scene) for name, scene in record["scenes"].items())
    return f"""# Beside Radiance

Error of lux at points against processor seconds, by photile and by Radiance. `bench/rivals/radiance.py` writes this
page.

- **Scenes**: the bundled living room and Cornell box, diffuse and without textures, lit by their lamps with an area:
  copies that both programs read. Neither has a sky, and both programs have no ground below the horizon (`ground=0`).
  Points look up from a horizontal plane.
- **Error**: root of the mean over the points of ((lux - reference) / reference)^2, of photile over {len(SEEDS)} seeds;
  *largest* is that of the worst point. **Mean ratio**: mean lux over that of the reference.
- **Reference**: the mean of `photile measure {REFERENCE}` with {len(REFERENCE_SEEDS)} other
  seeds: unbiased paths. Where rays are many, rtrace without a cache comes to the same mean.
- **rtrace** computes irradiance (`-I+`) with `{DIRECT}`; with an ambient cache (`-aa` above 0), without (`-aa 0`), and
  from a photon map by `mkpmap` with one gathered bounce. oconv is in its time. Each point has one jittered sample of each
  part of a lamp, whose noise is in all rows; a finer `-ds` takes more time, and other settings may do better. With
  `-ds` above 0, rtrace loses a part of the direct light of lamps that are made of triangles, such as those of the
  living room's floor and desk lamps; with `-ds 0` it agrees with photile. Much of its error in that room is this.
- **photile, maps** is `photile measure`; **photile, paths** is `photile measure --integrator path`. Reading the scene is in
  all times; kernels are compiled.

{record['cores']} cores, {record['processor']}; load average {record['load_average']:.1f}; {record['radiance']}.{lacking}

![Error against processor seconds](benchmarks/radiance.svg)

{sections}

## See also

[Accuracy](accuracy.md), [quality](quality.md).
"""


def draw(record):
    figure, axes = plots.panels(len(record["scenes"]), "lux at points")
    for axis, (name, scene) in zip(axes, record["scenes"].items()):
        for number, tool in enumerate(TOOLS):
            rows = sorted((row["seconds"], row["error"]) for row in scene["rows"] if row["tool"] == tool)
            if rows:
                axis.plot(*zip(*rows), "-o", markersize=4, label=tool, color=plots.COLOURS[number])
        plots.log_log(axis, name, "processor seconds")
    axes[0].set_ylabel("root mean square relative error")
    plots.legend_beside(axes)
    plots.save(figure, PLOT)


def main():
    options = arguments()
    stored = RESULTS.is_file() and not options.again and not options.quick
    record = json.loads(RESULTS.read_text(encoding="utf-8")) if stored else {"bench": "radiance", "scenes": {}}

    def keep():
        if not options.quick:
            RESULTS.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")

    if not options.redraw:
        now = measured.now()
        record |= {"cores": os.cpu_count(), "load_average": os.getloadavg()[2], "radiance": version(options),
                   "processor": now["machine"], "commit": now["commit"], "date": now["date"]}
        measure(options, record, keep)
    if options.quick:
        print(page(record))
        return
    draw(record)
    replace_page(PAGE, "rivals/radiance.py", page(record), RESULTS)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        sys.exit(f"radiance.py: error: {error}")
