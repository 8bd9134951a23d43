// Soil creep, banks of rivers, and steepest descent, as in `creep.rs` and `banks.rs`. The lowest eight bits of
// `frame.step` are the plane of heights that is read, followed by the plane of heights that is written and the plane of
// areas, with eight bits each.

fn heights() -> u32 {
    return frame.step & 0xffu;
}

fn areas() -> u32 {
    return (frame.step >> 16u) & 0xffu;
}

// The factor of creep: the input; on detail levels less where slopes are of rock.
fn creep_factor(base: u32, at: vec2<i32>) -> f32 {
    if (has(base, DETAIL)) {
        return 1.0 - 0.9 * share_between(plane(STABLE, at), 0.5, 1.0);
    }
    return factor(given_creep_factor(base), at, 0.0, 1.25);
}

fn is_land(at: vec2<i32>) -> bool {
    return plane(RECEIVER, at) < WATER && plane(FIXED, at) < WATER;
}

fn creep(base: u32, at: vec2<i32>) {
    let here = plane(heights(), at);
    let area = plane(areas(), at);
    let receiver = plane(RECEIVER, at);
    var sides = 0.0;
    var corners = 0.0;
    var down = 0.0;
    var up = UNKNOWN;
    for (var code = 0u; code < 8u; code += 1u) {
        let near = at + step_of(code);
        let there = plane(heights(), near);
        if ((code & 1u) == 0u) {
            sides += there;
        } else {
            corners += there;
        }
        if (receiver == f32(code)) {
            down = here - there;
        }
        if (plane(RECEIVER, near) == f32(opposite(code))) {
            up = min(up, there - here);
        }
    }
    let lower = -0.5 * max(down - kept_fall(base), 0.0);
    let upper = 0.5 * max(up - kept_fall(base), 0.0);
    let rate = 0.8 * creep_factor(base, at) * 300.0 / (300.0 + area);
    var change = rate * ((4.0 * sides + corners) * 0.05 - here);
    if (area >= cut_area(base)) {
        change = -1.5;
    }
    change = min(max(change, lower), upper);
    var height = select(here, here + change, is_land(at));
    if (has(base, LAKES)) {
        // Land around lakes does not fall below its smallest height.
        height = max(height, min(here, plane(LEAST, at)));
    }
    set_plane((frame.step >> 8u) & 0xffu, at, height);
}

// Raises nodes next to rivers to the banks, as long as their donors stay above them.
fn raise_banks(base: u32, at: vec2<i32>) {
    let here = plane(heights(), at);
    var bank = here;
    var lowest_donor = UNKNOWN;
    for (var code = 0u; code < 8u; code += 1u) {
        let near = at + step_of(code);
        let there = plane(heights(), near);
        let receiver = plane(RECEIVER, near);
        if (plane(areas(), near) >= 500.0 && receiver < WATER) {
            bank = max(bank, there + 0.3);
        }
        if (receiver == f32(opposite(code))) {
            lowest_donor = min(lowest_donor, there);
        }
    }
    let raised = max(min(bank, lowest_donor - 0.01), here);
    let is_raised = plane(areas(), at) < 500.0 && is_land(at);
    set_plane((frame.step >> 8u) & 0xffu, at, select(here, raised, is_raised));
}

// Sets the receivers of free nodes by steepest descent.
fn descend(base: u32, at: vec2<i32>) {
    if (plane(FIXED, at) != FREE) {
        return;
    }
    let here = plane(heights(), at);
    var steepest = 0.0;
    for (var code = 0u; code < 8u; code += 1u) {
        var fall = here - plane(heights(), at + step_of(code));
        if ((code & 1u) != 0u) {
            fall *= 0.70710677;
        }
        if (fall > steepest) {
            steepest = fall;
            set_plane(RECEIVER, at, f32(code));
        }
    }
}
