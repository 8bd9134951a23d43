// Musgrave's hybrid multifractal: octaves are weighted by the product of those before. Parameters: offset, and factor of the result.
fn hybrid_SOURCE(base: u32, place: Placement) -> f32 {
    let source = noise_source(base);
    var lattice = noise_lattice(base);
    var octave = base + NOISE_OCTAVES;
    var sum = 0.0;
    var weight = 1.0;
    for (var i = 0u; i < data[base]; i = i + 1u) {
        let x = cell_at(lattice, 0u, place);
        let y = cell_at(lattice, 1u, place);
        let noise = number(octave, NOISE_AMPLITUDE) * SOURCE_value(source, octave, x, y);
        let weighted = weight * ((noise + number(base, NOISE_PARAMETERS)) * number(octave, NOISE_GAIN));
        sum = sum + weighted;
        weight = clamp(weighted, 0.0, 1.0);
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return clamp(sum * number(base, NOISE_PARAMETERS + 1u), -1.0, 1.0);
}
