#!/usr/bin/python3
"""bench/rivals/radiance.py: errors, the page, and the scene as Radiance reads it."""

import json
import math
import pathlib
import sys
import tempfile
import unittest

from records import ROOT
try:
    import numpy as np
    from rivals import radiance
    from rivals.radiance_scene import plain_material, write_plain_gltf, write_radiance_scene
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


def light_flux(text):
    """Lumens of all lamps of Radiance's text: pi x area x luminance."""
    flux, luminance = 0, {}
    for entry in text.split("void ")[1:]:
        head, *polygons = entry.split(" polygon ")
        kind, name, *words = head.split()
        if kind == "light":
            luminance[name] = np.dot([float(word) for word in words[3:6]], radiance.LUMINANCE)
            for polygon in polygons:
                values = polygon.split()[3:]  # how many, and these
                corners = np.array(values[1:1 + int(values[0])], dtype=float).reshape(-1, 3)
                area = np.linalg.norm(sum(np.cross(b - corners[0], c - corners[0])
                                          for b, c in zip(corners[1:], corners[2:]))) / 2
                flux += math.pi * area * luminance[name]
    return flux


class Scene(unittest.TestCase):
    def written(self, name):
        """Of a bundled scene, Radiance's text, and glTF without what Radiance has not."""
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        gltf = write_plain_gltf(ROOT / f"scenes/{name}/{name}.gltf", folder)
        write_radiance_scene(gltf, folder / "scene.rad")
        return (folder / "scene.rad").read_text(), json.loads(gltf.read_text())

    def test_the_cornell_box_has_its_triangles_and_lumens(self):
        text, _ = self.written("cornell-box")
        self.assertEqual(text.count(" polygon "), 37)  # the lamp is one
        self.assertAlmostEqual(light_flux(text), 1000, delta=1)

    def test_the_living_room_loses_textures_metals_and_the_spot_alone(self):
        text, copy = self.written("living-room")
        self.assertLess(text.count(" polygon "), 62368)
        self.assertAlmostEqual(light_flux(text), 1200 + 1600 + 1050 + 400 + 400 + 470, delta=20)
        self.assertNotIn("Texture", json.dumps(copy["materials"]))
        self.assertNotIn("KHR_lights_punctual", json.dumps(copy))

    def test_a_metal_becomes_grey_and_diffuse(self):
        surface = plain_material({"pbrMetallicRoughness": {"metallicFactor": 1}})["pbrMetallicRoughness"]
        self.assertEqual((surface["metallicFactor"], surface["baseColorFactor"]), (0, [0.5, 0.5, 0.5, 1]))


class Errors(unittest.TestCase):
    def test_errors_are_relative_root_mean_squares(self):
        found = radiance.figures(np.array([[110.0, 180.0], [100.0, 200.0]]), np.array([100.0, 200.0]))
        self.assertAlmostEqual(found["error"], math.sqrt((0.1**2 + 0.1**2) / 4))
        self.assertAlmostEqual(found["largest"], 0.1)
        self.assertAlmostEqual(found["mean"], 147.5 / 150)

    def test_runs_of_the_reference_are_averaged(self):
        lux, error = radiance.truth_of({"references": [{"lux": [100], "standard_error": [3]},
                                                       {"lux": [102], "standard_error": [4]}]})
        self.assertEqual((lux[0], error[0]), (101, 2.5))

    def test_the_page_says_what_was_not_reached_and_what_is_missing(self):
        rows = [{"tool": "rtrace", "setting": "-ab 3", "seconds": seconds, "error": error, "largest": 0.1, "mean": 1.01}
                for seconds, error in ((2.0, 0.04), (1.0, 0.06), (3.0, 0.015))]
        page = radiance.page({"cores": 2, "processor": "P", "load_average": 0.5, "radiance": "R", "scenes": {
            "Cornell box": {"points": 2, "rows": rows,
                            "references": [{"lux": [100, 200], "standard_error": [1, 2]}]}}})
        self.assertIn("| rtrace | 2 s | 3 s | not reached |", page)
        self.assertIn("the reference's own error is 1.00%", page)
        self.assertIn("Not measured: mkpmap, rtrace `-apg 50k; ", page)


if __name__ == "__main__":
    unittest.main()
