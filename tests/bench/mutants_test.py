#!/usr/bin/python3
"""Tests of bench/mutants, whose list has to follow the files that it changes."""

import re
import unittest

from records import ROOT
from mutants import mutants
from mutants.chosen import MUTANTS, Mutant


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
        listed = [(mutant.name, tests) for mutant in MUTANTS for tests in mutant.tests]
        listed += [("drawn", tests) for tests in (mutants.KERNEL_TESTS, *mutants.FURTHER_TESTS.values())
                   for tests in tests]
        for name, (folder, specification) in listed:
            files = sorted((ROOT / "tests" / folder).glob("*_test.cpp"))
            sources = "".join(file.read_text(encoding="utf-8") for file in files)
            names = [re.sub(r'"\s+"', "", case)
                     for case in re.findall(r'TEST_CASE\(\s*"((?:[^"\\]|\\.|"\s+")*)"', sources)]
            if specification.startswith("~"):
                continue  # all but a few
            for part in re.split(r"(?<!\\),", specification):
                if part.startswith("[#"):
                    self.assertIn(part[2:part.index("]")], [file.stem for file in files])
                elif part.startswith("["):
                    self.assertIn(part, sources, f"{name}: {folder}")
                else:
                    pattern = re.escape(part.replace("\\,", ",")).replace(r"\*", ".*")
                    self.assertTrue(any(re.fullmatch(pattern, case, re.IGNORECASE | re.DOTALL)
                                        for case in names), f"{name}: {folder}, {part}")


class Drawn(unittest.TestCase):
    def test_every_one_changes_one_line_of_code_at_its_place(self):
        drawn = list(mutants.sites(sorted(ROOT.glob("kernels/estimate/*.cl*"))))
        self.assertGreater(len(drawn), 300)
        self.assertEqual(len({site.name for site in drawn}), len(drawn))
        for site in drawn:
            before = (ROOT / site.file).read_text(encoding="utf-8").split("\n")
            after = site.apply("\n".join(before)).split("\n")
            different = [i for i in range(len(before)) if before[i] != after[i]]
            self.assertEqual(different, [site.line], site.name)
            self.assertFalse(before[site.line].strip().startswith("//"))

    def test_operators_and_numbers_become_others(self):
        for before, after in (("<", "<="), ("max", "min"), ("16", "17"), ("0.5f", "0.55f"),
                              ("0.0f", "0.1f"), ("&&", "||"), (">>", "<<"), ("true", "false"), ("!", "")):
            self.assertEqual(mutants.changed(before), after)

    def test_templates_pointers_signs_and_comments_are_no_sites(self):
        for line in ("std::vector<int> a;", "const T& a = *b;", "f(-x);", "// a < b", "  * 2", "a->b();"):
            self.assertEqual([token.group() for _, code in mutants.code_lines(line)
                              for token in mutants.SITES.finditer(code)
                              if not token.group().isdigit()], [], line)


class Changes(unittest.TestCase):
    def test_a_text_is_changed_where_it_is_there_once_and_is_else_an_error(self):
        mutant = Mutant("m", "a.cl", "two", "three", ())
        self.assertEqual(mutants.apply(mutant, "one two"), "one three")
        for text in ("two two", "four"):
            with self.assertRaises(mutants.CannotRun):
                mutants.apply(mutant, text)


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
