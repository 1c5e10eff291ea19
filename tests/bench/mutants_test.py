#!/usr/bin/python3
"""Tests of bench/mutants.py and of its list, which has to follow the files that it changes.

    tests/bench/mutants_test.py
"""

import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import drawn_mutants
import mutants
from mutant_list import MUTANTS, Mutant


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


class Drawn(unittest.TestCase):
    def test_every_one_changes_one_place_of_a_line_of_code(self):
        drawn = list(drawn_mutants.sites(sorted(ROOT.glob("kernels/estimate/*.cl*"))))
        self.assertGreater(len(drawn), 300)
        for mutant in drawn:
            text = (ROOT / mutant.file).read_text(encoding="utf-8")
            self.assertEqual((mutant.name, text.count(mutant.find)), (mutant.name, 1))
            self.assertNotEqual(mutant.find, mutant.replace)
            self.assertFalse(mutant.find.splitlines()[-1].strip().startswith("//"))

    def test_the_tests_of_kernels_are_there(self):
        for folder, specification in drawn_mutants.KERNEL_TESTS:
            sources = "".join(file.read_text(encoding="utf-8")
                              for file in (ROOT / "tests" / folder).glob("*.cpp"))
            for pattern in specification.split(","):
                name = pattern.rpartition("]")[2]
                self.assertNotIn("~", name)  # behind a name, it excludes nothing: no test matches
                if name:
                    self.assertTrue(f'TEST_CASE("{name.rstrip("*")}' in sources, name)

    def test_operators_and_numbers_become_others(self):
        for before, after in (("<", "<="), ("max", "min"), ("16", "17"), ("0.5f", "0.55f"),
                              ("0.0f", "0.1f"), ("&&", "||")):
            self.assertEqual(drawn_mutants.changed(before), after)

    def test_the_interval_holds_the_share_and_is_never_empty(self):
        for killed, count in ((0, 0), (0, 10), (10, 10), (28, 30)):
            low, high = drawn_mutants.wilson(killed, count)
            self.assertLess(low, high)
            self.assertGreaterEqual(high, killed / max(count, 1) - 1e-12)


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
