// Phacelle noise: stripes along a direction.
//
// Words: two words of the hash for each axis, stripes per cell, and the minimum length that a wave is divided by.

// Cosine and sine of a number of turns. Those of the language have too few digits on some devices.
fn phacelle_circle(turns: f32) -> vec2<f32> {
    // Quarter turns from the nearest whole one. An odd number of them swaps sine and cosine.
    let quarters = turns * 4.0;
    let whole = floor(quarters + 0.5);
    let a = (quarters - whole) * 1.5707964;
    let s = a * a;
    let c = (((2.4801588e-5 * s - 1.3888889e-3) * s + 4.1666668e-2) * s - 0.5) * s + 1.0;
    let d = ((((2.7557319e-6 * s - 1.984127e-4) * s + 8.3333338e-3) * s - 1.6666667e-1) * s + 1.0) * a;
    let number = i32(whole) & 3;
    let wave = select(vec2<f32>(c, d), vec2<f32>(d, c), (number & 1) != 0);
    return vec2<f32>(select(wave.x, -wave.x, number == 1 || number == 2), select(wave.y, -wave.y, number > 1));
}

// Cosine and sine of the stripes along a direction of any length.
fn phacelle(words: u32, x: Cell, y: Cell, direction: vec2<f32>) -> vec2<f32> {
    let squared = direction.x * direction.x + direction.y * direction.y;
    // Turns per cell across the stripes; a direction of length 0 makes no stripes.
    var side = vec2<f32>(0.0);
    if (squared > 0.0) {
        side = vec2<f32>(-direction.y, direction.x) * (number(words, 4u) / sqrt(squared));
    }
    var wave = vec2<f32>(0.0);
    var weights = 0.0;
    for (var j = -1; j < 3; j = j + 1) {
        let row = noise_key(words + 2u, stepped(y, j));
        for (var i = -1; i < 3; i = i + 1) {
            let hash = noise_hash(noise_key(words, stepped(x, i)), row);
            let second = (hash ^ (hash >> 16u)) * 0x93d765ddu;
            let third = (second ^ (second >> 15u)) * 0x915f77f5u;
            // Each pivot is within half a cell of its lattice point.
            let pivot = vec2<f32>(noise_unit(hash) - 0.5 + f32(i), noise_unit(second) - 0.5 + f32(j));
            let v = vec2<f32>(x.t, y.t) - pivot;
            let far = v.x * v.x + v.y * v.y;
            let weight = max(exp(-2.0 * far) - 0.011108997, 0.0);
            wave = wave + weight * phacelle_circle(v.x * side.x + v.y * side.y + noise_unit(third));
            weights = weights + weight;
        }
    }
    wave = wave / weights;
    let length = max(sqrt(wave.x * wave.x + wave.y * wave.y), number(words, 5u));
    return clamp(wave / length, vec2<f32>(-1.0), vec2<f32>(1.0));
}
