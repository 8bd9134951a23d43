//! Statistics of drainage networks.
//!
//! Each statistic is the slope of a least-squares line through the logarithms of classes; `None` if fewer than four
//! classes have members.

use super::accumulation::Accumulation;
use super::direction::DISTANCES;
use super::receivers::Receivers;
use crate::grid::Grid;

/// Number of classes of drainage area.
const CLASSES: usize = 12;

/// The exponent t of P(area > a) ~ a^-t (Rodriguez-Iturbe and Rinaldo 1997), fitted from 8 cells to a hundredth of the
/// map. Real terrain has 0.43 to 0.58.
#[must_use]
pub fn area_exponent(drained: &Accumulation) -> Option<f64> {
    let mut counts = AreaCounts::new(drained.area.data().len());
    counts.add(drained.area.data());
    counts.exponent()
}

/// Counts of cells by drainage area, for [`area_exponent`].
#[derive(Debug, Clone)]
pub struct AreaCounts {
    cells: usize,
    bounds: Vec<f64>,
    above: Vec<usize>,
}

impl AreaCounts {
    /// Empty counts for a map of `cells` cells.
    #[must_use]
    pub fn new(cells: usize) -> AreaCounts {
        let bounds = spaced(8.0, cells as f64 / 100.0, 14).unwrap_or_default();
        AreaCounts { cells, above: vec![0; bounds.len()], bounds }
    }

    /// Counts cells with these drainage areas, in cells.
    pub fn add(&mut self, areas: &[u32]) {
        for (bound, above) in self.bounds.iter().zip(&mut self.above) {
            *above += areas.iter().filter(|area| f64::from(**area) > *bound).count();
        }
    }

    /// The exponent, after all cells were counted.
    #[must_use]
    pub fn exponent(&self) -> Option<f64> {
        let counted = self.bounds.iter().zip(&self.above).filter(|(_, above)| **above > 0);
        let points = counted.map(|(bound, above)| (libm::log(*bound), libm::log(*above as f64 / self.cells as f64)));
        Some(-line(&points.collect::<Vec<_>>())?)
    }
}

/// The exponent h of Hack's law, L ~ A^h (Hack 1957), where L is the longest flow path to a cell and A its area, over
/// cells that drain at least `threshold` cells. Real rivers have 0.5 to 0.6.
#[must_use]
pub fn hack_exponent(receivers: &Receivers, drained: &Accumulation, threshold: u32) -> Option<f64> {
    let ways = longest_ways(receivers, drained);
    let areas = drained.area.data();
    let mut classes = AreaClasses::new(threshold, areas.iter().copied().max()?, Average::Median)?;
    areas.iter().zip(&ways).for_each(|(area, way)| classes.add(*area, way.length()));
    classes.slope()
}

/// The concavity of rivers: theta of S ~ A^-theta (Flint 1974), where S is the slope along the flow path on `filled`.
/// For rivers in equilibrium with uplift it is m / n, 0.4 to 0.6.
#[must_use]
pub fn concavity(filled: &Grid, receivers: &Receivers, drained: &Accumulation, threshold: u32) -> Option<f64> {
    let cell = filled.window().cell;
    let areas = drained.area.data();
    let mut classes = AreaClasses::new(threshold, areas.iter().copied().max()?, Average::Mean)?;
    for (c, area) in areas.iter().enumerate() {
        let receiver = receivers.of(c);
        if receiver != c {
            classes.add(*area, drop_per_metre(filled.data()[c], filled.data()[receiver], receivers.code(c), cell));
        }
    }
    Some(-classes.slope()?)
}

/// The slope of the water surface from a cell to its receiver in direction `code`, in metres per metre.
#[must_use]
pub fn drop_per_metre(height: f32, receiver: f32, code: u8, cell: f64) -> f64 {
    f64::from(height - receiver) / (DISTANCES[usize::from(code & 7)] * cell)
}

/// The length of a flow path as the numbers of axial and diagonal steps. These are integers, so that the sum does not
/// depend on the starting point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Way {
    straight: u32,
    diagonal: u32,
}

impl Way {
    /// The path with one more step in direction `code`.
    #[must_use]
    pub fn step(self, code: u8) -> Way {
        let diagonal = u32::from(code & 1);
        Way { straight: self.straight + 1 - diagonal, diagonal: self.diagonal + diagonal }
    }

    /// The path followed by `next`.
    #[must_use]
    pub fn then(self, next: Way) -> Way {
        Way { straight: self.straight + next.straight, diagonal: self.diagonal + next.diagonal }
    }

    /// The length, in cells.
    #[must_use]
    pub fn length(self) -> f64 {
        f64::from(self.straight) + f64::from(self.diagonal) * std::f64::consts::SQRT_2
    }

    /// The longer one of two paths. The lengths of two different paths of fewer than 2^20 steps differ by more than the
    /// rounding error.
    #[must_use]
    pub fn longer(self, other: Way) -> Way {
        if other.length() > self.length() { other } else { self }
    }
}

/// The longest flow path to each cell.
#[doc(hidden)]
#[must_use]
pub fn longest_ways(receivers: &Receivers, drained: &Accumulation) -> Vec<Way> {
    let mut ways = vec![Way::default(); drained.area.data().len()];
    for c in drained.upstream_first() {
        let receiver = receivers.of(c);
        if receiver != c {
            ways[receiver] = ways[receiver].longer(ways[c].step(receivers.code(c)));
        }
    }
    ways
}

/// The average of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Average {
    /// The median; for an even count, the upper one of the middle two values.
    Median,
    /// The arithmetic mean.
    Mean,
}

/// Averages of cell values in classes of drainage area, from a threshold to half the largest area, and the line through
/// their logarithms.
#[derive(Debug, Clone)]
pub struct AreaClasses {
    average: Average,
    bounds: Vec<f64>,
    classes: Vec<Class>,
}

#[derive(Debug, Clone, Default)]
struct Class {
    count: usize,
    logarithms: f64,
    /// Sum of the values, for the mean.
    sum: f64,
    /// The values, for the median.
    values: Vec<f64>,
}

impl AreaClasses {
    /// Empty classes for areas from `threshold` to half of `largest`, in cells; `None` if the range is empty.
    #[must_use]
    pub fn new(threshold: u32, largest: u32, average: Average) -> Option<AreaClasses> {
        let bounds = spaced(f64::from(threshold.max(1)), f64::from(largest) / 2.0, CLASSES)?;
        Some(AreaClasses { average, bounds, classes: vec![Class::default(); CLASSES - 1] })
    }

    /// Adds the value of a cell; values that are not finite are ignored. Add the cells row by row, because the sums
    /// depend on their order.
    pub fn add(&mut self, area: u32, value: f64) {
        let class = self.bounds.partition_point(|bound| *bound <= f64::from(area));
        let Some(class) = class.checked_sub(1).and_then(|k| self.classes.get_mut(k)).filter(|_| value.is_finite())
        else {
            return;
        };
        class.count += 1;
        class.logarithms += libm::log(f64::from(area));
        match self.average {
            Average::Median => class.values.push(value),
            Average::Mean => class.sum += value,
        }
    }

    /// The slope of the line through classes with at least five cells.
    #[must_use]
    pub fn slope(self) -> Option<f64> {
        let points = self.classes.into_iter().filter(|class| class.count >= 5).filter_map(|mut class| {
            let value = match self.average {
                Average::Median => *class.values.select_nth_unstable_by(class.count / 2, f64::total_cmp).1,
                Average::Mean => class.sum / class.count as f64,
            };
            (value > 0.0).then(|| (class.logarithms / class.count as f64, libm::log(value)))
        });
        line(&points.collect::<Vec<_>>())
    }
}

/// `count` numbers from `low` to `high` with equal ratios; `None` if the range is empty.
fn spaced(low: f64, high: f64, count: usize) -> Option<Vec<f64>> {
    let ratio = libm::log(high / low) / (count as f64 - 1.0);
    (high > low).then(|| (0..count).map(|k| low * libm::exp(ratio * k as f64)).collect())
}

/// The slope of the least-squares line.
fn line(points: &[(f64, f64)]) -> Option<f64> {
    if points.len() < 4 {
        return None;
    }
    let count = points.len() as f64;
    let (sx, sy) = points.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x, sy + y));
    let (mx, my) = (sx / count, sy / count);
    let (sxx, sxy) =
        points.iter().fold((0.0, 0.0), |(sxx, sxy), (x, y)| (sxx + (x - mx) * (x - mx), sxy + (x - mx) * (y - my)));
    (sxx > 0.0).then(|| sxy / sxx)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::erosion::Erosion;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::stream_power::{StreamPower, Substrate};
    use crate::hydrology::{drainage, samples};

    #[test]
    fn lines() {
        let points: Vec<(f64, f64)> = (0..6).map(|k| (f64::from(k), 3.0 - 0.5 * f64::from(k))).collect();
        assert!((line(&points).unwrap() + 0.5).abs() < 1e-12);
        assert_eq!((line(&points[..3]), line(&[(1.0, 2.0); 5])), (None, None));
        let spaced = spaced(1.0, 8.0, 4).unwrap();
        assert!(spaced.iter().zip([1.0, 2.0, 4.0, 8.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn a_single_long_river_has_length_as_its_area() {
        let window = Window::new(3000, 3, 1.0);
        let mut receivers = Receivers::none(window);
        receivers.codes_mut()[3001..5999].fill(0);
        let drained = accumulate(&receivers);
        assert!((hack_exponent(&receivers, &drained, 10).unwrap() - 1.0).abs() < 0.02);
        // A profile of S = A^-0.4.
        let mut heights = Grid::filled(window, 0.0);
        let mut h = 0.0f64;
        for i in (1..2999).rev() {
            h += libm::pow(i as f64, -0.4);
            heights.row_mut(1)[i] = h as f32;
        }
        assert!((concavity(&heights, &receivers, &drained, 10).unwrap() - 0.4).abs() < 0.01);
    }

    #[test]
    fn land_in_balance_has_the_numbers_of_its_law() {
        let mut heights = samples::rough(160, 160, 3);
        let law =
            StreamPower { area_exponent: 0.5, erodibility: 1e-2, uplift: 1e-2, max_slope: 1e9, ..Default::default() };
        let erosion = Erosion::new(law, 2e4, 150);
        let drained =
            erosion.run(&mut heights, &Substrate::default(), None, &crate::progress::Progress::none()).unwrap();
        let receivers = drainage::over_surface(&heights, &Outlets::new(&heights, None), Descent::Steepest);
        let theta = concavity(&heights, &receivers, &drained, 10).unwrap();
        let (hack, area) = (hack_exponent(&receivers, &drained, 10).unwrap(), area_exponent(&drained).unwrap());
        assert!((theta - 0.5).abs() < 0.05, "{theta}");
        assert!((0.45..0.7).contains(&hack) && (0.35..0.6).contains(&area), "{hack} {area}");
    }

    #[test]
    fn a_map_too_small_for_classes_has_no_numbers() {
        for heights in samples::grids().into_iter().filter(|heights| heights.data().len() < 60) {
            let receivers =
                drainage::route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
            let drained = accumulate(&receivers);
            assert_eq!(area_exponent(&drained), None);
            assert_eq!(hack_exponent(&receivers, &drained, 10), None);
        }
    }
}
