# The sea of a run-time package in Godot 4, without a GPU: for servers, boats and buoys.
#     fftocean export-sea -o sea
#     var sea := SeaWaves.new("res://sea")       # every wave
#     var fast := SeaWaves.new("res://sea", 500) # the strongest, without fast.neglected_rms [m]
#     var water := sea.at(x, y, t)       # the water above a place: water.height, water.normal
#     var buoy := sea.rest(x0, y0, t)    # the water that rests at a place: buoy.x, buoy.y
# x east, y north, z up, metres, seconds. In Godot's axes: sea.at(p.x, -p.z, t), and the normal is
# Vector3(n.x, n.z, -n.y). For a damaged package `error` names the file and the rule, and the sea
# is flat. In an export preset, list *.waves and *.json as files to include.
class_name SeaWaves
extends RefCounted

const MOST := 1048576  # bytes of sea.json
const DEEPEST := 32

var document: Dictionary
var error := ""
var loop := 1.0  # [s]
var choppiness := 1.0
var neglected_rms := 0.0  # of the height of the waves that are left out [m]

# A wave's height is the real part of (re + i im) e^(i phase).
var tile := PackedInt32Array()
var mx := PackedFloat64Array()
var my := PackedFloat64Array()
var cycles := PackedFloat64Array()
var re := PackedFloat64Array()
var im := PackedFloat64Array()
var factor := PackedFloat64Array()  # 1 / (k tanh(k depth)) [m]

var _place := -1  # in the plane of the wave that was read last


class Water:
	extends RefCounted
	var x0: float  # place at rest [m]
	var y0: float
	var x: float  # place now [m]
	var y: float
	var height: float
	var normal := Vector3(0.0, 0.0, 1.0)  # unit, z up
	var residual: float  # distance from the place that was asked for [m]
	var jacobian := 1.0  # 0 or less: in a fold, one of several
	var xx := 1.0  # of the place now: dx/dx0, dx/dy0 = dy/dx0, dy/dy0
	var xy := 0.0
	var yy := 1.0


func _init(folder: String, strongest: int = -1) -> void:
	if not _read(folder):
		push_error(error)
		document = {}
		tile.clear()
	elif strongest >= 0 and strongest < tile.size():
		_keep(strongest)


# Water that rests at (x0, y0): it is at (x, y, height) now.
func rest(x0: float, y0: float, t: float) -> Water:
	return _water(x0, y0, x0, y0, t)


# Water above (x, y), that is x0 + choppiness D(x0) = x, by Newton's method.
func at(x: float, y: float, t: float) -> Water:
	var water := _water(x, y, x, y, t)
	var least := water.jacobian
	for i in 30:
		if water.residual <= 1e-9:
			break
		var dx := water.x - x
		var dy := water.y - y
		var j := maxf(water.jacobian, 0.2)  # short steps near a fold
		var x0 := water.x0 - (water.yy * dx - water.xy * dy) / j
		var y0 := water.y0 - (water.xx * dy - water.xy * dx) / j
		water = _water(x, y, x0, y0, t)
		least = minf(least, water.jacobian)
	water.jacobian = least
	return water


func _water(x: float, y: float, x0: float, y0: float, t: float) -> Water:
	var now := fmod(t, loop) / loop
	var place := PackedFloat64Array()  # in each tile's own period, and its wavenumbers
	for one: Dictionary in document.get("tiles", []):
		var lx: float = one["size"][0]
		var ly: float = one["size"][1]
		place.append_array([fmod(x0, lx) / lx, fmod(y0, ly) / ly, TAU / lx, TAU / ly])
	var height := 0.0
	var dx := 0.0
	var dy := 0.0
	var sx := 0.0
	var sy := 0.0
	var xx := 0.0
	var xy := 0.0
	var yy := 0.0
	for i in tile.size():
		var first := 4 * tile[i]
		var turn := mx[i] * place[first] + my[i] * place[first + 1] - cycles[i] * now
		var angle := TAU * (turn - roundf(turn))
		var c := cos(angle)
		var s := sin(angle)
		var a := re[i] * c - im[i] * s
		var b := re[i] * s + im[i] * c
		var kx := mx[i] * place[first + 2]
		var ky := my[i] * place[first + 3]
		var f := factor[i]
		height += a
		sx -= kx * b
		sy -= ky * b
		dx -= kx * f * b
		dy -= ky * f * b
		xx -= kx * kx * f * a
		xy -= kx * ky * f * a
		yy -= ky * ky * f * a
	var water := Water.new()
	water.x0 = x0
	water.y0 = y0
	water.x = x0 + choppiness * dx
	water.y = y0 + choppiness * dy
	water.height = height
	water.residual = sqrt((water.x - x) ** 2 + (water.y - y) ** 2)
	water.xx = 1.0 + choppiness * xx
	water.xy = choppiness * xy
	water.yy = 1.0 + choppiness * yy
	water.jacobian = water.xx * water.yy - water.xy * water.xy
	var across := water.xy * sy - water.yy * sx
	var along := water.xy * sx - water.xx * sy
	water.normal = Vector3(across, along, water.jacobian).normalized()
	return water


# Keep the strongest waves alone.
func _keep(strongest: int) -> void:
	var order := range(tile.size())
	order.sort_custom(func(i: int, j: int) -> bool: return [-_square(i), i] < [-_square(j), j])
	var lost := 0.0
	for i: int in order.slice(strongest):
		lost += _square(i) / 2.0
	neglected_rms = sqrt(lost)
	var kept: Array = order.slice(0, strongest)
	tile = PackedInt32Array(kept.map(func(i: int) -> int: return tile[i]))
	mx = _picked(mx, kept)
	my = _picked(my, kept)
	cycles = _picked(cycles, kept)
	re = _picked(re, kept)
	im = _picked(im, kept)
	factor = _picked(factor, kept)


func _picked(values: PackedFloat64Array, kept: Array) -> PackedFloat64Array:
	return PackedFloat64Array(kept.map(func(i: int) -> float: return values[i]))


func _square(i: int) -> float:
	return re[i] * re[i] + im[i] * im[i]


# Read a package; return true if it is whole. The first rule that is broken becomes `error`.
func _read(folder: String) -> bool:
	if not (_read_document(folder) and _require_values()):
		return false
	loop = document["loop"]
	choppiness = document["choppiness"]
	for index: int in document["tiles"].size():
		if not (_require_tile(index) and _read_tile(folder, index)):
			return false
	return true


func _must(right: bool, rule: String) -> bool:
	if not right:
		error = rule
	return right


# Read the document; its checksum is that of all before the last key.
func _read_document(folder: String) -> bool:
	var path := folder.path_join("sea.json")
	if not _must(FileAccess.file_exists(path), "sea.json does not exist"):
		return false
	var file := FileAccess.open(path, FileAccess.READ)
	var size := file.get_length()
	if not _must(size <= MOST, "sea.json must have at most %d bytes, got %d" % [MOST, size]):
		return false
	var bytes := file.get_buffer(size)
	if not _must(_depth(bytes) <= DEEPEST, "sea.json must nest at most %d deep" % DEEPEST):
		return false
	var json := JSON.new()
	var parsed := json.parse(bytes.get_string_from_utf8()) == OK
	if not _must(parsed and json.data is Dictionary, "sea.json must be JSON"):
		return false
	document = json.data
	var format := str(document.get("format"))
	var version: Variant = document.get("version")
	var check := str(document.get("check"))
	var end := (',\n  "check": "%s"\n}\n' % check).to_utf8_buffer()
	var start := maxi(bytes.size() - end.size(), 0)
	var before := bytes.slice(0, start) + "\n}\n".to_utf8_buffer()
	var rule := "format of sea.json must be fftocean-runtime, got %s" % format
	return (
		_must(format == "fftocean-runtime", rule)
		and _must(
			_is_number(version) and version == 1,
			"version of sea.json must be 1, got %s" % [version]
		)
		and _must(
			bytes.slice(start) == end and _sha256(before) == check,
			"sea.json was changed after it was written"
		)
	)


func _require_values() -> bool:
	var tiles: Variant = document.get("tiles")
	var depth: Variant = document.get("depth")
	return (
		_must(
			_is_power(document.get("ticks"), MOST),
			"ticks of sea.json must be a power of two from 2 to 1048576"
		)
		and _must(
			tiles is Array and tiles.size() >= 1 and tiles.size() <= 16,
			"tiles of sea.json must be a list of 1 to 16"
		)
		and _must(document.get("files") is Array, "files of sea.json must be a list")
		and _must(_is_positive(document.get("loop")), "loop of sea.json must be a positive number")
		and _must(_is_number(document.get("choppiness")), "choppiness of sea.json must be a number")
		and _must(
			depth == null or _is_positive(depth),
			"depth of sea.json must be null or a positive number"
		)
	)


func _require_tile(index: int) -> bool:
	var of := "of tile %d in sea.json must" % index
	var given: Variant = document["tiles"][index]
	var one: Dictionary = given if given is Dictionary else {}
	var power := func(side: Variant) -> bool: return _is_power(side, 1024)
	return (
		_must(_is_pair(one.get("n"), power), "n %s be two powers of two from 2 to 1024" % of)
		and _must(_is_pair(one.get("size"), _is_positive), "size %s be two positive numbers" % of)
		and _must(
			(
				_is_whole(one.get("waves"), int(one["n"][0]) * int(one["n"][1]))
				and _is_whole(one.get("most_cycles"), 65535)
			),
			"waves %s fit its n and most_cycles" % of
		)
	)


func _read_tile(folder: String, index: int) -> bool:
	var one: Dictionary = document["tiles"][index]
	var file := "tile%d.waves" % index
	var path := folder.path_join(file)
	var expected := 14 * int(one["waves"])
	var digest := ""
	for row: Variant in document["files"]:
		if row is Dictionary and row.get("name") == file and row.get("bytes") == expected:
			digest = str(row.get("sha256"))
	var listed := "sea.json must list %s with %d bytes and its SHA-256" % [file, expected]
	if not _must(digest.length() == 64, listed):
		return false
	if not _must(FileAccess.file_exists(path), "%s does not exist" % file):
		return false
	var bytes := FileAccess.get_file_as_bytes(path)
	var size := bytes.size()
	if not _must(size == expected, "%s must have %d bytes, got %d" % [file, expected, size]):
		return false
	if not _must(_sha256(bytes) == digest, "%s was changed after it was written" % file):
		return false
	_place = -1
	for i in int(one["waves"]):
		var rule := _add_wave(bytes, 14 * i, index)
		if not _must(rule == "", "record %d of %s must %s" % [i, file, rule]):
			return false
	return true


# Add the wave at a byte; return the rule that it breaks, or "".
func _add_wave(bytes: PackedByteArray, at_byte: int, index: int) -> String:
	var one: Dictionary = document["tiles"][index]
	var nx := int(one["n"][0])
	var ny := int(one["n"][1])
	var x := bytes.decode_s16(at_byte)
	var y := bytes.decode_s16(at_byte + 2)
	var turns := bytes.decode_u16(at_byte + 4)
	var kx := TAU * x / float(one["size"][0])
	var ky := TAU * y / float(one["size"][1])
	var k := sqrt(kx * kx + ky * ky)
	var depth: Variant = document.get("depth")
	tile.append(index)
	mx.append(x)
	my.append(y)
	cycles.append(turns)
	re.append(2.0 * bytes.decode_float(at_byte + 6))
	im.append(2.0 * bytes.decode_float(at_byte + 10))
	factor.append(1.0 / (k * tanh(k * depth) if depth != null else k))
	var square := _square(re.size() - 1)
	var before := _place
	_place = posmod(y, ny) * nx + posmod(x, nx)
	if 2 * absi(x) >= nx or 2 * absi(y) >= ny or (x == 0 and y == 0):
		return "have |mx| < %d and |my| < %d, not both 0" % [nx >> 1, ny >> 1]
	if _place <= before:
		return "follow the one before in the plane"
	if not is_finite(square) or square == 0.0:
		return "have a finite amplitude, not 0"
	if turns < 1 or turns > int(one["most_cycles"]):
		return "have 1 to %d cycles" % int(one["most_cycles"])
	return ""


# Depth of JSON, of lists and objects alike.
func _depth(bytes: PackedByteArray) -> int:
	var depth := 0
	var deepest := 0
	var text := false
	var escaped := false
	for byte in bytes:
		if escaped:
			escaped = false
		elif byte == 92:  # a backslash
			escaped = text
		elif byte == 34:  # a quote
			text = not text
		elif not text and byte in [91, 123]:
			depth += 1
			deepest = maxi(deepest, depth)
		elif not text and byte in [93, 125]:
			depth -= 1
	return deepest


func _sha256(bytes: PackedByteArray) -> String:
	var context := HashingContext.new()
	context.start(HashingContext.HASH_SHA256)
	if not bytes.is_empty():
		context.update(bytes)
	return context.finish().hex_encode()


func _is_number(value: Variant) -> bool:
	return (value is float or value is int) and is_finite(value)


func _is_positive(value: Variant) -> bool:
	return _is_number(value) and value > 0.0


func _is_whole(value: Variant, most: int) -> bool:
	return _is_number(value) and value >= 0 and value <= most and value == floor(value)


func _is_power(value: Variant, most: int) -> bool:
	return _is_whole(value, most) and value >= 2 and int(value) & (int(value) - 1) == 0


func _is_pair(value: Variant, rule: Callable) -> bool:
	return value is Array and value.size() == 2 and rule.call(value[0]) and rule.call(value[1])
