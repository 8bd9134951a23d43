class_name Terrain
extends Node3D
## Ground around a viewer: meshes as far as one sees, colliders near by.
##
## Worker threads of the extension make the chunks; this node adds what is made.

## A preset, a recipe or a file of heights.
@export var source := "endless"
## The seed; the recipe's own if it is negative.
@export var seed_value := -1
## Distance between samples near the viewer, in metres.
@export var cell := 2.0
## Number of levels, each with samples twice as far apart.
@export var levels := 6
## Range of sight, in metres.
@export var view_range := 6000.0
## Levels whose chunks have colliders.
@export var collider_levels := 1
## Chunks that are added per frame at most.
@export var chunks_per_frame := 4
## The node that the ground is made around.
@export var viewer: Node3D
## Metres east and south of the world's origin at the origin of the scene.
@export var origin := Vector2.ZERO

var world := OrogenWorld.new()
var _chunks := OrogenChunks.new()
var _shown := {}
var _material := StandardMaterial3D.new()


func _ready() -> void:
	_material.vertex_color_use_as_albedo = true
	_material.roughness = 0.95
	if not world.open_with(source, seed_value, {}):
		return
	_chunks.start(world, "height", cell, levels, view_range, 2)


func _process(_delta: float) -> void:
	if viewer == null:
		return
	var at := viewer.global_position
	_chunks.set_viewer(origin.x + at.x, origin.y + at.z)
	for _count in chunks_per_frame:
		var made := _chunks.next_made()
		if made.is_empty():
			break
		_show(made)
	var dropped := _chunks.next_dropped()
	while dropped >= 0:
		_shown[dropped].queue_free()
		_shown.erase(dropped)
		dropped = _chunks.next_dropped()


## Whether all ground around the viewer is there.
func is_complete() -> bool:
	return _chunks.is_complete()


## The height of the ground at a point of the scene, in metres.
func height(x: float, z: float) -> float:
	return _chunks.height(origin.x + x, origin.y + z)


func _show(made: Dictionary) -> void:
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, made.arrays)
	mesh.surface_set_material(0, _material)
	var chunk := MeshInstance3D.new()
	chunk.mesh = mesh
	chunk.position = Vector3(made.x - origin.x, 0.0, made.z - origin.y)
	if made.level < collider_levels:
		chunk.add_child(_body(made))
	add_child(chunk)
	_shown[made.id] = chunk


## The collider of a chunk: a height map has one unit between samples, and its origin in the middle.
func _body(made: Dictionary) -> StaticBody3D:
	var map := HeightMapShape3D.new()
	map.map_width = made.width
	map.map_depth = made.depth
	map.map_data = made.heights_in_cells
	var shape := CollisionShape3D.new()
	shape.shape = map
	shape.scale = Vector3.ONE * made.cell
	shape.position = Vector3(made.width - 1, 0.0, made.depth - 1) * made.cell / 2.0
	var body := StaticBody3D.new()
	body.add_child(shape)
	return body
