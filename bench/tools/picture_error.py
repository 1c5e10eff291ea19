"""Error of a picture against a reference, and pictures that show it.

Pictures are arrays of shape (height, width, 3): linear RGB with Rec.709 primaries, cd/m2.
"""

import numpy as np
import OpenImageIO as oiio

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # Rec.709
LAMP_LEVEL = 20  # pixels brighter than this many medians see a lamp
WORST_SHARE = 0.05  # of the pixels, left out of the second relMSE
MID_GREY = 0.18
COLOUR_STEP = 0.05  # of the false colours; a few steps also make small PNG files


def read_picture(path, channels="RGB"):
    """Channels of an EXR file, in this order. Raises OSError where they are not there."""
    source = oiio.ImageInput.open(str(path))
    if not source:
        raise OSError(f"{path}: {oiio.geterror()}")
    names = list(source.spec().channelnames)
    if not set(channels) <= set(names):
        raise OSError(f"{path}: no channels {', '.join(channels)}")
    pixels = source.read_image(oiio.FLOAT)
    source.close()
    return np.asarray(pixels, dtype=np.float64)[:, :, [names.index(name) for name in channels]]


def write_png(path, colours):
    """Writes display values from 0 to 1, shape (height, width, 3), as 8-bit sRGB."""
    values = np.ascontiguousarray(np.rint(np.clip(colours, 0, 1) * 255).astype(np.uint8))
    spec = oiio.ImageSpec(values.shape[1], values.shape[0], 3, oiio.UINT8)
    spec.attribute("png:compressionLevel", 9)
    target = oiio.ImageOutput.create(str(path))
    if not target.open(str(path), spec) or not target.write_image(values) or not target.close():
        raise OSError(f"{path}: {target.geterror()}")


def without_lamps(reference):
    """Mask (height, width) of the pixels that see no lamp."""
    luminance = reference @ LUMINANCE
    return luminance <= LAMP_LEVEL * np.median(luminance)


def rel_mse_text(figures):
    """Of `measure`: relMSE, and that without the worst pixels."""
    return f"{figures['rel_mse']:.4f} ({figures['rel_mse_without_worst']:.4f})"


def measure(picture, reference):
    """Mean ratio, relMSE, relMSE without the worst pixels, and the share of pixels left out.

    relMSE = mean over pixels and channels of (a - b)^2 / (b^2 + 0.01 mean(b)^2), where a is the
    picture, b the reference, and pixels that see a lamp are left out.
    """
    mask = without_lamps(reference)
    a, b = picture[mask], reference[mask]
    errors = ((a - b) ** 2 / (b**2 + 0.01 * b.mean() ** 2)).mean(axis=1)
    kept = np.sort(errors)[: round(len(errors) * (1 - WORST_SHARE))]
    return {
        "mean_ratio": a.mean() / b.mean(),
        "rel_mse": errors.mean(),
        "rel_mse_without_worst": kept.mean(),
        "lamp_fraction": 1 - mask.mean(),
    }


def windows(plane, reach):
    """The planes that are moved by up to `reach` pixels, borders repeated."""
    height, width = plane.shape
    padded = np.pad(plane, reach, mode="edge")
    side = 2 * reach + 1
    return np.stack([padded[y:y + height, x:x + width] for y in range(side) for x in range(side)])


def mottle(picture, reference):
    """Rms relative error of the luminance after a 3x3 mean, where the reference varies by less than
    a tenth within 5x5 pixels and no lamp is seen; None where that is nowhere."""
    own, true = (image @ LUMINANCE for image in (picture, reference))
    around = windows(true, 2)
    smooth = around.max(0) - around.min(0) < 0.1 * around.mean(0)
    smooth &= without_lamps(reference)
    if not smooth.any():
        return None
    error = windows(own, 1).mean(0)[smooth] / windows(true, 1).mean(0)[smooth] - 1
    return float(np.sqrt((error ** 2).mean()))


def exposure(reference):
    """The factor that makes the mean luminance of the reference, lamps left out, mid grey."""
    return MID_GREY / (reference @ LUMINANCE)[without_lamps(reference)].mean()


def displayed(picture, factor):
    """sRGB values of a picture multiplied by `factor`; brighter than white is clipped."""
    linear = np.clip(picture * factor, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def relative_error(picture, reference):
    """Signed error of the luminance, (height, width): its mean square is relMSE's of luminance."""
    a, b = picture @ LUMINANCE, reference @ LUMINANCE
    mean = b[without_lamps(reference)].mean()
    return (a - b) / np.sqrt(b**2 + 0.01 * mean**2)


def false_colour(error):
    """Blue for -1 and less, white for 0, red for 1 and more, in steps."""
    share = np.rint(np.clip(error, -1, 1) / COLOUR_STEP)[..., None] * COLOUR_STEP
    blue, white, red = np.array([[0.02, 0.19, 0.58], [0.97, 0.97, 0.97], [0.62, 0.0, 0.12]])
    return white + np.where(share < 0, -share * (blue - white), share * (red - white))


def colour_scale(width=512, height=16):
    """A strip of the false colours from -1 on the left to 1 on the right."""
    return np.repeat(false_colour(np.linspace(-1, 1, width))[None], height, axis=0)
