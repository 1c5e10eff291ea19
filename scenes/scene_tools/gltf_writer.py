"""glTF 2.0 files: one .gltf of JSON and one .bin of vertices beside it."""

import json
import math
import struct

from scene_tools.colour import luminance
from scene_tools.shapes import cross, normalised

FLOAT, UNSIGNED_SHORT = 5126, 5123  # component types of glTF


def rounded(values, digits=6):
    return [round(v, digits) for v in values]


def looking_along(direction):
    """Rotation quaternion (x, y, z, w) that turns -z to `direction` and keeps y upwards."""
    back = normalised([-c for c in direction])
    up_hint = (0.0, 1.0, 0.0) if abs(back[1]) < 0.999 else (0.0, 0.0, -1.0)
    right = normalised(cross(up_hint, back))
    up = cross(back, right)
    m = [[right[i], up[i], back[i]] for i in range(3)]  # columns: images of x, y, z
    w = math.sqrt(max(0.0, 1 + m[0][0] + m[1][1] + m[2][2])) / 2
    x = math.copysign(math.sqrt(max(0.0, 1 + m[0][0] - m[1][1] - m[2][2])) / 2, m[2][1] - m[1][2])
    y = math.copysign(math.sqrt(max(0.0, 1 - m[0][0] + m[1][1] - m[2][2])) / 2, m[0][2] - m[2][0])
    z = math.copysign(math.sqrt(max(0.0, 1 - m[0][0] - m[1][1] + m[2][2])) / 2, m[1][0] - m[0][1])
    return rounded([x, y, z, w], 9)


class GltfDocument:
    """Collects materials, meshes, lights and cameras; `save` writes them."""

    def __init__(self, title):
        self.buffer = bytearray()
        self.extensions = set()
        self.json = {"asset": {"version": "2.0", "generator": "photile scenes/make_scenes.py"},
                     "scene": 0, "scenes": [{"name": title, "nodes": []}], "nodes": [],
                     "materials": [], "meshes": [], "accessors": [], "bufferViews": []}

    # Materials

    def matte(self, name, rgb, texture=None, normals=None, bumps=1.0):
        """A Lambertian surface; `rgb` is its linear albedo, times the texture where it has one. `normals` is a normal
        map, and `bumps` scales it."""
        return self._surface(name, rgb, 1, texture, normals, bumps, {"KHR_materials_specular": {"specularFactor": 0}})

    def glossy(self, name, rgb, roughness, texture=None, normals=None, bumps=1.0):
        """A dielectric of index 1.5 over a Lambertian base; `roughness` as glTF has it."""
        return self._surface(name, rgb, roughness, texture, normals, bumps, {})

    def _surface(self, name, rgb, roughness, texture, normals, bumps, extensions):
        pbr = {"baseColorFactor": [*rounded(rgb), 1], "metallicFactor": 0, "roughnessFactor": roughness}
        if texture is not None:
            pbr["baseColorTexture"] = {"index": self._texture(texture)}
        index = self._material(name, pbr, extensions)
        if normals is not None:
            self.json["materials"][index]["normalTexture"] = {"index": self._texture(normals), "scale": bumps}
        return index

    def metal(self, name, rgb, roughness):
        """A metal that reflects `rgb`; a perfect mirror at roughness 0."""
        return self._material(name, {"baseColorFactor": [*rounded(rgb), 1], "metallicFactor": 1,
                                     "roughnessFactor": roughness}, {})

    def glass(self, name, index):
        return self._material(name, {"metallicFactor": 0, "roughnessFactor": 0},
                              {"KHR_materials_transmission": {"transmissionFactor": 1},
                               "KHR_materials_ior": {"ior": index},
                               "KHR_materials_volume": {"thicknessFactor": 0.1}})

    def pane(self, name, transmittance):
        """Thin glass that lets `transmittance` of what enters through, besides its reflections."""
        return self._material(name, {"baseColorFactor": [transmittance] * 3 + [1],
                                     "metallicFactor": 0, "roughnessFactor": 0},
                              {"KHR_materials_transmission": {"transmissionFactor": 1}})

    def lamp(self, name, lumen, area, rgb, picture=None, mean=1.0):
        """A black surface whose front emits `lumen` in all over `area` square metres.

        `picture` is a texture of its radiance, and `mean` the mean luminance of the texels over that area.
        """
        radiance = lumen / (math.pi * area)  # cd/m2 of luminance, for a Lambertian emitter
        colour = [c / max(rgb) for c in rgb]
        index = self._material(
            name, {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 1},
            {"KHR_materials_specular": {"specularFactor": 0},
             "KHR_materials_emissive_strength":
                 {"emissiveStrength": round(radiance / luminance(colour) / mean, 3)}})
        self.json["materials"][index]["emissiveFactor"] = rounded(colour)
        if picture is not None:
            self.json["materials"][index]["emissiveTexture"] = {"index": self._texture(picture)}
        return index

    def _material(self, name, pbr, extensions):
        self.extensions.update(extensions)
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if extensions:
            material["extensions"] = extensions
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def _texture(self, uri):
        images, textures = self.json.setdefault("images", []), self.json.setdefault("textures", [])
        self.json.setdefault("samplers", [{"wrapS": 10497, "wrapT": 10497}])
        if {"uri": uri} not in images:
            images.append({"uri": uri})
            textures.append({"source": len(images) - 1, "sampler": 0})
        return images.index({"uri": uri})

    # Nodes

    def mesh(self, name, *parts):
        """A mesh of (material, shape) parts; returns its index for `place`."""
        primitives = []
        for material, shape in parts:
            attributes = {"POSITION": self._accessor(shape.positions, "VEC3", FLOAT),
                          "NORMAL": self._accessor(shape.normals, "VEC3", FLOAT)}
            if "Texture" in json.dumps(self.json["materials"][material]):
                attributes["TEXCOORD_0"] = self._accessor(shape.uvs, "VEC2", FLOAT)
            indices = [(i,) for t in shape.triangles for i in t]
            primitives.append({"attributes": attributes, "material": material,
                               "indices": self._accessor(indices, "SCALAR", UNSIGNED_SHORT)})
        self.json["meshes"].append({"name": name, "primitives": primitives})
        return len(self.json["meshes"]) - 1

    def place(self, name, mesh, at=(0, 0, 0), turn=0.0, lumen=None):
        """A node that shows a mesh, moved, and turned by `turn` degrees about y. `lumen` is the flux of all its lamps
        together, to the digit where a texture leaves it to roundings."""
        half = math.radians(turn) / 2
        node = {"name": name, "mesh": mesh}
        if any(at):
            node["translation"] = rounded(at)
        if turn:
            node["rotation"] = rounded([0, math.sin(half), 0, math.cos(half)], 9)
        if lumen is not None:
            node["extras"] = {"photile_lumens": lumen}
        self._node(node)

    def thing(self, name, *parts):
        """A mesh that is shown once, where it stands."""
        self.place(name, self.mesh(name, *parts))

    def camera(self, name, position, target, vertical_degrees, aspect):
        cameras = self.json.setdefault("cameras", [])
        cameras.append({"name": name, "type": "perspective", "perspective": {
            "yfov": round(math.radians(vertical_degrees), 7), "aspectRatio": aspect, "znear": 0.01}})
        direction = [t - p for t, p in zip(target, position)]
        self._node({"name": name, "camera": len(cameras) - 1, "translation": rounded(position),
                    "rotation": looking_along(direction)})

    def spot(self, name, position, target, candela, rgb, inner_degrees, outer_degrees):
        self.extensions.add("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault(
            "KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": "spot", "color": rounded(rgb),
                       "intensity": round(candela / luminance(rgb), 3),
                       "spot": {"innerConeAngle": round(math.radians(inner_degrees), 6),
                                "outerConeAngle": round(math.radians(outer_degrees), 6)}})
        direction = [t - p for t, p in zip(target, position)]
        self._node({"name": name, "translation": rounded(position),
                    "rotation": looking_along(direction),
                    "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})

    def _node(self, node):
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    # Buffers

    def _accessor(self, rows, kind, component):
        letter = {FLOAT: "f", UNSIGNED_SHORT: "H"}[component]
        data = b"".join(struct.pack(f"<{len(row)}{letter}", *row) for row in rows)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.buffer),
                                         "byteLength": len(data)})
        self.buffer += data + b"\0" * (-len(data) % 4)
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component,
                    "count": len(rows), "type": kind}
        if kind == "VEC3":
            stored = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
            accessor["min"] = [min(column) for column in zip(*stored)]
            accessor["max"] = [max(column) for column in zip(*stored)]
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def triangle_count(self):
        """Of all nodes: a mesh shown twice counts twice."""
        return sum(self.json["accessors"][p["indices"]]["count"] // 3
                   for node in self.json["nodes"] if "mesh" in node
                   for p in self.json["meshes"][node["mesh"]]["primitives"])

    def save(self, path):
        binary = path.with_suffix(".bin")
        self.json["buffers"] = [{"uri": binary.name, "byteLength": len(self.buffer)}]
        if self.extensions:
            self.json["extensionsUsed"] = sorted(self.extensions)
        binary.write_bytes(bytes(self.buffer))
        path.write_text(json.dumps(self.json, separators=(",", ":")) + "\n", encoding="utf-8")
        print(f"{path.name}: {self.triangle_count()} triangles, "
              f"{path.stat().st_size + len(self.buffer)} bytes")
