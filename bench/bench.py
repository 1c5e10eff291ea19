#!/usr/bin/python3
"""The benches as one tool: what there is, one of them run, two runs compared.

    bench/bench.py list
    bench/bench.py run NAME [-o FILE.json] [--csv FILE.csv] [OPTION OF THE BENCH]...
    bench/bench.py pairs NAME [--before FOLDER] [--turns N] [-o FOLDER] [OPTION OF BOTH]... [-- OPTION OF THE SECOND]...
    bench/bench.py compare BEFORE.json AFTER.json

`run` builds the bench first and writes build/bench-results/NAME.json unless told where. An option that the
bench does not know, such as --repeats where nothing is repeated, is an error; where a row is a failure, as of
a kernel that does not compile, all are written and the exit code is 1. `run NAME --help` lists its
options. `pairs` runs a bench twice in turns, so that both see the same load, with the programs of FOLDER first (those of
another commit) or with the options after -- the second time, writes NAME-before.json and NAME-after.json, which `compare`
reads, into build/bench-results or the folder of -o, and compares them.
docs/kernels/points.md says what the files hold, docs/kernels/bench.md what to do with them.
"""

import argparse
import csv
import json
import pathlib
import re
import statistics
import subprocess
import sys

from tools import compare

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / "build/release"
RESULTS = ROOT / "build/bench-results"
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


def program_of(name, folder):
    """The program of a bench, built where it is this tree's."""
    known = benches()
    if name not in known:
        fail(f"there is no bench '{name}'; there are {', '.join(known)}")
    target = f"photile_bench_{name}"
    program = folder / target
    if folder == BUILD / "bench":
        print(f"building {target}", file=sys.stderr)
        built = subprocess.run(["cmake", "--build", BUILD, "--target", target],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if built.returncode != 0:
            fail(f"{target} does not build:\n{built.stdout[-2000:]}", 1)
    if not program.exists():
        fail(f"{program}: is not there; build it, or name another folder")
    return program


def results_of(program, options, output):
    """What the bench wrote; ends with its exit code where that is not 0."""
    output.parent.mkdir(parents=True, exist_ok=True)
    code = subprocess.run([program, "--output", output, *options]).returncode
    if code != 0:
        sys.exit(code)
    return json.loads(output.read_text())


def run(arguments):
    program = program_of(arguments.name, arguments.benches)
    if "--help" in arguments.options or "-h" in arguments.options:
        sys.exit(subprocess.run([program, "--help"]).returncode)
    output = arguments.output or RESULTS / f"{arguments.name}.json"
    results = results_of(program, arguments.options, output)
    if arguments.csv:
        write_csv(results, arguments.csv)
    print(f"wrote {output}", file=sys.stderr)
    failed = [row["failure"] for row in results["results"] if "failure" in row]
    if failed and arguments.name != GROWS_UNTIL_IT_FAILS:
        fail(f"{len(failed)} of {len(results['results'])} rows are failures, the first: {failed[0]}", 1)


def joined(turns):
    """The results of the last turn; times have a sample a turn, its median."""
    results = turns[-1]
    for i, row in enumerate(results["results"]):
        for name, value in row.items():
            if not compare.is_time(value):
                continue
            of_turns = [turn["results"][i] for turn in turns]
            # A case may have answered more queries in one turn than in another.
            samples = [other[name]["median"] * row.get("queries", 1) / other.get("queries", 1) for other in of_turns]
            value.update(median=statistics.median(samples), min=min(samples), max=max(samples), samples=samples)
    return results


def pairs(arguments):
    own = arguments.benches
    first, second = (program_of(arguments.name, folder) for folder in (arguments.before or own, own))
    turns = ([], [])
    for turn in range(arguments.turns):
        runs = [(0, first, arguments.options), (1, second, arguments.options + arguments.of_second)]
        for which, program, given in runs if turn % 2 == 0 else runs[::-1]:
            turns[which].append(results_of(program, given, RESULTS / "turn.json"))
    arguments.output.mkdir(parents=True, exist_ok=True)
    files = [arguments.output / f"{arguments.name}-{which}.json" for which in ("before", "after")]
    for file, results in zip(files, turns):
        file.write_text(json.dumps(joined(results), indent=1) + "\n")
    compare.compare_files(*files, tells_all=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="names and what each measures")
    one = commands.add_parser("run", help="run one", add_help=False, allow_abbrev=False)
    one.add_argument("name")
    one.add_argument("-o", "--output", type=pathlib.Path)
    one.add_argument("--csv", type=pathlib.Path, help="the rows as a table")
    two = commands.add_parser("compare", help="what changed from one run to another")
    two.add_argument("before", type=pathlib.Path)
    two.add_argument("after", type=pathlib.Path)
    side_by_side = commands.add_parser("pairs", help="run one twice, in turns, and compare", allow_abbrev=False)
    side_by_side.add_argument("name")
    side_by_side.add_argument("--before", type=pathlib.Path,
                              help="programs of the first: build/release/bench of another tree")
    side_by_side.add_argument("-o", "--output", type=pathlib.Path, default=RESULTS, metavar="FOLDER",
                              help="for the results of both; default: build/bench-results")
    for command in (one, side_by_side):
        command.add_argument("--benches", type=pathlib.Path, default=BUILD / "bench",
                             help="where the programs are; they are not built then")
    side_by_side.add_argument("--turns", type=int, default=compare.LEAST_PAIRS, help="of both; default: %(default)s")
    given, of_second = sys.argv[1:], []
    if "--" in given:
        given, of_second = given[:given.index("--")], given[given.index("--") + 1:]
    arguments, options = parser.parse_known_args(given)
    if arguments.command == "run":
        arguments.options = options + of_second
        run(arguments)
        return
    if arguments.command == "pairs":
        if arguments.before is None and not of_second:
            fail("both of a pair are the same: give --before FOLDER, or options of the second after --")
        arguments.options, arguments.of_second = options, of_second
        pairs(arguments)
        return
    options += of_second
    if options:
        fail(f"unknown arguments: {' '.join(options)}; see bench/bench.py --help")
    if arguments.command == "list":
        for name, text in benches().items():
            print(f"{name:12} {text}")
    else:
        compare.compare_files(arguments.before, arguments.after)


if __name__ == "__main__":
    main()
