#!/usr/bin/python3
"""Writes the table of what areas and kernels cost in docs/density.md from docs/benchmarks/area.json,
which `photile_bench_area --output docs/benchmarks/area.json` makes."""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

CASES = (("disc", "constant"), ("clipped", "constant"), ("clipped", "cone"),
         ("clipped", "epanechnikov"))


def row(place, results):
    """Nanoseconds a hit of one place, and what clipping costs over the whole disc."""
    taken = {(result["area"], result["kernel"]): result["nanoseconds per hit"]
             for result in results if result["place"] == place}
    ratio = taken["clipped", "constant"] / taken["disc", "constant"]
    return f"| {place} | " + " | ".join(f"{taken[case]:.0f}" for case in CASES) + f" | {ratio:.2f} |"


def main():
    record = json.loads((ROOT / "docs/benchmarks/area.json").read_text())
    results = record["results"]
    places = list(dict.fromkeys(result["place"] for result in results))
    rows = "\n".join(row(place, results) for place in places)
    machine = record["machine"]
    replace_section(ROOT / "docs/density.md", "kernels/report_area.py",
                    "| ns a hit | whole disc | clipped | clipped, cone | clipped, Epanechnikov "
                    "| clipped over whole |\n"
                    f"|---|--:|--:|--:|--:|--:|\n{rows}\n\n"
                    f"{machine['processor']}, {machine['hardware threads']} hardware threads; load "
                    f"average at the start {machine['load average at start']:.0f}.\n")


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"report_area.py: error: {error}")
