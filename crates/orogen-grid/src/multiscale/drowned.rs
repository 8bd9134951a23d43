//! The sea of given land, whose heights include the sea floor.

use super::level::Level;
use super::surface::sea_bottom;
use crate::grid::Grid;
use crate::hydrology::direction::NONE;

/// Depth of the shelf at a kilometre from the shore, in metres.
const SHELF: f32 = 1.8;

/// The maximum distance from the shore up to which the sea floor falls, in km.
const FURTHEST: f32 = 1300.0;

/// Number of bisection steps, enough for all 24 binary digits of an f32.
const HALVINGS: usize = 40;

impl Level {
    /// Sets the sea at `sea_level` metres in a coarsest level of given land: heights become relative to it, and nodes
    /// of land at or below it become water. Their distance from the shore is chosen such that the sea floor there has
    /// the depth of the given land, with a minimum near the coast. `land` covers the window grown by
    /// [`REACH`](super::coarse::REACH).
    pub fn drown(&mut self, land: &Grid, sea_level: f32) {
        let cell = (self.window.cell * 1e-3) as f32;
        let window = self.window;
        let above = |x: i64, y: i64| land[((x - land.window().x) as usize, (y - land.window().y) as usize)] - sea_level;
        for (q, (y, x)) in
            (window.y..window.bottom()).flat_map(|y| (window.x..window.right()).map(move |x| (y, x))).enumerate()
        {
            let height = above(x, y);
            let around =
                |ring: i64| (-ring..=ring).flat_map(move |south| (-ring..=ring).map(move |east| (x + east, y + south)));
            if height <= 0.0 {
                let is_coast = |ring: i64| around(ring).any(|(x, y)| above(x, y) > 0.0);
                let least = if is_coast(1) {
                    0.5
                } else if is_coast(2) {
                    1.5
                } else {
                    2.5
                };
                (self.height[q], self.receiver[q]) = (0.0, NONE);
                self.shore[q] = -distance_of(-height).max(least * cell);
                continue;
            }
            self.height[q] = height;
            // Between a node of the coast and a node of the sea, the shore is about where the ground is at sea level.
            let sea = around(1).map(|(x, y)| -above(x, y)).fold(-1.0, f32::max);
            if sea >= 0.0 && self.receiver[q] < NONE {
                self.shore[q] = (height / SHELF).min(distance_of(sea)).max(0.5 * cell);
            }
        }
    }
}

/// Distance from the shore, in km, at which the sea has this depth in metres.
fn distance_of(depth: f32) -> f32 {
    let (mut low, mut high) = (0.0, FURTHEST);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if -sea_bottom(middle) < depth { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::multiscale::coarse::{Coarse, REACH};
    use crate::multiscale::given::Given;
    use crate::multiscale::refinement::Refinement;
    use crate::progress::Progress;

    #[test]
    fn the_sea_is_as_deep_as_the_land_below_it() {
        for depth in [0.0f32, 0.3, 10.0, 140.0, 150.0, 2000.0, 3600.0, 4900.0] {
            let made = -sea_bottom(distance_of(depth));
            assert!((made - depth).abs() < 0.01 + 1e-4 * depth, "{made} m, not {depth} m");
        }
        assert!(distance_of(9000.0) <= FURTHEST);
    }

    #[test]
    fn land_at_and_below_sea_level_is_sea() {
        let land = Refinement::new(9).with_levels(4);
        let window = Window::new(30, 20, land.cell_of(0)).at(-15, -10);
        let read = window.grown(REACH);
        // A coast along x = 2. The land falls to the west, below a sea level of 300 m.
        let heights = (0..read.len()).map(|q| 40.0 * ((q % read.width) as i64 + read.x) as f32 + 220.0).collect();
        let height = Grid::from_data(read, heights).unwrap();
        let flow = Grid::filled(read, 1e6f32);
        let coarse = Coarse { height: &height, flow: &flow, receiver: None };
        let mut level = land.coarsest_of(&coarse, &Given::default(), &window, &Progress::none()).unwrap();
        level.drown(&height, 300.0);
        for q in 0..window.len() {
            let x = (q % window.width) as i64 + window.x;
            let above = 40.0 * x as f32 - 80.0;
            if x <= 2 {
                assert_eq!((level.height[q], level.receiver[q]), (0.0, NONE));
                let depth = -sea_bottom(-level.shore[q]);
                assert!((depth - -above).abs() < 5.0 && level.shore[q] < 0.0, "{depth} m at {x}");
            } else {
                assert_eq!((level.height[q], level.receiver[q]), (above, 4));
                assert!(level.shore[q] > 0.0);
            }
        }
    }
}
