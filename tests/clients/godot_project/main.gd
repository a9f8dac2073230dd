# What Godot makes of the scenes of examples/godot4: heights, maps by their own shader code, pictures. Answers on stdout.
extends Node3D


func _ready() -> void:
	var ask: Dictionary = JSON.parse_string(FileAccess.get_file_as_string("res://ask.json"))
	for name: String in ask["scenes"]:
		await shown(name, ask["scenes"][name], ask)
	for name: String in ask["textures"]:
		var values := ShaderMaterial.new()
		var code: Dictionary = ask["textures"][name]
		values.shader = Shader.new()
		values.shader.code = code["code"]
		for map: String in code["maps"]:
			values.set_shader_parameter(map, floats_of(code["maps"][map], code["size"]))
		var tile: Array = code["tile"]
		values.set_shader_parameter("tile_0", Vector4(tile[0], tile[1], tile[2], tile[3]))
		values.set_shader_parameter("tiles", 1)
		var bytes := await probed(values, code["code"], code["places"])
		answer(name, Marshalls.raw_to_base64(bytes))
	await laid_out(ask["compute"])
	answer("version", Engine.get_version_info()["string"])
	print("DONE")


func answer(name: String, value: Variant) -> void:
	print("ANSWER ", JSON.stringify([name, value], "", true, true))


# sea_compute.gd without a device: what it would give to the kernels.
class Recorded extends "res://live/sea_compute.gd":
	var ran := PackedByteArray()

	func _start(_folder: String) -> void:
		pass

	func _run(block: PackedByteArray) -> void:
		ran = block


func laid_out(ask: Dictionary) -> void:
	var package: RefCounted = load("res://live/sea_package.gd").new("res://live")
	var compute := Recorded.new(package, "res://live")
	compute.step(int(ask["tick"]), ask["seconds"], Vector2(ask["about"][0], ask["about"][1]))
	await RenderingServer.frame_post_draw
	answer("compute error", compute.error)
	answer("block", Marshalls.raw_to_base64(compute.ran))
	answer("groups", [compute.groups, compute.side])
	answer("bindings", Recorded.KERNELS)
	for table: String in ["h0", "wave"]:
		var bytes := PackedByteArray()
		for tile: Dictionary in package.tiles:
			bytes.append_array(tile[table].to_byte_array())
		answer(table, Marshalls.raw_to_base64(bytes))


func floats_of(text: String, size: Array) -> ImageTexture:
	var bytes := Marshalls.base64_to_raw(text)
	var image := Image.create_from_data(int(size[0]), int(size[1]), false, Image.FORMAT_RGBAF, bytes)
	return ImageTexture.create_from_image(image)


# A scene at a time: heights at points, the sums of its shader at places, and a picture.
func shown(name: String, scene: Dictionary, ask: Dictionary) -> void:
	var viewport := SubViewport.new()
	viewport.size = Vector2i(scene["picture"][0], scene["picture"][1])
	viewport.own_world_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	add_child(viewport)
	var root: Node3D = load(scene["path"]).instantiate()
	viewport.add_child(root)
	var water := root.get_node("Water")
	water.playing = false
	water.time = scene["time"]
	if water.error:
		answer(name + " error", water.error)
		viewport.queue_free()
		return
	water.show_time(scene["time"])
	var heights := []
	var rests := []
	for p: Array in scene.get("points", []):
		heights.append(water.height_at(p[0], p[1]))
		var rest: Vector3 = water.rest_at(p[0], p[1])
		rests.append([rest.x, rest.y, rest.z])
	answer(name + " heights", heights)
	answer(name + " rests", rests)
	for probe: String in scene.get("probes", {}):
		var bytes := await probed(water.shader, scene["probes"][probe], scene["places"])
		answer("%s %s" % [name, probe], Marshalls.raw_to_base64(bytes))
	if scene["picture"][0] > 1:
		for i in 3:
			await get_tree().process_frame
		viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
		for i in 3:
			await RenderingServer.frame_post_draw
		var image := viewport.get_texture().get_image()
		image.convert(Image.FORMAT_RGBA8)
		answer(name + " picture", Marshalls.raw_to_base64(image.save_png_to_buffer()))
	viewport.queue_free()
	await get_tree().process_frame


# Bits of what a canvas shader with a material's values writes: a column a place, two rows a channel.
func probed(values: ShaderMaterial, code: String, places: Array) -> PackedByteArray:
	var width := places.size() / 4
	var shader := Shader.new()
	shader.code = code
	var material := ShaderMaterial.new()
	material.shader = shader
	for uniform: Dictionary in shader.get_shader_uniform_list():
		material.set_shader_parameter(uniform["name"], values.get_shader_parameter(uniform["name"]))
	var data := PackedFloat32Array(places).to_byte_array()
	var image := Image.create_from_data(width, 1, false, Image.FORMAT_RGBAF, data)
	material.set_shader_parameter("places", ImageTexture.create_from_image(image))
	var rect := ColorRect.new()
	rect.size = Vector2(width, 8)
	rect.material = material
	var viewport := SubViewport.new()
	viewport.size = Vector2i(width, 8)
	viewport.disable_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	viewport.add_child(rect)
	add_child(viewport)
	for i in 3:
		await RenderingServer.frame_post_draw
	var picture := viewport.get_texture().get_image()
	viewport.queue_free()
	picture.convert(Image.FORMAT_RGBA8)
	return picture.get_data()
