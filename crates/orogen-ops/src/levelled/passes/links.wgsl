// Chooses the links of the parents that are kept, and the children that they pass, as in `links.rs`. Planes of the
// level above: links without detours, the children that links use, and links.

// The exit and the entry of a link across a side, chosen by length and at random.
fn across_side(base: u32, at: vec2<i32>, by: vec2<i32>, straight: vec2<u32>) -> vec2<u32> {
    let to = at + by;
    let begin = child_of(at, heir(at));
    let end = child_of(to, heir(to));
    let bits = parent_bits(wander_hash(base), at);
    var shortest = UNKNOWN;
    var best = vec2<u32>(0u);
    for (var choice = 0u; choice < 4u; choice += 1u) {
        let sides = vec2<u32>(choice & 1u, choice >> 1u);
        let pair = straight | select(sides, sides << vec2<u32>(1u), by.x != 0);
        let exit = child_of(at, pair.x);
        let entry = child_of(to, pair.y);
        let length = distance_of(begin, exit) + distance_of(exit, entry) + distance_of(entry, end);
        let drawn = length * (1.0 + wander(base) * unit16(bits, choice));
        if (drawn < shortest) {
            shortest = drawn;
            best = pair;
        }
    }
    return best;
}

fn connect(base: u32, at: vec2<i32>) {
    let code = above(RECEIVER, at);
    var link = Link(code >= NONE, false, 0u, 0u, 0u);
    for (var k = 0u; k < 8u; k += 1u) {
        if (leads_to(at + step_of(k), at)) {
            link.kept = true;
            link.fed = true;
        }
    }
    if (link.kept && drains(code)) {
        let by = step_of(u32(code));
        // The bits of the sides of the cells in the link's direction.
        let exit = select(0u, 1u, by.x > 0) | select(0u, 2u, by.y > 0);
        let entry = select(0u, 1u, by.x < 0) | select(0u, 2u, by.y < 0);
        var pair = vec2<u32>(exit, entry);
        if (by.x == 0 || by.y == 0) {
            pair = across_side(base, at, by, pair);
        }
        link.leaves = pair.x;
        link.arrives = pair.y;
    }
    set_above(DIRECT, at, encoded(link));
}

// The children of a cell that links use.
fn occupy(base: u32, at: vec2<i32>) {
    var used = 1u << heir(at);
    for (var k = 0; k < 9; k += 1) {
        let near = near_cell(at, k);
        let code = above(RECEIVER, near);
        if (!is_inner(near) || !drains(code)) {
            continue;
        }
        let link = link_in(DIRECT, near);
        if (link.kept && same(near, at)) {
            used |= 1u << link.leaves;
        } else if (link.kept && same(receiver_of(near), at)) {
            used |= 1u << link.arrives;
        }
    }
    set_above(USED, at, f32(used));
}

// Leads some links that cross a corner around it, through an unused child of one of the two other cells.
fn go_around(base: u32, at: vec2<i32>) {
    let code = above(RECEIVER, at);
    var link = link_in(DIRECT, at);
    if (!has(base, FINEST) && link.kept && drains(code) && (u32(code) & 1u) != 0u) {
        let exit = child_of(at, link.leaves);
        let entry = child_of(receiver_of(at), link.arrives);
        let bits = parent_bits(diagonal_hash(base), at);
        var shortest = distance_of(exit, entry) * (1.0 + wander(base) * unit16(bits, 0u));
        for (var around = 1u; around < 3u; around += 1u) {
            let child = passed(at, link, around);
            let corner = u32(child.x & 1) | (u32(child.y & 1) << 1u);
            if (((u32(above(USED, child / 2)) >> corner) & 1u) != 0u) {
                continue;
            }
            let length = (distance_of(exit, child) + distance_of(child, entry)) * 0.9;
            let drawn = length * (1.0 + wander(base) * unit16(bits, around));
            if (drawn < shortest) {
                shortest = drawn;
                link.around = around;
            }
        }
    }
    set_above(LINK, at, encoded(link));
}
