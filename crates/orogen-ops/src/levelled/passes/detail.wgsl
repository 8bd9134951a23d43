// Converts nodes of the finest level of valleys to the nodes that detail levels start from, as in `detail.rs` and
// `scree.rs`. Planes of the level above: slopes, their weights, and their means.

// The stable slope for which the law gives the slope from a node to its receiver, and its weight.
fn weigh(base: u32, at: vec2<i32>) {
    let logarithm = above(VARIATION, at) + above(UPLIFT, at);
    let law = stable_slope(base) * exponential(0.3 * logarithm);
    let area = max(above(AREA, at), 1.0);
    let code = above(RECEIVER, at);
    var slope = law;
    var weight = 0.001;
    if (code < NONE) {
        let direction = u32(code);
        let distance = select(1.0, 1.4142135, (direction & 1u) != 0u);
        let fall = above(HEIGHT, at) - above(HEIGHT, at + step_of(direction));
        slope = fall / (distance * cell_above(base));
        var most = law;
        if (area <= 8.0) {
            // 1 / slope = 1 / river + 1 / stable.
            let river = river_slope_above(base) * exponential(logarithm) * power(area, -0.45);
            slope = slope * river / max(river - slope, 0.05 * river);
            most = 1.5 * law;
        }
        slope = min(max(slope, 1e-3), max(most, 1e-3));
        let share = area / 8.0;
        weight = 0.01 + 1.0 / (1.0 + share * share);
    }
    set_above(SLOPE, at, slope);
    set_above(WEIGHT, at, weight);
}

// Averages over 3 x 3 nodes.
fn average(base: u32, at: vec2<i32>) {
    var sum = 0.0;
    var weights = 0.0;
    for (var k = 0; k < 9; k += 1) {
        let by = vec2<i32>(k % 3, k / 3) - vec2<i32>(1);
        let weight = select(1.0, 2.0, by.x == 0) * select(1.0, 2.0, by.y == 0) * above(WEIGHT, at + by);
        sum += weight * above(SLOPE, at + by);
        weights += weight;
    }
    set_above(MEAN, at, sum / weights);
}

// Displaces nodes, and lays scree at the foot of faces.
fn prepare(base: u32, at: vec2<i32>) {
    let here = above(HEIGHT, at);
    var low = here;
    var high = here;
    for (var k = 0; k < 49; k += 1) {
        let there = above(HEIGHT, at + vec2<i32>(k % 7 - 3, k / 7 - 3));
        low = min(low, there);
        high = max(high, there);
    }
    let position = (here - low) / max(high - low, 1e-3);
    let stable = above(MEAN, at);
    let face = share_between(stable, 0.75, 1.0);
    let scree = face * (1.0 - share_between(position, 0.3, 0.5));
    let steeper = 1.0 + 0.6 * (face - scree) * (1.0 - 0.675 / max(stable, 0.675));
    let rock = min(stable * steeper, max(2.5, stable));
    let bits = parent_bits(detail_hash(base), at);
    set_above(EAST, at, 0.5 + 0.5 * (unit(bits) - 0.5));
    set_above(SOUTH, at, 0.5 + 0.5 * (second_unit(bits) - 0.5));
    set_above(VARIATION, at, above(VARIATION, at) + 2.0 * scree + above(UPLIFT, at));
    set_above(UPLIFT, at, log(rock + scree * (0.675 - rock)));
}
