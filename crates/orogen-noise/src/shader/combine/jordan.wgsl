// De Carpentier's jordan turbulence: squares whose slopes displace and damp finer octaves. Parameters: damping, and factor of the result.
fn jordan_SOURCE(base: u32, place: Placement) -> f32 {
    let source = noise_source(base);
    var lattice = noise_lattice(base);
    var octave = base + NOISE_OCTAVES;
    var sum = 0.0;
    var weight = 1.0;
    var displacement = vec2<f32>(0.0);
    for (var i = 0u; i < data[base]; i = i + 1u) {
        let shift = noise_shift(displacement, number(octave, NOISE_SHIFT));
        let x = noise_moved(base, cell_at(lattice, 0u, place), 0u, shift);
        let y = noise_moved(base, cell_at(lattice, 1u, place), 1u, shift);
        let one = noise_scaled(octave, SOURCE_slopes(source, octave, x, y));
        sum = sum + (number(octave, NOISE_GAIN) * weight * one.value) * one.value;
        displacement = displacement + one.value * (one.slope * number(octave, NOISE_PER_RATIO));
        let damped = displacement * number(base, NOISE_PARAMETERS);
        weight = 1.0 - 1.0 / (1.0 + damped.x * damped.x + damped.y * damped.y);
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return clamp(sum * number(base, NOISE_PARAMETERS + 1u) * 2.0 - 1.0, -1.0, 1.0);
}
