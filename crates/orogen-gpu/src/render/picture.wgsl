// A tile of a picture: each invocation paints a pixel. The words of a dispatch are the column and the row of its tile
// in the picture.

// The direction of the ray through a point of the picture: (0, 0) is its upper left corner, (1, 1) its lower right
// corner.
fn view_through(across: vec2<f32>) -> vec3<f32> {
    let at = (2.0 * across - vec2<f32>(1.0)) * pair(WIDE);
    return unit(triple(AHEAD) + triple(RIGHT) * at.x + triple(DOWN) * at.y);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= frame.width || id.y >= frame.height) {
        return;
    }
    load_land();
    let size = vec2<u32>(data[SIZE], data[SIZE + 1u]);
    let at = id.xy + vec2<u32>(data[frame.base], data[frame.base + 1u]);
    let exposure = triple(EXPOSURE);
    let count = data[SAMPLES];
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < count; k++) {
        let spot = data[SPOTS] + 2u * k;
        let across = (vec2<f32>(at) + vec2<f32>(samples[spot], samples[spot + 1u])) / vec2<f32>(size);
        sum += tone_map(light_along(view_through(across)) * exposure);
    }
    let color = sum / f32(count);
    let to = data[PICTURE] + 3u * ((at.y - data[FIRST_ROW]) * size.x + at.x);
    samples[to] = color.x;
    samples[to + 1u] = color.y;
    samples[to + 2u] = color.z;
}
