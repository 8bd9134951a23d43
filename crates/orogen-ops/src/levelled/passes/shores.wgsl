// Standing water of the children, as in `shores.rs`. These numbers are what links make of a child: nothing, a river, a
// mouth or a lake.
const HELD_NOT = 0u;
const HELD_RIVER = 1u;
const HELD_MOUTH = 2u;
const HELD_LAKE = 3u;

struct Held {
    kind: u32,
    height: f32,
}

// Combines the data of two links: lakes take precedence over rivers, and of two rivers the lower one counts.
fn gained(held: Held, other: Held) -> Held {
    if (held.kind == HELD_LAKE && other.kind == HELD_RIVER) {
        return held;
    }
    if (held.kind == HELD_RIVER && other.kind == HELD_RIVER) {
        return Held(HELD_RIVER, min(held.height, other.height));
    }
    return other;
}

// Whether a node of a lake has water from the same lake.
fn is_fed_by_lake(at: vec2<i32>) -> bool {
    for (var k = 0u; k < 8u; k += 1u) {
        let near = at + step_of(k);
        if (leads_to(near, at) && is_lake(above(RECEIVER, near)) && link_in(LINK, near).kept) {
            return true;
        }
    }
    return false;
}

// Adds the data of a link to a child.
fn held_by(parent: vec2<i32>, link: Link, at: vec2<i32>, before: Held) -> Held {
    let way = way_of(parent, link);
    if (!(same(at, way.start) || same(at, way.exit) || same(at, way.via) || same(at, way.entry))) {
        return before;
    }
    let code = above(RECEIVER, parent);
    let to = receiver_of(parent);
    let lake = Held(HELD_LAKE, above(HEIGHT, parent));
    let below = above(HEIGHT, to);
    let river = Held(HELD_RIVER, below);
    let is_outlet = is_lake(code) && !is_lake(above(RECEIVER, to));
    var first = river;
    if (is_lake(code)) {
        first = lake;
    }
    // A lake ends at the start of its outlet's link, or one child later if the lake has no other part.
    var later = river;
    if (is_lake(code) && !(is_outlet && is_fed_by_lake(parent))) {
        later = lake;
    }
    var held = before;
    if (same(at, way.start)) {
        held = gained(held, first);
    }
    if (same(at, way.exit)) {
        held = gained(held, later);
    }
    if (same(at, way.via)) {
        held = gained(held, later);
    }
    if (same(at, way.entry)) {
        if (is_lake(code) && !is_outlet) {
            held = gained(held, Held(HELD_LAKE, below));
        } else if (above(RECEIVER, to) < NONE) {
            held = gained(held, river);
        }
    }
    return held;
}

// The data of the links for each child, and the initial water.
fn hold(base: u32, at: vec2<i32>) {
    let parent = at / 2;
    var held = Held(HELD_NOT, 0.0);
    var is_mouth = false;
    for (var k = 0; k < 9; k += 1) {
        let near = near_cell(parent, k);
        if (!is_inner(near)) {
            continue;
        }
        let link = link_in(LINK, near);
        if (!link.kept) {
            continue;
        }
        if (drains(above(RECEIVER, near))) {
            if (k == 4 || link.around != 0u || same(receiver_of(near), parent)) {
                held = held_by(near, link, at, held);
            }
        } else if (same(near, parent) && link.fed && same(at, child_of(parent, heir(parent)))) {
            is_mouth = true;
        }
    }
    // A passing river is land even where another river ends.
    if (is_mouth && held.kind == HELD_NOT) {
        held.kind = HELD_MOUTH;
    }
    var level = UNKNOWN;
    let floods = held.kind == HELD_MOUTH || (held.kind == HELD_NOT && plane(SHORE, at) < 0.0);
    if (held.kind == HELD_LAKE) {
        level = held.height;
    } else if (above(RECEIVER, parent) >= NONE && floods) {
        level = above(HEIGHT, parent);
    }
    set_plane(HELD, at, f32(held.kind));
    set_plane(HELD_HEIGHT, at, held.height);
    set_plane(FIRST_LEVEL, at, level);
}

// Whether a river that is or will become lower than a water level passes next to a child.
fn is_beside_lower(at: vec2<i32>, level: f32) -> bool {
    for (var k = 0u; k < 8u; k += 1u) {
        let near = at + step_of(k);
        if (u32(plane(HELD, near)) == HELD_RIVER && plane(HELD_HEIGHT, near) < level) {
            return true;
        }
    }
    return false;
}

fn is_in_lake(at: vec2<i32>) -> bool {
    return u32(plane(HELD, at)) == HELD_LAKE || is_lake(above(RECEIVER, at / 2));
}

// Keeps lakes with an outlet apart from other water and from lower rivers.
fn dry_between(base: u32, at: vec2<i32>) {
    let level = plane(FIRST_LEVEL, at);
    var dried = level;
    if (level < KNOWN && u32(plane(HELD, at)) == HELD_NOT) {
        let is_own = is_in_lake(at);
        for (var k = 0u; k < 8u; k += 1u) {
            let near = at + step_of(k);
            let other = plane(FIRST_LEVEL, near);
            if (other < KNOWN && other != level && (is_own || is_in_lake(near))) {
                dried = UNKNOWN;
            }
        }
        if (is_own && is_beside_lower(at, level)) {
            dried = UNKNOWN;
        }
    }
    set_plane(DRIED_LEVEL, at, dried);
}

// Spreads water by one cell into low land, and moves shores accordingly.
fn spread(base: u32, at: vec2<i32>) {
    let held = u32(plane(HELD, at));
    let shore = plane(SHORE, at);
    var level = plane(DRIED_LEVEL, at);
    var beside = 0u;
    if (above(RECEIVER, at / 2) < NONE && held == HELD_NOT && shore < 0.0) {
        var water = UNKNOWN;
        var is_one = true;
        // West, east, north and south.
        for (var k = 0u; k < 4u; k += 1u) {
            let code = (0x2604u >> (4u * k)) & 15u;
            let other = plane(DRIED_LEVEL, at + step_of(code));
            if (other < KNOWN) {
                if (beside == 0u) {
                    beside = code + 1u;
                    water = other;
                }
                is_one = is_one && other == water;
            }
        }
        if (beside != 0u && is_one && !is_beside_lower(at, water)) {
            level = water;
        } else {
            beside = 0u;
        }
    }
    set_plane(LEVEL, at, level);
    set_plane(GAINED, at, f32(beside));
    if (level < KNOWN) {
        set_plane(SHORE, at, min(shore, -0.5 * indent(base)));
    } else {
        set_plane(SHORE, at, max(shore, select(0.3, 0.8, held == HELD_RIVER) * indent(base)));
    }
}
