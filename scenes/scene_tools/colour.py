"""Spectra to linear RGB with Rec.709 primaries, through the CIE 1931 2-degree observer."""

import math


def _lobe(wavelength, peak, width_below, width_above):
    width = width_below if wavelength < peak else width_above
    return math.exp(-0.5 * ((wavelength - peak) / width) ** 2)


def observer(wavelength):
    """Colour matching functions (x, y, z) at a wavelength in nm.

    Source: Wyman, Sloan, Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color
    Matching Functions", JCGT 2(2), the multi-lobe fit.
    """
    w = wavelength
    x = (1.056 * _lobe(w, 599.8, 37.9, 31.0) + 0.362 * _lobe(w, 442.0, 16.0, 26.7)
         - 0.065 * _lobe(w, 501.1, 20.4, 26.2))
    y = 0.821 * _lobe(w, 568.8, 46.9, 40.5) + 0.286 * _lobe(w, 530.9, 16.3, 31.1)
    z = 1.217 * _lobe(w, 437.0, 11.8, 36.0) + 0.681 * _lobe(w, 459.0, 26.0, 13.8)
    return x, y, z


def spectrum_to_rgb(wavelengths, values):
    """Linear Rec.709 RGB of a spectrum sampled at equal steps; the scale is arbitrary."""
    xyz = [0.0, 0.0, 0.0]
    for wavelength, value in zip(wavelengths, values):
        for i, matching in enumerate(observer(wavelength)):
            xyz[i] += matching * value
    x, y, z = xyz
    return (3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
            -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z)


def luminance(rgb):
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


def blackbody_rgb(kelvin):
    """Linear Rec.709 RGB of a black body, its largest component 1."""
    wavelengths = range(380, 781, 5)
    planck = [w ** -5 / (math.exp(1.4388e7 / (w * kelvin)) - 1.0) for w in wavelengths]
    rgb = [max(0.0, c) for c in spectrum_to_rgb(wavelengths, planck)]
    return tuple(c / max(rgb) for c in rgb)


def linear_from_srgb(code):
    """One 8-bit sRGB code value to linear."""
    encoded = code / 255.0
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


def srgb_from_linear(value):
    """A linear value in [0,1] to an 8-bit sRGB code value."""
    value = min(max(value, 0.0), 1.0)
    encoded = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return round(255 * encoded)
