"""bench/kernels/report_device.py: what a report says of parts that failed, crashed or were not run."""

import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from kernels import report_device

POCL = {"name": "pthread-skylake-avx512-AMD EPYC", "platform": "Portable Computing Language",
        "platform_version": "OpenCL 3.0 PoCL 3.1+debian  Linux", "driver_version": "3.1+debian", "version": "OpenCL 3.0",
        "type": "cpu", "compute_units": 2, "clock_mhz": 2600, "global_memory_bytes": 1 << 34,
        "max_allocation_bytes": 1 << 33, "local_memory_bytes": 1 << 20, "max_work_group_size": 4096, "lanes": 0,
        "denormals": True, "exact_division": True, "extensions": "cl_khr_fp64", "id": "0:0", "selected": True}


def section(name, failures):
    return f'<Section name="{name}"><OverallResults successes="2" failures="{failures}"/></Section>'


class DeviceReportTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
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
        timing = lambda *seconds: {"min": min(seconds), "median": max(seconds), "max": max(seconds), "samples": seconds}
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


if __name__ == "__main__":
    unittest.main()
