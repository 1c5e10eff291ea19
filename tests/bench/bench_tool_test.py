"""bench/bench.py: what it lists, runs and refuses, where a script stands in for the programs; and bench/tools/compare.py:
what it calls a change, and what it refuses."""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from records import ROOT, check_refusal, run_on, timing

RECORD = {
    "schema version": 1, "bench": "knn", "commit": "abc", "results": [
        {"structure": "uniform-grid", "k": 50, "GB/s": 2.5, "seconds": timing(1, 2, 3)},
        {"structure": "wide-bvh", "k": 50, "failure": "out of memory"}]}


def run(*arguments):
    return subprocess.run([sys.executable, ROOT / "bench/bench.py", *map(str, arguments)], capture_output=True,
                          text=True)


class BenchToolTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.program = self.folder / "photile_bench_knn"
        self.program.write_text(f"#!/bin/sh\necho \"$@\" > {self.folder}/arguments\n"
                                f"[ \"$3\" = --colour ] && exit 2\ncat > \"$2\" <<'E'\n"
                                f"{json.dumps(RECORD)}\nE\n")
        self.program.chmod(0o755)

    def run_knn(self, *arguments):
        return run("run", "knn", "--benches", self.folder, "-o", self.folder / "out.json", *arguments)

    def test_every_bench_is_listed_with_what_it_measures(self):
        lines = run("list").stdout.splitlines()
        names = {line.split()[0] for line in lines}
        self.assertTrue({"knn", "build", "frame", "kernels", "strategies"} <= names)
        for line in lines:
            self.assertGreater(len(line.split(None, 1)[1]), 15, line)

    def test_options_reach_the_program_and_rows_a_table(self):
        result = self.run_knn("--csv", self.folder / "out.csv", "--structure", "uniform-grid", "-k", 50)
        self.assertEqual(result.returncode, 1)  # for the second row is a failure
        self.assertIn("1 of 2 rows are failures, the first: out of memory", result.stderr)
        given = (self.folder / "arguments").read_text().split()
        self.assertEqual(given[2:], ["--structure", "uniform-grid", "-k", "50"])
        with open(self.folder / "out.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(rows[0]["seconds median"], "2")
        self.assertEqual((rows[0]["schema version"], rows[0]["commit"]), ("1", "abc"))
        self.assertEqual((rows[1]["failure"], rows[1]["seconds median"]), ("out of memory", ""))

    def test_rows_without_failures_are_a_success(self):
        self.program.write_text(self.program.read_text().replace('"failure"', '"remark"'))
        result = self.run_knn()
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_refusal_of_the_program_is_one_of_the_tool(self):
        result = self.run_knn("--colour")
        self.assertEqual(result.returncode, 2)
        self.assertFalse((self.folder / "out.json").exists())

    def test_unknown_names_are_refused_with_those_there_are(self):
        result = run("run", "plaen")
        self.assertEqual(result.returncode, 2)
        self.assertIn("there is no bench 'plaen'; there are", result.stderr)
        self.assertIn("knn", result.stderr)
        self.assertEqual(run("compare", "a.json").returncode, 2)
        self.assertEqual(run("list", "--fast").returncode, 2)

    def test_pairs_run_in_turns_and_are_compared(self):
        """A stand-in whose time is the turn's, and half as much again with the option of the second."""
        self.program.write_text(f"""#!/usr/bin/python3
import json, sys
log = open("{self.folder}/log", "a+"); log.write(" ".join(sys.argv[3:]) + "\\n"); log.seek(0)
time = (len(log.readlines()) + 1) // 2 + (0.5 if "--cells" in sys.argv else 0)
row = {{"k": 50, "seconds": {{"median": time, "min": time, "max": time, "samples": [time]}}}}
json.dump({{"bench": "knn", "results": [row]}}, open(sys.argv[2], "w"))
""")
        result = run("pairs", "knn", "--benches", self.folder, "--turns", 6, "-o", self.folder, "-k", 50, "--", "--cells", 8)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "knn-after.json").exists())
        self.assertIn("6 pairs", result.stdout)
        self.assertIn("slower: k 50, seconds", result.stdout)
        with_cells = ["--cells" in line for line in (self.folder / "log").read_text().splitlines()]
        self.assertEqual(with_cells, [False, True, True, False] * 3)
        self.assertEqual(run("pairs", "knn").returncode, 2)  # both would be the same

    def test_a_comparison_names_files_that_are_not_there(self):
        result = run("compare", self.folder / "a.json", self.folder / "b.json")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("a.json", result.stderr)


def row(structure, samples, k=50, **more):
    return {"workload": "plane", "structure": structure, "k": k, "references": 7, "seconds": timing(*samples), **more}


def record(*rows, bench="knn", **device):
    return {"bench": bench, "device": {"driver": "1", **device}, "results": rows}


class CompareTest(unittest.TestCase):
    def check(self, before, after, *told):
        """Of two records, what is said contains each of these."""
        said = run_on("tools/compare.py", before, after).stdout
        for text in told:
            self.assertIn(text, said)
        return said

    def test_pairs_that_disagree_are_noise(self):
        said = self.check(record(row("grid", [1.0, 1.1, 1.3, 1.0, 1.0])),
                          record(row("grid", [1.2, 1.4, 1.5, 1.2, 0.9])))
        self.assertEqual(said, "0 of 1 times changed beyond the noise\n")

    def test_a_change_shows_below_a_load_that_differs_more_from_turn_to_turn(self):
        self.check(record(row("grid", [1.0, 4.0, 2.0, 8.0, 1.0])), record(row("grid", [1.1, 4.4, 2.2, 8.8, 1.1])),
                   "1.10 x slower: k 50, grid, plane, seconds 2 [1, 8] s -> 2.2 [1.1, 8.8] s, 5 pairs")

    def test_one_of_eight_pairs_may_disagree_and_one_of_seven_not(self):
        for count, changed in ((8, 0), (9, 1)):
            self.check(record(row("grid", [1.0] * count)), record(row("grid", [2.0] * (count - 1) + [0.5])),
                       f"{changed} of 1 times")

    def test_fewer_than_five_pairs_decide_nothing(self):
        self.check(record(row("grid", [1.0] * 4)), record(row("grid", [2.0] * 4)),
                   "0 of 1 times changed", "1 have fewer than 5 pairs")

    def test_slower_and_faster_have_the_median_factor_of_the_pairs(self):
        self.check(record(row("grid", [1.0, 1.1, 1.2] * 2), row("tree", [4, 5, 6] * 2)),
                   record(row("tree", [2, 2.5, 3] * 2), row("grid", [2.0, 2.2, 2.4] * 2)),
                   "2.00 x slower: k 50, grid, plane, seconds", "2.00 x faster: k 50, tree, plane", "2 of 2 times")

    def test_processor_seconds_stand_for_others_on_a_cpu_and_not_on_a_gpu(self):
        for kind, changed in (("cpu", 0), ("gpu", 1)):
            self.check(*(record(row("grid", [seconds] * 5, **{"processor seconds": timing(*[1.0] * 5)}), type=kind)
                         for seconds in (1.0, 2.0)), f"{changed} of 1 times")

    def test_times_of_fewer_queries_count_for_as_many(self):
        slow = row("grid", [1.0, 1.1, 1.2] * 2, queries=100)
        half = row("grid", [0.5, 0.55, 0.6] * 2, queries=50)
        self.check(record(slow), record(half), "0 of 1 times")
        self.check(record(half), record({**slow, "queries": 50}), "2.00 x slower")

    def test_rows_of_one_file_and_other_drivers_are_named(self):
        self.check(record(row("grid", [1]), row("grid", [1], k=16)),
                   record(row("grid", [1]), row("tree", [1]), driver="2"), "only before: k 16, grid, plane",
                   "only after: k 50, tree, plane", "not the same: device, driver: 1 -> 2")

    def test_other_files_are_refused_in_a_line(self):
        for before in ("{", "[]", record(bench="build")):
            check_refusal(self, "tools/compare.py", before, record())


if __name__ == "__main__":
    unittest.main()
