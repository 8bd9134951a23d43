// Temperature: latitude of the northern edge, means at the equator and the poles, decrease per metre, sea level,
// whether the distance from the sea is given, the distance at which the index of continentality is 50, and the seasons
// without a distance. The lattice has degrees.
fn temperature_latitude(base: u32, place: Placement) -> f32 {
    return clamp(number(base, 0u) - coordinate(base + 8u, 1u, place), -90.0, 90.0);
}

fn temperature_mean(base: u32, place: Placement, source: f32, sea_distance: f32, anomaly: f32) -> f32 {
    let sine_of_latitude = sine(radians(temperature_latitude(base, place)));
    let at_sea_level = number(base, 1u) - (number(base, 1u) - number(base, 2u)) * sine_of_latitude * sine_of_latitude;
    return at_sea_level - number(base, 3u) * max(source - number(base, 4u), 0.0) + anomaly;
}

fn temperature_range(base: u32, place: Placement, source: f32, sea_distance: f32, anomaly: f32) -> f32 {
    let seasonality = sine(radians(abs(temperature_latitude(base, place)) + 10.0)) / 3.4;
    let from_sea = max(sea_distance, 0.0);
    let seasons = 100.0 * from_sea / (from_sea + number(base, 6u)) + 14.0;
    return seasonality * select(number(base, 7u), seasons, number(base, 5u) != 0.0);
}
