"""Tests that have to notice a mutant, those first that noticed most in the least time.

A step is some cases of one program, run until the first fails. How many seconds of the processor it
took, and how often it noticed mutants of an area of the code, is kept from one run to the next, and
orders the steps.
"""

import dataclasses
import json
import os
import pathlib
import re
import resource
import subprocess
import tempfile
import time
import xml.etree.ElementTree

REFUSED = 97  # mutant_schemata.hpp
GUESSED_SECONDS = 4.0  # of a step that never ran
LEAST_LIMIT, LIMIT_FACTOR = 10.0, 8  # seconds of the processor, and times what a step takes
STILL_SECONDS = 60  # without work for the processor: threads that wait for each other for good


def tests_of(folder):
    """The program of a folder of tests/ in the folder of a build."""
    return f"tests/{folder}/photile_tests_{folder}"


class CannotRun(Exception):
    """Why nothing can be said about a mutant."""


@dataclasses.dataclass
class Outcome:
    failed: list  # names of tests
    crashed: bool
    cases: list = dataclasses.field(default_factory=list)  # of the report
    seconds: float = 0.0  # of the processor

    def sound(self):
        """Itself. Errors: CannotRun where a test failed, although nothing was changed."""
        if self.failed or self.crashed:
            raise CannotRun(f"without the mutant: {', '.join(self.failed) or 'crash'}")
        return self


@dataclasses.dataclass(frozen=True)
class Step:
    folder: str
    cases: tuple  # names of test cases, or one specification that begins with [ or ~
    file: str = ""  # of the tests, where all cases are of one
    layer: str = ""  # around OpenCL, of tests/device/layers

    @property
    def key(self):
        more = f" and {len(self.cases) - 1}" if len(self.cases) > 1 else ""
        return f"{self.folder}/{self.file}: {self.cases[0]}{more}{self.under_layer}"

    @property
    def under_layer(self):
        return f" ({self.layer} layer)" if self.layer else ""


def wait_while_it_works(started):
    """Ends a program that waits for good; whether it ended by itself."""
    def worked():
        try:
            fields = pathlib.Path(f"/proc/{started.pid}/stat").read_text(encoding="ascii")
            return sum(map(int, fields.rpartition(")")[2].split()[11:13]))
        except OSError:
            return -1

    before, since = worked(), time.monotonic()
    while True:
        try:
            started.wait(5)
            return True
        except subprocess.TimeoutExpired:
            now = worked()
            if now != before:
                before, since = now, time.monotonic()
            elif time.monotonic() - since > STILL_SECONDS:
                started.kill()
                started.wait()
                return False


def run(program, arguments, environment=None, limit=None):
    """Runs a program of Catch2; `limit` is in seconds of the processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)

    def limited():
        if limit:
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.NamedTemporaryFile(suffix=".xml") as report:
        started = subprocess.Popen([program, *arguments, "--reporter", "xml", "--durations", "yes",
                                    "--out", report.name],
                                   env=environment, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, preexec_fn=limited)
        stopped = not wait_while_it_works(started)
        text = pathlib.Path(report.name).read_text(encoding="utf-8", errors="replace")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if started.returncode == REFUSED or "does not compile" in text or "BUILD_PROGRAM_FAILURE" in text:
        raise CannotRun("it does not compile")
    if stopped:
        return Outcome([], True, [], seconds)
    try:
        cases = list(xml.etree.ElementTree.fromstring(text).iter("TestCase"))
    except xml.etree.ElementTree.ParseError:
        return Outcome([], True, [], seconds)
    if not cases:
        raise CannotRun(f"no test of {program.name} matches {arguments}")
    failed = [case.get("name") for case in cases
              if case.find("OverallResult") is None or case.find("OverallResult").get("success") != "true"]
    return Outcome(failed, started.returncode != 0 and not failed, cases, seconds)


def run_step(program, step, environment=None, limit=None, whole=False):
    """Runs the cases until the first fails, or all of them."""
    options = ["--filenames-as-tags", *([] if whole else ["--abort"])]
    if step.cases[0][0] in "[~":
        return run(program, [*options, *step.cases], environment, limit)
    # A name that begins with a hyphen would be an option.
    names = (re.sub(r"([\\,\[])", r"\\\1", re.sub("^-", "*-", name)) for name in step.cases)
    return run(program, [*options, ",".join(names)], environment, limit)


class Order:
    """What steps took and noticed, in a file."""

    def __init__(self, file):
        self.file = file
        self.known = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}

    def of(self, steps, area, near=""):
        """The steps, the likeliest to notice in a second first; `near` is the changed file's stem."""
        return sorted(steps, key=lambda step: self._worth(step, area, near), reverse=True)

    def _worth(self, step, area, near):
        known = self.known.get(step.key, {})
        runs, noticed = known.get(area, (0, 0))
        factor = 10 if near and step.file.startswith(near) else 1
        return factor * (noticed + 0.3) / (runs + 1) / (self.seconds(step) + 0.05)

    def seconds(self, step):
        return self.known.get(step.key, {}).get("seconds", GUESSED_SECONDS)

    def limit(self, step):
        return max(LEAST_LIMIT, LIMIT_FACTOR * self.seconds(step))

    def passed_before(self, step):
        return "seconds" in self.known.get(step.key, {})

    def note(self, step, seconds):
        """What it takes where nothing is wrong; the most of it, as caches may hold what it compiles."""
        known = self.known.setdefault(step.key, {})
        known["seconds"] = max(seconds, known.get("seconds", 0.0))
        self._store()

    def count(self, step, area, noticed):
        known = self.known.setdefault(step.key, {})
        runs, all_noticed = known.get(area, (0, 0))
        known[area] = (runs + 1, all_noticed + noticed)
        self._store()

    def _store(self):
        self.file.write_text(json.dumps(self.known, indent=1) + "\n", encoding="utf-8")


def steps_of_folder(program, folder, file, order, quick=0.5):
    """A step for the quick cases of each source file of tests, one for each longer case. Kept in `file`."""
    if not file.is_file():
        outcome = run(program, ["~[slow]"]).sound()
        steps = []
        for source in dict.fromkeys(pathlib.PurePath(case.get("filename")).stem for case in outcome.cases):
            cases = {case.get("name"): float(case.find("OverallResult").get("durationInSeconds"))
                     for case in outcome.cases if pathlib.PurePath(case.get("filename")).stem == source}
            steps += [(source, [name], seconds) for name, seconds in cases.items() if seconds >= quick]
            of_quick = {name: seconds for name, seconds in cases.items() if seconds < quick}
            if of_quick:
                steps.append((source, list(of_quick), sum(of_quick.values())))
        file.write_text(json.dumps(steps, indent=1) + "\n", encoding="utf-8")
    steps = []
    for source, cases, seconds in json.loads(file.read_text(encoding="utf-8")):
        steps.append(Step(folder, tuple(cases), source))
        order.note(steps[-1], seconds)
    return steps
