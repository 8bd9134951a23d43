//! Numbers that tell drained land from noise.
//!
//! Each is the slope of a straight line through the logarithms of classes, fitted by least squares; none where fewer than four
//! classes have members.

use super::accumulation::Accumulation;
use super::direction::DISTANCES;
use super::receivers::Receivers;
use crate::grid::Grid;

/// How many classes of drainage area there are.
const CLASSES: usize = 12;

/// The exponent t of P(area > a) ~ a^-t (Rodriguez-Iturbe and Rinaldo 1997), from 8 cells to a hundredth of the map. Real land
/// has 0.43 to 0.58.
pub fn area_exponent(drained: &Accumulation) -> Option<f64> {
    let areas = drained.area.data();
    let bounds = spaced(8.0, areas.len() as f64 / 100.0, 14)?;
    let points = bounds.into_iter().filter_map(|bound| {
        let above = areas.iter().filter(|area| f64::from(**area) > bound).count();
        (above > 0).then(|| (libm::log(bound), libm::log(above as f64 / areas.len() as f64)))
    });
    Some(-line(&points.collect::<Vec<_>>())?)
}

/// The exponent h of Hack's law, L ~ A^h (Hack 1957): L is the longest way water comes to a cell, A its area, over cells that
/// drain `threshold` cells or more. Real rivers have 0.5 to 0.6.
pub fn hack_exponent(receivers: &Receivers, drained: &Accumulation, threshold: u32) -> Option<f64> {
    let lengths = longest_ways(receivers, drained);
    class_line(drained, threshold, &lengths, |members| {
        let middle = members.len() / 2;
        members.select_nth_unstable_by(middle, f64::total_cmp);
        members[middle]
    })
}

/// The concavity of rivers: theta of S ~ A^-theta (Flint 1974), with S the drop per metre along the way water takes over `filled`
/// ground. Rivers in balance with uplift have m / n, 0.4 to 0.6.
pub fn concavity(filled: &Grid, receivers: &Receivers, drained: &Accumulation, threshold: u32) -> Option<f64> {
    let cell = filled.window().cell;
    let drop = |c: usize| {
        let receiver = receivers.of(c);
        let way = DISTANCES[usize::from(receivers.code(c) & 7)] * cell;
        if receiver == c { f64::NAN } else { f64::from(filled.data()[c] - filled.data()[receiver]) / way }
    };
    let drops: Vec<f64> = (0..filled.data().len()).map(drop).collect();
    let mean = |members: &mut Vec<f64>| members.iter().sum::<f64>() / members.len() as f64;
    Some(-class_line(drained, threshold, &drops, mean)?)
}

/// How far water has come at most, in cells.
fn longest_ways(receivers: &Receivers, drained: &Accumulation) -> Vec<f64> {
    let mut ways = vec![0.0f64; drained.area.data().len()];
    for c in drained.upstream_first() {
        let receiver = receivers.of(c);
        if receiver != c {
            let way = ways[c] + DISTANCES[usize::from(receivers.code(c) & 7)];
            ways[receiver] = ways[receiver].max(way);
        }
    }
    ways
}

/// The line through classes of area, from `threshold` cells to half the largest: the middle of their logarithms, and the
/// logarithm of what `of` makes of the members' values. Values that are not finite have no class.
fn class_line(
    drained: &Accumulation,
    threshold: u32,
    values: &[f64],
    of: impl Fn(&mut Vec<f64>) -> f64,
) -> Option<f64> {
    let areas = drained.area.data();
    let largest = areas.iter().copied().max()?;
    let bounds = spaced(f64::from(threshold.max(1)), f64::from(largest) / 2.0, CLASSES)?;
    let mut classes = vec![(0.0, Vec::new()); CLASSES - 1];
    for (area, value) in areas.iter().zip(values).filter(|(_, value)| value.is_finite()) {
        let class = bounds.partition_point(|bound| *bound <= f64::from(*area));
        if let Some((sum, members)) = class.checked_sub(1).and_then(|k| classes.get_mut(k)) {
            *sum += libm::log(f64::from(*area));
            members.push(*value);
        }
    }
    let points = classes.into_iter().filter(|(_, members)| members.len() >= 5).filter_map(|(sum, mut members)| {
        let value = of(&mut members);
        (value > 0.0).then(|| (sum / members.len() as f64, libm::log(value)))
    });
    line(&points.collect::<Vec<_>>())
}

/// `count` numbers from `low` to `high` in equal ratios; none if there is no room between.
fn spaced(low: f64, high: f64, count: usize) -> Option<Vec<f64>> {
    let ratio = libm::log(high / low) / (count as f64 - 1.0);
    (high > low).then(|| (0..count).map(|k| low * libm::exp(ratio * k as f64)).collect())
}

/// The slope of the line of least squares.
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
    use crate::hydrology::stream_power::{Ground, StreamPower};
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
            StreamPower { area_exponent: 0.5, erodibility: 1e-2, uplift: 1e-2, steepest: 1e9, ..Default::default() };
        let erosion = Erosion { law, creep: 0.0, years: 2e4, steps: 150, scattered: None, irregular: 0.0 };
        let drained = erosion.run(&mut heights, &Ground::default(), None, &crate::Progress::none()).unwrap();
        let receivers = drainage::over_surface(&heights, &Outlets::new(&heights, None), Descent::Steepest);
        let theta = concavity(&heights, &receivers, &drained, 10).unwrap();
        let (hack, area) = (hack_exponent(&receivers, &drained, 10).unwrap(), area_exponent(&drained).unwrap());
        assert!((theta - 0.5).abs() < 0.05, "{theta}");
        assert!((0.45..0.7).contains(&hack) && (0.35..0.6).contains(&area), "{hack} {area}");
    }

    #[test]
    fn a_map_too_small_for_classes_has_no_numbers() {
        for heights in samples::grids().into_iter().filter(|heights| heights.data().len() < 60) {
            let receivers = drainage::over_bed(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
            let drained = accumulate(&receivers);
            assert_eq!(area_exponent(&drained), None);
            assert_eq!(hack_exponent(&receivers, &drained, 10), None);
        }
    }
}
