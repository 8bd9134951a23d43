//! The ball that rolls on the land, and the camera behind it.

use avian3d::prelude::*;
use bevy::prelude::*;

use crate::ground_plugin::{ShownGround, Viewer};

/// Radius of the ball, in metres.
pub const RADIUS: f32 = 1.5;

/// Force of a push, in newtons for each kilogram.
const PUSH: f32 = 12.0;

/// The place of the camera from the ball, in metres.
const BEHIND: Vec3 = Vec3::new(-17.0, 7.0, 12.0);

/// The ball.
#[derive(Component)]
pub struct Ball;

/// Which way the ball is pushed without a keyboard.
#[derive(Resource)]
pub struct Push(pub Vec3);

/// Puts the ball on the land as soon as the ground around it is complete.
pub fn drop_ball(
    shown: Res<ShownGround>,
    ball: Query<(), With<Ball>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    if !shown.is_complete || !ball.is_empty() {
        return;
    }
    let [east, south] = shown.origin;
    let height = match shown.ground.height(east, south) {
        Ok(height) => height,
        Err(error) => {
            error!("{error}");
            return;
        }
    };
    commands.spawn((
        Ball,
        RigidBody::Dynamic,
        Collider::sphere(RADIUS),
        Friction::new(0.9),
        LinearDamping(0.2),
        AngularDamping(0.3),
        SweptCcd::default(),
        ConstantForce::new(0.0, 0.0, 0.0),
        Mesh3d(meshes.add(Sphere::new(RADIUS).mesh().ico(5).unwrap_or_else(|_| Sphere::new(RADIUS).into()))),
        MeshMaterial3d(materials.add(Color::srgb(0.85, 0.22, 0.12))),
        Transform::from_xyz(0.0, height + 1.1 * RADIUS, 0.0),
    ));
}

/// Pushes the ball by the keys, or always the same way without a keyboard.
pub fn push_ball(
    keys: Option<Res<ButtonInput<KeyCode>>>,
    push: Res<Push>,
    mut ball: Query<(&mut ConstantForce, &ComputedMass), With<Ball>>,
) {
    let Ok((mut force, mass)) = ball.single_mut() else { return };
    let mut way = push.0;
    if let Some(keys) = keys {
        let ahead = Vec3::new(-BEHIND.x, 0.0, -BEHIND.z).normalize();
        let right = ahead.cross(Vec3::Y);
        for (key, add) in [
            (KeyCode::KeyW, ahead),
            (KeyCode::KeyS, -ahead),
            (KeyCode::KeyD, right),
            (KeyCode::KeyA, -right),
            (KeyCode::Space, 2.0 * Vec3::Y),
        ] {
            if keys.pressed(key) {
                way += add;
            }
        }
    }
    force.0 = way * PUSH * mass.value();
}

/// Keeps the camera behind the ball, and above the ground.
pub fn follow_ball(
    shown: Res<ShownGround>,
    ball: Query<&Transform, (With<Ball>, Without<Viewer>)>,
    mut camera: Query<&mut Transform, With<Viewer>>,
) {
    let (Ok(ball), Ok(mut camera)) = (ball.single(), camera.single_mut()) else { return };
    let mut eye = ball.translation + BEHIND;
    let [east, south] = shown.origin;
    if let Ok(ground) = shown.ground.height(east + f64::from(eye.x), south + f64::from(eye.z)) {
        eye.y = eye.y.max(ground + 3.0);
    }
    *camera = Transform::from_translation(eye).looking_at(ball.translation + 3.0 * Vec3::Y, Vec3::Y);
}
