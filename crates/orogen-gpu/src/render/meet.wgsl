// Intersections of rays with the land and its surroundings.

// A ray in the land's own coordinates, mirrored or not.
struct Ray {
    start: vec3<f32>,
    along: vec3<f32>,
    // East and south: 1, or -1 where the land is mirrored.
    flip: vec2<f32>,
}

// An intersection, with the ray as it arrives there.
struct Met {
    surface: u32,
    // The distance from the ray's first origin.
    distance: f32,
    place: vec3<f32>,
    normal: vec2<f32>,
    ray: Ray,
}

fn way_to_edge(start: f32, along: f32, low: f32, high: f32) -> f32 {
    if (abs(along) < 1e-12) {
        return FAR;
    }
    return (select(low, high, along > 0.0) - start) / along;
}

// The first intersection of a ray with the land and, with `copies` above 1, with its mirrored copies: at an edge the
// ray is mirrored instead.
fn meet_land(first: Ray, first_nearest: f32, copies: u32) -> Met {
    var ray = first;
    var nearest = first_nearest;
    var gone = 0.0;
    for (var k = 0u; k < copies; k++) {
        let hit = first_hit(ray.start, ray.along, nearest);
        if (hit.surface != NOTHING) {
            let place = vec3<f32>(ray.start.xy + ray.along.xy * hit.distance, hit.z);
            return Met(hit.surface, gone + hit.distance, place, hit.normal, ray);
        }
        if (k + 1u == copies) {
            break;
        }
        let x = way_to_edge(ray.start.x, ray.along.x, land_low.x, land_high.x);
        let y = way_to_edge(ray.start.y, ray.along.y, land_low.y, land_high.y);
        let way = max(min(x, y), 0.0);
        let at = ray.start + ray.along * way;
        if (way >= FAR || (ray.along.z >= 0.0 && at.z > land_highest)) {
            break;
        }
        ray.start = vec3<f32>(clamp(at.xy, land_low, land_high), at.z);
        if (x <= y) {
            ray.along.x = -ray.along.x;
            ray.flip.x = -ray.flip.x;
        } else {
            ray.along.y = -ray.along.y;
            ray.flip.y = -ray.flip.y;
        }
        gone += way;
        nearest = 0.0;
    }
    return Met(NOTHING, 0.0, vec3<f32>(0.0), vec2<f32>(0.0), ray);
}

// Adds the table below the land, or the sea around it.
fn with_surroundings(land: Met, ray: Ray) -> Met {
    let around = data[AROUND];
    let z = value(AROUND_Z);
    let distance = (z - ray.start.z) / min(ray.along.z, -1e-20);
    if (around == AROUND_MIRRORS) {
        return land;
    }
    let found = land.surface != NOTHING;
    if (ray.along.z >= 0.0 || distance <= 0.0) {
        if (around == AROUND_TABLE && land.place.z <= z) {
            return Met(NOTHING, 0.0, vec3<f32>(0.0), vec2<f32>(0.0), ray);
        }
        return land;
    }
    let surface = select(TABLE_TOP, WATER_TOP, around == AROUND_SEA);
    let level = Met(surface, distance, vec3<f32>(ray.start.xy + ray.along.xy * distance, z), vec2<f32>(0.0), ray);
    if (!found || (around == AROUND_TABLE && land.place.z <= z)) {
        return level;
    }
    // There is no bed beyond the land's edge, so rays below the sea surface meet the sea.
    if (around == AROUND_SEA && distance < land.distance && !is_inside(level.place.xy)) {
        return level;
    }
    return land;
}
