// Thermal weathering: the height difference between neighbors at the stable slope, and the share that moves. The lower
// eight bits of `frame.step` are the plane that is read, the next eight bits the plane that is written. The material
// that crosses a side, from the height differences across and along it.
fn moved(base: u32, across: f32, along: f32) -> f32 {
    let stands = stands(base);
    let steep = sqrt(across * across + along * along);
    if (steep > stands) {
        return share(base) * (1.0 - stands / steep) * across;
    }
    return 0.0;
}

fn slide(base: u32, at: vec2<i32>) {
    let source = frame.step & 0xffu;
    let nw = plane(source, at + vec2<i32>(-1, -1));
    let n = plane(source, at + vec2<i32>(0, -1));
    let ne = plane(source, at + vec2<i32>(1, -1));
    let w = plane(source, at + vec2<i32>(-1, 0));
    let z = plane(source, at);
    let e = plane(source, at + vec2<i32>(1, 0));
    let sw = plane(source, at + vec2<i32>(-1, 1));
    let s = plane(source, at + vec2<i32>(0, 1));
    let se = plane(source, at + vec2<i32>(1, 1));
    let west = moved(base, w - z, ((nw - sw) + (n - s)) * 0.25);
    let east = moved(base, z - e, ((n - s) + (ne - se)) * 0.25);
    let above = moved(base, n - z, ((nw - ne) + (w - e)) * 0.25);
    let below = moved(base, z - s, ((w - e) + (sw - se)) * 0.25);
    set_plane((frame.step >> 8u) & 0xffu, at, z + ((west - east) + (above - below)));
}
