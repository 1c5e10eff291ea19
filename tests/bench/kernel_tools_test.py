"""bench/kernels: what report_device.py says of parts that failed, crashed or were not run; how profile.py tells stages
apart; ratios of report_ratios.py, of which one test is skipped (77) where python3-matplotlib is not installed."""

import json
import pathlib
import sys
import tempfile
import unittest

from records import ROOT, check_refusal, knn_row, run_on, timing
from kernels import profile, report_device, report_ratios, report_tables

POCL = {"name": "pthread-skylake-avx512-AMD EPYC", "platform": "Portable Computing Language",
        "platform_version": "OpenCL 3.0 PoCL 3.1+debian  Linux", "driver_version": "3.1+debian", "version": "OpenCL 3.0",
        "type": "cpu", "compute_units": 2, "clock_mhz": 2600, "global_memory_bytes": 1 << 34,
        "max_allocation_bytes": 1 << 33, "local_memory_bytes": 1 << 20, "max_work_group_size": 4096, "lanes": 0,
        "denormals": True, "exact_division": True, "extensions": "cl_khr_fp64", "id": "0:0", "selected": True}


def section(name, failures):
    return f'<Section name="{name}"><OverallResults successes="2" failures="{failures}"/></Section>'


class DeviceReportTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "parts").mkdir()
        self.put("device.log", json.dumps([{**POCL, "name": "other", "selected": False}, POCL]))
        self.put("parts/device", "device 0 1\n")

    def put(self, name, text):
        (self.folder / name).write_text(text)

    def page(self):
        result = report_device.collect(self.folder, False)
        report_device.write(result, self.folder / "result.json")
        self.assertEqual(json.loads((self.folder / "result.json").read_text()), result)
        return report_device.page(result, self.folder)

    def test_a_device_of_which_nothing_else_is_known_has_a_page(self):
        page = self.page()
        self.assertIn("# photile on AMD EPYC, PoCL 3.1", page)
        self.assertIn("Maps: not run", page)

    def test_what_a_part_said_last_is_told(self):
        self.put("parts/test", "test 134 7\n")
        self.put("test.log", "0:0\nLLVM ERROR: no code\n")
        self.assertIn("| test | 134 | 7 | LLVM ERROR: no code |", self.page())

    def test_a_kind_is_right_wrong_or_was_not_reached(self):
        # The third ended the process: its section has no end.
        self.put("kinds.xml", '<TestCase name="every kind">' + section("select, disc, k = 1", 0)
                 + section("select, disc, k = 50", 1) + '<Section name="select, glossy, k = 1">')
        page = self.page()
        self.assertIn("| select, disc | right | **wrong** |", page)
        self.assertNotIn("glossy", page)
        result = report_device.collect(self.folder, False)
        self.assertEqual(result["kinds"], {"passed": 1, "failed": ["select, disc, k = 50"]})

    def test_a_run_that_ends_in_its_first_kernel_is_told(self):
        self.put("kinds.xml", '<TestCase name="every kind"><Section name="select, disc, k = 1">')
        self.assertIn("No kernel came to an end.", self.page())

    def test_cases_without_sections_count_by_themselves(self):
        self.put("maps.xml", '<TestCase name="a"><OverallResult success="true"/></TestCase>'
                             '<TestCase name="b"><OverallResult success="false"/></TestCase>')
        self.assertIn("Maps: 1 of 2", self.page())

    def test_times_are_the_least_and_the_rest_is_the_host_s(self):
        times = {"kernels": timing(0.002, 0.003), "transfers": timing(0.001), "all": timing(0.005, 0.009),
                 "processor": timing(0.004)}
        rows = [{"measured": "structure", "structure": "uniform-grid", "k": 50, "photons": 1000, "hits": 1000,
                 "compile": 1.5, "build": times, "estimate": times},
                {"measured": "structure", "structure": "wide-bvh", "k": 50, "photons": 1000, "hits": 1000,
                 "failure": "no memory"}]
        self.put("kernels.json", json.dumps(
            {"date": "2026-11-26", "commit": "abc", "results": rows,
             "machine": {"processor": "AMD", "hardware threads": 2, "load average at start": 0.5},
             "settings": {"k": 50, "limits": {"copied bytes per second": 1e10, "cached bytes per second": 1e11,
                                              "operations per second": 1e11}}}))
        page = self.page()
        # Milliseconds of the build, nanoseconds of a hit: a thousand of each.
        self.assertIn("| `uniform-grid` | 1.50 | 2 | 1 | 2 | 4 | 2e+03 | 1e+03 | 2e+03 | 4e+03 |", page)
        self.assertIn("| `wide-bvh` | no memory |", page)

    def test_names_are_of_files(self):
        self.assertEqual(report_device.slug("NVIDIA H100 (TM) / CUDA 12.4"), "nvidia-h100-cuda-12.4")


class ProfileTest(unittest.TestCase):
    def test_the_innermost_function_that_is_listed_decides_else_the_outermost_is_a_stage(self):
        for functions, stage in (
                (["squared_distances", "store_distances", "find_neighbourhood"], "distances of the candidates"),
                (["sum16", "estimate_hit", "_pocl_kernel_estimate_by_selection"], "sums of flux"),
                (["inner", "outer"], "outer")):
            self.assertEqual(profile.stage_of(functions), stage)

    def test_a_kernel_is_known_by_the_names_that_pocl_gives_it(self):
        for name in ("_pocl_kernel_estimate_by_selection", "_pocl_kernel_estimate_by_selection_workgroup_fast"):
            self.assertEqual(profile.stage_of([name]), "hits in, estimates out")

    def test_every_listed_function_is_in_the_kernels(self):
        text = "".join(file.read_text(encoding="utf-8") for file in
                       [*(ROOT / "kernels/estimate").iterdir(), ROOT / "kernels/grid/cell.clh"])
        self.assertEqual([name for name in profile.STAGES if f"{name}(" not in text], [])


class RatiosTest(unittest.TestCase):
    def test_ratios_are_of_times_a_query_at_the_same_photons(self):
        rows = [knn_row("uniform-grid", 2.0, photons=1000), knn_row("uniform-grid", 9.0, photons=10_000),
                knn_row("tree", 3.0, photons=1000, queries=50), knn_row("tree", 4.5, photons=10_000, queries=25),
                {"workload": "plane", "structure": "tree", "k": 50, "photons": 7, "failure": "memory"}]
        text = run_on("kernels/report_ratios.py", {"results": rows}).stdout
        self.assertIn("| structure | 1,000 photons | 10,000 photons |", text)
        self.assertIn("| tree | 3 | 2 |", text)

    def test_ratios_are_drawn_a_picture_a_workload(self):
        try:
            from kernels import report_plots
        except ImportError as missing:
            self.skipTest(str(missing))
        rows = [knn_row(name, seconds, photons=photons) for photons in (1_000, 10_000)
                for name, seconds in (("uniform-grid", 2.0), ("kdtree-3d", 3.0))]
        rows.append({**rows[0], "workload": "one number of photons"})
        with tempfile.TemporaryDirectory() as folder:
            drawn = report_plots.draw_ratios({"results": rows}, "", pathlib.Path(folder))
            self.assertEqual(drawn, [("plane", "knn-ratios-plane.svg")])
            self.assertIn("<svg", pathlib.Path(folder, drawn[0][1]).read_text())

    def test_visits_are_listed_where_they_are_counted(self):
        rows = [knn_row("tree", 3.0, **{"nodes visited": 12.4, "photons visited": 99.6})]
        self.assertIn("| tree | 12 | 100 |", run_on("kernels/report_ratios.py", {"results": rows}).stdout)

    def test_structure_and_selection_are_told_apart(self):
        seconds = {"uniform-grid": 1, "uniform-grid-heap": 10, "kdtree-2d": 15, "kdtree-3d": 14,
                   "kdtree-2d-radix-32": 2, "kdtree-2d-radix-64": 1.75, "kdtree-2d-radix-128": 3}
        rows = report_tables.timed({"results": [knn_row(name, taken) for name, taken in seconds.items()]})
        text = report_ratios.structure_and_selection(rows)
        for told in ("| plane, k = 50 | 1.8 (leaves of 64) | 10 | 15 | 14 |",
                     "the grid is 1.8 to 1.8 times as fast as the kd-tree",
                     "with a heap for both, 1.5 to 1.5 times", "the heap takes 10 to 10 times as long"):
            self.assertIn(told, text)
        self.assertIsNone(report_ratios.structure_and_selection(rows[:3]))

    def test_other_files_are_refused_in_a_line(self):
        for content in ("{", "[]", "{}"):
            check_refusal(self, "kernels/report_ratios.py", content)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)  # CTest counts skips
