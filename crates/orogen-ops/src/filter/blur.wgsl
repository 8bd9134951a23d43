// Gaussian blur along the rows, then along the columns: the number of weights and the weights.
fn weighed(base: u32, at: vec2<i32>, source: u32, along: vec2<i32>) -> f32 {
    let count = data[base];
    let reach = i32(count / 2u);
    var sum = 0.0;
    for (var k = 0u; k < count; k += 1u) {
        sum += number(base, 1u + k) * plane(source, at + along * (i32(k) - reach));
    }
    return sum;
}

fn rows(base: u32, at: vec2<i32>) {
    set_plane(2u, at, weighed(base, at, 0u, vec2<i32>(1, 0)));
}

fn columns(base: u32, at: vec2<i32>) {
    set_plane(1u, at, weighed(base, at, 2u, vec2<i32>(0, 1)));
}
