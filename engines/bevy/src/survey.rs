//! What a run without a window prints: where rays from above hit the colliders, for comparison with the land.

use avian3d::prelude::*;
use bevy::prelude::*;

use crate::ball::Ball;
use crate::ground_plugin::ShownGround;

/// Rays along each side of the square around the ball.
const RAYS: i32 = 41;

/// Distance between rays, in metres. Not a divisor of the cell: rays hit samples, edges and the middles of triangles.
const STEP: f32 = 3.7;

/// Height from which rays fall, in metres.
const ABOVE: f32 = 10_000.0;

/// Prints a line `ray EAST SOUTH HIT` for each ray in a square around the ball, with the height that it hits or `none`,
/// and a line `ball EAST HEIGHT SOUTH`.
pub fn print_survey(shown: Res<ShownGround>, rays: SpatialQuery, ball: Query<(Entity, &Transform), With<Ball>>) {
    let Ok((ball, at)) = ball.single() else { return };
    let [east, south] = shown.origin;
    let filter = SpatialQueryFilter::from_excluded_entities([ball]);
    for row in -RAYS / 2..=RAYS / 2 {
        for column in -RAYS / 2..=RAYS / 2 {
            // Every second row runs along the whole metres of samples and of borders between chunks.
            let place = |index: i32, middle: f32| match row % 2 {
                0 => middle.round() + (index as f32 * STEP).round(),
                _ => middle + index as f32 * STEP,
            };
            let [x, z] = [place(column, at.translation.x), place(row, at.translation.z)];
            let hit = rays.cast_ray(Vec3::new(x, ABOVE, z), Dir3::NEG_Y, 2.0 * ABOVE, true, &filter);
            let [x, z] = [east + f64::from(x), south + f64::from(z)];
            match hit {
                Some(hit) => println!("ray {x} {z} {}", ABOVE - hit.distance),
                None => println!("ray {x} {z} none"),
            }
        }
    }
    let Vec3 { x, y, z } = at.translation;
    println!("ball {} {y} {}", east + f64::from(x), south + f64::from(z));
}
