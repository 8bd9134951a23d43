// Light from the surfaces that rays meet.



// Width of a pixel in metres at a distance; `cosine` is that of the viewing angle.
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
    let hidden = clamp((rise - rims.x) / (rims.y - rims.x), 0.0, 1.0);
    return 1.0 - hidden * hidden * (3.0 - 2.0 * hidden);
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
        albedo = section(along, height_of(place.z), below, max(metres(depth), 1.0));
    }
    let facing = max(dot(met.normal, pair(SUN)), 0.0);
    // The side sees half sky, half table, which is darker at its foot.
    var foot = 1.0;
    if (depth > 0.0) {
        foot = 0.55 + 0.45 * clamp((place.z - lowest) / depth, 0.0, 1.0);
    }
    let table = TABLE * (0.5 * triple(LEVEL_SUN) + triple(LEVEL_SKY));
    let soft = foot * 0.5 * (triple(LEVEL_SKY) + table);
    return albedo / PI * (triple(SUNLIGHT) * facing + soft);
}

fn table_light(met: Met, seen: f32) -> vec3<f32> {
    let place = met.place;
    let nearest = clamp(place.xy, land_low, land_high);
    let off = distance(place.xy, nearest);
    let high = top_at(nearest) - place.z;
    let open = 0.5 + 0.5 * off / max(sqrt(off * off + high * high), 1e-9);
    let near = TABLE / PI * (triple(LEVEL_SUN) * seen + triple(LEVEL_SKY) * open);
    // The table fades into the horizon far behind the land.
    let far = exp(-(off / (1.3 * length(land_high - land_low))));
    return mix(sky_light(unit(vec3<f32>(met.ray.along.xy, 0.02))), near, far);
}

fn ground_light(look: Look, facing: f32, seen: f32, place: vec2<f32>) -> vec3<f32> {
    let shed = skylight_at(place);
    let bounced = MEAN_ALBEDO * (0.7 * triple(LEVEL_SUN) + triple(LEVEL_SKY)) * max(1.0 - shed.w, 0.0);
    return look.albedo / PI * (triple(SUNLIGHT) * (max(facing, 0.0) * seen) + shed.xyz + bounced);
}

// The light along a ray from the camera. Each surface is shaded by the same code, whether a ray meets it directly or reflected: the second pass follows the ray that
// water reflects.
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

        // What the surface is like, and from where on obstacles hide the sun; 0 if its light does not matter.
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
            let within = body / PI * (triple(LEVEL_SUN) * seen + triple(LEVEL_SKY));
            light = within * (1.0 - reflected) + triple(SUNLIGHT) * (seen * glitter(normal, -along, sun_here));
            away = along - normal * (2.0 * dot(along, normal));
            away = unit(vec3<f32>(away.xy, max(away.z, 0.004)));
        } else if (met.surface == TABLE_TOP) {
            light = table_light(met, seen);
        } else {
            light = side_light(met);
        }

        let left = haze_left(ray.start.z, place.z, met.distance);
        let air_along = select(ray.along, view, first);
        let air = sky_light(unit(vec3<f32>(air_along.xy, max(air_along.z, 0.0) + 0.015)));
        sum += weight * mix(air, light, left);
        if (reflected <= 0.0) {
            break;
        }
        weight *= left * reflected;
        before = distance;
        ray = Ray(place, away, turned);
    }
    return sum;
}
