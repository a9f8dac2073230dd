# Camera about the origin: drag to turn, wheel to come nearer. Crests lift it.
extends Camera3D

@export var water: NodePath # a node with `height_at(x, z)`
@export var distance := 11.0 # [m]
@export var bearing := 0.6 # [radians]
@export var elevation := 0.28 # [radians]


func _unhandled_input(event: InputEvent) -> void:
	if event is InputEventMouseMotion and event.button_mask & MOUSE_BUTTON_MASK_LEFT:
		bearing += 0.005 * event.relative.x
		elevation = clampf(elevation + 0.005 * event.relative.y, 0.03, 1.4)
	elif event is InputEventMouseButton and event.pressed:
		if event.button_index == MOUSE_BUTTON_WHEEL_UP:
			distance = maxf(distance / 1.1, 3.0)
		elif event.button_index == MOUSE_BUTTON_WHEEL_DOWN:
			distance = minf(distance * 1.1, 400.0)


func _process(_delta: float) -> void:
	var level := distance * cos(elevation)
	var place := Vector3(level * sin(bearing), 1.2 + distance * sin(elevation), level * cos(bearing))
	var sea := get_node_or_null(water)
	if sea and sea.has_method("height_at"):
		place.y = maxf(place.y, sea.height_at(place.x, place.z) + 0.6)
	look_at_from_position(place, Vector3(0.0, 1.0, 0.0))
