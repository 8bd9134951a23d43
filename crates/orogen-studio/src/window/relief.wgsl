// The land in space: a mesh that reads its heights from a texture, with walls down to a base, and water.

struct Scene {
    matrix: mat4x4f,
    // To the sun: east, up, south. w: strength of shadows.
    sun: vec4f,
    // Half the width and depth in units, units of height for a metre, the height in metres that is at 0.
    extent: vec4f,
    // Interval of contours in metres, 0 for none; their strength; the height of the base in units; 1 for haze.
    lines: vec4f,
    // The height of the water in metres; 1 if there is water; a cell in units.
    water: vec4f,
    eye: vec4f,
    sky: vec4f,
}

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var heights: texture_2d<f32>;
@group(0) @binding(2) var albedo: texture_2d<f32>;
@group(0) @binding(3) var light: texture_2d<f32>;
@group(0) @binding(4) var linear_sampler: sampler;

fn texel(at: vec2i) -> f32 {
    let last = vec2i(textureDimensions(heights)) - 1;
    return textureLoad(heights, clamp(at, vec2i(0), last), 0).x;
}

// The height in metres at a position from 0, 0 to 1, 1, whose ends are the middles of the outer samples.
fn height(uv: vec2f) -> f32 {
    let at = uv * (vec2f(textureDimensions(heights)) - 1.0);
    let first = vec2i(floor(at));
    let share = at - floor(at);
    let above = mix(texel(first), texel(first + vec2i(1, 0)), share.x);
    let below = mix(texel(first + vec2i(0, 1)), texel(first + vec2i(1, 1)), share.x);
    return mix(above, below, share.y);
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
    let ground = height(uv);
    let lower = vertex.z > 0.5;
    var y = level(ground);
    if kind == 1u && lower {
        y = scene.lines.z;
    } else if kind == 2u {
        y = level(scene.water.x);
    } else if kind == 3u && !lower {
        y = level(max(ground, scene.water.x));
    }
    let place = vec3f((2.0 * uv.x - 1.0) * scene.extent.x, y, (2.0 * uv.y - 1.0) * scene.extent.y);
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

// Light of the sun and the sky on a surface.
fn lit(color: vec3f, normal: vec3f, seen: f32) -> vec3f {
    let sun = max(dot(normal, scene.sun.xyz), 0.0) * mix(1.0, seen, scene.sun.w);
    let sky = 0.5 + 0.5 * normal.y;
    return color * (sun * vec3f(1.22, 1.14, 1.0) + sky * vec3f(0.26, 0.31, 0.40));
}

fn hazy(color: vec3f, place: vec3f) -> vec3f {
    let far = distance(place, scene.eye.xyz);
    let haze = (1.0 - exp(-max(far - 1.0, 0.0) * 0.06)) * scene.lines.w;
    return mix(color, scene.sky.xyz, haze);
}

@fragment
fn ground(in: Corner) -> @location(0) vec4f {
    let step = 1.0 / (vec2f(textureDimensions(heights)) - 1.0);
    if in.kind == 1u {
        // Layers of rock in the walls.
        let metres = in.place.y / scene.extent.z + scene.extent.w;
        let bands = 0.93 + 0.07 * sin(metres / max(scene.water.w, 1.0) * 16.0 + in.uv.x * 3.0 + in.uv.y * 2.0);
        let facing = select(0.85, 1.0, abs(in.uv.x - 0.5) > abs(in.uv.y - 0.5));
        return encoded(vec3f(0.155, 0.125, 0.10) * bands * facing);
    }
    let cell = vec2f(scene.extent.x, scene.extent.y) * 2.0 * step;
    let east = (height(in.uv + vec2f(step.x, 0.0)) - height(in.uv - vec2f(step.x, 0.0))) * scene.extent.z;
    let south = (height(in.uv + vec2f(0.0, step.y)) - height(in.uv - vec2f(0.0, step.y))) * scene.extent.z;
    let normal = normalize(vec3f(-east / (2.0 * cell.x), 1.0, -south / (2.0 * cell.y)));
    let sample = in.uv * (1.0 - step) + 0.5 * step;
    var color = lit(textureSample(albedo, linear_sampler, sample).rgb, normal, textureSample(light, linear_sampler, sample).r);
    if scene.lines.x > 0.0 {
        let at = height(in.uv) / scene.lines.x;
        let width = max(fwidth(at), 1e-6);
        let apart = abs(fract(at - 0.5) - 0.5) / width;
        let fifth = abs(fract(at / 5.0 - 0.5) - 0.5) * 5.0 / width;
        // Lines that would run together are left out.
        let room = 1.0 - smoothstep(0.15, 0.4, width);
        let room5 = 1.0 - smoothstep(0.75, 2.0, width);
        let line = max((1.0 - smoothstep(0.5, 1.2, apart)) * room * 0.6, (1.0 - smoothstep(0.8, 1.7, fifth)) * room5);
        color *= 1.0 - line * scene.lines.y;
    }
    return encoded(hazy(color, in.place));
}

@fragment
fn water(in: Corner) -> @location(0) vec4f {
    let depth = scene.water.x - height(in.uv);
    if in.kind == 2u && depth <= 0.0 {
        discard;
    }
    let view = normalize(scene.eye.xyz - in.place);
    let half = normalize(view + scene.sun.xyz);
    let glint = pow(max(half.y, 0.0), 220.0) * 0.5 * select(0.0, 1.0, in.kind == 2u);
    let fresnel = pow(1.0 - max(view.y, 0.0), 4.0) * 0.35;
    let color = mix(vec3f(0.045, 0.16, 0.28), scene.sky.xyz, fresnel) + vec3f(glint);
    let shown = select(0.62, 1.0 - exp(-depth / max(scene.water.w, 1.0) * 9.0) * 0.7, in.kind == 2u);
    return vec4f(encoded(hazy(color, in.place)).rgb, clamp(shown + glint, 0.0, 0.92));
}

@fragment
fn wire(in: Corner) -> @location(0) vec4f {
    return vec4f(0.0, 0.0, 0.0, 0.35);
}

struct Blit {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn whole(@builtin(vertex_index) index: u32) -> Blit {
    let uv = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return Blit(vec4f(uv * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0), uv);
}

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;

@fragment
fn blit(in: Blit) -> @location(0) vec4f {
    return textureSample(picture, picture_sampler, in.uv);
}
