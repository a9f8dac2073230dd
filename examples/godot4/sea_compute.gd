# Not run in Godot: no desktop Godot was at hand, and its web build has no RenderingDevice. Parsed
# and linted by gdtoolkit; fftocean's tests run its kernels, in this order, on Vulkan by wgpu.
#
# Every wave of a package, evolved and transformed each frame by the kernels fftocean_*.glsl beside
# this script, into textures for sea_water.gdshader. docs/kernels.md of fftocean has the bindings.
extends RefCounted

const SEA_BYTES := 1120
const TILE_BYTES := 64
const TABLE := 96 # first byte of the table of tiles
const FOAM_SIDE := 512
const FOAM_CELL := 0.4 # [m]
const PLANES := 3 # of a tile: displacement, slopes, moments
const LONGEST_STEP := 0.1 # of foam [s]
const KERNELS := {  # bindings of each kernel
	"rows": [0, 1, 2, 3, 4],
	"columns": [0, 3, 4, 5],
	"foam": [0, 5],
	"mips": [0, 5],
	"mips_far": [0, 5],
	"textures": [0, 5, 6, 9],
}

var error := ""
var sea: RefCounted # SeaPackage
var device := RenderingServer.get_rendering_device()
var pipelines := {} # by kernel
var shaders := {}
var buffers := {} # by binding
var sets := {} # by kernel but `textures`
var levels: Array[Dictionary] = [] # of all planes: set of `textures`, width and height
var textures: Array[RID] = []
var shown: Array[Texture2DRD] = []
var head := PackedByteArray() # the uniform block
var corner_before := Vector2i(1 << 20, 1 << 20) # far away: foam begins steady
var groups := 1 # of rows and columns, of the largest tile
var side := FOAM_SIDE # of the largest plane


func _init(package: RefCounted, folder: String) -> void:
	sea = package
	for kernel: String in KERNELS:
		var path := folder.path_join("fftocean_%s.glsl" % kernel)
		if not FileAccess.file_exists(path):
			error = "%s does not exist: fftocean export-sea --engine godot writes it" % path
			return
	_lay_out()
	for i in PLANES * sea.tiles.size() + 1:
		shown.append(Texture2DRD.new())
	RenderingServer.call_on_render_thread(_start.bind(folder))


# Give the textures to the water's shader.
func show_in(material: ShaderMaterial) -> void:
	var names := ["displacement", "slopes", "moments"]
	for i: int in sea.tiles.size():
		var size: Vector2 = sea.tiles[i]["size"]
		var n := Vector2(sea.tiles[i]["n"])
		var tile := Vector4(1.0 / size.x, 1.0 / size.y, 0.5 / n.x, 0.5 / n.y)
		material.set_shader_parameter("tile_%d" % i, tile)
		for p in PLANES:
			material.set_shader_parameter("%s_%d" % [names[p], i], shown[PLANES * i + p])
	material.set_shader_parameter("tiles", sea.tiles.size())
	material.set_shader_parameter("foam", shown[-1])
	material.set_shader_parameter("foam_size", FOAM_SIDE * FOAM_CELL)
	var beyond: Array = sea.document["slope_variance"]["beyond"]
	material.set_shader_parameter("beyond", 0.5 * (beyond[0] + beyond[1]))


# Bring the sea to a tick; foam about a place (x east, y north) has `seconds` to form and fade.
func step(tick: int, seconds: float, about: Vector2) -> void:
	var corner := Vector2i((about / FOAM_CELL).floor()) - Vector2i.ONE * (FOAM_SIDE >> 1)
	head.encode_u32(0, tick)
	head.encode_s32(32, corner.x)
	head.encode_s32(36, corner.y)
	head.encode_s32(40, corner_before.x)
	head.encode_s32(44, corner_before.y)
	var middle := (Vector2(corner) + Vector2(0.5, 0.5)) * FOAM_CELL
	head.encode_float(48, middle.x)
	head.encode_float(52, middle.y)
	head.encode_float(60, minf(seconds, LONGEST_STEP))
	corner_before = corner
	RenderingServer.call_on_render_thread(_run.bind(head.duplicate()))


# Fill the uniform block with what does not change.
func _lay_out() -> void:
	head.resize(SEA_BYTES)
	var document: Dictionary = sea.document
	var ticks := int(document["ticks"])
	var first := 0
	var first_map := 0
	var longest := 2
	for i: int in sea.tiles.size():
		var n: Vector2i = sea.tiles[i]["n"]
		var size: Vector2 = sea.tiles[i]["size"]
		var at := TABLE + TILE_BYTES * i
		head.encode_u32(at, n.x)
		head.encode_u32(at + 4, n.y)
		head.encode_u32(at + 8, first)
		head.encode_u32(at + 12, first_map)
		head.encode_float(at + 16, size.x)
		head.encode_float(at + 20, size.y)
		head.encode_float(at + 24, TAU / size.x)
		head.encode_float(at + 28, TAU / size.y)
		for lift in 4:
			head.encode_float(at + 32 + 4 * lift, 1.0)
		head.encode_float(at + 36, document["tiles"][i]["mixed"])
		first += n.x * n.y
		first_map += PLANES * _texels_of_levels(n)
		longest = maxi(longest, maxi(n.x, n.y))
		groups = maxi(groups, (n.x * n.y) >> 9)
		side = maxi(side, maxi(n.x, n.y))
	head.encode_u32(4, ticks - 1)
	head.encode_u32(8, sea.tiles.size())
	head.encode_u32(12, longest)
	head.encode_float(16, 1.0 / ticks)
	head.encode_float(20, document["choppiness"])
	head.encode_u32(28, 4)
	head.encode_float(56, FOAM_CELL)
	head.encode_float(64, document["foam"]["decay"])
	head.encode_float(68, document["foam"]["threshold"])
	head.encode_float(72, document["foam"]["strength"])
	head.encode_u32(76, FOAM_SIDE)
	head.encode_u32(80, first_map)


static func _texels_of_levels(n: Vector2i) -> int:
	var sum := 0
	for level in _levels_of(n):
		sum += maxi(n.x >> level, 1) * maxi(n.y >> level, 1)
	return sum


static func _levels_of(n: Vector2i) -> int:
	var count := 1
	while maxi(n.x, n.y) >> count > 0:
		count += 1
	return count


# On the render thread: compile the kernels, and make buffers and textures.
func _start(folder: String) -> void:
	for kernel: String in KERNELS:
		var source := RDShaderSource.new()
		var path := folder.path_join("fftocean_%s.glsl" % kernel)
		source.source_compute = FileAccess.get_file_as_string(path)
		var spirv := device.shader_compile_spirv_from_source(source)
		if spirv.compile_error_compute:
			push_error("%s: %s" % [path, spirv.compile_error_compute])
			return
		shaders[kernel] = device.shader_create_from_spirv(spirv)
		pipelines[kernel] = device.compute_pipeline_create(shaders[kernel])
	_make_buffers()
	for kernel: String in KERNELS:
		if kernel != "textures":
			sets[kernel] = device.uniform_set_create(_uniforms(kernel), shaders[kernel], 0)
	for i: int in sea.tiles.size():
		for p in PLANES:
			_make_texture(PLANES * i + p, sea.tiles[i]["n"])
	_make_texture(PLANES * sea.tiles.size(), Vector2i(FOAM_SIDE, FOAM_SIDE))


func _make_buffers() -> void:
	var h0 := PackedFloat32Array()
	var wave := PackedFloat32Array()
	for tile: Dictionary in sea.tiles:
		h0.append_array(tile["h0"])
		wave.append_array(tile["wave"])
	var longest := head.decode_u32(12)
	var twiddle := PackedFloat32Array()
	for i in longest:
		twiddle.append_array([cos(TAU * i / longest), sin(TAU * i / longest)])
	buffers[0] = device.uniform_buffer_create(head.size(), head)
	var read := {1: h0, 2: wave, 3: twiddle}
	for binding: int in read:
		var bytes: PackedByteArray = read[binding].to_byte_array()
		buffers[binding] = device.storage_buffer_create(bytes.size(), bytes)
	@warning_ignore("integer_division")
	var texels := h0.size() / 4
	var foam := _texels_of_levels(Vector2i(FOAM_SIDE, FOAM_SIDE))
	buffers[4] = device.storage_buffer_create(2 * 16 * texels)
	buffers[5] = device.storage_buffer_create(16 * (head.decode_u32(80) + foam))


# The uniforms of a kernel; `image` and `target` are those of one level, for `textures`.
func _uniforms(kernel: String, image := RID(), target := RID()) -> Array[RDUniform]:
	var found: Array[RDUniform] = []
	for binding: int in KERNELS[kernel]:
		var uniform := RDUniform.new()
		uniform.binding = binding
		uniform.uniform_type = RenderingDevice.UNIFORM_TYPE_STORAGE_BUFFER
		if binding in [0, 9]:
			uniform.uniform_type = RenderingDevice.UNIFORM_TYPE_UNIFORM_BUFFER
		elif binding == 6:
			uniform.uniform_type = RenderingDevice.UNIFORM_TYPE_IMAGE
		var ids := {6: image, 9: target}
		uniform.add_id(ids[binding] if binding in ids else buffers[binding])
		found.append(uniform)
	return found


# Make the texture of a plane, and a set of `textures` for each of its levels.
func _make_texture(plane: int, n: Vector2i) -> void:
	var format := RDTextureFormat.new()
	format.width = n.x
	format.height = n.y
	format.mipmaps = _levels_of(n)
	format.format = RenderingDevice.DATA_FORMAT_R16G16B16A16_SFLOAT
	format.usage_bits = (
		RenderingDevice.TEXTURE_USAGE_SAMPLING_BIT | RenderingDevice.TEXTURE_USAGE_STORAGE_BIT
	)
	var texture := device.texture_create(format, RDTextureView.new())
	textures.append(texture)
	for level in format.mipmaps:
		var target := PackedInt32Array([plane, level, 0, 0]).to_byte_array()
		var image := device.texture_create_shared_from_slice(RDTextureView.new(), texture, 0, level)
		var uniforms := _uniforms("textures", image, device.uniform_buffer_create(16, target))
		var uniform_set := device.uniform_set_create(uniforms, shaders["textures"], 0)
		var size := Vector2i(maxi(n.x >> level, 1), maxi(n.y >> level, 1))
		levels.append({"set": uniform_set, "size": size})
	shown[plane].texture_rd_rid = texture


# On the render thread: all dispatches of a frame, each after the one before.
func _run(block: PackedByteArray) -> void:
	if levels.is_empty():
		return
	device.buffer_update(buffers[0], 0, block.size(), block)
	var tiles: int = sea.tiles.size()
	var planes := PLANES * tiles + 1
	var foam := _over(FOAM_SIDE, 8)
	var far := _over(side, 1024)
	var list := device.compute_list_begin()
	_dispatch(list, "rows", sets["rows"], Vector3i(groups, tiles, 1))
	_dispatch(list, "columns", sets["columns"], Vector3i(groups, tiles, 1))
	_dispatch(list, "foam", sets["foam"], Vector3i(foam, foam, 1))
	_dispatch(list, "mips", sets["mips"], Vector3i(_over(side, 32), _over(side, 32), planes))
	_dispatch(list, "mips_far", sets["mips_far"], Vector3i(far, far, planes))
	for level in levels:
		var size: Vector2i = level["size"]
		_dispatch(list, "textures", level["set"], Vector3i(_over(size.x, 8), _over(size.y, 8), 1))
	device.compute_list_end()


static func _over(count: int, part: int) -> int:
	@warning_ignore("integer_division")
	return (count + part - 1) / part


func _dispatch(list: int, kernel: String, uniforms: RID, count: Vector3i) -> void:
	device.compute_list_bind_compute_pipeline(list, pipelines[kernel])
	device.compute_list_bind_uniform_set(list, uniforms, 0)
	device.compute_list_dispatch(list, count.x, count.y, count.z)
	if kernel != "textures":
		device.compute_list_add_barrier(list)
