// Shortens rivers on the finest level, as in `straighten.rs`. A shortcut is encoded as its direction plus 16 times the
// number of cells that it skips; 0 is no shortcut.

// Codes of paths: the direction of the river, 9 without a river, plus 16 in cells that are skipped.
const DRY = 9u;
const SKIPPED = 16u;

fn river_code(at: vec2<i32>) -> f32 {
    return plane(FIXED, at);
}

// Finds shortcuts: places where a river returns to a cell next to its path.
fn find_shortcuts(base: u32, at: vec2<i32>) {
    var node = at;
    var by = vec2<i32>(0);
    var found = 0u;
    for (var k = 0u; k < 5u; k += 1u) {
        let code = river_code(node);
        if (code < 0.0 || code >= NONE) {
            break;
        }
        let one = step_of(u32(code));
        node += one;
        by += one;
        if (k > 0u && all(abs(by) <= vec2<i32>(1)) && any(by != vec2<i32>(0))) {
            found = code_of(by) | (k << 4u);
        }
    }
    set_plane(FOUND, at, f32(found));
}

// Whether a shortcut from `start` skips the cell `at`.
fn skips(start: vec2<i32>, shortcut: u32, at: vec2<i32>) -> bool {
    var node = start;
    for (var k = 0u; k < (shortcut >> 4u); k += 1u) {
        node += step_of(u32(river_code(node)));
        if (same(node, at)) {
            return true;
        }
    }
    return false;
}

// The rank of a shortcut, as a low and a high word. Of two shortcuts, one of which skips the start of the other, the
// one with the higher rank is taken.
fn rank_of(at: vec2<i32>, shortcut: u32) -> vec2<u32> {
    let x = plus(first_column(), vec2<u32>(u32(at.x), 0u));
    let y = plus(first_row(), vec2<u32>(u32(at.y), 0u));
    let chance = mix64(mix64(x) ^ y);
    let even = ((x.x ^ y.x) & 1u) ^ 1u;
    return vec2<u32>((chance.x >> 8u) | (chance.y << 24u), (chance.y >> 8u) | (even << 25u) | ((shortcut >> 4u) << 28u));
}

fn is_higher(a: vec2<u32>, b: vec2<u32>) -> bool {
    return a.y > b.y || (a.y == b.y && a.x > b.x);
}

// Whether a shortcut is not taken, because another one of a higher rank skips its start or starts in a cell that it
// skips.
fn is_beaten(at: vec2<i32>, shortcut: u32) -> bool {
    let rank = rank_of(at, shortcut);
    var node = at;
    for (var k = 0u; k < (shortcut >> 4u); k += 1u) {
        node += step_of(u32(river_code(node)));
        let other = u32(plane(FOUND, node));
        if (other != 0u && is_higher(rank_of(node, other), rank)) {
            return true;
        }
    }
    for (var k = 0; k < 49; k += 1) {
        let near = at + vec2<i32>(k % 7 - 3, k / 7 - 3);
        let other = u32(plane(FOUND, near));
        if (other != 0u && k != 24) {
            if (skips(near, other, at) && !is_higher(rank, rank_of(near, other))) {
                return true;
            }
        }
    }
    return false;
}

fn take_shortcuts(base: u32, at: vec2<i32>) {
    let found = u32(plane(FOUND, at));
    var taken = found;
    if (found != 0u) {
        if (is_beaten(at, found)) {
            taken = 0u;
        }
    }
    set_plane(TAKEN, at, f32(taken));
}

// Skipped cells lose the water that now bypasses them. The starts of shortcuts keep theirs, because no shortcut that is
// taken skips them. The lower eight bits of `frame.step` are the plane of areas, the next eight bits the plane of
// paths.
fn bypass(base: u32, at: vec2<i32>) {
    let code = river_code(at);
    let areas = frame.step & 0xffu;
    let taken = u32(plane(TAKEN, at));
    var way = DRY;
    if (code > FREE) {
        way = u32(plane(RECEIVER, at));
    }
    if (taken != 0u) {
        way = taken & 15u;
    } else if (code >= 0.0 && code < NONE) {
        var area = plane(areas, at);
        var is_skipped = false;
        for (var k = 0; k < 49; k += 1) {
            let near = at + vec2<i32>(k % 7 - 3, k / 7 - 3);
            let other = u32(plane(TAKEN, near));
            if (other != 0u) {
                if (skips(near, other, at)) {
                    area -= plane(areas, near);
                    is_skipped = true;
                }
            }
        }
        if (is_skipped) {
            way |= SKIPPED;
            set_plane(areas, at, area);
        }
    }
    set_plane((frame.step >> 8u) & 0xffu, at, f32(way));
}

// A skipped cell becomes dry if no remaining river leads to it.
fn dry(base: u32, at: vec2<i32>) {
    let ways = frame.step & 0xffu;
    var way = u32(plane(ways, at));
    if (way >= SKIPPED) {
        var is_left = false;
        for (var k = 0u; k < 8u; k += 1u) {
            is_left = is_left || (u32(plane(ways, at + step_of(k))) & 15u) == opposite(k);
        }
        if (!is_left) {
            way = SKIPPED | DRY;
        }
    }
    set_plane((frame.step >> 8u) & 0xffu, at, f32(way));
}

// The lower eight bits of `frame.step` are the plane of heights, followed by the plane of areas and the plane of paths,
// with eight bits each.
fn straighten(base: u32, at: vec2<i32>) {
    let areas = (frame.step >> 8u) & 0xffu;
    let way = u32(plane((frame.step >> 16u) & 0xffu, at));
    if (u32(plane(TAKEN, at)) != 0u) {
        set_plane(FIXED, at, f32(way & 15u));
        set_plane(RECEIVER, at, f32(way & 15u));
    }
    if (way == (SKIPPED | DRY)) {
        set_plane(FIXED, at, FREE);
        set_plane(RECEIVER, at, NONE);
        set_plane(frame.step & 0xffu, at, UNKNOWN);
        set_plane(areas, at, 1.0);
    } else if (way >= SKIPPED) {
        set_plane(areas, at, max(plane(areas, at), 1.0));
    }
}
