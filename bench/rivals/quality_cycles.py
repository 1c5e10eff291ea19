#!/usr/bin/python3
"""Renders an interior of diffuse surfaces with Blender's Cycles; quality.py runs it once per picture.

    bench/rivals/quality_cycles.py SCENE --size WxH --samples N [--denoise] [--next] --begin SECONDS -o FILE.npy

Path tracing on the processor with its light tree, without clamping or adaptive sampling, nor path guiding,
which takes longer here and errs more; with --denoise its own Open Image Denoise, led by albedo and normals
that are denoised first. The output is that of tools/one_picture.py. Needs the packages bpy, numpy and
OpenImageIO.
"""

import pathlib
import sys
import tempfile

import bpy
import mathutils

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import one_picture, picture_error
from tools.gltf_meshes import read_gltf

DEPTH = 64  # bounces of a path; 1,024 gave the same figures in the kitchen at 64x48


def material(mesh):
    """Reflects, and emits, on the front alone unless it is double-sided."""
    made = bpy.data.materials.new(mesh.name)
    tree = made.node_tree
    tree.nodes.clear()

    def node(kind, *inputs, **values):
        """A node whose first inputs are these outputs of others."""
        added = tree.nodes.new(f"ShaderNode{kind}")
        for place, output in enumerate(inputs):
            tree.links.new(output, added.inputs[place])
        for name, value in values.items():
            added.inputs[name].default_value = value
        return added

    surface = node("BsdfDiffuse", Color=(*mesh.reflectance, 1)).outputs[0]
    if any(mesh.radiance):
        surface = node("AddShader", surface,
                       node("Emission", Color=(*mesh.radiance, 1)).outputs[0]).outputs[0]
    if not mesh.double_sided:
        behind = node("NewGeometry").outputs["Backfacing"]
        surface = node("MixShader", behind, surface).outputs[0]  # with nothing, which is black
        made.cycles.emission_sampling = "FRONT"
    node("OutputMaterial", surface)
    return made


def add_mesh(mesh):
    """With flat normals."""
    made = bpy.data.meshes.new(mesh.name)
    made.from_pydata(mesh.positions.tolist(), [], mesh.triangles.tolist())
    made.materials.append(material(mesh))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(mesh.name, made))


def seen_scene(to_world, vertical_field_of_view, size):
    """The scene at hand, as a camera sees it, to be rendered to EXR files with a box filter.

    to_world: (4, 4), columns are axes, the camera looks along -z; vertical_field_of_view: radians
    """
    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.matrix_world = mathutils.Matrix(to_world)
    lens = scene.camera.data
    lens.sensor_fit, lens.angle_y, lens.clip_start = "VERTICAL", vertical_field_of_view, 1e-3
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    return scene


def use_best_settings(scene, samples, denoise):
    """For rooms of diffuse surfaces; the light tree is on by default."""
    scene.world = None  # black
    scene.render.use_persistent_data = True  # a next picture keeps the scene
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", samples
    cycles.max_bounces = cycles.diffuse_bounces = DEPTH
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0  # none
    cycles.light_sampling_threshold = 0
    cycles.use_denoising, cycles.denoiser = denoise, "OPENIMAGEDENOISE"
    cycles.denoising_input_passes, cycles.denoising_prefilter = "RGB_ALBEDO_NORMAL", "ACCURATE"
    cycles.denoising_quality = "HIGH"


def rendered(scene, seed):
    """The picture, shape (height, width, 3)."""
    scene.cycles.seed = seed
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = f"{folder}/picture.exr"
        bpy.ops.render.render(write_still=True)
        return picture_error.read_picture(scene.render.filepath).astype("float32")


def main():
    options = one_picture.parser(__doc__.splitlines()[0]).parse_args()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    meshes, view = read_gltf(options.scene)
    for mesh in meshes:
        add_mesh(mesh)
    scene = seen_scene(view.to_world, view.vertical_field_of_view, options.size)
    use_best_settings(scene, options.samples, options.denoise)
    one_picture.write(options, lambda seed: rendered(scene, seed))


if __name__ == "__main__":
    main()
