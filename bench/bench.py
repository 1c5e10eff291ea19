#!/usr/bin/python3
"""The benches as one tool: what there is, one of them run, two runs compared.

    bench/bench.py list
    bench/bench.py run NAME [-o FILE.json] [--csv FILE.csv] [OPTION OF THE BENCH]...
    bench/bench.py compare BEFORE.json AFTER.json

`run` builds the bench first and writes build/bench-results/NAME.json unless told where. An option that the
bench does not know, such as --repeats where nothing is repeated, is an error; where a row is a failure, as of
a kernel that does not compile, all are written and the exit code is 1. `run NAME --help` lists its
options. docs/bench-points.md says what the files hold, docs/experiments.md what to do with them.
"""

import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys

from tools import compare

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / "build/release"
GROWS_UNTIL_IT_FAILS = "scale"  # its last rows say where memory or time ended


def fail(message, code=2):
    print(f"bench.py: error: {message}", file=sys.stderr)
    sys.exit(code)


def benches():
    """Names, and the first sentence of what each says of itself."""
    found = {}
    sources = [file for folder in ("kernels", "pictures") for file in (ROOT / "bench" / folder).glob("*_bench.cpp")]
    for source in sorted(sources, key=lambda file: file.name):
        comment = re.match(r"((?://.*\n)+)", source.read_text())
        words = " ".join(line[2:].strip() for line in comment[1].splitlines()) if comment else ""
        found[source.name.removesuffix("_bench.cpp")] = re.split(r"(?<=[.])\s+(?=[A-Z])|: ", words)[0]
    del found["groups"]  # it has the options and the files of Google Benchmark
    return found


def columns_of(rows):
    """Plain values in the order in which they appear, times as their median, least and largest."""
    table = []
    for row in rows:
        flat = {}
        for name, value in row.items():
            if compare.is_time(value):
                flat.update({f"{name} {part}": value[part] for part in ("median", "min", "max")})
            elif not isinstance(value, (dict, list)):
                flat[name] = value
        table.append(flat)
    return list(dict.fromkeys(name for row in table for name in row)), table


def write_csv(results, file):
    names, table = columns_of(results["results"])
    with open(file, "w", newline="", encoding="utf-8") as out:
        writer = csv.DictWriter(out, ["schema version", "commit", *names])
        writer.writeheader()
        about = {"schema version": results["schema version"], "commit": results["commit"]}
        writer.writerows({**about, **row} for row in table)


def run(arguments):
    known = benches()
    if arguments.name not in known:
        fail(f"there is no bench '{arguments.name}'; there are {', '.join(known)}")
    target = f"photile_bench_{arguments.name}"
    program = arguments.benches / target
    if arguments.benches == BUILD / "bench":
        built = subprocess.run(["cmake", "--build", BUILD, "--target", target],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if built.returncode != 0:
            fail(f"{target} does not build:\n{built.stdout[-2000:]}", 1)
    if not program.exists():
        fail(f"{program}: is not there; build it, or leave out --benches")
    if "--help" in arguments.options or "-h" in arguments.options:
        sys.exit(subprocess.run([program, "--help"]).returncode)
    output = arguments.output or ROOT / "build/bench-results" / f"{arguments.name}.json"
    output.parent.mkdir(parents=True, exist_ok=True)
    code = subprocess.run([program, "--output", output, *arguments.options]).returncode
    if code != 0:
        sys.exit(code)
    results = json.loads(output.read_text())
    if arguments.csv:
        write_csv(results, arguments.csv)
    print(f"wrote {output}", file=sys.stderr)
    failed = [row["failure"] for row in results["results"] if "failure" in row]
    if failed and arguments.name != GROWS_UNTIL_IT_FAILS:
        fail(f"{len(failed)} of {len(results['results'])} rows are failures, the first: {failed[0]}", 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="names and what each measures")
    one = commands.add_parser("run", help="run one", add_help=False, allow_abbrev=False)
    one.add_argument("name")
    one.add_argument("-o", "--output", type=pathlib.Path)
    one.add_argument("--csv", type=pathlib.Path, help="the rows as a table")
    one.add_argument("--benches", type=pathlib.Path, default=BUILD / "bench",
                     help="where the programs are; they are not built then")
    two = commands.add_parser("compare", help="what changed from one run to another")
    two.add_argument("before", type=pathlib.Path)
    two.add_argument("after", type=pathlib.Path)
    arguments, options = parser.parse_known_args()
    if arguments.command == "run":
        arguments.options = options
        run(arguments)
        return
    if options:
        fail(f"unknown arguments: {' '.join(options)}; see bench/bench.py --help")
    if arguments.command == "list":
        for name, text in benches().items():
            print(f"{name:12} {text}")
    else:
        compare.compare_files(arguments.before, arguments.after)


if __name__ == "__main__":
    main()
