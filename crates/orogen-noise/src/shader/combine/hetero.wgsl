// Musgrave's heterogeneous terrain: octaves are weighted by the height so far. Parameters: offset, and factor of the result.
fn hetero_SOURCE(base: u32, place: Placement) -> f32 {
    let source = noise_source(base);
    var lattice = noise_lattice(base);
    var octave = base + NOISE_OCTAVES;
    var sum = 0.0;
    var weight = 1.0;
    for (var i = 0u; i < data[base]; i = i + 1u) {
        let x = cell_at(lattice, 0u, place);
        let y = cell_at(lattice, 1u, place);
        let noise = number(octave, 4u) * SOURCE_value(source, octave, x, y);
        sum = sum + weight * ((noise + number(base, 3u)) * number(octave, 6u));
        weight = sum;
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + NOISE_LATTICE;
    }
    return clamp(sum * number(base, 4u), -1.0, 1.0);
}
