#!/usr/bin/python3
"""Runs `photile validate` and writes its readings into docs/measured/accuracy.md.

    bench/pictures/accuracy.py [--photile COMMAND] [--redraw]

Takes minutes. Needs the built command.
"""

import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

READINGS = ROOT / "docs/measured/accuracy/validation.json"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--photile", type=pathlib.Path, default=ROOT / "build/release/photile")
    parser.add_argument("--redraw", action="store_true", help="use the results in docs/measured/accuracy instead of measuring")
    return parser.parse_args()


def validation(photile, file):
    """Runs photile validate; a reading that is not within 1% is a result, not an error."""
    done = subprocess.run([photile, "validate", "--json", file], check=False)
    if done.returncode not in (0, 1) or not file.is_file():
        sys.exit(f"accuracy.py: error: photile validate ended with {done.returncode}")


def percent(measured):
    if measured is None:
        return "- | -"
    error, noise = 100 * measured["error"], 100 * measured["noise"]
    text = f"{error:+.2f} ± {noise:.2f}%"
    if measured["verdict"] == "MISSES":
        text = f"**{text}**"
    elif measured["verdict"] != "ok":
        text += " (too noisy)"
    return f"{measured['value']:.4g} | {text}"


def validation_table(record):
    rows = ["| case | reading | expected | photon maps | error | paths | error |",
            "|---|---|--:|--:|--:|--:|--:|"]
    last = None
    for row in record["readings"]:
        name = "" if row["case"] == last else row["case"]
        last = row["case"]
        rows.append(f"| {name} | {row['place']} | {row['expected']:.4g} {row['unit']} "
                    f"| {percent(row.get('photon_map'))} | {percent(row.get('path'))} |")
    return "\n".join(rows)


def sources(record):
    cases = {row["case"]: row["source"] for row in record["readings"]}
    return "\n".join(f"- {case}: {source}." for case, source in cases.items())


def counts(record, method):
    verdicts = [row[method]["verdict"] for row in record["readings"] if method in row]
    return (f"{verdicts.count('ok')} of {len(verdicts)} within 1%, {verdicts.count('MISSES')} beyond, "
            f"{verdicts.count('too noisy')} too noisy to tell")


def seeds(record):
    """"16 to 58"."""
    counts_of_seeds = [row[method]["seeds"] for row in record["readings"] for method in ("photon_map", "path")]
    return f"{min(counts_of_seeds)} to {max(counts_of_seeds)}"


def section(record):
    return f"""Each reading is the mean over {seeds(record)} seeds, more where it is noisy: of {record['photons'] / 1e6:.3g}M photon paths with
k = {record['neighbours']} by photon maps, of {record['paths'] / 1e3:.0f}k paths from the points by paths.

Photon maps: {counts(record, 'photon_map')}.
Paths: {counts(record, 'path')}.

{validation_table(record)}

Where the values come from:

{sources(record)}"""


def main():
    options = arguments()
    if not options.redraw:
        validation(options.photile, READINGS)
    replace_section(ROOT / "docs/measured/accuracy.md", "pictures/accuracy.py", section(json.loads(READINGS.read_text())), READINGS)


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"accuracy.py: error: {error}")
