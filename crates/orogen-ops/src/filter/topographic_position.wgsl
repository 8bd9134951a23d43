// Topographic position. Words: 1 / (8 cell), the radius, the number of samples in the disc, then the half height of
// each of its columns from the west. All but the first word are whole numbers.
//
// Heights are rounded to 1/256 m. Their sums and the sums of their squares down each column are kept exactly, as in
// orogen-grid's `analysis/position.rs`, in planes of 24 bits each, which f32 holds exactly. Whole numbers of 64 bits
// are pairs of u32, the lower part first.
const SUM = 4u;
const SQUARES = 6u;
const LIMB = 0x00ffffffu;

fn plus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn negative(a: vec2<u32>) -> vec2<u32> {
    return plus(~a, vec2<u32>(1u, 0u));
}

fn minus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return plus(a, negative(b));
}

fn widened(a: i32) -> vec2<u32> {
    return vec2<u32>(bitcast<u32>(a), select(0u, 0xffffffffu, a < 0));
}

fn times(a: vec2<u32>, b: i32) -> vec2<u32> {
    let size = u32(abs(b));
    var out = product(a.x, size);
    out.y += a.y * size;
    if (b < 0) {
        return negative(out);
    }
    return out;
}

fn rounded(a: vec2<u32>) -> f32 {
    if (bitcast<i32>(a.y) < 0) {
        let opposite = negative(a);
        return -(f32(opposite.y) * 4294967296.0 + f32(opposite.x));
    }
    return f32(a.y) * 4294967296.0 + f32(a.x);
}

// A height in units of 1/256 m; 0 if it is not a number. Halves are rounded away from 0, as on the processor; `round`
// of WGSL rounds them to even numbers.
fn counts(height: f32) -> i32 {
    if ((bitcast<u32>(height) & 0x7fffffffu) > 0x7f800000u) {
        return 0;
    }
    let exact = clamp(height, -131072.0, 131072.0) * 256.0;
    let whole = trunc(exact);
    return i32(whole + select(0.0, sign(exact), abs(exact - whole) >= 0.5));
}

// Sums down a column up to and including each sample: one call for each column.
fn add_up(base: u32, at: vec2<i32>) {
    if (at.y > 0) {
        return;
    }
    var sum = vec2<u32>(0u);
    var squares = vec2<u32>(0u);
    for (var y = 0; y < size().y; y += 1) {
        let here = vec2<i32>(at.x, y);
        let count = counts(plane(0u, here));
        sum = plus(sum, widened(count));
        squares = plus(squares, product(u32(abs(count)), u32(abs(count))));
        set_plane(SUM, here, f32(sum.x & LIMB));
        set_plane(SUM + 1u, here, f32((sum.x >> 24u) | ((sum.y & 0xffffu) << 8u)));
        set_plane(SQUARES, here, f32(squares.x & LIMB));
        set_plane(SQUARES + 1u, here, f32((squares.x >> 24u) | ((squares.y & 0xffffu) << 8u)));
        set_plane(SQUARES + 2u, here, f32(squares.y >> 16u));
    }
}

// The lower 48 bits of a sum.
fn sum_at(at: vec2<i32>) -> vec2<u32> {
    let high = u32(plane(SUM + 1u, at));
    return vec2<u32>(u32(plane(SUM, at)) | (high << 24u), high >> 8u);
}

fn squares_at(at: vec2<i32>) -> vec2<u32> {
    let high = u32(plane(SQUARES + 1u, at));
    return vec2<u32>(u32(plane(SQUARES, at)) | (high << 24u), (high >> 8u) | (u32(plane(SQUARES + 2u, at)) << 16u));
}

// The slope position of Weiss, from 1.
fn slope_position(deviation: f32, degrees: f32) -> f32 {
    if (deviation > 1.0) {
        return 1.0;
    }
    if (deviation > 0.5) {
        return 2.0;
    }
    if (deviation >= -0.5) {
        return select(3.0, 4.0, degrees <= 5.0);
    }
    return select(6.0, 5.0, deviation >= -1.0);
}

fn compare(base: u32, at: vec2<i32>) {
    let radius = i32(radius(base));
    let count = disc_samples(base);
    var sum = vec2<u32>(0u);
    var squares = vec2<u32>(0u);
    for (var x = -radius; x <= radius; x += 1) {
        let tall = i32(half_width(base, u32(x + radius)));
        let below = at + vec2<i32>(x, tall);
        sum = plus(sum, sum_at(below));
        squares = plus(squares, squares_at(below));
        let above = at + vec2<i32>(x, -tall - 1);
        if (above.y >= 0) {
            sum = minus(sum, sum_at(above));
            squares = minus(squares, squares_at(above));
        }
    }
    // Only the lower 48 bits of the sum are known: the disc's own sum has fewer.
    sum.y = bitcast<u32>(bitcast<i32>(sum.y << 16u) >> 16u);
    let height = plane(0u, at);
    let center = counts(height);
    // Relative to the center, then to the mean, so that f32 is precise enough for the remainder.
    let n = f32(count);
    let from_center = rounded(minus(sum, times(vec2<u32>(count, 0u), center))) / n;
    let mean = center + i32(round(from_center));
    let rest = rounded(minus(sum, times(vec2<u32>(count, 0u), mean))) / n;
    let size_of_mean = u32(abs(mean));
    let square_of_mean = product(size_of_mean, size_of_mean);
    var around = product(square_of_mean.x, count);
    around.y += square_of_mean.y * count;
    let total = minus(plus(squares, around), times(sum, 2 * mean));
    let variance = rounded(total) / n - rest * rest;
    // Heights are not always multiples of 1/256 m.
    let position = (height - f32(center) / 256.0) - from_center / 256.0;
    // A variance below one unit is a rounding error.
    var deviation = 0.0;
    if (variance >= 1.0) {
        deviation = position * 256.0 / sqrt(variance);
    }
    set_plane(1u, at, position);
    set_plane(2u, at, deviation);
    set_plane(3u, at, slope_position(deviation, slope_degrees(gradient(0u, at, gradient_scale(base)))));
}
