// The code of each direction, in the order of the engine's own codes.
fn convert(base: u32, at: vec2<i32>) {
    let code = u32(clamp(plane(0u, at), 0.0, 8.0));
    set_plane(1u, at, number(base, code));
}
