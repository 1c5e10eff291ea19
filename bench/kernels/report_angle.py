#!/usr/bin/python3
"""Writes the table of darkening and bleeding in docs/measured/groups.md from
docs/measured/benchmarks/angle.json, which `photile_bench_angle --output docs/measured/benchmarks/angle.json` makes."""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

RESULTS = ROOT / "docs/measured/benchmarks/angle.json"

ANGLES = range(0, 91, 15)


def row(shape, results):
    """Percent too little light on lit surfaces, or percent of the light that bled on unlit ones: by
    whole discs and by clipped ones."""
    cells = []
    for angle in ANGLES:
        result = next(r for r in results if r["shape"] == shape and r["angle"] == angle)
        wrong = [100 * (result[area] - result["expected"]) for area in ("disc", "clipped")]
        cells.append(" / ".join(f"{value:+.1f}" if abs(value) >= 0.05 else "0" for value in wrong))
    return f"| {shape} | " + " | ".join(cells) + " |"


def main():
    record = json.loads(RESULTS.read_text())
    results = record["results"]
    shapes = list(dict.fromkeys(result["shape"] for result in results))
    replace_section(ROOT / "docs/measured/groups.md", "kernels/report_angle.py",
                    "| | " + " | ".join(f"{angle} degrees" for angle in ANGLES) + " |\n|---|"
                    + "--:|" * len(ANGLES) + "\n"
                    + "\n".join(row(shape, results) for shape in shapes) + "\n", RESULTS)


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError, StopIteration) as error:
        sys.exit(f"report_angle.py: error: {error}")
