//! One noise as two pictures.

use orogen::analysis::hillshade::{Light, hillshade};
use orogen::format::levels::Levels;
use orogen::{Grid, Window};

use super::row::{SIDE, Shown};

/// How high the ground of a hillshade is, from black to white, in the unit of [`SIDE`].
const RELIEF: f32 = 25.0;

/// The share of the samples that is left black, and of those left white: a single peak should not turn all else grey.
const OUTSIDE: f64 = 0.005;

/// Greys, row after row, of `side` x `side` samples.
#[derive(Debug)]
pub struct Pictures {
    /// Black the lowest samples, white the highest.
    pub heights: Vec<u8>,
    /// The light on it.
    pub shade: Vec<u8>,
}

/// Draws a noise.
pub fn draw(shown: &Shown, side: usize) -> Pictures {
    // One sample more all around, where slopes at the edge look.
    let window = Window::new(side, side, SIDE / side as f64).grown(1);
    let mut grid = Grid::filled(window, f32::NAN);
    // The lengths always fit; were one ever wrong, the picture would be black and seen.
    let _ = shown.noise.fill(&window.eastings(), &window.southings(), grid.data_mut());
    let levels = levels(&grid);
    let heights = (1..=side).flat_map(|j| grid.row(j)[1..=side].iter().map(|&h| levels.to_u8(h))).collect();
    // However far a noise reaches into -1 to 1, here it has the same relief.
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
    use crate::sheet::row::rows;

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
