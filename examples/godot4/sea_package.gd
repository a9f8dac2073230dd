# Reads a run-time package (sea.json and tile*.waves): checks it, lays its waves out for a graphics
# processor, and sums its strongest waves at points, for boats and where there is no compute shader.
extends RefCounted

const RECORD := 14 # bytes of a wave: int16 mx, my; uint16 cycles; float32 re, im
const MOST_TILES := 4
const MOST_SIDE := 512 # of the kernels

var error := ""
var document: Dictionary
var tiles: Array[Dictionary] = [] # n, size, h0, wave
var strongest: Array[Dictionary] = [] # kx, ky, cycles, re, im, factor
var neglected := 0.0 # rms of the height of the waves left out of `strongest` [m]
var tick := 0
# Of the strongest waves: wavenumber along X and Z [rad/m], 1/(k tanh kh) times choppiness [m], and
# amplitude at the tick [m].
var kx := PackedFloat64Array()
var kz := PackedFloat64Array()
var factor := PackedFloat64Array()
var real := PackedFloat64Array()
var imaginary := PackedFloat64Array()


func _init(folder: String, most := 256) -> void:
	error = _read(folder, most)
	if error:
		push_error(error)


func _read(folder: String, most: int) -> String:
	var path := folder.path_join("sea.json")
	if not FileAccess.file_exists(path):
		return "%s does not exist: fftocean export-sea sea.toml -o DIR --engine godot" % path
	var found: Variant = JSON.parse_string(FileAccess.get_file_as_string(path))
	if not found is Dictionary or found.get("format") != "fftocean-runtime":
		return "format of %s must be fftocean-runtime" % path
	document = found
	var wrong_document := _document_error(path)
	if wrong_document:
		return wrong_document
	var all: Array[Dictionary] = []
	for i: int in document["tiles"].size():
		var wrong := _read_tile(folder, i, all)
		if wrong:
			return wrong
	all.sort_custom(func(a: Dictionary, b: Dictionary) -> bool: return a["energy"] > b["energy"])
	strongest = all.slice(0, most)
	for wave in strongest:
		kx.append(wave["kx"])
		kz.append(-wave["ky"]) # Z is south
		factor.append(wave["factor"] * float(document["choppiness"]))
	real.resize(strongest.size())
	imaginary.resize(strongest.size())
	set_time(0.0)
	for wave: Dictionary in all.slice(most):
		neglected += 2.0 * wave["energy"]
	neglected = sqrt(neglected)
	return ""


# Return what is wrong with the document, or "".
func _document_error(path: String) -> String:
	if document["version"] != 1.0:
		return "version of %s must be 1, got %s" % [path, document["version"]]
	var ticks := int(document["ticks"])
	if ticks < 2 or ticks > 1 << 20 or ticks & (ticks - 1) != 0:
		return "ticks of %s must be a power of two up to 1048576, got %d" % [path, ticks]
	var count: int = document["tiles"].size()
	if count < 1 or count > MOST_TILES:
		return "tiles of %s must be 1 to %d, got %d" % [path, MOST_TILES, count]
	return ""


# Read a tile; append its waves to `all`; return the error, or "".
func _read_tile(folder: String, index: int, all: Array[Dictionary]) -> String:
	var tile: Dictionary = document["tiles"][index]
	var nx := int(tile["n"][0])
	var ny := int(tile["n"][1])
	for n: int in [nx, ny]:
		if n < 2 or n > MOST_SIDE or n & (n - 1) != 0:
			return "n of tile %d must be a power of two up to %d, got %d" % [index, MOST_SIDE, n]
	var lx: float = tile["size"][0]
	var ly: float = tile["size"][1]
	var path := folder.path_join("tile%d.waves" % index)
	var count := int(tile["waves"])
	var bytes := FileAccess.get_file_as_bytes(path)
	if bytes.size() != RECORD * count:
		return "%s must have %d bytes, got %d" % [path, RECORD * count, bytes.size()]
	var context := HashingContext.new()
	context.start(HashingContext.HASH_SHA256)
	context.update(bytes)
	var sum := context.finish().hex_encode()
	for entry: Dictionary in document["files"]:
		if entry["name"] == path.get_file() and entry["sha256"] != sum:
			return "SHA-256 of %s must be the one in sea.json" % path
	var h0 := PackedFloat32Array()
	h0.resize(4 * nx * ny)
	var wave := PackedFloat32Array()
	wave.resize(2 * nx * ny)
	var depth: Variant = document["depth"]
	for i in count:
		var at := RECORD * i
		var mx := bytes.decode_s16(at)
		var my := bytes.decode_s16(at + 2)
		var cycles := bytes.decode_u16(at + 4)
		var re := bytes.decode_float(at + 6)
		var im := bytes.decode_float(at + 10)
		if 2 * absi(mx) >= nx or 2 * absi(my) >= ny or (mx == 0 and my == 0):
			return "wave %d of %s must lie in the grid, got (%d, %d)" % [i, path, mx, my]
		if not is_finite(re) or not is_finite(im):
			return "wave %d of %s must be finite" % [i, path]
		var k_east := TAU * mx / lx
		var k_north := TAU * my / ly
		var k := sqrt(k_east * k_east + k_north * k_north)
		var over := 1.0 / (k * (1.0 if depth == null else tanh(k * float(depth))))
		var here := posmod(my, ny) * nx + posmod(mx, nx)
		var there := posmod(-my, ny) * nx + posmod(-mx, nx)
		h0[4 * here] = re
		h0[4 * here + 1] = im
		h0[4 * there + 2] = re
		h0[4 * there + 3] = -im
		for one: int in [here, there]:
			wave[2 * one] = cycles
			wave[2 * one + 1] = over
		var row := {"kx": k_east, "ky": k_north, "cycles": cycles, "factor": over, "re": re, "im": im}
		row["energy"] = re * re + im * im
		all.append(row)
	tiles.append({"n": Vector2i(nx, ny), "size": Vector2(lx, ly), "h0": h0, "wave": wave})
	return ""


# Set the time [s], to a whole tick of the loop. The phase of a wave there is exact for ever: cycles
# times tick is a whole number.
func set_time(seconds: float) -> void:
	var ticks := int(document["ticks"])
	tick = int(fposmod(seconds / float(document["loop"]), 1.0) * ticks) % ticks
	for i in strongest.size():
		var wave := strongest[i]
		var phase := TAU * ((int(wave["cycles"]) * tick) % ticks) / ticks
		var c := cos(phase)
		var s := sin(phase)
		real[i] = 2.0 * (wave["re"] * c + wave["im"] * s)
		imaginary[i] = 2.0 * (wave["im"] * c - wave["re"] * s)


# Displacement along X, Y (up), Z (south) of the water that rests at (x, z), of the strongest waves.
func rest_at(x: float, z: float) -> Vector3:
	var moved_x := 0.0
	var height := 0.0
	var moved_z := 0.0
	for i in kx.size():
		var phase := kx[i] * x + kz[i] * z
		var c := cos(phase)
		var s := sin(phase)
		height += real[i] * c - imaginary[i] * s
		var across := factor[i] * (real[i] * s + imaginary[i] * c)
		moved_x -= kx[i] * across
		moved_z -= kz[i] * across
	return Vector3(moved_x, height, moved_z)


# Height of the water at a place of the world [m].
func height_at(x: float, z: float) -> float:
	var rest := Vector2(x, z)
	var moved := Vector3.ZERO
	for i in 3:
		moved = rest_at(rest.x, rest.y)
		rest = Vector2(x - moved.x, z - moved.z)
	return moved.y


# The strongest waves as texels, two a wave, for a shader that sums them: wavenumber along X and Z,
# amplitude (re, im) at the tick; and 1/(k tanh kh) times choppiness.
func texels() -> PackedFloat32Array:
	var found := PackedFloat32Array()
	for i in kx.size():
		found.append_array([kx[i], kz[i], real[i], imaginary[i], factor[i], 0.0, 0.0, 0.0])
	return found
