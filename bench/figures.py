#!/usr/bin/python3
"""Collects the figures that README.md and the pages cite, into docs/figures.json.

    bench/figures.py [--photile COMMAND] [--measure NAME]...

Most are found in what other benches have written; the others are measured here, where --measure names them, or
part of their names. Each is kept with its command, machine, commit, date and what it measures: files and folders
whose later changes make it old. A page cites a figure by a comment behind its numbers,

    takes 52 to 55 processor seconds<!-- figure: living_room.processor_s -->

and tests/docs/figures.py refuses numbers that are others, and figures that are old.
"""

import argparse
import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "bench"))
from kernels.report_ratios import TREES, ratios
from kernels.report_tables import timed as timed_rows
from tools import measured, processes

RESULTS = ROOT / "docs/figures.json"
RUNS = 3  # of what is measured here: the least and the most are the figure
SEARCH = ["host/renderer/estimate", "kernels/estimate", "bench/structures"]
BUILD = ["host/renderer/maps", "host/renderer/groups", "kernels/grid"]
PICTURE = ["host/renderer", "kernels"]


def read(file):
    return json.loads((ROOT / file).read_text(encoding="utf-8"))


# What other benches have written.

def times_as_fast_as_nanoflann(workload):
    """Of a million photons, with k of 50 and 200."""
    found = ratios(timed_rows(read("docs/measured/benchmarks/knn.json")))

    def of(k):
        structures = found[(workload, k)]
        return min(of_photons[min(of_photons, key=lambda count: abs(count - 1_000_000))]
                   for name, of_photons in structures.items() if name.startswith("nanoflann"))
    return [of(50), of(200)]


def times_of_grid():
    """As fast as the kd-tree in the plane with the same selection: the least and the most of a million photons."""
    found = ratios(timed_rows(read("docs/measured/benchmarks/knn.json")))
    values = [min(structures[tree][max(structures[tree])] for tree in TREES)
              for structures in found.values() if all(tree in structures for tree in TREES)]
    return [min(values), max(values)]


def build_over_one_tree(photons):
    rows = read("docs/measured/benchmarks/build.json")["results"]
    row = min((row for row in rows if row["workload"] == "living-room" and row["maps of"] == "auto"),
              key=lambda row: abs(row["photons"] - photons))
    return [(row["groups"]["median"] + row["uniform-grid"]["median"]) / row["nanoflann"]["median"]]


def pictures(tool, setting, key):
    """The least and the most of the two interiors' smaller pictures."""
    rows = [row for row in read("docs/measured/quality/quality.json")["results"]
            if row["tool"] == tool and row["setting"] == setting and row["view"].endswith("256x192")]
    values = [row["first"]["processor"] if key == "processor" else row[key] for row in rows]
    return [min(values), max(values)]


def too_dark():
    """Per cent of the mean, at most, of the two interiors with the default quality and with the finest."""
    ratios_of_means = [value for quality in ("good", "final")
                       for value in pictures("photile", f"`--quality {quality}`", "mean_ratio")]
    return [100 * (1 - min(ratios_of_means))]


def readings_within():
    rows = read("docs/measured/accuracy/validation.json")["readings"]
    good = [row for row in rows if row["photon_map"]["verdict"] == row["path"]["verdict"] == "ok"]
    return [len(good), len(rows)]


def on_gpu(k):
    """Times as fast as the best CUDA library, on an H100."""
    def best(rows, seconds):
        return min(row[seconds]["median"] / row["queries"] for row in rows if seconds in row
                   and row["workload"] == "plane" and row["photons"] == 1_000_000 and row["k"] == k)
    libraries = [json.loads(line) for line in (ROOT / "results/cuda/nvidia-h100.jsonl").read_text().splitlines()]
    photile = [row for row in read("results/cuda/nvidia-h100-photile.json")["results"]
               if row["structure"] == "uniform-grid"]
    return best(libraries, "seconds") / best(photile, "kernel seconds")


def on_sixteen_cores():
    """Wall seconds of the default picture of the living room, its neighbours found by the processor and by a card."""
    rows = read("results/workstations/intel-xeon-and-nvidia-h200.json")["pictures"]
    return [row["seconds"] for row in rows if row["cores"] == 16]


# What is measured here.

def processor_seconds(photile, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        runs = [processes.timed([photile, *arguments, "-o", f"{folder}/picture.exr", "-q"])[1] for _ in range(RUNS)]
    return [min(runs), max(runs)]


def living_room(photile):
    return processor_seconds(photile, "render", ROOT / "scenes/living-room/living-room.gltf")


# Name: what finds the values, where or with which command, and what is measured.
FOUND = {
    "validation.readings": (readings_within, "docs/measured/accuracy/validation.json", ["host/apps/validation"]),
    "search.plane": (lambda: times_as_fast_as_nanoflann("plane"), "docs/measured/benchmarks/knn.json", SEARCH),
    "search.living_room": (lambda: times_as_fast_as_nanoflann("living-room"), "docs/measured/benchmarks/knn.json", SEARCH),
    "search.classroom": (lambda: times_as_fast_as_nanoflann("classroom"), "docs/measured/benchmarks/knn.json", SEARCH),
    "search.grid": (times_of_grid, "docs/measured/benchmarks/knn.json", SEARCH),
    "search.h100": (lambda: [on_gpu(50), on_gpu(200)], "results/cuda/nvidia-h100-photile.json", SEARCH),
    "build.hundred_thousand": (lambda: build_over_one_tree(100_000), "docs/measured/benchmarks/build.json", BUILD),
    "build.million": (lambda: build_over_one_tree(1_000_000), "docs/measured/benchmarks/build.json", BUILD),
    "living_room.sixteen_cores_s": (on_sixteen_cores, "results/workstations/intel-xeon-and-nvidia-h200.json", PICTURE),
    "pictures.good_relmse": (lambda: pictures("photile", "`--quality good`", "rel_mse"),
                                "docs/measured/quality/quality.json", PICTURE),
    "pictures.good_processor_s": (lambda: pictures("photile", "`--quality good`", "processor"),
                                     "docs/measured/quality/quality.json", PICTURE),
    "pictures.too_dark_percent": (too_dark, "docs/measured/quality/quality.json", PICTURE),
    "pictures.denoised_relmse": (lambda: pictures("photile, paths denoised", "4 spp", "rel_mse"),
                                 "docs/measured/quality/quality.json", PICTURE),
    "pictures.denoised_processor_s": (lambda: pictures("photile, paths denoised", "4 spp", "processor"),
                                      "docs/measured/quality/quality.json", PICTURE),
}
MEASURED = {
    "living_room.processor_s": (living_room, "photile render scenes/living-room/living-room.gltf", PICTURE),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photile", default=ROOT / "build/release/photile", metavar="COMMAND")
    parser.add_argument("--measure", action="append", default=[], metavar="NAME")
    given = parser.parse_args()
    wrong = [part for part in given.measure if not any(part in name for name in MEASURED)]
    if wrong:
        parser.error(f"--measure {wrong[0]} is part of no name; there are {', '.join(MEASURED)}")
    figures = read(RESULTS) if RESULTS.is_file() else {}
    figures = {name: figure for name, figure in figures.items() if name in MEASURED}
    for name, (find, file, measures) in FOUND.items():
        figures[name] = {"values": find(), "command": file, **measured.of_file(file), "measures": measures}
        if file.startswith("results/"):
            figures[name]["card"] = "NVIDIA H100 and H200"
    for name, (measure, command, measures) in MEASURED.items():
        if any(part in name for part in given.measure):
            figures[name] = {"values": measure(given.photile), "command": command, **measured.now(),
                             "measures": measures}
    for figure in figures.values():
        figure["values"] = [float(f"{value:.4g}") for value in figure["values"]]
    RESULTS.write_text(json.dumps(dict(sorted(figures.items())), indent=1) + "\n", encoding="utf-8")
    print(RESULTS)


if __name__ == "__main__":
    main()
