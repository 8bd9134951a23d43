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

fn value_corners(octave: u32, x: Cell, y: Cell) -> vec4<f32> {
    let kx = noise_keys(octave, x);
    let ky = noise_keys(octave + 2u, y);
    return vec4<f32>(
        noise_signed(noise_hash(kx.x, ky.x)),
        noise_signed(noise_hash(kx.y, ky.x)),
        noise_signed(noise_hash(kx.x, ky.y)),
        noise_signed(noise_hash(kx.y, ky.y)),
    );
}

fn value_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    let kind = data[source];
    if (kind == 0u) {
        return noise_signed(noise_hash(noise_key(octave, x), noise_key(octave + 2u, y)));
    }
    let corners = value_corners(octave, x, y);
    let u = value_fade(kind, x.t).x;
    let v = value_fade(kind, y.t).x;
    let across = corners.xy * (1.0 - v) + corners.zw * v;
    return across.x * (1.0 - u) + across.y * u;
}

fn value_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    let kind = data[source];
    if (kind == 0u) {
        return vec3<f32>(value_value(source, octave, x, y), 0.0, 0.0);
    }
    let corners = value_corners(octave, x, y);
    let u = value_fade(kind, x.t);
    let v = value_fade(kind, y.t);
    let across = corners.xy * (1.0 - v.x) + corners.zw * v.x;
    let along = corners.xz * (1.0 - u.x) + corners.yw * u.x;
    return vec3<f32>(across.x * (1.0 - u.x) + across.y * u.x, u.y * (across.y - across.x), v.y * (along.y - along.x));
}
