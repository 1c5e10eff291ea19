"""bench/kernels/report_ratios.py: ratios of times a query, and what it refuses."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench/kernels/report_ratios.py"


def row(structure, seconds, queries, photons=1000, **more):
    return {"workload": "plane", "structure": structure, "k": 50, "photons": photons,
            "queries": queries, "seconds": {"median": seconds, "min": seconds, "max": seconds,
                                           "samples": [seconds]}, **more}


class RatiosTest(unittest.TestCase):
    def run_on(self, content):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "knn.json")
            file.write_text(content)
            return subprocess.run([sys.executable, SCRIPT, file], capture_output=True, text=True)

    def test_ratios_are_of_times_a_query_at_the_same_photons(self):
        rows = [row("uniform-grid", 2.0, 100), row("uniform-grid", 9.0, 100, photons=10_000),
                row("tree", 3.0, 50), row("tree", 4.5, 25, photons=10_000),
                {"workload": "plane", "structure": "tree", "k": 50, "photons": 7, "failure": "memory"}]
        text = self.run_on(json.dumps({"results": rows})).stdout
        self.assertIn("| structure | 1,000 photons | 10,000 photons |", text)
        self.assertIn("| tree | 3 | 2 |", text)

    def test_ratios_are_drawn_a_picture_a_workload(self):
        sys.path.insert(0, str(SCRIPT.parents[1]))
        try:
            from kernels import report_plots
        except ImportError as missing:
            self.skipTest(str(missing))
        rows = [row(name, seconds, 100, photons) for photons in (1_000, 10_000)
                for name, seconds in (("uniform-grid", 2.0), ("kdtree-3d", 3.0))]
        rows.append({**rows[0], "workload": "one number of photons"})
        with tempfile.TemporaryDirectory() as folder:
            drawn = report_plots.draw_ratios({"results": rows}, "", pathlib.Path(folder))
            self.assertEqual(drawn, [("plane", "knn-ratios-plane.svg")])
            self.assertIn("<svg", pathlib.Path(folder, drawn[0][1]).read_text())

    def test_visits_are_listed_where_they_are_counted(self):
        rows = [row("tree", 3.0, 50, **{"nodes visited": 12.4, "photons visited": 99.6})]
        self.assertIn("| tree | 12 | 100 |", self.run_on(json.dumps({"results": rows})).stdout)

    def test_structure_and_selection_are_told_apart(self):
        sys.path.insert(0, str(SCRIPT.parents[1]))
        from kernels import report_ratios, report_tables
        seconds = {"uniform-grid": 1, "uniform-grid-heap": 10, "kdtree-2d": 15, "kdtree-3d": 14,
                   "kdtree-2d-radix-32": 2, "kdtree-2d-radix-64": 1.75, "kdtree-2d-radix-128": 3}
        rows = report_tables.timed({"results": [row(name, taken, 100) for name, taken in seconds.items()]})
        text = report_ratios.structure_and_selection(rows)
        self.assertIn("| plane, k = 50 | 1.8 (leaves of 64) | 10 | 15 | 14 |", text)
        self.assertIn("the grid is 1.8 to 1.8 times as fast as the kd-tree", text)
        self.assertIn("with a heap for both, 1.5 to 1.5 times", text)
        self.assertIn("the heap takes 10 to 10 times as long", text)
        self.assertIsNone(report_ratios.structure_and_selection(rows[:3]))

    def test_other_files_are_refused_in_a_line(self):
        for content in ("{", "[]", "{}"):
            result = self.run_on(content)
            self.assertNotEqual(result.returncode, 0)
            self.assertTrue(result.stderr.startswith("report_ratios.py: error: "))
            self.assertEqual(result.stderr.count("\n"), 1)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)  # CTest counts skips
