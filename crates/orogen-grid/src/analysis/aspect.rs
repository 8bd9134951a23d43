//! Aspect: the downhill direction of the ground.

use super::slope::{Gradient, from_gradients};
use crate::grid::Grid;

/// The downhill direction in degrees clockwise from north, in 0.0..360.0; NaN where the ground is level or a sample is
/// not finite. Uses Horn's gradients (see [`slope`](super::slope)). The result is smaller than `grid` by a border of
/// one sample.
pub fn aspect(grid: &Grid) -> Grid {
    from_gradients(grid, aspect_of)
}

/// The aspect of one gradient, in degrees clockwise from north; NaN on level ground.
#[must_use]
pub fn aspect_of(gradient: Gradient) -> f32 {
    if gradient.east == 0.0 && gradient.north == 0.0 {
        return f32::NAN;
    }
    // The downhill direction is opposite to the gradient. atan2 of (east, north) is clockwise from north.
    let degrees = libm::atan2f(-gradient.east, -gradient.north).to_degrees();
    let turned = if degrees < 0.0 { degrees + 360.0 } else { degrees };
    if turned >= 360.0 { 0.0 } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn planes_face_the_way_they_fall() {
        for (degrees, east, south) in [
            (0.0, 0.0, -1.0),
            (45.0, 1.0, -1.0),
            (90.0, 1.0, 0.0),
            (135.0, 1.0, 1.0),
            (180.0, 0.0, 1.0),
            (225.0, -1.0, 1.0),
            (270.0, -1.0, 0.0),
            (315.0, -1.0, -1.0),
        ] {
            // The plane falls towards (east, south).
            let mut plane = Grid::filled(Window::new(5, 5, 10.0), 0.0f32);
            for j in 0..5 {
                for i in 0..5 {
                    plane.row_mut(j)[i] = -(east * i as f32 + south * j as f32);
                }
            }
            assert!(aspect(&plane).data().iter().all(|a| (a - degrees).abs() < 1e-3), "{degrees}");
        }
    }

    #[test]
    fn level_ground_faces_nowhere() {
        assert!(aspect(&Grid::filled(Window::new(4, 4, 1.0), 3.0)).data().iter().all(|a| a.is_nan()));
        assert_eq!(aspect_of(Gradient { east: 1e-30, north: -1.0 }), 0.0);
    }
}
