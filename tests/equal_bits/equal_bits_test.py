#!/usr/bin/python3
"""Whatever a picture is made of and however it is made, a seed gives the same bits.

    equal_bits_test.py PHOTILE [MPIEXEC]

Each kind of picture is rendered once as it comes, and then in ways that must not change it: on other numbers
of threads, parts of a device, processes, with little memory, from saved photons, with surfaces wound the other way
round, lamps of twice the power, or its errors stated. Not all ways can be combined with all; of those that can, every
two values of two factors are combined at least once.
"""

import itertools
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

KINDS = {
    "light maps": ["--quality", "draft"],
    "nodes that gather": ["--set", "light_map_rays=8"],
    "estimates at hits": ["--quality", "draft", "--set", "light_maps=off"],
    "gloss that is not filtered": ["--quality", "draft", "--set", "gloss=rays"],
    "maps by triangle": ["--quality", "draft", "--set", "light_maps=off", "--set", "maps=triangle"],
    "maps by patch": ["--quality", "draft", "--set", "light_maps=off", "--set", "maps=patch"],
    "naive maps": ["--quality", "draft", "--set", "light_maps=off", "--set", "maps=naive"],
    "two passes": ["--quality", "draft", "--set", "light_maps=off", "--set", "passes=2"],
    "paths": ["--integrator", "path"],
}
WAYS = {
    "lights": [2, 40],  # 40 are kept in the sparse form
    "threads": [1, 2, 3],
    "device": ["whole", "halves", "little memory"],
    "processes": [0, 1, 3],  # 0: without mpiexec
    "photons": ["traced", "saved", "loaded", "traced by themselves"],
    "winding": ["consistent", "inconsistent"],
    "power": [1, 2],
    "errors": ["not stated", "stated"],
}
USUAL = {way: values[0] for way, values in WAYS.items()}
PICTURE = ["--size", "32x24", "--samples", "4", "--eye", "0.3,1.7,0.3", "--look-at", "2,0.5,2.1"]
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
       "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_btl": "self,vader", "OMPI_MCA_plm": "isolated"}


def possible(case):
    """Whether the program offers this combination."""
    kind, alone = case["kind"], case["processes"] == 0
    others = case["photons"] != "traced"
    if kind == "paths" and (case["device"] != "whole" or not alone or others):
        return False
    if others and (kind == "two passes" or not alone):
        return False
    if case["errors"] == "stated" and (kind != "nodes that gather" or others or not alone):
        return False
    if case["lights"] > 2 and kind not in ("light maps", "nodes that gather", "estimates at hits"):
        return False
    if case["device"] == "halves" and case["threads"] == 1:
        return False
    return alone or case["device"] == "whole"


def reference_of(case):
    """The way to make the picture that this one has to equal. Of several processes that estimate at hits, each adds the
    light of its own maps: their sums are rounded otherwise than those of a program without mpiexec."""
    hits = "light_maps=off" in KINDS[case["kind"]]
    return dict(USUAL, kind=case["kind"], lights=case["lights"],
                processes=1 if case["processes"] and hits else 0)


def pairwise():
    """Cases that have every possible pair of values between them: the best of some drawn ones, again and again."""
    factors = {"kind": list(KINDS), **WAYS}
    cases = [case for values in itertools.product(*factors.values())
             if possible(case := dict(zip(factors, values)))]

    def pairs(case):
        return set(itertools.combinations(case.items(), 2))

    lacking = set().union(*map(pairs, cases))
    draw, chosen = random.Random(1), []
    while lacking:
        pair = min(lacking, key=repr)
        fitting = [case for case in cases if set(pair) <= set(case.items())]
        best = max(draw.sample(fitting, min(60, len(fitting))), key=lambda case: len(pairs(case) & lacking))
        chosen.append(best)
        lacking -= pairs(best)
    return chosen


def scene(lights, winding):
    """A room with glossy walls, a mirror and glass, and a board of two materials."""
    draw, lines, count = random.Random(7), ["mtllib room.mtl"], 0

    def quad(material, a, u, v, steps=1, keep=False):
        nonlocal count
        lines.append(f"usemtl {material}")
        for i, j in itertools.product(range(steps), repeat=2):
            for s, t in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                lines.append("v " + " ".join(f"{p + q * s / steps + r * t / steps:.6g}" for p, q, r in zip(a, u, v)))
            corners = [count + k for k in (1, 2, 3, 4)]
            if winding == "inconsistent" and not keep and draw.random() < 0.5:
                corners.reverse()
            lines.append("f " + " ".join(map(str, corners)))
            count += 4

    def box(material, low, size, steps, keep=False):
        for axis in range(3):
            u, v = [0, 0, 0], [0, 0, 0]
            u[(axis + 1) % 3], v[(axis + 2) % 3] = size[(axis + 1) % 3], size[(axis + 2) % 3]
            quad(material, low, v, u, steps, keep)
            quad(material, [p + (size[axis] if k == axis else 0) for k, p in enumerate(low)], u, v, steps, keep)

    box("wall", [0, 0, 0], [3, 3, 3], 6)
    # Where two materials lie in one place, the winding says which of them counts on either side.
    quad("carpet", [1, 0.1, 1], [0, 0, 1], [1, 0, 0], 3, keep=True)
    quad("wall", [1, 0.1, 1], [1, 0, 0], [0, 0, 1], 3, keep=True)
    box("glass", [0.5, 0.4, 0.5], [0.5, 0.5, 0.5], 1, keep=True)
    box("mirror", [1.5, 0.2, 0.4], [0.5, 0.8, 0.9], 1)
    for i in range(lights):
        lines.append(f"o lamp{i}")
        quad("lamp", [0.2 + 2.5 * i / lights, 2.9, 1], [1 / lights, 0, 0], [0, 0, 0.5], keep=True)
    return "\n".join(lines) + "\n"


MATERIALS = """newmtl wall\nKd 0.6 0.5 0.4\nKs 0.1 0.1 0.1\nNs 30\nillum 2\nnewmtl carpet\nKd 0.3 0.1 0.1
newmtl glass\nillum 7\nNi 1.5\nnewmtl mirror\nKd 0 0 0\nKs 0.9 0.9 0.9\nNs 1000\nillum 3\nnewmtl lamp\nKd 0 0 0\nKe 10 9 8\n"""


class Pictures:
    def __init__(self, photile, mpiexec, folder):
        self.photile, self.mpiexec, self.folder, self.references = photile, mpiexec, folder, {}
        for name, winding in (("room", "consistent"), ("rewound", "inconsistent")):
            for lights in WAYS["lights"]:
                (folder / f"{name}{lights}.obj").write_text(scene(lights, winding))
        (folder / "room.mtl").write_text(MATERIALS)

    def run(self, case, command, *options):
        start = [self.mpiexec, "-n", str(case["processes"])] if case["processes"] else []
        name = "room" if case["winding"] == "consistent" else "rewound"
        words = [*start, self.photile, command, f"{name}{case['lights']}.obj", "--seed", "3", "-q", *options]
        environment = os.environ | MPI | ({"PHOTILE_DEVICE": "0:0/2"} if case["device"] == "halves" else {})
        done = subprocess.run(words, cwd=self.folder, env=environment, text=True, capture_output=True, check=False)
        if done.returncode != 0:
            sys.exit(f"equal_bits_test.py: error: {words}: {done.stderr}")

    def render(self, case):
        """Names and values of the channels."""
        options = [*KINDS[case["kind"]], *PICTURE, "--threads", str(case["threads"]), "-o", "a.exr"]
        photons = [] if case["kind"] == "paths" else ["--photons", "10k"]
        if case["device"] == "little memory":
            options += ["--set", "device_memory=0.002"]
        if case["power"] == 2:
            options += ["--light", "*=x2"]
        if case["errors"] == "stated":
            options += ["--errors", "errors.exr"]
        if case["photons"] in ("saved", "loaded"):
            self.run(case, "render", *options, *photons, "--save-maps", "maps")
        if case["photons"] == "loaded":
            options += ["--load-maps", "maps"]
        if case["photons"] == "traced by themselves":
            self.run(case, "trace", "-o", "photons", *photons)
            options += ["--load-maps", "photons"]
        if case["photons"] != "saved":
            self.run(case, "render", *options, *photons)
        picture = oiio.ImageBuf(str(self.folder / "a.exr"))
        values = picture.get_pixels(oiio.FLOAT)
        oiio.ImageCache().invalidate_all(True)
        names = picture.spec().channelnames
        values[..., [name != "A" for name in names]] /= case["power"]  # by a power of two: exactly
        return names, values

    def reference(self, case):
        if repr(case) not in self.references:
            self.references[repr(case)] = self.render(case)
        return self.references[repr(case)]

    def check(self, case):
        """What is wrong with the picture of a case, or ""."""
        reference = reference_of(case)
        names, expected = self.reference(reference)
        found_names, found = self.render(case)
        if found_names != names:
            return f"other channels: {found_names}"
        if not expected.max() > 0:
            return "the picture is black"
        if reference["processes"]:
            alone = self.reference(dict(reference, processes=0))[1]
            if not np.allclose(expected, alone, rtol=1e-4, atol=1e-6 * alone.max()):
                return "the light of processes is not that of one program"
        differing = np.argwhere(found != expected)
        return f"{len(differing)} of {found.size} values differ, the first at {differing[0]}" if len(differing) else ""


def main():
    photile, mpiexec = os.path.realpath(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else None
    if mpiexec is None:
        WAYS["processes"] = [0]
    failures, cases = 0, pairwise()
    with tempfile.TemporaryDirectory() as name:
        pictures = Pictures(photile, mpiexec, pathlib.Path(name))
        for case in cases:
            wrong = pictures.check(case)
            if wrong:
                failures += 1
                print({way: value for way, value in case.items() if value != USUAL.get(way)}, wrong)
        other = pictures.reference(dict(USUAL, kind="light maps"))[1]
        pictures.run(dict(USUAL), "render", *KINDS["light maps"], *PICTURE, "--photons", "10k", "-o", "a.exr", "--light",
                     "*=x2")
        if np.array_equal(oiio.ImageBuf(str(pathlib.Path(name) / "a.exr")).get_pixels(oiio.FLOAT), other):
            failures += 1
            print("another power gives the same picture: what is compared shows no difference")
    if failures:
        sys.exit(f"equal_bits_test.py: error: {failures} of {len(cases)} pictures have other bits")
    print(f"{len(cases)} pictures have the bits of {len(pictures.references)}")


main()
