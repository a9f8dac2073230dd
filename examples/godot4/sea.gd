# The sea of the package in this script's folder. With a RenderingDevice (Forward+, Mobile) every
# wave is evolved and transformed by compute shaders, in sea_compute.gd: that was not run in Godot.
# Without one (Compatibility, web) the strongest waves are summed in the water's shader, and a label
# says so: that is run in tests.
extends MeshInstance3D

const SeaMesh := preload("sea_mesh.gd")
const SeaPackage := preload("sea_package.gd")
const STRONGEST := preload("sea_strongest.gdshader")
const WATER := preload("sea_water.gdshader")
const WAVES_WITHOUT_COMPUTE := 128

var time := 0.0 # [s]
var playing := true
var error := ""
var sea: SeaPackage
var shader := ShaderMaterial.new()
var compute: RefCounted # SeaCompute, or null without a RenderingDevice
var waves := ImageTexture.new()


func _ready() -> void:
	var folder: String = get_script().resource_path.get_base_dir()
	var device := RenderingServer.get_rendering_device()
	sea = SeaPackage.new(folder, 256 if device else WAVES_WITHOUT_COMPUTE)
	error = sea.error
	if not error and device:
		compute = load(folder.path_join("sea_compute.gd")).new(sea, folder)
		error = compute.error
	if error:
		_say(error)
		return
	if compute:
		shader.shader = WATER
		compute.show_in(shader)
	else:
		shader.shader = STRONGEST
		shader.set_shader_parameter("count", sea.strongest.size())
		var said := "No compute shaders: the strongest %d waves, without %.3f m rms of height."
		_say(said % [sea.strongest.size(), sea.neglected])
	var foam: Dictionary = sea.document["foam"]
	var rule := Vector3(foam["decay"], foam["threshold"], foam["strength"])
	shader.set_shader_parameter("foam_rule", rule)
	shader.set_shader_parameter("wave_height", sea.document["statistics"]["realised"]["hs"])
	mesh = SeaMesh.rings()
	material_override = shader
	extra_cull_margin = 16384.0 # the mesh follows the camera, and is displaced
	show_time(0.0)


func _process(delta: float) -> void:
	if error:
		return
	if playing:
		time += delta
	var camera := get_viewport().get_camera_3d()
	if camera:
		position = Vector3(camera.global_position.x, position.y, camera.global_position.z)
	show_time(time, delta)


# Show a time [s]; foam has had `seconds` to form and fade.
func show_time(at: float, seconds := 0.0) -> void:
	sea.set_time(at)
	if compute:
		compute.step(sea.tick, seconds, Vector2(position.x, -position.z))
		return
	var data := sea.texels().to_byte_array()
	var image := Image.create_from_data(2, sea.strongest.size(), false, Image.FORMAT_RGBAF, data)
	if waves.get_size() == Vector2(image.get_size()):
		waves.update(image)
	else:
		waves.set_image(image)
	shader.set_shader_parameter("waves", waves)


# Displacement along X, Y, Z of the water that rests at (x, z), of the strongest waves [m].
func rest_at(x: float, z: float) -> Vector3:
	return Vector3.ZERO if error else sea.rest_at(x, z)


# Height of the water at a place of the world, of the strongest waves [m].
func height_at(x: float, z: float) -> float:
	return 0.0 if error else sea.height_at(x, z)


func _say(text: String) -> void:
	var label := Label.new()
	label.text = text
	label.position = Vector2(12.0, 8.0)
	add_child(label)
