#!/usr/bin/python3
"""bench/first_picture.py: medians, and the page from what was measured."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "bench"))

import first_picture  # noqa: E402


def run(processor, **stages):
    return {"processor": processor, "seconds": 2 * processor, "bytes": 3_000_000,
            "stages": [{"stage": name, "processor_seconds": seconds}
                       for name, seconds in stages.items()]}


class FirstPicture(unittest.TestCase):
    def test_the_median_is_a_run_with_the_least_and_the_most(self):
        median = first_picture.median_of([run(3.0), run(1.0, trace=0.5), run(0.5)])
        self.assertEqual((median["processor"], median["least"], median["most"]), (1.0, 0.5, 3.0))
        self.assertEqual(median["stages"][0]["processor_seconds"], 0.5)

    def test_the_page_has_a_row_for_each_state_and_stage(self):
        states = {state: {**run(1.5, trace=0.25), "least": 1.0, "most": 2.0}
                  for state in first_picture.STATES}
        page = first_picture.page({"room": states})
        for state in first_picture.STATES:
            self.assertIn(f"| room, {state} | 1.50 (1.00-2.00) | 3.00 | 3 |", page)
        self.assertIn("| trace | 0.25 |", page)


if __name__ == "__main__":
    unittest.main()
