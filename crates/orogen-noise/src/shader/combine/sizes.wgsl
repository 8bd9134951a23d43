// The sum of absolute values. Parameter: 1 for billow noise, -1 for ridged noise.
fn sizes_SOURCE(base: u32, place: Placement) -> f32 {
    let source = noise_source(base);
    var lattice = noise_lattice(base);
    var octave = base + NOISE_OCTAVES;
    var sum = 0.0;
    for (var i = 0u; i < data[base]; i = i + 1u) {
        let x = cell_at(lattice, 0u, place);
        let y = cell_at(lattice, 1u, place);
        sum = sum + abs(number(octave, NOISE_AMPLITUDE) * SOURCE_value(source, octave, x, y));
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return (sum - 1.0) * number(base, NOISE_PARAMETERS);
}
