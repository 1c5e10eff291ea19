# SPDX-License-Identifier: MIT
"""Light layers of an EXR as a node of the compositor: a slider and a colour for each lamp."""

import bpy

GROUP = "photile lamps"
_PREFIX = "Combined_"


def layers_of(image):
    """Names of the lamps in the outputs of an Image node."""
    return [output.name[len(_PREFIX):] for output in image.outputs
            if output.name.startswith(_PREFIX)]


def _lamps_group(names):
    """A group that adds layers, each times its slider and its colour."""
    group = bpy.data.node_groups.new(GROUP, "CompositorNodeTree")
    entry, leave = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    entry.location = (-800, 0)
    group.outputs.new("NodeSocketColor", "Image")
    for name in names:
        group.inputs.new("NodeSocketColor", f"{name} layer").hide_value = True
        power = group.inputs.new("NodeSocketFloat", name)
        power.default_value, power.min_value, power.max_value = 1.0, 0.0, 10.0
        group.inputs.new("NodeSocketColor", f"{name} colour").default_value = (1, 1, 1, 1)

    total = None
    for number, name in enumerate(names):
        height = -260 * number
        # The colour times the slider, times the layer: not clamped, since radiance has no bound.
        brightness = _mix(group, "MULTIPLY", (-560, height))
        group.links.new(entry.outputs[f"{name} colour"], brightness.inputs[1])
        group.links.new(entry.outputs[name], brightness.inputs[2])
        lit = _mix(group, "MULTIPLY", (-360, height))
        group.links.new(entry.outputs[f"{name} layer"], lit.inputs[1])
        group.links.new(brightness.outputs[0], lit.inputs[2])
        if total is None:
            total = lit
            continue
        added = _mix(group, "ADD", (-160, height))
        group.links.new(total.outputs[0], added.inputs[1])
        group.links.new(lit.outputs[0], added.inputs[2])
        total = added
    opaque = group.nodes.new("CompositorNodeSetAlpha")
    opaque.mode, opaque.location = "REPLACE_ALPHA", (60, 0)
    group.links.new(total.outputs[0], opaque.inputs["Image"])
    group.links.new(opaque.outputs["Image"], leave.inputs["Image"])
    leave.location = (260, 0)
    return group


def _mix(group, blend_type, location):
    node = group.nodes.new("CompositorNodeMixRGB")
    node.blend_type, node.use_clamp, node.location = blend_type, False, location
    node.inputs[0].default_value = 1.0
    return node


def read_layers(scene, file):
    """Makes or renews the nodes of a picture; returns the node with the sliders.

    Sliders of lamps that were there keep their values. Raises ValueError where the picture has no
    light layers.
    """
    scene.use_nodes = True
    tree = scene.node_tree
    picture = bpy.data.images.load(str(file), check_existing=True)
    picture.reload()
    picture.colorspace_settings.name = "Linear"

    before = tree.nodes.get(GROUP)
    values = {}
    if before:
        values = {socket.name: _value(socket) for socket in before.inputs if not socket.is_linked}
        old = before.node_tree
        tree.nodes.remove(before)
        if old and old.users == 0:
            bpy.data.node_groups.remove(old)
    image = tree.nodes.get("photile picture")
    if image is None:
        image = tree.nodes.new("CompositorNodeImage")
        image.name = image.label = "photile picture"
        image.location = (-700, -300)
    image.image = picture
    names = layers_of(image)
    if not names:
        raise ValueError(f"{file}: the picture has no light layers; render it with photile")

    node = tree.nodes.new("CompositorNodeGroup")
    node.name = node.label = GROUP
    node.node_tree, node.location, node.width = _lamps_group(names), (-350, -300), 260
    for name in names:
        tree.links.new(image.outputs[_PREFIX + name], node.inputs[f"{name} layer"])
    for socket in node.inputs:
        if socket.name in values and not socket.is_linked:
            socket.default_value = values[socket.name]
    for kind in ("CompositorNodeComposite", "CompositorNodeViewer"):
        target = next((one for one in tree.nodes if one.bl_idname == kind), None)
        target = target or tree.nodes.new(kind)
        tree.links.new(node.outputs["Image"], target.inputs["Image"])
    return node


def _value(socket):
    value = socket.default_value
    return tuple(value) if hasattr(value, "__len__") else value
