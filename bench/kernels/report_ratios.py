#!/usr/bin/python3
"""Prints how many times as long each structure takes as the uniform grid: figure 6 of Graglia et al. 2012
as ratios, over photons and k, from what photile_bench_knn wrote.

    bench/kernels/report_ratios.py docs/benchmarks/knn.json
"""

import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from kernels.report_tables import figure, table

BASE = "uniform-grid"


def seconds_per_query(row):
    return row["seconds"]["median"] / row["queries"]


def ratios(rows):
    """{(workload, k): {structure: {photons: ratio}}}; cases without a uniform grid are left out."""
    timed = [row for row in rows if "seconds" in row]
    base = {(row["workload"], row["k"], row["photons"]): seconds_per_query(row)
            for row in timed if row["structure"] == BASE}
    found = {}
    for row in timed:
        case = (row["workload"], row["k"], row["photons"])
        if row["structure"] == BASE or case not in base:
            continue
        structures = found.setdefault((row["workload"], row["k"]), {})
        structures.setdefault(row["structure"], {})[row["photons"]] = (
            seconds_per_query(row) / base[case])
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


def text(rows):
    parts = []
    for (workload, k), structures in ratios(rows).items():
        counts = sorted({count for ratio in structures.values() for count in ratio})
        parts.append(f"**{workload}, k = {k}**, times as long as {BASE}\n\n" + table(
            ["structure", *(f"{count:,} photons" for count in counts)],
            [[name, *(figure(ratio[count]) if count in ratio else "" for count in counts)]
             for name, ratio in structures.items()]))
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
        rows = json.loads(given.record.read_text())["results"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        sys.exit(f"report_ratios.py: error: {given.record}: {error}; give a file that "
                 "photile_bench_knn wrote with -o")
    print(text(rows))


if __name__ == "__main__":
    main()
