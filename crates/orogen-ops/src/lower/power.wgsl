// x to the power y, for positive x, as in orogen-grid's `erosion/power.rs`.
fn power(x: f32, y: f32) -> f32 {
    let bits = bitcast<u32>(x) - 0x3f3504f3u;
    let exponent = bitcast<i32>(bits) >> 23u;
    let m = bitcast<f32>((bits & 0x007fffffu) + 0x3f3504f3u);
    let t = (m - 1.0) / (m + 1.0);
    let s = t * t;
    let series = ((((0.2222222 * s + 0.2857143) * s + 0.4) * s + 0.6666667) * s + 2.0) * t;
    let z = clamp(y * (f32(exponent) + series * 1.442695), -126.0, 127.0);
    let whole = round(z);
    let f = (z - whole) * 0.6931472;
    let root = (((((f / 720.0 + 0.008333334) * f + 0.041666668) * f + 0.16666667) * f + 0.5) * f + 1.0) * f + 1.0;
    return root * bitcast<f32>(u32(i32(whole) + 127) << 23u);
}
