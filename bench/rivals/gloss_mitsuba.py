#!/usr/bin/python3
"""photile's path tracer beside Mitsuba 3's on glossy surfaces (docs/method/gloss.md).

    bench/rivals/gloss_mitsuba.py SCENE.gltf... --references FOLDER [--paths N] [--photile COMMAND]

No material of Mitsuba's is glTF's coat as photile has it, so the formulas at the head of
include/photile/device/bsdf.h stand here once more, as a material of Mitsuba's: its camera, rays, lamps,
sampling and path tracer decide what light they give. Prints the ratio of the means, and by how many
standard errors means of tiles differ: 1 where they differ by noise alone. Needs the built command and the packages
numpy, OpenImageIO and mitsuba (DRJIT_LIBLLVM_PATH names LLVM 19).
"""

import argparse
import math
import pathlib
import sys

import drjit as dr
import mitsuba
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import path_references, picture_error, scene_arguments
from tools.gltf_meshes import read_gltf

mitsuba.set_variant("llvm_ad_rgb")

from rivals import quality_mitsuba

SIZE = "256x192"
PATHS_AT_A_TIME = 64
TILE = 16  # pixels
LEAST_ALPHA = 0.02


def quadratics(alpha, rows):
    """Coefficients in the cosine, from those in alpha."""
    return [a + alpha * (b + alpha * c) for a, b, c in rows]


def quotient(above, below, x):
    return dr.clip((above[0] + x * (above[1] + x * above[2])) /
                   (below[0] + x * (below[1] + x * below[2])), 0, 1)


class Coat(mitsuba.BSDF):
    """A GGX coat on a Lambertian base."""

    def __init__(self, properties):
        mitsuba.BSDF.__init__(self, properties)
        self.albedo, self.f0 = (mitsuba.Color3f(properties[key]) for key in ("albedo", "f0"))
        self.f90, self.alpha = properties["f90"], max(LEAST_ALPHA, properties["alpha"])
        self.regions = mitsuba.MicrofacetDistribution(mitsuba.MicrofacetType.GGX, self.alpha,
                                                     self.alpha, True)
        a = self.alpha
        self.weights = [quadratics(a, rows) for rows in (
            ((0.1003, 9.748, -8.245), (-0.6303, -2.038, 19.99), (29.34, -26.44, -5.448)),
            ((1.0, 8.263, -7.507), (-1.765, 11.53, 15.86), (28.96, -36.11, 33.37)),
            ((0.9345, 2.229, -0.7684), (-2.323, -3.748, 0.2913), (1.424, 1.436, 0.6286)),
            ((1.0, 15.94, 41.26), (0.2281, -55.83, 300.2), (13.08, 54.9, -285.1)))]
        self.mean = (np.polyval([-0.7034, 2.0736, -1.9283, 0.0150, 0.9524], a),
                     np.polyval([0.0968, -0.2979, 0.3510, -0.1978, 0.0505], a))
        # Half of the directions by regions, half by the cosine: only the noise depends on it.
        self.region_fraction = 0.5 if self.f90 > 0 else 0.0
        flags = mitsuba.BSDFFlags
        self.m_components = [flags.GlossyReflection | flags.DiffuseReflection | flags.FrontSide]
        self.m_flags = self.m_components[0]

    def facet_albedo(self, cosine):
        """Shares of F0 and F90 that one region reflects."""
        f0_above, f0_below, f90_above, f90_below = self.weights
        f90 = quotient(f90_above, f90_below, cosine)
        return dr.minimum(quotient(f0_above, f0_below, cosine), 1 - f90), f90

    def f(self, i, o):
        """Per steradian; i towards the light and o towards the eye, z along the normal."""
        cos_i, cos_o = mitsuba.Frame3f.cos_theta(i), mitsuba.Frame3f.cos_theta(o)
        if self.f90 == 0:
            return self.albedo / math.pi
        half = dr.normalize(i + o)
        schlick = (1 - dr.clip(dr.dot(i, half), 0, 1)) ** 5
        a2 = self.alpha ** 2
        below = mitsuba.Frame3f.cos_theta(half) ** 2 * (a2 - 1) + 1
        region = a2 / (math.pi * below * below) * 0.5 / (
            cos_o * dr.sqrt(cos_i * cos_i * (1 - a2) + a2) +
            cos_i * dr.sqrt(cos_o * cos_o * (1 - a2) + a2))
        one = (self.f0 + (self.f90 - self.f0) * schlick) * region

        e1_mean = min(self.mean[0] + self.mean[1], 1.0)
        f_mean = self.f0 + (self.f90 - self.f0) / 21
        fm = f_mean * f_mean * e1_mean / (1 - f_mean * (1 - e1_mean))
        lost_mean = max(1 - e1_mean, 0.01)

        def passed(weights):
            return 1 - fm - (self.f0 - fm) * weights[0] - (self.f90 - fm) * weights[1]

        at_i, at_o = self.facet_albedo(cos_i), self.facet_albedo(cos_o)
        several = fm * (1 - at_i[0] - at_i[1]) * (1 - at_o[0] - at_o[1]) / (math.pi * lost_mean)
        base = self.albedo / math.pi * dr.maximum(passed(at_o), 0) * passed(at_i) / dr.maximum(
            passed(self.mean), 0.1)
        return one + dr.maximum(several + base, 0)

    def density(self, i, o):
        half = dr.normalize(i + o)
        by_regions = self.regions.pdf(o, half) / (4 * dr.dot(o, half)) if self.region_fraction else 0
        return (self.region_fraction * by_regions +
                (1 - self.region_fraction) * mitsuba.warp.square_to_cosine_hemisphere_pdf(i))

    def sample(self, context, interaction, sample1, sample2, active=True):
        o = interaction.wi
        normal, _ = self.regions.sample(o, sample2)
        by_region = mitsuba.reflect(o, normal)
        i = dr.select(sample1 < self.region_fraction, by_region,
                      mitsuba.warp.square_to_cosine_hemisphere(sample2))
        active &= (mitsuba.Frame3f.cos_theta(o) > 0) & (mitsuba.Frame3f.cos_theta(i) > 0)
        made = mitsuba.BSDFSample3f()
        made.wo, made.pdf, made.eta = i, self.density(i, o), 1.0
        made.sampled_type, made.sampled_component = mitsuba.UInt32(+self.m_flags), 0
        active &= made.pdf > 0
        value = self.f(i, o) * mitsuba.Frame3f.cos_theta(i) / made.pdf
        return made, dr.select(active, value, 0)

    def eval(self, context, interaction, i, active=True):
        o = interaction.wi
        active &= (mitsuba.Frame3f.cos_theta(o) > 0) & (mitsuba.Frame3f.cos_theta(i) > 0)
        return dr.select(active, self.f(i, o) * mitsuba.Frame3f.cos_theta(i), 0)

    def pdf(self, context, interaction, i, active=True):
        o = interaction.wi
        active &= (mitsuba.Frame3f.cos_theta(o) > 0) & (mitsuba.Frame3f.cos_theta(i) > 0)
        return dr.select(active, self.density(i, o), 0)

    def eval_pdf(self, context, interaction, i, active=True):
        return self.eval(context, interaction, i, active), self.pdf(context, interaction, i, active)

    def to_string(self):
        return f"Coat[alpha={self.alpha}]"


mitsuba.register_bsdf("gltf_coat", Coat)


def material(mesh):
    """glTF's metallic-roughness model; single-sided materials reflect on their front only."""
    colour, metal = np.array(mesh.reflectance), mesh.metallic
    f0 = metal * colour + (1 - metal) * 0.04 * mesh.specular
    coat = {"type": "gltf_coat", "alpha": mesh.roughness ** 2,
            "albedo": mitsuba.ScalarColor3f((1 - metal) * colour), "f0": mitsuba.ScalarColor3f(f0),
            "f90": float(metal + (1 - metal) * mesh.specular)}
    return mitsuba.load_dict({"type": "twosided", "bsdf": coat} if mesh.double_sided else coat)


def pictures(scene, paths):
    """Independent pictures by Mitsuba, which share out the paths of a pixel."""
    width, height = (int(side) for side in SIZE.split("x"))
    meshes, view = read_gltf(scene, diffuse=False)
    seen = quality_mitsuba.seen_scene(
        [quality_mitsuba.mitsuba_mesh(mesh, material(mesh)) for mesh in meshes], view, width, height)
    method = mitsuba.load_dict({"type": "path", "max_depth": -1})
    return [np.array(mitsuba.render(seen, integrator=method, spp=min(paths, PATHS_AT_A_TIME), seed=seed),
                     dtype=np.float64) for seed in range(max(2, paths // PATHS_AT_A_TIME))]


def tile_means(found):
    """Of each picture, (pictures, rows, columns): luminance means of tiles of 16x16 pixels."""
    light = np.array(found) @ picture_error.LUMINANCE
    count, height, width = light.shape
    return light.reshape(count, height // TILE, TILE, width // TILE, TILE).mean(axis=(2, 4))


def mean_and_error(values):
    return np.mean(values, axis=0), np.std(values, axis=0, ddof=1) / math.sqrt(len(values))


def compared(own, rival):
    """A row: ratio of means where no lamp is seen, its standard error, and how many of its standard
    errors a tile's difference has, root mean square."""
    seen = picture_error.without_lamps(path_references.mean_and_noise(rival)[0])
    (mine, error), (other, other_error) = (
        mean_and_error([picture[seen].mean() for picture in found]) for found in (own, rival))
    (tiles, errors), (other_tiles, other_errors) = (
        mean_and_error(tile_means(found)) for found in (own, rival))
    deviations = (tiles - other_tiles) / np.hypot(errors, other_errors)
    return (f"{mine / other:.4f} | {mine / other * math.hypot(error / mine, other_error / other):.4f} | "
            f"{math.sqrt(np.mean(deviations**2)):.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=pathlib.Path, nargs="+", metavar="SCENE.gltf")
    parser.add_argument("--references", type=pathlib.Path, required=True, metavar="FOLDER",
                        help="photile's paths, as for gloss.py")
    parser.add_argument("--paths", type=int, default=1024, help="of a pixel")
    parser.add_argument("--photile", type=pathlib.Path, metavar="COMMAND",
                        default=scene_arguments.ROOT / "build/release/photile")
    given = parser.parse_args()
    print("| | photile's mean / Mitsuba's | standard error | rms of tiles, in standard errors |")
    print("|---|--:|--:|--:|")
    for scene in given.scenes:
        own = path_references.pictures(given.photile, scene, SIZE, given.paths, given.references)
        print(f"| {scene.stem} | {compared(own, pictures(scene, given.paths))} |", flush=True)


if __name__ == "__main__":
    main()
