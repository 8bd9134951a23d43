// What the passes that read layers from a level have in common.
//
// Planes beside those of the level are those of the layers: heights of the ground, drainage areas in m^2, depths of lakes, receivers; and water levels.
const WATER_LEVEL = 12u;
// Of nodes of rivers, until the layers take their place: position, height, half of the width in cells, and depth.
const NODE_EAST = 13u;
const NODE_SOUTH = 14u;
const NODE_HEIGHT = 15u;
const NODE_HALF = 16u;
const NODE_DEPTH = 17u;

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
