#!/usr/bin/python3
"""Tests of bench/promises.py against values worked out by hand. Exits with 77 (skipped) where
python3-numpy or python3-openimageio is not installed.

    tests/bench/promises_test.py
"""

import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
try:
    import numpy as np
    import promises
except (ImportError, SystemExit) as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


class Errors(unittest.TestCase):
    def test_pixels_that_see_a_lamp_and_those_next_to_them_do_not_count(self):
        reference = np.ones((5, 5, 3))
        reference[0, 0] = 1000
        picture = reference.copy()
        picture[1, 1] = 7  # next to the lamp
        self.assertEqual(promises.relative_error(picture, reference), 0)
        picture[2, 2] = 3
        expected = math.sqrt(4 / 1.01 / 21)  # one of 25 - 4 pixels is off by 2
        self.assertAlmostEqual(promises.relative_error(picture, reference), expected)


class Table(unittest.TestCase):
    def test_a_broken_promise_says_so(self):
        row = {"view": "hall", "promised": "error", "wanted": 0.2, "photons": 10, "k": 3,
               "samples": 4, "expected_error": 0.14, "expected_frame": 1, "error": 0.21, "frame": 1}
        self.assertIn("| hall | 20% | 14% | 21% | **no** | `--photons 10 -k 3 --samples 4` |",
                      promises.table([row]))
        row.update(promised="frame", wanted=0.3, expected_frame=0.27, frame=0.25)
        self.assertIn("| hall | 300 ms | 270 ms | 250 ms | yes |", promises.table([row]))


if __name__ == "__main__":
    unittest.main()
