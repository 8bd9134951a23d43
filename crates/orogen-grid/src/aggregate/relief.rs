//! Mountains from aggregates: coarse branches become ranges, finer ones become their spurs.

use super::tree::Tree;
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;
use crate::random::Random;

/// Parameters of [`ridge_heights`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Ridges {
    /// Seed of the random choices.
    pub seed: u64,
    /// Maximum distance from the center, as a share of the distance to the edges.
    pub reach: f64,
    /// Share of the cells that ridges cover, at every scale, 0 to 1.
    pub density: f64,
    /// Height of each scale relative to the next coarser one.
    pub gain: f64,
    /// Distance from the tip, in cells, at which a ridge has half its height.
    pub taper: f64,
}

impl Default for Ridges {
    /// The defaults of the op `dla`: seed 0, reach 0.95, density 0.2, gain 0.65, taper 8.
    fn default() -> Ridges {
        Ridges { seed: 0, reach: 0.95, density: 0.2, gain: 0.65, taper: 8.0 }
    }
}

orogen_noise::builder!(
    Ridges:
    with_seed(seed: u64),
    with_reach(reach: f64),
    with_density(density: f64),
    with_gain(gain: f64),
    with_taper(taper: f64)
);

/// Number of cells along the longer side of the coarsest grid.
const COARSEST: usize = 12;

/// Heights from 0 to about 1 on a grid of at least `width` x `height` samples. Returns the size of that grid and the
/// heights, row by row.
///
/// On the coarsest grid an aggregate grows from the center. Each finer grid starts with the aggregate of the coarser
/// one, with small random bends (see [`Tree::refined`]), and continues its growth. At every scale the height of a ridge
/// depends on the distance d to the farthest tip that grew on it: 1 - 1 / (1 + d / taper). The heights of all scales
/// are added; those of coarser scales are smoothed at each refinement. The time is O(cells).
///
/// # Errors
/// If the work is cancelled.
pub fn ridge_heights(
    width: usize,
    height: usize,
    ridges: &Ridges,
    progress: &Progress,
) -> Result<(usize, usize, Vec<f32>)> {
    let longest = width.max(height).max(1);
    let mut scales = 0u32;
    while COARSEST << scales < longest {
        scales += 1;
    }
    let at = |scale: u32| {
        let along = |n: usize| (n * (COARSEST << scale)).div_ceil(longest).max(3);
        (along(width), along(height))
    };
    let (mut across, mut down) = at(0);
    let mut tree = Tree::new(across, down, ridges.reach);
    tree.put(across as i64 / 2, down as i64 / 2, None);
    let mut map = vec![0.0f32; across * down];
    let (mut weight, mut total) = (1.0f32, 0.0f32);
    // Each scale has four times the cells of the previous one.
    let cells = |scale: u32| (1u64 << (2 * scale)) as f64;
    (0..=scales).for_each(|scale| progress.expect(cells(scale)));
    for scale in 0..=scales {
        let part = progress.part(cells(scale));
        let [refining, growing, raising] = part.parts([1.0, 3.0, 1.0]);
        let mut random = Random::new(ridges.seed, u64::from(scale) + 1);
        if scale > 0 {
            let (finer_across, finer_down) = at(scale);
            tree = tree.refined_checked(finer_across, finer_down, &mut random, &|| progress.check())?;
            progress.check()?;
            map = doubled(&map, across, finer_across, finer_down);
            for _ in 0..3 {
                map = blurred(&map, finer_across);
                progress.check()?;
            }
            progress.check()?;
            (across, down) = (finer_across, finer_down);
        }
        // The coarsest aggregate has a width of only a few cells and must extend in all directions.
        let share = if scale == 0 { ridges.density.max(0.3) } else { ridges.density };
        refining.finish();
        tree.grow((tree.room() as f64 * share) as usize, &mut random, &growing)?;
        progress.check()?;
        let taper = ridges.taper.max(1e-3);
        for (cell, steps) in tree.cells().iter().zip(tree.to_tips()) {
            let high = 1.0 - 1.0 / (1.0 + (f64::from(steps) + 0.5) / taper);
            map[*cell as usize] += weight * high as f32;
        }
        raising.finish();
        total += weight;
        weight *= ridges.gain as f32;
    }
    map = blurred(&map, across);
    parallel::for_each(map.chunks_mut(across), |row| row.iter_mut().for_each(|h| *h /= total));
    Ok((across, down, map))
}

/// The map with twice as many cells along each side, by bilinear interpolation between cell centers.
fn doubled(map: &[f32], across: usize, finer_across: usize, finer_down: usize) -> Vec<f32> {
    let down = map.len() / across;
    let mut finer = vec![0.0f32; finer_across * finer_down];
    parallel::for_each(finer.chunks_mut(finer_across).enumerate(), |(j, row)| {
        // The center of a fine cell is a quarter of a coarse cell away from the center of its coarse cell.
        let near = (j / 2).min(down - 1);
        let far = if j % 2 == 0 { near.max(1) - 1 } else { (near + 1).min(down - 1) };
        let (near, far) = (&map[near * across..(near + 1) * across], &map[far * across..(far + 1) * across]);
        for (i, h) in row.iter_mut().enumerate() {
            let here = (i / 2).min(across - 1);
            let there = if i % 2 == 0 { here.max(1) - 1 } else { (here + 1).min(across - 1) };
            let mixed = |row: &[f32]| 0.75 * row[here] + 0.25 * row[there];
            *h = 0.75 * mixed(near) + 0.25 * mixed(far);
        }
    });
    finer
}

/// Smooths the map with weights 1, 2, 1 along both axes.
fn blurred(map: &[f32], across: usize) -> Vec<f32> {
    let down = map.len() / across;
    let mut rows = vec![0.0f32; map.len()];
    parallel::for_each(rows.chunks_mut(across).zip(map.chunks(across)), |(out, row)| {
        for i in 0..across {
            out[i] = 0.25 * row[i.max(1) - 1] + 0.5 * row[i] + 0.25 * row[(i + 1).min(across - 1)];
        }
    });
    let mut out = vec![0.0f32; map.len()];
    parallel::for_each(out.chunks_mut(across).enumerate(), |(j, out)| {
        let row = |j: usize| &rows[j * across..(j + 1) * across];
        let (above, here, below) = (row(j.max(1) - 1), row(j), row((j + 1).min(down - 1)));
        for (((h, above), here), below) in out.iter_mut().zip(above).zip(here).zip(below) {
            *h = 0.25 * above + 0.5 * here + 0.25 * below;
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIDGES: Ridges = Ridges { seed: 4, reach: 0.95, density: 0.12, gain: 0.6, taper: 5.0 };

    #[test]
    fn it_is_highest_within_and_low_at_the_edges() {
        for (width, height) in [(100, 100), (150, 70), (13, 13), (5, 40), (1, 1)] {
            let (across, down, map) = ridge_heights(width, height, &RIDGES, &Progress::none()).unwrap();
            assert!(across >= width && down >= height && map.len() == across * down);
            assert!(map.iter().all(|h| (0.0..=1.5).contains(h)));
            if width > 20 && height > 20 {
                let mean = |inside: bool| {
                    let is_inside = |k: &usize| {
                        let (i, j) =
                            ((k % across) as f64 / across as f64 - 0.5, (k / across) as f64 / down as f64 - 0.5);
                        (i * i + j * j < 0.04) == inside
                    };
                    let (sum, count) = (0..map.len())
                        .filter(is_inside)
                        .fold((0.0, 0.0), |(sum, count), k| (sum + f64::from(map[k]), count + 1.0));
                    sum / count
                };
                assert!(mean(true) > 1.5 * mean(false), "{} {}", mean(true), mean(false));
            }
        }
    }

    #[test]
    fn other_seeds_are_other_mountains_and_threads_change_nothing() {
        let one = ridge_heights(90, 90, &RIDGES, &Progress::none()).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        assert_eq!(one, pool.install(|| ridge_heights(90, 90, &RIDGES, &Progress::none()).unwrap()));
        assert!(one.2 != ridge_heights(90, 90, &Ridges { seed: 5, ..RIDGES }, &Progress::none()).unwrap().2);
    }
}
