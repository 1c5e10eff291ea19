"""Copies of glTF scenes that Radiance can have, too: diffuse, without textures and lamps without size. Lamps that emit
by a picture emit evenly, as much in all."""

import json
import shutil

import numpy as np

from tools.gltf_meshes import matrix_of, read_accessor

LUMINANCE = (0.2126, 0.7152, 0.0722)  # of Rec.709 primaries
TEXTURED = [0.4, 0.4, 0.4, 1]  # in place of textures
SHINY = [0.5, 0.5, 0.5, 1]  # in place of metals


def plain_material(material):
    """The same material, diffuse and of one colour."""
    surface = material["pbrMetallicRoughness"]
    colour = surface.get("baseColorFactor", [1, 1, 1, 1])
    if surface.get("metallicFactor", 1) > 0:
        colour = SHINY
    if any("Texture" in key for key in surface):
        colour = TEXTURED
    extensions = {**material.get("extensions", {}), "KHR_materials_specular": {"specularFactor": 0}}
    return {**{key: value for key, value in material.items() if "Texture" not in key},
            "extensions": extensions,
            "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0, "roughnessFactor": 1}}


def write_plain_gltf(source, folder):
    """Writes the copy of a glTF file into `folder`, which has to exist; returns its path."""
    file = json.loads(source.read_text(encoding="utf-8"))
    file["materials"] = [plain_material(material) for material in file["materials"]]
    for scene in file["scenes"]:
        scene["nodes"] = [node for node in scene["nodes"] if {"mesh", "camera"} & set(file["nodes"][node])]
    for key in ("textures", "images", "samplers"):
        file.pop(key, None)
    for item in (file, *file["nodes"]):
        item.get("extensions", {}).pop("KHR_lights_punctual", None)
        if item.get("extensions") == {}:
            del item["extensions"]
    file["extensionsUsed"] = ["KHR_materials_emissive_strength", "KHR_materials_specular"]
    for buffer in file["buffers"]:
        shutil.copy(source.parent / buffer["uri"], folder)
    target = folder / source.name
    target.write_text(json.dumps(file), encoding="utf-8")
    make_lamps_even(file, target)
    target.write_text(json.dumps(file), encoding="utf-8")
    return target


def make_lamps_even(file, gltf):
    """Gives lamps whose node tells their lumens the even radiance that these come from; `gltf` is the plain file."""
    areas = {}
    for material, corners in surfaces(gltf):
        edges = corners[:, 1:] - corners[:, :1]
        area = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum()
        areas[material["name"]] = areas.get(material["name"], 0) + area
    for node in file["nodes"]:
        lumen = node.get("extras", {}).get("photile_lumens")
        if lumen is None:
            continue
        for primitive in file["meshes"][node["mesh"]]["primitives"]:
            material = file["materials"][primitive["material"]]
            luminance = np.dot(LUMINANCE, material.get("emissiveFactor", (0, 0, 0)))
            if luminance > 0:
                strength = lumen / (np.pi * areas[material["name"]]) / luminance
                material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}


def surfaces(gltf):
    """(material, corners of triangles of shape (n, 3, 3), metres) of each primitive of a plain glTF file.
    Raises ValueError where nodes have children or a scale, which no bundled scene's have."""
    file = json.loads(gltf.read_text(encoding="utf-8"))
    (buffer,) = file["buffers"]
    binary = (gltf.parent / buffer["uri"]).read_bytes()
    for index in file["scenes"][file.get("scene", 0)]["nodes"]:
        node = file["nodes"][index]
        if {"children", "scale"} & set(node):
            raise ValueError(f"{gltf}: node {index}: children and scales are not read")
        matrix = matrix_of(node)
        for primitive in file["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            positions = read_accessor(file, binary, primitive["attributes"]["POSITION"]).astype(float)
            corners = positions[read_accessor(file, binary, primitive["indices"]).ravel()].reshape(-1, 3, 3)
            yield file["materials"][primitive["material"]], corners @ matrix[:3, :3].T + matrix[:3, 3]


def number_list(values):
    return " ".join(f"{value:.9g}" for value in values)


def material_text(name, material):
    strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    radiance = [strength * value for value in material.get("emissiveFactor", (0, 0, 0))]
    if max(radiance) > 0:  # from the front alone, as in glTF
        return f"void light {name}\n0\n0\n3 {number_list(radiance)}\n"
    colour = material["pbrMetallicRoughness"]["baseColorFactor"][:3]
    return f"void plastic {name}\n0\n0\n5 {number_list(colour)} 0 0\n"


def joined(first, second):
    """The quadrangle of two triangles in one plane that share an edge, corners in order, or None."""
    shared = [index for index in range(3) if any(np.allclose(first[index], corner) for corner in second)]
    own = [corner for corner in second if not any(np.allclose(corner, other) for other in first)]
    normals = [np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0]) for triangle in (first, second)]
    lengths = [np.linalg.norm(normal) for normal in normals]
    if len(shared) != 2 or len(own) != 1 or np.dot(*normals) < (1 - 1e-6) * lengths[0] * lengths[1]:
        return None
    after = shared[0] if shared[1] - shared[0] == 1 else shared[1]  # the corner before the shared edge's end
    return np.insert(first, after + 1, own[0], axis=0)


def lamp_polygons(corners):
    """Triangles, pairs of neighbours joined: rtrace samples rectangles of lamps well, and triangles badly."""
    polygons, index = [], 0
    while index < len(corners):
        quadrangle = joined(corners[index], corners[index + 1]) if index + 1 < len(corners) else None
        polygons.append(corners[index] if quadrangle is None else quadrangle)
        index += 1 if quadrangle is None else 2
    return polygons


def write_radiance_scene(gltf, target):
    """The scene as Radiance's text. Radiances keep their numbers: cd/m2 with Rec.709 primaries stand
    for W/(m2 sr), so that 0.2126 R + 0.7152 G + 0.0722 B of an irradiance is lux."""
    with open(target, "w", encoding="utf-8") as out:
        for number, (material, corners) in enumerate(surfaces(gltf)):
            name, text = f"m{number}", material_text(f"m{number}", material)
            out.write(text)
            areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
            polygons = list(corners[areas > 0])
            for index, polygon in enumerate(lamp_polygons(polygons) if "light" in text else polygons):
                out.write(f"{name} polygon {name}.{index}\n0\n0\n{polygon.size} {number_list(polygon.ravel())}\n")
