// Virtual pipes: an iteration of orogen-grid's `erosion/pipe_rows.rs` as three passes. Words: the fields of its
// `Constants`, then the velocity in m/s of the flow over two sides at a depth of 1 m.
//
// Flows are in two pairs of planes: the first pass reads one pair and writes the other, the second pass the reverse.
const SOURCE = 0u;
const BED = 1u;
const DEPTH = 2u;
const SEDIMENT = 3u;
// The plane of the velocity has the changes of the ground until the velocity is computed at the end.
const VELOCITY = 4u;
const CHANGE = 4u;
const EAST = 5u;
const SOUTH = 6u;
const PULLED_EAST = 7u;
const PULLED_SOUTH = 8u;
const LIMIT = 9u;
const LOAD = 10u;

const TINY = 1e-30;

fn positive(x: f32) -> f32 {
    return max(x, 0.0);
}

fn start(base: u32, at: vec2<i32>) {
    set_plane(BED, at, plane(SOURCE, at));
}

// A flow after an iteration's pull from one cell to the other.
fn pulled(base: u32, flow: f32, bed: vec2<f32>, depth: vec2<f32>) -> f32 {
    return kept(base) * flow + pull(base) * ((bed.x - bed.y) + (depth.x - depth.y));
}

// Flows over the eastern and southern sides, the share of the outflow for which there is water, and its sediment.
fn flow(base: u32, at: vec2<i32>) {
    let west_at = at - vec2<i32>(1, 0);
    let north_at = at - vec2<i32>(0, 1);
    let east_at = at + vec2<i32>(1, 0);
    let south_at = at + vec2<i32>(0, 1);
    let bed = plane(BED, at);
    let depth = plane(DEPTH, at);
    let east = pulled(base, plane(EAST, at), vec2<f32>(bed, plane(BED, east_at)), vec2<f32>(depth, plane(DEPTH, east_at)));
    let south = pulled(base, plane(SOUTH, at), vec2<f32>(bed, plane(BED, south_at)), vec2<f32>(depth, plane(DEPTH, south_at)));
    let west = pulled(base, plane(EAST, west_at), vec2<f32>(plane(BED, west_at), bed), vec2<f32>(plane(DEPTH, west_at), depth));
    let north = pulled(base, plane(SOUTH, north_at), vec2<f32>(plane(BED, north_at), bed), vec2<f32>(plane(DEPTH, north_at), depth));
    let out = (positive(east) + positive(-west)) + (positive(south) + positive(-north));
    set_plane(PULLED_EAST, at, east);
    set_plane(PULLED_SOUTH, at, south);
    set_plane(LIMIT, at, min(depth / max(out, TINY), 1.0));
    set_plane(LOAD, at, plane(SEDIMENT, at) / max(depth, TINY));
}

// A flow, limited to the water of the cell that it comes from. `left` and `entered` are the limits of the cells that a
// positive flow leaves and enters.
fn held(flow: f32, left: f32, entered: f32) -> f32 {
    return flow * select(entered, left, flow > 0.0);
}

// Moves water and sediment over the sides. Records erosion and deposition, and changes the sediment accordingly.
fn pass_on(base: u32, at: vec2<i32>) {
    let west_at = at - vec2<i32>(1, 0);
    let north_at = at - vec2<i32>(0, 1);
    let east_at = at + vec2<i32>(1, 0);
    let south_at = at + vec2<i32>(0, 1);
    let limit = plane(LIMIT, at);
    let e = held(plane(PULLED_EAST, at), limit, plane(LIMIT, east_at));
    let s = held(plane(PULLED_SOUTH, at), limit, plane(LIMIT, south_at));
    let w = held(plane(PULLED_EAST, west_at), plane(LIMIT, west_at), limit);
    let n = held(plane(PULLED_SOUTH, north_at), plane(LIMIT, north_at), limit);
    set_plane(EAST, at, e);
    set_plane(SOUTH, at, s);
    let out = (positive(e) + positive(-w)) + (positive(s) + positive(-n));
    let came = (positive(-e) * plane(LOAD, east_at) + positive(w) * plane(LOAD, west_at))
        + (positive(-s) * plane(LOAD, south_at) + positive(n) * plane(LOAD, north_at));
    // The outflow is at most the content; rounding must not make it negative.
    let carried = positive(plane(SEDIMENT, at) - out * plane(LOAD, at)) + came;
    let left = positive(plane(DEPTH, at) + ((w - e) + (n - s)));
    let bed = plane(BED, at);
    let bed_w = plane(BED, west_at);
    let bed_e = plane(BED, east_at);
    let bed_n = plane(BED, north_at);
    let bed_s = plane(BED, south_at);
    let across = w + e;
    let down = n + s;
    let rise_x = bed_e - bed_w;
    let rise_y = bed_s - bed_n;
    let steep = rise_x * rise_x + rise_y * rise_y;
    let could = capacity(base) * sqrt((across * across + down * down) * (steep / (level_slope(base) + steep)));
    let more = could - carried;
    let lowest = min(min(bed_n, bed_s), min(bed_w, bed_e));
    let mean = 0.25 * ((bed_n + bed_s) + (bed_w + bed_e));
    let cut = min(erosion(base) * more, 0.5 * positive(bed - lowest));
    let laid = min(-deposition(base) * more, positive(mean - bed) + 0.25 * left);
    let change = select(laid, -cut, more > 0.0);
    set_plane(CHANGE, at, change);
    set_plane(SEDIMENT, at, carried - change);
    set_plane(DEPTH, at, left * kept_water(base) + rained(base));
}

// The changes of a row of three cells, with weights (1, 2, 1).
fn three(at: vec2<i32>) -> f32 {
    return (plane(CHANGE, at - vec2<i32>(1, 0)) + plane(CHANGE, at + vec2<i32>(1, 0))) + 2.0 * plane(CHANGE, at);
}

// The bed: a cell's change is shared over 3 x 3 cells.
fn lay(base: u32, at: vec2<i32>) {
    let change = 0.0625 * ((three(at - vec2<i32>(0, 1)) + three(at + vec2<i32>(0, 1))) + 2.0 * three(at));
    let bed = plane(BED, at);
    let changed = bed + change;
    // The rounding error of the bed goes to the sediment in the water.
    set_plane(SEDIMENT, at, plane(SEDIMENT, at) + (change - (changed - bed)));
    set_plane(BED, at, changed);
}

// Computes the velocity, and sets sediment that rounding of the bed made negative to 0.
fn finish(base: u32, at: vec2<i32>) {
    let east = plane(EAST, at - vec2<i32>(1, 0)) + plane(EAST, at);
    let south = plane(SOUTH, at - vec2<i32>(0, 1)) + plane(SOUTH, at);
    let depth = plane(DEPTH, at);
    var velocity = 0.0;
    if (depth >= 1e-4) {
        velocity = speed_scale(base) * sqrt(east * east + south * south) / depth;
    }
    set_plane(VELOCITY, at, velocity);
    set_plane(SEDIMENT, at, max(plane(SEDIMENT, at), 0.0));
}
