// The falloff towards the edges of the world: whether corners are square, and two lattices whose unit is the width of
// the border. They start at the north-western and at the south-eastern corner.
fn edge(base: u32, place: Placement) -> f32 {
    let near = vec2<f32>(coordinate(base + 1u, 0u, place), coordinate(base + 1u, 1u, place));
    let far = -vec2<f32>(coordinate(base + 13u, 0u, place), coordinate(base + 13u, 1u, place));
    // Distance into the border, as a share of its width: 0 inside, 1 at the edge.
    let strip = max(vec2<f32>(1.0) - min(near, far), vec2<f32>(0.0));
    let depth = select(length(strip), max(strip.x, strip.y), number(base, 0u) != 0.0);
    let t = clamp(1.0 - depth, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
