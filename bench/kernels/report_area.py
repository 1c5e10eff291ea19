#!/usr/bin/python3
"""Writes the table of what areas and kernels cost in docs/measured/density.md from docs/measured/benchmarks/area.json,
which `photile_bench_area --output docs/measured/benchmarks/area.json` makes."""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

RESULTS = ROOT / "docs/measured/benchmarks/area.json"
CASES = (("disc", "constant"), ("clipped", "constant"), ("clipped", "cone"))


def row(place, results):
    """Nanoseconds a hit by whole discs, and what clipping and the cone take over that."""
    taken = {(result["area"], result["kernel"]): result["nanoseconds per hit"]
             for result in results if result["place"] == place}
    disc, *others = (taken[case] for case in CASES)
    return f"| {place} | {disc:.0f} | " + " | ".join(f"{other / disc:.2f}" for other in others) + " |"


def main():
    record = json.loads(RESULTS.read_text())
    results = record["results"]
    places = list(dict.fromkeys(result["place"] for result in results))
    rows = "\n".join(row(place, results) for place in places)
    machine = record["machine"]
    replace_section(ROOT / "docs/measured/density.md", "kernels/report_area.py",
                    "| | whole disc, ns a hit | clipped over whole | clipped, cone, over whole |\n"
                    f"|---|--:|--:|--:|\n{rows}\n\n"
                    f"{machine['processor']}, {machine['hardware threads']} hardware threads; load "
                    f"average at the start {machine['load average at start']:.0f}.\n", RESULTS)


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"report_area.py: error: {error}")
