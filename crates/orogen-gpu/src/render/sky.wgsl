// The sky, the sun's disc and haze.

// The light from a direction, without the sun; below the horizon, that of the horizon above it.
fn sky_light(along: vec3<f32>) -> vec3<f32> {
    let up = sqrt(max(along.z, 0.0)) * f32(SKY_ROWS - 1u);
    let level = length(along.xy);
    var cosine = 0.0;
    if (level > 1e-9) {
        cosine = dot(along.xy, pair(SKY_AHEAD)) / level;
    }
    let around = sqrt(max(0.5 - 0.5 * cosine, 0.0)) * f32(SKY_COLUMNS - 1u);
    let i = min(u32(around), SKY_COLUMNS - 2u);
    let k = min(u32(up), SKY_ROWS - 2u);
    let s = min(around - f32(i), 1.0);
    let t = min(up - f32(k), 1.0);
    let low = data[SKY] + 3u * (k * SKY_COLUMNS + i);
    let high = low + 3u * SKY_COLUMNS;
    return mix(mix(triple_of(low), triple_of(low + 3u), s), mix(triple_of(high), triple_of(high + 3u), s), t);
}

// The light from a direction, including the sun's disc.
fn sky_seen(along: vec3<f32>) -> vec3<f32> {
    let sky = sky_light(along);
    // 1 - cos of the angle to the centre of the sun, relative to that of its limb; from the chord, because the cosine is too near to 1.
    let chord = along - triple(SUN);
    let away = 0.5 * dot(chord, chord) / SUN_HALF_SQUARE;
    if (away >= 1.5 || along.z < 0.0) {
        return sky;
    }
    let edge = clamp((1.5 - away) / 0.6, 0.0, 1.0);
    let rim = 1.0 - 0.6 * (1.0 - sqrt(max(1.0 - away, 0.0)));
    return sky + triple(SUNLIGHT) * min(SUN_DISC * edge * rim, 4000.0);
}

// The transmittance of haze over a distance between two values of z.
fn haze_left(eye: f32, place: f32, distance: f32) -> vec3<f32> {
    let thins = value(HAZE_THINS);
    let ends = max((vec2<f32>(eye, place) + vec2<f32>(origin_z)) / thins, vec2<f32>(0.0));
    let low = min(ends.x, ends.y);
    let high = max(ends.x, ends.y);
    let rise = high - low;
    // The mean density on the way.
    var thick = exp(-low);
    if (rise >= 1e-3) {
        thick = (exp(-low) - exp(-high)) / rise;
    }
    return exp(-triple(HAZE_DIMS) * (thick * distance));
}

// The light of the sky on the ground (red, green, blue), and the share relative to a uniform sky without obstacles.
fn skylight_at(place: vec2<f32>) -> vec4<f32> {
    let columns = whole(SKYLIGHT_SIZE);
    let rows = whole(SKYLIGHT_SIZE + 1u);
    let stride = whole(SKYLIGHT_SIZE + 2u);
    // Whole strides and the rest of the origin apart: their sum would lose the digits of the position.
    let first = origin / vec2<i32>(stride);
    let rest = vec2<f32>(origin - first * stride);
    let size = vec2<i32>(columns, rows);
    let at = clamp((place + rest) / f32(stride), vec2<f32>(-first), vec2<f32>(size - vec2<i32>(1) - first));
    let cell = clamp(vec2<i32>(floor(at)) + first, vec2<i32>(0), max(size - vec2<i32>(2), vec2<i32>(0)));
    let uv = at - vec2<f32>(cell - first);
    let nw = data[SKYLIGHT] + 4u * u32(cell.y * columns + cell.x);
    let east = select(0u, 4u, columns > 1);
    let south = select(0u, 4u * u32(columns), rows > 1);
    let north_row = mix(quad_of(nw), quad_of(nw + east), uv.x);
    let south_row = mix(quad_of(nw + south), quad_of(nw + south + east), uv.x);
    return mix(north_row, south_row, uv.y);
}
