// The sum of octaves, each damped by the slope of the plain sum so far. Parameters: strength k, and the shape of the damping (0: 1 / (1 + k m), 1: e^(-k m),
// 2: 1 / (1 + k sqrt m), 3: 1 - smoothstep(k m), of the squared slope m).
fn weighted_SOURCE(base: u32, place: Placement) -> f32 {
    let source = noise_source(base);
    let k = number(base, NOISE_PARAMETERS);
    let falloff = data[base + NOISE_PARAMETERS + 1u];
    var lattice = noise_lattice(base);
    var octave = base + NOISE_OCTAVES;
    var sum = 0.0;
    var slope = vec2<f32>(0.0);
    for (var i = 0u; i < data[base]; i = i + 1u) {
        let x = cell_at(lattice, 0u, place);
        let y = cell_at(lattice, 1u, place);
        let one = noise_scaled(octave, SOURCE_slopes(source, octave, x, y));
        slope = slope + one.slope;
        let squared = slope.x * slope.x + slope.y * slope.y;
        var weight: f32;
        switch falloff {
            case 0u: {
                weight = 1.0 / (1.0 + k * squared);
            }
            case 1u: {
                weight = exp(-min(k * squared, 87.0));
            }
            case 2u: {
                weight = 1.0 / (1.0 + k * sqrt(squared));
            }
            default: {
                let t = min(k * squared, 1.0);
                weight = 1.0 - t * t * (3.0 - 2.0 * t);
            }
        }
        sum = sum + one.value * weight;
        octave = octave + NOISE_OCTAVE;
        lattice = lattice + LATTICE_WORDS;
    }
    return sum;
}
