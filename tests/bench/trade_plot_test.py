#!/usr/bin/python3
"""Tests of bench/pictures/trade_plot.py.

    tests/bench/trade_plot_test.py
"""

import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
try:
    from pictures import trade_plot
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


def point(varied, seconds, error):
    return {"varied": varied, "first_picture_seconds": seconds, "frame_seconds": seconds / 2,
            "relative_error": error}


POINTS = [point("nothing", 2, 0.2), point("radius", 1, 0.5), point("radius", 3, 0.3),
          point("maps", 4, 0.1)]


class TradePlot(unittest.TestCase):
    def test_the_front_leaves_out_what_something_faster_beats(self):
        best = trade_plot.front(POINTS, "frame_seconds")
        self.assertEqual([p["relative_error"] for p in best], [0.5, 0.2, 0.1])

    def test_the_plot_names_what_was_varied(self):
        record = {"scene": "a & b.obj", "width": 4, "height": 3, "renderings": POINTS}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "plot.svg"
            trade_plot.draw(record, file)
            text = file.read_text(encoding="utf-8")
        xml.etree.ElementTree.fromstring(text)
        for name in ("nothing", "radius", "maps", "a &amp; b.obj"):
            self.assertIn(name, text)


if __name__ == "__main__":
    unittest.main()
