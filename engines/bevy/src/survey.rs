//! What a run without a window prints, for comparison with the land: where the ball is, and where rays from above hit
//! the colliders.

use avian3d::prelude::*;
use bevy::prelude::*;

use crate::ball::Ball;
use crate::ground_plugin::ShownGround;

/// Half the side of the square around the ball that rays fall on, in metres: more than half a chunk with the default
/// cell, so that the square has borders of chunks both ways.
const REACH: f64 = 76.0;

/// Distance between rays, in metres. The cell is no multiple of it: rays hit all parts of triangles.
const STEP: f64 = 3.7;

/// Samples from one row of rays along samples to the next.
const SAMPLES: f64 = 3.0;

/// Distance of rays beside the border of a chunk from the border, in metres.
const BESIDE: f64 = 0.01;

/// Height above the ball from which rays fall, in metres. Not more: distances have 24 bits.
const ABOVE: f32 = 500.0;

/// Prints a line `ball EAST HEIGHT SOUTH`.
pub fn print_ball(shown: Res<ShownGround>, ball: Query<&Transform, With<Ball>>) {
    let Ok(ball) = ball.single() else { return };
    let Vec3 { x, y, z } = ball.translation;
    let [east, south] = shown.origin;
    println!("ball {} {y} {}", east + f64::from(x), south + f64::from(z));
}

/// Prints a line `ray EAST SOUTH HIT` for each ray in a square around the ball, with the height that it hits or `none`.
pub fn print_survey(shown: Res<ShownGround>, rays: SpatialQuery, ball: Query<(Entity, &Transform), With<Ball>>) {
    let Ok((ball, at)) = ball.single() else { return };
    let [east, south] = shown.origin;
    let filter = SpatialQueryFilter::from_excluded_entities([ball]);
    let from = at.translation.y + ABOVE;
    let columns = places(&shown, east + f64::from(at.translation.x));
    for z in places(&shown, south + f64::from(at.translation.z)) {
        for x in &columns {
            let [x, z] = [(x - east) as f32, (z - south) as f32];
            let hit = rays.cast_ray(Vec3::new(x, from, z), Dir3::NEG_Y, 2.0 * ABOVE, true, &filter);
            let [x, z] = [east + f64::from(x), south + f64::from(z)];
            match hit {
                Some(hit) => println!("ray {x} {z} {}", from - hit.distance),
                None => println!("ray {x} {z} none"),
            }
        }
    }
}

/// Where rays are along an axis: a few metres apart, on samples, and on and closely beside the borders of chunks.
fn places(shown: &ShownGround, middle: f64) -> Vec<f64> {
    let multiples = |step: f64| {
        let [first, last] = [((middle - REACH) / step).ceil() as i64, ((middle + REACH) / step).floor() as i64];
        (first..=last).map(move |index| index as f64 * step)
    };
    let borders = multiples(shown.lod.side(0)).flat_map(|border| [border - BESIDE, border, border + BESIDE]);
    multiples(STEP).chain(multiples(SAMPLES * shown.lod.cell)).chain(borders).collect()
}
