// De Carpentier's swiss turbulence: ridges whose slopes displace finer octaves. Parameter, the second: factor of the result.
fn swiss_SOURCE(base: u32, place: Placement) -> f32 {
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
        let amplitude = weight * number(octave, NOISE_GAIN);
        sum = sum + amplitude * (1.0 - abs(one.value));
        displacement = displacement - (amplitude * one.value) * (one.slope * number(octave, NOISE_PER_RATIO));
        weight = weight * clamp(sum, 0.0, 1.0);
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return clamp(sum * number(base, NOISE_PARAMETERS + 1u) * 2.0 - 1.0, -1.0, 1.0);
}
