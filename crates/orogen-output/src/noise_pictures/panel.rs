//! The two pictures of a noise.

use orogen_grid::analysis::hillshade::{Light, hillshade};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::levels::Levels;

use super::row::{SIDE, Shown};

/// Height of a hillshade's ground between black and white, in the unit of [`SIDE`].
const RELIEF: f32 = 25.0;

/// The share of samples clipped to black, and to white, so that single peaks do not darken the rest.
const OUTSIDE: f64 = 0.005;

/// Gray values, row-major, of `side` x `side` samples.
#[derive(Debug)]
pub struct Pictures {
    /// The heights: black is low, white is high.
    pub heights: Vec<u8>,
    /// The hillshade.
    pub shade: Vec<u8>,
}

/// Draws a noise.
pub fn draw(shown: &Shown, side: usize) -> Pictures {
    // With a border of one sample for slopes at the edge.
    let window = Window::new(side, side, SIDE / side as f64).grown(1);
    let mut grid = Grid::filled(window, f32::NAN);
    // The lengths always agree; an unexpected error would give a visibly black picture.
    let _ = shown.noise.fill(&window.eastings(), &window.southings(), grid.data_mut());
    let levels = levels(&grid);
    let heights = (1..=side).flat_map(|j| grid.row(j)[1..=side].iter().map(|&h| levels.to_u8(h))).collect();
    // All noises are shown with the same relief, whatever their range.
    let stretch = RELIEF / (levels.high() - levels.low()).max(f32::MIN_POSITIVE);
    grid.data_mut().iter_mut().for_each(|h| *h = (*h - levels.low()) * stretch);
    let light = hillshade(&grid, &Light::default());
    let shade = light.data().iter().map(|&light| (light * 255.0 + 0.5) as u8).collect();
    Pictures { heights, shade }
}

fn levels(grid: &Grid) -> Levels {
    let mut sorted = grid.data().to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let outside = (sorted.len() as f64 * OUTSIDE) as usize;
    match (sorted.get(outside), sorted.iter().nth_back(outside)) {
        (Some(&low), Some(&high)) => Levels::new(low, high),
        _ => Levels::of(grid),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise_pictures::row::rows;

    #[test]
    fn pictures_use_all_greys_and_the_light_comes_from_the_north_west() {
        for shown in rows(3).iter().flat_map(|row| &row.noises) {
            let Pictures { heights, shade } = draw(shown, 100);
            assert_eq!((heights.len(), shade.len()), (10_000, 10_000));
            assert!(heights.iter().min() <= Some(&3) && heights.iter().max() >= Some(&252), "{}", shown.name);
            // Ground that rises to the south-east faces the light.
            let rising = |k: usize| i32::from(heights[k + 101]) - i32::from(heights[k - 101]);
            let inner = (101..9_899).filter(|k| !matches!(k % 100, 0 | 99));
            let agree: i64 = inner.map(|k| i64::from(rising(k)) * (i64::from(shade[k]) - 180)).sum();
            assert!(agree > 0, "{}", shown.name);
        }
    }
}
