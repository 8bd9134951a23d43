//! Bounds of vertices.

/// The minimum and the maximum of each coordinate.
pub(super) fn bounds(corners: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let bound = |pick: fn(f32, f32) -> f32, start: f32| {
        corners.iter().fold([start; 3], |all, corner| std::array::from_fn(|axis| pick(all[axis], corner[axis])))
    };
    [bound(f32::min, f32::INFINITY), bound(f32::max, f32::NEG_INFINITY)]
}
