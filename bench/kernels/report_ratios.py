#!/usr/bin/python3
"""Prints how many times as long each structure takes as the uniform grid: figure 6 of Graglia et al. 2012
as ratios, over photons and k, from what photile_bench_knn wrote.

    bench/kernels/report_ratios.py docs/measured/benchmarks/knn.json
"""

import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from kernels.report_tables import LISTS, figure, ratio, table, timed

BASE = "uniform-grid"


def ratios(rows):
    """{(workload, k): {structure: {photons: ratio}}}; cases without a uniform grid are left out.
    `rows`: those of report_tables.timed."""
    base = {(row["workload"], row["k"], row["photons"]): row for row in rows if row["structure"] == BASE}
    found = {}
    for row in rows:
        case = (row["workload"], row["k"], row["photons"])
        if row["structure"] == BASE or LISTS in row["structure"] or case not in base:
            continue
        structures = found.setdefault((row["workload"], row["k"]), {})
        structures.setdefault(row["structure"], {})[row["photons"]] = ratio(row, base[case])
    return found


def visits(rows):
    """{(workload, photons, k): {structure: (nodes, photons)}} of the searches that are counted."""
    found = {}
    for row in rows:
        if "nodes visited" in row:
            case = (row["workload"], row["photons"], row["k"])
            found.setdefault(case, {})[row["structure"]] = (row["nodes visited"],
                                                            row["photons visited"])
    return found


TREES = ("kdtree-2d-radix-32", "kdtree-2d-radix-64", "kdtree-2d-radix-128")


def structure_and_selection(rows):
    """What of the grid's advantage is due to its cells, and what to its selection; None where a run left out
    what that takes."""
    lines, cells, trees, selection = [], [], [], []
    for (workload, k), structures in ratios(rows).items():
        at = {name: of_photons[max(of_photons)] for name, of_photons in structures.items()}
        if not {*TREES, "uniform-grid-heap", "kdtree-2d", "kdtree-3d"} <= at.keys():
            continue
        tree = min(TREES, key=at.get)
        lines.append([f"{workload}, k = {k}", f"{figure(at[tree])} (leaves of {tree.rsplit('-', 1)[1]})",
                      *(figure(at[name]) for name in ("uniform-grid-heap", "kdtree-2d", "kdtree-3d"))])
        cells.append(at[tree])
        trees.append(at["kdtree-2d"] / at["uniform-grid-heap"])
        selection.append(at["uniform-grid-heap"])
    if not lines:
        return None

    def span(values):
        return f"{figure(min(values))} to {figure(max(values))}"

    return ("Time over that of the grid with its own selection, by radix:\n\n"
            + table(["a million photons", "kd-tree in the plane, radix", "grid, heap", "kd-tree in the plane, heap",
                     "kd-tree in space, heap"], lines)
            + f"""

Figure 6 of the paper has the grid 2 times as fast as a kd-tree in the plane, and 3 to 5 times as fast as one in space.

- **Structure**: with the selection by radix for both, the grid is {span(cells)} times as fast as the kd-tree in the plane;
  with a heap for both, {span(trees)} times. Rows of cells are found by arithmetic and nodes by walking the tree, which
  matters less with more neighbours. In interiors a map holds several surfaces, whose cells are searched together.
- **Selection**: in the same cells the heap takes {span(selection)} times as long as the radix, which computes with whole
  vectors and without branches. Most of the ratios to other libraries on this page are due to it. The paper does not
  have it.
- **A tree in space**: both trees split the longest side of the box of the photons here, so that they are the same tree on
  a surface. The factor of 3 to 5 of the paper is not reproduced.""")


def text(rows):
    parts = []
    for (workload, k), structures in ratios(rows).items():
        counts = sorted({count for of_photons in structures.values() for count in of_photons})
        parts.append(f"**{workload}, k = {k}**, times as long as {BASE}\n\n" + table(
            ["structure", *(f"{count:,} photons" for count in counts)],
            [[name, *(figure(of_photons[count]) if count in of_photons else "" for count in counts)]
             for name, of_photons in structures.items()]))
    for (workload, photons, k), structures in visits(rows).items():
        parts.append(f"**{workload}, {photons:,} photons, k = {k}**, looked at for each query\n\n" + table(
            ["structure", "nodes or cells", "photons"],
            [[name, f"{nodes:.0f}", f"{looked:.0f}"] for name, (nodes, looked) in structures.items()]))
    return "\n\n".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record", type=pathlib.Path, help="JSON file of photile_bench_knn")
    given = parser.parse_args()
    try:
        rows = timed(json.loads(given.record.read_text()))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f"report_ratios.py: error: {given.record}: {error}; give a file that "
                 "photile_bench_knn wrote with -o")
    print(text(rows))


if __name__ == "__main__":
    main()
