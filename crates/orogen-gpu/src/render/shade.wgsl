// Light from the surfaces that rays meet.



// Width of a pixel in metres at a distance; `cosine` is the cosine of the viewing angle.
fn footprint_at(distance: f32, pixel: f32, cosine: f32) -> f32 {
    // The geometric mean of length and width.
    return distance * pixel * value(CELL) / sqrt(clamp(cosine, 0.04, 1.0)) * 0.7;
}

// The visible share of the sun from a point, ignoring obstacles within `nearest` cells.
fn sun_seen(place: vec3<f32>, flip: vec2<f32>, nearest: f32) -> f32 {
    let rims = pair(RIMS);
    if (rims.y <= 0.0) {
        return 0.0;
    }
    let rise = steepest(place, pair(SUNWARDS) * flip, nearest, rims.x, rims.y);
    return sun_above(rise, rims);
}

fn side_light(met: Met) -> vec3<f32> {
    let place = met.place;
    let lowest = value(FLOOR);
    let depth = -value(FLOOR + 1u);
    var albedo = vec3<f32>(0.0);
    if (met.surface == WATER_SIDE) {
        albedo = water_section(metres(top_at(place.xy) - place.z));
    } else {
        let absolute = place.xy + vec2<f32>(origin);
        let along = select(absolute.y, absolute.x, met.normal.x == 0.0);
        let below = metres(ground_at(place.xy) - place.z);
        albedo = section(along, place.xy, height_of(place.z), below, max(metres(depth), 1.0));
    }
    let facing = max(dot(met.normal, pair(SUN)), 0.0);
    var foot = 1.0;
    if (depth > 0.0) {
        foot = 0.55 + 0.45 * clamp((place.z - lowest) / depth, 0.0, 1.0);
    }
    return side_of(albedo, facing, foot);
}

fn table_light(met: Met, seen: f32) -> vec3<f32> {
    let place = met.place;
    let nearest = clamp(place.xy, land_low, land_high);
    let across = length(land_high - land_low);
    return table_of(met.ray.along, distance(place.xy, nearest), top_at(nearest) - place.z, across, seen);
}

fn ground_light(look: Look, facing: f32, seen: f32, place: vec2<f32>) -> vec3<f32> {
    return diffuse(look.albedo, max(facing, 0.0) * seen, skylight_at(place));
}

// The light along a ray from the camera. The same code shades a surface whether a ray meets it directly or reflected:
// the second pass follows the ray that water reflects.
fn light_along(view: vec3<f32>) -> vec3<f32> {
    let flip = pair(FLIP);
    var ray = Ray(triple(EYE), vec3<f32>(view.xy * flip, view.z), flip);
    var sum = vec3<f32>(0.0);
    var weight = vec3<f32>(1.0);
    var before = 0.0;
    for (var pass_index = 0u; pass_index < 2u; pass_index++) {
        let first = pass_index == 0u;
        let copies = select(1u, MIRRORS, first && data[AROUND] == AROUND_MIRRORS);
        var met = meet_land(ray, select(0.1, 0.0, first), copies);
        if (first) {
            met = with_surroundings(met, ray);
        }
        if (met.surface == NOTHING || (!first && met.surface != GROUND)) {
            if (first) {
                return sky_seen(view);
            }
            return sum + weight * sky_light(vec3<f32>(ray.along.xy * ray.flip, ray.along.z));
        }
        let place = met.place;
        let along = met.ray.along;
        let turned = met.ray.flip;
        let pixel = value(PIXEL) * select(2.0, 1.0, first);
        let distance = before + met.distance;
        let sun_here = triple(SUN) * vec3<f32>(turned, 1.0);

        // The appearance of the surface, and the distance from which obstacles hide the sun; 0 if sunlight does not
        // matter.
        var look: Look;
        var facing = 0.0;
        var nearest = 0.0;
        if (met.surface == GROUND) {
            let site = Site(place.xy, height_of(place.z), footprint_at(distance, pixel, 0.3 - along.z));
            look = look_at(site);
            facing = dot(unit(vec3<f32>(-look.slope, 1.0)), sun_here);
            nearest = select(0.0, 0.75, facing > 0.0);
        } else if (met.surface == WATER_TOP) {
            nearest = select(0.0, 0.25, sun_here.z > 0.0);
        } else if (met.surface == TABLE_TOP) {
            nearest = 1e-3;
        }
        var seen = 0.0;
        if (nearest > 0.0) {
            seen = sun_seen(place, turned, nearest);
        }

        var light = vec3<f32>(0.0);
        var reflected = 0.0;
        var away = vec3<f32>(0.0);
        if (met.surface == GROUND) {
            light = ground_light(look, facing, seen, place.xy);
        } else if (met.surface == WATER_TOP) {
            let normal = wave_normal(place.xy, footprint_at(distance, pixel, -along.z));
            let cosine = max(dot(normal, -along), 0.02);
            reflected = mirrored_share(cosine);
            let inside = is_inside(place.xy);
            var depth = 1e6;
            if (inside) {
                depth = min(metres(place.z - ground_at(place.xy)), 1e6);
            }
            let off = abs(place.z - value(SEA));
            let is_sea = !inside || (data[HAS_SEA] != 0u && off < SEA_LEVEL_TOLERANCE + 1e-6 * abs(place.z + origin_z));
            let body = water_body(is_sea, depth, cosine, max(sun_here.z, 0.0));
            light = water_light(body, normal, -along, sun_here, seen, reflected);
            away = along - normal * (2.0 * dot(along, normal));
            away = unit(vec3<f32>(away.xy, max(away.z, 0.004)));
        } else if (met.surface == TABLE_TOP) {
            light = table_light(met, seen);
        } else {
            light = side_light(met);
        }

        let left = haze_left(ray.start.z + origin_z, place.z + origin_z, met.distance);
        let air_along = select(ray.along, view, first);
        sum += weight * through_air(light, air_along, left);
        if (reflected <= 0.0) {
            break;
        }
        weight *= left * reflected;
        before = distance;
        ray = Ray(place, away, turned);
    }
    return sum;
}
