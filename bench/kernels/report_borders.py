#!/usr/bin/python3
"""Writes the table of readings near borders in docs/measured/density.md from docs/measured/benchmarks/borders.json,
which `photile_bench_borders --output docs/measured/benchmarks/borders.json` makes."""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

RESULTS = ROOT / "docs/measured/benchmarks/borders.json"


def row(result):
    def lux(value):
        error = f" ({100 * (value / result['expected'] - 1):+.0f}%)" if result["expected"] else ""
        return f"{value:.0f}{error}"

    return (f"| {result['place']} | {result['millimetres']:.0f} mm | {result['expected']:.0f} "
            f"| {lux(result['disc'])} | {lux(result['clipped'])} |")


def main():
    record = json.loads(RESULTS.read_text())
    rows = "\n".join(row(result) for result in record["results"])
    replace_section(ROOT / "docs/measured/density.md", "kernels/report_borders.py",
                    "| place | distance | expected, lux | disc | clipped |\n"
                    f"|---|--:|--:|--:|--:|\n{rows}\n", RESULTS)


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"report_borders.py: error: {error}")
