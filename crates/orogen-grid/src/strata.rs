//! Strata: layers of rock, whose hardness depends on the height above their bedding.
//!
//! The rock at a point is a function of its stratigraphic height, the height above the datum of the bedding at that
//! place. Nothing is stored at depth: strata dip, fold and break where the datum does. Two integrals over the height
//! describe how strata erode:
//!
//! ```text
//! R(z) = integral of dz / k(z)          k: erodibility factor of the stratum at z
//! Q(z) = integral of dz / T(z)          T: maximum stable slope of the stratum at z
//! ```
//!
//! R is the work of erosion, Q the horizontal extent of the steepest stable wall. Both grow with z, so the implicit
//! equations of erosion have one solution for any time step, and no step skips a thin hard stratum.

use crate::grid::Grid;

/// A layer of rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stratum {
    /// Thickness, in metres.
    pub thickness: f64,
    /// Factor of the erodibility, smaller where rock is harder.
    pub erodibility_factor: f64,
    /// Maximum stable slope, in degrees; 0 for the op's own.
    pub talus_angle: f64,
}

impl Default for Stratum {
    fn default() -> Stratum {
        Stratum { thickness: 100.0, erodibility_factor: 1.0, talus_angle: 0.0 }
    }
}

/// The limits of what divides: factors and slopes.
const MIN_FACTOR: f64 = 1e-6;

/// The number of repetitions up to which beds are numbered.
const MAX_PERIOD: f64 = 1e12;

/// A sequence of strata, prepared for integrals over heights. Heights are measured from the bottom of the sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Strata {
    /// From the bottom up.
    beds: Vec<Bed>,
    /// The whole sequence, as a bed above all others.
    whole: Bed,
    repeats: bool,
}

/// A stratum and the integrals at its base.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Bed {
    base: f64,
    resistance: f64,
    extent: f64,
    /// 1 / k.
    hardness: f64,
    /// 1 / T.
    flatness: f64,
}

/// A bed by its number, with the integrals at its base.
#[derive(Clone, Copy)]
struct Found {
    number: i64,
    bed: Bed,
}

/// A number rounded down. The standard function is a call where the processor's own is not known to exist.
#[inline(always)]
fn floored(x: f64) -> i64 {
    let truncated = x as i64;
    truncated - i64::from(truncated as f64 > x)
}

impl Strata {
    /// Strata from the top down, as they are seen in a wall. Beyond the sequence the uppermost and the lowest stratum
    /// go on, or the sequence repeats. `max_slope`, rise over run, applies to strata without their own talus angle.
    /// `None` if there are none.
    #[must_use]
    pub fn new(strata: &[Stratum], repeats: bool, max_slope: f64) -> Option<Strata> {
        let mut whole = Bed::default();
        let mut beds = Vec::with_capacity(strata.len());
        for stratum in strata.iter().rev() {
            let slope = if stratum.talus_angle > 0.0 { libm::tan(stratum.talus_angle.to_radians()) } else { max_slope };
            let bed = Bed {
                hardness: 1.0 / stratum.erodibility_factor.max(MIN_FACTOR),
                flatness: 1.0 / slope.max(MIN_FACTOR),
                ..whole
            };
            beds.push(bed);
            let thickness = stratum.thickness.max(MIN_FACTOR);
            whole.base += thickness;
            whole.resistance += thickness * bed.hardness;
            whole.extent += thickness * bed.flatness;
        }
        (!beds.is_empty()).then_some(Strata { beds, whole, repeats })
    }

    /// The thickness of the sequence, in metres.
    #[must_use]
    pub fn thickness(&self) -> f64 {
        self.whole.base
    }

    /// The bed of a number: the lowest one of the sequence is 0, and those of repetitions are numbered on.
    fn numbered(&self, number: i64) -> Found {
        let count = self.beds.len() as i64;
        self.bed(number.div_euclid(count), number.rem_euclid(count))
    }

    /// The bed at an index of a repetition of the sequence.
    #[inline(always)]
    fn bed(&self, period: i64, index: i64) -> Found {
        let (bed, periods) = (self.beds[index as usize], period as f64);
        let bed = Bed {
            base: bed.base + periods * self.whole.base,
            resistance: bed.resistance + periods * self.whole.resistance,
            extent: bed.extent + periods * self.whole.extent,
            ..bed
        };
        Found { number: period * self.beds.len() as i64 + index, bed }
    }

    /// The bed that a value is in, where `of` grows with the height.
    #[inline(always)]
    fn find(&self, value: f64, of: impl Fn(&Bed) -> f64) -> Found {
        let whole = of(&self.whole);
        let period = if self.repeats { floored((value / whole).clamp(-MAX_PERIOD, MAX_PERIOD)) } else { 0 };
        let within = value - period as f64 * whole;
        let index = self.beds.partition_point(|bed| of(bed) <= within).max(1) - 1;
        self.bed(period, index as i64)
    }

    /// The number of the stratum at a height, from 0 at the top of the sequence.
    #[must_use]
    pub fn index(&self, height: f64) -> usize {
        let count = self.beds.len() as i64;
        let number = self.find(height, |bed| bed.base).number.rem_euclid(count);
        (count - 1 - number) as usize
    }

    /// The maximum stable slope at a height, rise over run.
    #[must_use]
    pub(crate) fn max_slope(&self, height: f64) -> f64 {
        1.0 / self.find(height, |bed| bed.base).bed.flatness
    }

    /// What remains of the drop from `top` to `below` after erosion by `cut`: x of R(top) - R(below + x) = cut x^n,
    /// where `solve` solves x + cut x^n = drop for x. In uniform rock with a factor of 1 this is that equation for the
    /// drop from `top` to `below`.
    #[inline(never)]
    pub(crate) fn eroded(&self, top: f64, below: f64, [cut, n]: [f64; 2], solve: impl Fn(f64, f64) -> f64) -> f64 {
        let drop = top - below;
        if !(drop > 0.0 && (top + cut).is_finite() && below.is_finite()) {
            return drop.min(0.0);
        }
        let mut found = self.find(top, |bed| bed.base);
        let work = found.bed.resistance + (top - found.bed.base) * found.bed.hardness;
        // The bed of the result is the uppermost one whose base is not reached.
        let is_reached = |bed: &Bed| {
            let x = bed.base - below;
            work - bed.resistance < cut * if n == 1.0 { x } else { libm::pow(x, n) }
        };
        if found.bed.base > below && is_reached(&found.bed) {
            let (mut low, mut high) = (self.find(below, |bed| bed.base).number, found.number);
            while high - low > 1 {
                let middle = low + (high - low) / 2;
                if is_reached(&self.numbered(middle).bed) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            found = self.numbered(low);
        }
        let bed = found.bed;
        // Within a bed: x + k cut x^n = k (R(top) - R(below)), with R(below) as if the bed went on.
        let drop = (work - bed.resistance) / bed.hardness + (bed.base - below);
        solve(drop, cut / bed.hardness)
    }

    /// The height above `below` of the steepest stable wall over a horizontal distance.
    pub(crate) fn stable(&self, below: f64, distance: f64) -> f64 {
        let foot = self.find(below, |bed| bed.base).bed;
        let extent = foot.extent + (below - foot.base) * foot.flatness + distance;
        let bed = self.find(extent, |bed| bed.extent).bed;
        bed.base + (extent - bed.extent) / bed.flatness - below
    }
}

/// Strata and their place in the ground.
#[derive(Debug, Clone, Copy)]
pub struct Bedding<'a> {
    /// The strata.
    pub strata: &'a Strata,
    /// Height of the top of the sequence at each cell at the end of the run, in metres; `None` for 0. There are no
    /// strata where it has no value.
    pub top: Option<&'a Grid>,
    /// Uplift after the run, in metres: rock rises with the ground, so the datum was lower before.
    pub risen_later: f64,
}

impl<'a> Bedding<'a> {
    /// Strata whose top is at these heights.
    #[must_use]
    pub fn new(strata: &'a Strata, top: Option<&'a Grid>) -> Bedding<'a> {
        Bedding { strata, top, risen_later: 0.0 }
    }

    /// Adds uplift that comes later.
    #[must_use]
    pub fn before(self, risen: f64) -> Bedding<'a> {
        Bedding { risen_later: self.risen_later + risen, ..self }
    }

    /// The height of the bottom of the sequence at a cell, with a factor of the uplift; `None` where there are no
    /// strata.
    #[inline]
    pub(crate) fn bottom(&self, c: usize, uplift_factor: f64) -> Option<f64> {
        let top = self.top.map_or(0.0, |top| f64::from(top.data()[c]));
        let bottom = top - self.strata.thickness() - self.risen_later * uplift_factor;
        bottom.is_finite().then_some(bottom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stratum(thickness: f64, erodibility_factor: f64, talus_angle: f64) -> Stratum {
        Stratum { thickness, erodibility_factor, talus_angle }
    }

    fn linear(drop: f64, cut: f64) -> f64 {
        drop / (1.0 + cut)
    }

    /// Three strata: 30 m on top of 5 m of hard rock on top of 65 m.
    fn three(repeats: bool) -> Strata {
        Strata::new(&[stratum(30.0, 1.0, 0.0), stratum(5.0, 0.01, 80.0), stratum(65.0, 2.0, 45.0)], repeats, 0.5)
            .unwrap()
    }

    #[test]
    fn strata_are_found_by_their_height() {
        let once = three(false);
        let of = |strata: &Strata, heights: &[f64]| heights.iter().map(|z| strata.index(*z)).collect::<Vec<_>>();
        assert_eq!(once.thickness(), 100.0);
        assert_eq!(of(&once, &[-50.0, 0.0, 64.9, 65.1, 69.9, 70.1, 500.0]), [2, 2, 2, 1, 1, 0, 0]);
        assert_eq!(of(&three(true), &[-31.0, -29.0, 64.9, 65.1, 101.0, 166.0, 171.0]), [1, 0, 2, 1, 2, 1, 0]);
        assert!(Strata::new(&[], true, 1.0).is_none());
    }

    #[test]
    fn erosion_does_the_work_of_all_strata() {
        // The resistance, summed in small steps.
        for strata in [three(false), three(true)] {
            let factor = |z: f64| [1.0, 0.01, 2.0][strata.index(z)];
            for (top, below) in [(95.0, 3.0), (71.0, 60.0), (230.0, -40.0), (20.0, 10.0)] {
                for cut in [1e-3, 0.2, 3.0, 500.0] {
                    let x = strata.eroded(top, below, [cut, 1.0], linear);
                    let steps = 100_000;
                    let dz = (top - below - x) / f64::from(steps);
                    let work: f64 = (0..steps).map(|k| dz / factor(below + x + (f64::from(k) + 0.5) * dz)).sum();
                    assert!((work - cut * x).abs() < 1e-3 * cut * x + 500.0 * dz, "{top} {below} {cut}: {x}");
                }
            }
        }
    }

    #[test]
    fn uniform_rock_is_as_without_strata() {
        let strata = Strata::new(&[stratum(7.0, 1.0, 0.0), stratum(13.0, 1.0, 0.0)], true, 0.5).unwrap();
        for (top, below, cut) in [(3.0, 1.0, 0.5), (900.0, -55.0, 20.0), (1e4, 0.0, 1e-9)] {
            let got = strata.eroded(top, below, [cut, 1.0], linear);
            let expect = linear(top - below, cut);
            assert!((got / expect - 1.0).abs() < 1e-9, "{got}, not {expect}");
            assert!((strata.stable(below, top) - 0.5 * top).abs() < 1e-6);
        }
        assert_eq!(strata.eroded(1.0, 5.0, [0.5, 1.0], linear), -4.0);
        assert_eq!(strata.eroded(f64::NAN, 5.0, [0.5, 1.0], linear), 0.0);
    }

    #[test]
    fn a_wall_is_as_steep_as_each_of_its_strata() {
        let strata = three(false);
        let cliff = 5.0 / libm::tan(80f64.to_radians());
        // 65 m at 45 degrees, the cliff, and 30 m of 0.5.
        assert!((strata.stable(0.0, 65.0 + cliff + 60.0) - 100.0).abs() < 1e-9);
        assert!((strata.stable(64.0, 1.0 + cliff / 2.0) - 3.5).abs() < 1e-9);
        assert!((three(true).stable(64.0, 1.0 + cliff + 60.0 + 5.0) - 41.0).abs() < 1e-9);
    }
}
