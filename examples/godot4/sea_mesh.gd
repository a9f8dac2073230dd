# Mesh of the water: rings about the camera, wider and wider, out to the horizon.
extends RefCounted

const COLUMNS := 256
const GROWTH := 1.045
const FARTHEST := 20000.0 # [m]


# Return the mesh. UV2 of a vertex: its distance from the middle, and the gap to the next ring [m].
static func rings() -> ArrayMesh:
	var radii := PackedFloat32Array([0.0])
	var radius := 0.6
	while radius < FARTHEST:
		radii.append(radius)
		radius *= GROWTH
	var places := PackedVector3Array()
	var gaps := PackedVector2Array()
	for i in radii.size():
		var gap := radii[mini(i + 1, radii.size() - 1)] - radii[i]
		if gap == 0.0:
			gap = radii[i] * (GROWTH - 1.0)
		for c in COLUMNS:
			var angle := TAU * c / COLUMNS
			places.append(radii[i] * Vector3(cos(angle), 0.0, sin(angle)))
			gaps.append(Vector2(radii[i], gap))
	var index := PackedInt32Array()
	for i in radii.size() - 1:
		for c in COLUMNS:
			var first := i * COLUMNS + c
			var next := i * COLUMNS + (c + 1) % COLUMNS
			index.append_array([first, next, first + COLUMNS])
			index.append_array([next, next + COLUMNS, first + COLUMNS])
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = places
	arrays[Mesh.ARRAY_TEX_UV2] = gaps
	arrays[Mesh.ARRAY_INDEX] = index
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh
