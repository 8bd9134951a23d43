//! Impact craters, as a function of the position.
//!
//! Craters of a class of diameters are scattered over a lattice with a cell that no crater of the class reaches across.
//! The craters that reach a position are therefore those of nine cells of each class. They are laid in the order of
//! their ages: a crater replaces the relief of older ones of its size and smaller ones in its bowl, and buries small
//! ones under its ejecta.

mod crater;
mod profiles;
mod scatter;

use crater::{Crater, REACH};
use scatter::Class;

/// How craters are distributed and how they age.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Craters {
    /// Minimum and maximum diameter, in metres.
    pub diameters: [f64; 2],
    /// Exponent of the number of craters larger than a diameter.
    pub exponent: f64,
    /// Number of the largest craters, as a share of geometric saturation.
    pub density: f64,
    /// Diameter from which craters are complex, in metres.
    pub transition: f64,
    /// Diffusivity times the age of the surface, for a crater of 1 km, in m^2.
    pub diffusion: f64,
    /// Seed of the craters.
    pub seed: u64,
}

impl Default for Craters {
    /// The defaults of the op `craters`.
    fn default() -> Craters {
        Craters {
            diameters: [200.0, 20_000.0],
            exponent: 2.0,
            density: 0.06,
            transition: 15_000.0,
            diffusion: 20_000.0,
            seed: 0,
        }
    }
}

orogen_noise::builder!(
    Craters:
    with_diameters(diameters: [f64; 2]),
    with_exponent(exponent: f64),
    with_density(density: f64),
    with_transition(transition: f64),
    with_diffusion(diffusion: f64),
    with_seed(seed: u64)
);

/// Maximum ratio of the largest and the smallest diameter: 32 classes.
pub const MAX_RATIO: f64 = 65_536.0;

/// What craters make of a position.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cratered {
    /// Height over the ground without craters, in metres.
    pub height: f64,
    /// Share of the older fine relief that craters replaced, 0 to 1.
    pub resurfaced: f64,
    /// Share of bright young ejecta, 0 to 1.
    pub ejecta: f64,
}

/// Craters that are prepared for many positions.
#[derive(Debug, Clone)]
pub struct PreparedCraters {
    classes: Vec<Class>,
    law: Craters,
}

/// Maximum number of positions that share a list of craters.
const SHARED: usize = 1024;

impl Craters {
    /// The craters, prepared for many positions.
    #[must_use]
    pub fn prepare(&self) -> PreparedCraters {
        PreparedCraters { classes: scatter::classes(self), law: *self }
    }
}

impl PreparedCraters {
    /// Calls `take` for each of the numbered `positions`, with its number and what is there: NaN where a position is
    /// not finite. A result does not depend on the other positions; it is fastest for positions that are close
    /// together.
    pub fn each(&self, positions: impl Iterator<Item = (usize, [f64; 2])>, mut take: impl FnMut(usize, Cratered)) {
        let mut shared = Vec::with_capacity(SHARED);
        let (mut craters, mut found) = (Vec::new(), Vec::new());
        let mut positions = positions.peekable();
        while positions.peek().is_some() {
            shared.clear();
            for (index, position) in positions.by_ref().take(SHARED) {
                if position.iter().all(|metres| metres.is_finite()) {
                    shared.push((index, position));
                } else {
                    take(index, Cratered { height: f64::NAN, resurfaced: f64::NAN, ejecta: f64::NAN });
                }
            }
            self.part(&shared, &mut craters, &mut found, &mut take);
        }
    }

    /// The positions of a part, in smaller parts where they are so far apart that most craters of a common list would
    /// reach few of them.
    fn part(
        &self,
        positions: &[(usize, [f64; 2])],
        craters: &mut Vec<Crater>,
        found: &mut Vec<Laid>,
        take: &mut impl FnMut(usize, Cratered),
    ) {
        let Some(((_, first), rest)) = positions.split_first() else { return };
        let mut bounds = [*first; 2];
        for (_, position) in rest {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(position[axis]);
                bounds[1][axis] = bounds[1][axis].max(position[axis]);
            }
        }
        let cells: f64 = self.classes.iter().map(|class| class.cells(&bounds)).sum();
        if !rest.is_empty() && cells > self.classes.len() as f64 * (16 + positions.len()) as f64 {
            let (one, other) = positions.split_at(positions.len() / 2);
            self.part(one, craters, found, take);
            self.part(other, craters, found, take);
            return;
        }
        craters.clear();
        self.classes.iter().for_each(|class| class.gather(&self.law, &bounds, craters));
        craters.sort_unstable_by(Crater::by_age);
        crater::find_levels(craters);
        for (index, position) in positions {
            take(*index, at(craters, *position, found));
        }
    }
}

/// The relief of a crater at a position.
struct Laid {
    /// The index of the crater.
    index: usize,
    height: f64,
}

/// What the craters, oldest first, make of a position.
fn at(craters: &[Crater], position: [f64; 2], laid: &mut Vec<Laid>) -> Cratered {
    laid.clear();
    let mut result = Cratered::default();
    for (index, crater) in craters.iter().enumerate() {
        let from = [position[0] - crater.center[0], position[1] - crater.center[1]];
        let square = from[0] * from[0] + from[1] * from[1];
        if square >= crater.reach * crater.reach {
            continue;
        }
        let shape = crater.shape(from, square.sqrt());
        let mut levels = crater.levels.as_slice();
        for older in laid.iter_mut() {
            while levels.first().is_some_and(|level| level.0 < older.index) {
                levels = &levels[1..];
            }
            let level = levels.first().filter(|level| level.0 == older.index).map_or(0.0, |level| level.1);
            let diameter = craters[older.index].diameter;
            older.height += (level - older.height) * shape.replaced(crater.diameter, diameter);
            older.height *= 1.0 - shape.buried(crater.diameter, diameter);
        }
        result.resurfaced += (1.0 - result.resurfaced) * shape.bowl;
        result.ejecta *= 1.0 - shape.bowl;
        result.ejecta = result.ejecta.max(shape.brightness);
        laid.push(Laid { index, height: shape.height });
    }
    // Oldest first: a fixed order.
    result.height = laid.iter().fold(0.0, |sum, laid| sum + laid.height);
    result
}

/// A smooth step from 0 at `from` to 1 at `to`.
pub(crate) fn step(from: f64, to: f64, at: f64) -> f64 {
    let t = ((at - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests;
