#!/usr/bin/python3
"""Builds faults into photile, one at a time, and says which tests notice: docs/measured/mutants.md.

    bench/mutants/mutants.py [NAME...] [--redraw] [--build FOLDER]
    bench/mutants/mutants.py --draw COUNT [--seed N] [--only kernels|host] [--folders NAME...] [--list]

Without --draw they are those of chosen.py beside this file, or those whose names hold one of NAME. Results
stay in docs/measured/mutants.json, from which --redraw makes the table again. With --draw they are drawn at
random: each changes one operator, bound, constant or truth value of a line of kernels/ or of folders of the
parts of host/. Those are not kept: survivors need a look.

Kernels are changed in a copy that PHOTILE_KERNEL_DIR names, and run by the tests of the build at hand. Of
the host, the objects that hold a changed file are compiled again from a copy of host/, and linked before
the archives of that build, whose own objects of these files are then not taken. Every test first has to
pass without the mutant.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import random
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from mutants.chosen import MUTANTS
from tools.report_section import replace_section

RESULTS = ROOT / "docs/measured/mutants.json"
LIMIT = 600  # seconds of the processor that tests may take; one that takes longer counts as a crash
STILL_SECONDS = 60  # without work for the processor: threads that wait for each other for good


class CannotRun(Exception):
    """Why nothing can be said about a mutant."""


# Where a line of code can be made wrong.
OPERATORS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+",
             "*": "/", "/": "*", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
             "%": "/", "&": "|", "|": "&", "<<": ">>", ">>": "<<", "!": "", "min": "max", "max": "min",
             "true": "false", "false": "true"}
SITES = re.compile(
    # Between blanks: no template, no pointer, no sign.
    r"(?<=[\w)\]] )(?:<<|>>|<=|>=|==|!=|&&|\|\||[+\-*/]=|[<>+\-*/%&|])(?= )"
    r"|(?<=[\s(])!(?=[\w(])"
    r"|\b(?:min|max)(?=\()|\b(?:true|false)\b"
    r"|(?<![\w.'])\d+\.\d+(?:e[+-]?\d+)?f?\b|(?<![\w.'])\d+(?![\w.'])")

# Tests that a drawn mutant has to pass, in this order, until one fails: (folder of tests/, specification).
KERNEL_TESTS = (
    ("estimate", "irradiance equals the oracle's for one light,neighbours equal the oracle's*,"
                 "glossy radiance equals*,weighted irradiance equals*,clipped irradiance*,lanes *,extremes: *,"
                 "the exact law of the estimate in a corner of 45 degrees,k of 1 to 900*,thin plates*"),
    ("maps", "~[slow]~[long]"), ("surface", "[#kernel_functions_test]"))
TESTED_IN = {"gltf": "loading", "obj": "loading"}  # folders whose tests are in one of another name
FURTHER_TESTS = {
    "groups": (("estimate", "[#estimates_vs_oracle_test]~[slow]"),),
    "surface": (("estimate", "[#corners_test]~[slow],[#dark_surface_test]~[slow]"),),
    "trace": (("reference", "~[slow]"), ("cache", "[#irradiance_gather_test]~[slow]"), ("daylight", "~[slow]")),
    "scene": (("trace", "~[slow]"), ("loading", "~[slow]")),
    "image": (("loading", "[#textures_test]~[slow]"),),
    "gltf": (("fuzz", "[#corpus_test]"),), "obj": (("fuzz", "[#corpus_test]"),)}


@dataclasses.dataclass(frozen=True)
class Site:
    file: str    # of the repository
    line: int    # from 0
    column: int  # from 0
    token: str

    @property
    def name(self):
        return f"{self.file}:{self.line + 1}:{self.column + 1} {self.token} -> {changed(self.token)}"

    @property
    def tests(self):
        if self.file.startswith("kernels/"):
            return KERNEL_TESTS
        folder = self.file.split("/")[2]
        home = TESTED_IN.get(folder, folder)
        own = ((home, "~[slow]"),) if (ROOT / "tests" / home).is_dir() else ()
        return own + FURTHER_TESTS.get(folder, ())

    def apply(self, text):
        """The file's text with this mutant."""
        lines = text.split("\n")
        line = lines[self.line]
        assert line[self.column:].startswith(self.token), self.name
        lines[self.line] = line[:self.column] + changed(self.token) + line[self.column + len(self.token):]
        return "\n".join(lines)


def changed(token):
    if token in OPERATORS:
        return OPERATORS[token]
    if token.isdigit():
        return str(int(token) + 1)
    number = float(token.rstrip("f"))
    return f"{1.1 * number or 0.1:.9g}" + ("f" if token.endswith("f") else "")


def code_lines(text):
    """(number, line) of those that hold code: no comments, directives, texts or checks of the compiler."""
    in_comment = False
    for number, line in enumerate(text.splitlines()):
        bare = line.strip()
        if in_comment or bare.startswith(("//", "#", "/*")) or '"' in line or "static_assert" in line:
            in_comment = (in_comment or bare.startswith("/*")) and "*/" not in bare
            continue
        if "template <" in line or "throw " in line or "assert(" in line:
            continue
        yield number, line.split("//")[0]


def sites(files):
    """Every mutant that there is."""
    for file in files:
        for number, code in code_lines(file.read_text(encoding="utf-8")):
            for found in SITES.finditer(code):
                yield Site(str(file.relative_to(ROOT)), number, found.start(), found.group())


def drawn(options):
    patterns = [] if options.only == "host" else ["kernels/**/*.cl*"]
    if options.only != "kernels":
        patterns += [f"host/*/{folder}/**/*.[ch]pp" for folder in options.folders]
    everything = list(sites(file for pattern in patterns for file in sorted(ROOT.glob(pattern))))
    return random.Random(options.seed).sample(everything, min(options.draw, len(everything)))


def apply(mutant, text):
    """The text with a mutant, drawn or chosen."""
    if isinstance(mutant, Site):
        return mutant.apply(text)
    if text.count(mutant.find) != 1:
        raise CannotRun(f"{mutant.file} has {mutant.find!r} {text.count(mutant.find)} times, not once")
    return text.replace(mutant.find, mutant.replace)


def output_of(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise CannotRun("it does not compile: " + (done.stderr or done.stdout).splitlines()[0])
    return done.stdout


class Builder:
    """Programs of tests with a file of the host changed, from the objects of a finished build."""

    LIBRARY = tuple(f"host/{room}/CMakeFiles/photile_{room}.dir/"
                    for room in ("renderer", "formats", "pictures", "lighting"))
    # What programs are linked from: the library, and what of host/apps stands on it.
    ARCHIVES = (*LIBRARY, *(f"host/{folder}.dir/" for folder in (
        "lighting/CMakeFiles/photile_report", "apps/CMakeFiles/photile_tools",
        "apps/command/CMakeFiles/photile_app", "apps/view/CMakeFiles/photile_view")))

    def __init__(self, build, work):
        self.build, self.work, self.host = build, work, work / "host"
        self.commands = {}  # object -> the words of its command
        for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
            words = shlex.split(entry["command"])
            self.commands[words[words.index("-o") + 1]] = words
        shutil.rmtree(self.host, ignore_errors=True)
        shutil.copytree(ROOT / "host", self.host)

    def objects_that_read(self, file, folders):
        """The archives' objects, and those of the tests of folders, that a file is part of."""
        readers, object_ = set(), None
        for line in output_of(["ninja", "-t", "deps"], self.build).splitlines():
            if not line.startswith(" "):
                object_ = line.split(":", 1)[0]
            # A cache of compilers may state paths from the build folder on.
            elif line.endswith(file) and (self.build / line.strip()).resolve() == ROOT / file:
                readers.add(object_)
        wanted = (*self.ARCHIVES, *(f"tests/{folder}/" for folder in folders))
        found = sorted(object_ for object_ in readers & set(self.commands) if object_.startswith(wanted))
        if not found:
            raise CannotRun(f"no object of {self.build} was compiled from {file}")
        return found

    def compile(self, object_):
        """The object again, from the copies; returns its path."""
        words = list(self.commands[object_])
        source, out = pathlib.Path(words[-1]), self.work / object_
        out.parent.mkdir(parents=True, exist_ok=True)
        changed_source = source
        if "/Unity/" in str(source):
            changed_source = out.with_suffix(".unity.cpp")
            changed_source.write_text(source.read_text(encoding="utf-8")
                                      .replace(f"{ROOT}/host/", f"{self.host}/"), encoding="utf-8")
        elif source.is_relative_to(ROOT / "host"):
            changed_source = self.host / source.relative_to(ROOT / "host")
        words = [word.replace(f"-I{ROOT}/host", f"-I{self.host}") for word in words[:-1]]
        words[words.index("-o") + 1] = str(out)
        output_of([*words[:-1], "-w", "-c", str(changed_source)], self.build)
        return out

    def link(self, folder, objects):
        """The program of a folder of tests with objects (name -> path) in place of the build's."""
        target = program_of(folder)
        command = output_of(["ninja", "-t", "commands", "-s", target], self.build)
        words = shlex.split(command.strip().splitlines()[-1].split("&&")[1])
        words = [str(objects.get(word, word)) for word in words]
        program = self.work / target
        program.parent.mkdir(parents=True, exist_ok=True)

        def is_linked(name):
            return name.startswith(self.LIBRARY) or re.sub(r"CMakeFiles/(\w+)\.dir/.*", r"lib\1.a", name) in words

        place = words.index("-o")
        words[place:place + 2] = [*(str(path) for name, path in sorted(objects.items()) if is_linked(name)),
                                  "-o", str(program)]
        output_of(words, self.build)
        return program

    def programs(self, mutant):
        folders = [folder for folder, _ in mutant.tests]
        copy, text = self.work / mutant.file, (ROOT / mutant.file).read_text(encoding="utf-8")
        copy.write_text(apply(mutant, text), encoding="utf-8")
        try:
            objects = {name: self.compile(name) for name in self.objects_that_read(mutant.file, folders)}
        finally:
            copy.write_text(text, encoding="utf-8")
        return {folder: self.link(folder, objects) for folder in folders}


def program_of(folder):
    """The program of a folder of tests/ in the folder of a build."""
    return f"tests/{folder}/photile_tests_{folder}"


def ended(started):
    """Whether a program ended by itself, and was not ended since it waits for good."""
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


def failures(program, specification, environment=None, first=False):
    """Names of the cases that fail, or of the first; "crash" where the program ends otherwise."""
    if not program.is_file():
        raise CannotRun(f"{program} is missing; build the target {program.name}")

    def limited():
        resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.NamedTemporaryFile(suffix=".xml") as report:
        started = subprocess.Popen([program, "--filenames-as-tags", *(["--abort"] if first else []), specification,
                                    "--reporter", "xml", "--out", report.name],
                                   env=environment, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, preexec_fn=limited)
        has_ended = ended(started)
        text = pathlib.Path(report.name).read_text(encoding="utf-8", errors="replace")
    if "does not compile" in text or "BUILD_PROGRAM_FAILURE" in text:
        raise CannotRun("it does not compile")
    try:
        cases = list(xml.etree.ElementTree.fromstring(text).iter("TestCase")) if has_ended else None
    except xml.etree.ElementTree.ParseError:
        cases = None
    if cases is None:
        return ["crash"]
    if not cases:
        raise CannotRun(f"no test of {program.name} matches {specification}")
    failed = [case.get("name") for case in cases
              if case.find("OverallResult") is None or case.find("OverallResult").get("success") != "true"]
    return failed or (["crash"] if started.returncode != 0 else [])


class Runner:
    def __init__(self, build):
        self.build, self.work = build, build.parent / "mutants"
        self.builder = None
        self.passed = set()  # tests that pass where nothing is changed

    def _check(self, folder, specification):
        if (folder, specification) in self.passed:
            return
        failed = failures(self.build / program_of(folder), specification)
        if failed:
            raise CannotRun(f"without the mutant: {', '.join(failed)}")
        self.passed.add((folder, specification))

    def noticed(self, mutant, first):
        """The tests that notice, or the first."""
        environment = dict(os.environ)
        if mutant.file.startswith("kernels/"):
            shutil.rmtree(self.work / "kernels", ignore_errors=True)
            shutil.copytree(ROOT / "kernels", self.work / "kernels")
            copy = self.work / mutant.file
            copy.write_text(apply(mutant, copy.read_text(encoding="utf-8")), encoding="utf-8")
            environment["PHOTILE_KERNEL_DIR"] = str(self.work / "kernels")
            programs = {folder: self.build / program_of(folder) for folder, _ in mutant.tests}
        else:
            self.builder = self.builder or Builder(self.build, self.work)
            programs = self.builder.programs(mutant)
        names = []
        for folder, specification in mutant.tests:
            self._check(folder, specification)
            names += [f"{folder}/{name}"
                      for name in failures(programs[folder], specification, environment, first)]
            if first and names:
                break
        return names


def run(options, mutants):
    """name -> tests that noticed, of those that could be run; each is printed."""
    runner, results = Runner(options.build.resolve()), {}
    for mutant in mutants:
        try:
            results[mutant.name] = runner.noticed(mutant, bool(options.draw))
        except CannotRun as reason:
            print(f"{mutant.name}: error: {reason}", flush=True)
            continue
        print(f"{mutant.name}: {'; '.join(results[mutant.name]) or 'SURVIVES'}", flush=True)
        if not options.draw:
            store(results)
    return results


def stored_results():
    """Tests that noticed, by mutant."""
    return json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.is_file() else {}


def store(results):
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    RESULTS.write_text(json.dumps({**stored_results(), **results}, indent=1) + "\n", encoding="utf-8")


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


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--redraw", action="store_true", help="make the table from docs/testing alone")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release",
                        help="where the tests are; default: %(default)s")
    parser.add_argument("--draw", type=int, default=0, metavar="COUNT", help="so many at random")
    parser.add_argument("--seed", type=int, default=29)
    parser.add_argument("--only", choices=("kernels", "host"))
    parser.add_argument("--folders", nargs="+", default=("groups", "surface", "trace"), metavar="NAME",
                        help="of the parts of host/; default: groups surface trace")
    parser.add_argument("--list", action="store_true", help="print those drawn, run none")
    return parser.parse_args()


def main():
    options = arguments()
    if options.draw:
        mutants = drawn(options)
        if options.list:
            print("\n".join(site.name for site in mutants))
            return
        results = run(options, mutants)
        print(f"{sum(map(bool, results.values()))} of {len(results)} that compile were noticed")
        return
    chosen = [mutant for mutant in MUTANTS
              if not options.names or any(name in mutant.name for name in options.names)]
    results = {} if options.redraw else run(options, chosen)
    replace_section(ROOT / "docs/measured/mutants.md", "mutants/mutants.py", table(stored_results()),
                    partly=len(results) < len(MUTANTS))
    if not options.redraw and (len(results) < len(chosen) or not all(results.values())):
        sys.exit("mutants.py: error: some mutants survive or could not be run")


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, CannotRun, subprocess.CalledProcessError) as error:
        sys.exit(f"mutants.py: error: {error}")
