// The header of all shaders.
//
// `data` has numbers and tables; the data of a function start at its `base`. `samples` has grids, one after the other.
// `frame` describes the part of the work that this dispatch does.
@group(0) @binding(0) var<storage, read> data: array<u32>;
@group(0) @binding(1) var<storage, read_write> samples: array<f32>;

struct Frame {
    // Index of the first word of this dispatch in `data`.
    base: u32,
    // Number of columns and rows.
    width: u32,
    height: u32,
    // A number that differs between dispatches, such as the number of the iteration.
    step: u32,
    // For copies: number of samples from row to row, in the source and in the destination.
    strides: vec2<u32>,
    // Columns and rows of the planes that a pass works on, and the index of their first sample.
    columns: u32,
    rows: u32,
    first: u32,
}
@group(0) @binding(2) var<uniform> frame: Frame;

// A number of a function.
fn number(base: u32, index: u32) -> f32 {
    return bitcast<f32>(data[base + index]);
}

// The arc tangent in radians, to some 2e-7, by the polynomial of Cephes' atanf after reduction to at most tan(pi / 8):
// the built-in function of WGSL may be off by 4096 units in the last place.
fn arc_tangent(a: f32) -> f32 {
    var x = abs(a);
    var start = 0.0;
    if (x > 2.414213562373095) {
        start = 1.5707963267948966;
        x = -1.0 / x;
    } else if (x > 0.4142135623730950) {
        start = 0.7853981633974483;
        x = (x - 1.0) / (x + 1.0);
    }
    let z = x * x;
    let y = start
        + ((((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * x + x);
    return select(y, -y, a < 0.0);
}
