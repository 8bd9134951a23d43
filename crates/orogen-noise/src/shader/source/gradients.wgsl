// Noise of gradients at the corners of square cells.

// The gradients of the corners: at the lower y, and at the upper y.
struct NoiseGradients {
    g00: vec2<f32>,
    g10: vec2<f32>,
    g01: vec2<f32>,
    g11: vec2<f32>,
}

// The products of the gradients and the ways from the corners to the sample, in the same order.
fn noise_gradients_ramps(g: NoiseGradients, t: vec2<f32>) -> vec4<f32> {
    let s = t - 1.0;
    return vec4<f32>(
        g.g00.x * t.x + g.g00.y * t.y,
        g.g10.x * s.x + g.g10.y * t.y,
        g.g01.x * t.x + g.g01.y * s.y,
        g.g11.x * s.x + g.g11.y * s.y,
    );
}

fn noise_gradients_value(g: NoiseGradients, t: vec2<f32>) -> f32 {
    let ramps = noise_gradients_ramps(g, t);
    let u = noise_quintic(t.x).x;
    let v = noise_quintic(t.y).x;
    let across = ramps.xy * (1.0 - v) + ramps.zw * v;
    return across.x * (1.0 - u) + across.y * u;
}

fn noise_gradients_slopes(g: NoiseGradients, t: vec2<f32>) -> vec3<f32> {
    let ramps = noise_gradients_ramps(g, t);
    let u = noise_quintic(t.x);
    let v = noise_quintic(t.y);
    let across = ramps.xy * (1.0 - v.x) + ramps.zw * v.x;
    let along = ramps.xz * (1.0 - u.x) + ramps.yw * u.x;
    let mean = (g.g00 * (1.0 - u.x) + g.g10 * u.x) * (1.0 - v.x) + (g.g01 * (1.0 - u.x) + g.g11 * u.x) * v.x;
    let slope = mean + vec2<f32>(u.y * (across.y - across.x), v.y * (along.y - along.x));
    return vec3<f32>(across.x * (1.0 - u.x) + across.y * u.x, slope);
}
