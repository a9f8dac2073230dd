# A buoy of 2 m, striped in half metres: it shows the scale, and that heights can be asked for.
extends Node3D

const HULL := 0.45 # it follows the mean of the water at four places this far out [m]
const PARTS := [ # bottom, top [m above the water line]; radius there; colour
	[-0.6, -0.1, 0.12, 0.42, Color(0.3, 0.06, 0.04)],
	[-0.1, 0.3, 0.42, 0.42, Color(0.95, 0.75, 0.1)],
	[0.3, 0.42, 0.42, 0.24, Color(0.95, 0.75, 0.1)],
	[0.42, 0.9, 0.24, 0.15, Color(0.8, 0.1, 0.06)],
	[0.9, 1.3, 0.15, 0.075, Color(0.95, 0.75, 0.1)],
	[1.3, 1.77, 0.035, 0.035, Color(0.8, 0.1, 0.06)],
	[1.77, 2.0, 0.085, 0.06, Color(0.9, 0.9, 0.9)],
]

@export var water: NodePath # a node with `height_at(x, z)`


func _ready() -> void:
	for part: Array in PARTS:
		var mesh := CylinderMesh.new()
		mesh.height = part[1] - part[0]
		mesh.bottom_radius = part[2]
		mesh.top_radius = part[3]
		var paint := StandardMaterial3D.new()
		paint.albedo_color = part[4]
		paint.roughness = 0.4
		mesh.material = paint
		var instance := MeshInstance3D.new()
		instance.mesh = mesh
		instance.position.y = (part[0] + part[1]) / 2.0
		add_child(instance)


func _process(_delta: float) -> void:
	var sea := get_node_or_null(water)
	if sea == null or not sea.has_method("height_at"):
		return
	var x := position.x
	var z := position.z
	var east: float = sea.height_at(x + HULL, z)
	var west: float = sea.height_at(x - HULL, z)
	var south: float = sea.height_at(x, z + HULL)
	var north: float = sea.height_at(x, z - HULL)
	position.y = (east + west + south + north) / 4.0
	var tilt := Vector3(west - east, 2.0 * HULL / 0.7, north - south).normalized()
	basis = Basis(Quaternion(Vector3.UP, tilt))
