//! Where dolines are: random points, thinned by clusters, by the slope and by a share of the density.

use super::doline::Doline;
use super::{Dolines, Land};
use crate::craters::step;
use crate::error::{Error, ErrorKind, Result};
use crate::grid::Window;
use crate::random::{Random, STEP, mix64};

/// Mean number of candidates in a cell of the lattice, before clusters.
const CANDIDATES: f64 = 2.0;

/// Maximum number of candidates in a cell.
const MAX_CANDIDATES: u32 = 64;

/// Where the noise of clusters reaches the largest and the least density.
const CLUSTER_EDGE: f64 = 0.35;

/// A place that may have a doline.
struct Candidate {
    center: [f64; 2],
    diameter: f64,
    /// It has one if the probability is above this.
    rank: f64,
    bits: u64,
}

/// The dolines that may reach into a window.
pub(super) fn gather(law: &Dolines, window: &Window, land: &Land) -> Result<Vec<Doline>> {
    let candidates = candidates(law, window);
    let clusters = clusters(law, &candidates)?;
    let steepest = libm::tan(law.max_slope.to_radians());
    let mut dolines = Vec::new();
    for (candidate, cluster) in candidates.iter().zip(clusters) {
        let share = cluster * land.share(candidate.center);
        if candidate.rank >= share {
            continue;
        }
        let (Some(ground), Some(slope)) =
            (land.height(candidate.center), land.slope(candidate.center, 0.5 * candidate.diameter))
        else {
            continue;
        };
        // Rarer from half of the maximum slope on.
        let gentle = if law.max_slope >= 90.0 { 1.0 } else { 1.0 - step(0.5 * steepest, steepest, slope) };
        if candidate.rank < share * gentle {
            let Candidate { center, diameter, bits, .. } = *candidate;
            dolines.push(Doline::new(law, center, ground, diameter, window.cell, bits));
        }
    }
    Ok(dolines)
}

/// The places whose dolines may reach into a window, in a fixed order.
fn candidates(law: &Dolines, window: &Window) -> Vec<Candidate> {
    let mut found = Vec::new();
    let side = (CANDIDATES * 1e6 / law.density).sqrt();
    let none = libm::exp(-CANDIDATES * (1.0 + law.clustering));
    let reach = law.reach();
    let range = |from: f64, to: f64| [from - reach, to + reach].map(|metres| (metres / side).floor() as i64);
    let last = [window.width, window.height].map(|count| count.saturating_sub(1));
    let [left, right] = range(window.east(0), window.east(last[0]));
    let [top, bottom] = range(window.south(0), window.south(last[1]));
    for row in top..=bottom {
        for column in left..=right {
            let cell = mix64(law.seed.wrapping_add((column as u64).wrapping_mul(STEP)));
            let mut random = Random::of_state(mix64(cell.wrapping_add((row as u64).wrapping_mul(STEP))));
            for _ in 0..count(none, &mut random) {
                let center = [column, row].map(|cell| (cell as f64 + random.share()) * side);
                let diameter = diameter(law, random.draw());
                let (rank, bits) = (random.share(), random.draw());
                let is_near = |at: f64, from: f64, to: f64| at > from - reach && at < to + reach;
                if diameter > window.cell
                    && is_near(center[0], window.east(0), window.east(last[0]))
                    && is_near(center[1], window.south(0), window.south(last[1]))
                {
                    found.push(Candidate { center, diameter, rank, bits });
                }
            }
        }
    }
    found
}

/// A number by a Poisson distribution, of which `none` is the probability of 0.
fn count(none: f64, random: &mut Random) -> u32 {
    let (mut left, mut count) = (random.share(), 0);
    while left > none && count < MAX_CANDIDATES {
        left *= random.share();
        count += 1;
    }
    count
}

/// A diameter: its logarithm has a normal distribution that ends two standard deviations from the median.
fn diameter(law: &Dolines, bits: u64) -> f64 {
    let [least, most] = law.diameters;
    let mut random = Random::of_state(bits);
    let mut deviations = 0.0;
    // One draw of 22 lies beyond.
    for _ in 0..16 {
        let length = (-2.0 * libm::log(1.0 - random.share())).sqrt();
        let drawn = length * libm::cos(std::f64::consts::TAU * random.share());
        if drawn.abs() < 2.0 {
            deviations = drawn;
            break;
        }
    }
    (least * most).sqrt() * libm::pow(most / least, 0.25 * deviations)
}

/// The probabilities of the candidates by their clusters.
fn clusters(law: &Dolines, candidates: &[Candidate]) -> Result<Vec<f64>> {
    let most = 1.0 + law.clustering;
    if law.clustering <= 0.0 {
        return Ok(vec![1.0; candidates.len()]);
    }
    let axis = |axis: usize| candidates.iter().map(|candidate| candidate.center[axis]).collect::<Vec<f64>>();
    let (x, y) = (axis(0), axis(1));
    let mut noise = vec![0.0; candidates.len()];
    orogen_noise::Perlin::new(mix64(law.seed), law.cluster_distance)
        .fill(&orogen_noise::Points::Scattered { x: &x, y: &y }, &mut noise)
        .map_err(|error| Error::new(ErrorKind::Internal, error.to_string()))?;
    // The noise is symmetric around 0, so the mean over all places is 1 / `most`.
    let share = |noise: f32| {
        let dense = 2.0 * step(-CLUSTER_EDGE, CLUSTER_EDGE, f64::from(noise)) - 1.0;
        (1.0 + law.clustering * dense) / most
    };
    Ok(noise.into_iter().map(share).collect())
}
