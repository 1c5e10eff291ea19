#!/usr/bin/python3
"""bench/pictures/first_picture.py: medians, and the page from what was measured."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "bench"))

from pictures import first_picture  # noqa: E402


def run(processor, **stages):
    return {"processor": processor, "seconds": 2 * processor, "bytes": 3_000_000, "photons": 20_000,
            "least": processor, "most": processor,
            "stages": [{"stage": name, "processor_seconds": seconds, "seconds": 2 * seconds}
                       for name, seconds in stages.items()]}


class FirstPicture(unittest.TestCase):
    def test_the_median_is_a_run_with_the_least_and_the_most(self):
        median = first_picture.median_of([run(3.0), run(1.0, trace=0.5), run(0.5)])
        self.assertEqual((median["processor"], median["least"], median["most"]), (1.0, 0.5, 3.0))
        self.assertEqual(median["stages"][0]["processor_seconds"], 0.5)

    def test_the_page_has_a_row_for_each_state_and_stage(self):
        states = {state: {**run(1.5, trace=0.25, build=0.5), "least": 1.0, "most": 2.0}
                  for state in first_picture.STATES}
        rivals = {"classroom": {state: {"processor": 2.0, "seconds": 1.0, "bytes": 5_000_000,
                                        "least": 1.5, "most": 2.5}
                                for state in first_picture.RIVAL_STATES},
                  "kitchen": "not installed: mitsuba"}
        page = first_picture.page({"photile": {"room": states}, "rivals": rivals, "load": 3.2})
        self.assertIn("a load of 3, the mean", page)
        for state in first_picture.STATES:
            self.assertIn(f"| room, {state} | 1.50 (1.00-2.00) | 3.00 | 3 | 150 | 50.0% |", page)
        for state in first_picture.RIVAL_STATES:
            self.assertIn(f"denoised: classroom, {state} | 2.00 (1.50-2.50) | 1.00 | 5 | - | - |",
                          page)
        self.assertIn("denoised: kitchen | not installed: mitsuba |", page)
        self.assertEqual(page.count("| trace | 0.25 / 0.50 |"), len(first_picture.STAGES_OF))



if __name__ == "__main__":
    unittest.main()
