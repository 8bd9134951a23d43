// Waves on water.

// The normal of the waves at a position, for a pixel of `footprint` metres.
fn wave_normal(place: vec2<f32>, footprint: f32) -> vec3<f32> {
    var slope = vec2<f32>(0.0);
    for (var k = 0u; k < WAVE_COUNT; k++) {
        let noise = WAVES + NOISE * k;
        let seen = clamp((value(noise) / footprint - 1.0) / 3.0, 0.0, 1.0);
        if (seen > 0.0) {
            slope += grain_at(noise, place.x, place.y).yz * value(noise + 9u) * seen;
        }
    }
    return unit(vec3<f32>(-slope, 1.0));
}
