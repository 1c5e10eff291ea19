#!/usr/bin/python3
"""Tests of bench/tools/mutants.py and of its list, which has to follow the files that it changes.

    tests/bench/mutants_test.py
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import drawn_mutants, mutant_schemata, mutant_sites, mutant_tests, mutants
from tools.mutant_list import MUTANTS, Mutant


class Texts(unittest.TestCase):
    def test_every_mutant_changes_what_its_file_has_exactly_once(self):
        for mutant in MUTANTS:
            text = (ROOT / mutant.file).read_text(encoding="utf-8")
            self.assertEqual((mutant.name, text.count(mutant.find)), (mutant.name, 1))
            self.assertNotEqual(mutant.find, mutant.replace)
            self.assertTrue(mutant.tests)

    def test_names_are_unique_and_folders_exist(self):
        self.assertEqual(len({mutant.name for mutant in MUTANTS}), len(MUTANTS))
        for mutant in MUTANTS:
            for folder, _ in mutant.tests:
                self.assertTrue((ROOT / "tests" / folder / "CMakeLists.txt").is_file(), folder)

    def test_each_specification_names_tests_that_are_there(self):
        for mutant in MUTANTS:
            for folder, specification in mutant.tests:
                sources = "".join(file.read_text(encoding="utf-8")
                                  for file in (ROOT / "tests" / folder).glob("*_test.cpp"))
                names = [re.sub(r'"\s+"', "", name)
                         for name in re.findall(r'TEST_CASE\(\s*"((?:[^"\\]|\\.|"\s+")*)"', sources)]
                if specification.startswith("~"):
                    continue  # all but a few
                for part in re.split(r"(?<!\\),", specification):
                    if part.startswith("["):
                        self.assertTrue(part in sources, f"{mutant.name}: {folder}, {part}")
                    else:
                        pattern = re.escape(part.replace("\\,", ",")).replace(r"\*", ".*")
                        self.assertTrue(any(re.fullmatch(pattern, name, re.IGNORECASE | re.DOTALL)
                                            for name in names), f"{mutant.name}: {folder}, {part}")


class Drawn(unittest.TestCase):
    def test_every_one_changes_one_line_of_code_at_its_place(self):
        drawn = list(mutant_sites.sites(ROOT, sorted(ROOT.glob("kernels/estimate/*.cl*"))))
        self.assertGreater(len(drawn), 300)
        self.assertEqual(len({site.name for site in drawn}), len(drawn))
        for site in drawn:
            before = (ROOT / site.file).read_text(encoding="utf-8").split("\n")
            after = site.apply("\n".join(before)).split("\n")
            different = [i for i in range(len(before)) if before[i] != after[i]]
            self.assertEqual(different, [site.line], site.name)
            self.assertFalse(before[site.line].strip().startswith("//"))

    def test_the_tests_to_run_are_there(self):
        for folder, cases in drawn_mutants.KERNEL_CASES.items():
            sources = "".join(file.read_text(encoding="utf-8")
                              for file in (ROOT / "tests" / folder).glob("*.cpp"))
            for name in cases:
                if name.startswith("["):
                    self.assertTrue((ROOT / f"tests/{folder}/{name[2:name.index(']')]}.cpp").is_file(), name)
                else:
                    self.assertIn(f'TEST_CASE("{name}"', sources)
        for tests in drawn_mutants.FURTHER_TESTS.values():
            for folder, file in tests:
                self.assertTrue((ROOT / f"tests/{folder}/{file}_test.cpp").is_file(), file)

    def test_operators_and_numbers_become_others(self):
        for before, after in (("<", "<="), ("max", "min"), ("16", "17"), ("0.5f", "0.55f"),
                              ("0.0f", "0.1f"), ("&&", "||"), (">>", "<<"), ("true", "false"), ("!", "")):
            self.assertEqual(mutant_sites.changed(before), after)

    def test_templates_pointers_signs_and_comments_are_no_sites(self):
        for line in ("std::vector<int> a;", "const T& a = *b;", "f(-x);", "// a < b", "  * 2", "a->b();"):
            self.assertEqual([token.group() for _, code in mutant_sites.code_lines(line)
                              for token in mutant_sites.SITES.finditer(code)
                              if not token.group().isdigit()], [], line)

    def test_the_interval_holds_the_share_and_is_never_empty(self):
        for killed, count in ((0, 0), (0, 10), (10, 10), (28, 30)):
            low, high = drawn_mutants.wilson(killed, count)
            self.assertLess(low, high)
            self.assertGreaterEqual(high, killed / max(count, 1) - 1e-12)


SCHEMATA = """
#include <algorithm>
#include <cstdio>
bool first(int a, int b) { return a < b; }
int second(int a, int b) { return a - b - 1; }
int third(int a, int b) { a += b; return std::max(a, 2 * b); }
bool fourth(bool a, bool b, bool c) { return a && !b || c; }
int main() {
  std::printf("%d %d %d %d%d\\n", first(2, 2), second(5, 3), third(1, 4), fourth(false, false, false),
              fourth(true, false, false));
}
"""


class Schemata(unittest.TestCase):
    def test_one_build_does_as_each_of_its_mutants_and_as_none(self):
        expected = {}
        sites = []
        for number, code in mutant_sites.code_lines(SCHEMATA):
            sites += [mutant_sites.Site("a.cpp", number, found.start(), found.group())
                      for found in mutant_sites.SITES.finditer(code)]
        sites = [site for site in sites if 3 <= site.line <= 6]
        numbered = dict(enumerate(sites, 1))
        self.assertGreater(len(sites), 9)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)

            def build(text, program, *options):
                (folder / "a.cpp").write_text(text, encoding="utf-8")
                subprocess.run(["c++", "-std=c++20", "-w", *options, "a.cpp", "-o", program], cwd=folder,
                               check=True)

            text, left_out = mutant_schemata.instrument(SCHEMATA, numbered)
            build(text, "all", "-include", str(mutant_schemata.HEADER))
            self.assertEqual(left_out, set())
            for number, site in {0: None, **numbered}.items():
                if number in (0, *list(numbered)[::4]):  # a build each takes its time
                    build(site.apply(SCHEMATA) if site else SCHEMATA, "one")
                    expected[number] = subprocess.run([folder / "one"], capture_output=True, check=True).stdout
            outputs = {number: subprocess.run([folder / "all"], capture_output=True, check=True,
                                              env={**os.environ, "PHOTILE_MUTANT": str(number)}).stdout
                       for number in [0, *numbered]}
            for number, output in expected.items():
                self.assertEqual(outputs[number], output, number)
            recorded = folder / "record.txt"
            subprocess.run([folder / "all"], capture_output=True, check=True,
                           env={**os.environ, "PHOTILE_MUTANT_RECORD": str(recorded)})
            matters = {int(line) for line in recorded.read_text(encoding="utf-8").split()}
            for number in numbered:
                if outputs[number] != outputs[0]:
                    self.assertIn(number, matters)


class Lines(unittest.TestCase):
    def test_a_line_is_found_again_nearest_in_its_file_and_else_in_the_one_that_it_went_to(self):
        name = "a.cpp:3:7 + -> -"
        again = drawn_mutants.found_again(name, [("b.cpp", 2), ("a.cpp", 9), ("a.cpp", 5)])
        self.assertEqual(again.name, "a.cpp:6:7 + -> -")
        self.assertEqual(drawn_mutants.found_again(name, [("b.cpp", 2)]).name, "b.cpp:3:7 + -> -")
        self.assertIsNone(drawn_mutants.found_again(name, []))


class Order(unittest.TestCase):
    def test_what_notices_more_in_less_time_comes_first(self):
        with tempfile.TemporaryDirectory() as name:
            order = mutant_tests.Order(pathlib.Path(name) / "order.json")
            quick, slow, blind = (mutant_tests.Step("trace", (case,)) for case in ("quick", "slow", "blind"))
            for step, seconds, noticed in ((quick, 0.1, True), (slow, 9.0, True), (blind, 0.1, False)):
                order.note(step, seconds)
                order.count(step, "host/renderer/trace", noticed)
            self.assertEqual(order.of([slow, blind, quick], "host/renderer/trace")[0], quick)
            self.assertEqual(mutant_tests.Order(order.file).known, json.loads(json.dumps(order.known)))


class Changes(unittest.TestCase):
    def test_a_file_is_changed_in_the_folder_alone_and_its_text_is_given_back(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "a.cl").write_text("one two", encoding="utf-8")
            mutant = Mutant("m", "a.cl", "two", "three", ())
            self.assertEqual(mutants.mutate(folder, mutant), "one two")
            self.assertEqual((folder / "a.cl").read_text(encoding="utf-8"), "one three")

    def test_a_text_that_is_missing_or_there_twice_is_an_error(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "a.cl").write_text("two two", encoding="utf-8")
            for find in ("two", "four"):
                with self.assertRaises(mutants.CannotRun):
                    mutants.mutate(folder, Mutant("m", "a.cl", find, "x", ()))


class Table(unittest.TestCase):
    def test_what_no_test_noticed_survives_and_what_did_not_run_says_so(self):
        first, second, third = (mutant.name for mutant in MUTANTS[:3])
        text = mutants.table({first: [], second: ["a/b", "c/d", "e/f"]}).splitlines()
        self.assertIn(f"| {first} |", text[2])
        self.assertIn("**survives**", text[2])
        self.assertIn("| a/b; 2 more |", text[3])
        self.assertTrue(text[-1].startswith(f"Not run: {third} ("))


if __name__ == "__main__":
    unittest.main()
