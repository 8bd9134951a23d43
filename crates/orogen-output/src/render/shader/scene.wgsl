// Numbers of the scene. Their indices in `data` are constants that are declared before this text.
//
// The CPU counterpart of each of these files has the same name in `orogen-output/src/render`; `tests/suite/render.rs`
// compares their pictures. This file and the files of the sky, the water and tones are also part of other shaders,
// which define their own `word`, `triple_of` and `quad_of`.

const PI = 3.14159265358979;

fn value(at: u32) -> f32 {
    return bitcast<f32>(word(at));
}

fn whole(at: u32) -> i32 {
    return bitcast<i32>(word(at));
}

fn pair(at: u32) -> vec2<f32> {
    return vec2<f32>(value(at), value(at + 1u));
}

fn triple(at: u32) -> vec3<f32> {
    return vec3<f32>(value(at), value(at + 1u), value(at + 2u));
}

// Smoothstep from 0 at `first` to 1 at `end`; `first` may be the larger.
fn ease(first: f32, end: f32, x: f32) -> f32 {
    let t = clamp((x - first) / (end - first), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

fn blend(dark: vec3<f32>, light: vec3<f32>, share: f32) -> vec3<f32> {
    return dark + (light - dark) * clamp(share, 0.0, 1.0);
}

fn unit(v: vec3<f32>) -> vec3<f32> {
    return v / sqrt(dot(v, v));
}
