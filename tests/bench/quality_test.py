#!/usr/bin/python3
"""Tests of bench/pictures/quality*.py and bench/tools/{gltf_meshes,picture_error}.py. Exits with 77 (skipped) where Debian's numpy,
matplotlib or OpenImageIO is not installed.

    tests/bench/quality_test.py
"""

import contextlib
import io
import json
import math
import sys
import tempfile
import time
import unittest

from records import ROOT
try:
    from tools import gltf_meshes, one_picture, picture_error
    import numpy as np
    import OpenImageIO as oiio
    from pictures import quality, quality_report
except (ImportError, SystemExit) as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def row(tool, processor, rel_mse, frame=None):
    made = {"tool": tool, "first": {"processor": processor, "seconds": processor},
            "rel_mse": rel_mse, "flip": None}
    if frame is not None:
        made["frame"] = {"processor": frame, "seconds": frame}
    return made


class Curves(unittest.TestCase):
    POINTS = [1, 100], [0.1, 0.001]  # error = 0.1 / time

    def test_times_and_errors_between_points_are_those_of_powers(self):
        self.assertAlmostEqual(quality_report.time_to(0.01, *self.POINTS), 10)
        self.assertAlmostEqual(quality_report.error_at(10, *self.POINTS), 0.01)

    def test_beyond_the_last_point_nothing_is_made_up(self):
        self.assertIsNone(quality_report.time_to(0.0001, *self.POINTS))
        self.assertAlmostEqual(quality_report.error_at(1000, *self.POINTS), 0.001)
        self.assertIsNone(quality_report.error_at(0.5, *self.POINTS))
        self.assertEqual(quality_report.time_to(0.5, *self.POINTS), 1)

    def test_a_curve_is_of_one_tool_and_one_cost_by_time(self):
        rows = [row("a", 9, 0.1, 3), row("a", 4, 0.2, 1), row("b", 1, 0.3), row("a", 5, 0.15)]
        self.assertEqual(quality_report.curve(rows, "a", "frame", "rel_mse"), ([1, 3], [0.2, 0.1]))
        self.assertEqual(quality_report.curve(rows, "a", "first", "flip"), ([], []))


class Tables(unittest.TestCase):
    def test_ten_seconds_are_those_of_all_cores(self):
        rows = [row("a", 2, 0.2), row("a", 200, 0.002)]
        text = quality_report.summary(rows, cores=2).splitlines()[-1]
        self.assertEqual(text, "| a | 20 s | - | 0.02 | - |")

    def test_what_is_not_installed_keeps_its_rows(self):
        rows = [{"tool": "Mitsuba", "missing": "not installed"}]
        self.assertIn("| Mitsuba | not installed |", quality_report.summary(rows, 2))
        self.assertIn("| Mitsuba | not installed |", quality_report.table(rows))


class Settings(unittest.TestCase):
    def test_k_grows_as_the_photons_to_the_power_two_thirds(self):
        for photons, k in ((10_000, 12), (640_000, 12 * 16), (100, 12)):  # k cannot shrink for ever
            self.assertEqual(quality.neighbours(photons), k)

    def test_every_tool_has_a_line_in_the_plots(self):
        self.assertEqual(list(quality_report.STYLES), list(quality.TOOLS))


class OnePicture(unittest.TestCase):
    def written(self, *more):
        """Pictures that were rendered, the one in the file and the costs."""
        seeds, said = [], io.StringIO()

        def render(seed):
            seeds.append(seed)
            return np.full((2, 3, 3), float(seed))

        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(said):
            options = one_picture.parser("").parse_args(
                ["room.gltf", "--size", "3x2", "--samples", "1", "--begin", str(time.monotonic() - 7),
                 "-o", f"{folder}/picture.npy", *more])
            self.assertEqual(options.size, (3, 2))
            one_picture.write(options, render)
            return seeds, np.load(options.output), json.loads(said.getvalue())

    def test_the_first_picture_is_written_and_costs_what_passed_since_the_start(self):
        seeds, picture, costs = self.written()
        self.assertEqual((seeds, picture.shape, picture.max()), ([0], (2, 3, 3), 0))
        self.assertEqual(list(costs), ["first"])
        self.assertTrue(7 <= costs["first"]["seconds"] < 60)

    def test_a_next_picture_has_another_seed_and_its_own_costs_and_is_not_written(self):
        seeds, picture, costs = self.written("--next")
        self.assertEqual((seeds, picture.max()), ([0, 1], 0))
        self.assertTrue(0 <= costs["frame"]["seconds"] < 7)


class Results(unittest.TestCase):
    def test_a_row_measured_anew_takes_the_place_of_its_own_and_leaves_the_others(self):
        kitchen, classroom = quality.VIEWS[:2]

        def made(view, tool, setting, processor):
            return {**row(tool, processor, 0.1), "view": view, "setting": setting}

        known = [made(kitchen, "photile", "good", 20), made(kitchen, "Mitsuba", "1 spp", 1),
                 made(classroom, "photile", "good", 15), made("a view of an older script", "photile", "good", 3)]
        merged = quality.merged(known, [made(kitchen, "photile", "good", 18), made(kitchen, "photile", "draft", 5)])
        self.assertEqual([(one["view"], one["setting"], one["first"]["processor"]) for one in merged],
                         [(kitchen, "draft", 5), (kitchen, "good", 18), (kitchen, "1 spp", 1), (classroom, "good", 15)])

    def test_a_tool_that_could_not_run_once_is_not_missing_beside_its_figures(self):
        view = quality.VIEWS[0]
        failed = {"view": view, "tool": "Mitsuba", "missing": "it ended"}
        figures = {"view": view, "setting": "1 spp", **row("Mitsuba", 1, 0.1)}
        self.assertEqual(quality.merged([failed], [figures]), [figures])
        self.assertEqual(quality.merged([figures], [failed]), [figures])
        self.assertEqual(quality.merged([], [failed]), [failed])


class Meshes(unittest.TestCase):
    def test_the_cornell_box_has_its_triangles_colours_lamp_and_camera(self):
        meshes, view = gltf_meshes.read_gltf(ROOT / "scenes/cornell-box/cornell-box.gltf")
        by_name = {mesh.name: mesh for mesh in meshes}
        self.assertEqual(len(meshes), 8)
        self.assertEqual(len(by_name["floor"].triangles), 2)
        self.assertEqual(len(by_name["tall block"].triangles), 10)
        self.assertEqual(by_name["left wall"].reflectance, [0.448925, 0.038887, 0.010255])
        self.assertAlmostEqual(by_name["lamp"].radiance[0], 38888.632)
        self.assertEqual(by_name["floor"].radiance, [0, 0, 0])
        self.assertTrue(np.all(by_name["floor"].positions[:, 1] == 0))
        # From in front of the box, into it.
        self.assertTrue(np.allclose(view.to_world[:3, 3], [0.278, 0.273, -0.8]))
        self.assertTrue(np.allclose(view.to_world[:3, 2], [0, 0, -1]))
        self.assertTrue(0 < view.vertical_field_of_view < math.pi)

    def test_what_is_not_diffuse_is_refused(self):
        with self.assertRaises(ValueError):
            gltf_meshes.read_gltf(ROOT / "scenes/living-room/living-room.gltf")


def grey(*rows):
    """A picture whose channels are equal."""
    return np.repeat(np.array(rows, dtype=np.float64)[..., None], 3, axis=2)


class Measures(unittest.TestCase):
    def test_figures_of_four_pixels_equal_those_by_hand(self):
        reference = grey([1, 2], [1, 100])  # the median is 1.5, so the last pixel sees a lamp
        picture = 1.5 * reference
        picture[0, 0] = [1, 1, 4]
        figures = picture_error.measure(picture, reference)
        floor = 0.01 * (4 / 3) ** 2
        self.assertAlmostEqual(figures["mean_ratio"], (2 + 3 + 1.5) / 4)
        self.assertAlmostEqual(figures["rel_mse"], (3 / (1 + floor) + 1 / (4 + floor) + 0.25 / (1 + floor)) / 3)
        self.assertAlmostEqual(figures["lamp_fraction"], 1 / 4)

    def test_the_worst_twentieth_of_the_pixels_is_left_out(self):
        reference = grey(*[[1.0] * 10] * 10)
        picture = reference.copy()
        picture[0, :5] = 3  # 5 of 100 pixels
        figures = picture_error.measure(picture, reference)
        self.assertAlmostEqual(figures["rel_mse"], 0.05 * 4 / 1.01)
        self.assertEqual(figures["rel_mse_without_worst"], 0)

    def test_the_mean_square_of_the_relative_error_is_rel_mse_of_a_grey_picture(self):
        reference, picture = grey([1, 2, 3, 4]), grey([2, 1, 3, 5])
        error = picture_error.relative_error(picture, reference)
        self.assertAlmostEqual((error**2).mean(), picture_error.measure(picture, reference)["rel_mse"])
        self.assertEqual(list(np.sign(error[0])), [1, -1, 0, 1])

    def test_the_exposure_makes_the_mean_mid_grey_and_white_clips(self):
        reference = grey([1, 3])
        factor = picture_error.exposure(reference)
        self.assertAlmostEqual(factor, 0.09)
        shown = picture_error.displayed(grey([0.5 / 0.09, 1000]), factor)
        self.assertAlmostEqual(shown[0, 0, 0], 0.7353569830524495)  # sRGB of 0.5
        self.assertAlmostEqual(shown[0, 1, 2], 1)

    def test_false_colours_are_blue_below_white_at_and_red_above_zero(self):
        blue, white, red = picture_error.false_colour(np.array([-5.0, 0.0, 5.0]))
        self.assertTrue(blue[2] > 2 * blue[0] and red[0] > 2 * red[2])
        self.assertTrue(np.all(white == white[0]) and white[0] > 0.95)


class Files(unittest.TestCase):
    def test_r_g_b_are_found_by_name_among_the_layers_of_an_exr(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/layers.exr"
            spec = oiio.ImageSpec(1, 1, 5, oiio.FLOAT)
            spec.channelnames = ("Combined_lamp.R", "R", "G", "B", "A")
            target = oiio.ImageOutput.create(path)
            target.open(path, spec)
            target.write_image(np.array([[[9, 1, 2, 3, 1]]], dtype=np.float32))
            target.close()
            self.assertEqual(picture_error.read_picture(path).tolist(), [[[1, 2, 3]]])

    def test_a_missing_picture_is_an_os_error_that_names_it(self):
        with self.assertRaisesRegex(OSError, "nowhere.exr"):
            picture_error.read_picture("nowhere.exr")


if __name__ == "__main__":
    unittest.main()
