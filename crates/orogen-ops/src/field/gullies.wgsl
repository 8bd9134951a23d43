// Gullies on the slopes of a source.
//
// Words: number of octaves, slope per difference, onset, assumed slope, weight, detail, and sharpness. For each octave:
// six words of its noise, its depth, and how far it turns the next one. The lattices of the octaves follow.

fn gullies_soft(t: f32) -> f32 {
    let started = select(t - 0.5, 0.5 * t * t, t < 1.0);
    let left = max(1.0 - started, 0.0);
    return 1.0 - left * left;
}

fn gullies(
    base: u32,
    place: Placement,
    source: f32,
    fade: f32,
    east: f32,
    west: f32,
    south: f32,
    north: f32,
) -> f32 {
    let octaves = data[base];
    let weight = number(base, GULLIES_WEIGHT);
    var slope = vec2<f32>(east - west, south - north) * number(base, GULLIES_PER_DIFFERENCE);
    let steepness = sqrt(slope.x * slope.x + slope.y * slope.y);
    var mask = gullies_soft(steepness * number(base, GULLIES_ONSET));
    let assumed = number(base, GULLIES_ASSUMED);
    if (assumed > 0.0 && steepness > 0.0) {
        slope = slope * (assumed / steepness);
    }
    var to = clamp(fade, -1.0, 1.0);
    var height = source;
    var octave = base + GULLIES_OCTAVES;
    var lattice = octave + GULLIES_OCTAVE * octaves;
    for (var i = 0u; i < octaves; i = i + 1u) {
        let wave = phacelle(octave, cell_at(lattice, 0u, place), cell_at(lattice, 1u, place), slope);
        to = to + (wave.x * weight - to) * mask;
        height = height + to * number(octave, GULLIES_DEPTH);
        let length = sqrt(slope.x * slope.x + slope.y * slope.y);
        if (length > 0.0 && wave.y != 0.0) {
            // The gradient of a stripe's cosine is minus its sine, across the stripe.
            let turn = number(octave, GULLIES_TURN) / length;
            let across = select(-turn, turn, wave.y < 0.0);
            slope = vec2<f32>(slope.x - slope.y * across, slope.y + slope.x * across);
        }
        let left = max(1.0 - mask, 0.0);
        let kept = select(0.0, pow(max(left, 1e-30), number(base, GULLIES_DETAIL)), left > 0.0);
        mask = (1.0 - kept) * gullies_soft(abs(wave.y) * number(base, GULLIES_SHARPNESS));
        octave = octave + GULLIES_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return height;
}
