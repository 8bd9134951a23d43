// Gaussian blur along the rows, then along the columns: the number of weights and the weights. A run adds some of them to the sum so far, so that a wide
// kernel does not keep the graphics card busy for too long at once.
const TOGETHER = 512u;

fn weighed(base: u32, at: vec2<i32>, source: u32, along: vec2<i32>, sum_so_far: f32) -> f32 {
    let count = data[base];
    let reach = i32(count / 2u);
    let first = frame.step * TOGETHER;
    var sum = sum_so_far;
    for (var k = first; k < min(first + TOGETHER, count); k += 1u) {
        sum += number(base, 1u + k) * plane(source, at + along * (i32(k) - reach));
    }
    return sum;
}

fn rows(base: u32, at: vec2<i32>) {
    set_plane(2u, at, weighed(base, at, 0u, vec2<i32>(1, 0), plane(2u, at)));
}

fn columns(base: u32, at: vec2<i32>) {
    set_plane(1u, at, weighed(base, at, 2u, vec2<i32>(0, 1), plane(1u, at)));
}
