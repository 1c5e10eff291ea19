"""Reads triangles, diffuse colours and the camera of a glTF 2.0 file, for renderers that cannot.

Knows flat, untextured meshes of one primitive at the root of the scene, opaque unless the caller asks for all
materials, cameras and one binary file. Raises ValueError where a file has more, so that no renderer gets another scene than
photile.
"""

import dataclasses
import json

import numpy as np

TYPES = {5126: np.float32, 5125: np.uint32, 5123: np.uint16}  # by componentType
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
TRANSFORM = {"matrix", "translation", "rotation", "scale", "children"}


@dataclasses.dataclass
class Mesh:
    """Metres, reflectance from 0 to 1, radiance of the front in cd/m2 (Rec.709)."""

    name: str
    positions: np.ndarray  # (vertices, 3)
    triangles: np.ndarray  # (triangles, 3) indices, counter-clockwise from the front
    reflectance: list
    radiance: list
    double_sided: bool
    metallic: float = 0
    roughness: float = 1
    specular: float = 0  # of dielectrics: 0 is diffuse, 1 reflects 4%
    index: float = 0  # of refraction, of solid glass
    normals: np.ndarray | None = None  # (vertices, 3), of solid glass and of metals


@dataclasses.dataclass
class View:
    to_world: np.ndarray  # (4, 4), columns are axes; the camera looks along -z
    vertical_field_of_view: float  # radians


def read_accessor(file, binary, index):
    accessor = file["accessors"][index]
    view = file["bufferViews"][accessor["bufferView"]]
    if "byteStride" in view or accessor["componentType"] not in TYPES:
        raise ValueError(f"accessor {index}: only packed floats and 16 or 32-bit indices are read")
    columns = COMPONENTS[accessor["type"]]
    first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    values = np.frombuffer(binary, TYPES[accessor["componentType"]], accessor["count"] * columns,
                           first)
    return values.reshape(-1, columns)


def read_mesh(file, binary, node, diffuse):
    (primitive,) = file["meshes"][node["mesh"]]["primitives"]
    material = file["materials"][primitive["material"]]
    surface, extensions = material["pbrMetallicRoughness"], material.get("extensions", {})
    specular = extensions.get("KHR_materials_specular", {}).get("specularFactor", 1)
    metallic, textures = surface.get("metallicFactor", 1), {key for key in surface if "Texture" in key}
    if textures or (diffuse and (metallic != 0 or specular != 0)):
        raise ValueError(f"material {material.get('name')}: not of one {'diffuse ' * diffuse}colour")
    transmission = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
    if diffuse and transmission != 0:
        raise ValueError(f"material {material.get('name')}: not opaque")
    strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    return Mesh(name=node.get("name", ""),
                positions=read_accessor(file, binary, primitive["attributes"]["POSITION"]),
                triangles=read_accessor(file, binary, primitive["indices"])
                .reshape(-1, 3).astype(np.uint32),
                reflectance=surface.get("baseColorFactor", [1, 1, 1, 1])[:3],
                radiance=[strength * value for value in material.get("emissiveFactor", [0, 0, 0])],
                double_sided=material.get("doubleSided", False), metallic=metallic,
                roughness=surface.get("roughnessFactor", 1), specular=specular,
                index=extensions.get("KHR_materials_ior", {}).get("ior", 1.5) if transmission else 0,
                normals=None if diffuse else read_accessor(file, binary, primitive["attributes"]["NORMAL"]))


def matrix_of(node):
    """(4, 4) of a node without scale."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    matrix = np.eye(4)
    matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def read_gltf(path, diffuse=True, camera_name=None):
    """(list of Mesh, View) of the file, which must be diffuse throughout unless told otherwise. The view is that of the
    first camera, or of the first of this name."""
    file = json.loads(path.read_text(encoding="utf-8"))
    (buffer,) = file["buffers"]
    binary = (path.parent / buffer["uri"]).read_bytes()
    meshes, views = [], []
    for index in file["scenes"][file.get("scene", 0)]["nodes"]:
        node = file["nodes"][index]
        if "mesh" in node and not TRANSFORM & set(node):
            meshes.append(read_mesh(file, binary, node, diffuse))
        elif "camera" in node:
            if camera_name not in (None, node.get("name")):
                continue
            camera = file["cameras"][node["camera"]]["perspective"]
            views.append(View(matrix_of(node), camera["yfov"]))
        else:
            raise ValueError(f"node {index}: neither a mesh without transform nor a camera")
    return meshes, views[0]
