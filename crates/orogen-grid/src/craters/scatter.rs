//! Where craters are: random points of each class of diameters.

use super::crater::Crater;
use super::{Craters, REACH};
use crate::random::{Random, STEP, mix64};

/// Number of craters of a diameter D and larger at geometric saturation, per square of side D (Gault 1970).
const SATURATION: f64 = 1.54;

/// Maximum share of geometric saturation in a class: new craters then remove as many as they add.
const MAX_DENSITY: f64 = 0.3;

/// Diameters of a class differ by at most this factor, the square root of 2.
const RATIO: f64 = std::f64::consts::SQRT_2;

/// Side of a cell over the maximum diameter of its class: just beyond the reach of a crater.
const SIDE: f64 = 0.5 * REACH * 1.01;

/// Craters whose diameters differ by at most a factor of the square root of 2.
#[derive(Debug, Clone)]
pub(super) struct Class {
    /// Minimum and maximum diameter, in metres.
    diameters: [f64; 2],
    /// Side of the cells, in metres.
    side: f64,
    /// exp(-mean), with the mean number of craters in a cell.
    none: f64,
    seed: u64,
}

/// The classes, largest first. Those of large craters do not depend on the minimum diameter.
pub(super) fn classes(law: &Craters) -> Vec<Class> {
    let [least, most] = law.diameters;
    let mut classes = Vec::new();
    let (mut upper, mut number) = (most, 0u64);
    // Number of craters of this diameter and larger, per square of side `most`.
    let above = |diameter: f64| law.density * libm::pow(most / diameter, law.exponent);
    while upper > least && number < 64 {
        let lower = (upper / RATIO).max(least);
        let share = above(lower) - above(upper);
        let most_of_them = MAX_DENSITY * ((most / lower) * (most / lower) - (most / upper) * (most / upper));
        let side = SIDE * upper;
        let mean = SATURATION * share.min(most_of_them) * (side / most) * (side / most);
        let seed = mix64(law.seed.wrapping_add(number.wrapping_mul(STEP)));
        classes.push(Class { diameters: [lower, upper], side, none: libm::exp(-mean), seed });
        (upper, number) = (lower, number + 1);
    }
    classes
}

impl Class {
    /// First and last cell along an axis whose craters may reach metres between two.
    fn range(&self, from: f64, to: f64) -> [f64; 2] {
        let reach = 0.5 * REACH * self.diameters[1];
        [((from - reach) / self.side).floor(), ((to + reach) / self.side).floor()]
    }

    /// Number of cells whose craters may reach into the bounds.
    pub(super) fn cells(&self, bounds: &[[f64; 2]; 2]) -> f64 {
        let along = |axis: usize| {
            let [first, last] = self.range(bounds[0][axis], bounds[1][axis]);
            last - first + 1.0
        };
        along(0) * along(1)
    }

    /// Adds the craters that may reach into the bounds.
    pub(super) fn gather(&self, law: &Craters, bounds: &[[f64; 2]; 2], craters: &mut Vec<Crater>) {
        let along = |axis: usize| self.range(bounds[0][axis], bounds[1][axis]).map(|cell| cell as i64);
        let ([left, right], [top, bottom]) = (along(0), along(1));
        for row in top..=bottom {
            for column in left..=right {
                let cell = mix64(self.seed.wrapping_add((column as u64).wrapping_mul(STEP)));
                let mut random = Random::of_state(mix64(cell.wrapping_add((row as u64).wrapping_mul(STEP))));
                for _ in 0..self.count(&mut random) {
                    let place = [column, row].map(|cell| (cell as f64 + random.share()) * self.side);
                    let (diameter, bits) = (self.diameter(law, random.share()), random.draw());
                    if distance(place, bounds) < 0.5 * REACH * diameter {
                        craters.extend(Crater::new(law, place, diameter, bits));
                    }
                }
            }
        }
    }

    /// Number of craters in a cell, by a Poisson distribution.
    fn count(&self, random: &mut Random) -> u32 {
        let (mut left, mut count) = (random.share(), 0);
        while left > self.none && count < 32 {
            left *= random.share();
            count += 1;
        }
        count
    }

    /// A diameter, distributed as the exponent says.
    fn diameter(&self, law: &Craters, share: f64) -> f64 {
        let [lower, upper] = self.diameters;
        let end = libm::pow(lower / upper, law.exponent);
        (lower * libm::pow(1.0 - share * (1.0 - end), -1.0 / law.exponent)).clamp(lower, upper)
    }
}

/// Distance of a point from bounds.
fn distance(place: [f64; 2], bounds: &[[f64; 2]; 2]) -> f64 {
    let beyond = [0, 1].map(|axis| (bounds[0][axis] - place[axis]).max(place[axis] - bounds[1][axis]).max(0.0));
    (beyond[0] * beyond[0] + beyond[1] * beyond[1]).sqrt()
}
