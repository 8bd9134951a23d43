// Steps of drainage areas, as in `drainage.rs`. The lower eight bits of `frame.step` are the plane of areas that is
// read, the next eight bits the plane that is written.

fn donates(at: vec2<i32>, code: u32) -> bool {
    return plane(RECEIVER, at + step_of(code)) == f32(opposite(code));
}

// Each cell adds up the areas of its donors. In the first step cells that are not rivers yet drain nothing: the areas
// of rivers contain their cells already.
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

// Raises areas to at least the previous areas of the donors.
fn raise_areas(base: u32, at: vec2<i32>) {
    var most = plane(frame.step & 0xffu, at);
    for (var code = 0u; code < 8u; code += 1u) {
        if (donates(at, code)) {
            most = max(most, plane(frame.step & 0xffu, at + step_of(code)));
        }
    }
    set_plane((frame.step >> 8u) & 0xffu, at, most);
}

// Limits areas to at most the previous areas of the receivers.
fn limit_areas(base: u32, at: vec2<i32>) {
    var least = plane(frame.step & 0xffu, at);
    let receiver = plane(RECEIVER, at);
    if (receiver < NONE) {
        least = min(least, plane(frame.step & 0xffu, at + step_of(u32(receiver))));
    }
    set_plane((frame.step >> 8u) & 0xffu, at, least);
}

// Writes the receivers of the finished level.
fn finish(base: u32, at: vec2<i32>) {
    let receiver = plane(RECEIVER, at);
    let is_in_lake = plane(FIXED, at) == WATER && receiver < WATER;
    set_plane(RECEIVER, at, select(receiver, receiver + LAKE, is_in_lake));
}
