// The sky, the sun's disc and haze.

// The light from a direction, without the sun; below the horizon, the light from the horizon in that direction.
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
    let low = word(SKY) + 3u * (k * SKY_COLUMNS + i);
    let high = low + 3u * SKY_COLUMNS;
    return mix(mix(triple_of(low), triple_of(low + 3u), s), mix(triple_of(high), triple_of(high + 3u), s), t);
}

// The light from a direction, including the sun's disc.
fn sky_seen(along: vec3<f32>) -> vec3<f32> {
    let sky = sky_light(along);
    // 1 - cos of the angle to the center of the sun, relative to the same for its limb. It is computed from the chord,
    // because the cosine is too close to 1.
    let chord = along - triple(SUN);
    let away = 0.5 * dot(chord, chord) / SUN_HALF_SQUARE;
    if (away >= 1.5 || along.z < 0.0) {
        return sky;
    }
    let edge = clamp((1.5 - away) / 0.6, 0.0, 1.0);
    let rim = 1.0 - 0.6 * (1.0 - sqrt(max(1.0 - away, 0.0)));
    return sky + triple(SUNLIGHT) * min(SUN_DISC * edge * rim, 4000.0);
}

// The visible share of the sun above a horizon that rises by this tangent; `rims` are the tangents of its lower and
// upper limb.
fn sun_above(rise: f32, rims: vec2<f32>) -> f32 {
    let hidden = clamp((rise - rims.x) / (rims.y - rims.x), 0.0, 1.0);
    return 1.0 - hidden * hidden * (3.0 - 2.0 * hidden);
}

// The transmittance of haze over a distance between two heights above the lowest ground.
fn haze_left(eye: f32, place: f32, distance: f32) -> vec3<f32> {
    let thins = value(HAZE_THINS);
    let ends = max(vec2<f32>(eye, place) / thins, vec2<f32>(0.0));
    let low = min(ends.x, ends.y);
    let high = max(ends.x, ends.y);
    let rise = high - low;
    // The mean density along the path.
    var thick = exp(-low);
    if (rise >= 1e-3) {
        thick = (exp(-low) - exp(-high)) / rise;
    }
    return exp(-triple(HAZE_DIMS) * (thick * distance));
}

// The light from ground with an albedo. `sun` is the visible share of the sun; `shed` is the light of the sky (red,
// green, blue) and its share relative to a sky without obstacles.
fn diffuse(albedo: vec3<f32>, sun: f32, shed: vec4<f32>) -> vec3<f32> {
    let bounced = MEAN_ALBEDO * (0.7 * triple(LEVEL_SUN) + triple(LEVEL_SKY)) * max(1.0 - shed.w, 0.0);
    return albedo / PI * (triple(SUNLIGHT) * sun + shed.xyz + bounced);
}

// The light from a side of the block, which faces half sky and half table. The table is darker near the foot of the
// block: `foot` is 1 far above it. `facing` is the cosine of the angle to the sun.
fn side_of(albedo: vec3<f32>, facing: f32, foot: f32) -> vec3<f32> {
    let table = TABLE * (0.5 * triple(LEVEL_SUN) + triple(LEVEL_SKY));
    return albedo / PI * (triple(SUNLIGHT) * facing + foot * 0.5 * (triple(LEVEL_SKY) + table));
}

// The light from the table on which the block stands. `off` is the distance from the block, `high` the height of the
// block above the table at the nearest point, `across` the diagonal of the land, and `seen` the visible share of the
// sun. The table fades into the horizon far behind the land.
fn table_of(along: vec3<f32>, off: f32, high: f32, across: f32, seen: f32) -> vec3<f32> {
    let open = 0.5 + 0.5 * off / max(sqrt(off * off + high * high), 1e-9);
    let near = TABLE / PI * (triple(LEVEL_SUN) * seen + triple(LEVEL_SKY) * open);
    let far = exp(-(off / (1.3 * across)));
    return mix(sky_light(unit(vec3<f32>(along.xy, 0.02))), near, far);
}

// Light from a surface after the air along a ray; `left` is the share that the air lets through.
fn through_air(light: vec3<f32>, along: vec3<f32>, left: vec3<f32>) -> vec3<f32> {
    return mix(sky_light(unit(vec3<f32>(along.xy, max(along.z, 0.0) + 0.015))), light, left);
}
