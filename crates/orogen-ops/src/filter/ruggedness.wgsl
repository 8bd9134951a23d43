// The root of the sum of squared differences to the eight neighbors.
fn index(base: u32, at: vec2<i32>) {
    let center = plane(0u, at);
    var sum = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let difference = plane(0u, at + vec2<i32>(x, y)) - center;
            sum += difference * difference;
        }
    }
    set_plane(1u, at, sqrt(sum));
}
