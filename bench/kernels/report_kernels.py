"""Tables of docs/measured/benchmarks.md about kernels: specialisations, the device's limits, starts, and
where the time of an estimate goes."""

import math

from kernels.report_tables import table, times

ESTIMATE = "estimate_by_selection"


def rows_of(result, measured):
    return [row for row in result["results"] if row["measured"] == measured]


def specialisations(result):
    rows = rows_of(result, "specialisation")
    workloads = list(dict.fromkeys(row["workload"] for row in rows))
    lines = []
    for glossy in (False, True):
        for several in (False, True):
            chosen = {row["workload"]: row for row in rows
                      if row["glossy"] == glossy and (row["lights"] > 1) == several}
            lights = max(row["lights"] for row in chosen.values())
            cells = [f"{'glossy' if glossy else 'diffuse'}, "
                     f"{f'{lights} lights' if several else 'one light'}"]
            for workload in workloads:
                row = chosen[workload]
                cells += [f"{row['bytes per reference']:.0f}",
                          times(row["seconds"], 1e6 / row["hits"])]
            lines.append(cells)
    text = ("Each kind of scene has a kernel of its own, which holds only what the scene needs. The same photons and hits, "
            f"k = {result['settings']['k']}: bytes of device memory for each reference, with its part of grids and "
            "cells, and microseconds of the kernel for each hit.")
    header = ["scene"]
    for workload in workloads:
        header += [f"{workload}: bytes", "microseconds a hit"]
    return text + "\n\n" + table(header, lines)


def estimate_cost(k):
    """(bytes read from cache, operations) a hit, by the sum in docs/kernels/cost.md."""
    # In units in which a photon has one unit of area: cells are 1 wide and 4 high.
    reach = math.sqrt(k / math.pi) * (1 + 0.7 / math.sqrt(k))
    candidates = (2 * reach + 1) * (2 * reach + 4)
    passes = 1  # after the first, which is part of the pass over the distances
    return (30 + (12 + 4 * passes + 16) * candidates,
            60 + (8 + 7 * (1 + passes) + 6) * candidates)


# Least bytes that a kernel of the build moves, per photon, reference, cell and map
# (docs/kernels/data.md), for the records of a diffuse scene with one light. A shape serves two maps.
BUILD_BYTES = {
    "find_insertions": (24, 0, 0, 0),   # position, triangle, list; bits
    "count_photons": (12, 4, 0, 0),  # triangle, list, bits
    "size_grids": (0, 0, 0, 130),    # half a shape, count, density_ratio; grid, cells
    "lay_out_grids": (0, 0, 0, 8),
    "count_cells": (24, 8, 0, 0),
    "sum_blocks": (0, 0, 4, 0),
    "scan_blocks": (0, 0, 8, 0),
    "scatter": (24, 12, 0, 0),
    "sort_cells": (0, 8, 4, 0),
    "copy_records": (0, 52, 0, 0),  # reference, position and flux; position and flux
    "gather_normals": (0, 20, 0, 0),  # reference, triangle; normal
}
# What maps of patches add: a flag per map.
PATCH_BYTES = {"count_photons": (0, 0, 0, 4), "size_grids": (0, 0, 0, 4)}


def build_bytes(row):
    """What the row's kernel must move, or None where that is not known."""
    counts = [row[of] for of in ("photons", "references", "cells", "maps")]
    if row["kernel"] not in BUILD_BYTES:
        return None
    moved = [BUILD_BYTES[row["kernel"]]]
    if row["patches"]:
        moved.append(PATCH_BYTES.get(row["kernel"], (0, 0, 0, 0)))
    return sum(count * size for sizes in moved for count, size in zip(counts, sizes))


def roofline(result):
    limits = result["settings"]["limits"]
    copy, cache = limits["copied bytes per second"], limits["cached bytes per second"]
    operations = limits["operations per second"]
    lines = []
    for row in rows_of(result, "kernel"):
        if row["kernel"] != ESTIMATE:
            continue
        cost_bytes, cost_operations = estimate_cost(row["k"])
        floor = max(cost_bytes / cache, cost_operations / operations)
        taken = row["seconds"]["median"] / row["hits"]
        lines.append([f"{row['workload']}, k = {row['k']}", f"{cost_bytes:,.0f}",
                      f"{cost_operations:,.0f}", f"{1e9 * cost_bytes / cache:.0f}",
                      f"{1e9 * cost_operations / operations:.0f}",
                      times(row["seconds"], 1e9 / row["hits"]), f"{100 * floor / taken:.0f}%"])
    text = (f"Limits of the device, measured in the same run: {copy / 1e9:.1f} GB/s copied in memory, "
            f"{cache / 1e9:.0f} GB/s read from the first-level cache, {operations / 1e9:.0f} billion "
            "unfused additions and multiplications a second. Bytes and operations of a hit are summed "
            "over the steps of the kernel for evenly spread photons; the uneven photons of the living room need more. "
            "Times in nanoseconds.")
    header = ["estimate", "bytes a hit", "operations", "for the bytes", "for the operations", "taken",
              "floor / taken"]
    return text + "\n\n" + table(header, lines)


def build_kernels(result):
    copy = result["settings"]["limits"]["copied bytes per second"]
    k = result["settings"]["k"]
    rows = [row for row in rows_of(result, "kernel") if row["k"] == k and row["kernel"] != ESTIMATE]
    workloads = list(dict.fromkeys(row["workload"] for row in rows))
    lines = []
    for kernel in dict.fromkeys(row["kernel"] for row in rows):
        cells = [f"`{kernel}`"]
        for workload in workloads:
            row = next((r for r in rows if (r["kernel"], r["workload"]) == (kernel, workload)), None)
            if row is None:
                cells += ["", "", ""]
                continue
            cells.append(times(row["seconds"]))
            moved = build_bytes(row)
            if moved is None:
                cells += ["", ""]
                continue
            rate = moved / row["seconds"]["median"]
            cells += [f"{rate / 1e9:.2g}", f"{100 * rate / copy:.0f}%"]
        lines.append(cells)
    references = ", ".join(
        f"{workload} {next(r for r in rows if r['workload'] == workload)['references']:,}"
        for workload in workloads)
    text = (f"The kernels of the build, k = {k}: milliseconds, the bytes that each has to move over that time, and this rate "
            f"over that of copying. References: {references}. Maps are those of `--set maps=auto`, the default.")
    header = ["kernel"]
    for workload in workloads:
        header += [f"{workload}: ms", "GB/s", "of copy"]
    return text + "\n\n" + table(header, lines)


def startup(result):
    rows = result["results"]
    columns = [(row, f"{row['variant']}: {row['cache']} cache") for row in rows]
    lines = [["shared libraries, before `main`"] + [times(row["load"]) for row, _ in columns],
             ["opening the device"] + [times(row["open"]) for row, _ in columns],
             ["all kernels"] + [times(row["prepare"]) for row, _ in columns]]
    for kind, title in (("programs", "program `{}`"), ("kernels", "`{}`")):
        for name in dict.fromkeys(name for row in rows for name in row[kind]):
            lines.append([title.format(name)] + [times(row[kind][name]) if name in row[kind] else ""
                                                 for row, _ in columns])
    text = ("Milliseconds until the kernels can run in a new process: compiled with an empty cache, loaded with a full one. PoCL "
            "compiles a kernel at its first launch, which the row of the kernel includes. With a full cache most of the "
            "time is the preprocessor of Clang, which PoCL runs over each program to find it in its cache. Shared "
            "libraries are those of the whole program.")
    return text + "\n\n" + table([""] + [name for _, name in columns], lines)


def profile(result):
    if not result["results"]:
        return f"No profile: {result.get('missing', 'none was made')}."
    stages = {}
    for row in result["results"]:
        for stage, share in row["shares"].items():
            stages[stage] = stages.get(stage, 0) + share
    order = sorted(stages, key=stages.get, reverse=True)
    lines = [[stage] + [f"{100 * row['shares'].get(stage, 0):.0f}%" for row in result["results"]]
             for stage in order]
    text = ("Samples of all threads while `Estimator::estimate` runs repeatedly (`bench/kernels/profile.py`, by perf with "
            "cpu-clock).")
    return text + "\n\n" + table(["stage"] + [row["case"] for row in result["results"]], lines)
