// Linear extrapolation beyond the world: its columns and rows (0 if it is unbounded), and the number of samples beyond
// an edge.

// The value `steps` samples beyond the sample `last` at an edge.
fn continued(last: f32, before: f32, steps: i32) -> f32 {
    let next = last + f32(steps) * (last - before);
    return select(next, last, is_missing(next));
}

// The sample that is nearest to a position, of `count` samples.
fn nearest(position: i32, count: i32) -> i32 {
    return clamp(position, 0, count - 1);
}

// The value at a position whose row is inside the world. `at` is the position in the planes, `place` in the world.
fn in_row(base: u32, at: vec2<i32>, place: i32) -> f32 {
    let columns = i32(data[base]);
    let last = nearest(place, columns);
    let steps = abs(place - last);
    let edge = plane(0u, vec2<i32>(at.x + last - place, at.y));
    if (steps == 0) {
        return edge;
    }
    if (steps > i32(data[base + 2u])) {
        return missing();
    }
    let before = nearest(last + sign(last - place), columns);
    return continued(edge, plane(0u, vec2<i32>(at.x + before - place, at.y)), steps);
}

fn extrapolate(base: u32, at: vec2<i32>) {
    let rows = i32(data[base + 1u]);
    if (rows == 0) {
        set_plane(1u, at, plane(0u, at));
        return;
    }
    let place = vec2<i32>(bitcast<i32>(column_low()), bitcast<i32>(row_low())) + at;
    let last = nearest(place.y, rows);
    let steps = abs(place.y - last);
    let edge = in_row(base, vec2<i32>(at.x, at.y + last - place.y), place.x);
    if (steps == 0) {
        set_plane(1u, at, edge);
        return;
    }
    if (steps > i32(data[base + 2u])) {
        set_plane(1u, at, missing());
        return;
    }
    let before = nearest(last + sign(last - place.y), rows);
    let value = continued(edge, in_row(base, vec2<i32>(at.x, at.y + before - place.y), place.x), steps);
    set_plane(1u, at, value);
}
