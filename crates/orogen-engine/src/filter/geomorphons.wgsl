// Landforms by lines of sight: samples along the axes and along the diagonals, the tangent of the limit, the rule (1 for the difference of the angles), the
// cell, then the forms by the numbers of lower and higher directions.
//
// One run for each direction, whose number is `frame.step`, counts in the layer: lower directions and 16 times the higher ones; -1 if a sample is missing.
fn is_missing(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) == 0x7f800000u;
}

fn look(base: u32, at: vec2<i32>) {
    let so_far = plane(1u, at);
    let centre = plane(0u, at);
    if (so_far < 0.0 || is_missing(centre)) {
        set_plane(1u, at, -1.0);
        return;
    }
    // Clockwise from the east.
    let turn = vec2<i32>(i32(frame.step), i32(frame.step) + 6) % 8;
    let along = vec2<i32>(select(select(-1, 1, turn.x < 2 || turn.x == 7), 0, turn.x % 4 == 2), select(select(-1, 1, turn.y < 2 || turn.y == 7), 0, turn.y % 4 == 2));
    let is_diagonal = along.x * along.y != 0;
    let farthest = i32(select(number(base, 0u), number(base, 1u), is_diagonal));
    // The rise and the number of steps of the highest and the lowest line. Products are compared, not quotients: they are exact for heights in whole metres,
    // so that equal slopes up and down cancel.
    var up = vec2<f32>(0.0, 0.0);
    var down = vec2<f32>(0.0, 0.0);
    for (var k = 1; k <= farthest; k += 1) {
        let there = plane(0u, at + along * k);
        if (is_missing(there)) {
            set_plane(1u, at, -1.0);
            return;
        }
        let line = vec2<f32>(there - centre, f32(k));
        if (k == 1 || line.x * up.y > up.x * line.y) {
            up = line;
        }
        if (k == 1 || line.x * down.y < down.x * line.y) {
            down = line;
        }
    }
    let limit = number(base, 2u);
    let length = number(base, 4u) * select(1.0, 1.4142135, is_diagonal);
    let rise = up.x / (up.y * length);
    let fall = down.x / (down.y * length);
    let sum = up.x * down.y + down.x * up.y;
    var tells = max(abs(rise), abs(fall)) > limit;
    if (number(base, 3u) > 0.0) {
        let rest = 1.0 - rise * fall;
        tells = rest <= 0.0 || abs(sum) / (up.y * down.y * length) > limit * rest;
    }
    if (tells && sum > 0.0) {
        set_plane(1u, at, so_far + 16.0);
    } else if (tells && sum < 0.0) {
        set_plane(1u, at, so_far + 1.0);
    }
}

fn classify(base: u32, at: vec2<i32>) {
    let counts = plane(1u, at);
    if (counts < 0.0) {
        set_plane(1u, at, 0.0);
        return;
    }
    let both = u32(counts);
    set_plane(1u, at, number(base, 5u + 9u * (both % 16u) + both / 16u));
}
