"""Copies of glTF scenes that Radiance can have, too: diffuse, without textures and lamps without size."""

import json
import shutil

import numpy as np

from gltf_meshes import matrix_of, read_accessor

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
    return target


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


def write_radiance_scene(gltf, target):
    """The scene as Radiance's text. Radiances keep their numbers: cd/m2 with Rec.709 primaries stand
    for W/(m2 sr), so that 0.2126 R + 0.7152 G + 0.0722 B of an irradiance is lux."""
    with open(target, "w", encoding="utf-8") as out:
        for number, (material, corners) in enumerate(surfaces(gltf)):
            name = f"m{number}"
            out.write(material_text(name, material))
            areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
            for index in np.nonzero(areas > 0)[0]:
                out.write(f"{name} polygon {name}.{index}\n0\n0\n9 {number_list(corners[index].ravel())}\n")
