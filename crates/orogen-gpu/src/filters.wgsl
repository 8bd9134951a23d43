// What the passes of all filters have in common: planes of one size, one after the other in `samples`.
//
// The words at `frame.base` are the first column and row of this pass, and where the filter's own words start.

// Columns and rows of the planes.
fn size() -> vec2<i32> {
    return vec2<i32>(i32(frame.columns), i32(frame.rows));
}

fn index_of(k: u32, at: vec2<i32>) -> u32 {
    return frame.first + (k * frame.rows + u32(at.y)) * frame.columns + u32(at.x);
}

// A sample of plane `k`; beyond the border, that of the border.
fn plane(k: u32, at: vec2<i32>) -> f32 {
    return samples[index_of(k, clamp(at, vec2<i32>(0), size() - vec2<i32>(1)))];
}

fn set_plane(k: u32, at: vec2<i32>, value: f32) {
    samples[index_of(k, at)] = value;
}

// Whether a value is infinite or not a number. Shader compilers may assume that there are none, so the bits are compared.
fn is_missing(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) == 0x7f800000u;
}

// Not a number. The sum hides it from compilers that refuse such a constant.
fn missing() -> f32 {
    return bitcast<f32>(0x7fc00000u + min(frame.width, 0u));
}
