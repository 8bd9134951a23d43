//! What the drainage of a piece of land is like.

use crate::grid::Grid;
use crate::hydrology::accumulation::accumulate;
use crate::hydrology::direction::DISTANCES;
use crate::hydrology::drainage;
use crate::hydrology::fill;
use crate::hydrology::outlets::Outlets;
use crate::hydrology::receivers::Receivers;
use crate::hydrology::rivers::{Reach, network};
use crate::hydrology::statistics;
use crate::hydrology::steepest::Descent;
use crate::hydrology::strahler;
use crate::hydrology::wetness::wetness;

/// Where rivers begin: the drainage area in m^2, and the fewest cells.
pub const SPRING: f64 = 5e5;
const FEWEST_CELLS: u32 = 32;

/// Depressions, rivers and their laws.
#[derive(Debug, Clone)]
pub struct Water {
    /// Share of the cells that lie below the level at which their depression spills.
    pub depressions: f64,
    /// Their mean depth in metres; 0 without any.
    pub depression_depth: f64,
    /// Exponent of P(area > a) ~ a^-t.
    pub area_exponent: Option<f64>,
    /// Exponent of Hack's law.
    pub hack: Option<f64>,
    /// Concavity of the rivers.
    pub concavity: Option<f64>,
    /// How many times more rivers an order has than the next (Horton 1945).
    pub bifurcation: Option<f64>,
    /// How many times longer they are.
    pub length_ratio: Option<f64>,
    /// The highest order.
    pub order: u8,
    /// Kilometres of river on a square kilometre.
    pub density: f64,
    /// Mean topographic wetness.
    pub wetness: f64,
    /// The rivers, from spring or confluence to confluence or outlet.
    pub reaches: Vec<Reach>,
}

/// Measures the drainage of heights in which what is no land is NaN.
pub fn measure(heights: &Grid) -> Water {
    let window = heights.window();
    let outlets = Outlets::new(heights, None);
    let filled = fill::fill(heights, &outlets);
    let receivers = drainage::over_surface(&filled, &outlets, Descent::Steepest);
    // Outlets are not asked for again.
    drop(outlets);
    let drained = accumulate(&receivers);
    let spring = ((SPRING / (window.cell * window.cell)) as u32).max(FEWEST_CELLS);
    let orders = strahler::orders(&receivers, &drained, spring);
    let (mut land, mut wet, mut deep) = (0.0, 0.0, 0.0);
    for (height, level) in heights.data().iter().zip(filled.data()).filter(|(height, _)| height.is_finite()) {
        land += 1.0;
        if level > height {
            wet += 1.0;
            deep += f64::from(*level) - f64::from(*height);
        }
    }
    let reaches = network(&receivers, &orders);
    let streams = streams(&reaches, &receivers, window.cell);
    let river: f64 = streams.iter().map(|(_, length)| length).sum();
    let area = land * window.cell * window.cell;
    let order = streams.len() as u8;
    let counted: Vec<f64> = streams.iter().map(|(count, _)| *count).collect();
    let lengths: Vec<f64> = streams.iter().map(|(count, length)| length / count).collect();
    // The highest order is cut off by the map's edge: its rivers are not whole.
    let whole = lengths.len().saturating_sub(1);
    Water {
        depressions: wet / f64::max(land, 1.0),
        depression_depth: if wet > 0.0 { deep / wet } else { 0.0 },
        area_exponent: statistics::area_exponent(&drained),
        hack: statistics::hack_exponent(&receivers, &drained, spring),
        concavity: statistics::concavity(&filled, &receivers, &drained, spring),
        bifurcation: ratio(&counted).map(|ratio| 1.0 / ratio),
        length_ratio: if order >= 3 { ratio(&lengths[..whole]) } else { None },
        order,
        density: if area > 0.0 { 1000.0 * river / area } else { 0.0 },
        wetness: mean(&wetness(heights, &drained)),
        reaches,
    }
}

fn mean(grid: &Grid) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in grid.data().iter().filter(|value| value.is_finite()) {
        sum += f64::from(*value);
        count += 1.0;
    }
    sum / count
}

/// Of each order from 1, how many streams there are (reaches of one order that follow each other are one) and how many metres of them.
fn streams(reaches: &[Reach], receivers: &Receivers, cell: f64) -> Vec<(f64, f64)> {
    let highest = reaches.iter().map(|reach| reach.order).max().unwrap_or(0);
    let mut streams = vec![(0.0, 0.0); usize::from(highest)];
    for reach in reaches {
        let Some((count, length)) = usize::from(reach.order).checked_sub(1).and_then(|k| streams.get_mut(k)) else {
            continue;
        };
        let next = reach.next.and_then(|next| reaches.get(next as usize));
        // A stream is counted where it ends: where the next reach is of another order.
        if next.is_none_or(|next| next.order != reach.order) {
            *count += 1.0;
        }
        for c in reach.cells.iter().take(reach.cells.len().saturating_sub(1)) {
            let code = usize::from(receivers.code(*c as usize) & 7);
            *length += DISTANCES[code] * cell;
        }
    }
    streams
}

/// The mean ratio from each number to the next: the slope of a line through their logarithms. None of fewer than two.
fn ratio(numbers: &[f64]) -> Option<f64> {
    let count = numbers.len() as f64;
    if numbers.len() < 2 || numbers.iter().any(|number| *number <= 0.0) {
        return None;
    }
    let middle = (count - 1.0) / 2.0;
    let (mut above, mut below) = (0.0, 0.0);
    for (k, number) in numbers.iter().enumerate() {
        let x = k as f64 - middle;
        above += x * libm::log(*number);
        below += x * x;
    }
    Some(libm::exp(above / below))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn ratios_are_those_of_horton() {
        assert!((ratio(&[64.0, 16.0, 4.0]).unwrap() - 0.25).abs() < 1e-12);
        assert_eq!((ratio(&[3.0]), ratio(&[3.0, 0.0])), (None, None));
    }

    #[test]
    fn a_valley_has_one_river_and_a_pit_is_a_depression() {
        // A V running south over 80 x 160 cells of 100 m, with a pit of one cell on its flank.
        let mut grid = Grid::filled(Window::new(80, 160, 100.0), 0.0f32);
        for j in 0..160 {
            for i in 0..80 {
                grid.row_mut(j)[i] = 20.0 * (i as f32 - 39.0).abs() + 500.0 - 2.0 * j as f32;
            }
        }
        grid.row_mut(60)[20] -= 300.0;
        let water = measure(&grid);
        assert!((water.depressions - 1.0 / 12_800.0).abs() < 1e-9, "{}", water.depressions);
        assert!(water.depression_depth > 200.0 && water.order >= 1);
        // About 155 cells of river: 15 km on 128 km^2; no flank is long enough for one of its own.
        assert!((0.05..0.15).contains(&water.density), "{}", water.density);
        let river = water.reaches.iter().find(|reach| reach.cells.contains(&(100 * 80 + 39))).unwrap();
        assert_eq!(river.order, water.order);
    }
}
