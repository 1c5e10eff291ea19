#!/usr/bin/python3
"""Builds faults into photile, one at a time, and says which tests notice: docs/testing.md.

    bench/mutants.py [NAME...] [--redraw] [--tree FOLDER] [--build FOLDER]

NAME is a part of the name of those to run; default: all of bench/mutant_list.py. Kernels are changed in
a copy that PHOTILE_KERNEL_DIR names and run by the tests of the build at hand; other files in a
worktree of the last commit, which is built with its tests (minutes the first time; ccache helps).
Every test first has to pass without the mutant. Results stay in docs/testing, and those of earlier runs
are kept, so that the table can be made in parts.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

from mutant_list import MUTANTS
from report_section import replace_section

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs/testing/mutants.json"
SECONDS = None  # that a program of tests may take; one that takes longer counts as a crash
CATCH_OPTIONS = ()


class CannotRun(Exception):
    """Why nothing can be said about a mutant."""


@dataclasses.dataclass
class Outcome:
    failed: list  # names of tests
    crashed: bool


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--redraw", action="store_true", help="make the table from docs/testing alone")
    parser.add_argument("--tree", type=pathlib.Path, default=ROOT / "out/mutants/tree",
                        help="worktree for what has to be built; default: %(default)s")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release",
                        help="where the tests that mutants of kernels run are; default: %(default)s")
    return parser.parse_args()


def mutate(folder, mutant):
    """Changes the file below `folder`; returns its text before."""
    file = folder / mutant.file
    text = file.read_text(encoding="utf-8")
    if text.count(mutant.find) != 1:
        raise CannotRun(f"{mutant.file} has {mutant.find!r} {text.count(mutant.find)} times, not once")
    file.write_text(text.replace(mutant.find, mutant.replace), encoding="utf-8")
    return text


def run_tests(build, folder, specification, kernels=None):
    """Runs tests of a folder of tests/, with the kernels of another folder if one is given."""
    environment = dict(os.environ)
    environment.pop("PHOTILE_KERNEL_DIR", None)
    if kernels:
        environment["PHOTILE_KERNEL_DIR"] = str(kernels)
    program = build / "tests" / folder / f"photile_tests_{folder}"
    if not program.is_file():
        raise CannotRun(f"{program} is missing; build the target photile_tests_{folder}")
    with tempfile.NamedTemporaryFile(suffix=".xml") as report:
        try:
            done = subprocess.run([program, specification, *CATCH_OPTIONS, "--reporter", "xml",
                                   "--out", report.name],
                                  env=environment, capture_output=True, text=True, check=False,
                                  timeout=SECONDS)
        except subprocess.TimeoutExpired:
            return Outcome([], True)
        text = pathlib.Path(report.name).read_text(encoding="utf-8", errors="replace")
    if "does not compile" in text or "BUILD_PROGRAM_FAILURE" in text:
        raise CannotRun("the mutant's kernels do not compile")
    try:
        cases = list(xml.etree.ElementTree.fromstring(text).iter("TestCase"))
    except xml.etree.ElementTree.ParseError:
        return Outcome([], True)
    if not cases:
        raise CannotRun(f"no test of {folder} matches {specification!r}")
    failed = [case.get("name") for case in cases
              if case.find("OverallResult").get("success") != "true"]
    return Outcome(failed, done.returncode != 0 and not failed)


def build_tree(tree, folders):
    if not (tree / ".git").exists():
        subprocess.run(["git", "-C", ROOT, "worktree", "prune"], check=True)
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--force", "--detach", tree],
                       check=True, capture_output=True)
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    subprocess.run(["cmake", "--preset", "release", *launcher], cwd=tree, check=True,
                   capture_output=True)
    done = subprocess.run(["cmake", "--build", "--preset", "release", "--parallel",
                           str(os.cpu_count()), "--target",
                           *(f"photile_tests_{folder}" for folder in sorted(folders))], cwd=tree,
                          check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise CannotRun("it does not compile: " + "".join(done.stdout.splitlines(True)[-20:]))
    return tree / "build/release"


class Runner:
    def __init__(self, options):
        self.options = options
        self.baselines = {}  # (build, folder, specification) -> Outcome

    def _baseline(self, build, folder, specification):
        key = build, folder, specification
        if key not in self.baselines:
            self.baselines[key] = run_tests(build, folder, specification)
        outcome = self.baselines[key]
        if outcome.failed or outcome.crashed:
            raise CannotRun(f"without the mutant: {', '.join(outcome.failed) or 'crash'}")

    def _tests(self, mutant, build, kernels=None):
        noticed = []
        for folder, specification in mutant.tests:
            outcome = run_tests(build, folder, specification, kernels)
            noticed += [f"{folder}/{name}" for name in outcome.failed]
            if outcome.crashed:
                noticed.append(f"{folder}: crash")
        return noticed

    def in_kernels(self, mutant):
        for folder, specification in mutant.tests:
            self._baseline(self.options.build, folder, specification)
        with tempfile.TemporaryDirectory(prefix="photile-mutant-") as folder:
            copy = pathlib.Path(folder)
            shutil.copytree(ROOT / "kernels", copy / "kernels")
            mutate(copy, mutant)
            return self._tests(mutant, self.options.build, copy / "kernels")

    def in_host(self, mutant):
        folders = {folder for folder, _ in mutant.tests}
        build = build_tree(self.options.tree, folders)
        for folder, specification in mutant.tests:
            self._baseline(build, folder, specification)
        text = mutate(self.options.tree, mutant)
        try:
            build_tree(self.options.tree, folders)
            return self._tests(mutant, build)
        finally:
            (self.options.tree / mutant.file).write_text(text, encoding="utf-8")


def stored_results():
    """Tests that noticed, by mutant."""
    return json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.is_file() else {}


def store_result(mutant, noticed):
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    results = {**stored_results(), mutant.name: noticed}
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def run(options):
    """Whether a mutant survived or could not be run."""
    runner = Runner(options)
    wrong = False
    for mutant in MUTANTS:
        if options.names and not any(name in mutant.name for name in options.names):
            continue
        try:
            noticed = runner.in_kernels(mutant) if mutant.in_kernels else runner.in_host(mutant)
        except CannotRun as reason:
            print(f"{mutant.name}: error: {reason}", flush=True)
            wrong = True
            continue
        print(f"{mutant.name}: {'; '.join(noticed) or 'SURVIVES'}", flush=True)
        store_result(mutant, noticed)
        wrong = wrong or not noticed
    return wrong


def table(results):
    rows = ["| mutant | file | killed by |", "|---|---|---|"]
    for mutant in MUTANTS:
        if mutant.name in results:
            verdict = next(iter(results[mutant.name]), "**survives**")
            more = len(results[mutant.name]) - 1
            verdict += f"; {more} more" if more > 0 else ""
            rows.append(f"| {mutant.name} | `{mutant.file}` | {verdict} |")
    missing = [f"{mutant.name} (`{mutant.file}`)" for mutant in MUTANTS if mutant.name not in results]
    if missing:
        rows += ["", f"Not run: {'; '.join(missing)}."]
    return "\n".join(rows) + "\n"


def main():
    options = arguments()
    wrong = False if options.redraw else run(options)
    replace_section(ROOT / "docs/testing.md", "mutants.py", table(stored_results()))
    if wrong:
        sys.exit("mutants.py: error: some mutants survive or could not be run")


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"mutants.py: error: {error}")
