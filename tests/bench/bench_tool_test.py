"""bench/bench.py: what it lists, runs and refuses. A script stands in for the programs."""

import csv
import json
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench/bench.py"
RECORD = {
    "schema version": 1, "bench": "knn", "commit": "abc", "results": [
        {"structure": "uniform-grid", "k": 50, "GB/s": 2.5,
         "seconds": {"median": 2, "min": 1, "max": 3, "samples": [1, 2, 3]}},
        {"structure": "wide-bvh", "k": 50, "failure": "out of memory"}]}


def run(*arguments):
    return subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], capture_output=True,
                          text=True)


class BenchToolTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        program = self.folder / "photile_bench_knn"
        program.write_text(f"#!/bin/sh\necho \"$@\" > {self.folder}/arguments\n"
                           f"[ \"$3\" = --colour ] && exit 2\ncat > \"$2\" <<'E'\n"
                           f"{json.dumps(RECORD)}\nE\n")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)

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
        program = self.folder / "photile_bench_knn"
        program.write_text(program.read_text().replace('"failure"', '"remark"'))
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
        program = self.folder / "photile_bench_knn"
        program.write_text(f"""#!/usr/bin/python3
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


if __name__ == "__main__":
    unittest.main()
