// The land: bilinear patches between samples, water over some of them, and a pyramid of maxima.

// Data that every ray reads, loaded once per invocation.
var<private> land_columns: i32;
// The last patch.
var<private> land_last: vec2<i32>;
var<private> origin: vec2<i32>;
var<private> origin_z: f32;
// The land's edges.
var<private> land_low: vec2<f32>;
var<private> land_high: vec2<f32>;
var<private> land_highest: f32;
var<private> bed_start: u32;
var<private> top_level: u32;

fn load_land() {
    let size = vec2<i32>(whole(LAND), whole(LAND + 1u));
    land_columns = size.x;
    land_last = size - vec2<i32>(2);
    origin = vec2<i32>(whole(ORIGIN), whole(ORIGIN + 1u));
    origin_z = value(ORIGIN_Z);
    land_low = vec2<f32>(-origin);
    land_high = vec2<f32>(size - vec2<i32>(1) - origin);
    land_highest = value(HIGHEST);
    bed_start = data[BED];
    top_level = data[TOP_LEVEL];
}

// The ground of a patch: its north-western corner, and the differences along the axes and of both.
struct Patch {
    corner: f32,
    east: f32,
    south: f32,
    twist: f32,
}

fn patch_at(cell: vec2<i32>) -> Patch {
    let at = bed_start + u32(cell.y * land_columns + cell.x);
    let below = at + u32(land_columns);
    let nw = samples[at] - origin_z;
    let ne = samples[at + 1u] - origin_z;
    let sw = samples[below] - origin_z;
    let se = samples[below + 1u] - origin_z;
    return Patch(nw, ne - nw, sw - nw, nw - ne - sw + se);
}

// The level of the water of a patch; DRY if there is none.
fn water_at(cell: vec2<i32>) -> f32 {
    if (data[HAS_WATER] == 0u) {
        return DRY;
    }
    return max(samples[data[WATER] + u32(cell.y * (land_columns - 1) + cell.x)] - origin_z, DRY);
}

// The highest point of the node that contains a patch.
fn top_of(level: u32, cell: vec2<i32>) -> f32 {
    let node = cell >> vec2<u32>(level);
    let row = LEVELS + 2u * level;
    return samples[data[TOPS] + data[row] + u32(node.y * whole(row + 1u) + node.x)] - origin_z;
}

fn cell_at(place: vec2<f32>) -> vec2<i32> {
    let at = clamp(place, land_low, land_high);
    return clamp(vec2<i32>(floor(at)) + origin, vec2<i32>(0), land_last);
}

fn ground_in(cell: vec2<i32>, place: vec2<f32>) -> f32 {
    let ground = patch_at(cell);
    let uv = clamp(place, land_low, land_high) - vec2<f32>(cell - origin);
    return ground.corner + ground.east * uv.x + (ground.south + ground.twist * uv.x) * uv.y;
}

// The z of the ground; outside, the z at the nearest point of the edge.
fn ground_at(place: vec2<f32>) -> f32 {
    return ground_in(cell_at(place), place);
}

// The z of the ground or the water, whichever is higher.
fn top_at(place: vec2<f32>) -> f32 {
    let cell = cell_at(place);
    return max(ground_in(cell, place), water_at(cell));
}

fn is_inside(place: vec2<f32>) -> bool {
    return all(place >= land_low) && all(place <= land_high);
}

// A height in metres.
fn height_of(z: f32) -> f32 {
    return z * value(CELL) / value(EXAGGERATION) + value(ORIGIN_HEIGHT);
}

// A difference of z in metres.
fn metres(cells: f32) -> f32 {
    return cells * value(CELL) / value(EXAGGERATION);
}
