//! Cinder cones and the ash around them.

use super::Ground;

/// Height of a cone, diameter of its crater, both over the diameter of its base (Wood 1980); its flanks have 31
/// degrees.
const HEIGHT: f64 = 0.18;
const CRATER: f64 = 0.4;
const FLANK: f64 = HEIGHT / (0.5 - 0.5 * CRATER);

/// Depth of the crater over the diameter of the base, and the share of its radius that is floor.
const DEPTH: f64 = 0.1;
const FLOOR: f64 = 0.25;

/// On slopes the foot of a cone is further down: from here it thins, up to the end, both over the base's diameter.
const FOOT: [f64; 2] = [0.6, 1.5];

/// Share of the volume that falls around the cone as ash, thinner by e over each diameter of the base; it ends at this
/// many diameters.
const FALL: f64 = 0.4;
const FALL_END: f64 = 5.0;

/// Volume of a cone on level ground over the cube of its base's diameter.
const VOLUME: f64 = 0.067;

/// Halvings of the interval that contains a cone's diameter.
const HALVINGS: u32 = 24;

/// Height of a cone over its base at a distance, both over the diameter of the base; negative beyond the base.
fn profile(distance: f64) -> f64 {
    let rim = 0.5 * CRATER;
    if distance >= rim {
        return HEIGHT - FLANK * (distance - rim);
    }
    let up = ((distance / rim - FLOOR) / (1.0 - FLOOR)).max(0.0);
    HEIGHT - DEPTH * (1.0 - up)
}

/// Change of the height of a cell by a cone.
fn change(height: f64, base: f64, diameter: f64, distance: f64) -> f64 {
    let at = distance / diameter;
    let above = base + profile(at) * diameter - height;
    // In the crater, ground above the cone is blown out.
    if at < 0.5 * CRATER {
        return above;
    }
    let [from, to] = FOOT;
    above.max(0.0) * ((to - at) / (to - from)).clamp(0.0, 1.0)
}

/// Builds the cone of an eruption that throws out a volume in m^3, and returns the volume that it laid: the given one
/// up to rounding, less on the border.
pub(super) fn build(ground: &mut Ground, [i, j]: [usize; 2], volume: f64, age: f32) -> f64 {
    let window = ground.window;
    let (cell, area) = (window.cell, window.cell * window.cell);
    let vent = [i as f64, j as f64];
    let base = ground.height[j * window.width + i];
    let size = cube_root((1.0 - FALL) * volume / VOLUME);
    // A cone of less than two cells is lost between them.
    if size < 2.0 * cell {
        return 0.0;
    }
    let distance = |[x, y]: [f64; 2]| cell * (x * x + y * y).sqrt();
    let laid = |ground: &Ground, diameter: f64| -> f64 {
        let near = ground.around(vent, FOOT[1] * diameter / cell);
        let finite = near.filter(|(at, _)| ground.height[*at].is_finite());
        area * finite.map(|(at, offset)| change(ground.height[at], base, diameter, distance(offset))).sum::<f64>()
    };
    let wanted = (1.0 - FALL) * volume;
    let (mut low, mut high) = (0.25 * size, 2.5 * size);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if laid(ground, middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    let mut sum = 0.0;
    for (at, offset) in ground.around(vent, FOOT[1] * low / cell) {
        let by = change(ground.height[at], base, low, distance(offset));
        if by.is_finite() && by != 0.0 {
            ground.shift(at, by, age);
            sum += by;
        }
    }
    sum * area + fall(ground, vent, FALL * volume, low, age)
}

/// Lets a volume of ash fall around a cone, and returns the volume on the grid.
fn fall(ground: &mut Ground, vent: [f64; 2], volume: f64, diameter: f64, age: f32) -> f64 {
    let cell = ground.window.cell;
    let reach = FALL_END * diameter / cell;
    let share = |[x, y]: [f64; 2]| {
        let distance = (x * x + y * y).sqrt();
        if distance < reach { libm::exp(-distance * cell / diameter) } else { 0.0 }
    };
    // All of it, also the ash that falls beyond the border.
    let whole = std::f64::consts::TAU * diameter * diameter * (1.0 - (1.0 + FALL_END) * libm::exp(-FALL_END));
    let mut sum = 0.0;
    for (at, offset) in ground.around(vent, reach) {
        let by = volume / whole * share(offset);
        if by > 0.0 && ground.height[at].is_finite() {
            // Thin ash does not hide what is below it.
            let surface = if by > 0.5 { age } else { ground.age[at] };
            ground.shift(at, by, surface);
            sum += by;
        }
    }
    sum * cell * cell
}

fn cube_root(value: f64) -> f64 {
    libm::pow(value.max(0.0), 1.0 / 3.0)
}
