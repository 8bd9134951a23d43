// Functions of expressions that WGSL lacks, or has with too little precision: its sine may be off by 5e-4.

fn infinity() -> f32 {
    // Not a constant, because a constant must be finite.
    return bitcast<f32>(0x7f800000u | (frame.height & 0x00000000u));
}

fn is_nan(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u;
}

fn truth(holds: bool) -> f32 {
    return select(0.0, 1.0, holds);
}

fn modulo(a: f32, b: f32) -> f32 {
    return a - b * floor(a / b);
}

fn rounded(a: f32) -> f32 {
    return sign(a) * floor(abs(a) + 0.5);
}

fn power(a: f32, b: f32) -> f32 {
    if (b == 0.0) {
        return 1.0;
    }
    if (a == 0.0) {
        return select(infinity(), 0.0, b > 0.0);
    }
    let size = exp2(b * log2(abs(a)));
    if (a > 0.0) {
        return size;
    }
    // A negative number has only whole powers.
    if (floor(b) != b) {
        return infinity() - infinity();
    }
    return select(size, -size, modulo(b, 2.0) == 1.0);
}

fn smooth_min(a: f32, b: f32, k: f32) -> f32 {
    let least = select(b, a, a < b);
    if (k <= 0.0) {
        return least;
    }
    let h = max(k - abs(a - b), 0.0) / k;
    return least - h * h * (k * 0.25);
}

fn smooth_max(a: f32, b: f32, k: f32) -> f32 {
    return -smooth_min(-a, -b, k);
}

fn cut(a: f32, low: f32, high: f32) -> f32 {
    let raised = select(a, low, a < low);
    return select(raised, high, raised > high);
}

fn step_between(low: f32, high: f32, x: f32) -> f32 {
    let t = cut((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Sine and cosine: the angle is reduced to a quarter turn around 0 by pi / 2 in three parts (Cody and Waite 1980), with
// the polynomials of Cephes' sinf.
fn sine_of(angle: f32, quarters: f32) -> f32 {
    let n = floor(angle * 0.636619772 + 0.5);
    let r = ((angle - n * 1.5703125) - n * 4.837512969970703e-4) - n * 7.549789948768648e-8;
    let quadrant = i32(n - 4.0 * floor((n + quarters) * 0.25) + quarters);
    let z = r * r;
    let s = ((-1.9515295891e-4 * z + 8.3321608736e-3) * z - 1.6666654611e-1) * z * r + r;
    let c = ((2.443315711809948e-5 * z - 1.388731625493765e-3) * z + 4.166664568298827e-2) * z * z - 0.5 * z + 1.0;
    let value = select(s, c, (quadrant & 1) == 1);
    return select(value, -value, (quadrant & 2) == 2);
}

fn sine(a: f32) -> f32 {
    return sine_of(a, 0.0);
}

fn cosine(a: f32) -> f32 {
    return sine_of(a, 1.0);
}

fn arc_tangent2(y: f32, x: f32) -> f32 {
    if (x == 0.0 && y == 0.0) {
        return 0.0;
    }
    if (abs(x) >= abs(y)) {
        let angle = arc_tangent(y / x);
        if (x > 0.0) {
            return angle;
        }
        return select(angle - 3.141592653589793, angle + 3.141592653589793, y >= 0.0);
    }
    let angle = arc_tangent(x / y);
    return select(-1.5707963267948966, 1.5707963267948966, y > 0.0) - angle;
}

fn arc_sine(a: f32) -> f32 {
    return arc_tangent2(a, sqrt((1.0 - a) * (1.0 + a)));
}

fn arc_cosine(a: f32) -> f32 {
    return arc_tangent2(sqrt((1.0 - a) * (1.0 + a)), a);
}

fn hyperbolic_tangent(a: f32) -> f32 {
    let x = min(abs(a), 15.0);
    if (x < 0.02) {
        return a - a * a * a / 3.0;
    }
    let e = exp(2.0 * x);
    let y = (e - 1.0) / (e + 1.0);
    return select(y, -y, a < 0.0);
}
