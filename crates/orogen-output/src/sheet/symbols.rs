//! Symbols of points.

use super::geometry::Point;
use super::scene::{Step, polygon};

/// Radius of the dot of a place, in millimetres.
pub const DOT: f32 = 0.7;

/// A small triangle around a point.
pub fn triangle(Point { x, y }: Point) -> Vec<Step> {
    polygon([[x, y - 0.95], [x + 0.85, y + 0.6], [x - 0.85, y + 0.6]])
}

/// A dot at a place.
pub fn dot(Point { x, y }: Point) -> Vec<Step> {
    let corner = |k: i32| {
        let (sin, cos) = libm::sincosf(std::f32::consts::TAU * k as f32 / 24.0);
        [x + DOT * cos, y + DOT * sin]
    };
    polygon((0..24).map(corner))
}
