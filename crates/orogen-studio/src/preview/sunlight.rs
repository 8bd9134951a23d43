//! Which samples are in the sun.

use orogen::Grid;
use orogen::grid::analysis::Shadows;

use crate::view::sun;

/// How much of the sun each sample sees, 0 to 255. Two bytes per sample: for the ground, and for the surface of land
/// and sea. Hills of the sea floor cast shadows on the floor, but not on the water above it. `azimuth` and `altitude`
/// of the sun are in degrees.
#[must_use]
pub fn sunlight(heights: &Grid, sea_level: f32, [azimuth, altitude]: [f64; 2]) -> Vec<u8> {
    let (columns, cell) = (heights.width(), heights.window().cell);
    let lit = |heights: &[f32]| Shadows::new(heights, columns, cell).lit(sun::towards([azimuth, altitude]));
    let ground = lit(heights.data());
    let is_sea = |height: &f32| *height < sea_level;
    let surface = heights.data().iter().any(is_sea).then(|| {
        let surface: Vec<f32> =
            heights.data().iter().map(|height| if is_sea(height) { sea_level } else { *height }).collect();
        lit(&surface)
    });
    let surface = surface.as_ref().unwrap_or(&ground);
    ground
        .iter()
        .zip(surface)
        .flat_map(|(ground, surface)| [ground, surface].map(|lit| if *lit { 255 } else { 0 }))
        .collect()
}

/// Adds the shadows of hills outside of the window of `heights` to its light, with the heights of a larger and coarser
/// `land`. Without it, they would end where the window begins.
pub fn beyond(light: &mut [u8], heights: &Grid, land: &Grid, sea_level: f32, sun: [f64; 2]) {
    let [east, south, up] = sun::towards(sun);
    let level = libm::hypot(east, south);
    if level < 1e-6 || up <= 0.0 {
        return;
    }
    let (window, around) = (heights.window(), land.window());
    let (towards, slope) = ([east / level, south / level], (up / level) as f32);
    let highest = land.data().iter().copied().filter(|height| height.is_finite()).fold(sea_level, f32::max);
    // In samples of the land; the first sample of the window is at `first`.
    let ratio = window.cell / around.cell;
    let first = [window.x as f64 * ratio - around.x as f64, window.y as f64 * ratio - around.y as f64];
    let size = [window.width, window.height].map(|samples| (samples - 1) as f64 * ratio);
    let rise = slope * around.cell as f32;
    for (k, lit) in light.chunks_exact_mut(2).enumerate() {
        let height = heights.data()[k];
        if lit == [0, 0] || !height.is_finite() {
            continue;
        }
        let at = [(k % window.width) as f64 * ratio, (k / window.width) as f64 * ratio];
        // The distance at which the ray leaves the window, whose own hills are known.
        let leaves = [0, 1].map(|axis| match towards[axis] {
            along if along > 1e-9 => (size[axis] - at[axis]) / along,
            along if along < -1e-9 => at[axis] / -along,
            _ => f64::INFINITY,
        });
        let mut far = leaves[0].min(leaves[1]) + 0.5;
        let mut rays = [height, height.max(sea_level)].map(|height| height + rise * far as f32);
        let is_lit = [lit[0] > 0, lit[1] > 0];
        while (is_lit[0] && lit[0] > 0 || is_lit[1] && lit[1] > 0) && rays[0] < highest {
            let [i, j] = [0, 1].map(|axis| first[axis] + at[axis] + towards[axis] * far + 0.5);
            if i < 0.0 || j < 0.0 {
                break;
            }
            let Some(ground) = land.get(i as usize, j as usize) else { break };
            if ground > rays[0] {
                lit[0] = 0;
            }
            if ground.max(sea_level) > rays[1] {
                lit[1] = 0;
            }
            far += 1.0;
            rays = rays.map(|ray| ray + rise);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Window;

    /// A row from west to east, with the sun in the west at 20 degrees: shadows are 2.7 times as long as the obstacle
    /// is high.
    fn row(heights: &[f32]) -> [Vec<bool>; 2] {
        let grid = Grid::from_data(Window::new(heights.len(), 1, 10.0), heights.to_vec()).unwrap();
        let light = sunlight(&grid, 0.0, [270.0, 20.0]);
        [0, 1].map(|of| light.chunks(2).map(|both| both[of] == 255).collect())
    }

    #[test]
    fn hills_of_the_sea_floor_cast_no_shadow_on_the_water() {
        let [ground, surface] = row(&[-50.0, -50.0, -10.0, -50.0, -50.0, -50.0, -50.0, -50.0]);
        assert_eq!(ground, [true, true, true, false, false, false, false, false]);
        assert_eq!(surface, [true; 8]);
    }

    #[test]
    fn islands_do_and_land_is_lit_the_same_with_and_without_water() {
        let [ground, surface] = row(&[-50.0, 10.0, -50.0, -50.0, -50.0, 5.0, -50.0, -50.0]);
        // 27 m behind 10 m, and 14 m behind 5 m; on the floor, 60 m lower, shadows are longer.
        assert_eq!(surface, [true, true, false, false, true, true, false, true]);
        assert_eq!(ground, [true, true, false, false, false, true, false, false]);
        let [ground, surface] = row(&[5.0, 40.0, 5.0, 5.0]);
        assert!(ground == surface && ground == [true, true, false, false]);
    }

    #[test]
    fn shadows_of_hills_outside_of_a_window_reach_into_it() {
        // A wall in the west of level land, with the sun in the west: its shadow is 110 m long.
        let land = Grid::from_data(
            Window::new(40, 20, 10.0),
            (0..800).map(|k| if k % 40 == 5 { 40.0 } else { 0.0 }).collect(),
        )
        .unwrap();
        let heights = Grid::filled(Window::new(40, 11, 5.0).at(20, 10), 0.0);
        let mut light = sunlight(&heights, -1.0, [270.0, 20.0]);
        assert!(light.iter().all(|lit| *lit == 255));
        beyond(&mut light, &heights, &land, -1.0, [270.0, 20.0]);
        for (k, lit) in light.chunks(2).enumerate() {
            let east = 100.0 + 5.0 * (k % 40) as f64;
            assert_eq!(lit, if east < 155.0 { [0; 2] } else { [255; 2] }, "{east} m");
        }
    }
}
