// Curvature: samples between the heights, their distance in metres, the kind.
fn curvatures(base: u32, at: vec2<i32>) {
    set_plane(1u, at, curvature(0u, at, i32(number(base, 0u)), number(base, 1u), number(base, 2u)));
}
