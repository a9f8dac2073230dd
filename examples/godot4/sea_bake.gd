# Plays a bake (`fftocean bake --engine godot`) that lies in this script's folder: loads its maps as
# texture arrays, blends frames, and answers `height_at`. Formats: bin, exr, exr-float, exr-atlas.
# In an export preset, list *.bin and *.json as files to include.
extends MeshInstance3D

const SeaMesh := preload("sea_mesh.gd")
const WATER := preload("sea_bake.gdshader")
const MAPS := ["displacement", "height", "derivative", "stretch", "normal", "foam"]
const MOST_TILES := 4

var time := 0.0 # [s]
var playing := true
var error := ""
var manifests: Array[Dictionary] = []
var places: Array[PackedByteArray] = [] # displacement or height of each tile: half RGBA
var frame := 0.0 # place in the sequence
var shader := ShaderMaterial.new()


func _ready() -> void:
	error = _read(get_script().resource_path.get_base_dir())
	if error:
		push_error(error)
		var label := Label.new()
		label.text = error
		add_child(label)
		return
	mesh = SeaMesh.rings()
	material_override = shader
	extra_cull_margin = 16384.0 # the mesh follows the camera, and is displaced


func _process(delta: float) -> void:
	if error:
		return
	if playing:
		time += delta
	show_time(time)
	var camera := get_viewport().get_camera_3d()
	if camera:
		position = Vector3(camera.global_position.x, position.y, camera.global_position.z)


# Show a time [s].
func show_time(seconds: float) -> void:
	var values: Dictionary = manifests[0]["sampling"]["values"]
	var count := int(values["frames"])
	frame = fposmod((seconds - values["start"]) / values["loop"] * count, count)
	var first := floorf(frame)
	shader.set_shader_parameter("frames", Vector3(first, fmod(first + 1.0, count), frame - first))


# Read the bake of a folder; return the error, or "".
func _read(folder: String) -> String:
	var tiles: Array[String] = [folder]
	var cascade := _json(folder.path_join("cascade.json"))
	if cascade:
		tiles.clear()
		for tile: Dictionary in cascade["tiles"]:
			tiles.append(folder.path_join(tile["path"]))
	if tiles.size() > MOST_TILES:
		return "%s must have at most %d tiles, got %d" % [folder, MOST_TILES, tiles.size()]
	shader.shader = WATER
	for i in tiles.size():
		var wrong := _read_tile(tiles[i], i)
		if wrong:
			return wrong
	shader.set_shader_parameter("tiles", tiles.size())
	var job: Dictionary = manifests[0]["job"]
	var rule := Vector3(job["bake.foam.tau"], job["bake.foam.threshold"], job["bake.foam.strength"])
	shader.set_shader_parameter("foam_rule", rule)
	var document := cascade if cascade else manifests[0]
	shader.set_shader_parameter("wave_height", document["statistics"]["hs"])
	show_time(0.0)
	return ""


func _json(path: String) -> Dictionary:
	if not FileAccess.file_exists(path):
		return {}
	var found: Variant = JSON.parse_string(FileAccess.get_file_as_string(path))
	return found if found is Dictionary else {}


# Load the maps of a tile into the shader; return the error, or "".
func _read_tile(folder: String, index: int) -> String:
	var manifest := _json(folder.path_join("manifest.json"))
	if not manifest.has("sampling"):
		return "%s must hold the manifest.json of a bake" % folder
	var profile: String = manifest["conventions"]["profile"]
	if profile != "godot":
		return "%s must be a bake of --engine godot, got %s" % [folder, profile]
	if manifest["sampling"]["v"] != "Z / size_y - 0.5 / ny":
		return "sampling.v of %s must be Godot's, got %s" % [folder, manifest["sampling"]["v"]]
	manifests.append(manifest)
	var maps: Dictionary = manifest["maps"]
	if not maps.has("displacement") and not maps.has("height"):
		return "%s must have the map displacement or height" % folder
	var place := "displacement" if maps.has("displacement") else "height"
	for map: String in MAPS:
		if not maps.has(map) or (map == "height" and place != "height"):
			continue
		var images: Array[Image] = []
		var wrong := _load(folder, map, manifest, images)
		if wrong:
			return wrong
		if map == place:
			var bytes := PackedByteArray()
			for image in images:
				bytes.append_array(image.get_data())
			places.append(bytes)
		for image in images:
			image.generate_mipmaps()
		var array := Texture2DArray.new()
		array.create_from_images(images)
		var shown := "displacement" if map == place else map
		shader.set_shader_parameter("%s_%d" % [shown, index], array)
	var v: Dictionary = manifest["sampling"]["values"]
	var half := Vector2(0.5 / v["nx"], 0.5 / v["ny"])
	var tile := Vector4(1.0 / v["size_x"], 1.0 / v["size_y"], half.x, half.y)
	shader.set_shader_parameter("tile_%d" % index, tile)
	for map: String in MAPS:
		shader.set_shader_parameter("has_" + map, maps.has(map))
	var packed: bool = manifest["conventions"]["normals"].begins_with("packed")
	shader.set_shader_parameter("packed_normal", packed)
	return ""


# Fill `images` with all frames of a map, half RGBA; return the error, or "".
func _load(folder: String, map: String, manifest: Dictionary, images: Array[Image]) -> String:
	var shape: Array = manifest["maps"][map]["shape"]
	var rows := int(shape[0])
	var columns := int(shape[1])
	var count := int(manifest["sampling"]["values"]["frames"])
	match manifest["maps"][map]["format"]:
		"bin":
			var path := folder.path_join(map + ".bin")
			var bytes := FileAccess.get_file_as_bytes(path)
			var one := columns * rows * 8
			if bytes.size() != count * one:
				return "%s must have %d bytes, got %d" % [path, count * one, bytes.size()]
			for i in count:
				var part := bytes.slice(i * one, (i + 1) * one)
				images.append(Image.create_from_data(columns, rows, false, Image.FORMAT_RGBAH, part))
		"exr", "exr-float":
			for row: Dictionary in manifest["frames"]:
				images.append(_image(folder.path_join(row["files"][map]["path"])))
		"exr-atlas":
			var path := folder.path_join(map + ".exr")
			var across := int(_json(folder.path_join(map + ".json"))["tiles"][0])
			if ResourceLoader.exists(path):
				var array := load(path) as TextureLayered
				for i in count:
					images.append(array.get_layer_data(i))
			else:
				var whole := _image(path)
				if whole == null:
					return "%s could not be read" % path
				for i in count:
					@warning_ignore("integer_division")
					var corner := Vector2i(i % across * columns, i / across * rows)
					images.append(whole.get_region(Rect2i(corner, Vector2i(columns, rows))))
		var other:
			return "format of %s must be bin, exr, exr-float or exr-atlas, got %s" % [map, other]
	for i in count:
		var image := images[i]
		if image == null or image.get_width() != columns or image.get_height() != rows:
			return "frame %d of %s must have %d x %d texels" % [i, map, columns, rows]
		image.clear_mipmaps()
		image.convert(Image.FORMAT_RGBAH)
	return ""


# An imported texture's image, or that of a file that is not imported.
func _image(path: String) -> Image:
	if ResourceLoader.exists(path):
		return (load(path) as Texture2D).get_image()
	return Image.load_from_file(path)


# Displacement along X, Y, Z of the water that rests at (x, z): linear between samples and frames.
func rest_at(x: float, z: float) -> Vector3:
	var sum := Vector3.ZERO
	for i in manifests.size():
		var v: Dictionary = manifests[i]["sampling"]["values"]
		var columns := int(v["nx"])
		var rows := int(v["ny"])
		var count := int(v["frames"])
		# texel i has its middle at (i + 1/2) / n: u columns - 1/2, v rows - 1/2
		var place := [frame, z / v["size_y"] * rows - 1.0, x / v["size_x"] * columns]
		for corner in 8:
			var weight := 1.0
			var index := [0, 0, 0]
			for axis in 3:
				var bit := (corner >> axis) & 1
				var part: float = place[axis] - floorf(place[axis])
				weight *= part if bit == 1 else 1.0 - part
				index[axis] = posmod(int(floorf(place[axis])) + bit, [count, rows, columns][axis])
			if weight == 0.0:
				continue
			var at: int = 8 * ((index[0] * rows + index[1]) * columns + index[2])
			var bytes := places[i]
			var red := bytes.decode_half(at)
			if manifests[i]["maps"].has("displacement"):
				sum += weight * Vector3(red, bytes.decode_half(at + 2), bytes.decode_half(at + 4))
			else:
				sum.y += weight * red
	return sum


# Height of the water at a place of the world [m].
func height_at(x: float, z: float) -> float:
	if error:
		return 0.0
	var rest := Vector2(x, z)
	var moved := Vector3.ZERO
	for i in 4:
		moved = rest_at(rest.x, rest.y)
		rest = Vector2(x - moved.x, z - moved.z)
	return moved.y
