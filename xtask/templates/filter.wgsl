// The height above the neighbor in the west. Number: the factor.
fn rise(base: u32, at: vec2<i32>) {
    set_plane(1u, at, (plane(0u, at) - plane(0u, at - vec2<i32>(1, 0))) * number(base, 0u));
}
