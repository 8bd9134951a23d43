//! The triangles of a mesh that has every sample of a grid as a vertex, two for each cell.

/// Whether a cell is split along the diagonal from its north-west to its south-east corner instead of the other one.
/// The diagonal with the smaller difference in height is chosen. If one corner is missing (not finite), it is the
/// diagonal that keeps the triangle of the other three. `corners` are the heights in the north-west, north-east,
/// south-west and south-east.
#[must_use]
pub fn falls([nw, ne, sw, se]: [f32; 4]) -> bool {
    match [nw, ne, sw, se].map(|corner| !corner.is_finite()) {
        [false, false, true, false] | [false, true, false, false] => true,
        [true, false, false, false] | [false, false, false, true] => false,
        _ => (nw - se).abs() <= (ne - sw).abs(),
    }
}

/// The height of the mesh in a cell with these corners (as in [`falls`]). `u` is the share of the way from west to east
/// and `v` from north to south, each 0 to 1. NaN where the mesh has no triangle.
#[must_use]
pub fn height(corners: [f32; 4], [u, v]: [f64; 2]) -> f64 {
    let [nw, ne, sw, se] = corners.map(f64::from);
    match (falls(corners), u >= v, u + v <= 1.0) {
        (true, true, _) => nw + u * (ne - nw) + v * (se - ne),
        (true, false, _) => nw + v * (sw - nw) + u * (se - sw),
        (false, _, true) => nw + u * (ne - nw) + v * (sw - nw),
        (false, _, false) => se + (1.0 - u) * (sw - se) + (1.0 - v) * (ne - se),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mesh_goes_through_its_corners_and_is_flat_between_them() {
        for corners in [[1.0, 4.0, 9.0, 2.0], [5.0, 1.0, 2.0, 9.0]] {
            let at = |u, v| height(corners, [u, v]);
            assert_eq!([at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)], corners.map(f64::from));
            let diagonal = if falls(corners) { [corners[0], corners[3]] } else { [corners[1], corners[2]] };
            assert_eq!(at(0.5, 0.5), f64::from(diagonal[0] + diagonal[1]) / 2.0);
            let triangle = if falls(corners) {
                [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)]
            } else {
                [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]
            };
            let inside = if falls(corners) { at(0.75, 0.5) } else { at(0.25, 0.5) };
            let weights = [0.25, 0.25, 0.5];
            let expect: f64 = triangle.iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
            assert!((inside - expect).abs() < 1e-12, "{inside} {expect}");
        }
    }

    #[test]
    fn a_missing_corner_leaves_one_triangle() {
        let corners = [1.0, f32::NAN, 3.0, 4.0];
        assert_eq!(height(corners, [0.25, 0.75]), 1.0 + 0.75 * 2.0 + 0.25);
        assert!(height(corners, [0.75, 0.25]).is_nan());
    }
}
