// Carves rivers of the level above into the children, as in `carve.rs`. Each child gathers the data of the links around
// its parent, in their order.

fn is_water(at: vec2<i32>) -> bool {
    return plane(LEVEL, at) < KNOWN;
}

fn length_of(start: vec2<i32>, end: vec2<i32>) -> f32 {
    if (same(start, end)) {
        return 0.0;
    }
    return distance_of(start, end);
}

// The shares of a link's length up to the exit and the entry. Water of lakes with an outlet does not fall.
fn measure(base: u32, at: vec2<i32>) {
    let link = link_in(LINK, at);
    let code = above(RECEIVER, at);
    var shares = vec2<f32>(0.0);
    if (link.kept && drains(code)) {
        let way = way_of(at, link);
        let leaves_lake = is_lake(code);
        let to_lake = is_lake(above(RECEIVER, receiver_of(at)));
        var first = 0.0;
        if (!(leaves_lake && is_water(way.exit))) {
            first = length_of(way.start, way.exit);
        }
        var second = 0.0;
        if (way.via.x < 0) {
            second = length_of(way.exit, way.entry);
        } else if (leaves_lake && is_water(way.via)) {
            second = length_of(way.via, way.entry);
        } else {
            second = length_of(way.exit, way.via) + length_of(way.via, way.entry);
        }
        var third = 0.0;
        if (!(to_lake && is_water(way.entry))) {
            third = length_of(way.entry, way.end);
        }
        let whole = max(first + second + third, 0.01);
        shares = vec2<f32>(first / whole, (first + second) / whole);
    }
    set_above(TO_EXIT, at, shares.x);
    set_above(TO_ENTRY, at, shares.y);
}

struct Carved {
    height: f32,
    area: f32,
    // The direction in which a link leads on, NONE without one.
    led: u32,
}

// Adds the height and area of a link to a child. Standing water keeps its level.
fn put(carved: Carved, at: vec2<i32>, height: f32, area: f32) -> Carved {
    return Carved(select(height, carved.height, is_water(at)), carved.area + area, carved.led);
}

// Adds the data of a link up to its entry to a child.
fn left_by(parent: vec2<i32>, link: Link, at: vec2<i32>, before: Carved) -> Carved {
    let way = way_of(parent, link);
    let has_via = way.via.x >= 0;
    var carved = before;
    let top = above(HEIGHT, parent);
    let fall = above(HEIGHT, receiver_of(parent)) - top;
    let area = 4.0 * above(AREA, parent);
    let is_moved = !same(way.exit, way.start);
    if (same(at, way.start)) {
        carved = put(carved, at, top, area);
        if (is_moved) {
            carved.led = code_of(way.exit - at);
        }
    }
    if (same(at, way.exit)) {
        if (is_moved) {
            carved = put(carved, at, top + fall * above(TO_EXIT, parent), area + 1.0);
        }
        carved.led = code_of(select(way.entry, way.via, has_via) - at);
    }
    if (has_via && same(at, way.via)) {
        let share = 0.5 * (above(TO_EXIT, parent) + above(TO_ENTRY, parent));
        carved = put(carved, at, top + fall * share, area + steps_of(way));
        carved.led = code_of(way.entry - at);
    }
    return carved;
}

// The area of a link at its entry.
fn arriving(parent: vec2<i32>, way: Way) -> f32 {
    return 4.0 * above(AREA, parent) + steps_of(way);
}

// Adds the data of the end of a link from `donor` to `parent` to a child of `parent`.
fn arrived_by(donor: vec2<i32>, parent: vec2<i32>, at: vec2<i32>, before: Carved) -> Carved {
    let way = way_of(donor, link_in(LINK, donor));
    let drains_on = drains(above(RECEIVER, parent));
    var carved = before;
    if (same(way.entry, way.end) || (is_water(way.entry) && !drains_on)) {
        return carved;
    }
    let area = arriving(donor, way);
    if (drains_on && same(child_of(parent, link_in(LINK, parent).leaves), way.entry)) {
        // The link joins the river below its node.
        if (same(at, way.end)) {
            carved.area -= area;
        }
        return carved;
    }
    if (same(at, way.entry)) {
        let top = above(HEIGHT, donor);
        let height = top + (above(HEIGHT, parent) - top) * above(TO_ENTRY, donor);
        carved = put(carved, at, min(height, carved.height), area + select(1.0, 0.0, carved.area > 0.0));
        carved.led = code_of(way.end - at);
    }
    return carved;
}

fn is_kept(parent: vec2<i32>) -> bool {
    return is_inner(parent) && link_in(LINK, parent).kept;
}

// Heights, areas and receivers of rivers and of standing water. The lower eight bits of `frame.step` are the plane of
// heights, the next eight bits the plane of areas.
fn carve(base: u32, at: vec2<i32>) {
    let parent = at / 2;
    let water = is_water(at);
    var carved = Carved(plane(LEVEL, at), 0.0, 8u);
    for (var k = 0; k < 9; k += 1) {
        let near = near_cell(parent, k);
        // Before its entry a link passes its parent, and a third cell if it leads around a corner.
        if (is_kept(near) && drains(above(RECEIVER, near))) {
            let link = link_in(LINK, near);
            if (k == 4 || link.around != 0u) {
                carved = left_by(near, link, at, carved);
            }
        }
    }
    for (var k = 0; k < 9; k += 1) {
        let near = near_cell(parent, k);
        if (k != 4 && is_kept(near) && leads_to(near, parent)) {
            carved = arrived_by(near, parent, at, carved);
        }
    }
    var receiver = carved.led;
    let node = child_of(parent, heir(parent));
    if (receiver == 8u && is_lake(above(RECEIVER, parent)) && water && !same(at, node)) {
        receiver = code_of(node - at);
    }
    set_plane(frame.step & 0xffu, at, carved.height);
    set_plane((frame.step >> 8u) & 0xffu, at, carved.area);
    set_plane(RECEIVER, at, f32(receiver));
    set_plane(LED, at, f32(carved.led));
    if (water) {
        set_plane(FIXED, at, WATER);
    } else {
        set_plane(FIXED, at, select(f32(carved.led), FREE, carved.led == 8u));
    }
}

// Keeps areas between the area of a node and the areas of its donors. Water that has spread drains to the adjacent
// water that it came from, if that water drains. The lower eight bits of `frame.step` are the plane of areas that is
// read, the next eight bits the plane that is written.
fn bound_areas(base: u32, at: vec2<i32>) {
    let parent = at / 2;
    let areas = frame.step & 0xffu;
    var area = plane(areas, at);
    if (drains(above(RECEIVER, parent))) {
        let most = 4.0 * above(AREA, parent);
        let exit = child_of(parent, link_in(LINK, parent).leaves);
        for (var k = 0; k < 9; k += 1) {
            let near = near_cell(parent, k);
            if (k == 4 || !is_kept(near) || !leads_to(near, parent)) {
                continue;
            }
            let way = way_of(near, link_in(LINK, near));
            if (same(way.entry, way.end)) {
                if (same(at, way.end)) {
                    area = max(area, arriving(near, way));
                }
            } else if (!same(exit, way.entry)) {
                if (same(at, way.entry)) {
                    area = min(area, most);
                }
                if (same(at, way.end)) {
                    area = max(area, min(plane(areas, way.entry), most));
                }
            }
        }
    }
    set_plane((frame.step >> 8u) & 0xffu, at, max(area, 1.0));
    // Children to which water has spread have no link, so no call writes a receiver that another call reads.
    let gained = u32(plane(GAINED, at));
    if (gained != 0u) {
        if (plane(RECEIVER, at + step_of(gained - 1u)) < WATER) {
            set_plane(RECEIVER, at, f32(gained - 1u));
        }
    }
}

fn between(at: vec2<i32>, code: u32) -> f32 {
    return max(distance_of(at, at + step_of(code)), 0.35);
}

// Whether the diagonal from a cell to the south-east is open instead of the one that crosses it. A link opens its
// diagonal; if two links cross, the last one does. Without a link the shorter diagonal is open.
fn is_falling(at: vec2<i32>) -> bool {
    let east = at + vec2<i32>(1, 0);
    let south = at + vec2<i32>(0, 1);
    if (plane(LED, at + vec2<i32>(1)) == 5.0) {
        return true;
    }
    if (plane(LED, east) == 3.0 || plane(LED, south) == 7.0) {
        return false;
    }
    if (plane(LED, at) == 1.0) {
        return true;
    }
    return between(at, 1u) < between(east, 3u);
}

// Distances between the nodes of neighboring cells, as in `distances.rs`.
fn measure_cells(base: u32, at: vec2<i32>) {
    set_plane(DISTANCE, at, between(at, 0u));
    set_plane(DISTANCE + 2u, at, between(at, 2u));
    var falling = UNKNOWN;
    if (is_falling(at)) {
        falling = between(at, 1u);
    }
    var rising = UNKNOWN;
    if (!is_falling(at - vec2<i32>(1, 0))) {
        rising = between(at, 3u);
    }
    set_plane(DISTANCE + 1u, at, falling);
    set_plane(DISTANCE + 3u, at, rising);
}
