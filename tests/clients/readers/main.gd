# Answers the questions of ask.txt by sea_waves.gd: see tests/clients/sea_waves.py.
extends Node

const SeaWaves := preload("res://sea_waves.gd")


func _ready() -> void:
	var answers := PackedStringArray()
	var sea: SeaWaves
	for line: String in FileAccess.get_file_as_string("res://ask.txt").strip_edges().split("\n"):
		var words := line.split(" ")
		if words[0] == "sea":
			sea = SeaWaves.new("res://" + words[1], int(words[2]))
			if sea.error:
				answers.append("error " + sea.error)
			else:
				answers.append("ok %.17f" % sea.neglected_rms)
			continue
		var p := [float(words[1]), float(words[2]), float(words[3])]
		var w: SeaWaves.Water = sea.callv(words[0], p)
		var n := w.normal
		var all := [w.x0, w.y0, w.x, w.y, w.height, n.x, n.y, n.z, w.residual, w.jacobian]
		answers.append(" ".join(all.map(func(value: float) -> String: return "%.15f" % value)))
	print("ANSWER ", JSON.stringify(["lines", answers]))
	print("DONE")
