// Distance to the nearest marked sample: the threshold, the reach in samples, the cell, the reach in metres, the range
// of the mask.
//
// Distances along the columns are minima over steps of 1, 2, 4, ...: every distance is a sum of such steps. The lower
// eight bits of `frame.step` are the plane that is read, the next eight bits the plane that is written, and the bits
// from 16 on the length of the step.
const NONE = 1e9;

fn mark(base: u32, at: vec2<i32>) {
    let value = plane(0u, at);
    set_plane((frame.step >> 8u) & 0xffu, at, select(NONE, 0.0, value >= number(base, 0u)));
}

fn down_columns(base: u32, at: vec2<i32>) {
    let source = frame.step & 0xffu;
    let length = i32(frame.step >> 16u);
    let there = min(plane(source, at - vec2<i32>(0, length)), plane(source, at + vec2<i32>(0, length)));
    set_plane((frame.step >> 8u) & 0xffu, at, min(plane(source, at), there + f32(length)));
}

// Squared distances in plane 1, from the distances along the columns in plane 2. The nearest columns are tried first,
// because few columns matter.
fn along_rows(base: u32, at: vec2<i32>) {
    let reach = i32(number(base, 1u));
    var best = NONE * NONE;
    for (var x = 0; x <= reach; x += 1) {
        let square = f32(x) * f32(x);
        if (square >= best) {
            break;
        }
        let down = min(plane(2u, at - vec2<i32>(x, 0)), plane(2u, at + vec2<i32>(x, 0)));
        best = min(best, square + down * down);
    }
    set_plane(1u, at, best);
}

fn measure(base: u32, at: vec2<i32>) {
    let reach = number(base, 1u);
    let square = plane(1u, at);
    let farthest = number(base, 3u);
    var metres = farthest;
    if (square <= reach * reach) {
        metres = min(sqrt(square) * number(base, 2u), farthest);
    }
    set_plane(1u, at, metres);
    set_plane(2u, at, selected(base + 4u, metres));
}
