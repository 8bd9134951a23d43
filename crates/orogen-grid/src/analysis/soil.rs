//! Soil depth in a steady state, where production balances erosion.
//!
//! Below a soil of depth h, bedrock turns into soil at the rate P0 exp(-h / h*) (Heimsath, Dietrich, Nishiizumi and
//! Finkel, "The soil production function and landscape equilibrium", Nature 388, 1997). Soil creeps downhill with the
//! flux q = K S / (1 - (S / Sc)^2), where S is the slope and Sc the critical slope (Roering, Kirchner and Dietrich
//! 1999). In a steady state, production equals the divergence of q (Pelletier and Rasmussen, "Geomorphically based
//! predictive mapping of soil thickness in upland watersheds", 2009):
//!
//! ```text
//! h = h* ln(ratio P0 / div q)
//! ```
//!
//! where `ratio` is the density of rock divided by the density of soil. There is no soil where more is removed than
//! bare rock produces. Where soil accumulates (hollows, foot slopes) the balance has no solution, and the depth is
//! `deepest`.

use super::nine::{over_nine, over_nine_with};
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;

/// Parameters of the soil balance.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Soil {
    /// P0: soil production from bare rock, in metres per year.
    pub production: f64,
    /// h*: the depth over which production falls by a factor of e, in metres.
    pub decay: f64,
    /// K: the creep coefficient, in m^2 per year.
    pub creep: f64,
    /// Sc: the critical slope, rise over run.
    pub critical_slope: f64,
    /// Density of rock over density of soil.
    pub density_ratio: f64,
    /// The maximum depth, in metres.
    pub deepest: f64,
}

impl Default for Soil {
    /// The defaults of the op `soil-depth`: production 7.7e-5, decay 0.43, creep 0.005, critical slope 1.25, density
    /// ratio 2, depth up to 2 m.
    fn default() -> Soil {
        Soil { production: 7.7e-5, decay: 0.43, creep: 0.005, critical_slope: 1.25, density_ratio: 2.0, deepest: 2.0 }
    }
}

orogen_noise::builder!(
    Soil:
    with_production(production: f64),
    with_decay(decay: f64),
    with_creep(creep: f64),
    with_critical_slope(critical_slope: f64),
    with_density_ratio(density_ratio: f64),
    with_deepest(deepest: f64)
);

impl Soil {
    /// The soil depth, in metres, where `carried` metres per year are removed (negative where soil accumulates).
    #[must_use]
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

    /// The flux K S / (1 - (S / Sc)^2) along one axis, for a slope with the components `along` and `across` that axis;
    /// infinite at Sc.
    fn flux(&self, along: f64, across: f64) -> f64 {
        let share = (along * along + across * across) / (self.critical_slope * self.critical_slope);
        if share >= 1.0 { f64::INFINITY.copysign(along) } else { self.creep * along / (1.0 - share) }
    }

    /// The soil depth, in metres, at the center of 3 x 3 heights that are `c` metres apart, rows from the north. It
    /// follows from the fluxes through the four sides of the center's cell. 0 if a side is steeper than the critical
    /// slope; NaN if one of the nine heights is not finite.
    #[must_use]
    pub fn depth_at(&self, z: [[f64; 3]; 3], c: f64) -> f64 {
        // Downhill flux, from the drop across a side and the mean drop along it.
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

    /// The soil depth, in metres, at every sample of `grid` except its border of one sample. Rows are computed in
    /// parallel.
    #[must_use]
    pub fn depths(&self, grid: &Grid) -> Grid {
        let cell = grid.window().cell;
        over_nine(grid, |z| self.depth_at(z, cell) as f32)
    }

    /// [`Soil::depths`] with progress and cancellation.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn depths_with(&self, grid: &Grid, progress: &Progress) -> Result<Grid> {
        let cell = grid.window().cell;
        over_nine_with(grid, progress, |z| self.depth_at(z, cell) as f32)
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
        // z = -C (x^2 + y^2) / 4: the Laplacian is -C, and K C is removed. The slopes are so gentle that the other
        // terms are negligible.
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
