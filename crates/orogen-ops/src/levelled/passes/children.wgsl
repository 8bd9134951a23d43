// Positions, rock and shores of the children, as in `children.rs`.

// Positions. The child that takes over a parent's node stays near the parent's position; nodes of the finest level of
// valleys are in the middles of their cells.
fn place(base: u32, at: vec2<i32>) {
    var position = vec2<f32>(0.5);
    if (!has(base, FINEST)) {
        let parent = at / 2;
        let bit = vec2<u32>(at & vec2<i32>(1));
        let bits = child_bits(place_hash(base), at);
        let draw = vec2<f32>(unit(bits), second_unit(bits));
        position = 0.5 + 0.8 * (draw - 0.5);
        if (heir(parent) == (bit.x | (bit.y << 1u))) {
            let share = 2.0 * vec2<f32>(above(EAST, parent), above(SOUTH, parent)) - vec2<f32>(bit);
            position = share + 0.5 * (draw - share);
        }
    }
    set_plane(EAST, at, position.x);
    set_plane(SOUTH, at, position.y);
}

// A nearly normally distributed number from hashed bits.
fn normal(base: u32, at: vec2<i32>, change: u32) -> f32 {
    return normal_number(mix64(child_bits(place_hash(base), at) ^ vec2<u32>(change, 0u)));
}

// A plane of the level above at the four nearest parents: the nearest, the two next to it, and the one across the
// corner.
fn nearest(k: u32, at: vec2<i32>) -> vec4<f32> {
    let near = at / 2;
    let far = near + 2 * (at & vec2<i32>(1)) - vec2<i32>(1);
    return vec4<f32>(above(k, near), above(k, vec2<i32>(far.x, near.y)), above(k, vec2<i32>(near.x, far.y)), above(k, far));
}

fn blended(values: vec4<f32>) -> f32 {
    return 0.5625 * values.x + 0.1875 * values.y + 0.1875 * values.z + 0.0625 * values.w;
}

// The change of the distance to the shore per kilometre near the shore, at least 1.
fn steepness(base: u32, shores: vec4<f32>) -> f32 {
    let side = 2.0 * kilometres(base);
    let falls = vec2<f32>(shores.x - shores.y, shores.x - shores.z);
    let steep = 0.5 * sqrt(falls.x * falls.x + falls.y * falls.y) / side;
    let near = clamp(2.0 - abs(blended(shores)) / (3.0 * side * max(steep, 1.0)), 0.0, 1.0);
    return 1.0 + near * max(steep - 1.0, 0.0);
}

// The term that a detail level adds to the logarithm of the stable slope: rock is rougher than soil.
fn roughness(logarithm: f32) -> f32 {
    return 0.3 + 0.9 * share_between(logarithm, -0.35, 0.1);
}

fn uplift_of(base: u32, at: vec2<i32>) -> f32 {
    let inherited = blended(nearest(UPLIFT, at));
    if (has(base, DETAIL)) {
        return inherited + amplitude(base) * roughness(inherited) * normal(base, at, 0x3333u);
    }
    let value = given(given_uplift(base), at);
    if (is_missing(value)) {
        return inherited;
    }
    return log(max(value, 1e-4));
}

fn shore_of(base: u32, at: vec2<i32>, uplift: f32) -> f32 {
    let shores = nearest(SHORE, at);
    let lakes = nearest(RECEIVER, at) >= vec4<f32>(LAKE);
    let rugged = 0.45 + 0.9 * clamp((uplift + 3.0) / 3.2, 0.0, 1.0);
    var irregular = indent(base) * rugged;
    if (has(base, SEA)) {
        irregular *= steepness(base, shores);
    }
    irregular *= normal(base, at, 0xaaaau);
    if (has(base, LAKES) && any(lakes)) {
        return blended(min(shores, vec4<f32>(beside_lakes(base)))) + 0.55 * irregular;
    }
    let value = given(given_shore(base), at);
    if (is_missing(value)) {
        return blended(shores) + irregular;
    }
    let inland = (nearest(RECEIVER, at) == vec4<f32>(NONE)) & (nearest(HEIGHT, at) > vec4<f32>(0.0));
    if (any(inland)) {
        // Half of a cell of the level above.
        return min(value * 1e-3, blended(min(shores, vec4<f32>(kilometres(base)))) + irregular);
    }
    return value * 1e-3;
}

// Rock and shore, from the four nearest parents.
fn inherit(base: u32, at: vec2<i32>) {
    let uplift = uplift_of(base, at);
    set_plane(VARIATION, at, blended(nearest(VARIATION, at)) + amplitude(base) * normal(base, at, 0x5555u));
    set_plane(UPLIFT, at, uplift);
    set_plane(SHORE, at, shore_of(base, at, uplift));
}
