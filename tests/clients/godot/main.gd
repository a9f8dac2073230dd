# What Godot makes of a bake: heights by the example's reader, maps by a shader, normals by its own material. Answers on stdout.
extends Node3D

const SeaHeights := preload("res://sea_heights.gd")


func _ready() -> void:
	var ask: Dictionary = read("res://ask.json")
	var sea := SeaHeights.new("res://sea/height.json")
	var heights := []
	for p: Array in ask["points"]:
		heights.append(sea.at(p[0], p[1], p[2]))
	answer("heights", heights)
	var other := SeaHeights.new("res://sea/other.json")
	answer("refused", [other.error, is_nan(other.at(0.0, 0.0, 0.0))])
	for map: String in ask["maps"]:
		answer(map, Marshalls.raw_to_base64(await looked_up(map, ask)))
	for map: String in ["", "normal_flat", "normal_sea"]:
		answer("lit " + map, Marshalls.raw_to_base64(await lit(map)))
	answer("screen", on_screen())
	answer("version", Engine.get_version_info()["string"])
	print("DONE")


func answer(name: String, value: Variant) -> void:
	print("ANSWER ", JSON.stringify([name, value], "", true, true))


func read(path: String) -> Variant:
	return JSON.parse_string(FileAccess.get_file_as_string(path))


func frames(map: String) -> Array[Image]:
	var s: Dictionary = read("res://sea/%s.json" % map)
	var bytes := FileAccess.get_file_as_bytes("res://sea/%s.bin" % map)
	var one := int(s["columns"]) * int(s["rows"]) * 8
	var images: Array[Image] = []
	for f in int(s["frames"]):
		images.append(Image.create_from_data(int(s["columns"]), int(s["rows"]), false, Image.FORMAT_RGBAH, bytes.slice(f * one, (f + 1) * one)))
	return images


# A viewport's picture, once it is drawn.
func picture(viewport: SubViewport) -> Image:
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(viewport)
	for i in 3:
		await RenderingServer.frame_post_draw
	var image := viewport.get_texture().get_image()
	viewport.queue_free()
	image.convert(Image.FORMAT_RGBA8)
	return image


# Bytes of the picture that the map's shader draws: a column a place, two rows a channel (low and high half of a float's bits).
func looked_up(map: String, ask: Dictionary) -> PackedByteArray:
	var places := PackedFloat32Array(ask["places"])
	var width := places.size() / 4
	var texture := Texture2DArray.new()
	texture.create_from_images(frames(map))
	var shader := Shader.new()
	shader.code = ask["maps"][map]
	var material := ShaderMaterial.new()
	material.shader = shader
	material.set_shader_parameter("map", texture)
	material.set_shader_parameter("places", ImageTexture.create_from_image(Image.create_from_data(width, 1, false, Image.FORMAT_RGBAF, places.to_byte_array())))
	var rect := ColorRect.new()
	rect.size = Vector2(width, 8)
	rect.material = material
	var viewport := SubViewport.new()
	viewport.size = Vector2i(width, 8)
	viewport.disable_3d = true
	viewport.add_child(rect)
	return (await picture(viewport)).get_data()


# Bytes of a still tile in a stock material with a normal map, seen from above and lit from the side; without a map, if "".
func lit(map: String) -> PackedByteArray:
	var material := StandardMaterial3D.new()
	if map:
		material.normal_enabled = true
		material.normal_texture = ImageTexture.create_from_image(frames(map)[0])
	var plane := MeshInstance3D.new()
	plane.mesh = PlaneMesh.new()
	plane.material_override = material
	var sun := DirectionalLight3D.new()
	sun.rotation = Vector3(-0.8, 0.5, 0.0)
	var viewport := SubViewport.new()
	viewport.size = Vector2i(64, 64)
	viewport.own_world_3d = true
	viewport.add_child(plane)
	viewport.add_child(sun)
	viewport.add_child(above(2.0))
	return (await picture(viewport)).get_data()


func above(size: float) -> Camera3D:
	var camera := Camera3D.new()
	camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	camera.size = size
	camera.position = Vector3(0, 20, 0)
	camera.rotation = Vector3(-PI / 2, 0, 0) # north, which is -Z, is up
	return camera


# Where X and Z appear, looking down with north up; y of the screen counts upward here.
func on_screen() -> Dictionary:
	var camera := above(20.0)
	add_child(camera)
	camera.current = true
	var zero := camera.unproject_position(Vector3.ZERO)
	var x := camera.unproject_position(Vector3(1, 0, 0)) - zero
	var z := camera.unproject_position(Vector3(0, 0, 1)) - zero
	return {"X": [x.x, -x.y], "Z": [z.x, -z.y]}
