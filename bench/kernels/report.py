#!/usr/bin/python3
"""Writes docs/measured/benchmarks.md and its plots from docs/measured/benchmarks/*.json. Runs nothing.

    bench/kernels/report.py [--results FOLDER] [--page FILE]

Needs the Debian package python3-matplotlib.
"""

import argparse
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_page
from kernels import (report_kernels, report_lights, report_plots, report_ratios, report_scale, report_tables,
                     report_targets)

BENCHES = ("knn", "paper", "build", "relight", "lights", "kernels", "startup", "profile")
OPTIONAL = ("python_neighbours", "scale")
BUSY_LOAD = 0.5  # load average at which other programs count as running


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "docs/measured/benchmarks",
                        help="folder of the JSON files; plots go there too")
    parser.add_argument("--page", type=pathlib.Path, default=ROOT / "docs/measured/benchmarks.md")
    return parser.parse_args()


def load(results):
    """What is said of other programs, or ""."""
    average = results["knn"]["machine"]["load average at start"]
    if average <= BUSY_LOAD:
        return ""
    return (f"other programs were running (load average {average:.1f} before the search was timed). Ratios of the search "
            "come from runs in turns and from processor time, which other programs change little. Waiting times are "
            "longer than on an idle machine")


def doubts(results):
    """Why the numbers are not to be relied on; empty where they are."""
    single = [name for name, result in results.items() if result["settings"].get("repeats", 3) < 3]
    return [f"fewer than three repeats ({', '.join(single)}), so the brackets do not show the spread"] if single else []


def machine_of(result):
    machine = result["machine"]
    return f"{machine['processor']}, {machine['hardware threads']} hardware threads"


def caption(results, bench):
    """The machine and the date, for the plots of a bench."""
    result = results[bench]
    device = result["device"]
    parts = [machine_of(result), f"OpenCL: {device['platform']} {device['driver']}", result["date"]]
    if doubts(results):
        parts.append("provisional")
    return "; ".join(parts)


def other_machines(results):
    """A line for each day and machine other than those of the search, with what was measured then."""
    own = machine_of(results["knn"]), results["knn"]["date"]
    benches = {}
    for name, result in results.items():
        if "machine" in result:
            benches.setdefault((machine_of(result), result["date"]), []).append(name)
    return [f"{', '.join(f'`{name}.json`' for name in names)}: {machine}; {date}."
            for (machine, date), names in sorted(benches.items()) if (machine, date) != own]


def machine_section(results):
    knn = results["knn"]
    device, versions = knn["device"], knn["versions"]
    lines = [
        f"**Machine**: {machine_of(knn)}; {knn['date']}.",
        f"**OpenCL device**: {device['name']}, {device['platform']} {device['driver']}, "
        f"{device['compute units']} compute units.",
        "**Versions**: " + ", ".join(f"{name} {version}" for name, version in versions.items())
        + ".",
        *other_machines(results),
    ]
    if load(results):
        lines.append(f"**Load**: {load(results)}.")
    lines += [f"**Provisional**: {reason}." for reason in doubts(results)]
    if any(result["settings"]["quick"] for result in results.values()):
        lines.append("**From a smoke test (`--quick`): these numbers mean nothing.**")
    return "  \n".join(lines)


def structure_and_selection(knn):
    """Its section, of a million photons; none where a run left out the structures."""
    rows = [row for row in report_tables.timed(knn) if report_tables.near_target(row["photons"])]
    text = report_ratios.structure_and_selection(rows)
    return ["### Structure and selection", text] if text else []


def page(results, plots, ratio_plots, notes):
    sections = [
        "# Benchmarks",
        "The search for the k nearest photons beside other libraries and structures, the build of the maps, relighting and "
        "starts. `bench/run_all.sh --docs` measures all of it and writes this page. Times are medians, with the "
        "smallest and the largest in brackets.",
        machine_section(results),
        "On a GPU: `PHOTILE_DEVICE=gpu bench/run_all.sh --docs`.",
        "## Targets", report_targets.write_table(results, bool(doubts(results))),
        "## Search and estimate against the number of photons",
        report_tables.knn_text(results["knn"]),
        "\n\n".join(f"![Time against photons: {name}](benchmarks/{file})"
                    for name, file in plots),
        report_tables.knn(results["knn"]),
        *structure_and_selection(results["knn"]),
        "### Lists", report_tables.lists(results["knn"], results.get("python_neighbours")),
        "### Kernels and the rest", report_tables.parts_of_time(results["knn"]),
        "### Variants of nanoflann", report_tables.variants(results["knn"]),
        "### As ratios",
        "\n\n".join(f"![Time over that of the uniform grid: {name}](benchmarks/{file})"
                    for name, file in ratio_plots),
        "## Where the time of an estimate goes", report_kernels.profile(results["profile"]),
        "## Kinds of scenes", report_kernels.specialisations(results["kernels"]),
        "## Beside the limits of the device", report_kernels.roofline(results["kernels"]),
        report_kernels.build_kernels(results["kernels"]),
        "## The paper's frame", report_tables.paper(results["paper"]),
        "## Build", report_tables.build(results["build"]),
        "## Relighting", report_tables.relight(results["relight"]),
        "## Many lights", report_lights.text(results["lights"]),
        *(["## Scale", report_scale.text(results["scale"])] if "scale" in results else []),
        "## Starting", report_kernels.startup(results["startup"]),
        notes,
        "## See also",
        "[Neighbour groups](groups.md), [density](density.md), [devices](devices.md). The records that the tables are "
        "made from are the JSON files in [benchmarks/](benchmarks/).",
    ]
    return "\n\n".join(section.strip() for section in sections) + "\n"


def main():
    options = arguments()
    results = {}
    for bench in BENCHES:
        with open(options.results / f"{bench}.json", encoding="utf-8") as file:
            results[bench] = json.load(file)
    for bench in OPTIONAL:
        file = options.results / f"{bench}.json"
        if file.exists():
            results[bench] = json.loads(file.read_text(encoding="utf-8"))
    plots = report_plots.draw_knn(results["knn"], caption(results, "knn"), options.results)
    ratio_plots = report_plots.draw_ratios(results["knn"], caption(results, "knn"), options.results)
    report_lights.draw(results["lights"], caption(results, "lights"), options.results)
    if "scale" in results:
        report_scale.draw(results["scale"], caption(results, "scale"), options.results)
    notes = (ROOT / "bench/kernels/report_notes.md").read_text(encoding="utf-8")
    replace_page(options.page, "kernels/report.py", page(results, plots, ratio_plots, notes), options.results / "knn.json")
    print(f"wrote {options.page}")


if __name__ == "__main__":
    main()
