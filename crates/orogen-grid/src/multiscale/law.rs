//! The law of slopes: the more land a river drains, the gentler it is, and hillsides approach a stable slope.

use super::children::Children;
use super::given::{self, Given};
use super::refinement::Refinement;
use crate::erosion::power::power;
use crate::grid::{Grid, Window};
use orogen_simd::{Body, Simd, dispatch};
use std::ops::RangeInclusive;

/// Exponent of the drainage area.
pub const CONCAVITY: f32 = 0.45;

/// Slope of a river with a drainage area of 1 km^2 where uplift over erodibility is 1.
const STEEPNESS: f64 = 0.25;

/// Stable slope of hillsides where uplift over erodibility is 1.
pub const STABLE: f32 = 0.8;

/// Minimum and maximum of given factors.
const FACTORS: RangeInclusive<f32> = 0.01..=100.0;

/// Maximum factor of the width of floors in soft rock.
pub const MAX_FLOOR_FACTOR: f32 = 4.0;

/// Exponent of uplift over erodibility in the stable slope.
pub const STABLE_EXPONENT: f32 = 0.3;

/// Slope of a river with a drainage area of `square_kilometres` where uplift over erodibility is 1.
pub fn river_slope(land: &Refinement, square_kilometres: f64) -> f64 {
    land.relief * STEEPNESS * libm::pow(square_kilometres, -f64::from(CONCAVITY))
}

/// Stable slope of hillsides where uplift over erodibility is 1, including the factor of the uplift.
pub fn stable_slope(land: &Refinement) -> f32 {
    STABLE * power(land.relief as f32, STABLE_EXPONENT)
}

/// The law at the nodes of a level. The slope is s t / (s + t) with s = `river` A^-0.45 and t = `stable`, where A is
/// the drainage area in cells.
pub struct Law {
    pub river: Vec<f32>,
    pub stable: Vec<f32>,
    /// Factor of the width of valley floors; empty on levels without floors.
    pub floor: Vec<f32>,
}

impl Law {
    /// The law where the logarithm of uplift over erodibility is the sum of `variation` and `uplift`.
    pub fn new(land: &Refinement, children: &Children, given: &Given) -> Law {
        let (depth, variation, uplift) = (children.depth, &children.variation, &children.uplift);
        let cells = variation.len().min(uplift.len());
        let kilometres = land.kilometres(depth);
        let river_factor = river_slope(land, kilometres * kilometres) as f32;
        let stable_factor = stable_slope(land);
        let mut law = Law { river: vec![0.0; cells], stable: vec![0.0; cells], floor: Vec::new() };
        if has_floors(land, depth) {
            law.floor.resize(cells, 0.0);
        }
        if land.is_detail(depth) {
            law.fill_detail(variation, uplift, river_factor);
        } else {
            dispatch(Fill { law: &mut law, variation, uplift, river_factor, stable_factor });
        }
        multiply(&mut law.stable, given.stability_factor, &children.window);
        multiply(&mut law.floor, given.floor_factor, &children.window);
        law
    }
}

impl Law {
    /// The law at the nodes of a detail level, with uplift over erodibility in `variation` and the logarithms of stable
    /// slopes in `uplift`. There are no separate floors, because the stable slopes include them.
    fn fill_detail(&mut self, variation: &[f32], uplift: &[f32], river_factor: f32) {
        for (river, variation) in self.river.iter_mut().zip(variation) {
            *river = river_factor * power(std::f32::consts::E, *variation);
        }
        for (stable, uplift) in self.stable.iter_mut().zip(uplift) {
            *stable = power(std::f32::consts::E, *uplift);
        }
    }
}

fn multiply(plane: &mut [f32], factor: Option<&Grid>, window: &Window) {
    if factor.is_some() {
        plane.iter_mut().zip(given::factor(factor, window, FACTORS)).for_each(|(value, factor)| *value *= factor);
    }
}

/// Whether valleys of a level have floors, which is true for the last three levels of valleys.
pub fn has_floors(land: &Refinement, depth: usize) -> bool {
    depth + 2 >= land.levels && !land.is_detail(depth)
}

struct Fill<'a> {
    law: &'a mut Law,
    variation: &'a [f32],
    uplift: &'a [f32],
    river_factor: f32,
    stable_factor: f32,
}

impl Body for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let factors = (self.river_factor, self.stable_factor);
        fill(self.variation, self.uplift, factors, &mut self.law.river, &mut self.law.stable);
        floors(self.variation, self.uplift, &mut self.law.floor);
    }
}

#[inline(always)]
fn fill(
    variation: &[f32],
    uplift: &[f32],
    (river_factor, stable_factor): (f32, f32),
    river: &mut [f32],
    stable: &mut [f32],
) {
    let n = river.len();
    let (variation, uplift, stable) = (&variation[..n], &uplift[..n], &mut stable[..n]);
    for i in 0..n {
        let logarithm = variation[i] + uplift[i];
        river[i] = river_factor * power(std::f32::consts::E, logarithm);
        stable[i] = stable_factor * power(std::f32::consts::E, STABLE_EXPONENT * logarithm);
    }
}

/// Factors of the width of floors: the softer the rock, the wider the floor.
#[inline(always)]
fn floors(variation: &[f32], uplift: &[f32], floor: &mut [f32]) {
    let n = floor.len();
    let (variation, uplift) = (&variation[..n], &uplift[..n]);
    for i in 0..n {
        let factor = power(std::f32::consts::E, -(variation[i] + uplift[i]));
        floor[i] = if factor < MAX_FLOOR_FACTOR { factor } else { MAX_FLOOR_FACTOR };
    }
}

/// The rise in metres from a node at the source of a river to its neighbor, where `logarithm` is the logarithm of
/// uplift over erodibility.
pub fn slope_of_one_cell(land: &Refinement, depth: usize, logarithm: f32) -> f32 {
    let kilometres = land.kilometres(depth);
    let river = river_slope(land, kilometres * kilometres) as f32 * power(std::f32::consts::E, logarithm);
    let stable = STABLE * power(land.relief as f32 * power(std::f32::consts::E, logarithm), STABLE_EXPONENT);
    river * stable / (river + stable) * land.cell_of(depth) as f32
}
