// The path of a parent's link, encoded as one whole number.

struct Link {
    // Whether the parent has a donor or is water, and whether it has a donor.
    kept: bool,
    fed: bool,
    // The children through which the river leaves and arrives.
    leaves: u32,
    arrives: u32,
    // The third cell that the link passes: 0 for none, 1 for the one in the east or west, 2 for the one in the north or
    // south.
    around: u32,
}

fn encoded(link: Link) -> f32 {
    let bits = select(0u, 1u, link.kept) | select(0u, 2u, link.fed);
    return f32(bits | (link.leaves << 2u) | (link.arrives << 4u) | (link.around << 6u));
}

fn link_in(k: u32, parent: vec2<i32>) -> Link {
    let bits = u32(above(k, parent));
    return Link((bits & 1u) != 0u, (bits & 2u) != 0u, (bits >> 2u) & 3u, (bits >> 4u) & 3u, (bits >> 6u) & 3u);
}

fn receiver_of(parent: vec2<i32>) -> vec2<i32> {
    return parent + step_of(u32(above(RECEIVER, parent)));
}

// Whether the river of an inner parent leads to a cell.
fn leads_to(parent: vec2<i32>, cell: vec2<i32>) -> bool {
    return is_inner(parent) && drains(above(RECEIVER, parent)) && all(receiver_of(parent) == cell);
}

// The child in the third cell, at the corner that a link crosses.
fn passed(parent: vec2<i32>, link: Link, around: u32) -> vec2<i32> {
    let by = step_of(u32(above(RECEIVER, parent)));
    if (around == 1u) {
        return child_of(parent + vec2<i32>(by.x, 0), (link.arrives & 1u) | (link.leaves & 2u));
    }
    return child_of(parent + vec2<i32>(0, by.y), (link.leaves & 1u) | (link.arrives & 2u));
}

// The children that a link passes. `via` is (-1, -1) if there is no third cell.
struct Way {
    start: vec2<i32>,
    exit: vec2<i32>,
    via: vec2<i32>,
    entry: vec2<i32>,
    end: vec2<i32>,
}

fn way_of(parent: vec2<i32>, link: Link) -> Way {
    let to = receiver_of(parent);
    var via = vec2<i32>(-1);
    if (link.around != 0u) {
        via = passed(parent, link, link.around);
    }
    return Way(child_of(parent, heir(parent)), child_of(parent, link.leaves), via, child_of(to, link.arrives), child_of(to, heir(to)));
}

// Number of children of a path between its start and its entry.
fn steps_of(way: Way) -> f32 {
    return select(0.0, 1.0, any(way.exit != way.start)) + select(0.0, 1.0, way.via.x >= 0);
}

// Number `k` of a cell and the eight around it, row by row.
fn near_cell(at: vec2<i32>, k: i32) -> vec2<i32> {
    return at + vec2<i32>(k % 3 - 1, k / 3 - 1);
}

fn same(a: vec2<i32>, b: vec2<i32>) -> bool {
    return all(a == b);
}
