"""bench/tools/compare.py: what it calls a change, and what it refuses."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench/tools/compare.py"


def row(structure, times, k=50):
    return {"workload": "plane", "structure": structure, "k": k, "references": 7,
            "seconds": {"median": sorted(times)[len(times) // 2], "min": min(times),
                        "max": max(times), "samples": times}}


def record(rows, bench="knn", driver="1"):
    return {"bench": bench, "device": {"driver": driver}, "results": rows}


class CompareTest(unittest.TestCase):
    def run_on(self, before, after):
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for name, content in (("before", before), ("after", after)):
                files.append(pathlib.Path(folder, name + ".json"))
                files[-1].write_text(content if isinstance(content, str) else json.dumps(content))
            return subprocess.run([sys.executable, SCRIPT, *files], capture_output=True, text=True)

    def test_pairs_that_disagree_are_noise(self):
        result = self.run_on(record([row("grid", [1.0, 1.1, 1.3, 1.0, 1.0])]),
                             record([row("grid", [1.2, 1.4, 1.5, 1.2, 0.9])]))
        self.assertEqual(result.stdout, "0 of 1 times changed beyond the noise\n")

    def test_a_change_shows_below_a_load_that_differs_more_from_turn_to_turn(self):
        result = self.run_on(record([row("grid", [1.0, 4.0, 2.0, 8.0, 1.0])]),
                             record([row("grid", [1.1, 4.4, 2.2, 8.8, 1.1])]))
        self.assertIn("1.10 x slower: k 50, grid, plane, seconds 2 [1, 8] s -> 2.2 [1.1, 8.8] s, 5 pairs", result.stdout)

    def test_one_of_eight_pairs_may_disagree_and_one_of_seven_not(self):
        for count, changed in ((8, 0), (9, 1)):
            after = [2.0] * (count - 1) + [0.5]
            result = self.run_on(record([row("grid", [1.0] * count)]), record([row("grid", after)]))
            self.assertIn(f"{changed} of 1 times", result.stdout)

    def test_fewer_than_five_pairs_decide_nothing(self):
        result = self.run_on(record([row("grid", [1.0] * 4)]), record([row("grid", [2.0] * 4)]))
        self.assertIn("0 of 1 times changed", result.stdout)
        self.assertIn("1 have fewer than 5 pairs", result.stdout)

    def test_slower_and_faster_have_the_median_factor_of_the_pairs(self):
        result = self.run_on(record([row("grid", [1.0, 1.1, 1.2] * 2), row("tree", [4, 5, 6] * 2)]),
                             record([row("tree", [2, 2.5, 3] * 2), row("grid", [2.0, 2.2, 2.4] * 2)]))
        self.assertIn("2.00 x slower: k 50, grid, plane, seconds", result.stdout)
        self.assertIn("2.00 x faster: k 50, tree, plane", result.stdout)
        self.assertIn("2 of 2 times", result.stdout)

    def test_processor_seconds_stand_for_others_on_a_cpu_and_not_on_a_gpu(self):
        def timed(seconds):
            one = row("grid", [seconds] * 5)
            return {**one, "processor seconds": row("grid", [1.0] * 5)["seconds"]}
        for kind, changed in (("cpu", 0), ("gpu", 1)):
            files = [record([timed(seconds)]) for seconds in (1.0, 2.0)]
            for file in files:
                file["device"]["type"] = kind
            self.assertIn(f"{changed} of 1 times", self.run_on(*files).stdout)

    def test_times_of_fewer_queries_count_for_as_many(self):
        slow = {**row("grid", [1.0, 1.1, 1.2] * 2), "queries": 100}
        half = {**row("grid", [0.5, 0.55, 0.6] * 2), "queries": 50}
        self.assertIn("0 of 1 times", self.run_on(record([slow]), record([half])).stdout)
        result = self.run_on(record([half]), record([{**slow, "queries": 50}]))
        self.assertIn("2.00 x slower", result.stdout)

    def test_rows_of_one_file_and_other_drivers_are_named(self):
        result = self.run_on(record([row("grid", [1]), row("grid", [1], k=16)]),
                             record([row("grid", [1]), row("tree", [1])], driver="2"))
        self.assertIn("only before: k 16, grid, plane", result.stdout)
        self.assertIn("only after: k 50, tree, plane", result.stdout)
        self.assertIn("not the same: device, driver: 1 -> 2", result.stdout)

    def test_other_files_are_refused_in_a_line(self):
        for before in ("{", "[]", record([], bench="build")):
            result = self.run_on(before, record([]))
            self.assertNotEqual(result.returncode, 0)
            self.assertTrue(result.stderr.startswith("compare.py: error: "))
            self.assertEqual(result.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
