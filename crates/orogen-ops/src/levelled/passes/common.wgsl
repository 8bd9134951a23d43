// Common functions of the passes of drained land, as in orogen-grid's `multiscale`. The names of all planes, and
// functions that read the numbers of `Refinement::words` and the planes of inputs, are declared before this text.

// Codes of receivers: none, and the number that is added in lakes with an outlet.
const NONE = 8.0;
const LAKE = 16.0;
// Codes in planes of fixed receivers.
const FREE = -1.0;
const WATER = 8.0;
// Height of nodes without a height yet, and water level of children without water. Smaller numbers are heights.
const UNKNOWN = 1e30;
const KNOWN = 1e29;

fn has(base: u32, flag: u32) -> bool {
    return (flags(base) & flag) != 0u;
}

// The value of the input in plane `k` at a node; missing if `k` is 0.
fn given(k: u32, at: vec2<i32>) -> f32 {
    if (k == 0u) {
        return missing();
    }
    return plane(k, at);
}

// The factor in plane `k`, limited to a range; 1 if it is not given.
fn factor(k: u32, at: vec2<i32>, low: f32, high: f32) -> f32 {
    let value = given(k, at);
    if (is_missing(value)) {
        return 1.0;
    }
    return clamp(value, low, high);
}

// The step of a direction, and the direction of a step: `by` is -1, 0 or 1 along each axis, not 0 along both.
fn step_of(code: u32) -> vec2<i32> {
    let shift = 2u * (code & 7u);
    return vec2<i32>(i32((0x901au >> shift) & 3u) - 1, i32((0x1a9u >> shift) & 3u) - 1);
}

fn code_of(by: vec2<i32>) -> u32 {
    let index = u32(clamp((by.y + 1) * 3 + by.x + 1, 0, 8));
    if (index == 8u) {
        return 1u;
    }
    return (0x23084765u >> (4u * index)) & 15u;
}

fn opposite(code: u32) -> u32 {
    return (code + 4u) & 7u;
}

fn is_lake(code: f32) -> bool {
    return code >= LAKE;
}

// Whether a node has a receiver: land, and lakes with an outlet.
fn drains(code: f32) -> bool {
    return code < NONE || code >= LAKE;
}

// Which of the four children takes over a cell's node: bit 0 is set in the east, bit 1 in the south.
fn heir(parent: vec2<i32>) -> u32 {
    return select(0u, 1u, above(EAST, parent) >= 0.5) | select(0u, 2u, above(SOUTH, parent) >= 0.5);
}

fn child_of(parent: vec2<i32>, corner: u32) -> vec2<i32> {
    return 2 * parent + vec2<i32>(i32(corner & 1u), i32(corner >> 1u));
}

fn is_inner(parent: vec2<i32>) -> bool {
    return all(parent > vec2<i32>(0)) && all(parent < above_size() - vec2<i32>(1));
}

// The distance between two children, in cells.
fn distance_of(start: vec2<i32>, end: vec2<i32>) -> f32 {
    let by = vec2<f32>(end - start);
    let x = plane(EAST, end) - plane(EAST, start) + by.x;
    let y = plane(SOUTH, end) - plane(SOUTH, start) + by.y;
    return sqrt(x * x + y * y);
}

// The position of a value between the first and the second one: 0 up to the first, 1 from the second on.
fn share_between(value: f32, first: f32, second: f32) -> f32 {
    return clamp((value - first) / (second - first), 0.0, 1.0);
}

fn exponential(y: f32) -> f32 {
    return power(2.7182817, y);
}
