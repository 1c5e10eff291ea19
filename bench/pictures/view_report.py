#!/usr/bin/python3
"""Measures frames of the window while the viewer moves and writes the table of docs/walkthrough.md.

    bench/pictures/view_report.py [--bench FILE] [--redraw] [--quick]

Needs the built bench (target photile_bench_view); the machine should do nothing else.
"""

import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

PAGE = ROOT / "docs/walkthrough.md"
RESULTS = ROOT / "docs/benchmarks/view.json"
BENCH = ROOT / "build/release/bench/photile_bench_view"
FRAMES_A_SECOND = 30
MOST_OVERHEAD = 0.20
STAGES = (("primary hits", "rays from the eye, sorted by map"),
          ("radiance estimate", "kNN and density, per light"),
          ("film", "sums per pixel and light"),
          ("other", "buffers, threads"),
          ("display", "lights mixed, tone mapped"))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bench", default=BENCH, type=pathlib.Path)
    parser.add_argument("--redraw", action="store_true", help=f"use the results in {RESULTS.name}")
    parser.add_argument("--quick", action="store_true", help="run alone: nothing is written")
    return parser.parse_args()


def median(row, part):
    return row[part]["median"]


def section(result):
    """The table, and what it says of the aims."""
    row, settings = result["results"][0], result["settings"]
    total = median(row, "total")
    bare = median(row, "bare rays") + median(row, "bare kernels")
    overhead = (total - bare) / total
    lines = [f"{settings['side']} x {settings['side']} pixels of the living room, diffuse, "
             f"{settings['lights']} lights, {settings['photons']:,} paths, k = {settings['k']}, "
             f"one sample a pixel;\nmedians of {settings['frames']} frames of a walk. "
             f"{result['machine']['processor']}, {result['machine']['hardware threads']} hardware "
             f"threads, {result['date']}.",
             "", "| stage | | ms | share |", "|---|---|---|---|"]
    for stage, meaning in STAGES:
        seconds = median(row, stage)
        lines.append(f"| {stage} | {meaning} | {1e3 * seconds:.1f} | {seconds / total:.0%} |")
    lines.append(f"| **frame** | {1 / total:.1f} a second | **{1e3 * total:.1f}** | |")
    for part, meaning in (("bare kernels", "by OpenCL's events"),
                          ("bare rays", "first hits alone")):
        lines.append(f"| {part} | {meaning} | {1e3 * median(row, part):.1f} | "
                     f"{median(row, part) / total:.0%} |")
    lines.append(f"| overhead | frame - kernels - rays | {1e3 * (total - bare):.1f} | "
                 f"{overhead:.0%} |")

    def aim(text, reached):
        return f"{text}: {'reached' if reached else 'missed'}"
    lines += ["", aim(f"Aim of {FRAMES_A_SECOND} whole frames a second",
                      1 / total >= FRAMES_A_SECOND) + f" ({1 / total:.1f}). "
              + aim(f"Aim of less than {MOST_OVERHEAD:.0%} overhead", overhead < MOST_OVERHEAD)
              + f" ({overhead:.0%})."]
    if 1 / total < FRAMES_A_SECOND:
        scale = (1 / FRAMES_A_SECOND / total) ** 0.5
        lines[-1] += (f" While moving, frames of {scale * settings['side']:.0f} x "
                      f"{scale * settings['side']:.0f} keep the rate.")
    return "\n".join(lines)


def main():
    options = arguments()
    if not options.redraw:
        command = [options.bench, "--output", RESULTS] if not options.quick else [options.bench,
                                                                                 "--quick"]
        if subprocess.run(command, check=False).returncode != 0:
            sys.exit("view_report.py: error: the bench failed")
    if not options.quick:
        replace_section(PAGE, "pictures/view_report.py", section(json.loads(RESULTS.read_text())))


if __name__ == "__main__":
    main()
