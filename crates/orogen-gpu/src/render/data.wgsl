// Words and grids of a scene. Positions are in cells, relative to ORIGIN and ORIGIN_Z, which are near the camera.

fn word(at: u32) -> u32 {
    return data[at];
}

fn triple_of(start: u32) -> vec3<f32> {
    return vec3<f32>(samples[start], samples[start + 1u], samples[start + 2u]);
}

fn quad_of(start: u32) -> vec4<f32> {
    return vec4<f32>(samples[start], samples[start + 1u], samples[start + 2u], samples[start + 3u]);
}
