// Tone mapping: from light to displayable colors.

fn tone_map(light: vec3<f32>) -> vec3<f32> {
    let c = max(light, vec3<f32>(0.0));
    let v = vec3<f32>(dot(TONE_IN_RED, c), dot(TONE_IN_GREEN, c), dot(TONE_IN_BLUE, c));
    let curve = (v * (v + TONE_ABOVE) - TONE_LESS) / (v * (TONE_SQUARE * v + TONE_LINEAR) + TONE_REST);
    let mixed = vec3<f32>(dot(TONE_OUT_RED, curve), dot(TONE_OUT_GREEN, curve), dot(TONE_OUT_BLUE, curve));
    return clamp(mixed, vec3<f32>(0.0), vec3<f32>(1.0));
}
