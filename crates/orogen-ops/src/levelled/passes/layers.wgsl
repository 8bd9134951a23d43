// Common functions of the passes that compute layers from a level.

fn square_metres(base: u32) -> f32 {
    return cell(base) * cell(base);
}

// Width and depth of a river with this drainage area in m^2, in metres.
fn width_of(base: u32, area: f32) -> f32 {
    return width_of_one(base) * sqrt(max(area * runoff(base), 0.0));
}

fn depth_of(base: u32, area: f32) -> f32 {
    let discharge = area * runoff(base);
    if (discharge <= 0.0) {
        return 0.0;
    }
    return depth_of_one(base) * power(discharge, 0.4);
}
