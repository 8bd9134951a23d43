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
}
