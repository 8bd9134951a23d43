//! Stream-power erosion and deposition with local rules.

use super::planes::{self, Pass, Planes};
use super::power::power;
use super::rows::{least, most, positive};
use crate::error::Result;
use crate::progress::Progress;
use crate::strata::Strata;
use orogen_simd::{Body, Simd, dispatch};

/// The stream power law with uplift and deposition, for all cells at once. After H. Schott, A. Paris, L. Fournier, E.
/// Guerin and E. Galin, "Large-scale terrain authoring through interactive erosion simulation" (2023), with the
/// deposition of X. P. Yuan, J. Braun, L. Guerit, D. Rouby and G. Cordonnier, "A new efficient method to solve the
/// stream power law model taking into account sediment deposition" (2019).
///
/// ```text
/// A' = l^2 + sum over higher neighbors of share A        share ~ slope^4 (multiple flow directions)
/// E  = dt K A'^m S^n / (1 + dt K A'^m S^(n-1) / l)        never below the lowest neighbor
/// D  = dt G Q / A'
/// Q  = sum over higher neighbors of share (Q + (E - D) l^2 / dt)
/// h' = h - E + D + dt (U + creep (d2h/dx2 + d2h/dy2))
/// ```
///
/// S is the upwind gradient, which is isotropic. The denominator makes the step stable for any dt: it is the implicit
/// step of Braun and Willett (2013) with the neighbor's old height. Water and sediment move one cell per iteration. To
/// include distant catchments, start with the drainage areas of a coarser solution. An iteration reads two cells on
/// each side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LocalStreamPower {
    /// Distance between samples, in metres.
    pub cell: f64,
    /// Years per iteration.
    pub years: f64,
    /// K, in m^(1 - 2 m) per year.
    pub erodibility: f64,
    /// m: exponent of the drainage area.
    pub area_exponent: f64,
    /// n: exponent of the slope.
    pub slope_exponent: f64,
    /// U: uplift, in metres per year.
    pub uplift: f64,
    /// G: deposition coefficient.
    pub deposition: f64,
    /// Soil creep: the diffusivity, in m^2 per year.
    pub creep: f64,
    /// Height of the sea in metres; cells at or below it do not change. `None` means no sea.
    pub sea_level: Option<f32>,
}

impl LocalStreamPower {
    /// The law for cells with this side in metres, without uplift and sea. The other fields have the defaults of the op
    /// `local-stream-power` (1e5 years in 50 iterations).
    #[must_use]
    pub const fn new(cell: f64) -> LocalStreamPower {
        LocalStreamPower {
            cell,
            years: 2000.0,
            erodibility: 2e-5,
            area_exponent: 0.45,
            slope_exponent: 1.0,
            uplift: 0.0,
            deposition: 0.5,
            creep: 0.005,
            sea_level: None,
        }
    }
}

orogen_noise::builder!(
    LocalStreamPower:
    with_cell(cell: f64),
    with_years(years: f64),
    with_erodibility(erodibility: f64),
    with_area_exponent(area_exponent: f64),
    with_slope_exponent(slope_exponent: f64),
    with_uplift(uplift: f64),
    with_deposition(deposition: f64),
    with_creep(creep: f64),
    with_sea_level(sea_level: Option<f32>)
);

/// Maximum creep per iteration, as a share of a squared cell: stable and without oscillation.
const FASTEST: f64 = 0.2;

/// The radius that an iteration reads, in cells.
pub const RADIUS: usize = 2;

/// Index of the plane of heights, in metres.
pub const HEIGHT: usize = 0;
/// Index of the plane of drainage areas, in m^2.
pub const AREA: usize = 1;
/// Index of the plane of the sediment that leaves a cell, in m^3 per year.
pub const SEDIMENT: usize = 2;
/// Index of the plane of the bottom of strata, in metres.
#[doc(hidden)]
pub const BOTTOM: usize = 3;

impl LocalStreamPower {
    /// The planes after `iterations`, smaller by [`RADIUS`] cells per iteration on each side.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn run(&self, planes: Planes<3>, iterations: usize, progress: &Progress) -> Result<Planes<3>> {
        planes::run(planes, iterations, &self.constants(), progress)
    }

    /// [`LocalStreamPower::run`] in strata. A fourth plane has the height of the bottom of their sequence before the
    /// first iteration, in metres; it rises with the ground. The implicit step of E becomes that of
    /// [`Strata`]. There are no strata where it is NaN.
    ///
    /// # Errors
    /// If the work is cancelled.
    #[doc(hidden)]
    pub fn run_in_strata(
        &self,
        strata: &Strata,
        planes: Planes<4>,
        iterations: usize,
        progress: &Progress,
    ) -> Result<Planes<4>> {
        planes::run(planes, iterations, &Layered { constants: self.constants(), strata }, progress)
    }

    /// The constants of an iteration, in the order of `Constants`.
    #[doc(hidden)]
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, f32); 11] {
        let c = self.constants();
        [
            ("per_side", c.per_side),
            ("per_corner", c.per_corner),
            ("cell_area", c.cell_area),
            ("cut_rate", c.cut),
            ("area_exponent", c.area_exponent),
            ("slope_exponent", c.slope_exponent),
            ("risen", c.risen),
            ("laid_rate", c.laid),
            ("step_years", c.years),
            ("spread", c.spread),
            // Avoids an infinite number, which not every reader can represent.
            ("sea_level", c.sea_level.max(f32::MIN)),
        ]
    }

    fn constants(&self) -> Constants {
        Constants {
            per_side: (1.0 / self.cell) as f32,
            per_corner: (std::f64::consts::FRAC_1_SQRT_2 / self.cell) as f32,
            cell_area: (self.cell * self.cell) as f32,
            cut: (self.years * self.erodibility) as f32,
            area_exponent: self.area_exponent as f32,
            slope_exponent: (self.slope_exponent - 1.0) as f32,
            risen: (self.years * self.uplift) as f32,
            laid: (self.years * self.deposition) as f32,
            years: self.years as f32,
            spread: ((self.years * self.creep / (self.cell * self.cell)).min(FASTEST) / 6.0) as f32,
            sea_level: self.sea_level.unwrap_or(f32::NEG_INFINITY),
        }
    }
}

/// The parameters in units of samples, for one iteration.
#[derive(Clone, Copy)]
struct Constants {
    per_side: f32,
    per_corner: f32,
    cell_area: f32,
    cut: f32,
    area_exponent: f32,
    slope_exponent: f32,
    risen: f32,
    laid: f32,
    years: f32,
    spread: f32,
    sea_level: f32,
}

impl Pass<3> for Constants {
    const RADIUS: usize = RADIUS;

    fn make(&self, from: &Planes<3>, to: &mut Planes<3>, scratch: &mut Vec<f32>) {
        // Three rows of two values, for all columns except the first and the last.
        scratch.resize(6 * (from.width() - 2), 0.0);
        dispatch(Rows { constants: self, from, to, scratch });
    }
}

struct Rows<'a> {
    constants: &'a Constants,
    from: &'a Planes<3>,
    to: &'a mut Planes<3>,
    scratch: &'a mut [f32],
}

impl Body for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let constants = self.constants;
        constants.rows(self.from, self.scratch, |j, heights, given| {
            constants.take(heights, given, self.to.row_mut(j), |_, _, rate, steep| constants.cut(rate, steep));
        });
    }
}

/// An iteration in strata.
struct Layered<'a> {
    constants: Constants,
    strata: &'a Strata,
}

impl Pass<4> for Layered<'_> {
    const RADIUS: usize = RADIUS;

    fn make(&self, from: &Planes<4>, to: &mut Planes<4>, scratch: &mut Vec<f32>) {
        scratch.resize(6 * (from.width() - 2), 0.0);
        let Layered { constants, strata } = self;
        constants.rows(from, scratch, |j, heights, given| {
            let [height, area, load, bottoms] = to.row_mut(j);
            let before = &from.row(j + RADIUS)[BOTTOM][RADIUS..];
            bottoms.iter_mut().zip(before).for_each(|(bottom, before)| *bottom = before + constants.risen);
            constants.take(heights, given, [height, area, load], |i, h, rate, steep| {
                let bottom = before[i];
                if !bottom.is_finite() {
                    return constants.cut(rate, steep);
                }
                // The drop to a neighbor with this slope.
                let drop = f64::from(steep / constants.per_side);
                let top = f64::from(h) - f64::from(bottom);
                let law = [f64::from(rate * constants.per_side), 1.0];
                (drop - strata.eroded(top, top - drop, law, |drop, cut| drop / (1.0 + cut))) as f32
            });
        });
    }
}

impl Constants {
    /// Calls `take` for each row of the result with the heights of three rows, and with what their cells give.
    /// `scratch` has room for three rows of two values.
    #[inline(always)]
    fn rows<const N: usize>(
        &self,
        from: &Planes<N>,
        scratch: &mut [f32],
        mut take: impl FnMut(usize, [&[f32]; 3], [&[f32]; 3]),
    ) {
        let wide = from.width() - 2;
        let mut rows = scratch.chunks_exact_mut(2 * wide);
        let ring: [&mut [f32]; 3] = std::array::from_fn(|_| rows.next().unwrap_or_default());
        for j in 0..from.height() - 2 {
            let three = [j, j + 1, j + 2].map(|row| from.row(row));
            // The amount that a cell of row j + 1 gives to a neighbor per unit of slope^4.
            let (areas, loads) = ring[j % 3].split_at_mut(wide);
            self.give(three.map(|row| row[HEIGHT]), [three[1][AREA], three[1][SEDIMENT]], [areas, loads]);
            if j >= 2 {
                let given = [j - 2, j - 1, j].map(|row| &*ring[row % 3]);
                let heights = [j - 1, j, j + 1].map(|row| from.row(row)[HEIGHT]);
                take(j - 2, heights, given);
            }
        }
    }

    /// The erosion on a slope, by the implicit step.
    #[inline(always)]
    fn cut(&self, rate: f32, steep: f32) -> f32 {
        rate * steep / (1.0 + rate * self.per_side)
    }

    /// The weight of a slope: its fourth power, or 0 uphill.
    #[inline(always)]
    fn weight(&self, drop: f32, per: f32) -> f32 {
        let slope = positive(drop) * per;
        let square = slope * slope;
        square * square
    }

    /// The amounts of area and sediment that the inner cells of a row give per unit of weight.
    #[inline(always)]
    fn give(&self, heights: [&[f32]; 3], [area, load]: [&[f32]; 2], [areas, loads]: [&mut [f32]; 2]) {
        let n = areas.len();
        let loads = &mut loads[..n];
        let [[nw, nc, ne], [w, c, e], [sw, sc, se]] = heights.map(|row| neighbors(row, n));
        let (area, load) = (&area[1..=n], &load[1..=n]);
        let (side, corner) = (self.per_side, self.per_corner);
        for i in 0..n {
            let h = c[i];
            let sides = (self.weight(h - nc[i], side) + self.weight(h - sc[i], side))
                + (self.weight(h - w[i], side) + self.weight(h - e[i], side));
            let corners = (self.weight(h - nw[i], corner) + self.weight(h - ne[i], corner))
                + (self.weight(h - sw[i], corner) + self.weight(h - se[i], corner));
            let all = sides + corners;
            // A pit has no outflow.
            let share = if all > 1e-24 { 1.0 / all } else { 0.0 };
            areas[i] = area[i] * share;
            loads[i] = load[i] * share;
        }
    }

    /// Adds the inflow to the cells of a row, then erodes and deposits. `cut_of` is the erosion at a column by its
    /// height, the rate and the slope.
    #[inline(always)]
    fn take(
        &self,
        heights: [&[f32]; 3],
        given: [&[f32]; 3],
        [height, area, load]: [&mut [f32]; 3],
        cut_of: impl Fn(usize, f32, f32, f32) -> f32,
    ) {
        let n = height.len();
        let (area, load) = (&mut area[..n], &mut load[..n]);
        let [[nw, nc, ne], [w, c, e], [sw, sc, se]] = heights.map(|row| neighbors(&row[1..], n));
        let halves = given.map(|row| row.split_at(row.len() / 2));
        let [[a_nw, a_n, a_ne], [a_w, _, a_e], [a_sw, a_s, a_se]] = halves.map(|(areas, _)| neighbors(areas, n));
        let [[q_nw, q_n, q_ne], [q_w, _, q_e], [q_sw, q_s, q_se]] = halves.map(|(_, loads)| neighbors(loads, n));
        let (side, corner) = (self.per_side, self.per_corner);
        for i in 0..n {
            let h = c[i];
            let (w_n, w_s) = (self.weight(nc[i] - h, side), self.weight(sc[i] - h, side));
            let (w_w, w_e) = (self.weight(w[i] - h, side), self.weight(e[i] - h, side));
            let (w_nw, w_ne) = (self.weight(nw[i] - h, corner), self.weight(ne[i] - h, corner));
            let (w_sw, w_se) = (self.weight(sw[i] - h, corner), self.weight(se[i] - h, corner));
            let drained = self.cell_area
                + (((w_n * a_n[i] + w_s * a_s[i]) + (w_w * a_w[i] + w_e * a_e[i]))
                    + ((w_nw * a_nw[i] + w_ne * a_ne[i]) + (w_sw * a_sw[i] + w_se * a_se[i])));
            let came = ((w_n * q_n[i] + w_s * q_s[i]) + (w_w * q_w[i] + w_e * q_e[i]))
                + ((w_nw * q_nw[i] + w_ne * q_ne[i]) + (w_sw * q_sw[i] + w_se * q_se[i]));
            let across = positive(h - least(w[i], e[i])) * side;
            let down = positive(h - least(nc[i], sc[i])) * side;
            let steep = (across * across + down * down).sqrt();
            let lowest =
                least(least(least(nw[i], ne[i]), least(sw[i], se[i])), least(least(nc[i], sc[i]), least(w[i], e[i])));
            let mut rate = self.cut * power(drained, self.area_exponent);
            if self.slope_exponent != 0.0 {
                rate *= power(most(steep, 1e-12), self.slope_exponent);
            }
            let cut = least(cut_of(i, h, rate, steep), positive(h - lowest));
            // At most the inflow is deposited, and nothing on cells above their surroundings.
            let all = came * self.years / self.cell_area;
            let mean = 0.25 * ((nc[i] + sc[i]) + (w[i] + e[i]));
            let hollow = positive(mean - (h - cut));
            let laid = least(least(self.laid * came / drained, all), hollow + cut);
            // The nine-point Laplacian, whose error is isotropic.
            let sides = (nc[i] - h) + (sc[i] - h) + (w[i] - h) + (e[i] - h);
            let corners = (nw[i] - h) + (ne[i] - h) + (sw[i] - h) + (se[i] - h);
            let crept = self.spread * (4.0 * sides + corners);
            let land = h > self.sea_level;
            let settled = (h - cut) + ((laid + crept) + self.risen);
            height[i] = if land { settled } else { h };
            area[i] = drained;
            load[i] = positive(came + (cut - laid) * self.cell_area / self.years);
        }
    }
}

/// The western, central and eastern neighbors of `n` columns, starting with the second.
#[inline(always)]
fn neighbors(row: &[f32], n: usize) -> [&[f32]; 3] {
    [&row[..n], &row[1..=n], &row[2..n + 2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Grid, Window};
    use crate::strata::Stratum;

    fn law() -> LocalStreamPower {
        LocalStreamPower {
            cell: 20.0,
            years: 2000.0,
            erodibility: 2e-5,
            area_exponent: 0.45,
            slope_exponent: 1.0,
            uplift: 0.0,
            deposition: 0.5,
            creep: 0.0,
            sea_level: None,
        }
    }

    fn planes(window: Window, height: impl Fn(f64, f64) -> f64) -> Planes<3> {
        let mut planes = Planes::new(window.width, window.height);
        for j in 0..window.height {
            let [heights, areas, _] = planes.row_mut(j);
            for (i, h) in heights.iter_mut().enumerate() {
                *h = height(window.east(i), window.south(j)) as f32;
            }
            areas.fill((window.cell * window.cell) as f32);
        }
        planes
    }

    fn run(law: &LocalStreamPower, from: Planes<3>, iterations: usize, to: Window) -> [Grid; 3] {
        let done = law.run(from, iterations, &Progress::none()).unwrap();
        [HEIGHT, AREA, SEDIMENT].map(|plane| done.grid(plane, to))
    }

    #[test]
    fn on_a_plane_each_iteration_brings_the_area_of_another_cell() {
        // Along the rows, along the columns, and in between: the upstream area of a strip one cell wide.
        let iterations = 12;
        let window = Window::new(9, 7, 20.0);
        for (east, south) in [(0.2, 0.0), (0.0, -0.3), (0.15, 0.1), (0.2, 0.2)] {
            let law = LocalStreamPower { erodibility: 0.0, ..law() };
            let from = planes(window.grown(iterations * RADIUS), |x, y| 500.0 - east * x - south * y);
            let [height, area, sediment] = run(&law, from.clone(), iterations, window);
            let before = from.grid(HEIGHT, window.grown(iterations * RADIUS)).crop(&window).unwrap();
            assert_eq!(height, before, "nothing is cut and nothing laid");
            // On a plane every cell passes on its whole value, and receives the same value.
            let expect = 400.0 * (iterations + 1) as f32;
            assert!(area.data().iter().all(|a| (a / expect - 1.0).abs() < 1e-3), "{} {expect}", area[(4, 4)]);
            assert!(sediment.data().iter().all(|q| *q == 0.0));
        }
    }

    #[test]
    fn it_cuts_no_pits_and_is_stable_for_any_step() {
        let rough = |x: f64, y: f64| {
            800.0
                + 100.0 * libm::sin(x / 200.0) * libm::cos(y / 150.0)
                + (x * 1.37 + y * 0.71).rem_euclid(13.0) * (y * 0.93 - x * 0.37).rem_euclid(11.0) / 10.0
        };
        let iterations = 15;
        let window = Window::new(40, 40, 20.0);
        for years in [100.0, 1e5, 1e9] {
            let law = LocalStreamPower { years, slope_exponent: if years > 1e6 { 2.0 } else { 1.0 }, ..law() };
            let from = planes(window.grown(iterations * RADIUS), rough);
            let before = from.grid(HEIGHT, window.grown(iterations * RADIUS));
            let (low, high) = before.data().iter().fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
            let [height, area, sediment] = run(&law, from, iterations, window);
            assert!(height.data().iter().all(|h| (low..=high).contains(h)), "{years}");
            assert_ne!(height, before.crop(&window).unwrap());
            assert!(area.data().iter().all(|a| *a >= 400.0 && a.is_finite()));
            assert!(sediment.data().iter().all(|q| *q >= 0.0 && q.is_finite()));
        }
    }

    #[test]
    fn uplift_raises_land_and_leaves_the_sea() {
        let iterations = 4;
        let window = Window::new(20, 20, 20.0);
        let law = LocalStreamPower { uplift: 1e-3, erodibility: 0.0, sea_level: Some(0.0), ..law() };
        let from = planes(window.grown(iterations * RADIUS), |x, _| if x < 200.0 { -5.0 } else { 5.0 });
        let [height, ..] = run(&law, from, iterations, window);
        for (i, h) in height.row(7).iter().enumerate() {
            let expect = if i < 10 { -5.0 } else { 13.0 };
            assert!((h - expect).abs() < 1e-4, "{i}: {h}");
        }
    }

    #[test]
    fn hard_strata_stand_and_even_strata_change_nothing() {
        let iterations = 20;
        let window = Window::new(60, 40, 20.0);
        let hills = |x: f64, y: f64| 300.0 + 80.0 * libm::sin(x / 170.0) * libm::cos(y / 130.0) + 0.1 * x;
        let from = planes(window.grown(iterations * RADIUS), hills);
        let run_in = |strata: &[Stratum], bottom: f32| {
            let strata = Strata::new(strata, false, 1.0).unwrap();
            let mut layered = Planes::<4>::new(from.width(), from.height());
            for j in 0..from.height() {
                for (to, row) in layered.row_mut(j).into_iter().zip(from.row(j)) {
                    to.copy_from_slice(row);
                }
                layered.row_mut(j)[BOTTOM].fill(bottom);
            }
            law().run_in_strata(&strata, layered, iterations, &Progress::none()).unwrap().grid(HEIGHT, window)
        };
        let stratum =
            |thickness: f64, erodibility_factor: f64| Stratum { thickness, erodibility_factor, ..Stratum::default() };
        let [plain, ..] = run(&law(), from.clone(), iterations, window);
        let before = from.grid(HEIGHT, window.grown(iterations * RADIUS)).crop(&window).unwrap();
        let off =
            |a: &Grid, b: &Grid| a.data().iter().zip(b.data()).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>();
        let even = run_in(&[stratum(10.0, 1.0), stratum(7.0, 1.0)], 250.0);
        assert!(off(&plain, &even) < 1e-3 * off(&plain, &before), "{} {}", off(&plain, &even), off(&plain, &before));
        assert_eq!(run_in(&[stratum(10.0, 0.001)], f32::NAN), plain, "no strata without a datum");
        // Ground above a hard stratum is eroded down to it, and it stays.
        let hard = run_in(&[stratum(500.0, 40.0), stratum(400.0, 0.001)], -100.0);
        let cut = |above: f32, grid: &Grid| {
            let cells = before.data().iter().zip(grid.data()).filter(|(before, _)| (**before > 300.0) == (above > 0.0));
            cells.map(|(before, after)| f64::from((before - after).max(0.0))).sum::<f64>()
        };
        assert!(cut(1.0, &hard) > 2.0 * cut(1.0, &plain) && cut(-1.0, &hard) < 0.3 * cut(-1.0, &plain));
    }
}
