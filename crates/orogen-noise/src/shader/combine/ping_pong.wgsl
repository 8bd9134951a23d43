// The sum of triangle waves of octaves. Parameters: strength, and factor of the result.
fn ping_pong_SOURCE(base: u32, place: Placement) -> f32 {
    let source = noise_source(base);
    var lattice = noise_lattice(base);
    var octave = base + NOISE_OCTAVES;
    var sum = 0.0;
    for (var i = 0u; i < data[base]; i = i + 1u) {
        let x = cell_at(lattice, 0u, place);
        let y = cell_at(lattice, 1u, place);
        let noise = number(octave, NOISE_AMPLITUDE) * SOURCE_value(source, octave, x, y);
        let wave = (noise + 1.0) * number(base, NOISE_PARAMETERS);
        let t = wave - 2.0 * floor(wave * 0.5);
        sum = sum + (select(2.0 - t, t, t < 1.0) * 2.0 - 1.0) * number(octave, NOISE_GAIN);
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return clamp(sum * number(base, NOISE_PARAMETERS + 1u), -1.0, 1.0);
}
