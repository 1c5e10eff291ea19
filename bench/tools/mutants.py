#!/usr/bin/python3
"""Builds faults into photile, one at a time, and says which tests notice: docs/testing.md.

    bench/tools/mutants.py [NAME...] [--redraw] [--build FOLDER]

NAME is a part of the name of those to run; default: all of bench/tools/mutant_list.py. Kernels are changed in
a copy that PHOTILE_KERNEL_DIR names and run by the tests of the build at hand; of the host, the objects
that hold a changed file are compiled again and linked with those of that build (mutant_builder.py).
Every test first has to pass without the mutant. Results stay in docs/testing, and those of earlier runs
are kept, so that the table can be made in parts.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import mutant_tests
from tools.mutant_builder import Builder, DoesNotCompile
from tools.mutant_list import MUTANTS
from tools.mutant_tests import CannotRun, tests_of
from tools.report_section import replace_section

RESULTS = ROOT / "docs/testing/mutants.json"
LIMIT = 600  # seconds of the processor that tests may take; one that takes longer counts as a crash


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--redraw", action="store_true", help="make the table from docs/testing alone")
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


def program_of(build, folder):
    program = build / tests_of(folder)
    if not program.is_file():
        raise CannotRun(f"{program} is missing; build the target photile_tests_{folder}")
    return program


class Runner:
    def __init__(self, options):
        self.build = options.build
        self.work = options.build.parent / "mutants"
        self.builder = None
        self.baselines = {}  # (folder, specification) -> Outcome

    def _check_baselines(self, mutant):
        for tests in mutant.tests:
            if tests not in self.baselines:
                self.baselines[tests] = mutant_tests.run(program_of(self.build, tests[0]), [tests[1]])
            self.baselines[tests].sound()

    @staticmethod
    def _noticed(mutant, programs, environment=None):
        noticed = []
        for folder, specification in mutant.tests:
            outcome = mutant_tests.run(programs[folder], [specification], environment, LIMIT)
            noticed += [f"{folder}/{name}" for name in outcome.failed]
            if outcome.crashed:
                noticed.append(f"{folder}: crash")
        return noticed

    def in_kernels(self, mutant):
        self._check_baselines(mutant)
        shutil.rmtree(self.work / "kernels", ignore_errors=True)
        shutil.copytree(ROOT / "kernels", self.work / "kernels")
        mutate(self.work, mutant)
        environment = {**os.environ, "PHOTILE_KERNEL_DIR": str(self.work / "kernels")}
        return self._noticed(mutant, {folder: program_of(self.build, folder)
                                      for folder, _ in mutant.tests}, environment)

    def in_host(self, mutant):
        self._check_baselines(mutant)
        if self.builder is None:
            self.builder = Builder(self.build, self.work)
        folders = [folder for folder, _ in mutant.tests]
        text = mutate(self.work, mutant)
        try:
            objects = {name: self.builder.compile(name, (), "own")
                       for name in self.builder.objects_that_read(mutant.file, folders)}
        except DoesNotCompile as failure:
            raise CannotRun("it does not compile: " + str(failure)) from None
        finally:
            (self.work / mutant.file).write_text(text, encoding="utf-8")
        return self._noticed(mutant, {folder: self.builder.link(tests_of(folder), objects, "own")
                                      for folder in folders})


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
    replace_section(ROOT / "docs/testing.md", "tools/mutants.py", table(stored_results()))
    if wrong:
        sys.exit("mutants.py: error: some mutants survive or could not be run")


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, DoesNotCompile, subprocess.CalledProcessError) as error:
        sys.exit(f"mutants.py: error: {error}")
