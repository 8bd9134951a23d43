// Values at lattice points. Word of the source: how they are blended: 0 not at all, 1 linear, 2 cubic, 3 quintic.

fn value_fade(kind: u32, t: f32) -> vec2<f32> {
    switch kind {
        case 1u: {
            return vec2<f32>(t, 1.0);
        }
        case 2u: {
            return vec2<f32>((3.0 - 2.0 * t) * (t * t), t * (1.0 - t) * 6.0);
        }
        default: {
            return noise_quintic(t);
        }
    }
}

fn value_corners(x: vec2<u32>, y: vec2<u32>) -> vec4<f32> {
    return vec4<f32>(
        noise_signed(noise_hash(x.x, y.x)),
        noise_signed(noise_hash(x.y, y.x)),
        noise_signed(noise_hash(x.x, y.y)),
        noise_signed(noise_hash(x.y, y.y)),
    );
}

fn value_keyed_value(source: u32, octave: u32, x: Keyed, y: Keyed) -> f32 {
    let kind = data[source];
    let corners = value_corners(x.keys, y.keys);
    if (kind == 0u) {
        return corners.x;
    }
    let u = value_fade(kind, x.t).x;
    let v = value_fade(kind, y.t).x;
    let across = corners.xy * (1.0 - v) + corners.zw * v;
    return across.x * (1.0 - u) + across.y * u;
}

fn value_keyed_slopes(source: u32, octave: u32, x: Keyed, y: Keyed) -> vec3<f32> {
    let kind = data[source];
    let corners = value_corners(x.keys, y.keys);
    if (kind == 0u) {
        return vec3<f32>(corners.x, 0.0, 0.0);
    }
    let u = value_fade(kind, x.t);
    let v = value_fade(kind, y.t);
    let across = corners.xy * (1.0 - v.x) + corners.zw * v.x;
    let along = corners.xz * (1.0 - u.x) + corners.yw * u.x;
    return vec3<f32>(across.x * (1.0 - u.x) + across.y * u.x, u.y * (across.y - across.x), v.y * (along.y - along.x));
}

fn value_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    return value_keyed_value(source, octave, keyed(octave, x), keyed(octave + 2u, y));
}

fn value_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    return value_keyed_slopes(source, octave, keyed(octave, x), keyed(octave + 2u, y));
}
