"""Converged pictures by photile's own path tracer, which a folder keeps.

A reference is the mean of pictures of some paths a pixel, each of a seed of its own: with more paths only
the pictures that lack are made, and the two halves of the seeds tell its noise.
"""

import pathlib
import subprocess
import tempfile

import numpy as np

from tools import picture_error

PATHS_OF_PICTURE = 64  # unless the caller says another number


def pictures(photile, scene, size, paths, folder, options=(), paths_of_picture=PATHS_OF_PICTURE):
    """Independent pictures of shape (height, width, 3), at least two, which share out the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for seed in range(1, max(2, paths // paths_of_picture) + 1):
        kept = folder / f"{scene.stem}-{size}-{seed}.npy"
        if not kept.exists():
            with tempfile.TemporaryDirectory() as name:
                picture = pathlib.Path(name) / "paths.exr"
                subprocess.run([photile, "render", scene, *options, "--integrator", "path", "--size",
                                size, "--samples", str(min(paths, paths_of_picture)), "--seed",
                                str(seed), "--quiet", "-o", picture], check=True)
                np.save(kept, picture_error.read_picture(picture))
        found.append(np.load(kept))
    return found


def halves(found):
    """Two independent means, each of every other picture."""
    return [np.mean(found[first::2], axis=0) for first in (0, 1)]


def mean_and_noise(found):
    """The reference, and its own relMSE: a half is off the mean of both by half of their difference,
    which is as noisy as that mean."""
    first, second = halves(found)
    reference = (first + second) / 2
    return reference, picture_error.measure(first, reference)["rel_mse"]
