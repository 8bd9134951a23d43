fn terrace_rise(t: f32, riser: f32) -> f32 {
    let s = clamp((t - 0.5) / riser + 0.5, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}

// Terraces: the height of a step, the height of one tread, and the riser's share of a step.
fn terrace(base: u32, place: Placement, source: f32) -> f32 {
    let step = number(base, 0u);
    let offset = number(base, 1u);
    let riser = number(base, 2u);
    let steps = (source - offset) / step;
    let tread = floor(steps + 0.5);
    let t = steps - tread + 0.5;
    let share = select(terrace_rise(t - 0.5, riser), terrace_rise(t + 0.5, riser) - 1.0, t < 0.5);
    return (tread + share) * step + offset;
}
