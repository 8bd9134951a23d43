// Random numbers of nodes, as in orogen-grid's `multiscale::hash`. `product.wgsl` precedes this text.

// Whole numbers of 64 bits are pairs of u32, the lower part first.
fn times(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = product(a.x, b.x);
    return vec2<u32>(low.x, low.y + a.x * b.y + a.y * b.x);
}

fn plus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

// A number combined by exclusive or with the same number shifted right by 1 to 31 bits.
fn folded(a: vec2<u32>, by: u32) -> vec2<u32> {
    return a ^ vec2<u32>((a.x >> by) | (a.y << (32u - by)), a.y >> by);
}

// The finalizer of splitmix64.
fn mix64(a: vec2<u32>) -> vec2<u32> {
    let b = times(folded(a, 30u), vec2<u32>(0x1ce4e5b9u, 0xbf58476du));
    return folded(times(folded(b, 27u), vec2<u32>(0x133111ebu, 0x94d049bbu)), 31u);
}

// The random bits of a node, from the initial value of its hash.
fn node_bits(begin: vec2<u32>, x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    let column = mix64(begin ^ times(x, vec2<u32>(0x6659fd93u, 0xd6e8feb8u)));
    return mix64(plus(column, times(y, vec2<u32>(0x78bd642fu, 0xa0761d64u))));
}

// The random bits of a child, and of a parent.
fn child_bits(begin: vec2<u32>, at: vec2<i32>) -> vec2<u32> {
    let x = plus(first_column(), vec2<u32>(u32(at.x), 0u));
    return node_bits(begin, x, plus(first_row(), vec2<u32>(u32(at.y), 0u)));
}

fn halved(a: vec2<u32>) -> vec2<u32> {
    return vec2<u32>((a.x >> 1u) | (a.y << 31u), bitcast<u32>(bitcast<i32>(a.y) >> 1u));
}

fn parent_bits(begin: vec2<u32>, at: vec2<i32>) -> vec2<u32> {
    let x = plus(halved(first_column()), vec2<u32>(u32(at.x), 0u));
    return node_bits(begin, x, plus(halved(first_row()), vec2<u32>(u32(at.y), 0u)));
}

// Numbers from 0 to 1, from the upper 24 bits, from the next 24, and from a part of 16 bits.
fn unit(bits: vec2<u32>) -> f32 {
    return f32(bits.y >> 8u) * 5.9604644775390625e-8;
}

fn second_unit(bits: vec2<u32>) -> f32 {
    return f32(((bits.x >> 16u) | (bits.y << 16u)) & 0xffffffu) * 5.9604644775390625e-8;
}

fn unit16(bits: vec2<u32>, part: u32) -> f32 {
    let word = select(bits.x, bits.y, part > 1u);
    return f32((word >> (16u * (part & 1u))) & 0xffffu) * 1.52587890625e-5;
}

// A number with a nearly normal distribution and unit variance.
fn normal_number(bits: vec2<u32>) -> f32 {
    let sum = (bits.x & 0xffffu) + (bits.x >> 16u) + (bits.y & 0xffffu) + (bits.y >> 16u);
    return (f32(sum) * 1.52587890625e-5 - 2.0) * 1.7320508;
}
