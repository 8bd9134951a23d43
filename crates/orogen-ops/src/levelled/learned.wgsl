// Learned detail, as in orogen-grid's `learned`. The planes of the level above are its heights, the scale of slopes, 1
// for standing water, and two sets of channels, which layers read and write in turn. The sizes of the network, and
// functions that read its weights and the numbers of a level, are declared before this text.

const HEIGHT = 0u;
const SCALE = 1u;
const CALM = 2u;
const SETS = 3u;

const EAST = vec2<i32>(1, 0);
const SOUTH = vec2<i32>(0, 1);

// The first plane of the channels that a layer reads; the layer before it has written them.
fn set_of(layer: u32) -> u32 {
    return SETS + (layer & 1u) * CHANNELS;
}

// The slopes east and south.
fn slopes(base: u32, at: vec2<i32>) -> vec2<f32> {
    let falls = vec2<f32>(
        above(HEIGHT, at + EAST) - above(HEIGHT, at - EAST),
        above(HEIGHT, at + SOUTH) - above(HEIGHT, at - SOUTH)
    );
    return falls * (0.5 * per_cell(base));
}

// The squares of the slopes.
fn square(base: u32, at: vec2<i32>) {
    let slope = slopes(base, at);
    set_above(frame.step, at, slope.x * slope.x + slope.y * slope.y);
}

fn filtered_along(k: u32, at: vec2<i32>) -> f32 {
    return (above(k, at - EAST) + 2.0 * above(k, at) + above(k, at + EAST)) * 0.25;
}

// A plane filtered with [1 2 1] / 4 along rows and columns. The lower half of the step is the plane that is read, the
// upper half the plane that is written.
fn filter_binomially(base: u32, at: vec2<i32>) {
    let k = frame.step & 0xffffu;
    let sum = filtered_along(k, at - SOUTH) + 2.0 * filtered_along(k, at) + filtered_along(k, at + SOUTH);
    set_above(frame.step >> 16u, at, sum * 0.25);
}

// What the network sees of a node, from the filtered squares in the plane of the lower half of the step and the
// filtered heights in that of the upper half.
fn see(base: u32, at: vec2<i32>) {
    let here = above(HEIGHT, at);
    let scale = sqrt(above(frame.step & 0xffffu, at) + level_square(base));
    let slope = slopes(base, at);
    let around = vec4<f32>(
        above(HEIGHT, at + EAST), above(HEIGHT, at - EAST), above(HEIGHT, at + SOUTH), above(HEIGHT, at - SOUTH)
    );
    let corners = vec4<f32>(
        above(HEIGHT, at - EAST - SOUTH), above(HEIGHT, at + EAST - SOUTH),
        above(HEIGHT, at - EAST + SOUTH), above(HEIGHT, at + EAST + SOUTH)
    );
    let falls = around - here;
    let bend = (falls.x + falls.y + falls.z + falls.w) * 0.25;
    let into = set_of(0u);
    set_above(SCALE, at, scale);
    set_above(CALM, at, select(0.0, 1.0, all(around == vec4<f32>(here)) && all(corners == vec4<f32>(here))));
    set_above(into, at, slope.x / scale);
    set_above(into + 1u, at, slope.y / scale);
    set_above(into + 2u, at, bend * per_cell(base) / scale * 3.0);
    set_above(into + 3u, at, (here - above(frame.step >> 16u, at)) * per_cell(base) / scale);
    set_above(into + 4u, at, log(scale) + 1.0);
    set_above(into + 5u, at, octave(base));
    set_above(into + 6u, at, noise(base) * normal_number(parent_bits(first_noise(base), at)));
    set_above(into + 7u, at, noise(base) * normal_number(parent_bits(second_noise(base), at)));
    set_above(into + 8u, at, noise(base) * normal_number(parent_bits(third_noise(base), at)));
    set_above(into + 9u, at, noise(base) * normal_number(parent_bits(fourth_noise(base), at)));
}

// Four weights.
fn weights(base: u32, k: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(
        vec4<u32>(weight(base, k), weight(base, k + 1u), weight(base, k + 2u), weight(base, k + 3u))
    );
}

// Four channels of a node.
fn channels(k: u32, at: vec2<i32>) -> vec4<f32> {
    return vec4<f32>(above(k, at), above(k + 1u, at), above(k + 2u, at), above(k + 3u, at));
}

fn set_channels(base: u32, k: u32, at: vec2<i32>, sums: vec4<f32>, before: vec4<f32>) {
    let values = max(sums, sums * leak(base)) + before;
    set_above(k, at, values.x);
    set_above(k + 1u, at, values.y);
    set_above(k + 2u, at, values.z);
    set_above(k + 3u, at, values.w);
}

// 16 channels of a node, from the one in the upper half of the step, by the layer in the lower half.
fn convolve(base: u32, at: vec2<i32>) {
    let layer = frame.step & 0xffffu;
    let first = frame.step >> 16u;
    let inputs = select(u32(CHANNELS), u32(INPUTS), layer == 0u);
    let before = set_of(layer);
    let start = select(FIRST_WEIGHTS + (layer - 1u) * WEIGHTS, 0u, layer == 0u) + first;
    let offsets = start + 9u * inputs * CHANNELS;
    var a = weights(base, offsets);
    var b = weights(base, offsets + 4u);
    var c = weights(base, offsets + 8u);
    var d = weights(base, offsets + 12u);
    let columns_and_rows = vec2<u32>(above_size());
    let nodes = columns_and_rows.x * columns_and_rows.y;
    var k = start;
    for (var south = -1; south <= 1; south += 1) {
        for (var east = -1; east <= 1; east += 1) {
            var read = index_above(before, at + vec2<i32>(east, south));
            for (var input = 0u; input < inputs; input += 1u) {
                let value = samples[read];
                a += weights(base, k) * value;
                b += weights(base, k + 4u) * value;
                c += weights(base, k + 8u) * value;
                d += weights(base, k + 12u) * value;
                read += nodes;
                k += CHANNELS;
            }
        }
    }
    let into = set_of(layer + 1u) + first;
    if (layer == 0u) {
        set_channels(base, into, at, a, vec4<f32>(0.0));
        set_channels(base, into + 4u, at, b, vec4<f32>(0.0));
        set_channels(base, into + 8u, at, c, vec4<f32>(0.0));
        set_channels(base, into + 12u, at, d, vec4<f32>(0.0));
    } else {
        let middle = before + first;
        set_channels(base, into, at, a, channels(middle, at));
        set_channels(base, into + 4u, at, b, channels(middle + 4u, at));
        set_channels(base, into + 8u, at, c, channels(middle + 8u, at));
        set_channels(base, into + 12u, at, d, channels(middle + 12u, at));
    }
}

// The residuals of the four fine samples of a node, in units of the scale. They replace the channels that the last
// layer has read.
fn find_residuals(base: u32, at: vec2<i32>) {
    let start = FIRST_WEIGHTS + (LAYERS - 1u) * WEIGHTS;
    var sums = weights(base, start + 4u * CHANNELS);
    for (var channel = 0u; channel < CHANNELS; channel += 1u) {
        sums += weights(base, start + 4u * channel) * above(set_of(LAYERS) + channel, at);
    }
    let into = set_of(LAYERS + 1u);
    set_above(into, at, sums.x);
    set_above(into + 1u, at, sums.y);
    set_above(into + 2u, at, sums.z);
    set_above(into + 3u, at, sums.w);
}

// A plane at a fine sample: between a node and the one at `end`.
fn between(k: u32, node: vec2<i32>, end: vec2<i32>) -> f32 {
    let north = (above(k, node) + above(k, vec2<i32>(end.x, node.y))) * 0.5;
    let south = (above(k, vec2<i32>(node.x, end.y)) + above(k, end)) * 0.5;
    return (north + south) * 0.5;
}

// The interpolating cubic in the middle of four values.
fn cubic(values: vec4<f32>) -> f32 {
    return (values.y + values.z) * 0.5 + ((values.y - values.x) + (values.z - values.w)) * 0.0625;
}

// The height at a row of nodes: at a node, or between it and the next one.
fn along(node: vec2<i32>, is_between: bool) -> f32 {
    if (!is_between) {
        return above(HEIGHT, node);
    }
    return cubic(vec4<f32>(
        above(HEIGHT, node - EAST), above(HEIGHT, node), above(HEIGHT, node + EAST), above(HEIGHT, node + 2 * EAST)
    ));
}

// The height of a fine sample.
fn refine(base: u32, at: vec2<i32>) {
    let node = at / 2;
    let phase = at & vec2<i32>(1);
    let is_between = phase == vec2<i32>(1);
    var height = 0.0;
    if (is_between.y) {
        height = cubic(vec4<f32>(
            along(node - SOUTH, is_between.x), along(node, is_between.x),
            along(node + SOUTH, is_between.x), along(node + 2 * SOUTH, is_between.x)
        ));
    } else {
        height = along(node, is_between.x);
    }
    let residual = above(set_of(LAYERS + 1u) + u32(2 * phase.y + phase.x), node);
    let land = 1.0 - between(CALM, node, node + phase);
    set_plane(0u, at, height + residual * between(SCALE, node, node + phase) * land * 0.5 * cell(base));
}
