// Steps of drainage areas: `drainage.rs`. The lower eight bits of `frame.step` are the plane of the areas that are read, the next eight that of those that are
// written.

fn donates(at: vec2<i32>, code: u32) -> bool {
    return plane(RECEIVER, at + step_of(code)) == f32(opposite(code));
}

// Each cell adds up what its donors had. In the first step what is not a river yet has drained nothing: the areas of rivers contain it.
fn add_areas(base: u32, at: vec2<i32>) {
    let is_first = (frame.step >> 16u) != 0u;
    var total = factor(given_rain(base), at, 0.01, 100.0);
    for (var code = 0u; code < 8u; code += 1u) {
        if (donates(at, code)) {
            let area = plane(frame.step & 0xffu, at + step_of(code));
            total += select(area, 0.0, is_first && area <= 1.0);
        }
    }
    set_plane((frame.step >> 8u) & 0xffu, at, total);
}

// Areas become at least those of the donors before.
fn raise_areas(base: u32, at: vec2<i32>) {
    var most = plane(frame.step & 0xffu, at);
    for (var code = 0u; code < 8u; code += 1u) {
        if (donates(at, code)) {
            most = max(most, plane(frame.step & 0xffu, at + step_of(code)));
        }
    }
    set_plane((frame.step >> 8u) & 0xffu, at, most);
}

// Areas become at most those of the receivers before.
fn limit_areas(base: u32, at: vec2<i32>) {
    var least = plane(frame.step & 0xffu, at);
    let receiver = plane(RECEIVER, at);
    if (receiver < NONE) {
        least = min(least, plane(frame.step & 0xffu, at + step_of(u32(receiver))));
    }
    set_plane((frame.step >> 8u) & 0xffu, at, least);
}

// Receivers as a level has them.
fn finish(base: u32, at: vec2<i32>) {
    let receiver = plane(RECEIVER, at);
    let is_in_lake = plane(FIXED, at) == WATER && receiver < WATER;
    set_plane(RECEIVER, at, select(receiver, receiver + LAKE, is_in_lake));
}
