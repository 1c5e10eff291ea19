#!/usr/bin/python3
"""Faults drawn at random from the code, rather than chosen: which share of them the tests notice.

    bench/tools/drawn_mutants.py [--count N] [--seed N] [--only kernels|host] [--folders NAME ...] [--all]
                           [--seconds N] [--part I/N --work FOLDER] [--results FILE]
                           [--list] [--renew] [--page] [--alone]

Each changes one operator, bound, constant or truth value of a line (mutant_sites.py) of kernels/ or of
folders of the parts of host/: groups, surface and trace, or those of --folders. Mutants of kernels are copies of the
folder that PHOTILE_KERNEL_DIR names; those of the host are in one build (mutant_schemata.py), linked with the objects
of the build at hand. Tests that noticed most in the least time come first, and the first that fails
ends a mutant; with --all every test runs, and --alone says what each noticed alone. A mutant that does not compile
does not count.

Results are added to docs/testing/drawn_mutants.json (--results), which holds the text of each line, so
that its mutants are found again where code has moved; --seed and --count are for a file that is not there
yet. Those decided there are not run again. Survivors need a look: "equivalent" with a reason there if no
result can change, a test otherwise. --page writes the share into docs/testing.md.
"""

import argparse
import fcntl
import hashlib
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import mutant_sites
from tools.mutant_builder import Builder, DoesNotCompile
from tools.mutant_schemata import HEADER, Schemata
from tools.mutant_tests import CannotRun, Order, Step, run_step, steps_of_folder, tests_of
from tools.report_section import replace_section

RESULTS = ROOT / "docs/testing/drawn_mutants.json"
HOST_FOLDERS = ("groups", "surface", "trace")

# Cases of the tests of kernels, each with few variants to compile.
KERNEL_CASES = {
    "estimate": (
        "irradiance equals the oracle's for one light",
        "every vector width gives the oracle's irradiance for one light",
        "neighbours equal the oracle's on a plate, for few and many photons and any k",
        "neighbours equal the oracle's on a torus with triangles smaller than the radius",
        "neighbours equal the oracle's where three plates meet and two lie back to back",
        "ties at the border of the neighbourhood go to the smallest photon indices",
        "clipped irradiance on plates of any triangulation equals the oracle's",
        "clipped irradiance where surfaces bend out of the slab equals the oracle's",
        "clipped irradiance on vertices and edges to the last bit equals the oracle's",
        "the exact law of the estimate in a corner of 45 degrees",
        "areas at corners, edges and T-junctions of the bundled rooms are the oracle's",
        "tiles on a floor read 1, in their middle and at the border of the floor",
        "thin plates of 1 to 20 mm read 1 on their faces: their insides count for nothing",
        "maps of patches find the oracle's neighbours on a fine torus",
        "irradiance equals the oracle's per light, for few and for many lights",
        "glossy radiance equals the BSDF summed over the oracle's neighbours in double",
        "weighted irradiance equals the oracle's for one light and for many, for any k",
        "lanes differ from vectors in the order of sums alone",
        "a hit keeps the lights that reach it, each once, however many there are",
        "k of 1 to 900 gives the oracle's irradiance",
        "extremes: photons within the radius by less than rounding moves them across cells",
        "extremes: surfaces less than a float's rounding apart count as one",
        "extremes: photons and hits on corners, edges and cell borders, and on the radius",
        "neighbours equal the oracle's among 2^20 + 1 photons",
        "extremes: the second photon at a distance that selection compares with",
        "hits a rounding beyond an edge or a corner count as on it, far off along any axis",
        "a panel all under a plate counts whole for hits on it, and as nothing for those above",
        "of two photons in one place at the border of the neighbourhood one counts",
        "hits that no photon comes near read nothing, next to hits that photons do",
        "selection tells photons apart at distances of ten orders of magnitude",
        "each light's estimates are those of its photons alone",
        "lanes estimate every kind as the oracle does"),
    "maps": ("[#grid_contents_test]~[slow]~[long]",),
    "surface": ("[#kernel_functions_test]",),
    "render": ("maps that keep normals give the same bits within an eighth of the memory",),
    "bench": ("a search for all photons computes the distance of each once",)}
# These cases run with a layer around OpenCL, which shows what GPUs run, and what is read or written
# beyond a buffer.
LAYER_CASES = (
    ("gpu", "maps", "[#grid_contents_test]~[slow]~[long]"),)
# Beyond the tests of the folder itself.
FURTHER_TESTS = {
    "groups": (("maps", "grid_contents"), ("estimate", "estimates_vs_oracle"),
               ("estimate", "neighbours_vs_oracle")),
    "surface": (("estimate", "corners"), ("estimate", "dark_surface"), ("estimate", "clipped_surfaces"),
                ("estimate", "clipped_vs_oracle")),
    "trace": (("reference", "path_direct_light"), ("reference", "path_interreflection"),
              ("reference", "path_materials"), ("reference", "path_smooth_shading"),
              ("render", "direct_rays"), ("cache", "irradiance_gather"),
              ("cache", "gathered_nodes"), ("measuring", "gather"),
              ("cache", "light_map_sensors"), ("cache", "light_map_frames"),
              ("loading", "textured_lights"), ("daylight", "daylight_matrix")),
    "scene": (("trace", "emission"), ("trace", "intensity"), ("trace", "bsdf"), ("trace", "primary_hits"),
              ("loading", "placement"), ("loading", "textures"), ("loading", "light_groups"),
              ("loading", "material_reflectance"), ("loading", "photometric_files"),
              ("loading", "textured_lights"), ("loading", "obj"), ("loading", "color_temperature"),
              ("loading", "bad_input")),
    "gltf": (("fuzz", "corpus"),), "obj": (("fuzz", "corpus"),),
    "image": (("loading", "textures"),),
    "measuring": (("command", "measure"),), "daylight": (("command", "daylight"),), "glare": (("command", "glare"),),
    "report": (("measuring", "plan_surroundings"), ("measuring", "isolines"),
               ("measuring", "false_colour_picture"), ("measuring", "sensor_files"), ("image", "colours"),
               ("command", "pictures"), ("command", "measure"), ("command", "glare"), ("command", "daylight")),
    "saved_maps": (("command", "saved_maps"),), "cloud": (), "view": (), "denoise": (("render", "denoiser"),),
    "bake": (("command", "trade"),), "walk": (("command", "walk"),), "command": ()}

# Folders of host/ whose tests are in a folder of another name.
TESTED_IN = {"gltf": "loading", "obj": "loading"}


def home_of(folder):
    """The folder of tests/ for a folder of host/."""
    return TESTED_IN.get(folder, folder)


def folder_of(name):
    """The folder of host/'s parts that a file or a mutant of it is in, or kernels."""
    return name.split("/")[2] if name.startswith("host/") else "kernels"


def all_files(options):
    kernels = [] if options.only == "host" else ["kernels/**/*.cl*"]
    host = [] if options.only == "kernels" else [f"host/*/{folder}/**/*.[ch]pp" for folder in options.folders]
    return [file for pattern in kernels + host for file in sorted(ROOT.glob(pattern))]


def wilson(killed, count):
    """The interval that holds the share with 95%."""
    if count == 0:
        return 0.0, 1.0
    z, share = 1.96, killed / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count**2)) / (1 + z * z / count)
    return middle - half, middle + half


class Kernels:
    """Runs mutants of kernels/ with the programs of the build."""

    def __init__(self, build, work):
        self.build, self.work = build, work
        self.steps = [Step(folder, (case,)) for folder, cases in KERNEL_CASES.items() for case in cases]
        self.steps += [Step(folder, (case,), layer=layer) for layer, folder, case in LAYER_CASES]
        # Kernels that do not include the mutant's file are compiled once for all.
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(work / "cache"),
                            "POCL_CACHE_DIR": str(work / "cache/pocl")}
        (work / "cache/pocl").mkdir(parents=True, exist_ok=True)
        self.environment.pop("PHOTILE_KERNEL_DIR", None)

    def prepare(self, site):
        shutil.rmtree(self.work / "kernels", ignore_errors=True)
        shutil.copytree(ROOT / "kernels", self.work / "kernels")
        (self.work / site.file).write_text(site.apply((ROOT / site.file).read_text(encoding="utf-8")),
                                           encoding="utf-8")

    def matters(self, step):
        return True

    def run(self, step, mutated, limit, whole):
        environment = dict(self.environment)
        if mutated:
            environment["PHOTILE_KERNEL_DIR"] = str(self.work / "kernels")
        if step.layer:
            environment["OPENCL_LAYERS"] = str(
                self.build / f"tests/device/layers/libphotile_{step.layer}_layer.so")
        return run_step(self.build / tests_of(step.folder), step, environment, limit, whole)


class Host:
    """Runs mutants of host/ in their common build, or in one of their own."""

    def __init__(self, build, work, sites, order, folders):
        builder = Builder(build, work)
        self.builder, self.work, self.order = builder, work, order
        self.schemata = Schemata(builder, sites, folders)
        self.folders = folders
        self.numbers = {site.name: number for number, site in self.schemata.sites.items()}
        self.own, self.own_programs = {}, {}  # objects and programs of a mutant that is built alone
        self.number = 0
        self.reached = {}  # step -> numbers of the mutants that can change what it does
        self.folder_steps = {
            folder: steps_of_folder(self.schemata.program(tests_of(home_of(folder))), home_of(folder),
                                    work / f"{home_of(folder)}.json", order)
            if (ROOT / "tests" / home_of(folder)).is_dir() else []
            for folder in folders}

    def steps(self, folder):
        return self.folder_steps[folder] + [Step(other, (f"[#{file}_test]~[slow]",))
                                            for other, file in FURTHER_TESTS[folder]]

    def prepare(self, site):
        self.own, self.own_programs, self.number = {}, {}, self.numbers[site.name]
        if self.number not in self.schemata.alone:
            return
        copy, text = self.work / site.file, (ROOT / site.file).read_text(encoding="utf-8")
        instrumented = copy.read_text(encoding="utf-8")
        copy.write_text(site.apply(text), encoding="utf-8")
        readers = self.builder.objects_that_read(site.file, self.folders)
        try:
            self.own = {name: self.builder.compile(name, ["-Wno-narrowing", "-include", str(HEADER)], "own")
                        for name in readers if name in self.schemata.objects}
        except DoesNotCompile:
            raise CannotRun("it does not compile") from None
        finally:
            copy.write_text(instrumented, encoding="utf-8")

    def matters(self, step):
        """Whether the mutant gives a value of its own anywhere in the step; asked once for all mutants."""
        if self.own:
            return True
        if step.key not in self.reached:
            file = self.work / "reached" / f"{hashlib.sha256(step.key.encode()).hexdigest()[:16]}.txt"
            if not file.is_file():
                file.parent.mkdir(exist_ok=True)
                part = file.with_suffix(".part")
                part.unlink(missing_ok=True)
                outcome = self._run(step, self.schemata.program, {"PHOTILE_MUTANT_RECORD": str(part)})
                self.order.note(step, outcome.sound().seconds)
                part.touch()  # a step that comes by no mutant writes none
                part.rename(file)
            self.reached[step.key] = {int(line) for line in file.read_text(encoding="utf-8").split()}
        return self.number in self.reached[step.key]

    def _own_program(self, target):
        if target not in self.own_programs:
            self.own_programs[target] = self.builder.link(target, {**self.schemata.objects, **self.own}, "own")
        return self.own_programs[target]

    @staticmethod
    def _run(step, program, environment, limit=None, whole=False):
        """`program` gives the one of a target. The tests of the command run that of the mutants, too."""
        if step.folder == "command":
            environment = {**environment, "PHOTILE_COMMAND": str(program("photile"))}
        return run_step(program(tests_of(step.folder)), step, {**os.environ, **environment}, limit, whole)

    def run(self, step, mutated, limit, whole):
        program = self._own_program if mutated and self.own else self.schemata.program
        return self._run(step, program, {"PHOTILE_MUTANT": str(self.number if mutated else 0)}, limit, whole)


def try_mutant(site, runner, steps, order, whole):
    """The tests that notice, or the first of them."""
    area = str(pathlib.PurePath(site.file).parent)
    runner.prepare(site)
    noticed = []
    for step in order.of(steps, area, pathlib.PurePath(site.file).stem if area[0] == "h" else ""):
        if not runner.matters(step):
            continue
        if not order.passed_before(step):
            order.note(step, runner.run(step, False, None, whole).sound().seconds)
        outcome = runner.run(step, True, order.limit(step), whole)
        failed = [f"/{name}" for name in outcome.failed] or [f"/{step.file}: crash"] * outcome.crashed
        noticed += [f"{step.folder}{what}{step.under_layer}" for what in failed]
        order.count(step, area, bool(failed))
        if not failed:
            order.note(step, outcome.seconds)
        elif not whole:
            break
    return noticed


def stored(file):
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    return json.loads(text or "{}")


def store(file, name, result):
    with open(file, "a", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        results = stored(file)
        results[name] = {**results.get(name, {}), **result}
        file.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def decided(result):
    return any(kind in result for kind in ("noticed", "equivalent", "survives", "not_counted"))


def draw(options):
    """The mutants of the results, or as many as asked for: name -> site, None where its line is gone."""
    results = stored(options.results)
    if not results:
        everything = list(mutant_sites.sites(ROOT, all_files(options)))
        for site in random.Random(options.seed).sample(everything, min(options.count, len(everything))):
            text = (ROOT / site.file).read_text(encoding="utf-8").split("\n")[site.line]
            results[site.name] = {"line": text}
        options.results.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    places = {}  # text -> (file, number from 0)
    for file in all_files(options):
        for number, text in enumerate(file.read_text(encoding="utf-8").split("\n")):
            places.setdefault(text, []).append((str(file.relative_to(ROOT)), number))
    return {name: found_again(name, places.get(result["line"], [])) for name, result in results.items()}


def found_again(name, places):
    """The site where the text of its line is now: the nearest one in its file, or else in another file."""
    place, token = name.split(" ")[:2]
    file, number, column = place.split(":")
    nearest = min(places, key=lambda at: (at[0] != file, abs(at[1] + 1 - int(number))), default=None)
    return None if nearest is None else mutant_sites.Site(*nearest, int(column) - 1, token)


def renew(file, drawn):
    """Names the mutants of the results by where their lines are now, and leaves out those whose lines are gone."""
    results = stored(file)
    file.write_text(json.dumps({site.name: results[name] for name, site in drawn.items() if site}, indent=1) + "\n",
                    encoding="utf-8")


def run_all(options, drawn):
    work = options.work.resolve()
    work.mkdir(exist_ok=True)
    order = Order(work / f"order_{options.only or 'all'}.json")
    results = stored(options.results)
    left = [(name, site) for name, site in drawn.items() if not decided(results[name])
            and (not options.only or name.startswith(options.only))]
    part, parts = map(int, options.part.split("/"))
    left = left[part - 1::parts]
    end = time.monotonic() + options.seconds
    host = None
    kernels = Kernels(options.build, work)
    for name, site in left:
        if site is None:
            store(options.results, name, {"not_counted": "its line is gone"})
            continue
        if time.monotonic() > end:
            break
        in_host = site.file.startswith("host/")
        if in_host and host is None:
            sites = [site for site in drawn.values() if site and site.file.startswith("host/")]
            host = Host(options.build, work, sites, order, options.folders)
        runner = host if in_host else kernels
        steps = host.steps(folder_of(site.file)) if in_host else kernels.steps
        before = os.times()
        try:
            noticed = try_mutant(site, runner, steps, order, options.all)
            result = {"noticed": noticed if options.all else noticed[0]} if noticed else {"survives": ""}
        except CannotRun as reason:
            result = {"not_counted": str(reason).splitlines()[0]}
        after = os.times()
        result["seconds"] = round(after.children_user + after.children_system
                                  - before.children_user - before.children_system, 1)
        store(options.results, name, result)
        print(f"{name}: {result}", flush=True)


def page(results):
    """The section of docs/testing.md."""
    rows = ["| | drawn | noticed | by one test alone | equivalent | survive | do not compile | not decided | "
            "share noticed |", "|---|--:|--:|--:|--:|--:|--:|--:|---|"]
    for name in [*dict.fromkeys(map(folder_of, results)), "all"]:
        of_area = [result for mutant, result in results.items() if name in ("all", folder_of(mutant))]
        count = len(of_area)
        of_area = list(filter(decided, of_area))
        noticed, equivalent, survive, refused = (
            sum(kind in result for result in of_area)
            for kind in ("noticed", "equivalent", "survives", "not_counted"))
        lists = [result["noticed"] for result in of_area if isinstance(result.get("noticed"), list)]
        alone = sum(len(tests) == 1 for tests in lists) if lists else "-"
        low, high = wilson(noticed, noticed + survive)
        share = f"{100 * noticed / max(noticed + survive, 1):.1f}% ({100 * low:.0f} to {100 * high:.0f}%)"
        if len(of_area) < count:  # those that the quickest tests notice are decided first
            share = f"at least {100 * noticed / max(count - equivalent - refused, 1):.0f}%"
        rows.append(f"| {name} | {count} | {noticed} | {alone} | {equivalent} | {survive} | {refused} | "
                    f"{count - len(of_area)} | {share} |")
    return "\n".join(rows) + "\n"


def noticed_alone(options):
    """Lines: how many mutants each test of the folders noticed with others and alone."""
    lists = [result["noticed"] for result in stored(options.results).values()
             if isinstance(result.get("noticed"), list)]
    tests = [f"{folder}/{case}" for folder in dict.fromkeys(map(home_of, options.folders))
             for _, cases, _ in stored(options.work / f"{folder}.json") for case in cases]
    return [f"{sum(test in noticed for noticed in lists):4} {lists.count([test]):4}  {test}"
            for test in dict.fromkeys([*tests, *(test for noticed in lists for test in noticed)])]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=29)
    parser.add_argument("--only", choices=("kernels", "host"))
    parser.add_argument("--folders", nargs="+", default=HOST_FOLDERS, metavar="NAME",
                        help="of the parts of host/; default: groups surface trace")
    parser.add_argument("--all", action="store_true", help="note every test that notices, not the first")
    parser.add_argument("--part", default="1/1", metavar="I/N", help="of those that are left")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/mutants")
    parser.add_argument("--seconds", type=float, default=math.inf, help="after which none is begun")
    parser.add_argument("--list", action="store_true", help="print those drawn, run none")
    parser.add_argument("--renew", action="store_true", help="name those drawn by where their lines are now, run none")
    parser.add_argument("--page", action="store_true", help="write docs/testing.md, run none")
    parser.add_argument("--alone", action="store_true", help="print what each test noticed, and alone; run none")
    parser.add_argument("--results", type=pathlib.Path, default=RESULTS)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    return parser.parse_args()


def main():
    options = arguments()
    drawn = draw(options)
    if options.list:
        print("\n".join(drawn))
    elif options.renew:
        renew(options.results, drawn)
    elif options.page:
        drawn = [stored(file) for file in (RESULTS, *sorted(RESULTS.parent.glob("drawn_*_*.json")))]
        replace_section(ROOT / "docs/testing.md", "tools/drawn_mutants.py",
                        page({name: result for results in drawn for name, result in results.items()}))
    elif options.alone:
        print("\n".join(noticed_alone(options)))
    else:
        run_all(options, drawn)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, CannotRun, DoesNotCompile, subprocess.CalledProcessError) as error:
        sys.exit(f"drawn_mutants.py: error: {error}")
