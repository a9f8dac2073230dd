# Heights of a baked sea in Godot 4:
#     fftocean bake sea.toml -o sea --engine godot --maps height --format bin --lookup eulerian
#     var sea := SeaHeights.new("res://sea/height.json")
#     var y := sea.at(boat.position.x, boat.position.z, Time.get_ticks_msec() / 1000.0)
# For a file that this reader does not support, `error` is set and there are no heights.
# In an export preset, list *.bin and *.json as files to include.
class_name SeaHeights
extends RefCounted

const EXPECTED := {
	"schema": 1.0,
	"dtype": "float16, little-endian",
	"levels": 1.0,
	"lookup": "eulerian",
	"closes": true,
}

var s: Dictionary
var heights: PackedFloat32Array # [frame, row, column], metres
var error := ""


func _init(json: String) -> void:
	error = _read(json)
	if error:
		push_error(error)


# Read a sidecar and its file; return the error, or "".
func _read(json: String) -> String:
	var found: Variant = JSON.parse_string(FileAccess.get_file_as_string(json))
	if not found is Dictionary:
		return "%s must be a sidecar in JSON" % json
	s = found
	for key: String in EXPECTED:
		var got: Variant = s.get(key)
		if typeof(got) == TYPE_INT:
			got = float(got)
		if typeof(got) != typeof(EXPECTED[key]) or got != EXPECTED[key]:
			return "%s must be %s, got %s" % [key, EXPECTED[key], got]
	if s["channels"]["R"] != "height":
		return "R must be height, got %s" % s["channels"]["R"]
	var bytes := FileAccess.get_file_as_bytes(json.get_base_dir().path_join(s["file"]))
	var count := int(s["frames"]) * int(s["rows"]) * int(s["columns"])
	if bytes.size() != 8 * count:
		return "%s must have %d bytes, got %d" % [s["file"], 8 * count, bytes.size()]
	heights.resize(count)
	for i in count:
		heights[i] = bytes.decode_half(8 * i) # R of RGBA
	return ""


# Bilinear between samples, linear between frames; the sea repeats in x, z and t.
func at(x: float, z: float, t: float) -> float:
	if error:
		return NAN
	var frames := int(s["frames"])
	var rows := int(s["rows"])
	var columns := int(s["columns"])
	var place := [
		(t - s["start"]) / s["loop"] * frames,
		s["row_origin"] + s["row_sign"] * z / s["size"][1] * rows,
		x / s["size"][0] * columns,
	]
	var sum := 0.0
	for corner in 8:
		var weight := 1.0
		var index := [0, 0, 0]
		for axis in 3:
			var bit := (corner >> axis) & 1
			var part: float = place[axis] - floor(place[axis])
			weight *= part if bit == 1 else 1.0 - part
			index[axis] = posmod(int(floor(place[axis])) + bit, [frames, rows, columns][axis])
		sum += weight * heights[(index[0] * rows + index[1]) * columns + index[2]]
	return sum
