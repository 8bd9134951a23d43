// What all shaders have in common.
//
// `data` holds numbers and tables: what belongs to a function starts at its `base`. `samples` holds grids, one after the other. `frame` is the part of the
// work that this dispatch does.
@group(0) @binding(0) var<storage, read> data: array<u32>;
@group(0) @binding(1) var<storage, read_write> samples: array<f32>;

struct Frame {
    // Index of the first word of this dispatch in `data`.
    base: u32,
    // Number of columns and rows.
    width: u32,
    height: u32,
    // Any number that changes from dispatch to dispatch, such as that of the iteration.
    step: u32,
}
@group(0) @binding(2) var<uniform> frame: Frame;

// A number of a function.
fn number(base: u32, index: u32) -> f32 {
    return bitcast<f32>(data[base + index]);
}
