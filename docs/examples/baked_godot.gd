class_name BakedRoom
extends Node3D
## Shows in Godot 4.2 or later what `photile publish -o room.glb` or `photile bake` wrote, each
## light by a slider, by baked_godot.gdshader, which lies beside this file.
## At most 64 lights, each of at most 65,504 lux: Godot reads pictures as half floats.

@export_file("*.glb", "*.gltf") var file := "res://room.glb"

var lights: Array = []  # name, file, power and tint of each
var factors := PackedFloat32Array()  # of these powers
var materials: Array[ShaderMaterial] = []


func _ready() -> void:
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	if document.append_from_file(file, state) != OK:
		push_error("%s cannot be read" % file)
		return
	var room := document.generate_scene(state)
	lights = state.json["scenes"][0]["extras"]["photile"]["light_maps"]
	factors.resize(64)
	factors.fill(1.0)
	var images: Array[Image] = []
	for light: Dictionary in lights:
		images.append(Image.load_from_file(file.get_base_dir().path_join(light["uri"])))
	var maps := Texture2DArray.new()
	maps.create_from_images(images)
	for node: MeshInstance3D in room.find_children("*", "MeshInstance3D", true, false):
		for i in node.mesh.get_surface_count():
			node.set_surface_override_material(i, shown(node.mesh.surface_get_material(i), maps))
	add_child(room)
	var sliders := VBoxContainer.new()
	add_child(sliders)
	for i in lights.size():
		var slider := HSlider.new()
		slider.max_value = 2.0
		slider.step = 0.01
		slider.value = 1.0
		slider.tooltip_text = lights[i]["light"]
		slider.custom_minimum_size.x = 200.0
		slider.value_changed.connect(set_power.bind(i))
		sliders.add_child(slider)


func shown(own: BaseMaterial3D, maps: Texture2DArray) -> ShaderMaterial:
	var material := ShaderMaterial.new()
	material.shader = preload("baked_godot.gdshader")
	var values := {"colour": own.albedo_color, "picture": own.albedo_texture, "light_maps": maps,
			"factors": factors, "lights": lights.size()}
	for key: String in values:
		material.set_shader_parameter(key, values[key])
	materials.append(material)
	return material


func set_power(factor: float, light: int) -> void:
	factors[light] = factor
	for material in materials:
		material.set_shader_parameter("factors", factors)
