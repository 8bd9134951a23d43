// Appearance of the ground: rock, scree, grass, forest, snow and sand by slope, height and aspect.

struct Look {
    albedo: vec3<f32>,
    // Slope east and south, including detail smaller than a cell, in z per cell as drawn.
    slope: vec2<f32>,
}

// Albedo, and roughness of the detail.
struct Coat {
    albedo: vec3<f32>,
    rough: f32,
}

// A point on the ground: its height in metres, and the width of a pixel there in metres.
struct Site {
    place: vec2<f32>,
    height: f32,
    footprint: f32,
}

// Bilinear interpolation of a grid of four numbers per sample.
fn between(start: u32, place: vec2<f32>) -> vec4<f32> {
    let cell = cell_at(place);
    let uv = clamp(place, land_low, land_high) - vec2<f32>(cell - origin);
    let at = start + 4u * u32(cell.y * land_columns + cell.x);
    let below = at + 4u * u32(land_columns);
    return mix(mix(quad_of(at), quad_of(at + 4u), uv.x), mix(quad_of(below), quad_of(below + 4u), uv.x), uv.y);
}

// The height above the surface that the layers of rock follow, of a point at this height.
fn above_bedding(place: vec2<f32>, height: f32) -> f32 {
    if (data[HAS_BEDDING] == 0u) {
        return height;
    }
    let cell = cell_at(place);
    let uv = clamp(place, land_low, land_high) - vec2<f32>(cell - origin);
    let at = data[BEDDING] + u32(cell.y * land_columns + cell.x);
    let below = at + u32(land_columns);
    let north = mix(samples[at], samples[at + 1u], uv.x);
    return height - mix(north, mix(samples[below], samples[below + 1u], uv.x), uv.y);
}

// Whether the nearest sample has no finite height.
fn is_missing(place: vec2<f32>) -> bool {
    if (data[HAS_MISSING] == 0u) {
        return false;
    }
    let nearest = vec2<i32>(floor(clamp(place, land_low, land_high) + 0.5)) + origin;
    let cell = clamp(nearest, vec2<i32>(0), land_last + vec2<i32>(1));
    return samples[data[MISSING] + u32(cell.y * land_columns + cell.x)] > 0.5;
}

fn look_at(site: Site) -> Look {
    let shape = between(data[SHAPE], site.place);
    let exaggeration = value(EXAGGERATION);
    if (is_missing(site.place)) {
        return Look(triple(NO_HEIGHT), shape.xy * exaggeration);
    }
    let colors = data[COLORS];
    var coat = Coat(CLAY, 0.0);
    if (colors == NATURAL || colors == DESERT || colors == SURFACES) {
        // wide, middle, small and fine
        var noise = vec4<f32>(0.0);
        for (var k = select(0u, 2u, colors == SURFACES); k < 4u; k++) {
            // By a mask, because not all shader compilers can assign to a component with a variable index.
            let here = vec4<u32>(k) == vec4<u32>(0u, 1u, 2u, 3u);
            noise = select(noise, vec4<f32>(noise_at(site.place, site.footprint, k)), here);
        }
        if (colors == NATURAL) {
            coat = natural(site, shape, noise);
        } else if (colors == DESERT) {
            coat = desert(site, shape, noise);
        } else {
            coat = covered(site, noise);
        }
    } else if (colors == MAP) {
        coat = Coat(map_color(site.height), 0.0);
    }
    var slope = shape.xy;
    if (coat.rough > 0.0) {
        slope += roughened(site, coat.rough);
    }
    return Look(coat.albedo, slope * exaggeration);
}

// Detail smaller than a cell: octaves from two cells down to the width of a pixel, the smaller ones steeper.
fn roughened(site: Site, rough: f32) -> vec2<f32> {
    var slope = vec2<f32>(0.0);
    for (var octave = 0u; octave < OCTAVE_COUNT; octave++) {
        let noise = OCTAVES + NOISE * octave;
        let seen = seen_share(value(noise), site.footprint) * (0.45 + 0.15 * f32(min(octave, 4u)));
        if (seen <= 0.0) {
            break;
        }
        let bump = grain_at(noise, site.place.x, site.place.y);
        // The absolute value gives creases and edges, where plain noise is round.
        slope += bump.yz * rough * select(seen, -seen, bump.x < 0.0);
    }
    return slope;
}

// The tint of the map, as albedo: two ramps, up to the sea level and above it.
fn map_color(height: f32) -> vec3<f32> {
    let ends = triple(RAMP_ENDS);
    let above = height > ends.y;
    let low = select(ends.x, ends.y, above);
    let high = select(ends.y, ends.z, above);
    let at = clamp((height - low) / max(high - low, 1e-6), 0.0, 1.0) * f32(RAMP_LENGTH - 1u);
    let k = min(u32(at), RAMP_LENGTH - 2u);
    let start = data[RAMP] + 3u * (k + select(0u, RAMP_LENGTH, above));
    return mix(triple_of(start), triple_of(start + 3u), at - f32(k));
}

// The recipe's surfaces. Between samples their color varies like that of soil and rock.
fn covered(site: Site, noise: vec4<f32>) -> Coat {
    let cover = between(data[COVER], site.place);
    let grain = 1.0 + 0.16 * noise.z + 0.18 * noise.w;
    return Coat(clamp(cover.xyz * grain, vec3<f32>(0.0), vec3<f32>(1.0)), 0.25 * cover.w);
}

// Land in a temperate climate.
fn natural(site: Site, shape: vec4<f32>, noise: vec4<f32>) -> Coat {
    let hollow = shape.z;
    let flow = shape.w;
    let steep = length(shape.xy);
    // 1 on slopes that face north.
    let north = shape.y / (steep + 0.2);
    let wide = noise.x;
    let middle = noise.y;
    let small = noise.z;
    let fine = noise.w;
    let rough_edge = 0.6 * middle + 0.4 * small + 0.25 * fine;

    // Rock: partly grayer and browner, with faint beds.
    let bed = plain_grain((above_bedding(site.place, site.height) + 25.0 * wide + 6.0 * middle) / 70.0, 0.53, 6u);
    let shade = 0.5 + 0.30 * wide + 0.25 * middle + 0.25 * small + 0.30 * fine + 0.22 * bed;
    let rock = blend(ROCK_DARK, ROCK_LIGHT, shade);
    let scree = blend(SCREE_DARK, SCREE_LIGHT, 0.5 + 0.4 * small + 0.4 * fine);

    // Vegetation: forest below the tree line, meadow above it, sparser towards the snow.
    let tree_line = value(TREE_LINE);
    let over_trees = site.height - tree_line + 130.0 * wide + 90.0 * middle + 60.0 * north;
    let lush = blend(LUSH_DARK, LUSH_LIGHT, 0.5 + 0.5 * wide + 0.4 * small);
    let tundra = blend(TUNDRA_DARK, TUNDRA_LIGHT, 0.5 + 0.5 * middle + 0.4 * fine);
    let meadow = blend(lush, tundra, ease(-250.0, 350.0, over_trees));
    let trees = blend(TREES_DARK, TREES_LIGHT, 0.5 + 0.45 * middle + 0.5 * fine);
    let wooded = ease(120.0, -160.0, over_trees)
        * ease(-0.42, 0.05, 0.55 * wide + 0.55 * middle + 0.25 * small + 0.5 * steep - 0.10)
        * ease(1.05, 0.75, steep);
    var color = blend(meadow, trees, wooded * 0.92);
    var rough = 0.10 + 0.16 * wooded;

    // Valley floors are farmland: lighter and more yellow.
    let valley = ease(0.10, 0.03, steep) * ease(0.0, -400.0, over_trees) * (1.0 - 0.6 * wooded);
    color = blend(color, blend(FARMLAND_DARK, FARMLAND_LIGHT, 0.5 + 0.5 * middle + 0.5 * small), 0.6 * valley);

    // Too steep for soil, or too high.
    let snow_line = value(SNOW_LINE);
    let high = ease(0.0, 700.0, site.height - 0.5 * (min(snow_line, 1e6) + min(tree_line, 1e6)) + 200.0 * middle);
    let bare = ease(0.62, 0.92, steep + 0.20 * rough_edge - 0.10 * hollow + 0.34 * high);
    let loose = ease(0.46, 0.66, steep + 0.14 * rough_edge + 0.35 * high) * (1.0 - 0.85 * wooded);
    color = blend(color, scree, loose * 0.8);
    color = blend(color, rock, bare);
    rough += 0.10 * loose + 0.22 * bare;

    // Gravel along rivers, sand along the sea.
    color = blend(color, GRAVEL, ease(0.72, 0.92, flow) * ease(0.20, 0.05, steep) * 0.5);
    if (data[HAS_SHORE] != 0u) {
        let shore = ease(9.0, 2.0, site.height - value(SHORE_HEIGHT) + 5.0 * small) * ease(0.40, 0.15, steep);
        color = blend(color, SHORE, shore);
        rough *= 1.0 - 0.8 * shore;
    }

    // Snow: lower in shade and in hollows, none on steep slopes.
    let above = site.height - snow_line + 190.0 * wide + 130.0 * middle + 50.0 * small + 170.0 * north + 110.0 * hollow;
    let lies = ease(1.25, 0.80, steep + 0.15 * rough_edge - 0.25 * hollow - 0.0003 * clamp(above, 0.0, 1500.0));
    let snow = ease(-60.0, 140.0, above) * lies;
    color = blend(color, SNOW, snow);
    rough = rough * (1.0 - snow) + 0.05 * snow;
    return Coat(color, rough);
}

// Land with little vegetation.
fn desert(site: Site, shape: vec4<f32>, noise: vec4<f32>) -> Coat {
    let hollow = shape.z;
    let flow = shape.w;
    let steep = length(shape.xy);
    let wide = noise.x;
    let middle = noise.y;
    let small = noise.z;
    let fine = noise.w;
    // Beds of some metres within beds of some tens of metres.
    let at = (above_bedding(site.place, site.height) + 14.0 * wide + 3.0 * middle) / 42.0;
    let bed = plain_grain(at, 0.37, 4u) * 1.6 + plain_grain(at * 3.7, 5.1, 5u) * 0.8;
    let place = clamp(bed * 2.2 + 3.0, 0.0, 4.999);
    let index = u32(place);
    var rock = blend(triple(BEDS + 3u * index), triple(BEDS + 3u * index + 3u), place - f32(index));
    rock *= 1.0 + 0.12 * small + 0.14 * fine + 0.10 * middle;
    let sand = blend(SAND_DARK, SAND_LIGHT, 0.5 + 0.5 * middle + 0.3 * fine);
    let bare = ease(0.16, 0.42, steep + 0.06 * (middle + small + fine) - 0.05 * hollow);
    let color = blend(sand, rock, 0.25 + 0.75 * bare);
    let green = ease(0.55, 0.85, flow) * ease(0.35, 0.12, steep) * 0.75
        + 0.35 * ease(0.05, 0.45, 0.6 * middle + 0.5 * small + 0.5 * fine) * (1.0 - bare);
    return Coat(blend(color, SCRUB, min(green, 0.9)), 0.07 + 0.26 * bare);
}

// The color of a block's side at a depth below the ground, in metres. `along` is a position along the side, `place` one
// on the land.
fn section(along: f32, place: vec2<f32>, height: f32, depth: f32, thickness: f32) -> vec3<f32> {
    // Level layers are bent a little.
    let bent = plain_grain(along * value(CELL) / thickness * 0.25, 0.7, 7u);
    let wave = select(bent, 0.0, data[HAS_BEDDING] != 0u);
    let at = above_bedding(place, height) / thickness + 0.35 * wave;
    let bed = plain_grain(at * 3.0, 0.41, 4u) + 0.5 * plain_grain(at * 9.0, 3.3, 5u);
    let rock = blend(triple(SECTION_ROCK), triple(SECTION_ROCK + 3u), 0.5 + 0.55 * bed);
    if (data[HAS_SOIL] == 0u) {
        return rock;
    }
    return blend(triple(SOIL), rock, ease(0.015 * thickness, 0.05 * thickness, depth));
}
