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

// Whole numbers of 64 bits are pairs of u32, the lower part first.
fn times(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = product(a.x, b.x);
    return vec2<u32>(low.x, low.y + a.x * b.y + a.y * b.x);
}

fn plus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

// A number combined by exclusive or with the same number shifted right by 1 to 31 bits.
fn folded(a: vec2<u32>, by: u32) -> vec2<u32> {
    return a ^ vec2<u32>((a.x >> by) | (a.y << (32u - by)), a.y >> by);
}

// The finalizer of splitmix64.
fn mix64(a: vec2<u32>) -> vec2<u32> {
    let b = times(folded(a, 30u), vec2<u32>(0x1ce4e5b9u, 0xbf58476du));
    return folded(times(folded(b, 27u), vec2<u32>(0x133111ebu, 0x94d049bbu)), 31u);
}

// The random bits of a node, from the initial value of its hash.
fn node_bits(begin: vec2<u32>, x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    let column = mix64(begin ^ times(x, vec2<u32>(0x6659fd93u, 0xd6e8feb8u)));
    return mix64(plus(column, times(y, vec2<u32>(0x78bd642fu, 0xa0761d64u))));
}

// The random bits of a child, and of a parent.
fn child_bits(begin: vec2<u32>, at: vec2<i32>) -> vec2<u32> {
    let x = plus(first_column(), vec2<u32>(u32(at.x), 0u));
    return node_bits(begin, x, plus(first_row(), vec2<u32>(u32(at.y), 0u)));
}

fn halved(a: vec2<u32>) -> vec2<u32> {
    return vec2<u32>((a.x >> 1u) | (a.y << 31u), bitcast<u32>(bitcast<i32>(a.y) >> 1u));
}

fn parent_bits(begin: vec2<u32>, at: vec2<i32>) -> vec2<u32> {
    let x = plus(halved(first_column()), vec2<u32>(u32(at.x), 0u));
    return node_bits(begin, x, plus(halved(first_row()), vec2<u32>(u32(at.y), 0u)));
}

// Numbers from 0 to 1, from the upper 24 bits, from the next 24, and from a part of 16 bits.
fn unit(bits: vec2<u32>) -> f32 {
    return f32(bits.y >> 8u) * 5.9604644775390625e-8;
}

fn second_unit(bits: vec2<u32>) -> f32 {
    return f32(((bits.x >> 16u) | (bits.y << 16u)) & 0xffffffu) * 5.9604644775390625e-8;
}

fn unit16(bits: vec2<u32>, part: u32) -> f32 {
    let word = select(bits.x, bits.y, part > 1u);
    return f32((word >> (16u * (part & 1u))) & 0xffffu) * 1.52587890625e-5;
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
