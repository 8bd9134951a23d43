// Mouths of rivers where shores are given, as in `mouths.rs`.
const BELOW_UNKNOWN = 0u;
const BELOW_LAND = 1u;
const BELOW_SEA = 2u;

// The children of a node according to the given shore. For the sea, the child nearest to the heir and its distance from
// the shore in km.
struct Below {
    kind: u32,
    corner: u32,
    shore: f32,
}

fn below(base: u32, parent: vec2<i32>) -> Below {
    let own = heir(parent);
    var found = Below(BELOW_LAND, 0u, 0.0);
    for (var flip = 0u; flip < 4u; flip += 1u) {
        let corner = own ^ flip;
        let metres = given(given_shore(base), child_of(parent, corner));
        if (is_missing(metres)) {
            return Below(BELOW_UNKNOWN, 0u, 0.0);
        }
        let shore = metres * 1e-3;
        let is_better = found.kind == BELOW_LAND || (flip == 2u && found.corner != own && shore < found.shore);
        if (shore < 0.0 && is_better) {
            found = Below(BELOW_SEA, corner, shore);
        }
    }
    return found;
}

fn is_at_sea(parent: vec2<i32>) -> bool {
    return above(RECEIVER, parent) == NONE && above(HEIGHT, parent) == 0.0;
}

// The direction of a node's receiver, also in lakes with an outlet; 8 for none.
fn direction_of(parent: vec2<i32>) -> u32 {
    let code = above(RECEIVER, parent);
    return u32(select(code, code - LAKE, code >= LAKE));
}

// The height of the lowest river that ends at an inner node; UNKNOWN if none does.
fn lowest_donor(parent: vec2<i32>) -> f32 {
    var lowest = UNKNOWN;
    for (var code = 0u; code < 8u; code += 1u) {
        let donor = parent + step_of(code);
        if (direction_of(donor) == opposite(code)) {
            lowest = min(lowest, above(HEIGHT, donor));
        }
    }
    return lowest;
}

// Whether a river passes between the two cells on the sides of a diagonal step.
fn is_crossed(parent: vec2<i32>, by: vec2<i32>) -> bool {
    let first = direction_of(parent + vec2<i32>(by.x, 0));
    let second = direction_of(parent + vec2<i32>(0, by.y));
    return first == code_of(vec2<i32>(-by.x, by.y)) || second == code_of(vec2<i32>(by.x, -by.y));
}

// The direction to adjacent sea: across a side if possible, never across a river, and then farthest from the shore. 8
// if there is none.
fn way_to_sea(base: u32, parent: vec2<i32>) -> u32 {
    var best = 8u;
    var best_shore = 0.0;
    for (var code = 0u; code < 8u; code += 1u) {
        let near = parent + step_of(code);
        let found = below(base, near);
        if (!is_at_sea(near) || found.kind != BELOW_SEA) {
            continue;
        }
        let is_diagonal = (code & 1u) != 0u;
        let best_is_diagonal = (best & 1u) != 0u;
        let is_better = best == 8u || (best_is_diagonal && !is_diagonal) || (best_is_diagonal == is_diagonal && found.shore < best_shore);
        if (is_better && !(is_diagonal && is_crossed(parent, step_of(code)))) {
            best = code;
            best_shore = found.shore;
        }
    }
    return best;
}

// A position in a cell, moved to its first or second half by mirroring.
fn in_half(share: f32, second: bool) -> f32 {
    return select(1.0 - share, share, (share >= 0.5) == second);
}

// Decides which nodes become mouths.
fn decide_mouths(base: u32, at: vec2<i32>) {
    var east = above(EAST, at);
    var south = above(SOUTH, at);
    var height = above(HEIGHT, at);
    var receiver = above(RECEIVER, at);
    var shore = above(SHORE, at);
    let lowest = lowest_donor(at);
    if (lowest < KNOWN) {
        let found = below(base, at);
        if (is_at_sea(at)) {
            if (found.kind == BELOW_SEA) {
                east = in_half(east, (found.corner & 1u) == 1u);
                south = in_half(south, (found.corner & 2u) == 2u);
            } else if (found.kind == BELOW_LAND) {
                let code = way_to_sea(base, at);
                height = 0.5 * lowest;
                if (code < 8u) {
                    receiver = f32(code);
                } else {
                    shore = min(shore, -2.0 * kilometres(base));
                }
            }
        } else if (found.kind == BELOW_SEA && found.corner == heir(at) && receiver < NONE) {
            let to = receiver_of(at);
            if (is_at_sea(to) && below(base, to).kind == BELOW_SEA) {
                receiver = NONE;
                height = 0.0;
            }
        }
    }
    set_above(NEW_EAST, at, east);
    set_above(NEW_SOUTH, at, south);
    set_above(NEW_HEIGHT, at, height);
    set_above(NEW_RECEIVER, at, receiver);
    set_above(NEW_SHORE, at, shore);
}

// Applies the decisions.
fn move_mouths(base: u32, at: vec2<i32>) {
    set_above(EAST, at, above(NEW_EAST, at));
    set_above(SOUTH, at, above(NEW_SOUTH, at));
    set_above(HEIGHT, at, above(NEW_HEIGHT, at));
    set_above(RECEIVER, at, above(NEW_RECEIVER, at));
    set_above(SHORE, at, above(NEW_SHORE, at));
}
