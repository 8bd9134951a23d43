//! Dolines on planes: how many there are, how deep, and where.

use super::*;
use crate::hydrology::{fill::fill, outlets::Outlets};

/// Bowls only, that do not vary by place.
fn plain() -> Dolines {
    Dolines::default().with_clustering(0.0).with_funnels(0.0).with_floors(0.0)
}

/// A plane that rises to the east by this tangent, over a window with the halo of the law.
fn plane(law: &Dolines, inner: Window, rise: f64) -> Grid {
    let mut ground = Grid::filled(inner.grown(law.halo(inner.cell)), 0.0);
    let eastings = ground.window().eastings();
    for j in 0..ground.height() {
        for (height, east) in ground.row_mut(j).iter_mut().zip(&eastings) {
            *height = (500.0 + east * rise) as f32;
        }
    }
    ground
}

/// The hollows and the ground with them.
fn made(law: &Dolines, ground: &Grid, share: Option<&Grid>) -> (Grid, Grid) {
    let hollow = law.hollow(ground, share, &Progress::none()).unwrap();
    let mut lowered = ground.crop(hollow.window()).unwrap();
    lowered.data_mut().iter_mut().zip(hollow.data()).for_each(|(height, depth)| *height -= depth);
    (hollow, lowered)
}

/// Areas of connected samples where the values are above a limit: their numbers of samples and greatest values.
fn areas(grid: &Grid, above: f32) -> Vec<(usize, f32)> {
    let (width, height) = (grid.width(), grid.height());
    let mut seen = vec![false; width * height];
    let mut found = Vec::new();
    for start in 0..width * height {
        if seen[start] || grid.data()[start] <= above {
            continue;
        }
        let (mut open, mut area) = (vec![start], (0, 0.0f32));
        seen[start] = true;
        while let Some(index) = open.pop() {
            area = (area.0 + 1, area.1.max(grid.data()[index]));
            let (i, j) = (index % width, index / width);
            let west = (i > 0).then(|| index - 1);
            let east = (i + 1 < width).then(|| index + 1);
            let north = (j > 0).then(|| index - width);
            let south = (j + 1 < height).then(|| index + width);
            for next in [west, east, north, south].into_iter().flatten() {
                if !seen[next] && grid.data()[next] > above {
                    seen[next] = true;
                    open.push(next);
                }
            }
        }
        found.push(area);
    }
    found
}

/// How deep the closed depressions of the ground are.
fn ponds(ground: &Grid) -> Grid {
    let mut filled = fill(ground, &Outlets::new(ground, None));
    filled.data_mut().iter_mut().zip(ground.data()).for_each(|(level, ground)| *level -= ground);
    filled
}

#[test]
fn density_and_depths_are_those_of_the_parameters() {
    // 4 km x 4 km; half of the dolines have diameters above 57 m.
    let law = plain().with_density(6.0).with_diameters([40.0, 80.0]).with_depths([0.2, 0.2]);
    let ground = plane(&law, Window::new(1000, 1000, 4.0).at(-300, 70), 0.0);
    let (_, lowered) = made(&law, &ground, None);
    let found = areas(&ponds(&lowered), 0.05);
    // 96 are expected, with a standard deviation of 10, some of which merge.
    assert!((70..118).contains(&found.len()), "{}", found.len());
    let mut ratios: Vec<f64> = Vec::new();
    for (samples, depth) in &found {
        let diameter = (*samples as f64 * 16.0 * 4.0 / std::f64::consts::PI).sqrt();
        ratios.push(f64::from(*depth) / diameter);
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    assert!((0.18..0.25).contains(&median), "{median}");
}

#[test]
fn depressions_are_closed_on_a_slope_of_five_degrees() {
    let law = plain().with_density(3.0).with_diameters([60.0, 120.0]).with_depths([0.1, 0.15]);
    let ground = plane(&law, Window::new(1000, 1000, 4.0), libm::tan(5f64.to_radians()));
    let (hollow, lowered) = made(&law, &ground, None);
    let closed = ponds(&lowered);
    // Those that the border of the window cuts are open.
    let (hollows, depressions) = (areas(&hollow, 0.5).len(), areas(&closed, 0.05).len());
    assert!(hollows > 25 && depressions + 5 >= hollows, "{depressions} of {hollows}");
}

#[test]
fn dolines_are_rarer_where_the_share_is_less_and_on_steep_ground() {
    let law = plain().with_density(8.0).with_diameters([30.0, 60.0]);
    let inner = Window::new(800, 800, 5.0);
    let count = |rise: f64, share: f32| {
        let ground = plane(&law, inner, rise);
        let share = Grid::filled(*ground.window(), share);
        areas(&made(&law, &ground, Some(&share)).0, 0.2).len()
    };
    let all = count(0.0, 1.0);
    let [quarter, none, steep] = [count(0.0, 0.25), count(0.0, 0.0), count(0.3, 1.0)];
    assert!(all > 80 && quarter * 3 < all && quarter * 6 > all, "{all}, {quarter}");
    assert!(none == 0 && steep * 3 < all, "{steep} of {all}");
    // Nothing is on ground steeper than the maximum.
    assert_eq!(count(0.4, 1.0), 0);
}

#[test]
fn clusters_keep_the_mean_density() {
    let law = plain().with_density(10.0).with_diameters([30.0, 40.0]).with_clustering(1.0).with_cluster_distance(800.0);
    let ground = plane(&law, Window::new(1600, 1600, 5.0), 0.0);
    let (hollow, _) = made(&law, &ground, None);
    // Of 640 some merge.
    let count = areas(&hollow, 0.2).len();
    assert!((480..720).contains(&count), "{count}");
    // Squares of 400 m have more or fewer than by chance.
    let counts: Vec<f64> =
        hollow.window().tiles(80).map(|tile| areas(&hollow.crop(&tile).unwrap(), 0.2).len() as f64).collect();
    let mean = counts.iter().sum::<f64>() / counts.len() as f64;
    let variance = counts.iter().map(|count| (count - mean) * (count - mean)).sum::<f64>() / counts.len() as f64;
    assert!(variance > 1.3 * mean, "{variance} around {mean}");
}

#[test]
fn a_floor_is_level_on_a_slope() {
    let law = plain().with_floors(1.0).with_density(2.0).with_diameters([200.0, 220.0]).with_depths([0.15, 0.15]);
    let ground = plane(&law, Window::new(400, 400, 5.0), 0.08);
    let (hollow, lowered) = made(&law, &ground, None);
    let level = (0..400).flat_map(|j| (1..400).map(move |i| (i, j)));
    let level = level.filter(|at| hollow[*at] > 5.0 && (lowered[*at] - lowered[(at.0 - 1, at.1)]).abs() < 0.01).count();
    assert!(level > 50, "{level}");
}

#[test]
fn a_window_is_the_crop_of_a_larger_one() {
    let law = Dolines::default().with_density(20.0);
    let ground = plane(&law, Window::new(300, 260, 7.0).at(-150, -90), 0.05);
    let (whole, _) = made(&law, &ground, None);
    let part = Window::new(101, 77, 7.0).at(-13, 21);
    let (cut, _) = made(&law, &ground.crop(&part.grown(law.halo(7.0))).unwrap(), None);
    assert_eq!(whole.crop(&part).unwrap(), cut);
    assert!(cut.data().iter().any(|depth| *depth > 1.0));
}

#[test]
fn grids_of_other_windows_are_refused() {
    let law = Dolines::default();
    let ground = plane(&law, Window::new(10, 10, 20.0), 0.0);
    let error = law.hollow(&ground, Some(&Grid::filled(Window::new(3, 3, 20.0), 1.0)), &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("same window"), "{error}");
}
