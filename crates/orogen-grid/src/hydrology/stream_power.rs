//! The stream power law with uplift, solved implicitly.
//!
//! ```text
//! dh/dt = U - K A^m S^n        S = (h - h_receiver) / d
//! ```
//!
//! where U is the uplift (m/yr), K the erodibility, A the drainage area (m^2) and S the slope along the flow path. A
//! step of dt years follows Braun and Willett, "A very efficient O(n), implicit and parallel method to solve the stream
//! power equation governing fluvial incision and landscape evolution" (2013). Receivers are solved first, so that their
//! new heights are known to their donors. For n = 1
//!
//! ```text
//! h' = (h + dt U + F h'_receiver) / (1 + F)        F = K dt A^m / d
//! ```
//!
//! which is stable for any dt; other n use Newton's method. The same sweep limits slopes: no cell is steeper above its
//! receiver than the landslide limit, nor less steep than the minimum slope. Where the path out of a depression leads
//! uphill, the ground is raised with sediment until water drains.

use super::accumulation::{Accumulation, UNIT_WEIGHT};
use super::direction::{DISTANCES, strides};
use super::points::Points;
use super::receivers::Receivers;
use crate::checks::{checks, never, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;
use crate::strata::{Bedding, Strata};

/// Parameters of the stream power law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StreamPower {
    /// K, in m^(1 - 2 m) per year: 1e-6 for hard rock to 5e-5 for soft.
    pub erodibility: f64,
    /// m: exponent of the drainage area, 0.3 to 0.6.
    pub area_exponent: f64,
    /// n: exponent of the slope, 0.5 to 3.
    pub slope_exponent: f64,
    /// U: uplift, in metres per year.
    pub uplift: f64,
    /// Maximum slope, rise over run; steeper ground slides.
    pub max_slope: f64,
    /// Minimum slope, rise over run, of ground that is filled with sediment.
    pub min_slope: f64,
}

orogen_noise::builder!(
    StreamPower:
    with_erodibility(erodibility: f64),
    with_area_exponent(area_exponent: f64),
    with_slope_exponent(slope_exponent: f64),
    with_uplift(uplift: f64),
    with_max_slope(max_slope: f64),
    with_min_slope(min_slope: f64)
);

impl Default for StreamPower {
    /// Erodibility 2e-5, exponents 0.45 and 1, uplift 0.2 mm per year, slopes from 1e-4 to 1.2.
    fn default() -> StreamPower {
        StreamPower {
            erodibility: 2e-5,
            area_exponent: 0.45,
            slope_exponent: 1.0,
            uplift: 2e-4,
            max_slope: 1.2,
            min_slope: 1e-4,
        }
    }
}

/// Spatial variation of the law's parameters, as factors on the grid of the heights.
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct Substrate<'a> {
    /// Factor of the erodibility; `None` means 1 everywhere. Negative values count as 0.
    pub erodibility_factor: Option<&'a Grid>,
    /// Factor of the uplift; `None` means 1 everywhere.
    pub uplift_factor: Option<&'a Grid>,
    /// Factor of the rain, 0.01 to 100; `None` means 1 everywhere. A run of the law weights drainage areas with it. A
    /// single step uses the given [discharge](Accumulation::discharge) instead.
    pub rain: Option<&'a Grid>,
    /// Positions of the cells, which determine the distances to receivers; `None` means the lattice.
    pub points: Option<&'a Points>,
    /// Layers of rock; `None` means the same rock at all heights.
    #[doc(hidden)]
    pub bedding: Option<Bedding<'a>>,
}

impl<'a> Substrate<'a> {
    /// Sets the factor of the erodibility.
    #[must_use]
    pub const fn with_erodibility_factor(self, factor: Option<&'a Grid>) -> Substrate<'a> {
        Substrate { erodibility_factor: factor, ..self }
    }

    /// Sets the factor of the uplift.
    #[must_use]
    pub const fn with_uplift_factor(self, factor: Option<&'a Grid>) -> Substrate<'a> {
        Substrate { uplift_factor: factor, ..self }
    }

    /// Sets the factor of the rain.
    #[must_use]
    pub const fn with_rain(self, factor: Option<&'a Grid>) -> Substrate<'a> {
        Substrate { rain: factor, ..self }
    }

    /// Sets the positions of the cells.
    #[must_use]
    pub const fn with_points(self, points: Option<&'a Points>) -> Substrate<'a> {
        Substrate { points, ..self }
    }

    /// Sets the layers of rock.
    #[doc(hidden)]
    #[must_use]
    pub const fn with_bedding(self, bedding: Option<Bedding<'a>>) -> Substrate<'a> {
        Substrate { bedding, ..self }
    }
}

impl StreamPower {
    /// Advances the heights by `years`. Cells without a receiver (outlets) keep their heights.
    ///
    /// If `drained` has a discharge, it replaces the drainage area. Afterwards every cell with a receiver is higher
    /// than its receiver, so the result has no depressions and no flats. The time is O(cells), on as many threads as
    /// `drained` was computed with.
    pub fn step(
        &self,
        heights: &mut Grid,
        receivers: &Receivers,
        drained: &Accumulation,
        ground: &Substrate,
        years: f64,
    ) {
        let Ok(()) = self.solve(heights, receivers, drained, ground, years, &never);
    }

    /// [`StreamPower::step`] with progress and cancellation.
    ///
    /// # Errors
    /// If the work is cancelled. Only some of the cells have then advanced.
    pub fn step_with(
        &self,
        heights: &mut Grid,
        receivers: &Receivers,
        drained: &Accumulation,
        ground: &Substrate,
        years: f64,
        progress: &Progress,
    ) -> error::Result<()> {
        let check = steps(progress, checks(heights.window().len()));
        self.solve(heights, receivers, drained, ground, years, &check)
    }

    fn solve<E: Send>(
        &self,
        heights: &mut Grid,
        receivers: &Receivers,
        drained: &Accumulation,
        ground: &Substrate,
        years: f64,
        check: &(impl Fn() -> Result<(), E> + Sync),
    ) -> Result<(), E> {
        let step = Step::new(self, receivers, drained, ground, years);
        drained.downstream(receivers, heights, check, |c, before, receiver| step.height(c, before, receiver))
    }
}

/// The parts of a step that are common to all cells.
pub(super) struct Step<'a> {
    codes: &'a [u8],
    area: &'a [u32],
    discharge: Option<&'a [u64]>,
    erodibility_factor: Option<&'a [f32]>,
    uplift_factor: Option<&'a [f32]>,
    powers: Powers,
    pub(super) slope_exponent: f64,
    /// For each direction: the product of years, erodibility and distance to the power -n, and the minimum and maximum
    /// height above the receiver.
    factors: [[f64; 3]; 8],
    /// The irregular points, and the strides of the directions.
    points: Option<(&'a Points, [isize; 8])>,
    /// Uplift of the step, in metres.
    risen: f64,
    bedding: Option<Bedding<'a>>,
    /// Whether slopes have a maximum.
    is_limited: bool,
    cell: f64,
}

impl<'a> Step<'a> {
    pub(super) fn new(
        law: &StreamPower,
        receivers: &'a Receivers,
        drained: &'a Accumulation,
        ground: &'a Substrate,
        years: f64,
    ) -> Step<'a> {
        let cell = receivers.window().cell;
        let factors = |d: f64| {
            let factor = years * law.erodibility * libm::pow(d, -law.slope_exponent);
            [factor, d * law.min_slope, d * law.max_slope]
        };
        // The factors depend on the distance. With irregular points they are computed once the receiver is known.
        let factors = match ground.points {
            None => DISTANCES.map(|distance| factors(distance * cell)),
            Some(_) => [factors(cell); 8],
        };
        Step {
            codes: receivers.codes(),
            area: drained.area.data(),
            discharge: drained.discharge.as_ref().map(Grid::data),
            erodibility_factor: ground.erodibility_factor.map(Grid::data),
            uplift_factor: ground.uplift_factor.map(Grid::data),
            powers: Powers::new(law.area_exponent, cell * cell),
            slope_exponent: law.slope_exponent,
            factors,
            points: ground.points.map(|points| (points, strides(receivers.window().width))),
            risen: years * law.uplift,
            bedding: ground.bedding,
            is_limited: law.max_slope.is_finite(),
            cell,
        }
    }

    /// The height of cell `c` after the step, from its previous height and the receiver's new height.
    #[inline(always)]
    fn height(&self, c: usize, before: f32, receiver: f32) -> f32 {
        let terms = self.terms(c);
        let below = f64::from(receiver);
        let above = f64::from(before) + terms.risen - below;
        let [left, most] = self.left(&terms, above, below, terms.cut);
        // A landslide limit below the minimum slope is raised to it. NaN counts as the limit, as with `min`.
        let left = if left < most { left } else { most };
        drained(below + if left > terms.least { left } else { terms.least }, receiver)
    }

    /// What the law has for cell `c`.
    #[inline(always)]
    pub(super) fn terms(&self, c: usize) -> Terms<'_> {
        let code = self.codes[c] & 7;
        let [mut factor, mut least, mut most] = self.factors[usize::from(code)];
        let mut away = DISTANCES[usize::from(code)];
        if let Some((points, strides)) = &self.points {
            let inverse_distance = f64::from(points.inverse_distance(c, code, strides));
            away = 1.0 / inverse_distance;
            factor *= if self.slope_exponent == 1.0 {
                inverse_distance
            } else {
                libm::pow(inverse_distance, self.slope_exponent)
            };
            (least, most) = (least * away, most * away);
        }
        let erodibility_factor = self.erodibility_factor.map_or(1.0, |factors| f64::from(factors[c]).max(0.0));
        let power = match self.discharge {
            Some(discharge) => self.powers.of_discharge(discharge[c]),
            None => self.powers.of(self.area[c]),
        };
        let uplift_factor = self.uplift_factor(c);
        let cut = factor * erodibility_factor * power;
        let bottom = self.bedding.and_then(|bedding| Some((bedding.strata, bedding.bottom(c, uplift_factor)?)));
        Terms { cut, least, most, risen: self.risen * uplift_factor, bottom, away: away * self.cell }
    }

    #[inline(always)]
    fn uplift_factor(&self, c: usize) -> f64 {
        self.uplift_factor.map_or(1.0, |factors| f64::from(factors[c]))
    }

    /// The water that drains through cell `c`, in cells.
    #[inline(always)]
    pub(super) fn water(&self, c: usize) -> f64 {
        match self.discharge {
            Some(discharge) => discharge[c] as f64 / f64::from(UNIT_WEIGHT),
            None => f64::from(self.area[c]),
        }
    }

    /// The drop that remains after the step of a drop to a receiver of the height `below`, and its maximum.
    #[inline(always)]
    pub(super) fn left(&self, terms: &Terms, above: f64, below: f64, cut: f64) -> [f64; 2] {
        match terms.bottom {
            None => [self.left_of(above, cut), terms.most],
            Some((strata, bottom)) => {
                let foot = below - bottom;
                let most = if self.is_limited { strata.stable(foot, terms.away) } else { terms.most };
                let law = [cut, self.slope_exponent];
                [strata.eroded(foot + above, foot, law, |above, cut| self.left_of(above, cut)), most]
            }
        }
    }

    /// [`Step::left`] of uniform rock.
    #[inline(always)]
    fn left_of(&self, above: f64, cut: f64) -> f64 {
        if self.slope_exponent == 1.0 { above / (1.0 + cut) } else { solve_newton(above, cut, self.slope_exponent) }
    }
}

/// What the law has for a cell.
pub(super) struct Terms<'a> {
    /// The coefficient of the equation for the drop x that remains of a drop: x + cut x^n = drop.
    pub cut: f64,
    /// The minimum height above the receiver.
    pub least: f64,
    /// The maximum height above the receiver, without strata.
    most: f64,
    /// Uplift of the step, in metres.
    pub risen: f64,
    /// The layers of rock, and their bottom.
    bottom: Option<(&'a Strata, f64)>,
    /// The distance to the receiver, in metres.
    pub away: f64,
}

/// A height as f32 that is above the receiver's. In f32 the minimum slope may be rounded away, but the cell must drain.
#[inline(always)]
pub(super) fn drained(height: f64, receiver: f32) -> f32 {
    let new = height as f32;
    if new > receiver { new } else { receiver.next_up() }
}

/// Solves x + cut x^n = above for x, the remaining drop after the step, where n is not 1.
///
/// Newton's method on a convex form, starting above the root: it converges monotonically.
#[inline(never)]
fn solve_newton(above: f64, cut: f64, n: f64) -> f64 {
    if above <= 0.0 || !(above + cut).is_finite() {
        return above.min(0.0);
    }
    // x + cut x^n is convex for n > 1; with y = x^n, y^(1/n) + cut y is convex for n < 1.
    let (power, linear, bent) = if n > 1.0 { (n, 1.0, cut) } else { (1.0 / n, cut, 1.0) };
    let mut x = if n > 1.0 { above } else { libm::pow(above, n) };
    for _ in 0..60 {
        let bend = bent * libm::pow(x, power - 1.0);
        let over = linear * x + bend * x - above;
        let next = x - over / (linear + power * bend);
        if next >= x || next <= 0.0 {
            break;
        }
        x = next;
    }
    if n > 1.0 { x } else { libm::pow(x, 1.0 / n) }
}

/// Drainage areas to the power m. Few cells drain large areas, so nearly all values come from a table.
struct Powers {
    exponent: f64,
    cell_area: f64,
    known: Vec<f64>,
}

impl Powers {
    fn new(exponent: f64, cell_area: f64) -> Powers {
        let known = (0..4096).map(|cells| libm::pow(f64::from(cells) * cell_area, exponent)).collect();
        Powers { exponent, cell_area, known }
    }

    #[inline]
    fn of(&self, cells: u32) -> f64 {
        match self.known.get(cells as usize) {
            Some(power) => *power,
            None => libm::pow(f64::from(cells) * self.cell_area, self.exponent),
        }
    }

    /// The power for a sum of weights. The same as for whole cells where the rain factor is 1.
    #[inline(never)]
    fn of_discharge(&self, weight: u64) -> f64 {
        libm::pow(weight as f64 * (self.cell_area / f64::from(UNIT_WEIGHT)), self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{drainage, samples};

    #[test]
    fn settling_solves_the_equation() {
        for n in [0.5, 0.8, 1.5, 2.0, 3.0] {
            for cut in [0.0, 1e-6, 0.3, 40.0, 1e5] {
                for above in [1e-3, 1.0, 700.0] {
                    let x = solve_newton(above, cut, n);
                    let got = x + cut * libm::pow(x, n);
                    assert!((got - above).abs() < 1e-9 * above, "n {n}, cut {cut}, above {above}: {x} gives {got}");
                }
            }
            assert_eq!(solve_newton(-3.0, 1.0, n), -3.0);
        }
    }

    /// A valley one cell wide that drains to the east, between walls that drain elsewhere.
    fn valley(length: usize, cell: f64) -> (Grid, Receivers) {
        let window = Window::new(length, 3, cell);
        let mut receivers = Receivers::none(window);
        receivers.codes_mut()[length + 1..2 * length - 1].fill(0);
        (Grid::filled(window, 0.0), receivers)
    }

    #[test]
    fn a_river_comes_to_its_steady_profile() {
        // In equilibrium of uplift and incision, S = (U / K)^(1/n) A^(-m/n) at every cell (Whipple and Tucker 1999).
        for (m, n) in [(0.45, 1.0), (0.5, 1.0), (0.9, 2.0), (0.4, 0.8)] {
            let (mut heights, receivers) = valley(60, 100.0);
            let drained = accumulate(&receivers);
            let law = StreamPower {
                area_exponent: m,
                slope_exponent: n,
                max_slope: 1e9,
                min_slope: 0.0,
                ..Default::default()
            };
            for _ in 0..400 {
                law.step(&mut heights, &receivers, &drained, &Substrate::default(), 1e5);
            }
            for c in 61..118 {
                let slope = f64::from(heights.data()[c] - heights.data()[c + 1]) / 100.0;
                let area = f64::from(drained.area.data()[c]) * 1e4;
                let expect = libm::pow(law.uplift / law.erodibility, 1.0 / n) * libm::pow(area, -m / n);
                assert!((slope / expect - 1.0).abs() < 2e-3, "m {m}, n {n}, cell {c}: {slope}, not {expect}");
            }
        }
    }

    #[test]
    fn one_step_is_the_equation() {
        let (mut heights, receivers) = valley(5, 10.0);
        heights.row_mut(1).copy_from_slice(&[0.0, 30.0, 20.0, 12.0, 5.0]);
        let drained = accumulate(&receivers);
        let (erodibility_factor, uplift_factor) =
            (Grid::filled(*heights.window(), 0.5), Grid::filled(*heights.window(), 3.0));
        let law = StreamPower { erodibility: 1e-3, area_exponent: 0.5, uplift: 1e-3, ..Default::default() };
        law.step(
            &mut heights,
            &receivers,
            &drained,
            &Substrate {
                erodibility_factor: Some(&erodibility_factor),
                uplift_factor: Some(&uplift_factor),
                ..Substrate::default()
            },
            100.0,
        );
        // F = 0.5 * 1e-3 * 100 * (cells * 100 m^2)^0.5 / 10 m = 0.05 sqrt(cells); 0.3 m of uplift.
        let mut below = 5.0;
        for (c, (h, cells)) in [(3, (12.0, 3.0f64)), (2, (20.0, 2.0)), (1, (30.0, 1.0))] {
            let f = 0.05 * cells.sqrt();
            below = ((h + 0.3 + f * below) / (1.0 + f)).min(below + 12.0);
            assert!((f64::from(heights.row(1)[c]) - below).abs() < 1e-4, "{:?}", heights.row(1));
        }
        assert_eq!(heights.row(1)[4], 5.0, "the outlet stays");
    }

    #[test]
    fn what_is_left_drains_as_it_did_and_nothing_is_too_steep() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let receivers = drainage::route_carving(&heights, &outlets, Descent::Steepest).receivers;
            let drained = accumulate(&receivers);
            let mut eroded = heights.clone();
            let law = StreamPower { max_slope: 0.9, min_slope: 1e-3, ..Default::default() };
            law.step(&mut eroded, &receivers, &drained, &Substrate::default(), 1000.0);
            for c in 0..heights.data().len() {
                let (h, receiver) = (eroded.data()[c], receivers.of(c));
                if receiver == c {
                    assert!(h == heights.data()[c] || h.is_nan());
                    continue;
                }
                let slope = f64::from(h - eroded.data()[receiver]) / DISTANCES[usize::from(receivers.code(c))];
                assert!(h > eroded.data()[receiver] && slope < 0.9 + 1e-3, "{slope}");
            }
            let again = super::super::steepest::receivers(&eroded, &outlets, Descent::Steepest);
            let pits = (0..again.codes().len()).filter(|c| !outlets.at(*c) && again.of(*c) == *c).count();
            assert_eq!(pits, 0);
        }
    }

    #[test]
    fn hard_rock_stands_and_soft_rock_goes() {
        let heights = samples::hills(48, 40, 1);
        let receivers = drainage::route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
        let drained = accumulate(&receivers);
        let mean = |erodibility_factor: f32| {
            let (mut eroded, erodibility_factor) =
                (heights.clone(), Grid::filled(*heights.window(), erodibility_factor));
            let law = StreamPower { max_slope: 1e9, ..Default::default() };
            law.step(
                &mut eroded,
                &receivers,
                &drained,
                &Substrate { erodibility_factor: Some(&erodibility_factor), ..Substrate::default() },
                3e4,
            );
            eroded.data().iter().map(|h| f64::from(*h)).sum::<f64>()
        };
        assert!(mean(0.1) > mean(1.0) && mean(1.0) > mean(10.0) && mean(-5.0) == mean(0.0));
    }
}
