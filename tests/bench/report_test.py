#!/usr/bin/python3
"""Tests of bench/kernels/report*.py and bench/pictures/trade_plot.py against values worked out by hand. Exits with 77 (skipped) where
python3-matplotlib is not installed.

    tests/bench/report_test.py
"""

import math
import pathlib
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree

from records import knn_row, timing
try:
    from kernels import (report_kernels, report_lights, report_plots, report_scale, report_tables,
                         report_targets)
    from pictures import trade_plot
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

SIZES = (1_000, 10_000, 100_000, 1_000_000)


def scale_result(**stages):
    """Rows of one curve: a function of the size for each stage."""
    return {"results": [
        {"axis": "triangles", "mesh": "hall", "triangles": n, "peak bytes": n,
         "stages": [{"stage": name, "seconds": seconds(n)} for name, seconds in stages.items()]}
        for n in SIZES]}


class Scale(unittest.TestCase):
    def test_the_exponent_of_a_power_is_that_power(self):
        for power in (0.5, 1, 2):
            fit, _ = report_scale.exponent([(n, 0.02 * (n / 1000) ** power) for n in SIZES])
            self.assertAlmostEqual(fit, power)

    def test_n_log_n_has_its_own_exponent(self):
        fit, bound = report_scale.exponent([(n, n * math.log(n)) for n in SIZES])
        self.assertAlmostEqual(fit, bound)

    def test_times_too_short_to_trust_are_left_out(self):
        self.assertIsNone(report_scale.exponent([(1_000, 0.001), (10_000, 0.002), (100_000, 0.02),
                                                 (1_000_000, 0.2)]))

    def test_only_the_stage_that_grows_faster_than_n_log_n_is_named(self):
        result = scale_result(linear=lambda n: 1e-4 * n, sorting=lambda n: 1e-5 * n * math.log(n),
                              quadratic=lambda n: 1e-7 * n * n)
        self.assertEqual([(stage, axis, mesh) for stage, axis, mesh, _ in
                          report_scale.faster_than_n_log_n(result)],
                         [("quadratic", "triangles", "hall")])
        self.assertIn("Faster than n log n: quadratic.", report_scale.text(result))

    def test_a_size_that_failed_is_named_and_not_fitted(self):
        result = scale_result(linear=lambda n: 1e-4 * n)
        result["results"].append({"axis": "triangles", "mesh": "hall", "detail": 632,
                                  "emitted photons": 5, "failure": "out of memory"})
        self.assertIn("632 cells, 5 photons emitted: out of memory", report_scale.text(result))
        self.assertIn("No stage grows faster", report_scale.text(result))


class Knn(unittest.TestCase):
    def test_ratios_are_to_the_best_rival_a_query_where_cases_were_asked_differently_often(self):
        rows = report_tables.timed({"results": [
            knn_row("nanoflann", 2), knn_row("nanoflann, newer", 1), knn_row("embree", 4),
            knn_row("uniform-grid", 0.5, queries=1000)]})
        lines = report_tables.knn_table(rows).splitlines()
        self.assertEqual(lines[2], "| nanoflann | 20,000 (20,000-20,000) | 0.5 |")
        self.assertEqual(lines[-1], "| uniform-grid | 500 (500-500) | 20 |")

    def test_a_ratio_is_the_median_of_those_of_the_rounds(self):
        result = {"results": [knn_row("nanoflann", 10, 80, 30), knn_row("uniform-grid", 1, 8, 2)]}
        self.assertAlmostEqual(report_targets.speedup({"knn": result}, "plane", 50, "nanoflann"), 10)

    def test_on_a_cpu_the_processor_counts_and_elsewhere_what_a_caller_waits(self):
        rows = [knn_row("nanoflann", 6), {**knn_row("uniform-grid", 2), "processor seconds": timing(1)}]
        for kind, faster in (("cpu", 6), ("gpu", 3)):
            knn = {"device": {"type": kind}, "results": rows}
            self.assertAlmostEqual(report_targets.speedup({"knn": knn}, "plane", 50, report_targets.BEST), faster)

    def test_at_the_limits_all_cores_take_what_a_hit_must_cost(self):
        size, operations = report_kernels.estimate_cost(50)
        # A millisecond a hit of the device for the operations, and half of it for the bytes.
        limits = {"cached bytes per second": 2000 * size, "operations per second": 1000 * operations}
        rows = [{**knn_row("nanoflann", 9), "processor seconds": timing(2)}, knn_row("uniform-grid", 1)]
        results = {"kernels": {"settings": {"limits": limits}},
                   "knn": {"device": {"type": "cpu", "compute units": 2}, "results": rows}}
        queries = rows[0]["queries"]
        self.assertAlmostEqual(
            report_targets.speedup_at_the_limits(results, "plane", 50, report_targets.BEST),
            2 / queries / (2 * 1e-3))

    def test_lists_are_held_against_lists(self):
        result = {"results": [knn_row("nanoflann", 8), knn_row("nanoflann, lists", 6),
                              knn_row("uniform-grid", 1), knn_row("uniform-grid, lists", 3)]}
        self.assertAlmostEqual(
            report_targets.speedup({"knn": result}, "plane", 50, report_targets.BEST, lists=True), 2)
        self.assertNotIn("lists", report_tables.knn(result))
        self.assertIn("| uniform-grid, lists | 30,000 (30,000-30,000) | 2 |", report_tables.lists(result, None))

    def test_what_is_no_kernel_is_the_rest(self):
        row = knn_row("uniform-grid", 3e-6, **{"kernel seconds": timing(2e-6), "processor seconds": timing(5e-6),
                                               "system seconds": timing(1e-6)})
        self.assertIn("| plane, uniform-grid, k = 50 | 30 | 20 | 10 | 50 | 10 |",
                      report_tables.parts_of_time({"results": [row]}))

    def test_a_structure_that_no_style_names_is_drawn_beside_the_others(self):
        rows = [{"structure": name, "photons": 10, "queries": 1, "time": timing(1)}
                for name in ("my-list", "uniform-grid")]
        axis = unittest.mock.Mock()
        report_plots.draw_times(axis, rows)
        self.assertEqual([call.kwargs["label"] for call in axis.plot.call_args_list],
                         ["uniform-grid", "my-list"])

    def test_traced_photons_count_as_a_million_within_a_twentieth(self):
        self.assertEqual([report_tables.near_target(count) for count in (960_000, 940_000)], [True, False])


class Targets(unittest.TestCase):
    def test_a_missed_target_says_by_how_much(self):
        self.assertEqual(report_targets.at_least("a", 10, 20, str)[3], "missed by a factor of 2")
        self.assertEqual(report_targets.at_least("a", 20, 20, str)[3], "reached")
        self.assertEqual(report_targets.at_most("a", 75, 50, str)[3], "missed by a factor of 1.5")
        self.assertEqual(report_targets.at_most("a", None, 50, str)[2], "not measured")

    def test_targets_are_held_to_the_default_maps_in_whatever_order_rows_come(self):
        rows = [{"structure": "uniform-grid", "maps of": maps, "estimate kernels": timing(seconds)}
                for maps, seconds in (("triangle", 0.2), ("auto", 0.1))]
        for order in (rows, rows[::-1]):
            results = {"paper": {"results": order}}
            self.assertAlmostEqual(report_targets.paper_milliseconds(results), 100)

    def test_a_kernel_takes_as_long_to_compile_as_itself_and_its_program(self):
        row = {"cache": "empty", "programs": {"a.cl": timing(0.5), "b.cl": timing(0.75)},
               "kernels": {"a": timing(0.25), "b": timing(0.125)}}
        full = {"cache": "full", "open": timing(0.03), "prepare": timing(0.05)}
        results = {"startup": {"results": [row, full]}}
        compiled, started = report_targets.start_seconds(results)
        self.assertAlmostEqual(compiled, 1.0)
        self.assertAlmostEqual(started, 0.08)


class Kernels(unittest.TestCase):
    def test_the_cost_of_a_hit_is_that_of_the_documentation(self):
        moved, operations = report_kernels.estimate_cost(50)
        self.assertEqual((round(moved, -2), round(operations, -2)), (4000, 3600))

    def test_patches_add_flags_of_maps_to_what_the_build_moves(self):
        row = {"photons": 1000, "references": 100, "cells": 10, "maps": 1, "patches": False}

        def moved(kernel, **changes):
            return report_kernels.build_bytes({**row, "kernel": kernel, **changes})
        self.assertEqual(moved("count_photons"), 12 * 1000 + 4 * 100)
        self.assertEqual(moved("count_photons", patches=True), 12 * 1000 + 4 * 100 + 4)
        self.assertEqual(moved("size_grids", patches=True), 130 + 4)
        self.assertEqual(moved("scatter", patches=True), moved("scatter"))
        self.assertEqual(moved("gather_normals", patches=True), (4 + 4 + 12) * 100)
        self.assertIsNone(moved("estimate"))


class Lights(unittest.TestCase):
    def test_growth_is_that_from_the_fewest_to_the_most_lights(self):
        stages = report_lights.STAGES
        rows = [{"lights": n, "layer bytes": 1e6 * n, "dense bytes": 16e6 * n, "file bytes": 5e5,
                 **{stage: timing(0.002 * n) for stage in stages}} for n in (1, 4, 256)]
        self.assertEqual(report_lights.growth(rows, "film"), 256)
        result = {"results": rows, "settings": {"emitted photons": 10, "width": 4, "height": 3}}
        text = report_lights.text(result)
        self.assertIn("From 1 to 256 lights", text)
        self.assertIn("| 256 | " + "512 (512-512) | " * len(stages) + "256 | 4.1e+03 | 0.5 |", text)


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
