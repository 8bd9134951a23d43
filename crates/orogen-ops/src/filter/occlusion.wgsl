// The visible share of the sky, as in orogen-grid's `analysis/sky.rs`. Words: the number of steps, and for each step
// its offset, 1 / distance and, at the last step of a direction, that direction's share of the circle, otherwise 0.
fn view(base: u32, at: vec2<i32>) {
    let here = plane(0u, at);
    if (is_missing(here)) {
        set_plane(1u, at, missing());
        return;
    }
    var hidden = 0.0;
    var steepest = 0.0;
    for (var k = 0u; k < data[base]; k++) {
        let step = base + 1u + 4u * k;
        let height = plane(0u, at + vec2<i32>(bitcast<i32>(data[step]), bitcast<i32>(data[step + 1u])));
        if (!is_missing(height)) {
            steepest = max(steepest, (height - here) * bitcast<f32>(data[step + 2u]));
        }
        let share = bitcast<f32>(data[step + 3u]);
        if (share > 0.0) {
            hidden += share * steepest / sqrt(1.0 + steepest * steepest);
            steepest = 0.0;
        }
    }
    set_plane(1u, at, 1.0 - hidden);
}
