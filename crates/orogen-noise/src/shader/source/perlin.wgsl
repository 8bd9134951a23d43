// Gradient noise on the hashed lattice.

fn perlin_gradients(octave: u32, x: Cell, y: Cell) -> NoiseGradients {
    let kx = noise_keys(octave, x);
    let ky = noise_keys(octave + 2u, y);
    return NoiseGradients(
        noise_sixteenth(noise_hash(kx.x, ky.x)),
        noise_sixteenth(noise_hash(kx.y, ky.x)),
        noise_sixteenth(noise_hash(kx.x, ky.y)),
        noise_sixteenth(noise_hash(kx.y, ky.y)),
    );
}

fn perlin_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    return noise_gradients_value(perlin_gradients(octave, x, y), vec2<f32>(x.t, y.t));
}

fn perlin_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    return noise_gradients_slopes(perlin_gradients(octave, x, y), vec2<f32>(x.t, y.t));
}
