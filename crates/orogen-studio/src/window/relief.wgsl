// The land in 3D: meshes that read their heights from textures, with walls down to a base, and water. The first mesh is
// the whole land, the others are rings: squares with finer samples, each inside the one before.
//
// Its light is the light of rendered pictures, whose shader code precedes this one. There, z points up and y south.

struct Scene {
    matrix: mat4x4f,
    inverse: mat4x4f,
    // Half the width and depth in units, units of height per metre, the height in metres at 0.
    extent: vec4f,
    // Interval of contours in metres, 0 for none; their strength; the height of the base in units; the strength of shadows.
    lines: vec4f,
    // The height of the water in metres; 1 if there is water; the lowest ground in units; the relief in metres.
    water: vec4f,
    eye: vec4f,
}

// The place of a part of the land.
struct Part {
    // West, north, width and depth in units.
    rect: vec4f,
    // The rectangle that a finer part covers: its first and last position.
    hole: vec4f,
    // The position in the coarser part: offset and scale.
    coarser: vec4f,
    // Number of vertices of the coarser part along its sides; the width of the border over which a ring turns into the
    // coarser part, 0 for the whole land.
    border: vec4f,
}

// Whether the part is a ring. Without rings, what mixes in the coarser part is left out of the shaders.
override RING: bool = true;

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var heights: texture_2d<f32>;
@group(0) @binding(2) var albedo: texture_2d<f32>;
@group(0) @binding(3) var light: texture_2d<f32>;
@group(0) @binding(4) var linear_sampler: sampler;
@group(0) @binding(5) var<uniform> part: Part;
@group(0) @binding(6) var coarser_heights: texture_2d<f32>;
@group(0) @binding(7) var coarser_albedo: texture_2d<f32>;
@group(0) @binding(8) var coarser_light: texture_2d<f32>;
@group(1) @binding(0) var<uniform> words: array<vec4u, WORDS>;
@group(1) @binding(1) var tables: texture_2d<f32>;

fn word(at: u32) -> u32 {
    return words[at / 4u][at % 4u];
}

fn triple_of(start: u32) -> vec3f {
    let columns = textureDimensions(tables).x;
    let at = start / 3u;
    return textureLoad(tables, vec2u(at % columns, at / columns), 0).xyz;
}

fn texel(grid: texture_2d<f32>, at: vec2i) -> f32 {
    let last = vec2i(textureDimensions(grid)) - 1;
    return textureLoad(grid, clamp(at, vec2i(0), last), 0).x;
}

// The height in metres at a position from 0, 0 to 1, 1, whose ends are the centers of the outer samples.
fn height_in(grid: texture_2d<f32>, uv: vec2f) -> f32 {
    let at = uv * (vec2f(textureDimensions(grid)) - 1.0);
    let first = vec2i(floor(at));
    let share = at - floor(at);
    let above = mix(texel(grid, first), texel(grid, first + vec2i(1, 0)), share.x);
    let below = mix(texel(grid, first + vec2i(0, 1)), texel(grid, first + vec2i(1, 1)), share.x);
    return mix(above, below, share.y);
}

// The position in the coarser part.
fn in_coarser(uv: vec2f) -> vec2f {
    return part.coarser.xy + uv * part.coarser.zw;
}

// The share of the finer samples: 0 along the border of a ring, 1 inside.
fn detail(uv: vec2f) -> f32 {
    if !RING || part.border.z <= 0.0 {
        return 1.0;
    }
    let inside = min(uv, 1.0 - uv) / part.border.zw;
    return smoothstep(0.2, 1.0, min(inside.x, inside.y));
}

// The height in metres. At the border of a ring it is that of the coarser part.
fn height(uv: vec2f) -> f32 {
    let share = detail(uv);
    if share >= 1.0 {
        return height_in(heights, uv);
    }
    return mix(height_in(coarser_heights, in_coarser(uv)), height_in(heights, uv), share);
}

// The height at which the triangles of the coarser part are drawn.
fn coarser_surface(uv: vec2f) -> f32 {
    let cells = part.border.xy - 1.0;
    let at = in_coarser(uv) * cells;
    let first = floor(at);
    let share = at - first;
    let b = height_in(coarser_heights, (first + vec2f(1.0, 0.0)) / cells);
    let c = height_in(coarser_heights, (first + vec2f(0.0, 1.0)) / cells);
    if share.x + share.y <= 1.0 {
        let a = height_in(coarser_heights, first / cells);
        return a + (b - a) * share.x + (c - a) * share.y;
    }
    let d = height_in(coarser_heights, (first + 1.0) / cells);
    return d + (c - d) * (1.0 - share.x) + (b - d) * (1.0 - share.y);
}

// The height of a vertex.
fn surface(uv: vec2f) -> f32 {
    let share = detail(uv);
    let own = height_in(heights, uv);
    if share >= 1.0 {
        return own;
    }
    return mix(coarser_surface(uv), own, share);
}

// Whether a finer part covers a position.
fn is_covered(uv: vec2f) -> bool {
    return all(uv > part.hole.xy) && all(uv < part.hole.zw);
}

fn level(metres: f32) -> f32 {
    return (metres - scene.extent.w) * scene.extent.z;
}

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) place: vec3f,
    // 0: ground, 1: wall of the ground, 2: water, 3: wall of the water.
    @location(2) @interpolate(flat) kind: u32,
}

@vertex
fn corner(@location(0) vertex: vec4f) -> Corner {
    let uv = vertex.xy;
    let kind = u32(vertex.w + 0.5);
    let ground = surface(uv);
    let lower = vertex.z > 0.5;
    var y = level(ground);
    if kind == 1u && lower {
        y = scene.lines.z;
    } else if kind == 2u {
        y = level(scene.water.x);
    } else if kind == 3u && !lower {
        y = level(max(ground, scene.water.x));
    }
    let xz = part.rect.xy + uv * part.rect.zw;
    let place = vec3f(xz.x, y, xz.y);
    var out: Corner;
    out.clip = scene.matrix * vec4f(place, 1.0);
    out.uv = uv;
    out.place = place;
    out.kind = kind;
    return out;
}

fn encoded(linear: vec3f) -> vec4f {
    let c = clamp(linear, vec3f(0.0), vec3f(1.0));
    let low = c * 12.92;
    let high = 1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055;
    return vec4f(select(high, low, c <= vec3f(0.0031308)), 1.0);
}

// The unit vector from the camera to a position, with z up.
fn along_to(place: vec3f) -> vec3f {
    return normalize(place - scene.eye.xyz).xzy;
}

// The color of light from a position.
fn exposed(light: vec3f, place: vec3f) -> vec4f {
    let lowest = scene.water.z;
    let left = haze_left(scene.eye.y - lowest, place.y - lowest, distance(place, scene.eye.xyz));
    return encoded(tone_map(through_air(light, along_to(place), left) * triple(EXPOSURE)));
}

// The cosine of the angle between the sun and the normal of the wall at a position.
fn wall_facing(uv: vec2f) -> f32 {
    let off = uv - 0.5;
    let normal = select(vec2f(0.0, sign(off.y)), vec2f(sign(off.x), 0.0), abs(off.x) > abs(off.y));
    return max(dot(normal, triple(SUN).xy), 0.0);
}

// The light from a wall at a position; it is darker at its foot.
fn wall_light(albedo: vec3f, uv: vec2f, place: vec3f) -> vec3f {
    let base = scene.lines.z;
    let foot = 0.55 + 0.45 * clamp((place.y - base) / max(scene.water.z - base, 1e-6), 0.0, 1.0);
    return side_of(albedo, wall_facing(uv), foot);
}

// The texture coordinates of a position.
fn sample_at(grid: texture_2d<f32>, uv: vec2f) -> vec2f {
    let step = 1.0 / (vec2f(textureDimensions(grid)) - 1.0);
    return uv * (1.0 - step) + 0.5 * step;
}

// The color of a texture at a position; at the border of a ring, that of the texture of the coarser part.
fn blended(coarser: texture_2d<f32>, own: texture_2d<f32>, uv: vec2f, share: f32) -> vec4f {
    let fine = textureSampleLevel(own, linear_sampler, sample_at(own, uv), 0.0);
    if share >= 1.0 {
        return fine;
    }
    return mix(textureSampleLevel(coarser, linear_sampler, sample_at(coarser, in_coarser(uv)), 0.0), fine, share);
}

// The share of the sun that reaches the ground or, with water, the surface of land and sea. Hills of the sea floor cast
// no shadow on the water.
fn sun_seen(uv: vec2f) -> f32 {
    let seen = blended(coarser_light, light, uv, detail(uv)).rg;
    return mix(1.0, select(seen.r, seen.g, scene.water.y > 0.0), scene.lines.w);
}

// The rise of the ground towards the east and south, in units per unit. `size` is that of the grid in units.
fn rise_in(grid: texture_2d<f32>, uv: vec2f, size: vec2f) -> vec2f {
    let cells = vec2f(textureDimensions(grid)) - 1.0;
    let step = 1.0 / cells;
    let east = height_in(grid, uv + vec2f(step.x, 0.0)) - height_in(grid, uv - vec2f(step.x, 0.0));
    let south = height_in(grid, uv + vec2f(0.0, step.y)) - height_in(grid, uv - vec2f(0.0, step.y));
    return vec2f(east, south) * scene.extent.z * cells / (2.0 * size);
}

// The normal of the ground, with z up.
fn normal_of(uv: vec2f, share: f32) -> vec3f {
    var rise = rise_in(heights, uv, part.rect.zw);
    if share < 1.0 {
        rise = mix(rise_in(coarser_heights, in_coarser(uv), part.rect.zw / part.coarser.zw), rise, share);
    }
    return normalize(vec3f(-rise, 1.0));
}

// The color of the ground.
fn ground_color(uv: vec2f, place: vec3f) -> vec4f {
    let share = detail(uv);
    var color = PAPER * blended(coarser_albedo, albedo, uv, share).rgb;
    if scene.lines.x > 0.0 {
        let at = height(uv) / scene.lines.x;
        let width = max(fwidth(at), 1e-6);
        let apart = abs(fract(at - 0.5) - 0.5) / width;
        let fifth = abs(fract(at / 5.0 - 0.5) - 0.5) * 5.0 / width;
        // Lines that would merge are omitted.
        let room = 1.0 - smoothstep(0.15, 0.4, width);
        let room5 = 1.0 - smoothstep(0.75, 2.0, width);
        let line = max((1.0 - smoothstep(0.5, 1.2, apart)) * room * 0.6, (1.0 - smoothstep(0.8, 1.7, fifth)) * room5);
        color *= 1.0 - line * scene.lines.y;
    }
    let normal = normal_of(uv, share);
    let open = 0.5 + 0.5 * normal.z;
    let sun = max(dot(normal, triple(SUN)), 0.0) * sun_seen(uv);
    return exposed(diffuse(color, sun, vec4f(triple(LEVEL_SKY) * open, open)), place);
}

// The color of a wall of the ground, with layers of rock.
fn wall_color(uv: vec2f, place: vec3f) -> vec4f {
    let metres = place.y / scene.extent.z + scene.extent.w;
    let bands = 0.93 + 0.07 * sin(metres / max(scene.water.w, 1.0) * 16.0 + uv.x * 3.0 + uv.y * 2.0);
    return exposed(wall_light(vec3f(0.155, 0.125, 0.10) * bands, uv, place), place);
}

// The brightest glitter, relative to the light on a surface that faces the sun.
const BRIGHTEST: f32 = 0.014;

// The color of the water.
fn water_color(uv: vec2f, place: vec3f) -> vec4f {
    let seen = sun_seen(uv);
    let depth = max(scene.water.x - height(uv), 0.0);
    let along = along_to(place);
    let up = vec3f(0.0, 0.0, 1.0);
    let cosine = max(-along.z, 0.02);
    let reflected = mirrored_share(cosine);
    let body = water_body(true, depth, cosine, max(triple(SUN).z, 0.0));
    let mirrored = sky_light(unit(vec3f(along.xy, max(-along.z, 0.004))));
    // Here the camera may face the sun at any time. Its glitter, much brighter than snow, is dimmed so far that the sea
    // still looks like water.
    let glint = glitter(up, -along, triple(SUN));
    let dazzling = triple(SUNLIGHT) * (seen * (glint - glint / (1.0 + glint / BRIGHTEST)));
    let light = water_light(body, up, -along, triple(SUN), seen, reflected) - dazzling;
    return exposed(light + reflected * mirrored, place);
}

// The color of a wall of the water.
fn water_wall_color(uv: vec2f, place: vec3f) -> vec4f {
    let below = scene.water.x - (place.y / scene.extent.z + scene.extent.w);
    return exposed(wall_light(water_section(max(below, 0.0)), uv, place), place);
}

// Whether there is no water at a position of the water's surface, or a finer part draws it.
fn is_dry(uv: vec2f) -> bool {
    return is_covered(uv) || height(uv) >= scene.water.x;
}

@fragment
fn ground(in: Corner) -> @location(0) vec4f {
    if in.kind == 1u {
        return wall_color(in.uv, in.place);
    }
    if is_covered(in.uv) {
        discard;
    }
    return ground_color(in.uv, in.place);
}

@fragment
fn water(in: Corner) -> @location(0) vec4f {
    if in.kind == 3u {
        return water_wall_color(in.uv, in.place);
    }
    if is_dry(in.uv) {
        discard;
    }
    return water_color(in.uv, in.place);
}

// A CPU shades whole blocks of pixels for each triangle, most of which are smaller than a block. It therefore draws
// first the positions of the land, and then shades each pixel once. The stencil has the kind and part of each pixel.

@fragment
fn ground_position(in: Corner) -> @location(0) vec4f {
    if in.kind == 0u && is_covered(in.uv) {
        discard;
    }
    return vec4f(in.place, 0.0);
}

@fragment
fn water_position(in: Corner) -> @location(0) vec4f {
    if in.kind == 2u && is_dry(in.uv) {
        discard;
    }
    return vec4f(in.place, 0.0);
}

@group(2) @binding(0) var positions: texture_2d<f32>;

// The position in the part and in the view of a pixel.
struct Position {
    uv: vec2f,
    place: vec3f,
}

fn position_at(in: Blit) -> Position {
    let place = textureLoad(positions, vec2i(in.clip.xy), 0).xyz;
    return Position((place.xz - part.rect.xy) / part.rect.zw, place);
}

@fragment
fn shade_ground(in: Blit) -> @location(0) vec4f {
    let at = position_at(in);
    return ground_color(at.uv, at.place);
}

@fragment
fn shade_wall(in: Blit) -> @location(0) vec4f {
    let at = position_at(in);
    return wall_color(at.uv, at.place);
}

@fragment
fn shade_water(in: Blit) -> @location(0) vec4f {
    let at = position_at(in);
    return water_color(at.uv, at.place);
}

@fragment
fn shade_water_wall(in: Blit) -> @location(0) vec4f {
    let at = position_at(in);
    return water_wall_color(at.uv, at.place);
}

// Number of steps towards the sun over the land in the search for its shadow.
const SHADOW_STEPS = 64;

// The share of the sun that reaches a position on the table.
fn table_seen(place: vec3f) -> f32 {
    let rims = pair(RIMS);
    if scene.lines.w <= 0.0 || rims.y <= 0.0 {
        return 1.0;
    }
    // The range of the path over the land, as horizontal distances from the position.
    let towards = pair(SUNWARDS);
    let half = scene.extent.xy;
    let safe = select(towards, vec2f(1e-6), abs(towards) < vec2f(1e-6));
    let one = (-half - place.xz) / safe;
    let other = (half - place.xz) / safe;
    let enters = max(max(min(one.x, other.x), min(one.y, other.y)), 0.0);
    let leaves = min(max(one.x, other.x), max(one.y, other.y));
    if leaves <= enters {
        return 1.0;
    }
    var rise = -1.0;
    for (var k = 0; k < SHADOW_STEPS; k++) {
        let far = mix(enters, leaves, (f32(k) + 0.5) / f32(SHADOW_STEPS));
        let uv = 0.5 + 0.5 * (place.xz + towards * far) / half;
        rise = max(rise, (level(height(uv)) - place.y) / max(far, 1e-4));
    }
    return mix(1.0, sun_above(rise, rims), scene.lines.w);
}

// The background of the land: the sky, and the table on which the land stands.
@fragment
fn behind(in: Blit) -> @location(0) vec4f {
    let far = scene.inverse * vec4f(2.0 * in.uv.x - 1.0, 1.0 - 2.0 * in.uv.y, 0.5, 1.0);
    let ray = normalize(far.xyz / far.w - scene.eye.xyz);
    let base = scene.lines.z;
    if ray.y >= 0.0 || scene.eye.y <= base {
        return encoded(tone_map(sky_seen(ray.xzy) * triple(EXPOSURE)));
    }
    let place = scene.eye.xyz + ray * ((base - scene.eye.y) / ray.y);
    let half = scene.extent.xy;
    let nearest = clamp(place.xz, -half, half);
    let high = max(level(height(0.5 + 0.5 * nearest / half)) - base, 0.0);
    let table = table_of(ray.xzy, distance(place.xz, nearest), high, 2.0 * length(half), table_seen(place));
    return exposed(table, place);
}

@fragment
fn wire(in: Corner) -> @location(0) vec4f {
    if is_covered(in.uv) {
        discard;
    }
    return vec4f(0.0, 0.0, 0.0, 0.35);
}

struct Blit {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn covering(@builtin(vertex_index) index: u32) -> Blit {
    let uv = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return Blit(vec4f(uv * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0), uv);
}

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;
// The drawn part of the picture, as a share of its sides, and the last position in it.
@group(0) @binding(2) var<uniform> drawn: vec4f;

// Without interpolation, if all pixels are drawn.
@fragment
fn copy(in: Blit) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(picture));
    return textureLoad(picture, vec2i(min(in.uv * size, size - 1.0)), 0);
}

@fragment
fn blit(in: Blit) -> @location(0) vec4f {
    return textureSample(picture, picture_sampler, min(in.uv * drawn.xy, drawn.zw));
}
