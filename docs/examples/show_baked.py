"""Opens what `photile bake` wrote in Blender 3.4 or later: surfaces glow with their baked light.

    blender --python docs/examples/show_baked.py -- baked.gltf

Each material becomes base colour x irradiance / pi as emission, the sum of the light's pictures, looked
up by the second UV set. Faces that look away are clear, as glTF has it: of a surface that is lit on both
sides there are two, which are moved to where they are seen from, for Cycles passes over one of two faces in
one place.
"""

import json
import math
import pathlib
import sys

import bpy
import numpy

if "bool" not in vars(numpy):  # Debian 12's importer asks for it, its numpy no longer has it
    numpy.bool = bool

APART = 5e-5  # metres


def new_node(tree, kind, **settings):
    node = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(node, name, value)
    return node


def light_of(tree, images):
    """Irradiance of all lights: the socket of a colour."""
    place = new_node(tree, "ShaderNodeUVMap", uv_map="UVMap.001")
    total = None
    for image in images:
        texture = new_node(tree, "ShaderNodeTexImage", image=image, extension="EXTEND")
        tree.links.new(place.outputs["UV"], texture.inputs["Vector"])
        if total is None:
            total = texture.outputs["Color"]
            continue
        both = new_node(tree, "ShaderNodeVectorMath", operation="ADD")
        tree.links.new(total, both.inputs[0])
        tree.links.new(texture.outputs["Color"], both.inputs[1])
        total = both.outputs["Vector"]
    return total


def base_colour(tree):
    """What the importer made the base colour of: a socket, or a constant."""
    for node in tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            socket = node.inputs["Base Color"]
            return socket.links[0].from_socket if socket.is_linked else tuple(socket.default_value)
    return (1.0, 1.0, 1.0, 1.0)


def glow(material, images):
    tree = material.node_tree
    colour = base_colour(tree)
    for node in [each for each in tree.nodes if each.type == "OUTPUT_MATERIAL"]:
        tree.nodes.remove(node)
    reflected = new_node(tree, "ShaderNodeVectorMath", operation="MULTIPLY")
    tree.links.new(light_of(tree, images), reflected.inputs[0])
    if isinstance(colour, tuple):
        reflected.inputs[1].default_value = colour[:3]
    else:
        tree.links.new(colour, reflected.inputs[1])
    emission = new_node(tree, "ShaderNodeEmission")
    emission.inputs["Strength"].default_value = 1 / math.pi
    tree.links.new(reflected.outputs["Vector"], emission.inputs["Color"])
    sides = new_node(tree, "ShaderNodeMixShader")
    tree.links.new(new_node(tree, "ShaderNodeNewGeometry").outputs["Backfacing"], sides.inputs["Fac"])
    tree.links.new(emission.outputs["Emission"], sides.inputs[1])
    tree.links.new(new_node(tree, "ShaderNodeBsdfTransparent").outputs["BSDF"], sides.inputs[2])
    tree.links.new(sides.outputs["Shader"],
                   new_node(tree, "ShaderNodeOutputMaterial").inputs["Surface"])


def part_sides(mesh):
    """No two faces share a vertex."""
    count = len(mesh.vertices)
    positions = numpy.empty(3 * count, dtype=numpy.float32)
    mesh.vertices.foreach_get("co", positions)
    corners = numpy.empty(len(mesh.loops), dtype=numpy.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    positions, corners = positions.reshape(-1, 3), corners.reshape(-1, 3)
    a, b, c = (positions[corners[:, i]].astype(float) for i in range(3))
    normals = numpy.cross(b - a, c - a)
    normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    for i in range(3):
        positions[corners[:, i]] += (APART * normals).astype(numpy.float32)
    mesh.vertices.foreach_set("co", positions.ravel())
    mesh.update()


def document_of(baked):
    """The JSON of a .gltf or a .glb."""
    content = baked.read_bytes()
    if content[:4] == b"glTF":  # the first chunk, by its length
        content = content[20:20 + int.from_bytes(content[12:16], "little")]
    return json.loads(content)


def show(baked):
    """Replaces what is open by the baked room."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(baked))
    document = document_of(baked)
    images = []
    for layer in document["scenes"][0]["extras"]["photile"]["light_maps"]:
        image = bpy.data.images.load(str(baked.parent / layer["uri"]))
        image.colorspace_settings.name = "Non-Color"  # linear, and no bytes of a colour
        images.append(image)
    for mesh in bpy.data.meshes:
        part_sides(mesh)
    for material in bpy.data.materials:
        glow(material, images)


if __name__ == "__main__":
    show(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).resolve())
