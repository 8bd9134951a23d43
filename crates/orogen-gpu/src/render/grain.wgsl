// Detail smaller than a cell: a tile of noise for the grain of rock, grass and water.

// A noise has `NOISE` words: wavelength in metres, matrix, offset, cosine and sine of its angle, steepness of its
// waves.
fn noise_sample(i: i32, j: i32) -> vec3<f32> {
    let side = i32(GRAIN_SIDE) - 1;
    return triple_of(data[GRAIN] + 3u * (u32(j & side) * GRAIN_SIDE + u32(i & side)));
}

// The value of a noise at a position, and its derivatives east and south per wavelength.
fn grain_at(noise: u32, x: f32, y: f32) -> vec3<f32> {
    let u = value(noise + 1u) * x + value(noise + 2u) * y + value(noise + 5u);
    let v = value(noise + 3u) * x + value(noise + 4u) * y + value(noise + 6u);
    let i = i32(floor(u));
    let j = i32(floor(v));
    let s = u - floor(u);
    let t = v - floor(v);
    let north = mix(noise_sample(i, j), noise_sample(i + 1, j), s);
    let south = mix(noise_sample(i, j + 1), noise_sample(i + 1, j + 1), s);
    let bump = mix(north, south, t);
    let cosine = value(noise + 7u);
    let sine = value(noise + 8u);
    return vec3<f32>(bump.x, bump.y * cosine + bump.z * sine, bump.z * cosine - bump.y * sine);
}

// A noise of kinds 4 to 7 over other quantities than positions.
fn plain_grain(x: f32, y: f32, kind: u32) -> f32 {
    return grain_at(PLAIN + NOISE * (kind - 4u), x, y).x;
}

// The visibility of a wavelength for a pixel of this width: full from four pixels, zero below one and a half.
fn seen_share(wavelength: f32, footprint: f32) -> f32 {
    return ease(1.5, 4.0, wavelength / footprint);
}

// One of the climate's noises, faded where a pixel is too wide to resolve it.
fn noise_at(place: vec2<f32>, footprint: f32, index: u32) -> f32 {
    let noise = NOISES + NOISE * index;
    let seen = seen_share(value(noise), footprint);
    if (seen <= 0.0) {
        return 0.0;
    }
    return grain_at(noise, place.x, place.y).x * seen;
}
