extends RigidBody3D
## A ball that the arrow keys push, and that waits until the ground is there.

## Force of a push, in newtons for each kilogram.
const PUSH := 12.0
## The place of the camera from the ball, in metres.
const BEHIND := Vector3(-26.0, 15.0, 22.0)

@export var terrain: Terrain
@export var camera: Camera3D


func _ready() -> void:
	freeze = true


func _physics_process(_delta: float) -> void:
	if freeze:
		if terrain.is_complete():
			position.y = terrain.height(position.x, position.z) + 3.0
			freeze = false
		return
	var ahead := Vector3(-BEHIND.x, 0.0, -BEHIND.z).normalized()
	var right := ahead.cross(Vector3.UP)
	var keys := Input.get_vector("ui_left", "ui_right", "ui_down", "ui_up")
	apply_central_force((ahead * keys.y + right * keys.x) * PUSH * mass)


func _process(_delta: float) -> void:
	var eye := global_position + BEHIND
	var ground := terrain.height(eye.x, eye.z)
	if not is_nan(ground):
		eye.y = maxf(eye.y, ground + 3.0)
	camera.look_at_from_position(eye, global_position + Vector3.UP * 3.0)
