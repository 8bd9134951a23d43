// Gradient noise on the permutation of 2002. Words of the source: the mask of hashes, the permutation as 64 words of four bytes, and the gradients of the
// masked hashes as pairs.

fn classic_permuted(source: u32, index: u32) -> u32 {
    let at = index & 255u;
    return (data[source + CLASSIC_TABLE + (at >> 2u)] >> (8u * (at & 3u))) & 255u;
}

fn classic_gradient(source: u32, x: u32, y: u32) -> vec2<f32> {
    let hash = classic_permuted(source, x + y) & data[source];
    return vec2<f32>(number(source, CLASSIC_GRADIENTS + 2u * hash), number(source, CLASSIC_GRADIENTS + 2u * hash + 1u));
}

fn classic_gradients(source: u32, octave: u32, x: Cell, y: Cell) -> NoiseGradients {
    let column = x.low + data[octave];
    let here = classic_permuted(source, column);
    let next = classic_permuted(source, column + 1u);
    let row = y.low + data[octave + 2u];
    return NoiseGradients(
        classic_gradient(source, here, row),
        classic_gradient(source, next, row),
        classic_gradient(source, here, row + 1u),
        classic_gradient(source, next, row + 1u),
    );
}

fn classic_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    return noise_gradients_value(classic_gradients(source, octave, x, y), vec2<f32>(x.t, y.t));
}

fn classic_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    return noise_gradients_slopes(classic_gradients(source, octave, x, y), vec2<f32>(x.t, y.t));
}
