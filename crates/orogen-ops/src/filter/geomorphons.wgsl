// Landforms by lines of sight. Words: number of samples along the axes and along the diagonals, the tangent of the
// limit, and the forms by the numbers of lower and higher directions. Whether a direction leads up (1), down (-1) or is
// level (0); 2 if a sample is missing.
fn look(base: u32, at: vec2<i32>, along: vec2<i32>) -> i32 {
    let center = plane(0u, at);
    let is_diagonal = along.x * along.y != 0;
    let farthest = i32(select(straight(base), diagonal(base), is_diagonal));
    // The rise and the number of steps of the highest and the lowest line. Products are compared instead of quotients,
    // because they are exact for heights in whole metres, so that equal slopes up and down cancel.
    var up = vec2<f32>(0.0, 1.0);
    var down = vec2<f32>(0.0, 1.0);
    for (var k = 1; k <= farthest; k += 1) {
        let there = plane(0u, at + along * k);
        if (is_missing(there)) {
            return 2;
        }
        let line = vec2<f32>(there - center, f32(k));
        if (k == 1 || line.x * up.y > up.x * line.y) {
            up = line;
        }
        if (k == 1 || line.x * down.y < down.x * line.y) {
            down = line;
        }
    }
    let limit = limit(base);
    let length = cell(base) * select(1.0, 1.4142135, is_diagonal);
    let rise = up.x / (up.y * length);
    let fall = down.x / (down.y * length);
    let sum = up.x * down.y + down.x * up.y;
    var tells = max(abs(rise), abs(fall)) > limit;
    if (is_by_difference(base) > 0.0) {
        let rest = 1.0 - rise * fall;
        tells = rest <= 0.0 || abs(sum) / (up.y * down.y * length) > limit * rest;
    }
    return select(0, select(select(0, -1, sum < 0.0), 1, sum > 0.0), tells);
}

fn forms(base: u32, at: vec2<i32>) {
    var lower = 0u;
    var higher = 0u;
    for (var k = 0; k < 9; k += 1) {
        let along = vec2<i32>(k % 3 - 1, k / 3 - 1);
        if (k == 4) {
            continue;
        }
        let leads = look(base, at, along);
        if (leads == 2 || is_missing(plane(0u, at))) {
            set_plane(1u, at, 0.0);
            return;
        }
        higher += select(0u, 1u, leads == 1);
        lower += select(0u, 1u, leads == -1);
    }
    set_plane(1u, at, f32(form(base, 9u * lower + higher)));
}
