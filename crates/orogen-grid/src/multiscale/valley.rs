//! The positions of valleys between the samples of given land.

/// Maximum distance of a valley from the middle of a cell, in cells, so that it belongs to the cell. It is slightly
/// more than half a cell, because heights have errors.
const IN_CELL: f32 = 0.6;

/// The point of a valley's line that is closest to the middle of a cell, in cells to the east and south of the middle:
/// the lowest point across the direction of the strongest curvature of the quadratic surface through 3 x 3 samples
/// (Steger 1998). (0, 0) if there is no valley in the cell. `height` returns the height of the sample at a number of
/// steps to the east and south of the middle.
pub fn valley(height: impl Fn(i64, i64) -> f32) -> (f32, f32) {
    let h = height;
    let (gx, gy) = (0.5 * (h(1, 0) - h(-1, 0)), 0.5 * (h(0, 1) - h(0, -1)));
    let (xx, yy) = (h(1, 0) - 2.0 * h(0, 0) + h(-1, 0), h(0, 1) - 2.0 * h(0, 0) + h(0, -1));
    let xy = 0.25 * (h(1, 1) - h(1, -1) - h(-1, 1) + h(-1, -1));
    // The larger eigenvalue of the matrix of second derivatives, and its eigenvector.
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = (half * half + xy * xy).sqrt();
    let curvature = mean + radius;
    let (east, south) = if half > 0.0 { (half + radius, xy) } else { (xy, radius - half) };
    let square = east * east + south * south;
    if !(curvature > 0.0 && square > 0.0) {
        return (0.0, 0.0);
    }
    let step = -(gx * east + gy * south) / (square * curvature);
    let (east, south) = (step * east, step * south);
    if east.abs() <= IN_CELL && south.abs() <= IN_CELL { (east, south) } else { (0.0, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_valley_is_found_between_samples() {
        for degrees in (0..180).step_by(15) {
            let angle = f64::from(degrees).to_radians();
            let (sine, cosine) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
            for distance in [-0.4f32, 0.0, 0.25] {
                // A parabola across a line at this distance, falling along the line.
                let height = |x: i64, y: i64| {
                    let across = x as f32 * cosine + y as f32 * sine - distance;
                    let along = y as f32 * cosine - x as f32 * sine;
                    500.0 + 30.0 * across * across - 4.0 * along
                };
                let (east, south) = valley(height);
                assert!((east - distance * cosine).abs() < 1e-3 && (south - distance * sine).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn planes_crests_and_far_valleys_have_none() {
        assert_eq!(valley(|x, y| (3 * x - 5 * y) as f32), (0.0, 0.0));
        assert_eq!(valley(|x, _| -7.0 * (x * x) as f32), (0.0, 0.0));
        assert_eq!(valley(|x, _| (x * x) as f32 - 1.6 * x as f32), (0.0, 0.0));
        assert_eq!(valley(|x, y| if x == y { f32::NAN } else { 2.0 }), (0.0, 0.0));
    }
}
