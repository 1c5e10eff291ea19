#!/usr/bin/python3
"""Tests of bench/tools/picture_error.py against values worked out by hand. Exits with 77 (skipped) where
python3-numpy or python3-openimageio is not installed.

    tests/bench/picture_error_test.py
"""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
try:
    import numpy as np
    import OpenImageIO as oiio
    from tools import picture_error
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


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
        self.assertAlmostEqual(
            figures["rel_mse"], (3 / (1 + floor) + 1 / (4 + floor) + 0.25 / (1 + floor)) / 3)
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
        self.assertAlmostEqual((error**2).mean(),
                               picture_error.measure(picture, reference)["rel_mse"])
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
