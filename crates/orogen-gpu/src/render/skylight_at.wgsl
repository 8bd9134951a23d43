// The light of the sky on the ground, where obstacles hide parts of it.

// The light (red, green, blue), and the share relative to a uniform sky without obstacles.
fn skylight_at(place: vec2<f32>) -> vec4<f32> {
    let columns = whole(SKYLIGHT_SIZE);
    let rows = whole(SKYLIGHT_SIZE + 1u);
    let stride = whole(SKYLIGHT_SIZE + 2u);
    // Whole strides and the remainder of the origin are kept apart, because their sum would lose precision.
    let first = origin / vec2<i32>(stride);
    let rest = vec2<f32>(origin - first * stride);
    let size = vec2<i32>(columns, rows);
    let at = clamp((place + rest) / f32(stride), vec2<f32>(-first), vec2<f32>(size - vec2<i32>(1) - first));
    let cell = clamp(vec2<i32>(floor(at)) + first, vec2<i32>(0), max(size - vec2<i32>(2), vec2<i32>(0)));
    let uv = at - vec2<f32>(cell - first);
    let nw = data[SKYLIGHT] + 4u * u32(cell.y * columns + cell.x);
    let east = select(0u, 4u, columns > 1);
    let south = select(0u, 4u * u32(columns), rows > 1);
    let north_row = mix(quad_of(nw), quad_of(nw + east), uv.x);
    let south_row = mix(quad_of(nw + south), quad_of(nw + south + east), uv.x);
    return mix(north_row, south_row, uv.y);
}
