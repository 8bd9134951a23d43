//! How deep soil is where production keeps up with erosion.
//!
//! Bedrock turns into soil at P0 exp(-h / h*) below soil of depth h (Heimsath, Dietrich, Nishiizumi and Finkel, "The soil production function and landscape
//! equilibrium", Nature 388, 1997). Soil creeps downhill by q = K S / (1 - (S / Sc)^2), S the slope and Sc the slope at which it slides (Roering, Kirchner
//! and Dietrich 1999). Where the depth stays the same, production makes up for what the divergence of q carries away (the balance that Pelletier and
//! Rasmussen, "Geomorphically based predictive mapping of soil thickness in upland watersheds", 2009, solve with either law of transport):
//!
//! ```text
//! h = h* ln(ratio P0 / div q)
//! ```
//!
//! with `ratio` the density of rock over that of soil. Where more is carried away than bare rock makes there is no soil; where soil is brought rather than
//! carried away (hollows, foot slopes) the balance has no solution, and the depth is the greatest.

use super::nine::over_nine;
use crate::grid::Grid;

/// The figures of the balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soil {
    /// P0: production from bare rock, in metres a year.
    pub production: f64,
    /// h*: the depth over which it falls by a factor e, in metres.
    pub decay: f64,
    /// K: how fast soil creeps, in m^2 a year.
    pub creep: f64,
    /// Sc: the slope at which it slides, rise over run.
    pub critical_slope: f64,
    /// Density of rock over density of soil.
    pub density_ratio: f64,
    /// The greatest depth, in metres.
    pub deepest: f64,
}

impl Soil {
    /// The depth where so much is carried away, in m a year (negative where it is brought).
    pub fn depth(&self, carried: f64) -> f64 {
        if carried.is_nan() {
            return f64::NAN;
        }
        let made = self.density_ratio * self.production;
        match carried <= 0.0 {
            true => self.deepest,
            false => (self.decay * libm::log(made / carried)).clamp(0.0, self.deepest),
        }
    }

    /// K S / (1 - (S / Sc)^2) along an axis of which the slope's part is `along`, its part across being `across`; infinite at Sc.
    fn flux(&self, along: f64, across: f64) -> f64 {
        let share = (along * along + across * across) / (self.critical_slope * self.critical_slope);
        if share >= 1.0 { f64::INFINITY.copysign(along) } else { self.creep * along / (1.0 - share) }
    }

    /// The depth in the middle of 3 x 3 heights `c` metres apart, rows from the north: from the fluxes through the four sides of its cell. Where it is too
    /// steep for soil on any side there is none. NaN where one of the nine is not finite.
    pub fn depth_at(&self, z: [[f64; 3]; 3], c: f64) -> f64 {
        // Downhill flux: by the fall across a side, and the mean fall along it.
        let east = |x: usize| {
            let along_it = ((z[0][x] + z[0][x + 1]) - (z[2][x] + z[2][x + 1])) / (4.0 * c);
            self.flux((z[1][x] - z[1][x + 1]) / c, along_it)
        };
        let south = |y: usize| {
            let along_it = ((z[y][0] + z[y + 1][0]) - (z[y][2] + z[y + 1][2])) / (4.0 * c);
            self.flux((z[y][1] - z[y + 1][1]) / c, along_it)
        };
        let sides = [east(1), -east(0), south(1), -south(0)];
        match sides.iter().all(|side| side.is_finite()) {
            true => self.depth(sides.iter().sum::<f64>() / c),
            false if z.iter().flatten().all(|height| height.is_finite()) => 0.0,
            false => f64::NAN,
        }
    }

    /// The depth at every sample of `grid` but those of its border. Rows side by side.
    pub fn depths(&self, grid: &Grid) -> Grid {
        let cell = grid.window().cell;
        over_nine(grid, |z| self.depth_at(z, cell) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    const SOIL: Soil =
        Soil { production: 7.7e-5, decay: 0.43, creep: 0.005, critical_slope: 1.25, density_ratio: 2.0, deepest: 3.0 };

    fn made(f: impl Fn(f64, f64) -> f64) -> Grid {
        let data = (0..49).map(|k| f((k % 7) as f64 * 10.0 - 30.0, (k / 7) as f64 * 10.0 - 30.0) as f32).collect();
        SOIL.depths(&Grid::from_data(Window::new(7, 7, 10.0), data).unwrap())
    }

    #[test]
    fn a_gentle_dome_has_the_depth_of_the_balance() {
        // z = -C (x^2 + y^2) / 4: the Laplacian is -C, and K C is carried away; slopes are too gentle for the rest.
        let bend = 1e-3;
        let depth = made(|x, y| -bend * (x * x + y * y) / 4.0)[(2, 2)];
        let expect = 0.43 * libm::log(2.0 * 7.7e-5 / (0.005 * bend));
        assert!((f64::from(depth) - expect).abs() < 2e-3, "{depth} {expect}");
    }

    #[test]
    fn hollows_are_deep_and_crests_and_cliffs_bare() {
        assert_eq!(made(|x, y| 0.01 * (x * x + y * y))[(2, 2)], 3.0);
        assert_eq!(made(|x, _| -0.05 * x * x)[(2, 2)], 0.0);
        assert_eq!(made(|x, _| 2.0 * x)[(2, 2)], 0.0);
        assert_eq!(made(|_, _| 7.0)[(2, 2)], 3.0);
        assert!(made(|x, y| if x == y { f64::NAN } else { 0.0 })[(2, 2)].is_nan());
    }
}
