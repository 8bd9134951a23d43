// Water: reflection, and color by depth.

fn slanted(cosine: f32) -> f32 {
    return 1.0 / sqrt(max(1.0 - BENDS * (1.0 - cosine * cosine), 0.1));
}

// The share of light that water of this depth, in metres, scatters back.
fn water_body(is_sea: bool, depth: f32, seen: f32, lit: f32) -> vec3<f32> {
    let takes = select(LAKE_TAKES, triple(SEA_TAKES), is_sea);
    let deep = select(LAKE_DEEP, DEEP, is_sea);
    let bottom = select(LAKE_BOTTOM, BOTTOM, is_sea);
    let way = max(depth, 0.0) * (slanted(seen) + slanted(lit));
    let left = exp(-takes * way);
    return bottom * left + deep * (1.0 - left);
}

// The color of a section through water, at a depth in metres.
fn water_section(depth: f32) -> vec3<f32> {
    let left = exp(-triple(SEA_TAKES) * depth * 0.12);
    return DARK + (SHALLOW - DARK) * max(left, vec3<f32>(left.y * 0.6));
}

// The reflectance of water under an angle with this cosine.
fn mirrored_share(cosine: f32) -> f32 {
    let off = 1.0 - clamp(cosine, 0.0, 1.0);
    let square = off * off;
    return 0.02 + 0.98 * square * square * off;
}

// Glitter of the sun, relative to the light on a surface that faces the sun.
fn glitter(normal: vec3<f32>, to_eye: vec3<f32>, to_sun: vec3<f32>) -> f32 {
    let both = to_eye + to_sun;
    let size = dot(both, both);
    if (size <= 0.0) {
        return 0.0;
    }
    let middle = both / sqrt(size);
    let cosine = dot(normal, middle);
    if (cosine <= 0.01) {
        return 0.0;
    }
    let seen = max(dot(normal, to_eye), 0.05);
    let square = cosine * cosine;
    let rough = ROUGH_WATER * ROUGH_WATER;
    let facing = exp((square - 1.0) / (square * rough)) / (PI * rough * square * square);
    return facing * mirrored_share(dot(middle, to_eye)) / (4.0 * seen);
}

// The light from within water, and the glitter of the sun on it. `seen` is the visible share of the sun, `body` the
// light that the water scatters back, `reflected` the share that it reflects.
fn water_light(body: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, to_sun: vec3<f32>, seen: f32, reflected: f32) -> vec3<f32> {
    let within = body / PI * (triple(LEVEL_SUN) * seen + triple(LEVEL_SKY));
    return within * (1.0 - reflected) + triple(SUNLIGHT) * (seen * glitter(normal, to_eye, to_sun));
}
