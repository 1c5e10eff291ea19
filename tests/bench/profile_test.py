#!/usr/bin/python3
"""Tests of how bench/kernels/profile.py tells stages apart.

    tests/bench/profile_test.py
"""

import importlib.util
import pathlib
import unittest

# Not by its name: Python has a module `profile` of its own.
SPEC = importlib.util.spec_from_file_location(
    "photile_profile", pathlib.Path(__file__).resolve().parents[2] / "bench/kernels/profile.py")
PROFILE = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(PROFILE)

KERNELS = pathlib.Path(__file__).resolve().parents[2] / "kernels/estimate"


class Stages(unittest.TestCase):
    def test_the_innermost_function_that_is_listed_decides(self):
        self.assertEqual(
            PROFILE.stage_of(["squared_distances", "store_distances", "find_neighbourhood"]),
            "distances of the candidates")
        self.assertEqual(PROFILE.stage_of(["sum16", "estimate_hit", "_pocl_kernel_estimate_by_selection"]),
                         "sums of flux")

    def test_a_kernel_is_known_by_the_names_that_pocl_gives_it(self):
        for name in ("_pocl_kernel_estimate_by_selection",
                     "_pocl_kernel_estimate_by_selection_workgroup_fast"):
            self.assertEqual(PROFILE.stage_of([name]), "hits in, estimates out")

    def test_an_unknown_function_is_a_stage_of_its_own(self):
        self.assertEqual(PROFILE.stage_of(["inner", "outer"]), "outer")

    def test_every_listed_function_is_in_the_kernels(self):
        text = "".join(file.read_text(encoding="utf-8") for file in KERNELS.iterdir())
        text += (KERNELS.parent / "grid/cell.clh").read_text(encoding="utf-8")
        self.assertEqual([name for name in PROFILE.STAGES if f"{name}(" not in text], [])


if __name__ == "__main__":
    unittest.main()
