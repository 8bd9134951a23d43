// Gradient noise on the hashed lattice.

fn perlin_gradients(x: vec2<u32>, y: vec2<u32>) -> NoiseGradients {
    return NoiseGradients(
        noise_sixteenth(noise_hash(x.x, y.x)),
        noise_sixteenth(noise_hash(x.y, y.x)),
        noise_sixteenth(noise_hash(x.x, y.y)),
        noise_sixteenth(noise_hash(x.y, y.y)),
    );
}

fn perlin_keyed_value(source: u32, octave: u32, x: Keyed, y: Keyed) -> f32 {
    return noise_gradients_value(perlin_gradients(x.keys, y.keys), vec2<f32>(x.t, y.t));
}

fn perlin_keyed_slopes(source: u32, octave: u32, x: Keyed, y: Keyed) -> vec3<f32> {
    return noise_gradients_slopes(perlin_gradients(x.keys, y.keys), vec2<f32>(x.t, y.t));
}

fn perlin_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    return perlin_keyed_value(source, octave, keyed(octave, x), keyed(octave + 2u, y));
}

fn perlin_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    return perlin_keyed_slopes(source, octave, keyed(octave, x), keyed(octave + 2u, y));
}
