#!/usr/bin/python3
"""Faults drawn at random from the code, rather than chosen: which share of them the tests notice.

    bench/drawn_mutants.py [--count N] [--seed N] [--host] [--build FOLDER] [--tree FOLDER]

Each changes one operator, bound or number of a line: < for <=, + for -, min for max, a whole number by
one, another by a tenth. Those of kernels/ are run by the tests of the build at hand, as mutants.py does
it; with --host also those of the folders groups, surface and trace, which are built in a worktree. A
mutant that does not compile does not count. Survivors are printed with their line: some change nothing
(a number of photons a block, the order of a sum), and a person has to look which. Results are added to
docs/testing/drawn_mutants.json; the same seed draws the same mutants of the same code.
"""

import argparse
import dataclasses
import json
import math
import pathlib
import random
import re
import subprocess
import sys

import mutants
from mutant_list import Mutant

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs/testing/drawn_mutants.json"
SECONDS = 1200  # of a program of tests, ten times what it takes; a mutant beyond has been noticed

# Those of the estimate that find most. What excludes comes first: behind a name it would be part of it.
ESTIMATE_TESTS = ",".join(
    f"~[slow]{name}*" for name in (
        "the exact law", "every strategy", "neighbours equal", "irradiance equals", "tiles find",
        "maps of patches", "clipped irradiance", "tiles on a floor", "thin plates", "extremes"))
# By the folder of kernels/, the likeliest to notice first: one that notices ends it.
KERNEL_TESTS = (("estimate", ESTIMATE_TESTS), ("maps", "~[slow]~[long]"))
GRID_TESTS = tuple(reversed(KERNEL_TESTS))
HOST_FOLDERS = ("groups", "surface", "trace")

OPERATORS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+",
             "*": "/", "/": "*", "&&": "||", "||": "&&", "+=": "-=", "-=": "+="}
SITES = re.compile(
    r"(?<=\s)(?:<=|>=|==|!=|&&|\|\||\+=|-=|[<>+\-*/])(?=\s)"  # between blanks: no template, no pointer
    r"|\b(?:min|max)(?=\()"
    r"|(?<![\w.])\d+\.\d+(?:e[+-]?\d+)?f?\b|(?<![\w.])\d+(?![\w.])")


def changed(token):
    if token in OPERATORS:
        return OPERATORS[token]
    if token in ("min", "max"):
        return "max" if token == "min" else "min"
    if token.isdigit():
        return str(int(token) + 1)
    number = float(token.rstrip("f"))
    return f"{1.1 * number or 0.1:.9g}" + ("f" if token.endswith("f") else "")


def code_lines(text):
    """(number, line) of those that hold code: no comments, directives or strings."""
    in_comment = False
    for number, line in enumerate(text.splitlines()):
        bare = line.strip()
        if in_comment or bare.startswith(("//", "#", "/*")) or '"' in line or "static_assert" in line:
            in_comment = (in_comment or bare.startswith("/*")) and "*/" not in bare
            continue
        yield number, line.split("//")[0]


def unique_text(lines, number):
    """How many lines before it make a line unique in its file."""
    text = "\n".join(lines)
    for first in range(number, -1, -1):
        if text.count("\n".join(lines[first:number + 1])) == 1:
            return first
    return None


def sites(files):
    """Every mutant that there is."""
    for file in files:
        text = file.read_text(encoding="utf-8")
        lines = text.splitlines()
        name = str(file.relative_to(ROOT))
        folder = file.relative_to(ROOT).parts[1]
        tests = ((folder, "~[slow]"),)
        if name.startswith("kernels/"):
            tests = GRID_TESTS if folder == "grid" else KERNEL_TESTS
        for number, code in code_lines(text):
            for site in SITES.finditer(code):
                first = unique_text(lines, number)
                if first is None:
                    continue
                line = lines[number]
                new = line[:site.start()] + changed(site.group()) + line[site.end():]
                before = lines[first:number]
                yield Mutant(f"{name}:{number + 1}:{site.start() + 1} {site.group()} -> "
                             f"{changed(site.group())}", name, "\n".join([*before, line]),
                             "\n".join([*before, new]), tests)


def wilson(killed, count):
    """The interval that holds the share with 95%."""
    if count == 0:
        return 0.0, 1.0
    z, share = 1.96, killed / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count**2)) / (1 + z * z / count)
    return middle - half, middle + half


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--host", action="store_true")
    parser.add_argument("--list", action="store_true", help="print those drawn, run none")
    parser.add_argument("--tree", type=pathlib.Path, default=ROOT / "out/mutants/tree")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    return parser.parse_args()


def main():
    options = arguments()
    files = sorted(ROOT.glob("kernels/**/*.cl*"))
    if options.host:
        for folder in HOST_FOLDERS:
            files += sorted((ROOT / "host" / folder).glob("**/*.cpp"))
    everything = list(sites(files))
    drawn = random.Random(options.seed).sample(everything, min(options.count, len(everything)))
    if options.list:
        print("\n".join(mutant.name for mutant in drawn))
        return
    runner = mutants.Runner(options)
    mutants.SECONDS = SECONDS
    mutants.CATCH_OPTIONS = ("--abort",)  # one that notices is enough
    results = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.is_file() else {}
    killed = survived = 0
    for mutant in drawn:
        # One that notices is enough.
        noticed = []
        try:
            for tests in mutant.tests:
                one = dataclasses.replace(mutant, tests=(tests,))
                noticed = runner.in_kernels(one) if mutant.in_kernels else runner.in_host(one)
                if noticed:
                    break
        except mutants.CannotRun as reason:
            print(f"{mutant.name}: not counted: {str(reason).splitlines()[0]}", flush=True)
            continue
        killed += bool(noticed)
        survived += not noticed
        results[mutant.name] = noticed[:2]
        print(f"{mutant.name}: {'; '.join(noticed[:2]) or 'SURVIVES: ' + mutant.replace.strip()}",
              flush=True)
        RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    low, high = wilson(killed, killed + survived)
    print(f"{killed} of {killed + survived} noticed, of {len(everything)} that there are: "
          f"between {100 * low:.0f}% and {100 * high:.0f}% with a confidence of 95%")


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"drawn_mutants.py: error: {error}")
