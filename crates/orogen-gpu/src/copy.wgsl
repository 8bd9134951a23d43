// Copies a part of one buffer of samples to another. `data` is the source. The part starts at `frame.base` in `data`
// and at `frame.step` in `samples`.
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= frame.width || id.y >= frame.height) {
        return;
    }
    samples[frame.step + id.y * frame.strides.y + id.x] = bitcast<f32>(data[frame.base + id.y * frame.strides.x + id.x]);
}
