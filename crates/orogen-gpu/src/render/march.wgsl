// Intersection of rays with the land.

// The surfaces that a ray can meet.
const NOTHING = 0u;
const GROUND = 1u;
const WATER_TOP = 2u;
const SIDE = 3u;
const WATER_SIDE = 4u;
const TABLE_TOP = 5u;

struct Hit {
    distance: f32,
    surface: u32,
    // The z of ground or water; on a side, the z of the ray.
    z: f32,
    // The horizontal normal of a side.
    normal: vec2<f32>,
}

// A line over the land. `inverse` is 1 / `along`, or 0 where `along` is about 0.
struct Line {
    base: vec2<f32>,
    along: vec2<f32>,
    inverse: vec2<f32>,
}

fn line_of(base: vec2<f32>, along: vec2<f32>) -> Line {
    let level = abs(along) < vec2<f32>(1e-12);
    return Line(base, along, select(1.0 / along, vec2<f32>(0.0), level));
}

// A traversal of the nodes of the pyramid along a line.
struct Walk {
    level: u32,
    // The patch; for a higher node, any of its patches.
    cell: vec2<i32>,
    // The distance at which the line enters the node.
    enter: f32,
}

struct Exit {
    distance: f32,
    across_x: bool,
}

fn exit_of(walk: Walk, line: Line) -> Exit {
    let node = walk.cell >> vec2<u32>(walk.level);
    let side = select(vec2<i32>(0), vec2<i32>(1), line.along > vec2<f32>(0.0));
    let edge = (node + side) << vec2<u32>(walk.level);
    let ways = (vec2<f32>(edge - origin) - line.base) * line.inverse;
    let away = select(ways, vec2<f32>(FAR), line.inverse == vec2<f32>(0.0));
    return Exit(max(min(away.x, away.y), walk.enter), away.x <= away.y);
}

// Moves to the next node. Returns false if it is outside the land.
fn next_node(walk: ptr<function, Walk>, line: Line, exit: Exit) -> bool {
    let level = (*walk).level;
    let node = (*walk).cell >> vec2<u32>(level);
    let x = exit.across_x;
    let before = select(node.y, node.x, x);
    var crossed = (before << level) - 1;
    if (select(line.along.y, line.along.x, x) > 0.0) {
        crossed = (before + 1) << level;
    }
    if (crossed < 0 || crossed > select(land_last.y, land_last.x, x)) {
        return false;
    }
    // On the other axis the line is still in the same node; rounding must not put it beyond the node's ends.
    let other = select(node.x, node.y, x);
    let place = clamp(line.base + line.along * exit.distance, land_low, land_high);
    let cell = vec2<i32>(floor(place)) + origin;
    let end = min(((other + 1) << level) - 1, select(land_last.x, land_last.y, x));
    let at = clamp(select(cell.x, cell.y, x), other << level, end);
    (*walk).cell = select(vec2<i32>(at, crossed), vec2<i32>(crossed, at), x);
    (*walk).enter = exit.distance;
    if ((crossed >> (level + 1u)) != (before >> 1u)) {
        (*walk).level = min(level + 1u, top_level);
    }
    return true;
}

// The distances between which a line is over the land, and the horizontal normal of the edge that it enters through.
struct Clip {
    enter: f32,
    leave: f32,
    face: vec2<f32>,
}

// Empty, with `enter` above `leave`, if the line misses the land.
fn clip_line(line: Line, nearest: f32) -> Clip {
    let empty = Clip(1.0, 0.0, vec2<f32>(0.0));
    var clip = Clip(nearest, FAR, vec2<f32>(0.0));
    let first = (land_low - line.base) * line.inverse;
    let second = (land_high - line.base) * line.inverse;
    let near = min(first, second);
    let far = max(first, second);
    let outward = -sign(line.along);
    if (line.inverse.x == 0.0) {
        if (line.base.x < land_low.x || line.base.x > land_high.x) {
            return empty;
        }
    } else {
        if (near.x > clip.enter) {
            clip.enter = near.x;
            clip.face = vec2<f32>(outward.x, 0.0);
        }
        clip.leave = min(clip.leave, far.x);
    }
    if (line.inverse.y == 0.0) {
        if (line.base.y < land_low.y || line.base.y > land_high.y) {
            return empty;
        }
    } else {
        if (near.y > clip.enter) {
            clip.enter = near.y;
            clip.face = vec2<f32>(0.0, outward.y);
        }
        clip.leave = min(clip.leave, far.y);
    }
    return clip;
}

// The first s from 0 to `end` where above + fall s + bend s^2 is not positive; negative if there is none.
fn first_root(above: f32, fall: f32, bend: f32, end: f32) -> f32 {
    if (above <= 0.0) {
        return 0.0;
    }
    let square = fall * fall - 4.0 * bend * above;
    if (square < 0.0) {
        return -1.0;
    }
    // The form of each root without cancellation.
    let q = -0.5 * (fall + select(sqrt(square), -sqrt(square), fall < 0.0));
    var root = FAR;
    if (abs(q) > 1e-20) {
        let one = above / q;
        if (one >= 0.0) {
            root = one;
        }
    }
    if (abs(bend) > 1e-20) {
        let other = q / bend;
        if (other >= 0.0) {
            root = min(root, other);
        }
    }
    return select(-1.0, root, root <= end);
}

// The first intersection of a ray with the ground or the water of a patch, between two distances.
fn meets(base: vec3<f32>, along: vec3<f32>, cell: vec2<i32>, enter: f32, exit: f32) -> Hit {
    let ground = patch_at(cell);
    let start = base + along * enter;
    let uv = start.xy - vec2<f32>(cell - origin);
    let above = start.z - (ground.corner + ground.east * uv.x + (ground.south + ground.twist * uv.x) * uv.y);
    let slope = ground.east * along.x + ground.south * along.y + ground.twist * (uv.x * along.y + uv.y * along.x);
    let s = first_root(above, along.z - slope, -ground.twist * along.x * along.y, exit - enter);
    let level = water_at(cell);
    if (level > DRY && along.z < 0.0 && above > 0.0) {
        let water = (level - start.z) / along.z;
        if (water >= 0.0 && water <= exit - enter && (s < 0.0 || water < s)) {
            return Hit(enter + water, WATER_TOP, level, vec2<f32>(0.0));
        }
    }
    if (s < 0.0) {
        return Hit(0.0, NOTHING, 0.0, vec2<f32>(0.0));
    }
    // The z of the ground, because the z of the ray has the error of its distance.
    return Hit(enter + s, GROUND, ground_in(cell, base.xy + along.xy * (enter + s)), vec2<f32>(0.0));
}

// The first intersection of a ray, at least `nearest` cells from its origin.
fn first_hit(base: vec3<f32>, along: vec3<f32>, nearest: f32) -> Hit {
    let nothing = Hit(0.0, NOTHING, 0.0, vec2<f32>(0.0));
    let line = line_of(base.xy, along.xy);
    var clip = clip_line(line, nearest);
    if (along.z < 0.0) {
        let falls = (land_highest - base.z) / along.z;
        if (falls > clip.enter) {
            clip.enter = falls;
            clip.face = vec2<f32>(0.0);
        }
    } else if (along.z > 0.0) {
        clip.leave = min(clip.leave, (land_highest - base.z) / along.z);
    } else if (base.z > land_highest) {
        return nothing;
    }
    if (clip.enter > clip.leave) {
        return nothing;
    }
    if (any(clip.face != vec2<f32>(0.0))) {
        let place = base + along * clip.enter;
        if (place.z < ground_at(place.xy)) {
            return Hit(clip.enter, SIDE, place.z, clip.face);
        }
        if (place.z < top_at(place.xy)) {
            return Hit(clip.enter, WATER_SIDE, place.z, clip.face);
        }
    }
    var walk = Walk(top_level, cell_at(line.base + line.along * clip.enter), clip.enter);
    loop {
        let exit = exit_of(walk, line);
        let low = base.z + along.z * select(walk.enter, exit.distance, along.z < 0.0);
        // Rounding must not let a ray pass below the highest point of a node.
        let slack = 1e-6 * (abs(base.z) + walk.enter);
        if (low - slack <= top_of(walk.level, walk.cell)) {
            if (walk.level > 0u) {
                walk.level -= 1u;
                continue;
            }
            let hit = meets(base, along, walk.cell, walk.enter, exit.distance);
            if (hit.surface != NOTHING) {
                return hit;
            }
        }
        if (exit.distance >= clip.leave || !next_node(&walk, line, exit)) {
            return nothing;
        }
    }
    return nothing;
}

// The steepest slope (z per cell of distance) from a point to any ground in a horizontal unit direction, at least
// `nearest` cells away, if it is more than `at_least`. Values above `enough` are not refined.
fn steepest(place: vec3<f32>, along: vec2<f32>, nearest: f32, at_least: f32, enough: f32) -> f32 {
    var most = at_least;
    let line = line_of(place.xy, along);
    let clip = clip_line(line, nearest);
    if (clip.enter > clip.leave) {
        return most;
    }
    // Starting in the topmost node would only add descents.
    var walk = Walk(min(2u, top_level), cell_at(line.base + line.along * clip.enter), clip.enter);
    loop {
        let exit = exit_of(walk, line);
        // Within this range, the line with the steepest slope so far is nowhere lower than this.
        let lowest = place.z + most * select(exit.distance, walk.enter, most > 0.0);
        if (most > 0.0 && lowest > land_highest) {
            return most;
        }
        if (lowest < top_of(walk.level, walk.cell)) {
            if (walk.level > 0u) {
                walk.level -= 1u;
                continue;
            }
            most = max(most, rise_over(place, line, walk, min(exit.distance, clip.leave)));
            if (most > enough) {
                return most;
            }
        }
        if (exit.distance >= clip.leave || !next_node(&walk, line, exit)) {
            return most;
        }
    }
    return most;
}

// The steepest slope to the ground of a patch.
fn rise_over(place: vec3<f32>, line: Line, walk: Walk, exit: f32) -> f32 {
    let ground = patch_at(walk.cell);
    let along = line.along;
    let uv = line.base + along * walk.enter - vec2<f32>(walk.cell - origin);
    // The ground above the point, at a distance s from the line's entry: start + climb s + bend s^2. Distances from the
    // point itself would lose precision by cancellation.
    let start = ground.corner + ground.east * uv.x + (ground.south + ground.twist * uv.x) * uv.y - place.z;
    let climb = ground.east * along.x + ground.south * along.y + ground.twist * (uv.x * along.y + uv.y * along.x);
    let bend = ground.twist * along.x * along.y;
    let enter = walk.enter;
    let end = max(exit - enter, 0.0);
    var most = max(start / enter, (start + (climb + bend * end) * end) / (enter + end));
    let turn = (start - climb * enter + bend * enter * enter) * bend;
    if (turn > 0.0) {
        let s = sqrt(turn) / abs(bend) - enter;
        if (s > 0.0 && s < end) {
            most = max(most, (start + (climb + bend * s) * s) / (enter + s));
        }
    }
    return most;
}
