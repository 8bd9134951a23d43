//! Calderas.

use super::Ground;
use crate::random::Random;
use std::f64::consts::TAU;

/// Slope of the walls: 40 degrees, the mean of cliffs and the talus below them.
const WALL: f64 = 0.84;

/// The radius varies with the direction by waves of these numbers around the circle, each by up to this share.
const WAVES: [f64; 4] = [2.0, 3.0, 5.0, 9.0];
const UNEVEN: f64 = 0.05;

/// Halvings of the interval that contains the height of the floor.
const HALVINGS: u32 = 40;

/// Lets the ground within a diameter sink to a flat floor with walls, so that a volume in m^3 is lost, and returns that
/// volume.
pub(super) fn collapse(
    ground: &mut Ground,
    center: [f64; 2],
    diameter: f64,
    volume: f64,
    age: f32,
    random: &mut Random,
) -> f64 {
    let cell = ground.window.cell;
    let waves = WAVES.map(|wave| [wave, UNEVEN * random.share(), TAU * random.share()]);
    let radius = |[x, y]: [f64; 2]| {
        let angle = libm::atan2(y, x);
        let uneven: f64 = waves.iter().map(|[wave, by, phase]| by * libm::cos(wave * angle + phase)).sum();
        0.5 * diameter * (1.0 + uneven)
    };
    // Height over the floor at which the wall is, negative on the floor.
    let within: Vec<(usize, f64)> = ground
        .around(center, 1.5 * diameter / cell)
        .filter(|(at, _)| ground.height[*at].is_finite())
        .map(|(at, offset)| {
            let distance = cell * (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            (at, WALL * (distance - radius(offset)).max(0.0))
        })
        .collect();
    let sunk = |height: f64, wall: f64, floor: f64| (height - floor - wall).max(0.0);
    let inside = within.iter().filter(|(_, wall)| *wall == 0.0).map(|(at, _)| ground.height[*at]);
    let top = inside.fold(f64::NEG_INFINITY, f64::max);
    if !top.is_finite() {
        return 0.0;
    }
    let area = cell * cell;
    // At most as deep as half of the diameter.
    let (mut low, mut high) = (top - 0.5 * diameter, top);
    for _ in 0..HALVINGS {
        let floor = 0.5 * (low + high);
        let lost: f64 = area * within.iter().map(|(at, wall)| sunk(ground.height[*at], *wall, floor)).sum::<f64>();
        if lost > volume {
            low = floor;
        } else {
            high = floor;
        }
    }
    let mut lost = 0.0;
    for (at, wall) in within {
        let by = sunk(ground.height[at], wall, high);
        if by > 0.0 {
            ground.sink(at, by, age);
            lost += by;
        }
    }
    lost * area
}
